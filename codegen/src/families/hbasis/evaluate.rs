//! The functions of the H-basis at a normal, and sums of them: from coefficients as they are stored, and from those of the
//! monomials 1, y, z, x, xy, x² − y². For one channel a sum is nested; for three the functions are shared.

use crate::families::family::{Family, Measure, Spec};
use crate::families::hbasis::space::{
    MONOMIALS, NORMALISED, OF_ONE_ORDER, coefficients, in_monomials, mean_normal, no_half, of_normals, product, root,
    rows,
};
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;

/// What the records of four functions have in common.
const H4: Family = Family { orders: 2..=2, ..AT_A_NORMAL };
/// What the records of six functions have in common.
const H6: Family = Family { orders: 3..=3, ..AT_A_NORMAL };
const AT_A_NORMAL: Family = Family { choices: &[NORMALISED], unproven: NORMALISED, fault: no_half, ..OF_ONE_ORDER };

/// `h4_basis`.
pub static H4_BASIS: Family = Family {
    name: "h4_basis",
    stem: "h4_basis",
    measure: Measure::Absolute,
    what: |spec| basis_sentence(spec, 4),
    kernel: |spec| basis(spec, 4),
    shown: |order| shown(&H4_BASIS, order),
    ..H4
};

/// `h6_basis`.
pub static H6_BASIS: Family = Family {
    name: "h6_basis",
    stem: "h6_basis",
    measure: Measure::Absolute,
    what: |spec| basis_sentence(spec, 6),
    kernel: |spec| basis(spec, 6),
    shown: |order| shown(&H6_BASIS, order),
    ..H6
};

/// `h4_eval`, nested.
pub static H4_EVAL: Family = Family {
    name: "h4_eval",
    method: "nested",
    stem: "h4_eval_nested",
    usual: |_, rgb| !rgb,
    what: |spec| sum_sentence(spec, "H4"),
    kernel: |spec| stored(spec, 4, nested),
    shown: |order| shown_for(&H4_EVAL, order, false),
    ..H4
};

/// `h4_eval`, its functions shared by channels.
pub static H4_EVAL_SHARED: Family = Family {
    name: "h4_eval",
    method: "shared",
    stem: "h4_eval_shared",
    usual: |_, rgb| rgb,
    what: |spec| sum_sentence(spec, "H4"),
    kernel: |spec| stored(spec, 4, shared),
    shown: |order| shown_for(&H4_EVAL_SHARED, order, true),
    ..H4
};

/// `h6_eval`, nested.
pub static H6_EVAL: Family = Family {
    name: "h6_eval",
    method: "nested",
    stem: "h6_eval_nested",
    usual: |_, rgb| !rgb,
    what: |spec| sum_sentence(spec, "H6"),
    kernel: |spec| stored(spec, 6, nested),
    shown: |order| shown_for(&H6_EVAL, order, false),
    ..H6
};

/// `h6_eval`, its functions shared by channels.
pub static H6_EVAL_SHARED: Family = Family {
    name: "h6_eval",
    method: "shared",
    stem: "h6_eval_shared",
    usual: |_, rgb| rgb,
    what: |spec| sum_sentence(spec, "H6"),
    kernel: |spec| stored(spec, 6, shared),
    shown: |order| shown_for(&H6_EVAL_SHARED, order, true),
    ..H6
};

/// `h4_to_monomial`.
pub static H4_TO_MONOMIAL: Family = Family {
    name: "h4_to_monomial",
    stem: "h4_to_monomial",
    choices: &[],
    what: |_| to_monomial_sentence("h4"),
    kernel: |_| to_monomial(4),
    shown: |order| Spec::only(&H4_TO_MONOMIAL, order).into_iter().flat_map(Spec::both).collect(),
    ..H4
};

/// `h6_to_monomial`.
pub static H6_TO_MONOMIAL: Family = Family {
    name: "h6_to_monomial",
    stem: "h6_to_monomial",
    choices: &[],
    what: |_| to_monomial_sentence("h6"),
    kernel: |_| to_monomial(6),
    shown: |order| Spec::only(&H6_TO_MONOMIAL, order).into_iter().flat_map(Spec::both).collect(),
    ..H6
};

