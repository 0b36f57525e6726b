//! Bases of functions on the upper hemisphere, in f64 and as their papers define them, to be compared: no kernel is made
//! from these, and none of them shares code with one. All but the spherical harmonics and the cube are orthonormal there.
//!
//! | basis | source |
//! |---|---|
//! | [`SH`] | spherical harmonics, cut off at the horizon |
//! | [`EVEN`] | spherical harmonics of the function mirrored at the horizon: those with l + m even, times √2 (Sloan et al. 2003) |
//! | [`HSH`] | Gautron et al. 2004, equation 8 |
//! | [`ZERNIKE`] | Koenderink et al. 1996: the disc's polynomials at r = √2 sin(θ/2), so that r² = 1 − z and areas are kept |
//! | [`H`] | Habel and Wimmer 2010, equations 8 to 13 |
//! | [`HALF_LIFE`] | Habel and Wimmer 2010, equations 1 and 2 |
//! | [`CUBE`] | McTaggart 2004: the squares of x, y and z, each apart for either sign; not orthonormal |

use std::f64::consts::PI;
use zonal_codegen::environment::harmonics;

/// A basis.
pub struct Basis {
    /// Its name.
    pub name: &'static str,
    /// How many functions it has at an order: n bands, or degrees below n.
    pub count: fn(order: usize) -> usize,
    /// Writes its functions in a unit direction with z ≥ 0 into the first `count` of the values.
    pub values: fn(order: usize, direction: [f64; 3], values: &mut [f64]),
}

/// Spherical harmonics, n² of them.
pub static SH: Basis = Basis { name: "SH", count: square, values: harmonics::basis };

/// Spherical harmonics of a function mirrored at the horizon, those that vanish among the n².
pub static EVEN: Basis = Basis {
    name: "SH, even reflection",
    count: square,
    values: |order, direction, values| {
        harmonics::basis(order, direction, values);
        for l in 0..order {
            for (place, value) in values[l * l..(l + 1) * (l + 1)].iter_mut().enumerate() {
                // The place in the band is l + m.
                *value *= if place % 2 == 0 { 2f64.sqrt() } else { 0.0 };
            }
        }
    },
};

/// Hemispherical harmonics, n² of them.
pub static HSH: Basis = Basis {
    name: "HSH",
    count: square,
    values: |order, [x, y, z], values| {
        let k = 2.0 * (z / (1.0 + z)).sqrt();
        harmonics::basis(order, [k * x, k * y, 2.0 * z - 1.0], values);
        values[..order * order].iter_mut().for_each(|value| *value *= 2f64.sqrt());
    },
};

/// Zernike's polynomials on the hemisphere, the n(n+1)/2 of the degrees below n.
pub static ZERNIKE: Basis = Basis {
    name: "Zernike",
    count: |order| order * (order + 1) / 2,
    values: |order, [x, y, z], values| {
        // r cos φ and r sin φ, for sin θ = r √(1 + z).
        let root = (1.0 + z).sqrt();
        let (x, y, square) = (x / root, y / root, 1.0 - z);
        let mut powers = vec![(1.0, 0.0)];
        for m in 1..order {
            let (cos, sin): (f64, f64) = powers[m - 1];
            powers.push((x * cos - y * sin, x * sin + y * cos));
        }
        let mut place = 0;
        for degree in 0..order {
            for m in (-(degree as isize)..=degree as isize).step_by(2) {
                let size = m.unsigned_abs();
                let norm = ((degree + 1) as f64 / if m == 0 { 2.0 * PI } else { PI }).sqrt();
                let (cos, sin) = powers[size];
                values[place] = norm * radial(degree, size, square) * if m < 0 { sin } else { cos };
                place += 1;
            }
        }
    },
};

/// The H-basis: four functions at order 2, six at order 3.
pub static H: Basis = Basis {
    name: "H",
    count: |order| if order < 3 { 4 } else { 6 },
    values: |order, [x, y, z], values| {
        let (first, second) = ((1.5 / PI).sqrt(), (7.5 / PI).sqrt());
        values[..4].copy_from_slice(&[(0.5 / PI).sqrt(), -first * y, first * (2.0 * z - 1.0), -first * x]);
        if order >= 3 {
            values[4..6].copy_from_slice(&[second * x * y, 0.5 * second * (x * x - y * y)]);
        }
    },
};

/// The basis of Half-Life 2: three cosine lobes.
pub static HALF_LIFE: Basis = Basis {
    name: "Half-Life 2",
    count: |_| 3,
    values: |_, [x, y, z], values| {
        let norm = (1.5 / PI).sqrt();
        let (a, b, c) = (1.0 / 6f64.sqrt(), 1.0 / 2f64.sqrt(), z / 3f64.sqrt());
        values[..3].copy_from_slice(&[
            norm * (-a * x - b * y + c),
            norm * (-a * x + b * y + c),
            norm * ((2.0 / 3f64).sqrt() * x + c),
        ]);
    },
};

/// The ambient cube of Half-Life 2: of its six faces the five that are seen from above the horizon.
pub static CUBE: Basis = Basis {
    name: "Ambient cube",
    count: |_| 5,
    values: |_, [x, y, z], values| {
        let either = |x: f64| if x > 0.0 { [x * x, 0.0] } else { [0.0, x * x] };
        let ([east, west], [north, south]) = (either(x), either(y));
        values[..5].copy_from_slice(&[east, west, north, south, z * z]);
    },
};

fn square(order: usize) -> usize {
    order * order
}

/// The radial polynomial of Zernike over r^m, at r²: Σ (−1)^k (d−k)! / (k! ((d+m)/2−k)! ((d−m)/2−k)!) r^(d−m−2k).
fn radial(degree: usize, m: usize, square: f64) -> f64 {
    let factorial = |n: usize| (1..=n).map(|i| i as f64).product::<f64>();
    let half = (degree - m) / 2;
    (0..=half).fold(0.0, |sum, k| {
        let parts = factorial(k) * factorial((degree + m) / 2 - k) * factorial(half - k);
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        sum * square + sign * factorial(degree - k) / parts
    })
}

impl Basis {
    /// Its functions at an order in a unit direction with z ≥ 0.
    pub fn at(&self, order: usize, direction: [f64; 3]) -> Vec<f64> {
        let mut values = vec![0.0; (self.count)(order)];
        (self.values)(order, direction, &mut values);
        values
    }
}
