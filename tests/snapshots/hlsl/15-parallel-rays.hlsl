// glsl/15-parallel-rays.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Parallel projection: all rays have the same direction and different origins, so distant objects look no smaller.

cbuffer Inputs : register(b0) {
    float3 iResolution : packoffset(c0);
};

static const float NO_HIT = 1.0e6;
static const float WIDTH = 6.0;
static const int SPHERES = 5;
static const float3 AMBIENT = float3(0.1, 0.1, 0.12);
static const float3 LIGHT = float3(3.0, 5.0, 4.0);

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

static Sphere spheres[5] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };

void makeScene() {
    spheres[0] = make_Sphere(float3(-2.0, 0.0, -4.0), 0.7, float3(0.9, 0.3, 0.2));
    spheres[1] = make_Sphere(float3(-1.0, 0.3, -6.0), 0.7, float3(0.9, 0.6, 0.2));
    spheres[2] = make_Sphere(float3(0.0, 0.0, -9.0), 0.7, float3(0.9, 0.9, 0.3));
    spheres[3] = make_Sphere(float3(1.0, -0.3, -13.0), 0.7, float3(0.3, 0.8, 0.4));
    spheres[4] = make_Sphere(float3(2.0, 0.0, -18.0), 0.7, float3(0.3, 0.5, 0.9));
}

float intersectSphere(Ray ray, Sphere sphere) {
    float3 f = ray.origin - sphere.center;
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

Ray cameraRay(float2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
    float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
    return make_Ray(0.5 * WIDTH * float3(x, y, 0.0), float3(0.0, 0.0, -1.0));
}

void mainImage(out float4 fragColor, float2 fragCoord) {
    fragColor = float4(0.0, 0.0, 0.0, 0.0);
    makeScene();
    Ray ray = cameraRay(fragCoord);
    float3 color = float3(0.05, 0.05, 0.08);

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
        float3 point_1 = ray.origin + nearest * ray.direction;
        float3 normal = normalize(point_1 - spheres[hit].center);
        float3 toLight = normalize(LIGHT - point_1);
        color = spheres[hit].color * (AMBIENT
            + float3(0.9, 0.9, 0.9) * max(dot(normal, toLight), 0.0));
    }
    fragColor = float4(color, 1.0);
}

float4 main(float4 position : SV_Position) : SV_Target0 {
    float4 color;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(color, position.xy);
    return float4(color.xyz, 1.0);
}
