//! The extension for Visual Studio Code has the names of the program: what the grammar colors, and the settings.

use std::fs;
use std::path::Path;

use regex::Regex;
use serde_json::{Value, json};
use toyproof::glsl::Dialect;
use toyproof::glsl::tree::BuiltIn;
use toyproof::image::Input;

fn extension_file(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("editors/vscode")
        .join(name);
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// The alternatives of the rules of a group of the grammar that give a scope.
fn matched(group: &str, scope: &str) -> Regex {
    let grammar = extension_file("syntaxes/glsl.tmLanguage.json");
    let rules = grammar["repository"][group]["patterns"].as_array().unwrap();
    let patterns: Vec<_> = rules
        .iter()
        .filter(|rule| rule["name"] == scope)
        // Rust's regular expressions look nowhere; what follows a name is not part of it.
        .map(|rule| rule["match"].as_str().unwrap().replace(r"(?=\s*\()", ""))
        .collect();
    assert!(!patterns.is_empty(), "{group}: {scope}");
    Regex::new(&format!("^(?:{})$", patterns.join("|"))).unwrap()
}

#[test]
fn the_grammar_knows_each_built_in_function_and_input() {
    let functions = matched("functions", "support.function.builtin.glsl");
    for function in BuiltIn::ALL {
        // `a.length()` is colored as a member.
        assert!(functions.is_match(function.name()), "{}", function.name());
    }
    assert!(!functions.is_match("map"));
    let inputs = matched("inputs", "variable.language.input.glsl");
    let channels = (0..4).map(|index| format!("iChannel{index}"));
    for input in Input::ALL
        .map(|input| input.name().to_owned())
        .into_iter()
        .chain(channels)
    {
        assert!(inputs.is_match(&input), "{input}");
    }
}

#[test]
fn the_extension_offers_each_dialect() {
    let manifest = extension_file("package.json");
    let setting = &manifest["contributes"]["configuration"]["properties"]["toyproof.dialect"];
    let names: Vec<_> = ["auto"]
        .into_iter()
        .chain(Dialect::all().map(Dialect::name))
        .collect();
    assert_eq!(setting["enum"], json!(names));
}
