struct VertexOutput { position: vec4f }
struct View { viewport: vec4f }
struct Globals { time: f32, delta_time: f32, frame_count: u32 }
var<private> view: View;
var<private> globals: Globals;
$shader
@fragment fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    view = View(vec4f(0.0, 0.0, toyproof_frame.iResolution.xy));
    globals = Globals(toyproof_frame.iTime, toyproof_frame.iTimeDelta, u32(toyproof_frame.iFrame));
    inputs.iFrameRate = toyproof_frame.iFrameRate; //? iFrameRate
    inputs.iChannelTime = toyproof_frame.iChannelTime; //? iChannelTime
    inputs.iChannelResolution = toyproof_frame.iChannelResolution; //? iChannelResolution
    inputs.iMouse = toyproof_frame.iMouse; //? iMouse
    inputs.iDate = toyproof_frame.iDate; //? iDate
    return fragment(VertexOutput(position));
}
