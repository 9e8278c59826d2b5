//! Shaders with parameters: uniforms whose values are given for each point. Many variants of a shader,
//! selected by parameters, are compiled once, and evaluated side by side at a few points each, without
//! machine code, which does not pay.

use std::cell::RefCell;
use std::time::Duration;

use toyproof_diagnostic::Deadline;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::VariableId;
use toyproof_image::Frame;

use crate::build::{BuildOptions, Refusal};
use crate::compile::compile;
use crate::exec::batch::{Active, Batch};
use crate::exec::evaluate::Number;
use crate::exec::isel::FrameCode;
use crate::exec::lanes::LANES;
use crate::exec::limits::{BandError, Failure, Limits};
use crate::exec::ops::run;
use crate::exec::settings::Settings;
use crate::exec::tile::FrameJob;
use crate::ir::Kind;
use crate::lower::LoweredCode;

/// A shader with parameters, compiled for one frame in f64.
#[derive(Debug)]
pub struct ParametricProgram {
    lowered: LoweredCode,
    code: FrameCode<f64>,
}

impl ParametricProgram {
    /// Compiles a shader. The `parameters` are declared as uniforms of type `float` or `bool` in its tree.
    /// The result of an undefined operation is that of a strict GPU run.
    ///
    /// # Errors
    /// If the shader has more than `max_values` values once its calls are inlined, or takes longer
    /// than `limit` to compile.
    pub fn new(
        checked: &Checked,
        parameters: &[VariableId],
        frame: &Frame,
        max_values: usize,
        limit: Duration,
    ) -> Result<Self, Refusal> {
        let deadline = Deadline::after(limit);
        let options = BuildOptions {
            max_values,
            ..BuildOptions::default()
        };
        let lowered = compile(checked, parameters, options, &deadline)?;
        let code = f64::select(&lowered, frame);
        Ok(Self { lowered, code })
    }

    /// The number of instructions.
    #[must_use]
    pub fn instructions(&self) -> usize {
        self.code.instructions.len()
    }

    /// Runs `work` with an evaluator of points of the frame, whose size, time and channels are those that the
    /// program was compiled for. Of the settings, the limits and the interrupt count.
    pub fn evaluate<T>(
        &self,
        frame: &Frame,
        settings: &Settings<'_, f64>,
        work: impl FnOnce(&mut PointEvaluator<'_>) -> T,
    ) -> T {
        let limits = Limits::new(settings);
        let job = FrameJob::new(
            &self.lowered,
            &self.code,
            &frame.channels,
            &limits,
            settings,
            frame.size,
        );
        let batch = RefCell::new(job.batch());
        work(&mut PointEvaluator {
            program: self,
            job: &job,
            batch: &batch,
            limits: &limits,
            max_iterations: settings.max_iterations,
            iterations: 0,
            work: 0.0,
        })
    }
}

/// The cost of dispatching an instruction, relative to executing it for one chunk of pixels.
const DISPATCH: f64 = 1.0;

/// A point in the coordinates of `fragCoord`, with the values of the parameters there, in their order. A
/// `bool` is 0 or 1.
#[derive(Debug, Clone, Copy)]
pub struct Point<'v> {
    /// The position.
    pub at: [f64; 2],
    /// The parameters; those that are missing are 0.
    pub values: &'v [f64],
}

/// Evaluates a [`ParametricProgram`] at points.
pub struct PointEvaluator<'a> {
    program: &'a ParametricProgram,
    job: &'a FrameJob<'a, f64>,
    batch: &'a RefCell<Batch<'a, f64>>,
    limits: &'a Limits<'a>,
    max_iterations: u32,
    iterations: u32,
    work: f64,
}

