//! Stepping, values at each point, incidents, and expressions.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use super::{HANG_GUARD, SPHERES, line, record, subject};
use crate::recording::{IncidentKind, Point, Recording};
use crate::stepping::StepKind;
use crate::subject::Subject;
use crate::watch::{Budget, Context, Watch};

/// The lines that steps of a kind lead to, from the start to the end.
fn lines(recording: &Recording, kind: StepKind) -> Vec<usize> {
    let mut point = recording.start();
    let mut lines = Vec::new();
    while point != recording.end() {
        lines.push(line(recording, point));
        point = recording.step(point, kind).unwrap();
    }
    lines
}

/// An expression at a point, in the innermost function.
fn evaluate(subject: &Subject, recording: &Recording, point: Point, expression: &str) -> String {
    let context = Context { subject, recording };
    let checked = &subject.checked;
    let frame = recording.stack(&checked.tree, checked.main_image, point)[0];
    let interrupt = AtomicBool::new(false);
    let budget = Budget {
        deadline: Instant::now() + HANG_GUARD,
        interrupt: &interrupt,
    };
    let watch = Watch::new(context, frame.function, frame.step, expression);
    let evaluated = watch.and_then(|watch| watch.evaluate(&[(point, frame)], true, budget));
    match evaluated {
        Ok(evaluated) => evaluated.values[0].full_text(&evaluated.tree),
        Err(error) => format!("error: {error}"),
    }
}

/// The points at a line.
fn points(recording: &Recording, of: usize) -> Vec<Point> {
    let points = (0..recording.len()).map(Point);
    points
        .filter(|&point| line(recording, point) == of && !recording.stop(point).unwrap().is_return)
        .collect()
}

#[test]
fn stepping_over_calls_follows_the_lines_of_the_function() {
    let recording = record(&subject(SPHERES));
    let loop_lines = [27, 28, 27, 28, 27];
    let expected = [&[23, 24, 25, 26, 27][..], &loop_lines[1..], &[30]].concat();
    // The declaration of `i` and its condition are on one line.
    assert_eq!(lines(&recording, StepKind::Next), expected);
}

#[test]
fn stepping_into_calls_visits_each_line_and_goes_on_inside_the_line_of_the_call() {
    let recording = record(&subject(SPHERES));
    let all = lines(&recording, StepKind::Into);
    // `hit`, back in the line of its call, and `closer`.
    let first = [28, 9, 10, 11, 12, 13, 28, 17, 18];
    let starts = all.windows(first.len()).filter(|lines| lines == &first);
    assert_eq!(starts.count(), 2, "{all:?}");
}

#[test]
fn stepping_out_and_back_are_inverse_to_stepping_in() {
    let recording = record(&subject(SPHERES));
    let inside = points(&recording, 11)[0];
    let outside = recording.step(inside, StepKind::Out).unwrap();
    assert_eq!(line(&recording, outside), 28);
    let back = recording.step(inside, StepKind::Back).unwrap();
    assert_eq!(line(&recording, back), 10);
    let first = points(&recording, 9)[0];
    let call = recording.step(first, StepKind::Back).unwrap();
    assert_eq!(line(&recording, call), 28);
    assert_eq!(recording.step(call, StepKind::Into), Some(first));
    // Backward over all calls, the lines are those of stepping forward.
    let mut point = recording.end();
    let mut lines_back = Vec::new();
    while let Some(before) = recording.step(point, StepKind::Back) {
        lines_back.push(line(&recording, before));
        point = before;
    }
    lines_back.reverse();
    assert_eq!(lines_back, lines(&recording, StepKind::Next));
}

#[test]
fn a_stack_has_the_lines_of_the_calls() {
    let subject = subject(SPHERES);
    let recording = record(&subject);
    let inside = points(&recording, 18)[1];
    let checked = &subject.checked;
    let stack = recording.stack(&checked.tree, checked.main_image, inside);
    let described = stack.iter().map(|frame| {
        let name = &*checked.tree[frame.function].name;
        (name, subject.files.position(frame.at.span).line)
    });
    assert_eq!(described.collect::<Vec<_>>(), [("closer", 18), ("mainImage", 28)]);
}

#[test]
fn variables_have_the_values_of_each_point() {
    let subject = subject(SPHERES);
    let recording = record(&subject);
    let at = |line: usize, time: usize, expression: &str| {
        evaluate(&subject, &recording, points(&recording, line)[time], expression)
    };
    // Before and after the assignments.
    assert_eq!(at(23, 0, "centers[0]"), "(0, 0, 0)");
    assert_eq!(at(24, 0, "centers[0]"), "(0, 0, -5)");
    assert_eq!(at(30, 0, "centers"), "[(0, 0, -5), (0, 0, -3)]");
    assert_eq!(at(30, 0, "nearest"), "2");
    // In each iteration and each call.
    assert_eq!(at(28, 0, "i"), "0");
    assert_eq!(at(28, 1, "i"), "1");
    assert_eq!(at(28, 1, "nearest"), "4");
    assert_eq!(at(9, 0, "center.z"), "-5");
    assert_eq!(at(9, 1, "center.z"), "-3");
    assert_eq!(at(11, 1, "b"), "-3");
    // An `inout` parameter is the variable of the caller.
    assert_eq!(at(18, 1, "nearest"), "4");
    assert_eq!(at(18, 1, "t"), "2");
}

