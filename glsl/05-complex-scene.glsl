// Forty-three spheres: a parent, six children, and six more on each of them.

const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1.0e6;
const int SPHERES = 43;
const float SHRINK = 2.8;
const vec3 AMBIENT = vec3(0.15);

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Sphere {
    vec3 center;
    float radius;
    vec3 color;
};

Sphere spheres[SPHERES];
vec3 lightPosition;

vec3 side(int i) {
    if (i == 0) return vec3(1.0, 0.0, 0.0);
    if (i == 1) return vec3(-1.0, 0.0, 0.0);
    if (i == 2) return vec3(0.0, 1.0, 0.0);
    if (i == 3) return vec3(0.0, -1.0, 0.0);
    if (i == 4) return vec3(0.0, 0.0, 1.0);
    return vec3(0.0, 0.0, -1.0);
}

vec3 sideColor(int i) {
    if (i == 0) return vec3(0.9, 0.2, 0.2);
    if (i == 1) return vec3(0.9, 0.6, 0.1);
    if (i == 2) return vec3(0.2, 0.8, 0.3);
    if (i == 3) return vec3(0.1, 0.7, 0.7);
    if (i == 4) return vec3(0.2, 0.3, 0.9);
    return vec3(0.7, 0.3, 0.8);
}

// Once round in 240 frames, about the y axis of the parent.
vec3 turn(vec3 v, int frame) {
    float angle = 6.28318530718 * float(frame) / 240.0;
    float c = cos(angle);
    float s = sin(angle);
    return vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
}

Sphere childOf(Sphere parent, int i, int frame) {
    float radius = parent.radius / SHRINK;
    vec3 center = parent.center + (parent.radius + radius) * turn(side(i), frame);
    return Sphere(center, radius, 0.5 * (parent.color + sideColor(i)));
}

void makeScene(int frame) {
    spheres[0] = Sphere(vec3(0.0, 0.0, -6.0), 1.0, vec3(0.9, 0.9, 0.8));
    int next = 1;
    for (int i = 0; i < 6; i++) {
        Sphere child = childOf(spheres[0], i, frame);
        spheres[next++] = child;
        for (int j = 0; j < 6; j++) {
            spheres[next++] = childOf(child, j, frame);
        }
    }
    lightPosition = vec3(4.0, 5.0, 2.0);
}

float intersectSphere(Ray ray, Sphere sphere) {
    vec3 f = ray.origin - sphere.center;
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

Ray cameraRay(vec2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
    float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3(0.0), normalize(vec3(x, y, SCREEN_DEPTH)));
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    makeScene(iFrame);
    Ray ray = cameraRay(fragCoord);
    vec3 color = vec3(0.05, 0.05, 0.1);

    float nearest = NO_HIT;
    int hit = -1;
    for (int i = 0; i < SPHERES; i++) {
        float t = intersectSphere(ray, spheres[i]);
        if (t < nearest) {
            nearest = t;
            hit = i;
        }
    }
    for (int i = 0; i < SPHERES; i++) {
        if (i == hit) {
            vec3 point = ray.origin + nearest * ray.direction;
            vec3 normal = normalize(point - spheres[i].center);
            vec3 toLight = normalize(lightPosition - point);
            color = spheres[i].color * (AMBIENT + vec3(0.85) * max(dot(normal, toLight), 0.0));
        }
    }
    fragColor = vec4(color, 1.0);
}
