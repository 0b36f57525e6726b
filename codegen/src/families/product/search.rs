//! The search for plans: which pair sums each triple, by simulated annealing on what a pair's sums cost, for each choice of
//! rings; what is kept is what the kernel itself is counted to cost (docs/MATH.md#the-search-for-plans).
//!
//! A try's number and the seed decide all that it does, so that one seed finds one plan on every machine.

use crate::families::product::cover;
use crate::families::product::plan::{CONSTANT, Item, Plan, Record, Rings, Task, Triple, is_sum, ways};
use crate::ir::kernel::Domain;
use crate::ir::listing::Listing;
use crate::math::gaunt::Mode;
use crate::promise::samples::Random;
use crate::threads;
use std::collections::BTreeMap;

/// How much dearer a move may make a plan at first, in operations.
const WARM: f64 = 6.0;
/// How much at last.
const COLD: f64 = 0.15;

/// A pair and the thirds that are summed with it.
#[derive(Clone, Debug)]
struct Pair {
    modes: [Mode; 2],
    thirds: Vec<Mode>,
}

/// The real numbers of a mode.
fn parts((_, m): Mode) -> usize {
    if m == 0 { 1 } else { 2 }
}

/// Returns how many operations a pair's sums cost.
fn cost(task: &Task, [x, y]: [Mode; 2], thirds: &[Mode]) -> usize {
    if thirds.is_empty() {
        return 0;
    }
    let has = |mode: Mode| task.has(mode);
    let views: &[[usize; 2]] = if task.square { &[[0, 0]] } else { &[[0, 1], [1, 0]] };
    let (is_same, is_real) = (x == y, x.1 == y.1);
    let complex = x.1 > 0 && y.1 > 0;
    let is_own = |third: Mode| is_same && third == x;
    let of_sign = |plus: bool| thirds.iter().copied().filter(move |&z| is_sum([x, y], z) == plus && !is_own(z));
    let both = |a: bool, b: bool| a && b;
    // One view, in parts' products: of the sum's order or the difference's.
    let times = |plus: bool, minus: bool| match (complex, plus, minus) {
        (_, false, false) => 0,
        (true, false, true) if is_real => 2,
        (true, ..) => 4,
        (false, ..) => parts(x).max(parts(y)),
    };
    let mut total = 0;
    let kept = |plus: bool| of_sign(plus).filter(|&z| has(z)[2]).collect::<Vec<Mode>>();
    let (to_plus, to_minus) = (kept(true), kept(false));
    let of_views = if is_same { &views[..1] } else { views };
    let terms = of_views.iter().filter(|[u, v]| both(has(x)[*u], has(y)[*v])).count();
    if terms > 0 {
        let outs: usize = to_plus.iter().chain(&to_minus).map(|&z| parts(z)).sum();
        total += match (to_plus.is_empty(), to_minus.is_empty()) {
            (true, true) => 0,
            (false, false) if is_same => {
                if task.square {
                    5
                } else {
                    6
                }
            }
            (false, false) if complex => 4 * terms + if is_real { 2 } else { 4 },
            (false, _) if is_same && complex && task.square => 3,
            (plus, minus) => terms * times(!plus, !minus),
        };
        let only_constant = to_plus.len() + to_minus.len() == 1
            && outs == 1
            && [&to_plus, &to_minus].iter().any(|list| list.first() == Some(&CONSTANT));
        total += if only_constant { 0 } else { outs };
        if thirds.iter().any(|&z| is_own(z)) {
            total += if outs == 0 || only_constant { 2 } else { 1 };
        }
    }
    for &[u, v] in views {
        let (to_x, to_y) = (both(has(x)[2], has(y)[v]), !is_same && both(has(y)[2], has(x)[v]));
        if !to_x && !to_y {
            continue;
        }
        let summed = |plus: bool| of_sign(plus).filter(|&z| has(z)[u]).collect::<Vec<Mode>>();
        let (plus, minus) = (summed(true), summed(false));
        for list in [&plus, &minus] {
            total += list.iter().map(|&z| parts(z)).sum::<usize>() - usize::from(list.contains(&CONSTANT));
        }
        let (plus, minus) = (!plus.is_empty(), !minus.is_empty());
        if plus && minus && complex {
            total += if is_real { 2 } else { 4 };
        }
        total += times(plus, minus) * (usize::from(to_x) + usize::from(to_y));
    }
    total
}

/// Triples and the pair that sums each.
struct State<'a> {
    task: &'a Task,
    pairs: Vec<Pair>,
    costs: Vec<usize>,
    /// Of each triple its ways, as pairs and thirds, and which of them is taken.
    ways: Vec<Vec<(usize, Mode)>>,
    taken: Vec<usize>,
    /// Of each pair the triples that it may sum, with the way.
    members: Vec<Vec<(usize, usize)>>,
}

