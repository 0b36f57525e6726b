//! What a device is asked to do.

use zonal_codegen::emit::language::Target;

/// One shader text over many cases, whose numbers are vectors of four, one case after the other.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// The text's language.
    pub target: Target,
    /// The text.
    pub text: &'a str,
    /// The numbers that all cases take.
    pub inputs: &'a [f32],
    /// How many cases there are: a multiple of [`crate::wrap::GROUP`].
    pub count: usize,
    /// How many vectors a case takes.
    pub takes: usize,
    /// How many vectors a case gives.
    pub gives: usize,
}
