//! Observations of a run: undefined operations, each with its source location, its number of pixels, and the
//! first pixel.

use std::collections::BTreeMap;

use toyproof_glsl::tree::Place;

use crate::batch::{LANES, Lanes};

/// Identifies a site: a fault at a source location.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct SiteId(pub(crate) u32);

/// A fault of an operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Fault {
    /// An index out of bounds: the last element is used.
    IndexOutOfBounds,
    /// An integer divided by zero: the result is the dividend, as naga guards it.
    DivisionByZero,
    /// The remainder by zero: the result is zero.
    RemainderByZero,
    /// Zero divided by zero where constant propagation sees both: each driver folds it to a value of its
    /// choice.
    ZeroByZero,
    /// A shift by 32 or more, or by a negative count: the lowest five bits of the count are used.
    ShiftTooFar,
    /// A float out of range of `int` or `uint`: the nearest representable value is used.
    IntegerOverflow,
    /// `smoothstep` between equal edges.
    EqualEdges,
    /// `smoothstep` with edge0 > edge1: all implementations compute the formula.
    ReversedEdges,
    /// `pow` of a negative base, or of zero to zero or less.
    PowDomain,
    /// `min`, `max` or `clamp` of NaN.
    NotANumber,
    /// `clamp` with its minimum above its maximum.
    ReversedClamp,
    /// `sqrt` of a negative number, `inversesqrt` of zero or less.
    RootDomain,
    /// `log` or `log2` of zero or less.
    LogDomain,
    /// `asin` or `acos` outside [−1, 1], `acosh` below 1, `atanh` outside (−1, 1).
    ArcDomain,
    /// `atan(0, 0)`.
    ArcOfNothing,
    /// The size of a mip level that the texture does not have.
    NoLevel,
    /// A texture lookup at coordinates that are infinite, NaN, or too large to identify a texel.
    NoPlace,
    /// A derivative in non-uniform control flow: not all pixels of the quad are active.
    LonelyDerivative,
    /// A read of an uninitialized variable: zero, as in WebGL.
    NeverWritten,
}

impl Fault {
    /// Whether implementations differ in the result, so that the pixel is excluded from comparisons.
    ///
    /// Roots, logarithms and inverse functions outside of their domain are NaN everywhere, reversed edges
    /// follow the formula, and uninitialized variables are zero in WebGL.
    #[must_use]
    pub fn is_undefined(self) -> bool {
        !matches!(
            self,
            Self::ReversedEdges
                | Self::RootDomain
                | Self::LogDomain
                | Self::ArcDomain
                | Self::ArcOfNothing
                | Self::NeverWritten
        )
    }

    /// Returns the description for messages, such as `an index out of bounds`.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::IndexOutOfBounds => "an index out of bounds",
            Self::DivisionByZero => "an integer division by zero",
            Self::RemainderByZero => "the remainder of an integer division by zero",
            Self::ZeroByZero => "a division of two constant zeros",
            Self::ShiftTooFar => "a shift by 32 bits or more, or by a negative number",
            Self::IntegerOverflow => "a conversion of a float that is out of range of the integer type",
            Self::EqualEdges => "`smoothstep` with equal edges",
            Self::ReversedEdges => "`smoothstep` with reversed edges",
            Self::PowDomain => "`pow` of a negative base, or of base 0 and an exponent ≤ 0",
            Self::NotANumber => "`min`, `max` or `clamp` of NaN",
            Self::ReversedClamp => "`clamp` with a minimum above the maximum",
            Self::RootDomain => "`sqrt` of a negative number, or `inversesqrt` of a number ≤ 0",
            Self::LogDomain => "the logarithm of a number ≤ 0",
            Self::ArcDomain => "an inverse function outside its domain",
            Self::ArcOfNothing => "`atan(0, 0)`",
            Self::NoLevel => "`textureSize` of a mip level that does not exist",
            Self::NoPlace => "a texture lookup at infinite, NaN or very large coordinates",
            Self::LonelyDerivative => "a derivative in non-uniform control flow",
            Self::NeverWritten => "a read of an uninitialized variable",
        }
    }
}

