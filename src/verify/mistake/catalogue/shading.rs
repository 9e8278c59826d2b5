//! Mistakes in the shading: lights, shadows, lights with a radius, and Burley's BRDF.

use super::geometry::TEXTBOOK;
use super::{Mistake, mistakes};

/// Lights, and the shading of surfaces.
pub(super) static LIGHTS: &[Mistake] = mistakes! {
    "cosine-forgotten": "forgets the cosine of the angle to the light",
        [LightTerm = "lights[i].color * «Brdf»"];
    "cosine-not-clamped": "lets light from below the surface count as negative light",
        [Lit = "true"];
    "cosine-without-sign": "lights both sides of a surface: the absolute value of the cosine",
        [LightCosine = "abs(dot(hit.normal, toLight))"];
    "light-backwards": "has the direction to the light backwards",
        [DirectionToLight = "normalize(hit.point - lights[i].position)"];
    "light-not-normalised": "does not normalise the direction to the light",
        [DirectionToLight = "(lights[i].position - hit.point)"];
    "light-from-afar": "takes the light's position for its direction",
        [DirectionToLight = "normalize(lights[i].position)"];
    "light-falls-off": "lets the light fall off with the square of its distance, which the scene does not",
        [LightTerm = "… / dot(lights[i].position - hit.point, lights[i].position - hit.point)"];
    "first-light-only": "has one light where the scene has more", [LightCount = "1"];
    "last-light-only": "lets each light replace the one before, where they add up",
        [LightSum = "sum = AMBIENT * hit.color + «LightTerm»;"];
    "light-not-added": "takes the brighter of ambient light and a light's, where they add up",
        [LightSum = "sum = max(sum, «LightTerm»);"];
    "no-ambient": "forgets the ambient light", [AmbientTerm = "vec3(0.0)"];
    "ambient-per-light": "adds the ambient light once for each light",
        [AmbientTerm = "… * float(LIGHTS)"],
        [AmbientTerm = "… * float(LIGHTS + 1)"];
    "ambient-not-tinted": "does not multiply the ambient light by the surface's colour",
        [AmbientTerm = "AMBIENT"];
    "ambient-over-pi": "divides the ambient light by π", [AmbientTerm = "… / 3.14159265359"];
    "ambient-where-it-is-dark": "adds ambient light only where no other light comes",
        [LightSum = "sum = sum == AMBIENT * hit.color ? vec3(0.0) : sum;\n            …"];
    "light-without-colour": "forgets the lights' colour", [LightTerm = "«Brdf» * cosine"];
    "colour-forgotten": "forgets the surface's colour",
        [AmbientTerm = "AMBIENT", LambertBrdf = "1.0"],
        [AmbientTerm = "AMBIENT", DiffuseBrdf = "1.0 / PI"];
    "colour-added": "adds the surface's colour to the light, where it should multiply",
        [AmbientTerm = "AMBIENT + hit.color", LambertBrdf = "1.0"];
    "pi-forgotten": "forgets to divide the BRDF by π",
        [DiffuseBrdf = "hit.color"],
        [DiffuseCase = "hit.color"];
    "pi-multiplied": "multiplies the BRDF by π where it should divide",
        [DiffuseBrdf = "hit.color * PI"],
        [DiffuseCase = "hit.color * PI"];
    "cosine-squared": "multiplies by the cosine twice", [LightTerm = "… * cosine"];
};

/// Shadows of point lights.
pub(super) static SHADOWS: &[Mistake] = mistakes! {
    "no-shadows": "has no shadows", [LitAndVisible = "«Lit»"];
    "shadow-beyond-the-light": "tests shadows beyond the light", [ShadowLength = "NO_HIT"];
    "shadow-rays-short": "follows shadow rays for a length of 1 only, not as far as the light",
        [ShadowLength = "1.0"];
    "shadow-rays-away": "sends shadow rays away from the light", [ShadowVector = "origin - light"];
    "shadow-ray-not-normalised": "does not normalise shadow rays, though its formula is that for directions of length 1",
        [ShadowDirection = "toLight", Discriminant = TEXTBOOK];
    "shadow-of-itself": "starts shadow rays below the surface, so that everything lies in its own shadow",
        [ShadowOrigin = "hit.point - «ShadowOffset» * hit.normal"];
    "shadow-without-ambient": "leaves no ambient light in shadows",
        [
            LightStatement = "if (cosine > 0.0 && !(«Visible»)) {\n            return vec3(0.0);\n        }\n        if (cosine > 0.0) {\n            «LightSum»\n        }",
        ];
    "shadow-from-the-eye": "starts shadow rays at the eye", [ShadowOrigin = "vec3(0.0)"];
};

