// One sphere, shaded by the cosine between the ray and the normal.

const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1.0e6;

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Sphere {
    vec3 center;
    float radius;
    vec3 color;
};

// The ray o + t d intersects |x - center|^2 = r^2 where t^2 + 2 b t + c = 0, for d of length 1.
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
    Sphere sphere = Sphere(vec3(0.0, 0.0, -6.0), 1.5, vec3(1.0, 1.0, 0.0));
    Ray ray = cameraRay(fragCoord);
    vec3 color = vec3(0.0);

    float t = intersectSphere(ray, sphere);
    if (t < NO_HIT) {
        vec3 hitPoint = ray.origin + t * ray.direction;
        vec3 normal = normalize(hitPoint - sphere.center);
        color = sphere.color * abs(dot(ray.direction, normal));
    }
    fragColor = vec4(color, 1.0);
}
