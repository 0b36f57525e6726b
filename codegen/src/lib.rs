//! Generates spherical-harmonics kernels as WGSL, GLSL and Rust from one source.
//!
//! A kernel is data: it is built once as a small expression graph with exact constants; the printers, the counter of
//! operations, the interpreter and the planner all read that graph.
//!
//! ```text
//! Scene ──plan──▶ Spec ──built──▶ Kernel ──lay out──▶ Listing ──emit──▶ File ──validate──▶ File
//! (what a scene   (which kernel,  (graph:             (operations       (text)             (naga, syn)
//!  needs: orders,  which method)   exact)              in order)
//!  error budget)                                        ├─▶ eval: the interpreter, f32 and f64
//!                                                       ├─▶ cost: mul, add, fma, special, constants, live values
//!                                                       └─▶ accuracy: rounding measured, method error computed
//! ```
//!
//! From a build script, start at [`builder::Builder`]; for one kernel's text, cost and error, at [`promise::built::Built`] and
//! [`emit::Module`].
//!
//! ```
//! use zonal_codegen::promise::built::Built;
//! use zonal_codegen::families::{Spec};
//!
//! let spec: Spec = "tilt:5".parse()?;
//! let built = Built::new(&spec);
//! assert_eq!(built.code.cost(1).total, 133);
//! # Ok::<(), zonal_codegen::families::SpecError>(())
//! ```
//!
//! # Features
//!
//! * `check`, a default: what is printed is parsed and validated, WGSL and GLSL by naga, Rust by syn, and what they refuse
//!   is an error. Without it **nothing is parsed**: a text is returned and written as it was printed. zonal's own tests have
//!   checked every kernel of the catalogue, but not your names, orders and mixtures in it; the compilers that read the files
//!   do. A build script then compiles 23 crates instead of 47, in about half of the time.
//! * `exr`: environment maps in OpenEXR; `png`: in PNG. Radiance HDR needs no feature.
//!
//! Convention everywhere: real orthonormal harmonics with the Condon-Shortley phase (band 1 is −y, z, −x), index
//! l(l+1)+m; order n is the bands 0 to n − 1, n² coefficients; a rotation R takes c to D(R) c with y(Rω) = D(R) y(ω).

pub mod builder;
pub mod catalog;
pub mod emit;
pub mod environment;
pub mod families;
pub mod fault;
pub mod files;
pub mod generate;
pub mod input;
pub mod ir;
pub mod math;
pub mod plan;
pub mod promise;
pub mod reflectance;
pub mod scene;
mod threads;
