//! Pure mathematics: exact constants and the tables made of them. Imports nothing else of this crate.

pub mod convention;
pub mod exact;
<<<<<<< HEAD
pub mod fourier;
=======
pub mod gaunt;
>>>>>>> products
pub mod half;
pub mod index;
pub mod linear;
pub mod quadrature;
pub mod roots;
pub mod tables;
