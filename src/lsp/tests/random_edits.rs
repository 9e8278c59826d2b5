//! Random edits of valid shaders: after each, the diagnostics are those of a fresh analysis, and no feature
//! panics at a random place.

use std::env;
use std::path::Path;

use lsp_types::{Position, Range, TextDocumentContentChangeEvent, TextDocumentContentChangePartial, Uri};
use toyproof_glsl::{Stage, check};

use crate::code_actions::code_actions;
use crate::every_feature::{read_at, read_document};
use crate::formatting::format;
use crate::location::uri_of;
use crate::navigation::{definition, highlights, references};
use crate::rename::{prepare, rename};
use crate::workspace::Workspace;

/// The number of edits, unless the environment variable `TOYPROOF_EDITS` says another one.
const EDITS: usize = 400;

/// A generator of random numbers (xorshift64*, Marsaglia 2003).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let high = self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33;
        high as usize % limit.max(1)
    }
}

/// Pieces of text that authors type, and such that break a text.
const PIECES: [&str; 28] = [
    ".",
    ";",
    "(",
    ")",
    "{",
    "}",
    "[",
    "]",
    ",",
    "+",
    "=",
    "\"",
    "\n",
    "\r\n",
    " ",
    "/*",
    "*/",
    "//",
    "#define A(x) x.",
    "#if 0\n",
    "#endif\n",
    "vec3 col = ",
    "iTime",
    "p.",
    "mainImage",
    "😀",
    "\u{fe0f}",
    "struct S {",
];

fn courses() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../glsl");
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "glsl"));
    paths.sort();
    paths
        .iter()
        .map(|path| std::fs::read_to_string(path).unwrap())
        .collect()
}

/// A project whose tabs share functions, structures and macros.
const TABS: [(&str, &str); 3] = [
    (
        "common.glsl",
        "#define SQ(x) ((x) * (x))\nstruct Ray { vec3 o, d; };\nfloat hit(Ray r) { return SQ(r.o.x) + dot(r.d, r.d); }\n",
    ),
    (
        "image.glsl",
        "void mainImage(out vec4 c, in vec2 p) {\n    Ray r = Ray(vec3(0), vec3(p, 1.));\n    float t = hit(r);\n    c = texture(iChannel0, p / iResolution.xy) * SQ(t);\n}\n",
    ),
    (
        "buffer-a.glsl",
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(hit(Ray(vec3(p, 0), vec3(1)))); }\n",
    ),
];

#[test]
fn random_edits_keep_the_diagnostics_of_a_fresh_analysis() {
    let number = |name: &str| env::var(name).ok().and_then(|text| text.parse().ok());
    let edits = number("TOYPROOF_EDITS").unwrap_or(EDITS);
    let seed = number("TOYPROOF_SEED").unwrap_or(1);
    let mut random = Random(0x9e37_79b9_7f4a_7c15 ^ (seed as u64).wrapping_mul(0x0100_0000_01b3));
    let shaders = courses();
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in TABS {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let mut workspace = Workspace::default();
    let mut documents = Vec::new();
    for edit in 0..edits {
        // A few edits of one text, so that it is seldom only broken.
        if edit % 8 == 0 {
            workspace = Workspace::default();
            documents = if random.below(4) == 0 {
                let tabs =
                    TABS.map(|(name, text)| (uri_of(&folder.path().join(name)).unwrap(), text.to_owned()));
                tabs.to_vec()
            } else {
                let text = shaders[random.below(shaders.len())].clone();
                vec![(Uri("untitled:a.glsl".to_owned()), text)]
            };
            for (uri, text) in &documents {
                workspace.open(uri, "glsl", 0, text.clone());
            }
        }
        let uri = documents[random.below(documents.len())].0.clone();
        let change = random_change(&workspace, &uri, &mut random);
        assert!(workspace.change(&uri, edit as i32 + 1, vec![change]));
        let snapshot = workspace.snapshot(&uri).unwrap();
        let mut fresh = Workspace::default();
        for (uri, _) in &documents {
            let text = workspace.document(uri).unwrap().text.text().to_owned();
            fresh.open(uri, "glsl", 1, text);
        }
        let fresh = fresh.snapshot(&uri).unwrap();
        let place = format!("seed {seed}, edit {edit}");
        assert_eq!(snapshot.unit.diagnostics, fresh.unit.diagnostics, "{place}");
        // What the editor shows is what a check reports.
        if snapshot.options().stage != Stage::Common {
            match check(fresh.files(), fresh.analyzed(), fresh.options()) {
                Ok(_) => assert!(snapshot.analysis().checked().is_some(), "{place}"),
                Err(errors) => assert_eq!(Vec::from(errors), snapshot.analysis().diagnostics, "{place}"),
            }
        }
        read_document(&snapshot);
        let byte = random.below(snapshot.file().text().len() + 1) as u32;
        read_at(&snapshot, byte);
        let range = snapshot.document_range(byte, byte);
        let at = snapshot
            .byte(range.start)
            .expect("the compiler sees all of these texts");
        let _ = definition(&snapshot, at);
        let _ = references(&mut workspace, &snapshot, at, true);
        let _ = highlights(&mut workspace, &snapshot, at);
        let _ = code_actions(&mut workspace, &snapshot, range, &[], None);
        let _ = format(&snapshot, None);
        if prepare(&snapshot, at).is_ok() {
            let _ = rename(&mut workspace, &snapshot, at, "renamed");
        }
    }
}

fn random_change(workspace: &Workspace, uri: &Uri, random: &mut Random) -> TextDocumentContentChangeEvent {
    let file = &workspace.document(uri).unwrap().text;
    let length = file.text().len();
    let start = random.below(length + 1);
    // Most edits are short; some delete lines, and some positions are outside of the text.
    let removed = match random.below(4) {
        0 => 0,
        1 => random.below(200),
        _ => random.below(4),
    };
    let position = |byte: usize| workspace.encoding.position(file, byte as u32);
    let mut end = position(start + removed);
    if random.below(16) == 0 {
        end = Position::new(end.line, u32::MAX);
    }
    let text = match random.below(3) {
        0 => String::new(),
        1 => PIECES[random.below(PIECES.len())].to_owned(),
        _ => file
            .text()
            .get(start / 2..start / 2 + random.below(40))
            .unwrap_or(".")
            .to_owned(),
    };
    let range = Range::new(position(start), end);
    TextDocumentContentChangePartial::new(range, None, text).into()
}
