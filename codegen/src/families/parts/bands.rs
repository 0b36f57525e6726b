//! Rotations of one band, about z by a phase and about y exactly (docs/MATH.md#the-exact-y-rotation).

use crate::families::parts::orthogonal;
use crate::families::parts::phases::{Euler, Phase, YPhases, euler, phases_of_quaternion};
use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;
use crate::math::tables;

/// Rotates one band about z: u^m = c l^m − s l^−m, u^−m = c l^−m + s l^m with the phase of mα.
pub fn z_band(g: &mut Graph, band: &[Id], alpha: &[Phase]) -> Vec<Id> {
    let l = band.len() / 2;
    let mut out = band.to_vec();
    for m in 1..=l {
        let (plus, minus) = (band[l + m], band[l - m]);
        let Phase { cos, sin } = alpha[m - 1];
        let (cp, sm) = (g.mul(plus, cos), g.mul(minus, sin));
        let (cm, sp) = (g.mul(minus, cos), g.mul(plus, sin));
        out[l + m] = g.sub(cp, sm);
        out[l - m] = g.add(cm, sp);
    }
    g.stage(&out);
    out
}

/// One of the two chains of a band that a y rotation does not mix: rows k and −k of the swap of y and z, restricted to
/// the orders m that they touch.
struct Chain {
    /// The frequencies, descending; a zero comes last if there is one.
    frequencies: Vec<usize>,
    /// The orders m ≡ l that rows k touch, |m| descending, so that the symmetric blocks of J stay symmetric.
    even: Vec<isize>,
    /// The orders m ≢ l that rows −k touch.
    odd: Vec<isize>,
}

fn chains(l: usize) -> [Chain; 2] {
    let members = |sign: isize, parity: usize| -> Vec<isize> {
        let lowest = usize::from(sign < 0);
        (lowest..=l).rev().filter(|m| (m + l) % 2 == parity).map(|m| sign * m as isize).collect()
    };
    let chain = |sign: isize, offset: usize| Chain {
        frequencies: (0..=l).rev().filter(|k| (k + l) % 2 == offset).collect(),
        even: members(sign, 0),
        odd: members(sign, 1),
    };
    [chain(1, 0), chain(-1, 1)]
}

