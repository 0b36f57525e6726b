//! `docs/REFLECTIONS.md` and its picture: a mirror with a relief under three maps, by one sample a pixel, by a round and by a
//! long Gaussian, and by 16 by 16 samples.

use crate::canvas::{BRIGHT, Canvas, GROUND, MUTED, Text};
use crate::figures::{Errors, percent};
use crate::frame::Frame;
use crate::mirror::ball::{Ball, DEVIATION, Pixel, RAYS};
use crate::mirror::light::Banded;
use crate::tone;
use indicatif::ProgressBar;
use rayon::prelude::*;
use std::fmt::Write;
use zonal_codegen::environment::Map;
use zonal_codegen::families::Spec;
use zonal_codegen::ir::eval::{Contraction, Program};
use zonal_codegen::ir::listing::Listing;
use zonal_picture::mirror::{Attenuation, Slices, places};

/// The orders that are drawn.
pub const ORDERS: [usize; 3] = [16, 32, 64];
/// The maps.
pub const MAPS: [&str; 3] = ["courtyard", "forest", "sunset"];
/// The relief.
pub const NORMALS: &str = "0015";
/// The pixels along a side of a picture.
pub const SIDE: usize = 144;
/// The order at which the long Gaussian goes through a kernel too.
pub const BY_KERNEL: usize = 8;
/// Rings and spokes of the places by which a long Gaussian is summed.
const PLACES: [usize; 2] = [12, 24];
/// Gaussians beyond these deviations are taken for them.
const DEVIATIONS: [f64; 2] = [1e-3, 1.0];

/// The ways to find a pixel's light of some bands.
pub const WAYS: [&str; 3] = ["one sample", "option 3", "option 1"];

/// How many times the mean of the map the brightest texels are left.
const BRIGHTEST: f64 = 4.0;

/// Returns a map whose brightest texels are cut: bands ring around a lamp as high as it is, and nothing else would be seen.
pub fn cut(mut map: Map) -> Map {
    let (mut sum, mut whole) = (0.0, 0.0);
    for (i, texel) in map.texels.iter().enumerate() {
        let solid_angle = map.solid_angle(i % map.width, i / map.width);
        sum += solid_angle * texel.iter().sum::<f64>() / 3.0;
        whole += solid_angle;
    }
    let most = BRIGHTEST * sum / whole;
    for texel in &mut map.texels {
        let high = texel.iter().copied().fold(0.0, f64::max);
        if high > most {
            texel.iter_mut().for_each(|v| *v *= most / high);
        }
    }
    map
}

/// What one order comes to under one map.
#[derive(Clone, Debug)]
pub struct Row {
    /// The number of bands.
    pub order: usize,
    /// Each of [`WAYS`] against many samples of the same bands.
    pub own: [Errors; 3],
    /// Each of them, then many samples, against many samples of the map itself.
    pub map: [Errors; 4],
}

/// What one map comes to.
pub struct Case {
    /// The map's name.
    pub map: String,
    /// By order.
    pub rows: Vec<Row>,
    /// One sample of the map itself against many.
    pub one: Errors,
    /// By how much the long Gaussian through a table of slices and a kernel differs from its sum over places, at [`BY_KERNEL`].
    pub kernel: Errors,
    /// The pictures of the last order: the ways, many samples of the bands, then one and many of the map.
    frames: Vec<Frame>,
}

fn frame(pixels: &[Option<Pixel>], size: usize, of: impl Fn(&Pixel) -> [f64; 3] + Sync) -> Frame {
    let radiance = |pixel: &Option<Pixel>| pixel.as_ref().map(&of);
    Frame { size: [size; 2], pixels: pixels.par_iter().map(radiance).collect(), milliseconds: 0.0 }
}

/// The mean over a pixel's many rays.
fn many(pixel: &Pixel, read: impl Fn([f32; 3]) -> [f64; 3]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (direction, weight) in &pixel.rays {
        let value = read(*direction);
        (0..3).for_each(|k| sum[k] += f64::from(*weight) * value[k]);
    }
    sum
}

