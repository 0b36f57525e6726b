//! The adapter: draws a subject with a generated shader into radiance, or into what is known of its surface before it is
//! shaded. With `compute.rs` the only file that knows wgpu.

use crate::bands::Tables;
use crate::frame::{Frame, Surface};
use crate::subject::Subject;
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Mutex;
use std::time::Instant;
use wgpu::util::{DeviceExt, TextureDataOrder};
use zonal_codegen::environment::Projection;
use zonal_codegen::reflectance::brdf::Table;
use zonal_codegen::scene::diagnostic::Diagnostic;
use zonal_picture::camera::View;
use zonal_picture::mesh::STRIDE;
use zonal_picture::shade::{Shading, wgsl_gbuffer};

const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const RADIANCE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// How often a frame is drawn to be timed, after it was drawn once.
const TIMED: usize = 5;

/// A device, and the shaders that it was given.
#[derive(Debug)]
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    layout: wgpu::BindGroupLayout,
    pipelines: Mutex<HashMap<Option<Shading>, wgpu::RenderPipeline>>,
    limits: wgpu::Limits,
    /// The adapter and its driver.
    pub name: String,
}

/// A subject on a device, at a size in pixels.
#[derive(Debug)]
pub struct Stage<'a> {
    gpu: &'a Gpu,
    /// What is drawn.
    pub subject: &'a Subject,
    /// The width and the height.
    pub size: [usize; 2],
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    camera: wgpu::Buffer,
    normals: wgpu::TextureView,
    sampler: wgpu::Sampler,
}

fn fault(what: &str, error: impl std::fmt::Display) -> Diagnostic {
    Diagnostic::nowhere(format!("the adapter {what}: {error}"), "try a smaller picture, or another adapter or driver")
}

