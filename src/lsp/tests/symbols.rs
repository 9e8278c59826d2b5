//! Definitions, references and highlights.

use lsp_types::{Definition, DefinitionResponse, DocumentHighlightKind, Location};

use super::Fixture;
use crate::navigation::{definition, highlights, references};

/// `file:line:column` of locations, from 1.
fn shown(locations: &[Location]) -> Vec<String> {
    let show = |location: &Location| {
        let name = location.uri.0.rsplit('/').next().unwrap();
        let start = location.range.start;
        format!("{name}:{}:{}", start.line + 1, start.character + 1)
    };
    let mut shown: Vec<_> = locations.iter().map(show).collect();
    shown.sort();
    shown
}

fn definition_in(fixture: &mut Fixture) -> Vec<String> {
    let (snapshot, at) = fixture.at_cursor();
    match definition(&snapshot, at) {
        Some(DefinitionResponse::Definition(Definition::LocationList(locations))) => shown(&locations),
        None => Vec::new(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn definitions_of_all_kinds_of_names() {
    for (text, expected) in [
        (
            "float f(float x) { return x|; }\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(f(1.)); }",
            "a.glsl:1:15",
        ),
        (
            "float f(float);\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(|f(1.)); }\nfloat f(float x) { return x; }",
            "a.glsl:3:7",
        ),
        (
            "float f(int);\nfloat f(float x) { return x; }\nfloat f(int x) { return 1.; }\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(f|(1)); }",
            "a.glsl:3:7",
        ),
        (
            "struct S { float a, b; };\nvoid mainImage(out vec4 c, in vec2 p) { S s; c = vec4(s.b|); }",
            "a.glsl:1:21",
        ),
        (
            "struct S { float a; };\nvoid mainImage(out vec4 c, in vec2 p) { |S s; c = vec4(s.a); }",
            "a.glsl:1:8",
        ),
        (
            "#define K 2.\n#define SQ(x) (x)*(x)\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(K| * SQ(p.x)); }",
            "a.glsl:1:9",
        ),
        (
            "#define SQ(x) (x)*(x)\nvoid mainImage(out vec4 c, in vec2 p) { float r = 1.; c = vec4(SQ(r|)); }",
            "a.glsl:2:47",
        ),
        (
            "void mainImage(out vec4 c, in vec2 p) { float a = 1.; { float a = a|; c = vec4(a); } }",
            "a.glsl:1:47",
        ),
        (
            "void mainImage(out vec4 c, in vec2 p) { float a = 1.; c = vec4(a|.",
            "a.glsl:1:47",
        ),
    ] {
        assert_eq!(definition_in(&mut Fixture::shader(text)), [expected], "{text}");
    }
    for text in [
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(i|Time); }",
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(si|n(p.x)); }",
        "void mainImage(out vec4 c, in vec2 p) { c = ve|c4(1); }",
    ] {
        assert_eq!(definition_in(&mut Fixture::shader(text)), [""; 0], "{text}");
    }
}

const PROJECT: [(&str, &str); 3] = [
    (
        "image.glsl",
        "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(part|(p.x)) + vec4(part(p.y));\n}\n",
    ),
    ("common.glsl", "float part(float x) { return x / 2.; }\n"),
    (
        "buffer-a.glsl",
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(part(1.)); }\n",
    ),
];

#[test]
fn references_are_found_in_all_tabs() {
    // Only the Image tab is open.
    let mut fixture = Fixture::new(1, &PROJECT);
    assert_eq!(definition_in(&mut fixture), ["common.glsl:1:7"]);
    let (snapshot, at) = fixture.at_cursor();
    let uses = references(&mut fixture.workspace, &snapshot, at, false).unwrap();
    assert_eq!(
        shown(&uses),
        ["buffer-a.glsl:1:50", "image.glsl:2:14", "image.glsl:2:32"]
    );
    let all = references(&mut fixture.workspace, &snapshot, at, true).unwrap();
    assert_eq!(all.len(), 4);
    assert_eq!(
        all.iter()
            .filter(|one| one.uri == fixture.uri("common.glsl"))
            .count(),
        1
    );
}

#[test]
fn references_include_inputs_and_macro_bodies() {
    let text = "float r = 1.;\n#define TWICE (2. * r)\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(TWICE + TWICE + r|); }";
    let mut fixture = Fixture::shader(text);
    let (snapshot, at) = fixture.at_cursor();
    let all = references(&mut fixture.workspace, &snapshot, at, true).unwrap();
    assert_eq!(shown(&all), ["a.glsl:1:7", "a.glsl:2:21", "a.glsl:3:66"]);
    let mut fixture =
        Fixture::shader("void mainImage(out vec4 c, in vec2 p) { c = vec4(iT|ime) * sin(iTime); }");
    let (snapshot, at) = fixture.at_cursor();
    let all = references(&mut fixture.workspace, &snapshot, at, true).unwrap();
    assert_eq!(shown(&all), ["a.glsl:1:50", "a.glsl:1:63"]);
}

#[test]
fn highlights_distinguish_reads_and_writes() {
    let text = "void add(inout vec3 a, float b) { a += b; }\nvoid mainImage(out vec4 c, in vec2 p) {\n    vec3 co|l = vec3(1);\n    col.x = 2.;\n    add(col, col.y);\n    c = vec4(col, 1);\n}";
    let mut fixture = Fixture::shader(text);
    let (snapshot, at) = fixture.at_cursor();
    let found = highlights(&mut fixture.workspace, &snapshot, at).unwrap();
    let written = found
        .iter()
        .filter(|one| one.kind == Some(DocumentHighlightKind::Write));
    let lines: Vec<_> = written
        .map(|one| (one.range.start.line, one.range.start.character))
        .collect();
    assert_eq!((found.len(), lines), (5, vec![(2, 9), (3, 4), (4, 8)]));
}
