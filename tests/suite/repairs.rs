//! Wrong shaders are repaired at the line of their mistake, and the search keeps its limits.

use std::time::Duration;

use rayon::ThreadPoolBuilder;
use toyproof::explain::Findings;
use toyproof::explain::known::Diagnosis;
use toyproof::explain::repair::{Donors, Repair, SearchResult};
use toyproof::glsl::Checked;
use toyproof::verify::Verdict;

use crate::support::{
    ANIMATION, EVERY_EXERCISE, Exercise, MANY_OBJECTS, QUADRICS, REFLECTIONS, SHADING, SPHERE, WHITTED,
    check_and_repair, check_and_repair_with, check_and_repair_within, checked, edited,
};

/// A mistake, the exercise in which it is made, and the first repair's text and mistake.
type Planted = (
    &'static Exercise,
    &'static str,
    &'static str,
    &'static str,
    &'static str,
);

/// One of each kind of edit. The mistake is the only place whose edit renders the scene, or the most
/// plausible one of several.
const PLANTED: &[Planted] = &[
    (
        &SPHERE,
        "fragCoord.x / iResolution.x * 2.0",
        "fragCoord.x / iResolution.x * 3.0",
        "replace `3.0` with `2.0`",
        "wrong-number",
    ),
    (
        &SPHERE,
        "/ aspect;",
        "* aspect;",
        "replace `(fragCoord.y / iResolution.y * 2.0 - 1.0) * aspect` with `(fragCoord.y / iResolution.y * 2.0 - 1.0) / aspect`",
        "wrong-operator",
    ),
    (
        &SHADING,
        "max(dot(normal, toLight), 0.0)",
        "min(dot(normal, toLight), 0.0)",
        "replace `min(dot(normal, toLight), 0.0)` with `max(dot(normal, toLight), 0.0)`",
        "wrong-function",
    ),
    (
        &SHADING,
        "max(dot(normal, toLight), 0.0)",
        "dot(normal, toLight)",
        "replace `dot(normal, toLight)` with `max(dot(normal, toLight), 0.0)`",
        "missing-call",
    ),
    (
        &SHADING,
        "lights[i].color * max(",
        "vec3(1.0) * max(",
        "replace `vec3(1.0)` with `lights[i].color`",
        "wrong-variable",
    ),
    (&SHADING, "i < 2", "i < 1", "replace `1` with `2`", "wrong-loop"),
    (
        &MANY_OBJECTS,
        "if (t < hit.t) {",
        "if (t > hit.t) {",
        "replace `t > hit.t` with `t < hit.t`",
        "wrong-comparison",
    ),
    (
        &REFLECTIONS,
        "throughput *= spheres[hit].color",
        "throughput += spheres[hit].color",
        "replace `throughput += spheres[hit].color` with `throughput *= spheres[hit].color`",
        "wrong-operator",
    ),
];

fn search(findings: Findings) -> SearchResult {
    assert!(findings.panics.is_empty(), "{:?}", findings.panics);
    assert_eq!(findings.verdict, Verdict::Wrong);
    findings.search.expect("a wrong shader is searched")
}

/// The lines that a repair edits, from 1.
fn lines(repair: &Repair, shader: &str) -> Vec<usize> {
    let line = |start: u32| shader[..start as usize].matches('\n').count() + 1;
    repair
        .fix
        .edits
        .iter()
        .map(|edit| line(edit.span.start))
        .collect()
}

