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
    /// A batch has signals of no order that is compiled and has the kernel.
    Order {
        /// How many coefficients they have.
        count: usize,
    },
    /// A batch has not as many signals or parameters as results.
    Batch {
        /// How many there are.
        found: usize,
        /// How many results there is room for.
        results: usize,
    },
    /// The slices of a batch's channels are not of one length.
    Planes,
    /// The parameters of a batch have more or fewer numbers than the kernel takes.
    Parameters {
        /// How many each has.
        found: usize,
        /// How many the kernel takes.
        wanted: usize,
    },
    /// The results of a batch have other coefficients or channels than the kernel gives.
    Results {
        /// The coefficients and the channels that they have.
        found: [usize; 2],
        /// Those that the kernel gives.
        wanted: [usize; 2],
    },
    /// A row has no place for a signal's numbers.
    Stride {
        /// How many numbers a row has.
        stride: usize,
        /// How many the signal reaches over.
        width: usize,
    },
    /// A slice is not made of whole rows.
    Rows {
        /// How many numbers there are.
        numbers: usize,
        /// How many a row has.
        stride: usize,
        /// How many are too many.
        over: usize,
    },
    /// A row's signal has no numbers or channels, or too many.
    Row {
        /// Its coefficients a channel, 1 to 100.
        count: usize,
        /// Its channels, 1 to 4.
        channels: usize,
    },
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
            Self::Order { count } => {
                let order = count.isqrt();
                match order * order == count {
                    true => write!(
                        f,
                        "no such kernel of order {order} is there: orders are 2 to 10, of products 2 to 6, and each a feature \
                         of zonal, `order{order}`"
                    ),
                    false => write!(f, "{count} coefficients are no order: order n has n²"),
                }
            }
            Self::Batch { found, results } => write!(f, "{found} signals or parameters, but {results} results"),
            Self::Planes => write!(f, "the slices of the channels are not of one length"),
            Self::Parameters { found, wanted } => {
                write!(f, "parameters of {found} numbers each, but the kernel takes {wanted}")
            }
            Self::Results { found: [count, channels], wanted } => write!(
                f,
                "results of {count} numbers in {channels} channels, but there are {} in {}",
                wanted[0], wanted[1]
            ),
            Self::Stride { stride, width } => {
                write!(f, "a row of {stride} numbers, but its signal reaches over {width}")
            }
            Self::Rows { numbers, stride, over } => {
                write!(f, "{numbers} numbers are no whole rows of {stride}: {over} are left over")
            }
            Self::Row { count, channels } => write!(
                f,
                "a signal of {count} coefficients in {channels} channels, but a batch takes 1 to 100 in 1 to 4"
            ),
            Self::Axes(axes) => write!(f, "{axes:?} are not three different axes"),
        }
    }
}

impl core::error::Error for Error {}
