//! The integrals of rows of a map times cos mφ and sin mφ. A row is folded where a wave is its own mirror image, again
//! and again for waves of even m, so that a texel costs a third of what it would for each wave by itself. Loops run over
//! arrays of a fixed length: a build script compiles them without optimisation.

use std::f64::consts::PI;

/// One wave over the half of a row that is left: m, its cosines and its sines.
struct Wave {
    m: usize,
    cos: Vec<f64>,
    sin: Vec<f64>,
}

/// What is integrated before the row is folded once more.
struct Level {
    is_folded: bool,
    waves: Vec<Wave>,
}

/// The waves of all m below an order, for rows of a width.
pub(super) struct Waves {
    order: usize,
    levels: Vec<Level>,
    /// What each sum is multiplied with: the width of a texel, over which the wave is integrated, and the sign by which
    /// azimuths run from π downwards.
    weights: Vec<f64>,
}

impl Waves {
    /// The waves for rows of an even number of texels.
    pub fn new(order: usize, width: usize) -> Self {
        let weight = |m: usize| match m {
            0 => 2.0 * PI / width as f64,
            _ => 2.0 * (PI * m as f64 / width as f64).sin() / m as f64 * if m.is_multiple_of(2) { 1.0 } else { -1.0 },
        };
        let mut levels = Vec::new();
        // The first fold is that of a circle: what is left is half a turn, of which wave m makes m halves.
        let (mut length, mut stride) = (width / 2, 1);
        while stride < order {
            let is_folded = length.is_multiple_of(2);
            let count = if is_folded { length / 2 } else { length };
            let wave = |j: usize| {
                let angle = |x: usize| PI * j as f64 * (x as f64 + 0.5) / length as f64;
                let all = |of: fn(f64) -> f64| (0..count).map(|x| of(angle(x))).collect();
                Wave { m: stride * j, cos: all(f64::cos), sin: all(f64::sin) }
            };
            let wanted = |j: &usize| stride * j < order;
            let step = if is_folded { 2 } else { 1 };
            levels.push(Level { is_folded, waves: (1..).step_by(step).take_while(wanted).map(wave).collect() });
            if !is_folded {
                break;
            }
            (length, stride) = (count, 2 * stride);
        }
        Self { order, levels, weights: (0..order).map(weight).collect() }
    }

    /// For each m, the integrals over a row of one channel times cos mφ and sin mφ.
    pub fn integrals(&self, row: &[f64]) -> Vec<[f64; 2]> {
        let mut sums = vec![[0.0; 2]; self.order];
        let (mut even, mut odd) = folded(row);
        for level in &self.levels {
            if !level.is_folded {
                for Wave { m, cos, sin } in &level.waves {
                    sums[*m] = [dot(&even, cos), dot(&odd, sin)];
                }
                break;
            }
            let ([even_sums, even_rests], [odd_sums, odd_rests]) = (folded(&even).into(), folded(&odd).into());
            for Wave { m, cos, sin } in &level.waves {
                sums[*m] = [dot(&even_rests, cos), dot(&odd_sums, sin)];
            }
            (even, odd) = (even_sums, odd_rests);
        }
        if let Some(first) = sums.first_mut() {
            first[0] = even.iter().sum();
        }
        // Azimuths run from π downwards: sines have the other sign.
        sums.iter().zip(&self.weights).map(|([cos, sin], weight)| [cos * weight, -sin * weight]).collect()
    }
}

/// The sums and the differences of what lies mirrored at the middle.
fn folded(values: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let half = values.len() / 2;
    let (mut sums, mut differences) = (vec![0.0; half], vec![0.0; half]);
    let (near, far) = values.split_at(half);
    let ((near, near_rest), (far_rest, far)) = (near.as_chunks::<4>(), far.as_rchunks::<4>());
    let (sum, sum_rest) = sums.as_chunks_mut::<4>();
    let (difference, difference_rest) = differences.as_chunks_mut::<4>();
    let (count, rest) = (near.len(), near_rest.len());
    let mut i = 0;
    while i < count {
        let (a, b) = (&near[i], &far[count - 1 - i]);
        sum[i] = [a[0] + b[3], a[1] + b[2], a[2] + b[1], a[3] + b[0]];
        difference[i] = [a[0] - b[3], a[1] - b[2], a[2] - b[1], a[3] - b[0]];
        i += 1;
    }
    for i in 0..rest {
        let (a, b) = (near_rest[i], far_rest[rest - 1 - i]);
        (sum_rest[i], difference_rest[i]) = (a + b, a - b);
    }
    (sums, differences)
}

/// The sum of the products, by eights.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let (mut sum, mut i) = (0.0, 0);
    while i < a.len() {
        let (a, b) = (&a[i], &b[i]);
        sum += ((a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]))
            + ((a[4] * b[4] + a[5] * b[5]) + (a[6] * b[6] + a[7] * b[7]));
        i += 1;
    }
    sum + a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum::<f64>()
}
