//! How a scene says what an error may be: a rotation's, of which signal and in which precision; and an environment's,
//! relative to what.

use crate::math::hemisphere::Below;
use serde::{Deserialize, Serialize};

/// Which numbers a kernel works in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// f32.
    #[default]
    F32,
    /// f16, in WGSL alone.
    F16,
    /// f16 where the error that is allowed has room for its rounding.
    Auto,
}

/// What an error is the error of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Norm {
    /// The worst signal of the worst band.
    #[default]
    Max,
    /// A random signal of the worst band, in the root mean square.
    Mean,
    /// The worst signal whose bands have given energies, against all of it.
    Signal,
}

impl Norm {
    /// What an error in it is the error of.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Max => "of the worst band's norm",
            Self::Mean => "of the worst band's norm, in the root mean square over signals",
            Self::Signal => "of the norm of the worst signal with the environment's energies",
        }
    }
}

/// What hemispherical coefficients are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Hemisphere {
    /// A function that vanishes below the horizon, as a reflectance does.
    Lobe,
    /// A function that goes on below the horizon, as a record of radiance does.
    Record,
}

impl Hemisphere {
    /// What it is below the horizon.
    pub fn below(self) -> Below {
        match self {
            Self::Lobe => Below::Zero,
            Self::Record => Below::GoesOn,
        }
    }

    /// What an error of its rotation is the error of.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Lobe => "of the norm of clamped cosine lobes to 50 degrees from z, in the mean",
            Self::Record => "of the norm of radiance as it is expected to be, in the root mean square",
        }
    }
}

/// What the error of an environment's order is relative to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum RelativeTo {
    /// What is seen of the light with all of its bands.
    #[default]
    AllBands,
    /// What is seen of the bands that the scene can afford at most: what lies beyond is lost in any case.
    MaxOrder,
}
