diagnostic(off, derivative_uniformity); //? derivatives
//? derivatives
struct Inputs { //? inputs
    $members //? inputs
} //? inputs
//? inputs
@group(0) @binding(0) var<uniform> inputs: Inputs; //? inputs
@group(0) @binding(1) var iChannel0: texture_$shape0<f32>; //? channel0
@group(0) @binding(2) var iChannel0_sampler: sampler; //? channel0
@group(0) @binding(3) var iChannel1: texture_$shape1<f32>; //? channel1
@group(0) @binding(4) var iChannel1_sampler: sampler; //? channel1
@group(0) @binding(5) var iChannel2: texture_$shape2<f32>; //? channel2
@group(0) @binding(6) var iChannel2_sampler: sampler; //? channel2
@group(0) @binding(7) var iChannel3: texture_$shape3<f32>; //? channel3
@group(0) @binding(8) var iChannel3_sampler: sampler; //? channel3
//? uniforms
struct Uniforms { //? uniforms
    $uniforms //? uniforms
} //? uniforms
//? uniforms
@group(0) @binding(9) var<uniform> uniforms: Uniforms; //? uniforms
//? inputs channels uniforms
var<private> gl_FragCoord: vec4f; //? position
//? position
$shader

@fragment
fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    gl_FragCoord = position; //? position
    $startup(); //? startup
    var color: vec4f; //? out
    var color: vec4f = vec4f(0.0, 0.0, 0.0, 1.0); //? inout
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    $main_image(&color, position.xy);
    return vec4f(color.xyz, 1.0); //? image
    return color; //? buffer
}