impl PointEvaluator<'_> {
    /// The colors at some points; none where the shader runs more loop iterations than the settings allow.
    /// Four points in a row form a quad, across which derivatives are taken.
    ///
    /// # Errors
    /// If the evaluation is interrupted.
    pub fn colors(&mut self, points: &[Point<'_>]) -> Result<Vec<Option<[f64; 3]>>, Failure> {
        self.iterations = 0;
        let mut colors = Vec::with_capacity(points.len());
        for points in points.chunks(self.program.code.width * LANES) {
            self.batch_colors(points, &mut colors)?;
        }
        Ok(colors)
    }

    /// The largest number of loop iterations of a point of the last call.
    #[must_use]
    pub fn iterations(&self) -> u32 {
        self.iterations
    }

    /// The work so far: instructions times the chunks of pixels for which each was executed, and the cost of
    /// dispatching it. It does not depend on the machine.
    #[must_use]
    pub fn work(&self) -> f64 {
        self.work
    }

    /// Evaluates as many points as a batch holds.
    fn batch_colors(
        &mut self,
        points: &[Point<'_>],
        colors: &mut Vec<Option<[f64; 3]>>,
    ) -> Result<(), Failure> {
        let mut batch = self.batch.borrow_mut();
        let mut points = points.to_vec();
        let mut is_excluded = vec![false; points.len()];
        let chunks = points.len().div_ceil(LANES);
        // A point that exceeds the limit ends the batch, which is run again with another in its place.
        while let Some(other) = is_excluded.iter().position(|is_excluded| !is_excluded) {
            let other = points[other];
            for (point, &is_excluded) in points.iter_mut().zip(&is_excluded) {
                if is_excluded {
                    *point = other;
                }
            }
            self.begin(&mut batch, &points, chunks);
            let instructions = run(&batch, &self.program.code.instructions);
            self.work += instructions as f64 * (DISPATCH + chunks as f64);
            let stop = batch.stopped.take();
            if let Some(stop) = stop.filter(|stop| !stop.over_limit) {
                let end = BandError::LoopStopped(stop);
                return Err(end.failure(&self.program.lowered, self.limits, self.max_iterations));
            }
            for (lane, is_excluded) in is_excluded.iter_mut().enumerate() {
                *is_excluded |= iterations(&batch, lane) > self.max_iterations;
            }
            if stop.is_none() {
                break;
            }
        }
        let mut all = Vec::with_capacity(chunks * LANES);
        for chunk in 0..chunks {
            let ([red, green, blue, _], discarded) = self.job.outputs(&batch, chunk);
            all.extend((0..LANES).map(|lane| match discarded[lane] {
                0 => [red, green, blue].map(|component| component[lane]),
                _ => [0.0; 3],
            }));
        }
        for (lane, is_excluded) in is_excluded.into_iter().enumerate() {
            if !is_excluded {
                self.iterations = self.iterations.max(iterations(&batch, lane));
            }
            colors.push((!is_excluded).then_some(all[lane]));
        }
        Ok(())
    }

    /// Activates the chunks that hold the points. The last chunk is filled with copies of the last point.
    fn begin(&self, batch: &mut Batch<'_, f64>, points: &[Point<'_>], chunks: usize) {
        let code = &self.program.code;
        let point = |chunk: usize, lane: usize| &points[(chunk * LANES + lane).min(points.len() - 1)];
        for (axis, row) in code.coordinates.into_iter().enumerate() {
            let Some(row) = row else { continue };
            for (chunk, cell) in batch.float_row(row).iter().enumerate().take(chunks) {
                cell.set(std::array::from_fn(|lane| point(chunk, lane).at[axis]));
            }
        }
        for &(number, kind, row) in &code.parameters {
            let value = |chunk, lane| {
                let values = point(chunk, lane).values;
                values.get(number as usize).copied().unwrap_or_default()
            };
            for chunk in 0..chunks {
                match kind {
                    Kind::Float => {
                        batch.float_row(row)[chunk].set(std::array::from_fn(|lane| value(chunk, lane)));
                    }
                    Kind::Word => {
                        batch.word_row(row)[chunk].set(std::array::from_fn(|lane| word(value(chunk, lane))));
                    }
                }
            }
        }
        batch.active[0].set(Active {
            chunks: u32::MAX >> (32 - chunks),
            all: true,
        });
        batch.iterations.set(0);
        for iterations in &batch.own_iterations {
            iterations.set([0; LANES]);
        }
    }
}

/// The number of loop iterations of a point of a batch.
fn iterations(batch: &Batch<'_, f64>, lane: usize) -> u32 {
    batch.iterations.get() + batch.own_iterations[lane / LANES].get()[lane % LANES]
}

