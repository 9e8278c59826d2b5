#version 300 es
// glsl/14-accelerator.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Hundreds of spheres, one in each cell of a grid. A ray visits only the cells that it passes through, in order,
// and the sphere of a cell is computed from the cell's number when needed.

precision highp float;
precision highp int;

layout(std140) uniform Inputs {
    vec3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    vec4 iChannelTime[4];
    vec3 iChannelResolution[4];
    vec4 iMouse;
    vec4 iDate;
    float iSampleRate;
};
layout(location = 0) out vec4 outputColor;

const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1.0e6;
const ivec3 CELLS = ivec3(11, 5, 10);
const vec3 CORNER = vec3(-4.125, -1.875, -13.5);
const float SPACING = 0.75;
const uint SEED = 7u;
const vec3 AMBIENT = vec3(0.15);
const vec3 LIGHT = vec3(6.0, 8.0, -2.0);

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Sphere {
    vec3 center;
    float radius;
};

struct Intersection {
    float t;
    ivec3 cell;
};

uint state = 0u;

// The integer hash PCG (Jarzynski and Olano 2020).
uint pcg(uint v) {
    uint s = v * 747796405u + 2891336453u;
    uint word = (s >> (s >> 28u) + 4u ^ s) * 277803737u;
    return word >> 22u ^ word;
}

float random() {
    state = pcg(state);
    return float(state >> 8u) / 16777216.0;
}

// The sphere of a cell, entirely inside the cell; its color is random.
Sphere sphereIn(ivec3 cell) {
    state = SEED + uint(cell.x + CELLS.x * (cell.y + CELLS.y * cell.z));
    float radius = mix(0.1, 0.3, random());
    float room = SPACING - 2.0 * radius;
    float x = random();
    float y = random();
    float z = random();
    return Sphere(CORNER + SPACING * vec3(cell) + radius + room * vec3(x, y, z), radius);
}

vec3 nextColor() {
    float r = random();
    float g = random();
    float b = random();
    return 0.95 * (0.2 + 0.8 * vec3(r, g, b));
}

// Starts at the point of the ray closest to the center: smaller numbers have smaller rounding errors.
float intersectSphere(Ray ray, Sphere sphere) {
    vec3 f = ray.origin - sphere.center;
    float b = dot(f, ray.direction);
    vec3 closest = f - b * ray.direction;
    float disc = sphere.radius * sphere.radius - dot(closest, closest);
    if (disc > 0.0) {
        float root = sqrt(disc);
        float t = -b - root;
        if (t > 0.00001) {
            return t;
        }
        t = -b + root;
        if (t > 0.00001) {
            return t;
        }
    }
    return NO_HIT;
}

// The nearest hit, cell by cell (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", 1987).
Intersection hitScene(Ray ray) {
    vec3 low = (CORNER - ray.origin) / ray.direction;
    vec3 high = (CORNER + SPACING * vec3(CELLS) - ray.origin) / ray.direction;
    vec3 into = min(low, high);
    vec3 outOf = max(low, high);
    float enter = max(max(into.x, into.y), max(into.z, 0.0));
    float leave = min(outOf.x, min(outOf.y, outOf.z));
    Intersection none = Intersection(NO_HIT, ivec3(-1));
    if (enter >= leave) {
        return none;
    }
    vec3 place = (ray.origin + enter * ray.direction - CORNER) / SPACING;
    ivec3 cell = clamp(ivec3(floor(place)), ivec3(0), CELLS - 1);
    ivec3 stride = ivec3(sign(ray.direction));
    // For each axis: next is the t at which the ray leaves the cell (never, if the ray is perpendicular to the axis),
    // and step is the distance in t between two cell boundaries.
    vec3 next = (CORNER + SPACING * vec3(cell + max(stride, 0)) - ray.origin) / ray.direction;
    next = mix(next, vec3(NO_HIT), equal(stride, ivec3(0)));
    vec3 step = SPACING / abs(ray.direction);
    for (int i = 0; i < CELLS.x + CELLS.y + CELLS.z; i++) {
        float t = intersectSphere(ray, sphereIn(cell));
        if (t < NO_HIT) {
            return Intersection(t, cell);
        }
        if (next.x < next.y && next.x < next.z) {
            cell.x += stride.x;
            next.x += step.x;
            if (cell.x < 0 || cell.x >= CELLS.x) {
                return none;
            }
        } else if (next.y < next.z) {
            cell.y += stride.y;
            next.y += step.y;
            if (cell.y < 0 || cell.y >= CELLS.y) {
                return none;
            }
        } else {
            cell.z += stride.z;
            next.z += step.z;
            if (cell.z < 0 || cell.z >= CELLS.z) {
                return none;
            }
        }
    }
    return none;
}

Ray cameraRay(vec2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
    float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3(0.0), normalize(vec3(x, y, SCREEN_DEPTH)));
}

void mainImage(out vec4 fragColor, vec2 fragCoord) {
    fragColor = vec4(0.0);
    Ray ray = cameraRay(fragCoord);
    vec3 color = vec3(0.7, 0.8, 0.9);

    Intersection hit = hitScene(ray);
    if (hit.t < NO_HIT) {
        Sphere sphere = sphereIn(hit.cell);
        vec3 albedo = nextColor();
        vec3 point = ray.origin + hit.t * ray.direction;
        vec3 normal = normalize(point - sphere.center);
        vec3 sum = AMBIENT;
        float cosine = dot(normal, normalize(LIGHT - point));
        if (cosine > 0.0) {
            vec3 origin = point + 0.001 * normal;
            if (hitScene(Ray(origin, normalize(LIGHT - origin))).t == NO_HIT) {
                sum += vec3(0.85) * cosine;
            }
        }
        color = albedo * sum;
    }
    fragColor = vec4(color, 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
