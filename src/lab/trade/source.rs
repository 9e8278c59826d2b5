//! The shader or project to measure: its text with other settings, compiled for all renderers.

use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

use toyproof_diagnostic::{File, FileId, Files, Span};
use toyproof_eval::{Number, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::{self as glsl, Checked};
use toyproof_gpu::Worker;
use toyproof_image::{Frame, Image};
use toyproof_player::{Clock, Target};
use toyproof_project::files::IncludeFolders;
use toyproof_project::{CompiledProject, Rendering};
use toyproof_translate::FloatMode;
use toyproof_verify::project::playback::{CpuPlayback, DevicePlayback, PassShader};

use super::parameter::{Place, Scope, Setting};

/// The shader of a study, with its texts.
#[derive(Debug, Clone, Copy)]
pub enum Source<'a> {
    /// A shader of one pass.
    Shader {
        /// The tree.
        checked: &'a Checked,
        /// Its text.
        files: &'a Files,
    },
    /// A project.
    Project {
        /// The trees of its passes.
        project: &'a CompiledProject,
        /// What renders the image.
        rendering: &'a Rendering,
        /// The texts of its tabs.
        files: &'a Files,
        /// Where its tabs look for included files.
        includes: Option<&'a IncludeFolders>,
        /// The times of its frames, of which that of the study is the last one that is rendered.
        clock: &'a Clock,
    },
}

impl<'a> Source<'a> {
    /// The file of a shader of one pass.
    fn file(checked: &Checked) -> FileId {
        checked.tree[checked.main_image].at.span.file
    }

    fn files(self) -> &'a Files {
        match self {
            Self::Shader { files, .. } | Self::Project { files, .. } => files,
        }
    }

    /// The text of a shader of one pass, with its tree.
    pub(super) fn single(self) -> Option<(&'a str, &'a Checked)> {
        match self {
            Self::Shader { checked, files } => Some((files.get(Self::file(checked)).text(), checked)),
            Self::Project { .. } => None,
        }
    }

    /// The trees that have parameters.
    pub(super) fn scopes(self) -> Vec<Scope<'a>> {
        match self {
            Self::Shader { checked, files } => vec![Scope::new(checked, files, true)],
            Self::Project {
                project,
                rendering,
                files,
                ..
            } => {
                let passes = project.checked_of(rendering);
                passes.map(|checked| Scope::new(checked, files, false)).collect()
            }
        }
    }

    /// The shader with these settings; `None` if that does not compile, such as an array whose size is one of
    /// them, or is too large.
    pub(super) fn compile(self, settings: &[Setting], options: &glsl::Options) -> Option<Shader> {
        let mut options = options.clone();
        let mut scale = 1.0;
        let mut literals = Vec::new();
        for setting in settings {
            match setting.place() {
                Place::Literal { span, form } => literals.push((*span, form.write(setting.value))),
                Place::Factor(span) => {
                    let step = self.files().text(*span);
                    literals.push((*span, format!("({:?} * ({step}))", setting.value as f32)));
                }
                Place::Size => scale = setting.value,
                Place::Uniform => {
                    options
                        .uniforms
                        .retain(|uniform| uniform.name != setting.parameter);
                    options.uniforms.push(glsl::UniformValue {
                        name: setting.parameter.clone(),
                        components: vec![setting.value],
                    });
                }
            }
        }
        let shader = match self {
            Self::Shader { checked, files } => {
                let file = Self::file(checked);
                Shader::new(None, &edited(files, file, &literals), &options)?
            }
            Self::Project {
                project,
                rendering,
                files,
                includes,
                clock,
            } => {
                let mut files = files.clone();
                let mut changed: Vec<FileId> = literals.iter().map(|(span, _)| span.file).collect();
                changed.dedup();
                let mut included = BTreeMap::new();
                for file in changed {
                    let text = edited(&files, file, &literals);
                    // Included files are read again, by their paths.
                    if let Ok(path) = Path::new(files.get(file).name()).canonicalize() {
                        included.insert(path, text.clone());
                    }
                    files.replace(file, text);
                }
                let includes = includes.map(|includes| includes.clone().with_open_texts(Arc::new(included)));
                let edited = project.recompile(includes.as_ref(), &mut files, &options).ok()?;
                let passes = edited.checked_of(rendering).cloned().collect();
                let frames = Frames {
                    rendering: Rc::new(rendering.clone()),
                    clock: clock.clone(),
                };
                Shader::of_passes(None, passes, Some(frames), &options)?
            }
        };
        Some(Shader {
            settings: settings.to_vec(),
            scale,
            ..shader
        })
    }
}

