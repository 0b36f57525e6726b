//! Files that become a map: which format they are in by their content, how the image in them is laid out, and what a person is
//! told of both.

use super::decoded::Decoded;
use super::error::{MAX_BYTES, MapError};
use super::layout::{Expected, Layout, check_size};
use super::map::Map;
use super::openexr;
use super::png;
use super::radiance::Radiance;
use super::six;
use crate::input;
use std::fmt;
use std::path::Path;

/// A map with what its files said of themselves.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The map.
    pub map: Map,
    /// The columns and the rows of the image, or of each of six.
    pub size: [usize; 2],
    /// How the image is laid out.
    pub layout: Layout,
    /// What the radiance was decoded from, in words: `Radiance HDR`, `PNG of 16 bits, decoded from sRGB`.
    pub encoding: String,
}

/// As in `1024 × 512, latitude and longitude, Radiance HDR`.
impl fmt::Display for Loaded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} × {}, {}, {}", self.size[0], self.size[1], self.layout, self.encoding)
    }
}

impl Loaded {
    /// Reads a map from a file, in any format and layout by its content, whatever its extension; or from six files, a face
    /// each: the folder that holds them alone, or their common name with `*` for what tells them apart, as in
    /// `sky/day_*.png`.
    ///
    /// # Errors
    ///
    /// If a file cannot be read, is no regular file or larger than [`MAX_BYTES`], six cannot be told apart by their names,
    /// or for any reason of [`Loaded::from_bytes`].
    pub fn read(path: &Path) -> Result<Self, MapError> {
        match single(path)? {
            Some((name, bytes)) => Self::from_bytes(&name, &bytes),
            None => {
                let paths = six::find(path)?;
                let read = |path: &Path| match single(path)? {
                    Some(file) => Ok(file),
                    None => Err(MapError::Unreadable {
                        name: path.display().to_string(),
                        source: std::io::ErrorKind::IsADirectory.into(),
                    }),
                };
                let files = paths.iter().map(|path| read(path)).collect::<Result<Vec<_>, MapError>>()?;
                Self::of_faces(&path.display().to_string(), &files)
            }
        }
    }

    /// Reads a map from the bytes of a file. `name` is what errors call it.
    ///
    /// # Errors
    ///
    /// If the format is another one, the bytes are damaged, the image has none of the layouts or is too large, or a texel is
    /// not finite or negative, or all are zero.
    ///
    /// No bytes make it panic.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, MapError> {
        let Decoded { width, height, texels, encoding } = decoded(name, bytes, Expected::Whole)?;
        let size = [width, height];
        let Some(layout) = Layout::of(width, height) else {
            return Err(MapError::Shape { name: name.to_owned(), width, height, is_face: false });
        };
        let map = match layout {
            Layout::LatitudeLongitude => Map { width, height, texels },
            _ => {
                let texels = layout.faces(width, &texels);
                let side = (texels.len() / 6).isqrt();
                Map { width: side, height: 6 * side, texels }
            }
        };
        Ok(Self { map: map.checked(name)?, size, layout, encoding })
    }

    /// Reads a map from the bytes of one file, or of six that are told apart by their names: what a person has dropped
    /// somewhere.
    ///
    /// # Errors
    ///
    /// If there is another number of files, or as [`Loaded::read`].
    pub fn from_files(files: &[(String, Vec<u8>)]) -> Result<Self, MapError> {
        if let [(name, bytes)] = files {
            return Self::from_bytes(name, bytes);
        }
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        let order = six::order("the files", &names)?;
        let sorted: Vec<(String, Vec<u8>)> = order.iter().map(|&i| files[i].clone()).collect();
        Self::of_faces(&six::common(&names), &sorted)
    }

    /// Six images in the order of the faces.
    fn of_faces(name: &str, files: &[(String, Vec<u8>)]) -> Result<Self, MapError> {
        let mut all: Option<Decoded> = None;
        for (name, bytes) in files {
            let image = decoded(name, bytes, Expected::Face)?;
            match &mut all {
                None => all = Some(image),
                Some(first) if first.width != image.width => {
                    let message =
                        format!("is {0}×{0} texels, and the face before it {1}×{1}", image.width, first.width);
                    return Err(MapError::refused(name, message, "save all six faces at one size"));
                }
                Some(first) => first.texels.extend(image.texels),
            }
        }
        let Some(Decoded { width, texels, encoding, .. }) = all else {
            return Err(MapError::refused(name, "has no faces", "name six files"));
        };
        let map = Map { width, height: 6 * width, texels }.checked(name)?;
        Ok(Self { map, size: [width, width], layout: Layout::SixFiles, encoding })
    }
}

