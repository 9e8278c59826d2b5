//! Parallel rays.

use super::Edited;
use super::sphere::SPHERE;
use crate::PARALLEL_RAYS;

pub(super) static EDITED: Edited = Edited {
    exercise: &PARALLEL_RAYS,
    faults: &[
        (
            "rays that part",
            &[(
                "return Ray(0.5 * WIDTH * vec3(x, y, 0.0), vec3(0.0, 0.0, -1.0));",
                "return Ray(vec3(0.0), normalize(vec3(x, y, -2.0)));",
            )],
        ),
        (
            "all from one point",
            &[("0.5 * WIDTH * vec3(x, y, 0.0)", "vec3(0.0)")],
        ),
        (
            "the other way",
            &[("vec3(0.0, 0.0, -1.0));", "vec3(0.0, 0.0, 1.0));")],
        ),
        ("width as half of it", &[("0.5 * WIDTH", "WIDTH")]),
        ("width of another picture", &[("WIDTH = 6.0", "WIDTH = 5.0")]),
        ("aspect missing", &[(" / aspect", "")]),
        (
            "direction not of length 1",
            &[("vec3(0.0, 0.0, -1.0));", "vec3(0.0, 0.0, -2.0));")],
        ),
        (
            "sign of b",
            &[("ray.origin - sphere.center", "sphere.center - ray.origin")],
        ),
        (
            "square root forgotten",
            &[("float root = sqrt(disc);", "float root = disc;")],
        ),
        (
            "half a pixel added",
            &[(
                "fragCoord.x / iResolution.x",
                "(fragCoord.x + 0.5) / iResolution.x",
            )],
        ),
        (
            "last hit instead of the nearest",
            &[
                ("if (t < nearest) {", "if (t < NO_HIT) {"),
                ("nearest = t;", "nearest = min(t, nearest);"),
            ],
        ),
        ("light from behind", &[("LIGHT - point", "point - LIGHT")]),
        ("no ambient light", &[("AMBIENT + vec3(0.9)", "vec3(0.9)")]),
    ],
    rewrites: &[
        SPHERE,
        &[
            (
                "the distance in the plane",
                &[
                    (
                        "float b = dot(f, ray.direction);",
                        "float b = f.z * ray.direction.z;",
                    ),
                    (
                        "float disc = b * b - c;",
                        "float disc = sphere.radius * sphere.radius - dot(f.xy, f.xy);",
                    ),
                ],
            ),
            (
                "the screen in units of its width",
                &[(
                    "Ray cameraRay(…\n}\n",
                    "Ray cameraRay(vec2 p) {\n    vec2 place = (p / iResolution.x - 0.5 * vec2(1.0, iResolution.y / iResolution.x)) * WIDTH;\n    return Ray(vec3(place, 0.0), vec3(0, 0, -1));\n}\n",
                )],
            ),
            (
                "rays that start farther behind",
                &[(
                    "0.5 * WIDTH * vec3(x, y, 0.0)",
                    "vec3(0.5 * WIDTH * vec2(x, y), 1.0)",
                )],
            ),
        ],
    ],
};
