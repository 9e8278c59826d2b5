// glsl/07-diffuse.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// A diffuse BRDF conserves energy: color / pi. The result is tone-mapped, then gamma-corrected.

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;
const PI: f32 = 3.14159265359;
const SPHERES: i32 = 4;
const LIGHTS: i32 = 2;
const AMBIENT = vec3f(0.3, 0.35, 0.45);

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

struct Material {
    albedo: vec3f,
}

struct Sphere {
    center: vec3f,
    radius: f32,
    material: Material,
}

struct Light {
    position: vec3f,
    color: vec3f,
}

var<private> spheres: array<Sphere, 4>;
var<private> lights: array<Light, 2>;

fn makeScene() {
    spheres[0] = Sphere(vec3f(0.0, -101.0, -7.0), 100.0, Material(vec3f(0.5, 0.5, 0.5)));
    spheres[1] = Sphere(vec3f(-1.9, 0.0, -7.5), 1.0, Material(vec3f(0.8, 0.25, 0.2)));
    spheres[2] = Sphere(vec3f(0.2, -0.1, -6.5), 0.9, Material(vec3f(0.75, 0.75, 0.75)));
    spheres[3] = Sphere(vec3f(1.9, -0.3, -6.0), 0.7, Material(vec3f(0.2, 0.45, 0.8)));
    lights[0] = Light(vec3f(4.0, 6.0, -2.0), vec3f(9.0, 8.5, 7.5));
    lights[1] = Light(vec3f(-5.0, 3.0, 0.0), vec3f(2.0, 2.5, 4.0));
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

fn inShadow(point: vec3f, normal: vec3f, light: Light) -> bool {
    let origin = point + 0.001 * normal;
    let toLight = light.position - origin;
    let distance = length(toLight);
    let ray = Ray(origin, toLight / distance);
    for (var i = 0; i < SPHERES; i++) {
        if intersectSphere(ray, spheres[i]) < distance {
            return true;
        }
    }
    return false;
}

fn brdf(material: Material) -> vec3f {
    return material.albedo / PI;
}

fn shade(point: vec3f, normal: vec3f, material: Material) -> vec3f {
    var radiance = AMBIENT * material.albedo;
    for (var i = 0; i < LIGHTS; i++) {
        let cosine = dot(normal, normalize(lights[i].position - point));
        if cosine > 0.0 {
            if !inShadow(point, normal, lights[i]) {
                radiance += lights[i].color * brdf(material) * cosine;
            }
        }
    }
    return radiance;
}

fn toneMap(color: vec3f) -> vec3f {
    return color / (color + 1.0);
}

fn gammaCorrect(color: vec3f) -> vec3f {
    return pow(color, vec3f(1.0f / 2.2f));
}

fn cameraRay(fragCoord: vec2f) -> Ray {
    let aspect = inputs.iResolution.x / inputs.iResolution.y;
    let x = fragCoord.x / inputs.iResolution.x * 2.0 - 1.0;
    let y = (fragCoord.y / inputs.iResolution.y * 2.0 - 1.0) / aspect;
    return Ray(vec3f(0.0), normalize(vec3f(x, y, SCREEN_DEPTH)));
}

fn mainImage(fragColor: ptr<function, vec4f>, fragCoord: vec2f) {
    makeScene();
    let ray = cameraRay(fragCoord);
    var color = vec3f(0.5, 0.6, 0.8);

    var nearest = NO_HIT;
    var hit = -1;
    for (var i = 0; i < SPHERES; i++) {
        let t = intersectSphere(ray, spheres[i]);
        if t < nearest {
            nearest = t;
            hit = i;
        }
    }
    if hit >= 0 {
        let point = ray.origin + nearest * ray.direction;
        let normal = normalize(point - spheres[hit].center);
        color = shade(point, normal, spheres[hit].material);
    }
    *fragColor = vec4f(gammaCorrect(toneMap(color)), 1.0);
}

@fragment
fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    var color: vec4f;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(&color, position.xy);
    return vec4f(color.xyz, 1.0);
}
