//! Radiance HDR, row by row: each texel is three mantissas and one exponent of eight bits, whose rows are run-length
//! encoded, byte by byte or, before 1991, texel by texel. Ward's format as `image` and Radiance's own tools read it; a
//! header's exposure is left alone. Loops over texels are plain ones over slices, since a build script compiles them
//! without optimisation: an iterator or an index of a vector costs several calls a texel there.

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

/// What a mantissa is multiplied with, by its exponent: 0 for an exponent of 0, which is black whatever the mantissas
/// are, or 2^(e − 136).
const SCALES: [f64; 256] = {
    let (mut scales, mut e) = ([0.0; 256], 1);
    while e < 256 {
        // An f64 is 2 to the power of its exponent less 1023, above 52 bits of its mantissa.
        scales[e] = f64::from_bits((e as u64 + 1023 - 136) << 52);
        e += 1;
    }
    scales
};

/// A row as it is stored: the mantissas of R, G and B, and the exponents.
pub(super) struct Row([Vec<u8>; 4]);

impl Row {
    /// Writes the linear radiance of R, G and B, as f32 holds it, over planes that are as long as the row.
    pub fn read(&self, [red, green, blue]: [&mut [f64]; 3]) {
        let [r, g, b, exponents] = self.0.each_ref().map(Vec::as_slice);
        let mut x = 0;
        while x < exponents.len() {
            let scale = SCALES[exponents[x] as usize];
            red[x] = r[x] as f64 * scale;
            green[x] = g[x] as f64 * scale;
            blue[x] = b[x] as f64 * scale;
            x += 1;
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
        if matches!(self.bytes, [2, 2, high, _, ..] if *high < 128) {
            self.take(4)?;
            for plane in &mut row.0 {
                self.plane(plane)?;
            }
        } else {
            self.old_row(&mut row)?;
        }
        Ok(row)
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
    fn old_row(&mut self, row: &mut Row) -> Result<(), MapError> {
        let mut planes = row.0.each_mut().map(Vec::as_mut_slice);
        let (mut place, mut factor) = (0, 1usize);
        while place < self.width {
            let count = plain_texels(self.bytes, &mut planes, place);
            if count > 0 {
                self.take(4 * count)?;
                (place, factor) = (place + count, 1);
                continue;
            }
            let count = (self.take(4)?[3] as usize).saturating_mul(factor);
            factor = factor.saturating_mul(256);
            if place == 0 {
                return Err(self.malformed("a row begins with a run"));
            }
            if count > self.width - place {
                return Err(self.too_long());
            }
            for plane in &mut planes {
                let before = plane[place - 1];
                plane[place..place + count].fill(before);
            }
            place += count;
        }
        Ok(())
    }
}

/// Copies texels from `place` on, until a run, the end of the row or that of the bytes, and returns how many.
fn plain_texels(bytes: &[u8], [r, g, b, e]: &mut [&mut [u8]; 4], place: usize) -> usize {
    let (texels, _) = bytes.as_chunks::<4>();
    let (end, mut x) = (e.len().min(place + texels.len()), place);
    while x < end {
        let texel = &texels[x - place];
        if texel[0] == 1 && texel[1] == 1 && texel[2] == 1 {
            break;
        }
        (r[x], g[x], b[x], e[x]) = (texel[0], texel[1], texel[2], texel[3]);
        x += 1;
    }
    x - place
}

/// The beginning of a text that may be anything.
fn shortened(text: &str) -> String {
    text.chars().take(20).collect()
}
