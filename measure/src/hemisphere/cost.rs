//! What the evaluation of a basis costs and how it rounds: of kernels by the names of their specs, where they exist, and of
//! Zernike's polynomials and the ambient cube, which have none, as the shortest code known here.

use crate::significant;
use serde::{Deserialize, Serialize};
use zonal_codegen::families::Spec;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::kernel::{Builder, Domain, Kernel, Shape};
use zonal_codegen::ir::listing::{Cost, Listing};
use zonal_codegen::math::exact::Exact;
use zonal_codegen::promise::samples;

/// How many inputs the rounding is measured on.
pub const INPUTS: usize = 4000;
const SEED: u64 = 0xba5e;

/// What an evaluation costs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// Operations for one channel.
    pub operations: usize,
    /// Operations for three channels.
    pub operations_rgb: usize,
    /// Inverse square roots and reciprocals.
    pub special: usize,
    /// The largest error in f32 against the norm of the coefficients.
    pub f32: f64,
}

/// Of the kernel of a spec, whose last parameter is the coefficients; nothing where no family has that name.
pub fn of_spec(spec: &str) -> Option<Evaluation> {
    Some(of(&spec.parse::<Spec>().ok()?.kernel()))
}

/// Of Zernike's polynomials of the degrees to 1 or to 2, their constants within the coefficients.
pub fn of_zernike(degree: usize) -> Evaluation {
    of(&zernike(degree))
}

/// Of the ambient cube: six numbers, of which three are chosen by signs.
pub fn of_cube() -> Evaluation {
    let mut builder = Builder::new();
    let dir = builder.param("dir", Shape::Array(3), Domain::Direction, "a direction");
    let c = builder.param("c", Shape::Array(6), Domain::Signal, "the faces towards +x, −x, +y, −y, +z and −z");
    let g = &mut builder.graph;
    let zero = g.constant(Exact::zero());
    let mut value = None;
    for (axis, faces) in c.chunks(2).enumerate() {
        let square = g.mul(dir[axis], dir[axis]);
        let face = g.select_less(zero, dir[axis], faces[0], faces[1]);
        value = Some(match value {
            None => g.mul(square, face),
            Some(sum) => g.mul_add(square, face, sum),
        });
    }
    let value = value.expect("a direction has three axes");
    of(&builder.finish(vec![value], Shape::Scalar, "the sum"))
}

fn of(kernel: &Kernel) -> Evaluation {
    let listing = Listing::new(kernel);
    let Cost { total, special, .. } = listing.cost(1);
    let (narrow, wide) = (Program::<f32>::new(&listing), Program::<f64>::new(&listing));
    let mut worst = 0.0f64;
    for input in samples::inputs(&listing.params, SEED, INPUTS, None) {
        let single: Vec<Vec<f32>> = input.iter().map(|list| list.iter().map(|x| *x as f32).collect()).collect();
        let double: Vec<Vec<f64>> = single.iter().map(|list| list.iter().map(|x| f64::from(*x)).collect()).collect();
        let single: Vec<&[f32]> = single.iter().map(Vec::as_slice).collect();
        let double: Vec<&[f64]> = double.iter().map(Vec::as_slice).collect();
        let norm = double.last().map_or(1.0, |c| c.iter().map(|x| x * x).sum::<f64>().sqrt());
        let want = wide.run(&double, Contraction::Fused)[0];
        for contraction in [Contraction::Fused, Contraction::Separate] {
            let got = f64::from(narrow.run(&single, contraction)[0]);
            // Of nothing no share is taken.
            worst = worst.max(if norm > 0.0 { (got - want).abs() / norm } else { 0.0 });
        }
    }
    Evaluation { operations: total, operations_rgb: listing.cost(3).total, special, f32: significant(worst) }
}

/// c_0 + c_1 X + c_2 Y + c_3 z + c_4 X Y + c_5 (X² − Y²) with X, Y = (x, y) / √(1 + z).
fn zernike(degree: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = builder.param("dir", Shape::Array(3), Domain::Hemisphere, "a direction");
    let count = (degree + 1) * (degree + 2) / 2;
    let c = builder.param("c", Shape::Array(count), Domain::Signal, "the coefficients");
    let g = &mut builder.graph;
    let one = g.constant(Exact::int(1));
    let sum = g.add(one, dir[2]);
    let root = g.rsqrt(sum);
    let (x, y) = (g.mul(dir[0], root), g.mul(dir[1], root));
    let mut value = g.mul_add(c[1], x, c[0]);
    value = g.mul_add(c[2], y, value);
    if degree > 1 {
        value = g.mul_add(c[3], dir[2], value);
        let product = g.mul(x, y);
        value = g.mul_add(c[4], product, value);
        let square = g.mul(y, y);
        let square = g.neg(square);
        let difference = g.mul_add(x, x, square);
        value = g.mul_add(c[5], difference, value);
    }
    builder.finish(vec![value], Shape::Scalar, "the sum")
}
