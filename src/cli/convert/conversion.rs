//! One shader: translated, and proved where that is asked for.

use std::path::PathBuf;

use rayon::ThreadPool;
use toyproof_diagnostic::{Deadline, Diagnostic, Overdue};
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::browser::{Chromium, Text};
use toyproof_gpu::{Failure, Worker, Written};
use toyproof_translate::backend::Target;
use toyproof_translate::wgsl::{self, Style};
use toyproof_translate::{FloatMode, Lowered};
use toyproof_verify::conversion::FRAMES;

use super::super::inputs::{DriverArgs, LanguageArgs};
use super::super::shader::{Shader, Unusable, is_invalid};
use super::super::{Exit, pool};
use super::args::To;
use super::proof::{NAGA, Standing, in_browser};
use super::{header, tool};
use crate::cli::files::{Found, ReadError};

/// What is to be made of every shader.
pub(super) struct Converter<'a> {
    pub(super) to: To,
    pub(super) float: FloatMode,
    pub(super) style: Style,
    pub(super) verify: bool,
    /// Where a browser is, if it is asked too.
    pub(super) browser: Option<PathBuf>,
    pub(super) language: &'a LanguageArgs,
    pub(super) driver: &'a DriverArgs,
}

/// What a thread has for itself.
pub(super) struct Hand {
    translator: Result<Worker, String>,
    /// What runs what was converted; none where the evaluator is asked to.
    pub(super) runner: Result<Option<Worker>, String>,
    pub(super) browser: Option<Chromium>,
    /// Where the evaluator runs, if others are at work beside it.
    pub(super) pool: Option<ThreadPool>,
}

/// A converted shader.
pub(super) struct Made {
    pub(super) bytes: Vec<u8>,
    pub(super) standing: Standing,
    /// Why it is naga's text where ours was wanted.
    pub(super) instead: Option<String>,
}

impl Made {
    /// Whether it is proved, or nobody asked.
    pub(super) fn is_proved(&self) -> bool {
        !matches!(self.standing, Standing::Unproved(_) | Standing::Untried(_))
    }
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
    /// What one of so many threads works with.
    pub(super) fn hand(&self, threads: usize) -> Hand {
        let runner = self.driver.worker_for(FRAMES.len() as u32);
        Hand {
            translator: self.driver.translator(),
            runner: runner.map(|runner| runner.map(Worker::with_plain_code)),
            pool: self.verify.then(|| pool::own(threads)).flatten(),
            browser: self.browser.as_ref().map(|program| {
                let patience = self.driver.timeout() * FRAMES.len() as u32;
                Chromium::new(program.clone(), patience)
            }),
        }
    }

    pub(super) fn convert(
        &self,
        hand: &mut Hand,
        input: &Result<Found, ReadError>,
    ) -> (Shader, Result<Made, Trouble>) {
        let shader = Shader::load(input, self.language, Deadline::after(self.driver.timeout()));
        let made = match &shader.checked {
            Ok(checked) => self.make(hand, checked, &shader),
            Err(Unusable::Invalid(diagnostics)) => Err(Trouble::Told(diagnostics.clone(), Exit::Bad)),
            Err(Unusable::Trouble(error)) => Err(Trouble::Unreadable(error.clone())),
        };
        (shader, made)
    }

