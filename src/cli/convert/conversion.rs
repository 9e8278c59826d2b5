//! One shader: translated, and proved where that is asked for.

use std::thread;

use super::super::Exit;
use super::super::inputs::{DriverArgs, LanguageArgs};
use super::super::shader::{Shader, Unusable, is_invalid};
use super::{To, header, tool};
use crate::compare::plural;
use crate::diagnostic::Diagnostic;
use crate::emit::Target;
use crate::glsl::Checked;
use crate::glsl::wgsl::{self, Style};
use crate::gpu::{Failure, FloatMode, Worker, Written};
use crate::module::ValidModule;
use crate::source::{Found, ReadError};
use crate::verify;
use crate::verify::conversion::{Against, FRAMES, Proof, frames, prove};

/// What is to be made of every shader.
pub(super) struct Converter<'a> {
    pub(super) to: To,
    pub(super) float: FloatMode,
    pub(super) style: Style,
    pub(super) verify: bool,
    pub(super) language: &'a LanguageArgs,
    pub(super) driver: &'a DriverArgs,
}

/// What a thread has for itself.
pub(super) struct Hand {
    translator: Result<Worker, String>,
    /// What runs what was converted; none where the evaluator is asked to.
    runner: Result<Option<Worker>, String>,
}

/// A converted shader.
pub(super) struct Made {
    pub(super) bytes: Vec<u8>,
    pub(super) standing: Standing,
    /// Why it is naga's text where ours was wanted.
    pub(super) instead: Option<String>,
}

/// How far a conversion is proved.
pub(super) enum Standing {
    /// Nobody asked.
    Unasked,
    /// What was written was read again, and paints the same.
    Proved(Proof),
    /// What naga wrote it from paints the same; the text itself was not run, but judged by that tool, if there is one.
    Meant(Proof, Option<String>),
    /// It is not proved, for that reason.
    Unproved(String),
}

/// Why there is no conversion.
pub(super) enum Trouble {
    /// What is wrong, with its place.
    Told(Vec<Diagnostic>, Exit),
    /// What is wrong, in words.
    Said(String, Exit),
    /// The shader cannot be had.
    Unreadable(String),
}

impl Trouble {
    pub(super) fn exit(&self) -> Exit {
        match self {
            Self::Told(_, exit) | Self::Said(_, exit) => *exit,
            Self::Unreadable(_) => Exit::Trouble,
        }
    }
}

