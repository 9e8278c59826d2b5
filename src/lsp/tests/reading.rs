//! What features show of projects, where Common is in front of each tab, and of files with includes.

use lsp_types::{Contents, Position};

use super::Fixture;
use crate::completion::completion;
use crate::every_feature::{read_at, read_document};
use crate::folding::folding_ranges;
use crate::hover::hover;
use crate::inlay_hint::inlay_hints;
use crate::outline::{document_symbols, workspace_symbols};
use crate::semantic::semantic_tokens;
use crate::signature::signature_help;

const COMMON: &str = "// 😀 Half of x.\r\n\
    float bisect(float x, float share) { return x * share; }\r\n#define UP vec3(0, 1, 0)\r\n";
const IMAGE: &str = "void mainImage(out vec4 c, in vec2 p) {\r\n\tc = vec4(bisect(p.x, .5)); // 😀\r\n}\r\n";

fn project(image: &str) -> Fixture {
    Fixture::new(1, &[("image.glsl", image), ("common.glsl", COMMON)])
}

fn hovered(fixture: &mut Fixture) -> String {
    let (snapshot, at) = fixture.at_cursor();
    match hover(&snapshot, at).map(|hover| hover.contents) {
        Some(Contents::MarkupContent(markup)) => markup.value,
        other => format!("{other:?}"),
    }
}

#[test]
fn names_of_common_have_their_comments_in_tabs() {
    let text = hovered(&mut project(&IMAGE.replace("bisect", "bis|ect")));
    assert_eq!(
        text,
        "```glsl\nfloat bisect(float x, float share)\n```\n\n😀 Half of x."
    );
    let text = hovered(&mut project(&IMAGE.replace("bisect(p.x, .5)", "U|P.x")));
    assert!(
        text.starts_with("```glsl\n#define UP vec3(0, 1, 0)\n```"),
        "{text}"
    );
    let mut in_common = Fixture::new(
        2,
        &[
            ("image.glsl", IMAGE),
            ("common.glsl", &COMMON.replace("x * share", "x * sh|are")),
        ],
    );
    assert_eq!(hovered(&mut in_common), "```glsl\nfloat share\n```");
}

#[test]
fn names_of_common_are_completed_in_tabs() {
    let mut fixture = project(&IMAGE.replace("bisect", "bi|"));
    let (snapshot, at) = fixture.at_cursor();
    let items = completion(&snapshot, at).items;
    let item = items.iter().find(|item| item.label == "bisect").unwrap();
    assert_eq!(item.detail.as_deref(), Some("float bisect(float x, float share)"));
    assert!(items.iter().any(|item| item.label == "UP"));
    let mut fixture = project(&IMAGE.replace("(p.x, .5)", "(p.x, |"));
    let (snapshot, at) = fixture.at_cursor();
    let help = signature_help(&snapshot, at).unwrap();
    assert_eq!(help.signatures[0].label, "float bisect(float x, float share)");
}

#[test]
fn positions_of_a_tab_are_its_own() {
    let mut fixture = project(&IMAGE.replace("bisect", "|bisect"));
    let (snapshot, _) = fixture.at_cursor();
    let symbols = document_symbols(&snapshot);
    let names: Vec<_> = symbols.iter().map(|symbol| symbol.name.as_str()).collect();
    assert_eq!(names, ["mainImage"]);
    assert_eq!(symbols[0].range.end, Position::new(2, 1));
    assert_eq!(folding_ranges(&snapshot).len(), 1);
    let tokens = semantic_tokens(&snapshot, None).data;
    let lines: u32 = tokens.iter().map(|token| token.delta_line).sum();
    assert_eq!(lines, 1, "the last token is the comment on line 1");
    let hints = inlay_hints(&snapshot, (0, u32::MAX));
    let positions: Vec<_> = hints.iter().map(|hint| hint.position).collect();
    assert_eq!(positions, [Position::new(1, 22)]);
}

#[test]
fn features_read_files_that_include_others_and_those_that_are_included() {
    let files = [
        (
            "a.glsl",
            "#include \"b.glsl\"\n// 😀\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(twi|ce(p.x)); }",
        ),
        (
            "b.glsl",
            "// Twice x.\nfloat twice(float x) {\n\treturn 2. * x;\n}\n",
        ),
    ];
    let mut fixture = Fixture::new(2, &files);
    assert!(hovered(&mut fixture).ends_with("Twice x."));
    for name in ["a.glsl", "b.glsl"] {
        let uri = fixture.uri(name);
        let snapshot = fixture.workspace.snapshot(&uri).unwrap();
        read_document(&snapshot);
        for byte in 0..=snapshot.file().text().len() as u32 {
            read_at(&snapshot, byte);
        }
        assert_eq!(document_symbols(&snapshot).len(), 1, "{name}");
    }
}

#[test]
fn symbols_of_a_workspace_are_also_those_of_tabs_that_are_not_open() {
    let mut fixture = Fixture::new(
        1,
        &[
            ("image.glsl", IMAGE),
            ("common.glsl", COMMON),
            ("buffer-a.glsl", IMAGE),
        ],
    );
    let snapshots = fixture.workspace.snapshots();
    let symbols = workspace_symbols(&snapshots, "");
    let shown = symbols.iter().map(|symbol| {
        let (_, file) = symbol.location.uri.0.rsplit_once('/').unwrap();
        format!("{file} {}", symbol.base_symbol_information.name)
    });
    let shown: Vec<_> = shown.collect();
    assert_eq!(
        shown,
        [
            "buffer-a.glsl mainImage",
            "common.glsl bisect",
            "common.glsl UP",
            "image.glsl mainImage"
        ]
    );
}
