//! Tests that every error of a text is reported, and no consequential error.

use toyproof_diagnostic as diagnostic;
use toyproof_diagnostic::{File, Files};

use super::{MAIN, check_text};
use crate::{Options, check};

/// `line: code` of each error, in order.
fn reported(text: &str) -> Vec<String> {
    let mut files = Files::default();
    let file = files.add(File::new("a", format!("{text}\n{MAIN}")));
    let errors = check(&files, file, &Options::default()).unwrap_err();
    errors
        .iter()
        .map(|error| {
            let line = error.span.map_or(0, |span| files.position(span).line);
            format!("{line}: {}", error.code)
        })
        .collect()
}

#[track_caller]
fn expect(text: &str, wanted: &[&str]) {
    assert_eq!(reported(text), wanted, "{text}");
}

#[test]
fn errors_in_statements_are_reported_separately() {
    let text = "float f(float x) {
    float a = 1.0
    float b = 2.0 +;
    if (x > ) { x = c; }
    for (int i = 0; i < ; i++) { a += float(i) + d; }
    while (a b) { a = b; }
    do { a = e; } while (a > b)
    switch (int(x) {
        case 0 a = 1.0; break;
        case 1: a = 2.0 3.0; break;
        default: return f;
    }
    a = b * ;
    return a + b
}";
    let wanted = [
        "2: E0100",
        "3: E0100",
        "4: E0100",
        "4: E0200",
        "5: E0100",
        "5: E0200",
        "6: E0100",
        "7: E0200",
        "7: E0100",
        "8: E0105",
        "9: E0100",
        "10: E0100",
        "11: E0202",
        "13: E0100",
        "14: E0100",
    ];
    expect(text, &wanted);
}

