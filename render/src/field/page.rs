//! `docs/HEIGHT_FIELD.md` and its pictures: light turned into the frame of every point of a height field by each kernel, and not
//! turned at all.

use crate::canvas::{BRIGHT, Canvas, GROUND, MUTED, Text, over_ground};
use crate::compute::run;
use crate::field::ground::Ground;
use crate::field::shader::{Inputs, text};
use crate::field::tables::{Cube, ERROR};
use crate::field::transfer::{Kept, Transfer, bake};
use crate::field::ways::{Shader, Turn, WAYS, Way};
use crate::figures::{Errors, percent, pixel_errors};
use crate::frame::Frame;
use crate::gpu::Gpu;
use crate::tone;
use rayon::prelude::*;
use std::fmt::Write;
use zonal_codegen::environment::Map;
use zonal_codegen::fault::Fault;
use zonal_codegen::ir::eval::Number;
use zonal_codegen::reflectance::brdf::Brdf;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_picture::vector::unit;

/// The bands, as the paper has them.
pub const ORDER: usize = 9;
/// The points along a side, as the paper has them.
pub const SIDE: usize = 256;
/// Where hills are.
const SEED: u64 = 7;
/// What the ground reflects.
const BRDF: Brdf = Brdf::Phong { exponent: 8.0 };
/// Where the view is from: far above, and a little aside.
const VIEW: [f64; 3] = [0.4, -0.3, 0.85];
/// How many points along a side lie between two at which errors are measured.
const STEP: usize = 11;
/// Between which angles normals are told apart, in degrees.
const LEANS: [f64; 6] = [0.0, 5.0, 10.0, 15.0, 25.0, 90.0];
/// What begins the part of the page that hangs on the machine.
pub const TIMES: &str = "<!-- What follows is of one machine: no test reads it. -->";

/// What is known of a way.
#[derive(Clone, Debug)]
pub struct Row {
    /// The way.
    pub way: Way,
    /// Its operations a point, and the special ones.
    pub operations: [usize; 2],
    /// In f32 against f64 without a turn, in shares of the mean radiance; from tables where it reads them.
    pub errors: Errors,
    /// In f64, nothing read from tables.
    pub exact: Errors,
}

/// What is known of all ways.
pub struct Report {
    /// The map's name.
    pub map: String,
    /// The ways.
    pub rows: Vec<Row>,
    /// What the cubes of all bands take.
    pub tables: usize,
    /// By how far normals lean: the largest angle in degrees, the share of the points, and what `tilt` errs by there in the root
    /// mean square.
    pub leans: Vec<[f64; 3]>,
    /// What is lost if transfer is taken to be symmetric to the plane of view and normal, or the same all around the normal.
    pub kept: [Errors; 2],
}

/// A height field under a map.
pub struct Subject {
    map: String,
    ground: Ground,
    light: Vec<[f64; 3]>,
    tables: Vec<Cube>,
}

fn frame(side: usize, pixels: impl IntoIterator<Item = [f64; 3]>) -> Frame {
    Frame { size: [side, side], pixels: pixels.into_iter().map(Some).collect(), milliseconds: 0.0 }
}

fn view() -> [f64; 3] {
    unit(VIEW).unwrap_or(VIEW)
}

impl Subject {
    /// Returns the field under a map.
    pub fn new(name: &str, map: &Map) -> Self {
        let light = map.project(ORDER).coefficients;
        let tables = (0..ORDER).map(|l| Cube::new(&light, l)).collect();
        Self { map: name.to_owned(), ground: Ground::new(SEED, SIDE), light, tables }
    }

    fn shaded<T: Number>(
        &self,
        way: Way,
        tables: Option<&[Cube]>,
        points: &[usize],
        transfer: &[Transfer],
    ) -> Result<Frame, Fault> {
        let shader = Shader::<T>::new(way, &self.light, tables)?;
        let one = |(&point, transfer): (&usize, &Transfer)| shader.shade(self.ground.normal(point), transfer);
        let found: Vec<[f64; 3]> = points.par_iter().zip(transfer).map(one).collect();
        Ok(frame(points.len().isqrt(), found))
    }

