//! SIMD: one operation on as many numbers as the processor has lanes. Each lane has the same bits as a scalar
//! computation: nothing is fused or reordered, so that kernels give the same results on every processor.

mod instruction_set;
mod wide;

use std::fmt::Debug;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use std::marker::PhantomData;

use pulp::Scalar;
pub(super) use wide::{Columns, Wide, Wide3, lanes_of};

/// SIMD instructions for one number type.
pub trait Lanes<T>: Copy + Debug {
    /// One number per lane.
    type Numbers: Copy + Debug;
    /// One boolean per lane.
    type Mask: Copy + Debug;
    /// The same instructions with at most eight lanes.
    type Eight: Lanes<T>;

    /// Number of lanes: a power of two, at most `MAX_LANES`.
    const COUNT: usize;

    /// Returns the same instructions with at most eight lanes.
    fn eight(self) -> Self::Eight;
    /// Broadcasts a number to all lanes.
    fn splat(self, value: T) -> Self::Numbers;
    /// Loads the first numbers of a slice, which must hold at least one per lane.
    fn load(self, from: &[T]) -> Self::Numbers;
    /// Stores to the first elements of such a slice.
    fn store(self, numbers: Self::Numbers, to: &mut [T]);
    /// a + b
    fn add(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a − b
    fn sub(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a · b
    fn mul(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a / b
    fn div(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// −a
    fn neg(self, a: Self::Numbers) -> Self::Numbers;
    /// √a
    fn sqrt(self, a: Self::Numbers) -> Self::Numbers;
    /// |a|
    fn abs(self, a: Self::Numbers) -> Self::Numbers;
    /// Bitwise and.
    fn and(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// Bitwise or.
    fn or(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// Minimum; either operand if one is NaN.
    fn min(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// Maximum; either operand if one is NaN.
    fn max(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a < b
    fn less(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask;
    /// a ≤ b
    fn less_or_equal(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask;
    /// a = b
    fn equal(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask;
    /// Selects lane by lane.
    fn select(self, mask: Self::Mask, yes: Self::Numbers, no: Self::Numbers) -> Self::Numbers;
    /// Minimum over all lanes; any of them if one is NaN.
    fn reduce_min(self, a: Self::Numbers) -> T;
    /// Maximum over all lanes; any of them if one is NaN.
    fn reduce_max(self, a: Self::Numbers) -> T;
    /// Sum over all lanes. The order depends on the instruction set, so the result may only be compared with
    /// 0.
    fn reduce_sum(self, a: Self::Numbers) -> T;
    /// Converts a mask to bits: bit i is lane i.
    fn bits(self, mask: Self::Mask) -> u32;
    /// Converts bits to a mask: lane i is bit i.
    fn mask(self, bits: u32) -> Self::Mask;
}

/// Maximum number of lanes over all instruction sets.
pub(super) const MAX_LANES: usize = 16;

/// A computation that is generic over the instruction set.
pub trait Kernel<T> {
    /// The result.
    type Output;
    /// Runs the kernel. Implementations and all their callees must be inlined, since only then are they
    /// compiled for the instruction set.
    fn run<S: Lanes<T>>(self, simd: S) -> Self::Output;
}

/// The supported instruction sets.
#[derive(Debug, Clone, Copy)]
pub enum Level {
    /// One lane.
    Base,
    /// AVX2, without fused multiply-add.
    #[cfg(target_arch = "x86_64")]
    Avx2(pulp::x86::V3),
    /// AVX-512.
    #[cfg(target_arch = "x86_64")]
    Avx512(pulp::x86::V4),
    /// Neon.
    #[cfg(target_arch = "aarch64")]
    Neon(pulp::aarch64::Neon),
}

impl Level {
    /// Returns the best instruction set of this processor.
    pub(super) fn best() -> Self {
        Self::all().last().unwrap_or(Self::Base)
    }

    /// Iterates over the instruction sets of this processor, the best last.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let base = std::iter::once(Self::Base);
        #[cfg(target_arch = "x86_64")]
        let more = [
            pulp::x86::V3::try_new().map(Self::Avx2),
            pulp::x86::V4::try_new().map(Self::Avx512),
        ];
        #[cfg(target_arch = "aarch64")]
        let more = [pulp::aarch64::Neon::try_new().map(Self::Neon)];
        #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
        let more: [Option<Self>; 0] = [];
        base.chain(more.into_iter().flatten())
    }
}

/// A number type for which kernels exist.
pub trait Vectorized: Sized {
    /// Runs a kernel compiled for an instruction set.
    fn run<K: Kernel<Self>>(level: Level, kernel: K) -> K::Output;

    /// Runs a kernel with one lane.
    fn run_scalar<K: Kernel<Self>>(kernel: K) -> K::Output;
}

macro_rules! vectorized {
    ($($number:ty),*) => {
        $(impl Vectorized for $number {
            #[inline(always)]
            fn run_scalar<K: Kernel<Self>>(kernel: K) -> K::Output {
                kernel.run(Scalar)
            }

            #[inline(always)]
            fn run<K: Kernel<Self>>(level: Level, kernel: K) -> K::Output {
                match level {
                    Level::Base => kernel.run(Scalar),
                    #[cfg(target_arch = "x86_64")]
                    Level::Avx2(simd) => simd.vectorize(KernelCall(kernel, simd, PhantomData)),
                    #[cfg(target_arch = "x86_64")]
                    Level::Avx512(simd) => simd.vectorize(KernelCall(kernel, simd, PhantomData)),
                    #[cfg(target_arch = "aarch64")]
                    Level::Neon(simd) => simd.vectorize(KernelCall(kernel, simd, PhantomData)),
                }
            }
        }
        )*
    };
}
vectorized!(f32, f64);

/// A kernel and its instruction set, as pulp's closure type.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
struct KernelCall<T, K, S>(K, S, PhantomData<T>);

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
impl<T, K: Kernel<T>, S: Lanes<T>> pulp::NullaryFnOnce for KernelCall<T, K, S> {
    type Output = K::Output;

    #[inline(always)]
    fn call(self) -> K::Output {
        self.0.run(self.1)
    }
}
