struct VertexOutput { position: vec4f }
struct View { viewport: vec4f }
struct Globals { time: f32, delta_time: f32, frame_count: u32 }
var<private> view: View;
var<private> globals: Globals;
$shader
@fragment fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    view = View(vec4f(0.0, 0.0, toyproof_frame.resolution.xy));
    globals = Globals(toyproof_frame.time, toyproof_frame.time_delta, u32(toyproof_frame.frame));
    inputs.iFrameRate = toyproof_frame.frame_rate; //? iFrameRate
    inputs.iChannelTime = toyproof_frame.channel_time; //? iChannelTime
    inputs.iChannelResolution = toyproof_frame.channel_resolution; //? iChannelResolution
    inputs.iMouse = toyproof_frame.mouse; //? iMouse
    inputs.iDate = toyproof_frame.date; //? iDate
    return fragment(VertexOutput(position));
}
