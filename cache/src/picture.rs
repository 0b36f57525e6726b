//! Pictures for a page: squares beside each other, as the bytes of a PNG file.

use crate::cache::Cache;
use crate::view::View;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageError};
use std::collections::HashSet;
use zonal_codegen::fault::Fault;
use zonal_picture::tone::{encoded, mapped};
use zonal_picture::vector::{add, length};

/// A square of pixels in sRGB, row by row from the top.
pub type Square = Vec<[u8; 3]>;

/// Between squares.
const GAP: usize = 4;
const GROUND: [u8; 3] = [22, 24, 29];
const MARK: [u8; 3] = [255, 220, 60];

/// Returns radiance as a screen shows it.
pub fn shown(radiance: &[[f64; 3]], exposure: f64) -> Square {
    radiance.iter().map(|v| mapped(v.map(|x| x * exposure)).map(encoded)).collect()
}

/// Returns a dimmed picture in which the pixels are marked whose places have a record.
pub fn records<const C: usize>(view: &View, cache: &Cache<C>, radiance: &[[f64; 3]], exposure: f64) -> Square {
    let key = |position: [f64; 3]| position.map(f64::to_bits);
    let all: HashSet<_> = cache.records.iter().map(|record| key(record.place.point.position)).collect();
    let mut square = shown(radiance, 0.3 * exposure);
    let marked = view.glossy.iter().filter(|pixel| all.contains(&key(pixel.place.point.position)));
    marked.for_each(|pixel| square[pixel.number] = MARK);
    square
}

/// Returns the difference of what glossy pixels show in false colours: black at none, bright yellow at `bright` of the mean
/// of the second.
pub fn difference(view: &View, a: &[[f64; 3]], b: &[[f64; 3]], bright: f64) -> Square {
    let mean = b.iter().map(|v| length(*v)).sum::<f64>() / b.len().max(1) as f64;
    let mut square = vec![GROUND; view.side * view.side];
    for (pixel, (a, b)) in view.glossy.iter().zip(a.iter().zip(b)) {
        let share = length(add(*a, -1.0, *b)) / mean / bright;
        let colour = colorous::INFERNO.eval_continuous(share.clamp(0.0, 1.0));
        square[pixel.number] = [colour.r, colour.g, colour.b];
    }
    square
}

/// Returns squares beside each other as a PNG file.
///
/// # Errors
///
/// If the picture is too large for a PNG file.
pub fn strip(squares: &[Square], side: usize) -> Result<Vec<u8>, Fault> {
    let width = squares.len() * (side + GAP) - GAP.min(squares.len() * GAP);
    let mut pixels = vec![GROUND; width * side];
    for (i, square) in squares.iter().enumerate() {
        for (y, row) in square.chunks_exact(side).enumerate() {
            let left = y * width + i * (side + GAP);
            pixels[left..left + side].copy_from_slice(row);
        }
    }
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    let written = encoder.write_image(pixels.as_flattened(), width as u32, side as u32, ExtendedColorType::Rgb8);
    let fault = |error: ImageError| Fault::new(format!("cannot make the picture: {error}"), "make it smaller");
    written.map_err(fault).map(|()| bytes)
}
