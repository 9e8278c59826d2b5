//! Generated programs: our SPIR-V on a driver must render what the evaluator computes, to the bit, and so must
//! glslang's where arithmetic is exact.
//!
//! `TOYPROOF_PROGRAMS` sets their number (24), `TOYPROOF_SEED` the seed (0), `TOYPROOF_FIRST` the first
//! program (0), `TOYPROOF_EFFECTS` where operands may have side effects (`ordered` or `anywhere`; by default
//! programs alternate), `TOYPROOF_SHRINK` how often a failing program is reduced (300), `TOYPROOF_WRITTEN` a folder
//! to write the programs to. A program that crashes the driver, as some do, is reported and counted; it is compared
//! among the renderers that succeed.

use std::cell::RefCell;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, TestError, TestRunner};
use toyproof::diagnostic::{File, Files};
use toyproof::eval::{Program, Settings};
use toyproof::glsl::{Checked, Options, check};
use toyproof::gpu::{DrawOutput, Failure, ShaderArtifact, Worker};
use toyproof::image::{Frame, Image};
use toyproof::translate::naga_ir::Shape;
use toyproof::translate::{FloatMode, lower, lower_strict};

use crate::glslang;
use crate::requirements::{require_program, require_swiftshader, require_worker};
use crate::support::generate::{self, Arithmetic, Effects};
use crate::support::setting;

fn frame() -> Frame {
    Frame {
        size: [8, 8],
        time: 2.5,
        frame: 7,
        ..Frame::default()
    }
}

/// A failure of a program or of a renderer.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Wrong {
    /// The kind of the failure, which shrinking must preserve.
    kind: &'static str,
    message: String,
}

fn wrong(kind: &'static str) -> impl Fn(String) -> Wrong {
    move |message| Wrong { kind, message }
}

/// The renderers that are compared.
struct Renderers<'a> {
    worker: Worker,
    /// Creates the worker.
    start: fn() -> Option<Worker>,
    /// The working folder of glslang, if it takes part.
    glslang: Option<&'a Path>,
    /// Whether ours runs in strict mode.
    strict: bool,
    arithmetic: Arithmetic,
    /// The pixels that were compared.
    pixels: u64,
}

impl Renderers<'_> {
    /// Compares all images of a program; reports on whose SPIR-V the driver crashed.
    fn compare(&mut self, program: &str) -> Result<Option<String>, Wrong> {
        let checked = checked(program).map_err(wrong("the front end refuses it"))?;
        let (evaluated, defined) = evaluated(&checked).map_err(wrong("the evaluator"))?;
        if self.arithmetic == Arithmetic::Exact && defined.len() < 64 {
            return Err(wrong("the evaluator")(format!(
                "{} pixels are defined",
                defined.len()
            )));
        }
        self.pixels += defined.len() as u64;
        let mut images = vec![("the evaluator's", evaluated)];
        let mut crashes = String::new();
        let lowered = if self.strict {
            lower_strict(&checked)
        } else {
            lower(&checked)
        };
        let ours = self.again_after_a_crash(|worker| {
            let drawn = worker.draw_unwatched(lowered.clone(), frame(), FloatMode::Strict);
            drawn.map(DrawOutput::image)
        });
        match ours {
            Ok(image) => images.push(("ours", image)),
            Err(failure @ (Failure::Refused(_) | Failure::Naga(_))) => {
                return Err(wrong("naga refuses it")(format!("{failure:?}")));
            }
            Err(failure) => crashes = format!("ours: {failure}; "),
        }
        if let Some(folder) = self.glslang {
            let words = glslang::words(program, folder).map_err(wrong("glslang refuses it"))?;
            let artifact = ShaderArtifact::Words {
                words,
                channels: [Shape::D2; 4],
                upside_down: false,
            };
            let theirs = self.again_after_a_crash(|worker| {
                let (images, _) = worker.render(artifact.clone(), Default::default(), vec![frame()])?;
                Ok(images.into_iter().next().expect("an image for each frame"))
            });
            match theirs {
                Ok(image) => images.push(("glslang's", image)),
                Err(failure) => crashes = format!("{crashes}glslang's: {failure}"),
            }
        }
        match difference(&images, &defined) {
            Some(message) => Err(wrong("pixels differ")(message)),
            None => Ok((!crashes.is_empty()).then_some(crashes)),
        }
    }

    /// Renders with a worker. If the driver fails, tries again in a new process without history.
    fn again_after_a_crash(
        &mut self,
        mut render: impl FnMut(&mut Worker) -> Result<Image, Failure>,
    ) -> Result<Image, Failure> {
        match render(&mut self.worker) {
            Err(failure) if !matches!(failure, Failure::Refused(_) | Failure::Naga(_)) => {
                eprintln!("once more: {failure}");
                self.worker = (self.start)().expect("there was one before").with_plain_code();
                render(&mut self.worker)
            }
            result => result,
        }
    }
}

