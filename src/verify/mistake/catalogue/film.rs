//! Samples, tone map and gamma.

use super::mistakes;

const LAST: &str = "fragColor = vec4(color, 1.0);";
const SUM: &str = "color += look";
const MEAN: &str = "color /= float(SAMPLES);";
const X: &str = "fragCoord.x + random() - 0.5;";
const Y: &str = "fragCoord.y + random() - 0.5;";
const TONE_MAP: &str = "color = color / (color + 1.0);";
const GAMMA: &str = "color = pow(color, vec3(1.0 / …));";

mistakes! {
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
    "no-jitter": "samples the pixel's centre only", [(X, "fragCoord.x + 0.0 * random();"), (Y, "fragCoord.y + 0.0 * random();")];
    "jitter-not-centred": "lets samples lie beside their pixel: it forgets to take half a pixel away",
        [(X, "fragCoord.x + random();"), (Y, "fragCoord.y + random();")],
        [(X, "fragCoord.x + random();")],
        [(Y, "fragCoord.y + random();")];
    "jitter-too-wide": "spreads its samples over two pixels",
        [(X, "fragCoord.x + 2.0 * random() - 1.0;"), (Y, "fragCoord.y + 2.0 * random() - 1.0;")];
    "samples-at-the-corner": "puts all samples at the pixel's corner",
        [(X, "fragCoord.x + 0.0 * random() - 0.5;"), (Y, "fragCoord.y + 0.0 * random() - 0.5;")];
    "y-drawn-first": "draws y before x", [("float x = fragCoord.x + random() - 0.5;\n…float y = fragCoord.y + random() - 0.5;", "float y = fragCoord.y + random() - 0.5;\n…float x = fragCoord.x + random() - 0.5;")];
    "jitter-in-x-only": "moves its samples along x only", [(Y, "fragCoord.y;")];
}
