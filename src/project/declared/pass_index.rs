//! What a pass of ISF executes of the text that all passes share: branches of `if (PASSINDEX == 2)` that it
//! does not take are left out. Other conditions are not decided.

use std::cell::Cell;
use std::cmp::Ordering;
use std::collections::HashSet;
use std::ops::Range;

/// The maximum number of nested `if` without braces; the branches of more are not left out.
const MAX_OPEN_IFS: usize = 256;

/// The maximum number of tokens of a condition that is decided.
const MAX_CONDITION: usize = 64;

/// The steps that are made for each token to find the ends of statements. After more, no branch is left out.
const STEPS_PER_TOKEN: usize = 64;

fn is_in_name(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '_'
}

/// The tokens of a text, and the ends of what is in parentheses and braces.
pub(super) struct Tokens<'t> {
    /// Names, numbers and operators, and [`LINE_END`] behind each directive.
    words: Vec<&'t str>,
    /// For each `(` and `{`, the index behind the token that closes it, if there is one.
    ends: Vec<Option<usize>>,
    /// The number of directives before each token.
    directives: Vec<usize>,
    steps_left: Cell<usize>,
}

/// The token at the end of a directive.
const LINE_END: &str = "\n";

impl<'t> Tokens<'t> {
    /// Reads a text.
    pub(super) fn new(text: &'t str) -> Self {
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
        let directives = words.iter().scan(0, |count, word| {
            let before = *count;
            *count += usize::from(*word == "#");
            Some(before)
        });
        Self {
            directives: directives.collect(),
            ends,
            steps_left: Cell::new(STEPS_PER_TOKEN * words.len()),
            words,
        }
    }

