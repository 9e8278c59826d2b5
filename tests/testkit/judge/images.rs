//! A file as an image: a PNG or an EXR, read as floats and in 8 bits, and written again.

use std::fs;
use std::path::Path;
use std::time::Duration;

use toyproof::image::{Image, encode, quantize, read, read_shown};

use super::within;

/// The most pixels of an image that is written again.
const MAX_WRITTEN_PIXELS: usize = 1 << 16;

/// Whether these bytes are an image. They are written into the folder, from where toyproof reads them.
///
/// # Panics
/// If reading or writing it does, or takes more than `allowed` of a processor; if both ways of reading disagree; if
/// an image that was written is not read as the same.
pub fn judge(bytes: &[u8], folder: &Path, allowed: Duration) -> bool {
    let input = folder.join("input");
    fs::write(&input, bytes).expect("the folder can be written");
    within(allowed, || {
        let shown = read_shown(&input);
        let floats = match (read(&input), &shown) {
            (Ok(floats), Ok(_)) => floats,
            (Err(error), Err(_)) => {
                assert!(
                    error.to_string().contains("input"),
                    "{error} does not name the file"
                );
                return false;
            }
            (floats, shown) => panic!(
                "floats: {:?}; 8 bits: {:?}",
                floats.map(drop),
                shown.as_ref().map(drop)
            ),
        };
        let shown = shown.expect("both were read");
        assert_eq!(floats.size(), shown.size());
        assert!(floats.is_whole());
        if floats.pixels().len() <= MAX_WRITTEN_PIXELS {
            write_again(&floats, folder);
        }
        true
    })
}

fn write_again(image: &Image, folder: &Path) {
    let write = |name: &str| {
        let path = folder.join(name);
        fs::write(&path, encode(image, &path).expect("an image can be encoded")).expect("it can be written");
        path
    };
    let exr = read(&write("again.exr")).expect("our own EXR is read");
    let bits = |image: &Image| -> Vec<[u32; 4]> {
        let pixels = image.pixels().iter();
        pixels
            .map(|pixel| pixel.map(|x| if x.is_nan() { f32::NAN } else { x }.to_bits()))
            .collect()
    };
    assert_eq!(bits(&exr), bits(image), "an EXR keeps every float");
    let png = read_shown(&write("again.png")).expect("our own PNG is read");
    let quantized: Vec<[u8; 3]> = image
        .pixels()
        .iter()
        .map(|&[r, g, b, _]| [r, g, b].map(quantize))
        .collect();
    assert_eq!(png.pixels(), quantized, "a PNG holds the colors as displayed");
}
