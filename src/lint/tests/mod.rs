//! Tests of each warning, with similar code that must not be reported.

mod lints;
mod uninit;

use toyproof_diagnostic::{Code, Deadline, Diagnostic, File, Files};
use toyproof_glsl::{MAX_REPORTED, Options, check};

use super::{Lints, lint};

/// The warnings about a shader, as `W0005:3` with the line.
fn warned(text: &str) -> Vec<String> {
    let (found, files) = diagnostics(text);
    found
        .iter()
        .map(|found| {
            format!(
                "{}:{}",
                found.code,
                found.span.map_or(0, |span| files.position(span).line)
            )
        })
        .collect()
}

fn diagnostics(text: &str) -> (Vec<Diagnostic>, Files) {
    let (lints, files) = lints(text);
    (lints.warnings, files)
}

fn lints(text: &str) -> (Lints, Files) {
    let mut files = Files::default();
    let file = files.add(File::new("a", text));
    let checked = check(&files, file, &Options::default());
    let checked = checked.unwrap_or_else(|errors| panic!("{text}\n{errors:#?}"));
    (lint(&files, &checked, &Deadline::default()), files)
}

/// A shader with these functions and these statements of `mainImage`, which begin on line 3.
fn shader(functions: &str, statements: &str) -> String {
    format!(
        "{}\nvoid mainImage(out vec4 c, in vec2 f) {{ c = vec4(0.0);\n{statements}\n}}\n",
        functions.replace('\n', " ")
    )
}

