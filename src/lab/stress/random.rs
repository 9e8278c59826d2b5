//! Numbers drawn from a seed.

/// Steele, Lea and Flood's `SplitMix64`, “Fast splittable pseudorandom number generators” (OOPSLA 2014).
#[derive(Debug, Clone)]
pub(super) struct Random(u64);

impl Random {
    /// The stream of a seed and of words that name what is drawn: the same numbers whatever else is drawn beside it.
    pub(super) fn new(seed: u64, words: &[&str]) -> Self {
        let mut random = Self(seed);
        for byte in words.iter().flat_map(|word| word.bytes().chain([0])) {
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

    /// In [0, 1).
    pub(super) fn number(&mut self) -> f64 {
        (self.next() >> 11) as f64 * 2f64.powi(-53)
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.number()
    }

    /// As often near 1 as near 1,000.
    pub(super) fn log_between(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// One of the numbers below `count`.
    pub(super) fn below(&mut self, count: usize) -> usize {
        (self.number() * count as f64) as usize
    }

    pub(super) fn sign(&mut self) -> f64 {
        if self.next() >> 63 == 0 { 1.0 } else { -1.0 }
    }

    /// A unit vector, all alike.
    pub(super) fn direction(&mut self) -> glam::DVec3 {
        let z = self.between(-1.0, 1.0);
        let (sine, cosine) = (std::f64::consts::TAU * self.number()).sin_cos();
        let rho = (1.0 - z * z).sqrt();
        glam::DVec3::new(rho * cosine, rho * sine, z)
    }

    /// The axes in a random order and with random signs applied to a vector: what turns it exactly.
    pub(super) fn turn(&mut self) -> impl Fn([f64; 3]) -> [f64; 3] + use<> {
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
