//! Frames measured against each other: errors, what they cost, and how they fall with the order.

use crate::bands::{ERROR, Tables};
use crate::frame::{Frame, Surface};
use crate::gpu::Stage;
use crate::reference::{Lights, expected};
use crate::subject::Subject;
use indicatif::ProgressBar;
use serde::{Deserialize, Serialize};
use zonal_codegen::environment::Projection;
use zonal_codegen::reflectance::brdf::Table;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_picture::method::{Judged, Method};
use zonal_picture::shade::Shading;

/// How far a frame is from another, in shares of the other's mean radiance. The radiance of a pixel, and an error of it,
/// is the root of the sum of the squares of R, G and B.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// The mean over the pixels.
    pub mean: f64,
    /// The root of the mean square.
    pub rms: f64,
    /// The largest.
    pub worst: f64,
}

fn size(pixel: [f64; 3]) -> f64 {
    pixel.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// The mean radiance of a frame.
pub fn mean_radiance(frame: &Frame) -> f64 {
    let count = frame.pixels.iter().flatten().count().max(1);
    frame.pixels.iter().flatten().map(|pixel| size(*pixel)).sum::<f64>() / count as f64
}

/// The error of each pixel that both frames have, in shares of the mean radiance of the second.
pub fn pixel_errors(frame: &Frame, truth: &Frame) -> Vec<Option<f64>> {
    let mean = mean_radiance(truth);
    let error = |(a, b): (&Option<[f64; 3]>, &Option<[f64; 3]>)| {
        let (a, b) = (a.as_ref()?, b.as_ref()?);
        Some(size(std::array::from_fn(|i| a[i] - b[i])) / mean)
    };
    frame.pixels.iter().zip(&truth.pixels).map(error).collect()
}

impl Errors {
    /// The errors of a frame against another, over the pixels that both have.
    pub fn of(frame: &Frame, truth: &Frame) -> Self {
        let errors: Vec<f64> = pixel_errors(frame, truth).into_iter().flatten().collect();
        let count = errors.len().max(1) as f64;
        Self {
            mean: errors.iter().sum::<f64>() / count,
            rms: (errors.iter().map(|e| e * e).sum::<f64>() / count).sqrt(),
            worst: errors.iter().copied().fold(0.0, f64::max),
        }
    }
}

/// A part of a subject's pixels by brute force.
#[derive(Clone, Debug)]
pub struct Truth {
    /// The radiance.
    pub frame: Frame,
    /// The views of the pixels, each in the frame of its normal.
    pub views: Vec<[f64; 3]>,
}

impl Truth {
    /// About `points` pixels of a stage's subject, evenly spread; `bar` moves by as many steps as there are.
    ///
    /// # Errors
    ///
    /// If the device fails, or no pixel shows the object.
    pub fn new(stage: &Stage, points: usize, bar: &ProgressBar) -> Result<Self, Diagnostic> {
        let (subject, surfaces) = (stage.subject, stage.surfaces()?);
        let all: Vec<&Surface> = surfaces.iter().flatten().collect();
        if all.is_empty() {
            let help = "move the camera: `azimuth`, `elevation` and `distance` in `[picture]`";
            return Err(Diagnostic::nowhere("the picture shows nothing of the object", help));
        }
        let step = all.len().div_ceil(points.max(1));
        let views = all.iter().step_by(step).map(|surface| surface.modulated().1).collect();
        bar.set_length(all.len().div_ceil(step) as u64);
        let lights = Lights::of(&subject.map).with(&subject.lights);
        let frame = lights.frame(&subject.brdf, stage.size, &surfaces, step, || bar.inc(1));
        Ok(Self { frame, views })
    }
}

/// How far the exact kernel of an order is from brute force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The number of bands.
    pub order: usize,
    /// Against brute force.
    pub errors: Errors,
    /// The root mean square that the bands left out come to if the reflectance lies against the light as by chance.
    pub expected: f64,
}

/// Light and reflectance are taken to end below this band.
const DEPTH: usize = 40;

/// How the exact kernel's picture nears brute force as the order grows.
///
/// # Errors
///
/// If a shader is too long or the device fails.
pub fn convergence(stage: &Stage, truth: &Truth, orders: impl Iterator<Item = usize>) -> Result<Vec<Row>, Diagnostic> {
    let subject = stage.subject;
    let few: Vec<[f64; 3]> = truth.views.iter().step_by(truth.views.len().div_ceil(200)).copied().collect();
    let expected = expected(&subject.brdf, &few, &subject.light(DEPTH), DEPTH);
    let mean = mean_radiance(&truth.frame);
    let row = |order: usize| {
        let (frame, _) = drawn(stage, &Inputs::new(subject, order), Method::Exact, None, false)?;
        Ok(Row { order, errors: Errors::of(&frame, &truth.frame), expected: expected[order - 1] / mean })
    };
    orders.map(row).collect()
}

