//! Instruction sets, based on pulp, which encapsulates their unsafe code.

use pulp::{Scalar, Simd};

use super::{Lanes, MAX_LANES};

/// An instruction set: the operations that pulp's trait lacks.
pub trait InstructionSet: Simd {
    /// The same instruction set with at most eight f32 lanes.
    type Eight32: InstructionSet;
    /// The same instruction set with at most eight f64 lanes.
    type Eight64: InstructionSet;
    /// Returns the same instruction set with at most eight f32 lanes.
    fn eight32(self) -> Self::Eight32;
    /// Returns the same instruction set with at most eight f64 lanes.
    fn eight64(self) -> Self::Eight64;
    /// Converts a mask of f32 lanes to bits: bit i is lane i.
    fn bits32(self, mask: Self::m32s) -> u32;
    /// Converts a mask of f64 lanes to bits: bit i is lane i.
    fn bits64(self, mask: Self::m64s) -> u32;
}

/// An instruction set that has at most eight lanes itself.
macro_rules! at_most_eight {
    ($($type:ident $function:ident),*) => {
        $(type $type = Self;
        #[inline(always)]
        fn $function(self) -> Self {
            self
        })*
    };
}

impl InstructionSet for Scalar {
    at_most_eight!(Eight32 eight32, Eight64 eight64);
    #[inline(always)]
    fn bits32(self, mask: bool) -> u32 {
        u32::from(mask)
    }
    #[inline(always)]
    fn bits64(self, mask: bool) -> u32 {
        u32::from(mask)
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use pulp::x86::{V3, V4};
    use pulp::{b8, b16, cast, m32x8, m64x4};

    use super::InstructionSet;

    impl InstructionSet for V3 {
        at_most_eight!(Eight32 eight32, Eight64 eight64);
        #[inline(always)]
        fn bits32(self, mask: m32x8) -> u32 {
            self.avx._mm256_movemask_ps(cast(mask)).cast_unsigned()
        }
        #[inline(always)]
        fn bits64(self, mask: m64x4) -> u32 {
            self.avx._mm256_movemask_pd(cast(mask)).cast_unsigned()
        }
    }

    impl InstructionSet for V4 {
        type Eight32 = V3;
        #[inline(always)]
        fn eight32(self) -> V3 {
            *self
        }
        at_most_eight!(Eight64 eight64);
        #[inline(always)]
        fn bits32(self, mask: b16) -> u32 {
            u32::from(mask.0)
        }
        #[inline(always)]
        fn bits64(self, mask: b8) -> u32 {
            u32::from(mask.0)
        }
    }
}

#[cfg(target_arch = "aarch64")]
mod aarch64 {
    use pulp::aarch64::Neon;
    use pulp::{cast, m32x4, m64x2};

    use super::InstructionSet;

