//! The bases that records are stored in, each as the kernels that it takes. Coefficients are plain arrays.

use crate::dual::Dual;
use crate::methods::{self, Method};

/// A basis of one order, `C` functions.
#[derive(Clone, Copy)]
pub struct Basis<const C: usize> {
    /// What a person calls it.
    pub name: &'static str,
    /// Its order.
    pub order: usize,
    /// The functions at a direction.
    pub values: fn([f64; 3]) -> [f64; C],
    /// The functions at a direction that moves.
    pub moving: fn([Dual; 3]) -> [Dual; C],
    /// Coefficients turned about z, by the cosine and the sine.
    pub turned: fn([f32; 2], &[f32; C]) -> [f32; C],
    /// How records are turned into the frame of a pixel; the first leaves them as they are, the last is the exact one.
    pub methods: &'static [Method<C>],
}

/// Spherical harmonics of order 6: radiance below the horizon is none.
pub const SH6: Basis<36> = Basis {
    name: "SH",
    order: 6,
    values: zonal::sh6::basis,
    moving: zonal::sh6::basis,
    turned: zonal::sh6::rotate_z,
    methods: &methods::SH6,
};

/// Spherical harmonics of order 10.
pub const SH10: Basis<100> = Basis {
    name: "SH",
    order: 10,
    values: zonal::sh10::basis,
    moving: zonal::sh10::basis,
    turned: zonal::sh10::rotate_z,
    methods: &methods::SH10,
};

/// Hemispherical harmonics of order 6: radiance goes on below the horizon.
pub const HSH6: Basis<36> = Basis {
    name: "HSH",
    order: 6,
    values: zonal::sh6::hsh_basis,
    moving: zonal::sh6::hsh_basis,
    turned: zonal::sh6::rotate_z,
    methods: &methods::HSH6,
};

/// Hemispherical harmonics of order 10.
pub const HSH10: Basis<100> = Basis {
    name: "HSH",
    order: 10,
    values: zonal::sh10::hsh_basis,
    moving: zonal::sh10::hsh_basis,
    turned: zonal::sh10::rotate_z,
    methods: &methods::HSH10,
};
