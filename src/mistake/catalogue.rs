//! The mistakes that the course has seen, as edits of the shader that paints a scene.

use super::Named;
use super::edit::{Edit, edited};

/// A mistake.
#[derive(Debug)]
pub(super) struct Mistake {
    name: &'static str,
    says: &'static str,
    edits: &'static [Edit],
}

impl Mistake {
    /// The shader with this mistake; none where it cannot be made.
    pub(super) fn made_in(&self, text: &str) -> Option<String> {
        edited(text, self.edits)
    }

    pub(super) fn named(&self) -> Named {
        let Self { name, says, .. } = *self;
        Named { name, says }
    }
}

const F: &str = "vec3 f = ray.origin - sphere.center;";
const DISC: &str = "float disc = sphere.radius * sphere.radius - dot(closest, closest);";
/// The same for directions of length 1.
const TEXTBOOK: &str = "float disc = b * b - dot(f, f) + sphere.radius * sphere.radius;";
const NEAR: &str = "float t = -b - root;";
const FAR: &str = "t = -b + root;";
const CLOSER: &str = "if (t < hit.t) {";
const X: &str = "float x = fragCoord.x / iResolution.x * 2.0 - 1.0;";
const Y: &str = "(fragCoord.y / iResolution.y * 2.0 - 1.0)";
const LOOK: &str = "vec3 look(vec2 fragCoord) {";
const UNIT: &str = "normalize(vec3(x, y, …))";
const NORMAL: &str = "normalize(hit.point - spheres[i].center)";
const TO_LIGHT: &str = "normalize(lights[i].position - hit.point)";
const LIT: &str = "if (cosine > 0.0 && !inShadow(hit, lights[i].position)) {";
const PART: &str = "sum += lights[i].color * cosine;";
const OCCLUDED: &str = "if (intersectSphere(ray, spheres[i]) < distance) {";
const BOUNCE: &str = "reflect(ray.direction, hit.normal)";
const LAST: &str = "fragColor = vec4(color, 1.0);";

macro_rules! catalogue {
    ($($name:literal: $says:literal, [$($edit:expr),*];)*) => {
        /// All of them; of two that paint the same picture, the first is named.
        pub(super) static CATALOGUE: &[Mistake] = &[$(Mistake {
            name: $name,
            says: $says,
            edits: &[$($edit),*],
        }),*];
    };
}

