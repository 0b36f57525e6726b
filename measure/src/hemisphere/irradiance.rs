//! How well bases hold the irradiance of a surface: the integral over the upper hemisphere of the squared error, the measure
//! of Habel and Wimmer 2010 (equation 16), over seeded random irradiances of four kinds; their Figure 3 over ten thousand.

use super::bases::{Basis, CUBE, H, HALF_LIFE, HSH, SH, ZERNIKE};
use super::cost::{self, Evaluation};
use super::grid::{Node, frames, hemisphere, seen, sphere};
use super::matrix::Matrix;
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use zonal_codegen::environment::harmonics::{basis, cosine_lobe};
use zonal_codegen::environment::map::Map;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::Random;

/// How many signals of each kind are drawn for the ranking.
pub const SIGNALS: usize = 3000;
/// How many signals are drawn for Figure 3, as in the paper; a quarter of each kind.
pub const FIGURE_3: usize = 10_000;
/// The kinds of irradiance.
pub const KINDS: [&str; 4] = ["sun and sky", "three lights", "upper lobes", "noise"];
/// What each kind is.
pub const KINDS_IN_WORDS: [&str; 4] = [
    "a sun of irradiance 1 anywhere above the horizon, and a sky of irradiance s (0.75 + 0.25 n_z), s from 0.2 to 1",
    "three lights anywhere on the sphere, their irradiances exponentially distributed",
    "six lobes max(0, ω·d)^s of radiance, s from 16 to 128, d anywhere above the horizon, exponentially distributed too",
    "radiance of normally distributed coefficients, those of band l divided by l + 1",
];

/// The bands of radiance that are not lights of no size.
const ORDER: usize = 13;
/// The bands over the whole sphere that a basis may be made from.
const WHOLE: usize = 5;
const RINGS: usize = 24;
/// How many frames each map is seen in.
pub const FRAMES: usize = 48;
const SEED: u64 = 0x1bad;
/// Signals that one task draws.
const TASK: usize = 250;

