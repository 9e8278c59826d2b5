#version 300 es
// glsl/10-quadrics.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Quadric surfaces. Each ray is transformed to the quadric's local frame, where a quadratic equation gives the hits.

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
const int QUADRICS = 5;
const vec3 AMBIENT = vec3(0.15);
const vec3 LIGHT = vec3(4.0, 6.0, 2.0);
const vec3 LIGHT_COLOR = vec3(0.85);

struct Ray {
    vec3 origin;
    vec3 direction;
};

// q.x x^2 + q.y y^2 + q.z z^2 + 2 g z + k = 0 for low <= z <= high, with z along the axis.
struct Quadric {
    vec3 origin;
    vec3 axis;
    vec3 q;
    float g;
    float k;
    float low;
    float high;
    vec3 color;
};

struct Intersection {
    float t;
    vec3 normal;
    vec3 color;
};

Quadric quadrics[5] = Quadric[5](Quadric(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0,
        vec3(0.0)), Quadric(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0)),
    Quadric(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0)),
    Quadric(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0)),
    Quadric(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0)));

Quadric ellipsoid(vec3 center, vec3 radii, vec3 color) {
    // The ellipsoid's axes are the coordinate axes.
    return Quadric(center, vec3(0.0, 0.0, 1.0), 1.0 / (radii * radii), 0.0, -1.0, -radii.z, radii.z,
        color);
}

Quadric cylinder(vec3 base, vec3 axis, float radius, float height, vec3 color) {
    return Quadric(base, axis, vec3(1.0, 1.0, 0.0), 0.0, -radius * radius, 0.0, height, color);
}

Quadric cone(vec3 apex, vec3 axis, float radius, float height, vec3 color) {
    float slope = radius / height;
    return Quadric(apex, axis, vec3(1.0, 1.0, -slope * slope), 0.0, 0.0, 0.0, height, color);
}

Quadric paraboloid(vec3 apex, vec3 axis, float radius, float height, vec3 color) {
    return Quadric(apex, axis, vec3(1.0, 1.0, 0.0), -0.5 * radius * radius / height, 0.0, 0.0,
        height, color);
}

Quadric hyperboloid(vec3 center, vec3 axis, float waist, float radius, float height, vec3 color) {
    float z = 0.5 * height;
    float slope2 = (radius * radius - waist * waist) / (z * z);
    return Quadric(center, axis, vec3(1.0, 1.0, -slope2), 0.0, -waist * waist, -z, z, color);
}

void makeScene() {
    quadrics[0] = ellipsoid(vec3(-2.0, 0.5, -7.0), vec3(0.9, 0.5, 0.6), vec3(0.9, 0.3, 0.3));
    quadrics[1] = cylinder(vec3(-0.9, -1.0, -5.2), vec3(0.0, 1.0, 0.0), 0.4, 0.8,
        vec3(0.3, 0.7, 0.9));
    quadrics[2] = cone(vec3(0.3, 0.9, -6.5), vec3(0.0, -1.0, 0.0), 0.7, 1.9, vec3(0.9, 0.7, 0.2));
    quadrics[3] = paraboloid(vec3(1.1, -0.9, -5.0), vec3(0.28, 0.96, 0.0), 0.5, 0.7,
        vec3(0.5, 0.9, 0.4));
    quadrics[4] = hyperboloid(vec3(2.3, 0.0, -7.5), vec3(0.0, 1.0, 0.0), 0.4, 0.8, 2.0,
        vec3(0.7, 0.5, 0.9));
}

// The local coordinates of v: along two directions perpendicular to the axis, and along the axis.
mat3 frame(vec3 axis) {
    vec3 x = abs(axis.z) > 0.9 ? vec3(1.0, 0.0, 0.0) : normalize(cross(axis, vec3(0.0, 0.0, 1.0)));
    return mat3(x, cross(axis, x), axis);
}

// The smallest t of a hit between the two ends.
float intersectQuadric(Ray ray, Quadric quadric, mat3 frame) {
    vec3 d = ray.direction * frame;
    vec3 far = (ray.origin - quadric.origin) * frame;
    // Start at the point of the ray closest to the quadric's origin: smaller numbers have smaller rounding errors.
    float ahead = -dot(far, d);
    vec3 o = far + ahead * d;
    float a = dot(quadric.q * d, d);
    float b = dot(quadric.q * d, o) + quadric.g * d.z;
    float c = dot(quadric.q * o, o) + 2.0 * quadric.g * o.z + quadric.k;
    float disc = b * b - a * c;
    if (disc < 0.0) {
        return NO_HIT;
    }
    // The root without cancellation; the other follows from their product. If a is 0, there is only one root.
    float q = b > 0.0 ? -b - sqrt(disc) : -b + sqrt(disc);
    float t0 = q == 0.0 ? NO_HIT : c / q;
    float t1 = a == 0.0 ? NO_HIT : q / a;
    if (t0 > t1) {
        float t = t0;
        t0 = t1;
        t1 = t;
    }
    float z0 = o.z + t0 * d.z;
    if (ahead + t0 > 0.001 && z0 >= quadric.low && z0 <= quadric.high) {
        return ahead + t0;
    }
    float z1 = o.z + t1 * d.z;
    if (ahead + t1 > 0.001 && z1 >= quadric.low && z1 <= quadric.high) {
        return ahead + t1;
    }
    return NO_HIT;
}

vec3 normalOf(vec3 point, Quadric quadric, mat3 frame) {
    vec3 p = (point - quadric.origin) * frame;
    return normalize(frame * (quadric.q * p + vec3(0.0, 0.0, quadric.g)));
}

Intersection nearestHit(Ray ray) {
    Intersection hit = Intersection(NO_HIT, vec3(0.0), vec3(0.0));
    for (int i = 0; i < QUADRICS; i++) {
        mat3 f = frame(quadrics[i].axis);
        float t = intersectQuadric(ray, quadrics[i], f);
        if (t < hit.t) {
            hit.t = t;
            hit.normal = normalOf(ray.origin + t * ray.direction, quadrics[i], f);
            hit.color = quadrics[i].color;
        }
    }
    // The ground is a plane.
    float t = (-1.0 - ray.origin.y) / ray.direction.y;
    if (t > 0.001 && t < hit.t) {
        hit = Intersection(t, vec3(0.0, 1.0, 0.0), vec3(0.5));
    }
    // Open surfaces are visible from both sides.
    if (dot(hit.normal, ray.direction) > 0.0) {
        hit.normal = -hit.normal;
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
    makeScene();
    Ray ray = cameraRay(fragCoord);
    vec3 color = vec3(0.6, 0.7, 0.9);

    Intersection hit = nearestHit(ray);
    if (hit.t < NO_HIT) {
        vec3 point = ray.origin + hit.t * ray.direction;
        vec3 toLight = LIGHT - (point + 0.001 * hit.normal);
        float distance = length(toLight);
        float cosine = dot(hit.normal, normalize(LIGHT - point));
        vec3 sum = AMBIENT;
        if (cosine > 0.0) {
            Ray shadow = Ray(point + 0.001 * hit.normal, toLight / distance);
            if (nearestHit(shadow).t > distance) {
                sum += LIGHT_COLOR * cosine;
            }
        }
        color = hit.color * sum;
    }
    fragColor = vec4(color, 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
