//! Exact rotations. The default is z, y, z: the y rotation of a band splits into chains of even and odd m, each of which
//! a constant orthogonal matrix turns into plane rotations by multiples of the angle
//! (docs/MATH.md#the-exact-y-rotation). Set-up from a quaternion takes no trigonometry and no branch.

use crate::families::{Phase, basis, cross, inner, multiples, orthogonal, phases};
use crate::ir::graph::{Graph, Id, Kind};
use crate::ir::kernel::{Builder, Kernel, Shape};
use crate::math::exact::Exact;
use crate::math::tables;

/// A cosine and sine multiple of the y angle and what bands 2 and up need besides.
#[derive(Clone, Debug)]
pub struct YPhases {
    /// e^{ikβ} for k = 1, 2, …
    pub multiples: Vec<Phase>,
    /// sin²β / 2.
    pub half_square: Id,
    /// sin β cos β.
    pub product: Id,
}

/// The three angles of Rz(α) Ry(β) Rz(γ), as multiples of their phases.
#[derive(Clone, Debug)]
pub struct Euler {
    /// Multiples of α.
    pub alpha: Vec<Phase>,
    /// Multiples of β.
    pub beta: YPhases,
    /// Multiples of γ.
    pub gamma: Vec<Phase>,
}

/// The multiples of β up to `count`, with the two products that band 2 uses.
pub fn y_phases(g: &mut Graph, beta: Phase, count: usize) -> YPhases {
    let product = g.mul(beta.sin, beta.cos);
    let square = g.mul(beta.sin, beta.sin);
    let half_square = g.scale(&Exact::ratio(1, 2), square);
    let mut all = vec![beta];
    if count >= 2 {
        let cc = g.mul(beta.cos, beta.cos);
        let double = Phase { cos: g.sub(cc, square), sin: g.scale(&Exact::int(2), product) };
        all.push(double);
    }
    for _ in 2..count {
        let last = *all.last().expect("holds two");
        all.push(super::turn(g, last, beta));
    }
    YPhases { multiples: all, half_square, product }
}

/// What the angles of a quaternion are made of.
struct Halves {
    /// x, y, z, w, a tiny number added to y and w.
    q: [Id; 4],
    /// w² + z², which is cos²(β/2).
    a: Id,
    /// x² + y², which is sin²(β/2).
    b: Id,
    /// Their product and its inverse root.
    ab: Id,
    r: Id,
}

impl Halves {
    fn new(g: &mut Graph, q: &[Id]) -> Self {
        let tiny = g.tiny();
        let [x, z] = [q[0], q[2]];
        let [y, w] = [g.add(q[1], tiny), g.add(q[3], tiny)];
        let a = inner(g, &[w, z], &[w, z]);
        let b = inner(g, &[x, y], &[x, y]);
        let ab = g.mul(a, b);
        Self { q: [x, y, z, w], a, b, ab, r: g.rsqrt(ab) }
    }
}

/// tan(β/2) of a quaternion, whatever its length.
pub fn half_tangent_of_quaternion(g: &mut Graph, q: &[Id]) -> Id {
    let Halves { b, r, .. } = Halves::new(g, q);
    g.mul(b, r)
}

/// The phases of a unit quaternion (x, y, z, w), with neither trigonometry nor branch
/// (docs/MATH.md#set-up-from-a-quaternion): adding a tiny number to w and y keeps both phases defined where one of them
/// has no meaning.
pub fn phases_of_quaternion(g: &mut Graph, q: &[Id]) -> [Phase; 3] {
    let Halves { q: [x, y, z, w], a, b, ab, r } = Halves::new(g, q);
    let (wr, zr) = (g.mul(w, r), g.mul(z, r));
    let (wy, zx, zy, wx) = (g.mul(wr, y), g.mul(zr, x), g.mul(zr, y), g.mul(wr, x));
    let alpha = Phase { cos: g.add(wy, zx), sin: g.sub(zy, wx) };
    let gamma = Phase { cos: g.sub(wy, zx), sin: g.add(zy, wx) };
    let root = g.mul(ab, r);
    let beta = Phase { cos: g.sub(a, b), sin: g.scale(&Exact::int(2), root) };
    [alpha, beta, gamma]
}

