//! The evaluator against the interpreter, bit by bit.

use std::collections::BTreeMap;
use std::fmt;
use std::fmt::Display;
use std::thread;

use toyproof::eval::{
    Arithmetic, Engine, Failure, Fault, Number, Observations, Program, Rendered, Settings, Substitute,
    UndefinedPolicy,
};
use toyproof::glsl::Checked;
use toyproof::image::Frame;

use super::{Faults, Interpreter, Outcome, Real, STACK_BYTES, Single, site};

/// What was compared, in pixels: each counts once for each number type and treatment of undefined operations.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Tally {
    /// The pixels that were compared.
    pub compared: u64,
    /// Those that are out of scope, by reason.
    pub skipped: BTreeMap<&'static str, u64>,
}

impl Tally {
    /// Adds another one.
    pub fn add(&mut self, other: Self) {
        self.compared += other.compared;
        for (reason, count) in other.skipped {
            *self.skipped.entry(reason).or_default() += count;
        }
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let skipped: u64 = self.skipped.values().sum();
        let share = 100.0 * skipped as f64 / (self.compared + skipped).max(1) as f64;
        write!(
            f,
            "{} pixels compared, {skipped} ({share:.2} %) out of scope",
            self.compared
        )?;
        for (reason, count) in &self.skipped {
            write!(f, "; {count}: {reason}")?;
        }
        Ok(())
    }
}

/// All treatments of undefined operations.
pub const POLICIES: [UndefinedPolicy; 5] = [
    UndefinedPolicy::Observed,
    UndefinedPolicy::Plain,
    UndefinedPolicy::Substitute(Substitute::Number),
    UndefinedPolicy::Substitute(Substitute::NotANumber),
    UndefinedPolicy::Substitute(Substitute::OtherImplementation),
];

/// A comparison of a shader in a frame.
#[derive(Debug, Clone, Copy)]
pub struct Comparison<'a> {
    /// The shader.
    pub checked: &'a Checked,
    /// The inputs.
    pub frame: &'a Frame,
    /// The treatment of undefined operations.
    pub policy: UndefinedPolicy,
    /// The pixels that the interpreter runs.
    pub pixels: &'a [[u32; 2]],
    /// The maximum number of steps of the interpreter for each pixel.
    pub max_steps: u64,
}

