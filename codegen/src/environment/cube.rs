//! The cube around a point: which way its faces look in zonal's frame, the solid angles of their texels, and their projection.
//!
//! A harmonic times the solid angle that a place of a face has is smooth over the face, so that blocks of the face hold it as
//! polynomials: what is integrated over a texel are the polynomials, exactly. That is the adjoint of interpolation: texels
//! become weights of the nodes of their block, once for all harmonics, and a harmonic is computed at the nodes alone, for the
//! eight mirror images of a node at once (docs/MATH.md#projection-of-maps).

use super::harmonics::basis;
use super::waves::dot;
use crate::math::index::coefficients;
use crate::math::quadrature::{gauss_legendre, gauss_legendre_5};
use crate::threads;

/// Where a face looks, what is right in its image and what is down, in zonal's frame. The cube's own frame is left-handed
/// and y up, as that of OpenGL, Direct3D and Unity: its x, z and y are zonal's x, y and z.
const AXES: [[[f64; 3]; 3]; 6] = [
    [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]],
    [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]],
    [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]],
    [[0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]],
];

/// How many nodes a block has along a side: of degree 9, which the rule of five points integrates exactly.
const NODES: usize = 10;
/// The fewest blocks along a side of a face, for the sake of the solid angle.
const LEAST_BLOCKS: usize = 6;

/// A row or a column of nodes or of texels runs from −1 to 1 across a face.
fn place(i: usize, side: usize) -> f64 {
    (2 * i + 1) as f64 / side as f64 - 1.0
}

/// The unit direction of the centre of a texel of a face.
pub(super) fn direction(side: usize, face: usize, x: usize, y: usize) -> [f64; 3] {
    towards(face, place(x, side), place(y, side)).0
}

/// The unit direction of a place of a face, and how far it is: right and down from −1 to 1.
pub(super) fn towards(face: usize, u: f64, v: f64) -> ([f64; 3], f64) {
    let [forward, right, down] = AXES[face];
    let length = (1.0 + u * u + v * v).sqrt();
    (std::array::from_fn(|i| (forward[i] + u * right[i] + v * down[i]) / length), length)
}

/// The unit direction of a place of a face, in texels from its left and its upper edge, and the solid angle that a texel
/// would have if it were as far and leaned as there.
pub(super) fn inside(side: usize, face: usize, place: [f64; 2]) -> ([f64; 3], f64) {
    let step = 2.0 / side as f64;
    let [u, v] = place.map(|texels| step * texels - 1.0);
    let (direction, length) = towards(face, u, v);
    (direction, step * step / length.powi(3))
}

/// The face in which a direction lies, and where it does: right and down from −1 to 1.
pub(super) fn locate(direction: [f64; 3]) -> (usize, [f64; 2]) {
    let along = |axis: [f64; 3]| axis[0] * direction[0] + axis[1] * direction[1] + axis[2] * direction[2];
    let face = (0..6).max_by(|&a, &b| along(AXES[a][0]).total_cmp(&along(AXES[b][0]))).unwrap_or(0);
    let [forward, right, down] = AXES[face].map(along);
    (face, [right / forward, down / forward])
}

/// The face, the column and the row of the texel in which a direction lies.
pub(super) fn texel(side: usize, direction: [f64; 3]) -> [usize; 3] {
    let (face, place) = locate(direction);
    let [x, y] = place.map(|value| ((0.5 * (value + 1.0) * side as f64) as usize).min(side - 1));
    [face, x, y]
}

/// The solid angle of a texel of a face, in steradians.
pub(super) fn solid_angle(side: usize, x: usize, y: usize) -> f64 {
    let corner = |i: usize, j: usize| {
        let [u, v] = [i, j].map(|k| (2 * k) as f64 / side as f64 - 1.0);
        (u * v).atan2((1.0 + u * u + v * v).sqrt())
    };
    corner(x + 1, y + 1) - corner(x, y + 1) - corner(x + 1, y) + corner(x, y)
}

/// What the texels of a row weigh in the nodes of a block: the first of them, and for each node the integral of its
/// polynomial over each texel.
struct Block {
    first: usize,
    weights: [Vec<f64>; NODES],
}

/// The nodes along a side of a face.
struct Nodes {
    places: Vec<f64>,
    blocks: Vec<Block>,
}

impl Nodes {
    fn new(count: usize, side: usize) -> Self {
        let (mut places, mut blocks) = (Vec::new(), Vec::new());
        for b in 0..count {
            let [from, to] = [b, b + 1].map(|b| (2 * b) as f64 / count as f64 - 1.0);
            let mut own: Vec<f64> = gauss_legendre(NODES, from, to).map(|(node, _)| node).collect();
            own.sort_by(f64::total_cmp);
            // Texels that end where the block begins weigh nothing.
            let (first, end) = (b * side / count, ((b + 1) * side).div_ceil(count));
            let integral = |node: usize, texel: usize| {
                let low = ((2 * texel) as f64 / side as f64 - 1.0).max(from);
                let high = ((2 * texel + 2) as f64 / side as f64 - 1.0).min(to);
                let (middle, half) = (0.5 * (low + high), 0.5 * (high - low).max(0.0));
                let mut sum = 0.0;
                for (at, weight) in gauss_legendre_5() {
                    let u = middle + half * at;
                    let mut value = 1.0;
                    for other in 0..NODES {
                        if other != node {
                            value *= (u - own[other]) / (own[node] - own[other]);
                        }
                    }
                    sum += half * weight * value;
                }
                sum
            };
            let weights = std::array::from_fn(|node| (first..end).map(|texel| integral(node, texel)).collect());
            blocks.push(Block { first, weights });
            places.extend(own);
        }
        Self { places, blocks }
    }

