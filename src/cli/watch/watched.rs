//! Renders a shader that compiles in the moments of the tabs, by the evaluator.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use toyproof_diagnostic::Deadline;
use toyproof_eval::{self as eval, PassFailure, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_image::{Frame, Image, Keys, Rgb8Image, UniformValue, check_size};
use toyproof_player::State;
use toyproof_project::{PassKind, Rendering};
use toyproof_verify::project::bind::clock;
use toyproof_verify::project::playback::{CpuPlayback, PassShader};
use toyproof_watch::{Failure, Rendered, View, WatchedShader};

use super::browser::browser_job;
use super::reference::{References, RenderError};
use super::studio::Loaded;
use crate::cli::CliError;
use crate::cli::debug::{check_pixel, trace_pixel};
use crate::cli::project::{bind_channels, pass_shader, rendering};
use crate::cli::run::{bound, evaluation_error, parse_pass, pass_error};
use crate::cli::shader::Shader;

/// The largest number of frames that are rendered for one that is shown, after a jump or a save. A buffer
/// that remembers more starts later, and the page says so.
const MAX_REPLAYED: i32 = 300;
/// The time limit for tracing a pixel, which follows the mouse.
const MAX_TRACE_TIME: Duration = Duration::from_secs(2);
/// The largest number of sets of values of uniforms whose shaders are kept.
const MAX_VARIANTS: usize = 3;
/// The largest number of tabs whose frames go on from the last one.
const MAX_PLAYS: usize = 8;

/// A version of the shader.
pub(super) struct Watched {
    loaded: Loaded,
    timeout: Duration,
    references: Arc<Mutex<References>>,
    /// The shader as it was loaded.
    compiled: Compiled,
    /// The shader with values of uniforms that a tab gave, the latest first.
    variants: Mutex<Vec<(Vec<UniformValue>, Arc<Variant>)>>,
    /// The frames that the tabs show, the latest first.
    plays: Mutex<Vec<Play>>,
}

/// The shader with other values of uniforms.
struct Variant {
    shader: Shader,
    compiled: Compiled,
}

/// The programs of a shader for the passes that are shown.
#[derive(Default)]
pub(super) struct Compiled(Mutex<Vec<(PassKind, Arc<Prepared>)>>);

/// What renders a pass.
pub(super) struct Prepared {
    /// The graph of a project.
    pub(super) rendering: Option<Rendering>,
    /// The programs of its passes, or that of the shader.
    programs: Vec<Program>,
}

/// The frame that a tab shows, and the one before it.
struct Play {
    tab: u64,
    pass: String,
    uniforms: Vec<UniformValue>,
    /// The first frame that was rendered for it.
    first: i32,
    states: [Option<State>; 2],
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn failed(error: &CliError) -> Failure {
    Failure::Failed(error.in_one_line())
}

/// Why a shader has no image.
fn evaluation_failure(failure: &eval::Failure, shader: &Shader) -> Failure {
    match failure {
        eval::Failure::Interrupted => Failure::Stopped,
        failure => failed(&evaluation_error(failure, shader)),
    }
}

impl Compiled {
    /// The programs for a pass, compiled once.
    fn prepare(
        &self,
        shader: &Shader,
        kind: PassKind,
        frame: &Frame,
        timeout: Duration,
    ) -> Result<Arc<Prepared>, Failure> {
        let mut known = lock(&self.0);
        if let Some((_, prepared)) = known.iter().find(|(known, _)| *known == kind) {
            return Ok(Arc::clone(prepared));
        }
        let prepared = Arc::new(Prepared::new(shader, kind, frame, timeout)?);
        known.push((kind, Arc::clone(&prepared)));
        Ok(prepared)
    }
}

impl Prepared {
    fn new(shader: &Shader, kind: PassKind, frame: &Frame, timeout: Duration) -> Result<Self, Failure> {
        let checked = shader.require_image().map_err(|error| failed(&error))?;
        let Some(passes) = shader.project() else {
            let program = Program::prepared_within(checked, UndefinedPolicy::Plain, Some(timeout));
            let program = program.map_err(|refusal| evaluation_failure(&refusal.into(), shader))?;
            return Ok(Self {
                rendering: None,
                programs: vec![program],
            });
        };
        let rendering = rendering(passes, kind, frame.size);
        let mut rendering = rendering.map_err(|failure| Failure::Failed(failure.to_string()))?;
        bind_channels(passes, &mut rendering, &frame.channels);
        let programs = pass_shader(passes, &rendering).programs(timeout);
        let programs = programs.map_err(|(pass, refusal)| {
            let target = rendering.graph.passes().get(pass).map(|pass| pass.target);
            failed(&pass_error(&refusal.into(), target, shader))
        })?;
        Ok(Self {
            rendering: Some(rendering),
            programs,
        })
    }
}

/// The shader with the values of uniforms of a view.
enum Shown<'a> {
    Loaded(&'a Shader, &'a Compiled),
    Variant(Arc<Variant>),
}

impl Shown<'_> {
    fn shader(&self) -> &Shader {
        match self {
            Self::Loaded(shader, _) => shader,
            Self::Variant(variant) => &variant.shader,
        }
    }

    fn compiled(&self) -> &Compiled {
        match self {
            Self::Loaded(_, compiled) => compiled,
            Self::Variant(variant) => &variant.compiled,
        }
    }
}

