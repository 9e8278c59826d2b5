// glsl/14-accelerator.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Hundreds of spheres, one in each cell of a grid. A ray visits only the cells that it passes through, in order,
// and the sphere of a cell is computed from the cell's number when needed.

#include <metal_stdlib>
using namespace metal;

constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1.0e6;
constant int3 CELLS = int3(11, 5, 10);
constant float3 CORNER = float3(-4.125, -1.875, -13.5);
constant float SPACING = 0.75;
constant uint SEED = 7u;
constant float3 AMBIENT = float3(0.15);
constant float3 LIGHT = float3(6.0, 8.0, -2.0);

struct Ray {
    float3 origin;
    float3 direction;
};

struct Sphere {
    float3 center;
    float radius;
};

struct Intersection {
    float t;
    int3 cell;
};

// The integer hash PCG (Jarzynski and Olano 2020).
uint pcg(uint v) {
    uint s = v * 747796405u + 2891336453u;
    uint word = (s >> (s >> 28u) + 4u ^ s) * 277803737u;
    return word >> 22u ^ word;
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

struct Shader {
    float3 iResolution;

    uint state = 0u;

    float random() {
        state = pcg(state);
        return float(state >> 8u) / 16777216.0;
    }

    // The sphere of a cell, entirely inside the cell; its color is random.
    Sphere sphereIn(int3 cell) {
        state = SEED + uint(cell.x + CELLS.x * (cell.y + CELLS.y * cell.z));
        float radius = mix(0.1, 0.3, random());
        float room = SPACING - 2.0 * radius;
        float x = random();
        float y = random();
        float z = random();
        return Sphere{ CORNER + SPACING * float3(cell) + radius + room * float3(x, y, z), radius };
    }

    float3 nextColor() {
        float r = random();
        float g = random();
        float b = random();
        return 0.95 * (0.2 + 0.8 * float3(r, g, b));
    }

    // The nearest hit, cell by cell (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", 1987).
    Intersection hitScene(Ray ray) {
        float3 low = (CORNER - ray.origin) / ray.direction;
        float3 high = (CORNER + SPACING * float3(CELLS) - ray.origin) / ray.direction;
        float3 into = min(low, high);
        float3 outOf = max(low, high);
        float enter = max(max(into.x, into.y), max(into.z, 0.0));
        float leave = min(outOf.x, min(outOf.y, outOf.z));
        Intersection none = { NO_HIT, int3(-1) };
        if (enter >= leave) {
            return none;
        }
        float3 place = (ray.origin + enter * ray.direction - CORNER) / SPACING;
        int3 cell = clamp(int3(floor(place)), int3(0), CELLS - 1);
        int3 stride = int3(sign(ray.direction));
        // For each axis: next is the t at which the ray leaves the cell (never, if the ray is perpendicular to the axis),
        // and step is the distance in t between two cell boundaries.
        float3 next = (CORNER + SPACING * float3(cell + max(stride, 0)) - ray.origin)
            / ray.direction;
        next = select(next, float3(NO_HIT), stride == int3(0));
        float3 step_1 = SPACING / abs(ray.direction);
        for (int i = 0; i < CELLS.x + CELLS.y + CELLS.z; i++) {
            float t = intersectSphere(ray, sphereIn(cell));
            if (t < NO_HIT) {
                return Intersection{ t, cell };
            }
            if (next.x < next.y && next.x < next.z) {
                cell.x += stride.x;
                next.x += step_1.x;
                if (cell.x < 0 || cell.x >= CELLS.x) {
                    return none;
                }
            } else if (next.y < next.z) {
                cell.y += stride.y;
                next.y += step_1.y;
                if (cell.y < 0 || cell.y >= CELLS.y) {
                    return none;
                }
            } else {
                cell.z += stride.z;
                next.z += step_1.z;
                if (cell.z < 0 || cell.z >= CELLS.z) {
                    return none;
                }
            }
        }
        return none;
    }

    Ray cameraRay(float2 fragCoord) {
        float aspect = iResolution.x / iResolution.y;
        float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
        float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
        return Ray{ float3(0.0), normalize(float3(x, y, SCREEN_DEPTH)) };
    }

    void mainImage(thread float4& fragColor, float2 fragCoord) {
        fragColor = float4(0.0);
        Ray ray = cameraRay(fragCoord);
        float3 color = float3(0.7, 0.8, 0.9);

        Intersection hit = hitScene(ray);
        if (hit.t < NO_HIT) {
            Sphere sphere = sphereIn(hit.cell);
            float3 albedo = nextColor();
            float3 point = ray.origin + hit.t * ray.direction;
            float3 normal = normalize(point - sphere.center);
            float3 sum = AMBIENT;
            float cosine = dot(normal, normalize(LIGHT - point));
            if (cosine > 0.0) {
                float3 origin = point + 0.001 * normal;
                if (hitScene(Ray{ origin, normalize(LIGHT - origin) }).t == NO_HIT) {
                    sum += float3(0.85) * cosine;
                }
            }
            color = albedo * sum;
        }
        fragColor = float4(color, 1.0);
    }
};

struct Inputs {
    packed_float3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    float4 iChannelTime[4];
    float3 iChannelResolution[4];
    float4 iMouse;
    float4 iDate;
    float iSampleRate;
};

fragment float4 main_(
    constant Inputs& inputs [[buffer(0)]],
    float4 position [[position]]
) {
    Shader shader = {
        float3(inputs.iResolution),
    };
    float4 color;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    shader.mainImage(color, position.xy);
    return float4(color.xyz, 1.0);
}
