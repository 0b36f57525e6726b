//! What turning means, without any kernel that turns: which rotation a kernel's parameters say, by their domains, and what
//! becomes of a signal by definition, f(R⁻¹ω) projected on the basis by quadrature over the sphere.

use crate::{Runner, norm, quaternion_product};
use zonal_codegen::families::Spec;
use zonal_codegen::families::basis::BASIS;
use zonal_codegen::families::family::Job;
use zonal_codegen::ir::kernel::{Domain, Param};
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::promise::samples::{self, matrix_of};

/// A matrix by columns.
pub type Matrix = [f64; 9];

/// A vector of so many numbers.
fn fixed<const N: usize>(list: &[f64]) -> [f64; N] {
    list.try_into().unwrap_or_else(|_| panic!("{} numbers, not {N}", list.len()))
}

/// Returns the scalar product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

fn unit(list: &[f64]) -> Vec<f64> {
    list.iter().map(|x| x / norm(list)).collect()
}

/// Returns the matrix times a vector.
pub fn apply(m: &Matrix, v: &[f64]) -> [f64; 3] {
    std::array::from_fn(|row| (0..3).map(|column| m[3 * column + row] * v[column]).sum())
}

/// Returns the product of two matrices.
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let columns: Vec<f64> = b.chunks(3).flat_map(|column| apply(a, column)).collect();
    fixed(&columns)
}

/// Returns the transposed matrix.
pub fn transposed(m: &Matrix) -> Matrix {
    std::array::from_fn(|i| m[3 * (i % 3) + i / 3])
}

/// The rotation about z, or about y, by the angle of a cosine and a sine.
fn about_z(cs: &[f64]) -> Matrix {
    [cs[0], cs[1], 0.0, -cs[1], cs[0], 0.0, 0.0, 0.0, 1.0]
}

fn about_y(cs: &[f64]) -> Matrix {
    [cs[0], 0.0, -cs[1], 0.0, 1.0, 0.0, cs[1], 0.0, cs[0]]
}

/// The shortest rotation of z to a normal, which is not −z.
fn shortest(n: &[f64]) -> Matrix {
    matrix_of(fixed(&unit(&[-n[1], n[0], 0.0, 1.0 + n[2]])))
}

/// Any rotation of z to a direction.
fn frame(z: [f64; 3]) -> Matrix {
    let away = if z[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let x: [f64; 3] = fixed(&unit(&cross(away, z)));
    fixed(&[x, cross(z, x), z].concat())
}

/// Returns the axes x, y and z of a frame whose z is a direction.
///
/// # Panics
///
/// If the direction does not have three numbers.
pub fn frame_of(z: &[f64]) -> [[f64; 3]; 3] {
    let matrix = frame(fixed(z));
    std::array::from_fn(|axis| fixed(&matrix[3 * axis..3 * axis + 3]))
}

/// What parameters say of a rotation.
#[derive(Clone, Copy, Debug)]
pub enum Turn {
    /// All of it.
    Whole(Matrix),
    /// Where z goes; what the rotation does besides is left open.
    Axis(Matrix),
}

/// A parameter that is no signal, or those of the set-up that makes it: its domain and its numbers.
pub type Origin = (Domain, Vec<f64>);

/// Returns the rotation that parameters say, by their domains and the family's jobs; none where only the family's name does.
pub fn turn(spec: &Spec, origins: &[Origin]) -> Option<Turn> {
    let does = |job| (spec.family.does)(spec.order, spec.rgb).iter().any(|does| does.job == job && !does.otherwise);
    let whole = match origins {
        [(Domain::Quaternion | Domain::SmallTurn(_) | Domain::BoundedTurn(_), q), ..] => matrix_of(fixed(q)),
        [(Domain::Rotation, m)] => fixed(m),
        [(Domain::Hemisphere | Domain::Tilt(_), n)] => shortest(n),
        [(Domain::Normal | Domain::Direction, n)] => return Some(Turn::Axis(frame(fixed(n)))),
        [(Domain::Angle(_), beta)] if does(Job::Y) => about_y(&[beta[0].cos(), beta[0].sin()]),
        [(Domain::Phases, cs)] if does(Job::Y) => about_y(cs),
        [(Domain::Phases, cs)] if does(Job::Zyz) => {
            product(&about_z(&cs[..2]), &product(&about_y(&cs[2..4]), &about_z(&cs[4..])))
        }
        [(Domain::Phases, cs), (Domain::Angle(_), beta)] if does(Job::Zyz) => {
            let y = about_y(&[beta[0].cos(), beta[0].sin()]);
            product(&about_z(&cs[..2]), &product(&y, &about_z(&cs[2..])))
        }
        _ => return None,
    };
    Some(Turn::Whole(whole))
}

/// Returns the parameter of the inverse rotation, by its domain; none where the domain does not say it.
pub fn inverse((domain, list): &Origin) -> Option<Origin> {
    let inverse = match domain {
        Domain::Quaternion | Domain::SmallTurn(_) | Domain::BoundedTurn(_) => {
            vec![-list[0], -list[1], -list[2], list[3]]
        }
        Domain::Rotation => transposed(&fixed(list)).to_vec(),
        Domain::Hemisphere | Domain::Tilt(_) => vec![-list[0], -list[1], list[2]],
        // Of several rotations about axes the last is undone first.
        Domain::Phases => list.chunks(2).rev().flat_map(|pair| [pair[0], -pair[1]]).collect(),
        Domain::Angle(_) => vec![-list[0]],
        Domain::HalfSine(_) | Domain::Grey => list.clone(),
        Domain::Between(..) | Domain::Bent(..) | Domain::Zonal | Domain::Coefficients => return None,
        Domain::Signal
        | Domain::Direction
        | Domain::Normal
        | Domain::MeanNormal(_)
        | Domain::Made(_)
        | Domain::SetUp => return None,
    };
    Some((*domain, inverse))
}

/// Returns the parameter of the rotation by `b`, then by `a`, by their domain; none where it leaves the domain, or where it
/// does not say it.
pub fn composed((domain, a): &Origin, (_, b): &Origin) -> Option<Origin> {
    let both = match domain {
        Domain::Quaternion => quaternion_product(a, b),
        Domain::Rotation => product(&fixed(a), &fixed(b)).to_vec(),
        Domain::Phases if a.len() == 2 => vec![a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]],
        _ => return None,
    };
    Some((*domain, both))
}

