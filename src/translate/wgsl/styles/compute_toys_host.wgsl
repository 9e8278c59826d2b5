struct Time { frame: u32, elapsed: f32, delta: f32 }
var<private> time: Time;
struct Mouse { pos: vec2u, click: i32 } //? iMouse
var<private> mouse: Mouse; //? iMouse
var<private> toyproof_color: vec4f;
fn toyproof_size() -> vec2u { return vec2u(toyproof_frame.iResolution.xy); }
@group(0) @binding(1) var channel0: texture_2d<f32>; //? channel0
@group(0) @binding(3) var channel1: texture_2d<f32>; //? channel1
@group(0) @binding(2) var bilinear_repeat: sampler; //? channel0 channel1
$shader
@fragment fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    time = Time(u32(toyproof_frame.iFrame), toyproof_frame.iTime, toyproof_frame.iTimeDelta);
    let clicked = toyproof_frame.iMouse; //? iMouse
    let row = toyproof_frame.iResolution.y - clicked.y; //? iMouse
    mouse = Mouse(vec2u(u32(clicked.x), u32(row)), i32(clicked.z > 0.0)); //? iMouse
    main_image(vec3u(vec2u(position.xy), 0u));
    return toyproof_color;
}
