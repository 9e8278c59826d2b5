//! The evaluator beside lavapipe's strict frame, in turns, so that other work on the machine affects both; in processor time
//! of all threads. `cargo bench --bench evaluator`, or `cargo bench --bench evaluator -- 02 14` for the exercises whose names
//! contain one of these.

#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a benchmark prints its figures"
)]

use std::{env, fs};

use rustix::time::{ClockId, clock_gettime};
use toyproof::diagnostic::{File, Files};
use toyproof::eval::{Engine, Number, Program, RandomRounding, Seed, Settings, UndefinedPolicy};
use toyproof::glsl::{Checked, Options, check};
use toyproof::gpu::{AdapterSelector, LocalRenderer};
use toyproof::image::Frame;
use toyproof::translate::{FloatMode, lower_strict};

const EXERCISES: [&str; 15] = [
    "01-sampling",
    "02-sphere",
    "03-shading",
    "04-many-objects",
    "05-complex-scene",
    "06-reflections",
    "07-diffuse",
    "08-disney",
    "09-soft-shadows",
    "10-quadrics",
    "11-animation",
    "12-whitted",
    "13-importance-sampling",
    "14-accelerator",
    "15-parallel-rays",
];
const ROUNDS: usize = 9;

fn checked(exercise: &str) -> Checked {
    let mut files = Files::default();
    let text = fs::read_to_string(format!("glsl/{exercise}.glsl")).expect("the course is here");
    let file = files.add(File::new(exercise, text));
    check(&files, file, &Options::default()).expect("the course is valid")
}

/// Milliseconds that this process ran.
fn clock() -> f64 {
    let now = clock_gettime(ClockId::ProcessCPUTime);
    now.tv_sec as f64 * 1e3 + now.tv_nsec as f64 / 1e6
}

/// Milliseconds.
fn time(work: impl FnOnce()) -> f64 {
    let start = clock();
    work();
    clock() - start
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn render<N: Number>(
    program: &Program,
    undefined: UndefinedPolicy,
    noise: N::Noise,
    engine: Engine,
    size: [u32; 2],
) {
    let settings = Settings::<N> {
        undefined,
        noise,
        engine,
        ..Settings::default()
    };
    let frame = Frame {
        size,
        ..Frame::default()
    };
    let rows = frame.rows();
    program
        .render_rows(&frame, rows, &settings)
        .expect("the course is rendered");
}

/// What is measured, in the order of the columns.
const COLUMNS: [&str; 12] = [
    "compile",
    "code",
    "lavapipe",
    "f32",
    "AVX2",
    "handlers",
    "observing",
    "f64",
    "AVX2",
    "handlers",
    "observing",
    "perturbed",
];

fn main() {
    println!(
        "milliseconds of processor time at 640×360, medians of {ROUNDS} rounds in turns. code: machine code for f32 \
         and an image of one pixel; AVX2 (machine code for it), handlers (instead of machine code), observing and \
         perturbed: of the number type before them"
    );
    let heads = COLUMNS.map(|column| format!("{column:>10}"));
    println!("{:24}{}  f32/lavapipe  f64/lavapipe", "exercise", heads.concat());
    // Cargo passes `--bench`.
    let names: Vec<String> = env::args()
        .skip(1)
        .filter(|argument| !argument.starts_with("--"))
        .collect();
    let is_chosen =
        |exercise: &str| names.is_empty() || names.iter().any(|name| exercise.contains(name.as_str()));
    for exercise in EXERCISES.into_iter().filter(|exercise| is_chosen(exercise)) {
        let checked = checked(exercise);
        let lowered = lower_strict(&checked);
        let mut renderer = match LocalRenderer::new(
            &lowered,
            &Frame::default(),
            FloatMode::Strict,
            &AdapterSelector::Lavapipe,
        ) {
            Ok(renderer) => Some(renderer),
            Err(failure) => {
                eprintln!("without lavapipe: {failure}");
                None
            }
        };
        let new = || Program::new(&checked).expect("the course is small");
        let program = new();
        let size = Frame::default().size;
        let mut times: [Vec<f64>; COLUMNS.len()] = Default::default();
        for round in 0..=ROUNDS {
            use Engine::{Avx2, Fastest, Handlers, Native};
            use UndefinedPolicy::{Observed, Plain};
            let compile = time(|| drop(new()));
            let fresh = new();
            let code = time(|| render::<f32>(&fresh, Plain, (), Native, [1, 1]));
            let gpu = time(|| {
                if let Some(renderer) = &mut renderer {
                    renderer.render().expect("it was rendered before");
                }
            });
            let taken = [
                compile,
                code,
                gpu,
                time(|| render::<f32>(&program, Plain, (), Fastest, size)),
                time(|| render::<f32>(&program, Plain, (), Avx2, size)),
                time(|| render::<f32>(&program, Plain, (), Handlers, size)),
                time(|| render::<f32>(&program, Observed, (), Fastest, size)),
                time(|| render::<f64>(&program, Plain, (), Fastest, size)),
                time(|| render::<f64>(&program, Plain, (), Avx2, size)),
                time(|| render::<f64>(&program, Plain, (), Handlers, size)),
                time(|| render::<f64>(&program, Observed, (), Fastest, size)),
                time(|| render::<RandomRounding>(&program, Plain, Seed::double(1), Fastest, size)),
            ];
            // The first round warms up.
            if round > 0 {
                for (times, taken) in times.iter_mut().zip(taken) {
                    times.push(taken);
                }
            }
        }
        let medians = times.map(median);
        let [_, _, gpu, single, _, _, _, double, ..] = medians;
        let cells = medians.map(|time| format!("{time:10.2}"));
        println!(
            "{exercise:24}{}{:14.2}{:14.2}",
            cells.concat(),
            single / gpu,
            double / gpu
        );
    }
}
