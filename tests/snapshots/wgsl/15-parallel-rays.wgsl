// glsl/15-parallel-rays.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Parallel projection: all rays have the same direction and different origins, so distant objects look no smaller.

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const NO_HIT: f32 = 1.0e6;
const WIDTH: f32 = 6.0;
const SPHERES: i32 = 5;
const AMBIENT = vec3f(0.1, 0.1, 0.12);
const LIGHT = vec3f(3.0, 5.0, 4.0);

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

struct Sphere {
    center: vec3f,
    radius: f32,
    color: vec3f,
}

var<private> spheres: array<Sphere, 5>;

fn makeScene() {
    spheres[0] = Sphere(vec3f(-2.0, 0.0, -4.0), 0.7, vec3f(0.9, 0.3, 0.2));
    spheres[1] = Sphere(vec3f(-1.0, 0.3, -6.0), 0.7, vec3f(0.9, 0.6, 0.2));
    spheres[2] = Sphere(vec3f(0.0, 0.0, -9.0), 0.7, vec3f(0.9, 0.9, 0.3));
    spheres[3] = Sphere(vec3f(1.0, -0.3, -13.0), 0.7, vec3f(0.3, 0.8, 0.4));
    spheres[4] = Sphere(vec3f(2.0, 0.0, -18.0), 0.7, vec3f(0.3, 0.5, 0.9));
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

fn cameraRay(fragCoord: vec2f) -> Ray {
    let aspect = inputs.iResolution.x / inputs.iResolution.y;
    let x = fragCoord.x / inputs.iResolution.x * 2.0 - 1.0;
    let y = (fragCoord.y / inputs.iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(0.5 * WIDTH * vec3f(x, y, 0.0), vec3f(0.0, 0.0, -1.0));
}

fn mainImage(fragColor: ptr<function, vec4f>, fragCoord: vec2f) {
    makeScene();
    let ray = cameraRay(fragCoord);
    var color = vec3f(0.05, 0.05, 0.08);

    var nearest = NO_HIT;
    var hit = -1;
    for (var i = 0; i < SPHERES; i++) {
        let t = intersectSphere(ray, spheres[i]);
        if t < nearest {
            nearest = t;
            hit = i;
        }
    }
    if hit >= 0 {
        let point = ray.origin + nearest * ray.direction;
        let normal = normalize(point - spheres[hit].center);
        let toLight = normalize(LIGHT - point);
        color = spheres[hit].color * (AMBIENT + vec3f(0.9) * max(dot(normal, toLight), 0.0));
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
