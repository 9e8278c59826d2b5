use std::ops::ControlFlow;

use toyproof_diagnostic::Code;
use toyproof_glsl as glsl;
use toyproof_glsl::tree::{Statement, StatementKind};

use super::*;

/// Reduces a text to one that compiles and for which `shows` holds.
fn reduced(text: &str, threads: usize, shows: fn(&str) -> bool) -> Reduction {
    let language = glsl::Options::default();
    let limits = Limits {
        threads,
        ..Limits::default()
    };
    let tester = || |text: &str| compiles(text) && shows(text);
    reduce(text, &language, &limits, &tester, &mut |_| {
        ControlFlow::Continue(())
    })
    .unwrap()
}

fn compiles(text: &str) -> bool {
    let (files, file) = outline::file(text);
    glsl::check(&files, file, &glsl::Options::default()).is_ok()
}

const SHADER: &str = "\
// A scene with a ground and a sphere.
#define MAX_STEPS 64
#define SQ(x) ((x)*(x))
#ifdef HIGH
const float EPSILON = 1e-4;
#else
const float EPSILON = 1e-3;
#endif
struct Hit { float t; vec3 normal; };
float sphere(vec3 p, vec3 center, float radius) { return length(p - center) - radius; }
float map(vec3 p) {
    float ground = p.y + 1.;
    float ball = sphere(p, vec3(0., 0.2, -3.), 0.8);
    return min(ground, ball);
}
vec3 normal(vec3 p) {
    vec2 e = vec2(EPSILON, 0.);
    return normalize(vec3(
        map(p + e.xyy) - map(p - e.xyy),
        map(p + e.yxy) - map(p - e.yxy),
        map(p + e.yyx) - map(p - e.yyx)));
}
Hit march(vec3 o, vec3 d) {
    float t = 0.;
    for (int i = 0; i < MAX_STEPS; i++) {
        float h = map(o + t * d);
        if (h < EPSILON) break;
        t += h;
    }
    vec3 n = normal(o + t * d);
    return Hit(t, n);
}
void mainImage(out vec4 color, in vec2 position) {
    vec2 uv = (2. * position - iResolution.xy) / iResolution.y;
    vec3 d = normalize(vec3(uv, -1.5));
    Hit hit = march(vec3(0.), d);
    vec3 shaded = vec3(0.5 + 0.5 * hit.normal.y) / (1. + SQ(hit.t) * 0.1);
    if (hit.t > 20.) {
        shaded = mix(vec3(0.6, 0.7, 0.8), vec3(1.), uv.y);
    } else {
        shaded *= fract(hit.t) * 0.2 + 0.8;
    }
    color = vec4(pow(shaded, vec3(0.4545)), 1.);
}
";

#[test]
fn one_call_of_a_function_is_all_that_is_left() {
    let reduction = reduced(SHADER, 1, |text| text.contains("fract("));
    let expected = "void mainImage(out vec4 color, in vec2 position) {\n    fract(0.);\n}\n";
    assert_eq!(reduction.text, expected);
    assert!(reduction.is_complete);
}

#[test]
fn what_the_fault_needs_is_kept() {
    let shows = |text: &str| {
        let (files, file) = outline::file(text);
        let checked = glsl::check(&files, file, &glsl::Options::default()).unwrap();
        let mut functions = checked.tree.functions.iter();
        functions.any(|(_, function)| {
            let body = function.body.as_deref().unwrap_or_default();
            let mut loops = body.iter().filter_map(|statement| match &statement.kind {
                StatementKind::For { body, .. } => Some(body),
                _ => None,
            });
            loops.any(|body| {
                matches!(
                    body[..],
                    [
                        ..,
                        Statement {
                            kind: StatementKind::Expression(_),
                            ..
                        }
                    ]
                )
            })
        })
    };
    let reduction = reduced(SHADER, 1, shows);
    let expected =
        "void march() {\n    for (;;) 1.;\n}\nvoid mainImage(out vec4 color, in vec2 position) {\n}\n";
    assert_eq!(reduction.text, expected);
}

#[test]
fn the_number_of_threads_does_not_change_the_result() {
    let shows = |text: &str| text.contains("for") && text.contains("map(") && text.contains("break");
    let one = reduced(SHADER, 1, shows);
    assert_eq!(one, reduced(SHADER, 2, shows));
    assert_eq!(one, reduced(SHADER, 5, shows));
}

