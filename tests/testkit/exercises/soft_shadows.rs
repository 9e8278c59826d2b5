//! Cone-sampled spherical lights.

use super::Edited;
use super::sphere::{CAMERA, SPHERE};
use crate::SOFT_SHADOWS;

pub(super) static EDITED: Edited = Edited {
    exercise: &SOFT_SHADOWS,
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
        SPHERE,
        CAMERA,
        &[
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
    ],
};
