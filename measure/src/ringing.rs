//! What is done against ringing, and how far it errs: irradiance of order 3 of the maps that zonal carries with it, and of one
//! light alone, against all of their bands (docs/MATH.md#ringing).

use crate::markdown::{file, table as rows_of};
use crate::{File, Progress, each, significant};
use serde::{Deserialize, Serialize};
use zonal_codegen::environment::{Projection, cosine_lobe, harmonics};
use zonal_codegen::families::Spec;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_codegen::math::quadrature::gauss_legendre;

/// The order that stands for all bands of irradiance: what is beyond holds 0.01 of it at most.
const DEEP: usize = 20;
/// Rows of directions.
const ROWS: usize = 24;
/// Whence the light comes that is measured alone.
const LAMP: [f64; 3] = [0.36, 0.48, 0.8];

/// What is done, in the order of the errors.
pub const WAYS: [&str; 8] = [
    "order 3 as it is",
    "max(E, 0)",
    "`lerp_to_dc:3`",
    "`window:3`",
    "`window:3:laplacian`",
    "order 2 as it is",
    "`eval_geomerics`",
    "`eval_zh3`",
];

/// One light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ringing {
    /// The map's name, or what else it is.
    pub light: String,
    /// The least value of order 3 over the mean, of all channels.
    pub least: f64,
    /// The root mean square error of each way over all directions, relative to the irradiance.
    pub errors: Vec<f64>,
}

/// Irradiance in one direction, channel by channel.
type Exact = Box<dyn Fn([f64; 3]) -> Vec<f64>>;

struct Light {
    name: String,
    /// Its coefficients of irradiance of order 3, channel by channel.
    channels: Vec<Vec<f64>>,
    exact: Exact,
}

fn of_map(path: &str) -> Light {
    let bytes = zonal_scenes::embedded(path).unwrap_or_default();
    let (projection, _) = Projection::from_bytes(path, bytes, DEEP).unwrap_or_else(|error| panic!("{path}: {error}"));
    let irradiance = projection.irradiance();
    let channels = (0..3).map(|i| irradiance.coefficients[..9].iter().map(|c| c[i]).collect()).collect();
    let file = path.rsplit('/').next().unwrap_or(path);
    let name = file.split('_').next().unwrap_or(file).to_owned();
    Light { name, channels, exact: Box::new(move |dir| irradiance.evaluate(dir).to_vec()) }
}

fn lamp() -> Light {
    let mut y = [0.0; 9];
    harmonics::basis(3, LAMP, &mut y);
    let channel = y.iter().enumerate().map(|(place, y)| y * cosine_lobe(place.isqrt())).collect();
    let cosine = |dir: [f64; 3]| dir.iter().zip(LAMP).map(|(a, b)| a * b).sum::<f64>().max(0.0);
    Light { name: "one light".to_owned(), channels: vec![channel], exact: Box::new(move |dir| vec![cosine(dir)]) }
}

struct Kernel(Program<f64>);

impl Kernel {
    fn new(text: &str) -> Self {
        let spec: Spec = text.parse().unwrap_or_else(|error| panic!("{error}"));
        Self(Program::new(&Listing::new(&spec.kernel())))
    }

    fn run(&self, inputs: &[&[f64]]) -> Vec<f64> {
        self.0.run(inputs, Contraction::Separate)
    }
}

/// The least width that leaves nothing negative, and what it leaves.
fn windowed(text: &str, c: &[f64]) -> Vec<f64> {
    let (window, minimum) = (Kernel::new(text), Kernel::new("minimum:3"));
    let at = |mu: f64| window.run(&[&[mu], c]);
    let is_positive = |mu: f64| minimum.run(&[&at(mu)])[0] >= 0.0;
    let (mut low, mut high) = (0.0, 1.0);
    if is_positive(low) {
        return c.to_vec();
    }
    for _ in 0..40 {
        let middle = (low + high) / 2.0;
        if is_positive(middle) { high = middle } else { low = middle }
    }
    at(high)
}