/// A parameter's value as a word; a `bool` is 0 or all bits.
fn word(value: f64) -> u32 {
    if value == 0.0 { 0 } else { u32::MAX }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl::tree::{Type, Variable, VariableKind};

    use super::*;
    use crate::{MAX_VALUES, Program};

    fn checked(text: &str) -> Checked {
        let mut files = Files::default();
        let file = files.add(File::new("a", text));
        toyproof_glsl::check(&files, file, &toyproof_glsl::Options::default()).unwrap()
    }

    const TEXT: &str = "uniform bool flip; uniform float scale;
        void mainImage(out vec4 c, in vec2 p) {
            float x = p.x / iResolution.x;
            for (int i = 0; i < int(p.y); i++) { x += 0.125; }
            c = vec4(flip ? scale * x : x, fract(p.y * 0.1), 0, 1);
        }";

    fn program(checked: &Checked, frame: &Frame) -> ParametricProgram {
        let limit = Duration::from_secs(9);
        ParametricProgram::new(checked, &parameters(checked), frame, MAX_VALUES, limit).unwrap()
    }

    fn parameters(checked: &Checked) -> Vec<VariableId> {
        let variables = checked.tree.variables.iter();
        variables
            .filter(|(_, variable): &(VariableId, &Variable)| variable.kind == VariableKind::Uniform)
            .map(|(id, variable)| {
                assert!(matches!(variable.ty, Type::Scalar(_)));
                id
            })
            .collect()
    }

    #[test]
    fn parameters_change_the_colors_and_points_have_those_of_a_whole_image() {
        let checked = checked(TEXT);
        let frame = Frame {
            size: [96, 64],
            ..Frame::default()
        };
        let program = program(&checked, &frame);
        let image = Program::new(&checked).unwrap();
        let image = image.render(&frame, &Settings::<f64>::default()).unwrap();
        let image = image.framebuffer.image();
        // More points than one batch holds, in an order of their own.
        let pixels: Vec<[u32; 2]> = (0..1000).map(|at| [at * 7 % 96, at * 5 % 64]).collect();
        let points: Vec<[f64; 2]> = pixels
            .iter()
            .map(|&[x, y]| [f64::from(x) + 0.5, f64::from(y) + 0.5])
            .collect();
        let with = |values: &'static [f64], points: &[[f64; 2]]| -> Vec<Point<'static>> {
            points.iter().map(|&at| Point { at, values }).collect()
        };
        program.evaluate(&frame, &Settings::default(), |evaluator| {
            let mut colors = |points: &[Point]| -> Vec<_> {
                evaluator.colors(points).unwrap().into_iter().flatten().collect()
            };
            let plain = colors(&with(&[0.0, 3.0], &points));
            for (&[x, y], color) in pixels.iter().zip(&plain) {
                let [r, g, ..] = image.get(x, y);
                assert_eq!([color[0] as f32, color[1] as f32], [r, g]);
            }
            // Points with different parameters, side by side.
            let mut mixed = with(&[0.0, 3.0], &points[..99]);
            mixed[40..60].copy_from_slice(&with(&[1.0, 3.0], &points[40..60]));
            mixed[60..80].copy_from_slice(&with(&[1.0, -0.5], &points[60..80]));
            for (at, (color, plain)) in colors(&mixed).iter().zip(&plain).enumerate() {
                let scale = match at {
                    40..60 => 3.0,
                    60..80 => -0.5,
                    _ => 1.0,
                };
                assert_eq!(color[0], scale * plain[0], "point {at}");
            }
            assert_eq!(evaluator.iterations(), 64);
        });
    }

    #[test]
    fn points_beyond_the_limit_of_iterations_have_no_color() {
        let checked = checked(TEXT);
        let frame = Frame::default();
        let program = program(&checked, &frame);
        let settings = Settings::<f64> {
            max_iterations: 10,
            ..Settings::default()
        };
        let heights = [2.5, 100_000.5, 5.5, 9.5, 11.5, 200_000.5];
        let points = heights.map(|y| Point {
            at: [0.5, y],
            values: &[],
        });
        program.evaluate(&frame, &settings, |evaluator| {
            let colors = evaluator.colors(&points).unwrap();
            let is_within = heights.map(|y| y < 11.0);
            assert_eq!(colors.iter().map(Option::is_some).collect::<Vec<_>>(), is_within);
            assert_eq!(colors[2].unwrap()[1], 0.55_f64.fract());
            assert!(evaluator.colors(&points[1..2]).unwrap()[0].is_none());
        });
    }
}
