//! The expressions of the sizes of ISF's passes, such as `floor($WIDTH/4.0)`: arithmetic as its hosts have it,
//! with operators of the usual precedence, read without recursion.

use std::ops::Range;

use toyproof_player::{BinaryFunction, SizeExpr, Step, UnaryFunction};

/// The maximum length of an expression, in bytes.
const MAX_BYTES: usize = 1024;

/// Why a text is not an expression.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct SizeError {
    /// The reason.
    pub(super) message: String,
    /// Where, in bytes of the text.
    pub(super) at: Range<usize>,
}

/// A function with its arguments.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Function {
    Unary(UnaryFunction),
    Binary(BinaryFunction),
    /// One or more arguments, of which each two are combined.
    Fold(BinaryFunction),
}

/// The functions by their names.
const FUNCTIONS: [(&str, Function); 10] = [
    ("abs", Function::Unary(UnaryFunction::Abs)),
    ("ceil", Function::Unary(UnaryFunction::Ceil)),
    ("floor", Function::Unary(UnaryFunction::Floor)),
    ("round", Function::Unary(UnaryFunction::Round)),
    ("sqrt", Function::Unary(UnaryFunction::Sqrt)),
    ("trunc", Function::Unary(UnaryFunction::Trunc)),
    ("max", Function::Fold(BinaryFunction::Max)),
    ("min", Function::Fold(BinaryFunction::Min)),
    ("mod", Function::Binary(BinaryFunction::Remainder)),
    ("pow", Function::Binary(BinaryFunction::Pow)),
];

/// What waits for its last operand, or for its closing parenthesis.
enum Pending {
    /// An operator with its precedence.
    Operator(Step, u8),
    /// An opening parenthesis, with the function before it and the number of arguments so far.
    Open {
        function: Option<(Function, Range<usize>)>,
        arguments: usize,
        at: usize,
    },
}

/// The precedence of a sign, which is higher than those of operators.
const SIGN: u8 = 3;

struct Parser<'t, V> {
    text: &'t str,
    at: usize,
    /// The value of an input.
    value: V,
    steps: Vec<Step>,
    pending: Vec<Pending>,
}

/// Parses an expression; `value` returns the value of an input, if it is a number.
///
/// # Errors
/// What is wrong with it, and where.
pub(super) fn parse(text: &str, value: impl Fn(&str) -> Option<f64>) -> Result<SizeExpr, SizeError> {
    if text.len() > MAX_BYTES {
        return error(
            format!("the expression is longer than {MAX_BYTES} bytes"),
            0..text.len(),
        );
    }
    let parser = Parser {
        text,
        at: 0,
        value,
        steps: Vec::new(),
        pending: Vec::new(),
    };
    parser.expression()
}

fn error<T>(message: impl Into<String>, at: Range<usize>) -> Result<T, SizeError> {
    Err(SizeError {
        message: message.into(),
        at,
    })
}

