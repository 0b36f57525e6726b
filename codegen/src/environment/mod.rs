//! Environment maps: reads a latitude-longitude image, projects it on spherical harmonics and tells what each order
//! leaves out. It knows nothing of kernels.
//!
//! # Directions
//!
//! The polar axis of the harmonics, +z, is up: the top row of the map surrounds +z, the bottom row −z. Seen from
//! inside, the centre of the map lies along +x, columns to the right of it turn towards −y (so a quarter of the width
//! right of the centre is −y, a quarter left of it +y), and the left and right edges meet at −x. Blender places an
//! environment texture so. [`crate::math::convention`] takes coefficients into the frames of others and back.
//!
//! # Quadrature
//!
//! A texel is one radiance over the whole of its solid angle. The harmonics are integrated over each texel, exactly
//! but for rounding, so that a projection is the least-squares fit of the map, band energies obey Parseval's identity
//! whatever the size of the map, and rounding is all that separates a uniform map from a single coefficient.
//! (Sampling the harmonics at the centres of texels would change order 10 of a 256×128 map by about 1e-3 in rms.)
//! docs/MATH.md#projection-of-maps has the integrals.

pub mod error;
pub mod lamps;
pub mod map;
mod openexr;
pub mod project;
mod radiance;
pub mod ringing;
pub mod spectrum;
#[cfg(test)]
mod tests;
mod waves;

pub use error::{MAX_BYTES, MAX_WIDTH, MapError};
pub use map::Map;
pub use lamps::Lamps;
pub use project::{Projection, Survey};
pub use ringing::Negative;
pub use spectrum::{Parts, Spectrum, Weights, cosine_lobe};
