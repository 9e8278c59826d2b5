// glsl/10-quadrics.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// Quadric surfaces. Each ray is transformed to the quadric's local frame, where a quadratic equation gives the hits.

cbuffer Inputs : register(b0) {
    float3 iResolution : packoffset(c0);
};

static const float SCREEN_DEPTH = -2.0;
static const float NO_HIT = 1.0e6;
static const int QUADRICS = 5;
static const float3 AMBIENT = float3(0.15, 0.15, 0.15);
static const float3 LIGHT = float3(4.0, 6.0, 2.0);
static const float3 LIGHT_COLOR = float3(0.85, 0.85, 0.85);

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

// q.x x^2 + q.y y^2 + q.z z^2 + 2 g z + k = 0 for low <= z <= high, with z along the axis.
struct Quadric {
    float3 origin;
    float3 axis;
    float3 q;
    float g;
    float k;
    float low;
    float high;
    float3 color;
};

Quadric make_Quadric(float3 origin, float3 axis, float3 q, float g, float k, float low, float high,
        float3 color) {
    Quadric result;
    result.origin = origin;
    result.axis = axis;
    result.q = q;
    result.g = g;
    result.k = k;
    result.low = low;
    result.high = high;
    result.color = color;
    return result;
}

struct Intersection {
    float t;
    float3 normal;
    float3 color;
};

Intersection make_Intersection(float t, float3 normal, float3 color) {
    Intersection result;
    result.t = t;
    result.normal = normal;
    result.color = color;
    return result;
}

static Quadric quadrics[5] = { (Quadric)0, (Quadric)0, (Quadric)0, (Quadric)0, (Quadric)0 };

Quadric ellipsoid(float3 center, float3 radii, float3 color) {
    // The ellipsoid's axes are the coordinate axes.
    return make_Quadric(center, float3(0.0, 0.0, 1.0), 1.0 / (radii * radii), 0.0, -1.0, -radii.z,
        radii.z, color);
}

Quadric cylinder(float3 base, float3 axis, float radius, float height, float3 color) {
    return make_Quadric(base, axis, float3(1.0, 1.0, 0.0), 0.0, -radius * radius, 0.0, height,
        color);
}

Quadric cone(float3 apex, float3 axis, float radius, float height, float3 color) {
    float slope = radius / height;
    return make_Quadric(apex, axis, float3(1.0, 1.0, -slope * slope), 0.0, 0.0, 0.0, height, color);
}

Quadric paraboloid(float3 apex, float3 axis, float radius, float height, float3 color) {
    return make_Quadric(apex, axis, float3(1.0, 1.0, 0.0), -0.5 * radius * radius / height, 0.0,
        0.0, height, color);
}

Quadric hyperboloid(float3 center, float3 axis, float waist, float radius, float height,
        float3 color) {
    float z = 0.5 * height;
    float slope2 = (radius * radius - waist * waist) / (z * z);
    return make_Quadric(center, axis, float3(1.0, 1.0, -slope2), 0.0, -waist * waist, -z, z, color);
}

void makeScene() {
    quadrics[0] = ellipsoid(float3(-2.0, 0.5, -7.0), float3(0.9, 0.5, 0.6), float3(0.9, 0.3, 0.3));
    quadrics[1] = cylinder(float3(-0.9, -1.0, -5.2), float3(0.0, 1.0, 0.0), 0.4, 0.8,
        float3(0.3, 0.7, 0.9));
    quadrics[2] = cone(float3(0.3, 0.9, -6.5), float3(0.0, -1.0, 0.0), 0.7, 1.9,
        float3(0.9, 0.7, 0.2));
    quadrics[3] = paraboloid(float3(1.1, -0.9, -5.0), float3(0.28, 0.96, 0.0), 0.5, 0.7,
        float3(0.5, 0.9, 0.4));
    quadrics[4] = hyperboloid(float3(2.3, 0.0, -7.5), float3(0.0, 1.0, 0.0), 0.4, 0.8, 2.0,
        float3(0.7, 0.5, 0.9));
}

