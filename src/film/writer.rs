//! The frames of a film, collected and then encoded.

use std::fmt;
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use toyproof_image::{Image, output};

use crate::FilmError;
use crate::apng::ApngEncoder;
use crate::ffmpeg::{self, FfmpegEncoder};
use crate::frame::DisplayFrame;
use crate::gif::GifEncoder;
use crate::palette::Histogram;
use crate::raw::RawEncoder;
use crate::seam::{Seam, SeamMeter};
use crate::settings::{FilmSettings, Format};
use crate::store::{FrameStore, unwritable};

/// The number of frames whose colors determine those of a GIF.
const SAMPLED_FRAMES: u32 = 32;

/// Checks that a film can be written with these settings, before its frames are rendered.
///
/// # Errors
/// If ffmpeg is needed and cannot be used, or the format lacks what the settings require.
pub fn check(settings: &FilmSettings) -> Result<(), FilmError> {
    let format = settings.format;
    if settings.keeps_alpha && !format.has_alpha() {
        return Err(FilmError::Opaque(format));
    }
    if settings.sound.is_some() && !format.has_sound() {
        return Err(FilmError::Silent(format));
    }
    match format {
        Format::Mp4 | Format::Webm => ffmpeg::check(format),
        Format::Gif | Format::Apng | Format::Y4m | Format::Rgba => Ok(()),
    }
}

/// A film whose frames are rendered. They are kept in `PATH.frames` until the film is complete; one frame is
/// in memory at a time.
#[derive(Debug)]
pub struct FilmWriter {
    path: PathBuf,
    /// The folder that the user named, if the path is one of several files in it.
    folder: Option<PathBuf>,
    settings: FilmSettings,
    store: FrameStore,
}

/// A complete film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film {
    /// The size of the file, in bytes.
    pub bytes: u64,
    /// Width and height of the coded frames, in pixels, which are even in MP4.
    pub size: [u32; 2],
    /// The number of frames that it shows: a GIF shows at most 50 in a second.
    pub shown: u32,
    /// How its end leads into its start; `None` of fewer than three frames.
    pub seam: Option<Seam>,
}

impl FilmWriter {
    /// Starts a film, or goes on with an interrupted one. `fingerprint` is a line that identifies all that
    /// the frames depend on: those of an interrupted film with another fingerprint, size or transparency are
    /// dropped.
    ///
    /// # Errors
    /// Those of [`check`], and if the frames cannot be written.
    pub fn open(path: &Path, settings: FilmSettings, fingerprint: &str) -> Result<Self, FilmError> {
        Self::open_in(None, path, settings, fingerprint)
    }

    /// Starts a film as [`Self::open`] does, as one of the files of a folder, in which no link is followed.
    ///
    /// # Errors
    /// As for [`Self::open`], and if a folder between `folder` and the film is a link.
    pub fn open_inside(
        folder: &Path,
        path: &Path,
        settings: FilmSettings,
        fingerprint: &str,
    ) -> Result<Self, FilmError> {
        Self::open_in(Some(folder), path, settings, fingerprint)
    }

    fn open_in(
        folder: Option<&Path>,
        path: &Path,
        settings: FilmSettings,
        fingerprint: &str,
    ) -> Result<Self, FilmError> {
        check(&settings)?;
        let mut name = path.as_os_str().to_owned();
        name.push(".frames");
        let paths = (folder, Path::new(&name));
        let store = FrameStore::open(paths, settings.size, settings.keeps_alpha, fingerprint)?;
        Ok(Self {
            path: path.to_owned(),
            folder: folder.map(Path::to_owned),
            settings,
            store,
        })
    }

    /// The number of frames that exist: the next one to add has this number.
    pub fn existing(&self) -> u32 {
        self.store.len().min(self.settings.frames)
    }

    /// Adds the next frame.
    ///
    /// # Errors
    /// If it has another size than the film, or cannot be kept.
    pub fn add(&mut self, image: &Image) -> Result<(), FilmError> {
        let size = self.settings.size;
        if image.size() != size {
            return Err(FilmError::Size(image.size(), size));
        }
        self.store
            .push(&DisplayFrame::new(image, self.settings.keeps_alpha))
    }

    /// Encodes the frames, and replaces the file at the film's path by the complete film. `progress` is
    /// called with the number of encoded frames, and returns whether to go on.
    ///
    /// # Errors
    /// Why there is no film. The frames are kept, so that encoding them can be tried again.
    pub fn finish(mut self, progress: &mut dyn FnMut(u32) -> bool) -> Result<Film, FilmError> {
        let (path, folder) = (self.path.clone(), self.folder.clone());
        let mut film = None;
        let made = output::make(folder.as_deref(), &path, |file| {
            film = Some(self.encode(file, progress)?);
            Ok(())
        });
        made.map_err(|error| match error {
            output::MakeError::Output(error) => FilmError::Unwritable(error),
            output::MakeError::Content(error) => error,
        })?;
        self.store.remove();
        // The function has returned a film if there was no error.
        film.ok_or(FilmError::Interrupted)
    }