/// The pixels of the ball by a long Gaussian: a sum over places of the table of the bands.
fn long(pixels: &[Option<Pixel>], size: usize, banded: &Banded) -> Frame {
    let places = places(PLACES[0], PLACES[1]);
    frame(pixels, size, |pixel| {
        let spread = pixel.footprint.spread(DEVIATION * DEVIATION, DEVIATIONS);
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for direction in places.iter().filter_map(|place| spread.direction(*place)) {
            let value = banded.read(direction.map(|x| x as f32));
            (0..3).for_each(|k| sum[k] += f64::from(value[k]));
            count += 1.0;
        }
        sum.map(|v| v / count)
    })
}

/// The pixels by a long Gaussian through a table of its slices and `shade:n`.
fn through_kernel(pixels: &[Option<Pixel>], size: usize, banded: &Banded) -> Frame {
    let order = banded.light.order;
    let slices = Slices::new(order, [2e-2 / order as f64, DEVIATIONS[1]]);
    let spec: Spec = format!("shade:{order}").parse().unwrap_or_else(|error| panic!("{error}"));
    let kernel = Program::<f64>::new(&Listing::new(&spec.kernel()));
    let light: [Vec<f64>; 3] = [0, 1, 2].map(|k| banded.light.coefficients.iter().map(|c| c[k]).collect());
    frame(pixels, size, |pixel| {
        let spread = pixel.footprint.spread(DEVIATION * DEVIATION, DEVIATIONS);
        let (slice, q) = (slices.at(spread.deviations), spread.to_local());
        light.each_ref().map(|e| kernel.run(&[&q, e, &slice], Contraction::Separate)[0])
    })
}

/// Draws the ball under a map at some orders.
pub fn case(name: &str, map: &Map, pixels: &[Option<Pixel>], orders: &[usize], bar: &ProgressBar) -> Case {
    let size = pixels.len().isqrt();
    let narrow = |direction: [f32; 3]| map.radiance(direction.map(f64::from));
    let one = frame(pixels, size, |pixel| map.radiance(pixel.footprint.direction));
    let truth = frame(pixels, size, |pixel| many(pixel, narrow));
    let mut case = Case {
        map: name.to_owned(),
        rows: Vec::new(),
        one: Errors::of(&one, &truth),
        kernel: Errors::default(),
        frames: Vec::new(),
    };
    let few = Banded::new(map.project(BY_KERNEL));
    case.kernel = Errors::of(&through_kernel(pixels, size, &few), &long(pixels, size, &few));
    bar.inc(1);
    for &order in orders {
        bar.set_message(format!("{name}, order {order}"));
        let banded = Banded::new(map.project(order));
        let flat = vec![1.0; order];
        let attenuation = Attenuation::new(order);
        let ways = [
            frame(pixels, size, |pixel| banded.blurred(pixel.footprint.direction, &flat)),
            frame(pixels, size, |pixel| {
                let kappa = pixel.footprint.sharpness(DEVIATION * DEVIATION);
                banded.blurred(pixel.footprint.direction, &attenuation.factors(kappa))
            }),
            long(pixels, size, &banded),
        ];
        let all = frame(pixels, size, |pixel| many(pixel, |direction| banded.read(direction).map(f64::from)));
        let own = ways.each_ref().map(|way| Errors::of(way, &all));
        let [a, b, c] = ways.each_ref().map(|way| Errors::of(way, &truth));
        case.rows.push(Row { order, own, map: [a, b, c, Errors::of(&all, &truth)] });
        case.frames = ways.into_iter().chain([all]).collect();
        bar.inc(1);
    }
    case.frames.extend([one, truth]);
    case
}

/// All that is measured.
pub struct Report {
    /// By map.
    pub cases: Vec<Case>,
    /// How many pixels show the ball.
    pub shown: usize,
    /// The sharpness that half of the pixels are below, and that nine of ten are above.
    pub sharpness: [f64; 2],
}

impl Report {
    /// Draws the ball under maps.
    pub fn measure(ball: &Ball, maps: &[(&str, Map)], size: usize, orders: &[usize], bar: &ProgressBar) -> Self {
        bar.set_length((maps.len() * (orders.len() + 1)) as u64);
        let pixels = ball.pixels(size);
        let mut all: Vec<f64> =
            pixels.iter().flatten().map(|pixel| pixel.footprint.sharpness(DEVIATION * DEVIATION)).collect();
        all.sort_by(f64::total_cmp);
        let at = |share: f64| all.get((share * all.len() as f64) as usize).copied().unwrap_or_default();
        let cases = maps.iter().map(|(name, map)| case(name, map, &pixels, orders, bar)).collect();
        Self { cases, shown: all.len(), sharpness: [at(0.5), at(0.1)] }
    }

