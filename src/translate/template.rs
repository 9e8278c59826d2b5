//! Templates of the code around a shader, in the language of its host with two additions: `$name` is replaced
//! by a value, and a line that ends in `//? a b` is only printed if condition `a` or `b` holds; `a&b` holds
//! if both do.

/// The parts of a template before and after the shader.
pub(crate) fn around_shader(template: &str) -> [&str; 2] {
    let parts = template.split_once("$shader\n");
    parts.map_or([template, ""], |(before, after)| [before, after])
}

/// Fills in a part of a template: leaves out the lines none of whose conditions holds, and replaces names by
/// values.
pub(crate) fn fill(template: &str, holds: impl Fn(&str) -> bool, values: &[(&str, String)]) -> String {
    let mut text = String::new();
    for line in template.lines() {
        let line = match line.split_once("//?") {
            Some((_, conditions)) if !any_holds(conditions, &holds) => continue,
            Some((line, _)) => line.trim_end(),
            None => line,
        };
        let replace = |line: String, (name, value): &(&str, String)| line.replace(name, value);
        text += &values.iter().fold(line.to_owned(), replace);
        text.push('\n');
    }
    text
}

fn any_holds(conditions: &str, holds: impl Fn(&str) -> bool) -> bool {
    let mut conditions = conditions.split_whitespace();
    conditions.any(|condition| condition.split('&').all(&holds))
}

/// The channel in the name of a condition.
pub(crate) fn channel_number(condition: &str) -> Option<u8> {
    condition.strip_prefix("channel")?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_there_if_one_of_their_conditions_holds() {
        let part = "a $x\nb //? no\nc($x, $x); //? no yes\n//? yes\nd // ?\ne //? yes&no";
        let filled = fill(part, |name| name == "yes", &[("$x", "1".to_owned())]);
        assert_eq!(filled, "a 1\nc(1, 1);\n\nd // ?\n");
    }
}
