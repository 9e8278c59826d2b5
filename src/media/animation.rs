//! Films from files: GIF, animated PNG, and image sequences.

use std::io::BufReader;
use std::path::{Path, PathBuf};

use image::codecs::gif::GifDecoder;
use image::codecs::png::PngDecoder;
use image::{AnimationDecoder, DynamicImage, Frame, ImageDecoder, ImageFormat, RgbaImage};
use toyproof_diagnostic::grouped;
use toyproof_image::{Image, check_size, decoder_limits, from_decoded, input, open_image, read};

use crate::error::MediaError;

/// The most frames of a film, an hour at 30 frames per second.
const MAX_FRAMES: usize = 108_000;

/// The most memory that the frames of a film may take, in bytes: a minute of 640×480 at 15 frames per second.
const MAX_BYTES: usize = 1 << 30;

/// Images at times, which repeat.
#[derive(Debug)]
pub struct Film {
    frames: Frames,
    /// When each frame ends, in seconds from the beginning, increasing.
    ends: Vec<f64>,
}

#[derive(Debug)]
enum Frames {
    /// In 8 bits.
    Decoded(Vec<RgbaImage>),
    /// The file of each.
    Files(Vec<PathBuf>),
}

impl Film {
    /// Reads an animated GIF or PNG. An image that is not animated is a film of one frame.
    ///
    /// # Errors
    /// If the file is not an image, or has too many frames or pixels.
    pub fn open(path: &Path) -> Result<Self, MediaError> {
        let fault =
            |error: image::ImageError| MediaError::new(path, format!("the film cannot be read: {error}"));
        let opened = open_image(path)?;
        let format = opened.format();
        let reader: BufReader<_> = opened.into_inner();
        match format {
            Some(ImageFormat::Gif) => {
                let mut decoder = GifDecoder::new(reader).map_err(fault)?;
                decoder.set_limits(decoder_limits()).map_err(fault)?;
                Self::decode(path, decoder.dimensions(), decoder)
            }
            Some(ImageFormat::Png) => {
                let decoder = PngDecoder::with_limits(reader, decoder_limits()).map_err(fault)?;
                if !decoder.is_apng().map_err(fault)? {
                    return Self::sequence(vec![path.to_owned()], 1.0);
                }
                let size = decoder.dimensions();
                Self::decode(path, size, decoder.apng().map_err(fault)?)
            }
            _ => Self::sequence(vec![path.to_owned()], 1.0),
        }
    }

    /// A film of image files of one size, in their order, with the same time for each. A file is read when
    /// its frame is.
    ///
    /// # Errors
    /// If there is no file, there are too many, or the rate is not positive.
    pub fn sequence(files: Vec<PathBuf>, frames_per_second: f64) -> Result<Self, MediaError> {
        let first = files.first().cloned().unwrap_or_default();
        if files.is_empty() {
            return Err(MediaError::new(&first, "the film has no frames"));
        }
        if files.len() > MAX_FRAMES {
            return Err(too_long(&first));
        }
        if !(frames_per_second.is_finite() && frames_per_second > 0.0) {
            return Err(MediaError::new(
                &first,
                "the number of frames per second must be positive",
            ));
        }
        // Each time is computed from the number of the frame, so that rounding does not add up.
        let ends = (1..=files.len()).map(|frame| frame as f64 / frames_per_second);
        Ok(Self {
            ends: ends.collect(),
            frames: Frames::Files(files),
        })
    }

