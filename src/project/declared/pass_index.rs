//! What a pass of ISF executes of the text that all passes share: branches of `if (PASSINDEX == 2)` that it
//! does not take are left out. Other conditions are not decided.

use std::cmp::Ordering;

/// The maximum number of nested `if` without braces; the branches of more are not left out.
const MAX_OPEN_IFS: usize = 256;

/// Whether a text contains a name as a whole word.
pub(super) fn has_word(text: &str, word: &str) -> bool {
    let mut words = text.split(|character| !is_in_name(character));
    words.any(|other| other == word)
}

fn is_in_name(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '_'
}

/// The tokens that the pass with this index may execute, separated by spaces; without comments.
pub(super) fn live_text(text: &str, index: i64) -> String {
    let tokens = Tokens::new(text);
    let mut live = vec![true; tokens.words.len()];
    for at in 0..live.len() {
        if live[at]
            && let Some(dead) = tokens.dead_branch(at, index)
        {
            live[dead].fill(false);
        }
    }
    let words = tokens.words.iter().zip(live);
    let words = words.filter_map(|(word, is_live)| is_live.then_some(*word));
    words.collect::<Vec<_>>().join(" ")
}

/// Tokens, and the ends of what is in parentheses and braces.
struct Tokens<'t> {
    words: Vec<&'t str>,
    /// For each `(` and `{`, the index behind the token that closes it, if there is one.
    ends: Vec<Option<usize>>,
}

impl<'t> Tokens<'t> {
    fn new(text: &'t str) -> Self {
        let words = words(text);
        let mut ends = vec![None; words.len()];
        let mut open = Vec::new();
        for (at, word) in words.iter().enumerate() {
            match *word {
                "(" | "{" => open.push(at),
                ")" | "}" => {
                    if let Some(start) = open.pop() {
                        ends[start] = Some(at + 1);
                    }
                }
                _ => {}
            }
        }
        Self { words, ends }
    }

    fn get(&self, at: usize) -> &'t str {
        self.words.get(at).copied().unwrap_or_default()
    }

    /// The branch that is not taken of an `if` at this token.
    fn dead_branch(&self, at: usize, index: i64) -> Option<std::ops::Range<usize>> {
        let is_directive = at > 0 && self.get(at - 1) == "#";
        if self.get(at) != "if" || is_directive || self.get(at + 1) != "(" {
            return None;
        }
        let then = self.ends[at + 1]?;
        let is_taken = any(&self.words[at + 2..then - 1], index)?;
        let end = self.statement_end(then)?;
        if !is_taken {
            return Some(then..end);
        }
        (self.get(end) == "else").then_some(end + 1..self.statement_end(end + 1)?)
    }

    /// The index behind the statement that starts at this token.
    fn statement_end(&self, mut at: usize) -> Option<usize> {
        // The number of `if` that may still have an `else`.
        let mut open_ifs = 0;
        loop {
            match self.get(at) {
                "if" if open_ifs == MAX_OPEN_IFS => return None,
                "if" | "for" | "while" => {
                    open_ifs += usize::from(self.get(at) == "if");
                    at = *self.ends.get(at + 1)?.as_ref()?;
                    continue;
                }
                "{" => at = self.ends[at]?,
                "" | "}" | "do" | "switch" | "#" => return None,
                _ => {
                    while self.get(at) != ";" {
                        at = match self.get(at) {
                            "" | "}" | "#" => return None,
                            "(" | "{" => self.ends[at]?,
                            _ => at + 1,
                        };
                    }
                    at += 1;
                }
            }
            if open_ifs == 0 || self.get(at) != "else" {
                return Some(at);
            }
            open_ifs -= 1;
            at += 1;
        }
    }
}

/// Names, numbers and operators; of a comment nothing.
fn words(mut text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    loop {
        text = text.trim_start();
        let length = if let Some(comment) = text.strip_prefix("//") {
            text = comment.split_once('\n').map_or("", |(_, rest)| rest);
            continue;
        } else if let Some(comment) = text.strip_prefix("/*") {
            text = comment.split_once("*/").map_or("", |(_, rest)| rest);
            continue;
        } else if ["==", "!=", "<=", ">=", "&&", "||"]
            .iter()
            .any(|operator| text.starts_with(operator))
        {
            2
        } else {
            let name = text
                .find(|character| !is_in_name(character))
                .unwrap_or(text.len());
            let Some(first) = text.chars().next() else {
                return words;
            };
            name.max(first.len_utf8())
        };
        let (word, rest) = text.split_at(length);
        words.push(word);
        text = rest;
    }
}

