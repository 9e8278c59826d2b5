//! The text of a function's body.

use std::ops::Range;

/// The byte range of the body of the function whose name is at a byte of the text, including its braces.
pub(crate) fn body(text: &str, name_at: usize) -> Option<Range<usize>> {
    let (mut depth, mut begin) = (0usize, None);
    let mut rest = text.get(name_at..)?.char_indices();
    while let Some((at, letter)) = rest.next() {
        let after = &text[name_at + at..];
        let comment = ["//", "/*"].into_iter().zip(["\n", "*/"]);
        if let Some((_, end)) = comment.into_iter().find(|(begin, _)| after.starts_with(begin)) {
            let length = after[2..].find(end)? + 2 + end.len();
            let next = name_at + at + length;
            while rest.clone().next().is_some_and(|(at, _)| name_at + at < next) {
                rest.next();
            }
            continue;
        }
        match letter {
            '{' => {
                begin.get_or_insert(name_at + at);
                depth += 1;
            }
            '}' => {
                depth = depth.checked_sub(1)?;
                if depth == 0 {
                    return Some(begin?..name_at + at + 1);
                }
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn body_ends_at_its_closing_brace() {
        let text = "float f(float x) { // }\n if (x > 0.) { return 1.; } /* } */ return 2.; }\nfloat g;";
        let body = body(text, 6).unwrap();
        assert!(text[body.clone()].starts_with("{ // }"));
        assert!(text[body].ends_with("return 2.; }"));
    }
}
