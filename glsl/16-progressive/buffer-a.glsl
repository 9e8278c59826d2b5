// One more path per pixel in each frame. The buffer holds the sum of all paths in rgb and their number in alpha; iChannel0
// is this buffer as it was in the previous frame.

const int SPHERES = 4;
const int EMITTER = 0;
const int FLOOR = SPHERES;
const int MAX_DEPTH = 4;
const vec3 BACKGROUND = vec3(0.35, 0.45, 0.6);

Sphere spheres[SPHERES];

void makeScene() {
    spheres[EMITTER] = Sphere(vec3(1.6, 1.8, -6.0), 0.5, vec3(14.0, 12.0, 9.0));
    spheres[1] = Sphere(vec3(-1.5, 0.0, -6.5), 1.0, vec3(0.8, 0.3, 0.25));
    spheres[2] = Sphere(vec3(0.4, -0.4, -5.5), 0.6, vec3(0.8, 0.8, 0.75));
    spheres[3] = Sphere(vec3(1.7, -0.6, -4.8), 0.4, vec3(0.25, 0.45, 0.8));
}

// The nearest hit: the index of the sphere or FLOOR, or -1.
int nearestHit(Ray ray, out float nearest) {
    nearest = NO_HIT;
    int hit = -1;
    for (int i = 0; i < SPHERES; i++) {
        float t = intersectSphere(ray, spheres[i]);
        if (t < nearest) {
            nearest = t;
            hit = i;
        }
    }
    float t = intersectFloor(ray);
    if (t < nearest) {
        nearest = t;
        hit = FLOOR;
    }
    return hit;
}

// 1 - cos of the half angle of the cone that the emitter subtends.
float coneDepth(vec3 point) {
    vec3 toCenter = spheres[EMITTER].center - point;
    float sine2 = spheres[EMITTER].radius * spheres[EMITTER].radius / dot(toCenter, toCenter);
    return sine2 / (1.0 + sqrt(1.0 - sine2));
}

// The probability density, per solid angle, of sampling a direction toward the emitter.
float lightDensity(vec3 point) {
    return 1.0 / (2.0 * PI * coneDepth(point));
}

// The power heuristic (Veach and Guibas 1995).
float weight(float density, float other) {
    float ratio = other / density;
    return 1.0 / (1.0 + ratio * ratio);
}

// The light that reaches a point straight from the emitter, along one random direction.
vec3 directLight(vec3 point, vec3 normal) {
    // There is one emitter to choose from.
    random();
    float u = random();
    float v = random();
    vec3 direction = around(normalize(spheres[EMITTER].center - point), 1.0 - u * coneDepth(point), v);
    float facing = dot(normal, direction);
    if (facing <= 0.0) {
        return vec3(0.0);
    }
    float t;
    if (nearestHit(Ray(point + EPSILON * normal, direction), t) != EMITTER) {
        return vec3(0.0);
    }
    float density = lightDensity(point);
    return spheres[EMITTER].color * facing * weight(density, facing / PI) / density;
}

vec3 trace(Ray ray) {
    vec3 color = vec3(0.0);
    vec3 throughput = vec3(1.0);
    // The probability density of the ray's direction; 0 for camera rays.
    float density = 0.0;
    for (int depth = 0; depth < MAX_DEPTH; depth++) {
        float t;
        int hit = nearestHit(ray, t);
        if (hit < 0) {
            return color + throughput * BACKGROUND;
        }
        if (hit == EMITTER) {
            float share = density > 0.0 ? weight(density, lightDensity(ray.origin)) : 1.0;
            return color + throughput * share * spheres[EMITTER].color;
        }
        // A path through another surface would be longer than MAX_DEPTH segments.
        if (depth + 1 == MAX_DEPTH) {
            return color;
        }
        vec3 point = ray.origin + t * ray.direction;
        vec3 normal = vec3(0.0, 1.0, 0.0);
        vec3 albedo = vec3(0.65, 0.65, 0.6);
        if (hit != FLOOR) {
            normal = normalize(point - spheres[hit].center);
            albedo = spheres[hit].color;
        }
        color += throughput * albedo / PI * directLight(point, normal);
        float u = random();
        float v = random();
        vec3 direction = around(normal, sqrt(1.0 - u), v);
        float facing = dot(normal, direction);
        if (facing <= 0.0) {
            return color;
        }
        density = facing / PI;
        throughput *= albedo;
        ray = Ray(point + EPSILON * normal, direction);
    }
    return color;
}

void mainImage(out vec4 sum, in vec2 fragCoord) {
    makeScene();
    startSample(fragCoord, iFrame);
    float x = fragCoord.x + random() - 0.5;
    float y = fragCoord.y + random() - 0.5;
    vec3 color = trace(cameraRay(vec2(x, y), iResolution.xy));
    vec4 previous = iFrame == 0 ? vec4(0.0) : texelFetch(iChannel0, ivec2(fragCoord), 0);
    sum = previous + vec4(color, 1.0);
}
