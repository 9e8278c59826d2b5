//! The decisions behind a program: bytes, of which each decides one thing.

/// Bytes read as decisions. Once they are used up every decision is 0, which everywhere stands for the simplest thing: so
/// fewer and smaller bytes are a simpler program, and what shrinks bytes shrinks programs.
pub(crate) struct Choices<'a> {
    bytes: std::slice::Iter<'a, u8>,
}

impl<'a> Choices<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes: bytes.iter() }
    }

    /// A number below `count`, which is at most 256.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        usize::from(self.bytes.next().copied().unwrap_or(0)) % count
    }

    /// Yes in `of` of 256 cases, and no at the end.
    pub(crate) fn chance(&mut self, of: u8) -> bool {
        self.bytes.next().is_some_and(|&byte| byte > u8::MAX - of)
    }

    /// One of them, the first at the end.
    pub(crate) fn pick<T: Copy>(&mut self, among: &[T]) -> T {
        among[self.below(among.len())]
    }

    /// Whether every decision is made.
    pub(crate) fn is_over(&self) -> bool {
        self.bytes.len() == 0
    }
}
