#version 300 es
// glsl/11-animation.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A small solar system: a moon orbits a planet that orbits the sun, each with its own period. iTime moves the
// planets, iFrame the satellite.

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
const float TAU = 6.28318530718;
const int BODIES = 6;
const vec3 AMBIENT = vec3(0.12);
const vec3 SUN = vec3(0.0, 0.2, -7.0);

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Sphere {
    vec3 center;
    float radius;
    vec3 color;
};

Sphere bodies[6] = Sphere[6](Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)),
    Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)),
    Sphere(vec3(0.0), 0.0, vec3(0.0)), Sphere(vec3(0.0), 0.0, vec3(0.0)));
vec3 lamp = vec3(0.0);

// Rotates v about a unit axis (Rodrigues' formula).
vec3 rotate(vec3 v, vec3 axis, float angle) {
    float c = cos(angle);
    float s = sin(angle);
    return c * v + s * cross(axis, v) + (1.0 - c) * dot(axis, v) * axis;
}

vec3 rotateAbout(vec3 p, vec3 pivot, vec3 axis, float turns) {
    return pivot + rotate(p - pivot, axis, TAU * fract(turns));
}

// Each body first follows its own orbit, then the orbit of its parent.
vec3 year(vec3 p) {
    return rotateAbout(p, SUN, vec3(0.0, 1.0, 0.0), iTime / 8.0);
}

vec3 month(vec3 p) {
    return year(rotateAbout(p, vec3(2.0, 0.2, -7.0), vec3(0.0, 0.8, 0.6), iTime / 2.0));
}

vec3 orbit(vec3 p) {
    return month(rotateAbout(p, vec3(2.75, 0.2, -7.0), vec3(1.0, 0.0, 0.0), float(iFrame) / 60.0));
}

vec3 retrograde(vec3 p) {
    return rotateAbout(p, SUN, vec3(0.0, 0.96, -0.28), -iTime / 5.0);
}

void makeScene() {
    bodies[0] = Sphere(SUN, 0.8, vec3(1.0, 0.8, 0.3));
    bodies[1] = Sphere(year(vec3(2.0, 0.2, -7.0)), 0.35, vec3(0.3, 0.5, 0.9));
    bodies[2] = Sphere(month(vec3(2.75, 0.2, -7.0)), 0.15, vec3(0.8, 0.8, 0.8));
    bodies[3] = Sphere(orbit(vec3(2.75, 0.45, -7.0)), 0.06, vec3(0.9, 0.3, 0.9));
    bodies[4] = Sphere(retrograde(vec3(-1.4, 0.2, -7.0)), 0.22, vec3(0.9, 0.4, 0.2));
    bodies[5] = Sphere(vec3(0.0, -52.0, -8.0), 50.0, vec3(0.4, 0.4, 0.5));
    lamp = retrograde(vec3(3.0, 5.0, -4.0));
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

bool inShadow(vec3 point, vec3 normal) {
    vec3 origin = point + 0.001 * normal;
    vec3 toLight = lamp - origin;
    float distance = length(toLight);
    Ray ray = Ray(origin, toLight / distance);
    for (int i = 0; i < BODIES; i++) {
        if (intersectSphere(ray, bodies[i]) < distance) {
            return true;
        }
    }
    return false;
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
    vec3 color = vec3(0.02, 0.02, 0.06);

    float nearest = NO_HIT;
    int hit = -1;
    for (int i = 0; i < BODIES; i++) {
        float t = intersectSphere(ray, bodies[i]);
        if (t < nearest) {
            nearest = t;
            hit = i;
        }
    }
    if (hit >= 0) {
        vec3 point = ray.origin + nearest * ray.direction;
        vec3 normal = normalize(point - bodies[hit].center);
        float cosine = dot(normal, normalize(lamp - point));
        vec3 sum = AMBIENT;
        if (cosine > 0.0) {
            if (!inShadow(point, normal)) {
                sum += vec3(0.88) * cosine;
            }
        }
        color = bodies[hit].color * sum;
    }
    fragColor = vec4(color, 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
