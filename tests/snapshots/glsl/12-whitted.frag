#version 300 es
// glsl/12-whitted.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Whitted's scene: a mirror and a glass ball above a checkered floor. Glass splits each ray into two; a stack holds
// the rays that remain to be traced.

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
const int MAX_DEPTH = 6;
const vec3 AMBIENT = vec3(0.15);
const vec3 LIGHT = vec3(-4.0, 7.0, 1.0);

const int MATTE = 0;
const int MIRROR = 1;
const int GLASS = 2;
const float IOR = 1.5;

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Sphere {
    vec3 center;
    float radius;
    int model;
    vec3 color;
};

struct Intersection {
    float t;
    vec3 point;
    vec3 normal;
    int model;
    vec3 color;
};

// A ray on the stack; its throughput is its contribution to the pixel.
struct Branch {
    Ray ray;
    vec3 throughput;
    int depth;
};

Sphere spheres[4] = Sphere[4](Sphere(vec3(0.0), 0.0, 0, vec3(0.0)),
    Sphere(vec3(0.0), 0.0, 0, vec3(0.0)), Sphere(vec3(0.0), 0.0, 0, vec3(0.0)),
    Sphere(vec3(0.0), 0.0, 0, vec3(0.0)));

void makeScene() {
    spheres[0] = Sphere(vec3(-0.5, 0.0, -4.5), 0.9, GLASS, vec3(0.95, 1.0, 0.95));
    spheres[1] = Sphere(vec3(1.3, 0.1, -6.5), 1.1, MIRROR, vec3(0.9, 0.9, 0.9));
    spheres[2] = Sphere(vec3(-2.4, -0.4, -7.0), 0.6, MATTE, vec3(0.9, 0.3, 0.2));
    spheres[3] = Sphere(vec3(1.1, -0.7, -4.0), 0.3, MATTE, vec3(0.2, 0.4, 0.9));
}

vec3 sky(vec3 direction) {
    float up = 0.5 * (1.0 + direction.y);
    return (1.0 - up) * vec3(0.9, 0.9, 0.95) + up * vec3(0.3, 0.5, 0.9);
}

float intersectSphere(Ray ray, Sphere sphere) {
    vec3 f = ray.origin - sphere.center;
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

vec3 checker(vec3 point) {
    float square = floor(point.x) + floor(point.z);
    return mod(square, 2.0) == 0.0 ? vec3(0.9, 0.8, 0.3) : vec3(0.6, 0.15, 0.1);
}

Intersection nearestHit(Ray ray) {
    Intersection hit = Intersection(NO_HIT, vec3(0.0), vec3(0.0), MATTE, vec3(0.0));
    for (int i = 0; i < SPHERES; i++) {
        float t = intersectSphere(ray, spheres[i]);
        if (t < hit.t) {
            vec3 point = ray.origin + t * ray.direction;
            vec3 normal = normalize(point - spheres[i].center);
            hit = Intersection(t, point, normal, spheres[i].model, spheres[i].color);
        }
    }
    float t = (-1.02 - ray.origin.y) / ray.direction.y;
    if (t > EPSILON && t < hit.t) {
        vec3 point = ray.origin + t * ray.direction;
        hit = Intersection(t, point, vec3(0.0, 1.0, 0.0), MATTE, checker(point));
    }
    return hit;
}

vec3 shade(Intersection hit) {
    vec3 sum = AMBIENT;
    float cosine = dot(hit.normal, normalize(LIGHT - hit.point));
    if (cosine > 0.0) {
        vec3 origin = hit.point + EPSILON * hit.normal;
        vec3 toLight = LIGHT - origin;
        float distance = length(toLight);
        if (nearestHit(Ray(origin, toLight / distance)).t > distance) {
            sum += vec3(0.85) * cosine;
        }
    }
    return hit.color * sum;
}

// The reflectance by Fresnel's equations, for unpolarized light. eta is the index of refraction on this side divided
// by the index on the other side; cosine and beyond are the cosines of the ray on this side and on the other.
float fresnel(float eta, float cosine, float beyond) {
    float across = (eta * cosine - beyond) / (eta * cosine + beyond);
    float along = (cosine - eta * beyond) / (cosine + eta * beyond);
    return 0.5 * (across * across + along * along);
}

vec3 trace(Ray first) {
    Branch stack[8] = Branch[8](Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0),
        Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0),
        Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0),
        Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0),
        Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0),
        Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0),
        Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0),
        Branch(Ray(vec3(0.0), vec3(0.0)), vec3(0.0), 0));
    stack[0] = Branch(first, vec3(1.0), 0);
    int top = 1;
    vec3 color = vec3(0.0);
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
        vec3 throughput = branch.throughput * hit.color;
        Ray mirrored = Ray(hit.point, reflect(ray.direction, hit.normal));
        if (hit.model == MIRROR) {
            stack[top++] = Branch(mirrored, throughput, depth);
            continue;
        }
        bool entering = dot(ray.direction, hit.normal) < 0.0;
        vec3 normal = entering ? hit.normal : -hit.normal;
        float eta = entering ? 1.0 / IOR : IOR;
        float cosine = -dot(ray.direction, normal);
        float sine2 = eta * eta * (1.0 - cosine * cosine);
        if (sine2 >= 1.0) {
            // Total internal reflection.
            stack[top++] = Branch(mirrored, throughput, depth);
            continue;
        }
        float beyond = sqrt(1.0 - sine2);
        float share = fresnel(eta, cosine, beyond);
        vec3 refracted = eta * ray.direction + (eta * cosine - beyond) * normal;
        stack[top++] = Branch(mirrored, throughput * share, depth);
        stack[top++] = Branch(Ray(hit.point, refracted), throughput * (1.0 - share), depth);
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
    makeScene();
    fragColor = vec4(trace(cameraRay(fragCoord)), 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
