//! The decisions behind a program: bytes, each of which makes one decision.

/// A reader of bytes as decisions. Once they are exhausted every decision is 0, which always means the
/// simplest choice: so fewer and smaller bytes give a simpler program, and shrinking bytes shrinks programs.
pub(crate) struct Choices<'a> {
    bytes: std::slice::Iter<'a, u8>,
}

impl<'a> Choices<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes: bytes.iter() }
    }

    /// Returns a number below `count`, which is at most 256.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        usize::from(self.bytes.next().copied().unwrap_or(0)) % count
    }

    /// Returns true in `of` of 256 cases, and false when exhausted.
    pub(crate) fn chance(&mut self, of: u8) -> bool {
        self.bytes.next().is_some_and(|&byte| byte > u8::MAX - of)
    }

    /// Picks an element, the first when exhausted.
    pub(crate) fn pick<T: Copy>(&mut self, among: &[T]) -> T {
        among[self.below(among.len())]
    }

    /// Returns whether the bytes are exhausted.
    pub(crate) fn is_over(&self) -> bool {
        self.bytes.len() == 0
    }
}
