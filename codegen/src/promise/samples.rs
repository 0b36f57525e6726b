//! Inputs to try a kernel on: seeded, the extremes among them. They use no transcendental function, so that they are
//! the same to the last bit on every machine, and every number is an f32.

use crate::ir::eval::{Contraction, Program};
use crate::ir::kernel::Domain;
use crate::ir::kernel::Param;
use crate::ir::listing::Listing;

/// A small generator of numbers (splitmix64).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in [−1, 1).
    pub fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A vector of unit length, by rejection.
    pub fn unit<const N: usize>(&mut self) -> [f64; N] {
        loop {
            let v: [f64; N] = std::array::from_fn(|_| self.signed());
            let square: f64 = v.iter().map(|x| x * x).sum();
            if square > 0.01 && square < 1.0 {
                return v.map(|x| x / square.sqrt());
            }
        }
    }
}

fn normalised<const N: usize>(v: [f64; N]) -> [f64; N] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

/// Directions at and near what is special: poles, axes, the horizon.
const DIRECTIONS: [[f64; 3]; 12] = [
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [1e-4, 0.0, 1.0],
    [0.0, 1e-4, -1.0],
    [1e-8, 1e-8, 1.0],
    [1e-20, 0.0, 1.0],
    [1.0, 1.0, 1e-8],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, -1.0],
];

/// Rotations at and near what is special, as quaternions (x, y, z, w): identity, half and quarter turns, tiny angles.
const QUATERNIONS: [[f64; 4]; 14] = [
    [0.0, 0.0, 0.0, 1.0],
    [0.0, 0.0, 0.0, -1.0],
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [1.0, 0.0, 0.0, 1.0],
    [0.0, 1.0, 0.0, 1.0],
    [0.0, 0.0, 1.0, 1.0],
    [1e-4, 0.0, 0.0, 1.0],
    [0.0, 5e-8, 0.0, 1.0],
    [1e-9, 2e-9, 0.6, 0.8],
    [0.6, 0.8, 0.0, 1e-8],
    [1e-20, 0.0, 0.0, 1.0],
    [0.6, 0.8, 1e-20, 1e-20],
];

fn direction(random: &mut Random, i: usize) -> [f64; 3] {
    DIRECTIONS.get(i).map_or_else(|| random.unit(), |d| normalised(*d))
}

fn quaternion(random: &mut Random, i: usize) -> [f64; 4] {
    QUATERNIONS.get(i).map_or_else(|| random.unit(), |q| normalised(*q))
}

/// The rotation matrix of a unit quaternion (x, y, z, w), by columns.
pub fn matrix_of([x, y, z, w]: [f64; 4]) -> [f64; 9] {
    [
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y + w * z),
        2.0 * (x * z - w * y),
        2.0 * (x * y - w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z + w * x),
        2.0 * (x * z + w * y),
        2.0 * (y * z - w * x),
        1.0 - 2.0 * (x * x + y * y),
    ]
}

fn pairs(random: &mut Random, i: usize, count: usize) -> Vec<f64> {
    const PAIRS: [[f64; 2]; 5] = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [1.0, 1e-8], [-1.0, 1e-4]];
    (0..count).flat_map(|_| PAIRS.get(i).map_or_else(|| random.unit(), |p| normalised(*p))).collect()
}

/// A signal: every whole band of unit norm if there are n² numbers, the whole of unit norm otherwise.
fn signal(random: &mut Random, count: usize) -> Vec<f64> {
    let mut values: Vec<f64> = (0..count).map(|_| random.signed()).collect();
    let order = count.isqrt();
    let ranges: Vec<_> = match order * order == count {
        true => (0..order).map(|l| l * l..(l + 1) * (l + 1)).collect(),
        false => std::iter::once(0..count).collect(),
    };
    for range in ranges {
        let norm = values[range.clone()].iter().map(|x| x * x).sum::<f64>().sqrt();
        values[range].iter_mut().for_each(|x| *x /= norm);
    }
    values
}

/// What a parameter may be, ready to be drawn from.
enum Source {
    /// The domain itself.
    Of(Domain, usize),
    /// What another kernel makes of its parameters.
    Made(Box<Program<f64>>, Vec<Source>),
}

impl Source {
    /// The source of a domain, of which angles are at most `max_angle`.
    fn new(domain: Domain, len: usize, max_angle: Option<f64>) -> Self {
        let domain = max_angle.map_or(domain, |angle| domain.within(angle));
        match domain {
            Domain::Made(made) => {
                let kernel = (made.kernel)(made.order);
                let params =
                    kernel.params.iter().map(|param| Self::new(param.domain, param.shape.len(), made.max_angle));
                Self::Made(Box::new(Program::new(&Listing::new(&kernel))), params.collect())
            }
            _ => Self::Of(domain, len),
        }
    }

    /// Input number `i`.
    fn draw(&self, random: &mut Random, i: usize) -> Vec<f64> {
        match self {
            Self::Of(domain, len) => draw(*domain, *len, random, i),
            Self::Made(program, sources) => {
                let inputs: Vec<Vec<f64>> = sources.iter().map(|source| source.draw(random, i)).collect();
                let inputs: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
                program.run(&inputs, Contraction::Separate)
            }
        }
    }
}

