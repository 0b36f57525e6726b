//! `docs/LIGHTMAPS.md` and its picture: what each basis errs by and costs in a room with a lightmap.

use crate::canvas::{BRIGHT, Canvas, GROUND, MUTED, Text, difference, over_ground};
use crate::figures::{Errors, percent, pixel_errors};
use crate::frame::Frame;
use crate::lightmap::room::{RAYS, Room, SIZE};
use crate::lightmap::seen::{Lean, Level, Pixel, Relief, Setup, leans, levels, picture};
use crate::lightmap::ways::Way;
use crate::tone;
use indicatif::ProgressBar;
use std::f64::consts::FRAC_1_PI;
use std::fmt::Write;
use zonal_codegen::environment::Map;
use zonal_codegen::fault::Fault;
use zonal_codegen::scene::picture::Camera;
use zonal_picture::lights::Lights;
use zonal_picture::mesh::Mesh;

/// How the room is looked at.
pub const CAMERA: Camera = Camera { azimuth: -48.0, elevation: 26.0, distance: 2.6, field: 29.0 };
/// The size of a picture of the strip.
pub const TILE: [usize; 2] = [200, 168];
/// Where the boxes stand.
const SEED: u64 = 5;
/// How many lights brute force takes for the map.
const LIGHTS: usize = 2048;
/// At how many places the levels of the normal map are measured.
const PLACES: usize = 250;

/// What is measured.
pub struct Report {
    /// The map's name.
    pub map: String,
    /// The ways, in the order of all lists.
    pub ways: Vec<Way>,
    /// By each way from the lightmap and the vertices, against brute force.
    pub baked: Vec<Errors>,
    /// By each way from what reaches the pixel.
    pub own: Vec<Errors>,
    /// By how far normals lean.
    pub leans: Vec<Lean>,
    /// By level of the normal map.
    pub levels: Vec<Level>,
    pixels: Vec<Option<Pixel>>,
    size: [usize; 2],
    samples: usize,
}

fn frame(pixels: &[Option<Pixel>], size: [usize; 2], of: impl Fn(&Pixel) -> [f64; 3]) -> Frame {
    // A white surface sends out irradiance over π.
    let shown = |pixel: &Option<Pixel>| pixel.as_ref().map(|pixel| of(pixel).map(|v| v * FRAC_1_PI));
    Frame { size, pixels: pixels.iter().map(shown).collect(), milliseconds: 0.0 }
}

impl Report {
    /// Bakes and draws the room under a map, with an object in it and a relief on all; a pixel is the mean of the square of
    /// `samples`.
    ///
    /// # Errors
    ///
    /// If a kernel is not known, the lightmap has no room or the map no light.
    pub fn measure(
        name: &str,
        map: &Map,
        object: &Mesh,
        relief: &Relief,
        samples: usize,
        bar: &ProgressBar,
    ) -> Result<Self, Fault> {
        let ways = Way::all()?;
        let room = Room::new(SEED, object)?;
        bar.set_message("baking");
        let baked = room.bake(map)?;
        let lights = Lights::of(map).gathered(LIGHTS);
        let size = TILE.map(|side| side * samples);
        bar.set_message("brute force");
        bar.set_length((size[0] * size[1]) as u64);
        let setup = Setup { room: &room, baked: &baked, lights: &lights, relief, ways: &ways, camera: &CAMERA };
        let pixels = picture(&setup, size, || bar.inc(1));
        let truth = frame(&pixels, size, |pixel| pixel.truth);
        let errors = |of: &dyn Fn(&Pixel, usize) -> [f64; 3]| -> Vec<Errors> {
            (0..ways.len()).map(|way| Errors::of(&frame(&pixels, size, |pixel| of(pixel, way)), &truth)).collect()
        };
        Ok(Self {
            map: name.to_owned(),
            baked: errors(&|pixel, way| pixel.baked[way]),
            own: errors(&|pixel, way| pixel.own[way]),
            leans: leans(&setup, PLACES),
            levels: levels(&setup, PLACES),
            ways,
            pixels,
            size,
            samples,
        })
    }

    /// The strip: brute force and the pictures of the ways, and below each its errors in false colours.
    pub fn canvas(&self) -> Canvas {
        const GAP: usize = 12;
        const LINE: usize = 26;
        let [width, height] = TILE;
        let columns = self.ways.len() + 1;
        let mut canvas = Canvas::new([columns * (width + GAP) + GAP, 2 * (height + GAP) + 2 * LINE + 2 * GAP], GROUND);
        let truth = frame(&self.pixels, self.size, |pixel| pixel.truth);
        let exposure = tone::exposure(&truth, 0.6);
        let top = GAP + LINE;
        let mut put = |column: usize, title: &str, below: &str, frame: &Frame, errors: Option<Canvas>| {
            let left = GAP + column * (width + GAP);
            canvas.write([left, GAP - 4], title, Text::Title, BRIGHT);
            canvas.put([left, top], &over_ground(frame, self.samples, exposure));
            if let Some(errors) = errors {
                canvas.put([left, top + height + GAP], &errors);
            }
            canvas.write([left, top + 2 * height + GAP + GAP / 2], below, Text::Line, MUTED);
        };
        put(0, "brute force", "errors: bright is 30 %", &truth, None);
        for (i, way) in self.ways.iter().enumerate() {
            let frame = frame(&self.pixels, self.size, |pixel| pixel.baked[i]);
            let errors = difference(&pixel_errors(&frame, &truth), self.size, self.samples, 0.3);
            let below = format!("rms {}", percent(self.baked[i].rms));
            put(i + 1, way.name, &below, &frame, Some(errors));
        }
        canvas
    }

