//! Lights, and what surfaces do with them.

use super::mistakes;

const TO_LIGHT: &str = "normalize(lights[i].position - hit.point)";
const LIT: &str = "if (cosine > 0.0 && …) {\n            sum";
const UNLIT: &str = "if (cosine > 0.0) {\n            sum";
const PART: &str = "sum += lights[i].color * … * cosine;";
const COSINE: &str = "float cosine = dot(hit.normal, toLight);";
const AMBIENT: &str = "vec3 sum = AMBIENT * hit.color;";

mistakes! {
    "cosine-forgotten": "forgets the cosine of the angle to the light", [(PART, "sum += lights[i].color * …;")];
    "cosine-not-clamped": "lets light from below the surface count as negative light",
        [(LIT, "if (…) {\n            sum")],
        [(UNLIT, "{\n            sum")];
    "cosine-without-sign": "lights both sides of a surface: the absolute value of the cosine",
        [(COSINE, "float cosine = abs(dot(hit.normal, toLight));")];
    "light-backwards": "has the direction to the light backwards", [(TO_LIGHT, "normalize(hit.point - lights[i].position)")];
    "light-not-normalised": "does not normalise the direction to the light", [(TO_LIGHT, "(lights[i].position - hit.point)")];
    "light-from-afar": "takes the light's position for its direction", [(TO_LIGHT, "normalize(lights[i].position)")];
    "light-falls-off": "lets the light fall off with the square of its distance, which the scene does not",
        [(PART, "sum += lights[i].color * … * cosine / dot(lights[i].position - hit.point, lights[i].position - hit.point);")];
    "first-light-only": "has one light where the scene has more", [("i < LIGHTS", "i < 1")];
    "last-light-only": "lets each light replace the one before, where they add up",
        [(PART, "sum = AMBIENT * hit.color + lights[i].color * … * cosine;")];
    "light-not-added": "takes the brighter of ambient light and a light's, where they add up",
        [(PART, "sum = max(sum, lights[i].color * … * cosine);")];
    "no-ambient": "forgets the ambient light", [(AMBIENT, "vec3 sum = vec3(0.0);")];
    "ambient-per-light": "adds the ambient light once for each light",
        [(AMBIENT, "vec3 sum = AMBIENT * hit.color * float(LIGHTS);")],
        [(AMBIENT, "vec3 sum = AMBIENT * hit.color * float(LIGHTS + 1);")];
    "ambient-not-tinted": "does not multiply the ambient light by the surface's colour", [(AMBIENT, "vec3 sum = AMBIENT;")];
    "ambient-over-pi": "divides the ambient light by π", [(AMBIENT, "vec3 sum = AMBIENT * hit.color / 3.14159265359;")];
    "ambient-where-it-is-dark": "adds ambient light only where no other light comes",
        [(PART, "sum = sum == AMBIENT * hit.color ? vec3(0.0) : sum;\n            sum += lights[i].color * … * cosine;")];
    "light-without-colour": "forgets the lights' colour", [(PART, "sum += … * cosine;")];
    "colour-forgotten": "forgets the surface's colour",
        [(AMBIENT, "vec3 sum = AMBIENT;"), ("* hit.color * cosine;", "* cosine;")],
        [(AMBIENT, "vec3 sum = AMBIENT;"), ("* hit.color / PI * cosine;", "/ PI * cosine;")];
    "colour-added": "adds the surface's colour to the light, where it should multiply",
        [(AMBIENT, "vec3 sum = AMBIENT + hit.color;"), ("* hit.color * cosine;", "* cosine;")];
    "pi-forgotten": "forgets to divide the BRDF by π",
        [("* hit.color / PI * cosine;", "* hit.color * cosine;")],
        [("return hit.color / PI;", "return hit.color;")];
    "pi-multiplied": "multiplies the BRDF by π where it should divide",
        [("* hit.color / PI * cosine;", "* hit.color * PI * cosine;")],
        [("return hit.color / PI;", "return hit.color * PI;")];
    "cosine-squared": "multiplies by the cosine twice", [(PART, "sum += lights[i].color * … * cosine * cosine;")];
}
