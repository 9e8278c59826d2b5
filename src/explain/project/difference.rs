//! The difference of two textures, in all channels and beyond the range of colors.

use toyproof_image::Image;
use toyproof_verify::compare::EXACT_TOLERANCE;

/// The width of the shown range of a channel, relative to the range of the reference's values: wrong values
/// may be beyond.
pub(super) const SHOWN_RANGE: f64 = 2.0;

/// The width of the range of a channel with a single value, relative to the value.
const RELATIVE_RANGE: f64 = 1e-3;

/// The width of the range of a channel that is zero.
const MIN_RANGE: f64 = 1e-6;

/// The difference of a texture from that of the reference.
#[derive(Debug, Clone)]
pub(super) struct Difference {
    /// The number of pixels that differ.
    pub(super) pixels: usize,
    /// The number of all pixels.
    of: usize,
    /// The number of pixels that differ in each channel.
    pub(super) channels: [usize; 4],
    /// The number of pixels that differ in colors clamped to [0, 1].
    pub(super) visible: usize,
    /// The corners of the smallest rectangle around the pixels that differ: the first column and row inside,
    /// and the first ones beyond.
    pub(super) rectangle: [[u32; 2]; 2],
    /// The range of each channel of the reference.
    pub(super) ranges: [Range; 4],
    /// Whether the texture of the reference has more than one value.
    pub(super) is_varied: bool,
}

/// The values of a channel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    pub(super) middle: f64,
    pub(super) width: f64,
}

impl Difference {
    /// Compares two textures of the same size, apart from the `ignored` channels. An image that is
    /// `displayed`, with a tolerance, is compared as colors in [0, 1].
    pub(super) fn new(own: &Image, reference: &Image, ignored: [bool; 4], displayed: Option<f64>) -> Self {
        let ranges = std::array::from_fn(|channel| Range::of(reference, channel));
        let clamped = |value: f32| f64::from(value).clamp(0.0, 1.0);
        let differs_as_color = |own: f32, other: f32, tolerance: f64| {
            let difference = (clamped(own) - clamped(other)).abs();
            difference.is_nan() || difference > tolerance
        };
        let differs = |channel: usize, own: f32, other: f32| {
            let Range { width, .. } = ranges[channel];
            let is_alike = own == other || own.is_nan() && other.is_nan();
            !ignored[channel]
                && !is_alike
                && if let Some(tolerance) = displayed {
                    differs_as_color(own, other, tolerance)
                } else {
                    let difference = (f64::from(own) - f64::from(other)).abs();
                    difference.is_nan() || difference > SHOWN_RANGE * EXACT_TOLERANCE * width
                }
        };
        let pixels = reference.pixels();
        let is_varied = pixels
            .iter()
            .any(|pixel| (0..4).any(|channel| !ignored[channel] && pixel[channel] != pixels[0][channel]));
        let mut found = Self {
            pixels: 0,
            of: pixels.len(),
            channels: [0; 4],
            visible: 0,
            rectangle: [[u32::MAX; 2], [0; 2]],
            ranges,
            is_varied,
        };
        let width = reference.size()[0].max(1);
        for (at, (own, other)) in (0..).zip(own.pixels().iter().zip(pixels)) {
            let channels: [bool; 4] =
                std::array::from_fn(|channel| differs(channel, own[channel], other[channel]));
            if !channels.contains(&true) {
                continue;
            }
            found.pixels += 1;
            for (count, differs) in found.channels.iter_mut().zip(channels) {
                *count += usize::from(differs);
            }
            let is_visible = |channel: usize| {
                channels[channel] && differs_as_color(own[channel], other[channel], EXACT_TOLERANCE)
            };
            found.visible += usize::from((0..3).any(is_visible));
            let pixel: [u32; 2] = [at % width, at / width];
            for (axis, place) in pixel.into_iter().enumerate() {
                let [first, last] = &mut found.rectangle;
                first[axis] = first[axis].min(place);
                last[axis] = last[axis].max(place + 1);
            }
        }
        found
    }

    /// The share of the pixels that differ.
    pub(super) fn ratio(&self) -> f64 {
        self.pixels as f64 / self.of.max(1) as f64
    }
}

impl Range {
    /// The range of a channel of an image, of its finite values.
    fn of(image: &Image, channel: usize) -> Self {
        let values = image.pixels().iter().map(|pixel| f64::from(pixel[channel]));
        let finite = values.filter(|value| value.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        if low > high {
            return Self {
                middle: 0.0,
                width: 1.0,
            };
        }
        let least = (RELATIVE_RANGE * low.abs().max(high.abs())).max(MIN_RANGE);
        Self {
            middle: f64::midpoint(low, high),
            width: (high - low).max(least),
        }
    }

    /// The first of the values that are shown, and the factor that maps them to [0, 1].
    pub(super) fn shown(self) -> (f64, f64) {
        let width = SHOWN_RANGE * self.width;
        (self.middle - width / 2.0, 1.0 / width)
    }
}
