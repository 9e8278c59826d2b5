//! Messages of tools, up to what depends on the shader.

/// A message with names in quotes and numbers replaced by `_`, so that messages about shaders with other
/// names and lines are equal. Only the first line counts: others show the source.
///
/// ```
/// use toyproof_reduce::fault::pattern;
///
/// assert_eq!(pattern("Unknown variable: 'foo' at 12:3\n  foo = 1"), "Unknown variable: _ at _:_");
/// assert_eq!(pattern("Expression [17] is invalid"), pattern("Expression [2] is invalid"));
/// ```
pub fn pattern(message: &str) -> String {
    let line = message
        .lines()
        .find(|line| !line.trim().is_empty())
        .unwrap_or_default();
    let mut out = String::new();
    let mut rest = line.trim();
    while let Some(first) = rest.chars().next() {
        let quoted = matches!(first, '`' | '\'' | '"')
            .then(|| rest[1..].find(first).map(|end| end + 2))
            .flatten();
        let number = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        let is_part_of_word = out.ends_with(|c: char| c.is_ascii_alphabetic());
        match quoted {
            Some(end) => {
                out.push('_');
                rest = &rest[end..];
            }
            None if number > 0 && !is_part_of_word => {
                out.push('_');
                rest = &rest[number..];
            }
            None => {
                out.push(first);
                rest = &rest[first.len_utf8()..];
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_keep_their_numbers() {
        assert_eq!(pattern("no vec3 for `a`, 3 times"), "no vec3 for _, _ times");
        assert_eq!(pattern("an 'open quote"), "an 'open quote");
        assert_eq!(pattern(""), "");
    }
}
