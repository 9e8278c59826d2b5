//! Quick fixes.

use lsp_types::{CodeAction, CodeActionKind, CodeActionResponse, Position, Range};

use super::Fixture;
use crate::code_actions::code_actions;

/// The actions for the line of the cursor.
fn actions(fixture: &mut Fixture, only: &[CodeActionKind]) -> Vec<CodeAction> {
    let (uri, byte) = fixture.cursor.clone().unwrap();
    let snapshot = fixture.workspace.snapshot(&uri).unwrap();
    let line = snapshot.document_range(byte, byte).start.line;
    let range = Range::new(Position::new(line, 0), Position::new(line, u32::MAX));
    let found = code_actions(&mut fixture.workspace, &snapshot, range, only, None);
    let actions = found.into_iter().map(|action| match action {
        CodeActionResponse::CodeAction(action) => action,
        CodeActionResponse::Command(command) => panic!("{command:?}"),
    });
    actions.collect()
}

/// The titles of the actions, each with the text after it.
fn applied(text: &str) -> Vec<(String, String)> {
    let mut fixture = Fixture::shader(text);
    let found = actions(&mut fixture, &[CodeActionKind::QuickFix]);
    let applied = found.into_iter().map(|action| {
        let mut files = fixture.applied(&action.edit.unwrap());
        (action.title, files.pop().unwrap().1)
    });
    applied.collect()
}

#[test]
fn a_proposed_correction_is_a_quick_fix() {
    let text = "void mainImage(out vec4 c, in vec2 p) {\n    float a = 1|;\n    c = vec4(a);\n}\n";
    let found = applied(text);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].1, text.replace("1|;", "1.0;"));
    let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(smoothStep|(0., 1., p.x)); }";
    assert_eq!(applied(text)[0].1, text.replace("smoothStep|", "smoothstep"));
}

#[test]
fn the_edit_after_which_a_text_compiles_is_found() {
    let text =
        "void mainImage(out vec4 c, in vec2 p) {\n    vec3 a = vec3(p, 0.|;\n    c = vec4(a, 1.);\n}\n";
    let found = applied(text);
    assert!(
        found.iter().any(|(_, text)| text.contains("vec3(p, 0.);")),
        "{found:?}"
    );
}

#[test]
fn a_warning_is_allowed_by_a_comment() {
    let text = "void mainImage(out vec4 c, in vec2 p) {\n    float a|;\n    c = vec4(a);\n}\n";
    let text = text.replace("a|;", "a;").replace("(a)", "(a|)");
    let found = applied(&text);
    let allowed = found
        .iter()
        .find(|(title, _)| title == "Allow W0003 on this line")
        .unwrap();
    assert!(
        allowed.1.contains("c = vec4(a); // toyproof: allow(W0003)\n"),
        "{allowed:?}"
    );
    let commented = text.replace(");\n}", "); // red\n}");
    assert!(
        applied(&commented)
            .iter()
            .all(|(title, _)| !title.starts_with("Allow"))
    );
}

#[test]
fn all_corrections_are_applied_at_once() {
    let text = "|void mainImage(out vec4 c, in vec2 p) {\n    float a = 1;\n    float b = 2;\n    c = vec4(a, b, smoothStep(0., 1., p));\n}\n";
    let mut fixture = Fixture::shader(text);
    let fix_all = [CodeActionKind::SourceFixAll];
    let found = actions(&mut fixture, &fix_all);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].title, "Apply all 3 corrections of toyproof");
    let edited = fixture.applied(found[0].edit.as_ref().unwrap()).pop().unwrap().1;
    let expected = text
        .replace('|', "")
        .replace("= 1;", "= 1.0;")
        .replace("= 2;", "= 2.0;");
    assert_eq!(edited, expected.replace("smoothStep", "smoothstep"));
    assert!(actions(&mut fixture, &[CodeActionKind::Refactor]).is_empty());
    assert!(
        actions(
            &mut Fixture::shader("|void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }"),
            &[]
        )
        .is_empty()
    );
}

#[test]
fn a_correction_in_common_is_offered_where_it_is() {
    let files = [
        ("common.glsl", "float f() { return 1|; }\n"),
        (
            "image.glsl",
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(f()); }\n",
        ),
    ];
    let mut fixture = Fixture::new(2, &files);
    let found = actions(&mut fixture, &[]);
    let edit = found[0].edit.clone().unwrap();
    assert_eq!(
        fixture.applied(&edit),
        [("common.glsl".to_owned(), "float f() { return 1.0; }\n".to_owned())]
    );
    let image = fixture.workspace.snapshot(&fixture.uri("image.glsl")).unwrap();
    let everywhere = Range::new(Position::new(0, 0), Position::new(9, 0));
    let here = code_actions(
        &mut fixture.workspace,
        &image,
        everywhere,
        &[CodeActionKind::QuickFix],
        None,
    );
    assert!(here.is_empty(), "{here:?}");
}