    fn make(&self, hand: &mut Hand, checked: &Checked, shader: &Shader) -> Result<Made, Trouble> {
        let Some(target) = self.to.target() else {
            let lowered = self.lower(checked)?;
            let bytes = lowered.text().as_bytes().to_vec();
            let standing = if self.verify {
                let readings = vec![(NAGA.to_owned(), Written::Lowered(lowered))];
                self.run(hand, (checked, &shader.files), readings, None)
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
            let made = self.readable(hand, checked, shader)?;
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
            let other = self.by_naga(hand, checked, target, shader);
            return match (made, other) {
                // Neither is proved: the one that people can read.
                (
                    Ok(made),
                    Err(_)
                    | Ok(Made {
                        standing: Standing::Unproved(_) | Standing::Untried(_),
                        ..
                    }),
                ) => Ok(made),
                (_, other) => other.map(|made| Made {
                    instead: Some(why),
                    ..made
                }),
            };
        }
        self.by_naga(hand, checked, target, shader)
    }

    /// WGSL with the author's words; or why there is none.
    fn readable(
        &self,
        hand: &mut Hand,
        checked: &Checked,
        shader: &Shader,
    ) -> Result<Result<Made, String>, Trouble> {
        let deadline = Deadline::after(self.driver.timeout());
        match wgsl::wgsl(checked, &shader.files, self.style, &deadline) {
            Ok(text) => self.judged(hand, checked, shader, text),
            Err(wgsl::Failure::Overdue(overdue)) => Err(too_slow(overdue)),
            Err(wgsl::Failure::Unprintable(why)) => Ok(Err(format!(
                "cannot be written in the style {}: {why}",
                self.style.name()
            ))),
        }
    }

    /// That WGSL, proved if that is asked for; or why naga does not read it.
    fn judged(
        &self,
        hand: &mut Hand,
        checked: &Checked,
        shader: &Shader,
        text: String,
    ) -> Result<Result<Made, String>, Trouble> {
        let hosted = self.style.hosted(&text);
        match translator(hand)?.read_wgsl(&hosted.text) {
            Ok(()) => {}
            Err(failure @ Failure::Timeout { .. }) => return Err(trouble(failure)),
            Err(Failure::Reread(why)) => return Ok(Err(why)),
            Err(failure) => return Ok(Err(failure.to_string())),
        }
        let mut bytes = text.into_bytes();
        let standing = if self.verify {
            // The other styles are whole only within their hosts.
            let judged = match self.style {
                Style::Plain => tool::judge(Target::Wgsl, &bytes),
                _ => Ok(None),
            };
            match judged {
                Err(why) => Standing::Unproved(why),
                Ok(judge) => {
                    let readings = vec![(NAGA.to_owned(), Written::Wgsl(hosted.clone()))];
                    let standing = self.run(hand, (checked, &shader.files), readings, judge);
                    let text = Text::Wgsl(&hosted.text);
                    in_browser(hand, checked, shader, standing, text, hosted.upside_down)
                }
            }
        } else {
            Standing::Unasked
        };
        header::put(&mut bytes, Target::Wgsl, &shader.name, &standing);
        Ok(Ok(Made {
            bytes,
            standing,
            instead: None,
        }))
    }

    fn lower(&self, checked: &Checked) -> Result<Lowered, Trouble> {
        let deadline = Deadline::after(self.driver.timeout());
        let lowered = self.float.lower_within(checked, &deadline);
        lowered.map_err(too_slow)
    }

    /// What naga writes of the shader.
    fn by_naga(
        &self,
        hand: &mut Hand,
        checked: &Checked,
        target: Target,
        shader: &Shader,
    ) -> Result<Made, Trouble> {
        let lowered = self.lower(checked)?;
        let mut bytes = translator(hand)?
            .translate(lowered.clone(), target, self.float)
            .map_err(trouble)?;
        let standing = if self.verify {
            let standing = self.judge(hand, (checked, &shader.files), lowered, target, &bytes);
            let standing = standing.unwrap_or_else(Standing::Unproved);
            let text = String::from_utf8_lossy(&bytes);
            let text = match target {
                Target::Glsl => Text::Glsl(&text),
                _ => Text::Wgsl(&text),
            };
            in_browser(hand, checked, shader, standing, text, false)
        } else {
            Standing::Unasked
        };
        header::put(&mut bytes, target, &shader.name, &standing);
        Ok(Made {
            bytes,
            standing,
            instead: None,
        })
    }
}

/// What translates, in a process of its own.
fn translator(hand: &mut Hand) -> Result<&mut Worker, Trouble> {
    let translator = hand.translator.as_mut();
    translator.map_err(|error| Trouble::Said(error.clone(), Exit::Trouble))
}

fn too_slow(overdue: Overdue) -> Trouble {
    Trouble::Told(vec![glsl::overdue(overdue)], Exit::Bad)
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
