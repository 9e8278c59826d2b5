//! The texture that the site itself fills where it plays no music.

use toyproof_image::Image;
use toyproof_math::double;

use super::WIDTH;

/// The texture of music at a time in seconds, as the site computes it for its previews, without any sound.
pub fn silent_music(seconds: f64) -> Image {
    let spectrum = (0..WIDTH).map(|at| 255.0 * spectrum(at as f64, seconds));
    let wave = (0..WIDTH).map(|at| 255.0 * wave(at as f64 / WIDTH as f64, seconds));
    // The conversion to u8 truncates, as the site's array of bytes does.
    let texel = |level: f64| [f32::from(level as u8) / 255.0, 0.0, 0.0, 1.0];
    Image::new(WIDTH as u32, 2, spectrum.chain(wave).map(texel).collect())
}

fn spectrum(bin: f64, seconds: f64) -> f64 {
    if bin < 3.0 {
        #[expect(
            clippy::approx_constant,
            reason = "the site's constant, which is not exactly 2π"
        )]
        let [sine] = double::sin([6.2831 * seconds]);
        let beat = 0.5 + 0.5 * sine;
        return beat * beat * beat * beat * (1.0 - bin / 3.0);
    }
    let [sine] = double::sin([10.0 * bin + 13.0 * seconds]);
    let [falling] = double::exp([-3.0 * bin / WIDTH as f64]);
    (0.75 + 0.25 * sine) * falling
}

fn wave(part: f64, seconds: f64) -> f64 {
    let [fast, slow] = double::sin([17.0 * seconds + 62.831 * part, 23.0 * seconds + 1.9 * part]);
    0.5 + 0.15 * fast * slow
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_those_of_the_sites_formula() {
        let level = |seconds: f64, x: u32, y: u32| (255.0 * silent_music(seconds).get(x, y)[0]).round();
        // By hand: sin 0 = 0 in the first bins and the wave.
        assert_eq!(
            [level(0.0, 0, 0), level(0.0, 2, 0), level(0.0, 0, 1)],
            [15.0, 5.0, 127.0]
        );
        for (seconds, x) in [(0.0, 3), (1.7, 100), (12.25, 511)] {
            let bin = f64::from(x);
            let expected =
                255.0 * (0.75 + 0.25 * (10.0 * bin + 13.0 * seconds).sin()) * (-3.0 * bin / 512.0).exp();
            assert_eq!(level(seconds, x, 0), expected.floor() as f32);
        }
        assert_eq!(silent_music(3.0).size(), [512, 2]);
    }
}
