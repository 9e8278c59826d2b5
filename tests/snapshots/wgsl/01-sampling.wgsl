// glsl/01-sampling.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// 2D figures as implicit functions, with f < 0 inside; several samples per pixel smooth their edges.

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SAMPLES: i32 = 10;

var<private> seed: f32;

fn random() -> f32 {
    // toyproof: allow(W0005) the scene's sampler uses this hash
    let old_seed = seed;
    seed += 1.0;
    return fract(sin(old_seed) * 43758.5453123);
}

fn disk(p: vec2f, center: vec2f, radius: f32) -> f32 {
    let d = p - center;
    return dot(d, d) - radius * radius;
}

// Below a sine wave.
fn wave(p: vec2f, height: f32, amplitude: f32, frequency: f32) -> f32 {
    return p.y - height - amplitude * sin(frequency * p.x);
}

fn heart(p: vec2f, center: vec2f, size: f32) -> f32 {
    let q = (p - center) / size;
    let ring = dot(q, q) - 1.0;
    return ring * ring * ring - q.x * q.x * q.y * q.y * q.y;
}

// The figure tested first is on top.
fn figures(p: vec2f) -> vec3f {
    if heart(p, vec2f(0.35, 0.08), 0.25) < 0.0 {
        return vec3f(0.85, 0.1, 0.2);
    }
    if disk(p, vec2f(-0.45, 0.15), 0.28) < 0.0 {
        return vec3f(1.0, 0.8, 0.2);
    }
    if wave(p, -0.2, 0.1, 9.0) < 0.0 {
        return vec3f(0.1, 0.35, 0.6);
    }
    return vec3f(0.75, 0.85, 0.95);
}

fn mainImage(fragColor: ptr<function, vec4f>, fragCoord: vec2f) {
    seed = 0.0;
    let aspect = inputs.iResolution.x / inputs.iResolution.y;
    var color = vec3f(0.0);
    for (var i = 0; i < SAMPLES; i++) {
        let fx = fragCoord.x + random() - 0.5;
        let fy = fragCoord.y + random() - 0.5;
        let x = fx / inputs.iResolution.x * 2.0 - 1.0;
        let y = (fy / inputs.iResolution.y * 2.0 - 1.0) / aspect;
        color += figures(vec2f(x, y));
    }
    *fragColor = vec4f(color / f32(SAMPLES), 1.0);
}

@fragment
fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    var color: vec4f;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(&color, position.xy);
    return vec4f(color.xyz, 1.0);
}
