//! Light that is turned into the frame of every point (Nowrouzezahrai et al. 2012, section 7.3): a height field whose transfer
//! is baked in the frame of each point, under light that four kernels turn there, and the same without a turn, with transfer in
//! the axes of the object. Errors are those of the interpreter, pictures and times those of an adapter.
//!
//! ```text
//! Ground (heights, horizons) ─▶ Transfer (in both frames) ─┬─▶ ways (kernels, the interpreter) ─▶ page (docs/HEIGHT_FIELD.md)
//! map ─▶ light ─▶ Tables (a cube a band) ──────────────────┴─▶ shader, compute (an adapter) ─▶ pictures, times
//! ```

pub mod ground;
pub mod page;
pub mod shader;
pub mod tables;
pub mod transfer;
pub mod ways;
