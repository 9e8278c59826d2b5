//! Path tracing.

use super::mistakes;

const LIGHT: &str = "* weight(density, other) / density;";
const SHARE: &str = "share = weight(density, …);\n";
const EMITTER: &str = "min(int(random() * float(EMITTERS)), EMITTERS - 1);";
const THROUGHPUT: &str = "throughput *= … * cosine / density;";
const LAST: &str = "if (depth == MAX_DEPTH) {";
const HIDDEN: &str = "if (cosine <= 0.0 || inShadow(…) {";
const DENSITY: &str = "return max(dot(hit.normal, light), 0.0) / PI;";
const DRAWN: &str = "return around(hit.normal, sqrt(1.0 - u), v);";
const SAMPLED: &str = "color += throughput * sampleLight(hit, -ray.direction);";
const CONE: &str = "(2.0 * PI * coneDepth(point, emitter) * float(EMITTERS))";

mistakes! {
    "light-not-weighted": "does not weigh the light of the emitters that it draws, so that it counts twice", [(LIGHT, "/ density;")];
    "found-light-not-weighted": "does not weigh the light of the emitters that it finds by chance, so that it counts twice",
        [(SHARE, "share = 1.0;\n")];
    "light-not-weighted-at-all": "weighs no light, so that all counts twice", [(LIGHT, "/ density;"), (SHARE, "share = 1.0;\n")];
    "emitters-not-drawn": "does not count the light of the emitters that it draws",
        [(SAMPLED, "sampleLight(hit, -ray.direction);")];
    "found-light-not-counted": "does not count the light of the emitters that it finds by chance", [(SHARE, "share = 0.0;\n")];
    "number-of-emitters-forgotten": "forgets in the density that there are several emitters",
        [(CONE, "(2.0 * PI * coneDepth(point, emitter))")];
    "first-emitter-only": "draws the first emitter always", [(EMITTER, "min(int(0.0 * random()), EMITTERS - 1);")];
    "density-of-a-sphere": "has the density of a whole sphere for diffuse directions", [(DENSITY, "return 1.0 / (4.0 * PI);")];
    "density-of-a-half-space": "has the density of a half space for diffuse directions", [(DENSITY, "return 1.0 / (2.0 * PI);")];
    "directions-uniform": "draws diffuse directions uniformly over the half space, though their density is said to be the cosine's",
        [(DRAWN, "return around(hit.normal, 1.0 - u, v);")];
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
}
