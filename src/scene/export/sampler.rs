//! The numbers that samples draw.

use crate::Sampler;

pub(super) fn random(sampler: Sampler) -> String {
    if sampler == Sampler::SineHash {
        SINE_HASH.to_owned()
    } else {
        format!("{PCG}\n{INDEPENDENT}")
    }
}

const SINE_HASH: &str = "float seed;

float random() {
    return fract(sin(seed++) * 43758.5453123);
}
";

pub(super) const PCG: &str = "// The integer hash pcg (Jarzynski and Olano 2020).
uint pcg(uint v) {
    uint s = v * 747796405u + 2891336453u;
    uint word = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return (word >> 22u) ^ word;
}
";

const INDEPENDENT: &str = "uint state;

float random() {
    state = pcg(state);
    return float(state >> 8u) / 16777216.0;
}

void startSample(vec2 fragCoord, int i) {
    state = pcg(uint(fragCoord.x) + pcg(uint(fragCoord.y) + pcg(uint(i))));
}
";

pub(super) const AROUND: &str = "// The direction at an angle to w, given by its cosine, turned about w.
vec3 around(vec3 w, float cosine, float turn) {
    vec3 up = abs(w.y) > 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 a = normalize(cross(up, w));
    vec3 b = cross(w, a);
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float phi = 6.28318530718 * turn;
    return sine * cos(phi) * a + sine * sin(phi) * b + cosine * w;
}
";
