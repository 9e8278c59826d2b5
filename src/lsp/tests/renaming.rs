//! Renamings that are offered, and such that would change a shader.

use lsp_types::PrepareRenameResult;

use super::Fixture;
use crate::rename::{prepare, rename};

/// The files after a renaming, or why it is refused.
fn renamed(fixture: &mut Fixture, new_name: &str) -> Result<Vec<(String, String)>, String> {
    let (snapshot, at) = fixture.at_cursor();
    prepare(&snapshot, at)?;
    let edit = rename(&mut fixture.workspace, &snapshot, at, new_name)?;
    Ok(fixture.applied(&edit))
}

#[test]
fn names_of_all_kinds_are_renamed() {
    for (text, expected) in [
        (
            "void mainImage(out vec4 c, in vec2 p) { float a = 1.; { float b = a|; c = vec4(a*b); } }",
            "void mainImage(out vec4 c, in vec2 p) { float new = 1.; { float b = new; c = vec4(new*b); } }",
        ),
        (
            "float f(float);\nfloat f(float x) { return x; }\nfloat f(int x) { return 1.; }\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(f|(1.) + f(1)); }",
            "float new(float);\nfloat new(float x) { return x; }\nfloat f(int x) { return 1.; }\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(new(1.) + f(1)); }",
        ),
        (
            "struct S { float a, b; };\nvoid mainImage(out vec4 c, in vec2 p) { S s = S(1., 2.); c = vec4(s.|b, s.a, p).abgr; }",
            "struct S { float a, new; };\nvoid mainImage(out vec4 c, in vec2 p) { S s = S(1., 2.); c = vec4(s.new, s.a, p).abgr; }",
        ),
        (
            "struct |S { float a; };\nS f(S s) { S t[2]; return t[0]; }\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(f(S(1.)).a); }",
            "struct new { float a; };\nnew f(new s) { new t[2]; return t[0]; }\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(f(new(1.)).a); }",
        ),
        (
            "float r = 1.;\n#define TWICE (2. * r)\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(TWICE + r|); }",
            "float new = 1.;\n#define TWICE (2. * new)\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(TWICE + new); }",
        ),
        (
            "#define K| 2.\n#ifdef K\n#define L K\n#endif\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(L); }",
            "#define new 2.\n#ifdef new\n#define L new\n#endif\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(L); }",
        ),
    ] {
        let mut fixture = Fixture::shader(text);
        let files = renamed(&mut fixture, "new").unwrap_or_else(|reason| panic!("{reason}: {text}"));
        assert_eq!(files, [("a.glsl".to_owned(), expected.to_owned())]);
    }
}

#[test]
fn a_function_of_common_is_renamed_in_all_tabs() {
    let mut fixture = Fixture::new(
        1,
        &[
            (
                "image.glsl",
                "void mainImage(out vec4 c, in vec2 p) { c = vec4(h|(p.x)); }\n",
            ),
            ("common.glsl", "float h(float x) { return x / 2.; }\n"),
            (
                "buffer-a.glsl",
                "void mainImage(out vec4 c, in vec2 p) { c = vec4(h(1.)); }\n",
            ),
        ],
    );
    let files = renamed(&mut fixture, "bisect").unwrap();
    let changed: Vec<_> = files
        .iter()
        .map(|(name, text)| (&**name, text.matches("bisect").count()))
        .collect();
    assert_eq!(
        changed,
        [("buffer-a.glsl", 1), ("common.glsl", 1), ("image.glsl", 1)]
    );
    // A tab that is not open may have the name.
    let buffer = fixture.folder.path().join("buffer-a.glsl");
    std::fs::write(
        buffer,
        "float bisect(float x) { return x; }\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(h(1.)); }\n",
    )
    .unwrap();
    fixture.workspace.forget_all();
    let reason = renamed(&mut fixture, "bisect").unwrap_err();
    assert!(reason.starts_with("renaming it to `bisect`"), "{reason}");
}

#[test]
fn renamings_that_change_the_shader_are_refused() {
    let main = "void mainImage(out vec4 c, in vec2 p)";
    for (text, new_name, reason) in [
        (
            format!("{main} {{ float a| = 1., b = 2.; c = vec4(a, b, p); }}"),
            "b",
            "redeclaration of `b`",
        ),
        (
            format!("{main} {{ float b = 2.; {{ float a| = 1.; c = vec4(a, b, p); }} }}"),
            "b",
            "changes what another name",
        ),
        (
            format!("float g = 1.;\n{main} {{ float a| = 1.; c = vec4(a, g, p); }}"),
            "g",
            "changes what another name",
        ),
        (
            format!("{main} {{ float a| = 1.; c = vec4(a); }}"),
            "float",
            "is an error",
        ),
        (
            format!("{main} {{ float a| = 1.; c = vec4(a); }}"),
            "a b",
            "`a b` is not a name",
        ),
        (
            format!("{main} {{ float a| = 1.; c = vec4(a); }}"),
            "gl_a",
            "reserved",
        ),
        (
            format!("float f|() {{ return 1.; }}\n{main} {{ c = vec4(f()); }}"),
            "sin",
            "built-in function",
        ),
        (
            "void main|Image(out vec4 c, in vec2 p) { c = vec4(1); }".to_owned(),
            "main",
            "is an error",
        ),
        (
            format!("{main} {{ c = vec4(i|Time); }}"),
            "t",
            "`iTime` is not declared in this shader",
        ),
        (
            format!("{main} {{ c = vec4(q|); }}"),
            "t",
            "nothing in this shader declares it",
        ),
        (
            format!("#define K| 1.\n{main} {{ float t = K; c = vec4(t); }}"),
            "t",
            "`t` is already used",
        ),
        (
            format!(
                "float f|() {{ return 1.; }}\n#if 0\nfloat g() {{ return f(); }}\n#endif\n{main} {{ c = vec4(f()); }}"
            ),
            "h",
            "`f` is also used at a.glsl:3, which is not compiled",
        ),
    ] {
        let mut fixture = Fixture::shader(&text);
        let refused = renamed(&mut fixture, new_name).unwrap_err();
        assert!(refused.contains(reason), "{refused}: {text}");
    }
}

#[test]
fn the_name_that_would_be_renamed_is_shown() {
    let mut fixture = Fixture::shader("void mainImage(out vec4 color, in vec2 p) { colo|r = vec4(1); }");
    let (snapshot, at) = fixture.at_cursor();
    let PrepareRenameResult::PrepareRenamePlaceholder(shown) = prepare(&snapshot, at).unwrap() else {
        panic!("no placeholder")
    };
    assert_eq!(
        (
            &*shown.placeholder,
            shown.range.start.character,
            shown.range.end.character
        ),
        ("color", 44, 49)
    );
}