/// Where a basis' coefficients come from.
#[derive(Clone, Copy)]
enum Source {
    /// Inner products over the upper hemisphere.
    Hemisphere,
    /// The least squared error over the upper hemisphere.
    LeastSquares,
    /// The coefficients of so many bands over the whole sphere, each projected on the basis; its own are taken as they are.
    Sphere(usize),
    /// Those over the whole sphere, of which a reconstruction is made that is not linear.
    Bent(&'static Bent),
}

/// A reconstruction that is not linear.
struct Bent {
    /// How many numbers it holds.
    count: usize,
    /// They, of the coefficients over the whole sphere.
    held: fn(&[f64]) -> [f64; 5],
    /// The irradiance by the normal.
    at: fn([f64; 3], &[f64; 5]) -> f64,
}

fn first_four(whole: &[f64]) -> [f64; 5] {
    [whole[0], whole[1], whole[2], whole[3], 0.0]
}

static GEOMERICS: Bent =
    Bent { count: 4, held: first_four, at: |dir, &[a, b, c, d, _]| zonal::sh2::eval_geomerics(dir, &[a, b, c, d]) };
static ZH3: Bent = Bent {
    count: 4,
    held: first_four,
    at: |dir, &[a, b, c, d, _]| zonal::sh2::eval_zh3_hallucinated(dir, &[a, b, c, d]),
};
static ZH3_STORED: Bent = Bent {
    count: 5,
    held: |whole| zonal::sh3::to_zonal_quadratic(&std::array::from_fn(|i| whole[i])),
    at: zonal::sh2::eval_zh3_stored,
};

struct Fit {
    name: &'static str,
    basis: &'static Basis,
    order: usize,
    from: Source,
    evaluation: Code,
}

/// What evaluates a basis.
enum Code {
    /// The kernel of a spec.
    Spec(&'static str),
    /// Zernike's polynomials to a degree.
    Zernike(usize),
    /// The ambient cube.
    Cube,
}

const fn fit(name: &'static str, (basis, order, from): (&'static Basis, usize, Source), evaluation: Code) -> Fit {
    Fit { name, basis, order, from, evaluation }
}

/// What is compared, in the order of docs/MATH.md's ranking, and the kernel that evaluates it.
// Names a family: these evaluate the bases.
static FITS: [Fit; 17] = [
    fit("SH, order 3, least squares", (&SH, 3, Source::LeastSquares), Code::Spec("eval:3")),
    fit("SH, order 3, of the whole sphere", (&SH, 3, Source::Sphere(3)), Code::Spec("eval:3")),
    fit("H6", (&H, 3, Source::Hemisphere), Code::Spec("h6_eval")),
    fit("H6 from SH of order 5", (&H, 3, Source::Sphere(5)), Code::Spec("h6_eval")),
    fit("H6 from SH of order 3", (&H, 3, Source::Sphere(3)), Code::Spec("h6_eval")),
    fit("HSH, order 3", (&HSH, 3, Source::Hemisphere), Code::Spec("hsh_eval:3")),
    fit("Zernike, degrees to 2", (&ZERNIKE, 3, Source::Hemisphere), Code::Zernike(2)),
    fit("H4", (&H, 2, Source::Hemisphere), Code::Spec("h4_eval")),
    fit("SH, order 2, least squares", (&SH, 2, Source::LeastSquares), Code::Spec("eval:2")),
    fit("HSH, order 2", (&HSH, 2, Source::Hemisphere), Code::Spec("hsh_eval:2")),
    fit("SH, order 2, of the whole sphere", (&SH, 2, Source::Sphere(2)), Code::Spec("eval:2")),
    fit("SH, order 2, Geomerics", (&SH, 2, Source::Bent(&GEOMERICS)), Code::Spec("eval_geomerics")),
    fit("SH, order 2, ZH3, guessed", (&SH, 2, Source::Bent(&ZH3)), Code::Spec("eval_zh3")),
    fit("SH, order 2, ZH3, stored", (&SH, 2, Source::Bent(&ZH3_STORED)), Code::Spec("eval_zh3:stored")),
    fit("Zernike, degrees to 1", (&ZERNIKE, 2, Source::Hemisphere), Code::Zernike(1)),
    fit("Half-Life 2", (&HALF_LIFE, 1, Source::Hemisphere), Code::Spec("hl2_eval")),
    fit("Ambient cube, least squares", (&CUBE, 1, Source::LeastSquares), Code::Cube),
];

/// A basis and what it errs by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rank {
    /// The basis.
    pub basis: String,
    /// How many coefficients it has.
    pub coefficients: usize,
    /// The mean squared error over the mean square, for each of [`KINDS`].
    pub errors: [f64; 4],
    /// The mean squared error of Figure 3's signals, of which each has mean square one.
    pub figure_3: f64,
    /// The mean root of that error.
    pub rms: f64,
    /// For each map the mean root of its error in seeded frames, relative to the irradiance's.
    pub maps: Vec<f64>,
    /// What its evaluation costs, where there is a kernel of it.
    pub evaluation: Option<Evaluation>,
}

/// What order 3 leaves out of a map's irradiance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MapError {
    /// The map.
    pub map: String,
    /// The root mean square over the whole sphere, relative to the irradiance's.
    pub rms: f64,
}

/// What order 3 leaves out of the irradiance of each map, by its bands to order 32.
pub fn maps(maps: &[(&str, Map)]) -> Vec<MapError> {
    let error = |(name, map): &(&str, Map)| {
        let bands = map.project(32).irradiance().band_energy();
        let rms = (bands[3..].iter().sum::<f64>() / bands.iter().sum::<f64>()).sqrt();
        MapError { map: (*name).to_owned(), rms: significant(rms) }
    };
    maps.iter().map(error).collect()
}

/// An irradiance: lights of no size and a sum of harmonics.
struct Signal {
    lights: Vec<([f64; 3], f64)>,
    harmonics: Vec<f64>,
}

fn uniform(random: &mut Random) -> f64 {
    0.5 * (random.signed() + 1.0)
}

fn exponential(random: &mut Random) -> f64 {
    -(1.0 - uniform(random)).ln()
}

