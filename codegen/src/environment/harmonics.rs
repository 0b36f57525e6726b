//! The harmonics themselves in f64, in any direction, and what turns radiance into irradiance. It knows nothing of maps.

use std::f64::consts::PI;

/// The factor A_l by which band `l` of radiance gives the irradiance of a surface, the clamped cosine's integral over
/// the hemisphere against the Legendre polynomial: π, 2π/3, π/4, 0, −π/24, 0, π/64, …. It is in steradians, and exactly
/// 0 for every odd band above 1.
///
/// For even l it is 2π (−1)^(l/2−1) / ((l+2)(l−1)) · l! / (2^l (l/2)!²) (Ramamoorthi and Hanrahan 2001, equation 19).
pub fn cosine_lobe(l: usize) -> f64 {
    if l == 1 {
        return 2.0 * PI / 3.0;
    }
    if l % 2 == 1 {
        return 0.0;
    }
    let central: f64 = (1..=l / 2).map(|k| -((2 * k - 1) as f64) / (2 * k) as f64).product();
    let l = l as f64;
    -2.0 * PI * central / ((l + 2.0) * (l - 1.0))
}

/// The harmonics of the bands below `order` in a direction (x, y, z) of length 1, into the first `order * order` of
/// `values`, at index l(l+1)+m. Polynomials in x, y and z, so that the poles are like any other place.
pub fn basis(order: usize, direction: [f64; 3], values: &mut [f64]) {
    let [x, y, z] = direction;
    let mut sectoral = 0.5 / PI.sqrt();
    let (mut cos, mut sin) = (1.0, 0.0);
    for m in 0..order {
        if m > 0 {
            let factor = if m == 1 { 3.0 } else { (2 * m + 1) as f64 / (2 * m) as f64 };
            sectoral *= -factor.sqrt();
            (cos, sin) = (x * cos - y * sin, x * sin + y * cos);
        }
        let (mut before, mut legendre) = (0.0, sectoral);
        let mut last_ratio = 1.0;
        for l in m..order {
            if l > m {
                let (ll, mm) = ((l * l) as f64, (m * m) as f64);
                let ratio = ((4.0 * ll - 1.0) / (ll - mm)).sqrt();
                (before, legendre) = (legendre, ratio * (z * legendre - before / last_ratio));
                last_ratio = ratio;
            }
            let centre = l * (l + 1);
            values[centre + m] = legendre * cos;
            if m > 0 {
                values[centre - m] = legendre * sin;
            }
        }
    }
}

/// Turns the coefficients of the bands below `order` about z by an angle in radians, from x towards y.
pub fn turn_about_z(order: usize, angle: f64, signal: &mut [f64]) {
    for (l, m) in (0..order).flat_map(|l| (1..=l).map(move |m| (l, m))) {
        let (sin, cos) = (m as f64 * angle).sin_cos();
        let (plus, minus) = (l * (l + 1) + m, l * (l + 1) - m);
        (signal[plus], signal[minus]) =
            (cos * signal[plus] - sin * signal[minus], sin * signal[plus] + cos * signal[minus]);
    }
}