/// The value of a condition, if `PASSINDEX` decides it.
fn any(condition: &[&str], index: i64) -> Option<bool> {
    let mut is_known = true;
    for part in split(condition, "||") {
        match all(part, index) {
            Some(true) => return Some(true),
            Some(false) => {}
            None => is_known = false,
        }
    }
    is_known.then_some(false)
}

/// The value of a condition without `||` outside of parentheses.
fn all(condition: &[&str], index: i64) -> Option<bool> {
    let mut is_known = true;
    for part in split(condition, "&&") {
        match comparison(part, index) {
            Some(false) => return Some(false),
            Some(true) => {}
            None => is_known = false,
        }
    }
    is_known.then_some(true)
}

/// Splits a condition at an operator outside of parentheses.
fn split<'w, 't>(words: &'w [&'t str], operator: &'static str) -> impl Iterator<Item = &'w [&'t str]> {
    let mut depth = 0_i32;
    words.split(move |word| {
        depth += i32::from(*word == "(") - i32::from(*word == ")");
        depth == 0 && *word == operator
    })
}

/// The value of a comparison of `PASSINDEX` with a number.
fn comparison(mut words: &[&str], index: i64) -> Option<bool> {
    while let ["(", inside @ .., ")"] = words {
        words = inside;
    }
    let side = |word: &str| match word {
        "PASSINDEX" => Some(index),
        _ => word.parse().ok(),
    };
    let [left, operator, right] = words else {
        return None;
    };
    let order: Ordering = side(left)?.cmp(&side(right)?);
    Some(match *operator {
        "==" => order.is_eq(),
        "!=" => order.is_ne(),
        "<" => order.is_lt(),
        "<=" => order.is_le(),
        ">" => order.is_gt(),
        ">=" => order.is_ge(),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The letters of the statements `a;`, `b;` and so on that a pass may execute.
    fn live(text: &str, index: i64) -> String {
        let is_letter =
            |word: &&str| word.len() == 1 && word.chars().all(|letter| letter.is_ascii_lowercase());
        live_text(text, index).split(' ').filter(is_letter).collect()
    }

    #[test]
    fn branches_that_a_pass_does_not_take_are_left_out() {
        let chain = "a; if (PASSINDEX == 0) { b; if (x > PASSINDEX) c; } else if (PASSINDEX==1) d;
            else if (PASSINDEX <= 2) { if (2 == PASSINDEX) e; else f; } else g; h;";
        assert_eq!(
            [0, 1, 2, 3].map(|index| live(chain, index)),
            ["abxch", "adh", "aeh", "agh"]
        );
        // A condition that is partly known.
        let partly = "if ((PASSINDEX == 0) || (PASSINDEX == 2)) a; if (PASSINDEX != 1 && y) b; else c;
            if (PASSINDEX == 1 || y) d; else e;";
        assert_eq!([0, 1].map(|index| live(partly, index)), ["aybcyde", "ycyd"]);
        // Statements without braces.
        let nested = "if (PASSINDEX == 0) if (y) a; else for (;;) if (z) b; else c; else d; f;";
        assert_eq!([0, 1].map(|index| live(nested, index)), ["yazbcf", "df"]);
    }

    #[test]
    fn what_is_not_understood_stays() {
        for text in [
            "if (PASSINDEX == 0) do a; while (y);",
            "#if (PASSINDEX == 0)\na;\n#endif",
            "if (PASSINDEX == 0) { a;",
            "if (PASSINDEX == 0) a",
            "if (PASSINDEX == ZERO) a;",
            "if ((PASSINDEX == 0 || y) && z) a;",
            "if (PASSINDEX",
            "switch (PASSINDEX) { case 0: a; }",
        ] {
            assert_eq!(live_text(text, 1), words(text).join(" "), "{text}");
        }
        let comments =
            "// if (PASSINDEX == 0)\na; /* if (PASSINDEX == 0) */ b; if /**/ (PASSINDEX == /* 1 */ 0) c;";
        assert_eq!(live(comments, 1), "ab");
        // Neither depth nor length takes long.
        let deep = "if (PASSINDEX == 1) ".repeat(40_000) + "a;";
        assert_eq!([0, 1].map(|index| live(&deep, index)), ["", "a"]);
    }

    #[test]
    fn names_are_whole_words() {
        assert!(has_word("IMG_PIXEL(blurA, p)", "blurA"));
        assert!(!has_word("IMG_PIXEL(blurA, p)", "blur"));
    }
}
