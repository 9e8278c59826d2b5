//! What a run notes beside the picture: operations that GLSL leaves undefined, each with its place, its pixels and the first of them.

use std::collections::BTreeMap;

use toyproof_glsl::tree::Place;

use crate::batch::{LANES, Lanes};

/// Names a place where something may be noted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct SiteId(pub(crate) u32);

/// What can be wrong with an operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Fault {
    /// An index that names no element; the last one is taken.
    IndexOutOfBounds,
    /// An integer divided by zero: the value is the dividend, as naga guards it.
    DivisionByZero,
    /// The remainder by zero: the value is zero.
    RemainderByZero,
    /// Zero divided by zero, both of them constants to whoever propagates constants: what drivers fold it to,
    /// they choose.
    ZeroByZero,
    /// A shift by 32 or more, or by less than zero: the lowest five bits count.
    ShiftTooFar,
    /// A float that its `int` or `uint` cannot hold: the nearest that it can is taken.
    IntegerOverflow,
    /// `smoothstep` between equal edges.
    EqualEdges,
    /// `smoothstep` from the higher to the lower edge: everybody computes the formula.
    ReversedEdges,
    /// `pow` of a negative base, or of zero to zero or less.
    PowDomain,
    /// `min`, `max` or `clamp` of NaN.
    NotANumber,
    /// `clamp` with its least above its greatest.
    ReversedClamp,
    /// `sqrt` of less than zero, `inversesqrt` of zero or less.
    RootDomain,
    /// `log` or `log2` of zero or less.
    LogDomain,
    /// `asin` or `acos` beyond ±1, `acosh` below 1, `atanh` from ±1 on.
    ArcDomain,
    /// `atan(0, 0)`.
    ArcOfNothing,
    /// The size of a level that a texture does not have.
    NoLevel,
    /// A lookup in a texture at coordinates that are infinite, NaN, or so large that no texel's number can be told of them.
    NoPlace,
    /// A derivative where a neighbour in the quad does not run the same.
    LonelyDerivative,
    /// A variable that nothing was written to: zero, as WebGL has it.
    NeverWritten,
}

impl Fault {
    /// Whether implementations differ in what comes of it, so that the pixel is left out of comparisons. Of roots, logarithms and
    /// arcs beyond their domain NaN comes everywhere, of reversed edges the formula, and what was never written is zero in WebGL.
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

    /// What it is, for messages: `an index out of bounds`.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::IndexOutOfBounds => "an index out of bounds",
            Self::DivisionByZero => "an integer divided by zero",
            Self::RemainderByZero => "the remainder of an integer divided by zero",
            Self::ZeroByZero => "zero divided by zero, both of them constants",
            Self::ShiftTooFar => "a shift by more bits than there are",
            Self::IntegerOverflow => "a float too large for its integer",
            Self::EqualEdges => "`smoothstep` between equal edges",
            Self::ReversedEdges => "`smoothstep` from a higher to a lower edge",
            Self::PowDomain => "`pow` of a negative base, or of zero to zero or less",
            Self::NotANumber => "`min`, `max` or `clamp` of NaN",
            Self::ReversedClamp => "`clamp` with its least above its greatest",
            Self::RootDomain => "the square root of a negative number, or one over that of zero",
            Self::LogDomain => "the logarithm of zero or less",
            Self::ArcDomain => "an inverse function beyond its domain",
            Self::ArcOfNothing => "`atan(0, 0)`",
            Self::NoLevel => "the size of a level that the texture does not have",
            Self::NoPlace => "a texture looked up at infinite, NaN or far too large coordinates",
            Self::LonelyDerivative => "a derivative where a neighbouring pixel runs something else",
            Self::NeverWritten => "the value of a variable that was never written",
        }
    }
}

/// A place where something may be wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Site {
    /// What.
    pub fault: Fault,
    /// Where.
    pub at: Place,
}

/// When it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Predicate {
    /// The index is this or more, or negative.
    From(u32),
    /// The word is zero.
    Zero,
    /// The float is no `int`.
    NoInt,
    /// The float is no `uint`.
    NoUint,
    /// One of the two is NaN.
    Unordered,
    /// The floats are equal.
    Equal,
    /// The first is the greater.
    Greater,
    /// Less than zero.
    Negative,
    /// Zero or less.
    NotPositive,
    /// Beyond ±1.
    BeyondOne,
    /// ±1 or beyond.
    FromOne,
    /// Less than one.
    BelowOne,
    /// Both are zero.
    BothZero,
    /// The same of constants; of other values nobody looks.
    ConstantZeros,
    /// `pow` has no value.
    NoPower,
    /// The pixel runs this and one of its quad does not.
    Lonely,
}

/// What a batch noted: of each site, a bit for each pixel.
#[derive(Debug, Clone, Default)]
pub(crate) struct Notes {
    pub(crate) sites: BTreeMap<SiteId, Vec<u16>>,
}

impl Notes {
    /// Adds the pixels of a chunk whose bits are set.
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

/// What was wrong at a site.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Observed {
    /// What and where in the text.
    pub site: Site,
    /// In how many pixels.
    pub pixels: u64,
    /// The first of them, row by row from the bottom.
    pub first: [u32; 2],
}

/// What a run noted.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Observations {
    /// What was wrong, in the order of its places in the text.
    pub faults: Vec<Observed>,
    /// The most rounds that a pixel ran in all loops together.
    pub most_rounds: u32,
    /// In how many pixels they were more than the 65,535 after which Mesa before 23 ends all loops of a pixel.
    pub beyond_cap: u64,
}

/// After so many rounds older versions of Mesa end all loops of a pixel.
pub const MESA_CAP: u32 = 65_535;

impl Observations {
    /// Adds what another part of the picture noted.
    pub fn merge(&mut self, other: &Self) {
        self.most_rounds = self.most_rounds.max(other.most_rounds);
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
                    old.first = earlier(old.first, new.first);
                }
            }
        }
    }
}

/// The pixel that comes first, row by row from the bottom.
pub(crate) fn earlier(a: [u32; 2], b: [u32; 2]) -> [u32; 2] {
    if (b[1], b[0]) < (a[1], a[0]) { b } else { a }
}