    /// What the texels of a row come to in the nodes.
    fn gather(&self, row: &[f64], mut put: impl FnMut(usize, f64)) {
        for (b, block) in self.blocks.iter().enumerate() {
            for (i, weights) in block.weights.iter().enumerate() {
                put(b * NODES + i, dot(&row[block.first..block.first + weights.len()], weights));
            }
        }
    }

    /// What a face comes to in the nodes: a row of nodes after another.
    fn face(&self, side: usize, texels: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let count = self.places.len();
        let mut sums = vec![[0.0; 3]; count * count];
        let mut row = vec![0.0; side];
        for channel in 0..3 {
            // Column by column of nodes, so that the second pass reads along rows again.
            let mut columns = vec![0.0; count * side];
            for y in 0..side {
                let line = &texels[y * side..(y + 1) * side];
                let mut x = 0;
                while x < side {
                    row[x] = line[x][channel];
                    x += 1;
                }
                self.gather(&row, |i, value| columns[i * side + y] = value);
            }
            for i in 0..count {
                self.gather(&columns[i * side..(i + 1) * side], |j, value| sums[j * count + i][channel] = value);
            }
        }
        sums
    }
}

/// The node of a face that lies in a direction: `at` tells how far along the two axes that the face does not look along.
fn node(face: usize, count: usize, at: [usize; 3]) -> usize {
    let [_, right, down] = AXES[face];
    let along = |axis: [f64; 3]| {
        let place = axis.iter().position(|&x| x != 0.0).unwrap_or(0);
        if axis[place] > 0.0 { at[place] } else { count - 1 - at[place] }
    };
    along(down) * count + along(right)
}

/// The face that looks along an axis.
fn face_along(axis: usize, is_negative: bool) -> usize {
    let sign = if is_negative { -1.0 } else { 1.0 };
    AXES.iter().position(|[forward, ..]| forward[axis] == sign).unwrap_or(0)
}

/// The coefficients of six faces, which stand one below the other.
pub(super) fn project(side: usize, texels: &[[f64; 3]], order: usize) -> Vec<[f64; 3]> {
    let nodes = Nodes::new(order.max(LEAST_BLOCKS), side);
    let count = nodes.places.len();
    let faces = threads::map(0..6, |face| nodes.face(side, &texels[face * side * side..(face + 1) * side * side]));
    // In which of x, y and z a harmonic is odd.
    let classes: Vec<usize> = coefficients(order)
        .map(|(l, m)| {
            let odd = m % 2 != 0;
            usize::from((m < 0) != odd) | usize::from(m < 0) << 1 | usize::from(l.is_multiple_of(2) == odd) << 2
        })
        .collect();
    // A row of nodes of a quarter of a face, for each axis.
    let half = count / 2;
    let row = |item: usize| {
        let (axis, p) = (item / half, item % half);
        let [second, third] = [(axis + 1) % 3, (axis + 2) % 3];
        let mut sums = vec![[0.0; 3]; order * order];
        let mut values = vec![0.0; order * order];
        for q in 0..half {
            let (s, t) = (nodes.places[half + p], nodes.places[half + q]);
            let square = 1.0 + s * s + t * t;
            let mut towards = [0.0; 3];
            (towards[axis], towards[second], towards[third]) = (1.0, s, t);
            basis(order, towards.map(|x| x / square.sqrt()), &mut values);
            // The eight mirror images: bit 0 for the opposite of x, bit 1 of y, bit 2 of z.
            let mut folded = [[0.0; 3]; 8];
            for signs in 0..8usize {
                let is_negative = |axis: usize| signs >> axis & 1 == 1;
                let mut at = [0; 3];
                at[second] = if is_negative(second) { half - 1 - p } else { half + p };
                at[third] = if is_negative(third) { half - 1 - q } else { half + q };
                let face = face_along(axis, is_negative(axis));
                let value = faces[face][node(face, count, at)];
                for (class, sum) in folded.iter_mut().enumerate() {
                    let sign = if (signs & class).count_ones() % 2 == 1 { -1.0 } else { 1.0 };
                    (0..3).for_each(|channel| sum[channel] += sign * value[channel]);
                }
            }
            let weight = 1.0 / (square * square.sqrt());
            let mut i = 0;
            while i < values.len() {
                let (value, [r, g, b], sum) = (weight * values[i], folded[classes[i]], &mut sums[i]);
                sum[0] += value * r;
                sum[1] += value * g;
                sum[2] += value * b;
                i += 1;
            }
        }
        sums
    };
    let mut all = vec![[0.0; 3]; order * order];
    for part in threads::map(0..3 * half, row) {
        for (sum, value) in all.iter_mut().zip(part) {
            (0..3).for_each(|channel| sum[channel] += value[channel]);
        }
    }
    all
}

/// The square of the radiance over the sphere, summed over R, G and B.
pub(super) fn energy(side: usize, texels: &[[f64; 3]]) -> f64 {
    let solid_angles: Vec<f64> = (0..side * side).map(|i| solid_angle(side, i % side, i / side)).collect();
    let faces = texels.chunks_exact(side * side);
    let squares = faces.flat_map(|face| face.iter().zip(&solid_angles));
    squares.map(|(texel, solid_angle)| solid_angle * texel.iter().map(|v| v * v).sum::<f64>()).sum()
}
