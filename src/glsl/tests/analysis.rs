//! The analysis of texts for an editor: what names denote, where they are visible, and what remains of a text
//! that is being written.

use toyproof_diagnostic::{File, FileId, Files};

use crate::tree::Type;
use crate::{Analysis, Options, Resolution, analyze, check};

fn analyzed(text: &str) -> (Files, FileId, Analysis) {
    let mut files = Files::default();
    let file = files.add(File::new("a.glsl", text));
    let analysis = analyze(&files, file, &Options::default());
    (files, file, analysis)
}

/// The name of an entity, and for members and parameters that of what contains them.
fn named(analysis: &Analysis, resolution: Resolution) -> String {
    let tree = analysis.tree();
    match resolution {
        Resolution::Variable(id) => tree[id].name.clone(),
        Resolution::Struct(id) => tree[id].name.clone(),
        Resolution::Member(id, member) => format!("{}.{}", tree[id].name, tree[id].members[member].name),
        Resolution::Function(id) => format!("{}()", tree[id].name),
        Resolution::BuiltIn(function) => format!("{}[]", function.name()),
    }
}

/// The names that are visible at a `|` of a text, the innermost first; the `|` is removed.
fn visible(text: &str) -> Vec<String> {
    let (before, after) = text.split_once('|').unwrap();
    let at = before.len() as u32;
    let (_, _, analysis) = analyzed(&format!("{before}{after}"));
    let mut found: Vec<_> = analysis
        .visibilities
        .iter()
        .filter(|visible| (visible.start..visible.end).contains(&at))
        .map(|visible| (usize::MAX - visible.depth, named(&analysis, visible.resolution)))
        .collect();
    found.sort();
    found.into_iter().map(|(_, name)| name).collect()
}

#[test]
fn each_name_denotes_what_is_declared() {
    let text = "struct S { float a; };\nfloat f(float);\nfloat f(float x) { S s = S(x); return s.a; }\n\
                #define TWICE(v) (2. * f(v))\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(TWICE(p.x) + sin(iTime)); }";
    let (files, _, analysis) = analyzed(text);
    assert!(analysis.is_valid(), "{:?}", analysis.diagnostics);
    let names: Vec<_> = analysis
        .names
        .iter()
        .map(|name| {
            let mark = if name.declares { "=" } else { "" };
            format!("{mark}{}", named(&analysis, name.resolution))
        })
        .collect();
    assert_eq!(
        names.join(" "),
        "=S =S.a =f() =f() =x S =s S x s S.a =mainImage() =c =p c f() p sin[] iTime"
    );
    // The name in the macro is where it is written.
    let in_macro = analysis.names.iter().find(|name| name.at.is_expanded()).unwrap();
    assert_eq!(files.text(in_macro.at.spelling), "f");
    assert_eq!(files.position(in_macro.at.spelling).line, 4);
}

#[test]
fn names_are_visible_in_their_scopes() {
    let main = "float g = 1.;\nvoid f(int q) {}\nvoid mainImage(out vec4 c, in vec2 p) {";
    for (body, expected) in [
        (" | float a = 1.; }", "c p f() g mainImage()"),
        (" float a = |1.; }", "c p f() g mainImage()"),
        (" float a = 1.;| }", "a c p f() g mainImage()"),
        (" { float a = 1.; } | }", "c p f() g mainImage()"),
        (" { float a = 1.; | } }", "a c p f() g mainImage()"),
        (
            " for (int i = 0; i < 3; i++) { float a; | } }",
            "i a c p f() g mainImage()",
        ),
        (" for (int i = 0; i < 3; i++) | }", "i c p f() g mainImage()"),
        (" if (true) { float a = 1.; | ", "a c p f() g mainImage()"),
        (" float a = 1., b = a|; }", "a c p f() g mainImage()"),
        (" float a; a. | }", "a c p f() g mainImage()"),
        (" } | void h() {}", "f() g mainImage()"),
    ] {
        let text = format!("{main}{body}");
        let found = visible(&text);
        let mut wanted: Vec<_> = expected.split(' ').collect();
        let mut found: Vec<_> = found.iter().map(String::as_str).collect();
        wanted.sort_unstable();
        found.sort_unstable();
        assert_eq!(found, wanted, "{text}");
    }
}

#[test]
fn what_is_written_so_far_has_its_type() {
    let main = "struct R { vec3 o; };\nfloat f(float x, vec2 y) { return x; }\nvoid mainImage(out vec4 c, in vec2 p) { vec3 v[2]; R r;";
    for (rest, end, ty) in [
        (" c = p.", "p", "vec2"),
        (" c = p. }", "p", "vec2"),
        (" c = r.o. }", "r.o", "vec3"),
        (" c = v[1]. ; }", "v[1]", "vec3"),
        (" c = f(1., p. ; }", "p", "vec2"),
        (" c = vec4(p, p.\n vec3 d = vec3(1); }", "p", "vec2"),
        (" if (p. ) { } }", "p", "vec2"),
        (" for (int i = 0; i < p. ; i++) {} }", "p", "vec2"),
        (" float a = 1. + p. }", "p", "vec2"),
        (" vec3 c = (p.xyx * 2.). ; }", "(p.xyx * 2.)", "vec3"),
        (" c = f(p.x, p). }", "f(p.x, p)", "float"),
    ] {
        let text = format!("{main}{rest}");
        let (files, file, analysis) = analyzed(&text);
        assert!(!analysis.is_valid());
        let dot = (main.len() + rest.rfind('.').unwrap()) as u32;
        let tree = analysis.tree();
        let ends_here = tree.exprs.iter().filter(|(_, expr)| {
            expr.at.span.file == file && expr.at.span.end == dot && expr.ty != Type::Error
        });
        let longest = ends_here.max_by_key(|(_, expr)| expr.at.span.end - expr.at.span.start);
        let longest = longest.map(|(_, expr)| (files.text(expr.at.span), tree.type_name(expr.ty)));
        assert_eq!(longest, Some((end, ty.to_owned())), "{text}");
    }
}

#[test]
fn an_analysis_reports_what_a_check_reports() {
    for text in [
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }",
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(q; }",
        "#define F(x) x +\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(F(1) F(2) 3); }",
        "void mainImage(out vec4 c, in vec2 p) { /* ",
        "#if\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(q); }",
        "float f() { return 1; }",
        "",
    ] {
        let (files, file, analysis) = analyzed(text);
        let checked = check(&files, file, &Options::default());
        assert_eq!(analysis.checked().is_some(), checked.is_ok(), "{text}");
        match checked {
            Ok(checked) => assert_eq!(analysis.diagnostics, checked.warnings),
            Err(errors) => assert_eq!(analysis.diagnostics, Vec::from(errors), "{text}"),
        }
    }
}

#[test]
fn a_text_of_unknown_extent_is_analyzed_as_far_as_it_goes() {
    let (_, _, analysis) =
        analyzed("float g = 1.;\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(g); /* never closed");
    assert_eq!(analysis.diagnostics.len(), 1);
    assert!(
        analysis
            .names
            .iter()
            .any(|name| named(&analysis, name.resolution) == "g" && !name.declares)
    );
}
