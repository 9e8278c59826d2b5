// glsl/02-sphere.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// One sphere, shaded by the cosine between the ray and the normal.

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

struct Sphere {
    center: vec3f,
    radius: f32,
    color: vec3f,
}

// The ray o + t d intersects |x - center|^2 = r^2 where t^2 + 2 b t + c = 0, for d of length 1.
fn intersectSphere(ray: Ray, sphere: Sphere) -> f32 {
    let f = ray.origin - sphere.center;
    let b = dot(f, ray.direction);
    let c = dot(f, f) - sphere.radius * sphere.radius;
    let disc = b * b - c;
    if disc > 0.0 {
        let root = sqrt(disc);
        var t = -b - root;
        if t > 0.00001 {
            return t;
        }
        t = -b + root;
        if t > 0.00001 {
            return t;
        }
    }
    return NO_HIT;
}

fn cameraRay(fragCoord: vec2f) -> Ray {
    let aspect = inputs.iResolution.x / inputs.iResolution.y;
    let x = fragCoord.x / inputs.iResolution.x * 2.0 - 1.0;
    let y = (fragCoord.y / inputs.iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3f(0.0), normalize(vec3f(x, y, SCREEN_DEPTH)));
}

fn mainImage(fragColor: ptr<function, vec4f>, fragCoord: vec2f) {
    let sphere = Sphere(vec3f(0.0, 0.0, -6.0), 1.5, vec3f(1.0, 1.0, 0.0));
    let ray = cameraRay(fragCoord);
    var color = vec3f(0.0);

    let t = intersectSphere(ray, sphere);
    if t < NO_HIT {
        let hitPoint = ray.origin + t * ray.direction;
        let normal = normalize(hitPoint - sphere.center);
        color = sphere.color * abs(dot(ray.direction, normal));
    }
    *fragColor = vec4f(color, 1.0);
}

@fragment
fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    var color: vec4f;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(&color, position.xy);
    return vec4f(color.xyz, 1.0);
}
