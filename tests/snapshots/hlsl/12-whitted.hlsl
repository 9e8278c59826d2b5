// glsl/12-whitted.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Whitted's scene: a mirror and a glass ball above a checkered floor. Glass splits each ray into two; a stack holds
// the rays that remain to be traced.

cbuffer Inputs : register(b0) {
    float3 iResolution : packoffset(c0);
};

// `mod` of GLSL: `fmod` rounds towards zero.
float mod(float x, float y) {
    return x - y * floor(x / y);
}

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1.0e6;
static const float EPSILON = 0.001;
static const int SPHERES = 4;
static const int MAX_DEPTH = 6;
static const float3 AMBIENT = float3(0.15, 0.15, 0.15);
static const float3 LIGHT = float3(-4.0, 7.0, 1.0);

static const int MATTE = 0;
static const int MIRROR = 1;
static const int GLASS = 2;
static const float IOR = 1.5;

struct Ray {
    float3 origin;
    float3 direction;
};

Ray make_Ray(float3 origin, float3 direction) {
    Ray result;
    result.origin = origin;
    result.direction = direction;
    return result;
}

struct Sphere {
    float3 center;
    float radius;
    int model;
    float3 color;
};

Sphere make_Sphere(float3 center, float radius, int model, float3 color) {
    Sphere result;
    result.center = center;
    result.radius = radius;
    result.model = model;
    result.color = color;
    return result;
}

struct Intersection {
    float t;
    float3 point_1;
    float3 normal;
    int model;
    float3 color;
};

Intersection make_Intersection(float t, float3 point_1, float3 normal, int model, float3 color) {
    Intersection result;
    result.t = t;
    result.point_1 = point_1;
    result.normal = normal;
    result.model = model;
    result.color = color;
    return result;
}

// A ray on the stack; its throughput is its contribution to the pixel.
struct Branch {
    Ray ray;
    float3 throughput;
    int depth;
};

Branch make_Branch(Ray ray, float3 throughput, int depth) {
    Branch result;
    result.ray = ray;
    result.throughput = throughput;
    result.depth = depth;
    return result;
}

static Sphere spheres[4] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };

void makeScene() {
    spheres[0] = make_Sphere(float3(-0.5, 0.0, -4.5), 0.9, GLASS, float3(0.95, 1.0, 0.95));
    spheres[1] = make_Sphere(float3(1.3, 0.1, -6.5), 1.1, MIRROR, float3(0.9, 0.9, 0.9));
    spheres[2] = make_Sphere(float3(-2.4, -0.4, -7.0), 0.6, MATTE, float3(0.9, 0.3, 0.2));
    spheres[3] = make_Sphere(float3(1.1, -0.7, -4.0), 0.3, MATTE, float3(0.2, 0.4, 0.9));
}

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

float3 checker(float3 point_1) {
    float square = floor(point_1.x) + floor(point_1.z);
    return mod(square, 2.0) == 0.0 ? float3(0.9, 0.8, 0.3) : float3(0.6, 0.15, 0.1);
}

Intersection nearestHit(Ray ray) {
    Intersection hit = { NO_HIT, float3(0.0, 0.0, 0.0), float3(0.0, 0.0, 0.0), MATTE,
        float3(0.0, 0.0, 0.0) };
    for (int i = 0; i < SPHERES; i++) {
        float t = intersectSphere(ray, spheres[i]);
        if (t < hit.t) {
            float3 point_1 = ray.origin + t * ray.direction;
            float3 normal = normalize(point_1 - spheres[i].center);
            hit = make_Intersection(t, point_1, normal, spheres[i].model, spheres[i].color);
        }
    }
    float t = (-1.02 - ray.origin.y) / ray.direction.y;
    if (t > EPSILON && t < hit.t) {
        float3 point_2 = ray.origin + t * ray.direction;
        hit = make_Intersection(t, point_2, float3(0.0, 1.0, 0.0), MATTE, checker(point_2));
    }
    return hit;
}

float3 shade(Intersection hit) {
    float3 sum = AMBIENT;
    float cosine = dot(hit.normal, normalize(LIGHT - hit.point_1));
    if (cosine > 0.0) {
        float3 origin = hit.point_1 + EPSILON * hit.normal;
        float3 toLight = LIGHT - origin;
        float distance_1 = length(toLight);
        if (nearestHit(make_Ray(origin, toLight / distance_1)).t > distance_1) {
            sum += float3(0.85, 0.85, 0.85) * cosine;
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

float3 trace(Ray first) {
    Branch stack[8] = { (Branch)0, (Branch)0, (Branch)0, (Branch)0, (Branch)0, (Branch)0, (Branch)0,
        (Branch)0 };
    stack[0] = make_Branch(first, float3(1.0, 1.0, 1.0), 0);
    int top = 1;
    float3 color = float3(0.0, 0.0, 0.0);
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
        Ray mirrored = { hit.point_1, reflect(ray.direction, hit.normal) };
        if (hit.model == MIRROR) {
            stack[top++] = make_Branch(mirrored, throughput, depth);
            continue;
        }
        bool entering = dot(ray.direction, hit.normal) < 0.0;
        float3 normal = entering ? hit.normal : -hit.normal;
        float eta = entering ? 1.0 / IOR : IOR;
        float cosine = -dot(ray.direction, normal);
        float sine2 = eta * eta * (1.0 - cosine * cosine);
        if (sine2 >= 1.0) {
            // Total internal reflection.
            stack[top++] = make_Branch(mirrored, throughput, depth);
            continue;
        }
        float beyond = sqrt(1.0 - sine2);
        float share = fresnel(eta, cosine, beyond);
        float3 refracted = eta * ray.direction + (eta * cosine - beyond) * normal;
        stack[top++] = make_Branch(mirrored, throughput * share, depth);
        stack[top++] = make_Branch(make_Ray(hit.point_1, refracted), throughput * (1.0 - share),
            depth);
    }
    return color;
}

Ray cameraRay(float2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
    float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
    return make_Ray(float3(0.0, 0.0, 0.0), normalize(float3(x, y, SCREEN_DEPTH)));
}

void mainImage(out float4 fragColor, float2 fragCoord) {
    makeScene();
    fragColor = float4(trace(cameraRay(fragCoord)), 1.0);
}

float4 main(float4 position : SV_Position) : SV_Target0 {
    float4 color;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(color, position.xy);
    return float4(color.xyz, 1.0);
}
