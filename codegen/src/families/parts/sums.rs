//! Sums of products.

use crate::ir::graph::{Graph, Id};

/// The x, y, z products of two triples: a × b, six operations.
pub fn cross(g: &mut Graph, a: [Id; 3], b: [Id; 3]) -> [Id; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let plus = g.mul(a[j], b[k]);
        let minus = g.mul(a[k], b[j]);
        g.sub(plus, minus)
    })
}

/// a · b, left to right.
pub fn inner(g: &mut Graph, a: &[Id], b: &[Id]) -> Id {
    let mut sum = g.mul(a[0], b[0]);
    for (&x, &y) in a.iter().zip(b).skip(1) {
        sum = g.mul_add(x, y, sum);
    }
    sum
}
