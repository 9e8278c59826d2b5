//! Surfaces of second degree.

use super::Edited;
use crate::QUADRICS;

pub(super) static EDITED: Edited = Edited {
    exercise: &QUADRICS,
    faults: &[
        (
            "ends not tested",
            &[
                ("&& z0 >= quadric.low && z0 <= quadric.high", ""),
                ("&& z1 >= quadric.low && z1 <= quadric.high", ""),
            ],
        ),
        (
            "only the nearer root",
            &[(
                "if (ahead + t1 > 0.001 && z1 >= quadric.low && z1 <= quadric.high) {\n        return ahead + t1;\n    }",
                "",
            )],
        ),
        ("radii not squared", &[("1.0 / (radii * radii)", "1.0 / radii")]),
        ("radii multiplied", &[("1.0 / (radii * radii)", "radii * radii")]),
        (
            "axis forgotten",
            &[("return mat3(x, cross(axis, x), axis)", "return mat3(1.0)")],
        ),
        (
            "into the frame by the wrong side",
            &[("ray.direction * frame", "frame * ray.direction")],
        ),
        (
            "normal left in the frame",
            &[("normalize(frame * (quadric.q * p", "normalize((quadric.q * p")],
        ),
        (
            "normal to the origin",
            &[(
                "return normalize(frame * (quadric.q * p + vec3(0.0, 0.0, quadric.g)));",
                "return normalize(point - quadric.origin);",
            )],
        ),
        (
            "the linear part forgotten in the normal",
            &[("quadric.q * p + vec3(0.0, 0.0, quadric.g)", "quadric.q * p")],
        ),
        (
            "cone without its slope",
            &[(
                "-slope * slope), 0.0, 0.0, 0.0, height",
                "-1.0), 0.0, 0.0, 0.0, height",
            )],
        ),
        (
            "both nappes of the cone",
            &[(
                "0.0, 0.0, 0.0, height, color);\n}\n\nQuadric paraboloid",
                "0.0, 0.0, -height, height, color);\n}\n\nQuadric paraboloid",
            )],
        ),
        (
            "paraboloid of twice the width",
            &[("-0.5 * radius * radius / height", "-radius * radius / height")],
        ),
        (
            "hyperboloid of two sheets",
            &[("0.0, -waist * waist, -z, z", "0.0, waist * waist, -z, z")],
        ),
        (
            "open surfaces dark inside",
            &[
                (
                    "    if (dot(hit.normal, ray.direction) > 0.0) {\n        hit.normal = -hit.normal;\n    }\n",
                    "",
                ),
                ("hit.normal = normalOf(", "hit.normal = -normalOf("),
            ],
        ),
        ("not moved back", &[("return ahead + t0;", "return t0;")]),
    ],
    rewrites: &[&[
        ("as it stands", &[]),
        (
            "from the eye itself",
            &[("float ahead = -dot(far, d);", "float ahead = 0.0;")],
        ),
        (
            "the full quadratic",
            &[(
                "float q = b > 0.0 ? -b - sqrt(disc) : -b + sqrt(disc);\n    float t0 = q == 0.0 ? NO_HIT : c / q;\n    float t1 = a == 0.0 ? NO_HIT : q / a;",
                "float t0 = (-b - sqrt(disc)) / a;\n    float t1 = (-b + sqrt(disc)) / a;",
            )],
        ),
        (
            "z by the whole ray",
            &[(
                "float z0 = o.z + t0 * d.z;",
                "float z0 = far.z + (ahead + t0) * d.z;",
            )],
        ),
        (
            "another frame",
            &[
                (
                    "abs(axis.z) > 0.9 ? vec3(1.0, 0.0, 0.0) : normalize(cross(axis, vec3(0.0, 0.0, 1.0)))",
                    "abs(axis.z) > 0.9 ? vec3(0.0, -1.0, 0.0) : normalize(cross(axis, vec3(0.3, 0.0, 1.0)))",
                ),
                ("1.0 / (radii * radii)", "1.0 / (radii.yxz * radii.yxz)"),
            ],
        ),
        (
            "the frame transposed",
            &[(
                "vec3 d = ray.direction * frame;",
                "vec3 d = transpose(frame) * ray.direction;",
            )],
        ),
        (
            "the discriminant by quarters",
            &[(
                "float disc = b * b - a * c;",
                "float disc = ((2.0 * b) * (2.0 * b) - 4.0 * a * c) / 4.0;",
            )],
        ),
        (
            "the normal by faceforward",
            &[(
                "    if (dot(hit.normal, ray.direction) > 0.0) {\n        hit.normal = -hit.normal;\n    }\n",
                "    hit.normal = faceforward(hit.normal, ray.direction, hit.normal);\n",
            )],
        ),
    ]],
};
