//! The numbers that samples draw.

use crate::scene::Sampler;

pub(super) fn random(sampler: Sampler) -> &'static str {
    if sampler == Sampler::SineHash {
        SINE_HASH
    } else {
        INDEPENDENT
    }
}

const SINE_HASH: &str = "float seed;

float random() {
    return fract(sin(seed++) * 43758.5453123);
}
";

const INDEPENDENT: &str = "uint state;

// The integer hash pcg (Jarzynski and Olano 2020).
uint pcg(uint v) {
    uint s = v * 747796405u + 2891336453u;
    uint word = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return (word >> 22u) ^ word;
}

float random() {
    state = pcg(state);
    return float(state >> 8u) / 16777216.0;
}

void startSample(vec2 fragCoord, int i) {
    state = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))));
}
";