    /// The number of encoded frames of the whole film, of which [`Self::finish`] reports the progress.
    pub fn steps(&self) -> u32 {
        self.settings.frames.saturating_mul(self.settings.repetitions())
    }

    /// Encodes the film into a file, which takes the place of that at the film's path.
    fn encode(&mut self, file: &Path, progress: &mut dyn FnMut(u32) -> bool) -> Result<Film, FilmError> {
        let mut encoder = self.encoder(file)?;
        let mut meter = SeamMeter::default();
        let frames = self.settings.frames;
        for step in 0..self.steps() {
            if !progress(step) {
                return Err(FilmError::Interrupted);
            }
            let frame = self.store.read(step % frames)?;
            if step < frames {
                meter.add(&frame);
            }
            encoder.add(&frame, &self.path)?;
        }
        let shown = encoder.finish(&self.path)?.unwrap_or(self.steps());
        let found = std::fs::metadata(file).map_err(|error| unwritable(&self.path, &error))?;
        Ok(Film {
            bytes: found.len(),
            size: ffmpeg::coded_size(&self.settings),
            shown,
            seam: meter.seam(frames),
        })
    }

    fn encoder(&mut self, file: &Path) -> Result<Encoder<BufWriter<File>>, FilmError> {
        let settings = &self.settings;
        if let Format::Mp4 | Format::Webm = settings.format {
            return Ok(Encoder::Ffmpeg(FfmpegEncoder::new(file, settings)?));
        }
        let path = &self.path;
        let unwritable = |error: io::Error| unwritable(path, &error);
        let opened = OpenOptions::new().write(true).open(file).map_err(unwritable)?;
        let out = BufWriter::new(opened);
        let encoder = match settings.format {
            Format::Gif => {
                let mut colors = Histogram::new();
                let sampled = settings.frames.min(SAMPLED_FRAMES);
                for sample in 0..sampled {
                    // In 64 bits, so that the product cannot overflow.
                    let number = u64::from(sample) * u64::from(settings.frames) / u64::from(sampled);
                    colors.add(&self.store.read(number as u32)?);
                }
                GifEncoder::new(out, settings, &colors).map(Encoder::Gif)
            }
            Format::Apng => ApngEncoder::new(out, settings).map(Encoder::Apng),
            _ => RawEncoder::new(out, settings).map(Encoder::Raw),
        };
        encoder.map_err(unwritable)
    }
}

/// The encoder of a format.
enum Encoder<W: Write> {
    Gif(GifEncoder<W>),
    Apng(ApngEncoder<W>),
    Raw(RawEncoder<W>),
    Ffmpeg(FfmpegEncoder),
}

impl<W: Write> Encoder<W> {
    /// Adds a frame of the film at a path, which errors name.
    fn add(&mut self, frame: &DisplayFrame, path: &Path) -> Result<(), FilmError> {
        let added = match self {
            Self::Gif(encoder) => encoder.add(frame),
            Self::Apng(encoder) => encoder.add(frame),
            Self::Raw(encoder) => encoder.add(frame),
            Self::Ffmpeg(encoder) => return encoder.add(frame),
        };
        added.map_err(|error| unwritable(path, &error))
    }

    /// Ends the film; returns the number of shown frames, if that is not the number of added ones.
    fn finish(self, path: &Path) -> Result<Option<u32>, FilmError> {
        let finished = match self {
            Self::Gif(encoder) => encoder.finish().map(Some),
            Self::Apng(encoder) => encoder.finish().map(|()| None),
            Self::Raw(encoder) => encoder.finish().map(|()| None),
            Self::Ffmpeg(encoder) => return encoder.finish().map(|()| None),
        };
        finished.map_err(|error| unwritable(path, &error))
    }
}

/// Frames that are written to a pipe one after the other.
pub struct StreamWriter<W: Write> {
    encoder: RawEncoder<W>,
    settings: FilmSettings,
}

impl<W: Write> fmt::Debug for StreamWriter<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("StreamWriter")
            .field("settings", &self.settings)
            .finish_non_exhaustive()
    }
}

impl<W: Write> StreamWriter<W> {
    /// Starts a film in [`Format::Y4m`] or [`Format::Rgba`].
    ///
    /// # Errors
    /// Those of `out`.
    ///
    /// # Panics
    /// For other formats.
    pub fn new(out: W, settings: FilmSettings) -> io::Result<Self> {
        assert!(settings.format.is_stream(), "{} is no stream", settings.format);
        Ok(Self {
            encoder: RawEncoder::new(out, &settings)?,
            settings,
        })
    }

    /// Writes the next frame.
    ///
    /// # Errors
    /// Those of the pipe.
    pub fn add(&mut self, image: &Image) -> io::Result<()> {
        self.encoder
            .add(&DisplayFrame::new(image, self.settings.keeps_alpha))
    }

    /// Writes what is still buffered.
    ///
    /// # Errors
    /// Those of the pipe.
    pub fn finish(self) -> io::Result<()> {
        self.encoder.finish()
    }
}
