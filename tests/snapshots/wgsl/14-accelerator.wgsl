// glsl/14-accelerator.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Hundreds of spheres, one in each cell of a grid. A ray visits only the cells that it passes through, in order,
// and the sphere of a cell is computed from the cell's number when needed.

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;
const CELLS = vec3i(11, 5, 10);
const CORNER = vec3f(-4.125, -1.875, -13.5);
const SPACING: f32 = 0.75;
const SEED: u32 = 7u;
const AMBIENT = vec3f(0.15);
const LIGHT = vec3f(6.0, 8.0, -2.0);

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

struct Sphere {
    center: vec3f,
    radius: f32,
}

struct Intersection {
    t: f32,
    cell: vec3i,
}

var<private> state: u32;

// The integer hash PCG (Jarzynski and Olano 2020).
fn pcg(v: u32) -> u32 {
    let s = v * 747796405u + 2891336453u;
    let word = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return (word >> 22u) ^ word;
}

fn random() -> f32 {
    state = pcg(state);
    return f32(state >> 8u) / 16777216.0;
}

// The sphere of a cell, entirely inside the cell; its color is random.
fn sphereIn(cell: vec3i) -> Sphere {
    state = SEED + u32(cell.x + CELLS.x * (cell.y + CELLS.y * cell.z));
    let radius = mix(0.1, 0.3, random());
    let room = SPACING - 2.0 * radius;
    let x = random();
    let y = random();
    let z = random();
    return Sphere(CORNER + SPACING * vec3f(cell) + radius + room * vec3f(x, y, z), radius);
}

fn nextColor() -> vec3f {
    let r = random();
    let g = random();
    let b = random();
    return 0.95 * (0.2 + 0.8 * vec3f(r, g, b));
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

// The nearest hit, cell by cell (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", 1987).
fn hitScene(ray: Ray) -> Intersection {
    let low = (CORNER - ray.origin) / ray.direction;
    let high = (CORNER + SPACING * vec3f(CELLS) - ray.origin) / ray.direction;
    let into = min(low, high);
    let outOf = max(low, high);
    let enter = max(max(into.x, into.y), max(into.z, 0.0));
    let leave = min(outOf.x, min(outOf.y, outOf.z));
    let none = Intersection(NO_HIT, vec3i(-1));
    if enter >= leave {
        return none;
    }
    let place = (ray.origin + enter * ray.direction - CORNER) / SPACING;
    var cell = clamp(vec3i(floor(place)), vec3i(0), CELLS - 1);
    let stride = vec3i(sign(ray.direction));
    // For each axis: next is the t at which the ray leaves the cell (never, if the ray is perpendicular to the axis),
    // and step is the distance in t between two cell boundaries.
    var next = (CORNER + SPACING * vec3f(cell + max(stride, vec3i(0))) - ray.origin)
        / ray.direction;
    next = select(next, vec3f(NO_HIT), stride == vec3i(0));
    let step = SPACING / abs(ray.direction);
    for (var i = 0; i < CELLS.x + CELLS.y + CELLS.z; i++) {
        let t = intersectSphere(ray, sphereIn(cell));
        if t < NO_HIT {
            return Intersection(t, cell);
        }
        if next.x < next.y && next.x < next.z {
            cell.x += stride.x;
            next.x += step.x;
            if cell.x < 0 || cell.x >= CELLS.x {
                return none;
            }
        } else if next.y < next.z {
            cell.y += stride.y;
            next.y += step.y;
            if cell.y < 0 || cell.y >= CELLS.y {
                return none;
            }
        } else {
            cell.z += stride.z;
            next.z += step.z;
            if cell.z < 0 || cell.z >= CELLS.z {
                return none;
            }
        }
    }
    return none;
}

fn cameraRay(fragCoord: vec2f) -> Ray {
    let aspect = inputs.iResolution.x / inputs.iResolution.y;
    let x = fragCoord.x / inputs.iResolution.x * 2.0 - 1.0;
    let y = (fragCoord.y / inputs.iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3f(0.0), normalize(vec3f(x, y, SCREEN_DEPTH)));
}

fn mainImage(fragColor: ptr<function, vec4f>, fragCoord: vec2f) {
    let ray = cameraRay(fragCoord);
    var color = vec3f(0.7, 0.8, 0.9);

    let hit = hitScene(ray);
    if hit.t < NO_HIT {
        let sphere = sphereIn(hit.cell);
        let albedo = nextColor();
        let point = ray.origin + hit.t * ray.direction;
        let normal = normalize(point - sphere.center);
        var sum = AMBIENT;
        let cosine = dot(normal, normalize(LIGHT - point));
        if cosine > 0.0 {
            let origin = point + 0.001 * normal;
            if hitScene(Ray(origin, normalize(LIGHT - origin))).t == NO_HIT {
                sum += vec3f(0.85) * cosine;
            }
        }
        color = albedo * sum;
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
