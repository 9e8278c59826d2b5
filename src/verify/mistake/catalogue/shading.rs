//! Mistakes in the shading: lights, shadows, lights with a radius, and Burley's BRDF.

use super::geometry::{DISC, TEXTBOOK};
use super::{Mistake, mistakes};

const TO_LIGHT: &str = "normalize(lights[i].position - hit.point)";
const LIT: &str = "if (cosine > 0.0 && …) {\n            sum";
const UNLIT: &str = "if (cosine > 0.0) {\n            sum";
const LIGHT_TERM: &str = "sum += lights[i].color * … * cosine;";
const COSINE: &str = "float cosine = dot(hit.normal, toLight);";
const AMBIENT: &str = "vec3 sum = AMBIENT * hit.color;";

/// Lights, and the shading of surfaces.
pub(super) static LIGHTS: &[Mistake] = mistakes! {
    "cosine-forgotten": "forgets the cosine of the angle to the light", [(LIGHT_TERM, "sum += lights[i].color * …;")];
    "cosine-not-clamped": "lets light from below the surface count as negative light",
        [(LIT, "if (…) {\n            sum")],
        [(UNLIT, "{\n            sum")];
    "cosine-without-sign": "lights both sides of a surface: the absolute value of the cosine",
        [(COSINE, "float cosine = abs(dot(hit.normal, toLight));")];
    "light-backwards": "has the direction to the light backwards", [(TO_LIGHT, "normalize(hit.point - lights[i].position)")];
    "light-not-normalised": "does not normalise the direction to the light", [(TO_LIGHT, "(lights[i].position - hit.point)")];
    "light-from-afar": "takes the light's position for its direction", [(TO_LIGHT, "normalize(lights[i].position)")];
    "light-falls-off": "lets the light fall off with the square of its distance, which the scene does not",
        [(LIGHT_TERM, "sum += lights[i].color * … * cosine / dot(lights[i].position - hit.point, lights[i].position - hit.point);")];
    "first-light-only": "has one light where the scene has more", [("i < LIGHTS", "i < 1")];
    "last-light-only": "lets each light replace the one before, where they add up",
        [(LIGHT_TERM, "sum = AMBIENT * hit.color + lights[i].color * … * cosine;")];
    "light-not-added": "takes the brighter of ambient light and a light's, where they add up",
        [(LIGHT_TERM, "sum = max(sum, lights[i].color * … * cosine);")];
    "no-ambient": "forgets the ambient light", [(AMBIENT, "vec3 sum = vec3(0.0);")];
    "ambient-per-light": "adds the ambient light once for each light",
        [(AMBIENT, "vec3 sum = AMBIENT * hit.color * float(LIGHTS);")],
        [(AMBIENT, "vec3 sum = AMBIENT * hit.color * float(LIGHTS + 1);")];
    "ambient-not-tinted": "does not multiply the ambient light by the surface's colour", [(AMBIENT, "vec3 sum = AMBIENT;")];
    "ambient-over-pi": "divides the ambient light by π", [(AMBIENT, "vec3 sum = AMBIENT * hit.color / 3.14159265359;")];
    "ambient-where-it-is-dark": "adds ambient light only where no other light comes",
        [(LIGHT_TERM, "sum = sum == AMBIENT * hit.color ? vec3(0.0) : sum;\n            sum += lights[i].color * … * cosine;")];
    "light-without-colour": "forgets the lights' colour", [(LIGHT_TERM, "sum += … * cosine;")];
    "colour-forgotten": "forgets the surface's colour",
        [(AMBIENT, "vec3 sum = AMBIENT;"), ("* hit.color * cosine;", "* cosine;")],
        [(AMBIENT, "vec3 sum = AMBIENT;"), ("* hit.color / PI * cosine;", "/ PI * cosine;")];
    "colour-added": "adds the surface's colour to the light, where it should multiply",
        [(AMBIENT, "vec3 sum = AMBIENT + hit.color;"), ("* hit.color * cosine;", "* cosine;")];
    "pi-forgotten": "forgets to divide the BRDF by π",
        [("* hit.color / PI * cosine;", "* hit.color * cosine;")],
        [("return hit.color / PI;", "return hit.color;")];
    "pi-multiplied": "multiplies the BRDF by π where it should divide",
        [("* hit.color / PI * cosine;", "* hit.color * PI * cosine;")],
        [("return hit.color / PI;", "return hit.color * PI;")];
    "cosine-squared": "multiplies by the cosine twice", [(LIGHT_TERM, "sum += lights[i].color * … * cosine * cosine;")];
};

