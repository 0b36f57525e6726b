//! The page of the times.
