//! Seeded random numbers.

use glam::DVec3;

/// Steele, Lea and Flood's `SplitMix64`, “Fast splittable pseudorandom number generators” (OOPSLA 2014).
#[derive(Debug, Clone)]
pub(crate) struct Random(u64);

impl Random {
    /// A stream of numbers for a seed and labels: independent of all other streams.
    pub(crate) fn new(seed: u64, labels: &[&str]) -> Self {
        let mut random = Self(seed);
        for byte in labels.iter().flat_map(|label| label.bytes().chain([0])) {
            random.0 ^= u64::from(byte);
            random.0 = random.next();
        }
        random
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 * 2f64.powi(-53)
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A number with a uniformly distributed logarithm.
    pub(crate) fn log_between(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// An integer in [0, count).
    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    pub(crate) fn sign(&mut self) -> f64 {
        if self.next() >> 63 == 0 { 1.0 } else { -1.0 }
    }

    /// A uniformly distributed unit vector.
    pub(crate) fn direction(&mut self) -> DVec3 {
        let z = self.between(-1.0, 1.0);
        let (sine, cosine) = (std::f64::consts::TAU * self.unit()).sin_cos();
        let rho = (1.0 - z * z).sqrt();
        DVec3::new(rho * cosine, rho * sine, z)
    }

    /// A random permutation of the axes with random signs: an exact rotation or reflection.
    pub(crate) fn rotation(&mut self) -> impl Fn([f64; 3]) -> [f64; 3] + use<> {
        let first = self.below(3);
        let step = 1 + self.below(2);
        let signs = [self.sign(), self.sign(), self.sign()];
        move |v| {
            let mut turned = [0.0; 3];
            for (i, value) in v.into_iter().enumerate() {
                turned[(first + i * step) % 3] = signs[i] * value;
            }
            turned
        }
    }
}
