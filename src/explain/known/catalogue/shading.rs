//! Mistakes in the shading: lights, shadows, lights with a radius, and Burley's BRDF.

use super::geometry::TEXTBOOK;
use super::{Group, mistakes};

/// Lights, and the shading of surfaces.
pub(super) static LIGHTS: Group = mistakes! {
    /// Multiply the light by `max(dot(n, l), 0.0)`.
    "cosine-missing": "the cosine N·L is missing",
        [LightTerm = "lights[i].color * «Brdf»"];
    /// Use `max(dot(n, l), 0.0)`.
    "cosine-not-clamped": "N·L is not clamped to 0",
        [Lit = "true"];
    /// Use `max(dot(n, l), 0.0)` instead of `abs(dot(n, l))`.
    "cosine-absolute": "the absolute value of N·L is used, which lights the back of surfaces",
        [LightCosine = "abs(dot(hit.normal, toLight))"];
    /// Use `l = normalize(light - point)`.
    "light-direction-reversed": "the direction to the light is reversed: point − light is used instead of light − point",
        [DirectionToLight = "normalize(hit.point - lights[i].position)"];
    /// Use `l = normalize(light - point)`.
    "light-not-normalized": "the direction to the light is not normalized",
        [DirectionToLight = "(lights[i].position - hit.point)"];
    /// Subtract the hit point: `l = normalize(light - point)`.
    "light-position-as-direction": "the light's position is used as the direction to the light",
        [DirectionToLight = "normalize(lights[i].position)"];
    /// Do not divide by the squared distance to the light.
    "light-falloff": "the light decreases with the squared distance; lights in the scene have no falloff",
        [LightTerm = "… / dot(lights[i].position - hit.point, lights[i].position - hit.point)"];
    /// Add the contributions of all lights in a loop: `for (int i = 0; i < LIGHTS; i++)`.
    "first-light-only": "only the first light is used", [LightCount = "1"];
    /// Use `sum += …` instead of `sum = …` in the loop over the lights.
    "last-light-only": "only the last light counts: each light replaces the previous one instead of being added",
        [LightSum = "sum = AMBIENT * hit.color + «LightTerm»;"];
    /// Add them: `sum = ambient + direct`.
    "light-not-added": "the maximum of ambient light and direct light is used instead of their sum",
        [LightSum = "sum = max(sum, «LightTerm»);"];
    /// Start the sum with `AMBIENT * color`.
    "no-ambient": "ambient light is missing", [AmbientTerm = "vec3(0.0)"];
    /// Add `AMBIENT * color` before the loop over the lights, not in it.
    "ambient-per-light": "ambient light is added once per light instead of once",
        [AmbientTerm = "… * float(LIGHTS)"],
        [AmbientTerm = "… * float(LIGHTS + 1)"];
    /// Use `AMBIENT * color`.
    "ambient-not-tinted": "ambient light is not multiplied by the surface color",
        [AmbientTerm = "AMBIENT"];
    /// Use `AMBIENT * color`; only the BRDF of direct light is divided by π.
    "ambient-over-pi": "ambient light is divided by π", [AmbientTerm = "… / 3.14159265359"];
    /// Add `AMBIENT * color` at every hit point.
    "ambient-only-in-shadow": "ambient light is added only where there is no other light",
        [LightSum = "sum = sum == AMBIENT * hit.color ? vec3(0.0) : sum;\n            …"];
    /// Multiply by the light's color: `light.color * brdf * cosine`.
    "light-color-ignored": "the color of the lights is ignored", [LightTerm = "«Brdf» * cosine"];
    /// Multiply the light by the surface color.
    "surface-color-ignored": "the surface color is ignored",
        [AmbientTerm = "AMBIENT", LambertBrdf = "1.0"],
        [AmbientTerm = "AMBIENT", DiffuseBrdf = "1.0 / PI"];
    /// Use `color * light` instead of `color + light`.
    "surface-color-added": "the surface color is added to the light instead of multiplied by it",
        [AmbientTerm = "AMBIENT + hit.color", LambertBrdf = "1.0"];
    /// Use `color / PI`.
    "pi-missing": "the diffuse BRDF is not divided by π",
        [DiffuseBrdf = "hit.color"],
        [DiffuseCase = "hit.color"];
    /// Use `color / PI`.
    "pi-multiplied": "the diffuse BRDF is multiplied by π instead of divided by it",
        [DiffuseBrdf = "hit.color * PI"],
        [DiffuseCase = "hit.color * PI"];
    /// Multiply by `max(dot(n, l), 0.0)` only once.
    "cosine-squared": "the cosine N·L is applied twice", [LightTerm = "… * cosine"];
};

