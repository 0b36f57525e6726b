//! The phases of a rotation's angles: their multiples, and the set-up from a quaternion, which takes neither trigonometry
//! nor branch.

use crate::families::parts::sums::inner;
use crate::ir::graph::{Graph, Id};
use crate::math::exact::Exact;

/// A cosine and a sine.
#[derive(Clone, Copy, Debug)]
pub struct Phase {
    /// The cosine.
    pub cos: Id,
    /// The sine.
    pub sin: Id,
}

/// e^{ia} · e^{ib}: four operations.
pub fn turn(g: &mut Graph, a: Phase, b: Phase) -> Phase {
    let ss = g.mul(a.sin, b.sin);
    let cc = g.mul(a.cos, b.cos);
    let sc = g.mul(a.sin, b.cos);
    let cs = g.mul(a.cos, b.sin);
    Phase { cos: g.sub(cc, ss), sin: g.add(sc, cs) }
}

/// The multiples e^{ia}, e^{2ia}, …, e^{i·count·a} by complex products, which keep f32's accuracy where Chebyshev's
/// recurrence does not: 4(n − 2) operations (docs/MATH.md#multiples-of-an-angle).
pub fn multiples(g: &mut Graph, phase: Phase, count: usize) -> Vec<Phase> {
    let mut all = vec![phase];
    for _ in 1..count {
        let last = *all.last().expect("starts with one");
        all.push(turn(g, last, phase));
    }
    all.truncate(count);
    all
}

/// Reads a slice of inputs as (cosine, sine) pairs.
pub fn phases(inputs: &[Id]) -> Vec<Phase> {
    inputs.chunks_exact(2).map(|pair| Phase { cos: pair[0], sin: pair[1] }).collect()
}

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
        all.push(turn(g, last, beta));
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

/// The multiples that a rotation of an order takes.
pub fn euler(g: &mut Graph, [alpha, beta, gamma]: [Phase; 3], order: usize) -> Euler {
    Euler {
        alpha: multiples(g, alpha, order - 1),
        beta: y_phases(g, beta, order - 1),
        gamma: multiples(g, gamma, order - 1),
    }
}

/// The phases of a unit normal's azimuth φ and its angle θ from z, with neither trigonometry nor branch: adding a tiny
/// number to x keeps the azimuth defined at the poles.
pub fn phases_of_normal(g: &mut Graph, n: &[Id]) -> [Phase; 2] {
    let tiny = g.tiny();
    let x = g.add(n[0], tiny);
    let squares = inner(g, &[x, n[1]], &[x, n[1]]);
    let r = g.rsqrt(squares);
    let phi = Phase { cos: g.mul(x, r), sin: g.mul(n[1], r) };
    [phi, Phase { cos: n[2], sin: g.mul(squares, r) }]
}
