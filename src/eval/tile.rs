//! One tile of a frame after another: a batch is begun, run, and what it painted and noted is kept.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

use super::number::Number;
use super::program::Compiled;
use super::texture::Texture;
use crate::batch::{Batch, COLUMNS, FUEL, Here, LANES, Lanes, Stop, Watch, lane_at, place};
use crate::framebuffer::{DISCARDED, UNDEFINED};
use crate::lower::isel::Prepared;
use crate::lower::regalloc::Home;
use crate::observe::{MESA_CAP, Observations, Observed, Site, earlier};
use crate::ops::run;
use crate::render::{Failure, Limits, Places, Settings};
use crate::trace::story::{Lead, Scribe, Story};

/// Why a band was not painted.
#[derive(Debug, Clone, Copy)]
pub(crate) enum End {
    Late,
    Loop(Stop),
}

impl End {
    /// The same for those who wait for the picture.
    pub(crate) fn failure(self, compiled: &Compiled, limits: &Limits<'_>, rounds: u32) -> Failure {
        match self {
            Self::Loop(stop) if stop.too_often => Failure::TooOften {
                rounds,
                at: compiled.loop_at(stop.id),
            },
            _ if limits.is_interrupted() => Failure::Interrupted,
            Self::Loop(stop) => Failure::Timeout {
                at: compiled.loop_at(stop.id),
            },
            Self::Late => Failure::TimeUp,
        }
    }
}

/// How many pixels a chunk is wide, and how many high.
const CHUNK_COLUMNS: usize = COLUMNS / 2;
const CHUNK_ROWS: usize = LANES / CHUNK_COLUMNS;

/// A frame that is being painted.
pub(crate) struct Job<'a, N: Number> {
    prepared: &'a Prepared<N>,
    textures: &'a [Option<Texture<'a>>; 4],
    limits: &'a Limits<'a>,
    settings: &'a Settings<'a, N>,
    floats: Vec<N>,
    words: Vec<u32>,
    sites: &'a [Site],
    size: [u32; 2],
    /// Where the pixels are, if not side by side.
    places: Option<&'a Places>,
}

