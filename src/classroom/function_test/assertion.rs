//! The grammar of a test in one line.
//!
//! ```text
//! test       = comparison ["+-" NUMBER] ["for" variables] ["after" EXPRESSION]
//! comparison = side ("==" | "!=" | "<" | "<=" | ">" | ">=") side
//!            | side "in" "[" EXPRESSION "," EXPRESSION "]"
//!            | side "is" ("increasing" | "decreasing")
//!            | EXPRESSION
//! side       = EXPRESSION | "|" EXPRESSION "|"
//! variables  = variable {"," variable}
//! variable   = [TYPE] NAME ["in" ("[" EXPRESSION "," EXPRESSION "]" | "{" EXPRESSION {"," EXPRESSION} "}")]
//! ```
//!
//! EXPRESSION is one of GLSL, which the front end checks. Comparisons, `+-`, `for` and `after` count only
//! outside of parentheses. A variable without a set has that of the next one, which also has its type.

use std::ops::Range;

use toyproof_diagnostic::{Span, nearest};

use super::source::Snippet;
use super::tokens::{Kind, SyntaxError, Token, tokens};

/// A comparison of expressions, for all values of its variables.
#[derive(Debug, Clone, PartialEq)]
pub struct Assertion {
    whole: Snippet,
    pub(super) left: Side,
    pub(super) relation: Relation,
    /// The largest permitted difference; `None` for the default of the relation.
    pub(super) tolerance: Option<f64>,
    pub(super) variables: Vec<Variable>,
    /// What is evaluated first.
    pub(super) after: Option<Snippet>,
}

/// A compared expression.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Side {
    pub(super) expression: Snippet,
    /// Whether its length is compared: `|…|`.
    pub(super) is_length: bool,
    /// Both, as it is written.
    pub(super) text: String,
}

/// What must hold for the expression.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Relation {
    /// It is true.
    Holds,
    Compare(Comparison, Side),
    /// It is in a closed interval.
    Within(Snippet, Snippet),
    /// It never falls.
    Increases,
    /// It never rises.
    Decreases,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Comparison {
    Equal,
    Unequal,
    Less,
    AtMost,
    Greater,
    AtLeast,
}

impl Comparison {
    const ALL: [(&'static str, Self); 6] = [
        ("==", Self::Equal),
        ("!=", Self::Unequal),
        ("<", Self::Less),
        ("<=", Self::AtMost),
        (">", Self::Greater),
        (">=", Self::AtLeast),
    ];

    fn named(symbol: &str) -> Option<Self> {
        let found = Self::ALL.iter().find(|(known, _)| *known == symbol);
        found.map(|(_, comparison)| *comparison)
    }

    pub(super) fn symbol(self) -> &'static str {
        let found = Self::ALL.iter().find(|(_, comparison)| *comparison == self);
        found.map_or("", |(symbol, _)| symbol)
    }
}

/// A variable that takes several values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Variable {
    /// `None` if it follows from a call; several variables may share it.
    pub(super) ty: Option<Snippet>,
    pub(super) name: Snippet,
    pub(super) set: Set,
}

/// The values of a variable.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Set {
    /// A closed interval in each component.
    Interval(Snippet, Snippet),
    /// These, at least one.
    List(Vec<Snippet>),
}

impl Assertion {
    /// The test as it is written.
    #[must_use]
    pub fn text(&self) -> &str {
        self.whole.text()
    }

    /// Where it is written.
    #[must_use]
    pub fn at(&self) -> Span {
        self.whole.at()
    }

    /// The names in the compared expressions.
    pub(super) fn names(&self) -> Vec<&str> {
        let mut sides = vec![&self.left];
        if let Relation::Compare(_, right) = &self.relation {
            sides.push(right);
        }
        let names = sides.into_iter().flat_map(|side| {
            let tokens = tokens(&side.expression, true).unwrap_or_default();
            let text = side.expression.text();
            let words = tokens.into_iter().filter(|token| token.kind == Kind::Word);
            words.map(|token| &text[token.range])
        });
        names.collect()
    }