/// The text of a file with other literals.
fn edited(files: &Files, file: FileId, literals: &[(Span, String)]) -> String {
    let mut text = files.get(file).text().to_owned();
    let mut in_file: Vec<_> = literals.iter().filter(|(span, _)| span.file == file).collect();
    in_file.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
    for (span, literal) in in_file {
        text.replace_range(span.start as usize..span.end as usize, literal);
    }
    text
}

/// The frames of a project.
#[derive(Debug, Clone)]
struct Frames {
    rendering: Rc<Rendering>,
    clock: Clock,
}

/// A shader prepared for the evaluator and for GPUs.
#[derive(Debug)]
pub(super) struct Shader {
    /// The formula that replaces the shader's ray–sphere intersection; `None` for the shader's own.
    pub(super) formula: Option<&'static str>,
    /// What differs from the user's shader.
    pub(super) settings: Vec<Setting>,
    /// The size of the rendered image, relative to the shown one.
    scale: f64,
    /// The passes in the order of the graph; one without `frames`.
    checked: Vec<Checked>,
    programs: Vec<Program>,
    frames: Option<Frames>,
}

impl Shader {
    /// Prepares a shader of one pass; `None` if the text is invalid or the program too large.
    pub(super) fn new(formula: Option<&'static str>, text: &str, options: &glsl::Options) -> Option<Self> {
        let mut files = Files::default();
        let file = files.add(File::new("<trade>", text));
        let checked = glsl::check(&files, file, options).ok()?;
        Self::of_passes(formula, vec![checked], None, options)
    }

    fn of_passes(
        formula: Option<&'static str>,
        checked: Vec<Checked>,
        frames: Option<Frames>,
        options: &glsl::Options,
    ) -> Option<Self> {
        let limit = options.deadline.left();
        let programs = checked
            .iter()
            .map(|checked| Program::prepared_within(checked, UndefinedPolicy::Plain, limit).ok())
            .collect::<Option<_>>()?;
        Some(Self {
            formula,
            settings: Vec::new(),
            scale: 1.0,
            checked,
            programs,
            frames,
        })
    }

    /// The frame with the size that is rendered.
    fn rendered_frame(&self, frame: &Frame) -> Frame {
        let size = frame
            .size
            .map(|side| (f64::from(side) * self.scale).round().max(1.0) as u32);
        Frame {
            size,
            ..frame.clone()
        }
    }

    /// Renders a frame on the evaluator; of a project, its frames up to this one, and takes their mean time.
    pub(super) fn evaluate<N: Number>(
        &self,
        frame: &Frame,
        noise: N::Noise,
        deadline: Instant,
    ) -> Result<(Image, Duration), toyproof_eval::Failure> {
        let rendered = self.rendered_frame(frame);
        let settings = Settings::<N> {
            undefined: UndefinedPolicy::Plain,
            deadline: Some(deadline),
            noise,
            ..Settings::default()
        };
        let start = Instant::now();
        let Some(frames) = &self.frames else {
            let image = self.programs[0].render(&rendered, &settings)?.framebuffer.image();
            return Ok((enlarged(image, frame.size), start.elapsed()));
        };
        let passes = frames.passes(&self.checked);
        let limit = deadline.saturating_duration_since(start);
        let mut playback = CpuPlayback::new(&passes, &self.programs, None, limit, settings);
        for number in 0..=frame.frame {
            let inputs = frames.inputs(number, rendered.size);
            playback.render(&inputs).map_err(|failure| failure.failure)?;
            if Instant::now() > deadline {
                return Err(toyproof_eval::Failure::TimeUp);
            }
        }
        let took = start.elapsed() / (frame.frame as u32 + 1);
        let image = playback
            .texture(Target::Image)
            .map(|texture| Image::clone(&texture.stack()));
        let image = image.ok_or(toyproof_eval::Failure::TimeUp)?;
        Ok((enlarged(image, frame.size), took))
    }

