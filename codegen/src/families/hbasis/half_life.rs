//! The Half-Life 2 basis (McTaggart 2004): three cosines about an orthonormal frame, which are all linear functions of a
//! normal, orthonormal over the upper hemisphere (docs/MATH.md#half-life-2).

use crate::families::family::{Family, Measure, Spec};
use crate::families::hbasis::convert::from_to;
use crate::families::hbasis::evaluate::of_the_basis;
use crate::families::hbasis::space::{
    NORMALISED, OF_ONE_ORDER, coefficients, components, h, half_life, half_life_vectors, integrals, light, mean_normal,
    no_half, of_normals, product, rows,
};
use crate::families::parts::params::signal;
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::{Builder, Shape};

const LINEAR: Family = Family { orders: 2..=2, ..OF_ONE_ORDER };
const AT_A_NORMAL: Family = Family { choices: &[NORMALISED], unproven: NORMALISED, fault: no_half, ..LINEAR };

/// What three coefficients are.
const COEFFICIENTS: &str = "the three coefficients of the Half-Life 2 basis";
/// What a vector of irradiance is.
const VECTOR: &str = "the vector whose scalar product with a normal is the irradiance";

/// `hl2_basis`.
pub static HL2_BASIS: Family = Family {
    name: "hl2_basis",
    stem: "hl2_basis",
    measure: Measure::Absolute,
    what: |spec| {
        format!(
            "The Half-Life 2 basis at a normal: sqrt(3/2pi) times the cosines with (-1/sqrt6, -1/sqrt2, 1/sqrt3), (-1/sqrt6, 1/sqrt2, 1/sqrt3) and (sqrt(2/3), 0, 1/sqrt3) (McTaggart 2004; Habel and Wimmer 2010, eqs. 1 and 2). No cosine is clamped. {}",
            of_normals(spec)
        )
    },
    kernel: |spec| {
        let mut builder = Builder::new();
        let dir = mean_normal(&mut builder, spec);
        let all = along(&mut builder.graph, dir);
        builder.finish(all.to_vec(), Shape::Array(3), "the values of the basis")
    },
    shown: |order| with_normalised(&HL2_BASIS, order).collect(),
    ..AT_A_NORMAL
};

/// `hl2_eval`.
pub static HL2_EVAL: Family = Family {
    name: "hl2_eval",
    stem: "hl2_eval",
    what: |spec| format!("The sum of c_i b_i(dir) over the Half-Life 2 basis (McTaggart 2004). {}", of_normals(spec)),
    kernel: |spec| {
        let mut builder = Builder::new();
        let dir = mean_normal(&mut builder, spec);
        let c = coefficients(&mut builder, 3, COEFFICIENTS);
        let all = along(&mut builder.graph, dir);
        let sum = product(&mut builder.graph, &all, &c);
        builder.finish(vec![sum], Shape::Scalar, "Σ c_i b_i(dir)")
    },
    shown: |order| with_normalised(&HL2_EVAL, order).flat_map(Spec::both).collect(),
    ..AT_A_NORMAL
};

/// `sh3_to_hl2`.
pub static SH3_TO_HL2: Family = Family {
    name: "sh3_to_hl2",
    stem: "sh3_to_hl2_coefficients",
    orders: 3..=3,
    choices: &[&["irradiance"], &["over_pi"]],
    what: |spec| {
        let [from, to] = from_to(spec);
        format!(
            "From harmonics of order 3 of {from} to the Half-Life 2 basis, of {to}: the best approximation over the upper hemisphere (Habel and Wimmer 2010, eqs. 1 and 2)."
        )
    },
    kernel: |spec| {
        let mut builder = Builder::new();
        let c = signal(&mut builder, spec.order);
        let g = &mut builder.graph;
        // The three coefficients are the basis at the vector of moments.
        let moments = rows(g, &integrals(&components(), &light(spec)), &c);
        let all = along(g, [moments[0], moments[1], moments[2]]);
        builder.finish(all.to_vec(), Shape::Array(3), COEFFICIENTS)
    },
    shown: |order| {
        let specs = Spec::only(&SH3_TO_HL2, order).into_iter();
        specs.flat_map(|spec| [spec.clone(), spec.choosing("irradiance")]).flat_map(Spec::both).collect()
    },
    ..LINEAR
};

