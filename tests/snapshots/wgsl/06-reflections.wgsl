// glsl/06-reflections.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Mirrors under an evening sky: the ray is reflected until it misses all mirrors.

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;
const EPSILON: f32 = 0.001;
const SPHERES: i32 = 4;
const MAX_DEPTH: i32 = 100;

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

struct Sphere {
    center: vec3f,
    radius: f32,
    color: vec3f,
}

var<private> spheres: array<Sphere, 4>;

fn makeScene() {
    spheres[0] = Sphere(vec3f(-1.3, -0.4, -5.2), 0.6, vec3f(0.9, 0.6, 0.6));
    spheres[1] = Sphere(vec3f(0.0, 0.0, -7.0), 1.2, vec3f(0.95, 0.93, 0.88));
    spheres[2] = Sphere(vec3f(0.2, -0.6, -3.6), 0.3, vec3f(0.7, 0.9, 0.7));
    spheres[3] = Sphere(vec3f(1.2, 0.5, -5.0), 0.7, vec3f(0.6, 0.7, 0.95));
}

fn sky(direction: vec3f) -> vec3f {
    let up = 0.5 * (1.0 + direction.y);
    return (1.0 - up) * vec3f(0.9, 0.5, 0.25) + up * vec3f(0.1, 0.2, 0.5);
}

// As in 02-sphere, but hits closer than t_min are ignored: they are on the surface that the ray just left.
fn intersectSphere(ray: Ray, sphere: Sphere, tMin: f32) -> f32 {
    let f = ray.origin - sphere.center;
    let b = dot(f, ray.direction);
    let c = dot(f, f) - sphere.radius * sphere.radius;
    let disc = b * b - c;
    if disc > 0.0 {
        let root = sqrt(disc);
        var t = -b - root;
        if t > tMin {
            return t;
        }
        t = -b + root;
        if t > tMin {
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
    makeScene();
    var ray = cameraRay(fragCoord);
    var color = vec3f(0.0);
    var throughput = vec3f(1.0);

    for (var depth = 0; depth < MAX_DEPTH; depth++) {
        var nearest = NO_HIT;
        var hit = -1;
        for (var i = 0; i < SPHERES; i++) {
            let t = intersectSphere(ray, spheres[i], EPSILON);
            if t < nearest {
                nearest = t;
                hit = i;
            }
        }
        if hit < 0 {
            color = throughput * sky(ray.direction);
            break;
        }
        let point = ray.origin + nearest * ray.direction;
        let normal = normalize(point - spheres[hit].center);
        throughput *= spheres[hit].color;
        ray = Ray(point, reflect(ray.direction, normal));
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