    pub(super) fn parse(whole: &Snippet) -> Result<Self, SyntaxError> {
        Parser {
            whole,
            tokens: tokens(whole, false)?,
        }
        .assertion()
    }
}

// The grammar.

struct Parser<'t> {
    whole: &'t Snippet,
    tokens: Vec<Token>,
}

impl Parser<'_> {
    fn text(&self, token: &Token) -> &str {
        &self.whole.text()[token.range.clone()]
    }

    /// Whether a token is this word or operator.
    fn is(&self, index: usize, text: &str) -> bool {
        let token = self.tokens.get(index);
        token.is_some_and(|token| token.kind != Kind::Group && self.text(token) == text)
    }

    fn error<T>(
        &self,
        range: Range<usize>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Result<T, SyntaxError> {
        Err(SyntaxError {
            at: self.whole.place(range.start, range.end),
            message: message.into(),
            help: help.into(),
        })
    }

    /// The bytes of a range of tokens; of the place before the first if there are none.
    fn bytes(&self, tokens: &Range<usize>) -> Range<usize> {
        let start = match self.tokens.get(tokens.start) {
            Some(token) => token.range.start,
            None => self.whole.text().len(),
        };
        match tokens.end.checked_sub(1).and_then(|last| self.tokens.get(last)) {
            Some(last) if !tokens.is_empty() => start..last.range.end,
            _ => start..start,
        }
    }

    fn snippet(&self, tokens: &Range<usize>) -> Snippet {
        let bytes = self.bytes(tokens);
        self.whole.part(bytes.start, bytes.end)
    }

    /// The first of some tokens that is this word or operator.
    fn find(&self, tokens: &Range<usize>, text: &str) -> Option<usize> {
        tokens.clone().find(|&index| self.is(index, text))
    }

    fn assertion(&self) -> Result<Assertion, SyntaxError> {
        let all = 0..self.tokens.len();
        if all.is_empty() {
            return self.error(
                0..self.whole.text().len(),
                "the test is empty",
                "write a comparison, such as `f(1.0) == 2.0`",
            );
        }
        let quantifier = self.find(&all, "for").unwrap_or(all.end);
        // A word after an operand is no GLSL, so that a variable may have this name.
        let is_operand = |index: usize| self.tokens[index].kind != Kind::Operator;
        let after = all.clone().skip(1).find(|&index| {
            let is_word_next = self
                .tokens
                .get(index + 1)
                .is_some_and(|next| next.kind == Kind::Word);
            self.is(index, "after") && is_operand(index - 1) && is_word_next
        });
        let end = after.unwrap_or(all.end);
        if quantifier > end && quantifier < all.end {
            let bytes = self.bytes(&(quantifier..quantifier + 1));
            let help = "write `… for p in [-1, 1] after makeScene()`";
            return self.error(bytes, "`for` must stand before `after`", help);
        }
        let head = 0..quantifier.min(end);
        let (comparison, tolerance) = self.tolerance(head)?;
        let (left, relation) = self.comparison(comparison)?;
        let variables = if quantifier < end {
            self.variables(quantifier + 1..end)?
        } else {
            Vec::new()
        };
        let assertion = Assertion {
            whole: self.whole.clone(),
            left,
            relation,
            tolerance,
            variables,
            after: after.map(|after| self.snippet(&(after + 1..all.end))),
        };
        if matches!(assertion.relation, Relation::Increases | Relation::Decreases) {
            let is_one = matches!(
                assertion.variables[..],
                [Variable {
                    set: Set::Interval(..),
                    ..
                }]
            );
            if !is_one {
                return self.error(
                    0..self.whole.text().len(),
                    "what is increasing or decreasing depends on one variable in an interval",
                    "write `f(x) is increasing for x in [0, 1]`",
                );
            }
        }
        Ok(assertion)
    }

    /// Splits off the tolerance.
    fn tolerance(&self, head: Range<usize>) -> Result<(Range<usize>, Option<f64>), SyntaxError> {
        let Some(sign) = self.find(&head, "+-").or_else(|| self.find(&head, "±")) else {
            return Ok((head, None));
        };
        let value = self.snippet(&(sign + 1..head.end));
        match value.text().parse::<f64>() {
            Ok(tolerance) if tolerance.is_finite() => Ok((head.start..sign, Some(tolerance))),
            _ => self.error(
                self.bytes(&(sign..head.end)),
                "`+-` must be followed by a tolerance",
                "write a number at the end of the comparison: `f(1.0) == 2.0 +- 1e-6`",
            ),
        }
    }

    fn comparison(&self, all: Range<usize>) -> Result<(Side, Relation), SyntaxError> {
        let symbol = |index: usize| match self.tokens[index].kind {
            Kind::Operator => Comparison::named(self.text(&self.tokens[index])),
            _ => None,
        };
        let is_relation = |index: &usize| {
            symbol(*index).is_some()
                || self.is(*index, "in")
                || (self.is(*index, "is") && *index > 0 && self.tokens[*index - 1].kind != Kind::Operator)
        };
        let mut relations = all.clone().filter(is_relation);
        let Some(at) = relations.next() else {
            if let Some(assignment) = self.find(&all, "=") {
                let bytes = self.bytes(&(assignment..assignment + 1));
                return self.error(bytes, "a test compares, and assigns nothing", "write `==`");
            }
            return Ok((self.side(all, "a test")?, Relation::Holds));
        };
        if let Some(other) = relations.next() {
            return self.error(
                self.bytes(&(other..other + 1)),
                "a test has one comparison",
                "write two tests, a range such as `f(x) in [0, 1]`, or parentheses around a condition",
            );
        }
        let logical = all
            .clone()
            .find(|&index| ["&&", "||", "^^", "?"].iter().any(|op| self.is(index, op)));
        if let Some(logical) = logical {
            return self.error(
                self.bytes(&(logical..logical + 1)),
                "a test has one comparison",
                "write two tests, or put the condition in parentheses",
            );
        }
        let before = all.start..at;
        let rest = at + 1..all.end;
        if self.is(at, "is") {
            let left = self.side(before, "`is`")?;
            let word = self.snippet(&rest);
            return match word.text() {
                "increasing" => Ok((left, Relation::Increases)),
                "decreasing" => Ok((left, Relation::Decreases)),
                other => self.error(
                    self.bytes(&(at..all.end)),
                    format!("unknown property `is {other}`"),
                    match nearest(other, ["increasing", "decreasing"]) {
                        Some(near) => format!("did you mean `is {near}`?"),
                        None => "the properties are `is increasing` and `is decreasing`".to_owned(),
                    },
                ),
            };
        }
        if self.is(at, "in") {
            let left = self.side(before, "`in`")?;
            return match self.set(rest.clone())? {
                Set::Interval(low, high) => Ok((left, Relation::Within(low, high))),
                Set::List(_) => self.error(
                    self.bytes(&rest),
                    "a range is an interval",
                    "write `f(x) in [0, 1]`",
                ),
            };
        }
        let Some(comparison) = symbol(at) else {
            return self.error(self.bytes(&all), "invalid comparison", "");
        };
        let name = format!("`{}`", comparison.symbol());
        let left = self.side(before, &name)?;
        Ok((left, Relation::Compare(comparison, self.side(rest, &name)?)))
    }

    /// Reads an expression, or the length of one, beside `what`.
    fn side(&self, tokens: Range<usize>, what: &str) -> Result<Side, SyntaxError> {
        let bytes = self.bytes(&tokens);
        if tokens.is_empty() {
            let message = format!("{what} lacks an expression");
            return self.error(bytes, message, "write a comparison, such as `f(1.0) == 2.0`");
        }
        let text = self.snippet(&tokens).text().to_owned();
        let bars: Vec<_> = tokens.clone().filter(|&index| self.is(index, "|")).collect();
        match bars[..] {
            [first, last] if first == tokens.start && last + 1 == tokens.end && first + 1 < last => {
                Ok(Side {
                    expression: self.snippet(&(first + 1..last)),
                    is_length: true,
                    text,
                })
            }
            [first, ..] if first == tokens.start => self.error(
                bytes,
                "bars must enclose all of one side of a comparison",
                "write `|normal(p)| == 1`, or call `length` inside of an expression",
            ),
            _ => Ok(Side {
                expression: self.snippet(&tokens),
                is_length: false,
                text,
            }),
        }
    }

    fn variables(&self, all: Range<usize>) -> Result<Vec<Variable>, SyntaxError> {
        const HELP: &str = "write `for x in [0, 1]`, `for vec3 p in [-2, 2]` or `for n in {1, 2, 3}`";
        let mut variables = Vec::new();
        // Those that have no set yet.
        let mut pending: Vec<(Option<Snippet>, Snippet)> = Vec::new();
        for part in self.split(all) {
            let set = self.find(&part, "in");
            let words = part.start..set.unwrap_or(part.end);
            let is_name = words.clone().all(|index| self.tokens[index].kind == Kind::Word);
            let at = |index: usize| self.snippet(&(index..index + 1));
            let declared = match words.len() {
                1 if is_name => {
                    let ty = pending.last().and_then(|(ty, _)| ty.clone());
                    (ty, at(words.start))
                }
                2 if is_name => (Some(at(words.start)), at(words.start + 1)),
                _ => return self.error(self.bytes(&part), "expected a variable after `for`", HELP),
            };
            let is_taken = |name: &str| {
                let known = variables.iter().map(|variable: &Variable| &variable.name);
                known
                    .chain(pending.iter().map(|(_, name)| name))
                    .any(|known| known.text() == name)
            };
            if is_taken(declared.1.text()) {
                let message = format!("there are two variables `{}`", declared.1.text());
                return self.error(self.bytes(&words), message, "give one of them another name");
            }
            pending.push(declared);
            if let Some(set) = set {
                let set = self.set(set + 1..part.end)?;
                variables.extend(pending.drain(..).map(|(ty, name)| Variable {
                    ty,
                    name,
                    set: set.clone(),
                }));
            }
        }
        match pending.first() {
            Some((_, name)) => Err(SyntaxError {
                at: name.at(),
                message: format!("the variable `{}` has no values", name.text()),
                help: HELP.to_owned(),
            }),
            None => Ok(variables),
        }
    }

    /// Splits tokens at commas.
    fn split(&self, all: Range<usize>) -> Vec<Range<usize>> {
        let mut parts = Vec::new();
        let mut start = all.start;
        for index in all.clone() {
            if self.is(index, ",") {
                parts.push(start..index);
                start = index + 1;
            }
        }
        parts.push(start..all.end);
        parts
    }

    /// Reads an interval or a list.
    fn set(&self, tokens: Range<usize>) -> Result<Set, SyntaxError> {
        let bytes = self.bytes(&tokens);
        let text = &self.whole.text()[bytes.clone()];
        let is_group = tokens.len() == 1 && self.tokens[tokens.start].kind == Kind::Group;
        let is_interval = text.starts_with('[');
        if !is_group || text.starts_with('(') {
            let help = "write an interval as `[low, high]`, and a list as `{a, b, c}`";
            return self.error(bytes, "expected values after `in`", help);
        }
        let inside = self.whole.part(bytes.start + 1, bytes.end - 1);
        let parser = Parser {
            tokens: super::tokens::tokens(&inside, false)?,
            whole: &inside,
        };
        let parts = parser.split(0..parser.tokens.len());
        let mut values = Vec::with_capacity(parts.len());
        for part in &parts {
            if part.is_empty() {
                let help = "write an expression before and after each comma";
                return self.error(bytes, "a value is missing", help);
            }
            values.push(parser.snippet(part));
        }
        match (is_interval, &values[..]) {
            (true, [low, high]) => Ok(Set::Interval(low.clone(), high.clone())),
            (true, _) => self.error(
                bytes,
                format!("an interval has two ends, found {}", values.len()),
                "write it as `[low, high]`; a list of values is `{a, b, c}`",
            ),
            (false, _) => Ok(Set::List(values)),
        }
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;

    fn parse(text: &str) -> Result<Assertion, (String, String)> {
        let mut files = Files::default();
        let file = files.add(File::new("a", text));
        let whole = Snippet::new(text, Span::new(file, 0, text.len() as u32), true);
        Assertion::parse(&whole).map_err(|error| (files.text(error.at).to_owned(), error.message))
    }

    #[test]
    fn comparisons_are_split_outside_of_parentheses() {
        let test =
            parse("f(a < b ? 1. : 2.) == -g(x, y) + 1.0 +- 1e-6 for vec3 x, y in [-1, 1] after makeScene()");
        let test = test.unwrap();
        assert_eq!(test.left.text, "f(a < b ? 1. : 2.)");
        let Relation::Compare(Comparison::Equal, right) = &test.relation else {
            panic!("{test:?}");
        };
        assert_eq!(
            (right.text.as_str(), test.tolerance),
            ("-g(x, y) + 1.0", Some(1e-6))
        );
        let names: Vec<_> = test.variables.iter().map(|one| one.name.text()).collect();
        assert_eq!(names, ["x", "y"]);
        assert_eq!(test.after.unwrap().text(), "makeScene()");
        assert_eq!(test.variables[0].ty, test.variables[1].ty);
        assert_eq!(test.variables[0].set, test.variables[1].set);
    }

    #[test]
    fn properties_are_recognized() {
        let test = parse("|normal(p)| == 1 for p in {vec3(1, 2, 3), vec3(0)}").unwrap();
        assert!(test.left.is_length && test.left.expression.text() == "normal(p)");
        assert!(matches!(&test.variables[0].set, Set::List(values) if values.len() == 2));
        let test = parse("f(x) in [0, 1] for x in [-1.0e+2, 4]").unwrap();
        assert!(matches!(test.relation, Relation::Within(..)));
        let test = parse("f(x) is increasing for x in [0, 1]").unwrap();
        assert_eq!(test.relation, Relation::Increases);
        assert_eq!(parse("hit(ray)").unwrap().relation, Relation::Holds);
        assert_eq!(parse("(a && b)").unwrap().relation, Relation::Holds);
        assert_eq!(parse("a && b").unwrap().relation, Relation::Holds);
        // `after` may also be the name of a variable.
        assert_eq!(parse("after == 1.0").unwrap().after, None);
        assert_eq!(parse("1.0 + after == 1.0").unwrap().after, None);
    }

    #[test]
    fn errors_have_their_place() {
        for (text, at, message) in [
            ("", "", "the test is empty"),
            ("f(1) ==", "", "`==` lacks an expression"),
            ("== 1", "", "`==` lacks an expression"),
            ("0 <= f(x) <= 1", "<=", "a test has one comparison"),
            ("a == 1 && b == 2", "==", "a test has one comparison"),
            ("a == 1 && b", "&&", "a test has one comparison"),
            ("f(1 == 2", "(", "`(` is not closed"),
            ("f(1]) == 2", "]", "`]` closes no bracket"),
            ("f(1) = 2", "=", "a test compares, and assigns nothing"),
            ("f(1); == 2", ";", "unexpected `;` in a test"),
            ("f(1) == 2 +- x", "+- x", "`+-` must be followed by a tolerance"),
            ("f(x) == 2 for x", "x", "the variable `x` has no values"),
            ("f(x) == 2 for", "", "expected a variable after `for`"),
            ("f(x) == 2 for x in 3", "3", "expected values after `in`"),
            (
                "f(x) == 2 for x in [1]",
                "[1]",
                "an interval has two ends, found 1",
            ),
            ("f(x) == 2 for x in [1, ]", "[1, ]", "a value is missing"),
            ("f(x) == 2 for x, x in [1, 2]", "x", "there are two variables `x`"),
            ("f(x) in {1, 2}", "{1, 2}", "a range is an interval"),
            (
                "f(x) is increasng for x in [0, 1]",
                "is increasng",
                "unknown property `is increasng`",
            ),
            (
                "|a| + |b| == 1",
                "|a| + |b|",
                "bars must enclose all of one side of a comparison",
            ),
            (
                "f(x) is decreasing",
                "f(x) is decreasing",
                "what is increasing or decreasing depends on one variable in an interval",
            ),
            (
                "f(x) == 1 after g() for x in [0, 1]",
                "for",
                "`for` must stand before `after`",
            ),
        ] {
            assert_eq!(parse(text), Err((at.to_owned(), message.to_owned())), "{text}");
        }
    }
}
