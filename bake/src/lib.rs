//! Bakes the light of an environment map into a mesh: for every vertex, or for every texel of a lightmap, what arrives where
//! nothing stands in its way, as coefficients in the frame of the surface.
//!
//! ```text
//! Map ─▶ Sky (rays where it is bright) ─┐
//! Mesh ─▶ Occluders (what they meet) ───┼─▶ Baker ─▶ coefficients ─▶ OpenEXR, PLY
//!   └───▶ points (vertices, texels) ────┘
//! ```

pub mod alias;
pub mod basis;
pub mod chart;
pub mod gather;
pub mod gltf;
pub mod model;
pub mod occluders;
pub mod output;
pub mod point;
pub mod quads;
pub mod sky;
