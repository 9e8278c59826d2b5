//! The bindings of all translated shaders, and the pipeline that runs their SPIR-V.

use std::num::NonZeroU64;

use toyproof_image::{BLOCK_BYTES, Filter, Frame, Sampling, Wrap};
use toyproof_translate::naga_ir::Shape;
use wgpu::{
    BindGroup, BindGroupLayout, BindGroupLayoutEntry, BindingType, Buffer, BufferUsages, Device, Features,
    PipelineLayout, RenderPipeline, Sampler, ShaderModule, ShaderStages, TextureView,
};

use super::quirks::TWO_VARIANTS;
use super::texture::{FORMAT, black, dimension, upload, view};

/// Vertex shader with three vertices that cover the target, and three more outside of it: drawing those
/// compiles the pipeline without covering a pixel.
const VERTEX_SHADER: &str = "
@vertex fn main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = index % 3u;
    let outside = f32(index / 3u) * 8.0;
    return vec4f(f32(corner & 1u) * 4.0 - 1.0 + outside, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}";

/// Binding and pipeline layout of a program.
#[derive(Debug)]
pub(super) struct Layout {
    filterable: bool,
    blends: bool,
    channels: [Shape; 4],
    bindings: BindGroupLayout,
    pipeline: PipelineLayout,
    vertices: ShaderModule,
}

impl Layout {
    /// Creates the layout with all nine bindings of the interface. None may be omitted, since wgpu renumbers
    /// bindings without gaps.
    pub(super) fn new(owner: &super::device::Device, channels: [Shape; 4]) -> Self {
        let (device, filterable) = (&owner.gpu, owner.filterable);
        let block = BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: NonZeroU64::new(BLOCK_BYTES as u64),
        };
        let texture = |shape| BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable },
            view_dimension: dimension(shape),
            multisampled: false,
        };
        let filtering = if filterable {
            wgpu::SamplerBindingType::Filtering
        } else {
            wgpu::SamplerBindingType::NonFiltering
        };
        let pairs = channels
            .into_iter()
            .flat_map(|shape| [texture(shape), BindingType::Sampler(filtering)]);
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
            source: wgpu::ShaderSource::Wgsl(VERTEX_SHADER.into()),
        });
        Self {
            filterable,
            blends: owner.has(&TWO_VARIANTS) && device.features().contains(Features::FLOAT32_BLENDABLE),
            channels,
            bindings,
            pipeline,
            vertices,
        }
    }

    /// Creates the pipeline for the SPIR-V words of a fragment shader.
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
                targets: &[Some(wgpu::ColorTargetState {
                    format: FORMAT,
                    // Its bits are those of the color, but lavapipe then compiles the shader once.
                    blend: self.blends.then_some(wgpu::BlendState::REPLACE),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// Creates the views of a frame's channels.
    pub(super) fn views(&self, device: &Device, queue: &wgpu::Queue, frame: &Frame) -> [TextureView; 4] {
        std::array::from_fn(|channel| {
            let shape = self.channels[channel];
            let texture = frame.channels[channel].as_ref();
            let uploaded = texture.and_then(|texture| upload(device, queue, texture, shape));
            uploaded.map_or_else(|| black(device, queue, shape), |texture| view(&texture, shape))
        })
    }

    /// Creates the view of a channel that reads nothing.
    pub(super) fn unbound(&self, device: &Device, queue: &wgpu::Queue, channel: usize) -> TextureView {
        black(device, queue, self.channels[channel])
    }

    /// The shape that a channel is declared with.
    pub(super) fn shape(&self, channel: usize) -> Shape {
        self.channels[channel]
    }

    /// Creates the bind group of a frame: its uniform block and the views of its channels.
    pub(super) fn bind(
        &self,
        device: &Device,
        queue: &wgpu::Queue,
        block: &[u8],
        views: &[TextureView; 4],
        sampling: [Sampling; 4],
    ) -> BindGroup {
        let block = uniform(device, queue, block);
        let samplers = sampling.map(|sampling| self.sampler(device, sampling));
        let pairs = views.iter().zip(&samplers).flat_map(|(view, sampler)| {
            [
                wgpu::BindingResource::TextureView(view),
                wgpu::BindingResource::Sampler(sampler),
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

impl Layout {
    /// The sampler of a channel. Without mipmaps, GLSL reads the largest level whatever level is requested.
    fn sampler(&self, device: &Device, sampling: Sampling) -> Sampler {
        let Sampling { filter, wrap } = sampling;
        let mipmaps = filter == Filter::Mipmap;
        let address = match wrap {
            Wrap::Repeat => wgpu::AddressMode::Repeat,
            Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
        };
        let filter = if filter != Filter::Nearest && self.filterable {
            wgpu::FilterMode::Linear
        } else {
            wgpu::FilterMode::Nearest
        };
        let mipmap_filter = if mipmaps && self.filterable {
            wgpu::MipmapFilterMode::Linear
        } else {
            wgpu::MipmapFilterMode::Nearest
        };
        device.create_sampler(&wgpu::SamplerDescriptor {
            address_mode_u: address,
            address_mode_v: address,
            address_mode_w: address,
            mag_filter: filter,
            min_filter: filter,
            mipmap_filter,
            lod_max_clamp: if mipmaps { f32::from(MAX_LEVEL) } else { 0.0 },
            ..Default::default()
        })
    }
}

/// The number of the smallest mipmap that a texture may have.
const MAX_LEVEL: u8 = 32;

#[expect(
    unsafe_code,
    reason = "only a passthrough module runs naga's SPIR-V unchanged"
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
    // SAFETY: the words are naga's, for a module that it validated and with indices clamped, or those of a
    // compiler that is compared with naga; the driver that processes them runs in a separate process.
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
