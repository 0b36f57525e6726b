//! The discrete Fourier transform of as many numbers as a power of two (Cooley and Tukey 1965).

use std::f64::consts::PI;

/// Replaces values, as real and imaginary parts, by the sums Σ_j v_j e^(2πi jk/n), by k.
///
/// # Panics
///
/// If their number is no power of two.
pub fn transform(values: &mut [[f64; 2]]) {
    let count = values.len();
    assert!(count.is_power_of_two(), "{count} values");
    let bits = count.trailing_zeros();
    for i in 0..count {
        let j = if bits == 0 { 0 } else { i.reverse_bits() >> (usize::BITS - bits) };
        if i < j {
            values.swap(i, j);
        }
    }
    let mut half = 1;
    while half < count {
        let turns: Vec<[f64; 2]> = (0..half)
            .map(|k| {
                let (sin, cos) = (PI * k as f64 / half as f64).sin_cos();
                [cos, sin]
            })
            .collect();
        for block in values.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for k in 0..half {
                let ([cos, sin], [re, im]) = (turns[k], high[k]);
                let turned = [cos * re - sin * im, cos * im + sin * re];
                high[k] = [low[k][0] - turned[0], low[k][1] - turned[1]];
                low[k] = [low[k][0] + turned[0], low[k][1] + turned[1]];
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_sum_that_it_says() {
        for count in [1usize, 2, 8, 32] {
            let values: Vec<[f64; 2]> = (0..count).map(|j| [(j * j % 7) as f64, (j % 3) as f64]).collect();
            let mut found = values.clone();
            transform(&mut found);
            for (k, [re, im]) in found.into_iter().enumerate() {
                let mut sum = [0.0; 2];
                for (j, [a, b]) in values.iter().enumerate() {
                    let (sin, cos) = (2.0 * PI * (j * k) as f64 / count as f64).sin_cos();
                    sum = [sum[0] + a * cos - b * sin, sum[1] + a * sin + b * cos];
                }
                assert!((re - sum[0]).abs() < 1e-12 && (im - sum[1]).abs() < 1e-12, "{k} of {count}");
            }
        }
    }
}
