//! Films by an installed ffmpeg, and films of all formats that go on after an interruption.

use std::path::Path;
use std::process::Command;

use toyproof_image::Image;

use crate::{Film, FilmError, FilmSettings, FilmWriter, Format, FrameRate, Plays, check};

/// A gray frame.
fn frame(level: f32) -> Image {
    Image::new(16, 8, vec![[level, level, level, 1.0]; 128])
}

fn write(path: &Path, settings: &FilmSettings) -> Result<Film, FilmError> {
    let mut film = FilmWriter::open(path, settings.clone(), "a")?;
    for number in film.existing()..settings.frames {
        film.add(&frame(number as f32 / 10.0))?;
    }
    film.finish(&mut |_| true)
}

fn settings(format: Format) -> FilmSettings {
    FilmSettings::new(format, [16, 8], FrameRate::nearest(10.0), 10)
}

/// Whether ffmpeg can write a format: `setup.sh --tests` installs it, and CI fails without it.
fn has_ffmpeg(format: Format) -> bool {
    let is_usable = check(&settings(format)).is_ok();
    assert!(
        is_usable || std::env::var_os("CI").is_none(),
        "no ffmpeg although CI is set"
    );
    is_usable
}

fn probe(path: &Path, entries: &str) -> Vec<String> {
    let mut command = Command::new("ffprobe");
    command.args([
        "-v",
        "error",
        "-count_frames",
        "-of",
        "csv=p=0",
        "-show_entries",
        entries,
    ]);
    let output = command.arg(path).output().unwrap();
    String::from_utf8(output.stdout)
        .unwrap()
        .lines()
        .map(str::to_owned)
        .collect()
}

/// A WAV file of silence: 16 bits, mono, 8 kHz.
fn silence(seconds: u32) -> Vec<u8> {
    let bytes = 16_000 * seconds;
    let mut wav = Vec::new();
    wav.extend(b"RIFF");
    wav.extend((36 + bytes).to_le_bytes());
    wav.extend(b"WAVEfmt \x10\0\0\0\x01\0\x01\0");
    wav.extend(8_000_u32.to_le_bytes());
    wav.extend(16_000_u32.to_le_bytes());
    wav.extend(b"\x02\0\x10\0data");
    wav.extend(bytes.to_le_bytes());
    wav.resize(wav.len() + bytes as usize, 0);
    wav
}

#[test]
fn sound_is_cut_at_the_end_of_the_film() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a sound.wav");
    std::fs::write(&sound, silence(5)).unwrap();
    for (format, codec) in [(Format::Mp4, "aac"), (Format::Webm, "opus")] {
        if !has_ffmpeg(format) {
            return;
        }
        let path = folder.path().join("a film");
        let mut settings = settings(format);
        settings.sound = Some(sound.clone());
        write(&path, &settings).unwrap();
        let found = probe(&path, "stream=codec_type,codec_name:format=duration");
        assert!(found.contains(&format!("{codec},audio")), "{found:?}");
        let duration: f64 = found.last().unwrap().parse().unwrap();
        // A block of AAC or Opus is at most 1024 samples at 8 kHz, or 60 ms.
        assert!((1.0..1.0 + 0.129).contains(&duration), "{format}: {duration}");
    }
}

#[test]
fn a_film_without_a_count_has_its_frames_several_times() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    if !has_ffmpeg(Format::Mp4) {
        return;
    }
    let mut settings = settings(Format::Mp4);
    settings.plays = Plays::Count(3);
    let film = write(&path, &settings).unwrap();
    assert_eq!(film.shown, 30);
    assert_eq!(probe(&path, "stream=nb_read_frames"), ["30"]);
}

#[test]
fn ffmpeg_states_why_it_fails_and_the_frames_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    if !has_ffmpeg(Format::Mp4) {
        return;
    }
    let mut settings = settings(Format::Mp4);
    settings.sound = Some(folder.path().join("none.wav"));
    let error = write(&path, &settings).unwrap_err();
    assert!(
        matches!(&error, FilmError::Ffmpeg(message) if message.contains("none.wav")),
        "{error}"
    );
    let left: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert_eq!(left, ["a.mp4.frames"]);
    settings.sound = None;
    let film = FilmWriter::open(&path, settings, "a").unwrap();
    assert_eq!(film.existing(), 10);
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
