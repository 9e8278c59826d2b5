//! Breaks long lines of written code: after `,` and `;`, and before binary operators, outside of as many
//! brackets as possible.
//!
//! It works on text, whose length depends on the language: names and types differ. Lines are broken at spaces
//! only, so tokens stay. Writers put spaces around binary operators, but not around the `<` and `>` of types.

/// Maximum number of columns of a line.
const MAX_COLUMNS: usize = 100;

/// Columns of a level of indentation.
const LEVEL: usize = 4;

/// Minimum number of columns that are used of a line, however far it is indented.
const MIN_WIDTH: usize = 40;

/// Maximum number of brackets that indent a continuation further.
const MAX_INDENTING: usize = 4;

/// A place where a line may be broken.
struct Break {
    /// The byte after which the next line begins.
    at: usize,
    /// The number of brackets around it.
    depth: usize,
    /// How early the operator is applied: lines are better broken at operators that are applied late.
    precedence: usize,
}

/// Breaks the lines of a text that are too long. A continuation is indented by `levels` more.
pub(crate) fn wrap(text: &str, levels: usize) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        let code = line.trim_start();
        let is_code = !code.starts_with("//") && !code.starts_with('#');
        if is_code && line.chars().count() > MAX_COLUMNS {
            let indent = line.len() - code.len();
            // A comment behind such a line would be behind its last part.
            let (code, comment) = code.split_at(code.find("//").unwrap_or(code.len()));
            if !comment.is_empty() {
                push_line(&mut out, indent, comment);
            }
            wrap_code(&mut out, indent, code.trim_end(), levels);
        } else {
            push_line(&mut out, 0, line);
        }
    }
    out
}

fn push_line(out: &mut String, indent: usize, line: &str) {
    out.extend(std::iter::repeat_n(' ', indent));
    out.push_str(line);
    out.push('\n');
}

fn wrap_code(out: &mut String, indent: usize, code: &str, levels: usize) {
    // What a head continues with does not look like the block behind it.
    let levels = levels + usize::from(code.ends_with('{'));
    let breaks = breaks(code);
    let (mut begin, mut margin, mut next) = (0, indent, 0);
    loop {
        let width = MAX_COLUMNS.saturating_sub(margin).max(MIN_WIDTH);
        if code.len() - begin <= width {
            push_line(out, margin, &code[begin..]);
            return;
        }
        let fitting = breaks[next..].partition_point(|place| code[begin..place.at].trim_end().len() <= width);
        let fitting = &breaks[next..next + fitting];
        // A short first part is only made if there is no other.
        let short = fitting.partition_point(|place| place.at - begin < width / 3);
        let better = fitting[short..]
            .iter()
            .enumerate()
            .map(|(number, place)| (short + number, place));
        let chosen = better
            .min_by_key(|&(number, place)| (place.depth, place.precedence, usize::MAX - number))
            .map_or(short.saturating_sub(1), |(number, _)| number);
        let Some(place) = breaks.get(next + chosen) else {
            push_line(out, margin, &code[begin..]);
            return;
        };
        push_line(out, margin, code[begin..place.at].trim_end());
        begin = place.at;
        margin = indent + LEVEL * (levels - 1 + place.depth.clamp(1, MAX_INDENTING));
        next += chosen + 1;
    }
}

/// The places where code may be broken, in order.
fn breaks(code: &str) -> Vec<Break> {
    let mut breaks = Vec::new();
    let (mut depth, mut angles) = (0_usize, 0_usize);
    let bytes = code.as_bytes();
    for (at, &byte) in bytes.iter().enumerate() {
        let follows_space = at == 0 || bytes[at - 1] == b' ';
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            b'<' if !follows_space && bytes[at - 1] != b'<' => angles += 1,
            b'>' if !follows_space => angles = angles.saturating_sub(1),
            b' ' => {
                let rest = &code[at + 1..];
                let operator = &rest[..rest.find(' ').unwrap_or(rest.len())];
                let precedence = match bytes[..at].last() {
                    Some(b',' | b';') => Some(0),
                    _ => precedence(operator).filter(|_| operator.len() < rest.len()),
                };
                if let Some(precedence) = precedence.filter(|_| angles == 0) {
                    breaks.push(Break {
                        at: at + 1,
                        depth,
                        precedence,
                    });
                }
            }
            _ => {}
        }
    }
    breaks
}

