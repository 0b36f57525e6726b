//! What zonal's commands share: how a diagnostic is drawn, how they print and end, the scene, the
//! map or the inputs of a kernel that they are given.
//! The command `zonal` itself is this package's program; those that draw are packages of their own, so that nobody builds
//! graphics, plots or pages to generate a kernel.

pub mod drawn;
pub mod inputs;
pub mod projected;
pub mod scene;
pub mod terminal;
