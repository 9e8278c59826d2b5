//! Mistakes in camera, film, background, and figures on the screen.

use super::geometry::TEXTBOOK;
use super::{Mistake, mistakes};

/// The camera.
pub(super) static CAMERA: &[Mistake] = mistakes! {
    "direction-not-normalised": "does not normalise the camera's directions, though its formula is that for directions of length 1",
        [CameraDirection = "«ScreenPoint»", Discriminant = TEXTBOOK],
        [ParallelDirection = "vec3(0.0, 0.0, -2.0)", Discriminant = TEXTBOOK];
    "no-aspect": "forgets the aspect of the picture", [ScreenYOverAspect = "«ScreenY»"];
    "aspect-upside-down": "multiplies by the aspect where it should divide",
        [ScreenYOverAspect = "«ScreenY» * aspect"];
    "aspect-of-integers": "computes the aspect by integer division",
        [AspectRatio = "float(int(iResolution.x) / int(iResolution.y))"];
    "place-of-integers": "computes the place on the screen by integer division",
        [
            ScreenX = "float(int(fragCoord.x) / int(iResolution.x)) * 2.0 - 1.0",
            ScreenY = "(float(int(fragCoord.y) / int(iResolution.y)) * 2.0 - 1.0)",
        ],
        [ScreenX = "float(int(fragCoord.x) / int(iResolution.x)) * 2.0 - 1.0"],
        [ScreenY = "(float(int(fragCoord.y) / int(iResolution.y)) * 2.0 - 1.0)"];
    "upside-down": "has y upside down", [ScreenY = "(1.0 - fragCoord.y / iResolution.y * 2.0)"];
    "mirrored": "has x the wrong way round", [ScreenX = "1.0 - fragCoord.x / iResolution.x * 2.0"];
    "not-centred": "lets the screen begin at the eye's axis: from 0 to 1, not from −1 to 1",
        [ScreenX = "fragCoord.x / iResolution.x", ScreenY = "(fragCoord.y / iResolution.y)"];
    "half-screen": "has a screen from −½ to ½, not from −1 to 1",
        [ScreenX = "fragCoord.x / iResolution.x - 0.5", ScreenY = "(fragCoord.y / iResolution.y - 0.5)"];
    "pixel-corner": "looks through the corners of pixels, not their middles",
        [AspectStatement = "fragCoord -= 0.5;\n    …"];
    "half-pixel-twice": "adds half a pixel to fragCoord, which has it already",
        [AspectStatement = "fragCoord += 0.5;\n    …"],
        [ScreenY = "((fragCoord.y + 0.5) / iResolution.y * 2.0 - 1.0)"],
        [ScreenX = "(fragCoord.x + 0.5) / iResolution.x * 2.0 - 1.0"];
    "a-pixel-aside": "is a pixel aside",
        [AspectStatement = "fragCoord.x += 1.0;\n    …"],
        [AspectStatement = "fragCoord.x -= 1.0;\n    …"],
        [AspectStatement = "fragCoord.y += 1.0;\n    …"],
        [AspectStatement = "fragCoord.y -= 1.0;\n    …"],
        [AspectStatement = "fragCoord += 1.0;\n    …"];
    "screen-behind": "has the screen behind the eye", [ScreenZ = "«ScreenDistance»"];
    "screen-at-1": "has the screen at distance 1, whatever the scene says", [ScreenZ = "-1.0"];
    "one-ray-for-all": "sends the same ray through all pixels", [ParallelOffset = "vec3(0.0)"];
};

