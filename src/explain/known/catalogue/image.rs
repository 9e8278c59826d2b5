//! Mistakes in camera, film, background, and figures on the screen.

use super::geometry::TEXTBOOK;
use super::{Group, mistakes};

/// The camera.
pub(super) static CAMERA: Group = mistakes! {
    /// Use `normalize(vec3(x, y, -screenDistance))`, or the full quadratic with `a = dot(d, d)`.
    "direction-not-normalized": "camera ray directions are not normalized, but the intersection formula assumes unit length",
        [CameraDirection = "«ScreenPoint»", Discriminant = TEXTBOOK],
        [ParallelDirection = "vec3(0.0, 0.0, -2.0)", Discriminant = TEXTBOOK];
    /// Divide y by it: `y /= iResolution.x / iResolution.y`.
    "no-aspect": "the aspect ratio is missing in the screen coordinates", [ScreenYOverAspect = "«ScreenY»"];
    /// Use `y / aspect` with `aspect = iResolution.x / iResolution.y`.
    "aspect-inverted": "y is multiplied by the aspect ratio instead of divided by it",
        [ScreenYOverAspect = "«ScreenY» * aspect"];
    /// Divide floats: `iResolution.x / iResolution.y`; the quotient of two `int` is truncated.
    "aspect-integer-division": "the aspect ratio is computed with integer division",
        [AspectRatio = "float(int(iResolution.x) / int(iResolution.y))"];
    /// Divide floats: `fragCoord / iResolution.xy`; the quotient of two `int` is truncated.
    "screen-integer-division": "the screen coordinates are computed with integer division",
        [
            ScreenX = "float(int(fragCoord.x) / int(iResolution.x)) * 2.0 - 1.0",
            ScreenY = "(float(int(fragCoord.y) / int(iResolution.y)) * 2.0 - 1.0)",
        ],
        [ScreenX = "float(int(fragCoord.x) / int(iResolution.x)) * 2.0 - 1.0"],
        [ScreenY = "(float(int(fragCoord.y) / int(iResolution.y)) * 2.0 - 1.0)"];
    /// In GLSL, y points upward and `fragCoord.y` is 0 at the bottom: use `2.0 * fragCoord.y / iResolution.y
    /// - 1.0`.
    "upside-down": "the image is upside down: y is negated",
        [ScreenY = "(1.0 - fragCoord.y / iResolution.y * 2.0)"];
    /// Use `2.0 * fragCoord.x / iResolution.x - 1.0`.
    "mirrored": "the image is mirrored: x is negated", [ScreenX = "1.0 - fragCoord.x / iResolution.x * 2.0"];
    /// Use `2.0 * fragCoord / iResolution.xy - 1.0`.
    "not-centered": "screen coordinates run from 0 to 1 instead of −1 to 1",
        [ScreenX = "fragCoord.x / iResolution.x", ScreenY = "(fragCoord.y / iResolution.y)"];
    /// Multiply by 2: `2.0 * fragCoord / iResolution.xy - 1.0`.
    "half-screen": "screen coordinates run from −0.5 to 0.5 instead of −1 to 1",
        [ScreenX = "fragCoord.x / iResolution.x - 0.5", ScreenY = "(fragCoord.y / iResolution.y - 0.5)"];
    /// Use `fragCoord` as it is: it contains the 0.5 of the pixel's center.
    "pixel-corner": "rays pass through the corners of pixels instead of their centers",
        [AspectStatement = "fragCoord -= 0.5;\n    …"];
    /// Use `fragCoord` without adding 0.5.
    "half-pixel-twice": "half a pixel is added to `fragCoord`, which is already the pixel's center",
        [AspectStatement = "fragCoord += 0.5;\n    …"],
        [ScreenY = "((fragCoord.y + 0.5) / iResolution.y * 2.0 - 1.0)"],
        [ScreenX = "(fragCoord.x + 0.5) / iResolution.x * 2.0 - 1.0"];
    /// Use `fragCoord` without adding or subtracting 1.
    "off-by-one-pixel": "the image is shifted by one pixel",
        [AspectStatement = "fragCoord.x += 1.0;\n    …"],
        [AspectStatement = "fragCoord.x -= 1.0;\n    …"],
        [AspectStatement = "fragCoord.y += 1.0;\n    …"],
        [AspectStatement = "fragCoord.y -= 1.0;\n    …"],
        [AspectStatement = "fragCoord += 1.0;\n    …"];
    /// The camera looks along −z: `vec3(x, y, -screenDistance)`.
    "screen-behind-camera": "the screen is behind the camera: the z of ray directions is positive",
        [ScreenZ = "«ScreenDistance»"];
    /// Use the scene's `screen_distance` as the z of the direction: `vec3(x, y, -screenDistance)`.
    "screen-at-1": "the screen distance is 1 instead of the scene's", [ScreenZ = "-1.0"];
    /// With a parallel projection, add the pixel's position to the origin: `eye + vec3(0.5 * width * uv,
    /// 0.0)`.
    "one-ray-for-all": "all pixels cast the same ray: its origin does not depend on the pixel",
        [ParallelOffset = "vec3(0.0)"];
    /// Use `normalize(lookAt - eye)`.
    "look-at-as-direction": "the scene's `look_at` is used as a direction: the camera's position is not subtracted",
        [Forward = "normalize(«LookAt»)"];
    /// Use `normalize(cross(forward, up))`: the length of the product is the sine of the angle.
    "right-not-normalized": "the camera's axis to the right is not normalized", [Right = "«RightCross»"];
    /// Use `cross(forward, up)`.
    "camera-cross-swapped": "the camera's axis to the right points to the left: the factors of its cross product are swapped",
        [RightCross = "cross(«UpReference», forward)"];
    /// Use `cross(right, forward)`.
    "up-not-perpendicular": "the camera's axis up is the scene's `up`, which is not perpendicular to the viewing direction",
        [Up = "«UpReference»"];
    /// Use `cos(roll) * right - sin(roll) * up`, and `cos(roll) * up + sin(roll) * right`.
    "roll-reversed": "the camera rolls counter-clockwise instead of clockwise", [Roll = "-…"];
    /// Use `radians(roll)`.
    "roll-in-degrees": "the camera's roll is not converted to radians", [Roll = "«RollDegrees»"];
};