#[test]
fn mistakes_of_each_kind_are_repaired_where_they_are() {
    let mut wrong = Vec::new();
    for &(exercise, before, after, message, id) in PLANTED {
        let shader = edited(exercise, &[(before, after)]);
        let result = search(check_and_repair(&shader, exercise));
        let found = result.repairs.first().map(|repair| {
            assert_eq!(repair.agreeing, repair.pixels, "{}", repair.fix.message);
            (repair.fix.message.as_str(), repair.mistake.id)
        });
        if found != Some((message, id)) {
            let all: Vec<_> = result.repairs.iter().map(|repair| &repair.fix.message).collect();
            wrong.push(format!("{}: {after}: {found:?} of {all:?}", exercise.name));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Adds the light sources one by one in place of a loop, with these calls. No function is left uncalled, since
/// that would be a mistake of its own.
fn with_calls(calls: &'static str) -> String {
    const ADD: &str = "void advance(inout int light) { light++; }

void addLight(inout vec3 sum, inout int light, vec3 point, vec3 normal) {
    vec3 toLight = normalize(lights[light].position - point);
    sum += lights[light].color * max(dot(normal, toLight), 0.0);
}

";
    const ADD_NEXT: &str = "void addNextLight(inout vec3 sum, inout int light, vec3 point, vec3 normal) {
    advance(light);
    addLight(sum, light, point, normal);
}

";
    let before = "for (int i = 0; i < 2; i++) {
        vec3 toLight = normalize(lights[i].position - point);
        sum += lights[i].color * max(dot(normal, toLight), 0.0);
    }";
    let next = if calls.contains("addNextLight") {
        ADD_NEXT
    } else {
        ""
    };
    let shader = edited(&SHADING, &[(before, calls)]);
    shader.replacen("vec3 shade(", &format!("{ADD}{next}vec3 shade("), 1)
}

#[test]
fn statements_are_repeated() {
    let cases = [
        (
            "int light = -1;
    addNextLight(sum, light, point, normal);",
            "repeat `addNextLight(sum, light, point, normal);`",
        ),
        (
            "int light = -1;
    advance(light);
    addLight(sum, light, point, normal);
    addLight(sum, light, point, normal);",
            "repeat `advance(light);` after `addLight(sum, light, point, normal);`",
        ),
    ];
    for (calls, message) in cases {
        let result = search(check_and_repair(&with_calls(calls), &SHADING));
        let found = result
            .repairs
            .first()
            .map(|repair| (repair.fix.message.as_str(), repair.mistake.id));
        assert_eq!(found, Some((message, "missing-statement")), "{calls}");
    }
}

#[test]
fn the_edited_text_renders_the_scene() {
    let shader = edited(&SPHERE, &[("/ aspect;", "* aspect;")]);
    let result = search(check_and_repair(&shader, &SPHERE));
    for repair in &result.repairs {
        let mut text = shader.clone();
        for edit in repair.fix.edits.iter().rev() {
            text.replace_range(
                edit.span.start as usize..edit.span.end as usize,
                &edit.replacement,
            );
        }
        assert_eq!(
            check_and_repair(&text, &SPHERE).verdict,
            Verdict::Correct,
            "{text}"
        );
    }
    assert!(!result.repairs.is_empty());
}

#[test]
fn a_number_that_the_scene_has_not_is_fitted() {
    let split = (
        "fragCoord.x / iResolution.x * 2.0 - 1.0",
        "fragCoord.x / iResolution.x * 2.0 - (0.63 + 0.31)",
    );
    let shader = edited(&SPHERE, &[split]);
    let result = search(check_and_repair(&shader, &SPHERE));
    let messages: Vec<_> = result
        .repairs
        .iter()
        .map(|repair| repair.fix.message.as_str())
        .collect();
    assert!(
        messages
            .iter()
            .any(|message| *message == "replace `0.31` with `0.37`"
                || *message == "replace `0.63` with `0.69`"),
        "{messages:?}"
    );
}

#[test]
fn two_mistakes_are_repaired_together() {
    let edits = [
        ("max(dot(normal, toLight), 0.0)", "dot(normal, toLight)"),
        ("sum = AMBIENT", "sum = 3.0 * AMBIENT"),
    ];
    let shader = edited(&SHADING, &edits);
    let result = search(check_and_repair(&shader, &SHADING));
    let wrong_lines: Vec<usize> = shader
        .lines()
        .zip(SHADING.shader.lines())
        .enumerate()
        .filter(|(_, (own, right))| own != right)
        .map(|(at, _)| at + 1)
        .collect();
    let first = result.repairs.first().expect("two edits repair it");
    let mut edited_lines = lines(first, &shader);
    edited_lines.sort_unstable();
    assert_eq!(
        (edited_lines, first.mistake.id),
        (wrong_lines, "two-mistakes"),
        "{}",
        first.fix.message
    );
}

#[test]
fn an_expression_of_another_shader_repairs_what_no_small_edit_does() {
    let shader = edited(
        &SHADING,
        &[("max(dot(normal, toLight), 0.0)", "fract(7.3 * normal.x)")],
    );
    let main = "void mainImage(out vec4 color, in vec2 pixel) {
        color = vec4(lambert(vec3(pixel, 1.0), vec3(0.0, 0.0, 1.0)));
    }";
    let lambert = |expression: &str| {
        let function = format!("float lambert(vec3 n, vec3 l) {{ return {expression}; }}\n");
        checked(&(function + main))
    };
    let [clamped, doubled] = ["clamp(dot(l, n), 0.0, 1.0)", "2.0 * dot(n, l) - 1.0"].map(lambert);
    let fixes = |shaders: &[&Checked]| {
        let donors = Donors::new(shaders.iter().copied());
        let result = search(check_and_repair_with(Some(&donors), &shader, &SHADING));
        let repairs = result.repairs.into_iter();
        repairs.map(|repair| repair.fix.message).collect::<Vec<_>>()
    };
    assert_eq!(fixes(&[&doubled]), [""; 0]);
    let expected = ["replace `fract(7.3 * normal.x)` with `clamp(dot(normal, toLight), 0.0, 1.0)`"];
    assert_eq!(fixes(&[&doubled, &clamped]), expected);
    assert_eq!(fixes(&[&clamped, &doubled]), expected);
}

