// glsl/09-soft-shadows.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A spherical light subtends a cone of directions; each sample picks a random direction in it.

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;
const SAMPLES: i32 = 16;
const SPHERES: i32 = 4;
const AMBIENT = vec3f(0.25);

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

struct Sphere {
    center: vec3f,
    radius: f32,
    color: vec3f,
}

struct Light {
    position: vec3f,
    radius: f32,
    color: vec3f,
}

var<private> spheres: array<Sphere, 4>;
var<private> light: Light;
var<private> state: u32;

// The integer hash PCG (Jarzynski and Olano 2020), which gives the same numbers on every machine.
fn pcg(v: u32) -> u32 {
    let s = v * 747796405u + 2891336453u;
    let word = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return (word >> 22u) ^ word;
}

fn random() -> f32 {
    state = pcg(state);
    return f32(state >> 8u) / 16777216.0;
}

fn startSample(fragCoord: vec2f, i: i32) {
    state = pcg(u32(fragCoord.x) + pcg(u32(fragCoord.y) + pcg(u32(i))));
}

fn makeScene() {
    spheres[0] = Sphere(vec3f(0.0, -41.0, -8.0), 40.0, vec3f(0.7, 0.7, 0.65));
    spheres[1] = Sphere(vec3f(-1.3, -0.2, -6.5), 0.8, vec3f(0.9, 0.4, 0.2));
    spheres[2] = Sphere(vec3f(0.5, 0.6, -7.0), 0.6, vec3f(0.3, 0.7, 0.4));
    spheres[3] = Sphere(vec3f(1.5, -0.6, -5.5), 0.4, vec3f(0.3, 0.4, 0.9));
    light = Light(vec3f(3.0, 5.0, -5.0), 0.6, vec3f(0.7));
}

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

// The direction at an angle to w, given by its cosine, rotated about w by `turn` turns.
fn around(w: vec3f, cosine: f32, turn: f32) -> vec3f {
    let up = select(vec3f(0.0, 1.0, 0.0), vec3f(1.0, 0.0, 0.0), abs(w.y) > 0.9);
    let a = normalize(cross(up, w));
    let b = cross(w, a);
    let sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    let phi = 6.28318530718 * turn;
    return sine * cos(phi) * a + sine * sin(phi) * b + cosine * w;
}

// Samples a direction uniformly in the cone of the light; lightDistance is the distance to the light along it.
fn sampleLight(point: vec3f, lightDistance: ptr<function, f32>) -> vec3f {
    let toLight = light.position - point;
    let distance = length(toLight);
    let sine2 = light.radius * light.radius / (distance * distance);
    let depth = sine2 / (1.0 + sqrt(1.0 - sine2));
    let u = random();
    let v = random();
    let cosine = 1.0 - u * depth;
    let chord = sqrt(max(sine2 - (1.0 - cosine * cosine), 0.0));
    *lightDistance = distance * (cosine - chord);
    return around(toLight / distance, cosine, v);
}

fn inShadow(ray: Ray, distance: f32) -> bool {
    for (var i = 0; i < SPHERES; i++) {
        if intersectSphere(ray, spheres[i]) < distance {
            return true;
        }
    }
    return false;
}

fn trace(ray: Ray) -> vec3f {
    var nearest = NO_HIT;
    var hit = -1;
    for (var i = 0; i < SPHERES; i++) {
        let t = intersectSphere(ray, spheres[i]);
        if t < nearest {
            nearest = t;
            hit = i;
        }
    }
    if hit < 0 {
        return vec3f(0.4, 0.5, 0.7);
    }
    let point = ray.origin + nearest * ray.direction;
    let normal = normalize(point - spheres[hit].center);
    var distance: f32;
    let toLight = sampleLight(point, &distance);
    var sum = AMBIENT;
    let cosine = dot(normal, toLight);
    if cosine > 0.0 {
        if !inShadow(Ray(point + 0.001 * normal, toLight), distance) {
            sum += light.color * cosine;
        }
    }
    return spheres[hit].color * sum;
}

fn cameraRay(fragCoord: vec2f) -> Ray {
    let aspect = inputs.iResolution.x / inputs.iResolution.y;
    let x = fragCoord.x / inputs.iResolution.x * 2.0 - 1.0;
    let y = (fragCoord.y / inputs.iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3f(0.0), normalize(vec3f(x, y, SCREEN_DEPTH)));
}

fn mainImage(fragColor: ptr<function, vec4f>, fragCoord: vec2f) {
    makeScene();
    var color = vec3f(0.0);
    for (var i = 0; i < SAMPLES; i++) {
        startSample(fragCoord, i);
        let x = fragCoord.x + random() - 0.5;
        let y = fragCoord.y + random() - 0.5;
        color += trace(cameraRay(vec2f(x, y)));
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
