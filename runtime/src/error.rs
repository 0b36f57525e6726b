//! What may be wrong with what is handed over, and the sizes that it has.

use core::fmt;

use zonal_kernels::conventions::Axis;

/// Why something is refused. What is displayed says the sizes that were found and those that were wanted.
///
/// ```
/// use zonal::Coefficients;
///
/// let error = <[[f32; 3]; 9]>::from_numbers(&[0.0; 25]).unwrap_err();
/// assert_eq!(error.to_string(), "25 numbers, but order 3 in RGB is 9 of 3, which makes 27");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// A slice of coefficients is longer or shorter than the order.
    Coefficients {
        /// How many there are.
        found: usize,
        /// The order n, of n² coefficients.
        order: usize,
    },
    /// A slice of numbers is longer or shorter than the order and its channels.
    Numbers {
        /// How many there are.
        found: usize,
        /// The order n, of n² coefficients.
        order: usize,
        /// The numbers of a coefficient.
        channels: usize,
    },
    /// An image has not as many texels as its sizes say, or none.
    Image {
        /// How many there are.
        found: usize,
        /// The columns.
        width: usize,
        /// The rows.
        height: usize,
    },
    /// A face of a cubemap has not as many texels as its size says, or none.
    Face {
        /// The face, from 0 to 5.
        face: usize,
        /// How many texels there are.
        found: usize,
        /// The columns, and the rows.
        size: usize,
    },
    /// There are more or fewer results than frames of which they are made.
    Frames {
        /// How many frames there are.
        frames: usize,
        /// How many results there is room for.
        results: usize,
    },
    /// A convention has no place for bands as high.
    Bands {
        /// The name of the convention.
        convention: &'static str,
        /// The most bands that it takes.
        most: usize,
        /// The order that it was asked to take.
        order: usize,
    },
    /// Axes that are not three different ones.
    Axes([Axis; 3]),
}

/// How many channels, in words before which *order n* stands.
fn in_channels(channels: usize) -> &'static str {
    match channels {
        1 => " in one channel",
        3 => " in RGB",
        _ => "",
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Coefficients { found, order } => {
                write!(f, "{found} coefficients, but order {order} is {}", order * order)
            }
            Self::Numbers { found, order, channels } => {
                let (count, words) = (order * order, in_channels(channels));
                write!(
                    f,
                    "{found} numbers, but order {order}{words} is {count} of {channels}, which makes {}",
                    count * channels
                )
            }
            Self::Image { found, width, height } if width == 0 || height == 0 => {
                write!(f, "an image of {width} × {height} has no texels, but {found} were given")
            }
            Self::Image { found, width, height } => {
                let texels = width.saturating_mul(height);
                write!(f, "{found} texels, but an image of {width} × {height} has {texels}")
            }
            Self::Face { face, size: 0, .. } => write!(f, "face {face} of a cubemap of size 0 has no texels"),
            Self::Face { face, found, size } => {
                let texels = size.saturating_mul(size);
                write!(f, "{found} texels in face {face}, but a cubemap of size {size} has {texels} in each")
            }
            Self::Frames { frames, results } => write!(f, "{frames} frames, but room for {results} results"),
            Self::Bands { convention, most, order } => {
                write!(f, "`{convention}` takes {most} bands, not {order}; `zonal::resize` leaves the others out")
            }
            Self::Axes(axes) => write!(f, "{axes:?} are not three different axes"),
        }
    }
}

impl core::error::Error for Error {}