/// A fault that may occur at a source location.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Site {
    /// The fault.
    pub fault: Fault,
    /// The source location.
    pub at: Place,
}

/// The condition for a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Predicate {
    /// The word is at least this; negative indices are large words.
    AtLeast(u32),
    /// The word is zero.
    Zero,
    /// The float is out of range of `int`.
    NotInt,
    /// The float is out of range of `uint`.
    NotUint,
    /// At least one of the two is NaN.
    Unordered,
    /// The floats are equal.
    Equal,
    /// The first is greater than the second.
    Greater,
    /// The float is less than zero.
    Negative,
    /// The float is zero or less.
    NotPositive,
    /// The magnitude is greater than 1.
    BeyondOne,
    /// The magnitude is 1 or greater.
    AtLeastOne,
    /// The float is less than 1.
    BelowOne,
    /// Both are zero.
    BothZero,
    /// Both are zero; checked only where both operands are frame constants.
    ConstantZeros,
    /// `pow` is undefined.
    PowUndefined,
    /// The pixel is active and a pixel of its quad is not.
    PartialQuad,
}

/// The faults of a batch: for each site, a bit for each pixel.
#[derive(Debug, Clone, Default)]
pub(crate) struct Notes {
    pub(crate) sites: BTreeMap<SiteId, Vec<u16>>,
}

impl Notes {
    /// Adds the pixels of a chunk whose lanes are not zero.
    #[cold]
    pub(crate) fn add(&mut self, site: SiteId, chunk: usize, hit: &Lanes<u32>) {
        let chunks = self.sites.entry(site).or_default();
        if chunks.len() <= chunk {
            chunks.resize(chunk + 1, 0);
        }
        for (lane, &hit) in hit.iter().enumerate().take(LANES) {
            chunks[chunk] |= u16::from(hit != 0) << lane;
        }
    }
}

/// A fault observed at a site.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Observed {
    /// The fault and its source location.
    pub site: Site,
    /// The number of pixels.
    pub pixels: u64,
    /// The first of them, row by row from the bottom.
    pub first: [u32; 2],
}

/// The observations of a run.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Observations {
    /// The observed faults, in source order.
    pub faults: Vec<Observed>,
    /// The largest number of loop iterations of a pixel, all loops together.
    pub max_iterations: u32,
    /// The number of pixels that exceed the 65,535 iterations after which Mesa before version 23 ends all
    /// loops of a pixel.
    pub beyond_cap: u64,
}

/// The number of iterations after which Mesa before version 23 ends all loops of a pixel.
pub const MESA_CAP: u32 = 65_535;

impl Observations {
    /// Adds the loop iterations of pixels.
    #[inline(always)]
    pub(crate) fn count_iterations(&mut self, iterations: &[u32]) {
        let most = iterations.iter().copied().max().unwrap_or(0);
        self.max_iterations = self.max_iterations.max(most);
        if most > MESA_CAP {
            self.beyond_cap += iterations.iter().filter(|&&count| count > MESA_CAP).count() as u64;
        }
    }

    /// Adds the observations of a different part of the image.
    pub fn merge(&mut self, other: &Self) {
        self.max_iterations = self.max_iterations.max(other.max_iterations);
        self.beyond_cap += other.beyond_cap;
        for &new in &other.faults {
            match self.faults.iter_mut().find(|old| old.site == new.site) {
                None => {
                    let place = |observed: &Observed| (observed.site.at.span.start, observed.site.fault);
                    let after = self.faults.partition_point(|old| place(old) <= place(&new));
                    self.faults.insert(after, new);
                }
                Some(old) => {
                    old.pixels += new.pixels;
                    old.first = first_in_rows(old.first, new.first);
                }
            }
        }
    }
}

/// Returns the pixel that comes first, row by row from the bottom.
pub(crate) fn first_in_rows(a: [u32; 2], b: [u32; 2]) -> [u32; 2] {
    if (b[1], b[0]) < (a[1], a[0]) { b } else { a }
}
