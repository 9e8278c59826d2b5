//! Compiles a GLSL fragment shader of any host for wgpu, and lists the bindings that its pipeline needs. This
//! runs without a GPU: `cargo run --example wgpu -- glsl/02-sphere.glsl`

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::borrow::Cow;
use std::error::Error;

use toyproof::translate::naga::{Module, TypeInner};
use toyproof::translate::{ModuleOptions, glsl_to_module};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: wgpu SHADER.glsl")?;
    let text = std::fs::read_to_string(&path)?;
    // A device that checks everything and renders nothing; a program requests one of an adapter.
    let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());

    // In place of `wgpu::ShaderSource::Glsl`, with wgpu's feature `naga-ir` instead of `glsl`:
    let module = glsl_to_module(&text, &ModuleOptions::named(path))?;
    print_bindings(&module);
    let fragment = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
    });

    let _pipeline = pipeline(&device, &fragment);
    Ok(())
}

/// Three vertices that cover the target.
const VERTICES: &str = "@vertex fn main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}";

fn pipeline(device: &wgpu::Device, fragment: &wgpu::ShaderModule) -> wgpu::RenderPipeline {
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
            module: fragment,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(wgpu::TextureFormat::Rgba8Unorm.into())],
        }),
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        multiview_mask: None,
        cache: None,
    })
}

/// Prints the bindings of a module, with the members of its blocks.
fn print_bindings(module: &Module) {
    for (_, global) in module.global_variables.iter() {
        let Some(place) = global.binding else { continue };
        let ty = &module.types[global.ty];
        let name = global.name.as_ref().or(ty.name.as_ref());
        let name = name.map_or("", String::as_str);
        println!("group {}, binding {}: {name}", place.group, place.binding);
        if let TypeInner::Struct { members, span } = &ty.inner {
            for member in members {
                let name = member.name.as_deref().unwrap_or_default();
                println!("    {name} at byte {} of {span}", member.offset);
            }
        }
    }
}
