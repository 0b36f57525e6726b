//! `docs/CACHE.md` and its pictures: what the radiance cache gains and errs by, measured.

use crate::basis::{Basis, HSH6, HSH10, SH6, SH10};
use crate::cache::Cache;
use crate::methods::Limit;
use crate::picture::{Square, strip};
use crate::record::Sampling;
use crate::scene::{OBJECTS, Scene, WALL};
use crate::study::{self, CAMERA, Equal, LIMITS, Plan, Setup, Step, Stop, Table, filled, squares, steps, table};
use crate::view::View;
use indicatif::ProgressBar;
use std::fmt::Write;
use zonal_codegen::fault::Fault;
use zonal_codegen::plan::text::percent;

/// How large everything is that is measured.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    /// The pixels along a side of a picture.
    pub side: usize,
    /// How many rays a record casts, of the objects.
    pub rays: usize,
    /// How many rays a record casts, of the wall.
    pub wall_rays: usize,
    /// How many rays a pixel brute force casts.
    pub truth: usize,
    /// Which rays.
    pub seed: u32,
}

/// What the page says.
pub const FULL: Size = Size { side: 144, rays: 1024, wall_rays: 4000, truth: 1024, seed: 1 };

/// The error a of the tables.
pub const ERROR: f64 = 0.3;
/// The error a of the wall.
const WALL_ERROR: f64 = 0.15;
/// How many times as many rays a pixel brute force casts for the wall, which is compared with fewer.
const TIMES: usize = 4;
/// Where the cameras of the wall stand, in degrees; the first is the paper's middle one.
const AZIMUTHS: [f64; 3] = [-90.0, -104.0, -76.0];

fn milliseconds(seconds: f64) -> String {
    let value = 1e3 * seconds;
    if value < 100.0 { format!("{value:.1} ms") } else { format!("{value:.0} ms") }
}

fn nanoseconds(seconds: f64) -> String {
    format!("{:.0} ns", 1e9 * seconds.max(0.0))
}

/// Returns a table as Markdown.
pub fn rows(table: &Table) -> String {
    let mut text = String::from(
        "| method | kernels | a frame | a rotation | rotations | done exactly | rms against exact | against brute force |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    let last = table.rows.len() - 1;
    for (i, row) in table.rows.iter().enumerate() {
        let kernels: Vec<String> = row
            .kernels
            .split(", ")
            .map(
                |kernel| {
                    if kernel.contains(' ') || kernel == "none" { kernel.to_owned() } else { format!("`{kernel}`") }
                },
            )
            .collect();
        let rotation = if i == 0 { "–".to_owned() } else { nanoseconds(row.rotation) };
        let share = match (i, row.is_adaptive) {
            (0, _) => "–".to_owned(),
            (_, true) => percent(row.count.any as f64 / row.count.all.max(1) as f64),
            _ => "all".to_owned(),
        };
        let against = if i == last { "–".to_owned() } else { percent(row.exact) };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {rotation} | {} | {share} | {against} | {} |",
            row.name,
            kernels.join(", "),
            milliseconds(row.seconds),
            row.count.all,
            percent(row.truth)
        );
    }
    text
}

fn steps_text(steps: &[Step]) -> String {
    let mut text = String::from("| a | records |");
    LIMITS.iter().for_each(|(name, _)| {
        let _ = write!(text, " {name}: angle | done exactly | a frame | rms |");
    });
    text += " all exact: a frame | against brute force |\n|---|---|";
    text += &"---|".repeat(4 * LIMITS.len() + 2);
    text.push('\n');
    for step in steps {
        let _ = write!(text, "| {} | {} |", step.error, step.records);
        for [angle, share, seconds, error] in &step.limits {
            let _ =
                write!(text, " {angle:.1}° | {} | {} | {} |", percent(*share), milliseconds(*seconds), percent(*error));
        }
        let _ = writeln!(text, " {} | {} |", milliseconds(step.seconds), percent(step.truth));
    }
    text
}

fn stops_text(stops: &[Stop]) -> String {
    let mut text = String::from(
        "| camera | records added | sampling them | a frame | rms against brute force | brute force of that error: rays a pixel | takes | times as long | at 850 by 850 |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for stop in stops {
        let Equal { rays, seconds, is_reached } = stop.equal;
        let more = if is_reached { "" } else { "> " };
        let _ = writeln!(
            text,
            "| {:+.0} degrees | {} | {:.2} s | {:.3} s | {} | {more}{rays:.0} | {more}{seconds:.2} s | {more}{:.2} | {more}{:.1} |",
            stop.azimuth + 90.0,
            stop.added,
            stop.filling,
            stop.seconds,
            percent(stop.truth),
            stop.times[0],
            stop.times[1]
        );
    }
    text
}

