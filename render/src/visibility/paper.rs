//! The paper's three steps for a pixel (Soler et al. 2015, section 6.1 and appendix A), with its misprints corrected, as
//! kernels that are run and counted here and are in no catalogue: `product`, then `shade` give the same for less.

use crate::visibility::multiplier::Multiplier;
use zonal_codegen::families::Spec;
// Names a family: its directions are what the steps are made of.
use zonal_codegen::families::isd::directions::{Shared, shared};
use zonal_codegen::families::parts::columns;
use zonal_codegen::families::parts::quaternion::matrix_of_quaternion;
use zonal_codegen::families::parts::sums::inner;
use zonal_codegen::families::parts::turned;
use zonal_codegen::ir::eval::{Contraction, Number, Program};
use zonal_codegen::ir::graph::Id;
use zonal_codegen::ir::kernel::{Builder, Domain, Kernel, Shape};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::math::exact::Exact;

/// The first step: the reflectance's coefficients in the axes of the object, of its weights λ in the frame of the surface,
/// ρ_l^k = π_l Σ_j λ_l^j y_l^k(R⁻¹ z^j).
fn first(order: usize, set: &Shared) -> Kernel {
    let mut builder = Builder::new();
    let doc = "the rotation R of the object to the local frame, a unit quaternion (x, y, z, w)";
    let q = builder.param("q", Shape::Vec4, Domain::Quaternion, doc);
    let lambda = builder.param("lambda", Shape::Array(order * order), Domain::Signal, "the weights");
    let g = &mut builder.graph;
    let rows = matrix_of_quaternion(g, &q);
    let back: [[Id; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| rows[j][i]));
    let turned = turned::directions(g, &back, &set.directions);
    let values: Vec<Vec<Id>> = turned.iter().map(|dir| columns::values(g, dir, order, columns::zonal)).collect();
    let mut out = Vec::new();
    for l in 0..order {
        for place in l * l..(l + 1) * (l + 1) {
            let at: Vec<Id> = values[..2 * l + 1].iter().map(|of| of[place]).collect();
            out.push(inner(g, &lambda[l * l..(l + 1) * (l + 1)], &at));
        }
    }
    builder.finish(out, Shape::Array(order * order), "the coefficients in the axes of the object")
}

/// The last step: Σ_l π_l Σ_j s_l^j Σ_k v_l^k y_l^k(z^j), equation 22 with directions that nothing turns.
fn last(order: usize, set: &Shared) -> Kernel {
    let mut builder = Builder::new();
    let v = builder.param("v", Shape::Array(order * order), Domain::Grey, "the visibility");
    let s = builder.param("s", Shape::Array(order * order), Domain::Signal, "the weights of reflectance times light");
    let g = &mut builder.graph;
    let mut at = Vec::new();
    for l in 0..order {
        let matrix = set.matrix(l);
        for j in 0..2 * l + 1 {
            let column: Vec<Exact> = matrix.iter().map(|row| row[j].clone()).collect();
            at.push(g.dot(&column, &v[l * l..(l + 1) * (l + 1)]));
        }
    }
    let sum = inner(g, &s, &at);
    builder.finish(vec![sum], Shape::Scalar, "the integral of light, visibility and reflectance")
}

/// The paper's way at an order, under a light.
pub struct Paper<T> {
    weights: Program<T>,
    first: Program<T>,
    last: Program<T>,
    /// γ of each channel, a row a weight.
    gamma: [Vec<Vec<T>>; 3],
    /// Operations of a pixel in R, G and B: of the three steps, the reflectance grey.
    pub operations: [usize; 3],
}

impl<T: Number> Paper<T> {
    /// Returns the way at the order of a light's matrices; none where no directions are kept, or at order 2.
    pub fn new(light: &Multiplier) -> Option<Self> {
        let order = light.order;
        let set = shared(order)?;
        let weights: Spec = format!("isd_weights:{order}").parse().ok()?;
        let weights = Listing::new(&weights.kernel());
        let [first, last] = [first(order, set), last(order, set)].map(|kernel| Listing::new(&kernel));
        let count = order * order;
        // The weights of y_i E are what `isd_weights` makes of its coefficients.
        let exact = Program::<f64>::new(&weights);
        let gamma = [0, 1, 2].map(|channel| {
            let columns: Vec<Vec<f64>> =
                (0..count).map(|i| exact.run(&[&light.column(i, channel)], Contraction::Separate)).collect();
            (0..count).map(|j| columns.iter().map(|column| T::from_f64(column[j])).collect()).collect()
        });
        let operations = [first.cost(1).total, 3 * count * count, last.cost(3).total];
        Some(Self {
            weights: Program::new(&weights),
            first: Program::new(&first),
            last: Program::new(&last),
            gamma,
            operations,
        })
    }

    /// Returns the integral of light, visibility and reflectance: `q` takes the object to the local frame, `c` are the
    /// reflectance's coefficients there, `v` those of the visibility in the axes of the object.
    pub fn shade(&self, q: [T; 4], c: &[T], v: &[T]) -> [T; 3] {
        let lambda = self.weights.run(&[c], Contraction::Separate);
        let rho = self.first.run(&[&q, &lambda], Contraction::Separate);
        [0, 1, 2].map(|channel| {
            let row = |row: &Vec<T>| row.iter().zip(&rho).fold(T::ZERO, |sum, (&a, &b)| sum + a * b);
            let s: Vec<T> = self.gamma[channel].iter().map(row).collect();
            self.last.run(&[v, &s], Contraction::Separate)[0]
        })
    }
}