/// How early a binary operator is applied; `None` for what is none, and for assignments.
fn precedence(operator: &str) -> Option<usize> {
    const LEVELS: [&[&str]; 11] = [
        &["?", ":"],
        &["||"],
        &["^^"],
        &["&&"],
        &["|"],
        &["^"],
        &["&"],
        &["==", "!=", "<", ">", "<=", ">="],
        &["<<", ">>"],
        &["+", "-"],
        &["*", "/", "%"],
    ];
    let level = LEVELS.iter().position(|operators| operators.contains(&operator));
    level.map(|level| level + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A call with that many arguments of 10 columns.
    fn call(name: &str, count: usize) -> String {
        format!("{name}({})", vec!["argument_1"; count].join(", "))
    }

    fn assert_wrapped(code: &str, expected: &[&str]) {
        let wrapped = wrap(code, 1);
        assert_eq!(wrapped.lines().collect::<Vec<_>>(), expected);
        let without_blanks = |text: &str| text.replace([' ', '\n'], "");
        assert_eq!(without_blanks(&wrapped), without_blanks(code));
    }

    #[test]
    fn short_lines_comments_and_directives_stay() {
        let long = "a + ".repeat(40);
        for line in [
            "x = a + b; // why".to_owned(),
            format!("    // {long}"),
            format!("  #define A {long}"),
        ] {
            assert_wrapped(&line, &[&line]);
        }
    }

    #[test]
    fn lines_are_broken_outside_of_brackets() {
        let [two, four] = [2, 4].map(|count| call("call", count));
        assert_wrapped(
            &format!("    float x = {two} * {two} + {two} * {two};"),
            &[
                &format!("    float x = {two} * {two}"),
                &format!("        + {two} * {two};"),
            ],
        );
        assert_wrapped(
            &format!("    float x = x ? {four} + y : {four};"),
            &[
                &format!("    float x = x ? {four} + y"),
                &format!("        : {four};"),
            ],
        );
    }

    #[test]
    fn lists_are_filled_and_continue_further_inside() {
        let eight = call("vec", 8);
        assert_wrapped(
            &format!("x = f(1.0, {eight}, y);"),
            &[
                "x = f(1.0, vec(argument_1, argument_1, argument_1, argument_1, argument_1, argument_1, argument_1,",
                "        argument_1), y);",
            ],
        );
    }

    #[test]
    fn heads_continue_further_than_their_blocks() {
        let ten = ["float argument"; 8].join(", ");
        assert_wrapped(
            &format!("void f({ten}) {{"),
            &[
                "void f(float argument, float argument, float argument, float argument, float argument,",
                "        float argument, float argument, float argument) {",
            ],
        );
    }

    #[test]
    fn types_are_not_broken() {
        let values = ["array<vec2<bool>, 3>(true)"; 4].join(", ");
        assert_wrapped(
            &format!("let x = array<array<vec2<bool>, 3>, 4>({values});"),
            &[
                "let x = array<array<vec2<bool>, 3>, 4>(array<vec2<bool>, 3>(true), array<vec2<bool>, 3>(true),",
                "    array<vec2<bool>, 3>(true), array<vec2<bool>, 3>(true));",
            ],
        );
    }

    #[test]
    fn comments_of_long_lines_precede_them() {
        let code = "a + ".repeat(25);
        assert_eq!(
            wrap(&format!("  x = {code}b; // c"), 2),
            format!("  // c\n  x = {}a\n          + a + b;\n", &code[..92])
        );
        assert_eq!(
            wrap(&format!("  x = y; // {code}"), 2),
            format!("  // {code}\n  x = y;\n")
        );
    }

    #[test]
    fn what_cannot_be_broken_stays() {
        let name = "x".repeat(120);
        assert_wrapped(&format!("{name} = {name};"), &[&format!("{name} = {name};")]);
        assert_wrapped(
            &format!("{name} = {name} + y;"),
            &[&format!("{name} = {name}"), "    + y;"],
        );
    }
}