/// Returns the parameter of no rotation.
pub fn identity((domain, list): &Origin) -> Origin {
    let none = match domain {
        Domain::Quaternion | Domain::SmallTurn(_) | Domain::BoundedTurn(_) => vec![0.0, 0.0, 0.0, 1.0],
        Domain::Rotation => vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        Domain::Direction | Domain::Normal | Domain::Hemisphere | Domain::Tilt(_) => vec![0.0, 0.0, 1.0],
        Domain::Phases => [1.0, 0.0].repeat(list.len() / 2),
        Domain::Angle(_) => vec![0.0],
        Domain::Between(..) | Domain::Bent(..) | Domain::Zonal | Domain::Coefficients => list.clone(),
        Domain::Signal
        | Domain::Grey
        | Domain::HalfSine(_)
        | Domain::MeanNormal(_)
        | Domain::Made(_)
        | Domain::SetUp => list.clone(),
    };
    (*domain, none)
}

/// Numbers of a domain, drawn as f32, as what they are meant to be in f64: units, phases, rotations.
fn precise(domain: Domain, list: &[f64]) -> Vec<f64> {
    match domain {
        Domain::Direction
        | Domain::Normal
        | Domain::Hemisphere
        | Domain::Tilt(_)
        | Domain::Quaternion
        | Domain::SmallTurn(_)
        | Domain::BoundedTurn(_) => unit(list),
        Domain::Phases => list.chunks(2).flat_map(unit).collect(),
        Domain::Rotation => {
            let x: [f64; 3] = fixed(&unit(&list[..3]));
            let z: [f64; 3] = fixed(&unit(&cross(x, fixed(&list[3..6]))));
            [x, cross(z, x), z].concat()
        }
        Domain::Between(..) | Domain::Bent(..) | Domain::Zonal | Domain::Coefficients => list.to_vec(),
        Domain::Signal | Domain::Grey | Domain::Angle(_) | Domain::HalfSine(_) => list.to_vec(),
        Domain::MeanNormal(_) | Domain::Made(_) | Domain::SetUp => list.to_vec(),
    }
}

/// One parameter, and what makes it where a set-up does.
#[derive(Debug)]
struct Source {
    param: Param,
    set_up: Option<(Runner<f64>, Vec<Param>)>,
}

/// What a kernel is tried on: its parameters by their origins, and its signals.
#[derive(Clone, Debug, Default)]
pub struct Trial {
    /// The parameters that are no signal, in order, those of a set-up for what it makes.
    pub origins: Vec<Origin>,
    /// The signals, in order.
    pub signals: Vec<Vec<f64>>,
}

impl Trial {
    /// Returns the parameters that are no signal, and the first signal, empty where there is none.
    pub fn alone(&self) -> (&[Origin], &[f64]) {
        (&self.origins, self.signals.first().map_or(&[], Vec::as_slice))
    }
}

/// A kernel's parameters, ready to be drawn from.
#[derive(Debug)]
pub struct Parameters(Vec<Source>);

