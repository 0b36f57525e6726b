//! One device of the Vulkan driver that the environment names, and a way to run a compute shader on it.

use crate::wrap::GROUP;
use std::borrow::Cow;
use wgpu::util::DeviceExt;
use zonal_codegen::emit::dialect::Target;

/// A device and its queue.
#[derive(Debug)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
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
        Ok(Self { device, queue, name: format!("{}, {} {}", info.name, info.driver, info.driver_info) })
    }

    /// Runs the entry point `main` of a text in WGSL or GLSL for `count` threads. A text that is refused ends the
    /// program with the compiler's message and the label.
    ///
    /// # Panics
    ///
    /// If the device fails.
    pub fn run(
        &self,
        label: &str,
        target: Target,
        text: &str,
        inputs: &[f32],
        outputs: usize,
        count: usize,
    ) -> Vec<f32> {
        let source = match target {
            Target::Glsl => wgpu::ShaderSource::Glsl {
                shader: Cow::Borrowed(text),
                stage: wgpu::naga::ShaderStage::Compute,
                defines: &[],
            },
            _ => wgpu::ShaderSource::Wgsl(Cow::Borrowed(text)),
        };
        let device = &self.device;
        let t0 = std::time::Instant::now();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source });
        let t1 = std::time::Instant::now();
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(label),
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let t2 = std::time::Instant::now();
        let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("inputs"),
            contents: bytemuck::cast_slice(inputs),
            usage: wgpu::BufferUsages::STORAGE,
        });
        let size = (outputs * size_of::<f32>()) as u64;
        let buffer = |label, usage| {
            device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let output = buffer("outputs", wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
        let read = buffer("read back", wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        let entries = [(0, &input), (1, &output)]
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(count.div_ceil(GROUP) as u32, 1, 1);
        }
        encoder.copy_buffer_to_buffer(&output, 0, &read, 0, size);
        self.queue.submit([encoder.finish()]);
        read.map_async(wgpu::MapMode::Read, .., |result| result.expect("the device gives its memory"));
        device.poll(wgpu::PollType::wait_indefinitely()).expect("the device finishes");
        let t3 = std::time::Instant::now();
        eprintln!("{label} {target} module {:?} pipeline {:?} dispatch {:?}", t1 - t0, t2 - t1, t3 - t2);
        let view = read.get_mapped_range(..).expect("the memory is mapped");
        bytemuck::pod_collect_to_vec(&view)
    }
}