fn euler(g: &mut Graph, [alpha, beta, gamma]: [Phase; 3], order: usize) -> Euler {
    Euler {
        alpha: multiples(g, alpha, order - 1),
        beta: y_phases(g, beta, order - 1),
        gamma: multiples(g, gamma, order - 1),
    }
}

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
fn zyz_apply(g: &mut Graph, c: &[Id], order: usize, angles: &Euler) -> Vec<Id> {
    each_band(g, c, order, |g, _, band| {
        let band = z_band(g, band, &angles.gamma);
        let band = y_band(g, &band, &angles.beta);
        z_band(g, &band, &angles.alpha)
    })
}

/// Declares the signal `c` of n² coefficients.
pub fn signal(builder: &mut Builder, order: usize) -> Vec<Id> {
    builder.param("c", Shape::Array(order * order), Kind::Signal, "the coefficients, index l(l+1)+m")
}

/// Declares the unit quaternion `q`.
pub fn quaternion(builder: &mut Builder) -> Vec<Id> {
    builder.param("q", Shape::Vec4, Kind::Scalar, "the rotation, a unit quaternion (x, y, z, w)")
}

/// Declares the unit normal `n`.
pub fn normal(builder: &mut Builder) -> Vec<Id> {
    builder.param("n", Shape::Vec3, Kind::Scalar, "where the z axis goes, of unit length")
}

/// Declares the rotation matrix `m`.
pub fn matrix(builder: &mut Builder) -> Vec<Id> {
    builder.param("m", Shape::Mat3, Kind::Scalar, "the rotation, a matrix of three columns")
}

fn finish(builder: Builder, order: usize, out: Vec<Id>) -> Kernel {
    builder.finish(out, Shape::Array(order * order), "the rotated coefficients")
}

/// `rotate` by z, y, z from a unit quaternion.
pub fn zyz(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder);
    let c = signal(&mut builder, order);
    let out = from_quaternion(&mut builder.graph, &q, &c, order);
    finish(builder, order, out)
}

/// z, y, z from a unit quaternion.
pub fn from_quaternion(g: &mut Graph, q: &[Id], c: &[Id], order: usize) -> Vec<Id> {
    let angles = phases_of_quaternion(g, q);
    let angles = euler(g, angles, order);
    zyz_apply(g, c, order, &angles)
}

/// `rotate` by z, y, z from the three angles' cosine and sine.
pub fn euler_angles(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pairs(3), Kind::Scalar, "(cos, sin) of α, β and γ in Rz(α) Ry(β) Rz(γ)");
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let angles = phases(&cs);
    let angles = euler(g, [angles[0], angles[1], angles[2]], order);
    let out = zyz_apply(g, &c, order, &angles);
    finish(builder, order, out)
}

fn angle_pairs(order: usize) -> usize {
    3 * (order - 1) + 1
}

const ANGLES: &str = "(cos, sin) of α, 2α, …, (n−1)α, then of the multiples of β, then of γ, in Rz(α) Ry(β) Rz(γ); \
                      last the pair (sin²β / 2, sin β cos β)";

/// `rotate` by z, y, z with every multiple of the three angles given, as `angles` makes them.
pub fn zyz_from_angles(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pairs(angle_pairs(order)), Kind::Scalar, ANGLES);
    let c = signal(&mut builder, order);
    let all = phases(&cs);
    let count = order - 1;
    let last = all[3 * count];
    let angles = Euler {
        alpha: all[..count].to_vec(),
        beta: YPhases { multiples: all[count..2 * count].to_vec(), half_square: last.cos, product: last.sin },
        gamma: all[2 * count..3 * count].to_vec(),
    };
    let out = zyz_apply(&mut builder.graph, &c, order, &angles);
    finish(builder, order, out)
}

/// The kernel `angles`: what [`zyz_from_angles`] takes, from a unit quaternion; done once for many signals.
pub fn angles(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder);
    let g = &mut builder.graph;
    let angles = phases_of_quaternion(g, &q);
    let angles = euler(g, angles, order);
    let pair = |phase: &Phase| [phase.cos, phase.sin];
    let mut out: Vec<Id> =
        [&angles.alpha, &angles.beta.multiples, &angles.gamma].into_iter().flatten().flat_map(pair).collect();
    out.extend([angles.beta.half_square, angles.beta.product]);
    builder.finish(out, Shape::Pairs(angle_pairs(order)), ANGLES)
}

/// The kernel `rotate_z`: about z by the angle of (cos α, sin α).
pub fn rotate_z(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pair, Kind::Scalar, "(cos α, sin α)");
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let alpha = multiples(g, phases(&cs)[0], order - 1);
    let out = each_band(g, &c, order, |g, _, band| z_band(g, band, &alpha));
    finish(builder, order, out)
}

