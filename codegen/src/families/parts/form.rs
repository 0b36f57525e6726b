//! The forms that a kernel has.

/// Unrolled, a loop over tables, or a piece of an unrolled kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Form {
    /// Straight lines, every index a constant.
    Unrolled,
    /// Tables and a loop.
    Loop,
    /// What all bands are made with, of a kernel in pieces.
    SetUp,
    /// A band, of a kernel in pieces.
    Band(usize),
}

impl Form {
    /// Returns whether it is a piece of an unrolled kernel.
    pub fn is_piece(self) -> bool {
        matches!(self, Self::SetUp | Self::Band(_))
    }
}
