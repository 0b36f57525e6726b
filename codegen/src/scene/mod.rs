//! A scene: what a renderer needs, as a TOML manifest. It says which kernels, or which rotations within which error, and
//! which environment map, for which languages; [`crate::plan`] decides what that comes to. Every value keeps its place
//! in the text, so that whatever is wrong with it is shown where it stands.
//!
//! ```toml
//! name = "glossy"
//!
//! [environment]                       # a map's coefficients as constants
//! map = "maps/city_256x128.hdr"       # beside the scene file
//! signal = "radiance"
//! budget = 0.05
//!
//! [[kernel]]
//! spec = "eval:environment:rgb"       # `environment` is the order that the map was found to need
//!
//! [[rotation]]                        # an error budget instead of a method
//! kind = "tilt"
//! order = "environment"
//! max_angle = 15
//! max_error = 0.05
//! ```
//!
//! `docs/SCENE.md` has every key, and `zonal init` writes a scene that holds them all; both follow from the types in
//! `manifest` and [`picture`], which the function `schema` behind the feature of that name prints.

pub mod budget;
pub mod diagnostic;
pub mod frame;
pub mod located;
mod manifest;
pub mod picture;
pub mod sphere;
pub mod wanted;
#[cfg(feature = "schema")]
mod words;

pub use crate::families::family::Job;
pub use budget::{Hemisphere, Norm, Precision, RelativeTo};
pub use located::{Located, Order};
pub(crate) use manifest::form;
#[cfg(feature = "schema")]
pub use manifest::schema;
pub use sphere::SphereLight;
pub use wanted::{Environment, Light, Maps, Rotation, Scene, Wanted};
