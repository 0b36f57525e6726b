//! Times batches beside a copy of the same bytes, in turn within one run, and says by how much they miss the law: no faster than
//! the slower of the copy and the multiplications at the unit's peak.

pub mod page;
pub mod peak;
pub mod time;