/// What one picture of a comparison is, costs and misses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// The method.
    pub method: Method,
    /// Its kernel.
    pub spec: Option<String>,
    /// The kernel's operations.
    pub operations: usize,
    /// Against the exact kernel's picture.
    pub errors: Errors,
    /// The time of a frame.
    pub milliseconds: f64,
}

/// Everything that is known of a picture, as it stands beside the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// The scene's name.
    pub scene: String,
    /// The adapter that drew it.
    pub adapter: String,
    /// The width and the height of one picture in pixels.
    pub size: [usize; 2],
    /// How many samples a pixel has along each side.
    pub samples: usize,
    /// The number of bands.
    pub order: usize,
    /// The reflectance.
    pub brdf: String,
    /// The pictures.
    pub pictures: Vec<Picture>,
}

/// A subject's reflectance and light as its shaders read them, whatever the method.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// The reflectance by view: one, or one each for red, green and blue.
    pub tables: Vec<Table>,
    /// The light.
    pub light: Projection,
}

impl Inputs {
    /// Those of an order.
    pub fn new(subject: &Subject, order: usize) -> Self {
        let tables = subject.brdf.channels().iter().map(|brdf| Table::new(brdf, order)).collect();
        Self { tables, light: subject.light(order) }
    }

    /// The frame of a stage. A reflectance that differs between channels is drawn once for each.
    /// The light is read from tables of its bands if there are any, and the reflectance is as `made` makes it.
    fn frame(
        &self,
        stage: &Stage,
        shading: Shading,
        bands: Option<&Tables>,
        made: impl Fn(&Table) -> Table,
        timed: bool,
    ) -> Result<Frame, Diagnostic> {
        let frames = self.tables.iter().map(|table| stage.frame(shading, &made(table), &self.light, bands, timed));
        let frames = frames.collect::<Result<Vec<Frame>, Diagnostic>>()?;
        let milliseconds = frames.iter().map(|frame| frame.milliseconds).sum();
        let last = frames.len() - 1;
        let pixel = |at: usize| {
            let of = |channel: usize| frames[channel.min(last)].pixels[at].map(|radiance| radiance[channel]);
            Some([of(0)?, of(1)?, of(2)?])
        };
        let pixels = (0..frames[0].pixels.len()).map(pixel).collect();
        Ok(Frame { size: frames[0].size, pixels, milliseconds })
    }
}

/// Draws a subject by a method and measures it against the exact kernel's frame, if there is one already.
///
/// # Errors
///
/// If the shader is too long or the device fails.
pub fn drawn(
    stage: &Stage,
    inputs: &Inputs,
    method: Method,
    exact: Option<&Frame>,
    timed: bool,
) -> Result<(Frame, Picture), Diagnostic> {
    let order = inputs.light.order;
    let shading = stage.subject.shading(order, method);
    let frame = match method.reads_tables() {
        false => inputs.frame(stage, shading, None, Table::clone, timed)?,
        true => {
            let tables = Tables::new(&inputs.light, ERROR)?;
            inputs.frame(stage, shading, Some(&tables), |table| tables.reflectance(table, method), timed)?
        }
    };
    let picture = Picture {
        method,
        spec: method.spec(order).map(|spec| spec.to_string()),
        operations: method.cost(order).total,
        errors: exact.map(|exact| Errors::of(&frame, exact)).unwrap_or_default(),
        milliseconds: frame.milliseconds,
    };
    Ok((frame, picture))
}

/// A share as percent, to two digits.
pub fn percent(share: f64) -> String {
    let value = 100.0 * share;
    match value {
        0.0 => "0 %".to_owned(),
        v if v >= 10.0 => format!("{v:.0} %"),
        v if v >= 1.0 => format!("{v:.1} %"),
        v if v >= 0.1 => format!("{v:.2} %"),
        v if v >= 0.01 => format!("{v:.3} %"),
        v if v >= 0.001 => format!("{v:.4} %"),
        v => format!("{v:.0e} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_shares_of_the_mean_over_what_both_frames_have() {
        let frame = |pixels: Vec<Option<[f64; 3]>>| Frame { size: [4, 1], pixels, milliseconds: 0.0 };
        let truth = frame(vec![Some([2.0, 0.0, 0.0]), Some([0.0, 6.0, 0.0]), None, None]);
        let other = frame(vec![Some([2.0, 0.0, 3.0]), Some([0.0, 6.0, 0.0]), Some([9.0; 3]), None]);
        let errors = Errors::of(&other, &truth);
        assert_eq!((errors.mean, errors.worst), (0.375, 0.75));
        assert!((errors.rms - 0.75 / 2f64.sqrt()).abs() < 1e-15);
        assert_eq!(Errors::of(&truth, &truth), Errors::default());
    }

    #[test]
    fn percents_have_two_digits() {
        let texts = [0.0, 0.000_001, 0.000_012_3, 0.000_123, 0.004_56, 0.078_9, 0.123, 4.0].map(percent);
        assert_eq!(texts, ["0 %", "1e-4 %", "0.0012 %", "0.012 %", "0.46 %", "7.9 %", "12 %", "400 %"]);
    }
}
