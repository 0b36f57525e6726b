//! The tilt: the rotation that takes z to a normal by the shortest way, from the normal alone, with no trigonometry.
//! Bands 1 and 2 are exact closed forms; from band 3 on three parity shears, regular at n = z and odd in (nx, ny), so
//! that the inverse is the same code with −n (MATH section 9).

use crate::graph::{Graph, Id};
use crate::kernel::{Builder, Kernel, Shape};
use crate::kernels::inner;
use crate::kernels::rotate::{each_band, normal, signal};
use crate::kernels::y_rotation::lf3_correction;
use crate::sh::exact::Exact;
use crate::sh::tables;

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

/// The coefficients of one parity's shear: for each of its rows m, (x, y) times the coupling to the row above; for the
/// last row, to the row below.
struct Shear {
    parity: usize,
    rows: Vec<[Id; 2]>,
}

impl Shear {
    /// `constant` + `linear` · u times (nx, ny) is the first row's pair but for its coupling; the others are multiples.
    fn new(g: &mut Graph, n: &Normal, l: usize, parity: usize, [constant, linear]: [Exact; 2]) -> Self {
        let coupling = |m: usize| tables::ladder(l, (m + 1).min(l));
        let first = coupling(parity);
        let factor = g.affine(&(&first * &linear), n.u, &(&first * &constant));
        let pair = [g.mul(factor, n.x), g.mul(factor, n.y)];
        let rows = (parity..=l)
            .step_by(2)
            .map(|m| {
                let ratio = &coupling(m) / &first;
                pair.map(|value| g.scale(&ratio, value))
            })
            .collect();
        Self { parity, rows }
    }

    /// x ← x + f A_φ x for the rows of this parity.
    fn apply(&self, g: &mut Graph, x: &mut [Id], l: usize) {
        let old = x.to_vec();
        let (re, im) = (|m: usize| old[l + m], |m: usize| old[l - m]);
        for (m, &[c, s]) in (self.parity..=l).step_by(2).zip(&self.rows) {
            // Upwards a_{m+1} (c − i s) ζ_{m+1}, from below −a_m (c + i s) ζ_{m−1}; ρ = a_m / a_{m+1}.
            let minus_rho = if m == 0 {
                Exact::zero()
            } else if m == l {
                Exact::int(-1)
            } else {
                -&(&tables::ladder(l, m) / &tables::ladder(l, m + 1))
            };
            let plus_rho = -&minus_rho;
            let zero = g.constant(Exact::zero());
            let (up_re, up_im) = if m < l { (re(m + 1), im(m + 1)) } else { (zero, zero) };
            let (down_re, down_im) = match m {
                0 => (zero, zero),
                1 => (re(0), zero),
                _ => (re(m - 1), im(m - 1)),
            };
            let difference_re = g.scale_add(&minus_rho, down_re, up_re);
            let sum_im = g.scale_add(&plus_rho, down_im, up_im);
            let mut row = g.mul_add(difference_re, c, re(m));
            row = g.mul_add(sum_im, s, row);
            x[l + m] = row;
            if m > 0 {
                let difference_im = g.scale_add(&minus_rho, down_im, up_im);
                let sum_re = g.scale_add(&plus_rho, down_re, up_re);
                let row = g.mul_add(difference_im, c, im(m));
                let term = g.mul(sum_re, s);
                x[l - m] = g.sub(row, term);
            }
        }
    }
}

/// Three shears: error (lβ)³/24, β the tilt.
fn shears(g: &mut Graph, band: &[Id], n: &Normal) -> Vec<Id> {
    let l = band.len() / 2;
    let p = lf3_correction(l);
    let sixth = Exact::ratio(1, 6);
    let odd = [Exact::one(), &sixth - &p];
    let quarter = &(&sixth / &Exact::int(2)) + &(&p / &Exact::int(4));
    let even = [Exact::ratio(1, 2), quarter];
    let (even, odd) = (Shear::new(g, n, l, 0, even), Shear::new(g, n, l, 1, odd));
    let mut x = band.to_vec();
    for shear in [&even, &odd, &even] {
        shear.apply(g, &mut x, l);
    }
    x
}

/// The kernel `tilt`.
pub fn tilt(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let n = normal(&mut builder);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let one = g.constant(Exact::one());
    let above = g.add(n[2], one);
    let n = Normal { x: n[0], y: n[1], z: n[2], u: inner(g, &n[..2], &n[..2]), k: g.recip(above) };
    let out = each_band(g, &c, order, |g, l, band| match l {
        0 => band.to_vec(),
        1 => band_1(g, band, &n),
        2 => band_2(g, band, &n),
        _ => shears(g, band, &n),
    });
    builder.finish(out, Shape::Array(order * order), "the tilted coefficients")
}
