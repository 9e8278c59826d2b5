use std::rc::Rc;

use serde_json::json;

use super::*;
use crate::snapshot::testing::marked;

/// The labels in the order in which an editor shows them, without those of the language itself.
fn labels(text: &str) -> Vec<String> {
    let (snapshot, at) = marked(text);
    let mut items = completion(&snapshot, at).items;
    items.sort_by(|a, b| a.sort_text.cmp(&b.sort_text));
    items.into_iter().map(|item| item.label).collect()
}

fn has(text: &str, label: &str) -> bool {
    labels(text).iter().any(|found| found == label)
}

fn first(text: &str, count: usize) -> String {
    let found = labels(text);
    found[..count.min(found.len())].join(" ")
}

const MAIN: &str = "void mainImage(out vec4 c, in vec2 p) {";

#[test]
fn names_are_those_in_scope_in_order_of_use() {
    let text = format!(
        "const float K = 1.; float g(float x) {{ float hidden; return x; }}\r\n\
         {MAIN} /* 😀 */ float a = 1.; {{ float b; }} float d = |;\r\n float later; }}"
    );
    assert_eq!(first(&text, 2), "a K", "what has the expected type is first");
    let found = labels(&text);
    let at = |label: &str| found.iter().position(|found| found == label);
    // What has the type is in the order of use, and so is the rest behind it.
    let order = ["a", "K", "g", "iTime", "c", "p", "iMouse", "mix"].map(at);
    assert!(order[0].is_some() && order.is_sorted(), "{order:?}");
    for missing in ["hidden", "x", "b", "later"] {
        assert_eq!(at(missing), None, "{missing}");
    }
}

#[test]
fn inner_declarations_hide_outer_ones() {
    let text = format!("float a; {MAIN} vec2 a; |}}");
    let (snapshot, at) = marked(&text);
    let items = completion(&snapshot, at).items;
    let details: Vec<_> = items.iter().filter(|item| item.label == "a").collect();
    assert_eq!(details.len(), 1);
    assert_eq!(details[0].detail.as_deref(), Some("vec2 a"));
}

#[test]
fn members_and_swizzles_follow_the_type() {
    let structure = "struct R { vec3 o; /* far */ float far; };";
    assert_eq!(labels(&format!("{structure} {MAIN} R r; r.|}}")), ["far", "o"]);
    assert_eq!(
        labels(&format!("{structure} {MAIN} R r; c = vec4(r.o.|, 1.); }}"))[..3],
        ["x", "y", "z"]
    );
    assert!(has(&format!("{structure} {MAIN} R r[2]; r[0].o.x|"), "xz"));
    assert!(has(&format!("{MAIN} c = vec4((p + p).|"), "yx"));
    assert!(!has(&format!("{MAIN} p.|"), "z"));
    assert!(has(&format!("{MAIN} vec3(1.).|"), "z"));
    assert_eq!(labels(&format!("{MAIN} float a[3]; a.|")), ["length()"]);
    assert_eq!(labels(&format!("{MAIN} p.x.|")), [""; 0]);
    assert!(has(&format!("#define Q p\r\n{MAIN} Q.|"), "x"));
    assert!(has(&format!("{MAIN} p.\n|\n c = vec4(0); }}"), "x"));
    assert!(has(&format!("{MAIN} c.zyx|"), "zyxw"));
}

#[test]
fn half_typed_text_has_its_names() {
    assert!(has(&format!("{MAIN} vec3 col; col = mi|"), "mix"));
    assert!(has(&format!("{MAIN} vec3 col; col = mix(co|"), "col"));
    assert!(has(&format!("{MAIN} for (int i = 0; i|"), "i"));
    assert!(has(&format!("{MAIN} if (p.x > 1.) ret|"), "return"));
    assert!(has(
        &format!("vec3 f(vec3 q) {{ return q + | }} {MAIN} c = vec4(0); }}"),
        "q"
    ));
}

#[test]
fn channels_come_first_where_a_texture_is_looked_up() {
    let found = first(&format!("{MAIN} c = texture(|, p); }}"), 4);
    assert_eq!(found, "iChannel0 iChannel1 iChannel2 iChannel3");
    assert_eq!(
        first(&format!("{MAIN} vec2 uv; c = texelFetch(|"), 1),
        "iChannel0"
    );
    let function = "float f(vec3 a, float b) { return b; }";
    assert_eq!(first(&format!("{function} {MAIN} float s; vec3 v; f(|"), 1), "v");
    assert_eq!(
        first(&format!("{function} {MAIN} float s; vec3 v; f(v, |)"), 1),
        "s"
    );
}

#[test]
fn declarations_have_types_and_qualifiers() {
    assert!(has("|", "const") && has("|", "vec3") && !has("|", "mix") && !has("|", "for"));
    assert!(has("float f(|", "inout") && !has("float f(|", "return"));
    assert!(has(&format!("{MAIN} |"), "for") && !has(&format!("{MAIN} c = |"), "for"));
    assert_eq!(labels(&format!("{MAIN} vec3 co|")), [""; 0]);
    assert_eq!(labels("struct R { float a; }; R r|"), [""; 0]);
}

#[test]
fn directives_and_their_macros() {
    assert!(has("#|", "define") && has("#if|", "ifdef"));
    assert_eq!(labels("#define AA 2\n#define BB(x) x\n#ifdef |"), ["AA", "BB"]);
    assert_eq!(labels("#define AA 2\n#if A|"), ["AA", "defined"]);
    assert_eq!(
        labels("#define AA 2\n#define AB |").first().map(String::as_str),
        Some("AA")
    );
    assert_eq!(first("#define F(x) x + |", 1), "x");
    assert_eq!(labels("#version |"), [""; 0]);
    assert!(has("#define A\n|", "const"));
}

#[test]
fn comments_and_numbers_have_none() {
    for text in ["// |", "/* a| ", "// 😀 a|", "float a = 1.|", "float a = 0x|1;"] {
        assert_eq!(labels(text), [""; 0], "{text}");
    }
    assert!(!labels("/* a */|").is_empty());
}

#[test]
fn hosts_and_versions_have_their_names() {
    let old = "uniform vec2 u_resolution; void main() { gl_FragColor = te| }";
    assert!(has(old, "texture2D") && !has(old, "iTime"));
    assert!(has(&format!("{MAIN} |"), "iTime") && !has(&format!("{MAIN} |"), "texture2D"));
}

#[test]
fn snippets_need_a_client_that_has_them() {
    let capable = |text: &str| {
        let (snapshot, at) = marked(text);
        let client = json!({"textDocument": {"completion": {"completionItem": {"snippetSupport": true}}}});
        let client = Rc::new(serde_json::from_value(client).unwrap());
        completion(&Snapshot { client, ..snapshot }, at).items
    };
    let items = capable("|");
    let main = items.iter().find(|item| item.label == "mainImage").unwrap();
    assert_eq!(main.insert_text_format, Some(InsertTextFormat::Snippet));
    let (snapshot, at) = marked("|");
    let without = completion(&snapshot, at).items;
    assert!(without.iter().all(|item| item.insert_text_format.is_none()));
    let items = capable(&format!("{MAIN} c = vec4(0); }} |"));
    assert!(
        items.iter().all(|item| item.label != "mainImage"),
        "it is there already"
    );
}
