//! Music as a texture: 512×2 texels of one component, the spectrum in row 0 and the wave in row 1, as the
//! site's player fills it from an analyser of Web Audio.

mod analyser;
mod decode;
mod fft;
mod silence;
mod vorbis;

use std::collections::VecDeque;
use std::path::Path;
use std::sync::{Arc, Mutex};

use toyproof_image::Image;

use self::analyser::{Magnitudes, SIZE, SMOOTHING, magnitudes, spectrum_level, wave_level};
pub use self::silence::silent_music;
use crate::error::MediaError;

/// The width of the texture.
const WIDTH: usize = 512;

/// How often the site reads the analyser in a second: once a frame.
const CALLS_PER_SECOND: i64 = 60;

/// The number of calls that a spectrum is the smoothed mean of, two seconds. What an earlier one would add
/// has the factor 0.8¹²⁰ < 10⁻¹¹, far below the least level, −100 dB.
const CALLS: i64 = 120;

/// A piece of music, which repeats.
#[derive(Debug)]
pub struct Music {
    /// The mean of the channels, nominally in [−1, 1].
    samples: Vec<f32>,
    /// Samples per second.
    rate: u32,
    /// The latest spectra, by the ends of their samples. In a film, all but one of a frame's are those of the
    /// frame before it.
    recent: Mutex<VecDeque<(i64, Arc<Magnitudes>)>>,
}

impl Music {
    /// Reads a WAV or an Ogg Vorbis file.
    ///
    /// The samples of a WAV are exact. Decoders of Vorbis differ in last bits, so that levels of the texture
    /// may differ by one between machines.
    ///
    /// # Errors
    /// If the file is in neither format, is damaged, or is too long.
    pub fn open(path: &Path) -> Result<Self, MediaError> {
        let (samples, rate) = decode::decode(path)?;
        Ok(Self::new(samples, rate))
    }

    /// Music of one channel, with its number of samples per second.
    ///
    /// # Panics
    /// If there are no samples, or the rate is 0.
    pub fn new(samples: Vec<f32>, rate: u32) -> Self {
        assert!(!samples.is_empty() && rate > 0);
        Self {
            samples,
            rate,
            recent: Mutex::default(),
        }
    }

    /// Samples per second. Column k of the spectrum is the frequency k·rate/2048.
    pub fn rate(&self) -> u32 {
        self.rate
    }

    /// The time after which the music repeats, in seconds.
    pub fn duration(&self) -> f64 {
        self.samples.len() as f64 / f64::from(self.rate)
    }

    /// The texture at a time in seconds, as if it were read sixty times a second from the beginning.
    pub fn texture(&self, seconds: f64) -> Image {
        let end = (seconds * f64::from(self.rate)).floor() as i64;
        let calls = (0..CALLS)
            .rev()
            .map(|call| end - call * i64::from(self.rate) / CALLS_PER_SECOND);
        let spectrum = self.smoothed(calls.filter(|&end| end > 0));
        let wave = self.latest(end);
        let row = |level: &dyn Fn(usize) -> u8| -> Vec<[f32; 4]> {
            let texel = |at| [f32::from(level(at)) / 255.0, 0.0, 0.0, 1.0];
            (0..WIDTH).map(texel).collect()
        };
        let mut pixels = row(&|at| spectrum_level(spectrum[at]));
        pixels.extend(row(&|at| wave_level(wave[at])));
        Image::new(WIDTH as u32, 2, pixels)
    }

    /// The spectrum after calls of the analyser, by the number of samples that each has heard.
    fn smoothed(&self, calls: impl Iterator<Item = i64>) -> Magnitudes {
        let mut smoothed = [0.0; WIDTH];
        for end in calls {
            let magnitudes = self.magnitudes(end);
            for (smoothed, magnitude) in smoothed.iter_mut().zip(magnitudes.iter()) {
                *smoothed = SMOOTHING * *smoothed + (1.0 - SMOOTHING) * magnitude;
            }
        }
        smoothed
    }

