//! Instruction selection: code for one number type and frame, where each step becomes an instruction with the
//! function that executes it.

use toyproof_glsl::tree::Input;
use toyproof_image::Frame;

use crate::exec::frame::{float_input, frame_counter};
use crate::exec::lanes::LANES;
use crate::exec::number::Arithmetic;
use crate::exec::ops::{self, Instruction, Level};
use crate::exec::texture::{extent, fitting};
use crate::ir::{Kind, NONE, Operation, Predicate, Value, ValueDef};
use crate::lower::LoweredCode;
use crate::lower::linearize::Step;
use crate::lower::regalloc::Location;
use crate::opt::pair::partner;

/// Executable code for one number type and frame.
#[derive(Debug)]
pub struct FrameCode<N: Arithmetic> {
    pub(crate) instructions: Vec<Instruction<N>>,
    /// The first instruction of each step, and the end.
    pub(crate) positions: Vec<u32>,
    /// The initial values of float scalars; `prologue` sets computed constants.
    pub(crate) floats: Vec<N>,
    /// The initial values of word scalars; `prologue` sets computed constants.
    pub(crate) words: Vec<u32>,
    /// The instructions that compute constants.
    pub(crate) prologue: Vec<Instruction<N>>,
    /// The number of rows of floats.
    pub(crate) float_rows: usize,
    /// The number of rows of words.
    pub(crate) word_rows: usize,
    /// The number of masks.
    pub(crate) masks: usize,
    /// The number of chunks in a row.
    pub(crate) width: usize,
    /// The locations of red, green, blue and alpha.
    pub(crate) color: [Location; 4],
    /// The location of the word that is set by `discard`.
    pub(crate) discarded: Location,
    /// The numbers, kinds and rows of the parameters.
    pub(crate) parameters: Vec<(u32, Kind, u32)>,
    /// The rows of `gl_FragCoord.xy`, where they are used.
    pub(crate) coordinates: [Option<u32>; 2],
}

/// The maximum number of chunks in a row; fewer if there are many rows.
const MAX_ROW_CHUNKS: usize = 16;

/// The target size of all rows of a batch, which should fit in the L2 cache.
const CACHE_BYTES: usize = 768 << 10;

/// The number of spare rows that hold the coordinates of lookups with scalar coordinates.
const SPARE_ROWS: u32 = 3;

impl<N: Arithmetic> FrameCode<N> {
    /// Generates code for a frame in a number type.
    pub(crate) fn select(lowered: &LoweredCode, frame: &Frame) -> Self {
        let (function, locations) = (&lowered.function, &lowered.locations);
        let rows = locations.rows;
        let row_bytes = rows.floats as usize * size_of::<N>() + rows.words as usize * size_of::<u32>();
        let mut width = MAX_ROW_CHUNKS;
        while width > 2 && row_bytes * width * LANES > CACHE_BYTES {
            width /= 2;
        }
        let mut writer = Writer {
            lowered,
            level: Level::detect(),
            width: width as u32,
            code: Vec::new(),
            mask: 0,
        };
        for &value in &lowered.linear.constants {
            writer.compute(value);
        }
        let prologue = std::mem::take(&mut writer.code);
        let (instructions, positions) = writer.steps();
        let mut floats = vec![N::default(); locations.scalars.floats as usize];
        let mut words = vec![0; locations.scalars.words as usize];
        let mut parameters = Vec::new();
        let mut coordinates = [None; 2];
        let textures = fitting(lowered.shapes, &frame.channels);
        for (at, def) in function.defs.iter().enumerate() {
            let location = locations.value(Value(at as u32));
            match (*def, location) {
                (ValueDef::Float(bits), Some(Location::Scalar(to))) => {
                    floats[to as usize] = N::from_f64(f64::from_bits(bits));
                }
                (ValueDef::Word(word), Some(Location::Scalar(to))) => words[to as usize] = word,
                (ValueDef::Input(Input::Frame, _), Some(Location::Scalar(to))) => {
                    words[to as usize] = frame_counter(frame);
                }
                (ValueDef::Input(input, component), Some(Location::Scalar(to))) => {
                    floats[to as usize] = float_input(frame, input, component);
                }
                (ValueDef::Extent { channel, axis }, Some(Location::Scalar(to))) => {
                    let texture = textures[usize::from(channel)].as_ref();
                    floats[to as usize] = N::from_f64(extent(texture, axis).into());
                }
                (ValueDef::Parameter(kind, number), Some(Location::Row(row))) => {
                    parameters.push((number, kind, row * width as u32));
                }
                (ValueDef::FragCoord(axis), Some(Location::Row(row))) => {
                    coordinates[axis as usize] = Some(row * width as u32);
                }
                _ => {}
            }
        }
        let place = |value| match locations.value(value) {
            Some(Location::Row(row)) => Location::Row(row * width as u32),
            Some(location) => location,
            None => Location::Scalar(0),
        };
        let [red, green, blue, alpha, discarded] = function.output;
        Self {
            instructions,
            positions,
            floats,
            words,
            prologue,
            float_rows: rows.floats as usize,
            word_rows: (rows.words + SPARE_ROWS) as usize,
            masks: usize::from(lowered.linear.masks),
            width,
            color: [red, green, blue, alpha].map(place),
            discarded: place(discarded),
            parameters,
            coordinates,
        }
    }
}

