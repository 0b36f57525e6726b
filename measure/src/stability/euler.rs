//! The three angles of a rotation where they are hard to tell apart, at β near 0 and near π: from quaternions, and from
//! matrices whose f32 entries are noisy. What is compared is the rotation that the angles make, not the angles.

use crate::numbers::Twin;
use crate::stability::truth::{Pair, turn};
use crate::{Progress, each, significant};
use glam::{Mat3, Quat};
use serde::{Deserialize, Serialize};
// Names a family: its set-up is what is measured.
use zonal_codegen::families::zyz::angles;
use zonal_codegen::ir::eval::{Contraction, Number, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::promise::samples::{Random, matrix_of};

/// The small angles: β, and π less β.
pub const SMALL: [f64; 10] = [0.0, 1e-20, 1e-15, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3];
/// How far a noisy entry lies from the exact one at most.
pub const NOISE: f64 = 1e-7;
/// How many pairs of α and γ are tried.
const TRIES: usize = 40;

/// The ways to the angles.
pub const WAYS: [&str; 5] = [
    "quaternion, the kernels' way",
    "matrix, by a quaternion, then the kernels' way",
    "matrix, one angle after another",
    "matrix, three arc tangents",
    "matrix, arc cosine",
];

/// The errors at one β.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The small angle.
    pub angle: f64,
    /// Whether β is π less that.
    pub from_pi: bool,
    /// For each of [`WAYS`] the largest error of an entry of the 3×3 matrix.
    pub errors: [f64; 5],
}

/// (cos, sin) of half a small angle, by its series: the same on every machine.
fn half(angle: f64) -> [f64; 2] {
    let h = angle / 2.0;
    let square = h * h;
    [1.0 - square / 2.0 * (1.0 - square / 12.0), h * (1.0 - square / 6.0)]
}

/// The matrix Rz(α) Ry(β) Rz(γ) by columns.
fn recomposed([[ca, sa], [cb, sb], [cg, sg]]: [[f64; 2]; 3]) -> [f64; 9] {
    [
        ca * cb * cg - sa * sg,
        sa * cb * cg + ca * sg,
        -sb * cg,
        -ca * cb * sg - sa * cg,
        ca * cg - sa * cb * sg,
        sb * sg,
        ca * sb,
        sa * sb,
        cb,
    ]
}

fn difference(a: &[f64; 9], b: &[f64; 9]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(x, y)| (x - y).abs())
        .fold(0.0, |worst, x| if x.is_nan() { f64::INFINITY } else { worst.max(x) })
}

/// (cos, sin) of three angles in f32.
fn phases(angles: [f32; 3]) -> [[f64; 2]; 3] {
    angles.map(|angle| [f64::from(libm::cosf(angle)), f64::from(libm::sinf(angle))])
}

/// The ways from a matrix given by columns, from the third on.
fn from_matrix(m: [f32; 9]) -> [[[f64; 2]; 3]; 3] {
    let r = |row: usize, column: usize| m[3 * column + row];
    let a = libm::atan2f(r(1, 2), r(0, 2));
    let (ca, sa) = (libm::cosf(a), libm::sinf(a));
    let b = libm::atan2f(ca * r(0, 2) + sa * r(1, 2), r(2, 2));
    let g = libm::atan2f(ca * r(1, 0) - sa * r(0, 0), ca * r(1, 1) - sa * r(0, 1));
    let own = libm::atan2f(r(2, 1), -r(2, 0));
    let tangent = libm::atan2f((r(0, 2) * r(0, 2) + r(1, 2) * r(1, 2)).sqrt(), r(2, 2));
    let cosine = libm::acosf(r(2, 2).clamp(-1.0, 1.0));
    [phases([a, b, g]), phases([a, tangent, own]), phases([a, cosine, own])]
}

fn row(angles: &Program<f32>, angle: f64, from_pi: bool) -> Row {
    let mut random = Random::new(0xe01e);
    let mut errors = [0.0f64; 5];
    for _ in 0..TRIES {
        let ([cp, sp], [cm, sm]) = (random.unit::<2>(), random.unit::<2>());
        let [cos, sin] = half(angle);
        let (cos, sin) = if from_pi { (sin, cos) } else { (cos, sin) };
        let exact = [-sin * sm, sin * cm, cos * sp, cos * cp];
        let q = exact.map(|x| x as f32);
        let of_quaternion = |q: [f32; 4]| -> [[f64; 2]; 3] {
            let flat = angles.run(&[&q], Contraction::Separate);
            std::array::from_fn(|i| [f64::from(flat[2 * i]), f64::from(flat[2 * i + 1])])
        };
        let want = matrix_of(exact);
        let noisy = want.map(|x| (x + NOISE * random.signed()) as f32);
        let turned = Quat::from_mat3(&Mat3::from_cols_array(&noisy)).normalize().to_array();
        let [sequential, tangents, cosine] = from_matrix(noisy);
        let ways = [of_quaternion(q), of_quaternion(turned), sequential, tangents, cosine];
        for (error, way) in errors.iter_mut().zip(ways) {
            *error = error.max(difference(&recomposed(way), &want));
        }
    }
    Row { angle, from_pi, errors: errors.map(significant) }
}

