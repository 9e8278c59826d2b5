//! Plays the passes of a converted project: those of `graph.json`, which `toyproof convert PROJECT -o FOLDER` writes.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

use serde_json::Value;

/// Three vertices that cover the target.
const VERTICES: &str = "@vertex fn main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}";

/// Renders a mipmap: each texel is the mean of its part of the next larger level.
const HALVING: &str = "@group(0) @binding(1) var larger: texture_2d<f32>;
@group(0) @binding(2) var linear: sampler;
@group(0) @binding(0) var<uniform> size: vec2f;
@fragment fn main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return textureSampleLevel(larger, linear, at.xy / size, 0.0);
}";

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// The frames in a second.
const RATE: f32 = 60.0;

/// A pass of the graph.
struct Pass {
    pipeline: wgpu::RenderPipeline,
    /// `image`, or `buffer-a` to `buffer-d`.
    target: String,
    /// What the channels read, and with which samplers.
    inputs: [Input; 4],
    samplers: [wgpu::Sampler; 4],
    makes_mipmaps: bool,
}

/// What a channel reads.
enum Input {
    /// A texture that does not change, and its size; 0 if nothing is bound.
    Fixed(wgpu::Texture, [f32; 2]),
    /// What a pass renders in this frame or in the previous one.
    Buffer(String, bool),
}

/// A target has two textures: one is rendered, the other holds the previous frame.
struct Target {
    textures: [wgpu::Texture; 2],
    /// The one that holds this frame, after its pass, or the previous frame, before.
    last: usize,
    is_rendered: bool,
}

/// Renders the frames from 0 on, and returns the last image: rows from the bottom, four bytes a pixel.
///
/// # Errors
/// If the graph is of another version, or the device cannot play it.
pub(crate) async fn render(
    graph: &Path,
    [width, height]: [u32; 2],
    frames: u32,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = instance
        .request_adapter(&wgpu::RequestAdapterOptions::default())
        .await?;
    // Buffers hold 32-bit floats; those that are sampled linearly need the first feature, and SPIR-V the second.
    let required_features =
        wgpu::Features::FLOAT32_FILTERABLE | (adapter.features() & wgpu::Features::PASSTHROUGH_SHADERS);
    let (device, queue) = adapter
        .request_device(&wgpu::DeviceDescriptor {
            required_features,
            ..Default::default()
        })
        .await?;
    let host = Host {
        layout: layout(&device),
        device,
        queue,
        size: [width, height],
    };
    let text = std::fs::read_to_string(graph)?;
    let json: Value = serde_json::from_str(&text)?;
    if json["version"] != 1 {
        return Err("graph.json has another version".into());
    }
    let folder = graph.parent().unwrap_or(Path::new("."));
    let passes = json["passes"].as_array().ok_or("graph.json has no passes")?;
    let passes: Result<Vec<Pass>, _> = passes.iter().map(|pass| host.pass(folder, pass)).collect();
    let passes = passes?;
    // A buffer that no pass renders stays zero.
    let read = passes
        .iter()
        .flat_map(|pass| &pass.inputs)
        .filter_map(|input| match input {
            Input::Buffer(name, _) => Some(name),
            Input::Fixed(..) => None,
        });
    let names = passes.iter().map(|pass| &pass.target).chain(read);
    let mut targets = BTreeMap::new();
    for name in names {
        let has_mipmaps = passes
            .iter()
            .any(|pass| pass.target == *name && pass.makes_mipmaps);
        targets
            .entry(name.clone())
            .or_insert_with(|| host.target(has_mipmaps));
    }
    let halving = host.pipeline(&host.module(HALVING));
    for frame in 0..frames {
        for target in targets.values_mut() {
            target.is_rendered = false;
        }
        for pass in &passes {
            host.draw(pass, &targets, frame);
            let Some(target) = targets.get_mut(&pass.target) else {
                continue;
            };
            target.last = 1 - target.last;
            target.is_rendered = true;
            if pass.makes_mipmaps {
                host.make_mipmaps(&halving, &target.textures[target.last]);
            }
        }
    }
    let image = &targets["image"];
    host.read(&image.textures[image.last])
}

struct Host {
    device: wgpu::Device,
    queue: wgpu::Queue,
    layout: wgpu::BindGroupLayout,
    size: [u32; 2],
}

/// Group 0: the uniform block at binding 0, the texture of channel K at 1 + 2K, its sampler at 2 + 2K.
fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let block = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let types = std::iter::once(block).chain([texture, sampler].into_iter().cycle().take(8));
    let entries = (0..).zip(types).map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    });
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &entries.collect::<Vec<_>>(),
    })
}