/// Samples, tone map and gamma.
pub(super) static FILM: Group = mistakes! {
    /// Add `color = pow(color, vec3(1.0 / gamma))` at the end.
    "no-gamma": "gamma correction is missing", [GammaStatement = ""];
    /// Use `pow(color, vec3(1.0 / gamma))`.
    "gamma-inverted": "gamma correction uses the exponent γ instead of 1/γ",
        [GammaExponent = "«Gamma»"];
    /// Use `pow(color, vec3(1.0 / gamma))` instead of `sqrt(color)`.
    "gamma-of-2": "gamma correction uses the square root instead of the scene's gamma",
        [GammaStatement = "color = sqrt(color);"];
    /// Remove the extra gamma correction.
    "extra-gamma": "colors are raised to the power 1/2.2, although the scene does not require it",
        [FinalColor = "pow(color, vec3(1.0 / 2.2))"];
    /// Remove the conversion `pow(color, vec3(2.2))`.
    "extra-inverse-gamma": "colors are raised to the power 2.2, although the scene does not require it",
        [FinalColor = "pow(color, vec3(2.2))"];
    /// Add `color = color / (color + 1.0)` before gamma correction.
    "no-tone-map": "tone mapping is missing", [ToneMapStatement = ""];
    /// Remove the extra tone map.
    "extra-tone-map": "the tone map c / (c + 1) is applied, although the scene does not require it",
        [FinalColor = "color / (color + 1.0)"];
    /// Apply the tone map first, gamma correction last.
    "gamma-before-tone-map": "gamma correction is applied before tone mapping",
        [ToneMapStatement = "«GammaStatement»", GammaStatement = "«ToneMapStatement»"];
    /// Use `color / (color + 1.0)`.
    "exponential-tone-map": "the tone map is 1 − exp(−c) instead of c / (c + 1)",
        [ToneMapped = "1.0 - exp(-color)"];
    /// Use `color / (color + 1.0)`, component by component.
    "tone-map-by-luminance": "the tone map divides by the luminance plus 1 instead of each component plus 1",
        [ToneMapped = "color / (dot(color, vec3(0.3, 0.6, 0.1)) + 1.0)"],
        [ToneMapped = "color / (dot(color, vec3(0.299, 0.587, 0.114)) + 1.0)"],
        [ToneMapped = "color / (dot(color, vec3(0.2126, 0.7152, 0.0722)) + 1.0)"],
        [ToneMapped = "color / (dot(color, vec3(1.0 / 3.0)) + 1.0)"];
    /// Apply both to the final color, whatever the ray hit.
    "background-not-tone-mapped": "tone mapping and gamma correction are not applied to the background",
        [
            ToneMapStatement = "vec3 light = color;\n    …",
            FinalColor = "light == background(vec3(0.0)) ? light : color",
        ],
        [
            GammaStatement = "vec3 light = color;\n    …",
            FinalColor = "light == background(vec3(0.0)) ? light : color",
        ];
    /// Write the components in the order r, g, b.
    "red-blue-swapped": "red and blue are swapped", [FinalColor = "color.zyx"];
    /// Add `color /= float(SAMPLES)` after the loop.
    "samples-not-averaged": "the sum of the samples is not divided by their number", [MeanStatement = ""];
    /// Use `for (int i = 0; i < SAMPLES; i++)` and divide by `float(SAMPLES)`.
    "sample-loop-too-short": "the sum has one sample fewer than its divisor",
        [SampleCondition = "i < SAMPLES - 1"];
    /// Use `i < SAMPLES` instead of `i <= SAMPLES`.
    "sample-loop-too-long": "the sum has one sample more than its divisor",
        [SampleCondition = "i <= SAMPLES"];
    /// Use the scene's number of samples.
    "one-sample-fewer": "the number of samples is one less than the scene's",
        [SampleCondition = "i < SAMPLES - 1", MeanDivisor = "SAMPLES - 1"];
    /// Use the scene's number of samples.
    "one-sample-more": "the number of samples is one more than the scene's",
        [SampleCondition = "i <= SAMPLES", MeanDivisor = "SAMPLES + 1"];
    /// Divide by `float(SAMPLES)`.
    "samples-divisor-too-small": "the sum of the samples is divided by one less than their number",
        [MeanDivisor = "SAMPLES - 1"];
    /// Use `sum += …` in the loop, and divide by the number of samples after it.
    "last-sample-only": "only the last sample is kept instead of the mean of all samples",
        [SampleStatement = "color = «Sample»;", MeanStatement = ""];
    /// Include the index of the sample in the seed.
    "same-seed-for-all-samples": "all samples of a pixel use the same random numbers", [SampleIndex = "0"];
    /// Use `fragCoord + vec2(random(), random()) - 0.5`.
    "no-jitter": "samples are not jittered: all lie at the pixel's center",
        [SampleX = "fragCoord.x + 0.0 * random()", SampleY = "fragCoord.y + 0.0 * random()"];
    /// Subtract half a pixel: `fragCoord + vec2(random(), random()) - 0.5`.
    "jitter-not-centered": "samples are jittered from 0 to 1 instead of −0.5 to 0.5",
        [SampleX = "fragCoord.x + random()", SampleY = "fragCoord.y + random()"],
        [SampleX = "fragCoord.x + random()"],
        [SampleY = "fragCoord.y + random()"];
    /// Use `fragCoord + vec2(random(), random()) - 0.5`.
    "jitter-too-wide": "samples are jittered from −1 to 1 instead of −0.5 to 0.5",
        [SampleX = "fragCoord.x + 2.0 * random() - 1.0", SampleY = "fragCoord.y + 2.0 * random() - 1.0"];
    /// Use `fragCoord + vec2(random(), random()) - 0.5`.
    "samples-at-corner": "all samples lie at the pixel's corner",
        [SampleX = "fragCoord.x + 0.0 * random() - 0.5", SampleY = "fragCoord.y + 0.0 * random() - 0.5"];
    /// Assign x first: `float x = random(), y = random();`.
    "y-sampled-before-x": "the first random number jitters y instead of x",
        [SampleXStatement = "«SampleYStatement»", SampleYStatement = "«SampleXStatement»"];
    /// Jitter y with a random number of its own.
    "jitter-in-x-only": "samples are jittered only along x", [SampleY = "fragCoord.y"];
};

