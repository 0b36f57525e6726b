//! The set-up of a rotation from a quaternion or a normal, analysed over boxes. A pair of components, (w, z), (y, x) or
//! (x, y), enters by its angle alone: what is computed is homogeneous in the pair's length, and so is its error, as long
//! as nothing underflows. So no pole is special, and the domain is one angle a pair. Boxes of angles are quartered until
//! their bound is hardly above what is found at single angles (docs/MATH.md#phases-of-a-set-up).

use crate::ir::listing::{Listing, Op, Operand};
use crate::promise::bound::region::{Enclosure, Region, Root};
use crate::promise::bound::roundoff::{Both, U, larger};
use crate::promise::bound::section::{Run, Section, Start};
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::{LazyLock, Mutex, PoisonError};

/// How close the bound comes to what is found at single angles.
const CLOSE: f64 = 1.03;
/// Boxes are quartered so often at most.
const DEPTH: usize = 8;
/// Boxes along each angle at first.
const COARSE: usize = 8;

/// How a value changes with the lengths of two pairs: the exponents, and whether it changes its sign with the pair's.
type Scale = ([f64; 2], [bool; 2]);

/// The scale of a value made of pairs; none if it is not homogeneous.
fn scale(
    listing: &Listing,
    pairs: &[[Operand; 2]],
    operand: Operand,
    known: &mut HashMap<Operand, Option<Scale>>,
) -> Option<Scale> {
    if let Some(pair) = pairs.iter().position(|pair| pair.contains(&operand)) {
        return Some((std::array::from_fn(|i| if i == pair { 1.0 } else { 0.0 }), std::array::from_fn(|i| i == pair)));
    }
    let Operand::Step(step) = operand else {
        return matches!(operand, Operand::Const(_)).then_some(([0.0; 2], [false; 2]));
    };
    if let Some(&scale) = known.get(&operand) {
        return scale;
    }
    let mut of = |operand| scale(listing, pairs, operand, known);
    let product = |(a, p): Scale, (b, q): Scale| -> Scale {
        (std::array::from_fn(|i| a[i] + b[i]), std::array::from_fn(|i| p[i] != q[i]))
    };
    let found = match listing.steps[step].op {
        Op::Neg(a) => of(a),
        Op::Add(a, b) | Op::Sub(a, b) => of(a).filter(|&a| of(b) == Some(a)),
        Op::Mul(a, b) => of(a).zip(of(b)).map(|(a, b)| product(a, b)),
        Op::Fma(a, b, c, _) => of(a).zip(of(b)).map(|(a, b)| product(a, b)).filter(|&ab| of(c) == Some(ab)),
        Op::Recip(a) => of(a).map(|(a, p)| (a.map(|a| -a), p)),
        Op::Rsqrt(a) => of(a).filter(|(_, p)| *p == [false; 2]).map(|(a, p)| (a.map(|a| -a / 2.0), p)),
        _ => None,
    };
    known.insert(operand, found);
    found
}

/// cos or sin over angles from `middle` − `half` to `middle` + `half`.
fn enclose(value: f64, slope: f64, half: f64) -> Enclosure {
    (value, slope.abs() * half + half * half / 2.0 + 1e-15)
}

static KNOWN: LazyLock<Mutex<HashMap<String, Both>>> = LazyLock::new(Mutex::default);

