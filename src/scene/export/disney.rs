//! Burley's BRDF: B. Burley, “Physically Based Shading at Disney”, SIGGRAPH 2012 course notes.

use super::number;
use crate::Disney;

pub(super) const STRUCTURE: &str = "struct Disney {
    float metallic;
    float subsurface;
    float specular;
    float specularTint;
    float roughness;
    float anisotropic;
    float sheen;
    float sheenTint;
    float clearcoat;
    float clearcoatGloss;
};
";

pub(super) fn values(disney: &Disney) -> String {
    let all = [
        disney.metallic,
        disney.subsurface,
        disney.specular,
        disney.specular_tint,
        disney.roughness,
        disney.anisotropic,
        disney.sheen,
        disney.sheen_tint,
        disney.clearcoat,
        disney.clearcoat_gloss,
    ];
    format!("Disney({})", all.map(number).join(", "))
}

pub(super) const FUNCTIONS: &str = "float square(float x) {
    return x * x;
}

// Schlick's weight.
float schlickWeight(float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    return square(square(m)) * m;
}

// The clear coat's distribution, with a long tail.
float berry(float nH, float alpha) {
    float a2 = alpha * alpha;
    return (a2 - 1.0) / (PI * log(a2) * (1.0 + (a2 - 1.0) * nH * nH));
}

// The distribution of the specular lobe, stretched along the tangents.
float trowbridgeReitz(float nH, float xH, float yH, float ax, float ay) {
    return 1.0 / (PI * ax * ay * square(square(xH / ax) + square(yH / ay) + nH * nH));
}

// Shadowing, over twice the cosine.
float smith(float cosine, float alpha) {
    float a2 = alpha * alpha;
    float c2 = cosine * cosine;
    return 1.0 / (cosine + sqrt(a2 + c2 - a2 * c2));
}

// B. Burley, \"Physically Based Shading at Disney\" (2012).
vec3 disney(Disney m, vec3 color, vec3 light, vec3 view, vec3 normal) {
    float nL = dot(normal, light);
    float nV = dot(normal, view);
    if (nL <= 0.0 || nV <= 0.0) {
        return vec3(0.0);
    }
    vec3 middle = normalize(light + view);
    float nH = dot(normal, middle);
    float lH = dot(light, middle);
    // Around the y axis, and towards it.
    vec3 x = normal.xz == vec2(0.0) ? vec3(0.0, 0.0, normal.y) : normalize(vec3(normal.z, 0.0, -normal.x));
    vec3 y = cross(normal, x);

    float luminance = dot(color, vec3(0.3, 0.6, 0.1));
    vec3 tint = luminance > 0.0 ? color / luminance : vec3(1.0);
    vec3 dielectric = 0.08 * m.specular * mix(vec3(1.0), tint, m.specularTint);
    vec3 specularColor = mix(dielectric, color, m.metallic);
    vec3 sheenColor = mix(vec3(1.0), tint, m.sheenTint);

    float fL = schlickWeight(nL);
    float fV = schlickWeight(nV);
    float fH = schlickWeight(lH);
    float retro = lH * lH * m.roughness;
    float grazing = 0.5 + 2.0 * retro;
    float diffuse = mix(1.0, grazing, fL) * mix(1.0, grazing, fV);
    float flatness = mix(1.0, retro, fL) * mix(1.0, retro, fV);
    float subsurface = 1.25 * (flatness * (1.0 / (nL + nV) - 0.5) + 0.5);
    vec3 base = color / PI * mix(diffuse, subsurface, m.subsurface);
    vec3 sheen = fH * m.sheen * sheenColor;

    float aspect = sqrt(1.0 - 0.9 * m.anisotropic);
    float ax = max(0.001, square(m.roughness) / aspect);
    float ay = max(0.001, square(m.roughness) * aspect);
    float d = trowbridgeReitz(nH, dot(x, middle), dot(y, middle), ax, ay);
    float alpha = square(0.5 + 0.5 * m.roughness);
    float g = smith(nL, alpha) * smith(nV, alpha);
    vec3 f = mix(specularColor, vec3(1.0), fH);

    float coat = 0.25 * m.clearcoat * berry(nH, mix(0.1, 0.001, m.clearcoatGloss)) * mix(0.04, 1.0, fH)
        * smith(nL, 0.25) * smith(nV, 0.25);
    return (base + sheen) * (1.0 - m.metallic) + f * d * g + coat;
}
";
