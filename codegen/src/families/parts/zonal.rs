//! The coefficients of zonal functions, one a band, stable for every size or width (docs/MATH.md#lights).

use crate::families::parts::columns::two_step;
use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;
use crate::math::tables;

/// √((2l + 1) π).
fn root_of_pi(l: usize) -> Exact {
    Exact::sqrt_ratio(2 * l + 1, 1) * Exact::pi_sqrt_power(1)
}

/// The coefficient of y_l^0 in a function that is one in one direction and has no other: √((2l + 1) / 4π).
pub fn delta(l: usize) -> Exact {
    Exact::sqrt_ratio(2 * l + 1, 4) * Exact::pi_sqrt_power(-1)
}

/// What the bands above 0 of a cap are made of: all of them are multiples of `s`, the squared sine of its half-angle.
fn above(g: &mut Graph, order: usize, first: Id, [s, cos]: [Id; 2], flat: Id) -> Vec<Id> {
    // The harmonics of m = 1 have the same polynomials, K_l^1 = K_l^0 / √(l(l+1)).
    let ratio = |factor: &Exact, to: usize, from: usize| factor * &Exact::sqrt_ratio(from * (from + 1), to * (to + 1));
    let mut e = vec![flat, first];
    for l in 2..order {
        let next = if l == 2 {
            let step = g.scale(&ratio(&tables::legendre_recurrence(2, 1).0, 2, 1), cos);
            g.mul(step, e[1])
        } else {
            let [a, b, c] = two_step(l, 1);
            // cos² is 1 − s.
            let factor = g.affine(&-ratio(&a, l, l - 2), s, &ratio(&(&a + &b), l, l - 2));
            let product = g.mul(factor, e[l - 2]);
            if c.is_zero() {
                product
            } else {
                let before = g.scale(&ratio(&c, l, l - 4), e[l - 4]);
                g.add(before, product)
            }
        };
        e.push(next);
    }
    e.truncate(order);
    e
}

/// A cap of the squared sine `s` of its half-angle, at most a hemisphere: seven operations and two special ones at order 3.
pub fn cap(g: &mut Graph, order: usize, s: Id) -> Vec<Id> {
    let one = g.constant(Exact::one());
    let s = g.min(s, one);
    let rest = g.sub(one, s);
    let cos = g.sqrt(rest);
    let first = g.scale(&(root_of_pi(1) * Exact::ratio(1, 2)), s);
    // √π s / (1 + cos).
    let half_root = Exact::sqrt_ratio(3, 4);
    let divisor = g.affine(&half_root, cos, &half_root);
    let inverse = g.recip(divisor);
    let flat = g.mul(first, inverse);
    above(g, order, first, [s, cos], flat)
}

/// A cap of the cosine of its half-angle, of any size up to the whole sphere.
pub fn cone(g: &mut Graph, order: usize, cos: Id) -> Vec<Id> {
    let one = g.constant(Exact::one());
    let (below, beyond) = (g.sub(one, cos), g.add(one, cos));
    let s = g.mul(below, beyond);
    let first = g.scale(&(root_of_pi(1) * Exact::ratio(1, 2)), s);
    let flat = g.scale(&root_of_pi(0), below);
    above(g, order, first, [s, cos], flat)
}

/// How the coefficients of a spherical Gaussian are found.
#[derive(Clone, Copy, Debug)]
pub struct Gaussian {
    /// The sharpness up to which bands are made downward.
    pub limit: i64,
    /// The band that this starts from.
    pub start: usize,
    /// Whether what is as small as e^(−2κ) above the limit counts.
    pub tail: bool,
}

impl Gaussian {
    /// What f64 needs: e_0 errs by 2e-14 of itself at most, and so does every other band by as much of e_0.
    pub fn exact(order: usize) -> Self {
        Self { limit: 10.max(2 * order as i64 - 10), start: 20.max(2 * order), tail: true }
    }

    /// What f32 needs, to order 10: 2e-8 of e_0.
    pub const NARROW: Self = Self { limit: 12, start: 16, tail: false };

    /// The coefficients for the sharpness `kappa`.
    pub fn coefficients(self, g: &mut Graph, order: usize, kappa: Id) -> Vec<Id> {
        let limit = g.constant(Exact::int(self.limit));
        // Each way is given what it can take, whichever is chosen.
        let (low, high) = (g.min(kappa, limit), g.max(kappa, limit));
        let (down, up) = (self.downward(g, order, low), self.upward(g, order, high));
        down.into_iter().zip(up).map(|(down, up)| g.select_at_most(kappa, limit, down, up)).collect()
    }

