// glsl/14-accelerator.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Hundreds of spheres, one in each cell of a grid. A ray visits only the cells that it passes through, in order,
// and the sphere of a cell is computed from the cell's number when needed.

cbuffer Inputs : register(b0) {
    float3 iResolution : packoffset(c0);
};

float3 mix(float3 x, float3 y, bool3 a) {
    return float3(a.x ? y.x : x.x, a.y ? y.y : x.y, a.z ? y.z : x.z);
}

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1.0e6;
static const int3 CELLS = int3(11, 5, 10);
static const float3 CORNER = float3(-4.125, -1.875, -13.5);
static const float SPACING = 0.75;
static const uint SEED = 7u;
static const float3 AMBIENT = float3(0.15, 0.15, 0.15);
static const float3 LIGHT = float3(6.0, 8.0, -2.0);

struct Ray {
    float3 origin;
    float3 direction;
};

Ray make_Ray(float3 origin, float3 direction) {
    Ray result;
    result.origin = origin;
    result.direction = direction;
    return result;
}

struct Sphere {
    float3 center;
    float radius;
};

Sphere make_Sphere(float3 center, float radius) {
    Sphere result;
    result.center = center;
    result.radius = radius;
    return result;
}

struct Intersection {
    float t;
    int3 cell;
};

Intersection make_Intersection(float t, int3 cell) {
    Intersection result;
    result.t = t;
    result.cell = cell;
    return result;
}

static uint state = 0u;

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
Sphere sphereIn(int3 cell) {
    state = SEED + uint(cell.x + CELLS.x * (cell.y + CELLS.y * cell.z));
    float radius = lerp(0.1, 0.3, random());
    float room = SPACING - 2.0 * radius;
    float x = random();
    float y = random();
    float z = random();
    return make_Sphere(CORNER + SPACING * float3(cell) + radius + room * float3(x, y, z), radius);
}

float3 nextColor() {
    float r = random();
    float g = random();
    float b = random();
    return 0.95 * (0.2 + 0.8 * float3(r, g, b));
}

// Starts at the point of the ray closest to the center: smaller numbers have smaller rounding errors.
float intersectSphere(Ray ray, Sphere sphere) {
    float3 f = ray.origin - sphere.center;
    float b = dot(f, ray.direction);
    float3 closest = f - b * ray.direction;
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
    float3 low = (CORNER - ray.origin) / ray.direction;
    float3 high = (CORNER + SPACING * float3(CELLS) - ray.origin) / ray.direction;
    float3 into = min(low, high);
    float3 outOf = max(low, high);
    float enter = max(max(into.x, into.y), max(into.z, 0.0));
    float leave = min(outOf.x, min(outOf.y, outOf.z));
    Intersection none_1 = { NO_HIT, (int3)(-1) };
    if (enter >= leave) {
        return none_1;
    }
    float3 place = (ray.origin + enter * ray.direction - CORNER) / SPACING;
    int3 cell = clamp(int3(floor(place)), int3(0, 0, 0), CELLS - 1);
    int3 stride = int3(float3(sign(ray.direction)));
    // For each axis: next is the t at which the ray leaves the cell (never, if the ray is perpendicular to the axis),
    // and step is the distance in t between two cell boundaries.
    float3 next = (CORNER + SPACING * float3(cell + max(stride, 0)) - ray.origin) / ray.direction;
    next = mix(next, float3(NO_HIT, NO_HIT, NO_HIT), stride == int3(0, 0, 0));
    float3 step_1 = SPACING / abs(ray.direction);
    for (int i = 0; i < CELLS.x + CELLS.y + CELLS.z; i++) {
        float t = intersectSphere(ray, sphereIn(cell));
        if (t < NO_HIT) {
            return make_Intersection(t, cell);
        }
        if (next.x < next.y && next.x < next.z) {
            cell.x += stride.x;
            next.x += step_1.x;
            if (cell.x < 0 || cell.x >= CELLS.x) {
                return none_1;
            }
        } else if (next.y < next.z) {
            cell.y += stride.y;
            next.y += step_1.y;
            if (cell.y < 0 || cell.y >= CELLS.y) {
                return none_1;
            }
        } else {
            cell.z += stride.z;
            next.z += step_1.z;
            if (cell.z < 0 || cell.z >= CELLS.z) {
                return none_1;
            }
        }
    }
    return none_1;
}

Ray cameraRay(float2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
    float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
    return make_Ray(float3(0.0, 0.0, 0.0), normalize(float3(x, y, SCREEN_DEPTH)));
}

void mainImage(out float4 fragColor, float2 fragCoord) {
    fragColor = float4(0.0, 0.0, 0.0, 0.0);
    Ray ray = cameraRay(fragCoord);
    float3 color = float3(0.7, 0.8, 0.9);

    Intersection hit = hitScene(ray);
    if (hit.t < NO_HIT) {
        Sphere sphere = sphereIn(hit.cell);
        float3 albedo = nextColor();
        float3 point_1 = ray.origin + hit.t * ray.direction;
        float3 normal = normalize(point_1 - sphere.center);
        float3 sum = AMBIENT;
        float cosine = dot(normal, normalize(LIGHT - point_1));
        if (cosine > 0.0) {
            float3 origin = point_1 + 0.001 * normal;
            if (hitScene(make_Ray(origin, normalize(LIGHT - origin))).t == NO_HIT) {
                sum += float3(0.85, 0.85, 0.85) * cosine;
            }
        }
        color = albedo * sum;
    }
    fragColor = float4(color, 1.0);
}

float4 main(float4 position : SV_Position) : SV_Target0 {
    float4 color;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(color, position.xy);
    return float4(color.xyz, 1.0);
}
