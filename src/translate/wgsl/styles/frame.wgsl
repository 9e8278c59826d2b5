
struct ToyproofFrame {
    resolution: vec3f,
    time: f32,
    time_delta: f32,
    frame: i32,
    @size(8) frame_rate: f32,
    channel_time: array<vec4f, 4>,
    channel_resolution: array<vec3f, 4>,
    mouse: vec4f,
    date: vec4f,
    sample_rate: f32,
}
@group(0) @binding(0) var<uniform> toyproof_frame: ToyproofFrame;