/// A frame of a view in which a pass is evaluated: with the buffers that it reads.
struct Bound {
    frame: Frame,
    /// The number of the pass in the project, if it is one.
    pass: Option<usize>,
}

impl Watched {
    pub(super) fn new(loaded: Loaded, timeout: Duration, references: Arc<Mutex<References>>) -> Self {
        Self {
            loaded,
            timeout,
            references,
            compiled: Compiled::default(),
            variants: Mutex::default(),
            plays: Mutex::default(),
        }
    }

    /// The shader with the values of uniforms of a view, read again if they are others than those that the
    /// arguments give.
    fn shown(&self, view: &View) -> Result<Shown<'_>, Failure> {
        if view.uniforms.is_empty() {
            return Ok(Shown::Loaded(&self.loaded.shader, &self.compiled));
        }
        let mut variants = lock(&self.variants);
        if let Some((_, variant)) = variants.iter().find(|(known, _)| *known == view.uniforms) {
            return Ok(Shown::Variant(Arc::clone(variant)));
        }
        let mut language = self.loaded.language.clone();
        let given = std::mem::replace(&mut language.uniform, view.uniforms.clone());
        let language = language.with_uniforms(&given);
        let shader = Shader::load(&self.loaded.input, &language, Deadline::after(self.timeout));
        shader.require_image().map_err(|error| failed(&error))?;
        let variant = Arc::new(Variant {
            shader,
            compiled: Compiled::default(),
        });
        variants.truncate(MAX_VARIANTS - 1);
        variants.insert(0, (view.uniforms.clone(), Arc::clone(&variant)));
        Ok(Shown::Variant(variant))
    }

    /// The frame of a view, with the textures that the user names.
    fn frame(&self, view: &View) -> Result<Frame, Failure> {
        let [width, height] = view.size.map(u64::from);
        check_size(width, height).map_err(|error| Failure::Failed(error.to_string()))?;
        Ok(Frame {
            size: view.size,
            time: view.time,
            frame: view.frame.max(0),
            mouse: view.mouse,
            keys: Keys::from(&view.keys),
            // The page has its own mouse and keyboard.
            script: None,
            ..self.loaded.frame.clone()
        })
    }

    fn pass(view: &View) -> Result<PassKind, Failure> {
        parse_pass(&view.pass).map_err(|expected| Failure::Failed(format!("{}: {expected}", view.pass)))
    }

    /// Evaluates a program in a frame.
    fn evaluate(
        &self,
        program: &Program,
        frame: &Frame,
        shader: &Shader,
        stop: &AtomicBool,
    ) -> Result<Image, Failure> {
        let settings = Settings::<f32> {
            deadline: Some(Instant::now() + self.timeout),
            interrupt: Some(stop),
            ..Settings::plain()
        };
        let rendered = program.render_rows(frame, frame.rows(), &settings);
        let rendered = rendered.map_err(|failure| evaluation_failure(&failure, shader))?;
        Ok(rendered.image)
    }

    /// Plays the passes up to the frame of a view, from the last frame that its tab showed if that was the
    /// one before; calls `read` with the frame and the passes after it. Also returns the first frame.
    fn play<T>(
        &self,
        (shader, prepared): (&Shader, &Prepared),
        (scheduled, frame): (&PassShader<'_>, &Frame),
        view: &View,
        stop: &AtomicBool,
        read: impl FnOnce(&CpuPlayback<'_, f32>, &Frame) -> T,
    ) -> Result<(T, i32), Failure> {
        let number = frame.frame;
        let mut clock = clock(frame);
        clock.inputs.films = scheduled.films.clone();
        let fits = |state: &State| {
            let is_near = (number - MAX_REPLAYED..number).contains(&state.frame);
            is_near && state.size == frame.size && state.fits(scheduled.graph)
        };
        let (mut first, mut state) = ((number - MAX_REPLAYED).max(0), None);
        {
            let mut plays = lock(&self.plays);
            let own = plays.iter().position(|play| {
                (play.tab, &play.pass, &play.uniforms) == (view.tab, &view.pass, &view.uniforms)
            });
            if let Some(play) = own.map(|at| plays.remove(at)) {
                // The later one saves more.
                let found = play.states.into_iter().flatten().rfind(fits);
                (first, state) = found.map_or((first, None), |state| (play.first, Some(state)));
            }
        }
        let settings = Settings {
            interrupt: Some(stop),
            ..Settings::plain()
        };
        let next = state.as_ref().map_or(first, |state| state.frame + 1);
        let mut playback = CpuPlayback::new(
            scheduled,
            &prepared.programs,
            state.as_ref(),
            self.timeout,
            settings,
        );
        for at in next..=number {
            if stop.load(Ordering::Relaxed) {
                return Err(Failure::Stopped);
            }
            if at == number && at > next {
                state = Some(playback.state(at - 1));
            }
            let rendered = playback.render(&clock.frame(at));
            rendered.map_err(|PassFailure { pass, failure }| match failure {
                eval::Failure::Interrupted => Failure::Stopped,
                failure => {
                    let target = scheduled.graph.passes().get(pass).map(|pass| pass.target);
                    failed(&pass_error(&failure, target, shader))
                }
            })?;
        }
        let shown = read(&playback, &clock.frame(number));
        let mut plays = lock(&self.plays);
        plays.truncate(MAX_PLAYS - 1);
        let play = Play {
            tab: view.tab,
            pass: view.pass.clone(),
            uniforms: view.uniforms.clone(),
            first,
            states: [state, Some(playback.state(number))],
        };
        plays.insert(0, play);
        Ok((shown, first))
    }

    /// The inputs of the pass of a view, with the buffers that it reads.
    fn bound(
        &self,
        shader: &Shader,
        prepared: &Prepared,
        view: &View,
        stop: &AtomicBool,
    ) -> Result<Bound, Failure> {
        let frame = self.frame(view)?;
        let (Some(passes), Some(rendering)) = (shader.project(), &prepared.rendering) else {
            return Ok(Bound { frame, pass: None });
        };
        let kind = Self::pass(view)?;
        let pass = passes.project.passes.iter().position(|pass| pass.kind == kind);
        let scheduled = pass_shader(passes, rendering);
        if let Some(frame) = bound(rendering, &scheduled.with_films(&frame)) {
            return Ok(Bound { frame, pass });
        }
        let target = kind.target();
        let at = rendering
            .graph
            .passes()
            .iter()
            .position(|pass| pass.target == target);
        let at = at.ok_or_else(|| Failure::Failed(format!("there is no {kind}")))?;
        let parts = ((shader, prepared), (&scheduled, &frame));
        let (frame, _) = self.play(parts.0, parts.1, view, stop, |playback, frame| {
            playback.bound(at, frame)
        })?;
        Ok(Bound { frame, pass })
    }
}

impl WatchedShader for Watched {
    fn render(&self, view: &View, stop: &AtomicBool) -> Result<Rendered, Failure> {
        let shown = self.shown(view)?;
        let shader = shown.shader();
        let frame = self.frame(view)?;
        let kind = Self::pass(view)?;
        let prepared = shown.compiled().prepare(shader, kind, &frame, self.timeout)?;
        let (passes, rendering) = match (shader.project(), &prepared.rendering) {
            (Some(passes), Some(rendering)) => (passes, rendering),
            _ if kind != PassKind::Image => return Err(Failure::Failed(format!("there is no {kind}"))),
            _ => {
                let image = self.evaluate(&prepared.programs[0], &frame, shader, stop)?;
                return Ok(rendered(&image, &frame, frame.frame));
            }
        };
        let scheduled = pass_shader(passes, rendering);
        if let Some(frame) = bound(rendering, &scheduled.with_films(&frame)) {
            let image = self.evaluate(&prepared.programs[0], &frame, shader, stop)?;
            return Ok(rendered(&image, &frame, frame.frame));
        }
        let target = kind.target();
        let (image, first) = self.play(
            (shader, &prepared),
            (&scheduled, &frame),
            view,
            stop,
            |playback, _| {
                playback
                    .texture(target)
                    .map(|texture| Image::clone(&texture.stack()))
            },
        )?;
        let image = image.ok_or_else(|| Failure::Failed(format!("there is no {kind}")))?;
        Ok(rendered(&image, &frame, first))
    }

    fn reference(&self, view: &View, stop: &AtomicBool) -> Result<Option<Rgb8Image>, Failure> {
        let Some(reference) = self.loaded.reference.as_ref().filter(|_| view.pass == "image") else {
            return Ok(None);
        };
        let frame = self.frame(view)?;
        if let Some(image) = lock(&self.references).find(reference, &frame) {
            return Ok(Some(Rgb8Image::clone(&image)));
        }
        let has_history = self.loaded.shader.has_passes;
        let image = reference.image(&frame, has_history, (self.timeout, stop));
        let image = image.map_err(|error| match error {
            RenderError::Stopped => Failure::Stopped,
            RenderError::Failed(message) => Failure::Failed(message),
        })?;
        if let Some(image) = &image {
            lock(&self.references).keep(reference, &frame, Arc::new(image.clone()));
        }
        Ok(image)
    }

    fn pixel(&self, view: &View, pixel: [u32; 2], stop: &AtomicBool) -> Result<Value, Failure> {
        let shown = self.shown(view)?;
        let shader = shown.shader();
        let kind = Self::pass(view)?;
        let prepared = shown
            .compiled()
            .prepare(shader, kind, &self.frame(view)?, self.timeout)?;
        let Bound { frame, pass } = self.bound(shader, &prepared, view, stop)?;
        check_pixel(pixel, kind, frame.size).map_err(|error| failed(&error))?;
        let checked: &Checked = match (shader.project(), pass) {
            (Some(project), Some(pass)) => &project.checked[pass],
            _ => shader.require_image().map_err(|error| failed(&error))?,
        };
        let reference = self.loaded.reference.as_ref().filter(|_| kind == PassKind::Image);
        let expected = reference.and_then(|reference| reference.pixel(&frame, pixel));
        let limit = self.timeout.min(MAX_TRACE_TIME);
        let traced = trace_pixel((shader, checked), &frame, pixel, expected, limit);
        let (trace, _) = traced.map_err(|error| failed(&error))?;
        Ok(json!({"text": trace.human(false)}))
    }

    fn browser_job(&self, view: &View) -> Result<Value, Failure> {
        let shown = self.shown(view)?;
        let shader = shown.shader();
        let frame = self.frame(view)?;
        let prepared = shown
            .compiled()
            .prepare(shader, Self::pass(view)?, &frame, self.timeout)?;
        browser_job(shader, prepared.rendering.as_ref(), &frame).map_err(Failure::Failed)
    }
}

fn rendered(image: &Image, frame: &Frame, first_frame: i32) -> Rendered {
    Rendered {
        image: image.into(),
        block: frame.block(),
        first_frame,
    }
}
