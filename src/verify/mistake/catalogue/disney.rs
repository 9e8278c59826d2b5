//! Burley's BRDF.

use super::mistakes;

const BRDF: &str = "* brdf(hit, toLight, view) * cosine;";
const F_H: &str = "float fH = schlickWeight(lH);";
const COAT: &str = "berry(nH, mix(0.1, 0.001, m.clearcoatGloss))";

mistakes! {
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
        [(F_H, "float fH = schlickWeight(nH);")];
    "fresnel-by-the-light": "takes the light's angle to the normal for Fresnel's", [(F_H, "float fH = schlickWeight(nL);")];
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
}
