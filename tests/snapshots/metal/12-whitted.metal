// glsl/12-whitted.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Whitted's scene: a mirror and a glass ball above a checkered floor. Glass splits each ray into two; a stack holds
// the rays that remain to be traced.

#include <metal_stdlib>
using namespace metal;

// `mod` of GLSL: `fmod` rounds towards zero.
float mod(float x, float y) {
    return x - y * floor(x / y);
}

constant float SCREEN_DEPTH = -2.0;
constant float NO_HIT = 1.0e6;
constant float EPSILON = 0.001;
constant int SPHERES = 4;
constant int MAX_DEPTH = 6;
constant float3 AMBIENT = float3(0.15);
constant float3 LIGHT = float3(-4.0, 7.0, 1.0);

constant int MATTE = 0;
constant int MIRROR = 1;
constant int GLASS = 2;
constant float IOR = 1.5;

struct Ray {
    float3 origin;
    float3 direction;
};

struct Sphere {
    float3 center;
    float radius;
    int model;
    float3 color;
};

struct Intersection {
    float t;
    float3 point;
    float3 normal;
    int model;
    float3 color;
};

// A ray on the stack; its throughput is its contribution to the pixel.
struct Branch {
    Ray ray;
    float3 throughput;
    int depth;
};

float3 sky(float3 direction) {
    float up = 0.5 * (1.0 + direction.y);
    return (1.0 - up) * float3(0.9, 0.9, 0.95) + up * float3(0.3, 0.5, 0.9);
}

float intersectSphere(Ray ray, Sphere sphere) {
    float3 f = ray.origin - sphere.center;
    float b = dot(f, ray.direction);
    float c = dot(f, f) - sphere.radius * sphere.radius;
    float disc = b * b - c;
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

float3 checker(float3 point) {
    float square = floor(point.x) + floor(point.z);
    return mod(square, 2.0) == 0.0 ? float3(0.9, 0.8, 0.3) : float3(0.6, 0.15, 0.1);
}

// The reflectance by Fresnel's equations, for unpolarized light. eta is the index of refraction on this side divided
// by the index on the other side; cosine and beyond are the cosines of the ray on this side and on the other.
float fresnel(float eta, float cosine, float beyond) {
    float across = (eta * cosine - beyond) / (eta * cosine + beyond);
    float along = (cosine - eta * beyond) / (cosine + eta * beyond);
    return 0.5 * (across * across + along * along);
}

struct Shader {
    float3 iResolution;

    array<Sphere, 4> spheres = {};

    void makeScene() {
        spheres[0] = Sphere{ float3(-0.5, 0.0, -4.5), 0.9, GLASS, float3(0.95, 1.0, 0.95) };
        spheres[1] = Sphere{ float3(1.3, 0.1, -6.5), 1.1, MIRROR, float3(0.9, 0.9, 0.9) };
        spheres[2] = Sphere{ float3(-2.4, -0.4, -7.0), 0.6, MATTE, float3(0.9, 0.3, 0.2) };
        spheres[3] = Sphere{ float3(1.1, -0.7, -4.0), 0.3, MATTE, float3(0.2, 0.4, 0.9) };
    }

    Intersection nearestHit(Ray ray) {
        Intersection hit = { NO_HIT, float3(0.0), float3(0.0), MATTE, float3(0.0) };
        for (int i = 0; i < SPHERES; i++) {
            float t = intersectSphere(ray, spheres[i]);
            if (t < hit.t) {
                float3 point = ray.origin + t * ray.direction;
                float3 normal = normalize(point - spheres[i].center);
                hit = Intersection{ t, point, normal, spheres[i].model, spheres[i].color };
            }
        }
        float t = (-1.02 - ray.origin.y) / ray.direction.y;
        if (t > EPSILON && t < hit.t) {
            float3 point = ray.origin + t * ray.direction;
            hit = Intersection{ t, point, float3(0.0, 1.0, 0.0), MATTE, checker(point) };
        }
        return hit;
    }

    float3 shade(Intersection hit) {
        float3 sum = AMBIENT;
        float cosine = dot(hit.normal, normalize(LIGHT - hit.point));
        if (cosine > 0.0) {
            float3 origin = hit.point + EPSILON * hit.normal;
            float3 toLight = LIGHT - origin;
            float distance_1 = length(toLight);
            if (nearestHit(Ray{ origin, toLight / distance_1 }).t > distance_1) {
                sum += float3(0.85) * cosine;
            }
        }
        return hit.color * sum;
    }

    float3 trace(Ray first) {
        array<Branch, 8> stack = {};
        stack[0] = Branch{ first, float3(1.0), 0 };
        int top = 1;
        float3 color = float3(0.0);
        while (top > 0) {
            top--;
            Branch branch = stack[top];
            Ray ray = branch.ray;
            Intersection hit = nearestHit(ray);
            if (hit.t == NO_HIT) {
                color += branch.throughput * sky(ray.direction);
                continue;
            }
            if (hit.model == MATTE) {
                color += branch.throughput * shade(hit);
                continue;
            }
            int depth = branch.depth + 1;
            if (depth == MAX_DEPTH) {
                continue;
            }
            float3 throughput = branch.throughput * hit.color;
            Ray mirrored = { hit.point, reflect(ray.direction, hit.normal) };
            if (hit.model == MIRROR) {
                stack[top++] = Branch{ mirrored, throughput, depth };
                continue;
            }
            bool entering = dot(ray.direction, hit.normal) < 0.0;
            float3 normal = entering ? hit.normal : -hit.normal;
            float eta = entering ? 1.0 / IOR : IOR;
            float cosine = -dot(ray.direction, normal);
            float sine2 = eta * eta * (1.0 - cosine * cosine);
            if (sine2 >= 1.0) {
                // Total internal reflection.
                stack[top++] = Branch{ mirrored, throughput, depth };
                continue;
            }
            float beyond = sqrt(1.0 - sine2);
            float share = fresnel(eta, cosine, beyond);
            float3 refracted = eta * ray.direction + (eta * cosine - beyond) * normal;
            stack[top++] = Branch{ mirrored, throughput * share, depth };
            stack[top++] = Branch{ Ray{ hit.point, refracted }, throughput * (1.0 - share), depth };
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
        makeScene();
        fragColor = float4(trace(cameraRay(fragCoord)), 1.0);
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
