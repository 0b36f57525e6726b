//! The pictures of a subject as one canvas: alone, or as the strip exact | chosen | difference | no rotation with the
//! figures under it.

use crate::canvas::{BRIGHT, Canvas, GROUND, MUTED, Text, difference, false_colour, shown};
use crate::figures::{Figures, Inputs, Picture, drawn, percent, pixel_errors};
use crate::gpu::{Gpu, Stage};
use crate::subject::Subject;
use crate::tone;
use indicatif::ProgressBar;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_picture::method::Method;

/// Between tiles and around them.
const GAP: usize = 12;
/// The room for a tile's title.
const TITLE: usize = 34;
/// The height of a line of text.
const LINE: usize = 24;
/// How many lines stand under a tile.
const LINES: usize = 3;

/// Draws a subject by its method.
///
/// # Errors
///
/// If the shader is too long or the device fails.
pub fn single(
    gpu: &Gpu,
    subject: &Subject,
    samples: usize,
    bar: &ProgressBar,
) -> Result<(Canvas, Figures), Diagnostic> {
    bar.set_length(2);
    let stage = stage(gpu, subject, samples, bar)?;
    let inputs = Inputs::new(subject, subject.order);
    let (frame, picture) = drawn(&stage, &inputs, subject.method, None, true)?;
    bar.inc(1);
    let exposure = tone::exposure(&frame, subject.exposure);
    let canvas = shown(&frame, samples, exposure, &subject.camera, &subject.map);
    Ok((canvas, figures(gpu, subject, samples, vec![picture])))
}

fn stage<'a>(gpu: &'a Gpu, subject: &'a Subject, samples: usize, bar: &ProgressBar) -> Result<Stage<'a>, Diagnostic> {
    bar.set_message("uploading");
    let stage = Stage::new(gpu, subject, subject.size.map(|side| side * samples))?;
    bar.inc(1);
    bar.set_message(subject.method.name());
    Ok(stage)
}

fn figures(gpu: &Gpu, subject: &Subject, samples: usize, pictures: Vec<Picture>) -> Figures {
    Figures {
        scene: subject.name.clone(),
        adapter: gpu.name.clone(),
        size: subject.size,
        samples,
        order: subject.order,
        brdf: subject.brdf.to_string(),
        pictures,
    }
}

/// Draws a subject exactly, by its method and without the rotation, and what its method misses in false colours.
///
/// # Errors
///
/// If a shader is too long or the device fails.
pub fn compared(
    gpu: &Gpu,
    subject: &Subject,
    samples: usize,
    bar: &ProgressBar,
) -> Result<(Canvas, Figures), Diagnostic> {
    bar.set_length(4);
    let stage = stage(gpu, subject, samples, bar)?;
    let inputs = Inputs::new(subject, subject.order);
    let draw = |method: Method, exact: Option<&_>| {
        bar.set_message(method.name());
        let result = drawn(&stage, &inputs, method, exact, true);
        bar.inc(1);
        result
    };
    let (exact, of_exact) = draw(Method::Exact, None)?;
    let (chosen, of_chosen) = draw(subject.method, Some(&exact))?;
    let (none, of_none) = draw(Method::None, Some(&exact))?;
    bar.set_message("composing");
    let exposure = tone::exposure(&exact, subject.exposure);
    let shown = |frame| shown(frame, samples, exposure, &subject.camera, &subject.map);
    let errors = pixel_errors(&chosen, &exact);
    let scale = scale_of(&errors);
    let tiles = [
        ("exact".to_owned(), shown(&exact)),
        (format!("zonal: {}", subject.method), shown(&chosen)),
        ("difference".to_owned(), difference(&errors, exact.size, samples, scale)),
        ("no rotation".to_owned(), shown(&none)),
    ];
    let [width, height] = subject.size;
    let full = [4 * (width + GAP) + GAP, GAP + TITLE + height + GAP / 2 + LINES * LINE + GAP];
    let mut canvas = Canvas::new(full, GROUND);
    let lefts: [usize; 4] = std::array::from_fn(|i| GAP + i * (width + GAP));
    let below = |line: usize| GAP + TITLE + height + GAP / 2 + line * LINE;
    for (left, (title, tile)) in lefts.into_iter().zip(&tiles) {
        canvas.write([left, GAP - 2], cut(title, Text::Title, width), Text::Title, BRIGHT);
        canvas.put([left, GAP + TITLE], tile);
    }
    for (i, picture) in [(0, &of_exact), (1, &of_chosen), (3, &of_none)] {
        for (line, (text, colour)) in lines(picture).iter().enumerate() {
            canvas.write([lefts[i], below(line)], cut(text, Text::Line, width), Text::Line, *colour);
        }
    }
    legend(&mut canvas, [lefts[2], below(0)], width, scale, subject.method);
    Ok((canvas, figures(gpu, subject, samples, vec![of_exact, of_chosen, of_none])))
}

/// As much of a text of ASCII as a tile is wide.
fn cut(text: &str, weight: Text, width: usize) -> &str {
    text.get(..width / weight.width()).unwrap_or(text)
}

/// What stands under a picture.
fn lines(picture: &Picture) -> [(String, [u8; 3]); LINES] {
    let kernel = match &picture.spec {
        Some(spec) => format!("{spec}: {} operations", picture.operations),
        None => "simplified normal mapping".to_owned(),
    };
    let errors = match picture.method {
        Method::Exact => "what the others are measured by".to_owned(),
        _ => format!("error: mean {}, worst {}", percent(picture.errors.mean), percent(picture.errors.worst)),
    };
    [(kernel, BRIGHT), (errors, BRIGHT), (format!("{:.0} ms a frame", picture.milliseconds), MUTED)]
}

/// The bar of the false colours and its two ends.
fn legend(canvas: &mut Canvas, [left, top]: [usize; 2], width: usize, scale: f64, method: Method) {
    let mut bar = Canvas::new([width, LINE - 6], GROUND);
    for (i, pixel) in bar.pixels.iter_mut().enumerate() {
        *pixel = false_colour((i % width) as f64 / (width - 1).max(1) as f64);
    }
    canvas.put([left, top + 3], &bar);
    let end = percent(scale);
    let right = (left + width).saturating_sub(end.len() * Text::Line.width());
    canvas.write([left, top + LINE], "0", Text::Line, BRIGHT);
    canvas.write([right, top + LINE], &end, Text::Line, BRIGHT);
    let what = format!("{method} - exact, of the mean radiance");
    canvas.write([left, top + 2 * LINE], cut(&what, Text::Line, width), Text::Line, MUTED);
}

/// The end of the false colours: all but one in a hundred errors lie below it; 1, 2 or 5 times a power of ten.
fn scale_of(errors: &[Option<f64>]) -> f64 {
    let mut errors: Vec<f64> = errors.iter().flatten().copied().collect();
    errors.sort_by(f64::total_cmp);
    let high = errors.get((errors.len() * 99 / 100).saturating_sub(1)).copied().unwrap_or(0.0).max(1e-6);
    let power = 10f64.powf(high.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|digit| digit * power).find(|&end| end >= high).unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_end_at_round_numbers_above_nearly_all_errors() {
        let of = |high: f64| scale_of(&[Some(0.0), Some(high), Some(high), None]);
        for (high, end) in [(0.013, 0.02), (0.02, 0.02), (0.3, 0.5), (0.7, 1.0), (0.0, 1e-6)] {
            assert!((of(high) / end - 1.0).abs() < 1e-9, "{high}: {}", of(high));
        }
    }
}
