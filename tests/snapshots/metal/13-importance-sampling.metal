// glsl/13-importance-sampling.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A path tracer with multiple importance sampling: at each hit, one direction is sampled toward an emitter and one from the
// BRDF, and the power heuristic weights the two (Veach and Guibas 1995).

#include <metal_stdlib>
using namespace metal;

constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1.0e6;
constant float PI = 3.14159265359;
constant float EPSILON = 0.001;
constant int SAMPLES = 16;
constant int SPHERES = 6;
constant int EMITTERS = 2;
constant int MAX_DEPTH = 4;

constant int DIFFUSE = 0;
constant int GLOSSY = 1;
constant int EMITTER = 2;

struct Ray {
    float3 origin;
    float3 direction;
};

struct Material {
    int model;
    float3 color;
    float exponent;
};

struct Sphere {
    float3 center;
    float radius;
    Material material;
};

struct Intersection {
    float t;
    float3 point;
    float3 normal;
    Material material;
    // The index of the sphere, or -1; the first EMITTERS spheres are emitters.
    int sphere;
};

// The integer hash PCG (Jarzynski and Olano 2020), which gives the same numbers on every machine.
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
        if (t > EPSILON) {
            return t;
        }
        t = -b + root;
        if (t > EPSILON) {
            return t;
        }
    }
    return NO_HIT;
}

// The direction at an angle to w, given by its cosine, rotated about w by `turn` turns.
float3 around(float3 w, float cosine, float turn) {
    float3 up = abs(w.y) > 0.9 ? float3(1.0, 0.0, 0.0) : float3(0.0, 1.0, 0.0);
    float3 a = normalize(cross(up, w));
    float3 b = cross(w, a);
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float phi = 6.28318530718 * turn;
    return sine * cos(phi) * a + sine * sin(phi) * b + cosine * w;
}

// 1 - cos of the half angle of the cone that an emitter subtends.
float coneDepth(float3 point, Sphere emitter) {
    float3 toCenter = emitter.center - point;
    float sine2 = emitter.radius * emitter.radius / dot(toCenter, toCenter);
    return sine2 / (1.0 + sqrt(1.0 - sine2));
}

// The probability density, per solid angle, of sampling a direction toward this emitter.
float lightDensity(float3 point, Sphere emitter) {
    return 1.0 / (2.0 * PI * coneDepth(point, emitter) * float(EMITTERS));
}

float3 brdf(Material material, float3 reflected, float3 direction) {
    if (material.model == GLOSSY) {
        float lobe = pow(max(dot(reflected, direction), 0.0), material.exponent);
        return material.color * (material.exponent + 2.0) / (2.0 * PI) * lobe;
    }
    return material.color / PI;
}

float brdfDensity(Material material, float3 normal, float3 reflected, float3 direction) {
    if (material.model == GLOSSY) {
        float lobe = pow(max(dot(reflected, direction), 0.0), material.exponent);
        return (material.exponent + 1.0) / (2.0 * PI) * lobe;
    }
    return max(dot(normal, direction), 0.0) / PI;
}

float weight(float density, float other) {
    float ratio = other / density;
    return 1.0 / (1.0 + ratio * ratio);
}

struct Shader {
    float3 iResolution;

    array<Sphere, 6> spheres = {};
    uint state = 0u;

    float random() {
        state = pcg(state);
        return float(state >> 8u) / 16777216.0;
    }

