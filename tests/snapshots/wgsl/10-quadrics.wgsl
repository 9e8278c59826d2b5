// glsl/10-quadrics.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Quadric surfaces. Each ray is transformed to the quadric's local frame, where a quadratic equation gives the hits.

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;
const QUADRICS: i32 = 5;
const AMBIENT = vec3f(0.15);
const LIGHT = vec3f(4.0, 6.0, 2.0);
const LIGHT_COLOR = vec3f(0.85);

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

// q.x x^2 + q.y y^2 + q.z z^2 + 2 g z + k = 0 for low <= z <= high, with z along the axis.
struct Quadric {
    origin: vec3f,
    axis: vec3f,
    q: vec3f,
    g: f32,
    k: f32,
    low: f32,
    high: f32,
    color: vec3f,
}

struct Intersection {
    t: f32,
    normal: vec3f,
    color: vec3f,
}

var<private> quadrics: array<Quadric, 5>;

fn ellipsoid(center: vec3f, radii: vec3f, color: vec3f) -> Quadric {
    // The ellipsoid's axes are the coordinate axes.
    return Quadric(center, vec3f(0.0, 0.0, 1.0), 1.0 / (radii * radii), 0.0, -1.0, -radii.z,
        radii.z, color);
}

fn cylinder(base: vec3f, axis: vec3f, radius: f32, height: f32, color: vec3f) -> Quadric {
    return Quadric(base, axis, vec3f(1.0, 1.0, 0.0), 0.0, -radius * radius, 0.0, height, color);
}

fn cone(apex: vec3f, axis: vec3f, radius: f32, height: f32, color: vec3f) -> Quadric {
    let slope = radius / height;
    return Quadric(apex, axis, vec3f(1.0, 1.0, -slope * slope), 0.0, 0.0, 0.0, height, color);
}

fn paraboloid(apex: vec3f, axis: vec3f, radius: f32, height: f32, color: vec3f) -> Quadric {
    return Quadric(apex, axis, vec3f(1.0, 1.0, 0.0), -0.5 * radius * radius / height, 0.0, 0.0,
        height, color);
}

fn hyperboloid(center: vec3f, axis: vec3f, waist: f32, radius: f32, height: f32,
        color: vec3f) -> Quadric {
    let z = 0.5 * height;
    let slope2 = (radius * radius - waist * waist) / (z * z);
    return Quadric(center, axis, vec3f(1.0, 1.0, -slope2), 0.0, -waist * waist, -z, z, color);
}

fn makeScene() {
    quadrics[0] = ellipsoid(vec3f(-2.0, 0.5, -7.0), vec3f(0.9, 0.5, 0.6), vec3f(0.9, 0.3, 0.3));
    quadrics[1] = cylinder(vec3f(-0.9, -1.0, -5.2), vec3f(0.0, 1.0, 0.0), 0.4, 0.8,
        vec3f(0.3, 0.7, 0.9));
    quadrics[2] = cone(vec3f(0.3, 0.9, -6.5), vec3f(0.0, -1.0, 0.0), 0.7, 1.9,
        vec3f(0.9, 0.7, 0.2));
    quadrics[3] = paraboloid(vec3f(1.1, -0.9, -5.0), vec3f(0.28, 0.96, 0.0), 0.5, 0.7,
        vec3f(0.5, 0.9, 0.4));
    quadrics[4] = hyperboloid(vec3f(2.3, 0.0, -7.5), vec3f(0.0, 1.0, 0.0), 0.4, 0.8, 2.0,
        vec3f(0.7, 0.5, 0.9));
}

// The local coordinates of v: along two directions perpendicular to the axis, and along the axis.
fn frame(axis: vec3f) -> mat3x3f {
    let x = select(normalize(cross(axis, vec3f(0.0, 0.0, 1.0))), vec3f(1.0, 0.0, 0.0),
        abs(axis.z) > 0.9);
    return mat3x3f(x, cross(axis, x), axis);
}

// The smallest t of a hit between the two ends.
fn intersectQuadric(ray: Ray, quadric: Quadric, frame_1: mat3x3f) -> f32 {
    let d = ray.direction * frame_1;
    let far = (ray.origin - quadric.origin) * frame_1;
    // Start at the point of the ray closest to the quadric's origin: smaller numbers have smaller rounding errors.
    let ahead = -dot(far, d);
    let o = far + ahead * d;
    let a = dot(quadric.q * d, d);
    let b = dot(quadric.q * d, o) + quadric.g * d.z;
    let c = dot(quadric.q * o, o) + 2.0 * quadric.g * o.z + quadric.k;
    let disc = b * b - a * c;
    if disc < 0.0 {
        return NO_HIT;
    }
    // The root without cancellation; the other follows from their product. If a is 0, there is only one root.
    let q = select(-b + sqrt(disc), -b - sqrt(disc), b > 0.0);
    var t0 = select(c / q, NO_HIT, q == 0.0);
    var t1 = select(q / a, NO_HIT, a == 0.0);
    if t0 > t1 {
        let t = t0;
        t0 = t1;
        t1 = t;
    }
    let z0 = o.z + t0 * d.z;
    if ahead + t0 > 0.001 && z0 >= quadric.low && z0 <= quadric.high {
        return ahead + t0;
    }
    let z1 = o.z + t1 * d.z;
    if ahead + t1 > 0.001 && z1 >= quadric.low && z1 <= quadric.high {
        return ahead + t1;
    }
    return NO_HIT;
}

fn normalOf(point: vec3f, quadric: Quadric, frame_1: mat3x3f) -> vec3f {
    let p = (point - quadric.origin) * frame_1;
    return normalize(frame_1 * (quadric.q * p + vec3f(0.0, 0.0, quadric.g)));
}

fn nearestHit(ray: Ray) -> Intersection {
    var hit = Intersection(NO_HIT, vec3f(0.0), vec3f(0.0));
    for (var i = 0; i < QUADRICS; i++) {
        let f = frame(quadrics[i].axis);
        let t = intersectQuadric(ray, quadrics[i], f);
        if t < hit.t {
            hit.t = t;
            hit.normal = normalOf(ray.origin + t * ray.direction, quadrics[i], f);
            hit.color = quadrics[i].color;
        }
    }
    // The ground is a plane.
    let t = (-1.0 - ray.origin.y) / ray.direction.y;
    if t > 0.001 && t < hit.t {
        hit = Intersection(t, vec3f(0.0, 1.0, 0.0), vec3f(0.5));
    }
    // Open surfaces are visible from both sides.
    if dot(hit.normal, ray.direction) > 0.0 {
        hit.normal = -hit.normal;
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
    makeScene();
    let ray = cameraRay(fragCoord);
    var color = vec3f(0.6, 0.7, 0.9);

    let hit = nearestHit(ray);
    if hit.t < NO_HIT {
        let point = ray.origin + hit.t * ray.direction;
        let toLight = LIGHT - (point + 0.001 * hit.normal);
        let distance = length(toLight);
        let cosine = dot(hit.normal, normalize(LIGHT - point));
        var sum = AMBIENT;
        if cosine > 0.0 {
            let shadow = Ray(point + 0.001 * hit.normal, toLight / distance);
            if nearestHit(shadow).t > distance {
                sum += LIGHT_COLOR * cosine;
            }
        }
        color = hit.color * sum;
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