impl<'a> State<'a> {
    fn new(task: &'a Task, triples: &[Triple], dice: &mut Random) -> Self {
        let mut places: BTreeMap<[Mode; 2], usize> = BTreeMap::new();
        let mut state = Self { task, pairs: vec![], costs: vec![], ways: vec![], taken: vec![], members: vec![] };
        for (number, &triple) in triples.iter().enumerate() {
            let mut own = Vec::new();
            for (way, (modes, third)) in ways(triple).into_iter().enumerate() {
                let next = state.pairs.len();
                let place = *places.entry(modes).or_insert(next);
                if place == next {
                    state.pairs.push(Pair { modes, thirds: vec![] });
                    state.members.push(vec![]);
                }
                state.members[place].push((number, way));
                own.push((place, third));
            }
            state.taken.push(below(dice, own.len()));
            state.ways.push(own);
        }
        for (ways, &taken) in state.ways.iter().zip(&state.taken) {
            let (place, third) = ways[taken];
            state.pairs[place].thirds.push(third);
        }
        state.costs = state.pairs.iter().map(|pair| cost(task, pair.modes, &pair.thirds)).collect();
        state
    }

    fn total(&self) -> usize {
        self.costs.iter().sum()
    }

    /// Sums triples in other ways; returns how much dearer the whole has become.
    fn change(&mut self, moves: &[(usize, usize)]) -> isize {
        let mut touched = Vec::new();
        for &(number, way) in moves {
            let (old, third) = self.ways[number][self.taken[number]];
            let list = &mut self.pairs[old].thirds;
            let at = list.iter().position(|&z| z == third).expect("the pair sums the triple");
            list.swap_remove(at);
            let (new, third) = self.ways[number][way];
            self.pairs[new].thirds.push(third);
            self.taken[number] = way;
            touched.extend([old, new]);
        }
        touched.sort_unstable();
        touched.dedup();
        let mut dearer = 0;
        for place in touched {
            let pair = &self.pairs[place];
            let now = cost(self.task, pair.modes, &pair.thirds);
            dearer += now as isize - self.costs[place] as isize;
            self.costs[place] = now;
        }
        dearer
    }

    /// A move: one triple to another pair, all that a pair may sum to it, or all of a pair's to others.
    fn moves(&self, dice: &mut Random) -> Vec<(usize, usize)> {
        match below(dice, 8) {
            0 => {
                let place = below(dice, self.pairs.len());
                self.members[place].iter().copied().filter(|&(number, way)| self.taken[number] != way).collect()
            }
            1 => {
                let place = below(dice, self.pairs.len());
                let own = self.members[place].iter().filter(|&&(number, way)| self.taken[number] == way);
                let others = own.filter(|(number, _)| self.ways[*number].len() > 1).map(|&(number, way)| {
                    let count = self.ways[number].len();
                    (number, (way + 1 + below(dice, count - 1)) % count)
                });
                others.collect()
            }
            _ => {
                let number = below(dice, self.ways.len());
                let count = self.ways[number].len();
                match count {
                    1 => vec![],
                    _ => vec![(number, (self.taken[number] + 1 + below(dice, count - 1)) % count)],
                }
            }
        }
    }

    fn items(&self) -> Vec<Item> {
        let used = self.pairs.iter().filter(|pair| !pair.thirds.is_empty());
        let mut items: Vec<Item> = used
            .map(|pair| {
                let mut thirds = pair.thirds.clone();
                thirds.sort_unstable();
                Item { pair: pair.modes, thirds }
            })
            .collect();
        items.sort_by_key(|item| (item.pair[1], item.pair[0]));
        items
    }
}

fn below(dice: &mut Random, count: usize) -> usize {
    (dice.bits() % count as u64) as usize
}

/// A number that is exponentially distributed, from bits alone: no transcendental function.
fn exponential(dice: &mut Random) -> f64 {
    let mut whole = 0.0;
    // ln 2 for each coin in a row, and within it a fraction that is nearly even.
    while dice.bits() & 1 == 1 {
        whole += 1.0;
    }
    std::f64::consts::LN_2 * (whole + (dice.bits() >> 11) as f64 / (1u64 << 53) as f64)
}

