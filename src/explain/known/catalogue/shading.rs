//! Mistakes in the shading: lights, shadows, lights with a radius, and Burley's BRDF.

use super::geometry::TEXTBOOK;
use super::{Mistake, mistakes};

/// Lights, and the shading of surfaces.
pub(super) static LIGHTS: &[Mistake] = mistakes! {
    "cosine-missing": "the cosine N·L is missing",
        [LightTerm = "lights[i].color * «Brdf»"];
    "cosine-not-clamped": "N·L is not clamped to 0",
        [Lit = "true"];
    "cosine-absolute": "the absolute value of N·L is used, which lights the back of surfaces",
        [LightCosine = "abs(dot(hit.normal, toLight))"];
    "light-direction-reversed": "the direction to the light is reversed: point − light is used instead of light − point",
        [DirectionToLight = "normalize(hit.point - lights[i].position)"];
    "light-not-normalized": "the direction to the light is not normalized",
        [DirectionToLight = "(lights[i].position - hit.point)"];
    "light-position-as-direction": "the light's position is used as the direction to the light",
        [DirectionToLight = "normalize(lights[i].position)"];
    "light-falloff": "the light decreases with the squared distance; lights in the scene have no falloff",
        [LightTerm = "… / dot(lights[i].position - hit.point, lights[i].position - hit.point)"];
    "first-light-only": "only the first light is used", [LightCount = "1"];
    "last-light-only": "only the last light counts: each light replaces the previous one instead of being added",
        [LightSum = "sum = AMBIENT * hit.color + «LightTerm»;"];
    "light-not-added": "the maximum of ambient light and direct light is used instead of their sum",
        [LightSum = "sum = max(sum, «LightTerm»);"];
    "no-ambient": "ambient light is missing", [AmbientTerm = "vec3(0.0)"];
    "ambient-per-light": "ambient light is added once per light instead of once",
        [AmbientTerm = "… * float(LIGHTS)"],
        [AmbientTerm = "… * float(LIGHTS + 1)"];
    "ambient-not-tinted": "ambient light is not multiplied by the surface color",
        [AmbientTerm = "AMBIENT"];
    "ambient-over-pi": "ambient light is divided by π", [AmbientTerm = "… / 3.14159265359"];
    "ambient-only-in-shadow": "ambient light is added only where there is no other light",
        [LightSum = "sum = sum == AMBIENT * hit.color ? vec3(0.0) : sum;\n            …"];
    "light-color-ignored": "the color of the lights is ignored", [LightTerm = "«Brdf» * cosine"];
    "surface-color-ignored": "the surface color is ignored",
        [AmbientTerm = "AMBIENT", LambertBrdf = "1.0"],
        [AmbientTerm = "AMBIENT", DiffuseBrdf = "1.0 / PI"];
    "surface-color-added": "the surface color is added to the light instead of multiplied by it",
        [AmbientTerm = "AMBIENT + hit.color", LambertBrdf = "1.0"];
    "pi-missing": "the diffuse BRDF is not divided by π",
        [DiffuseBrdf = "hit.color"],
        [DiffuseCase = "hit.color"];
    "pi-multiplied": "the diffuse BRDF is multiplied by π instead of divided by it",
        [DiffuseBrdf = "hit.color * PI"],
        [DiffuseCase = "hit.color * PI"];
    "cosine-squared": "the cosine N·L is applied twice", [LightTerm = "… * cosine"];
};

/// Shadows of point lights.
pub(super) static SHADOWS: &[Mistake] = mistakes! {
    "no-shadows": "shadows are missing", [LitAndVisible = "«Lit»"];
    "shadow-beyond-light": "shadow rays do not stop at the light, so objects behind it cast shadows",
        [ShadowLength = "NO_HIT"];
    "shadow-rays-too-short": "shadow rays have length 1 instead of the distance to the light",
        [ShadowLength = "1.0"];
    "shadow-rays-reversed": "shadow rays point away from the light", [ShadowVector = "origin - light"];
    "shadow-ray-not-normalized": "shadow rays are not normalized, but the intersection formula assumes unit length",
        [ShadowDirection = "toLight", Discriminant = TEXTBOOK];
    "shadow-origin-below-surface": "shadow rays start below the surface, so every surface is in its own shadow",
        [ShadowOrigin = "hit.point - «ShadowOffset» * hit.normal"];
    "shadow-without-ambient": "ambient light is missing in shadows",
        [
            LightStatement = "if (cosine > 0.0 && !(«Visible»)) {\n            return vec3(0.0);\n        }\n        if (cosine > 0.0) {\n            «LightSum»\n        }",
        ];
    "shadow-from-camera": "shadow rays start at the camera instead of the hit point",
        [ShadowOrigin = "vec3(0.0)"];
};

