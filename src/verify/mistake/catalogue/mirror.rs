//! Mirrors.

use super::intersection::{DISC, TEXTBOOK};
use super::mistakes;

const BOUNCE: &str = "reflect(ray.direction, hit.normal)";
const DEPTH: &str = "depth < MAX_DEPTH;";

mistakes! {
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
}
