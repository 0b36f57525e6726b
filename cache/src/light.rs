//! What a record holds: coefficients, whatever their basis.

/// Coefficients of red, green and blue.
pub type Light<const C: usize> = [[f32; 3]; C];
