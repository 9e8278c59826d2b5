// glsl/09-soft-shadows.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A spherical light subtends a cone of directions; each sample picks a random direction in it.

cbuffer Inputs : register(b0) {
    float3 iResolution : packoffset(c0);
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1.0e6;
static const int SAMPLES = 16;
static const int SPHERES = 4;
static const float3 AMBIENT = float3(0.25, 0.25, 0.25);

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
    float radius;
    float3 color;
};

Light make_Light(float3 position, float radius, float3 color) {
    Light result;
    result.position = position;
    result.radius = radius;
    result.color = color;
    return result;
}

static Sphere spheres[4] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };
static Light light = (Light)0;
static uint state = 0u;

// The integer hash PCG (Jarzynski and Olano 2020), which gives the same numbers on every machine.
uint pcg(uint v) {
    uint s = v * 747796405u + 2891336453u;
    uint word = (s >> (s >> 28u) + 4u ^ s) * 277803737u;
    return word >> 22u ^ word;
}

float random() {
    state = pcg(state);
    return float(state >> 8u) / 16777216.0;
}

void startSample(float2 fragCoord, int i) {
    state = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))));
}

void makeScene() {
    spheres[0] = make_Sphere(float3(0.0, -41.0, -8.0), 40.0, float3(0.7, 0.7, 0.65));
    spheres[1] = make_Sphere(float3(-1.3, -0.2, -6.5), 0.8, float3(0.9, 0.4, 0.2));
    spheres[2] = make_Sphere(float3(0.5, 0.6, -7.0), 0.6, float3(0.3, 0.7, 0.4));
    spheres[3] = make_Sphere(float3(1.5, -0.6, -5.5), 0.4, float3(0.3, 0.4, 0.9));
    light = make_Light(float3(3.0, 5.0, -5.0), 0.6, float3(0.7, 0.7, 0.7));
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

// The direction at an angle to w, given by its cosine, rotated about w by `turn` turns.
float3 around(float3 w, float cosine, float turn) {
    float3 up = abs(w.y) > 0.9 ? float3(1.0, 0.0, 0.0) : float3(0.0, 1.0, 0.0);
    float3 a = normalize(cross(up, w));
    float3 b = cross(w, a);
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float phi = 6.28318530718 * turn;
    return sine * cos(phi) * a + sine * sin(phi) * b + cosine * w;
}

// Samples a direction uniformly in the cone of the light; lightDistance is the distance to the light along it.
float3 sampleLight(float3 point_1, out float lightDistance) {
    float3 toLight = light.position - point_1;
    float distance_1 = length(toLight);
    float sine2 = light.radius * light.radius / (distance_1 * distance_1);
    float depth = sine2 / (1.0 + sqrt(1.0 - sine2));
    float u = random();
    float v = random();
    float cosine = 1.0 - u * depth;
    float chord = sqrt(max(sine2 - (1.0 - cosine * cosine), 0.0));
    lightDistance = distance_1 * (cosine - chord);
    return around(toLight / distance_1, cosine, v);
}

bool inShadow(Ray ray, float distance_1) {
    for (int i = 0; i < SPHERES; i++) {
        if (intersectSphere(ray, spheres[i]) < distance_1) {
            return true;
        }
    }
    return false;
}

float3 trace(Ray ray) {
    float nearest = NO_HIT;
    int hit = -1;
    for (int i = 0; i < SPHERES; i++) {
        float t = intersectSphere(ray, spheres[i]);
        if (t < nearest) {
            nearest = t;
            hit = i;
        }
    }
    if (hit < 0) {
        return float3(0.4, 0.5, 0.7);
    }
    float3 point_1 = ray.origin + nearest * ray.direction;
    float3 normal = normalize(point_1 - spheres[hit].center);
    float distance_1 = 0.0;
    float3 toLight = sampleLight(point_1, distance_1);
    float3 sum = AMBIENT;
    float cosine = dot(normal, toLight);
    if (cosine > 0.0) {
        if (!inShadow(make_Ray(point_1 + 0.001 * normal, toLight), distance_1)) {
            sum += light.color * cosine;
        }
    }
    return spheres[hit].color * sum;
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
    float3 color = float3(0.0, 0.0, 0.0);
    for (int i = 0; i < SAMPLES; i++) {
        startSample(fragCoord, i);
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
