//! Tangent-space normal maps: an image becomes unit vectors above the horizon, and those become what a texture holds.
//! It knows nothing of shading.

use super::vector::unit;
use image::ImageFormat;
use std::io::Cursor;
use zonal_codegen::fault::Fault;

/// The largest file that is read, in bytes: twice what the most pixels of four 16-bit channels take.
pub const MAX_BYTES: usize = 1 << 28;
/// The most pixels along a side.
const MAX_SIZE: u32 = 4096;
/// The least z of a normal: 89 degrees. What leans further, or below the horizon, is brought up to it, here and where a
/// shader has filtered the normals of a texture.
pub const LEAST_Z: f64 = 0.0175;

/// Normals in tangent space: x along the tangent, y along the bitangent, z out of the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalMap {
    /// How many normals a row has.
    pub width: usize,
    /// How many rows there are.
    pub height: usize,
    /// Unit vectors with z > 0, row by row from v = 0, which is the bottom of the image.
    pub normals: Vec<[f32; 3]>,
}

impl NormalMap {
    /// No relief: every normal is z.
    pub fn flat() -> Self {
        Self { width: 1, height: 1, normals: vec![[0.0, 0.0, 1.0]] }
    }

    /// A map from the bytes of a PNG or WebP image whose channels hold (n + 1)/2, y up. `name` is what errors call it.
    /// Normals are brought to length one, and above the horizon.
    ///
    /// # Errors
    ///
    /// If it is no such image, or too large.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, Fault> {
        let fault = |message: String, help: &str| Fault::new(format!("{name}: {message}"), help);
        let known = [ImageFormat::WebP, ImageFormat::Png];
        let format = image::guess_format(bytes).ok().filter(|format| known.contains(format));
        let Some(format) = format else {
            return Err(fault("is neither a PNG nor a WebP image".to_owned(), "save the normal map as one of these"));
        };
        let mut reader = image::ImageReader::with_format(Cursor::new(bytes), format);
        let mut limits = image::Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(MAX_SIZE), Some(MAX_SIZE));
        reader.limits(limits);
        let image = reader
            .decode()
            .map_err(|error| fault(format!("cannot be decoded ({error})"), "save a map of at most 4096 x 4096 pixels"))?
            .into_rgb32f();
        let normal = |pixel: [f32; 3]| {
            let [x, y, z] = pixel.map(|value| f64::from(2.0 * value - 1.0));
            let [x, y, z] = unit([x, y, z]).unwrap_or([0.0, 0.0, 1.0]);
            unit([x, y, z.max(LEAST_Z)]).unwrap_or([0.0, 0.0, 1.0]).map(|x| x as f32)
        };
        let normals = image.rows().rev().flatten().map(|pixel| normal(pixel.0)).collect();
        Ok(Self { width: image.width() as usize, height: image.height() as usize, normals })
    }

    /// The slopes √(x² + y²)/z in ascending order: a strength of s makes of a slope a tilt by atan(s · slope).
    pub fn slopes(&self) -> Vec<f64> {
        let slope = |n: &[f32; 3]| f64::from(n[0].hypot(n[1]) / n[2]);
        let mut slopes: Vec<f64> = self.normals.iter().map(slope).collect();
        slopes.sort_by(f64::total_cmp);
        slopes
    }

    /// The texels of a texture with all its levels, RGBA with (n + 1)/2 in the first three: each level is the average of
    /// two by two normals of the one before, at length one, down to one normal.
    pub fn levels(&self) -> Vec<Vec<[u8; 4]>> {
        let byte = |x: f32| (127.5 * (x + 1.0)).round() as u8;
        let mut level = self.clone();
        let mut levels = Vec::new();
        loop {
            levels.push(level.normals.iter().map(|n| [byte(n[0]), byte(n[1]), byte(n[2]), 255]).collect());
            if (level.width, level.height) == (1, 1) {
                return levels;
            }
            level = level.halved();
        }
    }

    fn halved(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let at = |x: usize, y: usize| self.normals[y.min(self.height - 1) * self.width + x.min(self.width - 1)];
        let average = |x: usize, y: usize| {
            let four = [at(2 * x, 2 * y), at(2 * x + 1, 2 * y), at(2 * x, 2 * y + 1), at(2 * x + 1, 2 * y + 1)];
            let sum = std::array::from_fn(|i| four.iter().map(|n| f64::from(n[i])).sum());
            unit(sum).unwrap_or([0.0, 0.0, 1.0]).map(|x| x as f32)
        };
        let normals = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| average(x, y)).collect();
        Self { width, height, normals }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zonal_scenes as assets;

    #[test]
    fn the_maps_are_unit_vectors_above_the_horizon() {
        for path in assets::below("normals") {
            let map = NormalMap::from_bytes(path, assets::embedded(path).expect("embedded")).expect("a map");
            assert_eq!((map.width, map.height, map.normals.len()), (512, 512, 512 * 512), "{path}");
            for n in &map.normals {
                let length = n.iter().map(|x| x * x).sum::<f32>().sqrt();
                assert!((length - 1.0).abs() < 1e-6 && n[2] > 0.017, "{path}: {n:?}");
            }
            let slopes = map.slopes();
            assert!(slopes.is_sorted() && slopes[slopes.len() / 2] > 0.0, "{path}");
        }
    }

    #[test]
    fn levels_halve_down_to_one_normal_and_keep_a_uniform_slope() {
        let normal = [0.6, 0.0, 0.8];
        let map = NormalMap { width: 8, height: 2, normals: vec![normal; 16] };
        let levels = map.levels();
        assert_eq!(levels.iter().map(Vec::len).collect::<Vec<_>>(), [16, 4, 2, 1]);
        assert!(levels.iter().flatten().all(|texel| *texel == [204, 128, 230, 255]), "{levels:?}");
        assert_eq!(NormalMap::flat().levels(), [[[128, 128, 255, 255]]]);
    }

    #[test]
    fn rows_start_at_the_bottom_and_what_is_below_the_horizon_comes_up() {
        let mut png = Vec::new();
        let image = image::RgbImage::from_raw(1, 2, vec![128, 128, 255, 255, 128, 0]).expect("two pixels");
        image.write_to(&mut Cursor::new(&mut png), ImageFormat::Png).expect("a PNG");
        let map = NormalMap::from_bytes("a.png", &png).expect("a map");
        let [bottom, top] = [map.normals[0], map.normals[1]];
        assert!(bottom[0] > 0.99 && bottom[2] > 0.017 && top[2] > 0.999, "{map:?}");
    }

    #[test]
    fn what_is_no_normal_map_is_refused_with_a_reason() {
        for (bytes, part) in [(&b""[..], "neither"), (b"#?RADIANCE", "neither"), (b"\x89PNG\r\n\x1a\n", "decoded")] {
            let error = NormalMap::from_bytes("a.png", bytes).expect_err("no map").to_string();
            assert!(error.starts_with("a.png: ") && error.contains(part), "{error}");
        }
    }
}
