//! The evaluator in f32 and the strict GPU run produce the same bits.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use toyproof::diagnostic::{File, Files};
use toyproof::eval::{Program, Rendered, Settings};
use toyproof::glsl::{Checked, Options, check};
use toyproof::gpu::{AdapterSelector, Worker};
use toyproof::image::{Frame, Image};
use toyproof::translate::{FloatMode, lower_strict};

use crate::support::{self, EXERCISES, checked};

/// The number of pixels that differ between two images, and the first with both colors.
fn differences(a: &Image, b: &Image, ignore: impl Fn(u32, u32) -> bool) -> (usize, String) {
    let [width, height] = a.size();
    // Compared like in the toolchain check.
    let same = |a: f32, b: f32| a == b || (a.is_nan() && b.is_nan());
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let differing: Vec<_> = pixels
        .filter(|&(x, y)| !ignore(x, y))
        .filter(|&(x, y)| (0..3).any(|at| !same(a.get(x, y)[at], b.get(x, y)[at])))
        .collect();
    let first = differing.first().map_or(String::new(), |&(x, y)| {
        format!("first at ({x}, {y}): {:?} and {:?}", a.get(x, y), b.get(x, y))
    });
    (differing.len(), first)
}

fn both(worker: &mut Worker, checked: &Checked, frame: &Frame) -> (Rendered<f32>, Image) {
    let rendered = Program::new(checked)
        .unwrap()
        .render::<f32>(frame, &Settings::default())
        .unwrap();
    let drawn = worker
        .draw(lower_strict(checked), frame.clone(), FloatMode::Strict)
        .unwrap();
    (rendered, drawn.image())
}

#[test]
fn the_course_has_the_same_bits_on_the_cpu() {
    let Some(mut worker) = support::worker() else {
        return;
    };
    let frame = Frame {
        size: [131, 75],
        frame: 7,
        time: 0.7,
        ..Frame::default()
    };
    for exercise in EXERCISES {
        let (rendered, drawn) = both(&mut worker, &checked(exercise.shader), &frame);
        let (count, first) = differences(&rendered.framebuffer.image(), &drawn, |_, _| false);
        assert_eq!(count, 0, "{}: {first}", exercise.name);
        assert_eq!(
            rendered.framebuffer.undefined(),
            0,
            "{}: {:?}",
            exercise.name,
            rendered.observations
        );
    }
}

/// Constructs in which drivers have differed in spite of strict mode.
static DIFFERED: &[&str] = &[
    // Derivatives where a quad lies half in each of two triangles, which is how lavapipe fills a frame: the
    // other half must have the frame's uniform block as well.
    "c = vec4(dFdx(iResolution.x), dFdy(iResolution.y), fwidth(sin(iTime) * p.x), 1.0);",
    // A derivative of a quad's first row and column, or of the pixel's own.
    "c = vec4(dFdx(p.x * p.y), dFdy(p.x * p.y), fwidth(p.x * p.y * p.y), 1.0);",
    // Values loaded in a loop that some pixels have already left.
    "float k = 0.; for (int i = 0; i < 9; i++) { k += iResolution.x; if (k > p.x * 9.) break; } c = vec4(k, k / iResolution.x, iTime, 1.0);",
    // Zero times NaN.
    "float k = sqrt(p.x - 20.); c = vec4(0. * k, vec2(.5, 0) * k, 1.); c.w = dot(vec2(0, 1), vec2(k, 1));",
    "float k = log(20. - p.x); c.xyz = mat3(1, 0, 0, 0, p, k, 0, p.x) * vec3(k, p); c.w = 0. / k;",
    "float k = sqrt(p.x - 20.); c = vec4(mix(vec3(0, 0, 1), vec3(1, .5, 0), k), p.x > 9. ? 0. : 1.);",
    // A loop that depends on uniforms only, through more paths than a compiler can visit.
    "float k = sin(8. * cos(iTime)), s = 0.; for (int i = 0; i < 8; i++) { if (k < float(i) * .1) break; s += .1; } c = vec4(s, k, p);",
    // Exact functions of values that constant propagation makes constant, in one branch of two.
    "vec3 g = vec3(14, 63, 240) / 255.0; float m = max(g.x, g.z); c = vec4(m == 0.0 ? 0.25 : 0.5 / m);",
    "vec3 g = vec3(14, 63, 240) / 255.0; float m = min(g.x, g.z); c = vec4(m == 0.0 ? 0.25 : 0.5 / m);",
    "vec3 g = vec3(14, 63, 240) / 255.0; float m = sqrt(g.x); c = vec4(m == 0.0 ? 0.25 : 0.5 / m);",
];

