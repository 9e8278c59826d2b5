//! Mistakes in secondary rays: mirrors, glass, and path tracing.

use super::geometry::TEXTBOOK;
use super::{Group, mistakes};

/// Mirrors.
pub(super) static MIRRORS: Group = mistakes! {
    /// Use `reflect(d, n)` as the new direction.
    "no-reflection": "rays are not reflected: they pass straight through mirrors",
        [ReflectedDirection = "ray.direction"];
    /// Use `reflect(d, n)`, where d points toward the surface; do not negate the result.
    "reflection-reversed": "the reflected direction is reversed", [ReflectedDirection = "-…"];
    /// Use `d - 2.0 * dot(d, n) * n`, or `reflect(d, n)`.
    "reflection-without-2": "the factor 2 is missing in the reflected direction d − 2(d·n)n",
        [ReflectedDirection = "normalize(ray.direction - dot(ray.direction, hit.normal) * hit.normal)"],
        [
            ReflectedDirection = "ray.direction - dot(ray.direction, hit.normal) * hit.normal",
            Discriminant = TEXTBOOK,
        ];
    /// Use `d - 2.0 * dot(d, n) * n`, or `reflect(d, n)`.
    "reflection-with-4": "the reflected direction is d − 4(d·n)n instead of d − 2(d·n)n",
        [ReflectedDirection = "normalize(ray.direction - 4.0 * dot(ray.direction, hit.normal) * hit.normal)"],
        [
            ReflectedDirection = "ray.direction - 4.0 * dot(ray.direction, hit.normal) * hit.normal",
            Discriminant = TEXTBOOK,
        ];
    /// Use `d - 2.0 * dot(d, n) * n`, or `reflect(d, n)`.
    "reflection-with-plus": "the reflected direction is d + 2(d·n)n instead of d − 2(d·n)n",
        [ReflectedDirection = "normalize(ray.direction + 2.0 * dot(ray.direction, hit.normal) * hit.normal)"],
        [
            ReflectedDirection = "ray.direction + 2.0 * dot(ray.direction, hit.normal) * hit.normal",
            Discriminant = TEXTBOOK,
        ];
    /// Set the origin to the hit point: `ray.origin = point + 1e-3 * normal`.
    "reflection-origin-unchanged": "reflected rays start at the origin of the incoming ray instead of the hit point",
        [ReflectedOrigin = "ray.origin"],
        [SampledOrigin = "ray.origin"];
    /// Use `reflect(d, n)`.
    "reflection-along-normal": "the normal is used as the reflected direction",
        [ReflectedDirection = "hit.normal"];
    "one-bounce-fewer": "paths end one bounce before the scene's maximum depth",
        [MirrorDepth = "depth < MAX_DEPTH - 1"];
    /// Reflect in a loop of `max_depth` iterations.
    "one-bounce-only": "only one reflection is followed", [MirrorDepth = "depth < 2"];
    /// Reflect in a loop of `max_depth` iterations.
    "two-bounces-only": "only two reflections are followed", [MirrorDepth = "depth < 3"];
    /// Find the nearest hit of the reflected ray, too; show the background only where it hits nothing.
    "background-after-one-bounce": "the background is shown after one reflection, even where the reflected ray hits a surface",
        [MirrorDepth = "depth < 2", ColorAfterLastMirror = "throughput * background(ray.direction)"];
    /// Return black when the maximum depth is reached.
    "background-after-last-bounce": "the background is shown after the last bounce instead of black",
        [ColorAfterLastMirror = "throughput * background(ray.direction)"];
    /// Use `throughput *= color`.
    "mirror-colors-added": "the throughput adds the colors of mirrors instead of multiplying them",
        [MirrorStatement = "throughput += hit.color;"];
    /// Use `throughput *= color` at each mirror.
    "mirror-color-ignored": "the throughput is not multiplied by the mirror's color", [MirrorStatement = ""];
    /// Use `throughput *= color` instead of `throughput = color`.
    "last-mirror-only": "the throughput is replaced by the last mirror's color instead of multiplied by it",
        [MirrorStatement = "throughput = hit.color;"];
};

