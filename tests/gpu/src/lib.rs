//! A bench for generated shaders: every kernel of the catalogue is wrapped in a shader, run on software Vulkan drivers, as
//! WebGPU and as WebGL2 in a browser, and compared with the interpreter in f64. Vulkan's drivers are chosen by the
//! environment, so that the program `zonal-gpu-worker` runs the bench and the tests read what that prints.

pub mod bench;
pub mod browser;
pub mod cases;
pub mod devices;
pub mod gpu;
pub mod job;
pub mod report;
pub mod row;
pub mod system;
pub mod wrap;