/// Shadows of point lights.
pub(super) static SHADOWS: Group = mistakes! {
    /// Add the light only if a ray from the hit point to the light hits nothing before the light.
    "no-shadows": "shadows are missing", [LitAndVisible = "«Lit»"];
    /// Count a hit only if `t < length(light - point)`.
    "shadow-beyond-light": "shadow rays do not stop at the light, so objects behind it cast shadows",
        [ShadowLength = "NO_HIT"];
    /// Compare t with `length(light - point)`; `t < 1.0` is right only if the direction is not normalized.
    "shadow-rays-too-short": "shadow rays have length 1 instead of the distance to the light",
        [ShadowLength = "1.0"];
    /// Use the direction `normalize(light - point)`.
    "shadow-rays-reversed": "shadow rays point away from the light", [ShadowVector = "origin - light"];
    /// Use the direction `normalize(light - point)`.
    "shadow-ray-not-normalized": "shadow rays are not normalized, but the intersection formula assumes unit length",
        [ShadowDirection = "toLight", Discriminant = TEXTBOOK];
    /// Offset the origin outward: `point + 1e-3 * normal`.
    "shadow-origin-below-surface": "shadow rays start below the surface, so every surface is in its own shadow",
        [ShadowOrigin = "hit.point - «ShadowOffset» * hit.normal"];
    /// In shadow, leave out only this light; keep `AMBIENT * color`.
    "shadow-without-ambient": "ambient light is missing in shadows",
        [
            LightStatement = "if (cosine > 0.0 && !(«Visible»)) {\n            return vec3(0.0);\n        }\n        if (cosine > 0.0) {\n            «LightSum»\n        }",
        ];
    /// Start them at `point + 1e-3 * normal`.
    "shadow-from-camera": "shadow rays start at the camera instead of the hit point",
        [ShadowOrigin = "vec3(0.0)"];
};

/// Lights with a radius.
pub(super) static SOFT_LIGHTS: Group = mistakes! {
    /// Sample a direction in the cone that the light subtends: `cosine = 1.0 - u * depth`, azimuth `2.0 * PI
    /// * v`.
    "point-light": "the light is sampled only at its center, like a point light",
        [LightSample = "normalize(axis)"];
    /// Limit the cosine to the cone: `cosine = 1.0 - u * (1.0 - cosMax)`.
    "hemisphere-sampled": "directions are sampled in the hemisphere around the light's axis instead of the light's cone",
        [ConeCosine = "1.0 - u"];
    /// Multiply by the random number: `cosine = 1.0 - u * (1.0 - cosMax)`.
    "cone-edge-only": "directions are sampled only on the edge of the light's cone",
        [ConeCosine = "1.0 - depth"];
    /// Use `cosine = 1.0 - u * (1.0 - cosMax)`; the area of a cap is proportional to 1 − cos θ.
    "angle-uniform": "the angle to the light's axis is sampled uniformly instead of its cosine",
        [ConeCosine = "cos(u * asin(sqrt(sine2)))"];
    /// Use `sin² = radius * radius / dot(toLight, toLight)`.
    "light-radius-not-squared": "the light's radius is not squared in the size of its cone",
        [LightRadiusSquared = "light.radius"];
    /// Use the first random number for the cosine and the second for the azimuth.
    "random-numbers-swapped": "the two random numbers are swapped: the first one sets the azimuth instead of the cosine",
        [ConeUStatement = "«ConeVStatement»", ConeVStatement = "«ConeUStatement»"];
    /// Use `phi = 2.0 * PI * v`.
    "azimuth-half-circle": "the azimuth covers only half a circle: π is used instead of 2π",
        [Turn = "3.14159265359 * turn"];
    /// Use `phi = 2.0 * PI * v`.
    "azimuth-without-2-pi": "the azimuth is not multiplied by 2π", [Turn = "turn"];
    /// Use `phi = 2.0 * PI * v`; `sin` and `cos` take radians.
    "azimuth-in-degrees": "the azimuth is in degrees instead of radians", [Turn = "360.0 * turn"];
    /// Use `max(dot(n, direction), 0.0)` with the sampled direction.
    "cosine-to-light-center": "N·L is computed with the direction to the light's center instead of the sampled direction",
        [LightCosine = "dot(hit.normal, normalize(lights[i].position - hit.point))"];
    /// Trace the shadow ray along the sampled direction.
    "shadow-rays-to-light-center": "shadow rays go to the light's center instead of along the sampled direction",
        [SoftShadowDirection = "normalize(lights[i].position - hit.point)"];
};

