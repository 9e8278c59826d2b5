// glsl/10-quadrics.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Quadric surfaces. Each ray is transformed to the quadric's local frame, where a quadratic equation gives the hits.

#include <metal_stdlib>
using namespace metal;

constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1.0e6;
constant int QUADRICS = 5;
constant float3 AMBIENT = float3(0.15);
constant float3 LIGHT = float3(4.0, 6.0, 2.0);
constant float3 LIGHT_COLOR = float3(0.85);

struct Ray {
    float3 origin;
    float3 direction;
};

// q.x x^2 + q.y y^2 + q.z z^2 + 2 g z + k = 0 for low <= z <= high, with z along the axis.
struct Quadric {
    float3 origin;
    float3 axis;
    float3 q;
    float g;
    float k;
    float low;
    float high;
    float3 color;
};

struct Intersection {
    float t;
    float3 normal;
    float3 color;
};

Quadric ellipsoid(float3 center, float3 radii, float3 color) {
    // The ellipsoid's axes are the coordinate axes.
    return Quadric{ center, float3(0.0, 0.0, 1.0), 1.0 / (radii * radii), 0.0, -1.0, -radii.z,
        radii.z, color };
}

Quadric cylinder(float3 base, float3 axis, float radius, float height, float3 color) {
    return Quadric{ base, axis, float3(1.0, 1.0, 0.0), 0.0, -radius * radius, 0.0, height, color };
}

Quadric cone(float3 apex, float3 axis, float radius, float height, float3 color) {
    float slope = radius / height;
    return Quadric{ apex, axis, float3(1.0, 1.0, -slope * slope), 0.0, 0.0, 0.0, height, color };
}

Quadric paraboloid(float3 apex, float3 axis, float radius, float height, float3 color) {
    return Quadric{ apex, axis, float3(1.0, 1.0, 0.0), -0.5 * radius * radius / height, 0.0, 0.0,
        height, color };
}

Quadric hyperboloid(float3 center, float3 axis, float waist, float radius, float height,
        float3 color) {
    float z = 0.5 * height;
    float slope2 = (radius * radius - waist * waist) / (z * z);
    return Quadric{ center, axis, float3(1.0, 1.0, -slope2), 0.0, -waist * waist, -z, z, color };
}

// The local coordinates of v: along two directions perpendicular to the axis, and along the axis.
float3x3 frame(float3 axis) {
    float3 x = abs(axis.z) > 0.9 ? float3(1.0, 0.0, 0.0)
        : normalize(cross(axis, float3(0.0, 0.0, 1.0)));
    return float3x3(x, cross(axis, x), axis);
}

// The smallest t of a hit between the two ends.
float intersectQuadric(Ray ray, Quadric quadric, float3x3 frame) {
    float3 d = ray.direction * frame;
    float3 far = (ray.origin - quadric.origin) * frame;
    // Start at the point of the ray closest to the quadric's origin: smaller numbers have smaller rounding errors.
    float ahead = -dot(far, d);
    float3 o = far + ahead * d;
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

float3 normalOf(float3 point, Quadric quadric, float3x3 frame) {
    float3 p = (point - quadric.origin) * frame;
    return normalize(frame * (quadric.q * p + float3(0.0, 0.0, quadric.g)));
}

struct Shader {
    float3 iResolution;

    array<Quadric, 5> quadrics = {};

    void makeScene() {
        quadrics[0] = ellipsoid(float3(-2.0, 0.5, -7.0), float3(0.9, 0.5, 0.6),
            float3(0.9, 0.3, 0.3));
        quadrics[1] = cylinder(float3(-0.9, -1.0, -5.2), float3(0.0, 1.0, 0.0), 0.4, 0.8,
            float3(0.3, 0.7, 0.9));
        quadrics[2] = cone(float3(0.3, 0.9, -6.5), float3(0.0, -1.0, 0.0), 0.7, 1.9,
            float3(0.9, 0.7, 0.2));
        quadrics[3] = paraboloid(float3(1.1, -0.9, -5.0), float3(0.28, 0.96, 0.0), 0.5, 0.7,
            float3(0.5, 0.9, 0.4));
        quadrics[4] = hyperboloid(float3(2.3, 0.0, -7.5), float3(0.0, 1.0, 0.0), 0.4, 0.8, 2.0,
            float3(0.7, 0.5, 0.9));
    }

    Intersection nearestHit(Ray ray) {
        Intersection hit = { NO_HIT, float3(0.0), float3(0.0) };
        for (int i = 0; i < QUADRICS; i++) {
            float3x3 f = frame(quadrics[i].axis);
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
            hit = Intersection{ t, float3(0.0, 1.0, 0.0), float3(0.5) };
        }
        // Open surfaces are visible from both sides.
        if (dot(hit.normal, ray.direction) > 0.0) {
            hit.normal = -hit.normal;
        }
        return hit;
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
        Ray ray = cameraRay(fragCoord);
        float3 color = float3(0.6, 0.7, 0.9);

        Intersection hit = nearestHit(ray);
        if (hit.t < NO_HIT) {
            float3 point = ray.origin + hit.t * ray.direction;
            float3 toLight = LIGHT - (point + 0.001 * hit.normal);
            float distance_1 = length(toLight);
            float cosine = dot(hit.normal, normalize(LIGHT - point));
            float3 sum = AMBIENT;
            if (cosine > 0.0) {
                Ray shadow = { point + 0.001 * hit.normal, toLight / distance_1 };
                if (nearestHit(shadow).t > distance_1) {
                    sum += LIGHT_COLOR * cosine;
                }
            }
            color = hit.color * sum;
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
