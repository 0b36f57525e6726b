//! Why a file is no environment map, and what to do about it.

use crate::fault::Fault;
use std::fmt;

/// The widest latitude-longitude map that is read; its height is half of this.
pub const MAX_WIDTH: usize = 8192;

/// The largest side of a cubemap's face that is read.
pub const MAX_SIDE: usize = 2048;

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
        /// What it holds, as far as its first bytes tell: "nothing", "a Jpeg image", "unknown data".
        found: String,
        /// What to do about it.
        help: &'static str,
    },
    /// The content is damaged.
    Malformed {
        /// The file.
        name: String,
        /// What the decoder says.
        message: String,
    },
    /// The content is sound, but of a kind that is not read; or several files do not make a cube.
    Refused {
        /// The file, or what several are called together.
        name: String,
        /// What it is.
        message: String,
        /// What to do about it.
        help: String,
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
    /// The image has the proportions of no layout.
    Shape {
        /// The file.
        name: String,
        /// The number of columns.
        width: usize,
        /// The number of rows.
        height: usize,
        /// Whether it is one of six files, which have to be square.
        is_face: bool,
    },
    /// The map is wider than [`MAX_WIDTH`], or its faces than [`MAX_SIDE`].
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
        /// The column of the first one, from 0 at the left of the map or of the face that `name` tells.
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
    /// The map is in a format for which this crate was built without the feature.
    Unsupported {
        /// The file.
        name: String,
        /// The format.
        format: &'static str,
        /// The feature.
        feature: &'static str,
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

    pub(crate) fn refused(name: &str, message: impl Into<String>, help: impl Into<String>) -> Self {
        let message = message.into().replace(char::is_control, " ");
        Self::Refused { name: name.to_owned(), message, help: help.into() }
    }
}

impl From<&MapError> for Fault {
    fn from(error: &MapError) -> Self {
        use MapError::{
            Black, Empty, Format, Malformed, Negative, NotFinite, Refused, Shape, TooLarge, Unreadable, Unsupported,
        };
        match error {
            Unreadable { name, source } => {
                Self::new(format!("{name}: cannot be read ({source})"), "check the path and its permissions")
            }
            Format { name, found, help } => {
                Self::new(format!("{name}: holds {found}, neither Radiance HDR nor OpenEXR nor PNG"), *help)
            }
            Refused { name, message, help } => Self::new(format!("{name}: {message}"), help.as_str()),
            Malformed { name, message } => {
                Self::new(format!("{name}: cannot be decoded ({message})"), "save or download the map again")
            }
            Unsupported { name, format, feature } => Self::new(
                format!("{name}: is in {format}, and zonal-codegen was built without its feature `{feature}`"),
                format!(
                    "write `features = [\"{feature}\"]` where you depend on zonal-codegen, or save the map as .hdr"
                ),
            ),
            Empty { name, width, height } => {
                Self::new(format!("{name}: is empty, {width}×{height} texels"), "save a map of at least 2×1 texels")
            }
            Shape { name, width, height, is_face: true } => Self::new(
                format!("{name}: is {width}×{height} texels, but a face of a cube is square"),
                "crop nothing: save each of the six faces as a square of the same size",
            ),
            Shape { name, width, height, is_face: false } => Self::new(
                format!("{name}: is {width}×{height} texels, the size of no map"),
                match width == height {
                    true => {
                        "a map is twice as wide as high, or a cubemap in a strip (6:1, 1:6) or a cross (4:3, 3:4); \
                             if this is one of six faces, name the folder that holds them all"
                    }
                    false => {
                        "convert it to latitude and longitude, twice as wide as high and uncropped, or to a cubemap in \
                              a strip (6:1, 1:6) or a cross (4:3, 3:4)"
                    }
                },
            ),
            TooLarge { name, width, height } => Self::new(
                match *width == 2 * *height {
                    true => format!("{name}: is {width}×{height} texels, above the limit of {MAX_WIDTH} columns"),
                    false => {
                        format!("{name}: is {width}×{height} texels, above the limit of {MAX_SIDE} for a face's side")
                    }
                },
                "reduce it and save it again: 256×128 texels, or faces of 64×64, serve order 10",
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