catalogue! {
    // Shadows.
    "no-shadows": "has no shadows", [(LIT, "if (cosine > 0.0) {")];
    "shadow-beyond-the-light": "tests shadows beyond the light",
        [(OCCLUDED, "if (intersectSphere(ray, spheres[i]) < NO_HIT) {")];
    "shadow-ray-not-normalised": "does not normalise shadow rays, though its formula is that for directions of length 1",
        [("toLight / distance);", "toLight);"), (DISC, TEXTBOOK)];
    "shadow-of-itself": "starts shadow rays below the surface, so that everything lies in its own shadow",
        [("hit.point + 0.001 * hit.normal;", "hit.point - 0.001 * hit.normal;")];
    "shadow-without-ambient": "leaves no ambient light in shadows",
        [("if (cosine > 0.0 && !inShadow(hit, lights[i].position)) {",
          "if (cosine > 0.0 && inShadow(hit, lights[i].position)) {\n            return vec3(0.0);\n        }\n        if (cosine > 0.0) {")];
    // Where a ray meets a sphere.
    "roots-not-halved": "does not divide the roots by 2a",
        [(NEAR, "float t = 2.0 * (-b - root);"), (FAR, "t = 2.0 * (-b + root);")];
    "discriminant-without-4": "forgets the 4 in b² − 4ac",
        [
            (DISC, "float disc = 4.0 * b * b - dot(f, f) + sphere.radius * sphere.radius;"),
            (NEAR, "float t = (-2.0 * b - root) / 2.0;"),
            (FAR, "t = (-2.0 * b + root) / 2.0;")
        ];
    "far-root": "takes the root where a ray leaves the sphere, not the one where it enters", [(NEAR, "float t = -b + root;")];
    "behind-the-eye": "counts what lies behind the start of a ray",
        [("float t = -b - root;\n        if (t > 0.00001) {", "float t = -b - root;\n        if (true) {")];
    "radius-not-squared": "does not square the radius", [(DISC, "float disc = sphere.radius - dot(closest, closest);")];
    "root-not-taken": "does not take the square root of the discriminant", [("float root = sqrt(disc);", "float root = disc;")];
    "sign-of-b": "has the wrong sign of b: the centre minus the origin, where the formula has the origin minus the centre",
        [(F, "vec3 f = sphere.center - ray.origin;")];
    "direction-not-normalised": "does not normalise the camera's directions, though its formula is that for directions of length 1",
        [(UNIT, "vec3(x, y, …)"), (DISC, TEXTBOOK)];
    "last-hit": "keeps the last sphere that a ray meets, not the nearest", [(CLOSER, "if (t < NO_HIT) {")];
    "first-hit": "keeps the first sphere that a ray meets, not the nearest", [(CLOSER, "if (t < NO_HIT && hit.t == NO_HIT) {")];
    "farthest-hit": "keeps the farthest sphere that a ray meets, not the nearest",
        [(CLOSER, "if (t < NO_HIT && (hit.t == NO_HIT || t > hit.t)) {")];
    // The camera.
    "no-aspect": "forgets the aspect of the picture", [(") / aspect;", ");")];
    "aspect-upside-down": "multiplies by the aspect where it should divide", [(") / aspect;", ") * aspect;")];
    "aspect-of-integers": "computes the aspect by integer division",
        [("iResolution.x / iResolution.y;", "float(int(iResolution.x) / int(iResolution.y));")];
    "place-of-integers": "computes the place on the screen by integer division",
        [
            (X, "float x = float(int(fragCoord.x) / int(iResolution.x)) * 2.0 - 1.0;"),
            (Y, "(float(int(fragCoord.y) / int(iResolution.y)) * 2.0 - 1.0)")
        ];
    "upside-down": "has y upside down", [(Y, "(1.0 - fragCoord.y / iResolution.y * 2.0)")];
    "mirrored": "has x the wrong way round", [(X, "float x = 1.0 - fragCoord.x / iResolution.x * 2.0;")];
    "not-centred": "lets the screen begin at the eye's axis: from 0 to 1, not from −1 to 1",
        [(X, "float x = fragCoord.x / iResolution.x;"), (Y, "(fragCoord.y / iResolution.y)")];
    "half-screen": "has a screen from −½ to ½, not from −1 to 1",
        [(X, "float x = fragCoord.x / iResolution.x - 0.5;"), (Y, "(fragCoord.y / iResolution.y - 0.5)")];
    "pixel-corner": "looks through the corners of pixels, not their middles", [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord -= 0.5;")];
    "half-pixel-twice": "adds half a pixel to fragCoord, which has it already", [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord += 0.5;")];
    "half-pixel-twice": "adds half a pixel to fragCoord, which has it already", [(Y, "((fragCoord.y + 0.5) / iResolution.y * 2.0 - 1.0)")];
    "half-pixel-twice": "adds half a pixel to fragCoord, which has it already",
        [(X, "float x = (fragCoord.x + 0.5) / iResolution.x * 2.0 - 1.0;")];
    "screen-behind": "has the screen behind the eye", [("vec3(x, y, -…)", "vec3(x, y, …)")];
    "screen-at-1": "has the screen at distance 1, whatever the scene says", [("vec3(x, y, -…)", "vec3(x, y, -1.0)")];
    // Normals.
    "normal-not-normalised": "does not normalise normals", [(NORMAL, "(hit.point - spheres[i].center)")];
    "normal-inwards": "has normals that point into the spheres", [(NORMAL, "normalize(spheres[i].center - hit.point)")];
    "normal-from-the-origin": "has normals that point away from the world's origin, not from the sphere's centre",
        [(NORMAL, "normalize(hit.point)")];
    // Light.
    "cosine-forgotten": "forgets the cosine of the angle to the light", [(PART, "sum += lights[i].color;")];
    "cosine-not-clamped": "lets light from below the surface count as negative light",
        [(LIT, "if (!inShadow(hit, lights[i].position)) {")];
    "cosine-not-clamped": "lets light from below the surface count as negative light", [("if (cosine > 0.0) {", "{")];
    "cosine-without-sign": "lights both sides of a surface: the absolute value of the cosine",
        [("float cosine = dot(…;", "float cosine = abs(dot(…);")];
    "light-backwards": "has the direction to the light backwards", [(TO_LIGHT, "normalize(hit.point - lights[i].position)")];
    "light-not-normalised": "does not normalise the direction to the light", [(TO_LIGHT, "(lights[i].position - hit.point)")];
    "light-from-afar": "takes the light's position for its direction", [(TO_LIGHT, "normalize(lights[i].position)")];
    "light-falls-off": "lets the light fall off with the square of its distance, which the scene does not",
        [(PART, "sum += lights[i].color * cosine / dot(lights[i].position - hit.point, lights[i].position - hit.point);")];
    "first-light-only": "has one light where the scene has more", [("i < LIGHTS", "i < 1")];
    "last-light-only": "lets each light replace the one before, where they add up", [(PART, "sum = AMBIENT + lights[i].color * cosine;")];
    "no-ambient": "forgets the ambient light", [("vec3 sum = AMBIENT;", "vec3 sum = vec3(0.0);")];
    "ambient-per-light": "adds the ambient light once for each light",
        [("vec3 sum = AMBIENT;", "vec3 sum = AMBIENT * float(LIGHTS);")];
    "ambient-per-light": "adds the ambient light once for each light",
        [("vec3 sum = AMBIENT;", "vec3 sum = AMBIENT * float(LIGHTS + 1);")];
    "ambient-not-tinted": "does not multiply the ambient light by the surface's colour",
        [("vec3 sum = AMBIENT;", "vec3 sum = vec3(0.0);"), ("return hit.color * sum;", "return AMBIENT + hit.color * sum;")];
    "light-without-colour": "forgets the lights' colour", [(PART, "sum += vec3(cosine);")];
    "colour-forgotten": "forgets the surface's colour", [("return hit.color * sum;", "return sum;")];
    "colour-added": "adds the surface's colour to the light, where it should multiply", [("return hit.color * sum;", "return hit.color + sum;")];
    // Mirrors.
    "no-reflection": "does not turn reflected rays: they go straight on", [(BOUNCE, "ray.direction")];
    "reflection-sign": "has the reflected direction backwards", [(BOUNCE, "-reflect(ray.direction, hit.normal)")];
    "reflection-without-2": "forgets the 2 in the reflected direction d − 2(d·n)n",
        [(BOUNCE, "normalize(ray.direction - dot(ray.direction, hit.normal) * hit.normal)")];
    "reflection-without-2": "forgets the 2 in the reflected direction d − 2(d·n)n",
        [(BOUNCE, "ray.direction - dot(ray.direction, hit.normal) * hit.normal"), (DISC, TEXTBOOK)];
    "reflection-from-the-eye": "starts reflected rays at the eye", [("ray = Ray(hit.point…,", "ray = Ray(ray.origin,")];
    "reflection-along-the-normal": "reflects every ray along the normal", [(BOUNCE, "hit.normal")];
    "one-bounce-short": "follows one reflection too few", [("depth < MAX_DEPTH;", "depth < MAX_DEPTH - 1;")];
    "one-bounce-more": "follows one reflection too many", [("depth < MAX_DEPTH;", "depth < MAX_DEPTH + 1;")];
    "one-bounce-only": "follows one reflection only", [("depth < MAX_DEPTH;", "depth < 2;")];
    "two-bounces-only": "follows two reflections only", [("depth < MAX_DEPTH;", "depth < 3;")];
    "mirrors-added": "adds the colours of mirrors up, where they should multiply", [("throughput *= hit.color;", "throughput += hit.color;")];
    "mirrors-without-colour": "forgets the mirrors' colour", [("throughput *= hit.color;", "")];
    "last-mirror-only": "keeps the last mirror's colour only, where all should multiply",
        [("throughput *= hit.color;", "throughput = hit.color;")];
    "background-not-reflected": "does not tint the background that mirrors show",
        [("return throughput * background(ray.direction);", "return background(ray.direction);")];
    "background-of-the-first-ray": "shows in mirrors the background that the eye's own ray would see",
        [("background(ray.direction);", "background(direction);")];
    // The background.
    "black-background": "has no background", [("vec3 background(vec3 direction) {\n    return …;", "vec3 background(vec3 direction) {\n    return vec3(0.0);")];
    "background-upside-down": "has the background upside down",
        [("vec3 background(vec3 direction) {", "vec3 background(vec3 direction) {\n    direction.y = -direction.y;")];
    "background-by-y-alone": "mixes the background by y, which goes from −1 to 1, not from 0 to 1",
        [("0.5 * (1.0 + direction.y)", "direction.y")];
    // The picture.
    "no-gamma": "forgets the gamma of the scene", [("color = pow(color, vec3(…));", "")];
    "gamma-inverted": "raises colours to the power 2.2 where it should take 1/2.2",
        [("color = pow(color, vec3(1.0 / …));", "color = pow(color, vec3(…));")];
    "gamma": "raises colours to the power 1/2.2, which the scene does not",
        [(LAST, "fragColor = vec4(pow(color, vec3(1.0 / 2.2)), 1.0);")];
    "gamma-backwards": "raises colours to the power 2.2",
        [(LAST, "fragColor = vec4(pow(color, vec3(2.2)), 1.0);")];
    "no-tone-map": "forgets the tone map", [("color = color / (color + 1.0);", "")];
    "gamma-before-tone-map": "applies the gamma before the tone map",
        [("    color = color / (color + 1.0);\n    color = pow(color, vec3(…));", "    color = pow(color, vec3(…));\n    color = color / (color + 1.0);")];
    "blue-is-red": "has red and blue exchanged", [(LAST, "fragColor = vec4(color.zyx, 1.0);")];
    "samples-not-averaged": "adds up its samples without dividing by their number", [("color /= float(SAMPLES);", "")];
}
