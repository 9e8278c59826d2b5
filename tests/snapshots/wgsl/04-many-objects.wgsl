// glsl/04-many-objects.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Seven spheres: the nearest hit is visible, and spheres cast shadows on each other.

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;
const SAMPLES: i32 = 4;
const SPHERES: i32 = 7;
const AMBIENT = vec3f(0.08);

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
    color: vec3f,
}

struct Intersection {
    t: f32,
    sphere: i32,
    point: vec3f,
    normal: vec3f,
}

var<private> spheres: array<Sphere, 7>;
var<private> light: Light;
var<private> seed: f32;

fn random() -> f32 {
    // toyproof: allow(W0005) the scene's sampler uses this hash
    let old_seed = seed;
    seed += 1.0;
    return fract(sin(old_seed) * 43758.5453123);
}

fn makeScene() {
    spheres[0] = Sphere(vec3f(0.0, -31.0, -8.0), 30.0, vec3f(0.5, 0.5, 0.45));
    spheres[1] = Sphere(vec3f(0.5, -0.7, -4.0), 0.3, vec3f(0.2, 0.8, 0.3));
    spheres[2] = Sphere(vec3f(0.0, 0.0, -6.0), 1.0, vec3f(0.9, 0.8, 0.1));
    spheres[3] = Sphere(vec3f(-1.5, -0.4, -5.0), 0.6, vec3f(0.9, 0.2, 0.15));
    spheres[4] = Sphere(vec3f(1.4, -0.5, -4.8), 0.5, vec3f(0.15, 0.3, 0.9));
    spheres[5] = Sphere(vec3f(-0.6, 1.1, -5.5), 0.35, vec3f(0.8, 0.4, 0.8));
    // Behind the light, so it casts no shadow.
    spheres[6] = Sphere(vec3f(6.8, 10.2, 5.9), 3.0, vec3f(0.6, 0.6, 0.6));
    light = Light(vec3f(4.0, 6.0, 1.0), vec3f(0.9));
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
    for (var i = 0; i < SPHERES; i++) {
        if i == hit.sphere {
            hit.point = ray.origin + hit.t * ray.direction;
            hit.normal = (hit.point - spheres[i].center) / spheres[i].radius;
        }
    }
    return hit;
}

fn inShadow(point: vec3f, normal: vec3f) -> bool {
    // Start slightly above the surface, so that the shadow ray does not hit the same sphere.
    let origin = point + 0.001 * normal;
    let toLight = light.position - origin;
    let distance = length(toLight);
    let ray = Ray(origin, toLight / distance);
    for (var i = 0; i < SPHERES; i++) {
        if intersectSphere(ray, spheres[i]) < distance {
            return true;
        }
    }
    return false;
}

fn trace(ray: Ray) -> vec3f {
    let hit = nearestHit(ray);
    if hit.sphere < 0 {
        return vec3f(0.3, 0.4, 0.6);
    }
    var sum = AMBIENT;
    let cosine = dot(hit.normal, normalize(light.position - hit.point));
    if cosine > 0.0 {
        if !inShadow(hit.point, hit.normal) {
            sum += light.color * cosine;
        }
    }
    return spheres[hit.sphere].color * sum;
}

fn cameraRay(fragCoord: vec2f) -> Ray {
    let aspect = inputs.iResolution.x / inputs.iResolution.y;
    let x = fragCoord.x / inputs.iResolution.x * 2.0 - 1.0;
    let y = (fragCoord.y / inputs.iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3f(0.0), normalize(vec3f(x, y, SCREEN_DEPTH)));
}

fn mainImage(fragColor: ptr<function, vec4f>, fragCoord: vec2f) {
    makeScene();
    seed = 0.0;
    var color = vec3f(0.0);
    for (var i = 0; i < SAMPLES; i++) {
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
