//! Glossy surfaces in harmonics (Soler et al. 2015, Figures 4 and 12, Table I): how many bands a lobe needs, how it rings with
//! fewer, how pictures converge and what the tables of reflectances take.

use crate::markdown::{file, percent, short, table as rows_of};
use crate::raster::Raster;
use crate::sphere::{Tile, heat};
use crate::svg::{self, Axis, Panel, Picture, Series, Stroke, key};
use crate::{File, Progress, each, significant};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use zonal_codegen::environment::harmonics::basis;
use zonal_codegen::families::Spec;
use zonal_codegen::ir::eval::Contraction;
use zonal_codegen::math::quadrature::gauss_legendre;
use zonal_codegen::reflectance::brdf::{Brdf, Table};
use zonal_picture::tone;
use zonal_picture::vector::dot;

/// The exponents of the lobes that ring.
const RINGING: [f64; 4] = [25.0, 100.0, 400.0, 900.0];
/// The highest bands that they are cut off at.
const CUTS: [usize; 12] = [4, 8, 12, 16, 20, 24, 30, 36, 42, 48, 56, 63];
/// Directions of a lobe, evenly spread over the angle from its axis.
const ANGLES: usize = 361;
/// The exponents whose bands are counted.
const EXPONENTS: [f64; 6] = [10.0, 30.0, 100.0, 300.0, 900.0, 3000.0];
/// The errors that bands are counted for.
const ERRORS: [f64; 2] = [0.1, 0.01];
/// As many bands as any of these lobes has.
const DEEP: usize = 320;
/// The reflectances of the picture.
const REFLECTANCES: [&str; 3] = ["ward:0.3", "phong:50", "ward:0.15:0.4"];
/// The highest bands of the picture.
const STRIP: [usize; 5] = [4, 8, 12, 16, 20];
/// The bands of the reference.
const REFERENCE: usize = 40;
/// The map of the picture.
const MAP: &str = "city";
/// Pixels along a side of a tile.
const SIDE: usize = 72;
/// The difference that is white in the picture, relative to the brightest pixel.
const WHITE: f64 = 0.2;
/// The name of the picture.
pub const NAME: &str = "glossy.png";
/// The numbers of bands of Table I.
const ORDERS: [usize; 4] = [8, 12, 16, 31];
/// What the paper prints for them, in megabytes: isotropic, anisotropic.
const PRINTED: [[f64; 2]; 4] = [[0.1, 12.0], [0.2, 24.0], [0.4, 48.0], [1.5, 192.0]];
/// The reflectances whose tables are counted.
const TABLED: [&str; 2] = ["ward:0.2", "ward:0.2:0.5"];

/// How a lobe rings that is cut off.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ringing {
    /// The exponent.
    pub exponent: f64,
    /// The highest band.
    pub bands: usize,
    /// The share of all directions in which it is below minus a thousandth of its peak.
    pub negative: f64,
    /// The least value, relative to the peak of the lobe.
    pub least: f64,
    /// By how much it exceeds the lobe at most, relative to its peak.
    pub over: f64,
}

/// How many bands a lobe needs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Needed {
    /// The exponent.
    pub exponent: f64,
    /// The relative error that the bands to its root leave.
    pub at_root: f64,
    /// The highest band for each error.
    pub bands: [usize; 2],
}

/// How pictures of a reflectance converge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Convergence {
    /// The reflectance.
    pub reflectance: String,
    /// The root mean square error for each highest band, relative to the picture.
    pub errors: [f64; 5],
}

/// What tables take.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// The number of bands.
    pub order: usize,
    /// Elevations and azimuths of the views: isotropic, anisotropic.
    pub views: [[usize; 2]; 2],
    /// Bytes of a channel in f32.
    pub bytes: [usize; 2],
}

/// All that is measured of glossy surfaces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Glossy {
    /// Figure 12.
    pub ringing: Vec<Ringing>,
    /// Bands over exponents.
    pub needed: Vec<Needed>,
    /// Figure 4.
    pub convergence: Vec<Convergence>,
    /// Table I.
    pub memory: Vec<Memory>,
}