fn upper(random: &mut Random) -> [f64; 3] {
    let [x, y, z] = random.unit();
    [x, y, z.abs()]
}

impl Signal {
    fn draw(kind: usize, random: &mut Random) -> Self {
        let mut signal = Self { lights: Vec::new(), harmonics: vec![0.0; ORDER * ORDER] };
        match kind {
            0 => {
                signal.lights.push((upper(random), 1.0));
                let sky = 0.2 + 0.8 * uniform(random);
                signal.harmonics[0] = 0.75 * sky * (4.0 * PI).sqrt();
                signal.harmonics[2] = 0.25 * sky * (4.0 * PI / 3.0).sqrt();
            }
            1 => signal.lights = (0..3).map(|_| (random.unit(), exponential(random))).collect(),
            2 => (0..6).for_each(|_| {
                let (axis, size, exponent) = (upper(random), exponential(random), 16.0 + 112.0 * uniform(random));
                signal.add_lobe(axis, size, exponent);
            }),
            _ => {
                for l in 0..ORDER {
                    for c in &mut signal.harmonics[l * l..(l + 1) * (l + 1)] {
                        let (radius, turn) = ((2.0 * exponential(random)).sqrt(), 2.0 * PI * uniform(random));
                        *c = cosine_lobe(l) * radius * turn.cos() / (l + 1) as f64;
                    }
                }
            }
        }
        signal
    }

    fn add_lobe(&mut self, axis: [f64; 3], size: f64, exponent: f64) {
        let mut values = vec![0.0; ORDER * ORDER];
        basis(ORDER, axis, &mut values);
        let mut bands = [0.0; ORDER];
        for (t, weight) in gauss_legendre(24, 0.0, 1.0) {
            let (mut before, mut legendre) = (0.0, 1.0);
            for (l, band) in bands.iter_mut().enumerate() {
                *band += 2.0 * PI * weight * t.powf(exponent) * legendre;
                let l = l as f64;
                (before, legendre) = (legendre, ((2.0 * l + 1.0) * t * legendre - l * before) / (l + 1.0));
            }
        }
        for (l, band) in bands.iter().enumerate() {
            for i in l * l..(l + 1) * (l + 1) {
                self.harmonics[i] += size * cosine_lobe(l) * band * values[i];
            }
        }
    }

    /// Its coefficients over the whole sphere, of the first bands.
    fn whole(&self) -> Vec<f64> {
        let mut sums = self.harmonics[..WHOLE * WHOLE].to_vec();
        let mut values = [0.0; WHOLE * WHOLE];
        for (direction, size) in &self.lights {
            basis(WHOLE, *direction, &mut values);
            for l in 0..WHOLE {
                for i in l * l..(l + 1) * (l + 1) {
                    sums[i] += size * cosine_lobe(l) * values[i];
                }
            }
        }
        sums
    }
}

/// What is the same for all signals.
struct Bench {
    nodes: Vec<Node>,
    /// The harmonics at each node.
    harmonics: Vec<Vec<f64>>,
    fits: Vec<Prepared>,
}

struct Prepared {
    /// The functions at each node, times the node's weight.
    weighted: Matrix,
    gram: Matrix,
    /// From inner products, or from the whole sphere's coefficients.
    map: Matrix,
    from: Source,
}

impl Prepared {
    fn new(fit: &Fit, nodes: &[Node]) -> Self {
        let at: Vec<Vec<f64>> = nodes.iter().map(|(direction, _)| fit.basis.at(fit.order, *direction)).collect();
        let count = at[0].len();
        let weighted = Matrix::from_fn(count, nodes.len(), |i, node| nodes[node].1 * at[node][i]);
        let values = Matrix::from_fn(nodes.len(), count, |node, i| at[node][i]);
        let gram = weighted.times(&values);
        let one = Matrix::identity(count);
        let map = match fit.from {
            Source::Hemisphere | Source::Bent(_) => one,
            Source::LeastSquares => one.over(&gram),
            Source::Sphere(bands) if std::ptr::eq(fit.basis, &SH) => {
                Matrix::from_fn(count, bands * bands, |i, j| f64::from(u8::from(i == j)))
            }
            Source::Sphere(bands) => {
                let harmonics: Vec<Vec<f64>> = nodes.iter().map(|(direction, _)| SH.at(bands, *direction)).collect();
                weighted.times(&Matrix::from_fn(nodes.len(), bands * bands, |node, j| harmonics[node][j]))
            }
        };
        Self { weighted, gram, map, from: fit.from }
    }

