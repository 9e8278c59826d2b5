#version 300 es
// glsl/13-importance-sampling.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A path tracer with multiple importance sampling: at each hit, one direction is sampled toward an emitter and one from the
// BRDF, and the power heuristic weights the two (Veach and Guibas 1995).

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
const float PI = 3.14159265359;
const float EPSILON = 0.001;
const int SAMPLES = 16;
const int SPHERES = 6;
const int EMITTERS = 2;
const int MAX_DEPTH = 4;

const int DIFFUSE = 0;
const int GLOSSY = 1;
const int EMITTER = 2;

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Material {
    int model;
    vec3 color;
    float exponent;
};

struct Sphere {
    vec3 center;
    float radius;
    Material material;
};

struct Intersection {
    float t;
    vec3 point;
    vec3 normal;
    Material material;
    // The index of the sphere, or -1; the first EMITTERS spheres are emitters.
    int sphere;
};

Sphere spheres[6] = Sphere[6](Sphere(vec3(0.0), 0.0, Material(0, vec3(0.0), 0.0)),
    Sphere(vec3(0.0), 0.0, Material(0, vec3(0.0), 0.0)),
    Sphere(vec3(0.0), 0.0, Material(0, vec3(0.0), 0.0)),
    Sphere(vec3(0.0), 0.0, Material(0, vec3(0.0), 0.0)),
    Sphere(vec3(0.0), 0.0, Material(0, vec3(0.0), 0.0)),
    Sphere(vec3(0.0), 0.0, Material(0, vec3(0.0), 0.0)));
uint state = 0u;

// The integer hash PCG (Jarzynski and Olano 2020), which gives the same numbers on every machine.
uint pcg(uint v) {
    uint s = v * 747796405u + 2891336453u;
    uint word = (s >> (s >> 28u) + 4u ^ s) * 277803737u;
    return word >> 22u ^ word;
}

float random() {
    state = pcg(state);
    return float(state >> 8u) / 16777216.0;
}

void startSample(vec2 fragCoord, int i) {
    state = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))));
}

void makeScene() {
    spheres[0] = Sphere(vec3(-2.5, 1.4, -6.5), 0.25,
        Material(EMITTER, vec3(80.0, 70.0, 55.0), 0.0));
    spheres[1] = Sphere(vec3(2.2, 1.4, -7.5), 0.8, Material(EMITTER, vec3(2.5, 3.0, 4.0), 0.0));
    spheres[2] = Sphere(vec3(-1.8, -0.3, -6.0), 0.7, Material(GLOSSY, vec3(0.9, 0.7, 0.3), 300.0));
    spheres[3] = Sphere(vec3(0.0, -0.3, -6.5), 0.7, Material(GLOSSY, vec3(0.8, 0.8, 0.8), 30.0));
    spheres[4] = Sphere(vec3(1.7, -0.4, -5.5), 0.6, Material(DIFFUSE, vec3(0.8, 0.25, 0.2), 0.0));
    spheres[5] = Sphere(vec3(0.6, -0.75, -4.2), 0.25, Material(DIFFUSE, vec3(0.3, 0.7, 0.4), 0.0));
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

Intersection nearestHit(Ray ray) {
    Intersection hit = Intersection(0.0, vec3(0.0), vec3(0.0), Material(0, vec3(0.0), 0.0), 0);
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
        hit.normal = vec3(0.0, 1.0, 0.0);
        hit.material = Material(DIFFUSE, vec3(0.6, 0.6, 0.65), 0.0);
    }
    hit.point = ray.origin + hit.t * ray.direction;
    if (hit.sphere >= 0) {
        hit.normal = normalize(hit.point - spheres[hit.sphere].center);
        hit.material = spheres[hit.sphere].material;
    }
    return hit;
}

// The direction at an angle to w, given by its cosine, rotated about w by `turn` turns.
vec3 around(vec3 w, float cosine, float turn) {
    vec3 up = abs(w.y) > 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 a = normalize(cross(up, w));
    vec3 b = cross(w, a);
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float phi = 6.28318530718 * turn;
    return sine * cos(phi) * a + sine * sin(phi) * b + cosine * w;
}

// 1 - cos of the half angle of the cone that an emitter subtends.
float coneDepth(vec3 point, Sphere emitter) {
    vec3 toCenter = emitter.center - point;
    float sine2 = emitter.radius * emitter.radius / dot(toCenter, toCenter);
    return sine2 / (1.0 + sqrt(1.0 - sine2));
}

