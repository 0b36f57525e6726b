//! How records are turned: rotations for small angles and for any, of spherical and of hemispherical harmonics, as
//! Křivánek et al. (2005, table 1) and Gautron et al. (2004, section 4) compare them. A method for small angles serves below a
//! limit, the exact one above.

use crate::light::Light;
use crate::table;
use zonal::{sh6, sh8, sh10};
use zonal_measure::stability::recursion::Matrices;

/// Turns coefficients by a unit quaternion (x, y, z, w).
pub type Turn<const C: usize> = fn([f32; 4], &Light<C>) -> Light<C>;

/// A way to turn records.
#[derive(Clone, Copy)]
pub struct Method<const C: usize> {
    /// What a person calls it.
    pub name: &'static str,
    /// The kernels that do it.
    pub kernels: &'static str,
    /// What is done below the limit, where that is not what is done above.
    pub small: Option<Turn<C>>,
    /// What is done at any angle.
    pub any: Turn<C>,
}

/// The rotation is left out.
fn ignored<const C: usize>(_: [f32; 4], c: &Light<C>) -> Light<C> {
    *c
}

/// The phases (cos, sin) of α and γ in Rz(α) Ry(β) Rz(γ), and the sine of β/2.
fn phases([x, y, z, w]: [f32; 4]) -> ([[f32; 2]; 2], f32) {
    let (sum, difference) = (w.hypot(z), x.hypot(y));
    let [a, b] = if sum > 0.0 { [w / sum, z / sum] } else { [1.0, 0.0] };
    let [c, d] = if difference > 0.0 { [y / difference, -x / difference] } else { [1.0, 0.0] };
    ([[a * c - b * d, a * d + b * c], [a * c + b * d, b * c - a * d]], difference.min(1.0))
}

/// The angle about z that is turned first, as (cos, sin), and where z then goes by the shortest way.
fn twist_and_tilt([x, y, z, w]: [f32; 4]) -> ([f32; 2], [f32; 3]) {
    let square = (w * w + z * z).max(f32::MIN_POSITIVE);
    let twist = [(w * w - z * z) / square, 2.0 * w * z / square];
    (twist, [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)])
}

/// By the recursion of Ivanic and Ruedenberg, whose matrices all three channels share.
fn recursion<const C: usize>(q: [f32; 4], c: &Light<C>) -> Light<C> {
    let matrices = Matrices::<f32>::new(q.map(f64::from), C.isqrt() - 1);
    let mut out = [[0.0; 3]; C];
    for channel in 0..3 {
        let turned = matrices.apply(&c.map(|c| c[channel]));
        out.iter_mut().zip(turned).for_each(|(out, turned)| out[channel] = turned);
    }
    out
}

/// Cosine and sine of the angle at which the stretched sphere turns for β, whose half has this sine: cos β' = 2 cos β − 1, at
/// most a half turn.
fn stretched(half: f32) -> [f32; 2] {
    let cos = (1.0 - 4.0 * half * half).max(-1.0);
    [cos, (1.0 - cos * cos).max(0.0).sqrt()]
}

macro_rules! kernels {
    ($module:ident, $count:literal) => {
        /// Kernels of an order with what they need of a quaternion.
        pub mod $module {
            use super::*;
            const C: usize = $count;

            pub fn taylor15(q: [f32; 4], c: &Light<C>) -> Light<C> {
                let (cs, half) = phases(q);
                zonal::$module::taylor15_zyz_rgb(&cs, 2.0 * half.asin(), c)
            }
            pub fn small(q: [f32; 4], c: &Light<C>) -> Light<C> {
                zonal::$module::rotate_small_rgb(q, c)
            }
            pub fn tilt(q: [f32; 4], c: &Light<C>) -> Light<C> {
                let (twist, normal) = twist_and_tilt(q);
                zonal::$module::tilt_rgb(normal, &zonal::$module::rotate_z_rgb(twist, c))
            }
            pub fn zxzxz(q: [f32; 4], c: &Light<C>) -> Light<C> {
                zonal::$module::rotate_zxzxz_rgb(q, c)
            }
            pub fn exact(q: [f32; 4], c: &Light<C>) -> Light<C> {
                zonal::$module::rotate_rgb(q, c)
            }
            pub fn equation_13(q: [f32; 4], c: &Light<C>) -> Light<C> {
                let ([alpha, gamma], half) = phases(q);
                zonal::$module::rotate_euler_rgb(&[alpha, stretched(half), gamma], c)
            }
            pub fn table(q: [f32; 4], c: &Light<C>) -> Light<C> {
                let ([alpha, gamma], half) = phases(q);
                let turned = zonal::$module::rotate_z_rgb(gamma, c);
                let about_y = table::of_order(C.isqrt()).turn(2.0 * half.asin(), &turned);
                zonal::$module::rotate_z_rgb(alpha, &about_y)
            }
        }
    };
}

