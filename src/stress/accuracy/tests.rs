//! The examination of functions with known errors.

use std::sync::atomic::AtomicBool;

use toyproof_diagnostic::{File, Files};
use toyproof_eval::Wide;
use toyproof_glsl::{self as glsl, Checked};

use super::*;

pub(super) fn checked(text: &str) -> Checked {
    let mut files = Files::default();
    let file = files.add(File::new("t", text));
    glsl::check(&files, file, &glsl::Options::default()).unwrap_or_else(|errors| panic!("{errors:?}\n{text}"))
}

/// A shader that calls nothing.
fn shader(functions: &str) -> String {
    format!("{functions}\nvoid mainImage(out vec4 c, in vec2 p) {{ c = vec4(0); }}")
}

fn examined(functions: &str, name: &str, ranges: &[(&str, &str)], properties: &[&str]) -> Report {
    let text = shader(functions);
    let checked = checked(&text);
    let interface = Interface::new(&checked, name).unwrap();
    let ranges: Vec<_> = ranges
        .iter()
        .map(|(path, range)| GivenRange {
            path: (*path).to_owned(),
            interval: Interval::parse(range),
        })
        .collect();
    let properties: Vec<_> = properties
        .iter()
        .map(|text| Property::parse(text).unwrap())
        .collect();
    let request = Request {
        ranges: &ranges,
        properties: &properties,
        seed: 1,
        cases: 4000,
        timeout: None,
        interrupt: &AtomicBool::new(false),
    };
    examine(&text, &checked, &interface, request, &|| ()).unwrap()
}

#[test]
fn cancellation_is_the_fault_of_the_formula_and_its_operation_is_found() {
    // √(1 + x) − 1 for small x, whose condition number is 1.
    let text = "float root(float x) { float s = sqrt(1.0 + x); return s - 1.0; }";
    let report = examined(text, "root", &[("x", "1e-6..1")], &[]);
    let worst = report.outputs[0].worst_of_formula.as_ref().unwrap();
    assert!(worst.excess > 1e4, "{worst:?}");
    assert!(worst.condition[0] < 2.0, "{worst:?}");
    let cause = worst.cause.as_ref().unwrap();
    let found = &shader(text)[cause.start as usize..cause.end as usize];
    assert!(found.contains("s - 1.0"), "{found}");
}

#[test]
fn a_zero_of_the_result_is_ill_conditioned_and_not_the_fault_of_the_formula() {
    let text = "float circle(vec2 p, float r) { return length(p) - r; }";
    let report = examined(text, "circle", &[("p", "-2..2"), ("r", "0.5..1")], &[]);
    let output = &report.outputs[0];
    let worst = output.worst.as_ref().unwrap();
    assert!(
        worst.ulps > 1e4 && worst.condition.iter().any(|number| *number > 1e4),
        "{worst:?}"
    );
    assert!(
        output
            .worst_of_formula
            .as_ref()
            .is_none_or(|worst| worst.excess < 32.0),
        "{output:?}"
    );
}

#[test]
fn flushed_denormals_are_no_error() {
    let text = "float halved(float x) { return 0.5 * x; }";
    let report = examined(text, "halved", &[("x", "-1..1")], &[]);
    assert_eq!(report.outputs[0].worst, None);
}

#[test]
fn all_types_are_passed_and_returned_to_the_bit() {
    let text = "struct Ray { vec3 o; vec3 d; };
        void every(in Ray ray, int n[2], uint u, bool b, mat2 m,
                 inout vec2 v, out ivec2 i, out uint w, out bool c) {
            v += m * ray.o.xy * 0.0; i = ivec2(n[0], n[1]); w = u; c = b;
        }";
    let text = shader(text);
    let checked = checked(&text);
    let interface = Interface::new(&checked, "every").unwrap();
    let evaluator = Evaluator::new(&text, &checked, &interface, None).unwrap();
    let case: Case = vec![
        1.0,
        2.0,
        3.0,
        0.0,
        0.0,
        1.0,
        -2_147_483_648.0,
        2_147_483_647.0,
        4_294_967_295.0,
        1.0,
        1.0,
        2.0,
        3.0,
        4.0,
        f64::from(0.1f32),
        f64::from(-1e-30f32),
    ]
    .into();
    let wanted = [
        f64::from(0.1f32),
        f64::from(-1e-30f32),
        -2_147_483_648.0,
        2_147_483_647.0,
        4_294_967_295.0,
        1.0,
    ];
    let cases = vec![case.clone(); 700];
    assert!(
        evaluator
            .evaluate::<f32>(&cases, ())
            .unwrap()
            .iter()
            .all(|outputs| outputs[..] == wanted)
    );
    assert!(
        evaluator
            .evaluate::<f64>(&cases, ())
            .unwrap()
            .iter()
            .all(|outputs| outputs[..] == wanted)
    );
    // The call is GLSL that the front end accepts.
    let call = interface.call(&case);
    let with_call = format!("{text}\nvoid other() {{ {call}; }}");
    super::tests::checked(&with_call);
    assert!(call.contains("(-2147483647 - 1), 2147483647"), "{call}");
}

