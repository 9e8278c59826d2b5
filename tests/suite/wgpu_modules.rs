//! Modules of `glsl_to_module` in wgpu: it accepts them, and what a host writes into the block of uniforms is
//! what the shader reads.

use std::borrow::Cow;
use std::error::Error;
use std::fs;
use std::path::Path;

use toyproof::diagnostic::{File, Files};
use toyproof::eval::{Program, Settings};
use toyproof::glsl::{Options, UniformValue, check};
use toyproof::image::Frame;
use toyproof::translate::naga::{Module, TypeInner};
use toyproof::translate::{ModuleOptions, glsl_to_module};

use crate::requirements::require_driver;

/// Three vertices that cover the target.
const VERTICES: &str = "@vertex fn main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}";

/// The image has 16×1 pixels: rows of 256 bytes.
const SIZE: [u32; 2] = [16, 1];
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

fn pipeline(device: &wgpu::Device, module: Module) -> wgpu::RenderPipeline {
    let fragment = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
    });
    let vertices = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(VERTICES.into()),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &vertices,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        fragment: Some(wgpu::FragmentState {
            module: &fragment,
            entry_point: None,
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

/// The pixels of the image, with the bytes of the author's block at binding 9.
async fn render(module: Module, uniforms: &[u8]) -> Result<Vec<f32>, Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = instance.request_adapter(&Default::default()).await?;
    let (device, queue) = adapter.request_device(&Default::default()).await?;
    let pipeline = pipeline(&device, module);
    let buffer = |size, usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation: false,
        })
    };
    let block = buffer(
        uniforms.len() as u64,
        wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
    );
    queue.write_buffer(&block, 0, uniforms);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry {
            binding: 9,
            resource: block.as_entire_binding(),
        }],
    });
    let extent = wgpu::Extent3d {
        width: SIZE[0],
        height: SIZE[1],
        depth_or_array_layers: 1,
    };
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let rows = buffer(256, wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
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
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
    let into = wgpu::TexelCopyBufferInfo {
        buffer: &rows,
        layout: wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(256),
            rows_per_image: None,
        },
    };
    commands.copy_texture_to_buffer(target.as_image_copy(), into, extent);
    queue.submit([commands.finish()]);
    rows.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let mapped = rows.slice(..).get_mapped_range()?;
    let components = mapped.chunks_exact(4);
    Ok(components
        .map(|bytes| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
        .collect())
}

/// Numbers of a uniform, and the parts into which std140 divides it: each begins a multiple of 16 bytes after
/// the first.
struct Given {
    name: &'static str,
    parts: &'static [&'static [f64]],
    is_float: bool,
}

const fn given(name: &'static str, parts: &'static [&'static [f64]], is_float: bool) -> Given {
    Given {
        name,
        parts,
        is_float,
    }
}

/// Every type of which a uniform can be, with a value; all sums of products below are exact.
const GIVEN: [Given; 8] = [
    given("speed", &[&[0.5]], true),
    given("count", &[&[-3.0]], false),
    given("on", &[&[1.0]], false),
    given("sides", &[&[1.0, 0.0, 1.0]], false),
    given("tint", &[&[0.25, 2.0, 4.0]], true),
    given("size", &[&[8.0, 16.0]], true),
    given(
        "turn",
        &[&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0], &[7.0, 8.0, 9.0]],
        true,
    ),
    given("bits", &[&[3.0, 5.0, 7.0, 9.0]], false),
];

const DECLARATIONS: &str = "#version 300 es
precision highp float;
precision highp int;
uniform float speed;
uniform int count;
uniform bool on;
uniform bvec3 sides;
uniform vec3 tint;
uniform vec2 size;
uniform mat3 turn;
uniform uvec4 bits;
";

const MAIN: &str = "out vec4 color;
void main() {
    float at = floor(gl_FragCoord.x);
    vec3 turned = turn * tint;
    color = vec4(turned.x + at, turned.y * speed, turned.z + float(count), size.y - size.x);
    if (on && sides.x && !sides[1] && any(sides)) { color.xw += float(bits.y * bits.w); }
}
";

/// The bytes of the author's block with the given values, at the offsets that the module states.
fn block_bytes(module: &Module) -> Vec<u8> {
    let mut globals = module.global_variables.iter();
    let block = globals.find(|(_, global)| global.binding.is_some_and(|place| place.binding == 9));
    let TypeInner::Struct { members, span } = &module.types[block.unwrap().1.ty].inner else {
        panic!("binding 9 is no block");
    };
    let mut bytes = vec![0; *span as usize];
    for (member, given) in members.iter().zip(&GIVEN) {
        assert_eq!(member.name.as_deref(), Some(given.name));
        for (part, numbers) in given.parts.iter().enumerate() {
            for (at, &number) in numbers.iter().enumerate() {
                let from = member.offset as usize + 16 * part + 4 * at;
                let word = if given.is_float {
                    (number as f32).to_bits()
                } else {
                    number as i32 as u32
                };
                bytes[from..from + 4].copy_from_slice(&word.to_le_bytes());
            }
        }
    }
    bytes
}

#[test]
fn uniforms_are_what_the_host_writes_into_the_block() {
    if !require_driver() {
        return;
    }
    let text = DECLARATIONS.to_owned() + MAIN;
    let module = glsl_to_module(&text, &ModuleOptions::default()).unwrap();
    let bytes = block_bytes(&module);
    let rendered = pollster::block_on(render(module, &bytes)).unwrap();

    let values = GIVEN.map(|given| UniformValue {
        name: given.name.to_owned(),
        components: given.parts.concat(),
    });
    let options = Options {
        uniforms: values.into(),
        ..Options::default()
    };
    let mut files = Files::default();
    let file = files.add(File::new("uniforms.frag", text));
    let checked = check(&files, file, &options).unwrap();
    let frame = Frame {
        size: SIZE,
        ..Frame::default()
    };
    let evaluated = Program::new(&checked).unwrap();
    let evaluated = evaluated.render(&frame, &Settings::<f32>::default()).unwrap();
    // Sums and products of small integers and halves are exact, whatever the driver does with them. The
    // evaluator shows alpha as 1.
    let expected = evaluated.framebuffer.image();
    for (x, pixel) in rendered.chunks_exact(4).enumerate() {
        assert_eq!(pixel[..3], expected.get(x as u32, 0)[..3], "pixel {x}");
        assert_eq!(pixel[3], 8.0 + 45.0, "alpha of pixel {x}");
    }
}

#[test]
fn wgpu_accepts_the_modules_of_the_course() {
    let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    for folder in ["glsl", "glsl/2d"] {
        for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "glsl") {
                let name = path.to_string_lossy().into_owned();
                let text = fs::read_to_string(&path).unwrap();
                let module = glsl_to_module(&text, &ModuleOptions::named(name)).unwrap();
                // wgpu panics if it refuses the module or the pipeline.
                pipeline(&device, module);
            }
        }
    }
}
