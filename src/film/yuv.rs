//! `Y'CbCr` of BT.709 in limited range, with 4:2:0 chroma as H.264, VP9 and Y4M have it.

use crate::frame::DisplayFrame;

/// Weights of red, green and blue in luma: Recommendation ITU-R BT.709-6, item 3.2.
const WEIGHTS: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// The planes Y', Cb and Cr of a frame, and alpha, if it is kept. Sides of `size` that exceed those of the
/// frame repeat its edges. Chroma has half of the sides, rounded up, and its samples are at the left luma
/// samples and between the rows, which is what decoders assume of MPEG-4 and VP9.
pub(crate) fn planes(frame: &DisplayFrame, [width, height]: [u32; 2], keeps_alpha: bool) -> Vec<u8> {
    let [frame_width, frame_height] = frame.size.map(|side| side as usize);
    let [width, height] = [width, height].map(|side| side as usize);
    let row = |y: usize| {
        let y = y.min(frame_height - 1);
        &frame.pixels[y * frame_width..(y + 1) * frame_width]
    };
    let at = |row: &[[u8; 4]], x: usize| row[x.min(frame_width - 1)];
    let chroma = [width.div_ceil(2), height.div_ceil(2)];
    let mut planes = Vec::with_capacity(width * height * 5 / 2);
    for y in 0..height {
        let row = row(y);
        planes.extend((0..width).map(|x| luma(at(row, x))));
    }
    let start = planes.len();
    let count = chroma[0] * chroma[1];
    planes.resize(start + 2 * count, 0);
    let (blue, red) = planes[start..].split_at_mut(count);
    for y in 0..chroma[1] {
        let rows = [row(2 * y), row(2 * y + 1)];
        for x in 0..chroma[0] {
            // 1, 2, 1 around the left of two columns, in two rows.
            let columns = [(2 * x).saturating_sub(1), 2 * x, 2 * x, 2 * x + 1];
            let mut sum = [0_u32; 3];
            for row in rows {
                for column in columns {
                    let pixel = at(row, column);
                    for (sum, part) in sum.iter_mut().zip(pixel) {
                        *sum += u32::from(part);
                    }
                }
            }
            let [blue_value, red_value] = difference(sum.map(|sum| sum as f32 / 8.0));
            blue[y * chroma[0] + x] = blue_value;
            red[y * chroma[0] + x] = red_value;
        }
    }
    if keeps_alpha {
        for y in 0..height {
            let row = row(y);
            planes.extend((0..width).map(|x| at(row, x)[3]));
        }
    }
    planes
}

/// Luma from 0 to 255, of components in this range.
fn full_luma(color: [f32; 3]) -> f32 {
    WEIGHTS[0] * color[0] + WEIGHTS[1] * color[1] + WEIGHTS[2] * color[2]
}

/// Luma from 16 to 235: BT.709-6, item 4.
fn luma([r, g, b, _]: [u8; 4]) -> u8 {
    let luma = full_luma([r, g, b].map(f32::from));
    (16.5 + luma * (219.0 / 255.0)) as u8
}

/// Cb and Cr from 16 to 240, 128 for gray: BT.709-6, items 3.3 and 4.
fn difference(color: [f32; 3]) -> [u8; 2] {
    let luma = full_luma(color);
    let blue = (color[2] - luma) / (2.0 * (1.0 - WEIGHTS[2]));
    let red = (color[0] - luma) / (2.0 * (1.0 - WEIGHTS[0]));
    [blue, red].map(|value| (128.5 + value * (224.0 / 255.0)) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(color: [u8; 3], size: [u32; 2]) -> DisplayFrame {
        let [r, g, b] = color;
        DisplayFrame {
            size,
            pixels: vec![[r, g, b, 99]; (size[0] * size[1]) as usize],
        }
    }

    /// The values of 100 % color bars: SMPTE ST 292-related tables and BT.709 itself give these 8-bit codes.
    #[test]
    fn color_bars_have_the_codes_of_the_recommendation() {
        for (color, codes) in [
            ([255, 255, 255], [235, 128, 128]),
            ([255, 255, 0], [219, 16, 138]),
            ([0, 255, 255], [188, 154, 16]),
            ([0, 255, 0], [173, 42, 26]),
            ([255, 0, 255], [78, 214, 230]),
            ([255, 0, 0], [63, 102, 240]),
            ([0, 0, 255], [32, 240, 118]),
            ([0, 0, 0], [16, 128, 128]),
        ] {
            let frame = flat(color, [2, 2]);
            let [y, cb, cr] = codes;
            assert_eq!(planes(&frame, [2, 2], false), [y, y, y, y, cb, cr], "{color:?}");
        }
    }

    #[test]
    fn odd_sizes_round_up_and_edges_are_repeated() {
        let frame = flat([255, 0, 0], [3, 5]);
        assert_eq!(planes(&frame, [3, 5], false).len(), 15 + 2 * 6);
        let padded = planes(&frame, [4, 6], true);
        assert_eq!(padded.len(), 24 + 2 * 6 + 24);
        assert!(padded[..24].iter().all(|&luma| luma == 63));
        assert!(padded[36..].iter().all(|&alpha| alpha == 99));
    }

    /// A step in red between the third and the fourth column: the second chroma sample is at the third
    /// column, and has a quarter of the fourth.
    #[test]
    fn chroma_is_at_the_left_luma_sample() {
        let mut frame = flat([0, 0, 0], [4, 2]);
        for row in 0..2 {
            frame.pixels[row * 4 + 3] = [200, 0, 0, 255];
        }
        let planes = planes(&frame, [4, 2], false);
        let [_, expected] = difference([50.0, 0.0, 0.0]);
        assert_eq!(planes[10..12], [128, expected]);
    }
}