impl Host {
    /// Reads a pass of the graph, and compiles it.
    fn pass(&self, folder: &Path, json: &Value) -> Result<Pass, Box<dyn Error>> {
        let file = json["file"].as_str().ok_or("a pass has no file")?;
        let bytes = std::fs::read(folder.join(file))?;
        let module = match file.rsplit('.').next() {
            Some("wgsl") => self.module(&String::from_utf8(bytes)?),
            Some("spv") => self.passthrough(&bytes),
            _ => return Err(format!("{file} is neither WGSL nor SPIR-V").into()),
        };
        let channels = [0, 1, 2, 3].map(|channel| &json["inputs"][channel]);
        let name = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let inputs = channels.map(|input| match input["source"].as_str() {
            Some("buffer") => Input::Buffer(name(&input["buffer"]), input["frame"] == "this"),
            Some("keyboard") => self.fixed([256, 3], [256.0, 3.0]),
            // Load the file of the texture here, with its mipmaps if `mipmaps` is true. Now it is black.
            Some(_) => self.fixed([1, 1], [1.0, 1.0]),
            None => self.fixed([1, 1], [0.0, 0.0]),
        });
        Ok(Pass {
            pipeline: self.pipeline(&module),
            target: name(&json["target"]),
            inputs,
            samplers: channels.map(|input| self.sampler(&name(&input["filter"]), &name(&input["wrap"]))),
            makes_mipmaps: json["mipmaps"] == true,
        })
    }

    /// Only `mipmap` reads other levels than the largest.
    fn sampler(&self, filter: &str, wrap: &str) -> wgpu::Sampler {
        let address = if wrap == "repeat" {
            wgpu::AddressMode::Repeat
        } else {
            wgpu::AddressMode::ClampToEdge
        };
        let (within, between) = match filter {
            "mipmap" => (wgpu::FilterMode::Linear, wgpu::MipmapFilterMode::Linear),
            "linear" => (wgpu::FilterMode::Linear, wgpu::MipmapFilterMode::Nearest),
            _ => (wgpu::FilterMode::Nearest, wgpu::MipmapFilterMode::Nearest),
        };
        self.device.create_sampler(&wgpu::SamplerDescriptor {
            address_mode_u: address,
            address_mode_v: address,
            mag_filter: within,
            min_filter: within,
            mipmap_filter: between,
            lod_max_clamp: if filter == "mipmap" { 32.0 } else { 0.0 },
            ..Default::default()
        })
    }

