//! Mistakes where rays go on from a surface: mirrors, glass, and path tracing.

use super::geometry::{DISC, TEXTBOOK};
use super::{Mistake, mistakes};

const BOUNCE: &str = "reflect(ray.direction, hit.normal)";
const DEPTH: &str = "depth < MAX_DEPTH;";

/// Mirrors.
pub(super) static MIRRORS: &[Mistake] = mistakes! {
    "no-reflection": "does not turn reflected rays: they go straight on", [(BOUNCE, "ray.direction")];
    "reflection-sign": "has the reflected direction backwards", [(BOUNCE, "-reflect(ray.direction, hit.normal)")];
    "reflection-without-2": "forgets the 2 in the reflected direction d − 2(d·n)n",
        [(BOUNCE, "normalize(ray.direction - dot(ray.direction, hit.normal) * hit.normal)")],
        [(BOUNCE, "ray.direction - dot(ray.direction, hit.normal) * hit.normal"), (DISC, TEXTBOOK)];
    "reflection-with-4": "has a 4 for the 2 in the reflected direction d − 2(d·n)n",
        [(BOUNCE, "normalize(ray.direction - 4.0 * dot(ray.direction, hit.normal) * hit.normal)")],
        [(BOUNCE, "ray.direction - 4.0 * dot(ray.direction, hit.normal) * hit.normal"), (DISC, TEXTBOOK)];
    "reflection-with-plus": "has d + 2(d·n)n for the reflected direction d − 2(d·n)n",
        [(BOUNCE, "normalize(ray.direction + 2.0 * dot(ray.direction, hit.normal) * hit.normal)")],
        [(BOUNCE, "ray.direction + 2.0 * dot(ray.direction, hit.normal) * hit.normal"), (DISC, TEXTBOOK)];
    "reflection-from-the-eye": "starts reflected rays at the eye", [("ray = Ray(hit.point…,", "ray = Ray(ray.origin,")];
    "reflection-along-the-normal": "reflects every ray along the normal", [(BOUNCE, "hit.normal")];
    "one-reflection-short": "follows one reflection less than the scene has", [(DEPTH, "depth < MAX_DEPTH - 1;")];
    "one-bounce-only": "follows one reflection only", [(DEPTH, "depth < 2;")];
    "two-bounces-only": "follows two reflections only", [(DEPTH, "depth < 3;")];
    "background-after-one-bounce": "shows the background after one reflection, whatever the ray meets then",
        [(DEPTH, "depth < 2;"), ("return vec3(0.0);\n}", "return throughput * background(ray.direction);\n}")];
    "background-after-the-last-bounce": "shows the background after the last reflection, where the scene has black",
        [("return vec3(0.0);\n}", "return throughput * background(ray.direction);\n}")];
    "mirrors-added": "adds the colours of mirrors up, where they should multiply", [("throughput *= hit.color;", "throughput += hit.color;")];
    "mirrors-without-colour": "forgets the mirrors' colour", [("throughput *= hit.color;", "")];
    "last-mirror-only": "keeps the last mirror's colour only, where all should multiply",
        [("throughput *= hit.color;", "throughput = hit.color;")];
};

const ETA: &str = "? 1.0 / hit.ior : hit.ior;";
const REFRACTED: &str = "vec3 refracted = eta * ray.direction + (eta * cosine - beyond) * side;";
const SHARE: &str = "float share = …(eta, cosine, beyond);";

/// Glass.
pub(super) static GLASS: &[Mistake] = mistakes! {
    "index-upside-down": "has the index of refraction the other way up", [(ETA, "? hit.ior : 1.0 / hit.ior;")];
    "index-always-entering": "takes every ray for one that enters the glass", [(ETA, "? 1.0 / hit.ior : 1.0 / hit.ior;")];
    "normal-not-turned-inside": "does not turn the normal where a ray leaves the glass",
        [
            ("float cosine = -dot(ray.direction, side);", "float cosine = -dot(ray.direction, hit.normal);"),
            (REFRACTED, "vec3 refracted = eta * ray.direction + (eta * cosine - beyond) * hit.normal;")
        ];
    "refraction-without-normal": "forgets the part of the refracted direction along the normal",
        [(REFRACTED, "vec3 refracted = normalize(eta * ray.direction);")],
        [(REFRACTED, "vec3 refracted = eta * ray.direction;"), (DISC, TEXTBOOK)];
    "refraction-sign": "has the wrong sign in Snell's law",
        [(REFRACTED, "vec3 refracted = normalize(eta * ray.direction + (eta * cosine + beyond) * side);")],
        [(REFRACTED, "vec3 refracted = eta * ray.direction + (eta * cosine + beyond) * side;"), (DISC, TEXTBOOK)];
    "no-refraction": "does not bend rays in glass: they go straight on", [(REFRACTED, "vec3 refracted = ray.direction;")];
    "glass-reflects-nothing": "lets glass reflect nothing", [(SHARE, "float share = 0.0;")];
    "glass-reflects-half": "lets glass reflect half of the light at every angle", [(SHARE, "float share = 0.5;")];
    "glass-reflects-4-percent": "lets glass reflect as much at every angle as straight on",
        [(SHARE, "float share = (1.0 - eta) * (1.0 - eta) / ((1.0 + eta) * (1.0 + eta));")];
    "one-polarisation": "counts one polarisation only, where Fresnel's equations take the mean of two",
        [("return 0.5 * (across * across + along * along);", "return across * across;")],
        [("return 0.5 * (across * across + along * along);", "return along * along;")];
    "shares-swapped": "has the shares of reflected and refracted light exchanged",
        [("throughput * (1.0 - share)", "throughput * SHARE"), ("throughput * share", "throughput * (1.0 - share)"), ("throughput * SHARE", "throughput * share")];
    "shares-forgotten": "adds up reflected and refracted light without their shares",
        [("throughput * (1.0 - share)", "throughput"), ("throughput * share", "throughput")];
    "glass-without-colour": "forgets the colour of the glass",
        [("branch.throughput * hit.color;\n        vec3 side", "branch.throughput * (hit.model == GLASS ? vec3(1.0) : hit.color);\n        vec3 side")],
        [("branch.throughput * hit.color;\n        vec3 side", "branch.throughput * (hit.model == SCHLICK ? vec3(1.0) : hit.color);\n        vec3 side")];
    "no-total-reflection": "loses the rays that glass reflects totally",
        [("// Total reflection.\n            stack[top++] = Branch(mirrored, throughput, branch.depth + 1);", "")];
};

