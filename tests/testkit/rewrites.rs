//! Equivalent rewrites of the course's shaders, which must stay correct.

use crate::exercises::EDITED;
use crate::{COMPLEX_SCENE, EXERCISES, Edit, Exercise, MANY_OBJECTS, REFLECTIONS, SHADING, SPHERE};

/// The name of the rewrite, the exercises that it applies to, and the edits.
pub type Rewrite = (&'static str, &'static [&'static Exercise], &'static [Edit]);

const ALL: &[&Exercise] = &EXERCISES;
/// The exercises without secondary rays.
const CAMERA_ONLY: &[&Exercise] = &[&SPHERE, &SHADING, &COMPLEX_SCENE];

const B: &str = "float b = dot(f, ray.direction);";
const C: &str = "float c = dot(f, f) - sphere.radius * sphere.radius;";
const DISC: &str = "float disc = b * b - c;";
const NEAR: &str = "float t = -b - root;";
const FAR: &str = "t = -b + root;";

// For directions of any length.
const B_ANY: &str = "float a = dot(ray.direction, ray.direction);\n    float b = dot(f, ray.direction);";
const DISC_ANY: &str = "float disc = b * b - a * c;";
const NEAR_ANY: &str = "float t = (-b - root) / a;";
const FAR_ANY: &str = "t = (-b + root) / a;";

// The tests of the two roots.
const NEAR_TEST: &str = "- root;\n        if (t > 0.00001)";
const FAR_TEST: &str = "+ root;\n        if (t > 0.00001)";

const CAMERA_RAY: &str = "Ray cameraRay(…\n}\n";
const UNIT: &str = "normalize(vec3(x, y, SCREEN_DEPTH))";
const NOT_UNIT: &str = "vec3(x, y, SCREEN_DEPTH)";

/// The rewrites of the first exercises.
pub static REWRITES: &[Rewrite] = &[
    // Every exercise.
    ("as it stands", ALL, &[]),
    (
        "the full quadratic",
        ALL,
        &[
            (
                B,
                "float a = dot(ray.direction, ray.direction);\n    float b = 2.0 * dot(f, ray.direction);",
            ),
            (DISC, "float disc = b * b - 4.0 * a * c;"),
            (NEAR, "float t = (-b - root) / (2.0 * a);"),
            (FAR, "t = (-b + root) / (2.0 * a);"),
        ],
    ),
    (
        "stable roots",
        ALL,
        &[
            (
                NEAR,
                "float q = b > 0.0 ? -b - root : -b + root;\n        float t = min(q, c / q);",
            ),
            (FAR, "t = max(q, c / q);"),
        ],
    ),
    (
        "the centre projected, by Pythagoras",
        ALL,
        &[
            (
                "vec3 f = ray.origin - sphere.center;",
                "vec3 toCenter = sphere.center - ray.origin;",
            ),
            (B, "float along = dot(toCenter, ray.direction);"),
            (C, "float aside = dot(toCenter, toCenter) - along * along;"),
            (DISC, "float disc = sphere.radius * sphere.radius - aside;"),
            (NEAR, "float t = along - root;"),
            (FAR, "t = along + root;"),
        ],
    ),
    (
        "the centre projected, by its distance",
        ALL,
        &[
            (
                C,
                "float off = distance(ray.origin - b * ray.direction, sphere.center);",
            ),
            (
                DISC,
                "float disc = (sphere.radius - off) * (sphere.radius + off);",
            ),
        ],
    ),
    (
        "the centre projected, by the cross product",
        ALL,
        &[
            (C, "vec3 off = cross(f, ray.direction);"),
            (DISC, "float disc = pow(sphere.radius, 2.0) - dot(off, off);"),
        ],
    ),
    (
        "an early return for a miss",
        ALL,
        &[("if (disc > 0.0) {", "if (disc < 0.0) return NO_HIT;\n    {")],
    ),
    (
        "the screen in units of its width",
        ALL,
        &[(
            CAMERA_RAY,
            "Ray cameraRay(vec2 p) {
                vec2 uv = (2.0 * p - iResolution.xy) / iResolution.x;
                return Ray(vec3(0), normalize(vec3(uv, SCREEN_DEPTH)));
            }\n",
        )],
    ),
    (
        "the screen in pixels",
        ALL,
        &[(
            CAMERA_RAY,
            "Ray cameraRay(vec2 p) {
                vec3 eye = vec3(0.0, 0.0, 0.0);
                vec3 d = vec3(p - 0.5 * iResolution.xy, -iResolution.x);
                return Ray(eye, d / length(d));
            }\n",
        )],
    ),
    (
        "the screen at 1, half as large, by mix",
        ALL,
        &[(
            CAMERA_RAY,
            "Ray cameraRay(vec2 p) {
                vec2 half_size = vec2(1.0, iResolution.y / iResolution.x) / 2.0;
                vec2 uv = mix(-half_size, half_size, p / iResolution.xy);
                vec3 d = vec3(uv, -1.0);
                return Ray(vec3(0.0), d * inversesqrt(dot(d, d)));
            }\n",
        )],
    ),
    (
        "macros for constants",
        ALL,
        &[
            ("const float SCREEN_DEPTH = -2.0;", "#define SCREEN_DEPTH (-2.)"),
            ("const float NO_HIT = 1.0e6;", "#define NO_HIT 1e6"),
        ],
    ),
    // Only for exercises without secondary rays.
    (
        "no far root for an eye outside",
        CAMERA_ONLY,
        &[(
            "        t = -b + root;\n        if (t > 0.00001) {\n            return t;\n        }\n",
            "",
        )],
    ),
    (
        "t > 0.0",
        CAMERA_ONLY,
        &[
            (NEAR_TEST, "- root;\n        if (t > 0.0)"),
            (FAR_TEST, "+ root;\n        if (t > 0.0)"),
        ],
    ),
    (
        "a direction of any length",
        &[&SHADING, &COMPLEX_SCENE],
        &[
            (UNIT, NOT_UNIT),
            (B, B_ANY),
            (DISC, DISC_ANY),
            (NEAR, NEAR_ANY),
            (FAR, FAR_ANY),
        ],
    ),
    // One sphere.
    (
        "a direction of any length",
        &[&SPHERE],
        &[
            (UNIT, NOT_UNIT),
            (B, B_ANY),
            (DISC, DISC_ANY),
            (NEAR, NEAR_ANY),
            (FAR, FAR_ANY),
            (
                "dot(ray.direction, normal)",
                "dot(normalize(ray.direction), normal)",
            ),
        ],
    ),
    (
        "the angle from outside",
        &[&SPHERE],
        &[(
            "abs(dot(ray.direction, normal))",
            "max(-dot(ray.direction, normal), 0.0)",
        )],
    ),
    (
        "colour by components",
        &[&SPHERE],
        &[("vec4(color, 1.0)", "vec4(color.x, color.y, 0, 1)")],
    ),
    (
        "loose variables, all in mainImage",
        &[&SPHERE],
        &[
            ("struct Ray {…}\n\nvoid", "void"),
            (
                "Sphere sphere =…\n}\n",
                "vec2 uv = fragCoord / iResolution.xy * 2. - 1.;
                uv.y *= iResolution.y / iResolution.x;
                vec3 d = normalize(vec3(uv, -2.)), c = vec3(0, 0, -6);
                float r = 1.5, b = dot(c, d), disc = b * b - dot(c, c) + r * r;
                fragColor = vec4(0, 0, 0, 1);
                if (disc > 0.) {
                    vec3 n = ((b - sqrt(disc)) * d - c) / r;
                    fragColor.rg = vec2(abs(dot(d, n)));
                }
            }\n",
            ),
        ],
    ),
    (
        "the cosine without the normal",
        &[&SPHERE],
        &[(
            "vec3 hitPoint =…abs(dot(ray.direction, normal));",
            "vec3 f = ray.origin - sphere.center;
            float b = dot(f, ray.direction);
            color = sphere.color * sqrt(1.0 - (dot(f, f) - b * b) / (sphere.radius * sphere.radius));",
        )],
    ),
    (
        "the normal by the radius",
        &[&SPHERE],
        &[(
            "normalize(hitPoint - sphere.center)",
            "(hitPoint - sphere.center) * (1.0 / sphere.radius)",
        )],
    ),
    (
        "an intersection that tells and hands out",
        &[&SPHERE],
        &[
            (
                "float intersectSphere(Ray ray, Sphere sphere) {",
                "bool meets(in Ray ray, in Sphere sphere, out float t) {",
            ),
            (NEAR, "t = -b - root;"),
            (
                "return t;\n        }\n        t =",
                "return true;\n        }\n        t =",
            ),
            ("return t;", "return true;"),
            ("return NO_HIT;", "return false;"),
            (
                "float t = intersectSphere(ray, sphere);\n    if (t < NO_HIT)",
                "float t;\n    if (meets(ray, sphere, t))",
            ),
        ],
    ),
    // Shading.
    (
        "the normal by normalize",
        &[&SHADING],
        &[(
            "(hitPoint - sphere.center) / sphere.radius",
            "normalize(hitPoint - sphere.center)",
        )],
    ),
    (
        "the normal by distance()",
        &[&SHADING],
        &[(
            "(hitPoint - sphere.center) / sphere.radius",
            "(hitPoint - sphere.center) / distance(sphere.center, hitPoint)",
        )],
    ),
    (
        "lights unrolled and in the other order",
        &[&SHADING],
        &[(
            "for (int i = 0; i < 2; i++) {…    }\n    return",
            "vec3 L = lights[1].position - point;
            sum += clamp(dot(normal, L) / length(L), 0.0, 1.0) * lights[1].color;
            L = lights[0].position - point;
            sum += clamp(dot(normal, L) / length(L), 0.0, 1.0) * lights[0].color;
            return",
        )],
    ),
    (
        "ambient added last, colour multiplied in",
        &[&SHADING],
        &[
            ("vec3 sum = AMBIENT;", "vec3 sum = vec3(0.0);"),
            ("sum += lights[i].color *", "sum += color * lights[i].color *"),
            ("return color * sum;", "return sum + AMBIENT * color;"),
        ],
    ),
    (
        "if instead of max",
        &[&SHADING],
        &[(
            "sum += lights[i].color * max(dot(normal, toLight), 0.0);",
            "float cosine = dot(normal, toLight);\n        if (cosine <= 0.0) continue;\n        sum += lights[i].color * cosine;",
        )],
    ),
    (
        "lights in a constant array",
        &[&SHADING],
        &[
            (
                "Light lights[2];\n\nvoid makeScene() {…}\n",
                "const Light lights[2] = Light[2](
                    Light(vec3(5.0, 5.0, 0.0), vec3(0.8, 0.8, 0.7)),
                    Light(vec3(-6.0, 1.0, -2.0), vec3(0.1, 0.1, 0.3))
                );\n",
            ),
            ("    makeScene();\n", ""),
        ],
    ),
    // Many objects.
    (
        "secondary rays 1e-4 off",
        &[&MANY_OBJECTS],
        &[("0.001 * normal", "1e-4 * normal")],
    ),
    (
        "secondary rays from the surface, t > 0.001",
        &[&MANY_OBJECTS],
        &[
            ("point + 0.001 * normal", "point"),
            (NEAR_TEST, "- root;\n        if (t > 0.001)"),
            (FAR_TEST, "+ root;\n        if (t > 0.001)"),
        ],
    ),
    (
        "secondary rays off along themselves",
        &[&MANY_OBJECTS],
        &[(
            "vec3 origin = point + 0.001 * normal;",
            "vec3 origin = point + 0.001 * normalize(light.position - point);",
        )],
    ),
    (
        "a shadow ray whose t is 1 at the light",
        &[&MANY_OBJECTS],
        &[
            (B, B_ANY),
            (DISC, DISC_ANY),
            (NEAR, NEAR_ANY),
            (FAR, FAR_ANY),
            ("toLight / distance)", "toLight)"),
            ("< distance)", "< 1.0)"),
        ],
    ),
    (
        "spheres in another order",
        &[&MANY_OBJECTS],
        &[
            ("spheres[0] =", "spheres[S] ="),
            ("spheres[2] =", "spheres[0] ="),
            ("spheres[S] =", "spheres[2] ="),
            ("spheres[1] =", "spheres[S] ="),
            ("spheres[6] =", "spheres[1] ="),
            ("spheres[S] =", "spheres[6] ="),
        ],
    ),
    (
        "one loop for the nearest hit, and a flag",
        &[&MANY_OBJECTS],
        &[(
            "Intersection nearestHit(…\n}\n",
            "Intersection nearestHit(Ray ray) {
                Intersection hit = Intersection(NO_HIT, -1, vec3(0.0), vec3(0.0));
                int i = SPHERES;
                while (--i >= 0) {
                    float t = intersectSphere(ray, spheres[i]);
                    bool nearer = t < hit.t;
                    if (!nearer) continue;
                    hit.t = t;
                    hit.sphere = i;
                    hit.point = ray.origin + ray.direction * t;
                    hit.normal = normalize(hit.point - spheres[i].center);
                }
                return hit;
            }\n",
        )],
    ),
    (
        "shadow as a factor",
        &[&MANY_OBJECTS],
        &[(
            "if (cosine > 0.0) {\n…    return spheres",
            "float visible = inShadow(hit.point, hit.normal) ? 0.0 : 1.0;
            sum += light.color * max(cosine, 0.0) * visible;
            return spheres",
        )],
    ),
    (
        "each sample divided",
        &[&MANY_OBJECTS],
        &[
            ("color += trace(", "color += 0.25 * trace("),
            ("color / float(SAMPLES)", "color"),
        ],
    ),
    (
        "a running mean",
        &[&MANY_OBJECTS],
        &[
            (
                "color += trace(cameraRay(vec2(x, y)));",
                "color = mix(color, trace(cameraRay(vec2(x, y))), 1.0 / float(i + 1));",
            ),
            ("color / float(SAMPLES)", "color"),
        ],
    ),
    (
        "the seed set once, the jitter about the centre",
        &[&MANY_OBJECTS],
        &[
            ("float seed;", "float seed = 0.0;"),
            ("    seed = 0.0;\n", ""),
            ("fragCoord.x + random() - 0.5", "(fragCoord.x - 0.5) + random()"),
            ("fragCoord.y + random() - 0.5", "floor(fragCoord.y) + random()"),
        ],
    ),
    (
        "jitter as a vector",
        &[&MANY_OBJECTS],
        &[(
            "float x = fragCoord.x + random()…color += trace(cameraRay(vec2(x, y)));",
            "vec2 place = fragCoord - vec2(0.5);
            place.x += random();
            place.y += random();
            color += trace(cameraRay(place)).rgb;",
        )],
    ),
    // The complex scene.
    (
        "the hierarchy as an array, filled first",
        &[&COMPLEX_SCENE],
        &[
            ("// Right,", "Sphere every[43];\n\n// Right,"),
            (
                "    Intersection hit = Intersection(NO_HIT, parent);\n…    return hit;",
                "    Intersection hit = Intersection(NO_HIT, parent);
                int n = 0;
                every[n++] = parent;
                for (int i = 0; i < 6; i++) every[n++] = childOf(parent, i, frame);
                for (int i = 0; i < 6; i++)
                    for (int j = 0; j < 6; j++) every[n++] = childOf(every[1 + i], j, frame);
                for (int i = 0; i < 43; i++) keepNearest(ray, every[i], hit);
                return hit;",
            ),
        ],
    ),
    (
        "the sides in another order",
        &[&COMPLEX_SCENE],
        &[
            (
                "i / 2 == 0, i / 2 == 1, i / 2 == 2",
                "i % 3 == 0, i % 3 == 1, i % 3 == 2",
            ),
            ("i % 2 == 0 ? axis", "i / 3 == 0 ? axis"),
        ],
    ),
    (
        "the sides by if",
        &[&COMPLEX_SCENE],
        &[(
            "vec3 side(…\n}\n",
            "vec3 side(int i) {
                if (i == 0) return vec3(1, 0, 0);
                if (i == 1) return vec3(-1, 0, 0);
                if (i == 2) return vec3(0, 1, 0);
                if (i == 3) return vec3(0, -1, 0);
                return vec3(0, 0, i == 4 ? 1 : -1);
            }\n",
        )],
    ),
    (
        "turned by a matrix",
        &[&COMPLEX_SCENE],
        &[
            (
                "return vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);",
                "return mat3(c, 0.0, -s, 0.0, 1.0, 0.0, s, 0.0, c) * v;",
            ),
            (
                "6.28318530718 * float(frame) / 240.0",
                "radians(1.5 * float(frame))",
            ),
        ],
    ),
    (
        "one over the radius, to four digits",
        &[&SHADING],
        &[(
            "(hitPoint - sphere.center) / sphere.radius",
            "(hitPoint - sphere.center) * 0.6667",
        )],
    ),
    (
        "constants folded",
        &[&COMPLEX_SCENE],
        &[
            ("parent.radius / SHRINK", "0.35714286 * parent.radius"),
            (
                "(parent.radius + radius) * turn",
                "1.35714286 * parent.radius * turn",
            ),
            (
                "0.5 * (parent.color + sideColor(i))",
                "0.5 * parent.color + 0.25 + 0.2 * side(i)",
            ),
        ],
    ),
    (
        "the nearest returned, not passed along",
        &[&COMPLEX_SCENE],
        &[
            (
                "void keepNearest(…\n}\n",
                "Intersection nearer(Ray ray, Sphere sphere, Intersection hit) {
                    float t = intersectSphere(ray, sphere);
                    if (t >= hit.t) return hit;
                    return Intersection(t, sphere);
                }\n",
            ),
            (
                "    keepNearest(ray, parent, hit);\n    for",
                "    hit = nearer(ray, parent, hit);\n    for",
            ),
            ("keepNearest(ray, child, hit)", "hit = nearer(ray, child, hit)"),
            (
                "keepNearest(ray, childOf(child, j, frame), hit)",
                "hit = nearer(ray, childOf(child, j, frame), hit)",
            ),
        ],
    ),
    (
        "the normal by the radius, colours by components",
        &[&COMPLEX_SCENE],
        &[
            (
                "normalize(point - hit.sphere.center)",
                "(point - hit.sphere.center) / hit.sphere.radius",
            ),
            (
                "color = hit.sphere.color * (AMBIENT + vec3(0.85) * max(dot(normal, toLight), 0.0))",
                "float light = 0.15 + 0.85 * max(0.0, dot(toLight, normal));\n        color = vec3(hit.sphere.color.r * light, hit.sphere.color.gb * light)",
            ),
        ],
    ),
    (
        "the sides by switch",
        &[&COMPLEX_SCENE],
        &[(
            "vec3 side(…\n}\n",
            "vec3 side(int i) {
                vec3 v = vec3(0.0);
                switch (i) {
                    case 0: v.x = 1.0; break;
                    case 1: v.x = -1.0; break;
                    case 2: v.y = 1.0; break;
                    case 3: v.y = -1.0; break;
                    case 4: v.z = 1.0; break;
                    default: v.z = -1.0;
                }
                return v;
            }\n",
        )],
    ),
    // Reflections.
    (
        "reflection spelled out",
        &[&REFLECTIONS],
        &[(
            "reflect(ray.direction, normal)",
            "ray.direction - 2.0 * dot(ray.direction, normal) * normal",
        )],
    ),
    (
        "reflection of the normal turned inward, normalised again",
        &[&REFLECTIONS],
        &[(
            "reflect(ray.direction, normal)",
            "normalize(reflect(ray.direction, -normal))",
        )],
    ),
    (
        "the normal by the radius",
        &[&REFLECTIONS],
        &[(
            "normalize(point - spheres[hit].center)",
            "(point - spheres[hit].center) / spheres[hit].radius",
        )],
    ),
    (
        "epsilon 1e-4",
        &[&REFLECTIONS],
        &[("EPSILON = 0.001", "EPSILON = 1e-4")],
    ),
    (
        "rays off along the normal",
        &[&REFLECTIONS],
        &[
            ("EPSILON = 0.001", "EPSILON = 1e-5"),
            ("Ray(point, reflect", "Ray(point + 0.001 * normal, reflect"),
        ],
    ),
    (
        "the mirror just left is skipped",
        &[&REFLECTIONS],
        &[
            ("EPSILON = 0.001", "EPSILON = 0.0"),
            ("    vec3 throughput", "    int last = -1;\n    vec3 throughput"),
            (
                "            float t = intersect",
                "            if (i == last) continue;\n            float t = intersect",
            ),
            ("throughput *=", "last = hit;\n        throughput *="),
        ],
    ),
    (
        "the sky by mix",
        &[&REFLECTIONS],
        &[(
            "(1.0 - up) * vec3(0.9, 0.5, 0.25) + up * vec3(0.1, 0.2, 0.5)",
            "mix(vec3(0.9, 0.5, 0.25), vec3(0.1, 0.2, 0.5), up)",
        )],
    ),
    (
        "the sky's slope",
        &[&REFLECTIONS],
        &[(
            "float up =…    return",
            "return vec3(0.5, 0.35, 0.375) + direction.y * vec3(-0.4, -0.15, 0.125);\n    float up = 0.0;\n    return",
        )],
    ),
    (
        "colour multiplied along the way",
        &[&REFLECTIONS],
        &[
            ("vec3 color = vec3(0.0)", "vec3 color = vec3(1.0)"),
            (
                "    vec3 throughput = vec3(1.0);\n",
                "    bool escaped = false;\n",
            ),
            (
                "color = throughput * sky(ray.direction)",
                "color *= sky(ray.direction);\n            escaped = true",
            ),
            ("throughput *=", "color *="),
            ("vec4(color, 1.0)", "vec4(escaped ? color : vec3(0.0), 1.0)"),
        ],
    ),
    (
        "a function that returns early",
        &[&REFLECTIONS],
        &[(
            "void mainImage(…\n}\n",
            "vec3 radiance(Ray ray) {
                vec3 throughput = vec3(1.0);
                for (int depth = 0; depth < MAX_DEPTH; ++depth) {
                    float nearest = NO_HIT;
                    Sphere hit;
                    for (int i = SPHERES - 1; i >= 0; --i) {
                        float t = intersectSphere(ray, spheres[i], EPSILON);
                        if (t < nearest) { nearest = t; hit = spheres[i]; }
                    }
                    if (nearest == NO_HIT) return throughput * sky(ray.direction);
                    ray.origin += nearest * ray.direction;
                    ray.direction = reflect(ray.direction, normalize(ray.origin - hit.center));
                    throughput = throughput * hit.color;
                }
                return vec3(0.0);
            }

            void mainImage(out vec4 fragColor, in vec2 fragCoord) {
                makeScene();
                fragColor = vec4(radiance(cameraRay(fragCoord)), 1.0);
            }\n",
        )],
    ),
    (
        "a direction of any length",
        &[&REFLECTIONS],
        &[
            (UNIT, NOT_UNIT),
            (B, B_ANY),
            (DISC, DISC_ANY),
            (NEAR, NEAR_ANY),
            (FAR, FAR_ANY),
            ("sky(ray.direction)", "sky(normalize(ray.direction))"),
        ],
    ),
    (
        "bounces counted down in an endless loop",
        &[&REFLECTIONS],
        &[
            (
                "for (int depth = 0; depth < MAX_DEPTH; depth++) {",
                "int left = MAX_DEPTH;\n    while (true) {",
            ),
            (
                "        float nearest = NO_HIT;",
                "        if (left-- == 0) break;\n        float nearest = NO_HIT;",
            ),
        ],
    ),
];

/// All rewrites, each with its name, exercise and edits: those above and those of the later exercises.
pub fn rewrites() -> impl Iterator<Item = (&'static str, &'static Exercise, &'static [Edit])> {
    let early = REWRITES
        .iter()
        .flat_map(|&(name, exercises, edits)| exercises.iter().map(move |&exercise| (name, exercise, edits)));
    let later = EDITED.iter().flat_map(|edited| {
        let of_exercise = |&(name, edits)| (name, edited.exercise, edits);
        edited.rewrites.iter().copied().flatten().map(of_exercise)
    });
    early.chain(later)
}
