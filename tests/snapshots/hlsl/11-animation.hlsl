// glsl/11-animation.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A small solar system: a moon orbits a planet that orbits the sun, each with its own period. iTime moves the
// planets, iFrame the satellite.

cbuffer Inputs : register(b0) {
    float3 iResolution : packoffset(c0);
    float iTime : packoffset(c0.w);
    int iFrame : packoffset(c1.y);
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1.0e6;
static const float TAU = 6.28318530718;
static const int BODIES = 6;
static const float3 AMBIENT = float3(0.12, 0.12, 0.12);
static const float3 SUN = float3(0.0, 0.2, -7.0);

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

static Sphere bodies[6] = { (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0, (Sphere)0 };
static float3 lamp = (float3)0;

// Rotates v about a unit axis (Rodrigues' formula).
float3 rotate(float3 v, float3 axis, float angle) {
    float c = cos(angle);
    float s = sin(angle);
    return c * v + s * cross(axis, v) + (1.0 - c) * dot(axis, v) * axis;
}

float3 rotateAbout(float3 p, float3 pivot, float3 axis, float turns) {
    return pivot + rotate(p - pivot, axis, TAU * frac(turns));
}

// Each body first follows its own orbit, then the orbit of its parent.
float3 year(float3 p) {
    return rotateAbout(p, SUN, float3(0.0, 1.0, 0.0), iTime / 8.0);
}

float3 month(float3 p) {
    return year(rotateAbout(p, float3(2.0, 0.2, -7.0), float3(0.0, 0.8, 0.6), iTime / 2.0));
}

float3 orbit(float3 p) {
    return month(rotateAbout(p, float3(2.75, 0.2, -7.0), float3(1.0, 0.0, 0.0),
            float(iFrame) / 60.0));
}

float3 retrograde(float3 p) {
    return rotateAbout(p, SUN, float3(0.0, 0.96, -0.28), -iTime / 5.0);
}

void makeScene() {
    bodies[0] = make_Sphere(SUN, 0.8, float3(1.0, 0.8, 0.3));
    bodies[1] = make_Sphere(year(float3(2.0, 0.2, -7.0)), 0.35, float3(0.3, 0.5, 0.9));
    bodies[2] = make_Sphere(month(float3(2.75, 0.2, -7.0)), 0.15, float3(0.8, 0.8, 0.8));
    bodies[3] = make_Sphere(orbit(float3(2.75, 0.45, -7.0)), 0.06, float3(0.9, 0.3, 0.9));
    bodies[4] = make_Sphere(retrograde(float3(-1.4, 0.2, -7.0)), 0.22, float3(0.9, 0.4, 0.2));
    bodies[5] = make_Sphere(float3(0.0, -52.0, -8.0), 50.0, float3(0.4, 0.4, 0.5));
    lamp = retrograde(float3(3.0, 5.0, -4.0));
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

bool inShadow(float3 point_1, float3 normal) {
    float3 origin = point_1 + 0.001 * normal;
    float3 toLight = lamp - origin;
    float distance_1 = length(toLight);
    Ray ray = { origin, toLight / distance_1 };
    for (int i = 0; i < BODIES; i++) {
        if (intersectSphere(ray, bodies[i]) < distance_1) {
            return true;
        }
    }
    return false;
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
    float3 color = float3(0.02, 0.02, 0.06);

    float nearest = NO_HIT;
    int hit = -1;
    for (int i = 0; i < BODIES; i++) {
        float t = intersectSphere(ray, bodies[i]);
        if (t < nearest) {
            nearest = t;
            hit = i;
        }
    }
    if (hit >= 0) {
        float3 point_1 = ray.origin + nearest * ray.direction;
        float3 normal = normalize(point_1 - bodies[hit].center);
        float cosine = dot(normal, normalize(lamp - point_1));
        float3 sum = AMBIENT;
        if (cosine > 0.0) {
            if (!inShadow(point_1, normal)) {
                sum += float3(0.88, 0.88, 0.88) * cosine;
            }
        }
        color = bodies[hit].color * sum;
    }
    fragColor = float4(color, 1.0);
}

float4 main(float4 position : SV_Position) : SV_Target0 {
    float4 color;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(color, position.xy);
    return float4(color.xyz, 1.0);
}