/// Lights with a radius.
pub(super) static SOFT_LIGHTS: &[Mistake] = mistakes! {
    "point-light": "samples the light's centre alone, as if it had no radius",
        [LightSample = "normalize(axis)"];
    "half-space-sampled": "draws directions from the whole half space around the light, not from its cone",
        [ConeCosine = "1.0 - u"];
    "cone-edge-only": "draws directions on the edge of the light's cone only", [ConeCosine = "1.0 - depth"];
    "angle-uniform": "draws the angle to the light's axis uniformly, where its cosine should be",
        [ConeCosine = "cos(u * asin(sqrt(sine2)))"];
    "light-radius-not-squared": "does not square the light's radius", [LightRadiusSquared = "light.radius"];
    "draws-swapped": "takes the first number drawn for the turn and the second for the angle, where the scene has them the other way round",
        [ConeUStatement = "«ConeVStatement»", ConeVStatement = "«ConeUStatement»"];
    "half-a-turn": "turns by half a circle only: π where 2π should stand", [Turn = "3.14159265359 * turn"];
    "turn-without-2-pi": "turns by as many radians as it should by full circles", [Turn = "turn"];
    "turn-in-degrees": "turns by degrees where radians are expected", [Turn = "360.0 * turn"];
    "cosine-of-the-centre": "takes the cosine to the light's centre, not that of the direction drawn",
        [LightCosine = "dot(hit.normal, normalize(lights[i].position - hit.point))"];
    "shadow-rays-to-the-centre": "sends its shadow rays to the light's centre, not in the direction drawn",
        [SoftShadowDirection = "normalize(lights[i].position - hit.point)"];
};

/// Burley's BRDF.
pub(super) static DISNEY: &[Mistake] = mistakes! {
    "diffuse-for-disney": "has a diffuse BRDF for Burley's", [ViewBrdf = "hit.color / PI"];
    "view-backwards": "has the direction to the eye backwards", [ShadeView = "ray.direction"];
    "roughness-not-squared": "does not square the roughness",
        [RoughnessX = "m.roughness", RoughnessY = "m.roughness"];
    "tangents-swapped": "has the two tangents exchanged",
        [HalfVectorX = "«HalfVectorY»", HalfVectorY = "«HalfVectorX»"];
    "anisotropy-forgotten": "forgets anisotropy", [Anisotropy = "1.0"];
    "diffuse-under-metal": "adds the diffuse part to metals, too", [DiffuseLobe = "«BaseAndSheen»"];
    "metal-without-colour": "forgets to tint the highlights of metals", [SpecularColor = "dielectric"];
    "fresnel-to-the-fourth": "has the fourth power in Schlick's weight, not the fifth",
        [SchlickWeight = "square(square(m))"];
    "fresnel-by-the-normal": "takes the half vector's angle to the normal for Fresnel's, where it should be that to the light",
        [FresnelCosine = "nH"];
    "fresnel-by-the-light": "takes the light's angle to the normal for Fresnel's", [FresnelCosine = "nL"];
    "no-subsurface": "forgets subsurface scattering", [DiffuseAndSubsurface = "diffuse"];
    "no-sheen": "forgets the sheen", [BaseAndSheen = "base"];
    "no-clear-coat": "forgets the clear coat", [SpecularAndCoat = "f * d * g"];
    "coat-of-the-base-lobe": "has the base's distribution for the clear coat",
        [CoatDistribution = "trowbridgeReitz(nH, dot(x, middle), dot(y, middle), 0.25, 0.25)"];
    "coat-without-gloss": "forgets the gloss of the clear coat", [CoatDistribution = "berry(nH, 0.1)"];
    "no-specular": "forgets the specular lobe", [SpecularAndCoat = "coat"];
    "shadowing-squared": "squares the shadowing term", [Shadowing = "square(…)"];
    "no-shadowing": "forgets the shadowing term", [SpecularAndCoat = "f * d + coat"];
    "pi-forgotten-in-the-base": "forgets to divide the diffuse part by π", [BaseOverPi = "color"];
    "half-vector-not-normalised": "does not normalise the half vector", [HalfVector = "(light + view)"];
    "specular-not-tinted": "forgets the tint of the highlights", [SpecularTint = "vec3(1.0)"];
};