#[test]
fn suspects_are_found_where_no_edit_repairs_the_shader() {
    let background = "return vec3(fract(7.0 * ray.direction.x), fract(5.0 * ray.direction.y), 0.9);";
    let shader = edited(&MANY_OBJECTS, &[("return vec3(0.3, 0.4, 0.6);", background)]);
    let result = search(check_and_repair(&shader, &MANY_OBJECTS));
    assert!(result.repairs.is_empty(), "{:?}", result.repairs[0].fix);
    let own = shader
        .lines()
        .position(|line| line.contains(background))
        .map(|at| at + 1);
    let line = |start: u32| shader[..start as usize].matches('\n').count() + 1;
    let suspects: Vec<usize> = result
        .suspects
        .iter()
        .map(|suspect| line(suspect.span.start))
        .collect();
    assert!(
        own.is_some_and(|own| suspects.contains(&own)),
        "{suspects:?}, not {own:?}"
    );
    assert!(
        result
            .suspects
            .windows(2)
            .all(|pair| pair[0].score >= pair[1].score)
    );
}

#[test]
fn correct_shaders_are_not_searched() {
    for exercise in EVERY_EXERCISE {
        assert!(
            check_and_repair(exercise.shader, exercise).search.is_none(),
            "{}",
            exercise.name
        );
    }
}

#[test]
fn the_result_does_not_depend_on_the_number_of_threads() {
    let mistakes: [(&Exercise, (&str, &str)); 3] = [
        (&ANIMATION, ("0.5", "0.6")),
        (&QUADRICS, ("-b", "b")),
        (&WHITTED, ("0.95", "0.85")),
    ];
    for (exercise, (before, after)) in mistakes {
        let shader = exercise.shader.replacen(before, after, 1);
        let results: Vec<_> = [1, 3]
            .into_iter()
            .map(|threads| {
                let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let findings = pool.install(|| check_and_repair(&shader, exercise));
                findings.search.map(|search| {
                    let fixes: Vec<_> = search.repairs.into_iter().map(|repair| repair.fix).collect();
                    (fixes, search.suspects, search.is_cut)
                })
            })
            .collect();
        assert_eq!(results[0], results[1], "{}", exercise.name);
    }
}

/// Work is counted, so that a short time limit changes nothing as long as the shader renders within it. The two
/// mistakes of a search take longer than all limits of the first one together.
#[test]
fn the_result_does_not_depend_on_the_time_limit() {
    let exercise = Exercise {
        size: [32, 18],
        ..SHADING
    };
    let two = edited(
        &exercise,
        &[
            ("max(dot(normal, toLight), 0.0)", "dot(normal, toLight)"),
            ("i < 2", "i < 1"),
        ],
    );
    let none = format!(
        "{}\nvoid unused() {{}}",
        edited(
            &exercise,
            &[(
                "lights[i].color *",
                "vec3(sin(9.0 * normal.x), 0.3, cos(5.0 * normal.y)) *"
            )]
        )
    );
    for shader in [two, none] {
        let result = |milliseconds| {
            let findings =
                check_and_repair_within(Duration::from_millis(milliseconds), 0.5, &shader, &exercise)?;
            assert!(!findings.is_cut_by_time);
            let mistake = findings.mistake.as_ref().map(Diagnosis::id);
            let search = findings.search.expect("a wrong shader is searched");
            let fixes: Vec<_> = search
                .repairs
                .into_iter()
                .map(|repair| (repair.fix, repair.agreeing))
                .collect();
            Some((findings.verdict, mistake, fixes, search.suspects, search.is_cut))
        };
        // On a slow machine, the image itself may take longer.
        let short = [50, 250, 1250].into_iter().find_map(result);
        assert_eq!(short, result(60_000), "{shader}");
    }
}

/// An edit may make a loop endless, or a shader so large that nothing compiles in time.
#[test]
fn a_search_ends_for_any_shader() {
    let repeated = |line: &dyn Fn(usize) -> String| (0..400).map(line).collect::<Vec<_>>().concat();
    let many = repeated(&|at| format!("float v{at} = fract(p.x * {at}.5 + p.y);\n"));
    let sum = repeated(&|at| format!("x += v{at} * {at}.25;\n"));
    let large =
        format!("void mainImage(out vec4 c, in vec2 p) {{ float x = 0.0;\n{many}{sum}c = vec4(fract(x)); }}");
    let loops = "void mainImage(out vec4 c, in vec2 p) { float x = 0.0;
        for (int i = 0; i < 40; i++) for (int j = 0; j < 40; j++) { x += fract(p.x * float(i * j)); }
        c = vec4(fract(x)); }";
    // Edits of pixels with so many iterations take a share of the budget each.
    let long_loop = "void mainImage(out vec4 c, in vec2 p) { float x = 0.0;
        for (int i = 0; i < 60000; i++) { x = fract(x + p.x * 0.37); } c = vec4(x); }";
    for shader in [large.as_str(), loops, long_loop] {
        let result = search(check_and_repair(shader, &SPHERE));
        assert!(result.repairs.is_empty());
    }
}
