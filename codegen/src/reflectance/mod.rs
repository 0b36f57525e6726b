//! What a surface makes of light: analytic and tabulated reflectances and their harmonics, and what a scene with one requires of its
//! environment. It knows kernels, but neither scenes nor pictures.

pub mod brdf;
pub mod measured;
pub mod requirement;
pub mod seen;
