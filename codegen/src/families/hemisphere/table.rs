//! A rotation on the hemisphere whose middle angle is a given matrix: two rotations about z, which are the sphere's, and
//! between them what a table holds (the third method of Gautron et al. 2004, with any extension below the horizon;
//! docs/MATH.md#rotation-on-the-hemisphere).

use crate::families::family::{Family, Measure, Spec};
use crate::families::hemisphere::methods::between_z;
use crate::families::hemisphere::{COMMON, signal};
use crate::families::parts::phases::phases;
use crate::ir::kernel::{Builder, Domain, Kernel, Shape};
use crate::math::exact::Exact;
use crate::math::hemisphere::{Below, about_y};
use crate::math::index::coefficients;

/// `hsh_rotate_table`.
pub static ROTATE_TABLE: Family = Family {
    name: "hsh_rotate_table",
    stem: "hsh_rotate_table",
    what: |spec| {
        let order = spec.order;
        format!(
            "Rotates hemispherical coefficients of order {order} by z, y, z, the rotation about y being a given matrix, such as an interpolated entry of a table over its angle (third method of Gautron et al. 2004); a matrix of `hsh_y_record:{order}:sh=16` is that of a record of radiance."
        )
    },
    kernel: |spec| kernel(spec.order),
    measure: Measure::Product,
    shown: |order| if matches!(order, 3..=4) { Spec::new(&ROTATE_TABLE, order).both() } else { vec![] },
    ..COMMON
};

/// Rows and columns of the entries that are not zero for every angle, in the order in which a table holds them: where row and
/// column have m ≥ 0, row by row, then where both have m < 0.
pub fn places(order: usize) -> Vec<[usize; 2]> {
    let of = |is_negative: bool| -> Vec<usize> {
        coefficients(order).enumerate().filter(|(_, (_, m))| (*m < 0) == is_negative).map(|(place, _)| place).collect()
    };
    [false, true]
        .into_iter()
        .flat_map(|is_negative| {
            let all = of(is_negative);
            let columns = all.clone();
            all.into_iter().flat_map(move |row| columns.clone().into_iter().map(move |column| [row, column]))
        })
        .collect()
}

/// The entries of the matrix that turns about y by an angle in radians, as `hsh_rotate_table` takes them.
pub fn entries(order: usize, below: Below, beta: f64) -> Vec<f64> {
    let matrix = about_y(order, below, beta);
    places(order).into_iter().map(|[row, column]| matrix[row][column]).collect()
}

fn kernel(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pairs(2), Domain::Phases, "(cos, sin) of α and γ in Rz(α) Ry(β) Rz(γ)");
    let places = places(order);
    let doc = "the entries of the matrix of Ry(β): row by row those where row and column have m >= 0, then those where both have m < 0";
    let m = builder.param("m", Shape::Array(places.len()), Domain::Grey, doc);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let angles = phases(&cs);
    let out = between_z(g, &c, [angles[0], angles[1]], |g, c| {
        let mut out = vec![g.constant(Exact::zero()); order * order];
        for ([row, column], &entry) in places.iter().zip(&m) {
            out[*row] = g.mul_add(entry, c[*column], out[*row]);
        }
        out
    });
    builder.finish(out, Shape::Array(order * order), "the rotated hemispherical coefficients")
}
