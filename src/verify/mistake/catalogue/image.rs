//! Mistakes in camera, film, background, and figures on the screen.

use super::geometry::{DISC, TEXTBOOK};
use super::{Mistake, mistakes};

const X: &str = "float x = fragCoord.x / iResolution.x * 2.0 - 1.0;";
const Y: &str = "(fragCoord.y / iResolution.y * 2.0 - 1.0)";
const LOOK: &str = "vec3 look(vec2 fragCoord) {";
const UNIT: &str = "normalize(vec3(x, y, …))";
const PARALLEL: &str = "vec3(0.0, 0.0, -1.0))";

/// The camera.
pub(super) static CAMERA: &[Mistake] = mistakes! {
    "direction-not-normalised": "does not normalise the camera's directions, though its formula is that for directions of length 1",
        [(UNIT, "vec3(x, y, …)"), (DISC, TEXTBOOK)],
        [(PARALLEL, "vec3(0.0, 0.0, -2.0))"), (DISC, TEXTBOOK)];
    "no-aspect": "forgets the aspect of the picture", [(") / aspect;", ");")];
    "aspect-upside-down": "multiplies by the aspect where it should divide", [(") / aspect;", ") * aspect;")];
    "aspect-of-integers": "computes the aspect by integer division",
        [("iResolution.x / iResolution.y;", "float(int(iResolution.x) / int(iResolution.y));")];
    "place-of-integers": "computes the place on the screen by integer division",
        [
            (X, "float x = float(int(fragCoord.x) / int(iResolution.x)) * 2.0 - 1.0;"),
            (Y, "(float(int(fragCoord.y) / int(iResolution.y)) * 2.0 - 1.0)")
        ],
        [(X, "float x = float(int(fragCoord.x) / int(iResolution.x)) * 2.0 - 1.0;")],
        [(Y, "(float(int(fragCoord.y) / int(iResolution.y)) * 2.0 - 1.0)")];
    "upside-down": "has y upside down", [(Y, "(1.0 - fragCoord.y / iResolution.y * 2.0)")];
    "mirrored": "has x the wrong way round", [(X, "float x = 1.0 - fragCoord.x / iResolution.x * 2.0;")];
    "not-centred": "lets the screen begin at the eye's axis: from 0 to 1, not from −1 to 1",
        [(X, "float x = fragCoord.x / iResolution.x;"), (Y, "(fragCoord.y / iResolution.y)")];
    "half-screen": "has a screen from −½ to ½, not from −1 to 1",
        [(X, "float x = fragCoord.x / iResolution.x - 0.5;"), (Y, "(fragCoord.y / iResolution.y - 0.5)")];
    "pixel-corner": "looks through the corners of pixels, not their middles", [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord -= 0.5;")];
    "half-pixel-twice": "adds half a pixel to fragCoord, which has it already",
        [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord += 0.5;")],
        [(Y, "((fragCoord.y + 0.5) / iResolution.y * 2.0 - 1.0)")],
        [(X, "float x = (fragCoord.x + 0.5) / iResolution.x * 2.0 - 1.0;")];
    "a-pixel-aside": "is a pixel aside",
        [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord.x += 1.0;")],
        [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord.x -= 1.0;")],
        [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord.y += 1.0;")],
        [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord.y -= 1.0;")],
        [(LOOK, "vec3 look(vec2 fragCoord) {\n    fragCoord += 1.0;")];
    "screen-behind": "has the screen behind the eye", [("vec3(x, y, -…)", "vec3(x, y, …)")];
    "screen-at-1": "has the screen at distance 1, whatever the scene says", [("vec3(x, y, -…)", "vec3(x, y, -1.0)")];
    "one-ray-for-all": "sends the same ray through all pixels", [(" * vec3(x, y, 0.0), vec3(0.0, 0.0, -1.0)", " * vec3(0.0), vec3(0.0, 0.0, -1.0)")];
};

const LAST: &str = "fragColor = vec4(color, 1.0);";
const SUM: &str = "color += look";
const MEAN: &str = "color /= float(SAMPLES);";
const JITTER_X: &str = "fragCoord.x + random() - 0.5;";
const JITTER_Y: &str = "fragCoord.y + random() - 0.5;";
const TONE_MAP: &str = "color = color / (color + 1.0);";
const GAMMA: &str = "color = pow(color, vec3(1.0 / …));";

/// Samples, tone map and gamma.
pub(super) static FILM: &[Mistake] = mistakes! {
    "no-gamma": "forgets the gamma of the scene", [(GAMMA, "")];
    "gamma-inverted": "raises colours to the power 2.2 where it should take 1/2.2",
        [(GAMMA, "color = pow(color, vec3(…));")];
    "gamma-of-2": "takes the square root for the scene's gamma", [(GAMMA, "color = sqrt(color);")];
    "gamma": "raises colours to the power 1/2.2, which the scene does not",
        [(LAST, "fragColor = vec4(pow(color, vec3(1.0 / 2.2)), 1.0);")];
    "gamma-backwards": "raises colours to the power 2.2",
        [(LAST, "fragColor = vec4(pow(color, vec3(2.2)), 1.0);")];
    "no-tone-map": "forgets the tone map", [(TONE_MAP, "")];
    "tone-map": "applies the tone map c / (c + 1), which the scene has not",
        [(LAST, "fragColor = vec4(color / (color + 1.0), 1.0);")];
    "gamma-before-tone-map": "applies the gamma before the tone map",
        [("    color = color / (color + 1.0);\n    color = pow(color, vec3(…));", "    color = pow(color, vec3(…));\n    color = color / (color + 1.0);")];
    "exponential-tone-map": "has the tone map 1 − exp(−c) where the scene has c / (c + 1)", [(TONE_MAP, "color = 1.0 - exp(-color);")];
    "tone-map-by-luminance": "divides by the luminance plus 1, where each component should be divided by its own",
        [(TONE_MAP, "color = color / (dot(color, vec3(0.3, 0.6, 0.1)) + 1.0);")],
        [(TONE_MAP, "color = color / (dot(color, vec3(0.299, 0.587, 0.114)) + 1.0);")],
        [(TONE_MAP, "color = color / (dot(color, vec3(0.2126, 0.7152, 0.0722)) + 1.0);")],
        [(TONE_MAP, "color = color / (dot(color, vec3(1.0 / 3.0)) + 1.0);")];
    "background-not-developed": "leaves the background out of tone map and gamma",
        [
            (TONE_MAP, "vec3 light = color;\n    color = color / (color + 1.0);"),
            (LAST, "fragColor = vec4(light == background(vec3(0.0)) ? light : color, 1.0);")
        ],
        [
            (GAMMA, "vec3 light = color;\n    color = pow(color, vec3(1.0 / …));"),
            (LAST, "fragColor = vec4(light == background(vec3(0.0)) ? light : color, 1.0);")
        ];
    "blue-is-red": "has red and blue exchanged", [(LAST, "fragColor = vec4(color.zyx, 1.0);")];
    "samples-not-averaged": "adds up its samples without dividing by their number", [(MEAN, "")];
    "one-sample-short": "takes one sample less than it divides by", [("i < SAMPLES;", "i < SAMPLES - 1;")];
    "one-sample-too-many": "takes one sample more than it divides by", [("i < SAMPLES;", "i <= SAMPLES;")];
    "one-sample-less": "takes one sample less than the scene",
        [("i < SAMPLES;", "i < SAMPLES - 1;"), (MEAN, "color /= float(SAMPLES - 1);")];
    "one-sample-more": "takes one sample more than the scene",
        [("i < SAMPLES;", "i <= SAMPLES;"), (MEAN, "color /= float(SAMPLES + 1);")];
    "samples-divided-by-one-less": "divides by one less than the number of its samples", [(MEAN, "color /= float(SAMPLES - 1);")];
    "last-sample-only": "keeps its last sample only", [(SUM, "color = look"), (MEAN, "")];
    "one-seed-for-all-samples": "draws the same numbers for all samples of a pixel", [("startSample(fragCoord, i);", "startSample(fragCoord, 0);")];
    "no-jitter": "samples the pixel's centre only", [(JITTER_X, "fragCoord.x + 0.0 * random();"), (JITTER_Y, "fragCoord.y + 0.0 * random();")];
    "jitter-not-centred": "lets samples lie beside their pixel: it forgets to take half a pixel away",
        [(JITTER_X, "fragCoord.x + random();"), (JITTER_Y, "fragCoord.y + random();")],
        [(JITTER_X, "fragCoord.x + random();")],
        [(JITTER_Y, "fragCoord.y + random();")];
    "jitter-too-wide": "spreads its samples over two pixels",
        [(JITTER_X, "fragCoord.x + 2.0 * random() - 1.0;"), (JITTER_Y, "fragCoord.y + 2.0 * random() - 1.0;")];
    "samples-at-the-corner": "puts all samples at the pixel's corner",
        [(JITTER_X, "fragCoord.x + 0.0 * random() - 0.5;"), (JITTER_Y, "fragCoord.y + 0.0 * random() - 0.5;")];
    "y-drawn-first": "draws y before x", [("float x = fragCoord.x + random() - 0.5;\n…float y = fragCoord.y + random() - 0.5;", "float y = fragCoord.y + random() - 0.5;\n…float x = fragCoord.x + random() - 0.5;")];
    "jitter-in-x-only": "moves its samples along x only", [(JITTER_Y, "fragCoord.y;")];
};

const HEAD: &str = "vec3 background(vec3 direction) {";
const UP: &str = "0.5 * (1.0 + direction.y)";

/// The background.
pub(super) static BACKGROUND: &[Mistake] = mistakes! {
    "black-background": "has no background", [("vec3 background(vec3 direction) {\n    return …;", "vec3 background(vec3 direction) {\n    return vec3(0.0);")];
    "background-upside-down": "has the background upside down",
        [(HEAD, "vec3 background(vec3 direction) {\n    direction.y = -direction.y;")];
    "background-by-y-alone": "mixes the background by y, which goes from −1 to 1, not from 0 to 1", [(UP, "direction.y")];
    "background-along-x": "mixes the background along x, not along y", [(UP, "0.5 * (1.0 + direction.x)")];
    "background-along-z": "mixes the background along z, not along y", [(UP, "0.5 * (1.0 + direction.z)")];
    "background-not-reflected": "does not tint the background that mirrors show",
        [("return throughput * background(ray.direction);", "return background(ray.direction);")];
    "background-of-the-first-ray": "shows in mirrors the background that the eye's own ray would see",
        [("background(ray.direction);", "background(direction);")];
};

const DISK: &str = "return dot(d, d) - radius * radius;";
const WAVE: &str = "return p.y - height - amplitude * sin(frequency * p.x);";
const HEART: &str = "return ring * ring * ring - q.x * q.x * q.y * q.y * q.y;";

/// Figures on the screen.
pub(super) static FIGURES: &[Mistake] = mistakes! {
    "disk-radius-not-squared": "does not square the disk's radius", [(DISK, "return dot(d, d) - radius;")];
    "disk-inside-out": "fills the outside of the disk", [(DISK, "return radius * radius - dot(d, d);")];
    "wave-upside-down": "fills the space above the wave, not below it",
        [(WAVE, "return height + amplitude * sin(frequency * p.x) - p.y;")],
        [(WAVE, "return height - p.y + amplitude * sin(frequency * p.x);")];
    "wave-mirrored": "has the wave upside down", [(WAVE, "return p.y - height + amplitude * sin(frequency * p.x);")];
    "wave-in-turns": "takes the wave's frequency for turns, not for radians",
        [(WAVE, "return p.y - height - amplitude * sin(6.28318530718 * frequency * p.x);")];
    "wave-of-cosine": "has a cosine for the wave's sine", [(WAVE, "return p.y - height - amplitude * cos(frequency * p.x);")];
    "heart-upside-down": "has the heart upside down", [(HEART, "return ring * ring * ring + q.x * q.x * q.y * q.y * q.y;")];
    "ring-not-cubed": "does not cube the ring of the heart", [(HEART, "return ring - q.x * q.x * q.y * q.y * q.y;")];
    "ring-squared": "squares the ring of the heart where it should cube it", [(HEART, "return ring * ring - q.x * q.x * q.y * q.y * q.y;")];
};
