//! Statements, conditionals, jumps and calls nested deeper than lavapipe's condition stack of 80: the GPU
//! must render what the evaluator computes, and fails without the pass that flattens them.

use std::time::Duration;

use toyproof::diagnostic::Code;
use toyproof::eval::{Program, Settings};
use toyproof::glsl::Checked;
use toyproof::gpu::{AdapterSelector, Failure, Worker};
use toyproof::image::{Frame, Image};
use toyproof::translate::FloatMode;
use toyproof::translate::lower::{Pass, Passes, lower_with};

use crate::requirements::require_worker;
use crate::support;

/// The number of pixels in a row, each of which reaches a different depth.
const WIDTH: u32 = 128;
/// More levels than the driver's stack has.
const DEPTH: usize = 100;

/// Wraps `DEPTH` levels around the innermost statement; `level` gives a level's text for its content and its
/// number, 0 for the outermost.
fn nest(level: impl Fn(String, usize) -> String) -> String {
    (0..DEPTH).rev().fold("g(x, 1.0);".to_owned(), level)
}

/// Concatenates `DEPTH` texts.
fn row(one: impl Fn(usize) -> String) -> String {
    (0..DEPTH).map(one).collect()
}

/// A name, the text before `mainImage`, and the body that computes `x` from `p`; pixels enter level `d` if
/// their `p.x` is greater.
type Nested = (&'static str, String, String);

fn plain(name: &'static str, body: String) -> Nested {
    (name, String::new(), body)
}

fn function(name: &'static str, body: &str) -> Nested {
    let function = format!("float f(vec2 p) {{ float x = 0.0; {body} return x; }}");
    (name, function, "x = f(p);".to_owned())
}

/// One of five functions, each with a fifth of the levels, which calls the next.
fn function_of_levels(at: usize) -> String {
    let inner = if at == 4 {
        String::new()
    } else {
        format!("x = k{}(p, x);", at + 1)
    };
    let fifth = DEPTH / 5;
    let levels = (fifth * at..fifth * (at + 1)).rev().fold(inner, |inside, d| {
        format!("if (p.x > {d}.0) {{ g(x, {d}.0); {inside} x += 0.5; }}")
    });
    format!("float k{at}(vec2 p, float x) {{ {levels} return x; }}\n")
}

/// Cases of nested levels.
fn nested() -> Vec<Nested> {
    vec![
        plain(
            "if",
            nest(|inside, d| format!("if (p.x > {d}.0) {{ g(x, {d}.0); {inside} x += 0.5; }}")),
        ),
        plain(
            "if else",
            nest(|inside, d| {
                format!("if (p.x > {d}.0) {{ g(x, {d}.0); {inside} }} else {{ x *= 0.75; g(x, 3.0); }}")
            }),
        ),
        plain(
            "else in else",
            nest(|inside, d| format!("if (p.x < {d}.0) {{ g(x, {d}.0); }} else {{ {inside} x += 0.25; }}")),
        ),
        plain(
            "loops in ifs",
            nest(|inside, d| match d % 25 {
                3 => format!(
                    "for (int i = 0; i < 2; i++) {{ if (p.x < {d}.0) continue; g(x, {d}.0); if (i == 1) {{ {inside} }} \
                     if (x > 15.0) break; x += 0.5; }}"
                ),
                4 => format!(
                    "int k{d} = 0; do {{ k{d}++; if (p.x > {d}.0) {{ {inside} }} x += 0.5; }} while (k{d} < 2 && x < 9.0);"
                ),
                _ => format!("if (p.x > {d}.0) {{ float y = x; g(y, {d}.0); x = y; {inside} x += 0.5; }}"),
            }),
        ),
        plain(
            "switch",
            nest(|inside, d| {
                format!(
                    "switch (int(clamp(p.x - {d}.0, 0.0, 3.9))) {{ case 0: x += 0.5; break; case 2: g(x, 2.0); \
                     case 3: default: g(x, {d}.0); {inside} if (x > 16.0) break; x += 0.25; }}"
                )
            }),
        ),
    ]
}

/// Cases that are flat in the source, but that the driver or the grammar nests.
fn in_a_row() -> Vec<Nested> {
    vec![
        plain(
            "choices",
            format!("x = {} 1.0;", row(|d| format!("p.x < {d}.0 ? h(x, {d}.0) : "))),
        ),
        plain(
            "choices with effects",
            format!(
                "float y = 1.0; x = {} 1.0; x += y;",
                row(|d| format!("(y += 0.25) * 4.0 > p.x ? (x += {d}.0, h(x, {d}.0) + y) : "))
            ),
        ),
        plain(
            "and",
            format!(
                "if ({} true) x += 0.25;",
                row(|d| format!("p.x > {d}.0 && h(x, {d}.0) >= 0.0 && "))
            ),
        ),
        function(
            "returns",
            &row(|d| format!("g(x, {d}.0); if (p.x < {d}.0) return x; ")),
        ),
        function(
            "returns in ifs",
            &nest(|inside, d| {
                format!("if (p.x > {d}.0) {{ g(x, {d}.0); {inside} if (x < 2.0) return x; x += 0.25; }}")
            }),
        ),
        plain(
            "continues",
            format!(
                "for (int i = 0; i < 3; i++) {{ {} }}",
                row(|d| format!("g(x, {d}.0); if (p.x < {d}.0) continue; "))
            ),
        ),
        plain(
            "breaks of a switch",
            format!(
                "switch (int(p.x) & 1) {{ case 0: x = 1.0; default: {} }}",
                row(|d| format!("g(x, {d}.0); if (p.x < {d}.0) break; "))
            ),
        ),
        plain(
            "discards",
            nest(|inside, d| format!("if (p.x > {d}.0) {{ g(x, {d}.0); {inside} if (x > 16.5) discard; }}")),
        ),
        (
            "calls",
            (0..5).rev().map(function_of_levels).collect(),
            "x = k0(p, x);".to_owned(),
        ),
    ]
}

fn frame() -> Frame {
    Frame {
        size: [WIDTH, 1],
        ..Frame::default()
    }
}

fn rendered(worker: &mut Worker, checked: &Checked, passes: Passes) -> Image {
    let rendered = worker.draw_unwatched(lower_with(checked, passes), frame(), FloatMode::Strict);
    rendered.unwrap_or_else(|failure| panic!("{failure}")).image()
}

fn evaluated(checked: &Checked) -> Image {
    let program = Program::new(checked).unwrap();
    let rendered_image = program.render::<f32>(&frame(), &Settings::default());
    rendered_image.unwrap().framebuffer.image()
}

#[test]
fn deep_nesting_renders_as_it_evaluates() {
    let Some(worker) = require_worker() else {
        return;
    };
    let mut worker = worker.with_plain_code();
    let (mut wrong, mut needless) = (Vec::new(), Vec::new());
    for (name, before, body) in nested().into_iter().chain(in_a_row()) {
        let text = format!(
            "void g(inout float x, float d) {{ x = mod(x * 1.25 + d + x * x * 0.125, 17.0); }}\n\
             float h(inout float x, float d) {{ x = mod(x * 1.25 + d, 17.0); return x; }}\n{before}\n\
             void mainImage(out vec4 c, in vec2 p) {{ float x = 0.0; {body} c = vec4(x, x * x, p.x, 1); }}"
        );
        let checked = support::checked(&text);
        let evaluated = evaluated(&checked);
        if rendered(&mut worker, &checked, Passes::strict()).pixels() != evaluated.pixels() {
            wrong.push(name);
        }
        let without = Passes::strict().without(Pass::Nesting);
        if rendered(&mut worker, &checked, without).pixels() == evaluated.pixels() {
            needless.push(name);
        }
    }
    assert!(wrong.is_empty(), "rendered wrong: {wrong:?}");
    // The driver folds these, or its loop stack holds them.
    let harmless = ["choices", "and"];
    needless.retain(|name| !harmless.contains(name));
    assert!(
        needless.len() <= 4,
        "no longer wrong without the pass: {needless:?}"
    );
}

/// A shader that calls `f`.
fn calling(functions: &str) -> Checked {
    support::checked(&format!(
        "{functions}\nvoid mainImage(out vec4 c, in vec2 p) {{ c = vec4(f(p.x)); }}"
    ))
}

fn loops(count: usize) -> Checked {
    let body = (0..count).fold("x += 0.5;".to_owned(), |inside, d| {
        format!("for (int i{d} = 0; i{d} < 1; i{d}++) {{ {inside} }}")
    });
    calling(&format!("float f(float x) {{ {body} return x; }}"))
}

fn calls(count: usize) -> Checked {
    let calls = (0..count).map(|d| {
        let callee = if d == 0 {
            "g".to_owned()
        } else {
            format!("f{}", d - 1)
        };
        let name = if d == count - 1 {
            "f".to_owned()
        } else {
            format!("f{d}")
        };
        format!("float {name}(float x) {{ if (x > {d}.0) x = {callee}(x); return x; }}\n")
    });
    calling(&format!(
        "float g(float x) {{ return x + 0.5; }}\n{}",
        calls.collect::<String>()
    ))
}

#[test]
fn too_deep_nesting_is_not_run_on_a_driver() {
    let lowered = |checked: &Checked| lower_with(checked, Passes::strict());
    for (name, deep, shallow) in [("loops", loops(73), loops(72)), ("calls", calls(73), calls(72))] {
        assert_eq!(lowered(&shallow).too_deep(), None, "{name}");
        let lowered = lowered(&deep);
        let reported = lowered.too_deep().expect(name);
        assert!(
            reported.code == Code::TooDeepToRun && reported.span.is_some(),
            "{reported:?}"
        );
        // No process is started for it.
        let mut worker = Worker::new(
            "/nothing".into(),
            Vec::new(),
            AdapterSelector::Auto,
            Duration::from_secs(1),
        );
        let failure = worker
            .draw(lowered.clone(), frame(), FloatMode::Strict)
            .unwrap_err();
        assert_eq!(failure, Failure::Invalid(vec![reported.clone()]));
    }
    let Some(worker) = require_worker() else {
        return;
    };
    let mut worker = worker.with_plain_code();
    for deepest in [loops(72), calls(72)] {
        let evaluated = evaluated(&deepest);
        let rendered = rendered(&mut worker, &deepest, Passes::strict());
        assert_eq!(rendered.pixels(), evaluated.pixels());
    }
}
