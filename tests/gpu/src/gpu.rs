//! A device of a Vulkan driver, and a way to run a compute shader on it.

use crate::job::Job;
use crate::wrap::{GROUP, VECTOR};
use std::borrow::Cow;
use wgpu::util::DeviceExt;
use zonal_codegen::emit::language::GLSL;

/// A device and its queue.
#[derive(Debug)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// The adapter's name and its driver's version.
    pub name: String,
}

impl Gpu {
    /// The adapter whose name holds `part`, among those of the drivers that the environment names.
    ///
    /// # Errors
    ///
    /// If there is no such adapter or no device.
    pub fn open(part: &str) -> Result<Self, String> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            flags: wgpu::InstanceFlags::empty(),
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
        let adapter = adapters.iter().find(|adapter| adapter.get_info().name.contains(part));
        let adapter = adapter.ok_or_else(|| format!("Vulkan has no adapter {part}"))?;
        let info = adapter.get_info();
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))
            .map_err(|error| error.to_string())?;
        let name = format!("{}, {} {}", info.name, info.driver, info.driver_info);
        Ok(Self { device, queue, name: name.trim().to_owned() })
    }

    /// Runs a compute shader.
    ///
    /// # Errors
    ///
    /// If the text is refused: what the compiler says.
    ///
    /// # Panics
    ///
    /// If the device fails.
    pub fn run(&self, job: &Job<'_>) -> Result<Vec<f32>, String> {
        let source = match job.target == &GLSL {
            true => wgpu::ShaderSource::Glsl {
                shader: Cow::Borrowed(job.text),
                stage: wgpu::naga::ShaderStage::Compute,
                defines: &[],
            },
            false => wgpu::ShaderSource::Wgsl(Cow::Borrowed(job.text)),
        };
        let device = &self.device;
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        if let Some(error) = pollster::block_on(scope.pop()) {
            return Err(error.to_string());
        }
        let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("inputs"),
            contents: bytemuck::cast_slice(job.inputs),
            usage: wgpu::BufferUsages::STORAGE,
        });
        let bytes = (job.count * job.gives * VECTOR * size_of::<f32>()) as u64;
        let buffer = |label, usage| {
            let label = Some(label);
            device.create_buffer(&wgpu::BufferDescriptor { label, size: bytes, usage, mapped_at_creation: false })
        };
        let output = buffer("outputs", wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
        let read = buffer("read back", wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[(0, &input), (1, &output)]
                .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() }),
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups((job.count / GROUP) as u32, 1, 1);
        }
        encoder.copy_buffer_to_buffer(&output, 0, &read, 0, bytes);
        self.queue.submit([encoder.finish()]);
        read.map_async(wgpu::MapMode::Read, .., |result| result.expect("the device gives its memory"));
        device.poll(wgpu::PollType::wait_indefinitely()).expect("the device finishes");
        let view = read.get_mapped_range(..).expect("the memory is mapped");
        Ok(bytemuck::pod_collect_to_vec(&view))
    }
}
