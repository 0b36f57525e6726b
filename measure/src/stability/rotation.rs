//! The exact rotation to order 64 in f32 and f64, band by band, against products with the exact J in pairs of doubles; and
//! the recursion of Ivanic and Ruedenberg beside it. The steps from a quaternion are taken apart, so that it shows which
//! of them costs accuracy: the bands themselves, the multiples of the angles, or the set-up.

use crate::numbers::Twin;
use crate::stability::recursion::Matrices;
use crate::stability::truth::{Pair, Rotation, Swap, distance, norm, sampled};
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
// Names a family: its loop is what is measured.
use zonal_codegen::families::loops::rotate_loop;
use zonal_codegen::families::parts::bands::{y_band, z_band};
use zonal_codegen::families::parts::phases::{YPhases, phases};
use zonal_codegen::ir::eval::{Contraction, Number, Program};
use zonal_codegen::ir::kernel::Domain;
use zonal_codegen::ir::kernel::{Builder, Param, Shape};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::ir::program::{LoopKernel, Stmt};
use zonal_codegen::promise::samples::Random;

/// The order of the loop.
pub const ORDER: usize = 64;
/// The highest band of straight lines.
pub const HIGHEST_STRAIGHT: usize = 16;
/// How many random rotations are tried besides the extremes.
const ROTATIONS: usize = 5;

/// How a rotation is made, and what of it is made exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The loop, from a quaternion.
    Quaternion,
    /// The loop, its set-up in f64 and the multiples of the angles too.
    WideSetup,
    /// The loop, its set-up and multiples in f64, the quaternion normalised in f64 first.
    Normalised,
    /// The loop, from correctly rounded (cos, sin) of the angles.
    Pairs,
    /// The loop, from correctly rounded multiples.
    Multiples,
    /// Straight lines by blocks of J, from correctly rounded multiples.
    Straight,
    /// The recursion of Ivanic and Ruedenberg, from a correctly rounded matrix.
    Recursion,
}

impl Way {
    /// All of them, with their names.
    pub const ALL: [(Self, &str); 7] = [
        (Self::Quaternion, "loop, from a quaternion"),
        (Self::WideSetup, "loop, set-up and multiples in f64"),
        (Self::Normalised, "loop, normalised, set up and multiplied in f64"),
        (Self::Pairs, "loop, cosines and sines given"),
        (Self::Multiples, "loop, multiples given"),
        (Self::Straight, "straight lines, multiples given"),
        (Self::Recursion, "Ivanic and Ruedenberg, matrix given"),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(way, _)| *way == self).map_or("", |(_, name)| name)
    }
}

/// The error over the bands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Which of [`Way::ALL`].
    pub way: String,
    /// The number type.
    pub number: String,
    /// The bands that were compared.
    pub bands: Vec<usize>,
    /// The largest error of each for a band of norm one.
    pub errors: Vec<f64>,
}

impl Curve {
    /// The largest error of the bands of an order.
    pub fn at_order(&self, order: usize) -> Option<f64> {
        let last = self.bands.last().copied()?;
        let below = self.bands.iter().zip(&self.errors).filter(|(l, _)| **l < order).map(|(_, error)| *error);
        (order <= last + 1).then(|| below.fold(0.0, f64::max))
    }
}

/// Rotations as quaternions of unit length but for rounding: the identity, turns by 180 and 90 degrees, by tiny angles, with
/// a tiny β or π − β, then random ones.
pub fn quaternions() -> Vec<[f64; 4]> {
    let half = 0.5f64.sqrt();
    let mut all = vec![
        [0.0, 0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, half, 0.0, half],
        [5e-8, 0.0, 0.6, 0.8],
        [0.6, 0.8, 1e-4, 0.0],
    ];
    let mut random = Random::new(0x0707);
    all.extend((0..ROTATIONS).map(|_| random.unit::<4>()));
    all.into_iter().map(|q| q.map(|x| x / norm(q))).collect()
}

/// A band of norm one, every number an f32.
pub fn signal(random: &mut Random, l: usize) -> Vec<f64> {
    let values: Vec<f64> = (0..2 * l + 1).map(|_| random.signed()).collect();
    let size = norm(values.iter().copied());
    values.into_iter().map(|x| f64::from((x / size) as f32)).collect()
}

