// glsl/11-animation.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A small solar system: a moon orbits a planet that orbits the sun, each with its own period. iTime moves the
// planets, iFrame the satellite.

struct Inputs {
    // `@size` skips inputs that the shader does not read.
    iResolution: vec3f,
    @size(8) iTime: f32,
    iFrame: i32,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;
const TAU: f32 = 6.28318530718;
const BODIES: i32 = 6;
const AMBIENT = vec3f(0.12);
const SUN = vec3f(0.0, 0.2, -7.0);

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

struct Sphere {
    center: vec3f,
    radius: f32,
    color: vec3f,
}

var<private> bodies: array<Sphere, 6>;
var<private> lamp: vec3f;

// Rotates v about a unit axis (Rodrigues' formula).
fn rotate(v: vec3f, axis: vec3f, angle: f32) -> vec3f {
    let c = cos(angle);
    let s = sin(angle);
    return c * v + s * cross(axis, v) + (1.0 - c) * dot(axis, v) * axis;
}

fn rotateAbout(p: vec3f, pivot: vec3f, axis: vec3f, turns: f32) -> vec3f {
    return pivot + rotate(p - pivot, axis, TAU * fract(turns));
}

// Each body first follows its own orbit, then the orbit of its parent.
fn year(p: vec3f) -> vec3f {
    return rotateAbout(p, SUN, vec3f(0.0, 1.0, 0.0), inputs.iTime / 8.0);
}

fn month(p: vec3f) -> vec3f {
    return year(rotateAbout(p, vec3f(2.0, 0.2, -7.0), vec3f(0.0, 0.8, 0.6), inputs.iTime / 2.0));
}

fn orbit(p: vec3f) -> vec3f {
    return month(rotateAbout(p, vec3f(2.75, 0.2, -7.0), vec3f(1.0, 0.0, 0.0),
            f32(inputs.iFrame) / 60.0));
}

fn retrograde(p: vec3f) -> vec3f {
    return rotateAbout(p, SUN, vec3f(0.0, 0.96, -0.28), -inputs.iTime / 5.0);
}

fn makeScene() {
    bodies[0] = Sphere(SUN, 0.8, vec3f(1.0, 0.8, 0.3));
    bodies[1] = Sphere(year(vec3f(2.0, 0.2, -7.0)), 0.35, vec3f(0.3, 0.5, 0.9));
    bodies[2] = Sphere(month(vec3f(2.75, 0.2, -7.0)), 0.15, vec3f(0.8, 0.8, 0.8));
    bodies[3] = Sphere(orbit(vec3f(2.75, 0.45, -7.0)), 0.06, vec3f(0.9, 0.3, 0.9));
    bodies[4] = Sphere(retrograde(vec3f(-1.4, 0.2, -7.0)), 0.22, vec3f(0.9, 0.4, 0.2));
    bodies[5] = Sphere(vec3f(0.0, -52.0, -8.0), 50.0, vec3f(0.4, 0.4, 0.5));
    lamp = retrograde(vec3f(3.0, 5.0, -4.0));
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

fn inShadow(point: vec3f, normal: vec3f) -> bool {
    let origin = point + 0.001 * normal;
    let toLight = lamp - origin;
    let distance = length(toLight);
    let ray = Ray(origin, toLight / distance);
    for (var i = 0; i < BODIES; i++) {
        if intersectSphere(ray, bodies[i]) < distance {
            return true;
        }
    }
    return false;
}

fn cameraRay(fragCoord: vec2f) -> Ray {
    let aspect = inputs.iResolution.x / inputs.iResolution.y;
    let x = fragCoord.x / inputs.iResolution.x * 2.0 - 1.0;
    let y = (fragCoord.y / inputs.iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3f(0.0), normalize(vec3f(x, y, SCREEN_DEPTH)));
}

fn mainImage(fragColor: ptr<function, vec4f>, fragCoord: vec2f) {
    makeScene();
    let ray = cameraRay(fragCoord);
    var color = vec3f(0.02, 0.02, 0.06);

    var nearest = NO_HIT;
    var hit = -1;
    for (var i = 0; i < BODIES; i++) {
        let t = intersectSphere(ray, bodies[i]);
        if t < nearest {
            nearest = t;
            hit = i;
        }
    }
    if hit >= 0 {
        let point = ray.origin + nearest * ray.direction;
        let normal = normalize(point - bodies[hit].center);
        let cosine = dot(normal, normalize(lamp - point));
        var sum = AMBIENT;
        if cosine > 0.0 {
            if !inShadow(point, normal) {
                sum += vec3f(0.88) * cosine;
            }
        }
        color = bodies[hit].color * sum;
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
