//! Image files: PNG (8 bits) and EXR (32-bit floats) are written; JPEG, GIF and Radiance HDR are read, too.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufReader, Cursor, Write};
use std::path::{Path, PathBuf};

use image::{
    DynamicImage, ExtendedColorType, ImageDecoder, ImageEncoder, ImageFormat, ImageReader, Limits,
    Rgba32FImage,
};
use thiserror::Error;

use super::{Image, MAX_SIDE, Rgb8Image, check_size, input, quantize};

/// An error of reading or writing an image.
#[derive(Debug, Error)]
pub enum ImageError {
    /// The extension is neither `.png` nor `.exr`.
    #[error("{0}: unsupported image format: use .png (8 bits) or .exr (floats)")]
    Extension(PathBuf),
    /// The file is not an image, or cannot be read.
    #[error("cannot read {path} as an image: {error}")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The decoder's message.
        error: String,
    },
    /// The encoder failed.
    #[error("{path}: cannot be written: {error}")]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// The encoder's message.
        error: String,
    },
}

/// Encodes an image in the format of `path`'s extension: PNG holds RGB clamped to [0, 1] and rounded to 8
/// bits, EXR the unchanged RGBA floats. Does not write a file.
///
/// # Errors
/// [`ImageError::Extension`] for other extensions, [`ImageError::Unwritable`] if the encoder fails.
pub fn encode(image: &Image, path: &Path) -> Result<Vec<u8>, ImageError> {
    let [width, height] = image.size();
    let top_down = image.rows().rev().flatten();
    match Format::from_path(path)? {
        Format::Png => {
            let rows = image.rows().rev();
            let rows = rows.map(|row| row.iter().map(|&[r, g, b, _]| [r, g, b].map(quantize)).collect());
            in_memory(path, |bytes| {
                png([width, height], rows.map(Cow::<[_]>::Owned), bytes)
            })
        }
        Format::Exr => {
            let rgba: Vec<[f32; 4]> = top_down.copied().collect();
            in_memory(path, |bytes| {
                let encoder = image::codecs::openexr::OpenExrEncoder::new(bytes);
                let encoded = encoder.write_image(
                    bytemuck::cast_slice(rgba.as_flattened()),
                    width,
                    height,
                    ExtendedColorType::Rgba32F,
                );
                encoded.map_err(io::Error::other)
            })
        }
    }
}

/// Encodes an image as [`encode`] does, and keeps alpha in PNG. Colors are not multiplied by it.
///
/// # Errors
/// As [`encode`].
pub fn encode_transparent(image: &Image, path: &Path) -> Result<Vec<u8>, ImageError> {
    match Format::from_path(path)? {
        Format::Png => {
            let rows = image.rows().rev();
            let rows = rows.map(|row| row.iter().map(|pixel| pixel.map(quantize)).collect());
            in_memory(path, |bytes| {
                png(image.size(), rows.map(Cow::<[_]>::Owned), bytes)
            })
        }
        Format::Exr => encode(image, path),
    }
}

/// Encodes an image of 8 bits as [`encode`] does.
///
/// # Errors
/// As [`encode`].
pub fn encode_shown(image_rgb8: &Rgb8Image, path: &Path) -> Result<Vec<u8>, ImageError> {
    match Format::from_path(path)? {
        Format::Png => in_memory(path, |bytes| write_png(image_rgb8, bytes)),
        Format::Exr => encode(&Image::from(image_rgb8), path),
    }
}

/// Writes an image as a PNG. At most the size of the image is in memory.
///
/// # Errors
/// Those of `out`.
pub fn write_png(image_rgb8: &Rgb8Image, out: &mut dyn Write) -> io::Result<()> {
    png(image_rgb8.size(), image_rgb8.rows().rev().map(Cow::Borrowed), out)
}

/// Writes a PNG of which only a band of rows is in memory at a time. The bands come from the top down; they
/// have the width of the image, and together its height.
///
/// # Errors
/// Those of `out` and of the bands.
pub fn stream_png<E: From<io::Error>>(
    [width, height]: [u32; 2],
    keeps_alpha: bool,
    bands: impl IntoIterator<Item = Result<Image, E>>,
    out: &mut dyn Write,
) -> Result<(), E> {
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(if keeps_alpha {
        png::ColorType::Rgba
    } else {
        png::ColorType::Rgb
    });
    encoder.set_compression(png::Compression::Fast);
    let mut encoder = encoder.write_header().map_err(io::Error::from)?;
    let mut rows = encoder.stream_writer().map_err(io::Error::from)?;
    for band in bands {
        let band = band?;
        for row in band.rows().rev() {
            let values = row.iter().flat_map(|pixel| {
                let components = if keeps_alpha { 4 } else { 3 };
                pixel.map(quantize).into_iter().take(components)
            });
            rows.write_all(&values.collect::<Vec<u8>>())?;
        }
    }
    rows.finish().map_err(io::Error::from)?;
    Ok(())
}