const LIGHT_WEIGHT: &str = "* weight(density, other) / density;";
const EMITTER_SHARE: &str = "share = weight(density, …);\n";
const EMITTER: &str = "min(int(random() * float(EMITTERS)), EMITTERS - 1);";
const THROUGHPUT: &str = "throughput *= … * cosine / density;";
const LAST: &str = "if (depth == MAX_DEPTH) {";
const HIDDEN: &str = "if (cosine <= 0.0 || inShadow(…) {";
const DENSITY: &str = "return max(dot(hit.normal, light), 0.0) / PI;";
const COSINE_SAMPLE: &str = "return around(hit.normal, sqrt(1.0 - u), v);";
const LIGHT_SAMPLE: &str = "color += throughput * sampleLight(hit, -ray.direction);";
const CONE: &str = "(2.0 * PI * coneDepth(point, emitter) * float(EMITTERS))";

/// Path tracing.
pub(super) static PATHS: &[Mistake] = mistakes! {
    "light-not-weighted": "does not weigh the light of the emitters that it draws, so that it counts twice", [(LIGHT_WEIGHT, "/ density;")];
    "found-light-not-weighted": "does not weigh the light of the emitters that it finds by chance, so that it counts twice",
        [(EMITTER_SHARE, "share = 1.0;\n")];
    "light-not-weighted-at-all": "weighs no light, so that all counts twice", [(LIGHT_WEIGHT, "/ density;"), (EMITTER_SHARE, "share = 1.0;\n")];
    "emitters-not-drawn": "does not count the light of the emitters that it draws",
        [(LIGHT_SAMPLE, "sampleLight(hit, -ray.direction);")];
    "found-light-not-counted": "does not count the light of the emitters that it finds by chance", [(EMITTER_SHARE, "share = 0.0;\n")];
    "number-of-emitters-forgotten": "forgets in the density that there are several emitters",
        [(CONE, "(2.0 * PI * coneDepth(point, emitter))")];
    "first-emitter-only": "draws the first emitter always", [(EMITTER, "min(int(0.0 * random()), EMITTERS - 1);")];
    "density-of-a-sphere": "has the density of a whole sphere for diffuse directions", [(DENSITY, "return 1.0 / (4.0 * PI);")];
    "density-of-a-half-space": "has the density of a half space for diffuse directions", [(DENSITY, "return 1.0 / (2.0 * PI);")];
    "directions-uniform": "draws diffuse directions uniformly over the half space, though their density is said to be the cosine's",
        [(COSINE_SAMPLE, "return around(hit.normal, 1.0 - u, v);")];
    "lobe-around-the-normal": "draws glossy directions around the normal, not around the reflected direction",
        [("return around(reflect(-view, hit.normal), pow(", "return around(hit.normal, pow(")];
    "exponent-without-1": "forgets the 1 in the exponent by which glossy directions are drawn",
        [("1.0 / (hit.exponent + 1.0)", "1.0 / hit.exponent")];
    "path-cosine-forgotten": "forgets the cosine where a path goes on", [(THROUGHPUT, "throughput *= … / density;")];
    "density-forgotten": "does not divide by the density where a path goes on", [(THROUGHPUT, "throughput *= … * cosine;")];
    "path-one-segment-short": "follows paths for one segment less than the scene has",
        [("depth <= MAX_DEPTH;", "depth <= MAX_DEPTH - 1;"), (LAST, "if (depth == MAX_DEPTH - 1) {")];
    "light-one-segment-too-far": "looks for light at the end of the last segment, too", [(LAST, "if (false) {")];
    "throughput-not-kept": "forgets what surfaces before the last have absorbed", [(THROUGHPUT, "throughput = … * cosine / density;")];
    "emitters-through-everything": "sees emitters through everything", [(HIDDEN, "if (cosine <= 0.0) {")];
    "pi-forgotten-in-paths": "forgets to divide the BRDF by π where light is looked for, or where a path goes on",
        [("* hit.color / PI * cosine / density;", "* hit.color * cosine / density;")],
        [("throughput *= hit.color / PI * cosine", "throughput *= hit.color * cosine")];
};
