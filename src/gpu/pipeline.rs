//! The bindings that every translated shader sees, and the pipeline that runs its words.

use std::num::NonZeroU64;

use wgpu::{
    BindGroup, BindGroupLayout, BindGroupLayoutEntry, BindingType, Buffer, BufferUsages, Device,
    PipelineLayout, RenderPipeline, ShaderModule, ShaderStages, TextureFormat, TextureUsages,
};

use crate::frame::{BLOCK_BYTES, Frame};
use crate::image::Image;

/// The format of every target and texture: 32-bit floats, so that nothing is rounded on the way.
pub(super) const FORMAT: TextureFormat = TextureFormat::Rgba32Float;

/// Three vertices that cover the target, and three more outside of it: drawing those compiles everything
/// and paints nothing.
const VERTICES: &str = "
@vertex fn main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = index % 3u;
    let outside = f32(index / 3u) * 8.0;
    return vec4f(f32(corner & 1u) * 4.0 - 1.0 + outside, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}";

/// What all pipelines of a device share.
#[derive(Debug)]
pub(super) struct Layout {
    bindings: BindGroupLayout,
    pipeline: PipelineLayout,
    vertices: ShaderModule,
}

impl Layout {
    /// All nine bindings of the contract; wgpu numbers them anew without gaps, so none may be left out.
    pub(super) fn new(device: &Device, filterable: bool) -> Self {
        let block = BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: NonZeroU64::new(BLOCK_BYTES as u64),
        };
        let texture = BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let filtering = if filterable {
            wgpu::SamplerBindingType::Filtering
        } else {
            wgpu::SamplerBindingType::NonFiltering
        };
        let pairs = [texture, BindingType::Sampler(filtering)]
            .into_iter()
            .cycle()
            .take(8);
        let entries: Vec<_> = (0..)
            .zip(std::iter::once(block).chain(pairs))
            .map(|(binding, ty)| BindGroupLayoutEntry {
                binding,
                visibility: ShaderStages::FRAGMENT,
                ty,
                count: None,
            })
            .collect();
        let bindings = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &entries,
        });
        let pipeline = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            bind_group_layouts: &[Some(&bindings)],
            ..Default::default()
        });
        let vertices = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(VERTICES.into()),
        });
        Self {
            bindings,
            pipeline,
            vertices,
        }
    }

    /// The pipeline that paints with these words, which naga wrote from a module that it validated.
    pub(super) fn pipeline(&self, device: &Device, words: &[u32]) -> RenderPipeline {
        let fragment = module(device, words);
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&self.pipeline),
            vertex: wgpu::VertexState {
                module: &self.vertices,
                entry_point: Some("main"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &fragment,
                entry_point: Some("main"),
                compilation_options: Default::default(),
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// The frame's block and channels, bound.
    pub(super) fn bind(
        &self,
        device: &Device,
        queue: &wgpu::Queue,
        frame: &Frame,
        filterable: bool,
    ) -> BindGroup {
        let block = uniform(device, queue, &frame.block());
        let filter = if filterable {
            wgpu::FilterMode::Linear
        } else {
            wgpu::FilterMode::Nearest
        };
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            mag_filter: filter,
            min_filter: filter,
            ..Default::default()
        });
        let black = Image::new(1, 1, vec![[0.0, 0.0, 0.0, 1.0]]);
        let views = frame
            .channels
            .each_ref()
            .map(|channel| texture(device, queue, channel.as_ref().unwrap_or(&black)));
        let pairs = views.iter().flat_map(|view| {
            [
                wgpu::BindingResource::TextureView(view),
                wgpu::BindingResource::Sampler(&sampler),
            ]
        });
        let entries: Vec<_> = (0..)
            .zip(std::iter::once(block.as_entire_binding()).chain(pairs))
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.bindings,
            entries: &entries,
        })
    }
}

#[expect(
    unsafe_code,
    reason = "only a passthrough module runs naga's words as they are"
)]
fn module(device: &Device, words: &[u32]) -> ShaderModule {
    let entry = wgpu::PassthroughShaderEntryPoint {
        name: "main".into(),
        workgroup_size: (0, 0, 0),
    };
    let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
        entry_points: std::slice::from_ref(&entry).into(),
        spirv: Some(words.into()),
        ..Default::default()
    };
    // SAFETY: the words are naga's for a module that it validated, with indices clamped; what a driver makes of
    // them happens in a process of its own.
    unsafe { device.create_shader_module_passthrough(descriptor) }
}

fn uniform(device: &Device, queue: &wgpu::Queue, bytes: &[u8]) -> Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: bytes.len() as u64,
        usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&buffer, 0, bytes);
    buffer
}

/// A channel's texture: row 0 is the bottom, as texture coordinates have it.
fn texture(device: &Device, queue: &wgpu::Queue, image: &Image) -> wgpu::TextureView {
    let [width, height] = image.size();
    let size = wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    });
    queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(image.pixels()),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(16 * width),
            rows_per_image: None,
        },
        size,
    );
    texture.create_view(&Default::default())
}
