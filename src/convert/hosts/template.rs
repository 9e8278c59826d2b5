//! Templates: text with sections `// #if NAME` … `// #endif`, which a file has only if its shader needs them.

/// The sections of a template whose names (or, with `!`, whose absence) hold; lines with conditions are left
/// out.
///
/// # Panics
/// If the conditions of the template are not balanced.
pub(super) fn sections(template: &str, has: impl Fn(&str) -> bool) -> String {
    let mut open = Vec::new();
    let mut text = String::new();
    for line in template.split_inclusive('\n') {
        let directive = line.trim();
        if let Some(name) = directive.strip_prefix("// #if ") {
            let holds = match name.strip_prefix('!') {
                Some(name) => !has(name),
                None => has(name),
            };
            open.push(holds);
        } else if directive == "// #endif" {
            open.pop().expect("each `#endif` of a template has an `#if`");
        } else if open.iter().all(|holds| *holds) {
            text += line;
        }
    }
    assert!(open.is_empty(), "each `#if` of a template has an `#endif`");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_nest_and_may_be_negated() {
        let template = "a\n// #if x\nb\n  // #if y\nc\n  // #endif\n// #endif\n// #if !x\nd\n// #endif\n";
        assert_eq!(sections(template, |name| name == "x"), "a\nb\n");
        assert_eq!(sections(template, |_| true), "a\nb\nc\n");
        assert_eq!(sections(template, |name| name == "y"), "a\nd\n");
    }
}
