//! Renders tiles. A *band* is a row of tiles; the pixels of a tile are one *batch*, which is stored in
//! *chunks* of [`LANES`] pixels.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::ops::Range;

use toyproof_image::Texture;

use crate::exec::batch::{Active, Batch, Cancellation};
use crate::exec::frame::{DISCARDED, UNDEFINED};
use crate::exec::isel::FrameCode;
use crate::exec::lanes::{LANES, Lanes, TILE_COLUMNS, chunks, lane_at, lane_position};
use crate::exec::limits::{BandError, Limits};
use crate::exec::native::{BatchTables, NativeBatch, NativeFrame, NativeInput, NativeProgram};
use crate::exec::number::Arithmetic;
use crate::exec::observe::{Observations, Observed, first_in_rows};
use crate::exec::ops::{refuel, run};
use crate::exec::places::Places;
use crate::exec::recorder::{ExecutionTrace, ForcedPrefix, Recorder};
use crate::exec::settings::{Engine, Settings};
use crate::exec::texture::fitting;
use crate::ir::SiteId;
use crate::lower::LoweredCode;
use crate::lower::regalloc::Location;

/// The width of a chunk, in pixels.
const CHUNK_COLUMNS: usize = TILE_COLUMNS / 2;

/// The height of a chunk, in pixels.
const CHUNK_ROWS: usize = LANES / CHUNK_COLUMNS;

/// The smallest number of pixels for which compiling to machine code takes less time than it saves.
const MIN_NATIVE_PIXELS: u64 = 4096;

/// A frame that is being rendered.
pub(crate) struct FrameJob<'a, N: Arithmetic> {
    lowered: &'a LoweredCode,
    code: &'a FrameCode<N>,
    textures: [Option<Texture>; 4],
    limits: &'a Limits<'a>,
    settings: &'a Settings<'a, N>,
    floats: Vec<N>,
    words: Vec<u32>,
    /// Machine code; none where it does not pay.
    native: Option<Box<dyn NativeFrame + 'a>>,
    size: [u32; 2],
    /// The sample positions, if they are not the pixel centers.
    places: Option<&'a Places>,
}

impl<'a, N: Arithmetic> FrameJob<'a, N> {
    pub(crate) fn new(
        lowered: &'a LoweredCode,
        code: &'a FrameCode<N>,
        channels: &[Option<Texture>; 4],
        limits: &'a Limits<'a>,
        settings: &'a Settings<'a, N>,
        size: [u32; 2],
    ) -> Self {
        let textures = fitting(lowered.shapes, channels);
        let (floats, words) = prologue(code, settings, &textures, limits);
        Self {
            lowered,
            code,
            textures,
            limits,
            settings,
            floats,
            words,
            native: None,
            size,
            places: None,
        }
    }

    /// Evaluates the frame at these positions instead of all its pixels.
    pub(crate) fn at(self, places: Option<&'a Places>) -> Self {
        Self { places, ..self }
    }

    /// Runs the machine code of the program if compiling it pays off.
    pub(crate) fn with_native(self, program: Option<&'a dyn NativeProgram>) -> Self {
        let pixels = u64::from(self.size[0]) * u64::from(self.size[1]);
        let engine = self.settings.engine;
        let pays = engine != Engine::Fastest || pixels >= MIN_NATIVE_PIXELS;
        let native = program
            .filter(|_| pays && !self.limits.is_cancelled())
            .zip(N::FORMAT)
            .and_then(|(program, format)| {
                let code = self.code;
                let input = NativeInput {
                    lowered: self.lowered,
                    positions: &code.positions,
                    width: code.width,
                    rows: code.float_rows.max(code.word_rows).max(code.masks),
                    format,
                };
                program.frame(input, engine)
            });
        Self { native, ..self }
    }

    /// Returns the size of the image in pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the size of a tile in pixels.
    pub(crate) fn tile(&self) -> [usize; 2] {
        [TILE_COLUMNS, self.rows()]
    }

    /// Returns the height of a tile in pixels.
    pub(crate) fn rows(&self) -> usize {
        self.code.width * LANES / TILE_COLUMNS
    }