/// The loop from the multiples of the angles: its own set-up left out, two arrays in its place.
fn from_multiples(mut kernel: LoopKernel, order: usize) -> LoopKernel {
    let is = |statement: &Stmt, wanted: &str| matches!(statement, Stmt::Array(name, ..) if *name == wanted);
    let rest = kernel.body.iter().position(|statement| is(statement, "swapped")).expect("the loop swaps");
    let result = kernel.body.iter().position(|statement| is(statement, kernel.output)).expect("the loop has a result");
    kernel.body = [&kernel.body[result..=result], &kernel.body[rest..]].concat();
    let given = |name| Param::new(name, Shape::Array(3 * order), Domain::Phases, "");
    kernel.params = [vec![given("phase_cos"), given("phase_sin")], kernel.params.split_off(1)].concat();
    kernel
}

/// The multiples as the loop keeps them: of −β, α and γ, each from 0.
fn arrays<T: Number>([alpha, beta, gamma]: &[Vec<Pair>; 3], order: usize) -> [Vec<T>; 2] {
    let mut all = [Vec::new(), Vec::new()];
    for (angle, sign) in [(beta, -1.0), (alpha, 1.0), (gamma, 1.0)] {
        for [cos, sin] in &angle[..order] {
            all[0].push(T::from_f64(cos.to_f64()));
            all[1].push(T::from_f64(sign * sin.to_f64()));
        }
    }
    all
}

/// The multiples by products in `T` from pairs in `T`, as the loop makes them.
fn by_products<T: Number>(pairs: [[T; 2]; 3], order: usize) -> [Vec<T>; 2] {
    let mut all = [Vec::new(), Vec::new()];
    for [cos, sin] in pairs {
        let (mut c, mut s) = (T::ONE, T::ZERO);
        for m in 0..order {
            all[0].push(c);
            all[1].push(s);
            (c, s) = if m == 0 { (cos, sin) } else { (c * cos - s * sin, s * cos + c * sin) };
        }
    }
    all
}

/// −β, α and γ of a quaternion as the loop's own set-up makes them.
fn setup<T: Number>(q: [T; 4]) -> [[T; 2]; 3] {
    let [x, y, z, w] = [q[0], q[1] + T::TINY, q[2], q[3] + T::TINY];
    let (a, b) = (w * w + z * z, x * x + y * y);
    let product = a * b;
    let scale = T::ONE / product.root();
    let (wu, zu) = (w * scale, z * scale);
    let two = T::ONE + T::ONE;
    [[a - b, -(two * product * scale)], [wu * y + zu * x, zu * y - wu * x], [wu * y - zu * x, zu * y + wu * x]]
}

/// A band in straight lines from the multiples of its angles.
fn straight(l: usize) -> Listing {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pairs(3 * l + 1), Domain::Phases, "");
    let c = builder.param("c", Shape::Array(2 * l + 1), Domain::Signal, "");
    let all = phases(&cs);
    let (last, g) = (all[3 * l], &mut builder.graph);
    let beta = YPhases { multiples: all[l..2 * l].to_vec(), half_square: last.cos, product: last.sin };
    let band = z_band(g, &c, &all[2 * l..3 * l]);
    let band = y_band(g, &band, &beta);
    let out = z_band(g, &band, &all[..l]);
    Listing::new(&builder.finish(out, Shape::Array(2 * l + 1), ""))
}

/// What straight lines take: the multiples of α, β, γ, then sin²β / 2 and sin β cos β.
fn straight_input<T: Number>([alpha, beta, gamma]: &[Vec<Pair>; 3], l: usize) -> Vec<T> {
    let flat = |all: &Vec<Pair>| all[1..=l].iter().flatten().copied().collect::<Vec<Twin>>();
    let [cos, sin] = beta[1];
    let half = Twin::from_f64(0.5);
    let last = vec![half * sin * sin, sin * cos];
    [flat(alpha), flat(beta), flat(gamma), last].concat().into_iter().map(|x| T::from_f64(x.to_f64())).collect()
}

/// What every way shares: the truth, the loop with its tables rounded, and without its set-up; straight lines.
struct Bench<'a, T> {
    swaps: &'a [Swap],
    whole: Program<T>,
    given: Program<T>,
    straight: Vec<Program<T>>,
}