#[test]
fn overflow_inside_of_the_function_is_found() {
    let text = "float size(vec2 p) { return sqrt(p.x * p.x + p.y * p.y); }";
    let report = examined(text, "size", &[("p", "-1..1")], &[]);
    assert_eq!(report.outputs[0].not_finite, 0);
    let failing = report.extremes.iter().filter(|one| one.not_finite > 0);
    let smallest = failing.map(|one| one.factor).fold(f64::INFINITY, f64::min);
    assert_eq!(smallest, 1e25);
}

#[test]
fn properties_hold_or_have_a_counterexample() {
    let text = "vec2 turn(float t) { return vec2(cos(t), sin(t)); }
        float even(float x) { return x * x; }
        float odd(float x) { return x * x * x; }
        float blend(float a, float b, float t) { return mix(a, b, t); }
        float sum(float a, float b) { return a + b; }";
    let holds = |name: &str, property: &str| {
        let report = examined(text, name, &[], &[property]);
        let result = &report.properties[0];
        assert_eq!(report.violates(), result.worst.is_some());
        !report.violates()
    };
    assert!(holds("turn", "unit") && !holds("sum", "unit"));
    assert!(holds("even", "symmetric x") && !holds("odd", "symmetric x"));
    assert!(holds("odd", "monotone x") && !holds("even", "monotone x"));
    assert!(holds("sum", "swap a,b") && !holds("blend", "swap a,b"));
    assert!(holds("turn", "range -1..1") && !holds("sum", "range -1..1"));
}

#[test]
fn what_cannot_be_examined_is_refused() {
    let text = shader(
        "void nothing(float x) {}
        float none() { return 1.0; }
        float look(sampler2D s, vec2 p) { return 0.0; }",
    );
    let checked = checked(&text);
    let refused = |name: &str| Interface::new(&checked, name).unwrap_err().to_string();
    assert_eq!(
        refused("nothing"),
        "nothing returns nothing, and has no `out` parameter"
    );
    assert_eq!(refused("none"), "none has no inputs to vary");
    assert!(refused("look").contains("the parameter `s` of type sampler2D"));
    assert_eq!(refused("lok"), "there is no function `lok`; did you mean `look`?");
}

#[test]
fn the_reported_reference_has_more_digits_than_f64() {
    // For x below 1e-8, the cosine is 1 in f64, too. (1 − cos x) / x² is nearly 1/2.
    let text = "float half_versed(float x) { return (1.0 - cos(x)) / (x * x); }";
    let report = examined(text, "half_versed", &[("x", "1e-9..1e-7")], &[]);
    let evaluator = |text: &str| {
        let checked = checked(text);
        let interface = Interface::new(&checked, "half_versed").unwrap();
        let evaluator = Evaluator::new(text, &checked, &interface, None).unwrap();
        let case: Case = vec![f64::from(1e-9f32)].into();
        let double = evaluator
            .evaluate::<f64>(std::slice::from_ref(&case), ())
            .unwrap();
        let exact = evaluator.exact(&[case]).unwrap().unwrap();
        [double[0][0], exact[0][0]]
    };
    assert_eq!(evaluator(&shader(text)), [0.0, 0.5]);
    let worst = report.outputs[0].worst.as_ref().unwrap();
    assert_eq!((worst.reference_bits, worst.single), (Wide::BITS, 0.0));
    assert!((worst.reference - 0.5).abs() < 1e-12, "{worst:?}");
}
