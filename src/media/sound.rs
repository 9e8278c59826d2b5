//! Sounds that shaders compute, as the site plays and exports them.

use std::io::Cursor;

/// The number of samples in a second.
pub const SAMPLE_RATE: u32 = 44_100;

/// The length of a sound on the site, in seconds.
pub const SOUND_SECONDS: f64 = 180.0;

/// A sample in 16 bits. The site's shader writes it as two bytes of a texture: beyond [−1, 1), the high byte
/// is clamped, while the low one wraps around. NaN is silence.
pub fn sample_level(sample: f32) -> i16 {
    let value = ((0.5 + 0.5 * sample) * 65_536.0).floor();
    if value.is_nan() {
        return 0;
    }
    let low = value - (value / 256.0).floor() * 256.0;
    let high = (value / 256.0).floor().clamp(0.0, 255.0);
    let level = low.clamp(0.0, 255.0) as i32 + 256 * high as i32;
    // The site exports `level − 32767`, which may not fit.
    (level - 32_767).min(i16::MAX.into()) as i16
}

/// A WAV file of two channels with 16 bits at [`SAMPLE_RATE`].
///
/// # Errors
/// If it is too long for the format: more than 6 hours.
pub fn wav(samples: &[[i16; 2]]) -> Result<Vec<u8>, String> {
    let spec = hound::WavSpec {
        channels: 2,
        sample_rate: SAMPLE_RATE,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut bytes = Cursor::new(Vec::with_capacity(44 + 4 * samples.len()));
    let mut writer = hound::WavWriter::new(&mut bytes, spec).map_err(|error| error.to_string())?;
    for &level in samples.as_flattened() {
        writer.write_sample(level).map_err(|error| error.to_string())?;
    }
    writer.finalize().map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_those_of_the_site() {
        assert_eq!(sample_level(0.0), 1, "the site's zero is half a level above");
        assert_eq!(sample_level(-1.0), -32_767);
        assert_eq!(sample_level(1.0 - 1.0 / 32_768.0), i16::MAX);
        assert_eq!(sample_level(f32::NAN), 0);
        // The low byte of 65,536 is 0, and the high one the largest.
        assert_eq!(i32::from(sample_level(1.0)), 65_280 - 32_767);
        assert_eq!(sample_level(-1.0 - 1.0 / 32_768.0), 255 - 32_767);
        for infinite in [f32::INFINITY, f32::NEG_INFINITY] {
            let _ = sample_level(infinite);
        }
    }

    #[test]
    fn a_file_is_read_again() {
        let samples = [[1, -2], [i16::MAX, i16::MIN]];
        let bytes = wav(&samples).unwrap();
        let mut reader = hound::WavReader::new(&bytes[..]).unwrap();
        assert_eq!(
            (reader.spec().channels, reader.spec().sample_rate),
            (2, SAMPLE_RATE)
        );
        let read: Vec<i16> = reader.samples().map(Result::unwrap).collect();
        assert_eq!(read, samples.as_flattened());
    }
}
