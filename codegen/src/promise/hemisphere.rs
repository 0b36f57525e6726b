//! What a rotation on the hemisphere errs by, besides rounding, as a plan predicts it: over lobes that vanish below the
//! horizon, by quadrature; over records of radiance that go on, by the power that their bands are expected to have
//! (docs/MATH.md#rotation-on-the-hemisphere).

// Names a family: the basis that lobes are projected on.
use crate::families::family::Spec;
use crate::families::hemisphere::evaluate::HSH_BASIS;
use crate::ir::eval::{Contraction, Program};
use crate::ir::listing::Listing;
use crate::math::hemisphere::{Below, expected_records};
use crate::math::quadrature::gauss_legendre;
use std::f64::consts::TAU;

/// Heights and azimuths of the quadrature: lobes have kinks, whose error is some 1e-3 of theirs.
const GRID: [usize; 2] = [72, 144];

/// How far from z the lobes stand, in degrees.
const LOBES: [f64; 5] = [10.0, 20.0, 30.0, 40.0, 50.0];

/// Functions before and after a turn about y, as hemispherical coefficients.
pub struct Trials {
    below: Below,
    pairs: Vec<[Vec<f64>; 2]>,
}

impl Trials {
    /// Those of an order, turned by an angle in radians.
    pub fn new(order: usize, below: Below, angle: f64) -> Self {
        let pairs = match below {
            Below::Zero => lobes(order, angle),
            Below::GoesOn => expected_records(order, angle),
        };
        Self { below, pairs }
    }

    /// What a matrix that should turn them errs by, given by rows: of lobes the mean of the relative errors; of records, which
    /// are independent parts of one, the root mean square against that of the result.
    pub fn error(&self, matrix: &[Vec<f64>]) -> f64 {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let squares = self.pairs.iter().map(|[before, after]| {
            let missed = matrix.iter().zip(after).map(|(row, want)| (dot(row, before) - want).powi(2));
            (missed.sum::<f64>(), dot(after, after))
        });
        match self.below {
            Below::Zero => squares.map(|(missed, size)| (missed / size).sqrt()).sum::<f64>() / self.pairs.len() as f64,
            Below::GoesOn => {
                let (missed, size) = squares.fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y));
                (missed / size).sqrt()
            }
        }
    }
}

/// max(0, ω·a)⁵ max(0, z), a at z and at some angles from it towards x, y and −x, cut off at the horizon.
fn lobes(order: usize, angle: f64) -> Vec<[Vec<f64>; 2]> {
    let [heights, around] = GRID;
    let basis = Program::<f64>::new(&Listing::new(&Spec::new(&HSH_BASIS, order).kernel()));
    let ring = |(z, weight): (f64, f64)| {
        let rim = (1.0 - z * z).sqrt();
        (0..around).map(move |i| {
            let (sin, cos) = (TAU * (i as f64 + 0.5) / around as f64).sin_cos();
            ([rim * cos, rim * sin, z], weight * TAU / around as f64)
        })
    };
    let points: Vec<([f64; 3], f64, Vec<f64>)> = gauss_legendre(heights, 0.0, 1.0)
        .flat_map(ring)
        .map(|(direction, weight)| (direction, weight, basis.run(&[&direction], Contraction::Separate)))
        .collect();
    let (sin, cos) = angle.sin_cos();
    let projected = |axis: [f64; 3], [sin, cos]: [f64; 2]| {
        let mut sum = vec![0.0; order * order];
        for ([x, y, z], weight, h) in &points {
            // Where the direction was before the turn.
            let [x, z] = [x * cos - z * sin, z * cos + x * sin];
            let lobe = (x * axis[0] + y * axis[1] + z * axis[2]).max(0.0).powi(5) * z.max(0.0) * weight;
            if lobe > 0.0 {
                sum.iter_mut().zip(h).for_each(|(sum, h)| *sum += lobe * h);
            }
        }
        sum
    };
    let towards = LOBES.iter().flat_map(|degrees| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        [[sin, 0.0, cos], [0.0, sin, cos], [-sin, 0.0, cos]]
    });
    let axes = std::iter::once([0.0, 0.0, 1.0]).chain(towards);
    axes.map(|axis| [projected(axis, [0.0, 1.0]), projected(axis, [sin, cos])]).collect()
}
