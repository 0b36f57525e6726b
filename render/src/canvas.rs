//! Pixels for a screen: frames over their background, false colours with their legend, lines of text, and PNG files.

use crate::frame::Frame;
use crate::tone;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use rayon::prelude::*;
use std::io::Cursor;
use zonal_codegen::environment::Map;
use zonal_picture::camera::{Camera, View};

/// Behind everything.
pub const GROUND: [u8; 3] = [22, 24, 29];
/// What is to be read first.
pub const BRIGHT: [u8; 3] = [236, 238, 242];
/// What is to be read then.
pub const MUTED: [u8; 3] = [160, 166, 176];

/// An image of bytes in sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Canvas {
    /// The width and the height.
    pub size: [usize; 2],
    /// Row by row from the top.
    pub pixels: Vec<[u8; 3]>,
}

/// The weight of a line of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Text {
    /// 24 pixels high, bold.
    Title,
    /// 20 pixels high.
    Line,
}

impl Text {
    fn font(self) -> (FontWeight, RasterHeight) {
        match self {
            Self::Title => (FontWeight::Bold, RasterHeight::Size24),
            Self::Line => (FontWeight::Regular, RasterHeight::Size20),
        }
    }

    /// The width of a character.
    pub fn width(self) -> usize {
        let (weight, height) = self.font();
        get_raster_width(weight, height)
    }
}

impl Canvas {
    /// A canvas of one colour.
    pub fn new(size: [usize; 2], colour: [u8; 3]) -> Self {
        Self { size, pixels: vec![colour; size[0] * size[1]] }
    }

    /// Puts another canvas at a place; what does not fit is cut off.
    pub fn put(&mut self, [left, top]: [usize; 2], other: &Self) {
        for (y, row) in other.pixels.chunks_exact(other.size[0]).enumerate() {
            for (x, pixel) in row.iter().enumerate() {
                self.set([left + x, top + y], *pixel);
            }
        }
    }

    fn set(&mut self, [x, y]: [usize; 2], colour: [u8; 3]) {
        if x < self.size[0] && y < self.size[1] {
            self.pixels[y * self.size[0] + x] = colour;
        }
    }

    /// Writes a line of ASCII over what is there, which is taken to be [`GROUND`]; what does not fit is cut off.
    pub fn write(&mut self, [left, top]: [usize; 2], text: &str, weight: Text, colour: [u8; 3]) {
        let (font, height) = weight.font();
        for (i, character) in text.chars().enumerate() {
            let Some(raster) = get_raster(character, font, height).or_else(|| get_raster('?', font, height)) else {
                continue;
            };
            for (y, row) in raster.rows().enumerate() {
                for (x, &ink) in row.iter().enumerate().filter(|(_, ink)| **ink > 0) {
                    let share = f64::from(ink) / 255.0;
                    let mixed = std::array::from_fn(|k| {
                        (f64::from(GROUND[k]) * (1.0 - share) + f64::from(colour[k]) * share).round() as u8
                    });
                    self.set([left + i * weight.width() + x, top + y], mixed);
                }
            }
        }
    }

    /// The canvas as the bytes of a PNG file.
    pub fn png(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let [width, height] = self.size.map(|side| side as u32);
        let encoder = image::codecs::png::PngEncoder::new_with_quality(
            Cursor::new(&mut bytes),
            image::codecs::png::CompressionType::Best,
            image::codecs::png::FilterType::Adaptive,
        );
        let written = image::ImageEncoder::write_image(
            encoder,
            self.pixels.as_flattened(),
            width,
            height,
            image::ExtendedColorType::Rgb8,
        );
        written.expect("memory takes any image whose bytes are as many as its size says");
        bytes
    }
}

/// The colour of an error: black at 0, bright yellow at 1 and beyond.
pub fn false_colour(share: f64) -> [u8; 3] {
    let colour = colorous::INFERNO.eval_continuous(share.clamp(0.0, 1.0));
    [colour.r, colour.g, colour.b]
}

/// A frame as a screen shows it: `samples` by `samples` of its pixels become one, over what the camera sees of the map,
/// which is blurred as if out of focus.
pub fn shown(frame: &Frame, samples: usize, exposure: f64, camera: &Camera, map: &Map) -> Canvas {
    let aspect = frame.size[0] as f64 / frame.size[1] as f64;
    let unrolled = map.is_cube().then(|| map.unrolled(2 * map.width));
    let map = unrolled.as_ref().unwrap_or(map);
    let sample = |x: usize, y: usize| {
        let radiance = frame.pixels[y * frame.size[0] + x].unwrap_or_else(|| {
            let place = |i: usize, side: usize| (2 * i + 1) as f64 / side as f64 - 1.0;
            blurred(map, camera.direction(place(x, frame.size[0]), -place(y, frame.size[1]), aspect))
        });
        tone::mapped(radiance.map(|c| exposure * c))
    };
    resolved(frame.size, samples, sample, |mean| mean.map(tone::encoded))
}

/// A frame as a screen shows it, over [`GROUND`]: `samples` by `samples` of its pixels become one.
pub fn over_ground(frame: &Frame, samples: usize, exposure: f64) -> Canvas {
    let [width, height] = frame.size.map(|side| side / samples);
    let mut canvas = Canvas::new([width, height], GROUND);
    for (i, pixel) in canvas.pixels.iter_mut().enumerate() {
        let (left, top) = (i % width * samples, i / width * samples);
        let all = (0..samples * samples).filter_map(|k| {
            frame.pixels[(top + k / samples) * frame.size[0] + left + k % samples]
                .map(|radiance| tone::mapped(radiance.map(|c| c * exposure)))
        });
        let found: Vec<[f64; 3]> = all.collect();
        let ground = (samples * samples - found.len()) as f64;
        for k in 0..3 {
            let sum: f64 = found.iter().map(|share| f64::from(tone::encoded(share[k]))).sum();
            pixel[k] = ((sum + ground * f64::from(GROUND[k])) / (samples * samples) as f64).round() as u8;
        }
    }
    canvas
}

