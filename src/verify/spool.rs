//! A queue of bands of an image that keeps only a few in memory, so that the worker can release its image
//! while the comparison is still busy.

use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use toyproof_image::Image;

/// The bands that are kept in memory: as many pixels as 960×540 has.
const MAX_BANDS_IN_MEMORY: usize = 2;

/// A queue with one sender and one receiver. Bands that do not fit into memory are in an unnamed temporary
/// file; if that cannot be written, in memory nevertheless.
#[derive(Debug, Default)]
pub(super) struct Spool {
    queue: Mutex<Queue>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Queue {
    bands: VecDeque<SpooledBand>,
    in_memory: usize,
    file: Option<File>,
    /// Bytes of the file.
    written: u64,
    is_closed: bool,
}

/// A band, and its size and place if it is in the file.
#[derive(Debug)]
enum SpooledBand {
    InMemory(Image),
    InFile { size: [u32; 2], at: u64 },
}

impl Spool {
    fn lock(&self) -> MutexGuard<'_, Queue> {
        // A panic leaves the queue as it was before or after a step.
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a band.
    pub(super) fn send(&self, band: Image) {
        let mut queue = self.lock();
        let spooled = queue.spool(band);
        queue.bands.push_back(spooled);
        self.changed.notify_one();
    }

    /// Tells the receiver that no band follows.
    pub(super) fn close(&self) {
        self.lock().is_closed = true;
        self.changed.notify_one();
    }

    /// Waits for the next band; `None` if there is no other.
    ///
    /// # Errors
    /// The system's error if a band cannot be read from the temporary file.
    pub(super) fn receive(&self) -> io::Result<Option<Image>> {
        let is_empty = |queue: &mut Queue| queue.bands.is_empty() && !queue.is_closed;
        let waited = self.changed.wait_while(self.lock(), is_empty);
        let mut queue = waited.unwrap_or_else(PoisonError::into_inner);
        let Some(band) = queue.bands.pop_front() else {
            return Ok(None);
        };
        match band {
            SpooledBand::InMemory(band) => {
                queue.in_memory -= 1;
                Ok(Some(band))
            }
            SpooledBand::InFile { size, at } => queue.read(size, at).map(Some),
        }
    }
}

impl Queue {
    fn spool(&mut self, band: Image) -> SpooledBand {
        if self.in_memory >= MAX_BANDS_IN_MEMORY
            && let Ok(at) = self.write(&band)
        {
            return SpooledBand::InFile {
                size: band.size(),
                at,
            };
        }
        self.in_memory += 1;
        SpooledBand::InMemory(band)
    }

    /// Writes a band at the end of the file, and returns its place.
    fn write(&mut self, band: &Image) -> io::Result<u64> {
        let at = self.written;
        let file = match &mut self.file {
            Some(file) => file,
            none => none.insert(tempfile::tempfile()?),
        };
        let bytes = bytemuck::cast_slice(band.pixels());
        file.seek(SeekFrom::Start(at))?;
        file.write_all(bytes)?;
        self.written += bytes.len() as u64;
        Ok(at)
    }

    fn read(&mut self, [width, height]: [u32; 2], at: u64) -> io::Result<Image> {
        let mut pixels = vec![[0.0f32; 4]; width as usize * height as usize];
        let file = self.file.as_mut().ok_or(io::ErrorKind::NotFound)?;
        file.seek(SeekFrom::Start(at))?;
        file.read_exact(bytemuck::cast_slice_mut(&mut pixels))?;
        Ok(Image::new(width, height, pixels))
    }
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::*;

    fn band(number: u32) -> Image {
        let pixels = (0..6).map(|at| [number as f32, at as f32, f32::NAN, -0.0]);
        Image::new(3, 2, pixels.collect())
    }

    fn bits(image: &Image) -> Vec<[u32; 4]> {
        image
            .pixels()
            .iter()
            .map(|pixel| pixel.map(f32::to_bits))
            .collect()
    }

    #[test]
    fn bands_arrive_in_order_with_their_bits() {
        let spool = Spool::default();
        (0..30).for_each(|number| spool.send(band(number)));
        let queue = spool.lock();
        assert_eq!(queue.in_memory, MAX_BANDS_IN_MEMORY);
        assert_eq!(queue.written, 28 * 6 * 16);
        drop(queue);
        // While some are taken, others follow.
        thread::scope(|scope| {
            scope.spawn(|| {
                (30..100).for_each(|number| spool.send(band(number)));
                spool.close();
            });
            for number in 0..100 {
                let received = spool.receive().unwrap().unwrap();
                assert_eq!(received.size(), [3, 2]);
                assert_eq!(bits(&received), bits(&band(number)), "band {number}");
            }
            assert!(spool.receive().unwrap().is_none());
        });
    }

    #[test]
    fn bands_stay_in_memory_if_the_file_cannot_be_written() {
        let spool = Spool::default();
        let unwritable = File::open("/dev/null").or_else(|_| File::open(file!()));
        spool.lock().file = Some(unwritable.unwrap());
        (0..30).for_each(|number| spool.send(band(number)));
        spool.close();
        assert_eq!(spool.lock().in_memory, 30);
        for number in 0..30 {
            assert_eq!(bits(&spool.receive().unwrap().unwrap()), bits(&band(number)));
        }
    }
}
