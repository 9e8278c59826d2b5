//! What the checks of all shaders of a task share, and what each thread owns.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use rayon::ThreadPool;
use toyproof_diagnostic::Deadline;
use toyproof_explain::repair::{Donors, SearchOptions};
use toyproof_explain::whole_image::OtherScenes;
use toyproof_glsl::Checked;
use toyproof_gpu::Worker;
use toyproof_image::Frame;
use toyproof_scene::Scene;
use toyproof_verify::Failure;
use toyproof_verify::project::bind::accumulate;

use super::features::Features;
use super::options::CheckOptions;
use super::plan::Plan;
use super::reference::{Reference, References, other_scenes};
use super::reference_cache::{CachedReference, SceneCache};
use super::submission::Submission;
use crate::cli::inputs::DriverArgs;
use crate::cli::pool;
use crate::cli::shader::Shader;

/// The worker process and the thread pool that a thread owns.
pub(super) struct WorkerContext {
    /// `None` if the evaluator renders.
    pub(super) worker: Option<Worker>,
    pub(super) pool: Option<ThreadPool>,
}

impl WorkerContext {
    /// Creates the context for one of `threads` threads that need no GPU.
    pub(super) fn without_gpu(threads: usize) -> Self {
        Self {
            worker: None,
            pool: pool::thread_pool(threads),
        }
    }

    /// Creates the context for one of `threads` threads that render images of up to that many pixels.
    pub(super) fn new(driver: &DriverArgs, threads: usize, pixels: u64) -> Self {
        let mut worker = new_worker(driver);
        if let Some(worker) = &mut worker {
            // The driver starts while the first shader is read and its scene is traced.
            worker.warm_up(pixels);
        }
        Self {
            worker,
            pool: pool::thread_pool(threads),
        }
    }

    /// Replaces the worker, which was interrupted in an unknown state.
    pub(super) fn restart(&mut self, driver: &DriverArgs) {
        self.worker = self.worker.take().and_then(|_| new_worker(driver));
    }
}

/// Creates a worker; the arguments have been validated before.
fn new_worker(driver: &DriverArgs) -> Option<Worker> {
    let worker = driver.worker().ok().flatten();
    worker.map(Worker::with_plain_code_for_small_images)
}

/// Checks shaders, on any thread.
pub(super) struct Checker<'a> {
    pub(super) options: &'a CheckOptions,
    pub(super) plan: &'a Plan,
    pub(super) references: &'a References,
    pub(super) features: &'a Features,
    /// Whether the missing driver has been reported.
    pub(super) fell_back: AtomicBool,
    scenes: SceneCache,
    /// The scenes that shaders may render instead of their own.
    pub(super) other_scenes: OtherScenes,
}

impl<'a> Checker<'a> {
    pub(super) fn new(
        options: &'a CheckOptions,
        plan: &'a Plan,
        references: &'a References,
        features: &'a Features,
    ) -> Self {
        Self {
            options,
            plan,
            references,
            features,
            fell_back: AtomicBool::new(false),
            scenes: SceneCache::default(),
            other_scenes: other_scenes(plan.reference.scene.as_deref()),
        }
    }

    /// The number of pixels of the largest frame, unless its scene determines it.
    pub(super) fn pixels(&self) -> u64 {
        let frames = self.plan.frames.iter().map(|planned| planned.frame.size);
        let pixels = frames.map(|[width, height]| u64::from(width) * u64::from(height));
        pixels.max().unwrap_or(0)
    }

    /// Reads a shader, with the values of uniforms of the planned frame with this index.
    pub(super) fn load(&self, submission: &Submission, index: usize) -> Shader {
        Shader::load(
            &submission.input,
            &self
                .plan
                .language(&self.options.language, &self.plan.frames[index].inputs),
            Deadline::after(self.options.driver.timeout()),
        )
    }

    /// Collects the expressions of correct shaders.
    pub(super) fn donors<'s>(&self, correct: impl Iterator<Item = &'s Submission>) -> Donors {
        let shaders: Vec<Shader> = correct.map(|submission| self.load(submission, 0)).collect();
        Donors::new(shaders.iter().filter_map(Shader::single_pass))
    }

    pub(super) fn search_options<'s>(&self, shader: &'s Shader, checked: &Checked) -> SearchOptions<'s> {
        SearchOptions {
            source: shader.text(checked),
            budget: self.options.search,
            donors: None,
            pass: None,
        }
    }

    /// The reference of a shader in the planned frame with this index; sets the size of the frame. If the
    /// image `has_history`, because it depends on earlier frames, it has accumulated a sample in each of
    /// them.
    pub(super) fn cached(
        &self,
        reference: &Reference,
        (index, key): (usize, usize),
        has_history: bool,
        frame: &mut Frame,
    ) -> Result<Arc<CachedReference>, Failure> {
        match reference {
            Reference::Scene(scene) => {
                let mut scene: Scene = scene.scene.clone()?;
                frame.size = self.plan.frames[index].inputs.size.unwrap_or(scene.film.size);
                scene.film.size = frame.size;
                if has_history {
                    accumulate(&mut scene, frame.frame);
                }
                Ok(self.scenes.get(scene, key, frame))
            }
            Reference::Given(given) => Ok(Arc::clone(&given.cached[index])),
        }
    }
}
