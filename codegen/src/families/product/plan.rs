//! A plan of a product: which integrals of three harmonics are summed by which pair of coefficients, and which by
//! quadrature on rings. Plans are data, found by `zonal search-products` (docs/MATH.md#products).

use crate::math::gaunt::{Mode, gaunt};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// The largest order of a factor or a result that plans are kept for.
pub const HIGHEST_ORDER: usize = 8;

/// What is multiplied: two functions, or one by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Task {
    /// The orders of the two factors and of the result.
    pub orders: [usize; 3],
    /// Whether the second factor is the first.
    pub square: bool,
}

/// Three modes of which the last one's order is the sum of the others'; of equal parts the smaller comes first.
pub type Triple = [Mode; 3];

/// The constant function's mode.
pub const CONSTANT: Mode = (0, 0);

impl Task {
    /// A product of two functions of one order, cut off at it.
    pub fn product(order: usize) -> Self {
        Self { orders: [order; 3], square: false }
    }

    /// A square, cut off at the function's order.
    pub fn square(order: usize) -> Self {
        Self { orders: [order; 3], square: true }
    }

    /// Returns whether a mode is in the first factor, the second and the result.
    pub fn has(&self, (l, _): Mode) -> [bool; 3] {
        self.orders.map(|order| l < order)
    }

    /// Returns the triples that the result needs and whose bands have an even sum, but for that of the constant alone.
    fn triples(&self) -> Vec<Triple> {
        let highest = self.orders.into_iter().max().unwrap_or(0);
        let modes: Vec<Mode> = (0..highest).flat_map(|l| (0..=l).map(move |m| (l, m))).collect();
        let mut all = Vec::new();
        for (i, &p) in modes.iter().enumerate() {
            for &q in &modes[i..] {
                // A real mode may stand beside two complex ones of the same order, each once.
                let (p, q) = if q.1 == 0 { (q, p) } else { (p, q) };
                for &sum in modes.iter().filter(|sum| sum.1 == p.1 + q.1) {
                    let triple = match (p.1, q.1) {
                        (0, 0) if sum < p.max(q) => continue,
                        (0, 0) => [p.min(q), p.max(q), sum],
                        (0, _) if sum < q => continue,
                        _ => [p, q, sum],
                    };
                    let is_even = triple.iter().map(|(l, _)| l).sum::<usize>().is_multiple_of(2);
                    if is_even && triple != [CONSTANT; 3] && self.needs(triple) {
                        all.push(triple);
                    }
                }
            }
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Whether one of three modes is in the first factor, another in the second and the third in the result.
    fn needs(&self, [p, q, r]: Triple) -> bool {
        let [p, q, r] = [p, q, r].map(|mode| self.has(mode));
        [[p, q, r], [p, r, q], [q, p, r], [q, r, p], [r, p, q], [r, q, p]].iter().any(|[a, b, c]| a[0] && b[1] && c[2])
    }
}

/// Rings of latitude on which both factors are multiplied as functions: at the nodes of the Gauss rule for the weight
/// (1 − z²)^exponent, every triple whose largest order is one of the classes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rings {
    /// The least and the largest class.
    pub classes: [usize; 2],
    /// How many nodes, on both sides of the equator.
    pub nodes: usize,
    /// The exponent of the weight.
    pub exponent: usize,
}

impl Rings {
    /// Whether there are such rings: a weight's exponent is at most the least class.
    fn are_possible(&self) -> bool {
        let [first, last] = self.classes;
        self.exponent <= first && first <= last && last < HIGHEST_ORDER && (1..=4 * HIGHEST_ORDER).contains(&self.nodes)
    }

    /// Whether they sum the triples of a class.
    pub fn hold(&self, class: usize) -> bool {
        (self.classes[0]..=self.classes[1]).contains(&class)
    }

    /// Whether their sum for a triple is its integral.
    pub fn are_exact(&self, triple: Triple) -> bool {
        triple.iter().map(|(l, _)| l).sum::<usize>() < 2 * (self.nodes + self.exponent)
    }
}

/// A pair of modes, the one of the larger order first, and the third modes that are summed with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// The pair.
    pub pair: [Mode; 2],
    /// The third of each triple.
    pub thirds: Vec<Mode>,
}

/// Returns a pair with the mode of the larger order first.
pub fn ordered(a: Mode, b: Mode) -> [Mode; 2] {
    if (a.1, a.0) >= (b.1, b.0) { [a, b] } else { [b, a] }
}

/// Returns whether a third mode's order is the sum of a pair's, or their difference.
pub fn is_sum([x, y]: [Mode; 2], third: Mode) -> bool {
    third.1 == x.1 + y.1
}

/// Returns the triple of a pair and its third.
pub fn triple([x, y]: [Mode; 2], third: Mode) -> Triple {
    let (mut parts, sum) = if is_sum([x, y], third) { ([x, y], third) } else { ([y, third], x) };
    parts.sort_by_key(|&(l, m)| (m > 0, l, m));
    match (parts[0].1, parts[1].1) {
        (0, 0) => {
            let mut all = [parts[0], parts[1], sum];
            all.sort_unstable();
            all
        }
        (0, _) => [parts[0], parts[1].min(sum), parts[1].max(sum)],
        _ => {
            parts.sort_unstable();
            [parts[0], parts[1], sum]
        }
    }
}

/// Returns the ways in which a triple can be summed: a pair and its third.
pub fn ways([p, q, sum]: Triple) -> Vec<([Mode; 2], Mode)> {
    if p == CONSTANT {
        return vec![(ordered(q, sum), p)];
    }
    let mut all = vec![(ordered(p, q), sum), (ordered(p, sum), q), (ordered(q, sum), p)];
    all.sort_unstable();
    all.dedup();
    all
}

