//! Shading past what stands in the way of light (Soler et al. 2015, appendix A), and under lights nearby: an object with its
//! visibility baked into its vertices, by the paper's way, by the product of light and visibility, and by brute force, on the
//! CPU.
//!
//! ```text
//! map ─▶ Multiplier (light times what is seen) ─┬─▶ paper (γ, its three steps)
//! mesh ─▶ Object (zonal-bake: visibility) ──────┼─▶ seen (each order, brute force) ─▶ page (docs/VISIBILITY.md, the pictures)
//! spheres ─▶ lamps (light by place) ────────────┘
//! ```

pub mod lamps;
pub mod multiplier;
pub mod page;
pub mod paper;
pub mod seen;
