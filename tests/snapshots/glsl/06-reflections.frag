#version 300 es
// glsl/06-reflections.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Mirrors under an evening sky: the ray is reflected until it misses all mirrors.

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
const float EPSILON = 0.001;
const int SPHERES = 4;
const int MAX_DEPTH = 100;

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Sphere {
    vec3 center;
    float radius;
    vec3 color;
};

Sphere spheres[4] = Sphere[4](Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)),
    Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)));

void makeScene() {
    spheres[0] = Sphere(vec3(-1.3, -0.4, -5.2), 0.6, vec3(0.9, 0.6, 0.6));
    spheres[1] = Sphere(vec3(0.0, 0.0, -7.0), 1.2, vec3(0.95, 0.93, 0.88));
    spheres[2] = Sphere(vec3(0.2, -0.6, -3.6), 0.3, vec3(0.7, 0.9, 0.7));
    spheres[3] = Sphere(vec3(1.2, 0.5, -5.0), 0.7, vec3(0.6, 0.7, 0.95));
}

vec3 sky(vec3 direction) {
    float up = 0.5 * (1.0 + direction.y);
    return (1.0 - up) * vec3(0.9, 0.5, 0.25) + up * vec3(0.1, 0.2, 0.5);
}

// As in 02-sphere, but hits closer than t_min are ignored: they are on the surface that the ray just left.
float intersectSphere(Ray ray, Sphere sphere, float tMin) {
    vec3 f = ray.origin - sphere.center;
    float b = dot(f, ray.direction);
    float c = dot(f, f) - sphere.radius * sphere.radius;
    float disc = b * b - c;
    if (disc > 0.0) {
        float root = sqrt(disc);
        float t = -b - root;
        if (t > tMin) {
            return t;
        }
        t = -b + root;
        if (t > tMin) {
            return t;
        }
    }
    return NO_HIT;
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
    Ray ray = cameraRay(fragCoord);
    vec3 color = vec3(0.0);
    vec3 throughput = vec3(1.0);

    for (int depth = 0; depth < MAX_DEPTH; depth++) {
        float nearest = NO_HIT;
        int hit = -1;
        for (int i = 0; i < SPHERES; i++) {
            float t = intersectSphere(ray, spheres[i], EPSILON);
            if (t < nearest) {
                nearest = t;
                hit = i;
            }
        }
        if (hit < 0) {
            color = throughput * sky(ray.direction);
            break;
        }
        vec3 point = ray.origin + nearest * ray.direction;
        vec3 normal = normalize(point - spheres[hit].center);
        throughput *= spheres[hit].color;
        ray = Ray(point, reflect(ray.direction, normal));
    }
    fragColor = vec4(color, 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