// The probability density, per solid angle, of sampling a direction toward this emitter.
float lightDensity(vec3 point, Sphere emitter) {
    return 1.0 / (2.0 * PI * coneDepth(point, emitter) * float(EMITTERS));
}

vec3 brdf(Material material, vec3 reflected, vec3 direction) {
    if (material.model == GLOSSY) {
        float lobe = pow(max(dot(reflected, direction), 0.0), material.exponent);
        return material.color * (material.exponent + 2.0) / (2.0 * PI) * lobe;
    }
    return material.color / PI;
}

float brdfDensity(Material material, vec3 normal, vec3 reflected, vec3 direction) {
    if (material.model == GLOSSY) {
        float lobe = pow(max(dot(reflected, direction), 0.0), material.exponent);
        return (material.exponent + 1.0) / (2.0 * PI) * lobe;
    }
    return max(dot(normal, direction), 0.0) / PI;
}

vec3 sampleBrdf(Material material, vec3 normal, vec3 reflected) {
    float u = random();
    float v = random();
    if (material.model == GLOSSY) {
        return around(reflected, pow(1.0 - u, 1.0 / (material.exponent + 1.0)), v);
    }
    return around(normal, sqrt(1.0 - u), v);
}

float weight(float density, float other) {
    float ratio = other / density;
    return 1.0 / (1.0 + ratio * ratio);
}

bool inShadow(Ray ray, int emitter) {
    float distance = intersectSphere(ray, spheres[emitter]);
    for (int i = 0; i < SPHERES; i++) {
        if (i != emitter && intersectSphere(ray, spheres[i]) < distance) {
            return true;
        }
    }
    float t = (-1.0 - ray.origin.y) / ray.direction.y;
    return t > EPSILON && t < distance;
}

// The light from one randomly chosen emitter.
vec3 sampleLight(Intersection hit, vec3 reflected) {
    int emitter = min(int(random() * float(EMITTERS)), EMITTERS - 1);
    float u = random();
    float v = random();
    float cosine = 1.0 - u * coneDepth(hit.point, spheres[emitter]);
    vec3 direction = around(normalize(spheres[emitter].center - hit.point), cosine, v);
    float facing = dot(hit.normal, direction);
    if (facing <= 0.0) {
        return vec3(0.0);
    }
    if (inShadow(Ray(hit.point + EPSILON * hit.normal, direction), emitter)) {
        return vec3(0.0);
    }
    float density = lightDensity(hit.point, spheres[emitter]);
    float other = brdfDensity(hit.material, hit.normal, reflected, direction);
    return spheres[emitter].material.color * brdf(hit.material, reflected, direction) * facing
        * weight(density, other) / density;
}

vec3 trace(Ray ray) {
    vec3 color = vec3(0.0);
    vec3 throughput = vec3(1.0);
    // The probability density of the ray's direction; 0 for camera rays.
    float density = 0.0;
    for (int depth = 0; depth < MAX_DEPTH; depth++) {
        Intersection hit = nearestHit(ray);
        if (hit.t == NO_HIT) {
            return color + throughput * vec3(0.05, 0.06, 0.08);
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
        vec3 reflected = reflect(ray.direction, hit.normal);
        color += throughput * sampleLight(hit, reflected);
        vec3 direction = sampleBrdf(hit.material, hit.normal, reflected);
        float facing = dot(hit.normal, direction);
        if (facing <= 0.0) {
            return color;
        }
        density = brdfDensity(hit.material, hit.normal, reflected, direction);
        throughput *= brdf(hit.material, reflected, direction) * facing / density;
        ray = Ray(hit.point + EPSILON * hit.normal, direction);
    }
    return color;
}

Ray cameraRay(vec2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
    float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3(0.0), normalize(vec3(x, y, SCREEN_DEPTH)));
}

void mainImage(out vec4 fragColor, vec2 fragCoord) {
    fragColor = vec4(0.0);
    makeScene();
    vec3 color = vec3(0.0);
    for (int i = 0; i < SAMPLES; i++) {
        startSample(fragCoord, i);
        float x = fragCoord.x + random() - 0.5;
        float y = fragCoord.y + random() - 0.5;
        color += trace(cameraRay(vec2(x, y)));
    }
    color /= float(SAMPLES);
    fragColor = vec4(pow(color / (color + 1.0), vec3(0.45454544)), 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
