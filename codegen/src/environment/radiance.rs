//! Radiance HDR, row by row: each texel is three mantissas and one exponent of eight bits, whose rows are run-length
//! encoded, byte by byte or, before 1991, texel by texel. Ward's format as `image` and Radiance's own tools read it; a
//! header's exposure is left alone.

use super::error::{MapError, check_size};

/// An image that is read from the top.
pub(super) struct Radiance<'a> {
    name: &'a str,
    /// What is left of the file.
    bytes: &'a [u8],
    /// The number of columns.
    pub width: usize,
    /// The number of rows.
    pub height: usize,
}

/// A row as it is stored: the mantissas of R, G and B, and the exponents.
pub(super) struct Row([Vec<u8>; 4]);

impl Row {
    /// The linear radiance of R, G and B, as f32 holds it.
    pub fn planes(&self) -> [Vec<f64>; 3] {
        let Self([r, g, b, exponents]) = self;
        // An exponent of 0 is black whatever the mantissas are.
        let scale = |e: usize| if e == 0 { 0.0 } else { f64::exp2(e as f64 - 136.0) };
        let scales: [f64; 256] = std::array::from_fn(scale);
        [r, g, b].map(|mantissas| {
            let mut plane = vec![0.0; mantissas.len()];
            for (i, value) in plane.iter_mut().enumerate() {
                *value = mantissas[i] as f64 * scales[exponents[i] as usize];
            }
            plane
        })
    }

    /// Whether every texel is zero.
    pub fn is_black(&self) -> bool {
        let Self([r, g, b, exponents]) = self;
        exponents.iter().enumerate().all(|(i, &e)| e == 0 || (r[i], g[i], b[i]) == (0, 0, 0))
    }

    fn set(&mut self, places: std::ops::Range<usize>, texel: [u8; 4]) {
        for (plane, byte) in self.0.iter_mut().zip(texel) {
            plane[places.clone()].fill(byte);
        }
    }
}

impl<'a> Radiance<'a> {
    /// Reads the header. `name` is what errors call the file.
    ///
    /// # Errors
    ///
    /// If it is none, or the size is no map's.
    pub fn new(name: &'a str, bytes: &'a [u8]) -> Result<Self, MapError> {
        let mut image = Self { name, bytes, width: 0, height: 0 };
        loop {
            let line = image.line()?;
            match line.split_once('=') {
                _ if line.is_empty() => break,
                Some((key, format)) if key.trim() == "FORMAT" && format.trim() != "32-bit_rle_rgbe" => {
                    return Err(image.malformed(&format!("the format {} is not supported", shortened(format.trim()))));
                }
                // Comments, commands and other attributes.
                _ => {}
            }
        }
        let size = image.line()?;
        let number = |text: &str| text.parse::<u32>().ok().map(|number| number as usize);
        let (width, height) = match size.split_whitespace().collect::<Vec<_>>()[..] {
            ["-Y", height, "+X", width, ..] => number(width).zip(number(height)),
            _ => None,
        }
        .ok_or_else(|| image.malformed(&format!("its size is no `-Y HEIGHT +X WIDTH` but `{}`", shortened(&size))))?;
        check_size(name, width, height)?;
        (image.width, image.height) = (width, height);
        Ok(image)
    }

    fn malformed(&self, message: &str) -> MapError {
        MapError::malformed(self.name, message)
    }

    /// The next bytes, as many as are asked for.
    fn take(&mut self, count: usize) -> Result<&'a [u8], MapError> {
        let (taken, rest) = self.bytes.split_at_checked(count).ok_or_else(|| self.malformed("it ends too early"))?;
        self.bytes = rest;
        Ok(taken)
    }

    fn line(&mut self) -> Result<String, MapError> {
        let end = self.bytes.iter().position(|&byte| byte == b'\n');
        let end = end.ok_or_else(|| self.malformed("it ends too early"))?;
        let line = self.take(end)?;
        self.take(1)?;
        Ok(String::from_utf8_lossy(line).into_owned())
    }

    /// The next row.
    ///
    /// # Errors
    ///
    /// If the file ends in it, or it is longer than the header says.
    pub fn row(&mut self) -> Result<Row, MapError> {
        let mut row = Row(std::array::from_fn(|_| vec![0; self.width]));
        let first = self.texel()?;
        if matches!(first, [2, 2, high, _] if high < 128) {
            for plane in &mut row.0 {
                self.plane(plane)?;
            }
        } else {
            self.old_row(first, &mut row)?;
        }
        Ok(row)
    }

    fn texel(&mut self) -> Result<[u8; 4], MapError> {
        let texel = self.take(4)?;
        Ok([texel[0], texel[1], texel[2], texel[3]])
    }

    fn too_long(&self) -> MapError {
        self.malformed(&format!("a row has more than {} texels", self.width))
    }

    /// Runs and literal bytes of one channel.
    fn plane(&mut self, plane: &mut [u8]) -> Result<(), MapError> {
        let mut place = 0;
        while place < plane.len() {
            let code = self.take(1)?[0];
            let (count, is_run) = if code > 128 { (code as usize - 128, true) } else { (code as usize, false) };
            if place + count > plane.len() {
                return Err(self.too_long());
            }
            let part = &mut plane[place..place + count];
            match is_run {
                true => part.fill(self.take(1)?[0]),
                false => part.copy_from_slice(self.take(count)?),
            }
            place += count;
        }
        Ok(())
    }

    /// Whole texels; (1, 1, 1, n) repeats the one before it n times, the next such one 256 n times, and so on.
    fn old_row(&mut self, first: [u8; 4], row: &mut Row) -> Result<(), MapError> {
        let (mut texel, mut before, mut place, mut factor) = (first, None, 0, 1usize);
        loop {
            let count = match (texel, before) {
                ([1, 1, 1, _], None) => return Err(self.malformed("a row begins with a run")),
                ([1, 1, 1, count], Some(_)) => {
                    let count = (count as usize).saturating_mul(factor);
                    factor = factor.saturating_mul(256);
                    count
                }
                _ => {
                    (before, factor) = (Some(texel), 1);
                    1
                }
            };
            if count > self.width - place {
                return Err(self.too_long());
            }
            row.set(place..place + count, before.unwrap_or(texel));
            place += count;
            if place == self.width {
                return Ok(());
            }
            texel = self.texel()?;
        }
    }
}

/// The beginning of a text that may be anything.
fn shortened(text: &str) -> String {
    text.chars().take(20).collect()
}
