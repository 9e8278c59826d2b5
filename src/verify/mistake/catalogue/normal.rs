//! Normals of spheres.

use super::intersection::{DISC, TEXTBOOK};
use super::mistakes;

const NORMAL: &str = "normalize(hit.point - spheres[i].center)";

mistakes! {
    "normal-not-normalised": "does not normalise normals",
        [(NORMAL, "(hit.point - spheres[i].center)")],
        [(NORMAL, "(hit.point - spheres[i].center)"), (DISC, TEXTBOOK)];
    "normal-inwards": "has normals that point into the spheres", [(NORMAL, "normalize(spheres[i].center - hit.point)")];
    "normal-from-the-origin": "has normals that point away from the world's origin, not from the sphere's centre",
        [(NORMAL, "normalize(hit.point)")];
    "normal-is-the-direction": "takes the ray's direction for the normal", [(NORMAL, "-ray.direction")];
}