    /// The squared error over the hemisphere: ∫ E² − 2 c·b + c·G c, or node by node where it is not linear.
    fn error(&self, nodes: &[Node], values: &[f64], whole: &[f64], square: f64) -> f64 {
        if let Source::Bent(bent) = self.from {
            let held = (bent.held)(whole);
            let error = |((dir, weight), value): (&Node, &f64)| weight * ((bent.at)(*dir, &held) - value).powi(2);
            return nodes.iter().zip(values).map(error).sum();
        }
        let products = self.weighted.apply(values);
        let c = match self.from {
            Source::Sphere(_) => self.map.apply(&whole[..self.map.columns()]),
            _ => self.map.apply(&products),
        };
        let twice: f64 = c.iter().zip(&products).map(|(c, b)| 2.0 * c * b).sum();
        let own: f64 = c.iter().zip(self.gram.apply(&c)).map(|(c, g)| c * g).sum();
        (square - twice + own).max(0.0)
    }
}

impl Bench {
    fn new() -> Self {
        let nodes = hemisphere(RINGS);
        let harmonics = nodes.iter().map(|(direction, _)| SH.at(ORDER, *direction)).collect();
        let fits = FITS.iter().map(|fit| Prepared::new(fit, &nodes)).collect();
        Self { nodes, harmonics, fits }
    }

