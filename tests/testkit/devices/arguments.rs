//! The arguments at which functions are measured.

/// A range of arguments: the first and the last.
pub type Range = (f32, f32);

/// [−1, 1].
pub const UNIT: Range = (-1.0, 1.0);

/// The seed of the random arguments.
pub const SEED: u64 = 1;

/// Zeros, denormals, numbers next to the ends of ranges, and non-finite numbers.
const EDGES: [u32; 14] = [
    0,
    1,
    0x0000_1234,
    0x007f_ffff, // the largest denormal
    0x0080_0000, // the smallest normal float
    0x3f7f_ffff, // the float below 1
    0x3f80_0000,
    0x3f80_0001,
    0x4049_0fda, // the float below π
    0x4049_0fdb,
    0x4b80_0001, // 2²⁴ + 2
    0x7f7f_ffff, // the largest float
    0x7f80_0000, // infinity
    0x7fc0_0000, // NaN
];

/// A generator of random numbers: `SplitMix64`.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in the range.
    fn in_range(&mut self, (low, high): Range) -> f32 {
        let share = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        (f64::from(low) + share * (f64::from(high) - f64::from(low))) as f32
    }

    /// A float of any exponent, also a denormal.
    fn any_float(&mut self) -> f32 {
        loop {
            let float = f32::from_bits((self.next() >> 32) as u32);
            if float.is_finite() {
                return float;
            }
        }
    }
}

/// The edges and all powers of two, of both signs.
fn special() -> Vec<f32> {
    let powers = (-149..=127).map(|exponent| libm::ldexpf(1.0, exponent));
    let positive = EDGES.into_iter().map(f32::from_bits).chain(powers);
    positive.flat_map(|value| [value, -value]).collect()
}

/// `count` arguments of a function whose operands have these usual ranges, the same for every device. One
/// operand: all special numbers first. Several operands: special ones in an eighth of the cases. Of the rest,
/// every third case has floats of any exponent, and the others are in the usual ranges.
pub fn arguments(usual: &[Range], count: usize) -> Vec<Vec<f32>> {
    let mut random = Random(SEED);
    let special = special();
    let case = |index: usize| -> Vec<f32> {
        if let ([_], Some(&value)) = (usual, special.get(index)) {
            return vec![value];
        }
        if usual.len() > 1 && index.is_multiple_of(8) {
            return usual
                .iter()
                .map(|_| special[random.next() as usize % special.len()])
                .collect();
        }
        let mut operand = |&range: &Range| {
            if index.is_multiple_of(3) {
                random.any_float()
            } else {
                random.in_range(range)
            }
        };
        usual.iter().map(&mut operand).collect()
    };
    (0..count).map(case).collect()
}
