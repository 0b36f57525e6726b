//! A device of Vulkan that compiles compute pipelines and tells what its compiler counted. All that is `unsafe` in this
//! package is here: each call hands Vulkan handles that this file made and that live to the end of the call.

use ash::{Device, Entry, Instance, khr, vk};
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::ffi::CStr;

/// What RADV's compiler counted of a pipeline. In JSON its numbers, in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "[u64; 6]", into = "[u64; 6]")]
pub struct Counted {
    /// Instructions.
    pub instructions: u64,
    /// Vector registers, in the steps in which they are given out.
    pub registers: u64,
    /// Vector registers that memory stands in for.
    pub spilled: u64,
    /// Waves that a unit holds at once.
    pub waves: u64,
    /// Cycles that a wave keeps the unit's busiest part for: the reciprocal of the throughput.
    pub cycles: u64,
    /// Cycles from the first instruction to the last.
    pub latency: u64,
}

impl From<[u64; 6]> for Counted {
    fn from([instructions, registers, spilled, waves, cycles, latency]: [u64; 6]) -> Self {
        Self { instructions, registers, spilled, waves, cycles, latency }
    }
}

impl From<Counted> for [u64; 6] {
    fn from(counted: Counted) -> Self {
        let Counted { instructions, registers, spilled, waves, cycles, latency } = counted;
        [instructions, registers, spilled, waves, cycles, latency]
    }
}

/// AMD, as Vulkan numbers vendors.
const AMD: u32 = 0x1002;
/// Buffers of a shader: parameters, coefficients, results, tables of loops.
const BUFFERS: u32 = 4;

/// A device that compiles.
pub struct Compiler {
    instance: Instance,
    physical: vk::PhysicalDevice,
    device: Device,
    statistics: khr::pipeline_executable_properties::Device,
    sets: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    // Dropped last: the library is unloaded with it.
    _entry: Entry,
}

impl Compiler {
    /// Opens AMD's device, of the family that the environment names.
    ///
    /// # Errors
    ///
    /// If there is no Vulkan, no device of AMD, or one that does not tell what its compiler counts.
    pub fn new() -> Result<Self, Box<dyn Error>> {
        // SAFETY: the loader is the system's Vulkan library, and the entry outlives all that is made with it.
        let entry = unsafe { Entry::load()? };
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_2);
        let create = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: the structures live to the end of the call.
        let instance = unsafe { entry.create_instance(&create, None)? };
        // SAFETY: the instance lives.
        let devices = unsafe { instance.enumerate_physical_devices()? };
        let is_amd = |device: &&vk::PhysicalDevice| {
            // SAFETY: the instance lives, and the device is one of its own.
            unsafe { instance.get_physical_device_properties(**device) }.vendor_id == AMD
        };
        let physical = *devices.iter().find(is_amd).ok_or("Vulkan has no device of AMD")?;
        let mut told =
            vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default().pipeline_executable_info(true);
        let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(0).queue_priorities(&[1.0])];
        let extensions = [khr::pipeline_executable_properties::NAME.as_ptr()];
        let create = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .push_next(&mut told);
        // SAFETY: the structures live to the end of the call, and the device is one of the instance's.
        let device = unsafe { instance.create_device(physical, &create, None)? };
        let statistics = khr::pipeline_executable_properties::Device::new(&instance, &device);
        let bindings: Vec<_> = (0..BUFFERS)
            .map(|binding| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(binding)
                    .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                    .descriptor_count(1)
                    .stage_flags(vk::ShaderStageFlags::COMPUTE)
            })
            .collect();
        let create = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: the bindings live to the end of the call.
        let sets = unsafe { device.create_descriptor_set_layout(&create, None)? };
        let all = [sets];
        let create = vk::PipelineLayoutCreateInfo::default().set_layouts(&all);
        // SAFETY: the layouts live to the end of the call.
        let layout = unsafe { device.create_pipeline_layout(&create, None)? };
        Ok(Self { instance, physical, device, statistics, sets, layout, _entry: entry })
    }

    /// Compiles a compute shader, SPIR-V whose entry point is `main`, and returns what was counted.
    ///
    /// # Errors
    ///
    /// If the driver refuses it, or does not say what RADV says.
    pub fn counted(&self, spirv: &[u32]) -> Result<Counted, Box<dyn Error>> {
        let create = vk::ShaderModuleCreateInfo::default().code(spirv);
        // SAFETY: naga has validated the module, and the words live to the end of the call.
        let module = unsafe { self.device.create_shader_module(&create, None)? };
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(c"main");
        let create = vk::ComputePipelineCreateInfo::default()
            .flags(vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR)
            .stage(stage)
            .layout(self.layout);
        // SAFETY: module and layout live, and were made by this device.
        let made = unsafe { self.device.create_compute_pipelines(vk::PipelineCache::null(), &[create], None) };
        // SAFETY: the pipeline does not need the module any more, and nothing else has it.
        unsafe { self.device.destroy_shader_module(module, None) };
        let pipeline = made.map_err(|(_, error)| error)?[0];
        let of = vk::PipelineExecutableInfoKHR::default().pipeline(pipeline).executable_index(0);
        // SAFETY: the pipeline lives, and was made to keep its statistics.
        let told = unsafe { self.statistics.get_pipeline_executable_statistics(&of) };
        // SAFETY: nothing else has the pipeline.
        unsafe { self.device.destroy_pipeline(pipeline, None) };
        let told = told?;
        let number = |name: &str| -> Result<u64, Box<dyn Error>> {
            let is_it = |statistic: &&vk::PipelineExecutableStatisticKHR<'_>| {
                statistic.name_as_c_str().is_ok_and(|found| found.to_bytes() == name.as_bytes())
            };
            let found = told.iter().find(is_it).ok_or_else(|| format!("the driver counts no `{name}`"))?;
            match found.format {
                // SAFETY: the format says that this is the field of the union.
                vk::PipelineExecutableStatisticFormatKHR::UINT64 => Ok(unsafe { found.value.u64 }),
                _ => Err(format!("`{name}` is no number").into()),
            }
        };
        Ok(Counted {
            instructions: number("Instructions")?,
            registers: number("VGPRs")?,
            spilled: number("Spilled VGPRs")?,
            waves: number("Subgroups per SIMD")?,
            cycles: number("Inverse Throughput")?,
            latency: number("Latency")?,
        })
    }

    /// Returns what the driver calls itself, with its version.
    pub fn driver(&self) -> String {
        let mut driver = vk::PhysicalDeviceDriverProperties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
        // SAFETY: the device is one of the instance's, and the structures live to the end of the call.
        unsafe { self.instance.get_physical_device_properties2(self.physical, &mut properties) };
        let text = |words: Result<&CStr, _>| words.map(|text| text.to_string_lossy().into_owned()).unwrap_or_default();
        let (name, info) = (text(driver.driver_name_as_c_str()), text(driver.driver_info_as_c_str()));
        format!("{name}, {info}")
    }
}

impl Drop for Compiler {
    fn drop(&mut self) {
        // SAFETY: nothing that was made with the device is used after this, in the order in which it was made.
        unsafe {
            self.device.destroy_pipeline_layout(self.layout, None);
            self.device.destroy_descriptor_set_layout(self.sets, None);
            self.device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}
