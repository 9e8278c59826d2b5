// glsl/06-reflections.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Mirrors under an evening sky: the ray is reflected until it misses all mirrors.

cbuffer Inputs : register(b0) {
    float3 iResolution : packoffset(c0);
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1.0e6;
static const float EPSILON = 0.001;
static const int SPHERES = 4;
static const int MAX_DEPTH = 100;

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
    float3 color;
};

Sphere make_Sphere(float3 center, float radius, float3 color) {
    Sphere result;
    result.center = center;
    result.radius = radius;
    result.color = color;
    return result;
}

static Sphere spheres[4] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };

void makeScene() {
    spheres[0] = make_Sphere(float3(-1.3, -0.4, -5.2), 0.6, float3(0.9, 0.6, 0.6));
    spheres[1] = make_Sphere(float3(0.0, 0.0, -7.0), 1.2, float3(0.95, 0.93, 0.88));
    spheres[2] = make_Sphere(float3(0.2, -0.6, -3.6), 0.3, float3(0.7, 0.9, 0.7));
    spheres[3] = make_Sphere(float3(1.2, 0.5, -5.0), 0.7, float3(0.6, 0.7, 0.95));
}

float3 sky(float3 direction) {
    float up = 0.5 * (1.0 + direction.y);
    return (1.0 - up) * float3(0.9, 0.5, 0.25) + up * float3(0.1, 0.2, 0.5);
}

// As in 02-sphere, but hits closer than t_min are ignored: they are on the surface that the ray just left.
float intersectSphere(Ray ray, Sphere sphere, float tMin) {
    float3 f = ray.origin - sphere.center;
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

Ray cameraRay(float2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
    float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
    return make_Ray(float3(0.0, 0.0, 0.0), normalize(float3(x, y, SCREEN_DEPTH)));
}

void mainImage(out float4 fragColor, float2 fragCoord) {
    fragColor = float4(0.0, 0.0, 0.0, 0.0);
    makeScene();
    Ray ray = cameraRay(fragCoord);
    float3 color = float3(0.0, 0.0, 0.0);
    float3 throughput = float3(1.0, 1.0, 1.0);

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
        float3 point_1 = ray.origin + nearest * ray.direction;
        float3 normal = normalize(point_1 - spheres[hit].center);
        throughput *= spheres[hit].color;
        ray = make_Ray(point_1, reflect(ray.direction, normal));
    }
    fragColor = float4(color, 1.0);
}

float4 main(float4 position : SV_Position) : SV_Target0 {
    float4 color;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(color, position.xy);
    return float4(color.xyz, 1.0);
}
