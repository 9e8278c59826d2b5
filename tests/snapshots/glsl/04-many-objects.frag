#version 300 es
// glsl/04-many-objects.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Seven spheres: the nearest hit is visible, and spheres cast shadows on each other.

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
const int SAMPLES = 4;
const int SPHERES = 7;
const vec3 AMBIENT = vec3(0.08);

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
    vec3 color;
};

struct Intersection {
    float t;
    int sphere;
    vec3 point;
    vec3 normal;
};

Sphere spheres[7] = Sphere[7](Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)),
    Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)),
    Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)),
    Sphere(vec3(0.0), 0.0, vec3(0.0)));
Light light = Light(vec3(0.0), vec3(0.0));
float seed = 0.0;

float random() {
    // toyproof: allow(W0005) the scene's sampler uses this hash
    return fract(sin(seed++) * 43758.5453123);
}

void makeScene() {
    spheres[0] = Sphere(vec3(0.0, -31.0, -8.0), 30.0, vec3(0.5, 0.5, 0.45));
    spheres[1] = Sphere(vec3(0.5, -0.7, -4.0), 0.3, vec3(0.2, 0.8, 0.3));
    spheres[2] = Sphere(vec3(0.0, 0.0, -6.0), 1.0, vec3(0.9, 0.8, 0.1));
    spheres[3] = Sphere(vec3(-1.5, -0.4, -5.0), 0.6, vec3(0.9, 0.2, 0.15));
    spheres[4] = Sphere(vec3(1.4, -0.5, -4.8), 0.5, vec3(0.15, 0.3, 0.9));
    spheres[5] = Sphere(vec3(-0.6, 1.1, -5.5), 0.35, vec3(0.8, 0.4, 0.8));
    // Behind the light, so it casts no shadow.
    spheres[6] = Sphere(vec3(6.8, 10.2, 5.9), 3.0, vec3(0.6, 0.6, 0.6));
    light = Light(vec3(4.0, 6.0, 1.0), vec3(0.9));
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

Intersection nearestHit(Ray ray) {
    Intersection hit = Intersection(0.0, 0, vec3(0.0), vec3(0.0));
    hit.t = NO_HIT;
    hit.sphere = -1;
    for (int i = 0; i < SPHERES; i++) {
        float t = intersectSphere(ray, spheres[i]);
        if (t < hit.t) {
            hit.t = t;
            hit.sphere = i;
        }
    }
    for (int i = 0; i < SPHERES; i++) {
        if (i == hit.sphere) {
            hit.point = ray.origin + hit.t * ray.direction;
            hit.normal = (hit.point - spheres[i].center) / spheres[i].radius;
        }
    }
    return hit;
}

bool inShadow(vec3 point, vec3 normal) {
    // Start slightly above the surface, so that the shadow ray does not hit the same sphere.
    vec3 origin = point + 0.001 * normal;
    vec3 toLight = light.position - origin;
    float distance = length(toLight);
    Ray ray = Ray(origin, toLight / distance);
    for (int i = 0; i < SPHERES; i++) {
        if (intersectSphere(ray, spheres[i]) < distance) {
            return true;
        }
    }
    return false;
}

vec3 trace(Ray ray) {
    Intersection hit = nearestHit(ray);
    if (hit.sphere < 0) {
        return vec3(0.3, 0.4, 0.6);
    }
    vec3 sum = AMBIENT;
    float cosine = dot(hit.normal, normalize(light.position - hit.point));
    if (cosine > 0.0) {
        if (!inShadow(hit.point, hit.normal)) {
            sum += light.color * cosine;
        }
    }
    return spheres[hit.sphere].color * sum;
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
    seed = 0.0;
    vec3 color = vec3(0.0);
    for (int i = 0; i < SAMPLES; i++) {
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