/// What the limits do as the error grows, beside what the paper says of them.
fn claim(steps: &[Step]) -> String {
    let range = |limit: usize| {
        let shares = steps.iter().map(|step| step.limits[limit][1]);
        let (least, most) = shares.fold((1.0f64, 0.0f64), |(a, b), x| (a.min(x), b.max(x)));
        format!("{} to {}", percent(least), percent(most))
    };
    let held = |step: &Step| milliseconds(step.limits[2][2]);
    let [first, last] = [&steps[0], &steps[steps.len() - 1]];
    let wide = steps.iter().find(|step| step.error == ERROR).unwrap_or(last);
    format!(
        "From a = {} to {} the share of exact rotations lies from {} with 1.25 a, from {} with the closed form: it stays as it is \
         while the error grows, as Křivánek et al. (2005, section 4.2) say, and here it is next to nothing, since the surfaces are \
         rounder than the r/R = 0.1 that the limit is made for, so that records stop to serve before they are turned so far. \
         Held, the share lies from {}, and the frame goes from {} with {} records to {} with {}. At a = {} a limit of {:.1} \
         degrees costs {} of error where one of {:.1} costs {}.",
        first.error,
        last.error,
        range(0),
        range(1),
        range(2),
        held(first),
        first.records,
        held(last),
        last.records,
        wide.error,
        wide.limits[1][0],
        percent(wide.limits[1][3]),
        wide.limits[2][0],
        percent(wide.limits[2][3])
    )
}

/// What is measured of the objects in a basis.
struct Part {
    table: Table,
    steps: Vec<Step>,
    squares: Vec<Square>,
    /// What is yellow in the picture of differences, of the mean.
    bright: f64,
    /// The error without the derivatives, by the exact method.
    still: f64,
}

fn part<const C: usize>(setup: &Setup, basis: Basis<C>, small: &str, bright: f64, bar: &ProgressBar) -> Part {
    bar.set_message(format!("{} of order {}", basis.name, basis.order));
    bar.set_position(0);
    bar.set_length((setup.view.glossy.len() * (1 + study::ERRORS.len())) as u64);
    let (cache, seconds) = filled(setup, basis, ERROR, &|| bar.inc(1));
    let table = table(setup, &cache, seconds);
    let squares = squares(setup, &cache, small, bright);
    let mut still = Cache::new(basis, ERROR);
    for record in &cache.records {
        let mut record = record.clone();
        record.slopes = [[[0.0; 3]; C]; 2];
        still.insert(record);
    }
    let still = study::table(setup, &still, 0.0).rows.last().map_or(f64::NAN, |row| row.truth);
    Part { table, steps: steps(setup, basis, small, &|| bar.inc(1)), squares, bright, still }
}