#[test]
fn errors_in_declarations_are_reported_separately() {
    let text = "struct S { float a float b; vec3 c };
float f(vec2 p, flaot x, vec3) { return p.x + x; }
float g(vec2 p, ) { return q + p.x; }
const float k = ;
vec3 h() { return vec3(f(vec2(1), k, vec3(1)), g(vec2(k)), S(1.0, k, vec3(k)).b; }
float late = x y;
void last() { late = 1.0; k2 = 1.0; }";
    let wanted = [
        "1: E0100", "1: E0100", "2: E0200", "3: E0100", "3: E0200", "4: E0100", "5: E0105", "6: E0100",
        "7: E0200",
    ];
    expect(text, &wanted);
}

#[test]
fn names_in_broken_declarations_are_not_reported_as_undeclared() {
    for text in [
        "void f() { vec3 a = ; a.x = 1.0; a = a * 2; }",
        "void f() { float a = 1.0 b, c = 2.0; c = b + a; }",
        "void f() { for (int i = 0, j =; i < 3; i++) { i += j; } }",
        "float f(vec2 p q) { return p.x; } float g() { return f(vec2(1), 2.0); }",
        "struct S { float a, }; S s; void f() { s.b = 1.0; }",
        "vec3 a[2] = vec3[](vec3(1), vec3(2) vec3(3)); void f() { a[0].x = 1.0; }",
        "void f() { vec2 a = vec3(1); a = vec3(2); float b = a.z; }",
        "vec2 f(float x) { return vec3(x); } void g() { vec3 v = f(1.0); }",
        "#define A(x) x ## x\nvoid f() { float b = A(1); b = 2.0; }",
        "#include <noise.glsl>\nvoid f() { float b = noise(vec2(1)); b = SCALE; }",
        "void f() { int a = 1; for (int i = 0 i < 3; i++) { a = i; } a = 2; }",
        "#define F(x) (x + oops)\nvoid f() { float a = F(1.0); a = F(2.0); }",
        "void f() { if (oops > 1.0) { float a = oops; } }",
        "float f() { return 1.0 + ; }",
    ] {
        assert_eq!(reported(text).len(), 1, "{text}: {:?}", reported(text));
    }
}

#[test]
fn missing_braces_are_located_by_indentation() {
    expect(
        "float f(float x) {\n    if (x > 1.0) {\n        x = 1.0;\n    return x;\n}\nfloat g() { return oops; }",
        &["2: E0105", "6: E0200"],
    );
    expect(
        "float f(float x) {\n    return x;\n\nfloat g() { return oops; }",
        &["1: E0105", "4: E0200"],
    );
    expect(
        "float f(float x)\n{\n    for (;;)\n    {\n        x = 1.0;\n    return x;\n}\nfloat g() { return oops; }",
        &["4: E0105", "8: E0200"],
    );
    // Without indentation, the innermost open block is at fault.
    expect(
        "float f(float x) {\nif (x > 1.0) {\nreturn x;\n}\nfloat g() { return oops; }",
        &["1: E0105", "5: E0200"],
    );
    expect(
        "float f(float x) {\n    if (x > 1.0)\n        x = 1.0;\n    }\n    return x;\n}\nfloat g() { return oops; }",
        &["4: E0105", "7: E0200"],
    );
    expect(
        "float f(float x)\n    return x;\n}\nfloat g() { return oops; }",
        &["3: E0105", "4: E0200"],
    );
    expect(
        "float f() {\n    return 1.0;\n    }\n}\nfloat g() { return oops; }",
        &["3: E0105", "5: E0200"],
    );
}

#[test]
fn missing_parentheses_are_reported_in_their_statement() {
    expect(
        "float f(float x) {\n    x = sin(cos(x);\n    if (x > (1.0) { x = 2.0; }\n    x = abs(x));\n    return x;\n}",
        &["2: E0105", "3: E0105", "4: E0105"],
    );
    expect("vec3 f(float x) { return vec3(x; 1.0, x); }", &["1: E0100"]);
    expect("float f(float x[2]) { return abs(x[1); }", &["1: E0105"]);
    expect("float f(float x) { return abs(x]; }", &["1: E0105"]);
}

#[test]
fn at_most_fifty_errors_are_reported() {
    let text = format!(
        "void f() {{\n{}}}\n{MAIN}",
        "    a = ;\n    b + c\n".repeat(40_000)
    );
    let errors = check_text(&text, &Options::default()).unwrap_err();
    assert_eq!(errors.len(), 50);
    assert!(errors.is_sorted_by_key(|error| error.span.map(|span| span.start)));
}

/// Quadratic time would be minutes, linear time is less than a second.
const HANG_GUARD: std::time::Duration = std::time::Duration::from_secs(60);

#[test]
fn hostile_texts_take_linear_time() {
    let count = 60_000;
    let texts = [
        "{ (".repeat(count),
        "} )".repeat(count),
        "a b(".repeat(count),
        "float f(float x { ".repeat(count),
        "void f() { ".repeat(count),
        "if ( ".repeat(count),
        "for (;".repeat(count),
        "@ ".repeat(count),
        "@;".repeat(count),
        "float @;".repeat(count),
        "struct { ".repeat(count),
        "switch (0) { case ".repeat(count),
        format!("{} {}", "(".repeat(count), ";".repeat(count)),
        format!("{} {}", "(;".repeat(count), ")".repeat(count)),
        format!("float f({}) {{ }}", "@,".repeat(count)),
    ];
    for text in texts {
        let start = std::time::Instant::now();
        assert!(check_text(&text, &Options::default()).is_err());
        assert!(start.elapsed() < HANG_GUARD, "{}", &text[..20]);
    }
}

#[test]
fn preprocessor_errors_do_not_hide_other_errors() {
    expect("float a = 2.0 § 3.0;\nfloat b = oops;", &["1: E0001", "2: E0200"]);
    expect(
        "#version 330\nfloat b = oops;\n#error no\nfloat c = 1;",
        &["1: E0011", "2: E0200", "3: E0010", "4: E0301"],
    );
    // But if the active text is unknown, nothing else is reported.
    expect(
        "#if oops\nfloat b = oops;\n#else\nfloat c = 1;\n#endif",
        &["1: E0005"],
    );
    expect("float b = oops; /*", &["1: E0002"]);
}

#[test]
fn a_missing_semicolon_is_reported_where_it_belongs() {
    let mut files = Files::default();
    let file = files.add(File::new(
        "a",
        format!("float f() {{\n    float a = 1.0 // one\n\n    return a;\n}}\n{MAIN}"),
    ));
    let errors = check(&files, file, &Options::default()).unwrap_err();
    assert_eq!(
        diagnostic::short(&errors[0], &files),
        "a:2:18: error[E0100]: expected `;` after `1.0`"
    );
    assert_eq!(errors.len(), 1);
}
