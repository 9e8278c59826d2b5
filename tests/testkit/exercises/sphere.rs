//! Rewrites for every exercise with the course's `intersectSphere`.

use super::Named;

pub(super) const SPHERE: &[Named] = &[
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
];

/// Rewrites for every exercise with the course's `cameraRay`.
pub(super) const CAMERA: &[Named] = &[(
    "the screen in pixels",
    &[(
        "Ray cameraRay(…\n}\n",
        "Ray cameraRay(vec2 p) {\n    vec3 d = vec3(p - 0.5 * iResolution.xy, -iResolution.x);\n    return Ray(vec3(0.0), d / length(d));\n}\n",
    )],
)];
