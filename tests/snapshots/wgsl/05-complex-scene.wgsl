// glsl/05-complex-scene.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// 43 spheres in a hierarchy: a parent, six children, and six grandchildren for each child.

struct Inputs {
    // `@size` skips inputs that the shader does not read.
    @size(20) iResolution: vec3f,
    iFrame: i32,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;
const SHRINK: f32 = 2.8;
const AMBIENT = vec3f(0.15);
const LIGHT = vec3f(4.0, 5.0, 2.0);

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

struct Sphere {
    center: vec3f,
    radius: f32,
    color: vec3f,
}

struct Intersection {
    t: f32,
    sphere: Sphere,
}

// `a % b` of GLSL as Mesa and SwiftShader round it, down: other languages round towards zero.
fn remainder(a: i32, b: i32) -> i32 {
    let r = a % b;
    return select(r, r + b, r != 0 && (r ^ b) < 0);
}

// Right, left, up, down, front, back.
fn side(i: i32) -> vec3f {
    let axis = vec3f(f32(i / 2 == 0), f32(i / 2 == 1), f32(i / 2 == 2));
    return select(-axis, axis, remainder(i, 2) == 0);
}

fn sideColor(i: i32) -> vec3f {
    return 0.5 + 0.4 * side(i);
}

// One turn in 240 frames, about the y axis through the parent.
fn turn(v: vec3f, frame: i32) -> vec3f {
    let angle = 6.28318530718 * f32(frame) / 240.0;
    let c = cos(angle);
    let s = sin(angle);
    return vec3f(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
}

fn childOf(parent: Sphere, i: i32, frame: i32) -> Sphere {
    let radius = parent.radius / SHRINK;
    let center = parent.center + (parent.radius + radius) * turn(side(i), frame);
    return Sphere(center, radius, 0.5 * (parent.color + sideColor(i)));
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

fn keepNearest(ray: Ray, sphere: Sphere, hit: ptr<function, Intersection>) {
    let t = intersectSphere(ray, sphere);
    if t < (*hit).t {
        (*hit).t = t;
        (*hit).sphere = sphere;
    }
}

fn hitScene(ray: Ray, frame: i32) -> Intersection {
    let parent = Sphere(vec3f(0.0, 0.0, -7.5), 1.0, vec3f(0.9, 0.9, 0.8));
    var hit = Intersection(NO_HIT, parent);
    keepNearest(ray, parent, &hit);
    for (var i = 0; i < 6; i++) {
        let child = childOf(parent, i, frame);
        keepNearest(ray, child, &hit);
        for (var j = 0; j < 6; j++) {
            keepNearest(ray, childOf(child, j, frame), &hit);
        }
    }
    return hit;
}

fn cameraRay(fragCoord: vec2f) -> Ray {
    let aspect = inputs.iResolution.x / inputs.iResolution.y;
    let x = fragCoord.x / inputs.iResolution.x * 2.0 - 1.0;
    let y = (fragCoord.y / inputs.iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3f(0.0), normalize(vec3f(x, y, SCREEN_DEPTH)));
}

fn mainImage(fragColor: ptr<function, vec4f>, fragCoord: vec2f) {
    let ray = cameraRay(fragCoord);
    var color = vec3f(0.05, 0.05, 0.1);

    let hit = hitScene(ray, inputs.iFrame);
    if hit.t < NO_HIT {
        let point = ray.origin + hit.t * ray.direction;
        let normal = normalize(point - hit.sphere.center);
        let toLight = normalize(LIGHT - point);
        color = hit.sphere.color * (AMBIENT + vec3f(0.85) * max(dot(normal, toLight), 0.0));
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