/// `h4_eval_monomial`.
pub static H4_EVAL_MONOMIAL: Family = Family {
    name: "h4_eval_monomial",
    stem: "h4_eval_monomial",
    what: |spec| monomial_sentence(spec, "h4"),
    kernel: |spec| of_monomials(spec, 4, |g, [x, y, z], c| inner_from(g, c[0], &[(y, c[1]), (z, c[2]), (x, c[3])])),
    shown: |order| with_normalised(Spec::only(&H4_EVAL_MONOMIAL, order), true),
    ..H4
};

/// `h6_eval_monomial`, nested.
pub static H6_EVAL_MONOMIAL: Family = Family {
    name: "h6_eval_monomial",
    method: "nested",
    stem: "h6_eval_monomial_nested",
    usual: |_, rgb| !rgb,
    what: |spec| monomial_sentence(spec, "h6"),
    kernel: |spec| {
        of_monomials(spec, 6, |g, [x, y, z], c| {
            // y (c1 + x c4 − y c5) + z c2 + x (c3 + x c5) + c0.
            let minus = g.neg(c[5]);
            let (of_y, of_x) = (inner_from(g, c[1], &[(x, c[4]), (y, minus)]), g.mul_add(c[5], x, c[3]));
            inner_from(g, c[0], &[(z, c[2]), (y, of_y), (x, of_x)])
        })
    },
    shown: |order| shown_for(&H6_EVAL_MONOMIAL, order, false),
    ..H6
};

/// `h6_eval_monomial`, its square shared by channels.
pub static H6_EVAL_MONOMIAL_SHARED: Family = Family {
    name: "h6_eval_monomial",
    method: "shared",
    stem: "h6_eval_monomial_shared",
    usual: |_, rgb| rgb,
    what: |spec| monomial_sentence(spec, "h6"),
    kernel: |spec| {
        of_monomials(spec, 6, |g, [x, y, z], c| {
            let rim = rim(g, x, y);
            let of_y = g.mul_add(c[4], x, c[1]);
            inner_from(g, c[0], &[(z, c[2]), (x, c[3]), (rim, c[5]), (y, of_y)])
        })
    },
    shown: |order| shown_for(&H6_EVAL_MONOMIAL_SHARED, order, true),
    ..H6
};

/// The catalogue's rows of a basis.
fn shown(family: &'static Family, order: usize) -> Vec<Spec> {
    with_normalised(Spec::only(family, order), false)
}

/// The catalogue's rows of a sum that is usual for one channel, or for three.
fn shown_for(family: &'static Family, order: usize, rgb: bool) -> Vec<Spec> {
    let spec = Spec::only(family, order).map(|spec| if rgb { spec.rgb() } else { spec });
    with_normalised(spec, false)
}

fn with_normalised(spec: Option<Spec>, both: bool) -> Vec<Spec> {
    let all = spec.into_iter().flat_map(|spec| [spec.clone(), spec.choosing(NORMALISED[0])]);
    all.flat_map(|spec| if both { spec.both() } else { vec![spec] }).collect()
}

fn basis_sentence(spec: &Spec, count: usize) -> String {
    format!(
        "The H-basis of {count} functions at a normal, orthonormal over the upper hemisphere (Habel and Wimmer 2010, eq. 10): irradiance by the normal in tangent space. {}",
        of_normals(spec)
    )
}

fn sum_sentence(spec: &Spec, basis: &str) -> String {
    format!(
        "The sum of c_i H_i(dir) over {basis}, the H-basis, from coefficients as they are stored (Habel and Wimmer 2010). {}",
        of_normals(spec)
    )
}

fn to_monomial_sentence(basis: &str) -> String {
    format!(
        "From coefficients of the H-basis to those of the monomials that `{basis}_eval_monomial` takes; done once, when they are stored."
    )
}

fn monomial_sentence(spec: &Spec, basis: &str) -> String {
    format!(
        "The sum of the H-basis from the coefficients of monomials that `{basis}_to_monomial` or a conversion with `:monomial` makes. {}",
        of_normals(spec)
    )
}

/// What a list of `count` coefficients of monomials is.
pub(super) fn of_which_monomials(count: usize) -> String {
    format!("the coefficients of {}", MONOMIALS[..count].join(", "))
}