/// Emits instructions.
struct Writer<'a, N: Arithmetic> {
    lowered: &'a LoweredCode,
    level: Level,
    width: u32,
    code: Vec<Instruction<N>>,
    mask: u32,
}

impl<N: Arithmetic> Writer<'_, N> {
    /// Returns a location as encoded in instructions, and whether it is a row.
    fn place(&self, location: Option<Location>) -> (u32, bool) {
        match location {
            Some(Location::Row(row)) => (row * self.width, true),
            Some(Location::Scalar(scalar)) => (scalar, false),
            // The value is never computed.
            None => (0, false),
        }
    }

    fn value(&self, value: Value) -> (u32, bool) {
        self.place(self.lowered.locations.value(value))
    }

    fn push(&mut self, run: ops::Handler<N>, out: u32, operands: [u32; 3], to: u32) {
        let mask = self.mask;
        self.code.push(Instruction {
            run,
            out,
            operands,
            mask,
            to,
        });
    }

    /// Emits all steps; returns also the first instruction of each, and the end.
    fn steps(&mut self) -> (Vec<Instruction<N>>, Vec<u32>) {
        let linear = &self.lowered.linear;
        let jumps = linear
            .steps
            .iter()
            .enumerate()
            .filter_map(|(at, (step, _))| match *step {
                Step::Split { if_empty: to, .. }
                | Step::Remove { if_empty: to, .. }
                | Step::JumpIfEmpty(to)
                | Step::Jump(to)
                | Step::JumpIf { to, .. } => Some((at, to as usize)),
                _ => None,
            });
        let mut is_target = vec![false; linear.steps.len() + 1];
        for (_, to) in jumps.clone() {
            is_target[to] = true;
        }
        let mut positions = Vec::with_capacity(linear.steps.len() + 1);
        let mut is_done = false;
        for (at, (step, mask)) in linear.steps.iter().enumerate() {
            positions.push(self.code.len() as u32);
            self.mask = u32::from(mask.0);
            if std::mem::take(&mut is_done) || self.lowered.locations.elided[at] {
                continue;
            }
            is_done = !is_target[at + 1] && self.sine_and_cosine(at);
            if !is_done {
                self.step(step);
            }
        }
        positions.push(self.code.len() as u32);
        let mut code = std::mem::take(&mut self.code);
        for (at, to) in jumps {
            code[positions[at] as usize].to = positions[to];
        }
        (code, positions)
    }

    /// Emits one instruction for a step and the next if they compute the sine and the cosine of an angle.
    fn sine_and_cosine(&mut self, at: usize) -> bool {
        let LoweredCode {
            function,
            linear,
            locations,
            ..
        } = self.lowered;
        let (Some((Step::Compute(first), mask)), Some((Step::Compute(second), next_mask))) =
            (linear.steps.get(at), linear.steps.get(at + 1))
        else {
            return false;
        };
        let (ValueDef::Operation(operation, [angle, ..]), ValueDef::Operation(other, [other_angle, ..])) =
            (function.def(*first), function.def(*second))
        else {
            return false;
        };
        if partner(operation) != Some(other)
            || (angle, mask) != (other_angle, next_mask)
            || locations.elided[at + 1]
        {
            return false;
        }
        let [(angle, has_row), (out, out_is_row), (to, to_is_row)] =
            [angle, *first, *second].map(|value| self.value(value));
        if !(has_row && out_is_row && to_is_row) {
            return false;
        }
        let run = ops::sine_and_cosine(self.level, operation == Operation::Sin);
        self.push(run, out, [angle, 0, 0], to);
        true
    }

    fn step(&mut self, step: &Step) {
        match *step {
            Step::Compute(value) => self.compute(value),
            Step::Store { cell, value } => {
                let kind = self.lowered.function.cells[cell.0 as usize];
                let (to, to_row) = self.place(self.lowered.locations.cell(cell));
                let (from, from_row) = self.value(value);
                let run = if to_row && self.lowered.shared[cell.0 as usize] {
                    ops::store(self.level, kind, from_row)
                } else {
                    ops::copy(self.level, kind, from_row, to_row)
                };
                self.push(run, to, [from, 0, 0], 0);
            }
            Step::StoreAt {
                cells,
                offset,
                index,
                value,
            } => {
                let kind = self.lowered.function.kind(value);
                let (first, cells_are_rows) = self.first_indexed(cells, offset);
                let [index, from] = [index, value].map(|operand| {
                    let (place, is_row) = self.value(operand);
                    if cells_are_rows {
                        ops::row_or_scalar(place, is_row)
                    } else {
                        place
                    }
                });
                let run = ops::store_at(self.level, kind, cells_are_rows);
                self.push(run, from, [index, first, cells.count - 1 - offset], 0);
            }
            Step::Split {
                condition,
                first,
                second,
                when,
                ..
            } => {
                let (condition, _) = self.value(condition);
                let run = if first == second {
                    ops::choose(self.level, when)
                } else {
                    ops::split(self.level, when)
                };
                self.push(run, 0, [condition, first.0.into(), second.0.into()], 0);
            }
            Step::Copy { to } => {
                let run = ops::copy_mask(self.level);
                self.push(run, 0, [to.0.into(), 0, 0], 0);
            }
            Step::Remove {
                condition,
                masks: (_, outer),
                ..
            } => {
                let word = condition.map_or(0, |(condition, _)| self.value(condition).0);
                let run = ops::remove(self.level, condition.map(|(_, when)| when));
                self.push(run, 0, [word, outer.0.into(), 0], 0);
            }
            Step::JumpIfEmpty(_) => self.push(ops::jump_if_empty(), 0, [0; 3], 0),
            Step::Jump(_) => self.push(ops::jump(), 0, [0; 3], 0),
            Step::JumpIf { condition, when, .. } => {
                let (condition, _) = self.value(condition);
                self.push(ops::jump_if(when), 0, [condition, 0, 0], 0);
            }
            Step::Iterate(id) => {
                let run = ops::iterate(self.level);
                self.push(run, 0, [id.0, 0, 0], 0);
            }
            Step::Check {
                predicate,
                values,
                site,
            } => self.check(predicate, values, site.0),
            Step::Trace {
                event, value: NONE, ..
            } => self.push(ops::record_event(), event, [0; 3], 0),
            Step::Trace {
                event,
                component,
                value,
            } => {
                let (from, row) = self.value(value);
                let run = ops::record(self.lowered.function.kind(value), row);
                self.push(run, event, [from, 0, 0], component);
            }
            Step::Count(block) => self.push(ops::count(self.level), block, [0; 3], 0),
        }
    }

    fn check(&mut self, predicate: Predicate, [a, b]: [Value; 2], site: u32) {
        let limit = match predicate {
            Predicate::AtLeast(limit) => limit,
            _ => 0,
        };
        let (mut first, mut second) = ((0, false), (0, false));
        if a != NONE {
            first = self.value(a);
            second = if b == NONE { first } else { self.value(b) };
        }
        let run = ops::check(self.level, predicate, first.1 && second.1);
        let [a, b] = [first, second].map(|(place, is_row)| ops::row_or_scalar(place, is_row));
        self.push(run, site, [a, b, 0], limit);
    }

    /// Returns the first row or scalar that an index is added to, counted in rows, and whether it is a row.
    fn first_indexed(&self, cells: crate::ir::Cells, offset: u32) -> (u32, bool) {
        match self.lowered.locations.cell(crate::ir::Cell(cells.first)) {
            Some(Location::Row(row)) => (row + offset, true),
            Some(Location::Scalar(scalar)) => (scalar + offset, false),
            None => (0, false),
        }
    }

    fn compute(&mut self, value: Value) {
        let function = &self.lowered.function;
        let (out, out_row) = self.value(value);
        match function.def(value) {
            ValueDef::Operation(operation, operands) => {
                let (mut places, mut rows) = ([0; 3], [false; 3]);
                let count = operation.operands().len();
                for (at, &operand) in operands.iter().enumerate().take(count) {
                    (places[at], rows[at]) = self.value(operand);
                }
                if rows.contains(&true) {
                    let operands = [0, 1, 2].map(|at| ops::row_or_scalar(places[at], rows[at]));
                    self.push(ops::compute(self.level, operation, rows), out, operands, 0);
                } else {
                    self.push(ops::compute_scalar(), out, places, operation as u32);
                }
            }
            ValueDef::Load(cell) => {
                let kind = function.cells[cell.0 as usize];
                let (from, from_row) = self.place(self.lowered.locations.cell(cell));
                let run = ops::copy(self.level, kind, from_row, out_row);
                self.push(run, out, [from, 0, 0], 0);
            }
            ValueDef::LoadAt {
                cells,
                offset,
                index,
                kind,
            } => {
                let (index, index_is_row) = self.value(index);
                let (first, cells_are_rows) = self.first_indexed(cells, offset);
                let run = ops::load_at(self.level, kind, cells_are_rows, index_is_row);
                self.push(run, out, [index, first, cells.count - 1 - offset], 0);
            }
            ValueDef::Texel {
                channel,
                component,
                at,
            } => {
                let spare = self.lowered.locations.rows.words;
                let mut places = [0; 3];
                for (axis, &value) in at.iter().enumerate() {
                    let (place, is_row) = self.value(value);
                    places[axis] = if is_row {
                        place
                    } else {
                        let to = (spare + axis as u32) * self.width;
                        let run = ops::copy(self.level, Kind::Word, false, true);
                        self.push(run, to, [place, 0, 0], 0);
                        to
                    };
                }
                let which = u32::from(channel) * 4 + u32::from(component);
                self.push(ops::texel(), out, places, which);
            }
            ValueDef::Float(_)
            | ValueDef::Word(_)
            | ValueDef::Input(..)
            | ValueDef::Extent { .. }
            | ValueDef::Parameter(..)
            | ValueDef::FragCoord(_) => {}
        }
    }
}
