//! Glass.

use super::intersection::{DISC, TEXTBOOK};
use super::mistakes;

const ETA: &str = "? 1.0 / hit.ior : hit.ior;";
const REFRACTED: &str = "vec3 refracted = eta * ray.direction + (eta * cosine - beyond) * side;";
const SHARE: &str = "float share = …(eta, cosine, beyond);";

mistakes! {
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
}
