#version 300 es
// glsl/09-soft-shadows.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A spherical light subtends a cone of directions; each sample picks a random direction in it.

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
const int SAMPLES = 16;
const int SPHERES = 4;
const vec3 AMBIENT = vec3(0.25);

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Sphere {
    vec3 center;
    float radius;
    vec3 color;
};

struct Light {
    vec3 position;
    float radius;
    vec3 color;
};

Sphere spheres[4] = Sphere[4](Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)),
    Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)));
Light light = Light(vec3(0.0), 0.0, vec3(0.0));
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
    spheres[0] = Sphere(vec3(0.0, -41.0, -8.0), 40.0, vec3(0.7, 0.7, 0.65));
    spheres[1] = Sphere(vec3(-1.3, -0.2, -6.5), 0.8, vec3(0.9, 0.4, 0.2));
    spheres[2] = Sphere(vec3(0.5, 0.6, -7.0), 0.6, vec3(0.3, 0.7, 0.4));
    spheres[3] = Sphere(vec3(1.5, -0.6, -5.5), 0.4, vec3(0.3, 0.4, 0.9));
    light = Light(vec3(3.0, 5.0, -5.0), 0.6, vec3(0.7));
}

float intersectSphere(Ray ray, Sphere sphere) {
    vec3 f = ray.origin - sphere.center;
    float b = dot(f, ray.direction);
    float c = dot(f, f) - sphere.radius * sphere.radius;
    float disc = b * b - c;
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

// The direction at an angle to w, given by its cosine, rotated about w by `turn` turns.
vec3 around(vec3 w, float cosine, float turn) {
    vec3 up = abs(w.y) > 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 a = normalize(cross(up, w));
    vec3 b = cross(w, a);
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float phi = 6.28318530718 * turn;
    return sine * cos(phi) * a + sine * sin(phi) * b + cosine * w;
}

// Samples a direction uniformly in the cone of the light; lightDistance is the distance to the light along it.
vec3 sampleLight(vec3 point, out float lightDistance) {
    vec3 toLight = light.position - point;
    float distance = length(toLight);
    float sine2 = light.radius * light.radius / (distance * distance);
    float depth = sine2 / (1.0 + sqrt(1.0 - sine2));
    float u = random();
    float v = random();
    float cosine = 1.0 - u * depth;
    float chord = sqrt(max(sine2 - (1.0 - cosine * cosine), 0.0));
    lightDistance = distance * (cosine - chord);
    return around(toLight / distance, cosine, v);
}

bool inShadow(Ray ray, float distance) {
    for (int i = 0; i < SPHERES; i++) {
        if (intersectSphere(ray, spheres[i]) < distance) {
            return true;
        }
    }
    return false;
}

vec3 trace(Ray ray) {
    float nearest = NO_HIT;
    int hit = -1;
    for (int i = 0; i < SPHERES; i++) {
        float t = intersectSphere(ray, spheres[i]);
        if (t < nearest) {
            nearest = t;
            hit = i;
        }
    }
    if (hit < 0) {
        return vec3(0.4, 0.5, 0.7);
    }
    vec3 point = ray.origin + nearest * ray.direction;
    vec3 normal = normalize(point - spheres[hit].center);
    float distance = 0.0;
    vec3 toLight = sampleLight(point, distance);
    vec3 sum = AMBIENT;
    float cosine = dot(normal, toLight);
    if (cosine > 0.0) {
        if (!inShadow(Ray(point + 0.001 * normal, toLight), distance)) {
            sum += light.color * cosine;
        }
    }
    return spheres[hit].color * sum;
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
    fragColor = vec4(color / float(SAMPLES), 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
