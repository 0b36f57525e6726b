//! Rotation by sparse zonal factorisation (docs/MATH.md#zonal-factorisation): a band is a sum of 2l + 1 lobes, lobes
//! turn by turning their directions. It takes far more operations than z, y, z when the lobes' basis values have to be
//! computed, and few when a scene has the samples anyway.

pub mod lobes;
pub mod search;

use crate::families::basis;
use crate::families::inner;
use crate::families::rotate::{each_band, matrix, signal};
use crate::families::zhf::lobes::{LobeSet, shared_free};
use crate::ir::graph::{Id, Kind};
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;

/// The lobes of an order, 2 to 10; any 2l + 1 of the 2n − 1 directions serve band l.
pub fn lobes(order: usize) -> &'static LobeSet {
    shared_free(order).expect("a spec's order was checked to have lobes")
}

/// The non-zero entries of Â in the bands from 2 on.
pub fn nonzeros(order: usize) -> usize {
    let set = lobes(order);
    (2..order).flat_map(|l| set.a_hat(l).iter().flatten()).filter(|x| !x.is_zero()).count()
}

fn weights(builder: &mut Builder, c: &[Id], order: usize) -> Vec<Id> {
    let set = lobes(order);
    each_band(&mut builder.graph, c, order, |g, l, band| {
        let a_hat = set.a_hat(l);
        (0..2 * l + 1)
            .map(|d| {
                let column: Vec<Exact> = a_hat.iter().map(|row| row[d].clone()).collect();
                g.dot(&column, band)
            })
            .collect()
    })
}

/// The kernel `zhf_weights`: z = Âᵀ c, band by band, so that c = Yᵀ z.
pub fn weights_of(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let c = signal(&mut builder, order);
    let out = weights(&mut builder, &c, order);
    let doc = "the lobe weights, 2l + 1 for band l, in the order of the band's lobes";
    builder.finish(out, Shape::Array(order * order), doc)
}

/// The kernel `zhf`: c'_lm = Σ_d z_d y_lm(R ω_d) with z = Âᵀ c, from a rotation matrix.
pub fn rotate(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let m = matrix(&mut builder);
    let c = signal(&mut builder, order);
    let z = weights(&mut builder, &c, order);
    let set = lobes(order);
    let g = &mut builder.graph;
    (0..order).for_each(|l| g.stage(&z[l * l..(l + 1) * (l + 1)]));
    let values: Vec<Vec<Id>> = set
        .directions
        .iter()
        .map(|lobe| {
            let xyz = lobe.xyz();
            let turned: Vec<Id> = (0..3).map(|row| g.dot(&xyz, &[m[row], m[3 + row], m[6 + row]])).collect();
            g.stage(&turned);
            basis::values(g, &turned, order, basis::orthonormal)
        })
        .collect();
    let out = (0..order)
        .flat_map(|l| (l * l..(l + 1) * (l + 1)).map(move |i| (l, i)))
        .map(|(l, i)| {
            let at: Vec<Id> = set.subsets[l].iter().map(|&d| values[d][i]).collect();
            inner(g, &z[l * l..(l + 1) * (l + 1)], &at)
        })
        .collect();
    builder.finish(out, Shape::Array(order * order), "the rotated coefficients")
}

/// The kernel `zhf_tailored`: c = Â f from the samples of each band's function at the lobes turned back, f(R⁻¹ ω_d).
pub fn tailored(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let doc = "the samples of each band's function at its lobes turned back, 2l + 1 for band l";
    let f = builder.param("f", Shape::Array(order * order), Kind::Signal, doc);
    let set = lobes(order);
    let out = each_band(&mut builder.graph, &f, order, |g, l, band| {
        set.a_hat(l).iter().map(|row| g.dot(row, band)).collect()
    });
    builder.finish(out, Shape::Array(order * order), "the rotated coefficients")
}
