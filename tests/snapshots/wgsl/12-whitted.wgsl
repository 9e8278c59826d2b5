// glsl/12-whitted.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Whitted's scene: a mirror and a glass ball above a checkered floor. Glass splits each ray into two; a stack holds
// the rays that remain to be traced.

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

// `mod` of GLSL: WGSL's `%` rounds towards zero.
fn modulo(x: f32, y: f32) -> f32 {
    return x - y * floor(x / y);
}

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;
const EPSILON: f32 = 0.001;
const SPHERES: i32 = 4;
const MAX_DEPTH: i32 = 6;
const AMBIENT = vec3f(0.15);
const LIGHT = vec3f(-4.0, 7.0, 1.0);

const MATTE: i32 = 0;
const MIRROR: i32 = 1;
const GLASS: i32 = 2;
const IOR: f32 = 1.5;

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

struct Sphere {
    center: vec3f,
    radius: f32,
    model: i32,
    color: vec3f,
}

struct Intersection {
    t: f32,
    point: vec3f,
    normal: vec3f,
    model: i32,
    color: vec3f,
}

// A ray on the stack; its throughput is its contribution to the pixel.
struct Branch {
    ray: Ray,
    throughput: vec3f,
    depth: i32,
}

var<private> spheres: array<Sphere, 4>;

fn makeScene() {
    spheres[0] = Sphere(vec3f(-0.5, 0.0, -4.5), 0.9, GLASS, vec3f(0.95, 1.0, 0.95));
    spheres[1] = Sphere(vec3f(1.3, 0.1, -6.5), 1.1, MIRROR, vec3f(0.9, 0.9, 0.9));
    spheres[2] = Sphere(vec3f(-2.4, -0.4, -7.0), 0.6, MATTE, vec3f(0.9, 0.3, 0.2));
    spheres[3] = Sphere(vec3f(1.1, -0.7, -4.0), 0.3, MATTE, vec3f(0.2, 0.4, 0.9));
}

fn sky(direction: vec3f) -> vec3f {
    let up = 0.5 * (1.0 + direction.y);
    return (1.0 - up) * vec3f(0.9, 0.9, 0.95) + up * vec3f(0.3, 0.5, 0.9);
}

fn intersectSphere(ray: Ray, sphere: Sphere) -> f32 {
    let f = ray.origin - sphere.center;
    let b = dot(f, ray.direction);
    let c = dot(f, f) - sphere.radius * sphere.radius;
    let disc = b * b - c;
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

fn checker(point: vec3f) -> vec3f {
    let square = floor(point.x) + floor(point.z);
    return select(vec3f(0.6, 0.15, 0.1), vec3f(0.9, 0.8, 0.3), modulo(square, 2.0) == 0.0);
}

fn nearestHit(ray: Ray) -> Intersection {
    var hit = Intersection(NO_HIT, vec3f(0.0), vec3f(0.0), MATTE, vec3f(0.0));
    for (var i = 0; i < SPHERES; i++) {
        let t = intersectSphere(ray, spheres[i]);
        if t < hit.t {
            let point = ray.origin + t * ray.direction;
            let normal = normalize(point - spheres[i].center);
            hit = Intersection(t, point, normal, spheres[i].model, spheres[i].color);
        }
    }
    let t = (-1.02 - ray.origin.y) / ray.direction.y;
    if t > EPSILON && t < hit.t {
        let point = ray.origin + t * ray.direction;
        hit = Intersection(t, point, vec3f(0.0, 1.0, 0.0), MATTE, checker(point));
    }
    return hit;
}

fn shade(hit: Intersection) -> vec3f {
    var sum = AMBIENT;
    let cosine = dot(hit.normal, normalize(LIGHT - hit.point));
    if cosine > 0.0 {
        let origin = hit.point + EPSILON * hit.normal;
        let toLight = LIGHT - origin;
        let distance = length(toLight);
        if nearestHit(Ray(origin, toLight / distance)).t > distance {
            sum += vec3f(0.85) * cosine;
        }
    }
    return hit.color * sum;
}

// The reflectance by Fresnel's equations, for unpolarized light. eta is the index of refraction on this side divided
// by the index on the other side; cosine and beyond are the cosines of the ray on this side and on the other.
fn fresnel(eta: f32, cosine: f32, beyond: f32) -> f32 {
    let across = (eta * cosine - beyond) / (eta * cosine + beyond);
    let along = (cosine - eta * beyond) / (cosine + eta * beyond);
    return 0.5 * (across * across + along * along);
}

fn trace(first: Ray) -> vec3f {
    var stack: array<Branch, 8>;
    stack[0] = Branch(first, vec3f(1.0), 0);
    var top = 1;
    var color = vec3f(0.0);
    while top > 0 {
        top--;
        let branch = stack[top];
        let ray = branch.ray;
        let hit = nearestHit(ray);
        if hit.t == NO_HIT {
            color += branch.throughput * sky(ray.direction);
            continue;
        }
        if hit.model == MATTE {
            color += branch.throughput * shade(hit);
            continue;
        }
        let depth = branch.depth + 1;
        if depth == MAX_DEPTH {
            continue;
        }
        let throughput = branch.throughput * hit.color;
        let mirrored = Ray(hit.point, reflect(ray.direction, hit.normal));
        if hit.model == MIRROR {
            stack[top] = Branch(mirrored, throughput, depth);
            top++;
            continue;
        }
        let entering = dot(ray.direction, hit.normal) < 0.0;
        let normal = select(-hit.normal, hit.normal, entering);
        let eta = select(IOR, 1.0 / IOR, entering);
        let cosine = -dot(ray.direction, normal);
        let sine2 = eta * eta * (1.0 - cosine * cosine);
        if sine2 >= 1.0 {
            // Total internal reflection.
            stack[top] = Branch(mirrored, throughput, depth);
            top++;
            continue;
        }
        let beyond = sqrt(1.0 - sine2);
        let share = fresnel(eta, cosine, beyond);
        let refracted = eta * ray.direction + (eta * cosine - beyond) * normal;
        stack[top] = Branch(mirrored, throughput * share, depth);
        top++;
        stack[top] = Branch(Ray(hit.point, refracted), throughput * (1.0 - share), depth);
        top++;
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
    *fragColor = vec4f(trace(cameraRay(fragCoord)), 1.0);
}

@fragment
fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    var color: vec4f;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(&color, position.xy);
    return vec4f(color.xyz, 1.0);
}
