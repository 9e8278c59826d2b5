//! Mistakes in secondary rays: mirrors, glass, and path tracing.

use super::geometry::TEXTBOOK;
use super::{Mistake, mistakes};

/// Mirrors.
pub(super) static MIRRORS: &[Mistake] = mistakes! {
    "no-reflection": "rays are not reflected: they pass straight through mirrors",
        [ReflectedDirection = "ray.direction"];
    "reflection-reversed": "the reflected direction is reversed", [ReflectedDirection = "-…"];
    "reflection-without-2": "the factor 2 is missing in the reflected direction d − 2(d·n)n",
        [ReflectedDirection = "normalize(ray.direction - dot(ray.direction, hit.normal) * hit.normal)"],
        [
            ReflectedDirection = "ray.direction - dot(ray.direction, hit.normal) * hit.normal",
            Discriminant = TEXTBOOK,
        ];
    "reflection-with-4": "the reflected direction is d − 4(d·n)n instead of d − 2(d·n)n",
        [ReflectedDirection = "normalize(ray.direction - 4.0 * dot(ray.direction, hit.normal) * hit.normal)"],
        [
            ReflectedDirection = "ray.direction - 4.0 * dot(ray.direction, hit.normal) * hit.normal",
            Discriminant = TEXTBOOK,
        ];
    "reflection-with-plus": "the reflected direction is d + 2(d·n)n instead of d − 2(d·n)n",
        [ReflectedDirection = "normalize(ray.direction + 2.0 * dot(ray.direction, hit.normal) * hit.normal)"],
        [
            ReflectedDirection = "ray.direction + 2.0 * dot(ray.direction, hit.normal) * hit.normal",
            Discriminant = TEXTBOOK,
        ];
    "reflection-origin-unchanged": "reflected rays start at the origin of the incoming ray instead of the hit point",
        [ReflectedOrigin = "ray.origin"],
        [SampledOrigin = "ray.origin"];
    "reflection-along-normal": "the normal is used as the reflected direction",
        [ReflectedDirection = "hit.normal"];
    "one-bounce-fewer": "paths end one bounce before the scene's maximum depth",
        [MirrorDepth = "depth < MAX_DEPTH - 1"];
    "one-bounce-only": "only one reflection is followed", [MirrorDepth = "depth < 2"];
    "two-bounces-only": "only two reflections are followed", [MirrorDepth = "depth < 3"];
    "background-after-one-bounce": "the background is shown after one reflection, even where the reflected ray hits a surface",
        [MirrorDepth = "depth < 2", ColorAfterLastMirror = "throughput * background(ray.direction)"];
    "background-after-last-bounce": "the background is shown after the last bounce instead of black",
        [ColorAfterLastMirror = "throughput * background(ray.direction)"];
    "mirror-colors-added": "the throughput adds the colors of mirrors instead of multiplying them",
        [MirrorStatement = "throughput += hit.color;"];
    "mirror-color-ignored": "the throughput is not multiplied by the mirror's color", [MirrorStatement = ""];
    "last-mirror-only": "the throughput is replaced by the last mirror's color instead of multiplied by it",
        [MirrorStatement = "throughput = hit.color;"];
};