    pub(crate) fn batch(&self) -> Batch<'_, N> {
        let code = self.code;
        let chunk_count = code.width;
        let mut active = vec![Active::default(); code.masks];
        active[0] = Active {
            chunks: u32::MAX >> (32 - chunk_count),
            all: true,
        };
        let masks = chunks([0; LANES], code.masks * chunk_count);
        for chunk in &masks[..chunk_count] {
            chunk.set([u32::MAX; LANES]);
        }
        Batch {
            masks,
            active: active.into_iter().map(Cell::new).collect(),
            ..Batch::new(
                chunk_count,
                [code.float_rows, code.word_rows],
                (&self.floats, &self.words),
                self.settings,
                &self.textures,
                self.limits,
            )
        }
    }

    /// Renders the row of tiles whose lowest row of pixels is `first`; `keep` converts the color and flags of
    /// a pixel to its stored value. Tiles without wanted pixels are left as they are.
    pub(crate) fn render_band<P>(
        &self,
        batch: &mut Batch<'_, N>,
        first: u32,
        (pixels, flags): (&mut [P], &mut [u8]),
        wanted: Option<&[bool]>,
        keep: &impl Fn([N; 4], u8) -> P,
    ) -> Result<Observations, BandError> {
        let mut observations = Observations::default();
        for left in (0..self.size[0]).step_by(TILE_COLUMNS) {
            if self.limits.is_cancelled() {
                return Err(BandError::Cancelled);
            }
            if wanted.is_some_and(|wanted| !self.is_wanted(left, wanted)) {
                continue;
            }
            let corner = [left, first];
            if let Some(native) = &self.native {
                native.run(&Tile {
                    job: self,
                    batch,
                    corner,
                });
            } else {
                self.begin_tile(batch, corner);
                run(batch, &self.code.instructions);
            }
            if let Some(stop) = batch.stopped.take() {
                return Err(BandError::LoopStopped(stop));
            }
            self.end_tile(batch, corner, (pixels, flags), keep, &mut observations);
        }
        Ok(observations)
    }

    /// Whether any pixel of the tile at column `left` is needed.
    fn is_wanted(&self, left: u32, wanted: &[bool]) -> bool {
        let width = self.size[0] as usize;
        let columns = left as usize..(left as usize + TILE_COLUMNS).min(width);
        let mut rows = wanted.chunks(width);
        rows.any(|row| row[columns.clone()].contains(&true))
    }

    /// Runs the tile of a pixel and records the trace of that pixel, with an optional forced prefix.
    pub(crate) fn trace(
        &self,
        pixel: [u32; 2],
        prefix: Option<ForcedPrefix<'_>>,
    ) -> Result<ExecutionTrace, BandError> {
        let sides = [TILE_COLUMNS, self.rows()];
        let own = [0, 1].map(|axis| pixel[axis] as usize % sides[axis]);
        let corner = [0, 1].map(|axis| pixel[axis] - own[axis] as u32);
        let position = lane_at(own);
        let mut batch = self.batch();
        batch.recorder = Some(Recorder::new(position, prefix));
        self.begin_tile(&batch, corner);
        run(&batch, &self.code.instructions);
        if let Some(stop) = batch.stopped.take() {
            return Err(BandError::LoopStopped(stop));
        }
        let mut trace = batch
            .recorder
            .take()
            .map_or_else(ExecutionTrace::default, |recorder| {
                recorder.finish(&self.lowered.sites)
            });
        let (chunk, lane) = (position / LANES, position % LANES);
        let (color, discarded) = self.outputs(&batch, chunk);
        let [red, green, blue, _] = color;
        trace.color =
            (discarded[lane] == 0).then(|| [red, green, blue].map(|component| component[lane].to_f64()));
        Ok(trace)
    }

    /// Runs a tile of a batch with a counter; `visit` is called with the operations of each pixel that lies in
    /// the image, and its position.
    pub(crate) fn count(
        &self,
        batch: &Batch<'_, N>,
        corner: [u32; 2],
        mut visit: impl FnMut(u64, [u32; 2]),
    ) -> Result<(), BandError> {
        if self.limits.is_cancelled() {
            return Err(BandError::Cancelled);
        }
        let counter = batch.counter.as_ref().expect("a profile has a counter");
        let pixel = |chunk: usize, lane: usize| {
            let place = lane_position(chunk * LANES + lane);
            [0, 1].map(|axis| corner[axis] + place[axis] as u32)
        };
        let is_inside = |[x, y]: [u32; 2]| x < self.size[0] && y < self.size[1];
        counter.begin_tile(|chunk, lane| is_inside(pixel(chunk, lane)));
        self.begin_tile(batch, corner);
        run(batch, &self.code.instructions);
        if let Some(stop) = batch.stopped.take() {
            return Err(BandError::LoopStopped(stop));
        }
        for chunk in 0..batch.width {
            for (lane, operations) in counter.operations(chunk).into_iter().enumerate() {
                if is_inside(pixel(chunk, lane)) {
                    visit(operations, pixel(chunk, lane));
                }
            }
        }
        Ok(())
    }

    /// Initializes the coordinates and iteration counts of a tile.
    fn begin_tile(&self, batch: &Batch<'_, N>, corner: [u32; 2]) {
        for (axis, row) in self.code.coordinates.into_iter().enumerate() {
            let Some(row) = row else {
                continue;
            };
            let row = batch.float_row(row);
            for (chunk, cell) in row.iter().enumerate() {
                // Chunks one above the other have the same columns, those side by side the same rows.
                let same = match axis {
                    0 => chunk.checked_sub(TILE_COLUMNS / CHUNK_COLUMNS),
                    _ => (chunk % (TILE_COLUMNS / CHUNK_COLUMNS) > 0).then(|| chunk - 1),
                };
                let first = corner[axis] as usize + lane_position(chunk * LANES)[axis];
                cell.set(match same {
                    Some(other) => row[other].get(),
                    None => std::array::from_fn(|lane| {
                        N::from_f64(self.coordinate(axis, first + lane_position(lane)[axis]))
                    }),
                });
            }
        }
        batch.iterations.set(0);
        for iterations in &batch.own_iterations {
            iterations.set([0; LANES]);
        }
    }

    /// Returns `fragCoord.x` or `fragCoord.y` of a pixel, also beyond the edge of the image.
    fn coordinate(&self, axis: usize, at: usize) -> f64 {
        let middle = at as f64 + 0.5;
        let Some(places) = self.places else {
            return middle;
        };
        let along = [&places.columns, &places.rows][axis];
        along.get(at).or(along.last()).copied().unwrap_or(middle)
    }

    /// Returns the colors of a chunk, and which of its pixels were discarded.
    pub(crate) fn outputs(&self, batch: &Batch<'_, N>, chunk: usize) -> ([Lanes<N>; 4], Lanes<u32>) {
        let color = self.code.color.map(|location| match location {
            Location::Row(row) => batch.float_row(row)[chunk].get(),
            Location::Scalar(scalar) => [batch.float_scalars[scalar as usize].get(); LANES],
        });
        let discarded = match self.code.discarded {
            Location::Row(row) => batch.word_row(row)[chunk].get(),
            Location::Scalar(scalar) => [batch.word_scalars[scalar as usize].get(); LANES],
        };
        (color, discarded)
    }

    /// Stores the colors, flags and observations of those pixels of a batch that lie in the image.
    fn end_tile<P>(
        &self,
        batch: &Batch<'_, N>,
        [left, low]: [u32; 2],
        (pixels, flags): (&mut [P], &mut [u8]),
        keep: &impl Fn([N; 4], u8) -> P,
        observations: &mut Observations,
    ) {
        let size = self.size.map(|side| side as usize);
        let corner = [left as usize, low as usize];
        let at = |chunk: usize, lane: usize| {
            let place = lane_position(chunk * LANES + lane);
            let [x, y] = [0, 1].map(|axis| corner[axis] + place[axis]);
            (x < size[0] && y < size[1]).then_some([x, y])
        };
        let index = |[x, y]: [usize; 2]| (y - corner[1]) * size[0] + x;
        let is_inside = corner[0] + TILE_COLUMNS <= size[0] && corner[1] + self.rows() <= size[1];
        for chunk in 0..batch.width {
            let outputs = self.outputs(batch, chunk);
            for row in 0..CHUNK_ROWS {
                let Some(first) = at(chunk, lane_at([0, row])) else {
                    continue;
                };
                let start = index(first);
                // A known length is unrolled.
                if is_inside {
                    let range = start..start + CHUNK_COLUMNS;
                    store_row(&mut pixels[range.clone()], &mut flags[range], &outputs, row, keep);
                } else {
                    let range = start..start + CHUNK_COLUMNS.min(size[0] - first[0]);
                    store_row(&mut pixels[range.clone()], &mut flags[range], &outputs, row, keep);
                }
            }
            let own = batch.own_iterations[chunk].get();
            let iterations = own.map(|own| batch.iterations.get() + own);
            if is_inside {
                observations.count_iterations(&iterations);
            } else {
                for lane in (0..LANES).filter(|&lane| at(chunk, lane).is_some()) {
                    observations.count_iterations(&iterations[lane..=lane]);
                }
            }
        }
        let sites = std::mem::take(&mut batch.notes.borrow_mut().sites);
        let mut observed = BTreeMap::new();
        for (id, chunks) in sites {
            let site = self.lowered.sites[id.0 as usize];
            for (chunk, bits) in chunks.into_iter().enumerate() {
                let lanes = (0..LANES).filter(|lane| bits >> lane & 1 != 0);
                for pixel in lanes.filter_map(|lane| at(chunk, lane)) {
                    if site.fault.is_undefined() {
                        flags[index(pixel)] |= UNDEFINED;
                    }
                    let pixel = pixel.map(|place| place as u32);
                    let fault = observed.entry(id).or_insert(Observed {
                        site,
                        pixels: 0,
                        first: pixel,
                    });
                    fault.pixels += 1;
                    fault.first = first_in_rows(fault.first, pixel);
                }
            }
        }
        observations.merge(&Observations {
            faults: observed.into_values().collect(),
            ..Observations::default()
        });
    }
}