/// P_0 to P_l times √((2l+1)/4π).
fn zonal(count: usize, z: f64) -> Vec<f64> {
    let mut values = vec![1.0, z];
    for l in 1..count {
        let n = l as f64;
        values.push(((2.0 * n + 1.0) * z * values[l] - n * values[l - 1]) / (n + 1.0));
    }
    values.truncate(count);
    values.iter().enumerate().map(|(l, p)| ((2 * l + 1) as f64 / (4.0 * PI)).sqrt() * p).collect()
}

/// The coefficients of max(0, z)^exponent, about its axis.
fn lobe(exponent: f64, count: usize) -> Vec<f64> {
    let mut sums = vec![0.0; count];
    for (z, weight) in gauss_legendre(400, 0.0, 1.0) {
        let value = TAU * weight * z.powf(exponent);
        sums.iter_mut().zip(zonal(count, z)).for_each(|(sum, y)| *sum += value * y);
    }
    sums
}

/// The lobe by the loop of the basis, in f32.
fn ringing(&(exponent, bands): &(f64, usize)) -> Ringing {
    let order = bands + 1;
    // Names a family: the loop of the basis is what a shader would run.
    let spec: Spec = format!("basis:{order}:loop").parse().unwrap_or_else(|error| panic!("{error}"));
    let run = spec.code().runner::<f32>();
    let zonal = lobe(exponent, order);
    let (mut negative, mut all, mut least, mut over) = (0.0, 0.0, 0.0f64, 0.0f64);
    for i in 0..ANGLES {
        let (sin, cos) = (PI * i as f64 / (ANGLES - 1) as f64).sin_cos();
        let y = run.run(&[&[sin as f32, 0.0, cos as f32]], Contraction::Separate);
        let value = f64::from(zonal.iter().enumerate().map(|(l, c)| *c as f32 * y[l * (l + 1)]).sum::<f32>());
        all += sin;
        negative += if value < -1e-3 { sin } else { 0.0 };
        least = least.min(value);
        over = over.max(value - cos.max(0.0).powf(exponent));
    }
    // What is smaller f32 may have rounded.
    let [negative, least, over] =
        [negative / all, least, over].map(|x| if x.abs() < 1e-5 { 0.0 } else { significant(x) });
    Ringing { exponent, bands, negative, least, over }
}

fn needed(&exponent: &f64) -> Needed {
    let squares: Vec<f64> = lobe(exponent, DEEP).iter().map(|c| c * c).collect();
    // ∫ max(0, z)^2s over the sphere, so that what lies beyond all bands counts.
    let all = TAU / (2.0 * exponent + 1.0);
    let error = |bands: usize| (1.0 - squares[..=bands].iter().sum::<f64>() / all).max(0.0).sqrt();
    let root = exponent.sqrt().round() as usize;
    let bands = ERRORS.map(|most| (0..DEEP).find(|&bands| error(bands) <= most).unwrap_or(DEEP));
    Needed { exponent, at_root: significant(error(root)), bands }
}

/// The radiance of each cut and of the reference.
type Cuts = [[f64; 3]; STRIP.len() + 1];

/// Nodes of the sphere, exact for products of the reference's bands with as many of the reflectance, with the light of each cut.
struct Lit {
    nodes: Vec<([f64; 3], Cuts)>,
}

impl Lit {
    fn new() -> Self {
        let maps = crate::hemisphere::maps();
        let (_, map) = maps.iter().find(|(name, _)| *name == MAP).unwrap_or(&maps[0]);
        let light = map.project(REFERENCE);
        let azimuths = 2 * REFERENCE;
        let cuts: Vec<usize> = STRIP.iter().map(|last| last + 1).chain([REFERENCE]).collect();
        let node = |(z, weight): (f64, f64), i: usize| {
            let (y, x) = (TAU * (i as f64 + 0.5) / azimuths as f64).sin_cos();
            let rim = (1.0 - z * z).sqrt();
            let direction = [rim * x, rim * y, z];
            let mut values = vec![0.0; REFERENCE * REFERENCE];
            basis(REFERENCE, direction, &mut values);
            let share = weight * TAU / azimuths as f64;
            let mut sums = [[0.0; 3]; STRIP.len() + 1];
            for (sum, order) in sums.iter_mut().zip(&cuts) {
                for (y, c) in values.iter().zip(&light.coefficients[..order * order]) {
                    (0..3).for_each(|channel| sum[channel] += share * y * c[channel]);
                }
            }
            (direction, sums)
        };
        let rows: Vec<(f64, f64)> = gauss_legendre(REFERENCE, -1.0, 1.0).collect();
        let nodes = rows.into_par_iter().flat_map_iter(|row| (0..azimuths).map(move |i| node(row, i))).collect();
        Self { nodes }
    }