    /// Renders a frame by a driver; of a project, its frames up to this one, and takes their mean time.
    pub(super) fn draw(
        &self,
        worker: &mut Worker,
        frame: &Frame,
        float: FloatMode,
        limit: Duration,
    ) -> Option<(Image, Duration)> {
        let rendered = self.rendered_frame(frame);
        let Some(frames) = &self.frames else {
            let lowered = float.lower(&self.checked[0]);
            let drawn = worker.draw_unwatched(lowered, rendered, float).ok()?;
            let took = drawn.draw;
            return Some((enlarged(drawn.image(), frame.size), took));
        };
        let passes = frames.passes(&self.checked);
        let mut playback = DevicePlayback::open(worker, &passes, None, float, limit).ok()?;
        let start = Instant::now();
        let mut image = None;
        for number in 0..=frame.frame {
            let wanted = (number == frame.frame).then_some(Target::Image);
            let inputs = frames.inputs(number, rendered.size);
            image = playback.render(&inputs, wanted.as_slice()).ok()?.pop();
            if start.elapsed() > limit {
                return None;
            }
        }
        let took = start.elapsed() / (frame.frame as u32 + 1);
        Some((enlarged(image?, frame.size), took))
    }
}

impl Frames {
    fn passes<'a>(&'a self, checked: &'a [Checked]) -> PassShader<'a> {
        PassShader {
            checked: checked.iter().collect(),
            graph: &self.rendering.graph,
            media: &self.rendering.media,
            films: self.rendering.films.clone(),
        }
    }

    fn inputs(&self, number: i32, size: [u32; 2]) -> Frame {
        Frame {
            size,
            ..self.clock.frame(number)
        }
    }
}

/// An image in another size, with linear interpolation between the centers of its pixels.
fn enlarged(image: Image, size: [u32; 2]) -> Image {
    if image.size() == size {
        return image;
    }
    let from = image.size();
    // The two nearest pixels along an axis, and the weight of the second.
    let nearest = |at: u32, axis: usize| {
        let position = (f64::from(at) + 0.5) * f64::from(from[axis]) / f64::from(size[axis]) - 0.5;
        let position = position.clamp(0.0, f64::from(from[axis] - 1));
        let first = position.floor();
        let second = (first as u32 + 1).min(from[axis] - 1);
        (first as u32, second, (position - first) as f32)
    };
    let columns: Vec<_> = (0..size[0]).map(|x| nearest(x, 0)).collect();
    let mut pixels = Vec::with_capacity(size[0] as usize * size[1] as usize);
    for y in 0..size[1] {
        let (low, high, up) = nearest(y, 1);
        for &(left, right, across) in &columns {
            let pixel = |x: u32, y: u32| image.pixels()[(y * from[0] + x) as usize];
            let mix = |a: [f32; 4], b: [f32; 4], weight: f32| {
                [0, 1, 2, 3].map(|at| a[at] + (b[at] - a[at]) * weight)
            };
            let below = mix(pixel(left, low), pixel(right, low), across);
            let above = mix(pixel(left, high), pixel(right, high), across);
            pixels.push(mix(below, above, up));
        }
    }
    Image::new(size[0], size[1], pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enlarged_images_keep_linear_gradients() {
        let ramp = |width: u32| {
            let pixels = (0..width).map(|x| [(x as f32 + 0.5) / width as f32, 0.5, 0.0, 1.0]);
            Image::new(width, 1, pixels.collect())
        };
        let larger = enlarged(ramp(4), [8, 2]);
        assert_eq!(larger.size(), [8, 2]);
        // Between the centers of the outer pixels the gradient is exact; outside it is constant.
        for (x, pixel) in larger.pixels()[..8].iter().enumerate() {
            let exact = (x as f32 + 0.5) / 8.0;
            assert!(
                (pixel[0] - exact.clamp(0.125, 0.875)).abs() < 1e-6,
                "{x}: {pixel:?}"
            );
            assert_eq!(pixel[1..], [0.5, 0.0, 1.0]);
        }
    }
}