/// Checks a table with one case per line: the expected codes, `-` for none, then functions, `|`, and the
/// statements of `mainImage`. W0004 is expected for a variable that may be uninitialized,
/// although only a run that observes the read reports it.
fn check_cases(table: &str) {
    let mut wrong = Vec::new();
    for line in table.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let (wanted, text) = line.split_once(' ').unwrap();
        let text = format!(" {text} ");
        let (functions, statements) = text.split_once(" | ").unwrap_or(("", &text));
        let (lints, _) = lints(&shader(functions, statements));
        let found = lints.warnings.iter().chain(&lints.maybe_uninitialized);
        let mut found: Vec<_> = found.map(|found| found.code.to_string()).collect();
        found.dedup();
        let found = if found.is_empty() {
            "-".to_owned()
        } else {
            found.join(",")
        };
        if found != wanted {
            wrong.push(format!("expected {wanted}, found {found}: {text}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The message of the only warning.
fn message(functions: &str, statements: &str) -> String {
    let (found, _) = diagnostics(&shader(functions, statements));
    assert_eq!(found.len(), 1, "{found:#?}");
    found[0].message.clone()
}

// Properties of all warnings: `allow`, deduplication, deadlines and large shaders.

#[test]
fn repeated_macro_is_reported_once() {
    let text = "#define R(x) fract(sin(x) * 43758.5)\nvoid mainImage(out vec4 c, in vec2 f) { c = vec4(R(f.x), R(f.y), 0, 1); }";
    assert_eq!(warned(text), ["W0005:2"]);
}

#[test]
fn allowed_warnings_are_suppressed() {
    let hash = "fract(sin(f.x) * 43758.5)";
    let main = |before: &str, line: &str| {
        format!("{before}void mainImage(out vec4 c, in vec2 f) {{\n{line}\nc.y = {hash};\n}}\n")
    };
    let warned = |before: &str, line: &str| warned(&main(before, line)).join(" ");
    let set = format!("c = vec4({hash});");
    assert_eq!(warned("", &set), "W0005:2 W0005:3");
    // At the end of a line: covers that line.
    assert_eq!(
        warned("", &format!("{set} // toyproof: allow(W0005) it is only noise")),
        "W0005:3"
    );
    // On its own line: covers the whole next statement.
    assert_eq!(
        warned("", &format!("// toyproof: allow(W0005)\n\n// words\n{set}")),
        "W0005:6"
    );
    assert_eq!(
        warned(
            "",
            &format!("  //toyproof: allow( W0010 , W0005 )\n{{ {set}\n f.x; }}")
        ),
        "W0005:5"
    );
    // Covers the next declaration: here the whole function.
    assert_eq!(warned("const int N = 3;\n// toyproof: allow(W0005)\n", &set), "");
    // Before all code: covers the whole file.
    assert_eq!(
        warned(
            "/* a */ // b\n\n// toyproof: allow(W0005)\nconst int N = 3;\n",
            &set
        ),
        ""
    );
    // Remarks in skipped preprocessor groups do not count.
    assert_eq!(
        warned(
            "",
            &format!("{set}\n#if 0\n// toyproof: allow(W0005, W9)\n#endif")
        ),
        "W0005:2 W0005:6"
    );
    // Unused, unknown, not allowable, malformed.
    assert_eq!(
        warned("", &format!("{set}\nf; // toyproof: allow(W0010, W0005)")),
        "W0005:2 W0015:3 W0005:4"
    );
    assert_eq!(
        warned("", &format!("{set} // toyproof: allow(W1234)")),
        "W0005:2 W0014:2 W0005:3"
    );
    assert_eq!(
        warned("", &format!("{set} // toyproof: allow(E0001,)")),
        "W0005:2 W0014:2 W0014:2 W0005:3"
    );
    assert_eq!(
        warned("", &format!("{set} // toyproof: please")),
        "W0005:2 W0014:2 W0005:3"
    );
    // In a macro definition, covers its expansions.
    let text = "#define R fract(sin(f.x) * 43758.5) // toyproof: allow(W0005)\nvoid mainImage(out vec4 c, in vec2 f) { c = vec4(R); }";
    assert!(self::warned(text).is_empty());
    let text = "int a;\n// toyproof: allow(W0001)\n#define a__b 1\nvoid mainImage(out vec4 c, in vec2 f) { c = vec4(a__b); }";
    assert!(self::warned(text).is_empty());
}

/// Analysis of these shaders takes less than a second in linear time, and minutes in quadratic time. Only the
/// end of the analysis and its stack are checked, because time depends on the machine.
#[test]
fn analysis_of_large_shaders_ends_on_a_small_stack() {
    let lines = |line: fn(usize) -> String| (0..5_000).map(line).collect::<String>();
    let texts = [
        lines(|i| format!("float a{i}; if (f.x > {i}.0) a{i} = 1.0; c.x += a{i};\n")),
        lines(|i| format!("float a{i};\n"))
            + &lines(|i| format!("if (f.x > {i}.0) a{i} = 1.0;\n"))
            + &lines(|i| format!("c.x += a{i};\n")),
        "float a; if (f.x < 1.0) a = 2.0;".to_owned()
            + &" else if (f.x == c.y * 0.1) a = 2.0;".repeat(5_000)
            + "c.x = a;",
        format!("float a; c.x = {} a;", "f.x + ".repeat(20_000)),
        format!(
            "float a; c.x = float({} a > 1.0);",
            "f.x > 1.0 || ".repeat(20_000)
        ),
        lines(|i| format!("for (int i = 0; i < {i}; i++) {{ if (f.x == 0.1 * c.y) break; }}\n")),
    ];
    for text in texts {
        let builder = std::thread::Builder::new().stack_size(2 << 20);
        let found = std::thread::scope(|scope| {
            let text = shader("", &text);
            builder
                .spawn_scoped(scope, move || warned(&text).len())
                .unwrap()
                .join()
                .unwrap()
        });
        assert!(found <= MAX_REPORTED, "{found} {}", &text[..60]);
    }
}

#[test]
fn course_has_no_warnings() {
    let mut warnings = Vec::new();
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../glsl")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "glsl") {
            let (found, files) = diagnostics(&std::fs::read_to_string(&path).unwrap());
            let lines = found
                .iter()
                .map(|found| toyproof_diagnostic::short(found, &files));
            warnings.extend(lines.map(|line| format!("{}: {line}", toyproof_diagnostic::path_name(&path))));
        }
    }
    assert!(warnings.is_empty(), "{}", warnings.join("\n"));
}

#[test]
fn timed_out_lints_leave_only_a_note() {
    let mut files = Files::default();
    let text = "void mainImage(out vec4 c, in vec2 p) { float unset; c = vec4(unset); }";
    let file = files.add(File::new("a", text));
    let checked = check(&files, file, &Options::default()).unwrap();
    let lints = lint(&files, &checked, &Deadline::after(std::time::Duration::ZERO));
    let codes: Vec<_> = lints.warnings.iter().map(|warning| warning.code).collect();
    assert_eq!(codes, [Code::LintTimeout]);
}