/// How far one or two values are off as one vector, where each pair has unit length; for a value that grows with the
/// lengths, relative to them. None if they are not homogeneous functions of the pairs.
pub fn error(listing: &Listing, pairs: &[[Operand; 2]], outputs: &[Operand]) -> Option<Both> {
    let mut known = HashMap::new();
    outputs.iter().try_for_each(|&output| scale(listing, pairs, output, &mut known).map(|_| ()))?;
    let start = |operand: Operand| {
        let place = pairs.as_flattened().iter().position(|part| *part == operand)?;
        Some(Start { root: Root::Component(place), spread: 0.0, error: [0.0; 2] })
    };
    let section = Section::new(listing, Region::Pairs, &[], outputs, start)?;
    let key = section.key();
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(&error) = known().get(&key) {
        return Some(error);
    }
    let mut search = Search { section: &section, run: Run::default(), found: [0.0; 2] };
    // Negating a pair negates values or does not, and changes no error: half a turn of each is enough.
    let boxes = if pairs.len() == 1 { 1 } else { COARSE };
    let half = FRAC_PI_2 / COARSE as f64;
    let middle = |i: usize| PI * (i as f64 + 0.5) / COARSE as f64;
    let all: Vec<[f64; 2]> = (0..COARSE)
        .flat_map(|i| (0..boxes).map(move |j| [middle(i), if boxes == 1 { 0.0 } else { middle(j) }]))
        .collect();
    let halves = [half, if boxes == 1 { 0.0 } else { half }];
    for &angles in &all {
        let found = search.at(angles, [0.0; 2]);
        search.found = larger(search.found, found);
    }
    let error = all.into_iter().fold([0.0; 2], |worst, angles| larger(worst, search.over(angles, halves, DEPTH)));
    known().insert(key, error);
    Some(error)
}

struct Search<'a> {
    section: &'a Section,
    run: Run,
    /// The largest at single angles so far.
    found: Both,
}

impl Search<'_> {
    fn at(&mut self, angles: [f64; 2], halves: [f64; 2]) -> Both {
        let parts = |i: usize| {
            let (sin, cos) = angles[i].sin_cos();
            [enclose(cos, sin, halves[i]), enclose(sin, cos, halves[i])]
        };
        let all = [parts(0), parts(1)];
        let starts = self.section.starts();
        let values: Vec<Enclosure> = starts
            .iter()
            .map(|start| match start.root {
                Root::Component(place) => all.as_flattened()[place],
                _ => unreachable!("pairs have components"),
            })
            .collect();
        self.section.run(&values, starts, U, &mut self.run);
        self.section.error_together(&mut self.run, U)
    }

    /// The bound over a box.
    fn over(&mut self, angles: [f64; 2], halves: [f64; 2], depth: usize) -> Both {
        let bound = self.at(angles, halves);
        let close = |i: usize| bound[i] <= CLOSE * self.found[i];
        if depth == 0 || (close(0) && close(1)) {
            return bound;
        }
        let found = self.at(angles, [0.0; 2]);
        self.found = larger(self.found, found);
        let quarter = halves.map(|half| half / 2.0);
        let mut worst = [0.0; 2];
        for (i, j) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            if quarter[1] == 0.0 && j > 0.0 {
                continue;
            }
            let part = self.over([angles[0] + i * quarter[0], angles[1] + j * quarter[1]], quarter, depth - 1);
            worst = larger(worst, part);
        }
        worst
    }
}

/// How far (cos β, sin β) = (A − B, 2√(AB)) is off, from the relative errors of A, B and of the sine, over boxes of β.
pub fn polar(a: Both, b: Both, sine: Both) -> Both {
    const BOXES: usize = 256;
    std::array::from_fn(|mode| {
        let over = |i: usize| {
            let [low, high] = [i, i + 1].map(|i| FRAC_PI_2 * i as f64 / BOXES as f64);
            let (cc, ss) = (low.cos().powi(2), high.sin().powi(2));
            let cosine = (2.0 * low).cos().abs().max((2.0 * high).cos().abs());
            let widest =
                if low <= PI / 4.0 && high >= PI / 4.0 { 1.0 } else { (2.0 * low).sin().max((2.0 * high).sin()) };
            let cosine = (a[mode] * cc + b[mode] * ss) * (1.0 + U) + U * cosine;
            cosine.hypot(sine[mode] * widest)
        };
        // Components that were rounded to f32 make a quaternion's norm differ from one by 1.001 u.
        (0..BOXES).map(over).fold(0.0, f64::max) * (1.0 + 1e-6)
    })
}
