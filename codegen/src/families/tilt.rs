//! The tilt: the rotation that takes z to a normal by the shortest way, from the normal alone, with no trigonometry.
//! Bands 1 and 2 are exact closed forms; from band 3 on three or five parity shears, regular at n = z and odd in (nx, ny), so
//! that the inverse is the same code with −n (docs/MATH.md#the-tilt).

use crate::families::family::{Acts, AngleAs, ByBand, Does, Family, Group, Job, Spec, Spelled, small_angle};
use crate::families::parts::bands::each_band;
use crate::families::parts::params::{normal, signal};
use crate::families::parts::small_angle::{ParityShear, SmallAngle, names, parity_shears};
use crate::families::parts::sums::inner;
use crate::ir::graph::{Graph, Id};
use crate::ir::kernel::Domain;
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;
use crate::math::index::coefficients;
use crate::math::tables;

const BY_BAND: ByBand = ByBand {
    spelled: Spelled::AsOption,
    given: AngleAs::Normal,
    in_band: |l| if l < 3 { &[SmallAngle::Exact] } else { &[SmallAngle::Lf3, SmallAngle::Lf5] },
    rule: [
        "a tilt is exact in bands 1 and 2 and takes `lf3` or `lf5` in the others",
        "write it as in `tilt:5:lf5` or `tilt:5:exact+exact+lf3+lf5`",
    ],
    plane: |order, methods| tilt(order, methods, Stored::Plainly),
};

/// A family's kernels with lf3 and with lf5.
fn both_shears(family: &'static Family, order: usize) -> Vec<Spec> {
    [SmallAngle::Lf3, SmallAngle::Lf5]
        .into_iter()
        .flat_map(|method| Spec::new(family, order).by(method).both())
        .collect()
}

/// `tilt`.
pub static TILT: Family = Family {
    name: "tilt",
    stem: "tilt",
    group: Group::Tilt,
    what: |spec| match spec.order {
        order @ 2..=3 => {
            format!("Tilts order {order}: the shortest rotation from z to a normal, exactly, with no trigonometry.")
        }
        order => format!(
            "Tilts order {order}: the shortest rotation from z to a normal, with no trigonometry; bands 1 and 2 exactly, the others by shears that are regular at n = z ({}). The inverse is the same with (-n.x, -n.y, n.z).",
            names(&spec.methods[2..])
        ),
    },
    by_band: Some(BY_BAND),
    kernel: |spec| tilt(spec.order, &spec.methods, Stored::Plainly),
    does: |_, _| vec![Does::job(Job::Tilt)],
    shown: |order| match order {
        2 | 3 => Spec::new(&TILT, order).both(),
        _ => both_shears(&TILT, order),
    },
    ..Family::PLAIN
};

/// `tilt_prescaled`.
pub static TILT_PRESCALED: Family = Family {
    name: "tilt_prescaled",
    stem: "tilt_prescaled",
    group: Group::Tilt,
    what: |spec| {
        let order = spec.order;
        format!(
            "Tilts order {order} as `tilt` does ({}), on coefficients that `tilt_scale:{order}` has divided: the couplings of neighbours are in the stored data. What it is multiplied with, such as a light, is scaled the other way, by `tilt_unscale:{order}`.",
            names(spec.methods.get(2..).unwrap_or_default())
        )
    },
    by_band: Some(BY_BAND),
    kernel: |spec| tilt(spec.order, &spec.methods, Stored::Divided),
    acts: Acts::Bands,
    shown: |order| if order > 3 { both_shears(&TILT_PRESCALED, order) } else { vec![] },
    ..Family::PLAIN
};