impl Gpu {
    /// The first adapter that wgpu finds, a software one if there is no other.
    ///
    /// # Errors
    ///
    /// If there is none, or it does not give a device.
    pub fn open() -> Result<Self, Diagnostic> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            flags: wgpu::InstanceFlags::empty(),
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()));
        let adapter = adapter.map_err(|_| {
            Diagnostic::nowhere(
                "no adapter that draws was found, neither a GPU nor a software one",
                "install a driver; for a software one: `apt-get install mesa-vulkan-drivers libvulkan1`",
            )
        })?;
        let info = adapter.get_info();
        let limits = adapter.limits();
        let descriptor = wgpu::DeviceDescriptor { required_limits: limits.clone(), ..Default::default() };
        let device = pollster::block_on(adapter.request_device(&descriptor));
        let (device, queue) = device.map_err(|error| fault("gives no device", error))?;
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let entry = |binding: u32, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let texture = |filterable| wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[
                entry(0, both, uniform),
                entry(1, fragment, texture(true)),
                entry(2, fragment, sampler),
                entry(3, fragment, uniform),
                entry(4, fragment, texture(false)),
            ],
        });
        let name = match info.driver_info.contains(&info.driver) {
            true => format!("{}, {}", info.name, info.driver_info),
            false => format!("{}, {} {}", info.name, info.driver, info.driver_info),
        };
        Ok(Self { device, queue, layout, pipelines: Mutex::default(), limits, name })
    }

    /// Runs what may go wrong on the device and says what did.
    pub(crate) fn checked<T>(&self, what: &str, run: impl FnOnce() -> T) -> Result<T, Diagnostic> {
        let scopes = [wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Internal]
            .map(|filter| self.device.push_error_scope(filter));
        let result = run();
        for scope in scopes.into_iter().rev() {
            if let Some(error) = pollster::block_on(scope.pop()) {
                return Err(fault(what, error));
            }
        }
        Ok(result)
    }

    /// The pipeline that shades, or without a shading the one that writes surfaces.
    fn pipeline(&self, shading: Option<Shading>) -> Result<wgpu::RenderPipeline, Diagnostic> {
        let mut known = self.pipelines.lock().expect("no holder panics");
        if let Some(pipeline) = known.get(&shading) {
            return Ok(pipeline.clone());
        }
        let text = match shading {
            None => wgsl_gbuffer(),
            Some(shading) => shading.wgsl().map_err(|limit| Diagnostic::nowhere(limit.to_string(), ""))?,
        };
        let pipeline = self.checked("refuses the shader", || {
            let source = wgpu::ShaderSource::Wgsl(Cow::Owned(text));
            let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
            let tables = shading.filter(|shading| shading.method.reads_tables());
            let tables = tables.map(|shading| self.tables_layout(shading.order));
            let layouts: Vec<_> = [Some(&self.layout), tables.as_ref()].into_iter().filter(Option::is_some).collect();
            let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: &layouts,
                immediate_size: 0,
            });
            let target = Some(wgpu::ColorTargetState::from(RADIANCE));
            let targets = vec![target; if shading.is_none() { 3 } else { 1 }];
            self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vertex"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[Some(wgpu::VertexBufferLayout {
                        array_stride: (STRIDE * size_of::<f32>()) as u64,
                        step_mode: wgpu::VertexStepMode::Vertex,
                        attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2],
                    })],
                },
                primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Less),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("fragment"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &targets,
                }),
                multiview_mask: None,
                cache: None,
            })
        })?;
        known.insert(shading, pipeline.clone());
        Ok(pipeline)
    }

    /// The layout of so many tables, as [`Reads`](zonal_codegen::emit::bands::Reads) has them.
    fn tables_layout(&self, count: usize) -> wgpu::BindGroupLayout {
        let entry = |binding: usize, ty| wgpu::BindGroupLayoutEntry {
            binding: binding as u32,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let cube = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::Cube,
            multisampled: false,
        };
        let mut entries = vec![entry(0, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering))];
        entries.extend((1..=count).map(|binding| entry(binding, cube)));
        self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
    }

    /// The tables with a sampler that filters.
    fn tables(&self, tables: &Tables) -> wgpu::BindGroup {
        let sampler = self.device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let view = |band: usize| {
            let side = tables.bands[band].side;
            let descriptor = wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { depth_or_array_layers: 6, ..extent([side; 2]) },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba16Float,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            };
            let (texels, order) = (tables.texels(band), TextureDataOrder::LayerMajor);
            let texture =
                self.device.create_texture_with_data(&self.queue, &descriptor, order, bytemuck::cast_slice(&texels));
            let dimension = Some(wgpu::TextureViewDimension::Cube);
            texture.create_view(&wgpu::TextureViewDescriptor { dimension, ..Default::default() })
        };
        let views: Vec<wgpu::TextureView> = (0..tables.bands.len()).map(view).collect();
        let entry = |binding: usize, resource| wgpu::BindGroupEntry { binding: binding as u32, resource };
        let mut entries = vec![entry(0, wgpu::BindingResource::Sampler(&sampler))];
        entries
            .extend(views.iter().enumerate().map(|(i, view)| entry(i + 1, wgpu::BindingResource::TextureView(view))));
        let layout = self.tables_layout(views.len());
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries })
    }

    fn buffer(&self, numbers: &[f32], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let contents = bytemuck::cast_slice(numbers);
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
    }

    fn texture(&self, size: [usize; 2], format: wgpu::TextureFormat, levels: usize, data: &[u8]) -> wgpu::TextureView {
        let descriptor = wgpu::TextureDescriptor {
            label: None,
            size: extent(size),
            mip_level_count: levels as u32,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        };
        let texture =
            self.device.create_texture_with_data(&self.queue, &descriptor, TextureDataOrder::LayerMajor, data);
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }
}