    /// The pictures of the last order, a row a map.
    pub fn canvas(&self) -> Canvas {
        const GAP: usize = 12;
        const TITLE: usize = 34;
        const LINE: usize = 24;
        let order = self.cases.first().and_then(|case| case.rows.last()).map_or(0, |row| row.order);
        let titles = ["one sample", "option 3", "option 1", "16 x 16", "map: one", "map: 16 x 16"];
        let side = self.cases.first().map_or(1, |case| case.frames[0].size[0]);
        let columns = titles.len();
        let height = GAP + TITLE + self.cases.len() * (side + LINE + GAP);
        let mut canvas = Canvas::new([columns * (side + GAP) + GAP, height], GROUND);
        for (column, title) in titles.iter().enumerate() {
            canvas.write([GAP + column * (side + GAP), GAP - 2], title, Text::Title, BRIGHT);
        }
        for (line, case) in self.cases.iter().enumerate() {
            let top = GAP + TITLE + line * (side + LINE + GAP);
            let exposure = tone::exposure(&case.frames[5], 0.5);
            let Some(row) = case.rows.last() else { continue };
            let errors = [row.map[0], row.map[1], row.map[2], row.map[3], case.one];
            for (column, frame) in case.frames.iter().enumerate() {
                let left = GAP + column * (side + GAP);
                canvas.put([left, top], &shown(frame, exposure));
                let text = match errors.get(column) {
                    Some(errors) => format!("rms {}", percent(errors.rms)),
                    None => format!("{}, {order}", case.map),
                };
                canvas.write([left, top + side + 2], &text, Text::Line, MUTED);
            }
        }
        canvas
    }

    /// The page.
    pub fn markdown(&self) -> String {
        let [half, tenth] = self.sharpness.map(|kappa| kappa.sqrt().recip().to_degrees());
        let mut text = format!(
            "# Antialiased reflections, measured\n\n\
             <!-- @generated by zonal: cargo render page reflections -->\n\n\
             ![A mirror with a relief under three maps: one sample, a round Gaussian, a long one, 16 by 16 samples; of 64 bands, and of the map itself](reflections.png)\n\n\
             A ball with the relief `normals/{NORMALS}.webp` as a mirror, {side} by {side} pixels, of which {} show it, under three maps: \
             Figure 6 of Soler et al. 2015. The pixel's filter is a Gaussian of a deviation of {DEVIATION} pixels; *{RAYS} by {RAYS} \
             samples* stand {RAYS} by {RAYS} over three deviations to each side, each with its own ray, normal and weight. From one \
             sample's derivatives of the normal, differences in squares of two by two pixels as shaders have them, come κ of a round \
             Gaussian about the mirrored direction (*option 3*, equation 29: bands times i_l(κ) / i_0(κ)) and a long one of the \
             covariance σ² D Dᵀ (*option 1*: here its light is summed over {} places of a table of the bands). Half of the pixels have a \
             Gaussian wider than {half:.1} degrees, one in ten one wider than {tenth:.1}. Errors are root mean squares over the ball, as shares \
             of its mean radiance. In the picture they are against many samples of the map itself. The maps' brightest texels are brought down to \
             {BRIGHTEST} times the mean: bands ring around a lamp by as much as it is bright, and nothing else would be seen.\n\n",
            self.shown,
            PLACES[0] * PLACES[1],
            side = self.cases.first().map_or(0, |case| case.frames[0].size[0]),
        );
        text.push_str(
            "## Against 16 by 16 samples of the same bands\n\n\
             | map | order | one sample | option 3 | option 1 | option 3 better by | option 1 by |\n|---|---|---|---|---|---|---|\n",
        );
        for case in &self.cases {
            for row in &case.rows {
                let [one, three, long] = row.own.map(|errors| errors.rms);
                let _ = writeln!(
                    text,
                    "| {} | {} | {} | {} | {} | {:.2}× | {:.2}× |",
                    case.map,
                    row.order,
                    percent(one),
                    percent(three),
                    percent(long),
                    one / three,
                    one / long
                );
            }
        }
        let kernel = self.cases.iter().map(|case| case.kernel.rms).fold(0.0, f64::max);
        let _ = write!(
            text,
            "\nThrough a table of {side} by {side} slices over the two deviations and `shade:{BY_KERNEL}` option 1 gives what the sum over \
             places does to {} at most.\n\n\
             ## Against 16 by 16 samples of the map itself\n\n\
             What the order leaves out is in these, but for the last column.\n\n\
             | map | order | one sample | option 3 | option 1 | 16 by 16 samples | the map, one sample |\n|---|---|---|---|---|---|---|\n",
            percent(kernel),
            side = Slices::SIDE,
        );
        for case in &self.cases {
            for row in &case.rows {
                let errors: Vec<String> = row.map.iter().map(|errors| percent(errors.rms)).collect();
                let _ = writeln!(
                    text,
                    "| {} | {} | {} | {} |",
                    case.map,
                    row.order,
                    errors.join(" | "),
                    percent(case.one.rms)
                );
            }
        }
        text + &costs_text()
    }
}

