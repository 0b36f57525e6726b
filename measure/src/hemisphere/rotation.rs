//! What rotations of hemispherical harmonics err by: for lobes, which vanish below the horizon, and for records of radiance,
//! which go on there. The three methods of Gautron et al. 2004, section 4, with the generators and the extension beside.

use super::bases::{HSH, SH};
use super::grid::{about_y, frames, hemisphere, seen, sphere};
use super::matrix::{Matrix, norm, relative};
use super::turn::{SPHERE, conversion, derivative, extension, lf3, stretched, turned, without_digon, y_rotation};
use crate::{Progress, each, significant};
use serde::{Deserialize, Serialize};
use zonal_codegen::environment::project::Projection;

/// The angles in degrees that lobes are turned by.
pub const LOBE_ANGLES: [f64; 4] = [5.0, 10.0, 20.0, 30.0];
/// The angles in degrees that records are turned by.
pub const RECORD_ANGLES: [f64; 3] = [5.0, 10.0, 20.0];
/// The orders of the tables.
pub const ORDERS: [usize; 4] = [3, 4, 6, 8];
/// The orders of the tables of matrices, and how many angles those hold from 0 to 90 degrees.
pub const TABLED: ([usize; 3], [usize; 4]) = ([3, 6, 10], [8, 16, 32, 64]);
/// The angles in degrees that tables of matrices are read at; none is in any of them.
pub const READ: [f64; 5] = [4.0, 11.0, 19.0, 28.0, 41.0];
/// The frames that a map is seen in, and how often they are drawn anew.
pub const FRAMES: [usize; 2] = [12, 10];
/// The window of the maps' bands: exp(−0.004 l (l + 1)).
pub const WINDOW: f64 = 0.004;

/// The tilts of the lobes' axes from z in degrees, towards x, y and −x.
pub const TILTS: [f64; 6] = [0.0, 10.0, 20.0, 30.0, 40.0, 50.0];
/// The tilts of fewer lobes, whose errors are averaged in the square.
pub const FEW: [f64; 3] = [0.0, 25.0, 50.0];
/// Rings of the nodes that lobes are integrated with: each lobe has an edge where its horizon was.
const RINGS: usize = 128;
const LARGEST: usize = 10;
const SEED: u64 = 0x3ec0;

/// The ways to rotate lobes.
pub const LOBE_WAYS: [&str; 6] =
    ["none", "eq. 13", "method 1, N = n + 2", "method 1, N = 2n", "exp(β B₀)", "LF3 on B₀"];
/// The ways to rotate records.
pub const RECORD_WAYS: [&str; 7] =
    ["none", "eq. 13", "method 1, N = n + 2", "method 1, N = 14", "LF3 on B₀", "C D E", "LF3 on B"];

/// The errors of one way at one order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// The order.
    pub order: usize,
    /// The way.
    pub way: String,
    /// The mean relative error at each angle; for records over all seeds.
    pub errors: Vec<f64>,
    /// For records the least and the largest of the seeds' means at each angle.
    pub spread: Vec<[f64; 2]>,
}

/// A table of matrices over the angle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tabled {
    /// The order.
    pub order: usize,
    /// How many angles it holds; 0 stands for the matrix at the very angle.
    pub angles: usize,
    /// Its bytes in f32, without the zeros between even and odd functions of y.
    pub bytes: usize,
    /// The mean error of lobes by zero extension.
    pub lobes: f64,
    /// The mean error of records by zero extension.
    pub records: f64,
    /// The mean error of records by the best extension.
    pub extended: f64,
}

/// All errors of rotations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rotation {
    /// Lobes at [`TILTS`].
    pub lobes: Vec<Errors>,
    /// The root mean square instead of the mean, of lobes at [`FEW`].
    pub few: Vec<Errors>,
    /// Records.
    pub records: Vec<Errors>,
    /// Method 2 on lobes: with the digon deleted, and without.
    pub second: Vec<Errors>,
    /// Method 2 on records.
    pub second_records: Vec<Errors>,
    /// Method 3.
    pub tables: Vec<Tabled>,
}

/// A signal in hemispherical harmonics, and as it is after each turn.
#[derive(Clone)]
struct Case {
    before: Vec<f64>,
    after: Vec<After>,
}

#[derive(Clone)]
struct After {
    coefficients: Vec<f64>,
    /// The norm that errors are relative to: that of the whole function above the horizon, or of the coefficients alone.
    whole: Option<f64>,
}

