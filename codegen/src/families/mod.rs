//! The kernel families: one file and one row each. What a kernel costs is decided here, by the recurrence that is chosen;
//! nothing downstream makes it cheaper. A family's file ends in nothing that another file has to repeat: its record
//! ([`Family`]) says all that is known of it, and a row of [`ALL`], in `all.rs`, makes it known.

pub mod about_y;
pub mod align;
pub mod all;
pub mod axis;
pub mod basis;
pub mod choices;
pub mod convolution;
pub mod factors;
pub mod family;
pub mod fitted;
pub mod group;
pub mod hbasis;
pub mod hemisphere;
pub mod irradiance;
pub mod isd;
pub mod lifted;
pub mod lights;
pub mod loops;
pub mod monomial;
pub mod parts;
pub mod pieces;
pub mod product;
pub mod ringing;
pub mod several;
pub mod small_turn;
pub mod tensor;
pub mod text;
pub mod tilt;
#[cfg(test)]
pub mod toy;
pub mod zhf;
pub mod zonal;
pub mod zonal_functions;
pub mod zxzxz;
pub mod zyz;

pub use all::ALL;
pub use family::{Family, Form, Group, Spec};
pub use parts::small_angle::SmallAngle;
pub use text::SpecError;
