//! Mistakes where rays go on from a surface: mirrors, glass, and path tracing.

use super::geometry::TEXTBOOK;
use super::{Mistake, mistakes};

/// Mirrors.
pub(super) static MIRRORS: &[Mistake] = mistakes! {
    "no-reflection": "does not turn reflected rays: they go straight on",
        [ReflectedDirection = "ray.direction"];
    "reflection-sign": "has the reflected direction backwards", [ReflectedDirection = "-…"];
    "reflection-without-2": "forgets the 2 in the reflected direction d − 2(d·n)n",
        [ReflectedDirection = "normalize(ray.direction - dot(ray.direction, hit.normal) * hit.normal)"],
        [
            ReflectedDirection = "ray.direction - dot(ray.direction, hit.normal) * hit.normal",
            Discriminant = TEXTBOOK,
        ];
    "reflection-with-4": "has a 4 for the 2 in the reflected direction d − 2(d·n)n",
        [ReflectedDirection = "normalize(ray.direction - 4.0 * dot(ray.direction, hit.normal) * hit.normal)"],
        [
            ReflectedDirection = "ray.direction - 4.0 * dot(ray.direction, hit.normal) * hit.normal",
            Discriminant = TEXTBOOK,
        ];
    "reflection-with-plus": "has d + 2(d·n)n for the reflected direction d − 2(d·n)n",
        [ReflectedDirection = "normalize(ray.direction + 2.0 * dot(ray.direction, hit.normal) * hit.normal)"],
        [
            ReflectedDirection = "ray.direction + 2.0 * dot(ray.direction, hit.normal) * hit.normal",
            Discriminant = TEXTBOOK,
        ];
    "reflection-from-the-eye": "starts reflected rays at the eye",
        [ReflectedOrigin = "ray.origin"],
        [SampledOrigin = "ray.origin"];
    "reflection-along-the-normal": "reflects every ray along the normal", [ReflectedDirection = "hit.normal"];
    "one-reflection-short": "follows one reflection less than the scene has",
        [MirrorDepth = "depth < MAX_DEPTH - 1"];
    "one-bounce-only": "follows one reflection only", [MirrorDepth = "depth < 2"];
    "two-bounces-only": "follows two reflections only", [MirrorDepth = "depth < 3"];
    "background-after-one-bounce": "shows the background after one reflection, whatever the ray meets then",
        [MirrorDepth = "depth < 2", ColorAfterLastMirror = "throughput * background(ray.direction)"];
    "background-after-the-last-bounce": "shows the background after the last reflection, where the scene has black",
        [ColorAfterLastMirror = "throughput * background(ray.direction)"];
    "mirrors-added": "adds the colours of mirrors up, where they should multiply",
        [MirrorStatement = "throughput += hit.color;"];
    "mirrors-without-colour": "forgets the mirrors' colour", [MirrorStatement = ""];
    "last-mirror-only": "keeps the last mirror's colour only, where all should multiply",
        [MirrorStatement = "throughput = hit.color;"];
};