/// What a list of `count` coefficients of the H-basis is.
pub(super) fn of_the_basis(count: usize) -> String {
    format!("the {count} coefficients of the H-basis, of -y, 2z-1 and -x from index 1 on")
}

/// start + Σ a c.
fn inner_from(g: &mut Graph, start: Id, terms: &[(Id, Id)]) -> Id {
    terms.iter().fold(start, |sum, &(a, c)| g.mul_add(c, a, sum))
}

/// x² − y².
fn rim(g: &mut Graph, x: Id, y: Id) -> Id {
    let (xx, yy) = (g.mul(x, x), g.mul(y, y));
    g.sub(xx, yy)
}

/// The first four or all six functions: three operations or eight.
fn functions(g: &mut Graph, [x, y, z]: [Id; 3], count: usize) -> Vec<Id> {
    let (slope, bend) = (root(3, 2, -1), root(15, 2, -1));
    let minus = -&slope;
    let first = g.constant(root(1, 2, -1));
    let mut all = vec![first, g.scale(&minus, y), g.affine(&(&slope * &Exact::int(2)), z, &minus), g.scale(&minus, x)];
    if count == 6 {
        let (bent, rim) = (g.scale(&bend, x), rim(g, x, y));
        all.extend([g.mul(bent, y), g.scale(&(&bend * &Exact::ratio(1, 2)), rim)]);
    }
    all
}

fn basis(spec: &Spec, count: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = mean_normal(&mut builder, spec);
    let all = functions(&mut builder.graph, dir, count);
    builder.finish(all, Shape::Array(count), "H_i(dir)")
}

fn stored(spec: &Spec, count: usize, sum: fn(&mut Graph, [Id; 3], &[Id]) -> Id) -> Kernel {
    let mut builder = Builder::new();
    let dir = mean_normal(&mut builder, spec);
    let c = coefficients(&mut builder, count, &of_the_basis(count));
    let sum = sum(&mut builder.graph, dir, &c);
    builder.finish(vec![sum], Shape::Scalar, "Σ c_i H_i(dir)")
}

fn shared(g: &mut Graph, dir: [Id; 3], c: &[Id]) -> Id {
    let values = functions(g, dir, c.len());
    product(g, &values, c)
}

/// k ((2z − 1) c₂ + x (y C + x D − c₃) − y (y D + c₁)) + h c₀, where C = √5 c₄ and D = ½ √5 c₅.
fn nested(g: &mut Graph, [x, y, z]: [Id; 3], c: &[Id]) -> Id {
    let height = g.affine(&Exact::int(2), z, &-Exact::one());
    let (mut of_x, mut of_y) = (g.neg(c[3]), c[1]);
    if let [_, _, _, _, fourth, fifth] = *c {
        let (cross, rim) = (g.scale(&Exact::sqrt_ratio(5, 1), fourth), g.scale(&Exact::sqrt_ratio(5, 4), fifth));
        of_x = inner_from(g, of_x, &[(y, cross), (x, rim)]);
        of_y = g.mul_add(rim, y, of_y);
    }
    let up = g.mul(c[2], height);
    let minus = g.neg(of_y);
    let sum = inner_from(g, up, &[(x, of_x), (y, minus)]);
    let first = g.scale(&root(1, 2, -1), c[0]);
    g.scale_add(&root(3, 2, -1), sum, first)
}

fn of_monomials(spec: &Spec, count: usize, sum: fn(&mut Graph, [Id; 3], &[Id]) -> Id) -> Kernel {
    let mut builder = Builder::new();
    let dir = mean_normal(&mut builder, spec);
    let c = coefficients(&mut builder, count, &of_which_monomials(count));
    let sum = sum(&mut builder.graph, dir, &c);
    builder.finish(vec![sum], Shape::Scalar, "Σ c_i H_i(dir)")
}

fn to_monomial(count: usize) -> Kernel {
    let mut builder = Builder::new();
    let c = coefficients(&mut builder, count, &of_the_basis(count));
    let matrix: Vec<Vec<Exact>> = (0..count)
        .map(|monomial| in_monomials().iter().take(count).map(|row| row[monomial].clone()).collect())
        .collect();
    let out = rows(&mut builder.graph, &matrix, &c);
    builder.finish(out, Shape::Array(count), of_which_monomials(count))
}
