//! Draws the pictures of scenes: with the kernels that zonal generates for shaders, on any adapter that wgpu finds, and
//! by brute force on the CPU, so that the former are seen to approach the latter.
//!
//! ```text
//! Scene ─▶ Subject ─▶ Stage (an adapter) ──▶ Frame (radiance)  ─▶ Canvas (PNG)
//!                       └──▶ surfaces ─▶ reference (f64) ─▶ figures
//! ```

pub mod bands;
pub mod bands_page;
pub mod canvas;
pub mod compute;
pub mod field;
pub mod figures;
pub mod frame;
pub mod gpu;
pub mod lightmap;
pub mod mirror;
pub mod pages;
pub mod reference;
pub mod report;
pub mod strip;
pub mod subject;
pub mod tone;
pub mod turn;
pub mod visibility;