    /// The page.
    pub fn markdown(&self) -> String {
        let mut text = format!(
            "# Lightmaps for normal maps, measured\n\n\
             <!-- Generated: UPDATE=1 cargo test -p zonal-render --test it lightmap -->\n\n\
             ![A room with a lightmap and a teapot with baked vertices, by brute force and in each basis](lightmaps.png)\n\n\
             A room under `{}` with a lightmap of {SIZE} by {SIZE} texels, its islands turned and mirrored, and a teapot whose \
             vertices are baked, all white and under one normal map: irradiance normal mapping (Habel and Wimmer 2010), baked \
             as `zonal bake` does, with {RAYS} rays a point. Brute force is the mean, over all normals of the map that a pixel \
             covers, of the sum over {LIGHTS} lights, into which the map's texels are gathered, of those that nothing hides. \
             Errors are shares of the mean, as in [PICTURES.md](PICTURES.md).\n\n\
             *flat* has no normal map. *hl2*, *h4* and *h6* are irradiance over the hemisphere in the Half-Life 2 basis and the \
             H-basis, made of radiance in three and in five bands; *ready* are the operations where coefficients were made ready \
             for the kernel. *sh3* is transferred radiance: the cosine's lobe is turned to the normal, pixel by pixel. \
             Operations are those of R, G and B.\n\n\
             | way | coefficients | kernel | operations | ready | from the lightmap: mean | rms | worst | the basis alone: mean | rms |\n\
             |---|---|---|---|---|---|---|---|---|---|\n",
            self.map
        );
        for (i, way) in self.ways.iter().enumerate() {
            let (baked, own) = (&self.baked[i], &self.own[i]);
            let special = if way.special > 0 { format!(" and {} special", way.special) } else { String::new() };
            let kernel = if way.operations == 0 { "none".to_owned() } else { format!("`{}`", way.spec) };
            let ready = way.prepared.map_or_else(|| "–".to_owned(), |(spec, total)| format!("{total} (`{spec}`)"));
            let [mean, rms, worst] = [baked.mean, baked.rms, baked.worst].map(percent);
            let (own_mean, own_rms) = (percent(own.mean), percent(own.rms));
            let _ = writeln!(
                text,
                "| {} | {} | {kernel} | {}{special} | {ready} | {mean} | {rms} | {worst} | {own_mean} | {own_rms} |",
                way.name, way.coefficients, way.operations
            );
        }
        self.write_leans(&mut text);
        self.write_levels(&mut text);
        text
    }

    fn write_leans(&self, text: &mut String) {
        text.push_str(
            "\n## What normals lean by\n\n\
             The root mean square error of each basis alone at normals that are spread evenly around the surface's, within an \
             angle of it. What `h6` has beyond `h4` grows with the square of the sine of that angle: for a shallow relief the \
             two are one.\n\n| within |",
        );
        self.ways.iter().for_each(|way| {
            let _ = write!(text, " {} |", way.name);
        });
        let _ = write!(text, "\n|---|{}\n", "---|".repeat(self.ways.len()));
        for lean in &self.leans {
            let errors: Vec<String> = lean.errors.iter().map(|error| percent(*error)).collect();
            let _ = writeln!(text, "| {:.0} degrees | {} |", lean.degrees, errors.join(" | "));
        }
    }

    fn write_levels(&self, text: &mut String) {
        let names: Vec<&Way> = self.ways.iter().filter(|way| way.takes_means).collect();
        text.push_str(
            "\n## Means of normals are taken as they are\n\n\
             At a distance a pixel covers many normals of the map, and a level of its texture holds their mean, which is \
             shorter than one. Irradiance in `hl2` and `h4` is linear in the normal, so that the mean gives the mean of the \
             irradiance; `h6` has squares besides. The root mean square error against the mean of brute force over all normals \
             of a texel, with the mean as it is and brought to length one, and how many times larger the second is. What the \
             basis errs by on each normal is in both.\n\n\
             | level | normals | mean length |",
        );
        for way in &names {
            let _ = write!(text, " {0}, as it is | {0}, at length one | times |", way.name);
        }
        let _ = write!(text, "\n|---|---|---|{}\n", "---|".repeat(3 * names.len()));
        for level in &self.levels {
            let _ = write!(text, "| {} | {} | {:.3} |", level.level, 1u64 << (2 * level.level), level.length);
            for (i, _) in self.ways.iter().enumerate().filter(|(_, way)| way.takes_means) {
                let (as_it_is, normalised) = (level.as_it_is[i], level.normalised[i]);
                let times = normalised / as_it_is;
                let _ = write!(text, " {} | {} | {times:.1} |", percent(as_it_is), percent(normalised));
            }
            text.push('\n');
        }
    }
}
