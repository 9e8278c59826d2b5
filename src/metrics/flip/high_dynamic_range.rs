//! HDR-FLIP: the largest error of FLIP over the exposures at which the reference may be displayed.

use toyproof_image::Image;

use super::Flip;
use crate::map::ErrorMap;

/// The tone curve (a₀x² + a₁x) / (b₀x² + b₁x + b₂): Narkowicz's fit of ACES (2016) without its exposure of
/// 0.6.
const ACES: ([f64; 2], [f64; 3]) = (
    [0.6 * 0.6 * 2.51, 0.6 * 0.03],
    [0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14],
);

/// The displayed value of the reference's brightest pixel at the first exposure, and of its median at the
/// last.
const BRIGHT: f64 = 0.85;

/// The largest number of exposures: one for each stop of a range beyond that of floats of 16 bits, 40 stops.
const MAX_EXPOSURES: usize = 64;

/// HDR-FLIP of two images in linear light. Components that are negative or NaN count as 0.
pub(crate) fn high_dynamic_range(reference: &Image, actual: &Image) -> ErrorMap {
    let flip = Flip::new();
    let exposures = exposures(reference);
    let at = |exposure: f64| {
        let shown = |image: &Image, index: usize| {
            let [r, g, b, _] = image.pixels()[index];
            [r, g, b].map(|component| tone_map(exposure.exp2() * light(component)).clamp(0.0, 1.0))
        };
        flip.map(
            reference.size(),
            |index| shown(reference, index),
            |index| shown(actual, index),
        )
    };
    let maps = exposures.into_iter().map(at);
    maps.reduce(|all, map| all.max(&map))
        .expect("there are at least two exposures")
}

/// A component in linear light.
fn light(component: f32) -> f64 {
    // The largest float in place of infinity, whose tone would be NaN.
    if component > 0.0 {
        f64::from(component.min(f32::MAX))
    } else {
        0.0
    }
}

fn tone_map(x: f64) -> f64 {
    let (above, below) = ACES;
    (above[0] * x * x + above[1] * x) / (below[0] * x * x + below[1] * x + below[2])
}

/// The light whose displayed value is [`BRIGHT`].
fn bright_light() -> f64 {
    let (above, below) = ACES;
    let a = above[0] - BRIGHT * below[0];
    let half = -0.5 * (above[1] - BRIGHT * below[1]) / a;
    half + (half * half + BRIGHT * below[2] / a).sqrt()
}

/// The exposures, in stops: from the one that shows the brightest pixel of the reference to the one that
/// makes its median bright, about a stop apart. A black reference has exposures of 0, and one that is black
/// in most pixels is shown up to the exposure that makes its darkest other pixel bright.
fn exposures(reference: &Image) -> Vec<f64> {
    let luminance = |&[r, g, b, _]: &[f32; 4]| {
        let [r, g, b] = [r, g, b].map(light);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    let mut luminances: Vec<f64> = reference.pixels().iter().map(luminance).collect();
    let median = luminances.len() / 2;
    let (_, &mut middle, _) = luminances.select_nth_unstable_by(median, f64::total_cmp);
    let brightest = luminances.iter().copied().fold(0.0, f64::max);
    if brightest == 0.0 {
        return vec![0.0; 2];
    }
    let positive = luminances.iter().copied().filter(|&luminance| luminance > 0.0);
    let median = if middle > 0.0 {
        middle
    } else {
        positive.fold(brightest, f64::min)
    };
    let [first, last] = [brightest, median].map(|luminance| (bright_light() / luminance).log2());
    let count = ((last - first).ceil() as usize).clamp(2, MAX_EXPOSURES);
    let step = (last - first) / (count - 1) as f64;
    (0..count).map(|at| first + at as f64 * step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tone_curve_is_inverted() {
        assert!((tone_map(bright_light()) - BRIGHT).abs() < 1e-15);
        assert_eq!(tone_map(0.0), 0.0);
    }

    #[test]
    fn exposures_are_a_stop_apart() {
        let gray = |value: f32| [value, value, value, 1.0];
        let image = Image::new(3, 1, vec![gray(8.0), gray(0.5), gray(0.25)]);
        let found = exposures(&image);
        // From 8 to 0.5, four stops.
        let first = (bright_light() / 8.0).log2();
        assert_eq!(found.len(), 4);
        assert!((found[0] - first).abs() < 1e-6 && (found[3] - first - 4.0).abs() < 1e-6);
        for values in [
            [0.0; 3],
            [f32::NAN, -1.0, 0.0],
            [0.0, 0.0, f32::INFINITY],
            [1e-38, 0.0, 0.0],
        ] {
            let image = Image::new(3, 1, values.map(gray).to_vec());
            let found = exposures(&image);
            assert!(
                found.iter().all(|exposure| exposure.is_finite()),
                "{values:?}: {found:?}"
            );
            let error = high_dynamic_range(&image, &image);
            assert!(error.errors().iter().all(|&error| error == 0.0), "{values:?}");
        }
    }
}