    fn shaded(&self, brdf: &Brdf, [x, y, z]: [[f64; 3]; 3], view: [f64; 3]) -> Cuts {
        let mut sums = [[0.0; 3]; STRIP.len() + 1];
        for (direction, light) in &self.nodes {
            let up = dot(*direction, z);
            if up > 0.0 {
                let value = brdf.value(view, [dot(*direction, x), dot(*direction, y), up]);
                for (sum, light) in sums.iter_mut().zip(light) {
                    (0..3).for_each(|channel| sum[channel] += value * light[channel]);
                }
            }
        }
        sums
    }
}

/// A strip of pictures and one of what they miss for each reflectance.
fn strips(progress: &dyn Progress) -> (Vec<Convergence>, Raster) {
    let lit = Lit::new();
    let tile = Tile { side: SIDE };
    let columns = STRIP.len() + 1;
    let mut raster = Raster::new(NAME, [columns * SIDE, 2 * REFLECTANCES.len() * SIDE]);
    let all = each(progress, "glossy spheres", &REFLECTANCES, |text| {
        let brdf: Brdf = text.parse().unwrap_or_else(|error| panic!("{text}: {error}"));
        let pixel = |i: usize| {
            let (axes, view) = tile.surface(i % SIDE, i / SIDE)?;
            Some(lit.shaded(&brdf, axes, view))
        };
        (0..SIDE * SIDE).into_par_iter().map(pixel).collect::<Vec<_>>()
    });
    let last = columns - 1;
    let converged = |(row, (text, pixels)): (usize, (&&str, &Vec<Option<Cuts>>))| {
        let shown = || pixels.iter().enumerate().filter_map(|(i, shown)| Some((i, shown.as_ref()?)));
        let exposure = tone::exposure(shown().map(|(_, shown)| shown[last]));
        let most = shown().map(|(_, shown)| tone::luminance(shown[last])).fold(0.0, f64::max);
        let (mut errors, mut size) = ([0.0; STRIP.len()], 0.0);
        for (i, shown) in shown() {
            let place = |column: usize, below: usize| [column * SIDE + i % SIDE, (2 * row + below) * SIDE + i / SIDE];
            for (column, radiance) in shown.iter().enumerate() {
                let exposed = radiance.map(|c| exposure * c);
                let is_negative = exposed.iter().any(|c| *c < 0.0);
                raster.set(place(column, 0), if is_negative { exposed } else { tone::mapped(exposed) });
                let error = (0..3).map(|c| (radiance[c] - shown[last][c]).powi(2)).sum::<f64>();
                raster.set(place(column, 1), heat((error / 3.0).sqrt() / (WHITE * most)));
                if column < last {
                    errors[column] += error;
                }
            }
            size += shown[last].iter().map(|c| c * c).sum::<f64>();
        }
        let errors = errors.map(|error| significant((error / size).sqrt()));
        Convergence { reflectance: (*text).to_owned(), errors }
    };
    let convergence = REFLECTANCES.iter().zip(&all).enumerate().map(converged).collect();
    (convergence, raster)
}

fn memory(&order: &usize) -> Memory {
    let brdfs: [Brdf; 2] = TABLED.map(|text| text.parse().unwrap_or_else(|error| panic!("{text}: {error}")));
    let views = [0, 1].map(|i| Table::shape(&brdfs[i], order));
    // Without the terms of negative order where the surface is isotropic.
    let numbers = [order * (order + 1) / 2, order * order];
    Memory { order, views, bytes: [0, 1].map(|i| 4 * views[i][0] * views[i][1] * numbers[i]) }
}