fn checked(program: &str) -> Result<Checked, String> {
    let mut files = Files::default();
    let file = files.add(File::new("program", program));
    check(&files, file, &Options::default()).map_err(|errors| {
        let lines: Vec<_> = errors
            .iter()
            .map(|error| toyproof::diagnostic::short(error, &files))
            .collect();
        lines.join("\n")
    })
}

/// The evaluator's image, and the pixels that do not depend on undefined behavior.
fn evaluated(checked: &Checked) -> Result<(Image, Vec<usize>), String> {
    let program = Program::new(checked).map_err(|refusal| refusal.to_string())?;
    let rendered = program
        .render::<f32>(&frame(), &Settings::default())
        .map_err(|failure| failure.to_string())?;
    let image = rendered.framebuffer;
    let is_defined = |&at: &usize| !image.is_undefined(at as u32 % 8, at as u32 / 8);
    let defined = (0..64).filter(is_defined).collect();
    Ok((image.image(), defined))
}

/// The first difference between images among these pixels, and the number of differing pixels.
fn difference(pictures: &[(&str, Image)], pixels: &[usize]) -> Option<String> {
    let differs = |&index: &usize| {
        let mut colors = pictures
            .iter()
            .map(|(_, rendered_image)| rendered_image.pixels()[index]);
        let first = colors.next();
        colors.any(|color| Some(color) != first)
    };
    let differing: Vec<usize> = pixels.iter().copied().filter(differs).collect();
    let &first = differing.first()?;
    let mut message = format!(
        "{} of {}, the first at ({}, {}):",
        differing.len(),
        pixels.len(),
        first % 8,
        first / 8
    );
    for (whose, rendered_image) in pictures {
        let _ = write!(message, " {whose} {:?}", rendered_image.pixels()[first]);
    }
    Some(message)
}

#[test]
fn glslang_and_the_evaluator_agree_with_ours() {
    if !require_program("glslangValidator") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    compare_all(require_worker, Some(folder.path()), Arithmetic::Exact, 2000);
}

#[test]
fn the_evaluator_agrees_with_ours() {
    compare_all(require_worker, None, Arithmetic::Exact, 900);
}

#[test]
fn any_arithmetic_is_the_evaluators_on_the_driver() {
    compare_all(require_worker, None, Arithmetic::AnyOnDrivers, 900);
}

#[test]
fn any_arithmetic_is_the_evaluators_on_swiftshader() {
    compare_all(require_swiftshader, None, Arithmetic::AnyOnDrivers, 900);
}

/// Where operands of that program may have side effects.
fn effects(number: u32) -> Effects {
    match std::env::var("TOYPROOF_EFFECTS").as_deref() {
        Ok("ordered") => Effects::Ordered,
        Ok("anywhere") => Effects::Anywhere,
        _ => generate::effects(number),
    }
}

