//! Helpers that the tests share: golden values, running a kernel in the interpreter, errors by band, shader text run
//! without a GPU.

pub mod command;
pub mod fuzz;
pub mod house;
pub mod shader;
pub mod tabulated;
pub mod toys;
pub mod turns;

use serde_json::Value;
use std::path::PathBuf;
use std::sync::LazyLock;
use zonal_codegen::catalog::standard;
use zonal_codegen::emit::Function;
use zonal_codegen::families::Spec;
use zonal_codegen::generate::build;
use zonal_codegen::ir::code::{self, Code};
use zonal_codegen::ir::eval::{Contraction, Number};
use zonal_codegen::ir::kernel::Kernel;
use zonal_codegen::ir::listing::Listing;

/// A path below the repository.
pub fn repository(path: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join(path)
}

/// A file of golden values.
///
/// # Panics
///
/// If there is no such file or it is no JSON.
pub fn golden(name: &str) -> Value {
    let path = repository(&format!("tests/golden/{name}.json"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A JSON list of numbers.
///
/// # Panics
///
/// If it is anything else.
pub fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list of numbers");
    list.iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// A spec from its text.
///
/// # Panics
///
/// If it is none.
pub fn spec(text: &str) -> Spec {
    text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// Every kernel of the catalogue, built once in a process.
pub fn catalogue() -> &'static [Function] {
    static FUNCTIONS: LazyLock<Vec<Function>> = LazyLock::new(|| build(&standard()));
    &FUNCTIONS
}

/// A kernel that can be run again and again.
#[derive(Clone, Debug)]
pub struct Runner<T>(code::Runner<T>);

impl<T: Number> Runner<T> {
    /// The kernel of a spec, in the form that it names.
    pub fn new(spec: &Spec) -> Self {
        Self(spec.code().runner())
    }

    /// A kernel in straight lines.
    pub fn of(kernel: &Kernel) -> Self {
        Self(Code::Straight(Listing::new(kernel)).runner())
    }

    /// Runs it unfused on inputs that are rounded to `T`.
    pub fn run(&self, inputs: &[Vec<f64>]) -> Vec<f64> {
        let rounded: Vec<Vec<T>> = inputs.iter().map(|list| list.iter().map(|&x| T::from_f64(x)).collect()).collect();
        let slices: Vec<&[T]> = rounded.iter().map(Vec::as_slice).collect();
        self.0.run(&slices, Contraction::Separate).into_iter().map(Number::to_f64).collect()
    }
}

/// The largest error of any band relative to the band's norm in `want`; NaN if there is one.
pub fn band_error(got: &[f64], want: &[f64]) -> f64 {
    (0..got.len().isqrt())
        .map(|l| {
            let range = l * l..(l + 1) * (l + 1);
            let difference: Vec<f64> =
                got[range.clone()].iter().zip(&want[range.clone()]).map(|(a, b)| a - b).collect();
            norm(&difference) / norm(&want[range])
        })
        .fold(0.0, larger)
}

/// The Euclidean norm.
pub fn norm(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The larger of two numbers, or NaN if one is.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// The unit quaternion (x, y, z, w) of Rz(α) Ry(β) Rz(γ).
pub fn quaternion_of_angles(alpha: f64, beta: f64, gamma: f64) -> Vec<f64> {
    let (cos, sin) = ((beta / 2.0).cos(), (beta / 2.0).sin());
    let (sum, difference) = ((alpha + gamma) / 2.0, (alpha - gamma) / 2.0);
    vec![-sin * difference.sin(), sin * difference.cos(), cos * sum.sin(), cos * sum.cos()]
}

/// The Hamilton product of two quaternions (x, y, z, w): first `b`, then `a`.
pub fn quaternion_product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let [x, y, z, w] = [a[0], a[1], a[2], a[3]];
    let [p, q, r, s] = [b[0], b[1], b[2], b[3]];
    vec![
        w * p + x * s + y * r - z * q,
        w * q - x * r + y * s + z * p,
        w * r + x * q - y * p + z * s,
        w * s - x * p - y * q - z * r,
    ]
}
