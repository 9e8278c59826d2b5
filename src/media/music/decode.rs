//! Samples of sound files.

use std::io::{BufReader, Read, Seek};
use std::path::Path;

use hound::{SampleFormat, WavReader};
use toyproof_image::input;

use super::vorbis;
use crate::error::MediaError;

/// The most samples of a channel: 50 minutes at 44,100 samples per second, half a gigabyte.
const MAX_SAMPLES: usize = 1 << 27;

/// How to get a file that can be read from any other.
const CONVERT: &str = "convert the sound to a WAV file, for example by: ffmpeg -i music.mp3 music.wav";

/// The mean of the channels, and the number of samples per second.
///
/// # Errors
/// If the file is in neither format, is damaged, has no samples, or is too long.
pub(super) fn decode(path: &Path) -> Result<(Vec<f32>, u32), MediaError> {
    let fault = |problem: String| MediaError::new(path, problem);
    let mut file = input::open(path).map_err(|error| fault(format!("the sound cannot be read: {error}")))?;
    let mut signature = [0; 4];
    let is_read = file.read_exact(&mut signature).and_then(|()| file.rewind());
    is_read.map_err(|error| fault(format!("the sound cannot be read: {error}")))?;
    let decoded = match &signature {
        b"RIFF" => wav(BufReader::new(file)),
        b"OggS" => vorbis::decode(BufReader::new(file)),
        _ => return Err(fault("the sound is neither WAV nor Ogg Vorbis".to_owned()).with_help(CONVERT)),
    };
    match decoded {
        Ok((samples, rate)) if !samples.is_empty() && rate > 0 => Ok((samples, rate)),
        Ok(_) => Err(fault("the sound has no samples".to_owned())),
        Err(problem) => Err(fault(problem).with_help(CONVERT)),
    }
}

fn wav(reader: impl Read) -> Result<(Vec<f32>, u32), String> {
    let fault = |error: hound::Error| format!("the WAV file cannot be read: {error}");
    let mut reader = WavReader::new(reader).map_err(fault)?;
    let spec = reader.spec();
    let mut mixer = Mixer::new(spec.channels.into())?;
    match spec.sample_format {
        SampleFormat::Float => {
            for sample in reader.samples::<f32>() {
                mixer.push(sample.map_err(fault)?)?;
            }
        }
        SampleFormat::Int => {
            let bits = spec.bits_per_sample;
            if !(1..=32).contains(&bits) {
                return Err(format!("the WAV file has samples of {bits} bits, not 1 to 32"));
            }
            let full = f64::from(1_u32 << (bits - 1));
            for sample in reader.samples::<i32>() {
                mixer.push((f64::from(sample.map_err(fault)?) / full) as f32)?;
            }
        }
    }
    Ok((mixer.samples, spec.sample_rate))
}

/// Collects the means of the channels' samples.
pub(super) struct Mixer {
    channels: usize,
    /// The means.
    pub(super) samples: Vec<f32>,
    /// The sum of the present sample, and the number of its channels.
    present: (f32, usize),
}

impl Mixer {
    /// Mixes this number of channels.
    pub(super) fn new(channels: usize) -> Result<Self, String> {
        if channels == 0 {
            return Err("the sound has no channels".to_owned());
        }
        Ok(Self {
            channels,
            samples: Vec::new(),
            present: (0.0, 0),
        })
    }

    /// Adds a sample of the next channel.
    pub(super) fn push(&mut self, sample: f32) -> Result<(), String> {
        let (sum, count) = (self.present.0 + sample, self.present.1 + 1);
        if count < self.channels {
            self.present = (sum, count);
            return Ok(());
        }
        if self.samples.len() >= MAX_SAMPLES {
            return Err("the sound is longer than 50 minutes".to_owned());
        }
        self.samples.push(sum / count as f32);
        self.present = (0.0, 0);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use hound::{WavSpec, WavWriter};

    use super::*;

    fn spec(channels: u16, bits_per_sample: u16, sample_format: SampleFormat) -> WavSpec {
        WavSpec {
            channels,
            sample_rate: 48_000,
            bits_per_sample,
            sample_format,
        }
    }

    #[test]
    fn wav_files_of_all_formats_are_mixed_to_one_channel() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.wav");
        for bits in [8, 16, 24, 32] {
            let mut writer = WavWriter::create(&path, spec(2, bits, SampleFormat::Int)).unwrap();
            let full = 1_i64 << (bits - 1);
            for sample in [full / 2, -full / 4, -full, -full] {
                writer.write_sample(sample as i32).unwrap();
            }
            writer.finalize().unwrap();
            assert_eq!(decode(&path).unwrap(), (vec![0.125, -1.0], 48_000), "{bits} bits");
        }
        let mut writer = WavWriter::create(&path, spec(1, 32, SampleFormat::Float)).unwrap();
        writer.write_sample(1.5_f32).unwrap();
        writer.finalize().unwrap();
        assert_eq!(decode(&path).unwrap(), (vec![1.5], 48_000));
    }

    #[test]
    fn what_is_not_a_sound_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.wav");
        let mut empty = WavWriter::create(&path, spec(1, 16, SampleFormat::Int)).unwrap();
        empty.flush().unwrap();
        drop(empty);
        assert!(decode(&path).unwrap_err().to_string().contains("no samples"));
        for (bytes, reason) in [
            (&b"ID3\x04 and an MP3 file"[..], "neither WAV nor Ogg"),
            (b"OggS\x00 and no stream", "Ogg Vorbis file cannot be read"),
            (b"RIFF\xff\xff\xff\xffWAVEjunk", "WAV file cannot be read"),
            (b"RI", "cannot be read"),
        ] {
            std::fs::write(&path, bytes).unwrap();
            let error = decode(&path).unwrap_err();
            assert!(error.to_string().contains(reason), "{error}");
        }
        assert!(decode(folder.path()).is_err());
    }
}
