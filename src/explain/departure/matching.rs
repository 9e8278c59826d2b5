//! Which floats of two shaders count as the same value.

use std::collections::HashSet;

/// The bits of a float that are ignored: the relative difference of equal values is below 2⁻¹⁸, far above the
/// rounding of double precision, and far below a visible difference.
const IGNORED_BITS: u32 = 52 - 18;

/// Floats below this are zeros, such as those that cancellation leaves.
const ZERO: f64 = 1e-9;

/// Which floats count as the same value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Matching {
    /// Those of double precision that differ by rounding.
    Rounded,
    /// Those with the same bits. The sign of a zero and the bits of NaN are open.
    Exact,
}

impl Matching {
    /// The bucket of a value: equal values have the same or neighboring ones.
    pub(super) fn bucket(self, value: f64) -> u64 {
        match self {
            Self::Rounded => {
                let value = if value.abs() < ZERO { 0.0 } else { value };
                (value.to_bits() + (1 << (IGNORED_BITS - 1))) >> IGNORED_BITS
            }
            Self::Exact if value == 0.0 => 0,
            Self::Exact if value.is_nan() => f64::NAN.to_bits(),
            Self::Exact => value.to_bits(),
        }
    }

    /// The buckets of the values that are equal to one of this bucket.
    pub(super) fn near(self, bucket: u64) -> [u64; 3] {
        let around = match self {
            Self::Rounded => 1,
            Self::Exact => 0,
        };
        [bucket.wrapping_sub(around), bucket, bucket + around]
    }
}

/// Whether a value, or one that counts as the same, is among these buckets.
pub(super) fn has(all: &HashSet<u64>, value: f64, matching: Matching) -> bool {
    let near = matching.near(matching.bucket(value));
    near.iter().any(|near| all.contains(near))
}