/// Every β.
pub fn measure(progress: &dyn Progress) -> Vec<Row> {
    // Order 2 has each angle once: α, β, γ.
    let program = Program::<f32>::new(&Listing::new(&angles(2)));
    let tasks: Vec<(f64, bool)> = [false, true].into_iter().flat_map(|pi| SMALL.map(|angle| (angle, pi))).collect();
    each(progress, "angles of rotations", &tasks, |(angle, from_pi)| row(&program, *angle, *from_pi))
}

/// The ways to the multiples of an angle.
pub const RECURRENCES: [&str; 2] = ["complex products, the kernels' way", "Chebyshev, the papers' way"];
/// The kinds of angle.
pub const ANGLES: [&str; 3] = ["anywhere", "near 0", "near π"];
/// The multiples that tables show.
pub const MULTIPLES: [usize; 4] = [7, 15, 31, 63];

/// How far the multiples of an angle lie from those of the angle that its own (cos, sin) has.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Multiples {
    /// Which of [`RECURRENCES`].
    pub way: String,
    /// The number type.
    pub number: String,
    /// Which of [`ANGLES`].
    pub angles: String,
    /// The largest error up to each of [`MULTIPLES`].
    pub errors: [f64; 4],
}

/// Angles as (cos, sin): random ones, and 1e-4 to 1e-1 and π less these by their half angles' tangents.
fn pairs(kind: usize) -> Vec<[f64; 2]> {
    let mut random = Random::new(0x31);
    match kind {
        0 => (0..40).map(|_| random.unit()).collect(),
        _ => {
            let sign = if kind == 1 { 1.0 } else { -1.0 };
            let angle = |t: f64| [sign * (1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t)];
            [5e-5, 1.7e-4, 5e-4, 1.7e-3, 5e-3, 1.7e-2, 5e-2].map(angle).to_vec()
        }
    }
}

fn recurrence<T: Number>(way: usize, [c, s]: [T; 2]) -> Vec<[T; 2]> {
    let mut all = vec![[T::ONE, T::ZERO], [c, s]];
    let twice = c + c;
    for m in 2..=MULTIPLES[3] {
        let ([a, b], [d, e]) = (all[m - 1], all[m - 2]);
        all.push(match way {
            0 => [a * c - b * s, b * c + a * s],
            _ => [twice * a - d, twice * b - e],
        });
    }
    all
}

fn multiples_of<T: Number>(way: usize, number: &str, kind: usize) -> Multiples {
    let mut errors = [0.0f64; 4];
    for pair in pairs(kind) {
        let given = pair.map(T::from_f64);
        let [c, s] = given.map(|x| Twin::from_f64(x.to_f64()));
        let length = (c * c + s * s).root();
        let unit: Pair = [c / length, s / length];
        let mut exact: Pair = [Twin::ONE, Twin::ZERO];
        for (m, [a, b]) in recurrence(way, given).into_iter().enumerate() {
            let off = |got: T, want: Twin| (Twin::from_f64(got.to_f64()) - want).to_f64();
            let error = off(a, exact[0]).hypot(off(b, exact[1]));
            for (worst, _) in errors.iter_mut().zip(MULTIPLES).filter(|(_, most)| m <= *most) {
                *worst = worst.max(error);
            }
            exact = turn(exact, unit);
        }
    }
    Multiples {
        way: RECURRENCES[way].to_owned(),
        number: number.to_owned(),
        angles: ANGLES[kind].to_owned(),
        errors: errors.map(significant),
    }
}

/// Both recurrences in f32 and f64.
pub fn multiples(progress: &dyn Progress) -> Vec<Multiples> {
    let tasks: Vec<(usize, bool, usize)> = (0..2)
        .flat_map(|way| [false, true].into_iter().flat_map(move |wide| (0..3).map(move |kind| (way, wide, kind))))
        .collect();
    each(progress, "multiples of angles", &tasks, |(way, wide, kind)| match wide {
        true => multiples_of::<f64>(*way, "f64", *kind),
        false => multiples_of::<f32>(*way, "f32", *kind),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_codegen::families::parts::phases::{multiples, phases};
    use zonal_codegen::ir::kernel::Domain;

    /// What is measured is what the kernels do.
    #[test]
    fn products_are_the_kernels_own() {
        use zonal_codegen::ir::kernel::{Builder, Shape};
        let mut builder = Builder::new();
        let cs = builder.param("cs", Shape::Pair, Domain::Phases, "");
        let all = multiples(&mut builder.graph, phases(&cs)[0], MULTIPLES[3]);
        let out = all.iter().flat_map(|phase| [phase.cos, phase.sin]).collect();
        let program = Program::<f32>::new(&Listing::new(&builder.finish(out, Shape::Pairs(MULTIPLES[3]), "")));
        for pair in pairs(0) {
            let given = pair.map(|x| x as f32);
            let own: Vec<f32> = recurrence(0, given).into_iter().skip(1).flatten().collect();
            assert_eq!(program.run(&[&given], Contraction::Separate), own);
        }
    }

    #[test]
    fn a_rotation_is_made_of_its_angles() {
        let (h, t) = (0.6f64, 0.8f64);
        // Rz(α) Ry(β) Rz(γ) with β alone turns z towards x.
        let m = recomposed([[1.0, 0.0], [h, t], [1.0, 0.0]]);
        assert_eq!([m[6], m[7], m[8]], [t, 0.0, h]);
    }
}