impl After {
    fn error(&self, got: &[f64]) -> f64 {
        let error = relative(got, &self.coefficients[..got.len()]);
        self.whole.map_or(error, |whole| error * norm(&self.coefficients[..got.len()]) / whole)
    }
}

/// The axes of the lobes, in each of three directions: one about z counts for each of them.
fn axes(tilts: &[f64]) -> Vec<[f64; 3]> {
    let tilted = |tilt: f64| {
        let (sin, cos) = tilt.to_radians().sin_cos();
        [[sin, 0.0, cos], [0.0, sin, cos], [-sin, 0.0, cos]]
    };
    tilts.iter().copied().flat_map(tilted).collect()
}

/// max(0, ω·a)⁵ max(0, z) about each axis, before and after each angle.
fn lobes(progress: &dyn Progress, tilts: &[f64], angles: &[f64]) -> Vec<Case> {
    let (nodes, axes) = (hemisphere(RINGS), axes(tilts));
    let values: Vec<Vec<f64>> = nodes.iter().map(|(direction, _)| HSH.at(LARGEST, *direction)).collect();
    let tasks: Vec<f64> = [0.0].iter().chain(angles).copied().collect();
    let by_angle = each(progress, "lobes to rotate", &tasks, |degrees| {
        let mut sums = vec![vec![0.0; LARGEST * LARGEST]; axes.len()];
        for ((direction, weight), values) in nodes.iter().zip(&values) {
            let from = about_y(-degrees.to_radians(), *direction);
            for (axis, sums) in axes.iter().zip(&mut sums) {
                let cosine: f64 = axis.iter().zip(from).map(|(a, b)| a * b).sum();
                let f = weight * cosine.max(0.0).powi(5) * from[2].max(0.0);
                if f > 0.0 {
                    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += f * value);
                }
            }
        }
        sums
    });
    let case = |i: usize| Case {
        before: by_angle[0][i].clone(),
        after: by_angle[1..].iter().map(|sums| After { coefficients: sums[i].clone(), whole: None }).collect(),
    };
    (0..axes.len()).map(case).collect()
}