    fn magnitudes(&self, end: i64) -> Arc<Magnitudes> {
        let recent = || {
            self.recent
                .lock()
                .unwrap_or_else(std::sync::PoisonError::into_inner)
        };
        if let Some((_, known)) = recent().iter().find(|(known, _)| *known == end) {
            return Arc::clone(known);
        }
        let computed = Arc::new(magnitudes(&self.latest(end)));
        let mut recent = recent();
        recent.push_front((end, Arc::clone(&computed)));
        recent.truncate(CALLS as usize);
        computed
    }

    /// The last samples before an end, zeros before the beginning.
    fn latest(&self, end: i64) -> [f32; SIZE] {
        std::array::from_fn(|at| {
            let at = end - SIZE as i64 + at as i64;
            // Non-negative, hence no sign is lost.
            usize::try_from(at).map_or(0.0, |at| self.samples[at % self.samples.len()])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: u32 = 44_100;

    fn sine(hertz: f64, amplitude: f64) -> Music {
        let turns = (0..RATE).map(|at| hertz * f64::from(at) / f64::from(RATE));
        let sample = |turns: f64| amplitude * (turns * std::f64::consts::TAU).sin();
        Music::new(turns.map(|turns| sample(turns) as f32).collect(), RATE)
    }

    fn level(image: &Image, x: u32, y: u32) -> i32 {
        (255.0 * image.get(x, y)[0]).round() as i32
    }

    #[test]
    fn a_tone_has_the_level_of_its_amplitude_at_its_frequency() {
        // In the middle of bin 100, so that a Blackman window has the gain 0.42 there.
        let music = sine(100.0 * 44_100.0 / 2048.0, 0.01);
        let image = music.texture(0.9);
        let decibels = 20.0 * (0.01_f64 / 2.0 * 0.42).log10();
        let expected = (255.0 / 70.0 * (decibels + 100.0)).floor() as i32;
        assert_eq!(level(&image, 100, 0), expected);
        // A Blackman window has three bins on both sides, and nothing beyond.
        assert_eq!((level(&image, 97, 0), level(&image, 103, 0)), (0, 0));
        assert!(level(&image, 98, 0) > 0 && level(&image, 102, 0) > 0);
    }

    #[test]
    fn a_spectrum_rises_by_a_fifth_of_the_difference_in_each_call() {
        let music = sine(100.0 * 44_100.0 / 2048.0, 0.01);
        // The first call at 0.1 s hears the tone in all its samples.
        let first = music.smoothed([4410].into_iter())[100];
        let tenth = music.smoothed((0..10).map(|call| 4410 + 735 * call))[100];
        let limit = 0.01 / 2.0 * 0.42;
        assert!((first / limit - 0.2).abs() < 1e-3);
        assert!((tenth / limit - (1.0 - 0.8_f64.powi(10))).abs() < 1e-3);
    }

    #[test]
    fn the_wave_is_that_of_the_oldest_samples() {
        let samples = (0..RATE).map(|at| if at < 4000 { 0.5 } else { -2.0 });
        let music = Music::new(samples.collect(), RATE);
        let at = |samples: u32| f64::from(samples) / f64::from(RATE) + 1e-9;
        let silent = music.texture(0.0);
        assert!((0..512).all(|x| level(&silent, x, 0) == 0 && level(&silent, x, 1) == 128));
        let image = music.texture(at(4000 + 2048 - 100));
        assert_eq!(
            (level(&image, 99, 1), level(&image, 100, 1)),
            (192, 0),
            "100 samples of 0.5 are left"
        );
    }

    #[test]
    fn textures_do_not_depend_on_those_before_them() {
        let music = sine(1000.0, 0.5);
        let in_order: Vec<_> = (0..200)
            .map(|frame| music.texture(f64::from(frame) / 60.0))
            .collect();
        for frame in [150, 3, 199] {
            let alone = sine(1000.0, 0.5).texture(f64::from(frame) / 60.0);
            assert_eq!(alone, in_order[frame as usize], "{frame}");
        }
    }
}
