//! How long a frame takes: translate, paint on lavapipe, trace in f32 and f64. `cargo bench`

#![expect(clippy::print_stderr, reason = "a benchmark's own words")]

use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use divan::Bencher;
use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{Options, check};
use toyproof::gpu;
use toyproof::gpu::{On, Worker};
use toyproof::image::Frame;
use toyproof::scene::{self, Scene};
use toyproof::tracer::{Real, Tracer};
use toyproof::translate::backend::spirv;
use toyproof::translate::naga_ir::ValidModule;
use toyproof::translate::{FloatMode, Lowered, lower};

const RUNGS: [&str; 3] = ["02-sphere", "04-many-objects", "05-complex-scene"];

fn main() {
    divan::main();
}

fn lowered(rung: &str) -> Lowered {
    let mut files = Files::default();
    let text = fs::read_to_string(format!("glsl/{rung}.glsl")).expect("the course is here");
    let file = files.add(File::new(rung, text));
    lower(&check(&files, file, &Options::default()).expect("the course is valid"))
}

fn scene(rung: &str) -> Scene {
    let mut files = Files::default();
    let text = fs::read_to_string(format!("glsl/{rung}.toml")).expect("the course is here");
    let file = files.add(File::new(rung, text));
    scene::parse(&files, file).expect("the course is valid")
}

/// From the lowered text to the SPIR-V that runs.
#[divan::bench(args = RUNGS)]
fn translate(bencher: Bencher, rung: &str) {
    let lowered = lowered(rung);
    bencher.bench(|| {
        let module = ValidModule::parse(&lowered).expect("the course is valid");
        spirv::strict(&spirv::words(&module).expect("naga writes the course"))
    });
}

/// Paint and read back 640×360, compiled before.
#[divan::bench(args = RUNGS, sample_count = 20)]
fn lavapipe(bencher: Bencher, rung: &str) {
    let lowered = lowered(rung);
    let mut painter = match gpu::Painter::new(&lowered, &Frame::default(), FloatMode::Strict, &On::Lavapipe) {
        Ok(painter) => painter,
        Err(failure) => {
            eprintln!("skipped: {failure}");
            return;
        }
    };
    bencher.bench_local(|| painter.paint().expect("it painted before"));
}

/// The whole way through the worker process: translate, compile (from Mesa's cache), paint, watch loops, send back.
#[divan::bench(args = RUNGS, sample_count = 20)]
fn through_the_worker(bencher: Bencher, rung: &str) {
    let lowered = lowered(rung);
    let program = PathBuf::from(env!("CARGO_BIN_EXE_toyproof"));
    let mut worker = Worker::new(
        program,
        vec!["worker".to_owned()],
        On::Lavapipe,
        Duration::from_secs(60),
    );
    if let Err(failure) = worker.draw(lowered.clone(), Frame::default(), FloatMode::Strict) {
        eprintln!("skipped: {failure}");
        return;
    }
    bencher.bench_local(|| worker.draw(lowered.clone(), Frame::default(), FloatMode::Strict));
}

/// 640×360 by the reference tracer, on all cores.
#[divan::bench(args = RUNGS, types = [f32, f64])]
fn trace<T: Real>(bencher: Bencher, rung: &str) {
    let tracer = Tracer::<T>::new(&scene(rung));
    bencher.bench(|| tracer.picture(|| ()));
}