const OCCLUDED: &str = "if (intersectSphere(ray, spheres[i]) < distance) {";
const HIDDEN: &str = "return nearestHit(Ray(origin, toLight / distance)).t < distance;";
const AWAY: &str = "vec3 toLight = light - origin;";

/// Shadows of point lights.
pub(super) static SHADOWS: &[Mistake] = mistakes! {
    "no-shadows": "has no shadows", [(LIT, "if (cosine > 0.0) {\n            sum")];
    "shadow-beyond-the-light": "tests shadows beyond the light",
        [(OCCLUDED, "if (intersectSphere(ray, spheres[i]) < NO_HIT) {")],
        [(HIDDEN, "return nearestHit(Ray(origin, toLight / distance)).t < NO_HIT;")];
    "shadow-rays-short": "follows shadow rays for a length of 1 only, not as far as the light",
        [(OCCLUDED, "if (intersectSphere(ray, spheres[i]) < 1.0) {")],
        [(HIDDEN, "return nearestHit(Ray(origin, toLight / distance)).t < 1.0;")];
    "shadow-rays-away": "sends shadow rays away from the light", [(AWAY, "vec3 toLight = origin - light;")];
    "shadow-ray-not-normalised": "does not normalise shadow rays, though its formula is that for directions of length 1",
        [("toLight / distance);", "toLight);"), (DISC, TEXTBOOK)];
    "shadow-of-itself": "starts shadow rays below the surface, so that everything lies in its own shadow",
        [("hit.point + 0.001 * hit.normal;", "hit.point - 0.001 * hit.normal;")];
    "shadow-without-ambient": "leaves no ambient light in shadows",
        [(LIT, "if (cosine > 0.0 && !(…)) {\n            return vec3(0.0);\n        }\n        if (cosine > 0.0) {\n            sum")];
    "shadow-from-the-eye": "starts shadow rays at the eye",
        [("vec3 origin = hit.point + 0.001 * hit.normal;", "vec3 origin = vec3(0.0);")];
};

const DEPTH: &str = "float cosine = 1.0 - u * depth;";
const TURN: &str = "float phi = 6.28318530718 * turn;";
const RANDOM_NUMBERS: &str = "    float u = random();\n    float v = random();\n    float cosine = 1.0";
const OCCLUDED_SOFT: &str = "inShadow(hit, toLight, distance)";

/// Lights with a radius.
pub(super) static SOFT_LIGHTS: &[Mistake] = mistakes! {
    "point-light": "samples the light's centre alone, as if it had no radius",
        [("return around(normalize(axis), cosine, v);", "return normalize(axis);")];
    "half-space-sampled": "draws directions from the whole half space around the light, not from its cone",
        [(DEPTH, "float cosine = 1.0 - u;")];
    "cone-edge-only": "draws directions on the edge of the light's cone only", [(DEPTH, "float cosine = 1.0 - depth;")];
    "angle-uniform": "draws the angle to the light's axis uniformly, where its cosine should be",
        [(DEPTH, "float cosine = cos(u * asin(sqrt(sine2)));")];
    "light-radius-not-squared": "does not square the light's radius", [("light.radius * light.radius / ", "light.radius / ")];
    "draws-swapped": "takes the first number drawn for the turn and the second for the angle, where the scene has them the other way round",
        [(RANDOM_NUMBERS, "    float v = random();\n    float u = random();\n    float cosine = 1.0")];
    "half-a-turn": "turns by half a circle only: π where 2π should stand", [(TURN, "float phi = 3.14159265359 * turn;")];
    "turn-without-2-pi": "turns by as many radians as it should by full circles", [(TURN, "float phi = turn;")];
    "turn-in-degrees": "turns by degrees where radians are expected", [(TURN, "float phi = 360.0 * turn;")];
    "cosine-of-the-centre": "takes the cosine to the light's centre, not that of the direction drawn",
        [("float cosine = dot(hit.normal, toLight);", "float cosine = dot(hit.normal, normalize(lights[i].position - hit.point));")];
    "shadow-rays-to-the-centre": "sends its shadow rays to the light's centre, not in the direction drawn",
        [(OCCLUDED_SOFT, "inShadow(hit, normalize(lights[i].position - hit.point), distance)")];
};