/// Measures glossy surfaces and draws their picture.
pub fn measure(progress: &dyn Progress) -> (Glossy, Raster) {
    let cuts: Vec<(f64, usize)> = RINGING.iter().flat_map(|&exponent| CUTS.map(|bands| (exponent, bands))).collect();
    let (convergence, raster) = strips(progress);
    let glossy = Glossy {
        ringing: each(progress, "ringing lobes", &cuts, ringing),
        needed: EXPONENTS.iter().map(needed).collect(),
        convergence,
        memory: ORDERS.iter().map(memory).collect(),
    };
    (glossy, raster)
}

fn megabytes(bytes: usize) -> String {
    short(bytes as f64 / f64::from(1 << 20))
}

/// The page.
pub fn table(glossy: &Glossy) -> File {
    let least = |exponent: f64| {
        let row = glossy.ringing.iter().find(|row| row.exponent == exponent && row.bands == 48);
        row.map_or_else(String::new, |row| percent(row.least))
    };
    let needed = glossy.needed.iter().map(|row| {
        let root = row.exponent.sqrt();
        let mut cells = vec![row.exponent.to_string(), short(root), percent(row.at_root)];
        cells.extend(row.bands.iter().flat_map(|&bands| [bands.to_string(), short(bands as f64 / root)]));
        cells
    });
    let rings = CUTS.iter().map(|cut| {
        let of = |exponent: &f64| {
            let row = glossy.ringing.iter().find(|row| row.exponent == *exponent && row.bands == *cut);
            row.map_or_else(String::new, |row| {
                format!("{} / {} / {}", percent(row.negative), percent(row.least), percent(row.over))
            })
        };
        std::iter::once(cut.to_string()).chain(RINGING.iter().map(of)).collect()
    });
    let converged = glossy
        .convergence
        .iter()
        .map(|row| std::iter::once(format!("`{}`", row.reflectance)).chain(row.errors.map(percent)).collect());
    let memory = glossy.memory.iter().zip(PRINTED).map(|(row, printed)| {
        let views = |[elevations, azimuths]: [usize; 2]| format!("{elevations} × {azimuths}");
        let papers = 6 * 64 * 64 * 2 * row.order * row.order * 4;
        vec![
            format!("{}²", row.order),
            printed[0].to_string(),
            views(row.views[0]),
            megabytes(row.bytes[0]),
            printed[1].to_string(),
            megabytes(papers),
            views(row.views[1]),
            megabytes(row.bytes[1]),
        ]
    });
    let exponents: Vec<String> = RINGING.iter().map(|exponent| format!("s = {exponent}")).collect();
    let parts = [
        "How many bands glossy surfaces need: Figures 4 and 12 and Table I of Soler et al. 2015.".to_owned(),
        "## Bands over the exponent\n\nThe paper takes L = √s for a Phong lobe of exponent s. The coefficients of max(0, cos)^s fall \
         as exp(−l²/2s), so that the bands to √s leave e^(−1/2) of it, three fifths: errors here are root mean squares over the \
         sphere, relative to the lobe. What is needed grows as √s indeed, but 2.1 times that for an error of 10 % and 3 times for \
         1 %, as √(2 ln(1/error)) says."
            .to_owned(),
        rows_of(
            &["s", "√s", "error with L = √s, %", "L for 10 %", "over √s", "L for 1 %", "over √s"],
            needed,
        ),
        format!(
            "## Ringing\n\n![How far a lobe cut off at band L goes below zero](glossy.svg)\n\nFigure 12: the lobe cut off after band L, \
             by `basis:n:loop` in f32: the share of all directions in which it is below minus a thousandth of the peak, its least \
             value, and by how much it exceeds the lobe at most, in per cent of the peak. That artifacts *completely disappear at \
             L ≈ 50* holds for s = 100, not for s = 400, which falls to {} % at L = 48, and for 900, to {} %. What is \
             below 1e-5 of the peak is told as nothing, since f32 rounds it.",
            least(400.0),
            least(900.0),
        ),
        rows_of(&["L"].into_iter().chain(exponents.iter().map(String::as_str)).collect::<Vec<_>>(), rings),
        format!(
            "## Convergence\n\n![Spheres of three reflectances, and what they miss]({NAME})\n\nFigure 4: spheres under the map *{MAP}*, \
             L = {} from left to right, then {} bands; below, what each misses, white from {} % of the brightest pixel on. What is \
             negative is blue. The surface's x lies along the parallels. The root mean square error, in per cent of the last:",
            STRIP.map(|last| last.to_string()).join(", "),
            REFERENCE,
            percent(WHITE),
        ),
        rows_of(
            &["reflectance".to_owned()]
                .into_iter()
                .chain(STRIP.map(|last| format!("L = {last}")))
                .collect::<Vec<_>>()
                .iter()
                .map(String::as_str)
                .collect::<Vec<_>>(),
            converged,
        ),
        format!(
            "## Tables\n\nTable I: megabytes (2²⁰ bytes) of a channel for s numbers a view, as printed, and as zonal's tables have \
             them, in f32: `{}` over elevations alone and without the terms of negative order, `{}` over elevations and azimuths, \
             with steps by which linear interpolation errs by less than 1 %. What the paper prints for anisotropic surfaces is \
             nearly what 2 s numbers for each of 6 × 64² views take, beside it.",
            TABLED[0], TABLED[1],
        ),
        rows_of(
            &["s", "isotropic, printed", "views", "MB", "anisotropic, printed", "2 s in 6 × 64²", "views", "MB"],
            memory,
        ),
    ];
    file("glossy", "Glossy surfaces", &parts)
}

