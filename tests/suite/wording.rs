//! User-facing text keeps to the vocabulary of docs/glossary.md: retired words do not come back.

use std::fs;
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use regex::RegexSet;

use crate::architecture::sources;
use crate::program::toyproof;

/// Retired words and phrases, each as a regular expression for whole words, and the term that replaces it.
const RETIRED: [(&str, &str); 41] = [
    ("paint(s|ed|er|ing)?", "render"),
    ("pictures?", "image"),
    ("told|tells?", "report, check"),
    (
        r"maths(_\w+)?|mathematics|rounding_\w+|\w+_undecided",
        "algorithm",
    ),
    ("rounding (check|question|errors? decides?)", "precision"),
    ("the (three )?questions?", "checks"),
    ("undecided", "ill-conditioned"),
    ("(even )?in exact arithmetic", "in double precision"),
    ("by a hair", "ill-conditioned"),
    ("hangs? (on|by)", "depends on"),
    ("truth", "reference"),
    ("rungs?", "exercise"),
    ("spelled|spelt|spells", "expanded, written"),
    ("other trouble", "an error that is not a shader's"),
    ("tak(e|es|en|ing) over what", "reuse"),
    ("take warnings for", "treat warnings as"),
    ("words of an? ", "a substring of"),
    ("in (its|their|naga's|whose) words", "message"),
    ("is none", "is not a"),
    ("that is none", "malformed"),
    ("(it|this|that|which|`) is no [a-z]+", "is not a"),
    ("comes to call", "recursive call"),
    (
        "on some way|may have gone another way",
        "on some path, in non-uniform control flow",
    ),
    ("be it", "whether"),
    ("all the same", "anyway"),
    ("does without|do without", "needs no"),
    ("nobody", "no one is needed in a message"),
    (
        "time is up|calls written out|rounds of loops",
        "time limit exceeded, inlined, iterations",
    ),
    ("colou?rs? of another|another colou?r", "differs"),
    ("colour(s|ed|ful|ing|less)?", "color"),
    ("cent(red|res?|ring)", "center"),
    ("neighbour(s|ing|hood)?", "neighbor"),
    ("behaviours?", "behavior"),
    ("grey", "gray"),
    ("(un)?normali[s]e(d|s)?|normali[s]ation", "normalize"),
    (
        "that draws?|it draws|draws? (others|random)",
        "stochastic, sample",
    ),
    (
        "meets? (a|the|its|their|an) (surface|sphere|plane)",
        "hits, intersects",
    ),
    ("fed to|is fed", "given to, read by"),
    ("every way to|ways to an? image", "configuration"),
    ("not asked|is asked", "not run"),
    ("judged|judges", "checked"),
];

/// Text that has a retired word for a reason: the end of its path, and a part of the text.
const ALLOWED: [(&str, &str); 5] = [
    // The British forms of keys, which scene files accept, and of students' parameters.
    ("scene/file", "colour"),
    ("scene/file", "centre"),
    ("stress/function/role", "centre"),
    // The name of a medium of ShaderToy.
    ("project/media", "Grey Noise3D"),
    // The British form in names of files.
    ("media/folder", "grey"),
];

fn patterns() -> RegexSet {
    let words = RETIRED.iter().map(|(words, _)| format!(r"(?i)\b(?:{words})\b"));
    RegexSet::new(words).unwrap()
}

/// Returns a line for each retired word in a text.
fn retired(patterns: &RegexSet, place: &str, text: &str) -> Vec<String> {
    let is_allowed = |line: &str| {
        let mut allowed = ALLOWED.iter();
        allowed.any(|(path, part)| place.contains(path) && line.contains(part))
    };
    let mut found = Vec::new();
    for line in text.lines().filter(|line| !is_allowed(line)) {
        for index in patterns.matches(line) {
            let (words, term) = RETIRED[index];
            found.push(format!("{place}: `{words}` (write: {term}): {}", line.trim()));
        }
    }
    found
}