/// A plan as `data/products.toml` holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// The orders of the two factors and of the result.
    pub orders: [usize; 3],
    /// Whether it is a square.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub square: bool,
    /// What the kernel costs.
    pub operations: usize,
    /// The seed of the search that found it.
    pub seed: u32,
    /// How many tries that search made for each choice of rings that it looked into.
    pub tries: usize,
    /// The rings.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rings: Vec<Rings>,
    /// The pairs and their thirds: `11 21: 10 30` for the pair of (1, 1) and (2, 1) with (1, 0) and (3, 0).
    pub pairs: Vec<String>,
}

/// Plans in a file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Records {
    /// The plans, each task once.
    #[serde(default)]
    pub plan: Vec<Record>,
}

impl Records {
    /// Returns the plans of a text, each of which is one.
    ///
    /// # Errors
    ///
    /// If the text holds none or one that is no plan.
    pub fn read(text: &str) -> Result<Self, String> {
        let records: Self = toml::from_str(text).map_err(|error| error.message().to_owned())?;
        records.plan.iter().try_for_each(|record| record.plan().map(drop))?;
        Ok(records)
    }
}

/// A plan, checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// What it is for.
    pub task: Task,
    /// The rings.
    pub rings: Vec<Rings>,
    /// What is summed by pairs.
    pub items: Vec<Item>,
}

fn mode(text: &str) -> Option<Mode> {
    match text.as_bytes() {
        [l @ b'0'..=b'9', m @ b'0'..=b'9'] if m <= l => Some(((l - b'0').into(), (m - b'0').into())),
        _ => None,
    }
}

impl Item {
    fn parse(text: &str) -> Option<Self> {
        let (pair, thirds) = text.split_once(": ")?;
        let (x, y) = pair.split_once(' ')?;
        let thirds = thirds.split(' ').map(mode).collect::<Option<Vec<Mode>>>()?;
        Some(Self { pair: [mode(x)?, mode(y)?], thirds })
    }

    fn text(&self) -> String {
        let [x, y] = self.pair;
        let of = |(l, m): Mode| format!("{l}{m}");
        let thirds: Vec<String> = self.thirds.iter().map(|&third| of(third)).collect();
        format!("{} {}: {}", of(x), of(y), thirds.join(" "))
    }
}

impl Record {
    /// Returns what a plan is kept as.
    pub fn new(plan: &Plan, operations: usize, (seed, tries): (u32, usize)) -> Self {
        let Task { orders, square } = plan.task;
        let pairs = plan.items.iter().map(Item::text).collect();
        Self { orders, square, operations, seed, tries, rings: plan.rings.clone(), pairs }
    }

    /// Returns what it is for.
    pub fn task(&self) -> Task {
        Task { orders: self.orders, square: self.square }
    }

    /// Returns the plan.
    ///
    /// # Errors
    ///
    /// If its orders or rings are none, or it does not sum every triple that the task needs exactly once.
    pub fn plan(&self) -> Result<Plan, String> {
        let Task { orders, square } = self.task();
        if !orders.iter().all(|order| (1..=HIGHEST_ORDER).contains(order)) || (square && orders[0] != orders[1]) {
            return Err(format!("{orders:?} are no orders of a product"));
        }
        if let Some(rings) = self.rings.iter().find(|rings| !rings.are_possible()) {
            return Err(format!("{rings:?} are no rings"));
        }
        let item = |text: &String| Item::parse(text).ok_or_else(|| format!("`{text}` is no pair with its thirds"));
        let items = self.pairs.iter().map(item).collect::<Result<Vec<Item>, String>>()?;
        let plan = Plan { task: self.task(), rings: self.rings.clone(), items };
        plan.check().map(|()| plan)
    }
}

impl Plan {
    /// Returns the rings that sum a class, if any do.
    pub fn rings_of(&self, class: usize) -> Option<&Rings> {
        self.rings.iter().find(|rings| rings.hold(class))
    }

    /// Returns the triples that pairs have to sum: those of no ring whose integral is not zero, and those that a ring does
    /// not sum exactly, whether it should be zero or not.
    pub fn left(task: Task, rings: &[Rings]) -> Vec<Triple> {
        let by_pairs = |&triple: &Triple| {
            let [p, q, sum] = triple;
            match rings.iter().find(|rings| rings.hold(sum.1)) {
                Some(ring) => !ring.are_exact(triple),
                None => !gaunt(p, q, sum).is_zero(),
            }
        };
        task.triples().into_iter().filter(by_pairs).collect()
    }

    fn check(&self) -> Result<(), String> {
        let mut missing: BTreeMap<Triple, usize> =
            Self::left(self.task, &self.rings).into_iter().map(|triple| (triple, 0)).collect();
        for item in &self.items {
            for &third in &item.thirds {
                let found = missing.get_mut(&triple(item.pair, third));
                *found.ok_or_else(|| format!("`{}` is not needed", item.text()))? += 1;
            }
        }
        match missing.iter().find(|(_, times)| **times != 1) {
            Some((triple, times)) => Err(format!("{triple:?} is summed {times} times")),
            None => Ok(()),
        }
    }
}

/// The plans that kernels are made from.
pub fn kept() -> &'static [Record] {
    static RECORDS: OnceLock<Vec<Record>> = OnceLock::new();
    RECORDS.get_or_init(|| {
        let records: Records = toml::from_str(include_str!("../../../data/products.toml"))
            .unwrap_or_else(|error| panic!("data/products.toml: {error}"));
        records.plan
    })
}
