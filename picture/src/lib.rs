//! What a picture of a scene needs besides kernels: meshes, normal maps, a camera at work, and whole shaders. Who draws
//! with them is `zonal-render`, or a browser with the explorer's page.

pub mod camera;
pub mod lights;
pub mod mesh;
pub mod method;
pub mod mirror;
pub mod normal_map;
pub mod shade;
pub mod tone;
pub mod vector;