/// The maps' luminance with its window, in frames of each seed: by seed the signals of all maps.
fn records(progress: &dyn Progress, maps: &[Projection], conversion: &Matrix, angles: &[f64]) -> Vec<Vec<Case>> {
    let nodes = sphere(SPHERE + 1);
    let turns: Vec<Matrix> = angles.iter().map(|degrees| y_rotation(SPHERE, degrees.to_radians())).collect();
    // The square of the radiance over the upper hemisphere is of twice the degree.
    let above: Vec<(f64, Vec<f64>)> =
        hemisphere(2 * SPHERE + 2).into_iter().map(|(direction, weight)| (weight, SH.at(SPHERE, direction))).collect();
    let size = |seen: &[f64]| {
        let square =
            |(weight, y): &(f64, Vec<f64>)| weight * y.iter().zip(seen).map(|(y, c)| y * c).sum::<f64>().powi(2);
        above.iter().map(square).sum::<f64>().sqrt()
    };
    let windowed = |map: &Projection| -> Vec<f64> {
        let luminance = |[r, g, b]: [f64; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
        let window = |i: usize| (-WINDOW * (i.isqrt() * (i.isqrt() + 1)) as f64).exp();
        map.coefficients[..SPHERE * SPHERE].iter().enumerate().map(|(i, c)| window(i) * luminance(*c)).collect()
    };
    let lights: Vec<Vec<f64>> = maps.iter().map(windowed).collect();
    let tasks: Vec<usize> = (0..FRAMES[1]).collect();
    each(progress, "records to rotate", &tasks, |seed| {
        let of_map = |(place, light): (usize, &Vec<f64>)| {
            let frames = frames(SEED + 100 * *seed as u64 + place as u64, FRAMES[0]);
            let case = |frame: &[[f64; 3]; 3]| {
                let seen = seen(&nodes, light, frame);
                let after = |turn: &Matrix| {
                    let turned = turn.apply(&seen);
                    After { coefficients: conversion.apply(&turned), whole: Some(size(&turned)) }
                };
                Case { before: conversion.apply(&seen), after: turns.iter().map(after).collect() }
            };
            frames.iter().map(case).collect::<Vec<Case>>()
        };
        lights.iter().enumerate().flat_map(of_map).collect()
    })
}

/// What is done to a signal.
type Way<'a> = Box<dyn Fn(&[f64]) -> Vec<f64> + 'a>;

/// How the errors of signals become one.
#[derive(Clone, Copy, PartialEq)]
enum Mean {
    Plain,
    Square,
}

/// The mean over the cases of how far what a way makes of the first `order`² numbers is off, at each angle.
fn mean_errors(cases: &[Case], order: usize, ways: &[Way<'_>], mean: Mean) -> Vec<f64> {
    let error = |place: usize, way: &Way<'_>, case: &Case| case.after[place].error(&way(&case.before[..order * order]));
    let of = |(place, way): (usize, &Way<'_>)| {
        let errors = cases.iter().map(|case| error(place, way, case));
        let count = cases.len() as f64;
        significant(match mean {
            Mean::Plain => errors.sum::<f64>() / count,
            Mean::Square => (errors.map(|error| error * error).sum::<f64>() / count).sqrt(),
        })
    };
    ways.iter().enumerate().map(of).collect()
}

/// The matrices of an order.
struct Order {
    order: usize,
    conversion: Matrix,
    extension: Matrix,
    lobe: Matrix,
    record: Matrix,
}

impl Order {
    fn new(order: usize, whole: &Matrix, derivative: &Matrix) -> Self {
        let conversion = whole.corner(order * order, SPHERE * SPHERE);
        let extension = extension(&conversion);
        let turning = conversion.times(derivative);
        let (lobe, record) = (turning.times(&conversion.transposed()), turning.times(&extension));
        Self { order, conversion, extension, lobe, record }
    }

    fn first_method(&self, sphere: usize, beta: f64) -> Matrix {
        let c = conversion(self.order, sphere);
        c.times(&y_rotation(sphere, beta)).times(&c.transposed())
    }

    fn best(&self, beta: f64) -> Matrix {
        self.conversion.times(&y_rotation(SPHERE, beta)).times(&self.extension)
    }

    /// What a way by its name does to a signal at an angle.
    fn way(&self, name: &str, degrees: f64) -> Way<'_> {
        let beta = degrees.to_radians();
        let by = |matrix: Matrix| -> Way<'_> { Box::new(move |h| matrix.apply(h)) };
        match name {
            "eq. 13" => by(y_rotation(self.order, stretched(beta))),
            "digon, eq. 13" => by(y_rotation(self.order, stretched(beta)).times(&without_digon(self.order, beta))),
            "method 1, N = n + 2" => by(self.first_method(self.order + 2, beta)),
            "method 1, N = 2n" => by(self.first_method(2 * self.order, beta)),
            "method 1, N = 14" => by(self.first_method(14, beta)),
            "exp(β B₀)" => by(self.lobe.mixed(beta, &self.lobe, 0.0).exp()),
            "LF3 on B₀" => Box::new(move |h| lf3(&self.lobe, beta, h)),
            "LF3 on B" => Box::new(move |h| lf3(&self.record, beta, h)),
            "C D E" => by(self.best(beta)),
            _ => Box::new(<[f64]>::to_vec),
        }
    }
}

/// Errors of every way at every order: the mean over all seeds, and the spread of each seed's.
fn errors(
    progress: &dyn Progress,
    orders: &[Order],
    (names, angles): (&[&str], &[f64]),
    (seeds, mean): (&[Vec<Case>], Mean),
) -> Vec<Errors> {
    let tasks: Vec<(&Order, &str)> =
        orders.iter().flat_map(|order| names.iter().map(move |name| (order, *name))).collect();
    each(progress, "rotations on the hemisphere", &tasks, |(order, name)| {
        let ways: Vec<_> = angles.iter().map(|degrees| order.way(name, *degrees)).collect();
        let means: Vec<Vec<f64>> = seeds.iter().map(|cases| mean_errors(cases, order.order, &ways, mean)).collect();
        let whole =
            |place: usize| significant(means.iter().map(|errors| errors[place]).sum::<f64>() / means.len() as f64);
        let spread = |place: usize| {
            let at = means.iter().map(|errors| errors[place]);
            [at.clone().fold(f64::INFINITY, f64::min), at.fold(0.0, f64::max)]
        };
        let spread = if means.len() > 1 { (0..angles.len()).map(spread).collect() } else { vec![] };
        Errors { order: order.order, way: (*name).to_owned(), errors: (0..angles.len()).map(whole).collect(), spread }
    })
}

/// The numbers of a matrix that keeps even and odd functions of y apart.
fn numbers(order: usize) -> usize {
    let (even, odd) = (order * (order + 1) / 2, order * (order - 1) / 2);
    even * even + odd * odd
}

/// The errors of linearly interpolated tables, and of the matrices at the very angles.
fn tables(progress: &dyn Progress, orders: &[Order], lobes: &[Case], records: &[Case]) -> Vec<Tabled> {
    let (_, sizes) = TABLED;
    let steps = |size: usize| 90.0 / (size - 1) as f64;
    // The two angles that a reading lies between, for each table; the angle itself for none.
    let ends = |size: usize, degrees: f64| {
        let first = (degrees / steps(size)).floor();
        [first * steps(size), (first + 1.0) * steps(size)]
    };
    let mut needed: Vec<f64> = READ.to_vec();
    needed.extend(sizes.iter().flat_map(|size| READ.iter().flat_map(move |degrees| ends(*size, *degrees))));
    needed.sort_by(f64::total_cmp);
    needed.dedup();
    let largest = orders.iter().map(|order| order.order).max().expect("there are orders");
    let zero: Vec<Matrix> =
        each(progress, "matrices over the angle", &needed, |degrees| turned(largest, degrees.to_radians()));
    let task = |order: &Order| -> Vec<Tabled> {
        let n = order.order * order.order;
        let best: Vec<Matrix> = needed.iter().map(|degrees| order.best(degrees.to_radians())).collect();
        let zero: Vec<Matrix> = zero.iter().map(|matrix| matrix.corner(n, n)).collect();
        let place = |degrees: f64| needed.iter().position(|known| *known == degrees).expect("it is needed");
        let read = |matrices: &[Matrix], size: usize, degrees: f64| match size {
            0 => matrices[place(degrees)].clone(),
            _ => {
                let [low, high] = ends(size, degrees);
                let share = (degrees - low) / (high - low);
                matrices[place(low)].mixed(1.0 - share, &matrices[place(high)], share)
            }
        };
        let mean = |matrices: &[Matrix], size: usize, cases: &[Case]| {
            let way = |degrees: &f64| -> Way<'_> {
                let matrix = read(matrices, size, *degrees);
                Box::new(move |h| matrix.apply(h))
            };
            let ways: Vec<Way<'_>> = READ.iter().map(way).collect();
            let errors = mean_errors(cases, order.order, &ways, Mean::Plain);
            significant(errors.iter().sum::<f64>() / errors.len() as f64)
        };
        let row = |size: usize| Tabled {
            order: order.order,
            angles: size,
            bytes: 4 * size * numbers(order.order),
            lobes: mean(&zero, size, lobes),
            records: mean(&zero, size, records),
            extended: mean(&best, size, records),
        };
        sizes.into_iter().chain([0]).map(row).collect()
    };
    each(progress, "tables of rotations", &orders.iter().collect::<Vec<_>>(), |order| task(order)).concat()
}