const BRDF: &str = "* brdf(hit, toLight, view) * cosine;";
const FRESNEL_WEIGHT: &str = "float fH = schlickWeight(lH);";
const COAT: &str = "berry(nH, mix(0.1, 0.001, m.clearcoatGloss))";

/// Burley's BRDF.
pub(super) static DISNEY: &[Mistake] = mistakes! {
    "diffuse-for-disney": "has a diffuse BRDF for Burley's", [(BRDF, "* hit.color / PI * cosine;")];
    "view-backwards": "has the direction to the eye backwards", [("shade(hit, -ray.direction)", "shade(hit, ray.direction)")];
    "roughness-not-squared": "does not square the roughness",
        [("square(m.roughness) / aspect", "m.roughness / aspect"), ("square(m.roughness) * aspect", "m.roughness * aspect")];
    "tangents-swapped": "has the two tangents exchanged", [("dot(x, middle), dot(y, middle)", "dot(y, middle), dot(x, middle)")];
    "anisotropy-forgotten": "forgets anisotropy", [("sqrt(1.0 - 0.9 * m.anisotropic)", "1.0")];
    "diffuse-under-metal": "adds the diffuse part to metals, too", [("(base + sheen) * (1.0 - m.metallic)", "(base + sheen)")];
    "metal-without-colour": "forgets to tint the highlights of metals", [("mix(dielectric, color, m.metallic)", "dielectric")];
    "fresnel-to-the-fourth": "has the fourth power in Schlick's weight, not the fifth",
        [("return square(square(m)) * m;", "return square(square(m));")];
    "fresnel-by-the-normal": "takes the half vector's angle to the normal for Fresnel's, where it should be that to the light",
        [(FRESNEL_WEIGHT, "float fH = schlickWeight(nH);")];
    "fresnel-by-the-light": "takes the light's angle to the normal for Fresnel's", [(FRESNEL_WEIGHT, "float fH = schlickWeight(nL);")];
    "no-subsurface": "forgets subsurface scattering", [("mix(diffuse, subsurface, m.subsurface)", "diffuse")];
    "no-sheen": "forgets the sheen", [("(base + sheen) *", "base *")];
    "no-clear-coat": "forgets the clear coat", [("f * d * g + coat", "f * d * g")];
    "coat-of-the-base-lobe": "has the base's distribution for the clear coat",
        [(COAT, "trowbridgeReitz(nH, dot(x, middle), dot(y, middle), 0.25, 0.25)")];
    "coat-without-gloss": "forgets the gloss of the clear coat", [(COAT, "berry(nH, 0.1)")];
    "no-specular": "forgets the specular lobe", [("f * d * g + coat", "coat")];
    "shadowing-squared": "squares the shadowing term", [("smith(nL, alpha) * smith(nV, alpha)", "square(smith(nL, alpha) * smith(nV, alpha))")];
    "no-shadowing": "forgets the shadowing term", [("f * d * g + coat", "f * d + coat")];
    "pi-forgotten-in-the-base": "forgets to divide the diffuse part by π", [("color / PI * mix(", "color * mix(")];
    "half-vector-not-normalised": "does not normalise the half vector", [("normalize(light + view)", "(light + view)")];
    "specular-not-tinted": "forgets the tint of the highlights", [("mix(vec3(1.0), tint, m.specularTint)", "vec3(1.0)")];
};
