//! How much is a difference.

/// Components that differ by no more than this agree.
///
/// A quarter of an 8-bit level: it can move a rounded value by one level and no more. Rounding in float32
/// stays a factor of several below it wherever the tracer's answer is decided (the course's shaders on
/// lavapipe reach 2e−5 there), and a mistake that hides below it is seen by nobody. The test
/// `the_tolerance_is_no_larger_than_needed` holds it to both.
pub const TOLERANCE: f64 = 1e-3;
