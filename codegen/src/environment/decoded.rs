//! What the readers of all formats give. It knows none of them.

/// An image as it is decoded.
pub(crate) struct Decoded {
    /// The number of columns.
    pub width: usize,
    /// The number of rows.
    pub height: usize,
    /// Linear R, G and B, row by row from the top.
    pub texels: Vec<[f64; 3]>,
    /// What it was decoded from.
    pub encoding: String,
}