/// Compares the requested number of programs, of at most `longest` decisions.
fn compare_all(
    start: fn() -> Option<Worker>,
    glslang: Option<&Path>,
    arithmetic: Arithmetic,
    longest: usize,
) {
    let Some(worker) = start() else {
        return;
    };
    let count: u32 = setting("TOYPROOF_PROGRAMS", 24);
    let seed: u64 = setting("TOYPROOF_SEED", 0);
    let first: u32 = setting("TOYPROOF_FIRST", 0);
    let written = std::env::var_os("TOYPROOF_WRITTEN");
    let config = Config {
        failure_persistence: None,
        max_shrink_iters: setting("TOYPROOF_SHRINK", 300),
        ..Config::default()
    };
    let mut runner = TestRunner::new_with_rng(config, generate::rng(seed));
    let renderers = RefCell::new(Renderers {
        worker: worker.with_plain_code(),
        start,
        glslang,
        strict: false,
        arithmetic,
        pixels: 0,
    });
    let begin = Instant::now();
    let (mut failures, mut crashes) = (Vec::new(), 0);
    for number in 0..count {
        let effects = effects(number);
        let tree = generate::programs(effects, arithmetic, longest)
            .new_tree(&mut runner)
            .unwrap();
        if number < first {
            continue;
        }
        if let Some(folder) = &written {
            let path = Path::new(folder).join(format!("{number:05}.glsl"));
            std::fs::write(path, tree.current()).unwrap();
        }
        // glslang leaves matrix products to the driver, whose sums are exact here.
        renderers.borrow_mut().strict = arithmetic != Arithmetic::Exact || number % 4 >= 2;
        let (found, crashed) = (RefCell::new(None), RefCell::new(None));
        let result = runner.run_one(tree, |program| {
            let wrong = match renderers.borrow_mut().compare(&program) {
                Ok(message) => {
                    crashed.replace(message.map(|message| format!("{message}\n{program}")));
                    return Ok(());
                }
                Err(wrong) => wrong,
            };
            // Shrinking must not change the kind of the failure.
            if *found.borrow_mut().get_or_insert(wrong.kind) != wrong.kind {
                return Ok(());
            }
            Err(TestCaseError::fail(format!("{}: {}", wrong.kind, wrong.message)))
        });
        if let Err(TestError::Fail(why, program)) = result {
            eprintln!("program {number} of seed {seed} ({effects:?}): {why}\n{program}");
            failures.push(format!("program {number}: {why}"));
        } else if let Some(message) = crashed.take() {
            eprintln!("program {number} of seed {seed}: the driver crashed on {message}");
            crashes += 1;
        }
    }
    let each = begin.elapsed().as_secs_f64() * 1e3 / f64::from(count.saturating_sub(first).max(1));
    let summary = format!(
        "seed {seed}: {count} programs with {} defined pixels, {} wrong, the driver crashed on {crashes}",
        renderers.borrow().pixels,
        failures.len()
    );
    eprintln!("{summary}, {each:.0} ms each");
    assert!(failures.is_empty(), "{summary}\n{}", failures.join("\n"));
    assert!(50 * crashes <= count, "{summary}");
}

