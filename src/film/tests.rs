//! Films that are interrupted or refused.

use toyproof_image::Image;

use crate::{FilmError, FilmSettings, FilmWriter, Format, FrameRate, check};

/// A gray frame.
fn frame(level: f32) -> Image {
    Image::new(16, 8, vec![[level, level, level, 1.0]; 128])
}

fn settings(format: Format) -> FilmSettings {
    FilmSettings::new(format, [16, 8], FrameRate::nearest(10.0), 10)
}

#[test]
fn an_interrupted_encoding_leaves_the_old_film_and_the_frames() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gif");
    std::fs::write(&path, "old").unwrap();
    let mut film = FilmWriter::open(&path, settings(Format::Gif), "a").unwrap();
    for number in 0..10_u8 {
        film.add(&frame(f32::from(number) / 10.0)).unwrap();
    }
    let error = film.finish(&mut |step| step < 5).unwrap_err();
    assert!(matches!(error, FilmError::Interrupted));
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
    let film = FilmWriter::open(&path, settings(Format::Gif), "a").unwrap();
    assert_eq!(film.existing(), 10);
    assert_eq!(film.finish(&mut |_| true).unwrap().shown, 10);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn what_a_format_lacks_is_refused() {
    let mut transparent = settings(Format::Gif);
    transparent.keeps_alpha = true;
    assert!(matches!(check(&transparent), Err(FilmError::Opaque(Format::Gif))));
    let mut loud = settings(Format::Apng);
    loud.sound = Some("a.wav".into());
    assert!(matches!(check(&loud), Err(FilmError::Silent(Format::Apng))));
    let folder = tempfile::tempdir().unwrap();
    let mut film = FilmWriter::open(&folder.path().join("a.gif"), settings(Format::Gif), "a").unwrap();
    let error = film.add(&Image::new(1, 1, vec![[0.0; 4]])).unwrap_err();
    assert_eq!(error.to_string(), "a frame has 1×1 pixels, and the film 16×8");
}
