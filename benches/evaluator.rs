//! The evaluator beside lavapipe's strict frame, in turns so that both meet the same noise; in processor time
//! of all threads, which other work on the machine hardly moves. `cargo bench --bench evaluator`

#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a benchmark's own words"
)]

use std::fs;

use rustix::time::{ClockId, clock_gettime};
use toyproof::diagnostic::{File, Files};
use toyproof::eval::{Number, Program, RandomRounding, Seed, Settings, UndefinedPolicy};
use toyproof::glsl::{Checked, Options, check};
use toyproof::gpu::{AdapterSelector, LocalRenderer};
use toyproof::image::Frame;
use toyproof::translate::{FloatMode, lower_strict};

const EXERCISES: [&str; 4] = [
    "02-sphere",
    "04-many-objects",
    "05-complex-scene",
    "06-reflections",
];
const ROUNDS: usize = 15;

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

fn render<N: Number>(program: &Program, undefined: UndefinedPolicy, noise: N::Noise) {
    let settings = Settings::<N> {
        undefined,
        noise,
        ..Settings::default()
    };
    program
        .render(&Frame::default(), &settings)
        .expect("the course paints");
}

fn main() {
    println!("milliseconds of processor time at 640×360, medians of {ROUNDS} rounds in turns");
    println!(
        "exercise               compile  lavapipe  f32     f32 observing  f64     f64 observing  f64 perturbed"
    );
    for exercise in EXERCISES {
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
        let program = Program::new(&checked).expect("the course is small");
        let mut times: [Vec<f64>; 7] = Default::default();
        for round in 0..=ROUNDS {
            let compile = time(|| drop(Program::new(&checked)));
            let gpu = time(|| {
                if let Some(renderer) = &mut renderer {
                    renderer.render().expect("it painted before");
                }
            });
            let taken = [
                compile,
                gpu,
                time(|| render::<f32>(&program, UndefinedPolicy::Plain, ())),
                time(|| render::<f32>(&program, UndefinedPolicy::Observed, ())),
                time(|| render::<f64>(&program, UndefinedPolicy::Plain, ())),
                time(|| render::<f64>(&program, UndefinedPolicy::Observed, ())),
                time(|| render::<RandomRounding>(&program, UndefinedPolicy::Plain, Seed::double(1))),
            ];
            // The first round warms up.
            if round > 0 {
                for (times, taken) in times.iter_mut().zip(taken) {
                    times.push(taken);
                }
            }
        }
        let [
            compile,
            gpu,
            single,
            single_observing,
            double,
            double_observing,
            perturbed,
        ] = times.map(median);
        println!(
            "{exercise:18} {compile:<8.2} {gpu:<9.2} {single:<7.2} {single_observing:<14.2} {double:<7.2} \
             {double_observing:<14.2} {perturbed:.2}"
        );
    }
}