/// Everything, with the light of `maps`, each at least of order [`SPHERE`].
pub fn measure(progress: &dyn Progress, maps: &[Projection]) -> Rotation {
    let (whole, derivative) = (conversion(LARGEST, SPHERE), derivative(SPHERE));
    let order = |n: &usize| Order::new(*n, &whole, &derivative);
    let orders = each(progress, "generators", &ORDERS, order);
    let tabled = each(progress, "extensions", &TABLED.0, order);
    let angles: Vec<f64> = LOBE_ANGLES.into_iter().chain(READ).collect();
    let many = [lobes(progress, &TILTS, &angles)];
    let few = [lobes(progress, &FEW, &LOBE_ANGLES)];
    let angles: Vec<f64> = RECORD_ANGLES.into_iter().chain(READ).collect();
    let records = records(progress, maps, &whole, &angles);
    let read = |cases: &[Case], from: usize| -> Vec<Case> {
        cases.iter().map(|case| Case { before: case.before.clone(), after: case.after[from..].to_vec() }).collect()
    };
    let (lobes_read, records_read) = (read(&many[0], LOBE_ANGLES.len()), read(&records[0], RECORD_ANGLES.len()));
    let second = ["eq. 13", "digon, eq. 13"];
    let lobe =
        |orders: &[Order], ways: &[&str], cases, mean| errors(progress, orders, (ways, &LOBE_ANGLES), (cases, mean));
    let record =
        |orders: &[Order], ways: &[&str]| errors(progress, orders, (ways, &RECORD_ANGLES), (&records, Mean::Plain));
    Rotation {
        lobes: lobe(&orders, &LOBE_WAYS, &many, Mean::Plain),
        few: lobe(&orders, &LOBE_WAYS, &few, Mean::Square),
        records: record(&orders, &RECORD_WAYS),
        second: lobe(&tabled, &second, &many, Mean::Plain),
        second_records: record(&tabled, &second),
        tables: tables(progress, &tabled, &lobes_read, &records_read),
    }
}
