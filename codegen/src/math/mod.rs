//! Pure mathematics: exact constants and the tables made of them. Imports nothing else of this crate.

pub mod convention;
pub mod exact;
pub mod fourier;
pub mod gaunt;
pub mod half;
pub mod hemisphere;
pub mod index;
pub mod inverse;
pub mod linear;
pub mod quadrature;
pub mod roots;
pub mod tables;
