//! Diffuse BRDF, tone map, gamma.

use super::Edited;
use crate::support::DIFFUSE;

pub(super) static EDITED: Edited = Edited {
    rung: &DIFFUSE,
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
};
