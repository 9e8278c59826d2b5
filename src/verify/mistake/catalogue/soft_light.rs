//! Lights with a radius.

use super::mistakes;

const DEPTH: &str = "float cosine = 1.0 - u * depth;";
const TURN: &str = "float phi = 6.28318530718 * turn;";
const DRAWN: &str = "    float u = random();\n    float v = random();\n    float cosine = 1.0";
const HIDDEN: &str = "inShadow(hit, toLight, distance)";

mistakes! {
    "point-light": "samples the light's centre alone, as if it had no radius",
        [("return around(normalize(axis), cosine, v);", "return normalize(axis);")];
    "half-space-sampled": "draws directions from the whole half space around the light, not from its cone",
        [(DEPTH, "float cosine = 1.0 - u;")];
    "cone-edge-only": "draws directions on the edge of the light's cone only", [(DEPTH, "float cosine = 1.0 - depth;")];
    "angle-uniform": "draws the angle to the light's axis uniformly, where its cosine should be",
        [(DEPTH, "float cosine = cos(u * asin(sqrt(sine2)));")];
    "light-radius-not-squared": "does not square the light's radius", [("light.radius * light.radius / ", "light.radius / ")];
    "draws-swapped": "takes the first number drawn for the turn and the second for the angle, where the scene has them the other way round",
        [(DRAWN, "    float v = random();\n    float u = random();\n    float cosine = 1.0")];
    "half-a-turn": "turns by half a circle only: π where 2π should stand", [(TURN, "float phi = 3.14159265359 * turn;")];
    "turn-without-2-pi": "turns by as many radians as it should by full circles", [(TURN, "float phi = turn;")];
    "turn-in-degrees": "turns by degrees where radians are expected", [(TURN, "float phi = 360.0 * turn;")];
    "cosine-of-the-centre": "takes the cosine to the light's centre, not that of the direction drawn",
        [("float cosine = dot(hit.normal, toLight);", "float cosine = dot(hit.normal, normalize(lights[i].position - hit.point));")];
    "shadow-rays-to-the-centre": "sends its shadow rays to the light's centre, not in the direction drawn",
        [(HIDDEN, "inShadow(hit, normalize(lights[i].position - hit.point), distance)")];
}
