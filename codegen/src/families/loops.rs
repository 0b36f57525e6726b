//! The loop forms: the three kernels that have one, each as tables and a few loops that serve every order. They do what
//! the straight lines of the other files do, in less text; on no GPU are they faster, whatever they index (docs/GPU.md).

use crate::families::family::small_angle;
use crate::ir::graph::Kind;
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Param, Shape};
use crate::ir::program::{Int, LoopKernel, Name, Num, Stmt, Table};
use crate::math::exact::Exact;
use crate::math::index::coefficients;
use crate::math::tables;
use std::collections::HashMap;

fn signal(order: usize) -> Param {
    Param::new("c", Shape::Array(order * order), Domain::Signal, "the coefficients, index l(l+1)+m")
}

fn table(name: Name, values: Vec<Exact>, doc: &str) -> Table {
    Table { name, values, doc: doc.to_owned() }
}

/// A kernel whose result is the array `r` of n² numbers.
fn kernel(order: usize, params: Vec<Param>, tables: Vec<Table>, mut body: Vec<Stmt>, result_doc: &str) -> LoopKernel {
    let result_kind = params.iter().map(|param| param.kind).max();
    let result_kind = result_kind.unwrap_or(Kind::Scalar);
    let count = order * order;
    body.insert(0, Stmt::Array("r", count, result_kind));
    LoopKernel {
        params,
        tables,
        body,
        output: "r",
        result: Shape::Array(count),
        result_kind,
        result_doc: result_doc.to_owned(),
    }
}

/// About y by a small β: `shRotYdiff15` of Křivánek et al. 2005 with its two tables, one loop over all bands, since
/// the couplings between bands are zero.
pub fn taylor15_loop(order: usize) -> LoopKernel {
    let last = order * order - 1;
    let c = |at: &Int| Num::item("c", at);
    let scaled = |at: &Int| {
        let factor = Num::from("half_square") * Num::item("DDY_DIAG", at) + Exact::one();
        c(at) * factor
    };
    let below = |at: &Int| c(&(at - 1)) * Num::item("DY_SUB_DIAG", at);
    let above = |at: &Int| c(&(at + 1)) * Num::item("DY_SUB_DIAG", at + 1);
    let (i, end) = (Int::Name("i"), Int::Literal(last));
    let body = vec![
        Stmt::Let("half_square", Num::from(Exact::ratio(1, 2)) * "beta" * "beta"),
        Stmt::store("r", 0, c(&Int::Literal(0))),
        Stmt::each("i", 1, last, vec![Stmt::store("r", &i, scaled(&i) + (below(&i) - above(&i)) * "beta")]),
        Stmt::store("r", &end, scaled(&end) + below(&end) * "beta"),
    ];
    let sub_diag = coefficients(order).map(|(l, m)| tables::dy_sub_diag(l, m));
    let diag = coefficients(order).map(|(l, m)| tables::ddy_diag(l, m));
    let tables = vec![
        table("DY_SUB_DIAG", sub_diag.collect(), "dD/dbeta at 0, from m - 1 to m"),
        table("DDY_DIAG", diag.collect(), "the diagonal of the second derivative of D at 0"),
    ];
    let angle = "the angle about y in radians, small";
    let params = vec![Param::new("beta", Shape::Scalar, Domain::Angle(small_angle()), angle), signal(order)];
    kernel(order, params, tables, body, "the rotated coefficients")
}

/// The recurrence y_l = a z y_{l−1} − b y_{l−2} up the column m from its start y_{m,±m}. Each part of the column has names
/// for a value and the two below it, and a place in the result.
fn column(order: usize, m: &Int, parts: &[([Name; 3], Int)]) -> Stmt {
    let (l, at) = (Int::Name("l"), Int::Name("at"));
    let mut body =
        vec![Stmt::Int("at", &l * (&l - 1) / 2 + m), Stmt::Let("az", Num::item("A", &at) * Num::item("dir", 2))];
    for ([next, last, before], place) in parts {
        let value = Num::from(*last) * "az" - Num::from(*before) * Num::item("B", &at);
        body.extend([
            Stmt::Let(next, value),
            Stmt::Set(before, Num::Name(last)),
            Stmt::Set(last, Num::Name(next)),
            Stmt::store("r", place, *next),
        ]);
    }
    Stmt::each("l", m + 1, order, body)
}

