//! Everything that runs shaders: two Vulkan drivers through wgpu, and a browser's WebGPU and WebGL2.

use crate::browser::Browser;
use crate::gpu::Gpu;
use crate::job::Job;
use crate::system::VULKAN;
use crate::wrap;
use zonal_codegen::emit::Function;
use zonal_codegen::emit::dialect::Dialect;
use zonal_codegen::emit::language::{GLSL, Target, WGSL};

/// A driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// One of [`VULKAN`].
    Vulkan(usize),
    /// The browser's WebGPU.
    WebGpu,
    /// The browser's WebGL2.
    WebGl,
}

/// A driver and a language that it runs: a column of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// The driver.
    pub driver: Driver,
    /// The language.
    pub target: Target,
}

/// Every driver, and the languages that it runs. SwiftShader gets GLSL from the browser alone, whose WebGL2 stands on it.
pub static COLUMNS: [Column; 5] = [
    Column { driver: Driver::Vulkan(0), target: &WGSL },
    Column { driver: Driver::Vulkan(0), target: &GLSL },
    Column { driver: Driver::Vulkan(1), target: &WGSL },
    Column { driver: Driver::WebGpu, target: &WGSL },
    Column { driver: Driver::WebGl, target: &GLSL },
];

impl Driver {
    /// What it is called here.
    pub fn name(self) -> &'static str {
        match self {
            Self::Vulkan(i) => VULKAN[i].name,
            Self::WebGpu => "WebGPU",
            Self::WebGl => "WebGL2",
        }
    }
}

impl Column {
    /// Its head in the table.
    pub fn name(self) -> String {
        format!("{} {}", self.driver.name(), self.target.name.to_uppercase())
    }

    /// The shader around a function's file.
    pub fn wrapped(self, function: &Function, dialect: Dialect, text: &str) -> String {
        match self.driver {
            Driver::WebGl => wrap::pixels(function, dialect, text),
            _ => wrap::compute(function, dialect, text),
        }
    }
}

/// A device of each driver.
#[derive(Debug)]
pub struct Devices {
    gpus: [Gpu; VULKAN.len()],
    browser: Browser,
}

impl Devices {
    /// Opens all of them.
    ///
    /// # Errors
    ///
    /// If there is no device of a driver.
    pub fn open() -> Result<Self, String> {
        let [first, second] = VULKAN.map(|driver| Gpu::open(driver.adapter));
        Ok(Self { gpus: [first?, second?], browser: Browser::open()? })
    }

    /// What a column's driver calls itself.
    pub fn name(&self, column: Column) -> String {
        match column.driver {
            Driver::Vulkan(i) => self.gpus[i].name.clone(),
            Driver::WebGpu | Driver::WebGl => self.browser.name(column.target),
        }
    }

    /// Runs a shader.
    ///
    /// # Errors
    ///
    /// If it is refused: what the compiler says.
    pub fn run(&mut self, driver: Driver, job: &Job<'_>) -> Result<Vec<f32>, String> {
        match driver {
            Driver::Vulkan(i) => self.gpus[i].run(job),
            Driver::WebGpu | Driver::WebGl => self.browser.run(job),
        }
    }
}
