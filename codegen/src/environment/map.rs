//! A map in memory: read from a latitude-longitude image and refused if it is no radiance.

use super::error::{MAX_BYTES, MapError, check_size};
use super::openexr;
use super::radiance::Radiance;
use crate::input;
use std::f64::consts::PI;
use std::path::Path;

/// A latitude-longitude map of radiance around a point. See the [module](super) for its directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// The number of columns, twice the height.
    pub width: usize,
    /// The number of rows.
    pub height: usize,
    /// The linear RGB radiance of `width * height` texels, row by row from the top, each row from the left. Finite,
    /// not negative, in the units of the file (a header's exposure is left alone).
    pub texels: Vec<[f64; 3]>,
}

impl Map {
    /// Reads a map from a file, Radiance HDR or OpenEXR by its content, whatever its extension.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, is no regular file or larger than [`MAX_BYTES`], or for any reason of
    /// [`Map::from_bytes`].
    pub fn read(path: &Path) -> Result<Self, MapError> {
        let name = path.display().to_string();
        match input::read(path, MAX_BYTES) {
            Ok(bytes) => Self::from_bytes(&name, &bytes),
            Err(source) => Err(MapError::Unreadable { name, source }),
        }
    }

    /// Reads a map from the bytes of a file, Radiance HDR or OpenEXR by its content. `name` is what errors call it.
    ///
    /// # Errors
    ///
    /// If the format is another one, the bytes are damaged, the map is empty, not twice as wide as high or wider than
    /// [`MAX_WIDTH`](super::MAX_WIDTH), or a texel is not finite or negative, or all are zero.
    ///
    /// No bytes make it panic. (A damaged OpenEXR file in DWA compression can still name sizes for which its decoder
    /// asks for more memory than there is, which ends the process.)
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, MapError> {
        match format(name, bytes)? {
            Format::OpenExr => {
                let (width, height, texels) = openexr::read(name, bytes)?;
                Self { width, height, texels }.checked(name)
            }
            Format::Radiance => {
                let mut image = Radiance::new(name, bytes)?;
                let mut texels = Vec::with_capacity(image.width * image.height);
                let mut planes: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; image.width]);
                for _ in 0..image.height {
                    image.row()?.read(planes.each_mut().map(Vec::as_mut_slice));
                    texels.extend((0..image.width).map(|x| planes.each_ref().map(|plane| plane[x])));
                }
                Self { width: image.width, height: image.height, texels }.checked(name)
            }
        }
    }

    /// This map, if it is one that [`Map::from_bytes`] could have given: for a map made by hand. `name` is what
    /// errors call it.
    ///
    /// # Errors
    ///
    /// If it is empty, not twice as wide as high, wider than [`MAX_WIDTH`](super::MAX_WIDTH), has another number of texels than its
    /// size says, or a texel is not finite or negative, or all are zero.
    pub fn checked(self, name: &str) -> Result<Self, MapError> {
        check_size(name, self.width, self.height)?;
        if self.texels.len() != self.width * self.height {
            return Err(MapError::malformed(name, &format!("it has {} texels", self.texels.len())));
        }
        let place = |i: usize| (i % self.width, i / self.width);
        let wrong = |bad: fn(f64) -> bool| {
            let found = |t: &[f64; 3]| t.iter().copied().find(|&v| bad(v));
            let mut wrong = self.texels.iter().enumerate().filter_map(|(i, t)| Some((i, found(t)?)));
            wrong.next().map(|(i, value)| (place(i), value, 1 + wrong.count()))
        };
        if let Some(((x, y), value, count)) = wrong(|v| !v.is_finite()) {
            return Err(MapError::NotFinite { name: name.to_string(), count, x, y, value });
        }
        if let Some(((x, y), _, count)) = wrong(|v| v < 0.0) {
            let lowest = self.texels.iter().flatten().copied().fold(0.0, f64::min);
            return Err(MapError::Negative { name: name.to_string(), count, lowest, x, y });
        }
        if self.texels.iter().flatten().all(|&v| v == 0.0) {
            return Err(MapError::Black { name: name.to_string() });
        }
        Ok(self)
    }

    /// The unit direction (x, y, z) of the centre of the texel in column `x` (from 0 at the left) of row `y` (from 0
    /// at the top).
    pub fn direction(&self, x: usize, y: usize) -> [f64; 3] {
        let azimuth = PI - 2.0 * PI * (x as f64 + 0.5) / self.width as f64;
        let (sin, cos) = (PI * (y as f64 + 0.5) / self.height as f64).sin_cos();
        [sin * azimuth.cos(), sin * azimuth.sin(), cos]
    }

    /// The solid angle in steradians of each texel in row `y` (from 0 at the top). All texels together have 4π.
    pub fn solid_angle(&self, y: usize) -> f64 {
        solid_angle(self.width, self.height, y)
    }

    /// The square of the radiance, integrated over the sphere and summed over R, G and B: what the energies of all
    /// the bands come to.
    ///
    /// # Panics
    ///
    /// If the map was made by hand and its width is 0; see [`Map::checked`].
    pub fn energy(&self) -> f64 {
        let rows = self.texels.chunks_exact(self.width).enumerate();
        rows.map(|(y, row)| self.solid_angle(y) * row.iter().flatten().map(|v| v * v).sum::<f64>()).sum()
    }
}

/// The formats of maps.
pub(super) enum Format {
    Radiance,
    OpenExr,
}

/// Other formats by their first bytes, of which 0 stands for any; files are called what they are not.
const OTHERS: [(&[u8], &str); 12] = [
    (b"\x89PNG\r\n\x1a\n", "Png"),
    (b"\xff\xd8\xff", "Jpeg"),
    (b"GIF8", "Gif"),
    (b"RIFF\0\0\0\0WEBP", "WebP"),
    (b"MM\0*", "Tiff"),
    (b"II*", "Tiff"),
    (b"DDS ", "Dds"),
    (b"BM", "Bmp"),
    (b"\0\0\0\0ftypavif", "Avif"),
    (b"qoif", "Qoi"),
    (b"P\0\n", "Pnm"),
    (b"farbfeld", "Farbfeld"),
];

/// The format of a file by its content.
pub(super) fn format(name: &str, bytes: &[u8]) -> Result<Format, MapError> {
    let starts = |magic: &[u8]| bytes.len() >= magic.len() && magic.iter().zip(bytes).all(|(m, b)| *m == 0 || m == b);
    let found = match OTHERS.iter().find(|(magic, _)| starts(magic)) {
        _ if bytes.starts_with(b"#?") => return Ok(Format::Radiance),
        _ if bytes.starts_with(&openexr::MAGIC) => return Ok(Format::OpenExr),
        _ if bytes.is_empty() => "nothing".to_owned(),
        Some((_, format)) => format!("a {format} image"),
        None => "unknown data".to_owned(),
    };
    Err(MapError::Format { name: name.to_owned(), found })
}

/// The solid angle in steradians of each texel in row `y` of a map.
pub(super) fn solid_angle(width: usize, height: usize, y: usize) -> f64 {
    let half = 0.5 * PI / height as f64;
    let cosines = 2.0 * half.sin() * ((2 * y + 1) as f64 * half).sin();
    2.0 * PI / width as f64 * cosines
}