    /// Of one signal its square and the squared error of each basis.
    fn errors(&self, signal: &Signal) -> (f64, Vec<f64>) {
        let used = signal.harmonics.iter().rposition(|c| *c != 0.0).map_or(0, |last| last + 1);
        let value = |(node, harmonics): (&Node, &Vec<f64>)| {
            let lit: f64 = signal.lights.iter().map(|(direction, size)| size * dot(direction, &node.0).max(0.0)).sum();
            lit + signal.harmonics[..used].iter().zip(harmonics).map(|(c, y)| c * y).sum::<f64>()
        };
        let values: Vec<f64> = self.nodes.iter().zip(&self.harmonics).map(value).collect();
        let square = self.nodes.iter().zip(&values).map(|(node, value)| node.1 * value * value).sum();
        let whole = signal.whole();
        (square, self.fits.iter().map(|fit| fit.error(&self.nodes, &values, &whole, square)).collect())
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The sums over the signals of a task: of squares, of errors, of errors over squares and of their roots.
struct Sums {
    square: f64,
    errors: Vec<[f64; 3]>,
}

fn sums(bench: &Bench, kind: usize, seed: u64, count: usize) -> Sums {
    let mut random = Random::new(seed);
    let mut sums = Sums { square: 0.0, errors: vec![[0.0; 3]; FITS.len()] };
    for _ in 0..count {
        let (square, errors) = bench.errors(&Signal::draw(kind, &mut random));
        sums.square += square;
        for (sum, error) in sums.errors.iter_mut().zip(errors) {
            let relative = error / square;
            *sum = [sum[0] + error, sum[1] + relative, sum[2] + relative.sqrt()];
        }
    }
    sums
}

/// The mean root of the error of each basis over frames of a map, relative to its irradiance in the frame.
fn of_map(bench: &Bench, name: &str, map: &Map) -> Vec<f64> {
    let luminance = |[r, g, b]: &[f64; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let light: Vec<f64> = map.project(ORDER).irradiance().coefficients.iter().map(luminance).collect();
    let nodes = sphere(ORDER + 1);
    let seed = name.bytes().fold(SEED, |seed, byte| 31 * seed + u64::from(byte));
    let mut sums = vec![0.0; FITS.len()];
    for frame in frames(seed, FRAMES) {
        let signal = Signal { lights: vec![], harmonics: seen(&nodes, &light, &frame) };
        let (square, errors) = bench.errors(&signal);
        sums.iter_mut().zip(errors).for_each(|(sum, error)| *sum += (error / square).sqrt() / FRAMES as f64);
    }
    sums
}

/// Every basis.
pub fn measure(progress: &dyn Progress, maps: &[(&str, Map)]) -> Vec<Rank> {
    let bench = Bench::new();
    let lights = each(progress, "irradiance of maps", maps, |(name, map)| of_map(&bench, name, map));
    // The ranking's signals of each kind, then those of Figure 3, with seeds of their own.
    let parts = |count: usize, first: u64| {
        (0..KINDS.len())
            .flat_map(move |kind| (0..count / TASK).map(move |i| (kind, first + 1000 * kind as u64 + i as u64)))
    };
    let tasks: Vec<(usize, u64)> = parts(SIGNALS, SEED).chain(parts(FIGURE_3 / 4, SEED << 16)).collect();
    let found = each(progress, "irradiance bases", &tasks, |(kind, seed)| sums(&bench, *kind, *seed, TASK));
    let (ranking, figure) = found.split_at(KINDS.len() * SIGNALS / TASK);
    let rank = |(place, fit): (usize, &Fit)| {
        let error = |kind: usize| {
            let own = &ranking[kind * SIGNALS / TASK..(kind + 1) * SIGNALS / TASK];
            let sum: f64 = own.iter().map(|sums| sums.errors[place][0]).sum();
            significant(sum / own.iter().map(|sums| sums.square).sum::<f64>())
        };
        let mean = |part: usize| {
            significant(figure.iter().map(|sums| sums.errors[place][part]).sum::<f64>() / FIGURE_3 as f64)
        };
        Rank {
            basis: fit.name.to_owned(),
            coefficients: match fit.from {
                Source::Bent(bent) => bent.count,
                _ => (fit.basis.count)(fit.order),
            },
            errors: std::array::from_fn(error),
            figure_3: mean(1),
            rms: mean(2),
            maps: lights.iter().map(|errors| significant(errors[place])).collect(),
            evaluation: match fit.evaluation {
                Code::Spec(spec) => cost::of_spec(spec),
                Code::Zernike(degree) => Some(cost::of_zernike(degree)),
                Code::Cube => Some(cost::of_cube()),
            },
        }
    };
    FITS.iter().enumerate().map(rank).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_signal_within_a_basis_is_held_exactly() {
        let bench = Bench::new();
        let mut signal = Signal { lights: vec![], harmonics: vec![0.0; ORDER * ORDER] };
        signal.harmonics[..4].copy_from_slice(&[3.0, 0.5, -1.0, 0.25]);
        let (square, errors) = bench.errors(&signal);
        for (fit, error) in FITS.iter().zip(errors).filter(|(fit, _)| !matches!(fit.from, Source::Bent(_))) {
            // A linear function is in every polynomial basis with a constant; the others bend towards the horizon.
            let polynomial = fit.basis.name == H.name || fit.basis.name == SH.name;
            assert_eq!(error < 1e-12 * square, polynomial, "{}: {error}", fit.name);
        }
    }

    #[test]
    fn a_light_has_the_cosine_s_bands() {
        let light = Signal { lights: vec![([0.6, 0.0, 0.8], 2.0)], harmonics: vec![0.0; ORDER * ORDER] };
        let whole = light.whole();
        let band = |l: usize| whole[l * l..(l + 1) * (l + 1)].iter().map(|c| c * c).sum::<f64>();
        // ∫ (2 max(0, cos))² over the sphere is 8π/3, of which bands 0 to 2 hold 1/4 + 1/3 + 5/64 of 4 · 2π … in A_l² (2l+1)/4π.
        for l in 0..WHOLE {
            let wanted = 4.0 * cosine_lobe(l).powi(2) * (2 * l + 1) as f64 / (4.0 * PI);
            assert!((band(l) - wanted).abs() < 1e-12, "band {l}");
        }
        assert!((0..WHOLE).map(band).sum::<f64>() < 8.0 * PI / 3.0);
    }
}