#[test]
fn a_text_that_does_not_compile_is_reduced() {
    let broken = SHADER.replace("t += h;", "t += h + missing;");
    let language = glsl::Options::default();
    let tester = || {
        |text: &str| {
            let (files, file) = outline::file(text);
            let errors = glsl::check(&files, file, &glsl::Options::default()).err();
            errors.is_some_and(|errors| errors.iter().all(|error| error.code == Code::Undeclared))
        }
    };
    let reduction = reduce(&broken, &language, &Limits::default(), &tester, &mut |_| {
        ControlFlow::Continue(())
    });
    let expected = "void mainImage(out vec4 color, in vec2 position) {\n    uv;\n}\n";
    assert_eq!(reduction.unwrap().text, expected);
}

#[test]
fn a_text_without_the_fault_is_an_error() {
    let tester = || |_: &str| false;
    let language = glsl::Options::default();
    let reduction = reduce(SHADER, &language, &Limits::default(), &tester, &mut |_| {
        ControlFlow::Continue(())
    });
    assert_eq!(reduction, Err(NoFault));
}

#[test]
fn every_smaller_text_is_reported_until_the_caller_stops() {
    let language = glsl::Options::default();
    let tester = || |text: &str| compiles(text);
    let mut last = String::new();
    let mut on_progress = |progress: &Progress| {
        if progress.is_smaller {
            assert!(last.is_empty() || Size::of(progress.text) <= Size::of(&last));
            progress.text.clone_into(&mut last);
        }
        if progress.tries < 3 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    };
    let reduction = reduce(SHADER, &language, &Limits::default(), &tester, &mut on_progress).unwrap();
    assert!(!reduction.is_complete && reduction.tries <= 4);
    assert_eq!(reduction.text, last);
}

/// A part with a text.
fn part(text: &str, is_required: bool) -> Part {
    Part {
        text: text.to_owned(),
        language: glsl::Options::default(),
        is_required,
    }
}

#[test]
fn parts_that_the_fault_does_not_need_are_left_out() {
    let parts = [
        part(
            "void mainImage(out vec4 c, in vec2 p) { float x = 1.; c = vec4(x); }",
            true,
        ),
        part(
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(dFdx(p.x)) + 1.; }",
            false,
        ),
        part("void mainImage(out vec4 c, in vec2 p) { c = vec4(0); }", false),
        part("", false),
        part("", false),
    ];
    let shows = |texts: &[Option<String>]| {
        let all_compile = texts[..3].iter().flatten().all(|text| compiles(text));
        all_compile && texts[1].as_ref().is_some_and(|text| text.contains("dFdx(")) && texts[4].is_some()
    };
    let reductions = [1, 2].map(|threads| {
        let limits = Limits {
            threads,
            ..Limits::default()
        };
        let mut sizes = Vec::new();
        let reduction = reduce_parts(&parts, &limits, &|| shows, &mut |texts, progress| {
            if progress.is_smaller {
                sizes.push(
                    texts
                        .iter()
                        .flatten()
                        .map(|text| Size::of(text).weight)
                        .sum::<usize>(),
                );
            }
            ControlFlow::Continue(())
        });
        assert!(sizes.is_sorted_by(|a, b| a >= b), "{sizes:?}");
        reduction.unwrap()
    });
    let [reduction, other] = reductions;
    assert_eq!(reduction, other);
    let empty = "void mainImage(out vec4 c, in vec2 p) {\n}\n";
    let derivative = "void mainImage(out vec4 c, in vec2 p) {\n    dFdx(0.);\n}\n";
    let texts: Vec<Option<&str>> = reduction.texts.iter().map(Option::as_deref).collect();
    assert_eq!(texts, [Some(empty), Some(derivative), None, None, Some("")]);
    assert!(reduction.is_complete);
}

#[test]
fn parts_without_the_fault_are_an_error() {
    let parts = [part("void f() {}", true)];
    let never = |_: &[Option<String>]| false;
    let reduction = reduce_parts(&parts, &Limits::default(), &|| never, &mut |_, _| {
        ControlFlow::Continue(())
    });
    assert_eq!(reduction, Err(NoFault));
}