fn measured(light: &Light) -> Ringing {
    let [three, two, geomerics, guessed, fade, minimum] =
        ["eval:3", "eval:2", "eval_geomerics", "eval_zh3", "lerp_to_dc:3", "minimum:3"].map(Kernel::new);
    let (mut errors, mut size) = (vec![0.0; WAYS.len()], 0.0);
    let (mut least, mut mean) = (f64::INFINITY, 0.0);
    for (channel, c) in light.channels.iter().enumerate() {
        let faded = fade.run(&[c]);
        let [blurred, damped] = ["window:3", "window:3:laplacian"].map(|text| windowed(text, c));
        least = f64::min(least, minimum.run(&[c])[0]);
        mean += c[0] / (4.0 * std::f64::consts::PI).sqrt() / light.channels.len() as f64;
        for (z, weight) in gauss_legendre(ROWS, -1.0, 1.0) {
            for column in 0..2 * ROWS {
                let (sin, cos) = (std::f64::consts::PI * column as f64 / ROWS as f64).sin_cos();
                let s = (1.0 - z * z).sqrt();
                let dir = [s * cos, s * sin, z];
                let want = (light.exact)(dir)[channel];
                let at = |kernel: &Kernel, c: &[f64]| kernel.run(&[&dir, c])[0];
                let plain = at(&three, c);
                let got = [
                    plain,
                    plain.max(0.0),
                    at(&three, &faded),
                    at(&three, &blurred),
                    at(&three, &damped),
                    at(&two, &c[..4]),
                    at(&geomerics, &c[..4]),
                    at(&guessed, &c[..4]),
                ];
                size += weight * want * want;
                errors.iter_mut().zip(got).for_each(|(sum, got)| *sum += weight * (got - want) * (got - want));
            }
        }
    }
    let errors = errors.into_iter().map(|sum| significant((sum / size).sqrt())).collect();
    Ringing { light: light.name.clone(), least: significant(least / mean), errors }
}

/// Measures one light alone, then every map.
pub fn measure(progress: &dyn Progress) -> Vec<Ringing> {
    let paths: Vec<Option<&str>> = std::iter::once(None).chain(zonal_scenes::below("maps").map(Some)).collect();
    let maps: Vec<Option<&str>> =
        paths.into_iter().filter(|path| path.is_none_or(|path| path.ends_with(".hdr"))).collect();
    each(progress, "ringing", &maps, |path| measured(&path.map_or_else(lamp, of_map)))
}

/// The page.
pub fn table(all: &[Ringing]) -> File {
    let maps = || all.iter().skip(1);
    let percent = |value: f64| format!("{:.1} %", 100.0 * value);
    let heads: Vec<&str> = std::iter::once("")
        .chain(all.iter().map(|light| light.light.as_str()))
        .chain(["mean of the maps", "the worst map"])
        .collect();
    let least = std::iter::once("least value over the mean, order 3".to_owned())
        .chain(all.iter().map(|light| percent(light.least)))
        .chain(["", ""].map(str::to_owned));
    let way = |(place, name): (usize, &&str)| -> Vec<String> {
        let of = |light: &Ringing| light.errors[place];
        let mean = maps().map(of).sum::<f64>() / maps().count() as f64;
        let worst = maps().map(of).fold(0.0, f64::max);
        let errors = all.iter().map(of).chain([mean, worst]).map(percent);
        std::iter::once((*name).to_owned()).chain(errors).collect()
    };
    let rows = std::iter::once(least.collect()).chain(WAYS.iter().enumerate().map(way));
    let parts = [
        format!(
            "Irradiance of order 3 falls below zero where one light is alone. What is done against it, and how far the result \
             errs from the irradiance of all bands (of a map, of order {DEEP}), as a root mean square over all directions and \
             channels, relative to the irradiance. The clamp stands in the shader, at no cost. `lerp_to_dc:3` and the windows \
             take as much as leaves nothing negative by `minimum:3`, each channel by itself, and nothing where nothing is \
             negative. The last three keep four coefficients; Geomerics' and ZH3's are not linear, so that they neither \
             blend nor filter."
        ),
        rows_of(&heads, rows),
    ];
    file("ringing", "Ringing", &parts)
}
