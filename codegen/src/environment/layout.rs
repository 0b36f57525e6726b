//! How an image holds what surrounds a point: as latitude and longitude, or as the six faces of a cube in a strip, a cross or
//! six files. Where each face is, and how it is brought into the one order in which a [`Map`](super::Map) holds them.

use super::error::{MAX_SIDE, MAX_WIDTH, MapError};
use std::fmt;

/// The faces in the order of OpenGL, Direct3D and three.js, by the axes of their y-up frame.
pub const FACES: [&str; 6] = ["+x", "-x", "+y", "-y", "+z", "-z"];

/// How an image is laid out. Of a cubemap every face is seen from inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Latitude and longitude, twice as wide as high.
    LatitudeLongitude,
    /// Six faces from left to right: +x −x +y −y +z −z.
    HorizontalStrip,
    /// Six faces from top to bottom, in the same order.
    VerticalStrip,
    /// Four faces beside each other, −x +z +x −z, with +y above +z and −y below it.
    HorizontalCross,
    /// +y; then −x +z +x beside each other; below +z come −y, and −z turned by half a turn.
    VerticalCross,
    /// A file a face.
    SixFiles,
}

/// What an image may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Expected {
    /// All of a map.
    Whole,
    /// One face of a cube.
    Face,
}

impl Layout {
    /// The layouts that one image has.
    const OF_IMAGES: [Self; 5] = [
        Self::LatitudeLongitude,
        Self::HorizontalStrip,
        Self::VerticalStrip,
        Self::HorizontalCross,
        Self::VerticalCross,
    ];

    /// How many squares it is wide and high.
    fn squares(self) -> [usize; 2] {
        match self {
            Self::LatitudeLongitude => [2, 1],
            Self::HorizontalStrip => [6, 1],
            Self::VerticalStrip => [1, 6],
            Self::HorizontalCross => [4, 3],
            Self::VerticalCross => [3, 4],
            Self::SixFiles => [1, 1],
        }
    }

    /// The layout of an image by its proportions.
    pub(super) fn of(width: usize, height: usize) -> Option<Self> {
        let is = |layout: &Self| {
            let [across, down] = layout.squares();
            width.is_multiple_of(across) && width / across * down == height
        };
        Self::OF_IMAGES.into_iter().find(is)
    }

    /// The square in which a face lies, by column and row, and whether it is turned by half a turn.
    fn place(self, face: usize) -> ([usize; 2], bool) {
        const HORIZONTAL: [[usize; 2]; 6] = [[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [3, 1]];
        const VERTICAL: [[usize; 2]; 6] = [[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [1, 3]];
        match self {
            Self::HorizontalStrip => ([face, 0], false),
            Self::HorizontalCross => (HORIZONTAL[face], false),
            Self::VerticalCross => (VERTICAL[face], face == 5),
            Self::LatitudeLongitude | Self::VerticalStrip | Self::SixFiles => ([0, face], false),
        }
    }

    /// The six faces of an image, one below the other.
    pub(super) fn faces(self, width: usize, texels: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let side = width / self.squares()[0];
        let mut faces = Vec::with_capacity(6 * side * side);
        for face in 0..6 {
            let ([column, row], is_turned) = self.place(face);
            for y in 0..side {
                let y = row * side + if is_turned { side - 1 - y } else { y };
                let part = &texels[y * width + column * side..][..side];
                match is_turned {
                    false => faces.extend_from_slice(part),
                    true => faces.extend(part.iter().rev()),
                }
            }
        }
        faces
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::LatitudeLongitude => "latitude and longitude",
            Self::HorizontalStrip => "a cubemap as a horizontal strip",
            Self::VerticalStrip => "a cubemap as a vertical strip",
            Self::HorizontalCross => "a cubemap as a horizontal cross",
            Self::VerticalCross => "a cubemap as a vertical cross",
            Self::SixFiles => "a cubemap in six files",
        })
    }
}

/// Refuses what is not the size of a map, or of a face.
pub(super) fn check_size(name: &str, width: usize, height: usize, expected: Expected) -> Result<(), MapError> {
    let name = name.to_string();
    let layout = match expected {
        Expected::Whole => Layout::of(width, height),
        Expected::Face => (width == height).then_some(Layout::SixFiles),
    };
    match layout {
        _ if width == 0 || height == 0 => Err(MapError::Empty { name, width, height }),
        None => Err(MapError::Shape { name, width, height, is_face: expected == Expected::Face }),
        Some(Layout::LatitudeLongitude) if width > MAX_WIDTH => Err(MapError::TooLarge { name, width, height }),
        Some(layout) if layout != Layout::LatitudeLongitude && width / layout.squares()[0] > MAX_SIDE => {
            Err(MapError::TooLarge { name, width, height })
        }
        Some(_) => Ok(()),
    }
}