/// `tilt_scale`.
pub static TILT_SCALE: Family = Family {
    name: "tilt_scale",
    stem: "tilt_scale",
    group: Group::Tilt,
    what: |spec| {
        let order = spec.order;
        format!(
            "Divides the coefficients of order {order} as `tilt_prescaled:{order}` takes them; done once, when they are stored."
        )
    },
    kernel: |spec| {
        let doc = "the coefficients as `tilt_prescaled` takes them";
        rescaled(spec.order, doc, |scale| &Exact::one() / &scale)
    },
    acts: Acts::Bands,
    shown: |order| if order > 3 { Spec::new(&TILT_SCALE, order).both() } else { vec![] },
    ..Family::PLAIN
};

/// `tilt_unscale`.
pub static TILT_UNSCALE: Family = Family {
    name: "tilt_unscale",
    stem: "tilt_unscale",
    group: Group::Tilt,
    what: |spec| {
        let order = spec.order;
        format!(
            "The inverse of `tilt_scale:{order}`: for tilted coefficients, or for a light that they are multiplied with."
        )
    },
    kernel: |spec| {
        let doc = "the coefficients that were scaled; those of a light, to be multiplied with scaled ones";
        rescaled(spec.order, doc, |scale| scale)
    },
    acts: Acts::Bands,
    shown: |order| if order > 3 { Spec::new(&TILT_UNSCALE, order).both() } else { vec![] },
    ..Family::PLAIN
};

/// What every band needs of the normal.
struct Normal {
    x: Id,
    y: Id,
    z: Id,
    /// nx² + ny².
    u: Id,
    /// 1 / (1 + nz).
    k: Id,
}

/// Band 1 exactly: six operations.
fn band_1(g: &mut Graph, band: &[Id], n: &Normal) -> Vec<Id> {
    let [y, z, x] = [g.neg(band[0]), band[1], g.neg(band[2])];
    let d = inner(g, &[x, y], &[n.x, n.y]);
    let kd = g.mul(d, n.k);
    let w = g.sub(z, kd);
    let zz = g.mul(z, n.z);
    let out = [g.mul_add(w, n.y, y), g.sub(zz, d), g.mul_add(w, n.x, x)];
    vec![g.neg(out[0]), out[1], g.neg(out[2])]
}

/// Band 2 exactly: thirty operations and no multiple angle.
fn band_2(g: &mut Graph, band: &[Id], n: &Normal) -> Vec<Id> {
    let root3 = Exact::sqrt_ratio(3, 1);
    let (p12, c0, c2) = (band[0], band[2], band[4]);
    let q = [g.neg(band[3]), g.neg(band[1])];
    let weighted = g.scale(&root3, c0);
    let p11 = g.sub(c2, weighted);
    let p22 = g.add(c2, weighted);
    let p22 = g.neg(p22);
    let xy = [n.x, n.y];
    let p = [inner(g, &[p11, p12], &xy), inner(g, &[p12, p22], &xy)];
    let (a, b) = (inner(g, &p, &xy), inner(g, &q, &xy));
    let ka = g.mul(a, n.k);
    let twice = g.scale(&Exact::int(2), b);
    let capital = g.sub(ka, twice);
    let half_k = g.scale(&Exact::ratio(1, 2), n.k);
    let e = g.mul(capital, half_k);
    let f = g.mul_add(b, n.k, capital);
    let w: [Id; 2] = std::array::from_fn(|i| {
        let kp = g.mul(p[i], n.k);
        let rest = g.sub(q[i], kp);
        g.mul_add(e, xy[i], rest)
    });
    let out_2 = g.mul_add(w[0], n.x, c2);
    let yy = g.mul(w[1], n.y);
    let out_2 = g.sub(out_2, yy);
    let out_12 = g.mul_add(w[1], n.x, p12);
    let out_12 = g.mul_add(w[0], n.y, out_12);
    let nw = inner(g, &w, &xy);
    let out_0 = g.scale_add(&-&root3, nw, c0);
    let q_out: [Id; 2] = std::array::from_fn(|i| {
        let zq = g.mul(q[i], n.z);
        let rest = g.sub(zq, p[i]);
        g.mul_add(f, xy[i], rest)
    });
    vec![out_12, g.neg(q_out[1]), out_0, g.neg(q_out[0]), out_2]
}