/// Burley's BRDF.
pub(super) static DISNEY: Group = mistakes! {
    /// Evaluate the Disney BRDF for surfaces with this model.
    "diffuse-instead-of-disney": "a diffuse BRDF is used instead of the Disney BRDF",
        [ViewBrdf = "hit.color / PI"];
    /// Use `v = -ray.direction`, from the surface to the camera.
    "view-direction-reversed": "the view direction is reversed", [ShadeView = "ray.direction"];
    /// Use `alpha = roughness * roughness`.
    "roughness-not-squared": "the roughness is not squared to obtain α",
        [RoughnessX = "m.roughness", RoughnessY = "m.roughness"];
    /// Exchange `dot(x, h)` and `dot(y, h)`.
    "tangents-swapped": "tangent and bitangent are swapped",
        [HalfVectorX = "«HalfVectorY»", HalfVectorY = "«HalfVectorX»"];
    /// Use `aspect = sqrt(1.0 - 0.9 * anisotropic)`, `ax = alpha / aspect`, `ay = alpha * aspect`.
    "anisotropy-ignored": "the parameter `anisotropic` is ignored", [Anisotropy = "1.0"];
    /// Multiply the diffuse part by `1.0 - metallic`.
    "diffuse-on-metal": "metals have a diffuse part: the factor 1 − metallic is missing",
        [DiffuseLobe = "«BaseAndSheen»"];
    /// Use `mix(dielectric, color, metallic)` as the specular color.
    "metal-highlights-not-tinted": "the specular color of metals is not the base color",
        [SpecularColor = "dielectric"];
    /// Use `pow(1.0 - cosine, 5.0)`.
    "schlick-fourth-power": "Schlick's weight uses the fourth power instead of the fifth",
        [SchlickWeight = "square(square(m))"];
    /// Use `dot(l, h)`, with h the half vector.
    "fresnel-with-n-dot-h": "the Fresnel term uses N·H instead of L·H",
        [FresnelCosine = "nH"];
    /// Use `dot(l, h)`, with h the half vector.
    "fresnel-with-n-dot-l": "the Fresnel term uses N·L instead of L·H", [FresnelCosine = "nL"];
    /// Mix it in: `mix(diffuse, subsurface, m.subsurface)`.
    "no-subsurface": "the subsurface term is missing", [DiffuseAndSubsurface = "diffuse"];
    /// Add the sheen to the diffuse part.
    "no-sheen": "the sheen term is missing", [BaseAndSheen = "base"];
    /// Add the clear coat, with the factor `0.25 * clearcoat`.
    "no-clear-coat": "the clear coat is missing", [SpecularAndCoat = "f * d * g"];
    /// Use GTR1 with `mix(0.1, 0.001, clearcoatGloss)` as α.
    "clear-coat-distribution": "the clear coat uses the distribution of the specular lobe (GTR2) instead of GTR1",
        [CoatDistribution = "trowbridgeReitz(nH, dot(x, middle), dot(y, middle), 0.25, 0.25)"];
    /// Use `mix(0.1, 0.001, clearcoatGloss)` as α.
    "clear-coat-gloss-ignored": "the parameter `clearcoatGloss` is ignored",
        [CoatDistribution = "berry(nH, 0.1)"];
    /// Add `f * d * g`.
    "no-specular": "the specular lobe is missing", [SpecularAndCoat = "coat"];
    /// Use `smith(nL) * smith(nV)` once.
    "shadowing-squared": "the shadowing–masking term G is squared", [Shadowing = "square(…)"];
    /// Multiply `f * d` by `smith(nL) * smith(nV)`.
    "no-shadowing": "the shadowing–masking term G is missing", [SpecularAndCoat = "f * d + coat"];
    /// Use `color / PI` in the diffuse part.
    "pi-missing-in-diffuse": "the diffuse part of the Disney BRDF is not divided by π",
        [BaseOverPi = "color"];
    /// Use `normalize(l + v)`.
    "half-vector-not-normalized": "the half vector is not normalized", [HalfVector = "(light + view)"];
    /// Use `mix(vec3(1.0), tint, specularTint)`.
    "specular-tint-ignored": "the parameter `specularTint` is ignored", [SpecularTint = "vec3(1.0)"];
};