/// Returns what one try finds for the triples that are left to pairs, and what it is reckoned to cost.
pub fn anneal(task: &Task, triples: &[Triple], seed: u64, moves: usize) -> (usize, Vec<Item>) {
    let mut dice = Random::new(seed);
    let mut state = State::new(task, triples, &mut dice);
    if state.pairs.is_empty() {
        return (0, vec![]);
    }
    let mut total = state.total();
    let (mut best, mut found) = (total, state.taken.clone());
    for step in 0..moves {
        let left = 1.0 - step as f64 / moves as f64;
        let heat = COLD + (WARM - COLD) * left * left * left;
        let tried = state.moves(&mut dice);
        if tried.is_empty() {
            continue;
        }
        let back: Vec<(usize, usize)> = tried.iter().map(|&(number, _)| (number, state.taken[number])).collect();
        let dearer = state.change(&tried);
        if dearer as f64 > heat * exponential(&mut dice) {
            state.change(&back);
            continue;
        }
        total = total.wrapping_add_signed(dearer);
        if total < best {
            best = total;
            found.clone_from(&state.taken);
        }
    }
    let moves: Vec<(usize, usize)> = (0..found.len())
        .filter(|&number| state.taken[number] != found[number])
        .map(|number| (number, found[number]))
        .collect();
    state.change(&moves);
    (best, state.items())
}

/// How many moves a try makes for each triple, where rings are compared and where a plan is looked for.
const MOVES: [usize; 2] = [300, 6000];
/// How many choices of rings are looked into.
const LOOKED_INTO: usize = 6;

/// Returns the choices of rings: none, one group of classes, two of them. A rule of the largest exponent needs the fewest
/// nodes; those that one or two nodes fewer leave wrong are summed by pairs.
pub fn layouts(task: &Task) -> Vec<Vec<Rings>> {
    let most = task.orders.into_iter().min().unwrap_or(0);
    let sum: usize = task.orders.iter().map(|order| order - 1).sum();
    let groups = |first: usize| -> Vec<Rings> {
        let of = |last: usize| {
            let exact = (sum / 2 + 1).saturating_sub(first);
            (exact.saturating_sub(2).max(1)..=exact).map(move |nodes| Rings {
                classes: [first, last],
                nodes,
                exponent: first,
            })
        };
        (first..most).flat_map(of).collect()
    };
    let mut all = vec![vec![]];
    for first in 0..most {
        for group in groups(first) {
            let next = group.classes[1] + 1;
            all.extend(
                (next..most)
                    .flat_map(groups)
                    .filter(|other| other.classes[0] == next)
                    .map(|other| vec![group.clone(), other]),
            );
            all.push(vec![group]);
        }
    }
    all
}

/// Returns the cheapest plan that is found with so many tries for each choice of rings that is looked into; says when each
/// choice or try is done.
pub fn search(task: Task, seed: u32, tries: usize, done: impl Fn() + Sync) -> Record {
    let attempt = |rings: &Vec<Rings>, number: usize, moves: usize| {
        let left = Plan::left(task, rings);
        let seed = u64::from(seed) << 32 | number as u64;
        let (_, items) = anneal(&task, &left, seed, moves * left.len());
        let plan = Plan { task, rings: rings.clone(), items };
        let operations = operations(&plan);
        done();
        (operations, plan)
    };
    let all = layouts(&task);
    let reckoned = threads::map(&all, |rings| attempt(rings, 0, MOVES[0]).0);
    let mut places: Vec<usize> = (0..all.len()).collect();
    places.sort_by_key(|&place| reckoned[place]);
    places.truncate(LOOKED_INTO);
    let jobs: Vec<(usize, usize)> =
        places.iter().flat_map(|&place| (1..=tries).map(move |number| (place, number))).collect();
    let found = threads::map(&jobs, |&(place, number)| attempt(&all[place], number, MOVES[1]));
    let (operations, plan) = found.into_iter().min_by_key(|(operations, _)| *operations).expect("a try is made");
    Record::new(&plan, operations, (seed, tries))
}

/// Adds a plan, or puts it in the place of a dearer one of its task; sorted by task.
pub fn keep(all: &mut Vec<Record>, found: Record) {
    match all.iter_mut().find(|record| record.task() == found.task()) {
        Some(record) if record.operations <= found.operations => {}
        Some(record) => *record = found,
        None => all.push(found),
    }
    all.sort_by_key(Record::task);
}

/// Returns what one short try finds, by pairs alone.
pub fn brief(task: Task) -> Plan {
    let left = Plan::left(task, &[]);
    let (_, items) = anneal(&task, &left, 0, MOVES[0] * left.len());
    Plan { task, rings: vec![], items }
}

/// Returns how often [`search`] says that something is done.
pub fn steps(task: &Task, tries: usize) -> usize {
    let layouts = layouts(task).len();
    layouts + layouts.min(LOOKED_INTO) * tries
}

/// Returns what a plan's kernel costs.
pub fn operations(plan: &Plan) -> usize {
    Listing::new(&cover::kernel(plan, Domain::Signal)).cost(1).total
}
