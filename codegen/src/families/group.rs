//! What families are listed under: a file of the catalogue an order, and a part of every list.

/// What families are listed under: the files of the catalogue and the table of the README follow it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Group {
    /// The basis, and sums over it.
    Evaluate,
    /// Exact rotations.
    Rotate,
    /// The rotation of z to a normal, from the normal.
    Tilt,
    /// Rotations by a small angle.
    SmallAngle,
    /// The sparse zonal factorisation.
    Factorise,
    /// What rotations are made of: about one axis.
    Piece,
    /// Functions of the angle from an axis, and lights.
    Light,
    /// Products of functions.
    Multiply,
    /// Irradiance over the upper hemisphere, and what keeps it from ringing.
    Irradiance,
    /// Hemispherical harmonics.
    Hemisphere,
    /// Shading by isotropic decomposition, and directly.
    Shade,
}

impl Group {
    /// All groups, in order.
    pub const ALL: [Self; 11] = [
        Self::Evaluate,
        Self::Rotate,
        Self::Tilt,
        Self::SmallAngle,
        Self::Factorise,
        Self::Piece,
        Self::Light,
        Self::Multiply,
        Self::Irradiance,
        Self::Hemisphere,
        Self::Shade,
    ];

    /// Its name in files; no kernel has it, so that a kernel's own file and the group's can meet.
    pub fn name(self) -> &'static str {
        match self {
            Self::Evaluate => "evaluation",
            Self::Rotate => "rotation",
            Self::Tilt => "tilting",
            Self::SmallAngle => "small_angles",
            Self::Factorise => "factorisation",
            Self::Piece => "pieces",
            Self::Light => "lighting",
            Self::Multiply => "products",
            Self::Irradiance => "irradiances",
            Self::Hemisphere => "hemispheres",
            Self::Shade => "shading",
        }
    }

    /// What its kernels do, in a sentence without its stop.
    pub fn what(self) -> &'static str {
        match self {
            Self::Evaluate => "the basis, and sums over it",
            Self::Rotate => "exact rotations, and what is done once for many of them",
            Self::Tilt => "the shortest rotation of z to a normal",
            Self::SmallAngle => "rotations by a small angle, approximately",
            Self::Factorise => "the sparse zonal factorisation",
            Self::Piece => "what rotations are made of, about one axis",
            Self::Light => "zonal functions, convolution with them, lights",
            Self::Multiply => "products of functions on the sphere",
            Self::Irradiance => "irradiance, its bases on the upper hemisphere, what keeps it from ringing",
            Self::Hemisphere => "hemispherical harmonics: the basis, sums over it, conversions, rotations, gradients",
            Self::Shade => "shading: the integral of light times reflectance, by isotropic decomposition and directly",
        }
    }
}
