//! Is float32 enough? The shader on the GPU in f32 against the same shader in f64.

use toyproof_image::Image;

use super::{Pixel, Standing};

/// A pixel that rounding moves by more than this is seen: two 8-bit levels, since one is what rounding a colour
/// to 8 bits may cost by itself.
pub const SEEN: f64 = 2.0 / 255.0;

/// Compares the picture in f32, `actual`, with that of the same shader in f64, `expected`.
///
/// # Panics
/// If the sizes differ.
#[must_use]
pub fn rounding(expected: &Image, actual: &Image, undefined: &[bool]) -> Vec<Standing> {
    assert_eq!(expected.size(), actual.size());
    let standing = |(index, &undefined): (usize, &bool)| {
        if undefined {
            Standing::Undefined
        } else if Pixel::at(index, expected, actual).difference() > SEEN {
            Standing::Differs
        } else {
            Standing::Agrees
        }
    };
    undefined.iter().enumerate().map(standing).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_levels_are_not_seen_and_three_are() {
        let level = |n: f32| [n / 255.0, 0.0, 0.0, 1.0];
        let exact = Image::new(3, 1, vec![level(100.0); 3]);
        let single = Image::new(3, 1, vec![level(101.9), level(103.0), level(0.0)]);
        let standings = rounding(&exact, &single, &[false, false, true]);
        assert_eq!(
            standings,
            [Standing::Agrees, Standing::Differs, Standing::Undefined]
        );
    }
}
