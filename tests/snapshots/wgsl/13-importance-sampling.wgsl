// glsl/13-importance-sampling.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A path tracer with multiple importance sampling: at each hit, one direction is sampled toward an emitter and one from the
// BRDF, and the power heuristic weights the two (Veach and Guibas 1995).

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;
const PI: f32 = 3.14159265359;
const EPSILON: f32 = 0.001;
const SAMPLES: i32 = 16;
const SPHERES: i32 = 6;
const EMITTERS: i32 = 2;
const MAX_DEPTH: i32 = 4;

const DIFFUSE: i32 = 0;
const GLOSSY: i32 = 1;
const EMITTER: i32 = 2;

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

struct Material {
    model: i32,
    color: vec3f,
    exponent: f32,
}

struct Sphere {
    center: vec3f,
    radius: f32,
    material: Material,
}

struct Intersection {
    t: f32,
    point: vec3f,
    normal: vec3f,
    material: Material,
    // The index of the sphere, or -1; the first EMITTERS spheres are emitters.
    sphere: i32,
}

var<private> spheres: array<Sphere, 6>;
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
    spheres[0] = Sphere(vec3f(-2.5, 1.4, -6.5), 0.25,
        Material(EMITTER, vec3f(80.0, 70.0, 55.0), 0.0));
    spheres[1] = Sphere(vec3f(2.2, 1.4, -7.5), 0.8, Material(EMITTER, vec3f(2.5, 3.0, 4.0), 0.0));
    spheres[2] = Sphere(vec3f(-1.8, -0.3, -6.0), 0.7,
        Material(GLOSSY, vec3f(0.9, 0.7, 0.3), 300.0));
    spheres[3] = Sphere(vec3f(0.0, -0.3, -6.5), 0.7, Material(GLOSSY, vec3f(0.8, 0.8, 0.8), 30.0));
    spheres[4] = Sphere(vec3f(1.7, -0.4, -5.5), 0.6, Material(DIFFUSE, vec3f(0.8, 0.25, 0.2), 0.0));
    spheres[5] = Sphere(vec3f(0.6, -0.75, -4.2), 0.25,
        Material(DIFFUSE, vec3f(0.3, 0.7, 0.4), 0.0));
}

// Starts at the point of the ray closest to the center: smaller numbers have smaller rounding errors.
fn intersectSphere(ray: Ray, sphere: Sphere) -> f32 {
    let f = ray.origin - sphere.center;
    let b = dot(f, ray.direction);
    let closest = f - b * ray.direction;
    let disc = sphere.radius * sphere.radius - dot(closest, closest);
    if disc > 0.0 {
        let root = sqrt(disc);
        var t = -b - root;
        if t > EPSILON {
            return t;
        }
        t = -b + root;
        if t > EPSILON {
            return t;
        }
    }
    return NO_HIT;
}

