//! Mirror, glass and checker.

use super::Edited;
use crate::WHITTED;

pub(super) static EDITED: Edited = Edited {
    exercise: &WHITTED,
    faults: &[
        (
            "index the other way up",
            &[("entering ? 1.0 / IOR : IOR", "entering ? IOR : 1.0 / IOR")],
        ),
        ("index of water", &[("IOR = 1.5", "IOR = 1.33")]),
        (
            "normal not turned inside",
            &[("entering ? hit.normal : -hit.normal", "hit.normal")],
        ),
        (
            "refraction without its normal part",
            &[("+ (eta * cosine - beyond) * normal", "")],
        ),
        (
            "sign in Snell's law",
            &[(
                "(eta * cosine - beyond) * normal",
                "(eta * cosine + beyond) * normal",
            )],
        ),
        (
            "nothing reflected by glass",
            &[("float share = fresnel(eta, cosine, beyond)", "float share = 0.0")],
        ),
        (
            "half reflected by glass",
            &[("float share = fresnel(eta, cosine, beyond)", "float share = 0.5")],
        ),
        (
            "only one polarisation",
            &[("0.5 * (across * across + along * along)", "across * across")],
        ),
        (
            "Schlick instead of Fresnel",
            &[(
                "float share = fresnel(eta, cosine, beyond)",
                "float share = 0.04 + 0.96 * pow(1.0 - (entering ? cosine : beyond), 5.0)",
            )],
        ),
        (
            "shares swapped",
            &[
                ("throughput * share, depth", "throughput * (1.0 - share), depth"),
                (
                    "Ray(hit.point, refracted), throughput * (1.0 - share)",
                    "Ray(hit.point, refracted), throughput * share",
                ),
            ],
        ),
        (
            "glass of no colour",
            &[(
                "vec3 throughput = branch.throughput * hit.color;",
                "vec3 throughput = branch.throughput * (hit.model == GLASS ? vec3(1.0) : hit.color);",
            )],
        ),
        (
            "checker in one direction",
            &[("floor(point.x) + floor(point.z)", "floor(point.x)")],
        ),
        (
            "checker by truncation",
            &[(
                "floor(point.x) + floor(point.z)",
                "float(int(point.x) + int(point.z))",
            )],
        ),
        (
            "checker colours swapped",
            &[(
                "vec3(0.9, 0.8, 0.3) : vec3(0.6, 0.15, 0.1)",
                "vec3(0.6, 0.15, 0.1) : vec3(0.9, 0.8, 0.3)",
            )],
        ),
        (
            "squares of two",
            &[(
                "floor(point.x) + floor(point.z)",
                "floor(0.5 * point.x) + floor(0.5 * point.z)",
            )],
        ),
        ("too few segments", &[("MAX_DEPTH = 6", "MAX_DEPTH = 3")]),
        (
            "mirror like glass",
            &[("if (hit.model == MIRROR) {", "if (hit.model == 7) {")],
        ),
        (
            "shadow as far as the eye sees",
            &[(
                "nearestHit(Ray(origin, toLight / distance)).t > distance",
                "nearestHit(Ray(origin, -toLight / distance)).t > distance",
            )],
        ),
    ],
    rewrites: &[&[
        ("as it stands", &[]),
        (
            "refract() of the language",
            &[(
                "vec3 refracted = eta * ray.direction + (eta * cosine - beyond) * normal;",
                "vec3 refracted = refract(ray.direction, normal, eta);",
            )],
        ),
        (
            "mirrored by hand",
            &[(
                "reflect(ray.direction, hit.normal)",
                "ray.direction - 2.0 * dot(hit.normal, ray.direction) * hit.normal",
            )],
        ),
        (
            "Fresnel by indices",
            &[(
                "float across = (eta * cosine - beyond) / (eta * cosine + beyond);\n    float along = (cosine - eta * beyond) / (cosine + eta * beyond);",
                "float n = 1.0 / eta;\n    float across = (cosine - n * beyond) / (cosine + n * beyond);\n    float along = (n * cosine - beyond) / (n * cosine + beyond);",
            )],
        ),
        (
            "the checker by parity",
            &[(
                "return mod(square, 2.0) == 0.0 ?",
                "return (int(square) & 1) == 0 ?",
            )],
        ),
        (
            "the checker by fract",
            &[(
                "return mod(square, 2.0) == 0.0 ?",
                "return fract(0.5 * square) < 0.25 ?",
            )],
        ),
        (
            "refracted rays first",
            &[(
                "stack[top++] = Branch(mirrored, throughput * share, depth);\n        stack[top++] = Branch(Ray(hit.point, refracted), throughput * (1.0 - share), depth);",
                "stack[top++] = Branch(Ray(hit.point, refracted), throughput - throughput * share, depth);\n        stack[top++] = Branch(mirrored, share * throughput, depth);",
            )],
        ),
        (
            "secondary rays off the surface",
            &[
                (
                    "Ray mirrored = Ray(hit.point,",
                    "vec3 side = dot(ray.direction, hit.normal) < 0.0 ? hit.normal : -hit.normal;\n        Ray mirrored = Ray(hit.point + EPSILON * side,",
                ),
                (
                    "Branch(Ray(hit.point, refracted)",
                    "Branch(Ray(hit.point - EPSILON * normal, refracted)",
                ),
            ],
        ),
    ]],
};
