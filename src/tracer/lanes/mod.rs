//! Numbers side by side: the same operation on as many as the processor has lanes for, with the bits in each lane that
//! it has alone. Nothing is fused and nothing is put in another order, so that a kernel says the same on every processor.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a kernel is compiled for its instruction set"
)]

mod columns;
mod length;
mod set;
mod wide;

use std::fmt::Debug;
use std::marker::PhantomData;

pub(super) use columns::Columns;
use pulp::Scalar;
pub(super) use wide::{Wide, Wide3};

/// Instructions on several numbers of one type at once.
pub trait Lanes<T>: Copy + Debug {
    /// A number for each lane.
    type Numbers: Copy + Debug;
    /// A yes or no for each lane.
    type Mask: Copy + Debug;
    /// The same instructions for at most eight lanes.
    type Eight: Lanes<T>;

    /// How many lanes there are: a power of two, at most `MOST_LANES`.
    const COUNT: usize;

    /// The same instructions for at most eight lanes.
    fn eight(self) -> Self::Eight;
    /// One number in all lanes.
    fn splat(self, value: T) -> Self::Numbers;
    /// The first of a slice that has at least as many as there are lanes.
    fn load(self, from: &[T]) -> Self::Numbers;
    /// To the first of such a slice.
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
    /// Bit by bit.
    fn and(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// Bit by bit.
    fn or(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// The smaller; any of the two where one is NaN.
    fn min(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// The larger; any of the two where one is NaN.
    fn max(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a < b
    fn less(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask;
    /// a ≤ b
    fn less_or_equal(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask;
    /// a = b
    fn equal(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask;
    /// Lane by lane.
    fn select(self, mask: Self::Mask, yes: Self::Numbers, no: Self::Numbers) -> Self::Numbers;
    /// The smallest of all lanes; any of them where one is NaN.
    fn least(self, a: Self::Numbers) -> T;
    /// The largest, likewise.
    fn greatest(self, a: Self::Numbers) -> T;
    /// The sum, in an order that depends on the instruction set: to be asked only whether it is 0.
    fn sum(self, a: Self::Numbers) -> T;
    /// Bit i tells of lane i.
    fn bits(self, mask: Self::Mask) -> u32;
}

/// The most lanes of any instruction set.
pub(super) const MOST_LANES: usize = 16;

/// Something to do with an instruction set.
pub trait Kernel<T> {
    /// What comes out.
    type Output;
    /// Does it. To be inlined always, with all that it calls: only so is it compiled for the instruction set.
    fn run<S: Lanes<T>>(self, simd: S) -> Self::Output;
}

/// The instruction sets that there are code paths for.
#[derive(Debug, Clone, Copy)]
pub enum Level {
    /// One lane.
    Base,
    /// AVX2, without its fused operations.
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
    /// The best that this processor has.
    pub(super) fn best() -> Self {
        Self::all().last().unwrap_or(Self::Base)
    }

    /// Those that it has, the best last.
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

/// A number type that kernels exist for.
pub trait Vectorised: Sized {
    /// Runs a kernel compiled for that instruction set.
    fn run<K: Kernel<Self>>(level: Level, kernel: K) -> K::Output;
}

macro_rules! vectorised {
    ($($number:ty),*) => {
        $(impl Vectorised for $number {
            #[inline(always)]
            fn run<K: Kernel<Self>>(level: Level, kernel: K) -> K::Output {
                match level {
                    Level::Base => kernel.run(Scalar),
                    #[cfg(target_arch = "x86_64")]
                    Level::Avx2(simd) => simd.vectorize(Call(kernel, simd, PhantomData)),
                    #[cfg(target_arch = "x86_64")]
                    Level::Avx512(simd) => simd.vectorize(Call(kernel, simd, PhantomData)),
                    #[cfg(target_arch = "aarch64")]
                    Level::Neon(simd) => simd.vectorize(Call(kernel, simd, PhantomData)),
                }
            }
        }
        )*
    };
}
vectorised!(f32, f64);

/// A kernel and its instruction set, to be compiled for it.
struct Call<T, K, S>(K, S, PhantomData<T>);

impl<T, K: Kernel<T>, S: Lanes<T>> pulp::NullaryFnOnce for Call<T, K, S> {
    type Output = K::Output;

    #[inline(always)]
    fn call(self) -> K::Output {
        self.0.run(self.1)
    }
}
