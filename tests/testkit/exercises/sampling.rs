//! Two-dimensional figures.

use super::Edited;
use crate::SAMPLING;

pub(super) static EDITED: Edited = Edited {
    exercise: &SAMPLING,
    faults: &[
        ("one sample", &[("SAMPLES = 10", "SAMPLES = 1")]),
        (
            "samples all at the corner",
            &[
                (
                    "fragCoord.x + random() - 0.5",
                    "fragCoord.x + 0.0 * random() - 0.5",
                ),
                (
                    "fragCoord.y + random() - 0.5",
                    "fragCoord.y + 0.0 * random() - 0.5",
                ),
            ],
        ),
        (
            "samples over two pixels",
            &[
                (
                    "fragCoord.x + random() - 0.5",
                    "fragCoord.x + 2.0 * random() - 1.0",
                ),
                (
                    "fragCoord.y + random() - 0.5",
                    "fragCoord.y + 2.0 * random() - 1.0",
                ),
            ],
        ),
        (
            "jitter not centred",
            &[("fragCoord.x + random() - 0.5", "fragCoord.x + random()")],
        ),
        (
            "sum not divided by all",
            &[("color / float(SAMPLES)", "color / float(SAMPLES - 1)")],
        ),
        ("radius not squared", &[("radius * radius", "radius")]),
        (
            "disk inside out",
            &[(
                "return dot(d, d) - radius * radius",
                "return radius * radius - dot(d, d)",
            )],
        ),
        (
            "wave above",
            &[(
                "return p.y - height -",
                "return height + 2.0 * amplitude * 0.0 - p.y +",
            )],
        ),
        (
            "wave of frequencies in turns",
            &[("sin(frequency * p.x)", "sin(6.2831853 * frequency * p.x)")],
        ),
        ("cosine wave", &[("sin(frequency * p.x)", "cos(frequency * p.x)")]),
        (
            "heart upside down",
            &[("q.x * q.x * q.y * q.y * q.y", "-q.x * q.x * q.y * q.y * q.y")],
        ),
        ("ring not cubed", &[("ring * ring * ring", "ring")]),
        (
            "disk over heart",
            &[
                (
                    "    if (heart(p, vec2(0.35, 0.08), 0.25) < 0.0) {\n        return vec3(0.85, 0.1, 0.2);\n    }\n",
                    "",
                ),
                (
                    "    if (wave(",
                    "    if (heart(p, vec2(0.35, 0.08), 0.25) < -0.1) {\n        return vec3(0.85, 0.1, 0.2);\n    }\n    if (wave(",
                ),
            ],
        ),
        ("aspect missing", &[(" / aspect", "")]),
        (
            "wave in front of the sun",
            &[(
                "    if (disk(p, vec2(-0.45, 0.15), 0.28) < 0.0) {\n        return vec3(1.0, 0.8, 0.2);\n    }\n    if (wave(p, -0.2, 0.1, 9.0) < 0.0) {\n        return vec3(0.1, 0.35, 0.6);\n    }",
                "    if (wave(p, -0.2, 0.1, 9.0) < 0.0) {\n        return vec3(0.1, 0.35, 0.6);\n    }\n    if (disk(p, vec2(-0.45, 0.15), 0.28) < 0.0) {\n        return vec3(1.0, 0.8, 0.2);\n    }",
            )],
        ),
    ],
    rewrites: &[&[
        ("as it stands", &[]),
        (
            "the disk by distance",
            &[("return dot(d, d) - radius * radius", "return length(d) - radius")],
        ),
        (
            "the wave by comparing",
            &[(
                "return p.y - height - amplitude * sin(frequency * p.x)",
                "return p.y < height + amplitude * sin(p.x * frequency) ? -1.0 : 1.0",
            )],
        ),
        (
            "the heart by pow",
            &[(
                "ring * ring * ring - q.x * q.x * q.y * q.y * q.y",
                "sign(ring) * pow(abs(ring), 3.0) - sign(q.y) * q.x * q.x * pow(abs(q.y), 3.0)",
            )],
        ),
        (
            "painted from back to front",
            &[(
                "    if (heart(…return vec3(0.75, 0.85, 0.95);",
                "    vec3 c = vec3(0.75, 0.85, 0.95);\n    if (wave(p, -0.2, 0.1, 9.0) < 0.0) c = vec3(0.1, 0.35, 0.6);\n    if (disk(p, vec2(-0.45, 0.15), 0.28) < 0.0) c = vec3(1.0, 0.8, 0.2);\n    if (heart(p, vec2(0.35, 0.08), 0.25) < 0.0) c = vec3(0.85, 0.1, 0.2);\n    return c;",
            )],
        ),
        (
            "painted by mix and step",
            &[(
                "    if (heart(…return vec3(0.75, 0.85, 0.95);",
                "    vec3 c = vec3(0.75, 0.85, 0.95);\n    c = mix(vec3(0.1, 0.35, 0.6), c, step(0.0, wave(p, -0.2, 0.1, 9.0)));\n    c = mix(vec3(1.0, 0.8, 0.2), c, step(0.0, disk(p, vec2(-0.45, 0.15), 0.28)));\n    return mix(vec3(0.85, 0.1, 0.2), c, step(0.0, heart(p, vec2(0.35, 0.08), 0.25)));",
            )],
        ),
        (
            "a running mean",
            &[
                (
                    "color += figures(vec2(x, y));",
                    "color = mix(color, figures(vec2(x, y)), 1.0 / float(i + 1));",
                ),
                ("color / float(SAMPLES)", "color"),
            ],
        ),
        (
            "the screen in units of its width",
            &[(
                "float x = fx / iResolution.x * 2.0 - 1.0;\n        float y = (fy / iResolution.y * 2.0 - 1.0) / aspect;",
                "vec2 uv = (2.0 * vec2(fx, fy) - iResolution.xy) / iResolution.x;\n        float x = uv.x, y = uv.y;",
            )],
        ),
    ]],
};