/// Returns what the page says of operations.
pub fn costs_text() -> String {
    let mut text = format!(
        "\n## What they take\n\n\
         Operations for R, G and B. *One sample* is `eval`, beyond 16 bands what its operations grow by, a polynomial through the \
         orders 10 to 16. *Option 3* is `eval` with a factor a band, n (n + 1) / 2 more, the coefficients of `gaussian`, their quotients \
         and {SHARPNESS} for κ. By tables of bands (`zonal bands`) it takes n reads and 3 n operations besides `gaussian`. *Option 1* is \
         `shade`, which grows about as n³, with four entries of the table of slices looked up, n² reads of four numbers each. *Many \
         samples* are {} times one.\n\n\
         | order | one sample | option 3 | reads by tables | option 1 | its reads | 16 by 16 samples | of the map: reads |\n\
         |---|---|---|---|---|---|---|---|\n",
        RAYS * RAYS
    );
    let evals = evals();
    for order in [BY_KERNEL, ORDERS[0], ORDERS[1], ORDERS[2]] {
        let eval = grown(&evals, order);
        let three = eval + order * (order + 1) / 2 + Attenuation::operations(order) + order + SHARPNESS;
        // Kernels of many bands take long to be made, and are too long for shaders.
        let one = if order == BY_KERNEL { operations("shade", order).to_string() } else { "–".to_owned() };
        let _ = writeln!(
            text,
            "| {order} | {eval} | {three} | {order} | {one} | {} | {} | {} |",
            order * order,
            RAYS * RAYS * eval,
            RAYS * RAYS
        );
    }
    text
}

/// The operations of κ: the cosine, for each of two slopes a product with the view, a sum of two vectors and a square, then
/// their sum and its quotient.
const SHARPNESS: usize = 5 + 2 * (5 + 6 + 5) + 3;

/// The operations of a family's kernel for three channels.
fn operations(family: &str, order: usize) -> usize {
    let spec: Spec = format!("{family}:{order}:rgb").parse().unwrap_or_else(|error| panic!("{error}"));
    spec.code().cost(3).total
}

/// Returns the operations of `eval` for three channels at the orders that others are told from.
pub fn evals() -> Vec<(usize, usize)> {
    [8, 10, 12, 14, 16].map(|order| (order, operations("eval", order))).to_vec()
}

/// Returns the operations of `eval` at an order: of the last four known ones the polynomial of the third degree.
pub fn grown(known: &[(usize, usize)], order: usize) -> usize {
    let nodes = &known[known.len().saturating_sub(4)..];
    if let Some((_, cost)) = known.iter().find(|(known, _)| *known == order) {
        return *cost;
    }
    let term = |&(i, cost): &(usize, usize)| {
        let others = nodes.iter().filter(|(j, _)| *j != i);
        others.fold(cost as f64, |product, (j, _)| product * (order as f64 - *j as f64) / (i as f64 - *j as f64))
    };
    nodes.iter().map(term).sum::<f64>().round() as usize
}

/// A frame as a screen shows it, over [`GROUND`].
fn shown(frame: &Frame, exposure: f64) -> Canvas {
    let mut canvas = Canvas::new(frame.size, GROUND);
    for (pixel, radiance) in canvas.pixels.iter_mut().zip(&frame.pixels) {
        if let Some(radiance) = radiance {
            *pixel = tone::mapped(radiance.map(|c| c * exposure)).map(tone::encoded);
        }
    }
    canvas
}
