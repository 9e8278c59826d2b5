//! Cone-sampled spherical lights.

use super::Edited;
use crate::support::SOFT_SHADOWS;

pub(super) static EDITED: Edited = Edited {
    rung: &SOFT_SHADOWS,
    faults: &[
        (
            "a point light",
            &[(
                "return around(toLight / distance, cosine, v)",
                "return toLight / distance",
            )],
        ),
        ("the whole half space", &[("1.0 - u * depth", "1.0 - u")]),
        (
            "the cone's depth not drawn",
            &[("1.0 - u * depth", "1.0 - depth")],
        ),
        (
            "angle instead of its cosine",
            &[("1.0 - u * depth", "cos(u * asin(sqrt(sine2)))")],
        ),
        (
            "radius not squared",
            &[(
                "light.radius * light.radius / (distance * distance)",
                "light.radius / (distance * distance)",
            )],
        ),
        (
            "u and v swapped",
            &[(
                "float u = random();\n    float v = random();",
                "float v = random();\n    float u = random();",
            )],
        ),
        (
            "turned by half",
            &[("6.28318530718 * turn", "3.14159265359 * turn")],
        ),
        ("turned by as many radians", &[("6.28318530718 * turn", "turn")]),
        (
            "samples with one seed",
            &[("startSample(fragCoord, i)", "startSample(fragCoord, 0)")],
        ),
        (
            "light at twice the size",
            &[("5.0, -5.0), 0.6", "5.0, -5.0), 1.2")],
        ),
        (
            "cosine of the light's centre",
            &[(
                "float cosine = dot(normal, toLight);",
                "float cosine = dot(normal, normalize(light.position - point));",
            )],
        ),
        (
            "no shadow",
            &[(
                "if (!inShadow(Ray(point + 0.001 * normal, toLight), distance))",
                "",
            )],
        ),
        (
            "shadow rays to the centre",
            &[(
                "inShadow(Ray(point + 0.001 * normal, toLight), distance)",
                "inShadow(Ray(point + 0.001 * normal, normalize(light.position - point)), distance)",
            )],
        ),
    ],
    rewrites: &[
        ("as it stands", &[]),
        (
            "the full quadratic",
            &[
                (
                    "float b = dot(f, ray.direction);",
                    "float a = dot(ray.direction, ray.direction);\n    float b = 2.0 * dot(f, ray.direction);",
                ),
                ("float disc = b * b - c;", "float disc = b * b - 4.0 * a * c;"),
                ("float t = -b - root;", "float t = (-b - root) / (2.0 * a);"),
                ("t = -b + root;", "t = (-b + root) / (2.0 * a);"),
            ],
        ),
        (
            "stable roots",
            &[
                (
                    "float t = -b - root;",
                    "float q = b > 0.0 ? -b - root : -b + root;\n        float t = min(q, c / q);",
                ),
                ("t = -b + root;", "t = max(q, c / q);"),
            ],
        ),
        (
            "the centre projected, by Pythagoras",
            &[
                (
                    "vec3 f = ray.origin - sphere.center;",
                    "vec3 toCenter = sphere.center - ray.origin;",
                ),
                (
                    "float b = dot(f, ray.direction);",
                    "float along = dot(toCenter, ray.direction);",
                ),
                (
                    "float c = dot(f, f) - sphere.radius * sphere.radius;",
                    "float aside = dot(toCenter, toCenter) - along * along;",
                ),
                (
                    "float disc = b * b - c;",
                    "float disc = sphere.radius * sphere.radius - aside;",
                ),
                ("float t = -b - root;", "float t = along - root;"),
                ("t = -b + root;", "t = along + root;"),
            ],
        ),
        (
            "an early return for a miss",
            &[("if (disc > 0.0) {", "if (disc < 0.0) return NO_HIT;\n    {")],
        ),
        (
            "the screen in pixels",
            &[(
                "Ray cameraRay(…\n}\n",
                "Ray cameraRay(vec2 p) {\n    vec3 d = vec3(p - 0.5 * iResolution.xy, -iResolution.x);\n    return Ray(vec3(0.0), d / length(d));\n}\n",
            )],
        ),
        (
            "the half angle's cosine",
            &[
                (
                    "float depth = sine2 / (1.0 + sqrt(1.0 - sine2));",
                    "float cosineMax = sqrt(1.0 - sine2);",
                ),
                ("1.0 - u * depth", "mix(1.0, cosineMax, u)"),
            ],
        ),
        (
            "as far as the light's centre",
            &[(
                "lightDistance = distance * (cosine - chord)",
                "lightDistance = distance * cosine - light.radius * 0.0 - distance * chord",
            )],
        ),
        (
            "each sample divided",
            &[
                ("color += trace(", "color += 0.0625 * trace("),
                ("color / float(SAMPLES)", "color"),
            ],
        ),
        (
            "seeds by components",
            &[(
                "state = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))));",
                "uvec2 p = uvec2(fragCoord);\n    state = pcg(uint(i));\n    state = pcg(p.y + state);\n    state = pcg(p.x + state);",
            )],
        ),
    ],
};
