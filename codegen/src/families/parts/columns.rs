//! The basis by columns. For each m: the sectoral pair y_{m,±m}, then what lies above it as polynomials in z² times the pair
//! of degree m (even l − m) or m + 1 (odd l − m). All normalisation is folded into the constants; nothing cancels near the
//! poles. docs/MATH.md#the-basis has the formulas, a rearrangement of the usual recurrences.

use crate::families::parts::phases::{Phase, turn};
use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;
use crate::math::index::index;
use crate::math::tables;

/// What the harmonics of each band are multiplied by; the orthonormal ones have ones.
pub type BandScale = fn(usize) -> Exact;

/// The orthonormal basis.
pub fn orthonormal(_band: usize) -> Exact {
    Exact::one()
}

/// Band l by √(4π / (2l + 1)), so that a zonal coefficient times it is the rotated coefficient.
pub fn zonal(band: usize) -> Exact {
    Exact::sqrt_ratio(4, 2 * band as i64 + 1) * Exact::pi_sqrt_power(1)
}

/// How the sectoral pairs of m = 2 and 3 are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sectoral {
    /// From x and y alone: accurate relative to the value itself, also near the poles.
    Safe,
    /// As [`Sectoral::Safe`], the pairs of m = 3 and 9 one operation cheaper: from those of a third and of two thirds of m.
    SafeCubes,
    /// With x² = 1 − y² − z², one operation cheaper each: accurate relative to the whole sum.
    UnitLength,
}

/// A direction in coordinates that may be multiples of its own, of which some are at hand.
pub struct Scaled {
    /// The coordinates.
    pub xyz: [Id; 3],
    /// What x and y are multiplied by.
    pub across: Exact,
    /// What z is multiplied by.
    pub along: Exact,
}

impl Scaled {
    /// A direction as it is.
    pub fn plain(dir: &[Id]) -> Self {
        Self { xyz: [dir[0], dir[1], dir[2]], across: Exact::one(), along: Exact::one() }
    }
}

/// The values at one direction from which every harmonic is made.
pub struct Columns {
    /// z times `along`.
    z: Id,
    along: Exact,
    z2: Id,
    /// `pairs[m]` is y_{m,m} and y_{m,−m}; the latter has no meaning for m = 0.
    pub pairs: Vec<Phase>,
    scale: BandScale,
}

/// The coefficients of the two-step recurrence y_l = (a z² + b) y_{l−2} + c y_{l−4} for column m.
pub fn two_step(l: usize, m: usize) -> [Exact; 3] {
    let b = |l: usize| if l > m + 1 { tables::legendre_recurrence(l, m).1 } else { Exact::zero() };
    let a = |l: usize| tables::legendre_recurrence(l, m).0;
    let lead = &a(l) * &a(l - 1);
    let back = b(l - 1);
    if back.is_zero() {
        return [lead, -b(l), Exact::zero()];
    }
    let ratio = &(&a(l) * &back) / &a(l - 2);
    [lead, -&(&b(l) + &ratio), -&(&ratio * &b(l - 2))]
}

/// (−1)^m √2 K_m^m (2m − 1)!!, the factor of Re and Im (x + iy)^m in the sectoral pair; K_0^0 for m = 0.
pub fn sectoral_factor(m: usize) -> Exact {
    let mut factor = tables::k(m, m);
    for odd in 0..m {
        factor = factor * Exact::int(-(2 * odd as i64 + 1));
    }
    match m {
        0 => factor,
        _ => factor * Exact::sqrt_ratio(2, 1),
    }
}

impl Columns {
    /// What a direction's columns start from, for harmonics whose bands are scaled.
    pub fn new(g: &mut Graph, dir: &Scaled, order: usize, scale: BandScale, sectoral: Sectoral) -> Self {
        let Scaled { xyz: [x, y, z], across, along } = dir;
        let (x, y, z) = (*x, *y, *z);
        let z2 = g.mul(z, z);
        let steep = along * along;
        let factor = |m: usize| &sectoral_factor(m) * &scale(m);
        let zero = g.constant(Exact::zero());
        let first = g.constant(factor(0));
        let mut pairs = vec![Phase { cos: first, sin: zero }];
        for m in 1..order {
            let k = factor(m);
            let pair = match (m, sectoral) {
                (1, _) => {
                    let k = &k / across;
                    Phase { cos: g.scale(&k, x), sin: g.scale(&k, y) }
                }
                (2, Sectoral::UnitLength) => {
                    let ky = g.scale(&(&(&k * &Exact::int(2)) / &(across * across)), y);
                    let rim = g.affine(&(&-&k / &steep), z2, &k);
                    let yy = g.mul(ky, y);
                    Phase { cos: g.sub(rim, yy), sin: g.mul(ky, x) }
                }
                (3, Sectoral::UnitLength) => {
                    let k = &k / across;
                    let ratio = &(&k * &Exact::int(2)) / &factor(2);
                    let rim = g.affine(&(&-&k / &steep), z2, &k);
                    let c2 = g.scale(&ratio, pairs[2].cos);
                    let (plus, minus) = (g.add(c2, rim), g.sub(c2, rim));
                    Phase { cos: g.mul(minus, x), sin: g.mul(plus, y) }
                }
                (3 | 9, Sectoral::SafeCubes) => {
                    // (C + iS)³ = C (D − 2 S²) + i S (3 D + 2 S²), D = C² − S².
                    let (third, double) = (pairs[m / 3], pairs[2 * m / 3].cos);
                    let cubed = |power: i32| (0..power).fold(Exact::one(), |product, _| &product * &factor(m / 3));
                    let ss = g.mul(third.sin, third.sin);
                    let rest = g.scale(&(&(&k * &Exact::int(2)) / &cubed(3)), ss);
                    let ratio = &k / &(&factor(2 * m / 3) * &cubed(1));
                    let (once, thrice) = (g.scale(&ratio, double), g.scale(&(&ratio * &Exact::int(3)), double));
                    let (minus, plus) = (g.sub(once, rest), g.add(thrice, rest));
                    Phase { cos: g.mul(minus, third.cos), sin: g.mul(plus, third.sin) }
                }
                _ if m % 2 == 0 => {
                    let half = pairs[m / 2];
                    let ratio = &k / &(&factor(m / 2) * &factor(m / 2));
                    let twice = g.scale(&(&ratio * &Exact::int(2)), half.cos);
                    let (cc, ss) = (g.mul(half.cos, half.cos), g.mul(half.sin, half.sin));
                    let difference = g.sub(cc, ss);
                    Phase { cos: g.scale(&ratio, difference), sin: g.mul(twice, half.sin) }
                }
                _ => {
                    let ratio = &(&k / &factor(m - 1)) / across;
                    let (ax, ay) = (g.scale(&ratio, x), g.scale(&ratio, y));
                    turn(g, pairs[m - 1], Phase { cos: ax, sin: ay })
                }
            };
            pairs.push(pair);
        }
        Self { z, along: along.clone(), z2, pairs, scale }
    }

