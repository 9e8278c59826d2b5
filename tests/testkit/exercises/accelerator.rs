//! Hundreds of spheres in a grid.

use super::Edited;
use crate::ACCELERATOR;

pub(super) static EDITED: Edited = Edited {
    exercise: &ACCELERATOR,
    faults: &[
        (
            "only the first cell",
            &[("i < CELLS.x + CELLS.y + CELLS.z", "i < 1")],
        ),
        ("too few steps", &[("i < CELLS.x + CELLS.y + CELLS.z", "i < 6")]),
        (
            "strides without their sign",
            &[("ivec3(sign(ray.direction))", "ivec3(1)")],
        ),
        (
            "steps of the wrong size",
            &[("SPACING / abs(ray.direction)", "1.0 / abs(ray.direction)")],
        ),
        (
            "the farther wall first",
            &[(
                "if (next.x < next.y && next.x < next.z)",
                "if (next.x > next.y && next.x > next.z)",
            )],
        ),
        (
            "cells along x alone",
            &[("} else if (next.y < next.z) {", "} else if (false) {")],
        ),
        (
            "x and y swapped in the number",
            &[(
                "cell.x + CELLS.x * (cell.y + CELLS.y * cell.z)",
                "cell.y + CELLS.y * (cell.x + CELLS.x * cell.z)",
            )],
        ),
        ("another seed", &[("SEED = 7u", "SEED = 8u")]),
        (
            "spheres in the middle of their cells",
            &[("radius + room * vec3(x, y, z)", "radius + room * 0.5")],
        ),
        ("room of the whole cell", &[("SPACING - 2.0 * radius", "SPACING")]),
        (
            "radii all alike",
            &[("mix(0.1, 0.3, random())", "0.0 * random() + 0.2")],
        ),
        (
            "coordinates drawn backwards",
            &[("vec3(x, y, z)", "vec3(z, y, x)")],
        ),
        (
            "colours drawn backwards",
            &[("0.8 * vec3(r, g, b)", "0.8 * vec3(b, g, r)")],
        ),
        (
            "hash without its shift",
            &[("return (word >> 22u) ^ word;", "return word;")],
        ),
        (
            "no shadow",
            &[(
                "if (hitScene(Ray(origin, normalize(LIGHT - origin))).t == NO_HIT) {",
                "{",
            )],
        ),
        (
            "shadow rays from the grid's edge",
            &[("max(into.z, 0.0)", "max(into.z, 1.5)")],
        ),
    ],
    rewrites: &[&[
        ("as it stands", &[]),
        (
            "every cell, one after the other",
            &[(
                "Intersection hitScene(…\n}\n\nRay",
                "Intersection hitScene(Ray ray) {\n    Intersection hit = Intersection(NO_HIT, ivec3(-1));\n    for (int z = 0; z < CELLS.z; z++) {\n        for (int y = 0; y < CELLS.y; y++) {\n            for (int x = 0; x < CELLS.x; x++) {\n                float t = intersectSphere(ray, sphereIn(ivec3(x, y, z)));\n                if (t < hit.t) hit = Intersection(t, ivec3(x, y, z));\n            }\n        }\n    }\n    return hit;\n}\n\nRay",
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
            "vectors of draws",
            &[(
                "float x = random();\n    float y = random();\n    float z = random();\n    return Sphere(CORNER + SPACING * vec3(cell) + radius + room * vec3(x, y, z), radius);",
                "vec3 place;\n    place.x = random();\n    place.y = random();\n    place.z = random();\n    return Sphere(CORNER + vec3(cell) * SPACING + (radius + room * place), radius);",
            )],
        ),
        (
            "hash by bit fields",
            &[(
                "return float(state >> 8u) / 16777216.0;",
                "return float(state >> 8u) * exp2(-24.0);",
            )],
        ),
        (
            "a wider box",
            &[(
                "max(max(into.x, into.y), max(into.z, 0.0))",
                "max(0.0, max(into.z, max(into.x, into.y)))",
            )],
        ),
        (
            "steps as vectors",
            &[(
                "cell.x += stride.x;\n            next.x += step.x;",
                "cell += ivec3(stride.x, 0, 0);\n            next += vec3(step.x, 0.0, 0.0);",
            )],
        ),
    ]],
};