/// Rotates one band about y by the angle whose multiples are given, exactly and at every angle.
pub fn y_band(g: &mut Graph, band: &[Id], beta: &YPhases) -> Vec<Id> {
    let l = band.len() / 2;
    let place = |m: isize| (l as isize + m) as usize;
    let mut out = band.to_vec();
    for chain in chains(l) {
        let pick = |orders: &[isize]| -> Vec<Id> { orders.iter().map(|&m| band[place(m)]).collect() };
        let (even, odd) = (pick(&chain.even), pick(&chain.odd));
        let rows = |sign: isize, columns: &[isize], frequencies: &[usize]| -> Vec<Vec<Exact>> {
            let row = |&k: &usize| columns.iter().map(|&m| tables::swap_yz(l, sign * k as isize, m)).collect();
            frequencies.iter().map(row).collect()
        };
        let moving: Vec<usize> = chain.frequencies.iter().copied().filter(|&k| k > 0).collect();
        let phase = |k: usize| beta.multiples[k - 1];
        if moving.is_empty() {
            continue;
        }
        let to_q = rows(-1, &chain.odd, &moving);
        if l == 2 && chain.even == [2, 0] {
            // Seven operations: p is scaled so that its largest coefficient is one.
            let (x0, x1, x2) = (band[2], band[3], band[4]);
            let root3 = Exact::sqrt_ratio(3, 1);
            let p = g.scale_add(&-&root3, x0, x2);
            let Phase { cos, .. } = phase(2);
            let (cx, sp) = (g.mul(x1, cos), g.mul(p, beta.product));
            out[3] = g.add(cx, sp);
            let (hp, sx) = (g.mul(p, beta.half_square), g.mul(x1, beta.product));
            let minus = g.add(hp, sx);
            out[4] = g.sub(x2, minus);
            out[2] = g.scale_add(&root3, minus, x0);
            continue;
        }
        let null = moving.len() < chain.frequencies.len();
        let to_p = rows(1, &chain.even, &moving);
        let whole = rows(1, &chain.even, &chain.frequencies);
        let partial = 2 * to_p.iter().flatten().filter(|x| !x.is_zero()).count();
        let differences = null && partial <= 2 * orthogonal::cost(&whole);
        let q = orthogonal::apply(g, &to_q, &odd);
        let mut p = if differences {
            to_p.iter().map(|row| g.dot(row, &even)).collect()
        } else {
            orthogonal::apply(g, &whole, &even)
        };
        if !differences {
            g.stage(&[&p[..], &q].concat());
        }
        let mut q_out = Vec::new();
        for (i, &k) in moving.iter().enumerate() {
            let Phase { cos, sin } = phase(k);
            let (cp, sq) = (g.mul(p[i], cos), g.mul(q[i], sin));
            let (cq, sp) = (g.mul(q[i], cos), g.mul(p[i], sin));
            q_out.push(g.sub(cq, sp));
            p[i] = if differences {
                let change = g.sub(cp, p[i]);
                g.add(change, sq)
            } else {
                g.add(cp, sq)
            };
        }
        if !differences {
            g.stage(&[&p[..], &q_out].concat());
        }
        let odd_out = orthogonal::apply(g, &orthogonal::transpose(&to_q), &q_out);
        for (&m, value) in chain.odd.iter().zip(odd_out) {
            out[place(m)] = value;
        }
        if differences {
            for (column, &m) in chain.even.iter().enumerate() {
                for (row, &change) in to_p.iter().zip(&p) {
                    out[place(m)] = g.scale_add(&row[column], change, out[place(m)]);
                }
            }
        } else {
            let even_out = orthogonal::apply(g, &orthogonal::transpose(&whole), &p);
            for (&m, value) in chain.even.iter().zip(even_out) {
                out[place(m)] = value;
            }
        }
    }
    g.stage(&out);
    out
}

/// Applies `f` to every band of a signal.
pub fn each_band(
    g: &mut Graph,
    c: &[Id],
    order: usize,
    mut f: impl FnMut(&mut Graph, usize, &[Id]) -> Vec<Id>,
) -> Vec<Id> {
    (0..order).flat_map(|l| f(g, l, &c[l * l..(l + 1) * (l + 1)])).collect()
}

/// Rz(α) Ry(β) Rz(γ) applied to every band.
pub fn zyz_apply(g: &mut Graph, c: &[Id], order: usize, angles: &Euler) -> Vec<Id> {
    each_band(g, c, order, |g, _, band| {
        let band = z_band(g, band, &angles.gamma);
        let band = y_band(g, &band, &angles.beta);
        z_band(g, &band, &angles.alpha)
    })
}

/// z, y, z from a unit quaternion, applied to every band.
pub fn zyz_from_quaternion(g: &mut Graph, q: &[Id], c: &[Id], order: usize) -> Vec<Id> {
    let angles = phases_of_quaternion(g, q);
    let angles = euler(g, angles, order);
    zyz_apply(g, c, order, &angles)
}

/// Applies a constant matrix, given by its entries at a band and two orders, to one band.
pub fn constant_band(g: &mut Graph, band: &[Id], entry: impl Fn(usize, isize, isize) -> Exact) -> Vec<Id> {
    let l = band.len() / 2;
    let orders: Vec<isize> = (-(l as isize)..=l as isize).collect();
    orders
        .iter()
        .map(|&a| {
            let row: Vec<Exact> = orders.iter().map(|&b| entry(l, a, b)).collect();
            g.dot(&row, band)
        })
        .collect()
}
