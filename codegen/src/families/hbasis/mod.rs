//! The H-basis (Habel and Wimmer 2010): irradiance over the upper hemisphere of normals in four or six polynomials; what
//! comes of spherical harmonics and of the Half-Life 2 basis is exact by integrals over the hemisphere
//! (docs/MATH.md#the-h-basis). Normals are taken as they are, means of normals among them.

pub mod convert;
pub mod evaluate;
pub mod half_life;
mod space;
