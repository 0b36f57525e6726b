//! Environment maps: reads an image of what surrounds a point, as latitude and longitude or as a cube, projects it on
//! spherical harmonics and tells what each order leaves out. It knows nothing of kernels.
//!
//! # Directions
//!
//! The polar axis of the harmonics, +z, is up: the top row of the map surrounds +z, the bottom row −z. Seen from
//! inside, the centre of the map lies along +x, columns to the right of it turn towards −y (so a quarter of the width
//! right of the centre is −y, a quarter left of it +y), and the left and right edges meet at −x. Blender places an
//! environment texture so. [`crate::math::convention`] takes coefficients into the frames of others and back.
//!
//! A cubemap's faces are named and turned as in OpenGL, Direct3D and Vulkan: six images, each seen from inside, of a
//! left-handed frame with y up, in the order +x −x +y −y +z −z. Its +x looks along zonal's +x, its +y up along zonal's +z,
//! its +z along zonal's +y; the image of +x has −z to its right, that of +z has +x, and the lower edge of +y is the upper
//! edge of +z. So a cubemap that a program in such a frame (`unity`, `directxmath`) makes of a latitude-longitude map has the
//! same coefficients as that map. three.js mirrors the x of a `CubeTexture`: for its world the axes are `-x,z,y`.
//!
//! # Quadrature
//!
//! A texel is one radiance over the whole of its solid angle. The harmonics are integrated over each texel, exactly
//! but for rounding, so that a projection is the least-squares fit of the map, band energies obey Parseval's identity
//! whatever the size of the map, and rounding is all that separates a uniform map from a single coefficient.
//! (Sampling the harmonics at the centres of texels would change order 10 of a 256×128 map by about 1e-3 in rms.)
//! docs/MATH.md#projection-of-maps has the integrals.

pub mod bands;
mod cube;
pub(crate) mod decoded;
pub mod error;
pub mod harmonics;
pub mod lamps;
pub mod layout;
pub mod loaded;
pub mod map;
pub(crate) mod openexr;
mod png;
pub mod project;
mod radiance;
pub mod ringing;
mod six;
pub mod spectrum;
#[cfg(test)]
mod tests;
mod waves;

pub use bands::{BandTable, Texel};
pub use error::{MAX_BYTES, MAX_SIDE, MAX_WIDTH, MapError};
pub use harmonics::cosine_lobe;
pub use lamps::Lamps;
pub use layout::{FACES, Layout};
pub use loaded::Loaded;
pub use map::Map;
pub use project::{Projection, Survey};
pub use ringing::Negative;
pub use spectrum::{Parts, Spectrum, Weights};
