//! Vectors of three numbers in f64: the little that pictures need of them.

/// The inner product.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a + s b.
pub fn add(a: [f64; 3], s: f64, b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + s * b[i])
}

/// The length.
pub fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// The vector at length one, if it has a direction.
pub fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = length(a);
    (length.is_finite() && length > 1e-30).then(|| a.map(|x| x / length))
}

/// What is left of a unit-length `a` across the unit vector `n`, at length one; some unit vector across `n` where
/// nothing is left.
pub fn across(a: [f64; 3], n: [f64; 3]) -> [f64; 3] {
    let rest = |a: [f64; 3]| add(a, -dot(a, n), n);
    let least = (0..3).min_by(|&i, &j| n[i].abs().total_cmp(&n[j].abs())).unwrap_or(0);
    let axis = std::array::from_fn(|i| if i == least { 1.0 } else { 0.0 });
    let a = rest(a);
    unit(if length(a) > 1e-6 { a } else { rest(axis) }).unwrap_or([1.0, 0.0, 0.0])
}