    /// h_l = (2l + 1)!! i_l / κ^l but for a factor: h_(l−1) = h_l + κ² h_(l+1) / ((2l + 1)(2l + 3)), and
    /// e^κ = h_(−1) + κ h_0.
    fn downward(self, g: &mut Graph, order: usize, kappa: Id) -> Vec<Id> {
        let square = g.mul(kappa, kappa);
        let (zero, one) = (g.constant(Exact::zero()), g.constant(Exact::one()));
        let mut h = vec![zero; self.start + 2];
        h[self.start] = one;
        let step = |g: &mut Graph, l: usize, at: Id, above: Id| {
            let weight = g.scale(&Exact::ratio(1, (2 * l + 1) * (2 * l + 3)), square);
            g.mul_add(weight, above, at)
        };
        for l in (1..=self.start).rev() {
            h[l - 1] = step(g, l, h[l], h[l + 1]);
        }
        let cosh = step(g, 0, h[0], h[1]);
        let all = g.mul_add(kappa, h[0], cosh);
        let mut power = g.recip(all);
        let mut double = Exact::int(2);
        (0..order)
            .map(|l| {
                if l > 0 {
                    power = g.mul(power, kappa);
                    double = &double / &Exact::int(2 * l as i64 + 1);
                }
                let value = g.mul(power, h[l]);
                g.scale(&(&root_of_pi(l) * &double), value)
            })
            .collect()
    }

    /// i_(l+1) = i_(l−1) − (2l + 1) / κ i_l, from i_0 = sinh κ / κ and i_1 = cosh κ / κ − sinh κ / κ², all times e^(−κ).
    fn upward(self, g: &mut Graph, order: usize, kappa: Id) -> Vec<Id> {
        let inverse = g.recip(kappa);
        let one = g.constant(Exact::one());
        let (minus, plus) = if self.tail {
            let exponent = g.scale(&-&(Exact::int(2) * log2_e()), kappa);
            let tail = g.exp2(exponent);
            (g.sub(one, tail), g.add(one, tail))
        } else {
            (one, one)
        };
        // Twice i_0 and i_1.
        let first = g.mul(minus, inverse);
        let rest = g.sub(plus, first);
        let mut i = vec![first, g.mul(rest, inverse)];
        for l in 1..order - 1 {
            let factor = g.scale(&Exact::int(2 * l as i64 + 1), inverse);
            let product = g.mul(factor, i[l]);
            i.push(g.sub(i[l - 1], product));
        }
        i.into_iter().enumerate().map(|(l, value)| g.scale(&root_of_pi(l), value)).collect()
    }
}

/// 1 / ln 2, by ln 2 = 2 Σ 1 / ((2k + 1) 3^(2k + 1)), to 150 bits: an exponent of which f64 holds 53.
pub fn log2_e() -> Exact {
    let ninth = Exact::ratio(1, 9);
    let (mut power, mut sum) = (Exact::ratio(2, 3), Exact::zero());
    for k in 0..48 {
        sum = &sum + &(&power * &Exact::ratio(1, 2 * k + 1));
        power = &power * &ninth;
    }
    &Exact::one() / &sum
}

/// The lobe max(0, cos)^s: the integral of band l is that of band l − 2 times (s − l + 2) / (s + l + 1).
pub fn phong(g: &mut Graph, order: usize, s: Id) -> Vec<Id> {
    let mut e: Vec<Id> = Vec::new();
    for l in 0..order {
        let below = Exact::int(l as i64 + 1);
        let divisor = g.affine(&Exact::one(), s, &below);
        let inverse = g.recip(divisor);
        e.push(match l {
            0 | 1 => g.scale(&root_of_pi(l), inverse),
            _ => {
                let numerator = g.affine(&Exact::one(), s, &-Exact::int(l as i64 - 2));
                let quotient = g.mul(numerator, inverse);
                let before = g.scale(&Exact::sqrt_ratio(2 * l + 1, 2 * l - 3), e[l - 2]);
                g.mul(quotient, before)
            }
        });
    }
    e
}

/// The phase function of Henyey and Greenstein: √((2l + 1) / 4π) times the mean cosine `mean` to the power l.
pub fn henyey_greenstein(g: &mut Graph, order: usize, mean: Id) -> Vec<Id> {
    let mut power = g.constant(Exact::one());
    (0..order)
        .map(|l| {
            if l > 0 {
                power = g.mul(power, mean);
            }
            g.scale(&delta(l), power)
        })
        .collect()
}

/// By what the irradiance of a surface multiplies band l of the radiance: the integral of the clamped cosine times P_l,
/// zero for odd l above 1 (docs/MATH.md#the-clamped-cosine).
pub fn cosine_lobe(l: usize) -> Exact {
    let pi = Exact::pi_sqrt_power(2);
    match l {
        1 => pi * Exact::ratio(2, 3),
        _ if l % 2 == 1 => Exact::zero(),
        _ => {
            let central =
                (1..=l as i64 / 2).fold(Exact::one(), |product, k| &product * &Exact::ratio(1 - 2 * k, 2 * k));
            let divisor = (l as i64 + 2) * (1 - l as i64);
            pi * &central * Exact::ratio(2, divisor)
        }
    }
}
