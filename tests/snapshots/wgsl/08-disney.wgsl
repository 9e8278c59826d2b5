// glsl/08-disney.glsl, converted by toyproof 0.1.0 (naga 30.0.1).

// The BRDF of B. Burley, "Physically Based Shading at Disney" (2012), on a grid of spheres over the ground.

struct Inputs {
    iResolution: vec3f,
}

@group(0) @binding(0) var<uniform> inputs: Inputs;

const SCREEN_DEPTH: f32 = -2.0;
const NO_HIT: f32 = 1.0e6;
const PI: f32 = 3.14159265359;
const SPHERES: i32 = 10;
const AMBIENT = vec3f(0.25, 0.27, 0.3);
const LIGHT = vec3f(-3.0, 6.0, 2.0);
const LIGHT_COLOR = vec3f(5.0, 4.8, 4.5);

struct Ray {
    origin: vec3f,
    direction: vec3f,
}

struct Material {
    color: vec3f,
    metallic: f32,
    subsurface: f32,
    specular: f32,
    specularTint: f32,
    roughness: f32,
    anisotropic: f32,
    sheen: f32,
    sheenTint: f32,
    clearcoat: f32,
    clearcoatGloss: f32,
}

struct Sphere {
    center: vec3f,
    radius: f32,
    material: Material,
}

var<private> spheres: array<Sphere, 10>;

