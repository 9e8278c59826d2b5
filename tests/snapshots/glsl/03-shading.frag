#version 300 es
// glsl/03-shading.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// One sphere under two point lights: Lambert's cosine law, plus ambient light.

precision highp float;
precision highp int;

layout(std140) uniform Inputs {
    vec3 iResolution;
    float iTime;
    float iTimeDelta;
    int iFrame;
    float iFrameRate;
    vec4 iChannelTime[4];
    vec3 iChannelResolution[4];
    vec4 iMouse;
    vec4 iDate;
    float iSampleRate;
};
layout(location = 0) out vec4 outputColor;

const float SCREEN_DEPTH = -2.0;
const float NO_HIT = 1.0e6;
const vec3 AMBIENT = vec3(0.1, 0.1, 0.15);

struct Ray {
    vec3 origin;
    vec3 direction;
};

struct Sphere {
    vec3 center;
    float radius;
    vec3 color;
};

struct Light {
    vec3 position;
    vec3 color;
};

Light lights[2] = Light[2](Light(vec3(0.0), vec3(0.0)), Light(vec3(0.0), vec3(0.0)));

void makeScene() {
    lights[0] = Light(vec3(5.0, 5.0, 0.0), vec3(0.8, 0.8, 0.7));
    lights[1] = Light(vec3(-6.0, 1.0, -2.0), vec3(0.1, 0.1, 0.3));
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

vec3 shade(vec3 point, vec3 normal, vec3 color) {
    vec3 sum = AMBIENT;
    for (int i = 0; i < 2; i++) {
        vec3 toLight = normalize(lights[i].position - point);
        sum += lights[i].color * max(dot(normal, toLight), 0.0);
    }
    return color * sum;
}

Ray cameraRay(vec2 fragCoord) {
    float aspect = iResolution.x / iResolution.y;
    float x = fragCoord.x / iResolution.x * 2.0 - 1.0;
    float y = (fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3(0.0), normalize(vec3(x, y, SCREEN_DEPTH)));
}

void mainImage(out vec4 fragColor, vec2 fragCoord) {
    fragColor = vec4(0.0);
    makeScene();
    Sphere sphere = Sphere(vec3(0.0, 0.0, -6.0), 1.5, vec3(0.9, 0.6, 0.2));
    Ray ray = cameraRay(fragCoord);
    vec3 color = vec3(0.02, 0.02, 0.05);

    float t = intersectSphere(ray, sphere);
    if (t < NO_HIT) {
        vec3 hitPoint = ray.origin + t * ray.direction;
        vec3 normal = (hitPoint - sphere.center) / sphere.radius;
        color = shade(hitPoint, normal, sphere.color);
    }
    fragColor = vec4(color, 1.0);
}

void main() {
    vec4 color;
    mainImage(color, gl_FragCoord.xy);
    outputColor = vec4(color.rgb, 1.0);
}