impl<'a, N: Number> Job<'a, N> {
    pub(crate) fn new(
        compiled: &'a Compiled,
        prepared: &'a Prepared<N>,
        textures: &'a [Option<Texture<'a>>; 4],
        limits: &'a Limits<'a>,
        settings: &'a Settings<'a, N>,
        size: [u32; 2],
    ) -> Self {
        let (floats, words) = prologue(prepared, settings, textures, limits);
        Self {
            prepared,
            textures,
            limits,
            settings,
            floats,
            words,
            sites: &compiled.sites,
            size,
            places: None,
        }
    }

    /// The same at places of the frame, not at all its pixels.
    pub(crate) fn at(self, places: Option<&'a Places>) -> Self {
        Self { places, ..self }
    }

    /// How many rows of pixels a tile has.
    pub(crate) fn rows(&self) -> usize {
        self.prepared.width * LANES / COLUMNS
    }

    pub(crate) fn batch(&self) -> Batch<'_, N> {
        let prepared = self.prepared;
        let width = prepared.width;
        let mut here = vec![Here::default(); prepared.masks];
        here[0] = Here {
            chunks: u32::MAX >> (32 - width),
            all: true,
        };
        let mut masks = vec![[0; LANES]; prepared.masks * width];
        masks[..width].fill([u32::MAX; LANES]);
        Batch {
            width,
            floats: vec![Cell::new([N::default(); LANES]); prepared.float_rows * width],
            words: vec![Cell::new([0; LANES]); prepared.word_rows * width],
            float_scalars: self.floats.iter().copied().map(Cell::new).collect(),
            word_scalars: self.words.iter().copied().map(Cell::new).collect(),
            masks: masks.into_iter().map(Cell::new).collect(),
            here: here.into_iter().map(Cell::new).collect(),
            noise: self.settings.noise,
            textures: self.textures,
            fuel: Cell::new(FUEL),
            stopped: Cell::new(None),
            watch: self.limits,
            limit: self.settings.rounds,
            rounds: Cell::new(0),
            own_rounds: vec![Cell::new([0; LANES]); width],
            notes: RefCell::default(),
            scribe: None,
        }
    }

    /// Paints the row of tiles that begins at that row of the frame.
    pub(crate) fn band(
        &self,
        batch: &mut Batch<'_, N>,
        first: u32,
        (pixels, marks): (&mut [[N; 3]], &mut [u8]),
        wanted: Option<&[bool]>,
    ) -> Result<Observations, End> {
        let mut observations = Observations::default();
        for left in (0..self.size[0]).step_by(COLUMNS) {
            if self.limits.is_over() {
                return Err(End::Late);
            }
            if wanted.is_some_and(|wanted| !self.is_wanted(left, wanted)) {
                continue;
            }
            let corner = [left, first];
            self.begin(batch, corner);
            run(batch, &self.prepared.code);
            if let Some(stop) = batch.stopped.take() {
                return Err(End::Loop(stop));
            }
            self.end(batch, corner, pixels, marks, &mut observations);
        }
        Ok(observations)
    }

    /// Whether any pixel of the tile is, in a row of tiles.
    fn is_wanted(&self, left: u32, wanted: &[bool]) -> bool {
        let width = self.size[0] as usize;
        let columns = left as usize..(left as usize + COLUMNS).min(width);
        let mut rows = wanted.chunks(width);
        rows.any(|row| row[columns.clone()].contains(&true))
    }

    /// Runs the tile of a pixel, and takes down what that one does, led by another story.
    pub(crate) fn story(&self, pixel: [u32; 2], lead: Option<Lead<'_>>) -> Result<Story, End> {
        let sides = [COLUMNS, self.rows()];
        let own = [0, 1].map(|axis| pixel[axis] as usize % sides[axis]);
        let corner = [0, 1].map(|axis| pixel[axis] - own[axis] as u32);
        let position = lane_at(own);
        let mut batch = self.batch();
        batch.scribe = Some(Scribe::new(position, lead));
        self.begin(&mut batch, corner);
        run(&batch, &self.prepared.code);
        if let Some(stop) = batch.stopped.take() {
            return Err(End::Loop(stop));
        }
        let mut story = batch.scribe.take().map_or_else(Story::default, Scribe::story);
        let (chunk, lane) = (position / LANES, position % LANES);
        let (colour, discarded) = self.painted(&batch, chunk);
        story.colour = (discarded[lane] == 0).then(|| colour.map(|component| component[lane].to_f64()));
        Ok(story)
    }

    /// Sets the coordinates of a tile.
    fn begin(&self, batch: &mut Batch<'_, N>, corner: [u32; 2]) {
        for (axis, row) in self.prepared.coordinates.into_iter().enumerate() {
            let Some(row) = row else {
                continue;
            };
            for (chunk, cell) in batch.float_row(row).iter().enumerate() {
                let first = corner[axis] as usize + place(chunk * LANES)[axis];
                cell.set(std::array::from_fn(|lane| {
                    N::from_f64(self.coordinate(axis, first + place(lane)[axis]))
                }));
            }
        }
        batch.rounds.set(0);
        for rounds in &batch.own_rounds {
            rounds.set([0; LANES]);
        }
    }

    /// `fragCoord.x` or `fragCoord.y` of a pixel, also beyond the picture's edge.
    fn coordinate(&self, axis: usize, at: usize) -> f64 {
        let middle = at as f64 + 0.5;
        let Some(places) = self.places else {
            return middle;
        };
        let along = [&places.columns, &places.rows][axis];
        along.get(at).or(along.last()).copied().unwrap_or(middle)
    }

    /// The colours of a chunk, and which of its pixels were discarded.
    fn painted(&self, batch: &Batch<'_, N>, chunk: usize) -> ([Lanes<N>; 3], Lanes<u32>) {
        let colour = self.prepared.colour.map(|home| match home {
            Home::Row(row) => batch.float_row(row)[chunk].get(),
            Home::Scalar(scalar) => [batch.float_scalars[scalar as usize].get(); LANES],
        });
        let discarded = match self.prepared.discarded {
            Home::Row(row) => batch.word_row(row)[chunk].get(),
            Home::Scalar(scalar) => [batch.word_scalars[scalar as usize].get(); LANES],
        };
        (colour, discarded)
    }

    /// Keeps what a batch painted and noted, of the pixels that are in the picture.
    fn end(
        &self,
        batch: &Batch<'_, N>,
        [left, low]: [u32; 2],
        pixels: &mut [[N; 3]],
        marks: &mut [u8],
        observations: &mut Observations,
    ) {
        let size = self.size.map(|side| side as usize);
        let corner = [left as usize, low as usize];
        let at = |chunk: usize, lane: usize| {
            let place = place(chunk * LANES + lane);
            let [x, y] = [0, 1].map(|axis| corner[axis] + place[axis]);
            (x < size[0] && y < size[1]).then_some([x, y])
        };
        let index = |[x, y]: [usize; 2]| (y - corner[1]) * size[0] + x;
        let rounds = batch.rounds.get();
        for chunk in 0..batch.width {
            let (colour, discarded) = self.painted(batch, chunk);
            let own_rounds = batch.own_rounds[chunk].get();
            for row in 0..CHUNK_ROWS {
                let Some(first) = at(chunk, lane_at([0, row])) else {
                    continue;
                };
                let count = CHUNK_COLUMNS.min(size[0] - first[0]);
                let here = index(first)..index(first) + count;
                for (column, (pixel, mark)) in
                    pixels[here.clone()].iter_mut().zip(&mut marks[here]).enumerate()
                {
                    let lane = lane_at([column, row]) % LANES;
                    *pixel = colour.map(|component| component[lane]);
                    *mark = if discarded[lane] != 0 { DISCARDED } else { 0 };
                    let rounds = rounds + own_rounds[lane];
                    observations.most_rounds = observations.most_rounds.max(rounds);
                    observations.beyond_cap += u64::from(rounds > MESA_CAP);
                }
            }
        }
        let sites = std::mem::take(&mut batch.notes.borrow_mut().sites);
        let mut noted = BTreeMap::new();
        for (id, chunks) in sites {
            let site = self.sites[id.0 as usize];
            for (chunk, bits) in chunks.into_iter().enumerate() {
                let lanes = (0..LANES).filter(|lane| bits >> lane & 1 != 0);
                for pixel in lanes.filter_map(|lane| at(chunk, lane)) {
                    if site.fault.is_undefined() {
                        marks[index(pixel)] |= UNDEFINED;
                    }
                    let pixel = pixel.map(|place| place as u32);
                    let fault = noted.entry(id).or_insert(Observed {
                        site,
                        pixels: 0,
                        first: pixel,
                    });
                    fault.pixels += 1;
                    fault.first = earlier(fault.first, pixel);
                }
            }
        }
        observations.merge(&Observations {
            faults: noted.into_values().collect(),
            ..Observations::default()
        });
    }
}

/// The scalars that all batches begin with.
fn prologue<N: Number>(
    prepared: &Prepared<N>,
    settings: &Settings<'_, N>,
    textures: &[Option<Texture<'_>>; 4],
    limits: &Limits<'_>,
) -> (Vec<N>, Vec<u32>) {
    let batch = Batch {
        width: 0,
        floats: Vec::new(),
        words: Vec::new(),
        float_scalars: prepared.floats.iter().copied().map(Cell::new).collect(),
        word_scalars: prepared.words.iter().copied().map(Cell::new).collect(),
        masks: Vec::new(),
        here: Vec::new(),
        noise: settings.noise,
        textures,
        fuel: Cell::new(FUEL),
        stopped: Cell::new(None),
        watch: limits,
        limit: settings.rounds,
        rounds: Cell::new(0),
        own_rounds: Vec::new(),
        notes: RefCell::default(),
        scribe: None,
    };
    run(&batch, &prepared.prologue);
    let floats = batch.float_scalars.iter().map(Cell::get).collect();
    let words = batch.word_scalars.iter().map(Cell::get).collect();
    (floats, words)
}