/// Glass.
pub(super) static GLASS: Group = mistakes! {
    /// Use `eta = 1.0 / ior` where the ray enters and `eta = ior` where it leaves.
    "ior-ratio-inverted": "the ratio of the refractive indices is inverted",
        [EtaEntering = "«EtaLeaving»", EtaLeaving = "«EtaEntering»"];
    /// Test the side: `eta = dot(d, n) < 0.0 ? 1.0 / ior : ior`.
    "ior-always-entering": "rays that leave the glass use the ratio of refractive indices of rays that enter it",
        [EtaLeaving = "1.0 / hit.ior"];
    /// Use `dot(d, n) < 0.0 ? n : -n` for the cosine and the refracted direction.
    "normal-not-flipped-inside": "the normal is not flipped where rays leave the glass",
        [
            GlassCosine = "-dot(ray.direction, hit.normal)",
            Refracted = "eta * ray.direction + (eta * cosine - beyond) * hit.normal",
        ];
    /// Use `eta * d + (eta * c - cosT) * n` with `c = -dot(d, n)`, or `refract(d, n, eta)`.
    "refraction-without-normal": "the normal component of the refracted direction is missing",
        [Refracted = "normalize(eta * ray.direction)"],
        [Refracted = "eta * ray.direction", Discriminant = TEXTBOOK];
    /// Use `eta * d + (eta * c - cosT) * n` with `c = -dot(d, n)`, or `refract(d, n, eta)`.
    "refraction-sign": "a sign is wrong in the refracted direction η d + (η cos θᵢ − cos θₜ) n",
        [Refracted = "normalize(eta * ray.direction + (eta * cosine + beyond) * side)"],
        [Refracted = "eta * ray.direction + (eta * cosine + beyond) * side", Discriminant = TEXTBOOK];
    /// Use `refract(d, n, eta)` as the direction of the transmitted ray.
    "no-refraction": "rays are not refracted: they pass straight through glass",
        [Refracted = "ray.direction"];
    /// Compute the reflectance from the angle and trace a reflected ray as well.
    "no-glass-reflection": "the Fresnel reflectance of glass is always 0", [ReflectedShare = "0.0"];
    /// Compute the reflectance from the angle, with the Fresnel equations or Schlick's approximation.
    "glass-reflects-half": "the Fresnel reflectance of glass is always 0.5", [ReflectedShare = "0.5"];
    /// Compute the reflectance from the angle; Schlick: `r0 + (1.0 - r0) * pow(1.0 - c, 5.0)`.
    "constant-reflectance": "the Fresnel reflectance at normal incidence is used at every angle",
        [ReflectedShare = "(1.0 - eta) * (1.0 - eta) / ((1.0 + eta) * (1.0 + eta))"];
    /// Use `0.5 * (rs * rs + rp * rp)`.
    "one-polarization": "the Fresnel reflectance uses one polarization instead of the mean of both",
        [Fresnel = "across * across"],
        [Fresnel = "along * along"];
    /// Weight the reflected ray by the reflectance F and the refracted one by `1.0 - F`.
    "fresnel-weights-swapped": "the weights of reflected and refracted light are swapped",
        [RefractedThroughput = "«ReflectedThroughput»", ReflectedThroughput = "«RefractedThroughput»"];
    /// Weight the reflected ray by the reflectance F and the refracted one by `1.0 - F`.
    "fresnel-weights-missing": "reflected and refracted light are added without their Fresnel weights",
        [RefractedThroughput = "throughput", ReflectedThroughput = "throughput"];
    /// Multiply the throughput by the glass color at each hit.
    "glass-color-ignored": "the color of the glass is ignored",
        [GlassColor = "(hit.model == GLASS ? vec3(1.0) : hit.color)"],
        [GlassColor = "(hit.model == SCHLICK ? vec3(1.0) : hit.color)"];
    /// Where `1.0 - eta * eta * (1.0 - c * c)` is negative, reflect all light.
    "no-total-internal-reflection": "total internal reflection is missing: such rays are lost",
        [TotalReflection = ""];
};