impl Comparison<'_> {
    /// Compares f32 and f64. Where the evaluator gives up, all pixels are out of scope.
    ///
    /// # Errors
    /// The first difference.
    pub fn run(&self) -> Result<Tally, String> {
        let Ok(program) = Program::prepared(self.checked, self.policy) else {
            return Ok(self.skip("refused by the evaluator"));
        };
        let mut tally = self.run_in::<f32, Single>(&program, "f32")?;
        tally.add(self.run_in::<f64, f64>(&program, "f64")?);
        Ok(tally)
    }

    fn skip(&self, reason: &'static str) -> Tally {
        Tally {
            compared: 0,
            skipped: BTreeMap::from([(reason, self.pixels.len() as u64)]),
        }
    }

    fn run_in<E: Number, I: Real + Send>(&self, program: &Program, number: &str) -> Result<Tally, String> {
        let rendered = |engine| {
            let settings = Settings {
                undefined: self.policy,
                max_iterations: 1 << 16,
                engine,
                ..Settings::<E>::default()
            };
            program.render(self.frame, &settings)
        };
        let case = |error: &dyn Display| format!("{number}, {:?}: {error}", self.policy);
        let handlers = rendered(Engine::Handlers);
        for engine in [Engine::Native, Engine::Avx2] {
            match (&handlers, rendered(engine)) {
                (Ok(handlers), Ok(native)) => {
                    let compared = self.compare_engines(handlers, &native);
                    compared.map_err(|error| case(&format_args!("{engine:?}: {error}")))?;
                }
                (Err(Failure::TooOften { .. }), Err(Failure::TooOften { .. })) => {}
                (handlers, native) => {
                    let failures = [handlers.as_ref().err(), native.as_ref().err()];
                    return Err(case(&format_args!("{engine:?}: {failures:?}")));
                }
            }
        }
        let Ok(rendered) = handlers else {
            return Ok(self.skip("too many iterations"));
        };
        let interpreter = Interpreter {
            checked: self.checked,
            frame: self.frame,
            undefined: self.policy,
            max_steps: self.max_steps,
        };
        let interpreted: Vec<(Outcome<I>, Faults)> = on_a_large_stack(|| {
            let pixels = self.pixels.iter();
            pixels.map(|&pixel| interpreter.pixel(pixel)).collect()
        });
        let image = rendered.framebuffer.image();
        let mut tally = Tally::default();
        for (&[x, y], (outcome, _)) in self.pixels.iter().zip(&interpreted) {
            let is_discarded = rendered.framebuffer.is_discarded(x, y);
            let difference = match *outcome {
                Outcome::Skipped(reason) => {
                    *tally.skipped.entry(reason).or_default() += 1;
                    continue;
                }
                Outcome::Discarded => {
                    (!is_discarded).then(|| "discarded, and not by the evaluator".to_owned())
                }
                Outcome::Color(_) if is_discarded => Some("discarded by the evaluator".to_owned()),
                Outcome::Color([r, g, b, a]) => {
                    let expected = [r, g, b].map(Real::to_f64);
                    let actual = rendered.framebuffer.get(x, y).map(Arithmetic::to_f64);
                    let alpha = [f64::from(a.to_f32()), image.get(x, y)[3].into()];
                    let mut pairs = expected.into_iter().zip(actual).chain([(alpha[0], alpha[1])]);
                    let are_same = pairs.all(|(a, b)| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan());
                    let shown = || {
                        format!(
                            "{expected:?}, {}; the evaluator has {actual:?}, {}",
                            alpha[0], alpha[1]
                        )
                    };
                    (!are_same).then(shown)
                }
            };
            if let Some(difference) = difference {
                return Err(format!(
                    "{number}, {:?}, pixel {x}, {y}: {difference}",
                    self.policy
                ));
            }
            tally.compared += 1;
        }
        if self.policy == UndefinedPolicy::Observed && tally.skipped.is_empty() && self.covers_the_frame() {
            let expected = interpreted.into_iter().map(|(_, faults)| faults);
            compare_faults(expected, &rendered.observations).map_err(|error| format!("{number}: {error}"))?;
        }
        Ok(tally)
    }

    /// Compares every pixel and observation of the handlers with that of machine code. The signs and payloads of NaN are
    /// not compared: the operands of a sum or product may be exchanged.
    fn compare_engines<E: Number>(&self, handlers: &Rendered<E>, native: &Rendered<E>) -> Result<(), String> {
        let [width, height] = self.frame.size;
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let [a, b] = [handlers, native].map(|one| {
                let buffer = &one.framebuffer;
                (
                    buffer.get(x, y).map(Arithmetic::to_f64),
                    buffer.is_discarded(x, y),
                )
            });
            let are_same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
            if a.1 != b.1 || !a.0.iter().zip(&b.0).all(are_same) {
                return Err(format!("pixel {x}, {y}: handlers {a:?}, machine code {b:?}"));
            }
        }
        if handlers.observations == native.observations {
            Ok(())
        } else {
            Err(format!(
                "handlers observed {:?}, machine code {:?}",
                handlers.observations, native.observations
            ))
        }
    }

    fn covers_the_frame(&self) -> bool {
        self.pixels.len() as u64
            == self
                .frame
                .size
                .iter()
                .map(|&side| u64::from(side))
                .product::<u64>()
    }
}

/// Compares the number of pixels of each fault.
fn compare_faults(expected: impl Iterator<Item = Faults>, observed: &Observations) -> Result<(), String> {
    let mut counts: BTreeMap<(Fault, [u32; 4]), i64> = BTreeMap::new();
    for fault in expected.flatten() {
        *counts.entry(fault).or_default() += 1;
    }
    // Which quotients of zeros a compiler sees is not the interpreter's business.
    let own = |fault: Fault| fault.is_undefined() && fault != Fault::ZeroByZero;
    for observed in observed.faults.iter().filter(|observed| own(observed.site.fault)) {
        let key = (observed.site.fault, site(observed.site.at));
        *counts.entry(key).or_default() -= observed.pixels as i64;
    }
    counts.retain(|_, count| *count != 0);
    if counts.is_empty() {
        Ok(())
    } else {
        Err(format!(
            "more or fewer pixels with faults than the evaluator observed: {counts:?}"
        ))
    }
}

fn on_a_large_stack<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    thread::scope(|scope| {
        let thread = thread::Builder::new()
            .stack_size(STACK_BYTES)
            .spawn_scoped(scope, work);
        let result = thread.expect("a thread can be had").join();
        result.unwrap_or_else(|payload| std::panic::resume_unwind(payload))
    })
}
