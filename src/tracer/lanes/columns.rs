//! Vectors on their way into lanes and out of them.

use super::{Lanes, MOST_LANES, Wide3};

/// As many vectors as there are lanes at most, component by component.
#[derive(Debug)]
#[repr(align(64))]
pub(in super::super) struct Columns<T>([[T; MOST_LANES]; 3]);

impl<T: Copy> Columns<T> {
    /// The same vector everywhere.
    pub(in super::super) fn splat([x, y, z]: [T; 3]) -> Self {
        Self([[x; MOST_LANES], [y; MOST_LANES], [z; MOST_LANES]])
    }

    #[inline]
    pub(in super::super) fn get(&self, at: usize) -> [T; 3] {
        [self.0[0][at], self.0[1][at], self.0[2][at]]
    }

    #[inline]
    pub(in super::super) fn set(&mut self, at: usize, [x, y, z]: [T; 3]) {
        self.0[0][at] = x;
        self.0[1][at] = y;
        self.0[2][at] = z;
    }

    /// As many as there are lanes, from `at` on.
    #[inline(always)]
    pub(in super::super) fn load<S: Lanes<T>>(&self, simd: S, at: usize) -> Wide3<T, S> {
        Wide3::load(simd, &self.0, at)
    }

    #[inline(always)]
    pub(in super::super) fn store<S: Lanes<T>>(&mut self, vectors: Wide3<T, S>, at: usize) {
        vectors.0.store(&mut self.0[0][at..]);
        vectors.1.store(&mut self.0[1][at..]);
        vectors.2.store(&mut self.0[2][at..]);
    }
}
