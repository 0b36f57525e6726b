//! One device of the Vulkan driver that the environment names, and a way to run a compute shader on it.

use crate::wrap::ALIGNMENT;
use std::borrow::Cow;
use std::num::NonZeroU64;
use wgpu::util::DeviceExt;
use zonal_codegen::emit::dialect::Target;

/// A device and its queue.
#[derive(Debug)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    layout: wgpu::BindGroupLayout,
    /// The adapter's name and its driver's version.
    pub name: String,
}

impl Gpu {
    /// The only adapter of the driver.
    ///
    /// # Errors
    ///
    /// If there is no adapter or no device.
    pub fn open() -> Result<Self, String> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            flags: wgpu::InstanceFlags::empty(),
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
        let adapter = adapters.first().ok_or("Vulkan has no adapter")?;
        let info = adapter.get_info();
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))
            .map_err(|error| error.to_string())?;
        let entry = |binding: u32, read_only: bool| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only },
                has_dynamic_offset: true,
                min_binding_size: None,
            },
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[entry(0, true), entry(1, false)],
        });
        Ok(Self { device, queue, layout, name: format!("{}, {} {}", info.name, info.driver, info.driver_info) })
    }

    /// Runs the entry point `main` of a text in WGSL or GLSL `count` times, each with its part of the inputs and of the
    /// outputs, which has `size` numbers; parts start at multiples of [`ALIGNMENT`]. A text that is refused ends the
    /// program with the compiler's message and the label.
    ///
    /// # Panics
    ///
    /// If the device fails.
    pub fn run(&self, label: &str, target: Target, text: &str, inputs: &[f32], size: usize, count: usize) -> Vec<f32> {
        let source = match target {
            Target::Glsl => wgpu::ShaderSource::Glsl {
                shader: Cow::Borrowed(text),
                stage: wgpu::naga::ShaderStage::Compute,
                defines: &[],
            },
            _ => wgpu::ShaderSource::Wgsl(Cow::Borrowed(text)),
        };
        let device = &self.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&self.layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(label),
            layout: Some(&layout),
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("inputs"),
            contents: bytemuck::cast_slice(inputs),
            usage: wgpu::BufferUsages::STORAGE,
        });
        let strides =
            [inputs.len() / count, size.next_multiple_of(ALIGNMENT)].map(|numbers| numbers * size_of::<f32>());
        let bytes = (strides[1] * count) as u64;
        let buffer = |label, usage| {
            let label = Some(label);
            device.create_buffer(&wgpu::BufferDescriptor { label, size: bytes, usage, mapped_at_creation: false })
        };
        let output = buffer("outputs", wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
        let read = buffer("read back", wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        let entry = |binding: usize, buffer| wgpu::BindGroupEntry {
            binding: binding as u32,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer,
                offset: 0,
                size: NonZeroU64::new(strides[binding] as u64),
            }),
        };
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.layout,
            entries: &[entry(0, &input), entry(1, &output)],
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline);
            for call in 0..count {
                pass.set_bind_group(0, &group, &strides.map(|stride| (call * stride) as u32));
                pass.dispatch_workgroups(1, 1, 1);
            }
        }
        encoder.copy_buffer_to_buffer(&output, 0, &read, 0, bytes);
        self.queue.submit([encoder.finish()]);
        read.map_async(wgpu::MapMode::Read, .., |result| result.expect("the device gives its memory"));
        device.poll(wgpu::PollType::wait_indefinitely()).expect("the device finishes");
        let view = read.get_mapped_range(..).expect("the memory is mapped");
        bytemuck::pod_collect_to_vec(&view)
    }
}
