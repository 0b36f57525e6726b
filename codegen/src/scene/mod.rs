//! A scene: what a renderer needs, as a TOML manifest. It says which kernels, or which rotations within which error, and
//! which environment map, for which languages; [`crate::plan`] decides what that comes to. Every value keeps its place
//! in the text, so that whatever is wrong with it is shown where it stands.
//!
//! ```toml
//! name = "glossy"                     # the stem of the files
//! targets = ["wgsl", "glsl", "rust"]  # all three if left out
//! arrays = "value"                    # if left out; or "struct" or "reference": how kernels take and return arrays, for
//!                                     # languages that know more than one way, which is GLSL alone
//! output = "zonal-out/glossy"         # this if left out; below the folder that zonal runs in
//!
//! [environment]                       # optional: a map's coefficients as constants
//! map = "maps/city_256x128.hdr"       # beside the scene file: .hdr, .exr or .png, latitude and longitude or a cubemap; or
//!                                     # six faces, "sky" for their folder or "sky/day_*.png"
//! signal = "radiance"                 # or "irradiance"
//! max_order = 5                       # 10 if left out
//! budget = 0.05                       # the relative rms error of what is seen that leaving bands out may cost: of what the
//!                                     # [brdf] reflects, over all normals and views; of irradiance, over all normals; or of
//!                                     # the light itself
//! relative_to = "all_bands"           # if left out; or "max_order": to what is seen of the bands below max_order alone
//! name = "city"                       # the constants are called CITY
//! axes = "three_js"                   # optional: whose axes the coefficients are in; or three axes of yours, to the map's
//!                                     # centre, to the left of it and up, as in "x,-z,y"; zonal's if left out: z is up,
//!                                     # the centre along +x, -y to its right. A picture's mesh is in these axes too
//! convention = "zonal"                # this if left out; or a program that takes the coefficients, for its axes, signs and
//!                                     # factors: docs/ENGINES.md has the names
//!
//! [[kernel]]
//! spec = "eval:environment:rgb"       # `environment` is the order that the map was found to need
//! name = "shade"                      # optional, a name of your own
//! max_angle = 15                      # optional, in degrees: the method must take it
//!
//! [[rotation]]                        # an error budget instead of a method
//! kind = "tilt"                       # z to a normal; or "y", about y by an angle; or "zyz", any three angles; or
//!                                     # "quaternion", any rotation whose y angle is bounded
//! order = "environment"               # or a number
//! max_angle = 15                      # the largest tilt, or angle about y, in degrees
//! max_error = 0.05                    # of a band's norm, the worst band
//! norm = "max"                        # the worst signal's error, if left out; or "mean", a random one's; or "signal",
//!                                     # that of the environment's energies, against all of it
//! precision = "f32"                   # if left out; or "f16" (WGSL alone), or "auto": f16 where the error allows it
//! rgb = true
//! signals = 1                         # if left out; how many such signals each rotation turns: with more, a kernel may
//!                                     # be chosen that does the set-up of a `quaternion` once for all of them
//! name = "bump"                       # optional
//!
//! [brdf]                              # what the surface reflects; it decides what is required of the environment
//! kind = "ward"                       # or "phong" with an `exponent`, or "lambert" alone
//! alpha = [0.2, 0.6]                  # the roughness along the tangent and across it, or one number
//!
//! [picture]                           # for who draws the scene: `zonal-render`
//! mesh = "meshes/teapot.obj"          # beside the scene file; or "sphere" or "plane"
//! normals = "normals/0003.webp"       # optional
//! strength = 1.0                      # of the normal map: a factor for its slopes; this if left out
//! size = [960, 540]                   # this if left out
//! method = "tilt"                     # if left out, what was chosen for the first rotation of the kind "tilt"
//! order = 5                           # if left out, the environment's
//! azimuth = 0                         # of the camera, which looks at the middle of the object, in degrees
//! elevation = 15                      # in degrees
//! distance = 4                        # in radii of the object
//! field = 30                          # of view from bottom to top, in degrees
//! exposure = 0                        # in stops
//! ```

pub mod budget;
pub mod diagnostic;
pub mod frame;
pub mod located;
mod manifest;
pub mod picture;
pub mod wanted;

pub use crate::families::family::Job;
pub use budget::{Norm, Precision, RelativeTo};
pub use located::{Located, Order};
pub use wanted::{Environment, Light, Maps, Rotation, Scene, Wanted};
