//! Runs a compute shader on the adapter, and says how long it takes. With `gpu.rs` the only file that knows wgpu.

use crate::field::shader::{GROUP, Inputs, bindings};
use crate::field::ways::Way;
use crate::gpu::Gpu;
use std::borrow::Cow;
use std::time::Instant;
use wgpu::util::{DeviceExt, TextureDataOrder};
use zonal_codegen::scene::diagnostic::Diagnostic;

/// How often it is run to be timed, after it was run once.
const TIMED: usize = 9;

/// What was computed, and how long a run takes: the median, waiting included, in milliseconds.
pub struct Ran {
    /// Four numbers a point.
    pub result: Vec<[f32; 4]>,
    /// The median time.
    pub milliseconds: f64,
}

/// Runs a way's shader for as many points as there are normals.
///
/// # Errors
///
/// If the adapter refuses the shader or the memory.
pub fn run(gpu: &Gpu, way: Way, order: usize, text: &str, inputs: &Inputs) -> Result<Ran, Diagnostic> {
    let (device, queue) = (&gpu.device, &gpu.queue);
    let count = inputs.normals.len();
    gpu.checked("cannot compute", || {
        let source = wgpu::ShaderSource::Wgsl(Cow::Borrowed(text));
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let filled = |contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
        };
        let storage = wgpu::BufferUsages::STORAGE;
        let transfer = filled(bytemuck::cast_slice(inputs.transfer), storage);
        let light = filled(bytemuck::cast_slice(inputs.light), wgpu::BufferUsages::UNIFORM);
        let normals = filled(bytemuck::cast_slice(inputs.normals), storage);
        let empty = |usage| {
            let size = size_of_val(inputs.normals) as u64;
            device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
        };
        let result = empty(storage | wgpu::BufferUsages::COPY_SRC);
        let read = empty(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let cube = |cube: &crate::field::tables::Cube| {
            let side = cube.side as u32;
            let descriptor = wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 6 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba16Float,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            };
            let bytes: Vec<u8> = cube.texels.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
            let texture = device.create_texture_with_data(queue, &descriptor, TextureDataOrder::LayerMajor, &bytes);
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::Cube),
                ..Default::default()
            })
        };
        let cubes: Vec<wgpu::TextureView> = inputs.cubes.iter().map(cube).collect();
        let resource = |binding: usize| match binding {
            0 => transfer.as_entire_binding(),
            1 => result.as_entire_binding(),
            2 => light.as_entire_binding(),
            3 => normals.as_entire_binding(),
            4 => wgpu::BindingResource::Sampler(&sampler),
            cube => wgpu::BindingResource::TextureView(&cubes[cube - 5]),
        };
        let entries: Vec<wgpu::BindGroupEntry> = bindings(way, order)
            .into_iter()
            .map(|binding| wgpu::BindGroupEntry { binding: binding as u32, resource: resource(binding) })
            .collect();
        let layout = pipeline.get_bind_group_layout(0);
        let group =
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
        let once = || {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, &group, &[]);
                pass.dispatch_workgroups(count.div_ceil(GROUP) as u32, 1, 1);
            }
            queue.submit([encoder.finish()]);
            let _ = device.poll(wgpu::PollType::wait_indefinitely());
        };
        once();
        let time = |_| {
            let start = Instant::now();
            once();
            1e3 * start.elapsed().as_secs_f64()
        };
        let mut times: Vec<f64> = (0..TIMED).map(time).collect();
        times.sort_by(f64::total_cmp);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(&result, 0, &read, 0, read.size());
        queue.submit([encoder.finish()]);
        read.map_async(wgpu::MapMode::Read, .., |_| ());
        let _ = device.poll(wgpu::PollType::wait_indefinitely());
        // A device that is lost maps nothing, which its error scopes tell.
        let result = match read.get_mapped_range(..) {
            Ok(view) => bytemuck::pod_collect_to_vec(&view),
            Err(_) => vec![[0.0; 4]; count],
        };
        Ran { result, milliseconds: times[TIMED / 2] }
    })
}
