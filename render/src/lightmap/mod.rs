//! Irradiance normal mapping (Habel and Wimmer 2010): a room with a lightmap and a teapot with baked vertices under a normal
//! map, seen by each basis and by brute force, on the CPU.
//!
//! ```text
//! room ─▶ Baked (zonal-bake) ─┐
//! camera ─▶ what a pixel sees ┴─▶ seen (each basis, brute force) ─▶ page (docs/LIGHTMAPS.md, the strip)
//! ```

pub mod page;
pub mod room;
pub mod seen;
pub mod ways;