impl<'a, T: Number> Bench<'a, T> {
    fn new(swaps: &'a [Swap], kernel: &LoopKernel, given: &LoopKernel, straight: &[Listing]) -> Self {
        let (whole, given) =
            rayon::join(|| Program::new(&Listing::from(kernel)), || Program::new(&Listing::from(given)));
        Self { swaps, whole, given, straight: straight.iter().map(Program::new).collect() }
    }
}

fn to<T: Number>(values: &[f64]) -> Vec<T> {
    values.iter().map(|x| T::from_f64(*x)).collect()
}

fn curve<T: Number>(bench: &Bench<'_, T>, way: Way, number: &str) -> Curve {
    let highest = if way == Way::Straight { HIGHEST_STRAIGHT } else { ORDER - 1 };
    let swaps: Vec<&Swap> = bench.swaps.iter().filter(|swap| swap.l() <= highest).collect();
    let mut random = Random::new(0x51);
    let mut errors = vec![0.0f64; swaps.len()];
    for q in quaternions() {
        let rounded = q.map(T::from_f64);
        let given = rounded.map(T::to_f64);
        let exact = Rotation::of_quaternion(given, ORDER);
        let mut c = vec![0.0; ORDER * ORDER];
        (0..ORDER).for_each(|l| c[l * l..(l + 1) * (l + 1)].copy_from_slice(&signal(&mut random, l)));
        let narrow: Vec<T> = to(&c);
        let through = |arrays: [Vec<T>; 2]| bench.given.run(&[&arrays[0], &arrays[1], &narrow], Contraction::Separate);
        let whole: Vec<T> = match way {
            Way::Quaternion => bench.whole.run(&[&rounded, &narrow], Contraction::Separate),
            Way::WideSetup | Way::Normalised => {
                let length = if way == Way::Normalised { norm(given) } else { 1.0 };
                let wide = by_products(setup(given.map(|x| x / length)), ORDER);
                through(wide.map(|list| to(&list)))
            }
            Way::Pairs => {
                let pair = |angle: usize| exact.angles[angle][1].map(|x| T::from_f64(x.to_f64()));
                let [cos, sin] = pair(1);
                through(by_products([[cos, -sin], pair(0), pair(2)], ORDER))
            }
            Way::Multiples => through(arrays(&exact.angles, ORDER)),
            Way::Recursion => Matrices::<T>::new(given, highest).apply(&narrow),
            Way::Straight => Vec::new(),
        };
        for (place, (swap, error)) in swaps.iter().zip(&mut errors).enumerate() {
            let l = swap.l();
            let band = l * l..(l + 1) * (l + 1);
            let signal: Vec<Twin> = c[band.clone()].iter().map(|x| Twin::from_f64(*x)).collect();
            let want = exact.apply(swap, &signal);
            let away = match way {
                Way::Straight => {
                    let inputs = straight_input::<T>(&exact.angles, l);
                    distance(&bench.straight[place].run(&[&inputs, &narrow[band]], Contraction::Separate), &want)
                }
                _ => distance(&whole[band], &want),
            };
            *error = error.max(away);
        }
    }
    Curve {
        way: way.name().to_owned(),
        number: number.to_owned(),
        bands: swaps.iter().map(|swap| swap.l()).collect(),
        errors: errors.into_iter().map(significant).collect(),
    }
}

/// Every way in f32 and f64.
pub fn measure(progress: &dyn Progress) -> Vec<Curve> {
    let bands = sampled(1..=ORDER - 1);
    let swaps = each(progress, "exact rotation", &bands, |l| Swap::new(*l));
    let up_to: Vec<usize> = bands.iter().copied().filter(|l| *l <= HIGHEST_STRAIGHT).collect();
    let straight = each(progress, "straight lines", &up_to, |l| straight(*l));
    let kernel = rotate_loop(ORDER);
    let given = from_multiples(kernel.clone(), ORDER);
    let tasks: Vec<Way> = Way::ALL.iter().map(|(way, _)| *way).collect();
    let narrow = Bench::<f32>::new(&swaps, &kernel, &given, &straight);
    let narrow = each(progress, "rotations in f32", &tasks, |way| curve(&narrow, *way, "f32"));
    let tasks: Vec<Way> = tasks.into_iter().filter(|way| !matches!(way, Way::WideSetup | Way::Normalised)).collect();
    let wide = Bench::<f64>::new(&swaps, &kernel, &given, &straight);
    let wide = each(progress, "rotations in f64", &tasks, |way| curve(&wide, *way, "f64"));
    [narrow, wide].concat()
}
