//! The error of an approximate rotation about y, band by band, as a law in lβ.
//!
//! The generator A of a band has the frequencies 0 to l, each in planes of its own; a polynomial in A and a product of
//! parity shears both act on these planes alone. So the distance to the exact rotation is that of 2 × 2 matrices, in
//! closed form: its largest singular value is the error of the worst signal, and its Frobenius norm over √(2l + 1) that of
//! a random one, in the root mean square. Only Taylor 1.5 keeps the diagonal of A² and so mixes planes: its law is
//! computed from its matrix, about L²/4 at first. docs/MATH.md#error-laws has the derivation.

use crate::families::family::{AngleAs, Spec};
use crate::families::parts::small_angle::{SmallAngle, parity_shears};
use crate::math::tables;

/// What a method errs by in one band.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Error {
    /// The worst signal's: the spectral norm.
    pub max: f64,
    /// A random signal's, root mean square.
    pub mean: f64,
}

impl AngleAs {
    /// What stands for β and for β².
    fn powers(self, beta: f64) -> [f64; 2] {
        let (sin, square) = (beta.sin(), beta.sin() * beta.sin());
        match self {
            Self::Angle => [beta, beta * beta],
            Self::Phase => [sin * (1.0 + square / 6.0), square * (1.0 + square / 3.0)],
            Self::Normal => [sin, square],
        }
    }
}

/// The methods of a spec's bands from 1 and what they are given, if it is a rotation that may be approximate.
pub fn methods(spec: &Spec) -> Option<(&[SmallAngle], AngleAs)> {
    spec.family.by_band.map(|by_band| (&spec.methods[..], by_band.given))
}

/// The error of every band of a spec's kernel for a y angle, or a tilt, of β radians; zero for exact kernels.
pub fn errors(spec: &Spec, beta: f64) -> Vec<Error> {
    match methods(spec) {
        None => vec![Error::default(); spec.order],
        Some((methods, given)) => std::iter::once(Error::default())
            .chain(methods.iter().zip(1..).map(|(method, l)| error(*method, given, l, beta)))
            .collect(),
    }
}

/// A 2 × 2 matrix by rows.
type Plane = [[f64; 2]; 2];

fn product(a: Plane, b: Plane) -> Plane {
    let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

/// What a method does to the plane of a frequency k, as a rotation by kβ should; none if it mixes planes.
fn plane(method: SmallAngle, given: AngleAs, l: usize, k: f64, beta: f64) -> Option<Plane> {
    let [first, square] = given.powers(beta);
    let x = k * first;
    let polynomial = |even: f64, odd: f64| Some([[even, odd], [-odd, even]]);
    match method {
        SmallAngle::Exact => polynomial((k * beta).cos(), (k * beta).sin()),
        SmallAngle::Taylor1 => polynomial(1.0, x),
        SmallAngle::Taylor2 => polynomial(1.0 - x * x / 2.0, x),
        SmallAngle::Taylor15 => None,
        SmallAngle::Lf3 | SmallAngle::Lf5 => {
            let shears = parity_shears(l, method);
            Some(shears.iter().fold([[1.0, 0.0], [0.0, 1.0]], |all, shear| {
                let [linear, cubic] = shear.series.each_ref().map(|value| value.to_f64());
                let cubic = if given == AngleAs::Normal { cubic + linear / 6.0 } else { cubic };
                let f = x * (linear + cubic * square);
                let own = if shear.parity == 0 { [[1.0, f], [0.0, 1.0]] } else { [[1.0, 0.0], [-f, 1.0]] };
                product(own, all)
            }))
        }
    }
}

/// The largest singular value and the squared Frobenius norm of a 2 × 2 matrix.
fn norms([[a, b], [c, d]]: Plane) -> [f64; 2] {
    let square = a * a + b * b + c * c + d * d;
    let determinant = a * d - b * c;
    [((square + (square * square - 4.0 * determinant * determinant).max(0.0).sqrt()) / 2.0).sqrt(), square]
}

/// What `method` errs by in band l at the angle β in radians.
pub fn error(method: SmallAngle, given: AngleAs, l: usize, beta: f64) -> Error {
    if method == SmallAngle::Exact || l == 0 {
        return Error::default();
    }
    if method == SmallAngle::Taylor15 {
        return of_matrix(l, given, beta);
    }
    let (mut max, mut square) = (0.0f64, 0.0);
    for k in 1..=l {
        let (sin, cos) = (k as f64 * beta).sin_cos();
        let [[a, b], [c, d]] = plane(method, given, l, k as f64, beta).expect("the method keeps planes apart");
        let [own, all] = norms([[a - cos, b - sin], [c + sin, d - cos]]);
        max = max.max(own);
        square += all;
    }
    Error { max, mean: (square / (2 * l + 1) as f64).sqrt() }
}

/// Taylor 1.5 in band l: 1 + β A + β²/2 diag(A²) against the exact rotation, for the chains of cosines and of sines.
fn of_matrix(l: usize, given: AngleAs, beta: f64) -> Error {
    let [first, squared] = given.powers(beta);
    let size = 2 * l + 1;
    let signed = |i: usize| i as isize - l as isize;
    let mut generator = vec![vec![0.0; size]; size];
    for i in 1..size {
        let entry = tables::dy_sub_diag(l, signed(i)).to_f64();
        (generator[i][i - 1], generator[i - 1][i]) = (entry, -entry);
    }
    // e^{βA} by its series after halving the angle, then squaring.
    let times = |a: &[Vec<f64>], b: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let row = |i: usize| (0..size).map(|j| (0..size).map(|k| a[i][k] * b[k][j]).sum()).collect();
        (0..size).map(row).collect()
    };
    let halvings = 10;
    let step = beta / f64::from(1 << halvings);
    let identity = |i: usize, j: usize| f64::from(u8::from(i == j));
    let mut exact: Vec<Vec<f64>> = (0..size).map(|i| (0..size).map(|j| identity(i, j)).collect()).collect();
    for power in (1..=8).rev() {
        let product = times(&generator, &exact);
        let entry = |i: usize, j: usize| identity(i, j) + step / f64::from(power) * product[i][j];
        exact = (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect();
    }
    (0..halvings).for_each(|_| exact = times(&exact, &exact));
    let approximate = |i: usize, j: usize| match i == j {
        true => 1.0 + squared / 2.0 * tables::ddy_diag(l, signed(i)).to_f64(),
        false => first * generator[i][j],
    };
    let columns: Vec<Vec<f64>> =
        (0..size).map(|j| (0..size).map(|i| approximate(i, j) - exact[i][j]).collect()).collect();
    let square: f64 = columns.iter().flatten().map(|x| x * x).sum();
    Error { max: crate::math::linear::spectral_norm(&columns), mean: (square / size as f64).sqrt() }
}