impl Converter<'_> {
    pub(super) fn hand(&self) -> Hand {
        Hand {
            translator: self.driver.translator(),
            runner: self.driver.worker_for(FRAMES.len() as u32),
        }
    }

    pub(super) fn convert(
        &self,
        hand: &mut Hand,
        input: &Result<Found, ReadError>,
    ) -> (Shader, Result<Made, Trouble>) {
        let shader = Shader::load(input, self.language);
        let made = match &shader.checked {
            Ok(checked) => self.make(hand, checked, &shader),
            Err(Unusable::Invalid(diagnostics)) => Err(Trouble::Told(diagnostics.clone(), Exit::Bad)),
            Err(Unusable::Trouble(error)) => Err(Trouble::Unreadable(error.clone())),
        };
        (shader, made)
    }

    fn make(&self, hand: &mut Hand, checked: &Checked, shader: &Shader) -> Result<Made, Trouble> {
        let Some(target) = self.to.target() else {
            let lowered = self.float.lower(checked);
            let bytes = lowered.text().as_bytes().to_vec();
            let standing = if self.verify {
                self.run(hand, checked, Written::Lowered(lowered))
                    .map_or_else(Standing::Unproved, Standing::Proved)
            } else {
                Standing::Unasked
            };
            return Ok(Made {
                bytes,
                standing,
                instead: None,
            });
        };
        if target == Target::Wgsl && self.float == FloatMode::Fast {
            let made = self.readable(hand, checked, shader);
            let why = match &made {
                Err(why)
                | Ok(Made {
                    standing: Standing::Unproved(why),
                    ..
                }) => why.clone(),
                Ok(_) => return made.map_err(|why| Trouble::Said(why, Exit::Trouble)),
            };
            if self.style != Style::Plain {
                return made.map_err(|why| Trouble::Said(why, Exit::Trouble));
            }
            let other = self.by_naga(hand, checked, target, &shader.name);
            return match (made, other) {
                // Neither is proved: the one that people can read.
                (
                    Ok(made),
                    Err(_)
                    | Ok(Made {
                        standing: Standing::Unproved(_),
                        ..
                    }),
                ) => Ok(made),
                (_, other) => other.map(|made| Made {
                    instead: Some(why),
                    ..made
                }),
            };
        }
        self.by_naga(hand, checked, target, &shader.name)
    }

    /// WGSL with the author's words; or why there is none.
    fn readable(&self, hand: &mut Hand, checked: &Checked, shader: &Shader) -> Result<Made, String> {
        let text = wgsl::wgsl(checked, &shader.files, self.style)
            .map_err(|why| format!("cannot be written in the style {}: {why}", self.style.name()))?;
        let hosted = self.style.hosted(&text);
        is_read(&hosted.text)?;
        let mut bytes = text.into_bytes();
        let standing = if self.verify {
            let judged = match self.style {
                Style::Plain => tool::judge(Target::Wgsl, &bytes).err(),
                _ => None,
            };
            match judged {
                Some(why) => Standing::Unproved(why),
                None => self
                    .run(hand, checked, Written::Wgsl(hosted))
                    .map_or_else(Standing::Unproved, Standing::Proved),
            }
        } else {
            Standing::Unasked
        };
        header::put(&mut bytes, Target::Wgsl, &shader.name, &standing);
        Ok(Made {
            bytes,
            standing,
            instead: None,
        })
    }

    /// What naga writes of the shader.
    fn by_naga(
        &self,
        hand: &mut Hand,
        checked: &Checked,
        target: Target,
        name: &str,
    ) -> Result<Made, Trouble> {
        let lowered = self.float.lower(checked);
        let translator = hand
            .translator
            .as_mut()
            .map_err(|error| Trouble::Said(error.clone(), Exit::Trouble))?;
        let mut bytes = translator
            .translate(lowered.clone(), target, self.float)
            .map_err(trouble)?;
        let standing = if self.verify {
            let written = match target {
                Target::Wgsl => Written::Wgsl(Style::Plain.hosted(&String::from_utf8_lossy(&bytes))),
                _ => Written::Lowered(lowered),
            };
            self.judge(hand, checked, written, target, &bytes)
        } else {
            Standing::Unasked
        };
        header::put(&mut bytes, target, name, &standing);
        Ok(Made {
            bytes,
            standing,
            instead: None,
        })
    }

    fn judge(
        &self,
        hand: &mut Hand,
        checked: &Checked,
        written: Written,
        target: Target,
        bytes: &[u8],
    ) -> Standing {
        let read = match tool::judge(target, bytes) {
            Ok(read) => read,
            Err(why) => return Standing::Unproved(why),
        };
        match self.run(hand, checked, written) {
            Ok(proof) if target == Target::Wgsl => Standing::Proved(proof),
            Ok(proof) => Standing::Meant(proof, read),
            Err(why) => Standing::Unproved(why),
        }
    }

    /// Runs what was written; the proof holds, or there is a reason why not.
    fn run(&self, hand: &mut Hand, checked: &Checked, written: Written) -> Result<Proof, String> {
        let runner = match &mut hand.runner {
            Ok(Some(runner)) => runner,
            Ok(None) => {
                return Err(
                    "to prove a conversion takes a Vulkan driver, and --on cpu asks for none".to_owned(),
                );
            }
            Err(error) => return Err(error.clone()),
        };
        let frames = frames(checked);
        let proof =
            prove(runner, checked, written, &frames, self.driver.timeout()).map_err(
                |failure| match failure {
                    verify::Failure::Gpu(Failure::NoDriver(why)) => {
                        format!("to prove a conversion takes a Vulkan driver: {why}")
                    }
                    failure => failure.to_string(),
                },
            )?;
        if proof.holds() {
            return Ok(proof);
        }
        let differing = proof.differing();
        if differing == 0 {
            return Err("every pixel hangs on what GLSL leaves undefined".to_owned());
        }
        let worst = proof
            .answers
            .iter()
            .map(|answer| answer.max_abs)
            .fold(0.0, f64::max);
        let against = match proof.against {
            Against::Evaluator => "the evaluator's",
            Against::StrictRun => "the shader's own",
        };
        Err(format!(
            "{differing} of {} pixels {} not to the bit {against}, by up to {worst:.1e}",
            proof.pixels(),
            plural(differing, "is", "are")
        ))
    }
}

/// naga recurses on what is nested.
const READER_STACK: usize = 64 << 20;

/// Whether naga reads a text; no driver is asked, so that no process of its own is needed.
fn is_read(text: &str) -> Result<(), String> {
    let text = text.to_owned();
    let reader = thread::Builder::new().stack_size(READER_STACK);
    let read = reader
        .spawn(move || ValidModule::of_wgsl(&text).map(|_| ()))
        .map_err(|error| error.to_string())?;
    read.join()
        .unwrap_or_else(|_| Err("naga panics on it".to_owned()))
}

fn trouble(failure: Failure) -> Trouble {
    match failure {
        Failure::Invalid(diagnostics) => Trouble::Told(diagnostics, Exit::Bad),
        Failure::Refused(diagnostics) => Trouble::Told(diagnostics, Exit::Trouble),
        failure => {
            let exit = if is_invalid(&failure) {
                Exit::Bad
            } else {
                Exit::Trouble
            };
            Trouble::Said(failure.to_string(), exit)
        }
    }
}
