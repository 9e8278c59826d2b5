//! How things move.

use super::mistakes;

const TURN: &str = "6.28318530718 * fract(turns)";
const ABOUT: &str = "return pivot + rotate(p - pivot, axis, …);";

mistakes! {
    "turned-the-other-way": "turns the other way round", [("s * cross(axis, v)", "s * cross(v, axis)")];
    "rotation-without-its-last-term": "forgets the last term of Rodrigues' formula", [(" + (1.0 - c) * dot(axis, v) * axis", "")];
    "sine-and-cosine-swapped": "has sine and cosine exchanged",
        [("float c = cos(angle);", "float c = sin(angle);"), ("float s = sin(angle);", "float s = cos(angle);")];
    "angle-in-turns": "takes the number of turns for an angle in radians", [(TURN, "fract(turns)")];
    "angle-in-degrees": "takes degrees for radians", [(TURN, "360.0 * fract(turns)")];
    "half-turns": "turns by π where 2π should stand", [(TURN, "3.14159265359 * fract(turns)")];
    "about-the-origin": "turns about the world's origin, not about the pivot", [(ABOUT, "return rotate(p, axis, …);")];
    "pivot-not-added-back": "does not add the pivot back", [(ABOUT, "return rotate(p - pivot, axis, …);")];
    "pivot-not-taken-away": "does not take the pivot away before it turns", [(ABOUT, "return pivot + rotate(p, axis, …);")];
    "carried-along-first": "carries a thing along before it turns it about its own axis, where it should be after",
        [("return motion0(rotateAbout(p, …));", "return rotateAbout(motion0(p), …);")],
        [("return motion1(rotateAbout(p, …));", "return rotateAbout(motion1(p), …);")],
        [("return motion2(rotateAbout(p, …));", "return rotateAbout(motion2(p), …);")];
}