/// The page and its pictures, by their names.
pub type Files = Vec<(&'static str, Vec<u8>)>;

/// Returns the page and its pictures, measured.
///
/// # Errors
///
/// If the bunny cannot be read, or a picture is too large.
pub fn measured(size: &Size, bar: &ProgressBar) -> Result<Files, Fault> {
    let scene = Scene::objects()?;
    let view = View::new(&scene, &CAMERA, size.side);
    bar.set_message("brute force");
    bar.set_length(view.glossy.len() as u64);
    let truth = view.brute_force(&scene, size.truth, size.seed, || bar.inc(1)).radiance;
    let sampling = Sampling { rays: size.rays, seed: size.seed };
    let setup = Setup { scene: &scene, gloss: OBJECTS, view: &view, truth: &truth, sampling };
    let parts = [
        part(&setup, SH6, "LF3", 0.02, bar),
        part(&setup, HSH6, "LF3 on B", 0.05, bar),
        part(&setup, SH10, "LF3", 0.02, bar),
        part(&setup, HSH10, "equation 13", 0.05, bar),
    ];
    bar.set_message("three cameras");
    bar.set_position(0);
    let wall = Scene::wall();
    let plan = Plan {
        azimuths: &AZIMUTHS,
        side: size.side,
        error: WALL_ERROR,
        sampling: Sampling { rays: size.wall_rays, seed: size.seed },
        rays: TIMES * size.truth,
    };
    let tour = study::tour(&wall, WALL, HSH10, &plan, &|| bar.inc(1));
    let mut text = head(size, view.glossy.len());
    for (i, part) in parts.iter().enumerate() {
        text += &section(part, ["cache_sh6.png", "cache_hsh6.png"].get(i).copied());
    }
    text += &wall_section(size, &tour.stops, tour.doubled);
    Ok(vec![
        ("CACHE.md", text.into_bytes()),
        ("cache_sh6.png", strip(&parts[0].squares, size.side)?),
        ("cache_hsh6.png", strip(&parts[1].squares, size.side)?),
        ("cache_wall.png", strip(&tour.squares, size.side)?),
    ])
}

fn head(size: &Size, glossy: usize) -> String {
    let Size { side, rays, truth, seed, .. } = *size;
    let [rounded, closed] = [Limit::Rounded, Limit::Closed].map(|limit| limit.angle(0.3).to_degrees());
    format!(
        "# The radiance cache, measured\n\n\
         <!-- @generated by zonal: cargo run -p zonal-cache -- page -->\n\n\
         A box with a glossy sphere and a glossy bunny (Phong, exponent {exponent}), looked at by a camera of {side} by {side} \
         pixels, of which {glossy} show something glossy. Light bounces once. The light that arrives at few points is sampled by \
         {rays} rays a record, seed {seed}, and stored as harmonics with its derivatives in the tangent plane, which are exact \
         (Gautron et al. 2004 take differences); between them it is turned into the frame of the pixel and averaged (Gautron \
         et al. 2004, equations 23 and 24). The radius of a record is the harmonic mean of the distances to what it sees, or what \
         its light is over its derivative if that is less, between 0.05 and 1 of half the box: the noise of few rays makes it \
         smaller. Brute force takes {truth} rays a pixel, dealt as the lobe is high. Times are of the \
         processor of one machine, those of frames on one thread and the shortest of five; they change from run to run, all else \
         is the same on every run. Errors are \
         root mean squares over the glossy pixels, as shares of their mean radiance, without the lamp's own light.\n\n\
         *A frame* is the interpolation alone. *A rotation* is what the frame takes beyond that of *ignored*, over the number of \
         rotations (Křivánek et al. 2005, table 1). The methods for small angles serve below 1.25 a, the exact one above: *done \
         exactly* is that share. The limit is {rounded:.1} degrees at a = 0.3, {closed:.1} in closed form: beyond the 10 degrees \
         that LF3 on B is meant for, which is in its errors below. Where rotations are ignored, so is how the frames of two points \
         are twisted. *Ivanic and Ruedenberg* is the recursion that the report on stability has, which makes its factors and its room anew \
         each time: it is slower than it could be. The catalogue has shears of B \
         to order 6, and no rotation of more than ten bands for the first method at order 10.\n\n",
        exponent = OBJECTS.exponent,
    )
}

fn section(part: &Part, picture: Option<&str>) -> String {
    let Table { basis: (name, order), error, records, filling, .. } = &part.table;
    let of = if *name == "SH" { "Spherical" } else { "Hemispherical" };
    let mut text = format!("## {of} harmonics of order {order}\n\n");
    if let Some(picture) = picture {
        let _ = writeln!(
            text,
            "![Records, the picture from the cache, what the approximate rotation changes, brute force]({picture})\n\n\
             From the left: the records at a = {error}, the picture from them, its difference from that with the approximate \
             rotation (yellow at {} of the mean), brute force.\n",
            percent(part.bright)
        );
    }
    let _ = writeln!(text, "At a = {error}, {records} records, sampled in {filling:.1} s:\n\n{}", rows(&part.table));
    let exact = part.table.rows.last().map_or(f64::NAN, |row| row.truth);
    let _ = writeln!(
        text,
        "Without the derivatives the exact method errs by {} against brute force, with them by {}.\n",
        percent(part.still),
        percent(exact)
    );
    let rotation = |name: &str| part.table.rows.iter().find(|row| row.name == name).map(|row| row.rotation);
    if let [Some(zxzxz), Some(taylor), Some(exact), Some(shears)] =
        ["zxzxz", "Taylor 1.5", "exact", "LF3"].map(rotation)
    {
        let _ = writeln!(
            text,
            "A rotation by zxzxz takes {:.1} times as long as one by Taylor 1.5, of which Křivánek et al. (2005, table 1) have \
             4.4 at order 6 and 6.4 at order 10; the exact kernel takes {:.1} times as long as LF3.\n",
            zxzxz / taylor,
            exact / shears
        );
    }
    if part.table.rows.iter().any(|row| row.is_adaptive) {
        let _ = writeln!(text, "The limit, as the error of the cache grows:\n\n{}", steps_text(&part.steps));
        let _ = writeln!(text, "{}\n", claim(&part.steps));
    }
    text
}

fn wall_section(size: &Size, stops: &[Stop], doubled: usize) -> String {
    let total: usize = stops.iter().map(|stop| stop.added).sum();
    let truth = TIMES * size.truth;
    format!(
        "## A glossy wall and three cameras\n\n\
         ![The wall from three cameras with one cache, and by brute force from the first](cache_wall.png)\n\n\
         The box of Gautron et al. (2004, figure 9): matte blocks before a back wall of exponent {}, hemispherical harmonics of \
         order 10, {} rays a record, a = {WALL_ERROR}. Three cameras take one cache, one after the other; the last square is by \
         brute force. The paper has 1121, 250 and 198 records and a tenth of the time of Monte Carlo at the same visual quality, \
         in pictures of 850 by 850 pixels; here it is {total} in all. *Times as long* is how many times as long brute force takes \
         until its root mean square error is the same: its rays, dealt as the lobe is high by a sequence of Sobol's, are doubled \
         until it is. The truth has {truth} rays a pixel. The last column is told from the others: brute force and the frame take longer by their pixels, the \
         records are taken as they are, though in a picture of twice as many pixels a side the first camera has {doubled}. \
         What the cache shows errs smoothly and brute force by noise. The wall is flat, so that \
         no record is turned.\n\n{}",
        WALL.exponent,
        size.wall_rays,
        stops_text(stops)
    )
}