mod of {
    use super::*;
    kernels!(sh6, 36);
    kernels!(sh10, 100);
}

/// With the best extension below the horizon, in spherical harmonics of two bands more (C D E).
fn extended(q: [f32; 4], c: &Light<36>) -> Light<36> {
    sh6::of_order_8_sh_to_hsh_rgb(&sh8::rotate_rgb(q, &table::extended(c)))
}

/// With the best extension below the horizon, in as many bands: the catalogue has no rotation of more.
fn extended_10(q: [f32; 4], c: &Light<100>) -> Light<100> {
    sh10::sh_to_hsh_rgb(&sh10::rotate_rgb(q, &table::extended(c)))
}

fn sheared(q: [f32; 4], c: &Light<36>) -> Light<36> {
    sh6::hsh_rotate_record_rgb(q, c)
}

const fn method<const C: usize>(
    name: &'static str,
    kernels: &'static str,
    small: Option<Turn<C>>,
    any: Turn<C>,
) -> Method<C> {
    Method { name, kernels, small, any }
}

macro_rules! spherical {
    ($module:ident, $order:literal) => {
        [
            method("ignored", "none", None, ignored),
            method(
                "Taylor 1.5",
                concat!("rotate:", $order, ":taylor15"),
                Some(of::$module::taylor15),
                of::$module::exact,
            ),
            method("LF3", concat!("rotate_small:", $order), Some(of::$module::small), of::$module::exact),
            method(
                "tilt",
                concat!("rotate_z:", $order, ", tilt:", $order),
                Some(of::$module::tilt),
                of::$module::exact,
            ),
            method("zxzxz", concat!("rotate:", $order, ":zxzxz"), None, of::$module::zxzxz),
            method("Ivanic and Ruedenberg", "none", None, recursion),
            method("exact", concat!("rotate:", $order), None, of::$module::exact),
        ]
    };
}

/// Of spherical harmonics of order 6.
pub static SH6: [Method<36>; 7] = spherical!(sh6, "6");
/// Of spherical harmonics of order 10.
pub static SH10: [Method<100>; 7] = spherical!(sh10, "10");
/// Of hemispherical harmonics of order 6.
pub static HSH6: [Method<36>; 5] = [
    method("ignored", "none", None, ignored),
    method("LF3 on B", "hsh_rotate_record:6", Some(sheared), of::sh6::table),
    method("method 1, 8 bands", "the matrix of hsh_extend:6+8, rotate:8, sh_to_hsh:8+6", None, extended),
    method("equation 13", "rotate:6:euler", None, of::sh6::equation_13),
    method("table C D_y E", "rotate_z:6, a table of hsh_y_record:6:sh=16, rotate_z:6", None, of::sh6::table),
];
/// Of hemispherical harmonics of order 10.
pub static HSH10: [Method<100>; 4] = [
    method("ignored", "none", None, ignored),
    method("method 1, 10 bands", "the matrix of hsh_extend:10, rotate:10, sh_to_hsh:10", None, extended_10),
    method("equation 13", "rotate:10:euler", None, of::sh10::equation_13),
    method("table C D_y E", "rotate_z:10, a table of hsh_y_record:10:sh=16, rotate_z:10", None, of::sh10::table),
];

/// The sine of half the angle below which a method for small angles serves, for a cache of error `a`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// 1.25 a in radians, as Křivánek et al. round it (2005, appendix B).
    Rounded,
    /// 2 asin(a / (√2 + 2r/R)) with their r/R = 0.1 (docs/MATH.md#the-adaptive-rotation).
    Closed,
    /// An angle in radians, whatever the error.
    Held(f64),
}

impl Limit {
    /// Returns the limit in radians for a cache of error `a` from 0 to 1.
    pub fn angle(self, a: f64) -> f64 {
        match self {
            Self::Rounded => 1.25 * a,
            Self::Closed => 2.0 * (a / (2f64.sqrt() + 0.2)).min(1.0).asin(),
            Self::Held(angle) => angle,
        }
    }
}

impl<const C: usize> Method<C> {
    /// Returns coefficients turned by a quaternion, and whether that was done at once for any angle. `limit` is the sine of
    /// half the largest angle for small turns.
    pub fn turn(&self, q: [f32; 4], limit: f32, c: &Light<C>) -> (Light<C>, bool) {
        match self.small {
            Some(small) if q[0] * q[0] + q[1] * q[1] <= limit * limit => (small(q, c), false),
            _ => ((self.any)(q, c), true),
        }
    }
}