    void startSample(float2 fragCoord, int i) {
        state = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))));
    }

    void makeScene() {
        spheres[0] = Sphere{ float3(-2.5, 1.4, -6.5), 0.25,
            Material{ EMITTER, float3(80.0, 70.0, 55.0), 0.0 } };
        spheres[1] = Sphere{ float3(2.2, 1.4, -7.5), 0.8,
            Material{ EMITTER, float3(2.5, 3.0, 4.0), 0.0 } };
        spheres[2] = Sphere{ float3(-1.8, -0.3, -6.0), 0.7,
            Material{ GLOSSY, float3(0.9, 0.7, 0.3), 300.0 } };
        spheres[3] = Sphere{ float3(0.0, -0.3, -6.5), 0.7,
            Material{ GLOSSY, float3(0.8, 0.8, 0.8), 30.0 } };
        spheres[4] = Sphere{ float3(1.7, -0.4, -5.5), 0.6,
            Material{ DIFFUSE, float3(0.8, 0.25, 0.2), 0.0 } };
        spheres[5] = Sphere{ float3(0.6, -0.75, -4.2), 0.25,
            Material{ DIFFUSE, float3(0.3, 0.7, 0.4), 0.0 } };
    }

    Intersection nearestHit(Ray ray) {
        Intersection hit = {};
        hit.t = NO_HIT;
        hit.sphere = -1;
        for (int i = 0; i < SPHERES; i++) {
            float t = intersectSphere(ray, spheres[i]);
            if (t < hit.t) {
                hit.t = t;
                hit.sphere = i;
            }
        }
        float t = (-1.0 - ray.origin.y) / ray.direction.y;
        if (t > EPSILON && t < hit.t) {
            hit.t = t;
            hit.sphere = -1;
            hit.normal = float3(0.0, 1.0, 0.0);
            hit.material = Material{ DIFFUSE, float3(0.6, 0.6, 0.65), 0.0 };
        }
        hit.point = ray.origin + hit.t * ray.direction;
        if (hit.sphere >= 0) {
            hit.normal = normalize(hit.point - spheres[hit.sphere].center);
            hit.material = spheres[hit.sphere].material;
        }
        return hit;
    }

    float3 sampleBrdf(Material material, float3 normal, float3 reflected) {
        float u = random();
        float v = random();
        if (material.model == GLOSSY) {
            return around(reflected, pow(1.0 - u, 1.0 / (material.exponent + 1.0)), v);
        }
        return around(normal, sqrt(1.0 - u), v);
    }

    bool inShadow(Ray ray, int emitter) {
        float distance_1 = intersectSphere(ray, spheres[emitter]);
        for (int i = 0; i < SPHERES; i++) {
            if (i != emitter && intersectSphere(ray, spheres[i]) < distance_1) {
                return true;
            }
        }
        float t = (-1.0 - ray.origin.y) / ray.direction.y;
        return t > EPSILON && t < distance_1;
    }

    // The light from one randomly chosen emitter.
    float3 sampleLight(Intersection hit, float3 reflected) {
        int emitter = min(int(random() * float(EMITTERS)), EMITTERS - 1);
        float u = random();
        float v = random();
        float cosine = 1.0 - u * coneDepth(hit.point, spheres[emitter]);
        float3 direction = around(normalize(spheres[emitter].center - hit.point), cosine, v);
        float facing = dot(hit.normal, direction);
        if (facing <= 0.0) {
            return float3(0.0);
        }
        if (inShadow(Ray{ hit.point + EPSILON * hit.normal, direction }, emitter)) {
            return float3(0.0);
        }
        float density = lightDensity(hit.point, spheres[emitter]);
        float other = brdfDensity(hit.material, hit.normal, reflected, direction);
        return spheres[emitter].material.color * brdf(hit.material, reflected, direction) * facing
            * weight(density, other) / density;
    }

    float3 trace(Ray ray) {
        float3 color = float3(0.0);
        float3 throughput = float3(1.0);
        // The probability density of the ray's direction; 0 for camera rays.
        float density = 0.0;
        for (int depth = 0; depth < MAX_DEPTH; depth++) {
            Intersection hit = nearestHit(ray);
            if (hit.t == NO_HIT) {
                return color + throughput * float3(0.05, 0.06, 0.08);
            }
            if (hit.material.model == EMITTER) {
                float share = 1.0;
                if (density > 0.0) {
                    share = weight(density, lightDensity(ray.origin, spheres[hit.sphere]));
                }
                return color + throughput * hit.material.color * share;
            }
            // A path through another surface would be longer than MAX_DEPTH segments.
            if (depth + 1 == MAX_DEPTH) {
                return color;
            }
            float3 reflected = reflect(ray.direction, hit.normal);
            color += throughput * sampleLight(hit, reflected);
            float3 direction = sampleBrdf(hit.material, hit.normal, reflected);
            float facing = dot(hit.normal, direction);
            if (facing <= 0.0) {
                return color;
            }
            density = brdfDensity(hit.material, hit.normal, reflected, direction);
            throughput *= brdf(hit.material, reflected, direction) * facing / density;
            ray = Ray{ hit.point + EPSILON * hit.normal, direction };
        }
        return color;
    }

    Ray cameraRay(float2 fragCoord) {
        float aspect = iResolution.x / iResolution.y;
        float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
        float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
        return Ray{ float3(0.0), normalize(float3(x, y, SCREEN_DEPTH)) };
    }

    void mainImage(thread float4& fragColor, float2 fragCoord) {
        fragColor = float4(0.0);
        makeScene();
        float3 color = float3(0.0);
        for (int i = 0; i < SAMPLES; i++) {
            startSample(fragCoord, i);
            float x = fragCoord.x + random() - 0.5;
            float y = fragCoord.y + random() - 0.5;
            color += trace(cameraRay(float2(x, y)));
        }
        color /= float(SAMPLES);
        fragColor = float4(pow(color / (color + 1.0), float3(0.45454544)), 1.0);
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