/// `hl2_to_h4`.
pub static HL2_TO_H4: Family = Family {
    name: "hl2_to_h4",
    stem: "hl2_to_h4_coefficients",
    what: |_| {
        "From coefficients of the Half-Life 2 basis to those of the same function in H4: exact, since it is linear in the normal (Habel and Wimmer 2010).".to_owned()
    },
    kernel: |_| {
        let mut builder = Builder::new();
        let c = coefficients(&mut builder, 3, COEFFICIENTS);
        let matrix = integrals(&h(4), &half_life());
        let g = &mut builder.graph;
        let (sum, difference) = (g.add(c[0], c[1]), g.sub(c[0], c[1]));
        let all = g.add(sum, c[2]);
        let tilted = g.scale(&matrix[3][0], sum);
        let out = vec![
            g.scale(&matrix[0][0], all),
            g.scale(&matrix[1][0], difference),
            g.scale(&matrix[2][0], all),
            g.scale_add(&matrix[3][2], c[2], tilted),
        ];
        builder.finish(out, Shape::Array(4), of_the_basis(4))
    },
    shown: |order| Spec::only(&HL2_TO_H4, order).into_iter().flat_map(Spec::both).collect(),
    ..LINEAR
};

/// `hl2_to_vector`.
pub static HL2_TO_VECTOR: Family = Family {
    name: "hl2_to_vector",
    stem: "hl2_to_vector",
    what: |_| {
        "From coefficients of the Half-Life 2 basis to the vector that `hl2_eval_vector` takes, the directional occlusion of engines; done once, when they are stored.".to_owned()
    },
    kernel: |_| {
        let mut builder = Builder::new();
        let c = coefficients(&mut builder, 3, COEFFICIENTS);
        let [near, other, far] = half_life_vectors();
        let g = &mut builder.graph;
        let (sum, difference) = (g.add(c[0], c[1]), g.sub(c[1], c[0]));
        let all = g.add(sum, c[2]);
        let tilted = g.scale(&near[0], sum);
        let out = vec![g.scale_add(&far[0], c[2], tilted), g.scale(&other[1], difference), g.scale(&near[2], all)];
        builder.finish(out, Shape::Array(3), VECTOR)
    },
    shown: |order| Spec::only(&HL2_TO_VECTOR, order).into_iter().flat_map(Spec::both).collect(),
    ..LINEAR
};

/// `hl2_eval_vector`.
pub static HL2_EVAL_VECTOR: Family = Family {
    name: "hl2_eval_vector",
    stem: "hl2_eval_vector",
    what: |spec| format!("The Half-Life 2 basis' sum from the vector that `hl2_to_vector` makes. {}", of_normals(spec)),
    kernel: |spec| {
        let mut builder = Builder::new();
        let dir = mean_normal(&mut builder, spec);
        let c = coefficients(&mut builder, 3, VECTOR);
        let sum = product(&mut builder.graph, &dir, &c);
        builder.finish(vec![sum], Shape::Scalar, "Σ c_i b_i(dir)")
    },
    shown: |order| with_normalised(&HL2_EVAL_VECTOR, order).flat_map(Spec::both).collect(),
    ..AT_A_NORMAL
};

fn with_normalised(family: &'static Family, order: usize) -> impl Iterator<Item = Spec> {
    Spec::only(family, order).into_iter().flat_map(|spec| [spec.clone(), spec.choosing(NORMALISED[0])])
}

/// The basis at a vector: z along, x and y across, five operations.
fn along(g: &mut Graph, [x, y, z]: [Id; 3]) -> [Id; 3] {
    let [near, other, far] = half_life_vectors();
    let up = g.scale(&near[2], z);
    let third = g.scale_add(&far[0], x, up);
    let middle = g.scale_add(&near[0], x, up);
    [g.scale_add(&near[1], y, middle), g.scale_add(&other[1], y, middle), third]
}
