//! A kernel as data: the expression graph, the kernel with its parameters and their domains, the listing that it is laid out as, loops,
//! the operations in any form, and the interpreter. It knows arithmetic and nothing of harmonics, text or targets.

pub mod code;
pub mod eval;
pub mod graph;
pub mod kernel;
pub mod listing;
pub mod op;
pub mod pieces;
pub mod program;
