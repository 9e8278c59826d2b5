//! How much is a difference.

/// Components that differ by no more than this agree.
///
/// A quarter of an 8-bit level: it can move a rounded value by one level and no more, so a mistake that hides below
/// it is seen by nobody. It covers what float32 does where the tracer's answer is decided: on lavapipe up to 9e−5
/// in the course's shaders as they stand, and up to 9.3e−4 in rewrites that start their shadow rays on the surface
/// itself, which then shades itself a little at the terminator. The test `the_tolerance_is_no_larger_than_needed`
/// measures that excess again and fails if the tolerance is ten times as large.
pub const TOLERANCE: f64 = 1e-3;