    fn decode<'a>(
        path: &Path,
        (width, height): (u32, u32),
        decoder: impl AnimationDecoder<'a>,
    ) -> Result<Self, MediaError> {
        check_size(width.into(), height.into()).map_err(|error| MediaError::new(path, error.to_string()))?;
        let most = MAX_BYTES / (4 * width as usize * height as usize);
        let (mut images, mut milliseconds, mut ends) = (Vec::new(), 0.0, Vec::new());
        for frame in decoder.into_frames() {
            let frame = frame.map_err(|error| {
                MediaError::new(path, format!("frame {} cannot be read: {error}", images.len()))
            })?;
            if images.len() >= most.min(MAX_FRAMES) {
                return Err(too_long(path));
            }
            milliseconds += duration(&frame);
            ends.push(milliseconds / 1000.0);
            images.push(frame.into_buffer());
        }
        if images.is_empty() {
            return Err(MediaError::new(path, "the film has no frames"));
        }
        Ok(Self {
            frames: Frames::Decoded(images),
            ends,
        })
    }

    /// The number of frames, at least 1.
    pub fn frames(&self) -> usize {
        self.ends.len()
    }

    /// The time after which the film repeats, in seconds.
    pub fn duration(&self) -> f64 {
        self.ends[self.ends.len() - 1]
    }

    /// The frame that is visible at a time in seconds.
    pub fn frame_at(&self, seconds: f64) -> usize {
        let within = seconds.rem_euclid(self.duration());
        let frame = self.ends.partition_point(|&end| end <= within);
        frame.min(self.frames() - 1)
    }

    /// A frame. It is read from a file, or converted, in each call.
    ///
    /// # Errors
    /// If a file of a sequence cannot be read.
    ///
    /// # Panics
    /// If there are fewer frames.
    pub fn image(&self, frame: usize) -> Result<Image, MediaError> {
        Ok(match &self.frames {
            Frames::Decoded(images) => from_decoded(DynamicImage::ImageRgba8(images[frame].clone())),
            Frames::Files(files) => read(&files[frame])?,
        })
    }
}

/// The time of a frame in milliseconds. Browsers show a frame of at most 10 ms, which many old files have,
/// for 100 ms.
fn duration(frame: &Frame) -> f64 {
    let (numerator, denominator) = frame.delay().numer_denom_ms();
    let milliseconds = f64::from(numerator) / f64::from(denominator.max(1));
    if milliseconds > 10.0 { milliseconds } else { 100.0 }
}

fn too_long(path: &Path) -> MediaError {
    let problem = format!(
        "the film is too long: the limits are {} frames and {} million bytes of decoded frames",
        grouped(MAX_FRAMES as u64),
        MAX_BYTES / 1_000_000
    );
    MediaError::new(path, problem).with_help("make its frames smaller or fewer, or use an image sequence")
}

/// The files of an image sequence: those of the pattern's folder whose names differ from the pattern's only
/// in the number, in the order of the numbers. The pattern is one of the files, such as `film/0001.png`.
///
/// # Errors
/// If the folder cannot be read, or the name has no number.
pub fn sequence_files(pattern: &Path) -> Result<Vec<PathBuf>, MediaError> {
    let name = pattern
        .file_name()
        .and_then(|name| name.to_str())
        .unwrap_or_default();
    let Some((prefix, _, suffix)) = split_number(name) else {
        let problem = "an image sequence is named by one of its files, whose name contains a number";
        return Err(MediaError::new(pattern, problem));
    };
    let folder = match pattern.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let entries = folder
        .read_dir()
        .map_err(|error| MediaError::new(folder, error.to_string()))?;
    let numbered = entries.filter_map(|entry| {
        let path = entry.ok()?.path();
        let (start, number, end) = split_number(path.file_name()?.to_str()?)?;
        let is_same = start == prefix && end.eq_ignore_ascii_case(suffix) && input::open(&path).is_ok();
        is_same.then_some((number, path))
    });
    let mut numbered: Vec<_> = numbered.collect();
    numbered.sort();
    Ok(numbered.into_iter().map(|(_, path)| path).collect())
}

/// A file name as what precedes its last number before the extension, the number, and the rest.
fn split_number(name: &str) -> Option<(&str, u64, &str)> {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let end = stem.rfind(|c: char| c.is_ascii_digit())? + 1;
    let start = stem[..end].trim_end_matches(|c: char| c.is_ascii_digit()).len();
    Some((&name[..start], name[start..end].parse().ok()?, &name[end..]))
}