impl Map {
    /// [`Loaded::read`] without what the files say of themselves.
    ///
    /// # Errors
    ///
    /// As [`Loaded::read`].
    pub fn read(path: &Path) -> Result<Self, MapError> {
        Loaded::read(path).map(|loaded| loaded.map)
    }

    /// [`Loaded::from_bytes`] without what the file says of itself.
    ///
    /// # Errors
    ///
    /// As [`Loaded::from_bytes`].
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, MapError> {
        Loaded::from_bytes(name, bytes).map(|loaded| loaded.map)
    }
}

/// The name and the bytes of a file; nothing if the path names six.
pub(super) fn single(path: &Path) -> Result<Option<(String, Vec<u8>)>, MapError> {
    let name = path.display().to_string();
    if path.is_dir() || (six::is_pattern(path) && !path.exists()) {
        return Ok(None);
    }
    match input::read(path, MAX_BYTES) {
        Ok(bytes) => Ok(Some((name, bytes))),
        Err(source) => Err(MapError::Unreadable { name, source }),
    }
}

/// The formats of maps.
pub(super) enum Format {
    Radiance,
    OpenExr,
    Png,
}

/// Other formats by their first bytes, of which 0 stands for any, with what to do about them.
const OTHERS: [(&[u8], &str, &str); 13] = [
    (b"\xff\xd8\xff", "Jpeg", CLIPPED),
    (b"GIF8", "Gif", CLIPPED),
    (b"RIFF\0\0\0\0WEBP", "WebP", CLIPPED),
    (b"\0\0\0\0ftypavif", "Avif", CLIPPED),
    (b"BM", "Bmp", CLIPPED),
    (b"qoif", "Qoi", CLIPPED),
    (b"P\0\n", "Pnm", CLIPPED),
    (b"farbfeld", "Farbfeld", CLIPPED),
    (b"MM\0*", "Tiff", SAVE),
    (b"II*", "Tiff", SAVE),
    (b"DDS ", "Dds", "save its faces as six files, .hdr, .exr or .png"),
    (b"\xabKTX", "Ktx", "save its faces as six files, .hdr, .exr or .png"),
    (b"PF\n", "Pfm", SAVE),
];
const SAVE: &str = "save the map as .hdr or .exr, or as .png of 16 bits";
const CLIPPED: &str = "such an image holds nothing brighter than white, so that its lights are cut off: take the map as .hdr or \
                       .exr; or save it as .png if that does not matter";

/// The format of a file by its content.
pub(super) fn format(name: &str, bytes: &[u8]) -> Result<Format, MapError> {
    let starts = |magic: &[u8]| bytes.len() >= magic.len() && magic.iter().zip(bytes).all(|(m, b)| *m == 0 || m == b);
    let (found, help) = match OTHERS.iter().find(|(magic, ..)| starts(magic)) {
        _ if bytes.starts_with(b"#?") => return Ok(Format::Radiance),
        _ if bytes.starts_with(&openexr::MAGIC) => return Ok(Format::OpenExr),
        _ if bytes.starts_with(&png::MAGIC) => return Ok(Format::Png),
        _ if bytes.is_empty() => ("nothing".to_owned(), SAVE),
        Some((_, format, help)) => (format!("a {format} image"), *help),
        None => ("unknown data".to_owned(), SAVE),
    };
    Err(MapError::Format { name: name.to_owned(), found, help })
}

/// The image that a file holds; its size is one that is expected.
fn decoded(name: &str, bytes: &[u8], expected: Expected) -> Result<Decoded, MapError> {
    match format(name, bytes)? {
        Format::Radiance => Radiance::new(name, bytes, expected)?.image(),
        Format::OpenExr => openexr::read(name, bytes, &|width, height| check_size(name, width, height, expected)),
        Format::Png => png::read(name, bytes, &|width, height| check_size(name, width, height, expected)),
    }
}
