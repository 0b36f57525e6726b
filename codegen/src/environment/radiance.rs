//! Radiance HDR, scan line by scan line: each texel is three mantissas and one exponent of eight bits, whose rows are run-length
//! encoded, byte by byte or, before 1991, texel by texel. Ward's format as `image` and Radiance's own tools read it; a
//! header's exposure is left alone. Loops over texels are plain ones over slices, since a build script compiles them
//! without optimisation: an iterator or an index of a vector costs several calls a texel there.

use super::decoded::Decoded;
use super::error::MapError;
use super::layout::{Expected, check_size};

/// An image, scan line by scan line.
pub(super) struct Radiance<'a> {
    name: &'a str,
    /// What is left of the file.
    bytes: &'a [u8],
    /// The number of columns.
    pub width: usize,
    /// The number of rows.
    pub height: usize,
    orientation: Orientation,
}

/// In which order the texels stand in the file, as its size line says: `-Y 8 +X 16` for rows from the top, each from the
/// left, which nearly all have.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Orientation {
    /// Whether scan lines are columns: the line names X first.
    by_columns: bool,
    /// Whether texels run from right to left: `-X`.
    from_right: bool,
    /// Whether texels run from the bottom to the top: `+Y`.
    from_bottom: bool,
}

const UPRIGHT: Orientation = Orientation { by_columns: false, from_right: false, from_bottom: false };

impl Orientation {
    /// What a size line says, with the numbers of columns and rows.
    fn read(line: &str) -> Option<(Self, usize, usize)> {
        let number = |text: &str| text.parse::<u32>().ok().map(|number| number as usize);
        let &[first, long, second, wide, ..] = &line.split_whitespace().collect::<Vec<_>>()[..] else { return None };
        let (by_columns, [y, x], [height, width]) = match (first.get(1..)?, second.get(1..)?) {
            ("Y", "X") => (false, [first, second], [long, wide]),
            ("X", "Y") => (true, [second, first], [wide, long]),
            _ => return None,
        };
        let is_positive = |text: &str| match text.as_bytes()[0] {
            b'+' => Some(true),
            b'-' => Some(false),
            _ => None,
        };
        let orientation = Self { by_columns, from_right: !is_positive(x)?, from_bottom: is_positive(y)? };
        Some((orientation, number(width)?, number(height)?))
    }
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

/// A scan line as it is stored: the mantissas of R, G and B, and the exponents.
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
    /// If it is none, or the size is none that is expected.
    pub fn new(name: &'a str, bytes: &'a [u8], expected: Expected) -> Result<Self, MapError> {
        let mut image = Self { name, bytes, width: 0, height: 0, orientation: UPRIGHT };
        loop {
            let line = image.line()?;
            match line.split_once('=') {
                _ if line.is_empty() => break,
                Some((key, format)) if key.trim() == "FORMAT" && format.trim() == "32-bit_rle_xyze" => {
                    let help = "convert it with Radiance's `ra_xyze -r`, or save it as RGB";
                    return Err(MapError::refused(name, "holds XYZ colours, not RGB", help));
                }
                Some((key, format)) if key.trim() == "FORMAT" && format.trim() != "32-bit_rle_rgbe" => {
                    return Err(image.malformed(&format!("the format {} is not supported", shortened(format.trim()))));
                }
                // Comments, commands and other attributes.
                _ => {}
            }
        }
        let size = image.line()?;
        let (orientation, width, height) = Orientation::read(&size).ok_or_else(|| {
            image.malformed(&format!("its size is no `-Y HEIGHT +X WIDTH` or the like, but `{}`", shortened(&size)))
        })?;
        check_size(name, width, height, expected)?;
        (image.width, image.height, image.orientation) = (width, height, orientation);
        Ok(image)
    }

    /// Whether scan lines are the rows from the top, each from the left.
    pub fn is_upright(&self) -> bool {
        self.orientation == UPRIGHT
    }

    /// How many texels a scan line has.
    fn length(&self) -> usize {
        if self.orientation.by_columns { self.height } else { self.width }
    }

    /// The whole image, upright.
    ///
    /// # Errors
    ///
    /// As [`Radiance::row`].
    pub fn image(mut self) -> Result<Decoded, MapError> {
        let (width, height, length) = (self.width, self.height, self.length());
        let Orientation { by_columns, from_right, from_bottom } = self.orientation;
        let flipped = |flip: bool, i: usize, side: usize| if flip { side - 1 - i } else { i };
        let mut texels = Vec::with_capacity(width * height);
        let mut planes: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; length]);
        if !self.is_upright() {
            texels.resize(width * height, [0.0; 3]);
        }
        for line in 0..width * height / length {
            self.row()?.read(planes.each_mut().map(Vec::as_mut_slice));
            let [red, green, blue] = planes.each_ref().map(Vec::as_slice);
            let mut i = 0;
            while i < length {
                let texel = [red[i], green[i], blue[i]];
                if self.orientation == UPRIGHT {
                    texels.push(texel);
                } else {
                    let (x, y) = if by_columns { (line, i) } else { (i, line) };
                    texels[flipped(from_bottom, y, height) * width + flipped(from_right, x, width)] = texel;
                }
                i += 1;
            }
        }
        Ok(Decoded { width, height, texels, encoding: "Radiance HDR".to_owned() })
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

    /// The next scan line.
    ///
    /// # Errors
    ///
    /// If the file ends in it, or it is longer than the header says.
    pub fn row(&mut self) -> Result<Row, MapError> {
        let mut row = Row(std::array::from_fn(|_| vec![0; self.length()]));
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
        self.malformed(&format!("a row has more than {} texels", self.length()))
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
        let length = self.length();
        while place < length {
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
            if count > length - place {
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