impl Parameters {
    /// The parameters of a kernel.
    pub fn new(params: &[Param]) -> Self {
        let source = |param: &Param| Source {
            param: param.clone(),
            set_up: match param.domain {
                Domain::Made(made) => {
                    let kernel = (made.kernel)(made.order);
                    Some((Runner::of(&kernel), kernel.params))
                }
                _ => None,
            },
        };
        Self(params.iter().map(source).collect())
    }

    /// Returns seeded trials, the extremes of the domains first.
    pub fn trials(&self, seed: u64, count: usize) -> Vec<Trial> {
        let mut trials = vec![Trial::default(); count];
        for (Source { param, set_up }, seed) in self.0.iter().zip(seed..) {
            let drawn = set_up.as_ref().map_or(std::slice::from_ref(param), |(_, params)| params);
            for (trial, lists) in trials.iter_mut().zip(samples::inputs(drawn, seed, count, None)) {
                for (param, list) in drawn.iter().zip(lists) {
                    match param.domain {
                        Domain::Signal => trial.signals.push(list),
                        domain => trial.origins.push((domain, precise(domain, &list))),
                    }
                }
            }
        }
        trials
    }

    /// Returns what the kernel is given: set-ups are run, the signals stand in their places.
    pub fn inputs(&self, origins: &[Origin], signals: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut rest = origins.iter().map(|(_, list)| list.clone());
        let mut signals = signals.iter().cloned();
        let given = |Source { param, set_up }: &Source| match (param.domain, set_up) {
            (Domain::Signal, _) => signals.next().expect("a list for each signal"),
            (_, Some((runner, params))) => runner.run(&rest.by_ref().take(params.len()).collect::<Vec<_>>()),
            _ => rest.next().expect("an origin for each parameter"),
        };
        self.0.iter().map(given).collect()
    }
}

/// Returns the places of a band in a list of n² numbers, or in one of n, as a zonal signal has.
pub fn places(l: usize, order: usize, length: usize) -> std::ops::Range<usize> {
    if length == order { l..l + 1 } else { l * l..(l + 1) * (l + 1) }
}

/// Returns n zonal coefficients as n² coefficients; what has n² already as it is.
pub fn whole(signal: &[f64], order: usize) -> Vec<f64> {
    if signal.len() != order {
        return signal.to_vec();
    }
    let mut all = vec![0.0; order * order];
    signal.iter().enumerate().for_each(|(l, &x)| all[l * l + l] = x);
    all
}

/// A direction of the quadrature, its weight, the basis there.
struct Node {
    direction: [f64; 3],
    weight: f64,
    basis: Vec<f64>,
}

/// A quadrature over the sphere that is exact for products of two functions of an order.
pub struct Sphere {
    nodes: Vec<Node>,
    basis: Runner<f64>,
}

impl Sphere {
    /// The quadrature of an order: n nodes in z, 2n in φ.
    pub fn new(order: usize) -> Self {
        let basis = Runner::<f64>::new(&Spec::new(&BASIS, order));
        let step = std::f64::consts::PI / order as f64;
        let ring = |(z, weight): (f64, f64)| {
            let s = (1.0 - z * z).sqrt();
            (0..2 * order)
                .map(move |j| (step * j as f64).sin_cos())
                .map(move |(sin, cos)| ([s * cos, s * sin, z], weight))
        };
        let nodes = gauss_legendre(order, -1.0, 1.0).flat_map(ring);
        let nodes = nodes
            .map(|(direction, weight)| Node {
                direction,
                weight: weight * step,
                basis: basis.run(&[direction.to_vec()]),
            })
            .collect();
        Self { nodes, basis }
    }

    /// Returns the directions of the quadrature, each with its weight.
    pub fn nodes(&self) -> impl Iterator<Item = ([f64; 3], f64)> + '_ {
        self.nodes.iter().map(|node| (node.direction, node.weight))
    }

    /// Returns the coefficients of what a signal of n² coefficients becomes under an orthogonal matrix.
    pub fn turned(&self, m: &Matrix, signal: &[f64]) -> Vec<f64> {
        let back = transposed(m);
        let mut out = vec![0.0; signal.len()];
        for node in &self.nodes {
            let value = dot(&self.basis.run(&[apply(&back, &node.direction).to_vec()]), signal) * node.weight;
            out.iter_mut().zip(&node.basis).for_each(|(sum, y)| *sum += value * y);
        }
        out
    }

    /// Returns the integrals of the products of the basis functions, by rows.
    pub fn gram(&self) -> Vec<Vec<f64>> {
        let size = self.nodes[0].basis.len();
        let entry =
            |a: usize, b: usize| self.nodes.iter().map(|node| node.weight * node.basis[a] * node.basis[b]).sum();
        (0..size).map(|a| (0..size).map(|b| entry(a, b)).collect()).collect()
    }
}