/// All values at a direction by the normalised recurrence in l, which starts at y_{m,±m} and so holds (x + iy)^m: no
/// order overflows, and no pole is special.
pub fn basis_loop(order: usize) -> LoopKernel {
    let (l, m) = (Int::Name("l"), Int::Name("m"));
    let zero = || Num::from(Exact::zero());
    let first = || Num::from(tables::k(0, 0));
    let cosines = ["cos_next", "cos_last", "cos_before"];
    let sines = ["sin_next", "sin_last", "sin_before"];
    let sectoral = Num::item("SECTORAL", &m - 1);
    let body = vec![
        Stmt::store("r", 0, first()),
        Stmt::Var("cos_last", first()),
        Stmt::Var("cos_before", zero()),
        column(order, &Int::Literal(0), &[(cosines, &l * &l + &l)]),
        Stmt::Var("re", first()),
        Stmt::Var("im", zero()),
        Stmt::each(
            "m",
            1,
            order,
            vec![
                Stmt::Let("kx", &sectoral * Num::item("dir", 0)),
                Stmt::Let("ky", &sectoral * Num::item("dir", 1)),
                Stmt::Let("turned", Num::from("re") * "kx" - Num::from("im") * "ky"),
                Stmt::Set("im", Num::from("im") * "kx" + Num::from("re") * "ky"),
                Stmt::Set("re", "turned".into()),
                Stmt::store("r", &m * &m + &m * 2, "re"),
                Stmt::store("r", &m * &m, "im"),
                Stmt::Set("cos_last", "re".into()),
                Stmt::Set("cos_before", zero()),
                Stmt::Var("sin_last", "im".into()),
                Stmt::Var("sin_before", zero()),
                column(order, &m, &[(cosines, &l * &l + &l + &m), (sines, &l * &l + &l - &m)]),
            ],
        ),
    ];
    let (a, b) = (1..order).flat_map(|l| (0..l).map(move |m| tables::legendre_recurrence(l, m))).unzip();
    let sectoral = |m: usize| match m {
        1 => -Exact::sqrt_ratio(3, 1),
        _ => -Exact::sqrt_ratio(2 * m + 1, 2 * m),
    };
    let tables = vec![
        table("A", a, "y_l = a z y_(l-1) - b y_(l-2) for each m: a, at l(l-1)/2 + |m|"),
        table("B", b, "b, at the same places"),
        table("SECTORAL", (1..order).map(sectoral).collect(), "y_mm by y_(m-1)(m-1) and x + iy, from m = 1"),
    ];
    let direction = "the direction, of unit length";
    let params = vec![Param::new("dir", Shape::Vec3, Domain::Direction, direction)];
    kernel(order, params, tables, body, "y_lm(dir), bands ascending, m from −l to l")
}

/// The entries of J, the exchange of y and z, that are not zero by their place: n(n² + 2)/3 − 1 of them, from band 1, by
/// row. Rows r and columns i of a band count from 0: i ≥ l where r is even, i < l where r is odd, and of these the even i
/// where r ≥ l, the odd i where r < l.
fn exchange(order: usize) -> Vec<Exact> {
    let mut all = Vec::new();
    for l in 1..order {
        let degree = |i: usize| i as isize - l as isize;
        let mut known: HashMap<[usize; 2], Exact> = HashMap::new();
        for r in 0..=2 * l {
            let columns = if r % 2 == 0 { l..2 * l + 1 } else { 0..l };
            for i in columns.filter(|i| (i % 2 == 0) == (r >= l)) {
                let entry =
                    known.entry([r.min(i), r.max(i)]).or_insert_with(|| tables::swap_yz(l, degree(r), degree(i)));
                all.push(entry.clone());
            }
        }
    }
    all
}

/// J of one band: from its place in `r` to `swapped`. `even` and `low` are one in even rows and in rows before the
/// middle, and say where a row's columns start.
fn swap(l: &Int) -> [Stmt; 3] {
    let [k, row, even, start, first] = ["k", "row", "even", "start", "first"].map(Int::Name);
    let term = |i: &Int| Num::item("r", l * l + i) * Num::item("J", &k);
    let rows = vec![
        Stmt::Int("even", (&row + 1) % 2),
        Stmt::Int("low", Int::Literal(1) - (&row + 1) / (l + 1)),
        Stmt::Int("start", &even * l),
        Stmt::Int("first", &start + (&start + "low") % 2),
        Stmt::Var("sum", term(&first)),
        Stmt::Advance("k"),
        Stmt::For {
            name: "i",
            from: &first + 2,
            to: &start + l + &even,
            step: 2,
            body: vec![Stmt::Set("sum", Num::from("sum") + term(&Int::Name("i"))), Stmt::Advance("k")],
        },
        Stmt::store("swapped", &row, "sum"),
    ];
    let width = l * 2 + 1;
    [
        Stmt::Counter("k", l * (l * l + 2) / 3 - 1),
        Stmt::each("row", 0, &width, rows),
        Stmt::Stage("swapped", Int::Literal(0), width),
    ]
}