// The local coordinates of v: along two directions perpendicular to the axis, and along the axis.
float3x3 frame(float3 axis) {
    float3 x = abs(axis.z) > 0.9 ? float3(1.0, 0.0, 0.0)
        : normalize(cross(axis, float3(0.0, 0.0, 1.0)));
    return float3x3(x, cross(axis, x), axis);
}

// The smallest t of a hit between the two ends.
float intersectQuadric(Ray ray, Quadric quadric, float3x3 frame) {
    float3 d = mul(frame, ray.direction);
    float3 far = mul(frame, ray.origin - quadric.origin);
    // Start at the point of the ray closest to the quadric's origin: smaller numbers have smaller rounding errors.
    float ahead = -dot(far, d);
    float3 o = far + ahead * d;
    float a = dot(quadric.q * d, d);
    float b = dot(quadric.q * d, o) + quadric.g * d.z;
    float c = dot(quadric.q * o, o) + 2.0 * quadric.g * o.z + quadric.k;
    float disc = b * b - a * c;
    if (disc < 0.0) {
        return NO_HIT;
    }
    // The root without cancellation; the other follows from their product. If a is 0, there is only one root.
    float q = b > 0.0 ? -b - sqrt(disc) : -b + sqrt(disc);
    float t0 = q == 0.0 ? NO_HIT : c / q;
    float t1 = a == 0.0 ? NO_HIT : q / a;
    if (t0 > t1) {
        float t = t0;
        t0 = t1;
        t1 = t;
    }
    float z0 = o.z + t0 * d.z;
    if (ahead + t0 > 0.001 && z0 >= quadric.low && z0 <= quadric.high) {
        return ahead + t0;
    }
    float z1 = o.z + t1 * d.z;
    if (ahead + t1 > 0.001 && z1 >= quadric.low && z1 <= quadric.high) {
        return ahead + t1;
    }
    return NO_HIT;
}

float3 normalOf(float3 point_1, Quadric quadric, float3x3 frame) {
    float3 p = mul(frame, point_1 - quadric.origin);
    return normalize(mul(quadric.q * p + float3(0.0, 0.0, quadric.g), frame));
}

Intersection nearestHit(Ray ray) {
    Intersection hit = { NO_HIT, float3(0.0, 0.0, 0.0), float3(0.0, 0.0, 0.0) };
    for (int i = 0; i < QUADRICS; i++) {
        float3x3 f = frame(quadrics[i].axis);
        float t = intersectQuadric(ray, quadrics[i], f);
        if (t < hit.t) {
            hit.t = t;
            hit.normal = normalOf(ray.origin + t * ray.direction, quadrics[i], f);
            hit.color = quadrics[i].color;
        }
    }
    // The ground is a plane.
    float t = (-1.0 - ray.origin.y) / ray.direction.y;
    if (t > 0.001 && t < hit.t) {
        hit = make_Intersection(t, float3(0.0, 1.0, 0.0), float3(0.5, 0.5, 0.5));
    }
    // Open surfaces are visible from both sides.
    if (dot(hit.normal, ray.direction) > 0.0) {
        hit.normal = -hit.normal;
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
    makeScene();
    Ray ray = cameraRay(fragCoord);
    float3 color = float3(0.6, 0.7, 0.9);

    Intersection hit = nearestHit(ray);
    if (hit.t < NO_HIT) {
        float3 point_1 = ray.origin + hit.t * ray.direction;
        float3 toLight = LIGHT - (point_1 + 0.001 * hit.normal);
        float distance_1 = length(toLight);
        float cosine = dot(hit.normal, normalize(LIGHT - point_1));
        float3 sum = AMBIENT;
        if (cosine > 0.0) {
            Ray shadow = { point_1 + 0.001 * hit.normal, toLight / distance_1 };
            if (nearestHit(shadow).t > distance_1) {
                sum += LIGHT_COLOR * cosine;
            }
        }
        color = hit.color * sum;
    }
    fragColor = float4(color, 1.0);
}

float4 main(float4 position : SV_Position) : SV_Target0 {
    float4 color;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(color, position.xy);
    return float4(color.xyz, 1.0);
}