/// Glass.
pub(super) static GLASS: &[Mistake] = mistakes! {
    "index-upside-down": "has the index of refraction the other way up",
        [EtaEntering = "«EtaLeaving»", EtaLeaving = "«EtaEntering»"];
    "index-always-entering": "takes every ray for one that enters the glass", [EtaLeaving = "1.0 / hit.ior"];
    "normal-not-turned-inside": "does not turn the normal where a ray leaves the glass",
        [
            GlassCosine = "-dot(ray.direction, hit.normal)",
            Refracted = "eta * ray.direction + (eta * cosine - beyond) * hit.normal",
        ];
    "refraction-without-normal": "forgets the part of the refracted direction along the normal",
        [Refracted = "normalize(eta * ray.direction)"],
        [Refracted = "eta * ray.direction", Discriminant = TEXTBOOK];
    "refraction-sign": "has the wrong sign in Snell's law",
        [Refracted = "normalize(eta * ray.direction + (eta * cosine + beyond) * side)"],
        [Refracted = "eta * ray.direction + (eta * cosine + beyond) * side", Discriminant = TEXTBOOK];
    "no-refraction": "does not bend rays in glass: they go straight on", [Refracted = "ray.direction"];
    "glass-reflects-nothing": "lets glass reflect nothing", [ReflectedShare = "0.0"];
    "glass-reflects-half": "lets glass reflect half of the light at every angle", [ReflectedShare = "0.5"];
    "glass-reflects-4-percent": "lets glass reflect as much at every angle as straight on",
        [ReflectedShare = "(1.0 - eta) * (1.0 - eta) / ((1.0 + eta) * (1.0 + eta))"];
    "one-polarisation": "counts one polarisation only, where Fresnel's equations take the mean of two",
        [Fresnel = "across * across"],
        [Fresnel = "along * along"];
    "shares-swapped": "has the shares of reflected and refracted light exchanged",
        [RefractedThroughput = "«ReflectedThroughput»", ReflectedThroughput = "«RefractedThroughput»"];
    "shares-forgotten": "adds up reflected and refracted light without their shares",
        [RefractedThroughput = "throughput", ReflectedThroughput = "throughput"];
    "glass-without-colour": "forgets the colour of the glass",
        [GlassColor = "(hit.model == GLASS ? vec3(1.0) : hit.color)"],
        [GlassColor = "(hit.model == SCHLICK ? vec3(1.0) : hit.color)"];
    "no-total-reflection": "loses the rays that glass reflects totally", [TotalReflection = ""];
};

/// Path tracing.
pub(super) static PATHS: &[Mistake] = mistakes! {
    "light-not-weighted": "does not weigh the light of the emitters that it draws, so that it counts twice",
        [WeightedEmitter = "«UnweightedEmitter»"];
    "found-light-not-weighted": "does not weigh the light of the emitters that it finds by chance, so that it counts twice",
        [EmitterShare = "1.0"];
    "light-not-weighted-at-all": "weighs no light, so that all counts twice",
        [WeightedEmitter = "«UnweightedEmitter»", EmitterShare = "1.0"];
    "emitters-not-drawn": "does not count the light of the emitters that it draws",
        [EmitterStatement = "«EmitterSample»;"];
    "found-light-not-counted": "does not count the light of the emitters that it finds by chance",
        [EmitterShare = "0.0"];
    "number-of-emitters-forgotten": "forgets in the density that there are several emitters",
        [ConeSolidAngle = "(2.0 * PI * coneDepth(point, emitter))"];
    "first-emitter-only": "draws the first emitter always",
        [EmitterChoice = "min(int(0.0 * random()), EMITTERS - 1)"];
    "density-of-a-sphere": "has the density of a whole sphere for diffuse directions",
        [DiffuseDensity = "1.0 / (4.0 * PI)"];
    "density-of-a-half-space": "has the density of a half space for diffuse directions",
        [DiffuseDensity = "1.0 / (2.0 * PI)"];
    "directions-uniform": "draws diffuse directions uniformly over the half space, though their density is said to be the cosine's",
        [DiffuseCosine = "1.0 - u"];
    "lobe-around-the-normal": "draws glossy directions around the normal, not around the reflected direction",
        [LobeAxis = "hit.normal"];
    "exponent-without-1": "forgets the 1 in the exponent by which glossy directions are drawn",
        [LobeExponent = "1.0 / hit.exponent"];
    "path-cosine-forgotten": "forgets the cosine where a path goes on", [PathFactor = "«PathBrdf» / density"];
    "density-forgotten": "does not divide by the density where a path goes on",
        [PathFactor = "«PathBrdf» * cosine"];
    "path-one-segment-short": "follows paths for one segment less than the scene has",
        [PathDepth = "depth <= MAX_DEPTH - 1", PathIsAtEnd = "depth == MAX_DEPTH - 1"];
    "light-one-segment-too-far": "looks for light at the end of the last segment, too",
        [PathIsAtEnd = "false"];
    "throughput-not-kept": "forgets what surfaces before the last have absorbed",
        [PathStatement = "throughput = «PathFactor»;"];
    "emitters-through-everything": "sees emitters through everything", [EmitterHidden = "cosine <= 0.0"];
    "pi-forgotten-in-paths": "forgets to divide the BRDF by π where light is looked for, or where a path goes on",
        [EmitterDiffuseBrdf = "hit.color"],
        [PathDiffuseBrdf = "hit.color"];
};