/// Glass.
pub(super) static GLASS: &[Mistake] = mistakes! {
    "ior-ratio-inverted": "the ratio of the refractive indices is inverted",
        [EtaEntering = "«EtaLeaving»", EtaLeaving = "«EtaEntering»"];
    "ior-always-entering": "rays that leave the glass use the ratio of refractive indices of rays that enter it",
        [EtaLeaving = "1.0 / hit.ior"];
    "normal-not-flipped-inside": "the normal is not flipped where rays leave the glass",
        [
            GlassCosine = "-dot(ray.direction, hit.normal)",
            Refracted = "eta * ray.direction + (eta * cosine - beyond) * hit.normal",
        ];
    "refraction-without-normal": "the normal component of the refracted direction is missing",
        [Refracted = "normalize(eta * ray.direction)"],
        [Refracted = "eta * ray.direction", Discriminant = TEXTBOOK];
    "refraction-sign": "a sign is wrong in the refracted direction η d + (η cos θᵢ − cos θₜ) n",
        [Refracted = "normalize(eta * ray.direction + (eta * cosine + beyond) * side)"],
        [Refracted = "eta * ray.direction + (eta * cosine + beyond) * side", Discriminant = TEXTBOOK];
    "no-refraction": "rays are not refracted: they pass straight through glass",
        [Refracted = "ray.direction"];
    "no-glass-reflection": "the Fresnel reflectance of glass is always 0", [ReflectedShare = "0.0"];
    "glass-reflects-half": "the Fresnel reflectance of glass is always 0.5", [ReflectedShare = "0.5"];
    "constant-reflectance": "the Fresnel reflectance at normal incidence is used at every angle",
        [ReflectedShare = "(1.0 - eta) * (1.0 - eta) / ((1.0 + eta) * (1.0 + eta))"];
    "one-polarization": "the Fresnel reflectance uses one polarization instead of the mean of both",
        [Fresnel = "across * across"],
        [Fresnel = "along * along"];
    "fresnel-weights-swapped": "the weights of reflected and refracted light are swapped",
        [RefractedThroughput = "«ReflectedThroughput»", ReflectedThroughput = "«RefractedThroughput»"];
    "fresnel-weights-missing": "reflected and refracted light are added without their Fresnel weights",
        [RefractedThroughput = "throughput", ReflectedThroughput = "throughput"];
    "glass-color-ignored": "the color of the glass is ignored",
        [GlassColor = "(hit.model == GLASS ? vec3(1.0) : hit.color)"],
        [GlassColor = "(hit.model == SCHLICK ? vec3(1.0) : hit.color)"];
    "no-total-internal-reflection": "total internal reflection is missing: such rays are lost",
        [TotalReflection = ""];
};

/// Path tracing.
pub(super) static PATHS: &[Mistake] = mistakes! {
    "sampled-light-not-weighted": "sampled emitters have no MIS weight, so their light counts twice",
        [WeightedEmitter = "«UnweightedEmitter»"];
    "hit-light-not-weighted": "emitters hit by BRDF samples have no MIS weight, so their light counts twice",
        [EmitterShare = "1.0"];
    "mis-weights-missing": "MIS weights are missing, so all direct light counts twice",
        [WeightedEmitter = "«UnweightedEmitter»", EmitterShare = "1.0"];
    "sampled-light-missing": "the light of sampled emitters is not added",
        [EmitterStatement = "«EmitterSample»;"];
    "hit-light-missing": "the light of emitters hit by BRDF samples is not added",
        [EmitterShare = "0.0"];
    "emitter-count-ignored": "the density of light sampling does not include the probability of choosing the emitter",
        [ConeSolidAngle = "(2.0 * PI * coneDepth(point, emitter))"];
    "first-emitter-only": "only the first emitter is sampled",
        [EmitterChoice = "min(int(0.0 * random()), EMITTERS - 1)"];
    "density-of-sphere": "the density of diffuse directions is 1/(4π) instead of cos θ/π",
        [DiffuseDensity = "1.0 / (4.0 * PI)"];
    "density-of-hemisphere": "the density of diffuse directions is 1/(2π) instead of cos θ/π",
        [DiffuseDensity = "1.0 / (2.0 * PI)"];
    "uniform-instead-of-cosine-weighted": "diffuse directions are sampled uniformly, but the density is that of cosine-weighted sampling",
        [DiffuseCosine = "1.0 - u"];
    "lobe-around-normal": "glossy directions are sampled around the normal instead of the reflected direction",
        [LobeAxis = "hit.normal"];
    "exponent-without-1": "glossy directions are sampled with the exponent 1/n instead of 1/(n + 1)",
        [LobeExponent = "1.0 / hit.exponent"];
    "path-cosine-missing": "the cosine is missing in the throughput", [PathFactor = "«PathBrdf» / density"];
    "density-missing": "the throughput is not divided by the probability density",
        [PathFactor = "«PathBrdf» * cosine"];
    "one-bounce-fewer": "paths end one bounce before the scene's maximum depth",
        [PathDepth = "depth <= MAX_DEPTH - 1", PathIsAtEnd = "depth == MAX_DEPTH - 1"];
    "light-sampled-beyond-max-depth": "emitters are sampled even at the end of the last segment of a path",
        [PathIsAtEnd = "false"];
    "throughput-replaced": "the throughput is replaced at each bounce instead of multiplied",
        [PathStatement = "throughput = «PathFactor»;"];
    "light-visibility-missing": "emitters are sampled without a shadow ray, so they shine through objects",
        [EmitterHidden = "cosine <= 0.0"];
    "pi-missing-in-paths": "the diffuse BRDF is not divided by π, either for sampled emitters or in the throughput",
        [EmitterDiffuseBrdf = "hit.color"],
        [PathDiffuseBrdf = "hit.color"];
};