/// Collects the text of string literals, except in attributes, such as doc comments, and in tests.
fn literals(tokens: TokenStream, texts: &mut Vec<String>) {
    let mut tokens = tokens.into_iter().peekable();
    let mut is_test = false;
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Punct(punct) if punct.as_char() == '#' => {
                let inner = tokens.next_if(|next| matches!(next, TokenTree::Punct(_)));
                if let Some(TokenTree::Group(attribute)) = tokens.next() {
                    let text = attribute.stream().to_string();
                    is_test |= inner.is_none() && (text.starts_with("cfg (test") || text == "test");
                }
            }
            TokenTree::Group(group) if !std::mem::take(&mut is_test) => {
                literals(group.stream(), texts);
            }
            TokenTree::Literal(literal) => {
                let text = literal.to_string();
                if text.starts_with(['"', 'r']) {
                    texts.push(text.replace("\\n", "\n"));
                }
            }
            TokenTree::Punct(punct) if punct.as_char() == ';' => is_test = false,
            _ => {}
        }
    }
}

/// Lists the files below a folder with one of these extensions.
fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let extension = path.extension().and_then(|extension| extension.to_str());
        if path.is_dir() {
            found.extend(files(&path, extensions));
        } else if extension.is_some_and(|extension| extensions.contains(&extension)) {
            found.push(path);
        }
    }
    found
}

fn report(found: &[String]) {
    assert!(
        found.is_empty(),
        "{} retired words:\n{}",
        found.len(),
        found.join("\n")
    );
}

#[test]
fn messages_have_no_retired_words() {
    let patterns = patterns();
    let mut found = Vec::new();
    let mut count = 0;
    for path in sources(Path::new("src")) {
        let name = path.display().to_string();
        let is_test = path.components().any(|part| part.as_os_str() == "tests") || name.ends_with("tests.rs");
        if is_test {
            continue;
        }
        let tokens: TokenStream = fs::read_to_string(&path).unwrap().parse().unwrap();
        let mut texts = Vec::new();
        literals(tokens, &mut texts);
        count += texts.len();
        for text in texts {
            found.extend(retired(&patterns, &name, &text));
        }
    }
    assert!(count > 2000, "{count} literals");
    report(&found);
}

#[test]
fn documents_pages_and_shaders_have_no_retired_words() {
    let patterns = patterns();
    let mut paths = files(Path::new("docs"), &["md"]);
    paths.extend(files(Path::new("glsl"), &["glsl", "toml"]));
    paths.extend(files(Path::new("src"), &["html", "css", "js", "wgsl", "json"]));
    paths.extend(files(Path::new("examples"), &["html"]));
    paths.extend(files(Path::new("tests/ui"), &["stderr"]));
    paths.extend(["README.md", "CONTRIBUTING.md", "setup.sh", "Makefile"].map(PathBuf::from));
    let mut found = Vec::new();
    for path in paths {
        let name = path.display().to_string();
        // The glossary lists the retired words.
        if !name.ends_with("glossary.md") {
            found.extend(retired(&patterns, &name, &fs::read_to_string(&path).unwrap()));
        }
    }
    report(&found);
}

#[test]
fn help_has_no_retired_words() {
    let patterns = patterns();
    let mut found = Vec::new();
    for name in crate::commands::COMMANDS {
        for flag in ["-h", "--help"] {
            let help = toyproof(Path::new("."), &[name, flag]).stdout;
            assert!(help.contains("Usage: toyproof"), "{name}: {help}");
            found.extend(retired(&patterns, &format!("{name} {flag}"), &help));
        }
    }
    report(&found);
}

#[test]
fn a_retired_word_is_found() {
    let patterns = patterns();
    let found = |text: &str| retired(&patterns, "a.rs", text).len();
    assert_eq!(found("the pixel is rendered in the image's center"), 0);
    assert_eq!(found("it Paints a picture"), 2);
    let mut texts = Vec::new();
    let code =
        "/// paints\nfn a() { b(\"told\\npaint\"); }\n#[cfg(test)]\nmod tests { const A: &str = \"maths\"; }";
    literals(code.parse().unwrap(), &mut texts);
    assert_eq!(texts, ["\"told\npaint\""]);
}