    /// Measures each way at some of the points, by the interpreter.
    ///
    /// # Errors
    ///
    /// If a kernel is not known.
    pub fn measure(&self) -> Result<Report, Fault> {
        let along = || (STEP / 2..SIDE).step_by(STEP);
        let points: Vec<usize> = along().flat_map(|y| along().map(move |x| y * SIDE + x)).collect();
        let transfer = bake(&self.ground, &points, &BRDF, view(), ORDER);
        let [.., object] = WAYS;
        let truth = self.shaded::<f64>(object, None, &points, &transfer)?;
        let row = |way: Way| {
            let tables = (way.turn == Turn::Samples).then_some(&self.tables[..]);
            Ok(Row {
                way,
                operations: way.operations(ORDER)?,
                errors: Errors::of(&self.shaded::<f32>(way, tables, &points, &transfer)?, &truth),
                exact: Errors::of(&self.shaded::<f64>(way, None, &points, &transfer)?, &truth),
            })
        };
        let kept = |kept: Kept| {
            let [rotate, ..] = WAYS;
            let part: Vec<Transfer> =
                transfer.iter().map(|of| Transfer { local: of.kept(kept), ..of.clone() }).collect();
            Ok::<Errors, Fault>(Errors::of(&self.shaded::<f64>(rotate, None, &points, &part)?, &truth))
        };
        let turned = WAYS.into_iter().find(|way| !way.is_exact()).unwrap_or(object);
        let errors = pixel_errors(&self.shaded::<f64>(turned, None, &points, &transfer)?, &truth);
        let lean = |from: f64, to: f64| {
            let within = |point: usize| (from..to).contains(&self.ground.normal(point)[2].acos().to_degrees());
            let all = points.iter().zip(&errors).filter(|(point, _)| within(**point));
            let found: Vec<f64> = all.filter_map(|(_, error)| *error).collect();
            let count = found.len().max(1) as f64;
            [to, found.len() as f64 / points.len() as f64, (found.iter().map(|x| x * x).sum::<f64>() / count).sqrt()]
        };
        Ok(Report {
            map: self.map.clone(),
            leans: LEANS.windows(2).map(|pair| lean(pair[0], pair[1])).collect(),
            rows: WAYS.into_iter().map(row).collect::<Result<_, Fault>>()?,
            tables: self.tables.iter().map(Cube::bytes).sum(),
            kept: [kept(Kept::Symmetric)?, kept(Kept::Isotropic)?],
        })
    }

    /// Draws all points by each way on an adapter, and says how long that takes: the pictures beside each other, and the end of
    /// the page.
    ///
    /// # Errors
    ///
    /// If a shader is too long or the device fails.
    pub fn draw(&self, gpu: &Gpu) -> Result<(Canvas, String), Diagnostic> {
        let points: Vec<usize> = (0..SIDE * SIDE).collect();
        let transfer = bake(&self.ground, &points, &BRDF, view(), ORDER);
        let narrow = |of: fn(&Transfer) -> &Vec<f64>| -> Vec<f32> {
            (0..ORDER * ORDER).flat_map(|i| transfer.iter().map(move |transfer| of(transfer)[i] as f32)).collect()
        };
        let wide = |[a, b, c]: [f64; 3]| [a as f32, b as f32, c as f32, 0.0];
        let normals: Vec<[f32; 4]> = points.iter().map(|&point| wide(self.ground.normal(point))).collect();
        let light: Vec<[f32; 4]> = self.light.iter().map(|&e| wide(e)).collect();
        let [local, object] = [narrow(|transfer| &transfer.local), narrow(|transfer| &transfer.object)];
        let mut found = Vec::new();
        for way in WAYS {
            let transfer = if way.turn == Turn::None { &object } else { &local };
            let inputs = Inputs { transfer, light: &light, normals: &normals, cubes: &self.tables };
            let ran = run(gpu, way, ORDER, &text(way, ORDER)?, &inputs)?;
            let pixels = ran.result.iter().map(|p| [p[0], p[1], p[2]].map(f64::from));
            found.push(Frame { milliseconds: ran.milliseconds, ..frame(SIDE, pixels) });
        }
        let mut text = format!(
            "\n{TIMES}\n\n## On an adapter\n\n\
             All {SIDE} by {SIDE} points in one compute shader a way on {}, medians of nine runs, waiting included. Errors against \
             the last row, in shares of the mean radiance: shaders contract and order sums as they like.\n\n\
             | way | a frame | frames a second | worst error | rms |\n|---|---|---|---|---|\n",
            gpu.name
        );
        let last = found.len() - 1;
        for (way, frame) in WAYS.iter().zip(&found) {
            let errors = Errors::of(frame, &found[last]);
            let _ = writeln!(
                text,
                "| {} | {:.1} ms | {:.0} | {} | {} |",
                way.name,
                frame.milliseconds,
                1e3 / frame.milliseconds,
                percent(errors.worst),
                percent(errors.rms)
            );
        }
        Ok((strip(&found), text))
    }
}

