//! Rotations on the hemisphere by three shears of the generator's: the coefficients of even m by half the angle, those of odd
//! m by the angle, those of even m again; its determinant is one, and its inverse the same with the opposite angle
//! (docs/MATH.md#rotation-on-the-hemisphere). About y by an angle, or from z towards a normal.

use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;
use crate::math::hemisphere::{Below, Coupling, generator};
use crate::math::index::index;

/// The shears: of which parity of m, and by what part of the angle.
const SHEARS: [(usize, [i64; 2]); 3] = [(0, [1, 2]), (1, [1, 1]), (0, [1, 2])];

/// Where the angle enters a shear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Each row is summed with constants, then multiplied.
    Rows,
    /// What the rows take is multiplied first.
    Sources,
}

/// All ways of both parities.
pub const WAYS: [[Way; 2]; 4] =
    [[Way::Rows, Way::Rows], [Way::Rows, Way::Sources], [Way::Sources, Way::Rows], [Way::Sources, Way::Sources]];

/// What a coefficient takes of its neighbours in a shear: from m + 1 and from m − 1, a factor and a band each.
struct Row {
    l: usize,
    m: usize,
    up: Vec<(Exact, usize)>,
    down: Vec<(Exact, usize)>,
}

/// The rows of one parity, m ≥ 0.
fn rows(order: usize, couplings: &[Coupling], parity: usize, [p, q]: [i64; 2]) -> Vec<Row> {
    let part = Exact::ratio(p, q);
    let of = |row: &[Exact], from: usize| -> Vec<(Exact, usize)> {
        row.iter().map(|factor| &part * factor).zip(from..order).collect()
    };
    let row = |m: usize, l: usize| Row {
        l,
        m,
        up: couplings.get(m).map_or_else(Vec::new, |coupling| of(&coupling.up[l - m], m + 1)),
        down: m.checked_sub(1).map_or_else(Vec::new, |below| of(&couplings[below].down[l - m], below)),
    };
    (parity..order).step_by(2).flat_map(|m| (m..order).map(move |l| row(m, l))).collect()
}

/// Σ of the factors times what `value` says of their bands, added to what there is.
fn sum(g: &mut Graph, start: Id, terms: &[(Exact, usize)], mut value: impl FnMut(&mut Graph, usize) -> Id) -> Id {
    terms.iter().fold(start, |sum, (factor, band)| {
        let value = value(g, *band);
        g.scale_add(factor, value, sum)
    })
}

/// Turns hemispherical coefficients about y.
pub fn about_y(g: &mut Graph, c: &[Id], order: usize, below: Below, beta: Id, ways: [Way; 2]) -> Vec<Id> {
    let couplings = generator(order, below);
    let zero = g.constant(Exact::zero());
    let mut x = c.to_vec();
    for (parity, part) in SHEARS {
        let old = x.clone();
        for Row { l, m, up, down } in rows(order, couplings, parity, part) {
            for sign in if m == 0 { vec![1] } else { vec![1, -1] } {
                let signed = |m: usize| sign * m as isize;
                let place = index(l, signed(m));
                // What is of order −1 takes nothing from order 0.
                let down = if sign < 0 && m == 1 { &[][..] } else { &down[..] };
                let both = [(&up[..], m + 1), (down, m.wrapping_sub(1))];
                x[place] = match ways[parity] {
                    Way::Rows => {
                        let sum = both.iter().fold(zero, |total, (terms, from)| {
                            sum(g, total, terms, |_, band| old[index(band, signed(*from))])
                        });
                        g.mul_add(beta, sum, old[place])
                    }
                    Way::Sources => both.iter().fold(old[place], |total, (terms, from)| {
                        sum(g, total, terms, |g, band| g.mul(beta, old[index(band, signed(*from))]))
                    }),
                };
            }
        }
    }
    x
}

/// Turns hemispherical coefficients from z towards a normal of azimuth φ, given β (cos φ, sin φ).
pub fn tilted(g: &mut Graph, c: &[Id], order: usize, below: Below, beta: [Id; 2], ways: [Way; 2]) -> Vec<Id> {
    let couplings = generator(order, below);
    let zero = g.constant(Exact::zero());
    let mut x = c.to_vec();
    for (parity, part) in SHEARS {
        let old = x.clone();
        let at = |band: usize, m: usize| {
            let imaginary = if m == 0 { zero } else { old[index(band, -(m as isize))] };
            [old[index(band, m as isize)], imaginary]
        };
        for Row { l, m, up, down } in rows(order, couplings, parity, part) {
            let places = [index(l, m as isize), index(l, -(m as isize))];
            let [re, im] = places.map(|place| old[place]);
            // From m + 1 by e^(−iφ), from m − 1 by e^(iφ).
            let [re, im] = match ways[parity] {
                Way::Rows => {
                    let [c, s] = beta;
                    let part = |g: &mut Graph, start: Id, is_up: bool, part: usize, sign: i64| {
                        let (terms, from) = if is_up { (&up, m + 1) } else { (&down, m.wrapping_sub(1)) };
                        let terms: Vec<(Exact, usize)> =
                            terms.iter().map(|(factor, band)| (&Exact::int(sign) * factor, *band)).collect();
                        sum(g, start, &terms, |_, band| at(band, from)[part])
                    };
                    let below = [0, 1].map(|of| part(g, zero, false, of, 1));
                    let minus = g.neg(below[1]);
                    let along = part(g, below[0], true, 0, 1);
                    let across = part(g, minus, true, 1, 1);
                    let re = g.mul_add(along, c, re);
                    let re = g.mul_add(across, s, re);
                    let along = part(g, below[1], true, 1, 1);
                    let across = part(g, below[0], true, 0, -1);
                    let im = g.mul_add(along, c, im);
                    [re, g.mul_add(across, s, im)]
                }
                Way::Sources => {
                    let [c, s] = beta;
                    let turned = |g: &mut Graph, [re, im]: [Id; 2], part: usize, sign: i64| {
                        // (re + i im) (c + i sign s).
                        let (with_c, with_s, sign) = match part {
                            0 => (g.mul(re, c), g.mul(im, s), -sign),
                            _ => (g.mul(im, c), g.mul(re, s), sign),
                        };
                        if sign > 0 { g.add(with_c, with_s) } else { g.sub(with_c, with_s) }
                    };
                    [re, im]
                        .into_iter()
                        .enumerate()
                        .map(|(part, start)| {
                            let start = sum(g, start, &up, |g, band| turned(g, at(band, m + 1), part, -1));
                            sum(g, start, &down, |g, band| turned(g, at(band, m.wrapping_sub(1)), part, 1))
                        })
                        .collect::<Vec<Id>>()
                        .try_into()
                        .expect("two parts")
                }
            };
            x[places[0]] = re;
            if m > 0 {
                x[places[1]] = im;
            }
        }
    }
    x
}