    impl InstructionSet for Neon {
        at_most_eight!(Eight32 eight32, Eight64 eight64);
        #[inline(always)]
        fn bits32(self, mask: m32x4) -> u32 {
            let lanes: [u32; 4] = cast(mask);
            (lanes[0] & 1) | (lanes[1] & 2) | (lanes[2] & 4) | (lanes[3] & 8)
        }
        #[inline(always)]
        fn bits64(self, mask: m64x2) -> u32 {
            let lanes: [u64; 2] = cast(mask);
            ((lanes[0] & 1) | (lanes[1] & 2)) as u32
        }
    }
}

/// Bit i for lane i, as an integer of 32 bits per lane.
const LANE_BITS_32: [u32; MAX_LANES] = lane_bits();

/// Bit i for lane i, as an integer of 64 bits per lane.
const LANE_BITS_64: [u64; MAX_LANES] = {
    let (bits, mut wide, mut at) = (lane_bits(), [0; MAX_LANES], 0);
    while at < MAX_LANES {
        wide[at] = bits[at] as u64;
        at += 1;
    }
    wide
};

const fn lane_bits() -> [u32; MAX_LANES] {
    let (mut bits, mut at) = ([0; MAX_LANES], 0);
    while at < MAX_LANES {
        bits[at] = 1 << at;
        at += 1;
    }
    bits
}

macro_rules! lanes {
    ($number:ty, $numbers:ident, $mask:ident, $count:ident, $eight_type:ident, $eight:ident, $bits:ident,
     $splat:ident, $load:ident, $store:ident, $add:ident, $sub:ident, $mul:ident, $div:ident, $neg:ident,
     $sqrt:ident, $and:ident, $or:ident, $min:ident, $max:ident, $less:ident, $less_or_equal:ident, $equal:ident, $select:ident,
     $reduce_min:ident, $reduce_max:ident, $reduce_sum:ident, $abs:ident,
     $lane_bits:ident, $load_integers:ident, $splat_integer:ident, $and_integers:ident, $equal_integers:ident) => {
        impl<S: InstructionSet> Lanes<$number> for S {
            type Numbers = S::$numbers;
            type Mask = S::$mask;
            type Eight = S::$eight_type;
            const COUNT: usize = S::$count;
            #[inline(always)]
            fn eight(self) -> S::$eight_type {
                InstructionSet::$eight(self)
            }
            #[inline(always)]
            fn splat(self, value: $number) -> S::$numbers {
                Simd::$splat(self, value)
            }
            #[inline(always)]
            fn load(self, from: &[$number]) -> S::$numbers {
                S::$load(&from[..S::$count]).0[0]
            }
            #[inline(always)]
            fn store(self, numbers: S::$numbers, to: &mut [$number]) {
                S::$store(&mut to[..S::$count]).0[0] = numbers;
            }
            lanes!(binary $numbers, add $add, sub $sub, mul $mul, div $div, and $and, or $or, min $min, max $max);
            lanes!(unary $numbers, neg $neg, sqrt $sqrt, abs $abs);
            lanes!(reduction $number, $numbers, reduce_min $reduce_min, reduce_max $reduce_max, reduce_sum $reduce_sum);
            lanes!(comparison $numbers, $mask, less $less, less_or_equal $less_or_equal, equal $equal);
            #[inline(always)]
            fn select(self, mask: S::$mask, yes: S::$numbers, no: S::$numbers) -> S::$numbers {
                Simd::$select(self, mask, yes, no)
            }
            #[inline(always)]
            fn bits(self, mask: S::$mask) -> u32 {
                InstructionSet::$bits(self, mask)
            }
            #[inline(always)]
            fn mask(self, bits: u32) -> S::$mask {
                let lanes = S::$load_integers(&$lane_bits[..S::$count]).0[0];
                let bits = Simd::$splat_integer(self, bits.into());
                Simd::$equal_integers(self, Simd::$and_integers(self, bits, lanes), lanes)
            }
        }
    };
    (binary $numbers:ident, $($name:ident $pulp_name:ident),*) => {
        $(#[inline(always)]
        fn $name(self, a: S::$numbers, b: S::$numbers) -> S::$numbers {
            Simd::$pulp_name(self, a, b)
        })*
    };
    (comparison $numbers:ident, $mask:ident, $($name:ident $pulp_name:ident),*) => {
        $(#[inline(always)]
        fn $name(self, a: S::$numbers, b: S::$numbers) -> S::$mask {
            Simd::$pulp_name(self, a, b)
        })*
    };
    (reduction $number:ty, $numbers:ident, $($name:ident $pulp_name:ident),*) => {
        $(#[inline(always)]
        fn $name(self, a: S::$numbers) -> $number {
            Simd::$pulp_name(self, a)
        })*
    };
    (unary $numbers:ident, $($name:ident $pulp_name:ident),*) => {
        $(#[inline(always)]
        fn $name(self, a: S::$numbers) -> S::$numbers {
            Simd::$pulp_name(self, a)
        })*
    };
}

lanes! {
    f32, f32s, m32s, F32_LANES, Eight32, eight32, bits32, splat_f32s, as_simd_f32s, as_mut_simd_f32s,
    add_f32s, sub_f32s, mul_f32s, div_f32s, neg_f32s, sqrt_f32s, and_f32s, or_f32s, min_f32s, max_f32s,
    less_than_f32s, less_than_or_equal_f32s, equal_f32s, select_f32s, reduce_min_f32s, reduce_max_f32s,
    reduce_sum_f32s, abs_f32s, LANE_BITS_32, as_simd_u32s, splat_u32s, and_u32s, equal_u32s
}
lanes! {
    f64, f64s, m64s, F64_LANES, Eight64, eight64, bits64, splat_f64s, as_simd_f64s, as_mut_simd_f64s,
    add_f64s, sub_f64s, mul_f64s, div_f64s, neg_f64s, sqrt_f64s, and_f64s, or_f64s, min_f64s, max_f64s,
    less_than_f64s, less_than_or_equal_f64s, equal_f64s, select_f64s, reduce_min_f64s, reduce_max_f64s,
    reduce_sum_f64s, abs_f64s, LANE_BITS_64, as_simd_u64s, splat_u64s, and_u64s, equal_u64s
}