/// Lights with a radius.
pub(super) static SOFT_LIGHTS: &[Mistake] = mistakes! {
    "point-light": "the light is sampled only at its center, like a point light",
        [LightSample = "normalize(axis)"];
    "hemisphere-sampled": "directions are sampled in the hemisphere around the light's axis instead of the light's cone",
        [ConeCosine = "1.0 - u"];
    "cone-edge-only": "directions are sampled only on the edge of the light's cone",
        [ConeCosine = "1.0 - depth"];
    "angle-uniform": "the angle to the light's axis is sampled uniformly instead of its cosine",
        [ConeCosine = "cos(u * asin(sqrt(sine2)))"];
    "light-radius-not-squared": "the light's radius is not squared in the size of its cone",
        [LightRadiusSquared = "light.radius"];
    "random-numbers-swapped": "the two random numbers are swapped: the first one sets the azimuth instead of the cosine",
        [ConeUStatement = "«ConeVStatement»", ConeVStatement = "«ConeUStatement»"];
    "azimuth-half-circle": "the azimuth covers only half a circle: π is used instead of 2π",
        [Turn = "3.14159265359 * turn"];
    "azimuth-without-2-pi": "the azimuth is not multiplied by 2π", [Turn = "turn"];
    "azimuth-in-degrees": "the azimuth is in degrees instead of radians", [Turn = "360.0 * turn"];
    "cosine-to-light-center": "N·L is computed with the direction to the light's center instead of the sampled direction",
        [LightCosine = "dot(hit.normal, normalize(lights[i].position - hit.point))"];
    "shadow-rays-to-light-center": "shadow rays go to the light's center instead of along the sampled direction",
        [SoftShadowDirection = "normalize(lights[i].position - hit.point)"];
};

/// Burley's BRDF.
pub(super) static DISNEY: &[Mistake] = mistakes! {
    "diffuse-instead-of-disney": "a diffuse BRDF is used instead of the Disney BRDF",
        [ViewBrdf = "hit.color / PI"];
    "view-direction-reversed": "the view direction is reversed", [ShadeView = "ray.direction"];
    "roughness-not-squared": "the roughness is not squared to obtain α",
        [RoughnessX = "m.roughness", RoughnessY = "m.roughness"];
    "tangents-swapped": "tangent and bitangent are swapped",
        [HalfVectorX = "«HalfVectorY»", HalfVectorY = "«HalfVectorX»"];
    "anisotropy-ignored": "the parameter `anisotropic` is ignored", [Anisotropy = "1.0"];
    "diffuse-on-metal": "metals have a diffuse part: the factor 1 − metallic is missing",
        [DiffuseLobe = "«BaseAndSheen»"];
    "metal-highlights-not-tinted": "the specular color of metals is not the base color",
        [SpecularColor = "dielectric"];
    "schlick-fourth-power": "Schlick's weight uses the fourth power instead of the fifth",
        [SchlickWeight = "square(square(m))"];
    "fresnel-with-n-dot-h": "the Fresnel term uses N·H instead of L·H",
        [FresnelCosine = "nH"];
    "fresnel-with-n-dot-l": "the Fresnel term uses N·L instead of L·H", [FresnelCosine = "nL"];
    "no-subsurface": "the subsurface term is missing", [DiffuseAndSubsurface = "diffuse"];
    "no-sheen": "the sheen term is missing", [BaseAndSheen = "base"];
    "no-clear-coat": "the clear coat is missing", [SpecularAndCoat = "f * d * g"];
    "clear-coat-distribution": "the clear coat uses the distribution of the specular lobe (GTR2) instead of GTR1",
        [CoatDistribution = "trowbridgeReitz(nH, dot(x, middle), dot(y, middle), 0.25, 0.25)"];
    "clear-coat-gloss-ignored": "the parameter `clearcoatGloss` is ignored",
        [CoatDistribution = "berry(nH, 0.1)"];
    "no-specular": "the specular lobe is missing", [SpecularAndCoat = "coat"];
    "shadowing-squared": "the shadowing–masking term G is squared", [Shadowing = "square(…)"];
    "no-shadowing": "the shadowing–masking term G is missing", [SpecularAndCoat = "f * d + coat"];
    "pi-missing-in-diffuse": "the diffuse part of the Disney BRDF is not divided by π",
        [BaseOverPi = "color"];
    "half-vector-not-normalized": "the half vector is not normalized", [HalfVector = "(light + view)"];
    "specular-tint-ignored": "the parameter `specularTint` is ignored", [SpecularTint = "vec3(1.0)"];
};