/// Samples, tone map and gamma.
pub(super) static FILM: &[Mistake] = mistakes! {
    "no-gamma": "forgets the gamma of the scene", [GammaStatement = ""];
    "gamma-inverted": "raises colours to the power 2.2 where it should take 1/2.2",
        [GammaExponent = "«Gamma»"];
    "gamma-of-2": "takes the square root for the scene's gamma", [GammaStatement = "color = sqrt(color);"];
    "gamma": "raises colours to the power 1/2.2, which the scene does not",
        [FinalColor = "pow(color, vec3(1.0 / 2.2))"];
    "gamma-backwards": "raises colours to the power 2.2", [FinalColor = "pow(color, vec3(2.2))"];
    "no-tone-map": "forgets the tone map", [ToneMapStatement = ""];
    "tone-map": "applies the tone map c / (c + 1), which the scene has not",
        [FinalColor = "color / (color + 1.0)"];
    "gamma-before-tone-map": "applies the gamma before the tone map",
        [ToneMapStatement = "«GammaStatement»", GammaStatement = "«ToneMapStatement»"];
    "exponential-tone-map": "has the tone map 1 − exp(−c) where the scene has c / (c + 1)",
        [ToneMapped = "1.0 - exp(-color)"];
    "tone-map-by-luminance": "divides by the luminance plus 1, where each component should be divided by its own",
        [ToneMapped = "color / (dot(color, vec3(0.3, 0.6, 0.1)) + 1.0)"],
        [ToneMapped = "color / (dot(color, vec3(0.299, 0.587, 0.114)) + 1.0)"],
        [ToneMapped = "color / (dot(color, vec3(0.2126, 0.7152, 0.0722)) + 1.0)"],
        [ToneMapped = "color / (dot(color, vec3(1.0 / 3.0)) + 1.0)"];
    "background-not-developed": "leaves the background out of tone map and gamma",
        [
            ToneMapStatement = "vec3 light = color;\n    …",
            FinalColor = "light == background(vec3(0.0)) ? light : color",
        ],
        [
            GammaStatement = "vec3 light = color;\n    …",
            FinalColor = "light == background(vec3(0.0)) ? light : color",
        ];
    "blue-is-red": "has red and blue exchanged", [FinalColor = "color.zyx"];
    "samples-not-averaged": "adds up its samples without dividing by their number", [MeanStatement = ""];
    "one-sample-short": "takes one sample less than it divides by", [SampleCondition = "i < SAMPLES - 1"];
    "one-sample-too-many": "takes one sample more than it divides by", [SampleCondition = "i <= SAMPLES"];
    "one-sample-less": "takes one sample less than the scene",
        [SampleCondition = "i < SAMPLES - 1", MeanDivisor = "SAMPLES - 1"];
    "one-sample-more": "takes one sample more than the scene",
        [SampleCondition = "i <= SAMPLES", MeanDivisor = "SAMPLES + 1"];
    "samples-divided-by-one-less": "divides by one less than the number of its samples",
        [MeanDivisor = "SAMPLES - 1"];
    "last-sample-only": "keeps its last sample only",
        [SampleStatement = "color = «Sample»;", MeanStatement = ""];
    "one-seed-for-all-samples": "draws the same numbers for all samples of a pixel", [SampleIndex = "0"];
    "no-jitter": "samples the pixel's centre only",
        [SampleX = "fragCoord.x + 0.0 * random()", SampleY = "fragCoord.y + 0.0 * random()"];
    "jitter-not-centred": "lets samples lie beside their pixel: it forgets to take half a pixel away",
        [SampleX = "fragCoord.x + random()", SampleY = "fragCoord.y + random()"],
        [SampleX = "fragCoord.x + random()"],
        [SampleY = "fragCoord.y + random()"];
    "jitter-too-wide": "spreads its samples over two pixels",
        [SampleX = "fragCoord.x + 2.0 * random() - 1.0", SampleY = "fragCoord.y + 2.0 * random() - 1.0"];
    "samples-at-the-corner": "puts all samples at the pixel's corner",
        [SampleX = "fragCoord.x + 0.0 * random() - 0.5", SampleY = "fragCoord.y + 0.0 * random() - 0.5"];
    "y-drawn-first": "draws y before x",
        [SampleXStatement = "«SampleYStatement»", SampleYStatement = "«SampleXStatement»"];
    "jitter-in-x-only": "moves its samples along x only", [SampleY = "fragCoord.y"];
};

/// The background.
pub(super) static BACKGROUND: &[Mistake] = mistakes! {
    "black-background": "has no background", [BackgroundColor = "vec3(0.0)"];
    "background-upside-down": "has the background upside down",
        [BackgroundStatement = "direction.y = -direction.y;\n    …"];
    "background-by-y-alone": "mixes the background by y, which goes from −1 to 1, not from 0 to 1",
        [BackgroundHeight = "direction.y"];
    "background-along-x": "mixes the background along x, not along y",
        [BackgroundHeight = "0.5 * (1.0 + direction.x)"];
    "background-along-z": "mixes the background along z, not along y",
        [BackgroundHeight = "0.5 * (1.0 + direction.z)"];
    "background-not-reflected": "does not tint the background that mirrors show",
        [BackgroundThroughMirrors = "background(«BackgroundDirection»)"];
    "background-of-the-first-ray": "shows in mirrors the background that the eye's own ray would see",
        [BackgroundDirection = "direction"];
};

/// Figures on the screen.
pub(super) static FIGURES: &[Mistake] = mistakes! {
    "disk-radius-not-squared": "does not square the disk's radius", [DiskFunction = "dot(d, d) - radius"];
    "disk-inside-out": "fills the outside of the disk", [DiskFunction = "radius * radius - dot(d, d)"];
    "wave-upside-down": "fills the space above the wave, not below it",
        [WaveFunction = "height + amplitude * sin(frequency * p.x) - p.y"],
        [WaveFunction = "height - p.y + amplitude * sin(frequency * p.x)"];
    "wave-mirrored": "has the wave upside down",
        [WaveFunction = "p.y - height + amplitude * sin(frequency * p.x)"];
    "wave-in-turns": "takes the wave's frequency for turns, not for radians",
        [WaveFunction = "p.y - height - amplitude * sin(6.28318530718 * frequency * p.x)"];
    "wave-of-cosine": "has a cosine for the wave's sine",
        [WaveFunction = "p.y - height - amplitude * cos(frequency * p.x)"];
    "heart-upside-down": "has the heart upside down",
        [HeartFunction = "ring * ring * ring + q.x * q.x * q.y * q.y * q.y"];
    "ring-not-cubed": "does not cube the ring of the heart",
        [HeartFunction = "ring - q.x * q.x * q.y * q.y * q.y"];
    "ring-squared": "squares the ring of the heart where it should cube it",
        [HeartFunction = "ring * ring - q.x * q.x * q.y * q.y * q.y"];
};
