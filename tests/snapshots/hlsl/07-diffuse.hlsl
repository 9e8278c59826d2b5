// glsl/07-diffuse.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A diffuse BRDF conserves energy: color / pi. The result is tone-mapped, then gamma-corrected.

cbuffer Inputs : register(b0) {
    float3 iResolution : packoffset(c0);
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1.0e6;
static const float PI = 3.14159265359;
static const int SPHERES = 4;
static const int LIGHTS = 2;
static const float3 AMBIENT = float3(0.3, 0.35, 0.45);

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

struct Material {
    float3 albedo;
};

Material make_Material(float3 albedo) {
    Material result;
    result.albedo = albedo;
    return result;
}

struct Sphere {
    float3 center;
    float radius;
    Material material;
};

Sphere make_Sphere(float3 center, float radius, Material material) {
    Sphere result;
    result.center = center;
    result.radius = radius;
    result.material = material;
    return result;
}

struct Light {
    float3 position;
    float3 color;
};

Light make_Light(float3 position, float3 color) {
    Light result;
    result.position = position;
    result.color = color;
    return result;
}

static Sphere spheres[4] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };
static Light lights[2] = { (Light)0, (Light)0 };

void makeScene() {
    spheres[0] = make_Sphere(float3(0.0, -101.0, -7.0), 100.0,
        make_Material(float3(0.5, 0.5, 0.5)));
    spheres[1] = make_Sphere(float3(-1.9, 0.0, -7.5), 1.0, make_Material(float3(0.8, 0.25, 0.2)));
    spheres[2] = make_Sphere(float3(0.2, -0.1, -6.5), 0.9, make_Material(float3(0.75, 0.75, 0.75)));
    spheres[3] = make_Sphere(float3(1.9, -0.3, -6.0), 0.7, make_Material(float3(0.2, 0.45, 0.8)));
    lights[0] = make_Light(float3(4.0, 6.0, -2.0), float3(9.0, 8.5, 7.5));
    lights[1] = make_Light(float3(-5.0, 3.0, 0.0), float3(2.0, 2.5, 4.0));
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

bool inShadow(float3 point_1, float3 normal, Light light) {
    float3 origin = point_1 + 0.001 * normal;
    float3 toLight = light.position - origin;
    float distance_1 = length(toLight);
    Ray ray = { origin, toLight / distance_1 };
    for (int i = 0; i < SPHERES; i++) {
        if (intersectSphere(ray, spheres[i]) < distance_1) {
            return true;
        }
    }
    return false;
}

float3 brdf(Material material) {
    return material.albedo / PI;
}

float3 shade(float3 point_1, float3 normal, Material material) {
    float3 radiance = AMBIENT * material.albedo;
    for (int i = 0; i < LIGHTS; i++) {
        float cosine = dot(normal, normalize(lights[i].position - point_1));
        if (cosine > 0.0) {
            if (!inShadow(point_1, normal, lights[i])) {
                radiance += lights[i].color * brdf(material) * cosine;
            }
        }
    }
    return radiance;
}

float3 toneMap(float3 color) {
    return color / (color + 1.0);
}

float3 gammaCorrect(float3 color) {
    return pow(color, float3(0.45454544, 0.45454544, 0.45454544));
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
    float3 color = float3(0.5, 0.6, 0.8);

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
        color = shade(point_1, normal, spheres[hit].material);
    }
    fragColor = float4(gammaCorrect(toneMap(color)), 1.0);
}

float4 main(float4 position : SV_Position) : SV_Target0 {
    float4 color;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(color, position.xy);
    return float4(color.xyz, 1.0);
}