    /// A texture of opaque black, with the size for `iChannelResolution`.
    fn fixed(&self, [width, height]: [u32; 2], size: [f32; 2]) -> Input {
        let texture = self.texture([width, height], 1);
        let black = [0.0f32, 0.0, 0.0, 1.0].map(f32::to_le_bytes).concat();
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(16 * width),
            rows_per_image: None,
        };
        let texels = black.repeat((width * height) as usize);
        self.queue
            .write_texture(texture.as_image_copy(), &texels, layout, texture.size());
        Input::Fixed(texture, size)
    }

    /// New textures are zero.
    fn target(&self, has_mipmaps: bool) -> Target {
        let [width, height] = self.size;
        let levels = if has_mipmaps {
            width.max(height).ilog2() + 1
        } else {
            1
        };
        Target {
            textures: [self.texture(self.size, levels), self.texture(self.size, levels)],
            last: 0,
            is_rendered: false,
        }
    }

    fn texture(&self, [width, height]: [u32; 2], mip_level_count: u32) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC
                | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    }

    /// Renders a pass over the texture that does not hold the last frame of its target: pixels that are discarded
    /// keep what it holds. The image has one texture on the site, so it continues from the last frame.
    fn draw(&self, pass: &Pass, targets: &BTreeMap<String, Target>, frame: u32) {
        let target = &targets[&pass.target];
        let into = &target.textures[1 - target.last];
        let mut commands = self.device.create_command_encoder(&Default::default());
        if pass.target == "image" {
            let last = target.textures[target.last].as_image_copy();
            commands.copy_texture_to_texture(last, into.as_image_copy(), into.size());
        }
        let channels = pass.inputs.each_ref().map(|input| match input {
            Input::Fixed(texture, size) => (texture, *size),
            Input::Buffer(name, is_of_this_frame) => {
                let target = &targets[name];
                let has_it_last = target.is_rendered == *is_of_this_frame;
                let at = if has_it_last { target.last } else { 1 - target.last };
                (&target.textures[at], self.size.map(|side| side as f32))
            }
        });
        let views = channels.map(|(texture, _)| texture.create_view(&Default::default()));
        let block = inputs(self.size, frame, channels.map(|(_, size)| size));
        let samplers = pass.samplers.each_ref();
        self.submit(
            commands,
            &pass.pipeline,
            &block,
            &views.each_ref(),
            &samplers,
            into,
            0,
        );
    }

    fn make_mipmaps(&self, halving: &wgpu::RenderPipeline, texture: &wgpu::Texture) {
        let linear = self.sampler("linear", "clamp");
        for level in 1..texture.mip_level_count() {
            let size = [texture.width(), texture.height()].map(|side| (side >> level).max(1) as f32);
            let larger = texture.create_view(&wgpu::TextureViewDescriptor {
                base_mip_level: level - 1,
                mip_level_count: Some(1),
                ..Default::default()
            });
            let mut block = [0; 208];
            block[..8].copy_from_slice(&size.map(f32::to_le_bytes).concat());
            let commands = self.device.create_command_encoder(&Default::default());
            self.submit(
                commands,
                halving,
                &block,
                &[&larger; 4],
                &[&linear; 4],
                texture,
                level,
            );
        }
    }

    #[expect(clippy::too_many_arguments, reason = "they are what one draw call needs")]
    fn submit(
        &self,
        mut commands: wgpu::CommandEncoder,
        pipeline: &wgpu::RenderPipeline,
        block: &[u8; 208],
        views: &[&wgpu::TextureView; 4],
        samplers: &[&wgpu::Sampler; 4],
        into: &wgpu::Texture,
        level: u32,
    ) {
        let uniforms = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 208,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&uniforms, 0, block);
        let pairs = views.iter().zip(samplers).flat_map(|(view, sampler)| {
            [
                wgpu::BindingResource::TextureView(view),
                wgpu::BindingResource::Sampler(sampler),
            ]
        });
        let resources = std::iter::once(uniforms.as_entire_binding()).chain(pairs);
        let entries = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.layout,
            entries: &entries.collect::<Vec<_>>(),
        });
        let view = into.create_view(&wgpu::TextureViewDescriptor {
            base_mip_level: level,
            mip_level_count: Some(1),
            ..Default::default()
        });
        {
            let mut pass = commands.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    // Targets are never cleared.
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Load,
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
        }
        self.queue.submit([commands.finish()]);
    }

    fn module(&self, text: &str) -> wgpu::ShaderModule {
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(text.into()),
        })
    }

    #[expect(unsafe_code, reason = "wgpu has no safe way to run SPIR-V unchanged")]
    fn passthrough(&self, bytes: &[u8]) -> wgpu::ShaderModule {
        let words = bytes.chunks_exact(4);
        let words: Vec<u32> = words
            .map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
            .collect();
        let entry = wgpu::PassthroughShaderEntryPoint {
            name: "main".into(),
            workgroup_size: (0, 0, 0),
        };
        let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
            entry_points: std::slice::from_ref(&entry).into(),
            spirv: Some(words.into()),
            ..Default::default()
        };
        // SAFETY: `toyproof convert --verify` proved the module; wgpu does not validate it.
        unsafe { self.device.create_shader_module_passthrough(descriptor) }
    }

    fn pipeline(&self, fragment: &wgpu::ShaderModule) -> wgpu::RenderPipeline {
        let layout = self
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                bind_group_layouts: &[Some(&self.layout)],
                ..Default::default()
            });
        self.device
            .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &self.module(VERTICES),
                    entry_point: None,
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                fragment: Some(wgpu::FragmentState {
                    module: fragment,
                    entry_point: Some("main"),
                    compilation_options: Default::default(),
                    targets: &[Some(FORMAT.into())],
                }),
                primitive: Default::default(),
                depth_stencil: None,
                multisample: Default::default(),
                multiview_mask: None,
                cache: None,
            })
    }

    /// Reads an image back, in eight bits.
    fn read(&self, texture: &wgpu::Texture) -> Result<Vec<u8>, Box<dyn Error>> {
        let [width, height] = self.size;
        // Rows are multiples of 256 bytes.
        let stride = (16 * width).next_multiple_of(256);
        let rows = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(stride * height),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let into = wgpu::TexelCopyBufferInfo {
            buffer: &rows,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(stride),
                rows_per_image: None,
            },
        };
        let mut commands = self.device.create_command_encoder(&Default::default());
        commands.copy_texture_to_buffer(texture.as_image_copy(), into, texture.size());
        self.queue.submit([commands.finish()]);
        rows.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let mapped = rows.slice(..).get_mapped_range()?;
        let byte = |component: &[u8]| {
            let value = f32::from_le_bytes([component[0], component[1], component[2], component[3]]);
            (value.clamp(0.0, 1.0) * 255.0).round_ties_even() as u8
        };
        let rows = mapped
            .chunks(stride as usize)
            .flat_map(|row| row[..16 * width as usize].chunks(4));
        Ok(rows.map(byte).collect())
    }
}

/// ShaderToy's inputs at the offsets of the uniform block; the mouse is idle, and the date zero.
fn inputs(size: [u32; 2], frame: u32, channels: [[f32; 2]; 4]) -> [u8; 208] {
    let mut block = [0; 208];
    let mut put = |at: usize, values: &[f32]| {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        block[at..at + bytes.len()].copy_from_slice(&bytes);
    };
    put(0, &[size[0] as f32, size[1] as f32, 1.0]); // iResolution
    put(12, &[frame as f32 / RATE, 1.0 / RATE]); // iTime, iTimeDelta
    put(24, &[RATE]); // iFrameRate
    for (channel, [width, height]) in channels.into_iter().enumerate() {
        let depth = f32::from(u8::from(width > 0.0));
        put(96 + 16 * channel, &[width, height, depth]); // iChannelResolution
    }
    put(160, &[0.0, 0.0, -0.0, -0.0]); // iMouse
    put(192, &[44_100.0]); // iSampleRate
    block[20..24].copy_from_slice(&frame.to_le_bytes()); // iFrame
    block
}