/// The background.
pub(super) static BACKGROUND: Group = mistakes! {
    /// Return the scene's background where a ray hits nothing.
    "black-background": "the background is black", [BackgroundColor = "vec3(0.0)"];
    /// Use `mix(bottom, top, 0.5 * (1.0 + d.y))`.
    "background-upside-down": "the background gradient is upside down",
        [BackgroundStatement = "direction.y = -direction.y;\n    …"];
    /// Use `mix(bottom, top, 0.5 * (1.0 + d.y))`.
    "background-y-not-remapped": "the background gradient uses y, which runs from −1 to 1, instead of 0.5 (1 + y)",
        [BackgroundHeight = "direction.y"];
    /// Use `d.y`: `0.5 * (1.0 + d.y)`.
    "background-along-x": "the background gradient runs along x instead of y",
        [BackgroundHeight = "0.5 * (1.0 + direction.x)"];
    /// Use `d.y`: `0.5 * (1.0 + d.y)`.
    "background-along-z": "the background gradient runs along z instead of y",
        [BackgroundHeight = "0.5 * (1.0 + direction.z)"];
    /// Use `throughput * background(ray.direction)`.
    "background-not-tinted": "the background seen in mirrors is not multiplied by the throughput",
        [BackgroundThroughMirrors = "background(«BackgroundDirection»)"];
    /// Pass the direction of the current ray to the background.
    "background-of-camera-ray": "the background seen in mirrors is that of the camera ray instead of the reflected ray",
        [BackgroundDirection = "direction"];
};

