//! The kernel families, one file each, and the small pieces that they share. What a kernel costs is decided here, by
//! the recurrence that is chosen; nothing downstream makes it cheaper.

pub mod basis;
pub mod lifted;
pub mod loops;
pub mod monomial;
pub mod orthogonal;
pub mod rotate;
pub mod spec;
pub mod tilt;
pub mod y_rotation;
pub mod zhf;

use crate::ir::graph::{Graph, Id};

/// A cosine and a sine.
#[derive(Clone, Copy, Debug)]
pub struct Phase {
    /// The cosine.
    pub cos: Id,
    /// The sine.
    pub sin: Id,
}

/// e^{ia} · e^{ib}: four operations.
fn turn(g: &mut Graph, a: Phase, b: Phase) -> Phase {
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

/// The x, y, z products of two triples: a × b, six operations.
fn cross(g: &mut Graph, a: [Id; 3], b: [Id; 3]) -> [Id; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let plus = g.mul(a[j], b[k]);
        let minus = g.mul(a[k], b[j]);
        g.sub(plus, minus)
    })
}

/// a · b, left to right.
fn inner(g: &mut Graph, a: &[Id], b: &[Id]) -> Id {
    let mut sum = g.mul(a[0], b[0]);
    for (&x, &y) in a.iter().zip(b).skip(1) {
        sum = g.mul_add(x, y, sum);
    }
    sum
}
