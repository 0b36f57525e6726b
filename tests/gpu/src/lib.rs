//! A bench for generated shaders: every kernel of the catalogue is wrapped in a compute shader, run on software Vulkan
//! drivers and compared with the interpreter in f64. A driver is chosen by the environment when its instance is made,
//! so that the program `zonal-gpu-worker` runs it and the tests read what that prints.

pub mod bench;
pub mod cases;
pub mod gpu;
pub mod report;
pub mod system;
pub mod wrap;
