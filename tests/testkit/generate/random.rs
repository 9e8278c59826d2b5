//! Random programs, the same for each seed.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng};

use super::{Arithmetic, Effects, program};

/// Generates programs from at most `longest` decisions.
pub fn programs(effects: Effects, arithmetic: Arithmetic, longest: usize) -> impl Strategy<Value = String> {
    (8..longest)
        .prop_flat_map(|length| vec(any::<u8>(), length / 2..=length))
        .prop_map(move |bytes| program(&bytes, effects, arithmetic))
}

/// The random numbers of a seed.
pub fn rng(seed: u64) -> TestRng {
    let mut seeds = [0; 32];
    seeds[..8].copy_from_slice(&seed.to_le_bytes());
    TestRng::from_seed(RngAlgorithm::ChaCha, &seeds)
}

/// Where operands of a program with this number may have side effects: programs alternate.
pub fn effects(number: u32) -> Effects {
    if number.is_multiple_of(2) {
        Effects::Ordered
    } else {
        Effects::Anywhere
    }
}
