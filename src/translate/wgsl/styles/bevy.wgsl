#import bevy_sprite::mesh2d_vertex_output::VertexOutput
#import bevy_sprite::mesh2d_view_bindings::{globals, view}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var iChannel0: texture_2d<f32>; //? channel0
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var iChannel0_sampler: sampler; //? channel0
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var iChannel1: texture_2d<f32>; //? channel1
@group(#{MATERIAL_BIND_GROUP}) @binding(3) var iChannel1_sampler: sampler; //? channel1
@group(#{MATERIAL_BIND_GROUP}) @binding(4) var iChannel2: texture_2d<f32>; //? channel2
@group(#{MATERIAL_BIND_GROUP}) @binding(5) var iChannel2_sampler: sampler; //? channel2
@group(#{MATERIAL_BIND_GROUP}) @binding(6) var iChannel3: texture_2d<f32>; //? channel3
@group(#{MATERIAL_BIND_GROUP}) @binding(7) var iChannel3_sampler: sampler; //? channel3
// The material provides these ShaderToy inputs, for example with `#[uniform(8)]`. //? inputs
struct Inputs { //? inputs
    $members //? inputs
} //? inputs
@group(#{MATERIAL_BIND_GROUP}) @binding(8) var<uniform> inputs: Inputs; //? inputs
var<private> gl_FragCoord: vec4f; //? position
//? position inputs
$shader

@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4f {
    // y points down here, and up in GLSL.
    let pixel = in.position.xy - view.viewport.xy;
    let frag_coord = vec2f(pixel.x, view.viewport.w - pixel.y);
    gl_FragCoord = vec4f(frag_coord, in.position.zw); //? position
    $startup(); //? startup
    var color: vec4f; //? out
    var color: vec4f = vec4f(0.0, 0.0, 0.0, 1.0); //? inout
    $main_image(&color, frag_coord);
    // The view takes linear colors; ShaderToy shows its values as they are.
    return vec4f(pow(saturate(color.xyz), vec3f(2.2)), 1.0);
}
