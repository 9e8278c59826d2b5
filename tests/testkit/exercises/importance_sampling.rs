//! Path tracing with multiple importance sampling.

use super::Edited;
use crate::IMPORTANCE_SAMPLING;

pub(super) static EDITED: Edited = Edited {
    exercise: &IMPORTANCE_SAMPLING,
    faults: &[
        (
            "light counted twice",
            &[("* weight(density, other) / density", "/ density")],
        ),
        (
            "no weight for what the BRDF finds",
            &[(
                "share = weight(density, lightDensity(ray.origin, spheres[hit.sphere]));",
                "share = 1.0;",
            )],
        ),
        (
            "emitters not drawn at all",
            &[(
                "color += throughput * sampleLight(hit, reflected);",
                "sampleLight(hit, reflected);",
            )],
        ),
        (
            "emitters found by chance not counted",
            &[("share = weight(", "share = 0.0 * weight(")],
        ),
        (
            "as if there were one emitter",
            &[(
                "coneDepth(point, emitter) * float(EMITTERS)",
                "coneDepth(point, emitter)",
            )],
        ),
        (
            "always the first emitter",
            &[("int(random() * float(EMITTERS))", "int(0.0 * random())")],
        ),
        (
            "pi forgotten in the BRDF",
            &[("return material.color / PI;", "return material.color;")],
        ),
        (
            "density of a sphere",
            &[(
                "return max(dot(normal, direction), 0.0) / PI;",
                "return 1.0 / (4.0 * PI);",
            )],
        ),
        (
            "directions uniform over the half space",
            &[("around(normal, sqrt(1.0 - u), v)", "around(normal, 1.0 - u, v)")],
        ),
        (
            "lobe around the normal",
            &[("return around(reflected, pow", "return around(normal, pow")],
        ),
        (
            "exponent without its one",
            &[(
                "1.0 / (material.exponent + 1.0)",
                "1.0 / material.exponent + 0.02",
            )],
        ),
        (
            "cosine forgotten",
            &[(
                "brdf(hit.material, reflected, direction) * facing / density;",
                "brdf(hit.material, reflected, direction) / density;",
            )],
        ),
        ("one segment too few", &[("MAX_DEPTH = 4", "MAX_DEPTH = 3")]),
        (
            "light looked for by a segment too many",
            &[("depth + 1 == MAX_DEPTH", "depth == MAX_DEPTH")],
        ),
        (
            "throughput not kept",
            &[("throughput *= brdf", "throughput = brdf")],
        ),
        (
            "emitters seen through everything",
            &[(
                "if (inShadow(Ray(hit.point + EPSILON * hit.normal, direction), emitter)) {\n        return vec3(0.0);\n    }\n",
                "",
            )],
        ),
        (
            "samples with one seed",
            &[("startSample(fragCoord, i)", "startSample(fragCoord, 0)")],
        ),
    ],
    rewrites: &[&[
        ("as it stands", &[]),
        (
            "the power heuristic by its squares",
            &[(
                "float ratio = other / density;\n    return 1.0 / (1.0 + ratio * ratio);",
                "return density * density / (density * density + other * other);",
            )],
        ),
        (
            "the textbook's quadratic",
            &[(
                "vec3 closest = f - b * ray.direction;\n    float disc = sphere.radius * sphere.radius - dot(closest, closest);",
                "float disc = b * b - dot(f, f) + sphere.radius * sphere.radius;",
            )],
        ),
        (
            "the cone by its cosine",
            &[(
                "return sine2 / (1.0 + sqrt(1.0 - sine2));",
                "return 1.0 - sqrt(1.0 - sine2);",
            )],
        ),
        (
            "times one over the number of samples",
            &[("color /= float(SAMPLES);", "color *= 1.0 / float(SAMPLES);")],
        ),
        (
            "bounces start on the surface, light rays off it",
            &[(
                "ray = Ray(hit.point + EPSILON * hit.normal, direction);",
                "ray = Ray(hit.point, direction);",
            )],
        ),
        (
            "light rays start on the surface, bounces off it",
            &[(
                "inShadow(Ray(hit.point + EPSILON * hit.normal, direction), emitter)",
                "inShadow(Ray(hit.point, direction), emitter)",
            )],
        ),
        (
            "each sample divided",
            &[
                ("color += trace(", "color += 0.0625 * trace("),
                ("    color /= float(SAMPLES);\n", ""),
            ],
        ),
    ]],
};
