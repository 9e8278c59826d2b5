//! How long a frame takes: translate, paint on lavapipe, trace in f32 and f64. `cargo bench`

#![expect(clippy::print_stderr, reason = "a benchmark's own words")]

use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use divan::Bencher;
use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{Options, check};
use toyproof::gpu;
use toyproof::gpu::{AdapterSelector, Worker};
use toyproof::image::Frame;
use toyproof::scene::{self, Scene};
use toyproof::tracer::{Backend, Tracer};
use toyproof::translate::backend::spirv;
use toyproof::translate::naga_ir::ValidModule;
use toyproof::translate::{FloatMode, Lowered, lower};

const EXERCISES: [&str; 3] = ["02-sphere", "04-many-objects", "05-complex-scene"];

fn main() {
    divan::main();
}

fn lowered(exercise: &str) -> Lowered {
    let mut files = Files::default();
    let text = fs::read_to_string(format!("glsl/{exercise}.glsl")).expect("the course is here");
    let file = files.add(File::new(exercise, text));
    lower(&check(&files, file, &Options::default()).expect("the course is valid"))
}

fn scene(exercise: &str) -> Scene {
    let mut files = Files::default();
    let text = fs::read_to_string(format!("glsl/{exercise}.toml")).expect("the course is here");
    let file = files.add(File::new(exercise, text));
    scene::parse(&files, file).expect("the course is valid")
}

/// From the lowered text to the SPIR-V that runs.
#[divan::bench(args = EXERCISES)]
fn translate(bencher: Bencher, exercise: &str) {
    let lowered = lowered(exercise);
    bencher.bench(|| {
        let module = ValidModule::parse(&lowered).expect("the course is valid");
        spirv::strict(&spirv::words(&module).expect("naga writes the course"))
    });
}

/// Paint and read back 640×360, compiled before.
#[divan::bench(args = EXERCISES, sample_count = 20)]
fn lavapipe(bencher: Bencher, exercise: &str) {
    let lowered = lowered(exercise);
    let mut renderer = match gpu::LocalRenderer::new(
        &lowered,
        &Frame::default(),
        FloatMode::Strict,
        &AdapterSelector::Lavapipe,
    ) {
        Ok(renderer) => renderer,
        Err(failure) => {
            eprintln!("skipped: {failure}");
            return;
        }
    };
    bencher.bench_local(|| renderer.render().expect("it painted before"));
}

/// The whole way through the worker process: translate, compile (from Mesa's cache), paint, watch loops, send
/// back.
#[divan::bench(args = EXERCISES, sample_count = 20)]
fn through_the_worker(bencher: Bencher, exercise: &str) {
    let lowered = lowered(exercise);
    let program = PathBuf::from(env!("CARGO_BIN_EXE_toyproof"));
    let mut worker = Worker::new(
        program,
        vec!["worker".to_owned()],
        AdapterSelector::Lavapipe,
        Duration::from_secs(60),
    );
    if let Err(failure) = worker.draw(lowered.clone(), Frame::default(), FloatMode::Strict) {
        eprintln!("skipped: {failure}");
        return;
    }
    bencher.bench_local(|| worker.draw(lowered.clone(), Frame::default(), FloatMode::Strict));
}

/// 640×360 by the reference tracer, on all cores.
#[divan::bench(args = EXERCISES, types = [f32, f64])]
fn trace<T: Backend>(bencher: Bencher, exercise: &str) {
    let tracer = Tracer::<T>::new(&scene(exercise));
    bencher.bench(|| tracer.render(|| ()));
}
