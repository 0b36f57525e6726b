//! Rotation by sparse zonal factorisation (docs/MATH.md#zonal-factorisation): a band is a sum of 2l + 1 lobes, lobes
//! turn by turning their directions. It takes far more operations than z, y, z when the lobes' basis values have to be
//! computed, and few when a scene has the samples anyway.

pub mod coupling;
pub mod lobes;
pub mod search;

use crate::families::family::{Acts, Family, Group, Proof, Spec};
use crate::families::parts::bands::each_band;
use crate::families::parts::columns;
use crate::families::parts::params::{matrix, rotated, signal};
use crate::families::parts::sums::inner;
use crate::families::zhf::lobes::{LobeSet, shared_free};
use crate::ir::graph::Id;
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;

/// What the three families share.
const FACTORISED: Family = Family {
    group: Group::Factorise,
    orders: 2..=10,
    outside: |order| {
        let message = format!("no lobe directions are known for order {order}");
        [message, "the zonal factorisation has orders 2 to 10".to_owned()]
    },
    half: false,
    nonzeros: Some(nonzeros),
    ..Family::PLAIN
};

/// `zhf`.
pub static ZHF: Family = Family {
    name: "zhf",
    stem: "zhf",
    what: |spec| {
        format!(
            "Rotates order {} by sparse zonal factorisation over {} shared lobes (Nowrouzezahrai et al. 2012, the standard rotation).",
            spec.order,
            2 * spec.order - 1
        )
    },
    kernel: |spec| rotate(spec.order),
    proof: Proof::Lobes,
    shown: |order| Spec::new(&ZHF, order).both(),
    ..FACTORISED
};

/// `zhf_weights`.
pub static ZHF_WEIGHTS: Family = Family {
    name: "zhf_weights",
    stem: "zhf_weights",
    what: |spec| {
        format!(
            "The weights of the zonal lobes of order {}, the sparse product A^^T c (Nowrouzezahrai et al. 2012).",
            spec.order
        )
    },
    kernel: |spec| weights_of(spec.order),
    acts: Acts::Bands,
    shown: |order| Spec::new(&ZHF_WEIGHTS, order).both(),
    ..FACTORISED
};

/// `zhf_tailored`.
pub static ZHF_TAILORED: Family = Family {
    name: "zhf_tailored",
    stem: "zhf_tailored",
    what: |spec| {
        format!(
            "Rotates order {} from samples at the lobes, the sparse product A^ f (Nowrouzezahrai et al. 2012, the signal-tailored rotation).",
            spec.order
        )
    },
    kernel: |spec| tailored(spec.order),
    acts: Acts::Bands,
    shown: |order| Spec::new(&ZHF_TAILORED, order).both(),
    ..FACTORISED
};

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
fn weights_of(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let c = signal(&mut builder, order);
    let out = weights(&mut builder, &c, order);
    let doc = "the lobe weights, 2l + 1 for band l, in the order of the band's lobes";
    builder.finish(out, Shape::Array(order * order), doc)
}

/// The kernel `zhf`: c'_lm = Σ_d z_d y_lm(R ω_d) with z = Âᵀ c, from a rotation matrix.
fn rotate(order: usize) -> Kernel {
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
            let turned: [Id; 3] = std::array::from_fn(|row| g.dot(&xyz, &[m[row], m[3 + row], m[6 + row]]));
            g.direction(turned);
            columns::values(g, &turned, order, columns::orthonormal)
        })
        .collect();
    let out = (0..order)
        .flat_map(|l| (l * l..(l + 1) * (l + 1)).map(move |i| (l, i)))
        .map(|(l, i)| {
            let at: Vec<Id> = set.subsets[l].iter().map(|&d| values[d][i]).collect();
            inner(g, &z[l * l..(l + 1) * (l + 1)], &at)
        })
        .collect();
    rotated(builder, order, out)
}

/// The kernel `zhf_tailored`: c = Â f from the samples of each band's function at the lobes turned back, f(R⁻¹ ω_d).
fn tailored(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let doc = "the samples of each band's function at its lobes turned back, 2l + 1 for band l";
    let f = builder.param("f", Shape::Array(order * order), Domain::Signal, doc);
    let set = lobes(order);
    let out = each_band(&mut builder.graph, &f, order, |g, l, band| {
        set.a_hat(l).iter().map(|row| g.dot(row, band)).collect()
    });
    rotated(builder, order, out)
}
