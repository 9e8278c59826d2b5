//! How much is a difference.

use crate::compare::Legend;

/// Components of two pictures that differ by no more than this agree.
///
/// A quarter of an 8-bit level: it can move a rounded value by one level and no more.
pub const TOLERANCE: f64 = 1e-3;

/// Components of a shader in f64 that differ from the tracer's in f64 by no more than this agree.
///
/// Equivalent formulas in f64 differ by 3e−7, which is what keeping the pictures in f32 costs; constants that are written with four digits,
/// as π = 3.1416 or a gamma of 0.4545, by up to 4e−5. That is the room that this leaves. The test
/// `the_tolerance_is_no_larger_than_needed` measures it again, and fails if it is ten times as large.
pub const EXACT_TOLERANCE: f64 = 1e-4;

/// The colours of pictures that are judged by eye: what is more than rounding stands out.
pub const SEEN_BY_EYE: Legend = Legend {
    tolerance: TOLERANCE as f32,
};

/// The colours where every bit counts: all but the last bits stand out.
pub const IN_BITS: Legend = Legend { tolerance: 1e-6 };
