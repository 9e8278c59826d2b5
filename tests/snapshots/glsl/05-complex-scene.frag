#version 300 es
// glsl/05-complex-scene.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// 43 spheres in a hierarchy: a parent, six children, and six grandchildren for each child.

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
const float SHRINK = 2.8;
const vec3 AMBIENT = vec3(0.15);
const vec3 LIGHT = vec3(4.0, 5.0, 2.0);

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Sphere {
    vec3 center;
    float radius;
    vec3 color;
};

struct Intersection {
    float t;
    Sphere sphere;
};

// `a % b` of GLSL as Mesa and SwiftShader round it, down: other languages round towards zero.
int remainder(int a, int b) {
    int r = a % b;
    return r != 0 && (r ^ b) < 0 ? r + b : r;
}

// Right, left, up, down, front, back.
vec3 side(int i) {
    vec3 axis = vec3(float(i / 2 == 0), float(i / 2 == 1), float(i / 2 == 2));
    return remainder(i, 2) == 0 ? axis : -axis;
}

vec3 sideColor(int i) {
    return 0.5 + 0.4 * side(i);
}

// One turn in 240 frames, about the y axis through the parent.
vec3 turn(vec3 v, int frame) {
    float angle = 6.28318530718 * float(frame) / 240.0;
    float c = cos(angle);
    float s = sin(angle);
    return vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
}

Sphere childOf(Sphere parent, int i, int frame) {
    float radius = parent.radius / SHRINK;
    vec3 center = parent.center + (parent.radius + radius) * turn(side(i), frame);
    return Sphere(center, radius, 0.5 * (parent.color + sideColor(i)));
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

void keepNearest(Ray ray, Sphere sphere, inout Intersection hit) {
    float t = intersectSphere(ray, sphere);
    if (t < hit.t) {
        hit.t = t;
        hit.sphere = sphere;
    }
}

Intersection hitScene(Ray ray, int frame) {
    Sphere parent = Sphere(vec3(0.0, 0.0, -7.5), 1.0, vec3(0.9, 0.9, 0.8));
    Intersection hit = Intersection(NO_HIT, parent);
    keepNearest(ray, parent, hit);
    for (int i = 0; i < 6; i++) {
        Sphere child = childOf(parent, i, frame);
        keepNearest(ray, child, hit);
        for (int j = 0; j < 6; j++) {
            keepNearest(ray, childOf(child, j, frame), hit);
        }
    }
    return hit;
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
    vec3 color = vec3(0.05, 0.05, 0.1);

    Intersection hit = hitScene(ray, iFrame);
    if (hit.t < NO_HIT) {
        vec3 point = ray.origin + hit.t * ray.direction;
        vec3 normal = normalize(point - hit.sphere.center);
        vec3 toLight = normalize(LIGHT - point);
        color = hit.sphere.color * (AMBIENT + vec3(0.85) * max(dot(normal, toLight), 0.0));
    }
    fragColor = vec4(color, 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
