//! Motion by frame and time.

use super::Edited;
use super::sphere::{CAMERA, SPHERE};
use crate::ANIMATION;

pub(super) static EDITED: Edited = Edited {
    exercise: &ANIMATION,
    faults: &[
        (
            "turned the other way",
            &[("s * cross(axis, v)", "s * cross(v, axis)")],
        ),
        (
            "Rodrigues without its last term",
            &[(" + (1.0 - c) * dot(axis, v) * axis", "")],
        ),
        ("angle in turns", &[("TAU * fract(turns)", "fract(turns)")]),
        (
            "angle in degrees",
            &[("TAU * fract(turns)", "360.0 * fract(turns)")],
        ),
        (
            "about the origin",
            &[("return pivot + rotate(p - pivot,", "return rotate(p,")],
        ),
        (
            "pivot not added back",
            &[("return pivot + rotate(", "return rotate(")],
        ),
        (
            "moon not carried along",
            &[(
                "return year(rotateAbout(p, vec3(2.0",
                "return (rotateAbout(p, vec3(2.0",
            )],
        ),
        (
            "carried along first",
            &[(
                "return year(rotateAbout(p, vec3(2.0, 0.2, -7.0), vec3(0.0, 0.8, 0.6), iTime / 2.0));",
                "return rotateAbout(year(p), vec3(2.0, 0.2, -7.0), vec3(0.0, 0.8, 0.6), iTime / 2.0);",
            )],
        ),
        (
            "axis not of length 1",
            &[("vec3(0.0, 0.8, 0.6)", "vec3(0.0, 1.0, 1.0)")],
        ),
        (
            "axis upright",
            &[("vec3(0.0, 0.96, -0.28)", "vec3(0.0, 1.0, 0.0)")],
        ),
        (
            "frames instead of time",
            &[("iTime / 8.0", "float(iFrame) / 8.0")],
        ),
        ("time by the wrong period", &[("iTime / 8.0", "iTime / 4.0")]),
        (
            "lamp at rest",
            &[(
                "lamp = retrograde(vec3(3.0, 5.0, -4.0))",
                "lamp = vec3(3.0, 5.0, -4.0)",
            )],
        ),
        (
            "frames divided as integers",
            &[
                ("float(iFrame) / 60.0", "float(iFrame / 60)"),
                ("iTime / 2.0", "float(int(iTime) / 2)"),
            ],
        ),
    ],
    rewrites: &[
        SPHERE,
        CAMERA,
        &[
            ("no fract", &[("TAU * fract(turns)", "TAU * turns")]),
            (
                "Rodrigues by parallel and perpendicular",
                &[(
                    "return c * v + s * cross(axis, v) + (1.0 - c) * dot(axis, v) * axis;",
                    "vec3 along = dot(axis, v) * axis;\n    return along + c * (v - along) + s * cross(axis, v);",
                )],
            ),
            (
                "a matrix",
                &[(
                    "return c * v + s * cross(axis, v) + (1.0 - c) * dot(axis, v) * axis;",
                    "vec3 a = axis;\n    mat3 k = mat3(0.0, a.z, -a.y, -a.z, 0.0, a.x, a.y, -a.x, 0.0);\n    return (mat3(1.0) + s * k + (1.0 - c) * k * k) * v;",
                )],
            ),
            (
                "the year about y by hand",
                &[(
                    "return rotateAbout(p, SUN, vec3(0.0, 1.0, 0.0), iTime / 8.0);",
                    "float a = TAU * iTime / 8.0;\n    vec3 q = p - SUN;\n    return SUN + vec3(cos(a) * q.x + sin(a) * q.z, q.y, cos(a) * q.z - sin(a) * q.x);",
                )],
            ),
            (
                "half angles",
                &[(
                    "float c = cos(angle);\n    float s = sin(angle);",
                    "float h = tan(0.5 * angle);\n    float c = (1.0 - h * h) / (1.0 + h * h);\n    float s = 2.0 * h / (1.0 + h * h);",
                )],
            ),
        ],
    ],
};
