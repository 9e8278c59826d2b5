//! A host for converted shaders: renders one frame of a WGSL or SPIR-V file to a PNG, or the 60th frame of a
//! project's passes.
//!
//!     toyproof convert glsl/02-sphere.glsl -o sphere.wgsl --verify
//!     cargo run --example host -- sphere.wgsl sphere.png
//!     toyproof convert waves -o converted --verify
//!     cargo run --example host -- converted/graph.json waves.png

mod passes;

use std::error::Error;
use std::path::Path;

const SIZE: [u32; 2] = [640, 360];
const TIME: f32 = 1.5;

/// Three vertices that cover the target.
const VERTICES: &str = "@vertex fn main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}";

/// The number of frames of a project that are played.
const FRAMES: u32 = 60;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(shader), Some(image)) = (arguments.next(), arguments.next()) else {
        return Err("usage: host SHADER.wgsl|SHADER.spv|GRAPH.json IMAGE.png".into());
    };
    let pixels = if Path::new(&shader)
        .extension()
        .is_some_and(|ending| ending == "json")
    {
        let rows = pollster::block_on(passes::render(Path::new(&shader), SIZE, FRAMES))?;
        // Row 0 is the bottom of the image.
        rows.chunks(4 * SIZE[0] as usize)
            .rev()
            .flatten()
            .copied()
            .collect()
    } else {
        pollster::block_on(render(&read(&shader)?))?
    };
    image::save_buffer(image, &pixels, SIZE[0], SIZE[1], image::ColorType::Rgba8)?;
    Ok(())
}

fn read(shader: &str) -> Result<Shader, Box<dyn Error>> {
    let file = std::fs::read(shader)?;
    if Path::new(shader).extension().is_none_or(|ending| ending != "spv") {
        return Ok(Shader::Wgsl(String::from_utf8(file)?));
    }
    let words = file.chunks_exact(4);
    let words = words.map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
    Ok(Shader::Spirv(words.collect()))
}

/// The content of a file.
enum Shader {
    Wgsl(String),
    Spirv(Vec<u32>),
}

/// ShaderToy's inputs at the offsets of the uniform block; all others are zero.
fn inputs() -> [u8; 208] {
    let mut block = [0; 208];
    let mut put = |at: usize, bytes: [u8; 4]| block[at..at + 4].copy_from_slice(&bytes);
    put(0, (SIZE[0] as f32).to_le_bytes()); // iResolution.x
    put(4, (SIZE[1] as f32).to_le_bytes()); // iResolution.y
    put(8, 1.0f32.to_le_bytes()); // iResolution.z
    put(12, TIME.to_le_bytes()); // iTime
    put(16, (1.0f32 / 60.0).to_le_bytes()); // iTimeDelta
    put(20, ((TIME * 60.0) as i32).to_le_bytes()); // iFrame
    put(24, 60.0f32.to_le_bytes()); // iFrameRate
    put(192, 44_100.0f32.to_le_bytes()); // iSampleRate
    block
}

/// The pipeline of a converted shader, which draws the three vertices `0..3`.
fn converted_pipeline(
    device: &wgpu::Device,
    fragment: &wgpu::ShaderModule,
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let vertices = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(VERTICES.into()),
    });
    // Group 0, binding 0 is the block of inputs. A shader that reads channel K also needs its texture at
    // 1 + 2K and its sampler at 2 + 2K.
    let group = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[Some(&group)],
        ..Default::default()
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &vertices,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        fragment: Some(wgpu::FragmentState {
            module: fragment,
            entry_point: Some("main"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        multiview_mask: None,
        cache: None,
    })
}

async fn render(shader: &Shader) -> Result<Vec<u8>, Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = instance
        .request_adapter(&wgpu::RequestAdapterOptions::default())
        .await?;
    // SPIR-V goes to the driver unchanged, which is an optional feature of wgpu.
    let required_features = match shader {
        Shader::Wgsl(_) => wgpu::Features::empty(),
        Shader::Spirv(_) => wgpu::Features::PASSTHROUGH_SHADERS,
    };
    let (device, queue) = adapter
        .request_device(&wgpu::DeviceDescriptor {
            required_features,
            ..Default::default()
        })
        .await?;
    let fragment = match shader {
        Shader::Wgsl(text) => device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(text.as_str().into()),
        }),
        Shader::Spirv(words) => passthrough(&device, words),
    };
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let pipeline = converted_pipeline(&device, &fragment, format);

    let block = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 208,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&block, 0, &inputs());
    let bound = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: block.as_entire_binding(),
        }],
    });
    let [width, height] = SIZE;
    let extent = wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    // 640 pixels of 4 bytes are a multiple of 256, as rows must be.
    let stride = 4 * width;
    let rows = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(stride * height),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });

    let view = target.create_view(&Default::default());
    let mut commands = device.create_command_encoder(&Default::default());
    {
        let mut pass = commands.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bound, &[]);
        pass.draw(0..3, 0..1);
    }
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(stride),
        rows_per_image: None,
    };
    let into = wgpu::TexelCopyBufferInfo {
        buffer: &rows,
        layout,
    };
    commands.copy_texture_to_buffer(target.as_image_copy(), into, extent);
    queue.submit([commands.finish()]);
    rows.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let mapped = rows.slice(..).get_mapped_range()?;
    // The target's first row is the bottom of the image: y of GLSL points up.
    Ok(mapped.chunks(stride as usize).rev().flatten().copied().collect())
}

#[expect(unsafe_code, reason = "wgpu has no safe way to run SPIR-V unchanged")]
fn passthrough(device: &wgpu::Device, words: &[u32]) -> wgpu::ShaderModule {
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
    unsafe { device.create_shader_module_passthrough(descriptor) }
}