impl<V: Fn(&str) -> Option<f64>> Parser<'_, V> {
    fn expression(mut self) -> Result<SizeExpr, SizeError> {
        loop {
            self.operand()?;
            if !self.after_operand()? {
                break;
            }
        }
        let end = self.text.len();
        match SizeExpr::new(self.steps) {
            Some(expr) => Ok(expr),
            None => error("malformed expression", 0..end),
        }
    }

    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    /// Takes the characters for which `is_part` holds.
    fn take(&mut self, is_part: impl Fn(char) -> bool) -> Range<usize> {
        let start = self.at;
        let rest = &self.text[start..];
        self.at += rest.find(|character| !is_part(character)).unwrap_or(rest.len());
        start..self.at
    }

    /// Reads signs, parentheses and functions up to a number or a name, and that.
    fn operand(&mut self) -> Result<(), SizeError> {
        loop {
            let start = self.at;
            match self.peek() {
                Some('-') => {
                    self.at += 1;
                    let negate = Step::Unary(UnaryFunction::Negate);
                    self.pending.push(Pending::Operator(negate, SIGN));
                }
                Some('+') => self.at += 1,
                Some('(') => self.open(None),
                Some('0'..='9' | '.') => return self.number(),
                Some('$' | '_' | 'a'..='z' | 'A'..='Z') => {
                    if self.name()? {
                        return Ok(());
                    }
                }
                Some(other) => {
                    let end = self.at + other.len_utf8();
                    return error(
                        format!("expected a number or a name, not `{other}`"),
                        self.at..end,
                    );
                }
                None => return error("expected a number or a name at the end", start..self.text.len()),
            }
        }
    }

    fn open(&mut self, function: Option<(Function, Range<usize>)>) {
        self.pending.push(Pending::Open {
            function,
            arguments: 1,
            at: self.at,
        });
        self.at += 1;
    }

    fn number(&mut self) -> Result<(), SizeError> {
        let start = self.at;
        self.take(|character| character.is_ascii_digit() || character == '.');
        // An exponent, with its sign.
        if self.text[self.at..].starts_with(['e', 'E']) {
            self.at += 1;
            if self.text[self.at..].starts_with(['+', '-']) {
                self.at += 1;
            }
            self.take(|character| character.is_ascii_digit());
        }
        let at = start..self.at;
        match self.text[at.clone()].parse() {
            Ok(number) => {
                self.steps.push(Step::Constant(number));
                Ok(())
            }
            Err(_) => error(format!("malformed number `{}`", &self.text[at.clone()]), at),
        }
    }

    /// Reads a variable, or a function with its parenthesis; returns whether it is a variable.
    fn name(&mut self) -> Result<bool, SizeError> {
        let start = self.at;
        if self.text[start..].starts_with('$') {
            self.at += 1;
        }
        let name = self.take(|character| character.is_ascii_alphanumeric() || character == '_');
        let at = start..self.at;
        let name = &self.text[name];
        let step = match name {
            "WIDTH" => Some(Step::Width),
            "HEIGHT" => Some(Step::Height),
            _ => (self.value)(name).map(Step::Constant),
        };
        if let Some(step) = step {
            self.steps.push(step);
            return Ok(true);
        }
        let functions = FUNCTIONS.iter().find(|(known, _)| *known == name);
        match (self.peek(), functions) {
            (Some('('), Some((_, function))) => {
                self.open(Some((*function, at)));
                Ok(false)
            }
            (Some('('), None) => {
                let names = FUNCTIONS.map(|(name, _)| name).join(", ");
                error(format!("unknown function `{name}`; there are {names}"), at)
            }
            _ => error(format!("there is no input `{name}` that is a number"), at),
        }
    }

    /// Reads closing parentheses, and then a comma or an operator; returns whether there is one of these.
    fn after_operand(&mut self) -> Result<bool, SizeError> {
        loop {
            let Some(next) = self.peek() else {
                self.apply(0);
                return match self.pending.last() {
                    Some(&Pending::Open { at, .. }) => error("this parenthesis is not closed", at..at + 1),
                    _ => Ok(false),
                };
            };
            let at = self.at..self.at + next.len_utf8();
            self.at = at.end;
            let (function, precedence) = match next {
                ')' => {
                    self.close(at)?;
                    continue;
                }
                ',' => {
                    self.apply(0);
                    return match self.pending.last_mut() {
                        Some(Pending::Open {
                            function: Some(_),
                            arguments,
                            ..
                        }) => {
                            *arguments += 1;
                            Ok(true)
                        }
                        _ => error("a comma stands only between the arguments of a function", at),
                    };
                }
                '+' => (BinaryFunction::Add, 1),
                '-' => (BinaryFunction::Subtract, 1),
                '*' => (BinaryFunction::Multiply, 2),
                '/' => (BinaryFunction::Divide, 2),
                '%' => (BinaryFunction::Remainder, 2),
                other => return error(format!("expected an operator, not `{other}`"), at),
            };
            self.apply(precedence);
            self.pending
                .push(Pending::Operator(Step::Binary(function), precedence));
            return Ok(true);
        }
    }

    /// Applies the operators that wait, back to a parenthesis or to one of a lower precedence.
    fn apply(&mut self, precedence: u8) {
        while let Some(&Pending::Operator(step, _)) = self
            .pending
            .last()
            .filter(|pending| matches!(pending, Pending::Operator(_, waiting) if *waiting >= precedence))
        {
            self.steps.push(step);
            self.pending.pop();
        }
    }

    fn close(&mut self, at: Range<usize>) -> Result<(), SizeError> {
        self.apply(0);
        let Some(Pending::Open {
            function, arguments, ..
        }) = self.pending.pop()
        else {
            return error("no parenthesis is open here", at);
        };
        let Some((function, name)) = function else {
            return Ok(());
        };
        match (function, arguments) {
            (Function::Unary(function), 1) => self.steps.push(Step::Unary(function)),
            (Function::Binary(function), 2) => self.steps.push(Step::Binary(function)),
            (Function::Fold(function), _) => {
                self.steps.extend((1..arguments).map(|_| Step::Binary(function)));
            }
            (Function::Unary(_) | Function::Binary(_), _) => {
                let expected = if matches!(function, Function::Unary(_)) {
                    "one argument"
                } else {
                    "two arguments"
                };
                let text = &self.text[name.clone()];
                return error(format!("`{text}` takes {expected}, not {arguments}"), name);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Result<f64, String> {
        let inputs = |name: &str| (name == "blurAmount").then_some(0.5);
        match parse(text, inputs) {
            Ok(expr) => Ok(expr.value([64, 36])),
            Err(error) => Err(format!("{}..{} {}", error.at.start, error.at.end, error.message)),
        }
    }

    #[test]
    fn expressions_have_the_usual_precedence() {
        for (text, expected) in [
            ("$WIDTH", 64.0),
            ("$WIDTH/4.0", 16.0),
            ("floor($HEIGHT * 0.3)", 10.0),
            ("$WIDTH - 3 * 2 - 1", 57.0),
            ("($WIDTH - 3) * (2 - 1)", 61.0),
            ("-2 - -3 * +2", 4.0),
            ("-(1 + 2) % 2", -1.0),
            ("24 / 4 / 3", 2.0),
            ("1e2 + .5 + 2.", 102.5),
            ("max($WIDTH / 100.0, 1.0)", 1.0),
            ("min(7, 5, 6, 8) + max(1)", 6.0),
            ("pow(2, 3) * mod(7, 4)", 24.0),
            ("ceil(1.2) + round(2.5) + trunc(-1.5) + abs(-3) + sqrt(16)", 11.0),
            ("floor($WIDTH*min((0.8-0.5*$blurAmount),1.0))", 35.0),
            ("max(floor(WIDTH*0.02),1.0)", 1.0),
            ("((((((1))))))", 1.0),
        ] {
            assert_eq!(value(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn errors_name_the_place() {
        for (text, expected) in [
            ("", "0..0 expected a number or a name at the end"),
            ("$WIDTH /", "8..8 expected a number or a name at the end"),
            ("$WIDTH / * 2", "9..10 expected a number or a name, not `*`"),
            ("$WIDTH 2", "7..8 expected an operator, not `2`"),
            ("2 ^ 3", "2..3 expected an operator, not `^`"),
            ("1.2.3", "0..5 malformed number `1.2.3`"),
            ("2e", "0..2 malformed number `2e`"),
            ("(1 + 2", "0..1 this parenthesis is not closed"),
            ("1 + 2)", "5..6 no parenthesis is open here"),
            (
                "(1, 2)",
                "2..3 a comma stands only between the arguments of a function",
            ),
            ("floor()", "6..7 expected a number or a name, not `)`"),
            ("floor(1, 2)", "0..5 `floor` takes one argument, not 2"),
            ("pow(2)", "0..3 `pow` takes two arguments, not 1"),
            ("2 * $blur", "4..9 there is no input `blur` that is a number"),
            ("floor", "0..5 there is no input `floor` that is a number"),
            ("1 + é", "4..6 expected a number or a name, not `é`"),
        ] {
            assert_eq!(value(text), Err(expected.to_owned()), "{text}");
        }
        assert!(
            value("rand(1)")
                .unwrap_err()
                .starts_with("0..4 unknown function `rand`; there are abs, ")
        );
        // Deep nesting needs no stack; long texts are refused.
        let deep = |depth: usize| "(".repeat(depth) + "1" + &")".repeat(depth);
        assert_eq!(value(&deep(500)), Ok(1.0));
        assert!(value(&deep(5000)).unwrap_err().contains("longer than 1024 bytes"));
        assert_eq!(value(&("-".repeat(1000) + "1")), Ok(1.0));
    }
}
