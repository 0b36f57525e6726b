//! Spherical harmonics of radiance or of irradiance to the H-basis or to its monomials: one sparse matrix, the cosine's
//! factors, the integrals over the hemisphere (the T_h of Habel and Wimmer 2010) and the basis' constants in it.

use crate::families::family::{Family, Spec};
use crate::families::hbasis::evaluate::{of_the_basis, of_which_monomials};
use crate::families::hbasis::space::{OF_ONE_ORDER, h, in_monomials, integrals, light, rows};
use crate::families::parts::params::signal;
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;

/// What a signal is, what irradiance is divided by, and what is made of it.
pub(super) const LIGHT: &[&[&str]] = &[&["irradiance"], &["over_pi"], &["monomial"]];

const CONVERSION: Family = Family { choices: LIGHT, ..OF_ONE_ORDER };

/// `sh3_to_h4`.
pub static SH3_TO_H4: Family = Family {
    name: "sh3_to_h4",
    stem: "sh3_to_h4_coefficients",
    orders: 3..=3,
    what: |spec| sentence(spec, 4),
    kernel: |spec| kernel(spec, 4),
    shown: |order| shown(&SH3_TO_H4, order),
    ..CONVERSION
};

/// `sh3_to_h6`.
pub static SH3_TO_H6: Family = Family {
    name: "sh3_to_h6",
    stem: "sh3_to_h6_coefficients",
    orders: 3..=3,
    what: |spec| sentence(spec, 6),
    kernel: |spec| kernel(spec, 6),
    shown: |order| shown(&SH3_TO_H6, order),
    ..CONVERSION
};

/// `sh5_to_h4`.
pub static SH5_TO_H4: Family = Family {
    name: "sh5_to_h4",
    stem: "sh5_to_h4_coefficients",
    orders: 5..=5,
    what: |spec| sentence(spec, 4),
    kernel: |spec| kernel(spec, 4),
    shown: |order| shown(&SH5_TO_H4, order),
    ..CONVERSION
};

/// `sh5_to_h6`.
pub static SH5_TO_H6: Family = Family {
    name: "sh5_to_h6",
    stem: "sh5_to_h6_coefficients",
    orders: 5..=5,
    what: |spec| sentence(spec, 6),
    kernel: |spec| kernel(spec, 6),
    shown: |order| shown(&SH5_TO_H6, order),
    ..CONVERSION
};

/// Radiance and irradiance, to the basis and to monomials.
fn shown(family: &'static Family, order: usize) -> Vec<Spec> {
    let specs = Spec::only(family, order).into_iter();
    let specs = specs.flat_map(|spec| [spec.clone(), spec.choosing("irradiance")]);
    specs.flat_map(|spec| [spec.clone(), spec.choosing("monomial")]).flat_map(Spec::both).collect()
}

/// From which light to which, in a sentence's parts.
pub(super) fn from_to(spec: &Spec) -> [&'static str; 2] {
    let from = if spec.has("irradiance") { "irradiance" } else { "radiance" };
    let to = match (spec.has("irradiance"), spec.has("over_pi")) {
        (false, false) => "its irradiance E (the integral of radiance times the cosine; `:over_pi` divides it by pi)",
        (true, false) => "the same function",
        (_, true) => "irradiance divided by pi, what a white surface sends out",
    };
    [from, to]
}

fn sentence(spec: &Spec, count: usize) -> String {
    let [from, to] = from_to(spec);
    let what = if spec.has("monomial") { "the monomials" } else { "the functions" };
    let cut = match spec.order {
        5 => " Band 3 is not read: irradiance has none.",
        _ => "",
    };
    format!(
        "From harmonics of order {} of {from} to {what} of H{count}, of {to}: the best approximation over the upper hemisphere (Habel and Wimmer 2010, eq. 14).{cut}",
        spec.order
    )
}

fn kernel(spec: &Spec, count: usize) -> Kernel {
    let mut builder = Builder::new();
    let c = signal(&mut builder, spec.order);
    let basis = integrals(&h(count), &light(spec));
    let (matrix, doc) = match spec.has("monomial") {
        false => (basis, of_the_basis(count)),
        true => {
            let to = in_monomials();
            let row = |monomial: usize| -> Vec<Exact> {
                let entry = |j: usize| (0..count).map(|i| &to[i][monomial] * &basis[i][j]).sum();
                (0..c.len()).map(entry).collect()
            };
            ((0..count).map(row).collect(), of_which_monomials(count))
        }
    };
    let out = rows(&mut builder.graph, &matrix, &c);
    builder.finish(out, Shape::Array(count), doc)
}
