//! The file of finished frames: a line that identifies the film, and a PNG for each frame behind its length.

use std::fs::{File, OpenOptions};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use toyproof_diagnostic::path_name;
use toyproof_image::{input, output};

use crate::FilmError;
use crate::frame::DisplayFrame;

/// Identifies the format.
const FORMAT: &str = "toyproof film 1";

/// The frames of a film that are finished.
#[derive(Debug)]
pub(crate) struct FrameStore {
    path: PathBuf,
    file: File,
    size: [u32; 2],
    keeps_alpha: bool,
    /// The position and the length in bytes of the PNG of each frame.
    frames: Vec<(u64, u32)>,
    /// Where the next frame begins.
    end: u64,
}

impl FrameStore {
    /// Opens the frames that an earlier run left, if it has the same fingerprint, or makes an empty store. A
    /// frame that was not written completely is dropped. In a folder, if one is given, no link is followed.
    pub(crate) fn open(
        (folder, path): (Option<&Path>, &Path),
        size: [u32; 2],
        keeps_alpha: bool,
        fingerprint: &str,
    ) -> Result<Self, FilmError> {
        let head = format!("{FORMAT} {fingerprint} {size:?} {keeps_alpha}\n");
        let is_continued = match input::open(path) {
            Ok(file) => has_head(&file, &head),
            Err(error) if error.kind() == io::ErrorKind::NotFound => false,
            Err(error) => return Err(unwritable(path, &error)),
        };
        if !is_continued {
            let written = match folder {
                Some(folder) => output::write_inside(folder, path, head.as_bytes()),
                None => output::write(path, head.as_bytes()),
            };
            written.map_err(FilmError::Unwritable)?;
        }
        let unwritable = |error: io::Error| unwritable(path, &error);
        let file = OpenOptions::new().read(true).write(true).open(path);
        let file = file.map_err(unwritable)?;
        let mut store = Self {
            path: path.to_owned(),
            file,
            size,
            keeps_alpha,
            frames: Vec::new(),
            end: head.len() as u64,
        };
        store.find_frames().map_err(unwritable)?;
        Ok(store)
    }

    /// Finds the complete frames, and cuts off what follows.
    fn find_frames(&mut self) -> io::Result<()> {
        let total = self.file.metadata()?.len();
        while self.end + 4 <= total {
            let mut length = [0; 4];
            self.file.seek(SeekFrom::Start(self.end))?;
            self.file.read_exact(&mut length)?;
            let length = u32::from_le_bytes(length);
            let start = self.end + 4;
            if start + u64::from(length) > total {
                break;
            }
            self.frames.push((start, length));
            self.end = start + u64::from(length);
        }
        self.file.set_len(self.end)
    }

    /// The number of finished frames.
    pub(crate) fn len(&self) -> u32 {
        self.frames.len() as u32
    }

    /// Appends a frame.
    pub(crate) fn push(&mut self, frame: &DisplayFrame) -> Result<(), FilmError> {
        let mut bytes = vec![0; 4];
        let encoded = self.encode(frame, &mut bytes).and_then(|()| {
            let length = (bytes.len() - 4) as u32;
            bytes[..4].copy_from_slice(&length.to_le_bytes());
            self.file.seek(SeekFrom::Start(self.end))?;
            self.file.write_all(&bytes)?;
            Ok(length)
        });
        let length = encoded.map_err(|error| unwritable(&self.path, &error))?;
        self.frames.push((self.end + 4, length));
        self.end += 4 + u64::from(length);
        Ok(())
    }

    fn encode(&self, frame: &DisplayFrame, out: &mut Vec<u8>) -> io::Result<()> {
        let [width, height] = self.size;
        let mut encoder = png::Encoder::new(out, width, height);
        encoder.set_color(color_type(self.keeps_alpha));
        encoder.set_compression(png::Compression::Fast);
        let mut encoder = encoder.write_header()?;
        encoder.write_image_data(&bytes(&frame.pixels, self.keeps_alpha))?;
        encoder.finish()?;
        Ok(())
    }

    /// Reads a frame again.
    pub(crate) fn read(&mut self, number: u32) -> Result<DisplayFrame, FilmError> {
        let (start, length) = self.frames[number as usize];
        let frame = self.decode(start, length);
        frame.map_err(|_| FilmError::Damaged(path_name(&self.path)))
    }