enum Format {
    Png,
    Exr,
}

impl Format {
    fn from_path(path: &Path) -> Result<Self, ImageError> {
        let format = path.extension().and_then(|extension| extension.to_str());
        match format.map(str::to_ascii_lowercase).as_deref() {
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            _ => Err(ImageError::Extension(path.to_owned())),
        }
    }
}

/// Writes a PNG of red, green and blue, and perhaps alpha, from rows in top-down order. The fast compression
/// makes noise a third larger, so that an image which it does not make smaller is stored as it is.
fn png<'a, const N: usize>(
    size: [u32; 2],
    rows: impl Iterator<Item = Cow<'a, [[u8; N]]>> + Clone,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut compressed = LimitedBuffer {
        bytes: Vec::new(),
        limit: stored_size(size, N),
        is_exceeded: false,
    };
    let written = png_with(png::Compression::Fast, size, rows.clone(), &mut compressed);
    if compressed.is_exceeded {
        drop(compressed);
        return png_with(png::Compression::NoCompression, size, rows, out);
    }
    written?;
    out.write_all(&compressed.bytes)
}

/// The size of the PNG of an image that is stored in one chunk, in bytes.
fn stored_size([width, height]: [u32; 2], components: usize) -> usize {
    /// The signature, the chunks of the size and of the end, and the framing of the pixels.
    const AROUND: usize = 68;
    // Each row begins with the number of its filter.
    AROUND + (components * width as usize + 1) * height as usize
}

fn png_with<'a, const N: usize>(
    compression: png::Compression,
    [width, height]: [u32; 2],
    rows: impl Iterator<Item = Cow<'a, [[u8; N]]>>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(if N == 4 {
        png::ColorType::Rgba
    } else {
        png::ColorType::Rgb
    });
    encoder.set_depth(png::BitDepth::Eight);
    // Filters are those of the compression: adaptive ones, or none.
    encoder.set_compression(compression);
    let mut encoder = encoder.write_header()?;
    let mut image = encoder.stream_writer()?;
    for row in rows {
        image.write_all(row.as_flattened())?;
    }
    image.finish()?;
    Ok(())
}

/// A file in memory that cannot become larger than a limit, in bytes.
struct LimitedBuffer {
    bytes: Vec<u8>,
    limit: usize,
    is_exceeded: bool,
}

