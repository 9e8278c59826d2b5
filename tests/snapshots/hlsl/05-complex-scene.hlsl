// glsl/05-complex-scene.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// 43 spheres in a hierarchy: a parent, six children, and six grandchildren for each child.

cbuffer Inputs : register(b0) {
    float3 iResolution : packoffset(c0);
    int iFrame : packoffset(c1.y);
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1.0e6;
static const float SHRINK = 2.8;
static const float3 AMBIENT = float3(0.15, 0.15, 0.15);
static const float3 LIGHT = float3(4.0, 5.0, 2.0);

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

struct Intersection {
    float t;
    Sphere sphere;
};

// `a % b` of GLSL as Mesa and SwiftShader round it, down: other languages round towards zero.
int remainder(int a, int b) {
    int r = a % b;
    return r != 0 && (r ^ b) < 0 ? r + b : r;
}

// Right, left, up, down, front, back.
float3 side(int i) {
    float3 axis = float3(i / 2 == 0, i / 2 == 1, i / 2 == 2);
    return remainder(i, 2) == 0 ? axis : -axis;
}

float3 sideColor(int i) {
    return 0.5 + 0.4 * side(i);
}

// One turn in 240 frames, about the y axis through the parent.
float3 turn(float3 v, int frame) {
    float angle = 6.28318530718 * float(frame) / 240.0;
    float c = cos(angle);
    float s = sin(angle);
    return float3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
}

Sphere childOf(Sphere parent, int i, int frame) {
    float radius = parent.radius / SHRINK;
    float3 center = parent.center + (parent.radius + radius) * turn(side(i), frame);
    return make_Sphere(center, radius, 0.5 * (parent.color + sideColor(i)));
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

void keepNearest(Ray ray, Sphere sphere, inout Intersection hit) {
    float t = intersectSphere(ray, sphere);
    if (t < hit.t) {
        hit.t = t;
        hit.sphere = sphere;
    }
}

Intersection hitScene(Ray ray, int frame) {
    Sphere parent = { float3(0.0, 0.0, -7.5), 1.0, float3(0.9, 0.9, 0.8) };
    Intersection hit = { NO_HIT, parent };
    keepNearest(ray, parent, hit);
    for (int i = 0; i < 6; i++) {
        Sphere child = childOf(parent, i, frame);
        keepNearest(ray, child, hit);
        for (int j = 0; j < 6; j++) {
            keepNearest(ray, childOf(child, j, frame), hit);
        }
    }
    return hit;
}

Ray cameraRay(float2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
    float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
    return make_Ray(float3(0.0, 0.0, 0.0), normalize(float3(x, y, SCREEN_DEPTH)));
}

void mainImage(out float4 fragColor, float2 fragCoord) {
    fragColor = float4(0.0, 0.0, 0.0, 0.0);
    Ray ray = cameraRay(fragCoord);
    float3 color = float3(0.05, 0.05, 0.1);

    Intersection hit = hitScene(ray, iFrame);
    if (hit.t < NO_HIT) {
        float3 point_1 = ray.origin + hit.t * ray.direction;
        float3 normal = normalize(point_1 - hit.sphere.center);
        float3 toLight = normalize(LIGHT - point_1);
        color = hit.sphere.color * (AMBIENT
            + float3(0.85, 0.85, 0.85) * max(dot(normal, toLight), 0.0));
    }
    fragColor = float4(color, 1.0);
}

float4 main(float4 position : SV_Position) : SV_Target0 {
    float4 color;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(color, position.xy);
    return float4(color.xyz, 1.0);
}
