//! Diffuse BRDF, tone map, gamma.

use super::Edited;
use super::sphere::{CAMERA, SPHERE};
use crate::DIFFUSE;

pub(super) static EDITED: Edited = Edited {
    exercise: &DIFFUSE,
    faults: &[
        ("pi forgotten", &[("material.albedo / PI", "material.albedo")]),
        (
            "pi multiplied",
            &[("material.albedo / PI", "material.albedo * PI")],
        ),
        (
            "gamma forgotten",
            &[("return pow(color, vec3(1.0 / 2.2))", "return color")],
        ),
        ("gamma the other way", &[("vec3(1.0 / 2.2)", "vec3(2.2)")]),
        ("gamma of 2", &[("vec3(1.0 / 2.2)", "vec3(0.5)")]),
        (
            "tone map forgotten",
            &[("gammaCorrect(toneMap(color))", "gammaCorrect(color)")],
        ),
        (
            "tone map after gamma",
            &[("gammaCorrect(toneMap(color))", "toneMap(gammaCorrect(color))")],
        ),
        (
            "an exponential tone map",
            &[("return color / (color + 1.0)", "return 1.0 - exp(-color)")],
        ),
        (
            "tone map by luminance",
            &[(
                "return color / (color + 1.0)",
                "return color / (dot(color, vec3(0.3, 0.6, 0.1)) + 1.0)",
            )],
        ),
        (
            "background not developed",
            &[(
                "vec4(gammaCorrect(toneMap(color)), 1.0)",
                "vec4(hit < 0 ? color : gammaCorrect(toneMap(color)), 1.0)",
            )],
        ),
        (
            "cosine forgotten",
            &[("brdf(material) * cosine", "brdf(material)")],
        ),
        (
            "second light without shadow",
            &[(
                "if (!inShadow(point, normal, lights[i]))",
                "if (i == 1 || !inShadow(point, normal, lights[i]))",
            )],
        ),
        (
            "falloff that nobody asked for",
            &[(
                "brdf(material) * cosine",
                "brdf(material) * cosine * 40.0 / dot(lights[i].position - point, lights[i].position - point)",
            )],
        ),
        (
            "ambient divided by pi",
            &[("AMBIENT * material.albedo", "AMBIENT * material.albedo / PI")],
        ),
    ],
    rewrites: &[
        SPHERE,
        CAMERA,
        &[
            (
                "tone map as one minus",
                &[("return color / (color + 1.0)", "return 1.0 - 1.0 / (1.0 + color)")],
            ),
            (
                "gamma by exp and log",
                &[(
                    "return pow(color, vec3(1.0 / 2.2))",
                    "return exp(log(color) / 2.2)",
                )],
            ),
            (
                "albedo multiplied last",
                &[
                    (
                        "vec3 radiance = AMBIENT * material.albedo;",
                        "vec3 irradiance = AMBIENT * PI;",
                    ),
                    (
                        "radiance += lights[i].color * brdf(material) * cosine;",
                        "irradiance += lights[i].color * cosine;",
                    ),
                    ("return radiance;", "return brdf(material) * irradiance;"),
                ],
            ),
        ],
    ],
};
