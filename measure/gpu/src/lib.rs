//! What kernels cost on AMD's GPUs: instructions, registers, spilled registers and throughput as the driver's own compiler
//! counts them, for a device that is not there. Mesa's RADV compiles for whatever family it is told
//! (`RADV_FORCE_FAMILY`); nothing runs. And on NVIDIA's, by their assembler, where it can be had.

pub mod compile;
pub mod cuda;
pub mod device;
pub mod kernels;
pub mod loops;
pub mod nvidia;
pub mod page;
pub mod price;
pub mod registers;
pub mod shader;
