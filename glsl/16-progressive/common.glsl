// Rays, spheres and random numbers.

const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1.0e6;
const float PI = 3.14159265359;
const float EPSILON = 0.001;

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Sphere {
    vec3 center;
    float radius;
    vec3 color;
};

// Starts at the point of the ray closest to the center: smaller numbers have smaller rounding errors.
float intersectSphere(Ray ray, Sphere sphere) {
    vec3 f = ray.origin - sphere.center;
    float b = dot(f, ray.direction);
    vec3 closest = f - b * ray.direction;
    float disc = sphere.radius * sphere.radius - dot(closest, closest);
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

// The plane y = -1.
float intersectFloor(Ray ray) {
    float t = (-1.0 - ray.origin.y) / ray.direction.y;
    return t > EPSILON ? t : NO_HIT;
}

Ray cameraRay(vec2 fragCoord, vec2 size) {
    float x = fragCoord.x / size.x * 2.0 - 1.0;
    float y = (fragCoord.y / size.y * 2.0 - 1.0) * size.y / size.x;
    return Ray(vec3(0.0), normalize(vec3(x, y, SCREEN_DEPTH)));
}

// The integer hash PCG (Jarzynski and Olano 2020), which gives the same numbers on every machine.
uint pcg(uint v) {
    uint s = v * 747796405u + 2891336453u;
    uint word = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return (word >> 22u) ^ word;
}

uint state;

float random() {
    state = pcg(state);
    return float(state >> 8u) / 16777216.0;
}

// The random numbers of a pixel differ from frame to frame.
void startSample(vec2 fragCoord, int frame) {
    state = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(frame))));
}

// The direction at an angle to w, given by its cosine, rotated about w by `turn` turns.
vec3 around(vec3 w, float cosine, float turn) {
    vec3 up = abs(w.y) > 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 a = normalize(cross(up, w));
    vec3 b = cross(w, a);
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float phi = 2.0 * PI * turn;
    return sine * cos(phi) * a + sine * sin(phi) * b + cosine * w;
}
