var<private> i_mouse: vec4f;
var<private> i_date: vec4f;
var<private> i_resolution: vec3f;
var<private> i_time: f32;
var<private> i_time_delta: f32;
var<private> i_frame: u32;
var<private> i_framerate: f32;
@group(0) @binding(1) var i_channel0: texture_2d<f32>; //? channel0
@group(0) @binding(2) var sampler0: sampler; //? channel0
@group(0) @binding(3) var i_channel1: texture_2d<f32>; //? channel1
@group(0) @binding(4) var sampler1: sampler; //? channel1
@group(0) @binding(5) var i_channel2: texture_2d<f32>; //? channel2
@group(0) @binding(6) var sampler2: sampler; //? channel2
@group(0) @binding(7) var i_channel3: texture_2d<f32>; //? channel3
@group(0) @binding(8) var sampler3: sampler; //? channel3
$shader
@fragment fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    i_mouse = toyproof_frame.iMouse;
    i_date = toyproof_frame.iDate;
    i_resolution = toyproof_frame.iResolution;
    i_time = toyproof_frame.iTime;
    i_time_delta = toyproof_frame.iTimeDelta;
    i_frame = u32(toyproof_frame.iFrame);
    i_framerate = toyproof_frame.iFrameRate;
    return shader_main(vec2f(position.x, i_resolution.y - position.y)); //? image
    return shader_main(position.xy); //? buffer
}
