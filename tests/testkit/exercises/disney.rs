//! Burley's BRDF.

use super::Edited;
use super::sphere::{CAMERA, SPHERE};
use crate::DISNEY;

pub(super) static EDITED: Edited = Edited {
    exercise: &DISNEY,
    faults: &[
        (
            "a diffuse ball",
            &[(
                "LIGHT_COLOR * disney(material, toLight, view, normal) * cosine",
                "LIGHT_COLOR * material.color / PI * cosine",
            )],
        ),
        (
            "cosine forgotten",
            &[(
                "disney(material, toLight, view, normal) * cosine",
                "disney(material, toLight, view, normal)",
            )],
        ),
        (
            "view the wrong way",
            &[(
                "shade(point, normal, -ray.direction,",
                "shade(point, normal, ray.direction,",
            )],
        ),
        (
            "roughness not squared",
            &[
                ("square(m.roughness) / aspect", "m.roughness / aspect"),
                ("square(m.roughness) * aspect", "m.roughness * aspect"),
            ],
        ),
        (
            "tangents swapped",
            &[("dot(x, middle), dot(y, middle)", "dot(y, middle), dot(x, middle)")],
        ),
        (
            "anisotropy forgotten",
            &[("sqrt(1.0 - 0.9 * m.anisotropic)", "1.0")],
        ),
        (
            "diffuse under metal",
            &[("(base + sheen) * (1.0 - m.metallic)", "(base + sheen)")],
        ),
        (
            "metal of no colour",
            &[("mix(dielectric, m.color, m.metallic)", "dielectric")],
        ),
        (
            "Fresnel to the power of four",
            &[("return square(square(m)) * m;", "return square(square(m));")],
        ),
        (
            "Fresnel by the half angle of the normal",
            &[("float fH = schlick(lH)", "float fH = schlick(nH)")],
        ),
        (
            "no subsurface",
            &[("mix(diffuse, subsurface, m.subsurface)", "diffuse")],
        ),
        ("no clear coat", &[("f * d * g + coat", "f * d * g")]),
        (
            "coat of one lobe with the base",
            &[(
                "berry(nH, mix(0.1, 0.001, m.clearcoatGloss))",
                "trowbridgeReitz(nH, dot(x, middle), dot(y, middle), 0.25, 0.25)",
            )],
        ),
        (
            "shadowing squared",
            &[(
                "smith(nL, alpha) * smith(nV, alpha)",
                "square(smith(nL, alpha) * smith(nV, alpha))",
            )],
        ),
        (
            "pi forgotten in the base",
            &[("m.color / PI * mix(", "m.color * mix(")],
        ),
        ("no shadow", &[("if (!inShadow(point, normal)) {", "{")]),
    ],
    rewrites: &[
        SPHERE,
        CAMERA,
        &[
            (
                "Schlick's weight by pow",
                &[("return square(square(m)) * m;", "return pow(m, 5.0);")],
            ),
            (
                "tangents by the cross product",
                &[(
                    "normalize(vec3(normal.z, 0.0, -normal.x))",
                    "normalize(cross(vec3(0.0, 1.0, 0.0), normal))",
                )],
            ),
            (
                "the cosine of the half angle by its own formula",
                &[(
                    "float lH = dot(light, middle);",
                    "float lH = sqrt(0.5 * (1.0 + dot(light, view)));",
                )],
            ),
            (
                "shadowing by the tangent",
                &[(
                    "return 1.0 / (cosine + sqrt(a2 + c2 - a2 * c2));",
                    "float t2 = (1.0 - c2) / c2;\n    return 1.0 / (cosine * (1.0 + sqrt(1.0 + a2 * t2)));",
                )],
            ),
        ],
    ],
};
