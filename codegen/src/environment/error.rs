//! Why a file is no environment map, and what to do about it.

use crate::fault::Fault;
use std::fmt;

/// The widest map that is read; its height is half of this.
pub const MAX_WIDTH: usize = 8192;

/// The largest file of a map that is read, in bytes: twice what 8192 × 4096 texels of four f32 take.
pub const MAX_BYTES: usize = 1 << 30;

/// Why a file is no environment map. As a [`Fault`] it names the file, what is wrong and what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// The file cannot be opened or read.
    Unreadable {
        /// The file.
        name: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// The content is in another format, whatever the file is called.
    Format {
        /// The file.
        name: String,
        /// What it holds, as far as its first bytes tell: "nothing", "a Png image", "unknown data".
        found: String,
    },
    /// The content is damaged, or uses a part of its format that is not supported.
    Malformed {
        /// The file.
        name: String,
        /// What the decoder says.
        message: String,
    },
    /// There are no texels.
    Empty {
        /// The file.
        name: String,
        /// The number of columns.
        width: usize,
        /// The number of rows.
        height: usize,
    },
    /// The map is not twice as wide as high.
    Shape {
        /// The file.
        name: String,
        /// The number of columns.
        width: usize,
        /// The number of rows.
        height: usize,
    },
    /// The map is wider than [`MAX_WIDTH`].
    TooLarge {
        /// The file.
        name: String,
        /// The number of columns.
        width: usize,
        /// The number of rows.
        height: usize,
    },
    /// Texels hold a NaN or an infinity.
    NotFinite {
        /// The file.
        name: String,
        /// How many texels have such a channel.
        count: usize,
        /// The column of the first one, from 0 at the left.
        x: usize,
        /// The row of the first one, from 0 at the top.
        y: usize,
        /// Its first such channel: a NaN or an infinity.
        value: f64,
    },
    /// Texels hold negative radiance.
    Negative {
        /// The file.
        name: String,
        /// How many texels have a negative channel.
        count: usize,
        /// The most negative channel of all texels.
        lowest: f64,
        /// The column of the first one, from 0 at the left.
        x: usize,
        /// The row of the first one, from 0 at the top.
        y: usize,
    },
    /// The map is in OpenEXR, and this crate was built without its feature `exr`.
    Unsupported {
        /// The file.
        name: String,
    },
    /// Every texel is zero, so that no error relative to the map exists.
    Black {
        /// The file.
        name: String,
    },
}

impl MapError {
    pub(super) fn malformed(name: &str, message: &str) -> Self {
        Self::Malformed { name: name.to_owned(), message: message.replace(char::is_control, " ") }
    }
}

impl From<&MapError> for Fault {
    fn from(error: &MapError) -> Self {
        use MapError::{
            Black, Empty, Format, Malformed, Negative, NotFinite, Shape, TooLarge, Unreadable, Unsupported,
        };
        match error {
            Unreadable { name, source } => {
                Self::new(format!("{name}: cannot be read ({source})"), "check the path and its permissions")
            }
            Format { name, found } => Self::new(
                format!("{name}: holds {found}, neither Radiance HDR nor OpenEXR"),
                "save the map as .hdr or .exr",
            ),
            Malformed { name, message } => {
                Self::new(format!("{name}: cannot be decoded ({message})"), "save or download the map again")
            }
            Unsupported { name } => Self::new(
                format!("{name}: is in OpenEXR, and zonal-codegen was built without its feature `exr`"),
                "write `features = [\"exr\"]` where you depend on zonal-codegen, or save the map as .hdr",
            ),
            Empty { name, width, height } => {
                Self::new(format!("{name}: is empty, {width}×{height} texels"), "save a map of at least 2×1 texels")
            }
            Shape { name, width, height } => Self::new(
                format!("{name}: is {width}×{height} texels, but a latitude-longitude map is twice as wide as high"),
                "convert it to that layout, uncropped",
            ),
            TooLarge { name, width, height } => Self::new(
                format!("{name}: is {width}×{height} texels, above the limit of {MAX_WIDTH} columns"),
                "reduce it (256×128 serves order 10) and save it again",
            ),
            NotFinite { name, count, x, y, value } => Self::new(
                format!("{name}: {count} of its texels are not finite, the first at column {x}, row {y} ({value})"),
                "replace them by radiance and save the map again",
            ),
            Negative { name, count, lowest, x, y } => Self::new(
                format!(
                    "{name}: {count} of its texels hold negative radiance, down to {lowest}, the first at column {x}, \
                     row {y}"
                ),
                "clamp the map to 0 and save it again",
            ),
            Black { name } => Self::new(format!("{name}: is black all over"), "check how it was exported"),
        }
    }
}

impl From<MapError> for Fault {
    fn from(error: MapError) -> Self {
        (&error).into()
    }
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Fault::from(self).fmt(f)
    }
}

/// Refuses what is not the size of a map.
pub(super) fn check_size(name: &str, width: usize, height: usize) -> Result<(), MapError> {
    let name = name.to_string();
    if width == 0 || height == 0 {
        Err(MapError::Empty { name, width, height })
    } else if Some(width) != height.checked_mul(2) {
        Err(MapError::Shape { name, width, height })
    } else if width > MAX_WIDTH {
        Err(MapError::TooLarge { name, width, height })
    } else {
        Ok(())
    }
}
