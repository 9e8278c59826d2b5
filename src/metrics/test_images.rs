//! Images for tests, computed with integers alone, and the values that other implementations of the metrics
//! give.

use toyproof_image::Image;

use crate::{Metric, measure};

/// The 8-bit level of a component: ramps with edges, in checks of 8×8 pixels.
fn level([x, y]: [u32; 2], component: u32) -> u32 {
    let ramp = (x * (5 + component) + y * (3 + 2 * component) + ((x * y) >> 4)) % 256;
    if (x / 8 + y / 8) % 2 == 1 {
        255 - ramp
    } else {
        ramp
    }
}

fn image(width: u32, height: u32, level: impl Fn([u32; 2], u32) -> u32) -> Image {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let color = |at| {
        let [r, g, b] = [0, 1, 2].map(|component| level(at, component) as f32 / 255.0);
        [r, g, b, 1.0]
    };
    Image::new(width, height, pixels.map(color).collect())
}

/// An image with edges and colors.
pub(crate) fn textured(width: u32, height: u32) -> Image {
    image(width, height, level)
}

/// The textured image with noise, a rectangle with exchanged channels, and a shifted part.
pub(crate) fn distorted(width: u32, height: u32) -> Image {
    image(width, height, |[x, y], component| {
        let hash = (x * 73 + y * 151 + component * 29).wrapping_mul(2_654_435_761) >> 24;
        let original = if (10..22).contains(&x) && (12..20).contains(&y) {
            level([x, y], (component + 1) % 3)
        } else if x >= 30 {
            level([x + 2, y], component)
        } else {
            level([x, y], component)
        };
        (original + hash % 31).saturating_sub(15).min(255)
    })
}

/// The images in linear light, with highlights of 64.
fn lit(image: &Image) -> Image {
    let [width, height] = image.size();
    let light = |&[r, g, b, _]: &[f32; 4]| {
        let [r, g, b] = [r, g, b].map(|component| {
            let level = (component * 255.0).round();
            level * level / 1024.0
        });
        [r, g, b, 1.0]
    };
    Image::new(width, height, image.pixels().iter().map(light).collect())
}

/// The values of `NumPy` (RMSE), of scikit-image 0.26 (PSNR, SSIM) and of flip-evaluator 1.7, in the order of
/// [`Metric::ALL`], for images of three sizes, some sides of which are smaller than a band of rows or a
/// filter.
const VALUES: [([u32; 2], [f64; 5]); 3] = [
    (
        [48, 40],
        [
            0.242_644_414_251,
            12.300_594_036_522,
            0.611_129_675_179,
            0.332_550_520,
            0.378_772_567,
        ],
    ),
    (
        [101, 75],
        [
            0.290_610_378_502,
            10.733_777_598_037,
            0.430_900_764_353,
            0.403_426_858,
            0.432_850_028,
        ],
    ),
    (
        [12, 150],
        [
            0.041_161_044_905,
            27.710_272_177_277,
            0.965_376_235_647,
            0.094_287_230,
            0.109_815_187,
        ],
    ),
];

/// The map of SSIM is stored in f32, and flip-evaluator computes in f32, with a few hundred operations.
const TOLERANCES: [f64; 5] = [1e-12, 1e-12, 1e-8, 2e-7, 2e-7];

#[test]
fn values_are_those_of_other_implementations() {
    for ([width, height], values) in VALUES {
        let images = [textured(width, height), distorted(width, height)];
        let [reference, actual] = &images;
        let [lit_reference, lit_actual] = images.each_ref().map(lit);
        for ((metric, expected), tolerance) in Metric::ALL.into_iter().zip(values).zip(TOLERANCES) {
            let measured = match metric {
                Metric::HdrFlip => measure(metric, &lit_reference, &lit_actual),
                _ => measure(metric, reference, actual),
            };
            let error = measured.unwrap().value - expected;
            assert!(
                error.abs() <= tolerance,
                "{metric:?} at {width}×{height}: {error:e}"
            );
        }
    }
}
