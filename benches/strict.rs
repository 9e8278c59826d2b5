//! What strictness costs on lavapipe: a shader's frame with everything spelled against the same as the driver
//! likes it, in turn, and the time to the first frame. `MESA_SHADER_CACHE_DISABLE=true cargo bench --bench
//! strict`

#![expect(clippy::print_stdout, reason = "a benchmark's own words")]

use std::fs;
use std::time::{Duration, Instant};

use toyproof::diagnostic::{File, Files};
use toyproof::glsl::{Options, check};
use toyproof::gpu::{AdapterSelector, LocalRenderer};
use toyproof::image::Frame;
use toyproof::translate::{FloatMode, Lowered, lower, lower_strict};

/// Little else than transcendental functions: a dozen calls, 20 times.
const HEAVY: &str = "void mainImage(out vec4 c, in vec2 p) {
    vec3 v = vec3(p / iResolution.xy, 0.5);
    for (int i = 0; i < 20; i++) {
        v = sin(v.yzx * 3.0 + 1.0) + exp(-abs(v)) * cos(v.zxy + float(i));
        v.x += pow(abs(v.y) + 0.1, 1.7) + atan(v.z, v.x) + log(1.0 + abs(v.x));
    }
    c = vec4(v, 1.0);
}";

const ROUNDS: usize = 15;

fn main() {
    let exercises = ["05-complex-scene", "06-reflections"].map(|exercise| {
        let text = fs::read_to_string(format!("glsl/{exercise}.glsl")).expect("the course is here");
        (exercise, text)
    });
    println!("shader | first frame strict, fast (ms) | frame strict, fast (ms) | ratio");
    for (name, text) in exercises.into_iter().chain([("sin, exp, pow", HEAVY.to_owned())]) {
        measure(name, &text);
    }
}

fn measure(name: &str, text: &str) {
    let mut files = Files::default();
    let file = files.add(File::new(name, text));
    let checked = check(&files, file, &Options::default()).expect("these shaders are valid");
    let modes = [
        (lower_strict(&checked), FloatMode::Strict),
        (lower(&checked), FloatMode::Fast),
    ];
    let first = |(lowered, mode): &(Lowered, FloatMode)| {
        let start = Instant::now();
        let mut renderer = LocalRenderer::new(lowered, &Frame::default(), *mode, &AdapterSelector::Lavapipe)
            .expect("lavapipe is here");
        renderer.render().expect("it paints");
        (renderer, start.elapsed())
    };
    // The driver itself is loaded, and warm.
    drop(first(&modes[0]));
    let [(mut strict, strict_first), (mut fast, fast_first)] = [first(&modes[0]), first(&modes[1])];
    let (mut strict_times, mut fast_times) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        for (renderer, times) in [(&mut strict, &mut strict_times), (&mut fast, &mut fast_times)] {
            let start = Instant::now();
            renderer.render().expect("it paints");
            times.push(start.elapsed());
        }
    }
    let [strict, fast] = [strict_times, fast_times].map(median);
    println!(
        "{name} | {:.0}, {:.0} | {:.1}, {:.1} | {:.2}",
        ms(strict_first),
        ms(fast_first),
        ms(strict),
        ms(fast),
        ms(strict) / ms(fast)
    );
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort();
    times[times.len() / 2]
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}