impl Write for LimitedBuffer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.is_exceeded |= self.bytes.len() + bytes.len() > self.limit;
        if self.is_exceeded {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        self.bytes.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Collects what `write` writes for the file at `path`.
fn in_memory(
    path: &Path,
    write: impl FnOnce(&mut Cursor<Vec<u8>>) -> io::Result<()>,
) -> Result<Vec<u8>, ImageError> {
    let mut bytes = Cursor::new(Vec::new());
    match write(&mut bytes) {
        Ok(()) => Ok(bytes.into_inner()),
        Err(error) => Err(ImageError::Unwritable {
            path: path.to_owned(),
            error: error.to_string(),
        }),
    }
}

/// Reads an image file, of a film its first frame; 8- and 16-bit values become `value / max`, without any
/// transfer function. A photograph is turned upright if it says how it was taken.
///
/// # Errors
/// [`ImageError::Unreadable`], also for images over the size limit.
pub fn read(path: &Path) -> Result<Image, ImageError> {
    Ok(from_decoded(decode(path)?))
}

/// An image from a decoder's, whose rows run downwards.
pub fn from_decoded(decoded: DynamicImage) -> Image {
    let rgba: Rgba32FImage = match decoded {
        DynamicImage::ImageRgba32F(floats) => floats,
        other => other.into_rgba32f(),
    };
    let rows = rgba.rows().rev();
    let pixels = rows.flat_map(|row| row.map(|pixel| pixel.0)).collect();
    Image::new(rgba.width(), rgba.height(), pixels)
}

/// Reads an image file as 8-bit RGB.
///
/// # Errors
/// As [`read`].
pub fn read_shown(path: &Path) -> Result<Rgb8Image, ImageError> {
    let rgb = decode(path)?.into_rgb8();
    let pixels = rgb.rows().rev().flat_map(|row| row.map(|pixel| pixel.0));
    Ok(Rgb8Image::new(rgb.width(), rgb.height(), pixels.collect()))
}

/// Checks that images can be written to a file with this extension.
///
/// # Errors
/// [`ImageError::Extension`].
pub fn check_extension(path: &Path) -> Result<(), ImageError> {
    Format::from_path(path).map(|_| ())
}

fn decode(path: &Path) -> Result<DynamicImage, ImageError> {
    let unreadable = |error: String| ImageError::Unreadable {
        path: path.to_owned(),
        error,
    };
    let mut reader = open_image(path)?;
    reader.limits(decoder_limits());
    let mut decoder = reader
        .into_decoder()
        .map_err(|error| unreadable(error.to_string()))?;
    // Before any memory is taken for the pixels.
    let (width, height) = decoder.dimensions();
    check_size(width.into(), height.into()).map_err(|error| unreadable(error.to_string()))?;
    let orientation = decoder.orientation();
    let decoded = orientation.and_then(|orientation| {
        let mut decoded = DynamicImage::from_decoder(decoder)?;
        decoded.apply_orientation(orientation);
        Ok(decoded)
    });
    decoded.map_err(|error| unreadable(error.to_string()))
}

/// The limits of decoders: [`MAX_SIDE`], and one gigabyte.
pub fn decoder_limits() -> Limits {
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(1 << 30);
    limits
}

/// Opens an image file of a format that is read.
///
/// # Errors
/// [`ImageError::Unreadable`], also for the palettes that no decoder accepts.
pub fn open_image(path: &Path) -> Result<ImageReader<BufReader<File>>, ImageError> {
    let unreadable = |error: String| ImageError::Unreadable {
        path: path.to_owned(),
        error,
    };
    let reader = input::open(path)
        .and_then(|file| ImageReader::new(BufReader::new(file)).with_guessed_format())
        .map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => unreadable("no such file".to_owned()),
            _ => unreadable(error.to_string()),
        })?;
    match reader.format() {
        Some(ImageFormat::Png) => check_palette(path).map_err(unreadable)?,
        Some(ImageFormat::Gif | ImageFormat::Hdr | ImageFormat::Jpeg | ImageFormat::OpenExr) => {}
        _ => {
            let supported = "only PNG, JPEG, EXR, Radiance HDR and GIF are supported";
            return Err(unreadable(supported.to_owned()));
        }
    }
    Ok(reader)
}