/// Input number `i` of a domain, extremes first.
fn draw(domain: Domain, len: usize, random: &mut Random, i: usize) -> Vec<f64> {
    match domain {
        Domain::Signal | Domain::Grey => signal(random, len),
        Domain::Direction | Domain::Normal => direction(random, i).to_vec(),
        Domain::MeanNormal(least) => {
            let length = match i % 4 {
                0 | 1 => 1.0,
                2 => least,
                _ => least + (1.0 - least) * random.signed().abs(),
            };
            direction(random, i).map(|x| x * length).to_vec()
        }
        Domain::Hemisphere => {
            let [x, y, z] = direction(random, i);
            vec![x, y, z.abs()]
        }
        Domain::Tilt(most) => tilted(random, i, most).to_vec(),
        Domain::Quaternion => quaternion(random, i).to_vec(),
        Domain::SmallTurn(most) | Domain::BoundedTurn(most) => small_rotation(random, i, most).to_vec(),
        Domain::Rotation => matrix_of(quaternion(random, i)).to_vec(),
        Domain::Phases => pairs(random, i, len / 2),
        Domain::Angle(most) => {
            const FRACTIONS: [f64; 6] = [0.0, 1.0, -1.0, 1e-7, 1e-20, -0.5];
            vec![FRACTIONS.get(i).copied().unwrap_or_else(|| random.signed()) * most]
        }
        Domain::HalfSine(most) => {
            // The half angle's sine: at most a third of a per cent below half the angle at 25 degrees.
            let half = most / 2.0;
            vec![random.signed().abs() * (half - half * half * half / 6.0)]
        }
        Domain::Between(least, most) => vec![between(random, i, least, most)],
        // Errors may be largest on either side of where another way is taken.
        Domain::Bent(_, bend, _) if i % 4 == 3 => vec![bend * (1.0 + random.signed() / (1u64 << (i % 16)) as f64)],
        Domain::Bent(least, _, most) => vec![between(random, i, least, most)],
        Domain::Zonal | Domain::SetUp => (0..len).map(|_| random.signed()).collect(),
        // What is found of nothing comes first.
        Domain::Coefficients if i == 0 => vec![0.0; len],
        Domain::Coefficients => signal(random, len),
        Domain::Made(_) => unreachable!("what is made has a source of its own"),
    }
}

/// A number between two: both ends, then every second one evenly, and between these of every size down to 2^-40 of the
/// range, on both sides of zero where the range has both.
fn between(random: &mut Random, i: usize, least: f64, most: f64) -> f64 {
    let both = least == -most;
    match i {
        0 => return most,
        1 => return least,
        2 => return (least + most) / 2.0,
        _ => {}
    }
    let even = least + (most - least) * (1.0 + random.signed()) / 2.0;
    let fraction = (3.0 + random.signed()) / 4.0 / (1u64 << (random.bits() % 40)) as f64;
    match (i % 2, both) {
        (0, _) => even,
        (_, false) => least + (most - least) * fraction,
        (_, true) => most * fraction.copysign(random.signed()),
    }
}

/// `count` sets of inputs for a kernel's parameters, extremes first, of the domains that they name, of which angles are
/// at most `max_angle` in radians. Each input is one list of numbers a parameter, in flat order, every number an f32.
pub fn inputs(params: &[Param], seed: u64, count: usize, max_angle: Option<f64>) -> Vec<Vec<Vec<f64>>> {
    let mut random = Random::new(seed);
    let sources: Vec<Source> =
        params.iter().map(|param| Source::new(param.domain, param.shape.len(), max_angle)).collect();
    let narrow = |list: Vec<f64>| list.into_iter().map(|x| f64::from(x as f32)).collect();
    (0..count).map(|i| sources.iter().map(|source| narrow(source.draw(&mut random, i))).collect()).collect()
}

/// A unit quaternion whose y angle is at most `max_angle`; the extremes are those of [`tilted`].
fn small_rotation(random: &mut Random, i: usize, max_angle: f64) -> [f64; 4] {
    let [sin, _, cos] = tilted_by(random, i, max_angle);
    // The half angle's cosine and sine from the angle's.
    let cosine = ((1.0 + cos) / 2.0).sqrt();
    let sine = sin / (2.0 * cosine);
    let ([a, b], [c, d]) = (random.unit::<2>(), random.unit::<2>());
    [sine * a, sine * b, cosine * c, cosine * d]
}

/// A unit vector within `max_angle` of z; the extremes are z itself, tiny tilts and the largest.
fn tilted(random: &mut Random, i: usize, max_angle: f64) -> [f64; 3] {
    let [cos, sin] = random.unit::<2>();
    let [x, _, z] = tilted_by(random, i, max_angle);
    [x * cos, x * sin, z]
}

/// A unit vector in the plane of x and z within `max_angle` of z; the extremes are those of [`tilted`].
fn tilted_by(random: &mut Random, i: usize, max_angle: f64) -> [f64; 3] {
    const FRACTIONS: [f64; 5] = [0.0, 1e-8, 1.0, 1e-4, 1e-20];
    // The tangent of the tilt stays below that of the largest: no trigonometry, the same bits everywhere.
    let fraction = FRACTIONS.get(i).copied().unwrap_or_else(|| random.signed());
    let (half, square) = (max_angle / 2.0, max_angle * max_angle / 4.0);
    // Half-angle tangent from its series, two terms: 1e-3 below the angle at 45 degrees.
    let t = fraction * half * (1.0 + square / 3.0).min(1.1);
    normalised([2.0 * t, 0.0, 1.0 - t * t])
}