fn extent(size: [usize; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d { width: size[0] as u32, height: size[1] as u32, depth_or_array_layers: 1 }
}

impl<'a> Stage<'a> {
    /// Brings a subject to a device.
    ///
    /// # Errors
    ///
    /// If the size is beyond what the device draws, or its memory does not suffice.
    pub fn new(gpu: &'a Gpu, subject: &'a Subject, size: [usize; 2]) -> Result<Self, Diagnostic> {
        let most = gpu.limits.max_texture_dimension_2d as usize;
        if size.iter().any(|side| !(1..=most).contains(side)) {
            let message = format!("{} draws from 1 to {most} pixels a side, not {} by {}", gpu.name, size[0], size[1]);
            return Err(Diagnostic::nowhere(
                message,
                "write a smaller `size` in `[picture]`, or take fewer `--samples`",
            ));
        }
        gpu.checked("cannot take the object", || {
            let matrix = subject.camera.matrix(size[0] as f64 / size[1] as f64);
            let eye = subject.camera.eye();
            let camera: Vec<f32> =
                matrix.iter().flatten().chain(&eye).chain([&subject.strength]).map(|&x| x as f32).collect();
            let levels = subject.normals.levels();
            let indices = bytemuck::cast_slice(&subject.mesh.indices);
            Self {
                gpu,
                subject,
                size,
                vertices: gpu.buffer(&subject.mesh.interleaved(), wgpu::BufferUsages::VERTEX),
                indices: gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: None,
                    contents: indices,
                    usage: wgpu::BufferUsages::INDEX,
                }),
                camera: gpu.buffer(&camera, wgpu::BufferUsages::UNIFORM),
                normals: gpu.texture(
                    [subject.normals.width, subject.normals.height],
                    wgpu::TextureFormat::Rgba8Unorm,
                    levels.len(),
                    levels.concat().as_flattened(),
                ),
                sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                    address_mode_u: wgpu::AddressMode::Repeat,
                    address_mode_v: wgpu::AddressMode::Repeat,
                    mag_filter: wgpu::FilterMode::Linear,
                    min_filter: wgpu::FilterMode::Linear,
                    mipmap_filter: wgpu::MipmapFilterMode::Linear,
                    ..Default::default()
                }),
            }
        })
    }

    /// Where the object is and how it lies, for each pixel that shows it.
    ///
    /// # Errors
    ///
    /// If the device fails.
    pub fn surfaces(&self) -> Result<Vec<Option<Surface>>, Diagnostic> {
        let gpu = self.gpu;
        if gpu.limits.max_color_attachment_bytes_per_sample < 48 {
            return Err(fault("cannot say where the object is", "it writes less than 48 bytes a pixel"));
        }
        let pipeline = gpu.pipeline(None)?;
        gpu.checked("cannot say where the object is", || {
            let light = gpu.buffer(&[0.0; 4], wgpu::BufferUsages::UNIFORM);
            let views = gpu.texture([1, 1], RADIANCE, 1, &[0; 16]);
            let group = self.group(&light, &views);
            let targets: [wgpu::Texture; 3] = std::array::from_fn(|_| self.target(RADIANCE));
            self.draw(&pipeline, &group, None, &targets);
            let [frames, normals, views] = targets.map(|target| self.read(&target));
            let surface = |((frame, normal), view): ((&[f32; 4], &[f32; 4]), &[f32; 4])| {
                (normal[3] > 0.5).then(|| Surface {
                    frame: frame.map(f64::from),
                    normal: [normal[0], normal[1], normal[2]].map(f64::from),
                    view: [view[0], view[1], view[2]].map(f64::from),
                })
            };
            frames.iter().zip(&normals).zip(&views).map(surface).collect()
        })
    }

    /// The radiance that the shader of an order and a method gives; `table` holds the subject's reflectance and `light`
    /// its light, both of the shading's order. `tables` are those of the light where the method reads tables.
    ///
    /// # Errors
    ///
    /// If the shader is too long, the table too large, or the device fails.
    pub fn frame(
        &self,
        shading: Shading,
        table: &Table,
        light: &Projection,
        tables: Option<&Tables>,
        timed: bool,
    ) -> Result<Frame, Diagnostic> {
        let gpu = self.gpu;
        let size = [table.azimuths * table.stride() / 4, table.elevations];
        if size.iter().any(|&side| side > gpu.limits.max_texture_dimension_2d as usize) {
            let message =
                format!("the table of `{}` at order {} is too large for {}", self.subject.brdf, table.order, gpu.name);
            return Err(Diagnostic::nowhere(message, "take a lower order, or a rougher reflectance"));
        }
        let pipeline = gpu.pipeline(Some(shading))?;
        gpu.checked("cannot draw", || {
            let mut numbers: Vec<f32> =
                light.coefficients.iter().flat_map(|&[r, g, b]| [r, g, b, 0.0]).map(|x| x as f32).collect();
            if let (Some(tables), Some(first)) = (tables, numbers.first_mut()) {
                *first = tables.scale as f32;
            }
            let tables = tables.map(|tables| gpu.tables(tables));
            let light = gpu.buffer(&numbers, wgpu::BufferUsages::UNIFORM);
            let views = gpu.texture(size, RADIANCE, 1, bytemuck::cast_slice(&table.values));
            let group = self.group(&light, &views);
            let target = [self.target(RADIANCE)];
            self.draw(&pipeline, &group, tables.as_ref(), &target);
            let mut times: Vec<f64> = (0..if timed { TIMED } else { 0 })
                .map(|_| {
                    let start = Instant::now();
                    self.draw(&pipeline, &group, tables.as_ref(), &target);
                    1e3 * start.elapsed().as_secs_f64()
                })
                .collect();
            times.sort_by(f64::total_cmp);
            let pixel = |p: &[f32; 4]| (p[3] > 0.5).then(|| [p[0], p[1], p[2]].map(f64::from));
            let pixels = self.read(&target[0]).iter().map(pixel).collect();
            Frame { size: self.size, pixels, milliseconds: times.get(TIMED / 2).copied().unwrap_or(0.0) }
        })
    }

    fn group(&self, light: &wgpu::Buffer, views: &wgpu::TextureView) -> wgpu::BindGroup {
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        self.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.gpu.layout,
            entries: &[
                entry(0, self.camera.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(&self.normals)),
                entry(2, wgpu::BindingResource::Sampler(&self.sampler)),
                entry(3, light.as_entire_binding()),
                entry(4, wgpu::BindingResource::TextureView(views)),
            ],
        })
    }

    fn target(&self, format: wgpu::TextureFormat) -> wgpu::Texture {
        self.gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: extent(self.size),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    }

    /// Draws once and waits for it.
    fn draw(
        &self,
        pipeline: &wgpu::RenderPipeline,
        group: &wgpu::BindGroup,
        tables: Option<&wgpu::BindGroup>,
        targets: &[wgpu::Texture],
    ) {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let (depth, views): (_, Vec<_>) = (view(&self.target(DEPTH)), targets.iter().map(view).collect());
        let colour = |view| {
            let ops =
                wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store };
            Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
        };
        let attachments: Vec<_> = views.iter().map(colour).collect();
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &attachments,
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &depth,
                    depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            if let Some(tables) = tables {
                pass.set_bind_group(1, tables, &[]);
            }
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..self.subject.mesh.indices.len() as u32, 0, 0..1);
        }
        self.gpu.queue.submit([encoder.finish()]);
        // A device that is lost says so when its results are read.
        let _ = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
    }

    /// The texels of a target of four floats.
    fn read(&self, texture: &wgpu::Texture) -> Vec<[f32; 4]> {
        let [width, height] = self.size;
        let row = (16 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
        let buffer = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: (row * height) as u64,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row as u32), rows_per_image: None };
        let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, extent(self.size));
        self.gpu.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |_| ());
        let _ = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
        let Ok(bytes) = buffer.get_mapped_range(..) else {
            return vec![[0.0; 4]; width * height];
        };
        let rows = bytes.chunks_exact(row).map(|row| bytemuck::pod_collect_to_vec::<u8, [f32; 4]>(&row[..16 * width]));
        rows.flatten().collect()
    }
}
