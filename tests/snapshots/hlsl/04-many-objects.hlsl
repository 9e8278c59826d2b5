// glsl/04-many-objects.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Seven spheres: the nearest hit is visible, and spheres cast shadows on each other.

cbuffer Inputs : register(b0) {
    float3 iResolution : packoffset(c0);
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1.0e6;
static const int SAMPLES = 4;
static const int SPHERES = 7;
static const float3 AMBIENT = float3(0.08, 0.08, 0.08);

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

struct Intersection {
    float t;
    int sphere;
    float3 point_1;
    float3 normal;
};

static Sphere spheres[7] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0,
    (Sphere)0 };
static Light light = (Light)0;
static float seed = 0.0;

float random() {
    // toyproof: allow(W0005) the scene's sampler uses this hash
    return frac(sin(seed++) * 43758.5453123);
}

void makeScene() {
    spheres[0] = make_Sphere(float3(0.0, -31.0, -8.0), 30.0, float3(0.5, 0.5, 0.45));
    spheres[1] = make_Sphere(float3(0.5, -0.7, -4.0), 0.3, float3(0.2, 0.8, 0.3));
    spheres[2] = make_Sphere(float3(0.0, 0.0, -6.0), 1.0, float3(0.9, 0.8, 0.1));
    spheres[3] = make_Sphere(float3(-1.5, -0.4, -5.0), 0.6, float3(0.9, 0.2, 0.15));
    spheres[4] = make_Sphere(float3(1.4, -0.5, -4.8), 0.5, float3(0.15, 0.3, 0.9));
    spheres[5] = make_Sphere(float3(-0.6, 1.1, -5.5), 0.35, float3(0.8, 0.4, 0.8));
    // Behind the light, so it casts no shadow.
    spheres[6] = make_Sphere(float3(6.8, 10.2, 5.9), 3.0, float3(0.6, 0.6, 0.6));
    light = make_Light(float3(4.0, 6.0, 1.0), float3(0.9, 0.9, 0.9));
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

Intersection nearestHit(Ray ray) {
    Intersection hit = (Intersection)0;
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
            hit.point_1 = ray.origin + hit.t * ray.direction;
            hit.normal = (hit.point_1 - spheres[i].center) / spheres[i].radius;
        }
    }
    return hit;
}

bool inShadow(float3 point_1, float3 normal) {
    // Start slightly above the surface, so that the shadow ray does not hit the same sphere.
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

float3 trace(Ray ray) {
    Intersection hit = nearestHit(ray);
    if (hit.sphere < 0) {
        return float3(0.3, 0.4, 0.6);
    }
    float3 sum = AMBIENT;
    float cosine = dot(hit.normal, normalize(light.position - hit.point_1));
    if (cosine > 0.0) {
        if (!inShadow(hit.point_1, hit.normal)) {
            sum += light.color * cosine;
        }
    }
    return spheres[hit.sphere].color * sum;
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
    seed = 0.0;
    float3 color = float3(0.0, 0.0, 0.0);
    for (int i = 0; i < SAMPLES; i++) {
        float x = fragCoord.x + random() - 0.5;
        float y = fragCoord.y + random() - 0.5;
        color += trace(cameraRay(float2(x, y)));
    }
    fragColor = float4(color / float(SAMPLES), 1.0);
}

float4 main(float4 position : SV_Position) : SV_Target0 {
    float4 color;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(color, position.xy);
    return float4(color.xyz, 1.0);
}