#[test]
fn expressions_are_those_of_the_shader() {
    let subject = subject(SPHERES);
    let recording = record(&subject);
    let point = points(&recording, 28)[1];
    let value = |expression: &str| evaluate(&subject, &recording, point, expression);
    assert_eq!(value("nearest / 10.0 + 0.5"), "0.9");
    assert_eq!(value("ray"), "Ray((0, 0, 0), (0, 0, -1))");
    assert_eq!(value("ray.direction.zyx"), "(-1, 0, 0)");
    assert_eq!(value("hit(ray, centers[i])"), "2");
    assert_eq!(value("i == 1 && nearest > 2.0 // comment"), "true");
    assert_eq!(value("mat2(1, 2, 3, 4) * vec2(1, 0)"), "(1, 2)");
    assert_eq!(value("uint(i) + 4u"), "5u");
    assert_eq!(value("iResolution.xy"), "(64, 36)");
    assert_eq!(value("gl_FragCoord.x"), "30.5");
    assert!(value("1.0 / 3.0").contains("(f64: 0.3333333333)"));
    // Variables that are not in scope, and changes.
    assert!(value("disc").contains("disc"), "{}", value("disc"));
    for wrong in [
        "nearest = 2.0",
        "i++",
        "closer(1.0, nearest)",
        "",
        "}",
        "vec3(",
        "iChannel0",
    ] {
        assert!(value(wrong).starts_with("error: "), "{wrong}: {}", value(wrong));
    }
}

#[test]
fn conditions_are_evaluated_as_in_float32() {
    let text = "void mainImage(out vec4 c, in vec2 p) {\n    float x = 0.1;\n    c = vec4(x);\n}\n";
    let subject = subject(text);
    let recording = record(&subject);
    let value = |text: &str| evaluate(&subject, &recording, points(&recording, 3)[0], text);
    assert_eq!(value("x == 0.1"), "true");
    assert_eq!(value("x * 1e39"), "inf (f64: 1e38)");
}

#[test]
fn values_that_are_not_finite_are_reported_where_they_arise() {
    let text = "\
float root(float x) {
    return sqrt(x);
}

void mainImage(out vec4 c, in vec2 p) {
    float a = root(-p.x);
    float b = a * 2.0;
    c = vec4(b);
    float d = 1.0 / (p.x - 30.5);
    c.x += d;
}
";
    let recording = record(&subject(text));
    let found = recording.incidents(0..usize::MAX);
    let found = found.filter(|incident| incident.kind == IncidentKind::NotFinite);
    let found: Vec<_> = found
        .map(|incident| (line(&recording, Point(incident.stop)), &*incident.text))
        .collect();
    assert_eq!(
        found,
        [(2, "`sqrt(x)` is NaN"), (9, "`1.0 / (p.x - 30.5)` is inf")]
    );
}

#[test]
fn a_loss_of_precision_is_reported_where_it_arises() {
    let text = "\
void mainImage(out vec4 c, in vec2 p) {
    float big = 1e8 + p.x;
    float small = big - 1e8;
    float scaled = small * 0.01;
    c = vec4(scaled);
}
";
    let subject = subject(text);
    let recording = record(&subject);
    for kind in [IncidentKind::Divergence, IncidentKind::VisibleCause] {
        let found = recording.incidents(0..usize::MAX);
        let found: Vec<_> = found.filter(|incident| incident.kind == kind).collect();
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(line(&recording, Point(found[0].stop)), 3);
        assert!(
            found[0].text.contains("`big - 1e8` is 32 in f32 and 30.5 in f64"),
            "{found:?}"
        );
    }
    let value = evaluate(&subject, &recording, points(&recording, 5)[0], "small");
    assert_eq!(value, "32 (f64: 30.5)");
}

#[test]
fn undefined_operations_are_reported() {
    let text = "\
void mainImage(out vec4 c, in vec2 p) {
    float a[3];
    int i = int(p.x);
    c = vec4(a[i]);
    c += float(7 / (i - i));
}
";
    let recording = record(&subject(text));
    let found = recording.incidents(0..usize::MAX);
    let found = found.filter(|incident| incident.kind == IncidentKind::Undefined);
    let found: Vec<_> = found
        .map(|incident| (line(&recording, Point(incident.stop)), &*incident.text))
        .collect();
    assert_eq!(found[0], (4, "an index out of bounds: `i`"));
    assert!(
        found.contains(&(5, "an integer division by zero: `7 / (i - i)`")),
        "{found:?}"
    );
}