/// The plot of the ringing.
pub fn plot(glossy: &Glossy) -> File {
    let series = |(colour, exponent): (usize, &f64)| {
        let rows = glossy.ringing.iter().filter(|row| row.exponent == *exponent);
        let points = rows.map(|row| (row.bands as f64, (-row.least).max(1e-6))).collect();
        Series { colour, stroke: Stroke::Dotted, points }
    };
    let picture = Picture {
        title: "Ringing of lobes".to_owned(),
        subtitle: "The least value of a lobe cut off after band L, below zero, relative to its peak".to_owned(),
        size: [620.0, 380.0],
        columns: 1,
        panels: vec![Panel {
            title: String::new(),
            x: Axis::linear("L", 0.0, 64.0, &[0.0, 8.0, 16.0, 24.0, 32.0, 40.0, 48.0, 56.0, 64.0]),
            y: Axis::decades("undershoot", 1e-6, 1.0),
            series: RINGING.iter().enumerate().map(series).collect(),
        }],
        keys: RINGING.iter().enumerate().map(|(i, s)| key(&format!("s = {s}"), i, Stroke::Dotted)).collect(),
    };
    svg::file("glossy", &picture)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Γ gives the integrals of powers against Legendre polynomials: ∫ z^s P_l obeys (s + l + 1) I(s, l) = s I(s − 1, l − 1).
    #[test]
    fn lobes_have_their_closed_form() {
        fn moment(power: f64, l: usize) -> f64 {
            match l {
                0 => 1.0 / (power + 1.0),
                _ => power * moment(power - 1.0, l - 1) / (power + l as f64 + 1.0),
            }
        }
        for exponent in [25.5, 900.5] {
            for (l, found) in lobe(exponent, 40).into_iter().enumerate() {
                let wanted = TAU * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt() * moment(exponent, l);
                assert!((found - wanted).abs() < 1e-12, "{exponent}, band {l}: {found}, {wanted}");
            }
        }
    }

    #[test]
    fn bands_grow_as_the_root_of_the_exponent_but_faster() {
        for row in EXPONENTS[2..5].iter().map(needed) {
            let root = row.exponent.sqrt();
            // e^(−1/2) as the exponent grows.
            assert!((0.54..0.61).contains(&row.at_root), "{row:?}");
            for (bands, most) in row.bands.into_iter().zip(ERRORS) {
                let predicted = (2.0 * (1.0 / most).ln()).sqrt() * root;
                assert!((bands as f64 / predicted - 1.0).abs() < 0.08, "{row:?}, predicted {predicted}");
            }
        }
    }
}