#[cfg(test)]
mod tests {
    use std::fs::File;

    use image::codecs::gif::GifEncoder;
    use image::{Delay, Rgba};

    use super::*;

    fn gif(path: &Path, delays: &[u32]) {
        let mut encoder = GifEncoder::new(File::create(path).unwrap());
        for (at, &delay) in delays.iter().enumerate() {
            let image = RgbaImage::from_pixel(3, 2, Rgba([(at * 51) as u8, 0, 0, 255]));
            let delay = Delay::from_numer_denom_ms(delay, 1);
            encoder
                .encode_frame(Frame::from_parts(image, 0, 0, delay))
                .unwrap();
        }
    }

    #[test]
    fn frames_of_a_gif_have_their_times_and_repeat() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gif");
        gif(&path, &[40, 0, 200]);
        let film = Film::open(&path).unwrap();
        assert_eq!((film.frames(), film.duration()), (3, 0.34), "0 ms are 100 ms");
        for (seconds, frame) in [
            (0.0, 0),
            (0.039, 0),
            (0.04, 1),
            (0.139, 1),
            (0.3, 2),
            (0.345, 0),
            (-0.01, 2),
        ] {
            assert_eq!(film.frame_at(seconds), frame, "{seconds}");
        }
        assert_eq!(film.image(2).unwrap().get(2, 1), [0.4, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn frames_of_an_animated_png_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut encoder = png::Encoder::new(File::create(&path).unwrap(), 2, 1);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_animated(2, 0).unwrap();
        encoder.set_frame_delay(1, 25).unwrap();
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&[51, 0, 0, 255, 0, 0, 0, 51]).unwrap();
        writer.write_image_data(&[0, 102, 0, 255, 0, 0, 0, 102]).unwrap();
        writer.finish().unwrap();
        let film = Film::open(&path).unwrap();
        assert_eq!((film.frames(), film.duration()), (2, 0.08));
        let second = film.image(film.frame_at(0.05)).unwrap();
        assert_eq!(second.pixels(), [[0.0, 0.4, 0.0, 1.0], [0.0, 0.0, 0.0, 0.4]]);
    }

    #[test]
    fn an_image_is_a_film_of_one_frame() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        RgbaImage::from_pixel(1, 1, Rgba([255; 4])).save(&path).unwrap();
        let film = Film::open(&path).unwrap();
        assert_eq!((film.frames(), film.frame_at(12.5)), (1, 0));
    }

    #[test]
    fn files_of_a_sequence_are_in_the_order_of_their_numbers() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["f9.png", "f10.png", "f1.PNG", "g2.png", "f.png", "f3.jpg"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let files = sequence_files(&folder.path().join("f9.png")).unwrap();
        let names: Vec<_> = files
            .iter()
            .map(|path| path.file_name().unwrap().to_str().unwrap())
            .collect();
        assert_eq!(names, ["f1.PNG", "f9.png", "f10.png"]);
        let film = Film::sequence(files, 25.0).unwrap();
        assert_eq!(
            [0.0, 0.039, 0.08, 0.12].map(|time| film.frame_at(time)),
            [0, 0, 2, 0]
        );
        let error = sequence_files(&folder.path().join("f.png")).unwrap_err();
        assert!(error.to_string().contains("contains a number"), "{error}");
    }

    #[test]
    fn broken_films_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gif");
        gif(&path, &[40, 40]);
        let bytes = std::fs::read(&path).unwrap();
        // The header promises more pixels than an image may have.
        let mut huge = bytes.clone();
        huge[6..10].copy_from_slice(&[255, 255, 255, 255]);
        std::fs::write(&path, huge).unwrap();
        assert!(Film::open(&path).is_err());
        std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
        // A cut film has the frames before the cut, or is an error, but does not panic.
        if let Ok(film) = Film::open(&path) {
            assert_eq!(film.frames(), 1);
        }
        assert!(Film::sequence(Vec::new(), 25.0).is_err());
        assert!(Film::sequence(vec![path], 0.0).is_err());
    }
}
