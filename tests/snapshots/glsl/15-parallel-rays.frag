#version 300 es
// glsl/15-parallel-rays.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Parallel projection: all rays have the same direction and different origins, so distant objects look no smaller.

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

const float NO_HIT = 1.0e6;
const float WIDTH = 6.0;
const int SPHERES = 5;
const vec3 AMBIENT = vec3(0.1, 0.1, 0.12);
const vec3 LIGHT = vec3(3.0, 5.0, 4.0);

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Sphere {
    vec3 center;
    float radius;
    vec3 color;
};

Sphere spheres[5] = Sphere[5](Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)),
    Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)),
    Sphere(vec3(0.0), 0.0, vec3(0.0)));

void makeScene() {
    spheres[0] = Sphere(vec3(-2.0, 0.0, -4.0), 0.7, vec3(0.9, 0.3, 0.2));
    spheres[1] = Sphere(vec3(-1.0, 0.3, -6.0), 0.7, vec3(0.9, 0.6, 0.2));
    spheres[2] = Sphere(vec3(0.0, 0.0, -9.0), 0.7, vec3(0.9, 0.9, 0.3));
    spheres[3] = Sphere(vec3(1.0, -0.3, -13.0), 0.7, vec3(0.3, 0.8, 0.4));
    spheres[4] = Sphere(vec3(2.0, 0.0, -18.0), 0.7, vec3(0.3, 0.5, 0.9));
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

Ray cameraRay(vec2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
    float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(0.5 * WIDTH * vec3(x, y, 0.0), vec3(0.0, 0.0, -1.0));
}

void mainImage(out vec4 fragColor, vec2 fragCoord) {
    fragColor = vec4(0.0);
    makeScene();
    Ray ray = cameraRay(fragCoord);
    vec3 color = vec3(0.05, 0.05, 0.08);

    float nearest = NO_HIT;
    int hit = -1;
    for (int i = 0; i < SPHERES; i++) {
        float t = intersectSphere(ray, spheres[i]);
        if (t < nearest) {
            nearest = t;
            hit = i;
        }
    }
    if (hit >= 0) {
        vec3 point = ray.origin + nearest * ray.direction;
        vec3 normal = normalize(point - spheres[hit].center);
        vec3 toLight = normalize(LIGHT - point);
        color = spheres[hit].color * (AMBIENT + vec3(0.9) * max(dot(normal, toLight), 0.0));
    }
    fragColor = vec4(color, 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