/// What every prescaled row of a band takes from the row above it: about the geometric mean of the couplings, so that the
/// factors of [`scale`] stay near one.
fn unit(l: usize) -> Exact {
    let product: f64 = (1..=l).map(|m| tables::ladder(l, m).to_f64()).product();
    Exact::int(product.powf(1.0 / l as f64).round() as i64)
}

/// How the coefficients are stored that are tilted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stored {
    /// As they are.
    Plainly,
    /// Each divided by [`scale`].
    Divided,
}

impl Stored {
    /// What row m of band l takes from m + 1: the ladder's coupling, or what [`scale`] makes of it.
    fn coupling_above(self, l: usize, m: usize) -> Exact {
        match self {
            Self::Plainly => tables::ladder(l, m + 1),
            Self::Divided => unit(l),
        }
    }

    /// What row m takes from m − 1.
    fn coupling_below(self, l: usize, m: usize) -> Exact {
        let a = tables::ladder(l, m);
        match self {
            Self::Plainly => a,
            Self::Divided => &(&a * &a) / &unit(l),
        }
    }
}

/// What a coefficient is divided by where it is stored for `tilt_prescaled`: one in bands 0 to 2; in a higher band it
/// makes all rows take alike from the row above.
pub fn scale(l: usize, m: isize) -> Exact {
    match l {
        0..=2 => Exact::one(),
        _ => (1..=m.unsigned_abs()).fold(Exact::one(), |d, m| &(&d * &unit(l)) / &tables::ladder(l, m)),
    }
}

/// The coefficients of one parity's shear: for each of its rows m, (x, y) times the coupling that is written as one.
struct Shear {
    parity: usize,
    rows: Vec<Row>,
}

/// A row of a shear.
struct Row {
    /// (x, y) times the coupling to one neighbour.
    pair: [Id; 2],
    /// The couplings to m + 1 and to m − 1 against that one.
    up: Exact,
    down: Exact,
}

impl Shear {
    /// `constant` + `linear` · u times (nx, ny), times each row's coupling to the row above, the last row's to the row
    /// below.
    fn new(g: &mut Graph, n: &Normal, l: usize, parity: usize, [constant, linear]: [Exact; 2], stored: Stored) -> Self {
        let (above, below) = (|m| stored.coupling_above(l, m), |m| stored.coupling_below(l, m));
        let own = |m: usize| if m < l { above(m) } else { below(m) };
        let first = own(parity);
        let factor = g.affine(&(&first * &linear), n.u, &(&first * &constant));
        let pair = [g.mul(factor, n.x), g.mul(factor, n.y)];
        let rows = (parity..=l)
            .step_by(2)
            .map(|m| {
                let own = own(m);
                let ratio = &own / &first;
                Row {
                    pair: pair.map(|value| g.scale(&ratio, value)),
                    up: if m < l { &above(m) / &own } else { Exact::zero() },
                    down: if m > 0 { &below(m) / &own } else { Exact::zero() },
                }
            })
            .collect();
        Self { parity, rows }
    }