/// A tile that machine code is run for.
struct Tile<'a, N: Arithmetic> {
    job: &'a FrameJob<'a, N>,
    batch: &'a Batch<'a, N>,
    corner: [u32; 2],
}

impl<N: Arithmetic> NativeBatch for Tile<'_, N> {
    fn tables(&self) -> BatchTables {
        self.batch.into()
    }

    fn begin(&self) {
        self.batch.stopped.set(None);
        self.batch.notes.borrow_mut().sites.clear();
        self.job.begin_tile(self.batch, self.corner);
    }

    fn execute(&self, instructions: Range<u32>) {
        let range = instructions.start as usize..instructions.end as usize;
        run(self.batch, &self.job.code.instructions[range]);
    }

    fn refuel(&self, instruction: u32) -> bool {
        refuel(self.batch, &self.job.code.instructions[instruction as usize], 0);
        self.batch.stopped.get().is_some()
    }

    fn note(&self, site: SiteId, chunk: usize, lanes: &Lanes<u32>) {
        self.batch.notes.borrow_mut().add(site, chunk, lanes);
    }
}

/// Stores the colors and flags of a row of a chunk.
#[inline(always)]
fn store_row<N: Arithmetic, P>(
    pixels: &mut [P],
    flags: &mut [u8],
    (color, discarded): &([Lanes<N>; 4], Lanes<u32>),
    row: usize,
    keep: &impl Fn([N; 4], u8) -> P,
) {
    for (column, (pixel, flag)) in pixels.iter_mut().zip(flags).enumerate() {
        let lane = lane_at([column, row]) % LANES;
        *flag = if discarded[lane] != 0 { DISCARDED } else { 0 };
        *pixel = keep([0, 1, 2, 3].map(|component: usize| color[component][lane]), *flag);
    }
}

/// Computes the initial scalars of all batches.
fn prologue<N: Arithmetic>(
    code: &FrameCode<N>,
    settings: &Settings<'_, N>,
    textures: &[Option<Texture>; 4],
    limits: &Limits<'_>,
) -> (Vec<N>, Vec<u32>) {
    let batch = Batch::new(0, [0; 2], (&code.floats, &code.words), settings, textures, limits);
    run(&batch, &code.prologue);
    let floats = batch.float_scalars.iter().map(Cell::get).collect();
    let words = batch.word_scalars.iter().map(Cell::get).collect();
    (floats, words)
}