fn makeScene() {
    // Rough plastic.
    spheres[0] = Sphere(vec3f(-2.0, 1.3, -7.0), 0.58,
        Material(vec3f(0.8, 0.2, 0.15), 0.0, 0.0, 0.5, 0.0, 0.9, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Plastic.
    spheres[1] = Sphere(vec3f(0.0, 1.3, -7.0), 0.58,
        Material(vec3f(0.8, 0.2, 0.15), 0.0, 0.0, 0.8, 0.0, 0.4, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Smooth plastic with a tinted highlight.
    spheres[2] = Sphere(vec3f(2.0, 1.3, -7.0), 0.58,
        Material(vec3f(0.8, 0.2, 0.15), 0.0, 0.0, 1.0, 0.8, 0.25, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Rough gold.
    spheres[3] = Sphere(vec3f(-2.0, 0.0, -7.0), 0.58,
        Material(vec3f(1.0, 0.75, 0.35), 1.0, 0.0, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Brushed gold.
    spheres[4] = Sphere(vec3f(0.0, 0.0, -7.0), 0.58,
        Material(vec3f(1.0, 0.75, 0.35), 1.0, 0.0, 0.5, 0.0, 0.45, 0.8, 0.0, 0.5, 0.0, 0.6));
    // Half metal.
    spheres[5] = Sphere(vec3f(2.0, 0.0, -7.0), 0.58,
        Material(vec3f(1.0, 0.75, 0.35), 0.5, 0.0, 0.5, 0.0, 0.3, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Cloth.
    spheres[6] = Sphere(vec3f(-2.0, -1.3, -7.0), 0.58,
        Material(vec3f(0.25, 0.35, 0.8), 0.0, 0.0, 0.1, 0.0, 0.8, 0.0, 1.0, 0.3, 0.0, 0.6));
    // Skin.
    spheres[7] = Sphere(vec3f(0.0, -1.3, -7.0), 0.58,
        Material(vec3f(0.9, 0.6, 0.5), 0.0, 0.9, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 0.0, 0.6));
    // Lacquer.
    spheres[8] = Sphere(vec3f(2.0, -1.3, -7.0), 0.58,
        Material(vec3f(0.15, 0.5, 0.25), 0.0, 0.0, 0.5, 0.0, 0.6, 0.0, 0.0, 0.5, 1.0, 0.6));
    // Ground.
    spheres[9] = Sphere(vec3f(0.0, -52.3, -8.0), 50.0,
        Material(vec3f(0.4, 0.4, 0.4), 0.0, 0.0, 0.2, 0.0, 0.9, 0.0, 0.0, 0.5, 0.0, 0.6));
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

fn inShadow(point: vec3f, normal: vec3f) -> bool {
    let origin = point + 0.001 * normal;
    let toLight = LIGHT - origin;
    let distance = length(toLight);
    let ray = Ray(origin, toLight / distance);
    for (var i = 0; i < SPHERES; i++) {
        if intersectSphere(ray, spheres[i]) < distance {
            return true;
        }
    }
    return false;
}

fn square(x: f32) -> f32 {
    return x * x;
}

// The weight (1 - cosine)^5 of Schlick's Fresnel approximation.
fn schlick(cosine: f32) -> f32 {
    let m = clamp(1.0 - cosine, 0.0, 1.0);
    return square(square(m)) * m;
}

// Normal distribution of the clear coat: GTR with gamma = 1, which has a long tail.
fn berry(nH: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    return (a2 - 1.0) / (PI * log(a2) * (1.0 + (a2 - 1.0) * nH * nH));
}

// Normal distribution of the specular lobe: anisotropic GTR with gamma = 2 (GGX).
fn trowbridgeReitz(nH: f32, xH: f32, yH: f32, ax: f32, ay: f32) -> f32 {
    return 1.0 / (PI * ax * ay * square(square(xH / ax) + square(yH / ay) + nH * nH));
}

// Smith's shadowing factor for one direction, divided by twice the cosine.
fn smith(cosine: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let c2 = cosine * cosine;
    return 1.0 / (cosine + sqrt(a2 + c2 - a2 * c2));
}

fn disney(m: Material, light: vec3f, view: vec3f, normal: vec3f) -> vec3f {
    let nL = dot(normal, light);
    let nV = dot(normal, view);
    if nL <= 0.0 || nV <= 0.0 {
        return vec3f(0.0);
    }
    let middle = normalize(light + view);
    let nH = dot(normal, middle);
    let lH = dot(light, middle);
    // The tangents: around the y axis, and toward it.
    let x = normalize(vec3f(normal.z, 0.0, -normal.x));
    let y = cross(normal, x);

    let luminance = dot(m.color, vec3f(0.3, 0.6, 0.1));
    let tint = m.color / luminance;
    let dielectric = 0.08 * m.specular * mix(vec3f(1.0), tint, m.specularTint);
    let specularColor = mix(dielectric, m.color, m.metallic);
    let sheenColor = mix(vec3f(1.0), tint, m.sheenTint);

    let fL = schlick(nL);
    let fV = schlick(nV);
    let fH = schlick(lH);
    let retro = lH * lH * m.roughness;
    let grazing = 0.5 + 2.0 * retro;
    let diffuse = mix(1.0, grazing, fL) * mix(1.0, grazing, fV);
    let flatness = mix(1.0, retro, fL) * mix(1.0, retro, fV);
    let subsurface = 1.25 * (flatness * (1.0 / (nL + nV) - 0.5) + 0.5);
    let base = m.color / PI * mix(diffuse, subsurface, m.subsurface);
    let sheen = fH * m.sheen * sheenColor;

    let aspect = sqrt(1.0 - 0.9 * m.anisotropic);
    let ax = max(0.001, square(m.roughness) / aspect);
    let ay = max(0.001, square(m.roughness) * aspect);
    let d = trowbridgeReitz(nH, dot(x, middle), dot(y, middle), ax, ay);
    let alpha = square(0.5 + 0.5 * m.roughness);
    let g = smith(nL, alpha) * smith(nV, alpha);
    let f = mix(specularColor, vec3f(1.0), fH);

    let coat = 0.25 * m.clearcoat * berry(nH, mix(0.1, 0.001, m.clearcoatGloss))
        * mix(0.04, 1.0, fH) * smith(nL, 0.25) * smith(nV, 0.25);
    return (base + sheen) * (1.0 - m.metallic) + f * d * g + coat;
}

fn shade(point: vec3f, normal: vec3f, view: vec3f, material: Material) -> vec3f {
    var radiance = AMBIENT * material.color;
    let toLight = normalize(LIGHT - point);
    let cosine = dot(normal, toLight);
    if cosine > 0.0 {
        if !inShadow(point, normal) {
            radiance += LIGHT_COLOR * disney(material, toLight, view, normal) * cosine;
        }
    }
    return radiance;
}

fn toneMap(color: vec3f) -> vec3f {
    return color / (color + 1.0);
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
    var color = vec3f(0.1, 0.12, 0.15);

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
        color = shade(point, normal, -ray.direction, spheres[hit].material);
    }
    *fragColor = vec4f(pow(toneMap(color), vec3f(1.0f / 2.2f)), 1.0);
}

@fragment
fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    var color: vec4f;
    // Row 0 of the target is the bottom of the image, as in ShaderToy.
    mainImage(&color, position.xy);
    return vec4f(color.xyz, 1.0);
}