fn strip(frames: &[Frame]) -> Canvas {
    const GAP: usize = 12;
    const LINE: usize = 28;
    let mut canvas = Canvas::new([frames.len() * (SIDE + GAP) + GAP, SIDE + LINE + 2 * GAP], GROUND);
    let exposure = tone::exposure(&frames[frames.len() - 1], 0.0);
    for (i, (way, frame)) in WAYS.iter().zip(frames).enumerate() {
        let left = GAP + i * (SIDE + GAP);
        let colour = if way.turn == Turn::None { BRIGHT } else { MUTED };
        canvas.write([left, GAP - 4], way.name, Text::Title, colour);
        canvas.put([left, GAP + LINE], &over_ground(frame, 1, exposure));
    }
    canvas
}

impl Report {
    /// The page, without its times.
    pub fn markdown(&self) -> String {
        let count = ORDER * ORDER;
        let few = (STEP / 2..SIDE).step_by(STEP).count();
        let (symmetric, isotropic) = (4 * ORDER * (ORDER + 1) / 2, 4 * ORDER);
        let mut text = format!(
            "# Light turned into every frame, measured\n\n\
             <!-- Generated: UPDATE=1 cargo test -p zonal-render --test it height_field -->\n\n\
             ![A height field by four kernels and without a turn](height_field.png)\n\n\
             After section 7.3 of Nowrouzezahrai et al. (2012): a height field of {SIDE} by {SIDE} points, seed {SEED}, seen from \
             above, under `{}`, of which {ORDER} bands are taken. Each point has its transfer, visibility times the cosine times \
             `{BRDF}` for the view, as {count} coefficients in its own frame; the light is turned there at every point, by the \
             rotation from a quaternion, by zonal factorisation (`zhf`), by the same tailored to the signal (`zhf_tailored`) and \
             by `tilt`, which takes the normal alone and is for small angles, and is multiplied with it. *object* has the same transfer in the axes of the \
             object, and turns nothing. Operations are of a point in R, G and B, the inner product included, what makes a \
             quaternion or a matrix of the normal not. `zhf_tailored` reads its samples from a cubemap a band, whose side keeps a \
             linear read within {} of the band's largest value; they are made for this page on the CPU.\n\n\
             Errors are of the interpreter in f32 against f64 without a turn, at {few} by {few} of the points, in shares of the mean \
             radiance; of f64 with nothing read from tables in the last column.\n\n\
             | way | kernel | operations | special | reads | bytes a point | tables, bytes | worst error | rms | in f64 |\n\
             |---|---|---|---|---|---|---|---|---|---|\n",
            self.map,
            percent(ERROR),
        );
        for Row { way, operations: [total, special], errors, exact } in &self.rows {
            let kernel = way.text(ORDER).map_or_else(|| "none".to_owned(), |spec| format!("`{spec}`"));
            let (reads, tables) = match way.turn {
                Turn::Samples => (count.to_string(), self.tables.to_string()),
                _ => ("–".to_owned(), "–".to_owned()),
            };
            // What rounds is told by a bound: it hangs on the last bits of every sum.
            let f32s = if errors.worst < 1e-5 {
                ["below 1e-5"; 2].map(str::to_owned)
            } else {
                [errors.worst, errors.rms].map(percent)
            };
            let f64s = if exact.worst < 1e-12 { "below 1e-12".to_owned() } else { percent(exact.worst) };
            let [worst, rms] = f32s;
            let _ = writeln!(
                text,
                "| {} | {kernel} | {total} | {special} | {reads} | {} | {tables} | {worst} | {rms} | {f64s} |",
                way.name,
                4 * count
            );
        }
        text.push_str(
            "\n`tilt` by how far normals lean:\n\n| to, degrees | share of the points | rms |\n|---|---|---|\n",
        );
        for [to, share, error] in &self.leans {
            let _ = writeln!(text, "| {to} | {} | {} |", percent(*share), percent(*error));
        }
        let [part, isotropic_cost] = self.kept.map(|errors| percent(errors.rms));
        let object = self.rows.last().map_or(0, |row| row.operations[0]);
        let exact =
            self.rows.iter().filter(|row| row.way.is_exact() && !matches!(row.way.turn, Turn::Samples | Turn::None));
        let least = exact.map(|row| row.operations[0]).min().unwrap_or_default();
        let _ = write!(
            text,
            "\n## Why turn at all\n\n\
             Without a turn a point takes {object} operations, with the cheapest kernel that is exact and reads nothing {least}: what the turn must buy is memory. In the \
             axes of the object transfer has {} bytes of f32 a point, whatever it is. In the frame of the point it has fewer where it \
             is symmetric: {symmetric} if it is the same on both sides of the plane of normal and view, as every isotropic \
             reflectance is, {isotropic} if it is the same all around the normal, as Lambert's is. So for reflectances without \
             visibility that all points share one table serves, by the view. This transfer has visibility, which is neither: what \
             is not symmetric left out costs {part} of the mean radiance in the root mean square, what is not isotropic {isotropic_cost}.\n",
            4 * count
        );
        text
    }
}
