//! Near-identical shaders: `similar`.

use std::collections::BTreeSet;
use std::fs;

use regex::{Captures, Regex};

use crate::program::toyproof;
use crate::support::{EXERCISES, MANY_OBJECTS};

/// A copy with other names and numbers is found, also one that does not compile.
#[test]
fn copies_are_found_whatever_their_names_and_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let hw = folder.path().join("hw");
    fs::create_dir(&hw).unwrap();
    let original = MANY_OBJECTS.shader;
    let copy = original
        .replace("sphere", "ball")
        .replace("0.5", "0.25")
        .replace("    ", "\t");
    let mandelbrot = "void mainImage(out vec4 c, in vec2 p) {
        vec2 z = vec2(0), k = 3.0 * p / iResolution.xy - 2.0;
        int n = 0;
        for (; n < 50 && dot(z, z) < 4.0; n++) z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + k;
        float level = float(n) / 50.0;
        c = vec4(level, level * level, sqrt(level), 1.0) * smoothstep(0.0, 1.0, length(z) - 0.5 * cos(iTime));
    }";
    for (name, text) in [
        ("a", original.to_owned()),
        ("b", copy.clone()),
        ("c", mandelbrot.to_owned()),
        ("d", "void main() {".to_owned()),
        ("f", copy.replacen(';', "", 1)),
        (
            "e",
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }".to_owned(),
        ),
    ] {
        fs::write(hw.join(name).with_extension("glsl"), text).unwrap();
    }
    let run = toyproof(folder.path(), &["similar", "hw"]);
    let lines: Vec<_> = run.stdout.lines().collect();
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        lines[0].starts_with("100 %  hw/a.glsl:") && lines[1].starts_with("       hw/b.glsl:"),
        "{}",
        run.stdout
    );
    // Which of the others is the most similar to the one that does not compile does not matter.
    let last = "group of 3: hw/a.glsl, hw/b.glsl, hw/f.glsl";
    assert_eq!((lines.len(), lines.last()), (7, Some(&last)), "{}", run.stdout);
    for message in [
        "warning: hw/f.glsl is compared by its text: it does not compile\n",
        "\n3 pairs of 4 shaders share at least 60 % of the smaller one: hw/a.glsl, hw/b.glsl, hw/c.glsl, hw/f.glsl\n",
        "2 shaders have too little of their own to compare: hw/d.glsl, hw/e.glsl\n",
    ] {
        assert!(run.stderr.contains(message), "{}", run.stderr);
    }
    fs::write(folder.path().join("template.glsl"), original).unwrap();
    let except = toyproof(folder.path(), &["similar", "hw", "--except", "template.glsl"]);
    assert_eq!(except.stdout, "");
}

/// Renames everything that a shader declares, except what may be a swizzle.
fn renamed(text: &str) -> String {
    let declared =
        Regex::new(r"\b(?:void|bool|int|uint|float|[biu]?vec[234]|mat[234]|[A-Z]\w+) +(\w+)").unwrap();
    let names: BTreeSet<&str> = declared
        .captures_iter(text)
        .map(|found| found.get(1).unwrap().as_str())
        .collect();
    let is_swizzle =
        |name: &str| name.len() <= 4 && name.chars().all(|letter| "xyzwrgbastpq".contains(letter));
    let word = Regex::new(r"\b[A-Za-z_]\w*\b").unwrap();
    let replaced = word.replace_all(text, |found: &Captures| {
        let name = &found[0];
        match names.iter().position(|known| *known == name) {
            Some(at) if name != "mainImage" && !is_swizzle(name) => format!("name{at}"),
            _ => name.to_owned(),
        }
    });
    replaced.into_owned()
}

/// Changes the decimals of all numbers.
fn with_other_numbers(text: &str) -> String {
    let number = Regex::new(r"\b(\d+)\.\d+\b").unwrap();
    number.replace_all(text, "${1}.375").into_owned()
}

/// Writes each line's words on lines of their own, and removes comments.
fn laid_out_otherwise(text: &str) -> String {
    let comments = Regex::new(r"//[^\n]*").unwrap();
    let text = comments.replace_all(text, "");
    let lines = text.lines().map(|line| {
        if line.trim_start().starts_with('#') {
            format!("{line}\n")
        } else {
            line.replace(' ', "\n") + "\n"
        }
    });
    lines.collect()
}

/// Exchanges neighboring functions of which the second does not call the first.
fn reordered(text: &str) -> String {
    let end = Regex::new(r"(?m)^\}\n").unwrap();
    let mut parts: Vec<String> = Vec::new();
    let mut start = 0;
    for found in end.find_iter(text) {
        parts.push(text[start..found.end()].to_owned());
        start = found.end();
    }
    let head = Regex::new(r"(?m)^\w+ (\w+)\([^;{]*\) *\{").unwrap();
    let name = |part: &str| head.captures(part).map(|found| found[1].to_owned());
    let is_plain = |part: &str| !part.contains('#') && !part.contains("struct ") && !part.contains("const ");
    let mut at = 0;
    while at + 1 < parts.len() {
        let (first, second) = (&parts[at], &parts[at + 1]);
        let calls = name(first).is_none_or(|first| second.contains(&first));
        if !calls
            && name(second).is_some_and(|second| second != "mainImage")
            && is_plain(first)
            && is_plain(second)
        {
            parts.swap(at, at + 1);
            at += 1;
        }
        at += 1;
    }
    parts.concat() + &text[start..]
}

/// Copies of the course: each changed in one way, or in all.
#[test]
fn planted_copies_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let hw = folder.path().join("hw");
    fs::create_dir(&hw).unwrap();
    let changes: [fn(&str) -> String; 5] = [
        renamed,
        with_other_numbers,
        laid_out_otherwise,
        reordered,
        |text| renamed(&with_other_numbers(&laid_out_otherwise(&reordered(text)))),
    ];
    let originals: Vec<_> = EXERCISES
        .iter()
        .filter(|exercise| exercise.shader.len() > 1500)
        .collect();
    for original in &originals {
        fs::write(hw.join(original.name).with_extension("glsl"), original.shader).unwrap();
    }
    let mut planted = Vec::new();
    for (at, change) in (0..20).zip(changes.iter().cycle()) {
        let original = originals[at % originals.len()];
        let copy = change(original.shader);
        assert_ne!(copy, original.shader, "{at}: {}", original.name);
        fs::write(hw.join(format!("copy{at}.glsl")), copy).unwrap();
        planted.push((
            format!("hw/{}.glsl:", original.name),
            format!("hw/copy{at}.glsl:"),
        ));
    }
    let run = toyproof(folder.path(), &["similar", "hw"]);
    assert!(!run.stderr.contains("does not compile"), "{}", run.stderr);
    let lines: Vec<_> = run.stdout.lines().collect();
    let is_found = |(original, copy): &&(String, String)| {
        let mut pairs = lines.windows(2);
        pairs.any(|pair| {
            let [first, second] = [pair[0], pair[1]];
            second.starts_with("       ")
                && (first.contains(original) && second.contains(copy)
                    || first.contains(copy) && second.contains(original))
        })
    };
    let missed: Vec<_> = planted.iter().filter(|pair| !is_found(pair)).collect();
    assert!(missed.is_empty(), "{missed:?}\n{}", run.stdout);
}
