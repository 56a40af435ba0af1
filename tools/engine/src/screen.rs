//! A GPU with the buffers of a cloth, which draws it into memory.

use std::error::Error;

use bytemuck::{Pod, Zeroable, cast_slice};
use wgpu::{BufferUsages, Device, Queue, TextureFormat, TextureUsages};

/// The width and height of the picture in pixels. A row has a multiple of 256 bytes, as copies need.
pub(crate) const SIZE: u32 = 640;

const EXTENT: wgpu::Extent3d = wgpu::Extent3d {
    width: SIZE,
    height: SIZE,
    depth_or_array_layers: 1,
};
const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// A slot of the vertex buffer.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Vertex {
    pub(crate) position: [f32; 3],
    pub(crate) normal: [f32; 3],
    pub(crate) texture: [f32; 2],
}

pub(crate) struct Screen {
    device: Device,
    queue: Queue,
    pipeline: wgpu::RenderPipeline,
    pub(crate) vertices: GrowingBuffer,
    pub(crate) indices: GrowingBuffer,
}

impl Screen {
    pub(crate) fn new() -> Result<Screen, Box<dyn Error>> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        let shader = device.create_shader_module(wgpu::include_wgsl!("cloth.wgsl"));
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<Vertex>() as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x2],
                })],
            },
            primitive: Default::default(), // Both sides of the cloth are drawn.
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(TextureFormat::Rgba8Unorm.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let vertices = GrowingBuffer::new(&device, &queue, BufferUsages::VERTEX);
        let indices = GrowingBuffer::new(&device, &queue, BufferUsages::INDEX);
        Ok(Screen {
            device,
            queue,
            pipeline,
            vertices,
            indices,
        })
    }

    /// Returns the pixels of what the buffers hold, row by row, four bytes each.
    pub(crate) fn draw(
        &self,
        camera: [[f32; 4]; 4],
        corners: usize,
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let [picture, depth] = [TextureFormat::Rgba8Unorm, DEPTH].map(|format| {
            self.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: EXTENT,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        });
        let [color, far] =
            [&picture, &depth].map(|texture| texture.create_view(&Default::default()));
        let mut uniform = GrowingBuffer::new(&self.device, &self.queue, BufferUsages::UNIFORM);
        uniform.set(&camera);
        let bound = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: uniform.buffer.as_entire_binding(),
            }],
        });
        let pixels = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(4 * SIZE * SIZE),
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut commands = self.device.create_command_encoder(&Default::default());
        let mut pass = commands.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &far,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &bound, &[]);
        pass.set_vertex_buffer(0, self.vertices.buffer.slice(..));
        pass.set_index_buffer(self.indices.buffer.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..corners as u32, 0, 0..1);
        drop(pass);
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * SIZE),
            rows_per_image: None,
        };
        let to = wgpu::TexelCopyBufferInfo {
            buffer: &pixels,
            layout,
        };
        commands.copy_texture_to_buffer(picture.as_image_copy(), to, EXTENT);
        self.queue.submit([commands.finish()]);
        pixels.slice(..).map_async(wgpu::MapMode::Read, |mapped| {
            mapped.expect("it can be read")
        });
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        Ok(pixels.slice(..).get_mapped_range()?.to_vec())
    }
}

/// A buffer on the GPU.
pub(crate) struct GrowingBuffer {
    device: Device,
    queue: Queue,
    usage: BufferUsages,
    buffer: wgpu::Buffer,
}

impl GrowingBuffer {
    fn new(device: &Device, queue: &Queue, usage: BufferUsages) -> GrowingBuffer {
        let usage = usage | BufferUsages::COPY_DST;
        let (device, queue) = (device.clone(), queue.clone());
        let buffer = allocate(&device, usage, 64);
        GrowingBuffer {
            device,
            queue,
            usage,
            buffer,
        }
    }

    /// Writes all values.
    pub(crate) fn set<T: Pod>(&mut self, values: &[T]) {
        let bytes: &[u8] = cast_slice(values);
        if self.buffer.size() < bytes.len() as u64 {
            self.buffer = allocate(&self.device, self.usage, 2 * bytes.len() as u64);
        }
        self.queue.write_buffer(&self.buffer, 0, bytes);
    }

    /// Writes the values that changed, by their indices, and returns the number of bytes written.
    pub(crate) fn update<T: Pod>(&mut self, values: &[T], changed: &[u32]) -> usize {
        if self.buffer.size() < size_of_val(values) as u64 {
            self.set(values);
            return size_of_val(values);
        }
        let runs = changed.chunk_by(|index, next| index + 1 == *next);
        for run in runs {
            let first = run[0] as usize;
            let bytes = cast_slice(&values[first..][..run.len()]);
            let at = first * size_of::<T>();
            self.queue.write_buffer(&self.buffer, at as u64, bytes);
        }
        changed.len() * size_of::<T>()
    }
}

fn allocate(device: &Device, usage: BufferUsages, size: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size,
        usage,
        mapped_at_creation: false,
    })
}