#[test]
fn drivers_agree_where_they_once_differed() {
    let frame = Frame {
        size: [64, 36],
        ..Frame::default()
    };
    for mut worker in [support::worker(), support::swiftshader()].into_iter().flatten() {
        for body in DIFFERED {
            let shader = format!("void mainImage(out vec4 c, in vec2 p) {{ {body} }}");
            let (rendered, drawn) = both(&mut worker, &checked(&shader), &frame);
            let (count, first) = differences(&rendered.framebuffer.image(), &drawn, |_, _| false);
            assert_eq!(count, 0, "{body}: {first}");
        }
    }
}

/// `TOYPROOF_CORPUS=DIR cargo test --release --test suite -- --ignored corpus --nocapture`: every shader
/// below a folder that reads no channel, at two times; `TOYPROOF_CORPUS_LIMIT` limits their number.
#[test]
#[ignore = "needs a folder of shaders"]
fn the_corpus_has_the_same_bits_on_the_cpu() {
    let folder = std::env::var_os("TOYPROOF_CORPUS").expect("TOYPROOF_CORPUS names a folder");
    let limit = std::env::var("TOYPROOF_CORPUS_LIMIT").map_or(usize::MAX, |limit| limit.parse().unwrap());
    let program = PathBuf::from(env!("CARGO_BIN_EXE_toyproof"));
    let patience = Duration::from_secs(60);
    let mut worker = Worker::new(program, vec!["worker".into()], AdapterSelector::Auto, patience);
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    // In an order independent of their names.
    paths.sort_by_key(|path| {
        let name = path.as_os_str().as_encoded_bytes();
        name.iter().fold(0u32, |hash, &byte| {
            (hash ^ u32::from(byte)).wrapping_mul(16_777_619)
        })
    });
    let (mut shaders, mut same, mut pixels, mut undefined, mut differing) = (0, 0, 0, 0, 0);
    for path in paths {
        if shaders == limit {
            break;
        }
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        let mut files = Files::default();
        let file = files.add(File::new(&name, text.as_str()));
        let Ok(checked) = check(&files, file, &Options::default()) else {
            continue;
        };
        if text.contains("iChannel") {
            continue;
        }
        let program = match Program::new(&checked) {
            Ok(program) => program,
            Err(refusal) => {
                eprintln!("{name}: {refusal}");
                continue;
            }
        };
        let mut bad = String::new();
        let mut done = 0;
        for time in [0.7, 10.3] {
            let frame = Frame {
                size: [64, 36],
                time,
                frame: (time * 60.0) as i32,
                ..Frame::default()
            };
            let settings = Settings {
                deadline: Some(Instant::now() + patience),
                ..Settings::default()
            };
            let rendered = match program.render::<f32>(&frame, &settings) {
                Ok(rendered) => rendered,
                Err(failure) => {
                    eprintln!("{name}: cpu: {failure}");
                    continue;
                }
            };
            let drawn = match worker.draw(lower_strict(&checked), frame.clone(), FloatMode::Strict) {
                Ok(drawn) => drawn.image(),
                Err(failure) => {
                    eprintln!("{name}: gpu: {failure}");
                    continue;
                }
            };
            done += 1;
            let painting = &rendered.framebuffer;
            pixels += 64 * 36;
            undefined += painting.undefined();
            let (count, first) = differences(&painting.image(), &drawn, |x, y| painting.is_undefined(x, y));
            if count > 0 {
                differing += count;
                bad = format!("{bad} {count} differ at {time} s, {first}");
            }
        }
        if done == 2 {
            shaders += 1;
            same += usize::from(bad.is_empty());
            if !bad.is_empty() {
                eprintln!("{name}:{bad}");
            }
        }
    }
    eprintln!(
        "{shaders} shaders, {same} the same in every defined bit; of {pixels} pixels {undefined} undefined, {differing} differ"
    );
}
