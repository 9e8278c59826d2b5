// glsl/03-shading.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// One sphere under two point lights: Lambert's cosine law, plus ambient light.

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;
const AMBIENT = vec3f(0.1, 0.1, 0.15);

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

struct Sphere {
    center: vec3f,
    radius: f32,
    color: vec3f,
}

struct Light {
    position: vec3f,
    color: vec3f,
}

var<private> lights: array<Light, 2>;

fn makeScene() {
    lights[0] = Light(vec3f(5.0, 5.0, 0.0), vec3f(0.8, 0.8, 0.7));
    lights[1] = Light(vec3f(-6.0, 1.0, -2.0), vec3f(0.1, 0.1, 0.3));
}

fn intersectSphere(ray: Ray, sphere: Sphere) -> f32 {
    let f = ray.origin - sphere.center;
    let b = dot(f, ray.direction);
    let c = dot(f, f) - sphere.radius * sphere.radius;
    let disc = b * b - c;
    if disc > 0.0 {
        let root = sqrt(disc);
        var t = -b - root;
        if t > 0.00001 {
            return t;
        }
        t = -b + root;
        if t > 0.00001 {
            return t;
        }
    }
    return NO_HIT;
}

fn shade(point: vec3f, normal: vec3f, color: vec3f) -> vec3f {
    var sum = AMBIENT;
    for (var i = 0; i < 2; i++) {
        let toLight = normalize(lights[i].position - point);
        sum += lights[i].color * max(dot(normal, toLight), 0.0);
    }
    return color * sum;
}

fn cameraRay(fragCoord: vec2f) -> Ray {
    let aspect = inputs.iResolution.x / inputs.iResolution.y;
    let x = fragCoord.x / inputs.iResolution.x * 2.0 - 1.0;
    let y = (fragCoord.y / inputs.iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3f(0.0), normalize(vec3f(x, y, SCREEN_DEPTH)));
}

fn mainImage(fragColor: ptr<function, vec4f>, fragCoord: vec2f) {
    makeScene();
    let sphere = Sphere(vec3f(0.0, 0.0, -6.0), 1.5, vec3f(0.9, 0.6, 0.2));
    let ray = cameraRay(fragCoord);
    var color = vec3f(0.02, 0.02, 0.05);

    let t = intersectSphere(ray, sphere);
    if t < NO_HIT {
        let hitPoint = ray.origin + t * ray.direction;
        let normal = (hitPoint - sphere.center) / sphere.radius;
        color = shade(hitPoint, normal, sphere.color);
    }
    *fragColor = vec4f(color, 1.0);
}

@fragment
fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    var color: vec4f;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(&color, position.xy);
    return vec4f(color.xyz, 1.0);
}