    fn decode(&mut self, start: u64, length: u32) -> io::Result<DisplayFrame> {
        self.file.seek(SeekFrom::Start(start))?;
        let mut encoded = vec![0; length as usize];
        self.file.read_exact(&mut encoded)?;
        let mut reader = png::Decoder::new(io::Cursor::new(encoded)).read_info()?;
        let info = reader.info();
        let is_expected = [info.width, info.height] == self.size
            && info.color_type == color_type(self.keeps_alpha)
            && info.bit_depth == png::BitDepth::Eight;
        if !is_expected {
            return Err(io::ErrorKind::InvalidData.into());
        }
        let count = self.size[0] as usize * self.size[1] as usize;
        let mut decoded = vec![0; count * if self.keeps_alpha { 4 } else { 3 }];
        reader.next_frame(&mut decoded)?;
        let pixels = if self.keeps_alpha {
            let (pixels, _) = decoded.as_chunks::<4>();
            pixels.to_vec()
        } else {
            let (pixels, _) = decoded.as_chunks::<3>();
            pixels.iter().map(|&[r, g, b]| [r, g, b, u8::MAX]).collect()
        };
        Ok(DisplayFrame {
            size: self.size,
            pixels,
        })
    }

    /// Deletes the file.
    pub(crate) fn remove(self) {
        drop(self.file);
        // The film is complete. A later run with other settings replaces what is left.
        let _ = std::fs::remove_file(&self.path);
    }
}

/// The color type of frames.
pub(crate) fn color_type(keeps_alpha: bool) -> png::ColorType {
    if keeps_alpha {
        png::ColorType::Rgba
    } else {
        png::ColorType::Rgb
    }
}

/// The bytes of pixels, with or without alpha.
pub(crate) fn bytes(pixels: &[[u8; 4]], keeps_alpha: bool) -> Vec<u8> {
    if keeps_alpha {
        pixels.as_flattened().to_vec()
    } else {
        pixels.iter().flat_map(|&[r, g, b, _]| [r, g, b]).collect()
    }
}

/// An error of the system, with the name of the file.
pub(crate) fn unwritable(path: &Path, error: &io::Error) -> FilmError {
    FilmError::Unwritable(io::Error::new(
        error.kind(),
        format!("{}: {error}", path_name(path)),
    ))
}

/// Whether a file begins with this line.
fn has_head(file: &File, head: &str) -> bool {
    let mut found = vec![0; head.len()];
    BufReader::new(file).read_exact(&mut found).is_ok() && found == head.as_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(level: u8, alpha: u8) -> DisplayFrame {
        let pixels = (0..6).map(|at| [level, at, 7, alpha]).collect();
        DisplayFrame { size: [3, 2], pixels }
    }

    #[test]
    fn frames_are_read_as_they_were_written() {
        let folder = tempfile::tempdir().unwrap();
        for (keeps_alpha, alpha) in [(false, 255), (true, 100)] {
            let path = folder.path().join(format!("{keeps_alpha}"));
            let mut store = FrameStore::open((None, &path), [3, 2], keeps_alpha, "a").unwrap();
            for level in [1, 2] {
                store.push(&frame(level, alpha)).unwrap();
            }
            assert_eq!(store.read(0).unwrap(), frame(1, alpha));
            store.push(&frame(3, alpha)).unwrap();
            assert_eq!(store.read(2).unwrap(), frame(3, alpha));
            assert_eq!(store.read(1).unwrap(), frame(2, alpha));
        }
    }

    #[test]
    fn a_store_goes_on_after_its_last_complete_frame() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/x.frames");
        let open = |fingerprint: &str| FrameStore::open((None, &path), [3, 2], false, fingerprint).unwrap();
        let mut store = open("a");
        for level in [1, 2] {
            store.push(&frame(level, 255)).unwrap();
        }
        let whole = store.end;
        drop(store);
        OpenOptions::new()
            .write(true)
            .open(&path)
            .unwrap()
            .set_len(whole - 1)
            .unwrap();
        let mut store = open("a");
        assert_eq!(store.len(), 1, "the second frame is incomplete");
        store.push(&frame(9, 255)).unwrap();
        drop(store);
        let mut store = open("a");
        assert_eq!((store.len(), store.read(1).unwrap()), (2, frame(9, 255)));
        drop(store);
        assert_eq!(open("b").len(), 0, "another film");
        let smaller = FrameStore::open((None, &path), [2, 2], false, "b").unwrap();
        assert_eq!(smaller.len(), 0, "another size");
        smaller.remove();
        assert!(!path.exists());
    }

    #[test]
    fn damage_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.frames");
        let mut store = FrameStore::open((None, &path), [3, 2], false, "a").unwrap();
        store.push(&frame(1, 255)).unwrap();
        let (start, length) = store.frames[0];
        store.file.seek(SeekFrom::Start(start)).unwrap();
        store.file.write_all(&vec![7; length as usize]).unwrap();
        let error = store.read(0).unwrap_err();
        assert!(matches!(error, FilmError::Damaged(_)), "{error}");
    }
}