/// Programs whose pixels show the order in which operands are evaluated, where the specification leaves it
/// open or is ambiguous.
const ORDERS: &[&str] = &[
    // The indices of a target, its value, and the added value.
    "int q[2]; q[0] = at.x; q[1] = at.y; q[q[0] & 1] += q[0]++; r = ivec2(q[0], q[1]);",
    "int q[2]; q[0] = 5; q[1] = 7; int i = at.x & 1; q[i] -= (i = at.y & 1) + 4; r = ivec2(q[0], q[1]);",
    "int q[2]; q[0] = 5; q[1] = 7; g = at.x & 1; q[next() & 1] *= next() + (q[1]++); r = ivec2(q[0], q[1]) + g;",
    "int q[2]; q[0] = 5; q[1] = 7; int i = at.x & 1; q[i] = (i = 1 - i) + 4; r = ivec2(q[0], q[1]);",
    "ivec2 v = at; v[v.x & 1] += (v = v.yx + 2, v.x); r = v;",
    "int q[2]; q[0] = 5; q[1] = 7; g = at.x & 1; q[g] %= next() + 2; r = ivec2(q[0], q[1]);",
    "S s; s.a[0] = 1; s.a[1] = 2; int i = at.x & 1; s.a[i] <<= (i = 1 - i) + s.a[0]; r = ivec2(s.a[0], s.a[1]);",
    "T t[2]; int i = at.x & 1; t[i].m = mat2(float((i = 1 - i) + 2)); t[i].m *= float(i = at.y & 1) + 3.0; \
     r = ivec2(t[0].m * vec2(1) + t[1].m * vec2(10));",
    // Arguments that are copied in and out, next to others that modify them.
    "ivec2 v = at; bump(v[0], (v[0] = 3)); r = v;",
    "ivec2 v = at; int i = at.x & 1; bump(v[i], (v = v + 4, i = 1 - i, 2)); r = v;",
    "int x = at.x; bump(x, (x = 3)); r = ivec2(x, 0);",
    "S s; s.a[0] = at.x; s.k = 4; bump(s.k, (s.k = at.y)); bump(s.a[at.y & 1], (s.a[0] += 7)); r = ivec2(s.a[0] + s.a[1] * 16, s.k);",
    "ivec2 v = at; both(v.x, v); r = v;",
    "ivec2 v = at; whole(v, v.y); r = v;",
    "int q[2]; q[0] = at.x; q[1] = at.y; int i = 0; swap(q[i++], q[i & 1]); r = ivec2(q[0], q[1]) + 16 * i;",
    "g = at.x; alias(g); r = ivec2(g, 1);",
    "ivec2 v = at; r = ivec2(add(v.x, v.x++), add(v.y, (v.y += 2, 1)));",
    "int i = at.x; r = ivec2(add(i, i++), add(i++, i)); r += ivec2(addc(i, i++), add((i), (i = 7, 2)));",
    "ivec2 v = at; int q[2]; q[0] = 3; q[1] = 5; int i = 0; r = ivec2(add(q[i++], q[i] += 2), add(q[i & 1], i = 0));",
    "g = at.x; ivec2 v = at; r = ivec2(add(g, next()), add(v[g & 1], next() + v.x++)); r.x += add(3, v.x) % (v.x = 7);",
    // The indexed value, and the index.
    "ivec2 v = at; r = ivec2(v[(v = v + 3, at.x & 1)], (v.yx)[v.x++ & 1]);",
    "int i = at.x & 1; r = ivec2(int[2](i, 7)[i = 1 - i], (at.y > 2 ? at : at.yx)[i = 1 - i] + i);",
    "ivec2 v[2]; v[0] = at; v[1] = at + 4; int i = 0; r = v[i++].yx + v[i] * 16; r.x += v[i = 1][i = 0];",
    // Operators, constructors, conditionals.
    "int i = at.x; r = ivec2(i++ * 2 + i, (i = 3) + i); r += ivec2(i, i++);",
    "int i = at.x; bool b = i++ > 2 && i++ > 4 || i++ > 3; r = ivec2(i, int(b)); r += b ? i++ : --i;",
    "g = at.x; r = ivec2(next(), next() - 2 * next()); r.x += g > 4 ? next() : -next();",
];

const ORDERS_PRELUDE: &str = "int g; struct S { int a[2]; int k; }; struct T { mat2 m; };
int next() { g += 1; return g; }
int add(int a, int b) { return a * 16 + b; }
int addc(const in int a, const in int b) { return a * 16 + b; }
void bump(inout int a, int b) { a += b; }
void both(inout int a, inout ivec2 b) { a += 1; b *= 2; }
void whole(inout ivec2 a, inout int b) { a += 1; b *= 2; }
void swap(inout int a, inout int b) { int c = a; a = b; b = c; }
void alias(inout int a) { a += 1; g += 16; a += g; }
";

#[test]
fn operands_are_evaluated_in_the_order_of_glslang() {
    let Some(worker) = require_worker() else {
        return;
    };
    if !require_program("glslangValidator") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut renderers = Renderers {
        worker: worker.with_plain_code(),
        start: require_worker,
        glslang: Some(folder.path()),
        strict: true,
        arithmetic: Arithmetic::Exact,
        pixels: 0,
    };
    let mut failures = String::new();
    for body in ORDERS {
        let program = format!(
            "{ORDERS_PRELUDE}void mainImage(out vec4 c, in vec2 p) {{ ivec2 at = ivec2(p), r = ivec2(0); {body} c = vec4(r, g, 1); }}"
        );
        match renderers.compare(&program) {
            Ok(None) => {}
            Ok(Some(crash)) => {
                let _ = writeln!(failures, "{crash}\n{body}");
            }
            Err(wrong) => {
                let _ = writeln!(failures, "{}: {}\n{body}", wrong.kind, wrong.message);
            }
        }
    }
    assert!(failures.is_empty(), "{failures}");
}
