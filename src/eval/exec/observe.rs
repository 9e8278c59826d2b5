//! Observations of a run: undefined operations, each with its source location, its number of pixels, and the
//! first pixel.

use std::collections::BTreeMap;

use crate::exec::lanes::{LANES, Lanes};
use crate::ir::{Site, SiteId};

/// The faults of a batch: for each site, a bit for each pixel.
#[derive(Debug, Clone, Default)]
pub(crate) struct Notes {
    pub(crate) sites: BTreeMap<SiteId, Vec<u16>>,
}

impl Notes {
    /// Adds the pixels of a chunk whose lanes are not zero.
    #[cold]
    pub(crate) fn add(&mut self, site: SiteId, chunk: usize, hit: &Lanes<u32>) {
        let chunks = self.sites.entry(site).or_default();
        if chunks.len() <= chunk {
            chunks.resize(chunk + 1, 0);
        }
        for (lane, &hit) in hit.iter().enumerate().take(LANES) {
            chunks[chunk] |= u16::from(hit != 0) << lane;
        }
    }
}

/// A fault observed at a site.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Observed {
    /// The fault and its source location.
    pub site: Site,
    /// The number of pixels with the fault.
    pub pixels: u64,
    /// The first pixel with the fault, row by row from the bottom.
    pub first: [u32; 2],
}

/// The observations of a run.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Observations {
    /// The observed faults, in source order.
    pub faults: Vec<Observed>,
    /// The largest number of loop iterations of a pixel, all loops together.
    pub max_iterations: u32,
    /// The number of pixels that exceed [`MESA_CAP`].
    pub beyond_cap: u64,
}

/// The number of iterations after which Mesa before version 23 ends all loops of a pixel.
pub const MESA_CAP: u32 = 65_535;

impl Observations {
    /// Adds the loop iterations of pixels.
    #[inline(always)]
    pub(crate) fn count_iterations(&mut self, iterations: &[u32]) {
        let most = iterations.iter().copied().max().unwrap_or(0);
        self.max_iterations = self.max_iterations.max(most);
        if most > MESA_CAP {
            self.beyond_cap += iterations.iter().filter(|&&count| count > MESA_CAP).count() as u64;
        }
    }

    /// Adds the observations of a different part of the image.
    pub fn merge(&mut self, other: &Self) {
        self.max_iterations = self.max_iterations.max(other.max_iterations);
        self.beyond_cap += other.beyond_cap;
        for &new in &other.faults {
            match self.faults.iter_mut().find(|old| old.site == new.site) {
                None => {
                    let place = |observed: &Observed| (observed.site.at.span.start, observed.site.fault);
                    let after = self.faults.partition_point(|old| place(old) <= place(&new));
                    self.faults.insert(after, new);
                }
                Some(old) => {
                    old.pixels += new.pixels;
                    old.first = first_in_rows(old.first, new.first);
                }
            }
        }
    }
}

/// Returns the pixel that comes first, row by row from the bottom.
pub(crate) fn first_in_rows(a: [u32; 2], b: [u32; 2]) -> [u32; 2] {
    if (b[1], b[0]) < (a[1], a[0]) { b } else { a }
}