fn nearestHit(ray: Ray) -> Intersection {
    var hit: Intersection;
    hit.t = NO_HIT;
    hit.sphere = -1;
    for (var i = 0; i < SPHERES; i++) {
        let t = intersectSphere(ray, spheres[i]);
        if t < hit.t {
            hit.t = t;
            hit.sphere = i;
        }
    }
    let t = (-1.0 - ray.origin.y) / ray.direction.y;
    if t > EPSILON && t < hit.t {
        hit.t = t;
        hit.sphere = -1;
        hit.normal = vec3f(0.0, 1.0, 0.0);
        hit.material = Material(DIFFUSE, vec3f(0.6, 0.6, 0.65), 0.0);
    }
    hit.point = ray.origin + hit.t * ray.direction;
    if hit.sphere >= 0 {
        hit.normal = normalize(hit.point - spheres[hit.sphere].center);
        hit.material = spheres[hit.sphere].material;
    }
    return hit;
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

// 1 - cos of the half angle of the cone that an emitter subtends.
fn coneDepth(point: vec3f, emitter: Sphere) -> f32 {
    let toCenter = emitter.center - point;
    let sine2 = emitter.radius * emitter.radius / dot(toCenter, toCenter);
    return sine2 / (1.0 + sqrt(1.0 - sine2));
}

// The probability density, per solid angle, of sampling a direction toward this emitter.
fn lightDensity(point: vec3f, emitter: Sphere) -> f32 {
    return 1.0 / (2.0 * PI * coneDepth(point, emitter) * f32(EMITTERS));
}

fn brdf(material: Material, reflected: vec3f, direction: vec3f) -> vec3f {
    if material.model == GLOSSY {
        let lobe = pow(max(dot(reflected, direction), 0.0), material.exponent);
        return material.color * (material.exponent + 2.0) / (2.0 * PI) * lobe;
    }
    return material.color / PI;
}

fn brdfDensity(material: Material, normal: vec3f, reflected: vec3f, direction: vec3f) -> f32 {
    if material.model == GLOSSY {
        let lobe = pow(max(dot(reflected, direction), 0.0), material.exponent);
        return (material.exponent + 1.0) / (2.0 * PI) * lobe;
    }
    return max(dot(normal, direction), 0.0) / PI;
}

fn sampleBrdf(material: Material, normal: vec3f, reflected: vec3f) -> vec3f {
    let u = random();
    let v = random();
    if material.model == GLOSSY {
        return around(reflected, pow(1.0 - u, 1.0 / (material.exponent + 1.0)), v);
    }
    return around(normal, sqrt(1.0 - u), v);
}

fn weight(density: f32, other: f32) -> f32 {
    let ratio = other / density;
    return 1.0 / (1.0 + ratio * ratio);
}

fn inShadow(ray: Ray, emitter: i32) -> bool {
    let distance = intersectSphere(ray, spheres[emitter]);
    for (var i = 0; i < SPHERES; i++) {
        if i != emitter && intersectSphere(ray, spheres[i]) < distance {
            return true;
        }
    }
    let t = (-1.0 - ray.origin.y) / ray.direction.y;
    return t > EPSILON && t < distance;
}

// The light from one randomly chosen emitter.
fn sampleLight(hit: Intersection, reflected: vec3f) -> vec3f {
    let emitter = min(i32(random() * f32(EMITTERS)), EMITTERS - 1);
    let u = random();
    let v = random();
    let cosine = 1.0 - u * coneDepth(hit.point, spheres[emitter]);
    let direction = around(normalize(spheres[emitter].center - hit.point), cosine, v);
    let facing = dot(hit.normal, direction);
    if facing <= 0.0 {
        return vec3f(0.0);
    }
    if inShadow(Ray(hit.point + EPSILON * hit.normal, direction), emitter) {
        return vec3f(0.0);
    }
    let density = lightDensity(hit.point, spheres[emitter]);
    let other = brdfDensity(hit.material, hit.normal, reflected, direction);
    return spheres[emitter].material.color * brdf(hit.material, reflected, direction) * facing
        * weight(density, other) / density;
}

fn trace(ray_in: Ray) -> vec3f {
    var ray = ray_in;
    var color = vec3f(0.0);
    var throughput = vec3f(1.0);
    // The probability density of the ray's direction; 0 for camera rays.
    var density = 0.0;
    for (var depth = 0; depth < MAX_DEPTH; depth++) {
        let hit = nearestHit(ray);
        if hit.t == NO_HIT {
            return color + throughput * vec3f(0.05, 0.06, 0.08);
        }
        if hit.material.model == EMITTER {
            var share = 1.0;
            if density > 0.0 {
                share = weight(density, lightDensity(ray.origin, spheres[hit.sphere]));
            }
            return color + throughput * hit.material.color * share;
        }
        // A path through another surface would be longer than MAX_DEPTH segments.
        if depth + 1 == MAX_DEPTH {
            return color;
        }
        let reflected = reflect(ray.direction, hit.normal);
        color += throughput * sampleLight(hit, reflected);
        let direction = sampleBrdf(hit.material, hit.normal, reflected);
        let facing = dot(hit.normal, direction);
        if facing <= 0.0 {
            return color;
        }
        density = brdfDensity(hit.material, hit.normal, reflected, direction);
        throughput *= brdf(hit.material, reflected, direction) * facing / density;
        ray = Ray(hit.point + EPSILON * hit.normal, direction);
    }
    return color;
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
    color /= f32(SAMPLES);
    *fragColor = vec4f(pow(color / (color + 1.0), vec3f(1.0f / 2.2f)), 1.0);
}

@fragment
fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    var color: vec4f;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(&color, position.xy);
    return vec4f(color.xyz, 1.0);
}
