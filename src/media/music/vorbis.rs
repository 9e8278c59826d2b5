//! Sounds in Ogg Vorbis files.

use std::io::{Read, Seek};

use lewton::audio::{PreviousWindowRight, read_audio_packet_generic};
use lewton::header::{read_header_ident, read_header_setup};
use lewton::samples::InterleavedSamples;
use ogg::PacketReader;

use super::decode::Mixer;

/// The most numbers of a codebook. Those of encoders have up to 52,488.
const MAX_CODEBOOK: u64 = 1 << 18;

/// The mean of the channels, and the number of samples per second. Of several streams, the first is read.
///
/// # Errors
/// One sentence without a full stop.
pub(super) fn decode(reader: impl Read + Seek) -> Result<(Vec<f32>, u32), String> {
    let fault = |error: &dyn std::fmt::Display| format!("the Ogg Vorbis file cannot be read: {error}");
    let mut packets = PacketReader::new(reader);
    let mut header = || packets.read_packet_expected().map_err(|error| fault(&error));
    let (first, _comments, setup) = (header()?, header()?, header()?);
    let stream = first.stream_serial();
    let identification = read_header_ident(&first.data).map_err(|error| fault(&error))?;
    if !are_codebooks_small(&setup.data) {
        return Err(fault(&"a codebook is too large"));
    }
    let block_sizes = (identification.blocksize_0, identification.blocksize_1);
    let setup = read_header_setup(&setup.data, identification.audio_channels, block_sizes);
    let setup = setup.map_err(|error| fault(&error))?;
    let channels = usize::from(identification.audio_channels);
    let mut mixer = Mixer::new(channels)?;
    let mut window = PreviousWindowRight::new();
    while let Some(packet) = packets.read_packet().map_err(|error| fault(&error))? {
        if packet.stream_serial() != stream {
            continue;
        }
        let decoded: InterleavedSamples<i16> =
            read_audio_packet_generic(&identification, &setup, &packet.data, &mut window)
                .map_err(|error| fault(&error))?;
        // Samples of 16 bits hide most of the differences between machines, whose sines the decoder uses.
        for sample in decoded.samples {
            mixer.push(f32::from(sample) / 32_768.0)?;
        }
        if packet.last_in_stream() {
            // The last packet may be longer than the sound, whose length its page holds.
            let length = usize::try_from(packet.absgp_page()).unwrap_or(usize::MAX);
            mixer.samples.truncate(length);
            break;
        }
    }
    Ok((mixer.samples, identification.audio_sample_rate))
}

/// Whether no codebook of the setup header is so large that the decoder, which reserves memory before it
/// reads, ends the program. Each begins with a pattern of 24 bits, at any bit, and its dimensions and entries
/// (Vorbis I specification, §3.2.1).
fn are_codebooks_small(setup: &[u8]) -> bool {
    const PATTERN: u64 = 0x56_4342;
    // The first bit of a byte is its lowest.
    let bits = |at: usize, count: usize| {
        let bit = |at: usize| u64::from(setup.get(at / 8).is_some_and(|byte| byte >> (at % 8) & 1 == 1));
        (0..count).fold(0, |number, offset| number | bit(at + offset) << offset)
    };
    let is_small = |at: usize| {
        let (dimensions, entries) = (bits(at, 16), bits(at + 16, 24));
        dimensions > 0 && dimensions * entries <= MAX_CODEBOOK
    };
    let mut window = 0;
    (0..8 * setup.len()).all(|at| {
        // The 24 bits that end here.
        window = window >> 1 | bits(at, 1) << 23;
        window != PATTERN || is_small(at + 1)
    })
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// 0.4 s of 1000 Hz at 8000 samples per second, computed and encoded by:
    /// `ffmpeg -f lavfi -i "sine=frequency=1000:sample_rate=8000:duration=0.4" -af volume=4 -q:a 0 tone.ogg`
    const TONE: &[u8] = include_bytes!("tone.ogg");

    #[test]
    fn a_tone_in_an_ogg_vorbis_file_is_decoded() {
        let (samples, rate) = decode(Cursor::new(TONE)).unwrap();
        assert_eq!(rate, 8000);
        assert!(samples.len().abs_diff(3200) < 256, "{}", samples.len());
        // In the middle, the sound is a sine of the amplitude 1/2 with a period of eight samples.
        let middle = &samples[1000..2000];
        let part = |phase: f64| -> f64 {
            let weighted = middle.iter().enumerate().map(|(n, x)| {
                let turns = n as f64 / 8.0 + phase;
                f64::from(*x) * (std::f64::consts::TAU * turns).cos()
            });
            weighted.sum::<f64>() * 2.0 / middle.len() as f64
        };
        let amplitude = part(0.0).hypot(part(0.25));
        let mean_square = middle.iter().map(|x| f64::from(x * x)).sum::<f64>() / middle.len() as f64;
        assert!((amplitude - 0.5).abs() < 0.03, "{amplitude}");
        // The rest is what the lossy format adds.
        assert!(
            (mean_square - amplitude * amplitude / 2.0).abs() < 0.002,
            "{mean_square}"
        );
    }

    #[test]
    fn huge_codebooks_are_rejected() {
        // Three bits, the pattern, and a codebook of 65,535 dimensions with 2²⁴ − 1 entries.
        let setup: Vec<u8> = (0x56_4342_u128 << 3 | 0xff_ffff_ffff << 27)
            .to_le_bytes()
            .to_vec();
        assert!(!are_codebooks_small(&setup));
        let small = (0x56_4342_u128 << 3 | 8 << 27 | 6561 << 43).to_le_bytes();
        assert!(are_codebooks_small(&small));
        let empty = (0x56_4342_u128 << 3 | 6561 << 43).to_le_bytes();
        assert!(!are_codebooks_small(&empty), "no dimensions");
        let mut packets = PacketReader::new(Cursor::new(TONE));
        let [_, _, setup] = std::array::from_fn(|_| packets.read_packet_expected().unwrap().data);
        assert!(are_codebooks_small(&setup));
        let patterns = setup.windows(3).filter(|bytes| bytes == b"BCV").count();
        assert!(patterns > 0, "the first codebook begins with a byte");
    }
}
