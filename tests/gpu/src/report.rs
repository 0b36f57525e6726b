//! Starts the bench on a driver, and the table of what all drivers' benches found.

use crate::bench::Row;
use crate::system::Driver;
use std::process::Command;
use zonal_codegen::emit::dialect::Target;
use zonal_codegen::spec::{Family, Method, Spec};

/// The family and the method of a spec, without its order and its channels.
pub fn family(spec: &Spec) -> String {
    let text = Spec { rgb: false, ..spec.clone() }.to_string();
    let mut parts: Vec<&str> = text.split(':').collect();
    parts.remove(1);
    let default = Spec::default_method(spec.order, false);
    if spec.family == Family::Rotate(default.clone()) {
        parts.insert(1, if default == Method::Tensor { "tensor" } else { "zyz" });
    }
    parts.join(":")
}

/// What a driver's bench found.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Which driver it was.
    pub driver: Driver,
    /// What the driver calls itself.
    pub adapter: String,
    /// A row a text.
    pub rows: Vec<Row>,
}

/// Runs the worker program on a driver.
///
/// # Errors
///
/// If the driver is not installed, or what the worker says when it fails.
pub fn measure(worker: &str, driver: Driver, mode: &str) -> Result<Measured, String> {
    let manifest = driver.manifest()?;
    let output = Command::new(worker)
        .arg(mode)
        .env("VK_ICD_FILENAMES", &manifest)
        .env("VK_DRIVER_FILES", &manifest)
        .envs(driver.settings.iter().copied())
        .output()
        .map_err(|error| error.to_string())?;
    let (text, said) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if !output.status.success() {
        return Err(format!("{} fails ({}):\n{said}", driver.name, output.status));
    }
    let (adapters, rows): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| !line.contains('\t'));
    match adapters.first() {
        Some(adapter) if adapter.contains(driver.adapter) => Ok(Measured {
            driver,
            adapter: (*adapter).to_owned(),
            rows: rows.into_iter().map(str::parse).collect::<Result<_, _>>()?,
        }),
        other => Err(format!("{} was wanted and {other:?} ran", driver.name)),
    }
}

/// A line of the table: what all drivers found of one family.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// The family.
    pub family: String,
    /// The worst error of each driver in each language, in the order of the columns.
    pub errors: Vec<f64>,
    /// The smallest and the largest tolerance of its kernels.
    pub tolerance: [f64; 2],
}

/// The languages that every driver runs.
pub const LANGUAGES: [Target; 2] = [Target::Wgsl, Target::Glsl];

/// The table: a line a family, in alphabetical order.
pub fn lines(measured: &[Measured]) -> Vec<Line> {
    let family_of = |row: &Row| family(&row.spec.parse().expect("the worker prints specs"));
    let mut families: Vec<String> = measured.iter().flat_map(|measured| &measured.rows).map(family_of).collect();
    families.sort();
    families.dedup();
    let line = |family: String| {
        let rows = |measured: &Measured| -> Vec<Row> {
            measured.rows.iter().filter(|row| family_of(row) == family).cloned().collect()
        };
        let worst = |rows: &[Row], target: Target| {
            rows.iter().filter(|row| row.target == target).map(|row| row.error).fold(0.0, f64::max)
        };
        let all: Vec<Vec<Row>> = measured.iter().map(rows).collect();
        let errors = all.iter().flat_map(|rows| LANGUAGES.map(|target| worst(rows, target))).collect();
        let tolerances = || all.iter().flatten().map(|row| row.tolerance);
        let tolerance = [tolerances().fold(f64::INFINITY, f64::min), tolerances().fold(0.0, f64::max)];
        Line { family, errors, tolerance }
    };
    families.into_iter().map(line).collect()
}