    /// The names, except those of members and components.
    pub(super) fn names(&self) -> HashSet<&'t str> {
        self.names_at(|_| true)
    }

    /// The names in what the pass with this index may execute.
    pub(super) fn live_names(&self, index: i64) -> HashSet<&'t str> {
        let live = self.live(index);
        self.names_at(|at| live[at])
    }

    /// The names of members and components.
    pub(super) fn members(&self) -> HashSet<&'t str> {
        let pairs = self.words.windows(2);
        pairs
            .filter_map(|pair| (pair[0] == ".").then_some(pair[1]))
            .collect()
    }

    fn names_at(&self, is_meant: impl Fn(usize) -> bool) -> HashSet<&'t str> {
        let is_name = |at: &usize| (*at == 0 || self.words[at - 1] != ".") && is_meant(*at);
        let places = (0..self.words.len()).filter(is_name);
        places.map(|at| self.words[at]).collect()
    }

    /// Whether the pass with this index may execute each token.
    fn live(&self, index: i64) -> Vec<bool> {
        let mut live = vec![true; self.words.len()];
        for at in 0..live.len() {
            if live[at]
                && let Some(dead) = self.dead_branch(at, index)
                && self.has_no_directive(&dead)
            {
                live[dead].fill(false);
            }
        }
        live
    }

    /// Whether a range can be left out: it has no part of a directive, which may hide some of its braces.
    fn has_no_directive(&self, range: &Range<usize>) -> bool {
        let before = |at: usize| self.directives.get(at).copied();
        let after = before(range.end).or_else(|| {
            let last = self.words.len().checked_sub(1)?;
            Some(self.directives[last] + usize::from(self.words[last] == "#"))
        });
        before(range.start) == after
    }

    fn get(&self, at: usize) -> &'t str {
        self.words.get(at).copied().unwrap_or_default()
    }

    /// Counts a step; `None` if too many are made.
    fn step(&self) -> Option<()> {
        self.steps_left.set(self.steps_left.get().checked_sub(1)?);
        Some(())
    }

    /// The branch that is not taken of an `if` at this token.
    fn dead_branch(&self, at: usize, index: i64) -> Option<Range<usize>> {
        let is_directive = at > 0 && self.get(at - 1) == "#";
        if self.get(at) != "if" || is_directive || self.get(at + 1) != "(" {
            return None;
        }
        let then = self.ends[at + 1]?;
        let words = &self.words[at + 2..then - 1];
        // The other operators that bind less tightly than `&&`.
        let is_simple =
            words.len() <= MAX_CONDITION && !words.iter().any(|word| ["?", ",", "^", "="].contains(word));
        let is_taken = is_simple.then(|| condition(words, index))??;
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
            self.step()?;
            match self.get(at) {
                "if" if open_ifs == MAX_OPEN_IFS => return None,
                "if" | "for" | "while" => {
                    open_ifs += usize::from(self.get(at) == "if");
                    at = *self.ends.get(at + 1)?.as_ref()?;
                    continue;
                }
                "{" => at = self.ends[at]?,
                "" | "}" | "do" | "switch" | "#" | LINE_END => return None,
                _ => {
                    while self.get(at) != ";" {
                        self.step()?;
                        at = match self.get(at) {
                            "" | "}" | "#" | LINE_END => return None,
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

/// Names, numbers and operators, and [`LINE_END`] behind each directive; of a comment nothing.
fn words(mut text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut is_directive = false;
    loop {
        // A line may be continued.
        let ends_line = |blank: &str| blank.replace("\\\r\n", "").replace("\\\n", "").contains('\n');
        let start = text.trim_start_matches(|character: char| character.is_whitespace() || character == '\\');
        let blank = &text[..text.len() - start.len()];
        if is_directive && (ends_line(blank) || start.is_empty()) {
            words.push(LINE_END);
            is_directive = false;
        }
        text = start;
        let length = if let Some(comment) = text.strip_prefix("//") {
            text = comment.find('\n').map_or("", |end| &comment[end..]);
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
        is_directive |= word == "#";
        words.push(word);
        text = rest;
    }
}

/// The value of a condition, if `PASSINDEX` decides it.
fn condition(words: &[&str], index: i64) -> Option<bool> {
    chain(words, "||", true, |part| {
        chain(part, "&&", false, |part| comparison(part, index))
    })
}

/// The value of operands with an operator between them that one operand with the value `decides` decides.
fn chain(
    words: &[&str],
    operator: &'static str,
    decides: bool,
    value: impl Fn(&[&str]) -> Option<bool>,
) -> Option<bool> {
    let mut is_known = true;
    for operand in split(words, operator) {
        match value(operand) {
            Some(value) if value == decides => return Some(decides),
            Some(_) => {}
            None => is_known = false,
        }
    }
    is_known.then_some(!decides)
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
        // Others than decimal numbers are not decided.
        "0" => Some(0),
        _ if word.starts_with('0') => None,
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

    /// The tokens that a pass may execute.
    fn live_words(text: &str, index: i64) -> Vec<&str> {
        let tokens = Tokens::new(text);
        let words = tokens.words.iter().zip(tokens.live(index));
        words
            .filter_map(|(word, is_live)| is_live.then_some(*word))
            .collect()
    }

    /// The letters of the statements `a;`, `b;` and so on that a pass may execute.
    fn live(text: &str, index: i64) -> String {
        let is_letter =
            |word: &&str| word.len() == 1 && word.chars().all(|letter| letter.is_ascii_lowercase());
        live_words(text, index).into_iter().filter(is_letter).collect()
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
            "if (PASSINDEX == 0 && x ^^ y) a;",
            "if (PASSINDEX == 0 ? x : y) a;",
            "if (PASSINDEX == 00) a;",
            // The directive ends with its line, and the lines of others may hide braces.
            "#define FIRST if (PASSINDEX == 0)\na;",
            "#define FIRST if \\\n (PASSINDEX == 0) // first\na;",
            "#ifdef A\nif (PASSINDEX == 0) {\n#else\nif (PASSINDEX == 0) {\n#endif\na; }",
        ] {
            assert_eq!(live_words(text, 1), words(text), "{text}");
        }
        let comments =
            "// if (PASSINDEX == 0)\na; /* if (PASSINDEX == 0) */ b; if /**/ (PASSINDEX == /* 1 */ 0) c;";
        assert_eq!(live(comments, 1), "ab");
        // Neither depth nor length takes long.
        let deep = "if (PASSINDEX == 1) ".repeat(40_000) + "a;";
        assert_eq!([0, 1].map(|index| live(&deep, index)), ["", "a"]);
        for part in [
            "if(PASSINDEX==1)a ",
            "if(",
            "if(PASSINDEX==1){",
            "if(PASSINDEX==1)a;else ",
        ] {
            let long = part.repeat(60_000);
            assert!(live(&long, 1).len() <= 60_000, "{part}");
        }
    }

    #[test]
    fn names_are_whole_words_and_no_members() {
        let tokens = Tokens::new("IMG_PIXEL(blurA, p.b); a; // c");
        let names = tokens.names();
        assert!(["blurA", "p", "a"].iter().all(|name| names.contains(name)));
        assert!(!["blur", "b", "c"].iter().any(|name| names.contains(name)));
        assert_eq!(tokens.members(), HashSet::from(["b"]));
    }
}