    /// factor · z.
    pub fn along(&self, g: &mut Graph, factor: &Exact) -> Id {
        g.scale(&(factor / &self.along), self.z)
    }

    /// factor · z² + offset.
    fn rise(&self, g: &mut Graph, factor: &Exact, offset: &Exact) -> Id {
        g.affine(&(factor / &(&self.along * &self.along)), self.z2, offset)
    }

    /// y_{m+1,m} / y_{m,m} = κ z.
    pub fn step(&self, g: &mut Graph, m: usize) -> Id {
        let kappa = self.ratio(tables::legendre_recurrence(m + 1, m).0, m + 1, m);
        self.along(g, &kappa)
    }

    /// A factor from band `from` to band `to`, both scaled.
    pub fn ratio(&self, factor: Exact, to: usize, from: usize) -> Exact {
        &(&factor * &(self.scale)(to)) / &(self.scale)(from)
    }

    /// The polynomials in z² for l = m + 2 .. `order`: entry d is what the pair of degree m (even d) or m + 1 (odd d) is
    /// multiplied by; entries 0 and 1 are one. For m = 0 even entries hold the constant y_{0,0} already.
    pub fn polynomials(&self, g: &mut Graph, m: usize, order: usize) -> Vec<Id> {
        let one = g.constant(Exact::one());
        let start = if m == 0 { self.pairs[0].cos } else { one };
        let mut all = vec![start, one];
        for d in 2..order.saturating_sub(m) {
            let l = m + d;
            let [a, b, c] = two_step(l, m);
            let (a, b) = (self.ratio(a, l, l - 2), self.ratio(b, l, l - 2));
            let next = match d {
                2 | 3 => {
                    // The polynomial below is a constant: fold it into the coefficients.
                    let below = match (m, d) {
                        (0, 2) => &sectoral_factor(0) * &(self.scale)(0),
                        _ => Exact::one(),
                    };
                    self.rise(g, &(&a * &below), &(&b * &below))
                }
                _ => {
                    let c = self.ratio(c, l, l - 4);
                    let factor = self.rise(g, &a, &b);
                    let before = g.scale(&c, all[d - 4]);
                    g.mul_add(factor, all[d - 2], before)
                }
            };
            all.push(next);
        }
        all.truncate(order - m);
        all
    }

    /// All n² values, each band scaled.
    pub fn values(&self, g: &mut Graph, order: usize) -> Vec<Id> {
        let zero = g.constant(Exact::zero());
        let mut out = vec![zero; order * order];
        for m in 0..order {
            let polynomials = self.polynomials(g, m, order);
            let even = self.pairs[m];
            let odd = (m + 1 < order).then(|| {
                let step = self.step(g, m);
                Phase { cos: g.mul(step, even.cos), sin: g.mul(step, even.sin) }
            });
            for (d, &polynomial) in polynomials.iter().enumerate() {
                let l = m + d;
                let pair = if d % 2 == 0 { even } else { odd.expect("there is a degree m + 1") };
                if m == 0 {
                    out[index(l, 0)] = if d % 2 == 0 { polynomial } else { g.mul(polynomial, pair.cos) };
                } else {
                    out[index(l, m as isize)] = g.mul(polynomial, pair.cos);
                    out[index(l, -(m as isize))] = g.mul(polynomial, pair.sin);
                }
            }
        }
        out
    }
}

/// All n² values at a direction, each band multiplied by `scale`.
pub fn values(g: &mut Graph, dir: &[Id], order: usize, scale: BandScale) -> Vec<Id> {
    Columns::new(g, &Scaled::plain(dir), order, scale, Sectoral::Safe).values(g, order)
}