/// Path tracing.
pub(super) static PATHS: Group = mistakes! {
    /// Multiply their light by the MIS weight `w = p1² / (p1² + p2²)`, with p1 the density of light sampling
    /// and p2 that of the BRDF.
    "sampled-light-not-weighted": "sampled emitters have no MIS weight, so their light counts twice",
        [WeightedEmitter = "«UnweightedEmitter»"];
    /// Multiply their light by the MIS weight `w = p2² / (p1² + p2²)`, with p1 the density of light sampling
    /// and p2 that of the BRDF.
    "hit-light-not-weighted": "emitters hit by BRDF samples have no MIS weight, so their light counts twice",
        [EmitterShare = "1.0"];
    /// Weight both strategies: `w1 = p1² / (p1² + p2²)` and `w2 = 1 - w1`.
    "mis-weights-missing": "MIS weights are missing, so all direct light counts twice",
        [WeightedEmitter = "«UnweightedEmitter»", EmitterShare = "1.0"];
    /// At each diffuse or glossy hit, add `throughput * sampleLight(hit)`.
    "sampled-light-missing": "the light of sampled emitters is not added",
        [EmitterStatement = "«EmitterSample»;"];
    /// Where a path hits an emitter, add its light with the MIS weight.
    "hit-light-missing": "the light of emitters hit by BRDF samples is not added",
        [EmitterShare = "0.0"];
    /// Divide the density by the number of emitters.
    "emitter-count-ignored": "the density of light sampling does not include the probability of choosing the emitter",
        [ConeSolidAngle = "(2.0 * PI * coneDepth(point, emitter))"];
    /// Choose an emitter at random: `int(random() * float(EMITTERS))`.
    "first-emitter-only": "only the first emitter is sampled",
        [EmitterChoice = "min(int(0.0 * random()), EMITTERS - 1)"];
    /// With cosine-weighted sampling, the density is `cosine / PI`.
    "density-of-sphere": "the density of diffuse directions is 1/(4π) instead of cos θ/π",
        [DiffuseDensity = "1.0 / (4.0 * PI)"];
    /// With cosine-weighted sampling, the density is `cosine / PI`.
    "density-of-hemisphere": "the density of diffuse directions is 1/(2π) instead of cos θ/π",
        [DiffuseDensity = "1.0 / (2.0 * PI)"];
    /// Use cosine-weighted directions: `cosine = sqrt(1.0 - u)`.
    "uniform-instead-of-cosine-weighted": "diffuse directions are sampled uniformly, but the density is that of cosine-weighted sampling",
        [DiffuseCosine = "1.0 - u"];
    /// Use `reflect(d, n)` as the axis of the lobe.
    "lobe-around-normal": "glossy directions are sampled around the normal instead of the reflected direction",
        [LobeAxis = "hit.normal"];
    /// Use `cosine = pow(1.0 - u, 1.0 / (n + 1.0))`.
    "exponent-without-1": "glossy directions are sampled with the exponent 1/n instead of 1/(n + 1)",
        [LobeExponent = "1.0 / hit.exponent"];
    /// Use `throughput *= brdf * cosine / density`.
    "path-cosine-missing": "the cosine is missing in the throughput", [PathFactor = "«PathBrdf» / density"];
    /// Use `throughput *= brdf * cosine / density`.
    "density-missing": "the throughput is not divided by the probability density",
        [PathFactor = "«PathBrdf» * cosine"];
    "one-bounce-fewer": "paths end one bounce before the scene's maximum depth",
        [PathDepth = "depth <= MAX_DEPTH - 1", PathIsAtEnd = "depth == MAX_DEPTH - 1"];
    /// Stop at the scene's `max_depth` before emitters are sampled.
    "light-sampled-beyond-max-depth": "emitters are sampled even at the end of the last segment of a path",
        [PathIsAtEnd = "false"];
    /// Use `throughput *= …` instead of `throughput = …`.
    "throughput-replaced": "the throughput is replaced at each bounce instead of multiplied",
        [PathStatement = "throughput = «PathFactor»;"];
    /// Add the light only if a shadow ray reaches the emitter.
    "light-visibility-missing": "emitters are sampled without a shadow ray, so they shine through objects",
        [EmitterHidden = "cosine <= 0.0"];
    /// Use `color / PI` in both places.
    "pi-missing-in-paths": "the diffuse BRDF is not divided by π, either for sampled emitters or in the throughput",
        [EmitterDiffuseBrdf = "hit.color"],
        [PathDiffuseBrdf = "hit.color"];
};