    /// x ← x + f A_φ x for the rows of this parity.
    fn apply(&self, g: &mut Graph, x: &mut [Id], l: usize) {
        let old = x.to_vec();
        let (re, im) = (|m: usize| old[l + m], |m: usize| old[l - m]);
        for (m, Row { pair: [c, s], up, down }) in (self.parity..=l).step_by(2).zip(&self.rows) {
            // Upwards a_{m+1} (c − i s) ζ_{m+1}, from below −a_m (c + i s) ζ_{m−1}.
            let zero = g.constant(Exact::zero());
            let (up_re, up_im) = if m < l { (re(m + 1), im(m + 1)) } else { (zero, zero) };
            let (down_re, down_im) = match m {
                0 => (zero, zero),
                1 => (re(0), zero),
                _ => (re(m - 1), im(m - 1)),
            };
            let combine = |g: &mut Graph, below: &Exact, low: Id, high: Id| {
                let above = g.scale(up, high);
                g.scale_add(below, low, above)
            };
            let (minus, plus) = (-down, down.clone());
            let difference_re = combine(g, &minus, down_re, up_re);
            let sum_im = combine(g, &plus, down_im, up_im);
            let mut row = g.mul_add(difference_re, *c, re(m));
            row = g.mul_add(sum_im, *s, row);
            x[l + m] = row;
            if m > 0 {
                let difference_im = combine(g, &minus, down_im, up_im);
                let sum_re = combine(g, &plus, down_re, up_re);
                let row = g.mul_add(difference_im, *c, im(m));
                let term = g.mul(sum_re, *s);
                x[l - m] = g.sub(row, term);
            }
        }
    }
}

/// Three or five shears, β the tilt. With sin β for β the series' second coefficient takes c₀/6 more.
fn shears(g: &mut Graph, band: &[Id], n: &Normal, method: SmallAngle, stored: Stored) -> Vec<Id> {
    let l = band.len() / 2;
    let mut x = band.to_vec();
    for ParityShear { parity, series: [first, third] } in parity_shears(l, method) {
        let third = &third + &(&first / &Exact::int(6));
        Shear::new(g, n, l, parity, [first, third], stored).apply(g, &mut x, l);
    }
    x
}

/// The kernels `tilt` and `tilt_prescaled`, with `methods[l − 1]` for band l: exact for bands 1 and 2, shears for the
/// others.
fn tilt(order: usize, methods: &[SmallAngle], stored: Stored) -> Kernel {
    let mut builder = Builder::new();
    let domain = match methods.iter().all(|method| *method == SmallAngle::Exact) {
        true => Domain::Hemisphere,
        false => Domain::Tilt(small_angle()),
    };
    let n = normal(&mut builder, domain);
    let c = match stored {
        Stored::Divided => {
            let doc = format!("the coefficients as `tilt_scale:{order}` stores them");
            builder.param("c", Shape::Array(order * order), Domain::Signal, doc)
        }
        Stored::Plainly => signal(&mut builder, order),
    };
    let out = each_tilted(&mut builder.graph, &n, &c, order, methods, stored);
    let doc = match stored {
        Stored::Plainly => "the tilted coefficients",
        Stored::Divided => "the tilted coefficients, scaled alike",
    };
    builder.finish(out, Shape::Array(order * order), doc)
}

/// Tilts every band.
fn each_tilted(g: &mut Graph, n: &[Id], c: &[Id], order: usize, methods: &[SmallAngle], stored: Stored) -> Vec<Id> {
    let one = g.constant(Exact::one());
    let above = g.add(n[2], one);
    let n = Normal { x: n[0], y: n[1], z: n[2], u: inner(g, &n[..2], &n[..2]), k: g.recip(above) };
    each_band(g, c, order, |g, l, band| match l {
        0 => band.to_vec(),
        1 => band_1(g, band, &n),
        2 => band_2(g, band, &n),
        _ => shears(g, band, &n, methods[l - 1], stored),
    })
}

/// Tilts the bands 0 to 2 at most, exactly.
pub fn exactly(g: &mut Graph, n: &[Id], c: &[Id], order: usize) -> Vec<Id> {
    each_tilted(g, n, c, order, &[], Stored::Plainly)
}

/// The kernels `tilt_scale` and `tilt_unscale`: each coefficient times what `factor` makes of its [`scale`].
fn rescaled(order: usize, doc: &str, factor: impl Fn(Exact) -> Exact) -> Kernel {
    let mut builder = Builder::new();
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let out = coefficients(order).zip(&c).map(|((l, m), &value)| g.scale(&factor(scale(l, m)), value)).collect();
    builder.finish(out, Shape::Array(order * order), doc)
}