/// The error of each pixel, in units of `scale`, in false colours over [`GROUND`].
pub fn difference(errors: &[Option<f64>], size: [usize; 2], samples: usize, scale: f64) -> Canvas {
    let sample = |x: usize, y: usize| match errors[y * size[0] + x] {
        None => [0.0, 0.0],
        Some(error) => [1.0, error / scale],
    };
    let colour = |[covered, error]: [f64; 2]| {
        let inside = false_colour(if covered > 0.0 { error / covered } else { 0.0 });
        let mix = |k: usize| covered * f64::from(inside[k]) + (1.0 - covered) * f64::from(GROUND[k]);
        std::array::from_fn(|k| mix(k).round() as u8)
    };
    resolved(size, samples, sample, colour)
}

/// The canvas whose pixels are the means of `samples` by `samples` values.
fn resolved<const N: usize>(
    size: [usize; 2],
    samples: usize,
    sample: impl Fn(usize, usize) -> [f64; N] + Sync,
    colour: impl Fn([f64; N]) -> [u8; 3] + Sync,
) -> Canvas {
    let [width, height] = size.map(|side| side / samples);
    let pixel = |i: usize| {
        let (left, top) = (i % width * samples, i / width * samples);
        let all = (0..samples * samples).map(|k| sample(left + k % samples, top + k / samples));
        let sum = all.fold([0.0; N], |sum, value| std::array::from_fn(|k| sum[k] + value[k]));
        colour(sum.map(|v| v / (samples * samples) as f64))
    };
    Canvas { size: [width, height], pixels: (0..width * height).into_par_iter().map(pixel).collect() }
}

/// The map in a direction, smoothed by a cubic B-spline over its texels.
fn blurred(map: &Map, direction: [f64; 3]) -> [f64; 3] {
    use std::f64::consts::PI;
    let azimuth = direction[1].atan2(direction[0]);
    let column = (0.5 - azimuth / (2.0 * PI)) * map.width as f64 - 0.5;
    let row = direction[2].clamp(-1.0, 1.0).acos() / PI * map.height as f64 - 0.5;
    let weights = |t: f64| {
        let s = 1.0 - t;
        [s * s * s / 6.0, (4.0 + 3.0 * t * t * (t - 2.0)) / 6.0, (4.0 + 3.0 * s * s * (s - 2.0)) / 6.0, t * t * t / 6.0]
    };
    let (across, down) = (weights(column - column.floor()), weights(row - row.floor()));
    let mut sum = [0.0; 3];
    for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let x = (column.floor() as isize + i as isize - 1).rem_euclid(map.width as isize) as usize;
        let y = (row.floor() as isize + j as isize - 1).clamp(0, map.height as isize - 1) as usize;
        let texel = map.texels[y * map.width + x];
        (0..3).for_each(|k| sum[k] += across[i] * down[j] * texel[k]);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_blurred_map_is_the_map_where_that_is_smooth_and_has_no_seam() {
        let mut map = Map { width: 64, height: 32, texels: vec![[0.0; 3]; 64 * 32] };
        for i in 0..map.texels.len() {
            let [x, y, z] = map.direction(i % 64, i / 64);
            map.texels[i] = [2.0 + x, 2.0 + y, 2.0 + z];
        }
        for direction in [[1.0, 0.0, 0.0], [-1.0, 1e-9, 0.0], [-1.0, -1e-9, 0.0], [0.6, 0.0, 0.8], [0.0, -0.8, -0.6]] {
            let found = blurred(&map, direction);
            for k in 0..3 {
                // The spline's kernel has a variance of a third of a texel squared: 0.1 * 0.1 / 6 of the value, twice.
                assert!((found[k] - 2.0 - direction[k]).abs() < 5e-3, "{direction:?}: {found:?}");
            }
        }
    }

    #[test]
    fn samples_are_averaged_after_the_tone_curve() {
        let map = Map { width: 2, height: 1, texels: vec![[1.0; 3]; 2] };
        let frame = Frame {
            size: [2, 2],
            pixels: vec![Some([1e9; 3]), Some([0.0; 3]), Some([1e9; 3]), Some([-5.0; 3])],
            milliseconds: 0.0,
        };
        let canvas = shown(&frame, 2, 1.0, &Camera::default(), &map);
        assert_eq!((canvas.size, &canvas.pixels[..]), ([1, 1], &[[tone::encoded(0.5); 3]][..]));
    }

    #[test]
    fn text_and_tiles_may_reach_over_the_edge() {
        let mut canvas = Canvas::new([40, 20], GROUND);
        canvas.write([30, 10], "a long line", Text::Title, BRIGHT);
        assert!(canvas.pixels.iter().any(|pixel| *pixel != GROUND));
        canvas.put([35, 15], &Canvas::new([50, 50], [255, 0, 0]));
        assert_eq!(canvas.pixels[19 * 40 + 39], [255, 0, 0]);
        let png = image::load_from_memory(&canvas.png()).expect("a PNG").into_rgb8();
        assert_eq!((png.dimensions(), png.as_raw().as_slice()), ((40, 20), canvas.pixels.as_flattened()));
    }

    #[test]
    fn errors_are_shown_where_the_object_is() {
        let canvas = difference(&[None, Some(0.0), Some(1.0), Some(9.0)], [4, 1], 1, 1.0);
        assert_eq!(canvas.pixels, [GROUND, false_colour(0.0), false_colour(1.0), false_colour(1.0)]);
    }
}
