//! The single edit: the results for typical mistakes, and the limits of the search.

use std::time::Duration;

use toyproof_diagnostic::Deadline;

use super::*;

/// Helper functions and a `mainImage` whose body is the given text.
fn shader(body: &str) -> String {
    format!(
        "float sphere(vec3 oc, vec3 rd) {{\n    float b = dot(oc, rd);\n    return b * b - dot(oc, oc);\n}}\n\
         void mainImage(out vec4 c, in vec2 p) {{\n    vec3 rd = vec3(p, 1.0);\n    {body}\n}}\n"
    )
}

/// The message of the single edit, and the text after it.
fn found(text: &str, options: &Options) -> Option<(String, String)> {
    let mut files = Files::default();
    let file = files.add(File::new("a.glsl", text));
    let errors = check(&files, file, options).expect_err("the text is invalid");
    let fix = single_edit(&files, file, &errors, options)?;
    let edited = edited(text, &fix.edits);
    let fixed = files.add(File::new("fixed.glsl", edited.as_str()));
    check(&files, fixed, options).expect("the edited text compiles");
    Some((fix.message, edited))
}

/// The message of the single edit for a text, which must have been found.
fn message(text: &str) -> String {
    found(text, &Options::default())
        .unwrap_or_else(|| panic!("no edit of\n{text}"))
        .0
}

#[test]
fn each_typical_mistake_has_its_edit() {
    let cases = [
        (
            "float t = sphere(rd, rd)\n    c = vec4(t);",
            "insert `;` after `sphere(rd, rd)`",
        ),
        ("c = vec4(sphere(rd, rd);", "insert `)` after `sphere(rd, rd)`"),
        ("c = vec4 sphere(rd, rd));", "insert `(` after `vec4`"),
        ("c = vec4sphere(rd, rd));", "insert `(` after `vec4`"),
        ("c = vec4(sphere(rd rd));", "insert `,` after `rd`"),
        ("c = vec4(rd 1.0);", "insert `,` after `rd`"),
        ("c = vec4(1.0 -1.0, p);", "insert `,` after `1.0`"),
        ("c = vec4(rd, 1.0,);", "remove `,`"),
        ("c = vec4(1.0));", "remove `)`"),
        ("float k[3; c = vec4(k[0]);", "insert `]` after `3`"),
        ("c = vec4(rdd, 1.0);", "did you mean `rd`?"),
        ("c = vec4(lerp(0.0, 1.0, 0.5));", "use `mix`"),
        ("int n = 1.0; c = vec4(n);", "write `1`"),
        ("float t = 2 * p.x; c = vec4(t);", "write `2.0`"),
        (
            "vec2 n = rd * 2.0; c = vec4(n, 1.0);",
            "write `vec3` instead of `vec2`",
        ),
        ("t = p.x; c = vec4(t);", "insert `float` after `;`"),
        ("c = vec4(1.0h);", "write `1.0` instead of `1.0h`"),
        (
            "if (p.x = 1.0) c = vec4(1.0);",
            "`=` assigns; use `==` to compare",
        ),
        ("foat t = p.x; c = vec4(t);", "did you mean `float`?"),
    ];
    let results: Vec<_> = cases
        .map(|(body, _)| message(&shader(body)))
        .into_iter()
        .collect();
    let wanted: Vec<_> = cases.map(|(_, wanted)| wanted.to_owned()).into_iter().collect();
    assert_eq!(results, wanted);
}

#[test]
fn braces_follow_the_indentation() {
    let text = "float f(float x) {\n    if (x > 0.0) {\n        x = 1.0;\n        x += 1.0;\n    return x;\n}\n\
                void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(f(p.x));\n}\n";
    let (_, edited) = found(text, &Options::default()).unwrap();
    assert!(edited.contains("x += 1.0;\n    }\n    return x;"), "{edited}");
    let without_open = text
        .replace("x > 0.0) {", "x > 0.0)")
        .replace("    return", "    }\n    return");
    assert_eq!(message(&without_open), "insert `{` after `if (x > 0.0)`");
    let doubled = text
        .replace("x > 0.0) {", "x > 0.0) {{")
        .replace("    return", "    }\n    return");
    assert_eq!(message(&doubled), "remove `{`");
}

#[test]
fn a_misspelled_declaration_is_renamed_rather_than_its_uses() {
    let text = shader("float widht = p.x; c = vec4(width, width, width, 1.0);");
    assert_eq!(message(&text), "write `width` instead of `widht`");
}

#[test]
fn the_header_of_main_image_is_completed() {
    for header in [
        "void mainImage(vec4 c, in vec2 p)",
        "mainImage(out vec4 c, in vec2 p)",
        "void mainImag(out vec4 c, vec2 p)",
    ] {
        let (_, edited) = found(
            &format!("{header} {{ c = vec4(p, 0.0, 1.0); }}"),
            &Options::default(),
        )
        .unwrap();
        assert!(edited.contains("void mainImage(out vec4 c, "), "{edited}");
    }
}

#[test]
fn nothing_is_reported_without_a_single_edit() {
    for body in [
        "c = vec4(first(p)); c += vec4(second(p)); c += third;",
        "c = @ @ # $;",
    ] {
        assert_eq!(found(&shader(body), &Options::default()), None, "{body}");
    }
}

#[test]
fn no_check_begins_after_the_deadline() {
    let text = shader("c = vec4(1.0)");
    let mut files = Files::default();
    let file = files.add(File::new("a.glsl", text));
    let errors = check(&files, file, &Options::default()).unwrap_err();
    let options = Options {
        deadline: Deadline::after(Duration::ZERO),
        ..Options::default()
    };
    assert_eq!(single_edit(&files, file, &errors, &options), None);
}

#[test]
fn hostile_texts_are_harmless() {
    let texts = [
        String::new(),
        "{".repeat(50_000),
        "(".repeat(50_000),
        "}".repeat(50_000),
        "a ".repeat(50_000),
        "é\\\n€".repeat(10_000),
        "#define A(\n".repeat(5_000),
        "else ".repeat(30_000),
        (0..20_000).fold(String::new(), |text, number| text + &format!("a{number} ")),
        "x".repeat(MAX_TEXT_BYTES + 1),
    ];
    for text in texts {
        assert_eq!(found(&text, &Options::default()), None);
    }
}

#[test]
fn the_edit_replaces_the_fixes_of_the_first_error_unless_an_error_carries_it() {
    let options = Options::default();
    let errors = |text: &str| {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        let errors = check(&files, file, &options).unwrap_err();
        let before = Vec::from(errors.clone());
        (before, with_single_edit(&files, file, errors, &options))
    };
    let (before, after) = errors(&shader("c = vec4(sphere(rd, rd);"));
    assert!(before[0].fixes.is_empty());
    assert_eq!(after[0].fixes[0].message, "insert `)` after `sphere(rd, rd)`");
    let (before, after) = errors(&shader("c = vec4(rdd, 1.0);"));
    assert_eq!(before, after);
}
