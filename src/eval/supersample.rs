//! Several samples in each pixel: the shader at several positions, and the mean of their colors.

use std::ops::Range;

use toyproof_image::{Frame, Image};

use crate::exec::evaluate::Number;
use crate::exec::limits::Failure;
use crate::exec::places::Places;
use crate::exec::settings::Settings;
use crate::program::Program;

/// The samples of a pixel, whose colors all have the same weight: a box filter of one pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Supersampling {
    /// Offsets from the center of a pixel in pixels, from −½ to ½.
    offsets: Vec<[f64; 2]>,
    /// Whether each color is clamped to [0, 1] before the mean, as it is displayed: otherwise one bright
    /// sample would decide the color of a pixel at its edge.
    clamps: bool,
}

impl Supersampling {
    /// The first `count` points of Sobol's (0, 2)-sequence: of 2ᵏ samples, each column, each row and each box
    /// of the same area has its share. `clamps`: whether colors are clamped to [0, 1] before the mean. One
    /// sample is at the center.
    ///
    /// I. M. Sobol', “On the distribution of points in a cube and the approximate evaluation of integrals”,
    /// USSR Computational Mathematics and Mathematical Physics 7(4), 1967. The points are moved by half of
    /// the distance of their coordinates, so that their mean is the center if there are 2ᵏ of them. All
    /// coordinates are multiples of a power of two, and exact in float32 in images of up to 2²³ samples per
    /// side.
    #[must_use]
    pub fn new(count: u32, clamps: bool) -> Self {
        let count = count.max(1);
        let distance = 1.0 / f64::from(count.next_power_of_two());
        let offset = |bits: u32| f64::from(bits) / (1_u64 << 32) as f64 + distance / 2.0 - 0.5;
        Self {
            offsets: (0..count)
                .map(|at| [at.reverse_bits(), second(at)].map(offset))
                .collect(),
            clamps,
        }
    }

    /// The number of samples of a pixel.
    #[must_use]
    pub fn count(&self) -> usize {
        self.offsets.len()
    }
}

/// The second coordinate of a point of the sequence, times 2³².
fn second(mut at: u32) -> u32 {
    let (mut direction, mut sum) = (1_u32 << 31, 0);
    while at != 0 {
        if at & 1 != 0 {
            sum ^= direction;
        }
        at >>= 1;
        // The primitive polynomial x + 1.
        direction ^= direction >> 1;
    }
    sum
}

impl Program {
    /// Renders a band of rows of a frame with several samples in each pixel, as [`Self::render_rows`] does
    /// with one. Derivatives are those of samples with the same offset.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn render_supersampled<N: Number>(
        &self,
        frame: &Frame,
        rows: Range<u32>,
        supersampling: &Supersampling,
        settings: &Settings<'_, N>,
    ) -> Result<Image, Failure> {
        let [width, height] = [frame.size[0], rows.len() as u32];
        let center = |at: u32| f64::from(at) + 0.5;
        // Whole quads, as derivatives need them.
        let centers = Places {
            columns: (0..width.next_multiple_of(2)).map(center).collect(),
            rows: (rows.start..rows.start + height.next_multiple_of(2))
                .map(center)
                .collect(),
        };
        let mut sums = vec![[0.0_f64; 4]; width as usize * height as usize];
        for &offset in &supersampling.offsets {
            let sampled = self.at(frame, &centers.shifted(offset), settings)?;
            let colors = sampled.rows().flat_map(|row| &row[..width as usize]);
            for (sum, color) in sums.iter_mut().zip(colors) {
                for (sum, &component) in sum.iter_mut().zip(color) {
                    // The comparison is false for NaN, which is displayed as 0.
                    let displayed = if component > 0.0 { component.min(1.0) } else { 0.0 };
                    *sum += f64::from(if supersampling.clamps {
                        displayed
                    } else {
                        component
                    });
                }
            }
        }
        let count = supersampling.count() as f64;
        let means = sums.iter().map(|sum| sum.map(|sum| (sum / count) as f32));
        Ok(Image::new(width, height, means.collect()))
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;

    fn program(body: &str) -> Program {
        let mut files = Files::default();
        let text = format!("void mainImage(out vec4 c, in vec2 p) {{ {body} }}");
        let file = files.add(File::new("a", text));
        let checked = toyproof_glsl::check(&files, file, &Default::default()).unwrap();
        Program::compile(&checked, crate::UndefinedPolicy::Plain, None, None).unwrap()
    }

    fn render(body: &str, size: [u32; 2], count: u32, clamps: bool) -> Image {
        let frame = Frame {
            size,
            ..Frame::default()
        };
        let supersampling = Supersampling::new(count, clamps);
        let program = program(body);
        program
            .render_supersampled(&frame, frame.rows(), &supersampling, &Settings::<f32>::plain())
            .unwrap()
    }

    #[test]
    fn each_elementary_box_has_one_sample() {
        let offsets = Supersampling::new(16, false).offsets;
        for (columns, rows) in [(16, 1), (8, 2), (4, 4), (2, 8), (1, 16)] {
            let mut boxes: Vec<_> = offsets
                .iter()
                .map(|[x, y]| {
                    [(x + 0.5) * f64::from(columns), (y + 0.5) * f64::from(rows)].map(|at| at as u32)
                })
                .collect();
            boxes.sort_unstable();
            boxes.dedup();
            assert_eq!(boxes.len(), 16, "{columns}×{rows}");
        }
        let mean = offsets
            .iter()
            .fold([0.0; 2], |sum, at| [sum[0] + at[0], sum[1] + at[1]]);
        assert_eq!(mean, [0.0; 2]);
    }

    #[test]
    fn one_sample_is_the_image_itself() {
        let body = "c = vec4(sin(p / 7.0), dFdx(p.x * p.x), 1.0);";
        let frame = Frame {
            size: [37, 21],
            ..Frame::default()
        };
        let whole = program(body)
            .render_rows(&frame, frame.rows(), &Settings::<f32>::plain())
            .unwrap();
        assert!(render(body, frame.size, 1, false) == whole.image);
    }

    /// Of N = 2ᵏ samples, the share beyond a straight edge that is parallel to an axis is right to 1/N.
    #[test]
    fn an_edge_has_the_share_that_it_covers() {
        let image = render(
            "c = vec4(step(3.3, p.x), step(2.75, p.y), 0.0, 1.0);",
            [8, 8],
            64,
            false,
        );
        let [x, y, ..] = image.get(3, 2);
        assert!((x - 0.7).abs() <= 1.0 / 64.0, "{x}");
        assert_eq!(y, 0.25);
        assert_eq!(image.get(2, 1)[..2], [0.0, 0.0]);
        assert_eq!(image.get(4, 3)[..2], [1.0, 1.0]);
    }

    #[test]
    fn displayed_colors_are_clamped_before_the_mean() {
        let body = "c = vec4(p.x < 0.5 ? 9.0 : 0.0, p.x < 0.5 ? -1.0 : 1.0, 0.0, 1.0);";
        assert_eq!(render(body, [1, 1], 4, true).get(0, 0)[..2], [0.5, 0.5]);
        assert_eq!(render(body, [1, 1], 4, false).get(0, 0)[..2], [4.5, 0.0]);
    }
}