/// The kernel `rotate_y`: about y by the angle of (cos β, sin β), exactly.
pub fn rotate_y(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let cs = builder.param("cs", Shape::Pair, Kind::Scalar, "(cos β, sin β)");
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let beta = y_phases(g, phases(&cs)[0], order - 1);
    let out = each_band(g, &c, order, |g, _, band| y_band(g, band, &beta));
    finish(builder, order, out)
}

fn constant_band(g: &mut Graph, band: &[Id], entry: impl Fn(usize, isize, isize) -> Exact) -> Vec<Id> {
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

fn x90_band(g: &mut Graph, band: &[Id], sign: i32) -> Vec<Id> {
    let out = constant_band(g, band, |l, a, b| tables::x90(l, a, b, sign));
    g.stage(&out);
    out
}

fn constant_rotation(order: usize, entry: impl Fn(usize, isize, isize) -> Exact) -> Kernel {
    let mut builder = Builder::new();
    let c = signal(&mut builder, order);
    let out = each_band(&mut builder.graph, &c, order, |g, _, band| constant_band(g, band, &entry));
    finish(builder, order, out)
}

/// The kernel `swap_yz`: the sparse symmetric matrix J that exchanges y and z (a reflection).
pub fn swap_yz(order: usize) -> Kernel {
    constant_rotation(order, tables::swap_yz)
}

/// The kernels `rotate_x_plus_90` and `rotate_x_minus_90`.
pub fn rotate_x_90(order: usize, sign: i32) -> Kernel {
    constant_rotation(order, |l, a, b| tables::x90(l, a, b, sign))
}

/// `rotate` as the papers do it: z, +90° about x, z, −90° about x, z, each x rotation a sparse product.
pub fn zxzxz(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let angles = phases_of_quaternion(g, &q);
    let [alpha, beta, gamma] = angles.map(|phase| multiples(g, phase, order - 1));
    let out = each_band(g, &c, order, |g, _, band| {
        let band = z_band(g, band, &gamma);
        // Ry(β) = Rx(−90°) Rz(β) Rx(90°).
        let band = x90_band(g, &band, 1);
        let band = z_band(g, &band, &beta);
        let band = x90_band(g, &band, -1);
        z_band(g, &band, &alpha)
    });
    finish(builder, order, out)
}

/// `rotate` of the z axis to a normal where the spin about it is irrelevant: y, then z.
pub fn align(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let n = normal(&mut builder);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let tiny = g.tiny();
    let x = g.add(n[0], tiny);
    let squares = inner(g, &[x, n[1]], &[x, n[1]]);
    let r = g.rsqrt(squares);
    let phi = Phase { cos: g.mul(x, r), sin: g.mul(n[1], r) };
    let theta = Phase { cos: n[2], sin: g.mul(squares, r) };
    let (phi, theta) = (multiples(g, phi, order - 1), y_phases(g, theta, order - 1));
    let out = each_band(g, &c, order, |g, _, band| {
        let band = y_band(g, band, &theta);
        z_band(g, &band, &phi)
    });
    finish(builder, order, out)
}

/// `rotate` of a zonal signal's axis from z to a direction: c_lm = √(4π / (2l + 1)) g_l y_lm(dir).
pub fn zonal(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let dir = builder.param("dir", Shape::Vec3, Kind::Scalar, "where the axis goes, of unit length");
    let c = builder.param("c", Shape::Array(order), Kind::Signal, "the zonal coefficients, one a band");
    let g = &mut builder.graph;
    let y = basis::values(g, &dir, order, basis::zonal);
    let out = (0..order).flat_map(|l| std::iter::repeat_n(c[l], 2 * l + 1)).zip(y).map(|(c, y)| g.mul(c, y)).collect();
    finish(builder, order, out)
}

/// Rotates band 1 as the vector (−c₁, −c₋₁, c₀), by a matrix given as rows.
fn matrix_band_1(g: &mut Graph, band: &[Id], rows: &[[Id; 3]; 3]) -> Vec<Id> {
    let v = [g.neg(band[2]), g.neg(band[0]), band[1]];
    let [x, y, z] = std::array::from_fn(|i| inner(g, &v, &rows[i]));
    vec![g.neg(y), z, g.neg(x)]
}

/// Rotates band 2 as a symmetric traceless tensor: 38 operations, no trigonometry
/// (docs/MATH.md#vectors-and-tensors).
fn matrix_band_2(g: &mut Graph, band: &[Id], rows: &[[Id; 3]; 3]) -> Vec<Id> {
    let [xy, yz, zz, zx, xx] = [band[0], band[1], band[2], band[3], band[4]];
    let root3 = Exact::sqrt_ratio(3, 1);
    let weighted = g.scale(&root3, zz);
    let (s11, s22) = (g.sub(xx, weighted), {
        let sum = g.add(xx, weighted);
        g.neg(sum)
    });
    let (s13, s23) = (g.neg(zx), g.neg(yz));
    let image = |g: &mut Graph, r: [Id; 3]| {
        [inner(g, &[s11, xy, s13], &r), inner(g, &[xy, s22, s23], &r), inner(g, &[s13, s23], &r[..2])]
    };
    let (u1, u2) = (image(g, rows[0]), image(g, rows[1]));
    let (r1u1, r2u2) = (inner(g, &u1, &rows[0]), inner(g, &u2, &rows[1]));
    let (difference, sum) = (g.sub(r1u1, r2u2), g.add(r1u1, r2u2));
    let twice = g.scale(&Exact::int(-2), zz);
    let out_yz = inner(g, &u2, &rows[2]);
    let out_zx = inner(g, &u1, &rows[2]);
    vec![
        inner(g, &u1, &rows[1]),
        g.neg(out_yz),
        g.scale_add(&-(&root3 / &Exact::int(2)), sum, twice),
        g.neg(out_zx),
        g.scale(&Exact::ratio(1, 2), difference),
    ]
}

fn matrix_apply(g: &mut Graph, c: &[Id], order: usize, rows: &[[Id; 3]; 3]) -> Vec<Id> {
    each_band(g, c, order, |g, l, band| match l {
        0 => band.to_vec(),
        1 => matrix_band_1(g, band, rows),
        _ => matrix_band_2(g, band, rows),
    })
}

/// `rotate` from a 3×3 matrix, orders 2 and 3, without trigonometry.
pub fn from_matrix(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let m = matrix(&mut builder);
    let c = signal(&mut builder, order);
    let rows: [[Id; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| m[3 * j + i]));
    let out = matrix_apply(&mut builder.graph, &c, order, &rows);
    finish(builder, order, out)
}

/// The rows of a unit quaternion's matrix: 17 operations.
fn matrix_of_quaternion(g: &mut Graph, q: &[Id]) -> [[Id; 3]; 3] {
    let [x, y, z, w] = [q[0], q[1], q[2], q[3]];
    let [x2, y2, z2] = [x, y, z].map(|v| g.scale(&Exact::int(2), v));
    let one = g.constant(Exact::one());
    let (xx, yy, zz) = (g.mul(x, x2), g.mul(y, y2), g.mul(z, z2));
    let no_z = g.sub(one, zz);
    let no_x = g.sub(one, xx);
    let (xy, xz, yz) = (g.mul(x, y2), g.mul(x, z2), g.mul(y, z2));
    let (wx, wy, wz) = (g.mul(w, x2), g.mul(w, y2), g.mul(w, z2));
    [
        [g.sub(no_z, yy), g.sub(xy, wz), g.add(xz, wy)],
        [g.add(xy, wz), g.sub(no_z, xx), g.sub(yz, wx)],
        [g.sub(xz, wy), g.add(yz, wx), g.sub(no_x, yy)],
    ]
}

/// `rotate` from a unit quaternion as a vector and a tensor, orders 2 and 3: nothing but products and sums.
pub fn tensor(order: usize) -> Kernel {
    let mut builder = Builder::new();
    let q = quaternion(&mut builder);
    let c = signal(&mut builder, order);
    let g = &mut builder.graph;
    let out = if order == 2 {
        // v + w t + q × t with t = 2 q × v: cheaper than the matrix for one vector.
        let v = [g.neg(c[3]), g.neg(c[1]), c[2]];
        let axis = [q[0], q[1], q[2]];
        let twice = axis.map(|a| g.scale(&Exact::int(2), a));
        let t = cross(g, twice, v);
        let turned: [Id; 3] = std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let sum = g.mul_add(t[i], q[3], v[i]);
            let sum = g.mul_add(t[k], axis[j], sum);
            let minus = g.mul(t[j], axis[k]);
            g.sub(sum, minus)
        });
        vec![c[0], g.neg(turned[1]), turned[2], g.neg(turned[0])]
    } else {
        let rows = matrix_of_quaternion(g, &q);
        matrix_apply(g, &c, order, &rows)
    };
    finish(builder, order, out)
}