/// One band about z by a row of the phases: from an array, in which the band's middle has this place, to `r`.
fn about_z(order: usize, angle: Int, l: &Int, from: Name, place: &Int) -> [Stmt; 3] {
    let (m, middle) = (Int::Name("m"), Int::Name("middle"));
    let phase = &angle * order + &m;
    let [plus, minus] = ["plus", "minus"].map(Num::Name);
    let turn = vec![
        Stmt::Let("co", Num::item("phase_cos", &phase)),
        Stmt::Let("si", Num::item("phase_sin", &phase)),
        Stmt::Let("plus", Num::item(from, place + &m)),
        Stmt::Let("minus", Num::item(from, place - &m)),
        Stmt::store("r", &middle + &m, &plus * "co" - &minus * "si"),
        Stmt::store("r", &middle - &m, &minus * "co" + &plus * "si"),
    ];
    [
        Stmt::store("r", &middle, Num::item(from, place)),
        Stmt::each("m", 1, l + 1, turn),
        Stmt::Stage("r", l * l, l * 2 + 1),
    ]
}

/// A row of multiples each for −β, α and γ: the phases of a quaternion as [`crate::families::zyz`] has them, without
/// trigonometry or branch, then complex products.
fn phases(order: usize) -> Vec<Stmt> {
    let q = |i: usize| Num::item("q", i);
    let [x, y, z, w] = ["x", "y", "z", "w"].map(Num::Name);
    let [wy, zx, zy, wx] = ["wy", "zx", "zy", "wx"].map(Num::Name);
    let [beta, alpha, gamma] = [0, 1, 2].map(|angle| angle * order + 1);
    let at = Int::Name("base") + "m";
    let product = |a: Name, b: Name| Num::item(a, &at - 1) * Num::item(b, Int::Name("base") + 1);
    let cos = product("phase_cos", "phase_cos") - product("phase_sin", "phase_sin");
    let sin = product("phase_sin", "phase_cos") + product("phase_cos", "phase_sin");
    let multiples = vec![Stmt::store("phase_cos", &at, cos), Stmt::store("phase_sin", &at, sin)];
    vec![
        Stmt::Array("phase_cos", 3 * order, Kind::Scalar),
        Stmt::Array("phase_sin", 3 * order, Kind::Scalar),
        Stmt::Let("x", q(0)),
        Stmt::Let("y", q(1) + Num::Tiny),
        Stmt::Let("z", q(2)),
        Stmt::Let("w", q(3) + Num::Tiny),
        Stmt::Let("ww_zz", &w * &w + &z * &z),
        Stmt::Let("xx_yy", &x * &x + &y * &y),
        Stmt::Let("product", Num::from("ww_zz") * "xx_yy"),
        Stmt::Let("scale", Num::from("product").rsqrt()),
        Stmt::Let("w_unit", &w * "scale"),
        Stmt::Let("z_unit", &z * "scale"),
        Stmt::Let("wy", Num::from("w_unit") * &y),
        Stmt::Let("zx", Num::from("z_unit") * &x),
        Stmt::Let("zy", Num::from("z_unit") * &y),
        Stmt::Let("wx", Num::from("w_unit") * &x),
        Stmt::store("phase_cos", beta, Num::from("ww_zz") - "xx_yy"),
        Stmt::store("phase_sin", beta, -(Num::from(Exact::int(2)) * (Num::from("product") * "scale"))),
        Stmt::store("phase_cos", alpha, &wy + &zx),
        Stmt::store("phase_sin", alpha, &zy - &wx),
        Stmt::store("phase_cos", gamma, &wy - &zx),
        Stmt::store("phase_sin", gamma, &zy + &wx),
        Stmt::each(
            "angle",
            0,
            3,
            vec![Stmt::Int("base", Int::Name("angle") * order), Stmt::each("m", 2, order, multiples)],
        ),
    ]
}

/// The rotation by a unit quaternion, Z(α) J Z(−β) J Z(γ) band by band, as accurate at every order. Its table has
/// n(n² + 2)/3 − 1 entries: 339 at order 10, 87,423 at order 64.
pub fn rotate_loop(order: usize) -> LoopKernel {
    let [l, middle, stage] = ["l", "middle", "stage"].map(Int::Name);
    let mut tilt = swap(&l).to_vec();
    tilt.extend(about_z(order, stage, &l, "swapped", &l));
    let mut band = vec![Stmt::Int("middle", &l * &l + &l)];
    band.extend(about_z(order, Int::Literal(2), &l, "c", &middle));
    band.push(Stmt::each("stage", 0, 2, tilt));
    let mut body = phases(order);
    body.extend([
        Stmt::Array("swapped", 2 * order - 1, Kind::Signal),
        Stmt::store("r", 0, Num::item("c", 0)),
        Stmt::each("l", 1, order, band),
    ]);
    let rotation = "the rotation, a unit quaternion (x, y, z, w)";
    let params = vec![Param::new("q", Shape::Vec4, Domain::Quaternion, rotation), signal(order)];
    let doc = "J, which exchanges y and z, by band and row from 0: in even rows the columns from l, in odd rows those\n\
               below l; of these the even columns in the rows from l, the odd columns in those below l";
    let tables = vec![table("J", exchange(order), doc)];
    kernel(order, params, tables, body, "the rotated coefficients")
}