#[test]
fn all_statements_can_be_stopped_at() {
    let text = "\
void nothing() {
}
void mainImage(out vec4 c, in vec2 p) {
    int n = 0;
    while (n < 2)
        n++;
    do {
        n--;
    }
    while (n > 0);
    switch (n) {
    case 0:
        n = 5;
    default:
        n += 1;
    }
    if (n == 7) {
        n = 0;
    } else if (n == 6)
        nothing();
    else
        n = 3;
    for (;;) {
        if (n-- < 0)
            break;
        continue;
    }
    {
        int m = n;
        n = m;
    }
    for (int i = 0; i < 3; i++) n += i;
    c = vec4(n);
    return;
}
";
    let recording = record(&subject(text));
    let lines = lines(&recording, StepKind::Next);
    let expected = [
        &[4, 5, 6, 5, 6, 5, 8, 10, 8, 10, 11, 13, 15, 17, 19, 20][..],
        &[24, 26].repeat(7),
        &[24, 25, 29, 30, 32, 32, 32, 32, 33, 34],
    ];
    assert_eq!(lines, expected.concat());
}

#[test]
fn scopes_have_the_variables_that_are_declared_before() {
    let text = "\
float x = 7.0;
void mainImage(out vec4 c, in vec2 p) {
    float y = x;
    {
        float x = 2.0;
        y += x;
    }
    float x = 3.0;
    c = vec4(x + y);
}
";
    let subject = subject(text);
    let recording = record(&subject);
    let value = |line: usize| evaluate(&subject, &recording, points(&recording, line)[0], "x");
    assert_eq!([3, 5, 6, 8, 9].map(value), ["7", "7", "2", "7", "3"]);
}

#[test]
fn macros_have_the_place_of_their_use() {
    let text = "\
#define TWICE(v) v *= 2.0; v += 1.0;
#define CALL(v) scaled(v)
float scaled(float v) {
    return 3.0 * v;
}
void mainImage(out vec4 c, in vec2 p) {
    float x = CALL(p.x);
    TWICE(x)
    c = vec4(x);
}
";
    let subject = subject(text);
    let recording = record(&subject);
    assert_eq!(lines(&recording, StepKind::Next), [7, 8, 8, 9]);
    let inside = points(&recording, 4)[0];
    let checked = &subject.checked;
    let stack = recording.stack(&checked.tree, checked.main_image, inside);
    assert_eq!(subject.files.position(stack[1].at.span).line, 7);
    let value = evaluate(&subject, &recording, points(&recording, 8)[0], "x");
    assert_eq!(value, "91.5");
}

#[test]
fn long_executions_are_cut_and_endless_ones_interrupted() {
    let text = "\
void mainImage(out vec4 c, in vec2 p) {
    for (int i = 0; i < 1000000; i++) {
        c.x += 1.0;
    }
}
";
    let recording = record(&subject(text));
    assert!(recording.is_cut && recording.len() > 10_000);
    assert_eq!(points(&recording, 3).len(), recording.len() / 2);
    let endless = subject(&text.replace("i < 1000000", "i < 2000000000"));
    let interrupt = AtomicBool::new(true);
    let failure = Recording::new(&endless, Instant::now() + HANG_GUARD, &interrupt).unwrap_err();
    assert_eq!(failure.to_string(), "interrupted");
}

#[test]
fn a_shader_without_statements_has_an_end() {
    let recording = record(&subject("void mainImage(out vec4 c, in vec2 p) {}\n"));
    assert!(recording.is_empty() && recording.start() == recording.end());
    for kind in [StepKind::Next, StepKind::Into, StepKind::Out] {
        assert_eq!(recording.step(recording.start(), kind), Some(recording.end()));
    }
    assert_eq!(recording.step(recording.start(), StepKind::Back), None);
}

/// The host calls `main`, and a generated `mainImage` is not displayed.
#[test]
fn shaders_of_other_hosts_begin_in_main() {
    let text = "\
uniform vec2 u_resolution;
float half_of(float x) {
    return 0.5 * x;
}
void main() {
    vec2 st = gl_FragCoord.xy / u_resolution;
    gl_FragColor = vec4(st, half_of(st.x), 1.0);
}
";
    let subject = subject(text);
    let recording = record(&subject);
    assert_eq!(lines(&recording, StepKind::Next), [6, 7]);
    let checked = &subject.checked;
    let names = |point| {
        let stack = recording.stack(&checked.tree, checked.main_image, point);
        let names = stack.iter().map(|frame| &*checked.tree[frame.function].name);
        names.collect::<Vec<_>>()
    };
    assert_eq!(names(points(&recording, 3)[0]), ["half_of", "main"]);
    assert_eq!(names(recording.end()), ["main"]);
    let color = evaluate(&subject, &recording, recording.end(), "gl_FragColor.y + st.x");
    assert_eq!(color, "0.9904514 (f64: 0.9904513889)");
}