/// Rejects palettes of PNGs on which the decoder panics (png 0.18.1).
fn check_palette(path: &Path) -> Result<(), String> {
    let file = input::open(path).map_err(|error| error.to_string())?;
    let reader = png::Decoder::new(BufReader::new(file)).read_info();
    let reader = reader.map_err(|error| error.to_string())?;
    match reader.info().palette.as_deref() {
        Some(palette) if palette.len() % 3 != 0 => Err(format!(
            "its palette has {} bytes, which is not a multiple of three",
            palette.len()
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output;

    fn sample() -> Image {
        let pixels = vec![
            [0.0, 0.25, 0.5, 1.0],
            [1.0, 1.0, 1.0, 1.0],
            [-2.0, 7.5, 1e-7, 1.0],
            [0.1, 0.2, 0.3, 1.0],
        ];
        Image::new(2, 2, pixels)
    }

    #[test]
    fn exr_keeps_every_float_and_the_rows() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        output::write(&path, &encode(&sample(), &path).unwrap()).unwrap();
        assert_eq!(read(&path).unwrap(), sample());
    }

    #[test]
    fn png_clamps_quantizes_and_puts_the_bottom_row_last() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        output::write(&path, &encode(&sample(), &path).unwrap()).unwrap();
        let raw = image::open(&path).unwrap().into_rgb8();
        assert_eq!(raw.get_pixel(0, 0).0, [0, 255, 0], "top left");
        assert_eq!(raw.get_pixel(0, 1).0, [0, 64, 128], "bottom left");
        assert_eq!(read(&path).unwrap().get(0, 0)[1], 64.0 / 255.0);
    }

    #[test]
    fn bands_make_the_same_image() {
        let pixel = |at: u32| [at as f32 / 35.0, 0.5, 1.0, at as f32 / 70.0];
        let image = Image::new(7, 5, (0..35).map(pixel).collect());
        let band = |rows: std::ops::Range<u32>| {
            let pixels = (rows.start * 7..rows.end * 7).map(pixel).collect();
            Ok::<_, io::Error>(Image::new(7, rows.len() as u32, pixels))
        };
        for keeps_alpha in [false, true] {
            let mut streamed = Vec::new();
            let bands = [3..5, 0..3].map(band);
            stream_png([7, 5], keeps_alpha, bands, &mut streamed).unwrap();
            let path = Path::new("a.png");
            let whole = if keeps_alpha {
                encode_transparent(&image, path)
            } else {
                encode(&image, path)
            };
            let decode = |bytes: &[u8]| image::load_from_memory(bytes).unwrap();
            assert_eq!(decode(&streamed), decode(&whole.unwrap()));
        }
    }

    #[test]
    fn alpha_is_kept_where_it_is_wanted() {
        let pixels = vec![[1.0, 0.0, 0.2, 0.5], [0.0, 0.0, 0.0, 0.0]];
        let image = Image::new(2, 1, pixels);
        let read = |bytes: Vec<u8>| image::load_from_memory(&bytes).unwrap();
        let path = Path::new("a.png");
        let kept = read(encode_transparent(&image, path).unwrap()).into_rgba8();
        assert_eq!(kept.get_pixel(0, 0).0, [255, 0, 51, 128]);
        assert_eq!(kept.get_pixel(1, 0).0, [0; 4]);
        assert!(!read(encode(&image, path).unwrap()).color().has_alpha());
    }

    #[test]
    fn no_png_is_larger_than_its_pixels() {
        let noise = |at: u32| {
            let hash = (at + 1).wrapping_mul(2_654_435_761);
            (hash ^ hash >> 15).wrapping_mul(0x85eb_ca6b).to_be_bytes()
        };
        // From headers that outweigh the pixels to several chunks.
        for size in [1, 2, 9, 120, 400] {
            let pixels: Vec<_> = (0..size * size).map(noise).collect();
            let pixels = pixels.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
            let image = Rgb8Image::new(size, size, pixels);
            let bytes = encode_shown(&image, Path::new("a.png")).unwrap();
            // The framing of the parts of a stored image takes less than a hundredth of it, and 22 bytes at
            // the end.
            let most = stored_size(image.size(), 3) * 101 / 100 + 22;
            assert!(bytes.len() <= most, "{size}: {} above {most}", bytes.len());
            let read = image::load_from_memory(&bytes).unwrap().into_rgb8();
            let rows = image.rows().rev().flatten().copied();
            assert!(rows.eq(read.pixels().map(|pixel| pixel.0)), "{size}");
        }
        let plain = Rgb8Image::new(400, 400, vec![[7; 3]; 160_000]);
        let bytes = encode_shown(&plain, Path::new("a.png")).unwrap();
        assert!(bytes.len() < 10_000, "{}", bytes.len());
    }

    #[test]
    fn other_extensions_and_other_files_are_rejected() {
        let error = encode(&sample(), Path::new("a.jpg")).unwrap_err();
        assert!(error.to_string().contains("a.jpg") && error.to_string().contains(".png"));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        std::fs::write(&path, "not an image").unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("as an image"));
    }

    #[test]
    fn photographs_radiance_pictures_and_the_first_frame_of_a_film_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let gray = image::RgbImage::from_fn(16, 8, |x, y| {
            image::Rgb([if y < 4 { 51 } else { 204 }, 102, (x / 8 * 255) as u8])
        });
        for (name, tolerance) in [("a.jpg", 40), ("a.gif", 4), ("a.png", 0)] {
            let path = folder.path().join(name);
            gray.save(&path).unwrap();
            let read = read_shown(&path).unwrap();
            assert_eq!(read.size(), [16, 8]);
            // The corners, far from edges, which JPEG blurs: the lower left and the upper right.
            for ((x, y), expected) in [((1, 1), [204, 102, 0]), ((14, 6), [51, 102, 255])] {
                let found = read.rows().nth(y).unwrap()[x];
                let difference = (0..3).map(|i| found[i].abs_diff(expected[i])).max();
                assert!(difference <= Some(tolerance), "{name}: {found:?}");
            }
        }
        let path = folder.path().join("a.hdr");
        let bright = image::Rgb32FImage::from_pixel(9, 3, image::Rgb([8.0, 0.5, 0.25]));
        bright.save(&path).unwrap();
        assert_eq!(super::read(&path).unwrap().get(8, 2), [8.0, 0.5, 0.25, 1.0]);
    }

    #[test]
    fn palettes_of_a_wrong_length_are_rejected() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        for (length, is_valid) in [(3, true), (4, false), (5, false), (768, true)] {
            let mut encoder = png::Encoder::new(std::fs::File::create(&path).unwrap(), 1, 1);
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_palette(vec![51; length]);
            let mut encoder = encoder.write_header().unwrap();
            encoder.write_image_data(&[0]).unwrap();
            encoder.finish().unwrap();
            match read(&path) {
                Ok(image) => assert!(is_valid && image.get(0, 0) == [0.2, 0.2, 0.2, 1.0], "{length}"),
                Err(error) => assert!(
                    !is_valid && error.to_string().contains(&format!("palette has {length} bytes")),
                    "{error}"
                ),
            }
        }
    }
}