/// Figures on the screen.
pub(super) static FIGURES: Group = mistakes! {
    /// Use `dot(d, d) - radius * radius`.
    "disk-radius-not-squared": "the disk's radius is not squared", [DiskFunction = "dot(d, d) - radius"];
    /// Use `dot(d, d) - radius * radius < 0.0`.
    "disk-inside-out": "the outside of the disk is filled: its function has the wrong sign",
        [DiskFunction = "radius * radius - dot(d, d)"];
    /// Use `p.y - height - amplitude * sin(frequency * p.x) < 0.0`.
    "wave-filled-above": "the area above the wave is filled instead of the area below it",
        [WaveFunction = "height + amplitude * sin(frequency * p.x) - p.y"],
        [WaveFunction = "height - p.y + amplitude * sin(frequency * p.x)"];
    /// Use `p.y - height - amplitude * sin(frequency * p.x) < 0.0`.
    "wave-sign": "the sine of the wave has the wrong sign: crests and troughs are swapped",
        [WaveFunction = "p.y - height + amplitude * sin(frequency * p.x)"];
    /// Use `sin(frequency * p.x)`.
    "wave-with-2-pi": "the wave's frequency is multiplied by 2π, but it is in radians",
        [WaveFunction = "p.y - height - amplitude * sin(6.28318530718 * frequency * p.x)"];
    /// Use `sin(frequency * p.x)`.
    "wave-of-cosine": "the wave uses the cosine instead of the sine",
        [WaveFunction = "p.y - height - amplitude * cos(frequency * p.x)"];
    /// Use `r * r * r - q.x * q.x * q.y * q.y * q.y` with `r = dot(q, q) - 1.0`.
    "heart-upside-down": "the heart is upside down: the term x²y³ has the wrong sign",
        [HeartFunction = "ring * ring * ring + q.x * q.x * q.y * q.y * q.y"];
    /// Use `r * r * r - q.x * q.x * q.y * q.y * q.y` with `r = dot(q, q) - 1.0`.
    "heart-not-cubed": "the term x² + y² − 1 of the heart is not cubed",
        [HeartFunction = "ring - q.x * q.x * q.y * q.y * q.y"];
    /// Use `r * r * r - q.x * q.x * q.y * q.y * q.y` with `r = dot(q, q) - 1.0`.
    "heart-squared": "the term x² + y² − 1 of the heart is squared instead of cubed",
        [HeartFunction = "ring * ring - q.x * q.x * q.y * q.y * q.y"];
};
