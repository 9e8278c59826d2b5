//! The declarations and statements of a text by its brackets and keywords. Texts that do not compile have an
//! outline, too, unless their brackets do not match.

use std::collections::HashSet;
use std::ops::Range;

use toyproof_diagnostic::{File, FileId, Files};
use toyproof_glsl::lexemes;

/// The largest depth of nested statements; the front end accepts no deeper ones.
const MAX_DEPTH: usize = toyproof_glsl::MAX_NESTING;

/// The functions that hosts call.
pub(crate) const HOST_FUNCTIONS: [&str; 4] = ["main", "mainImage", "mainSound", "mainCubemap"];

/// A text with its tokens, directives, declarations and statements. Ranges are bytes of the text, but where
/// they are said to be tokens.
#[derive(Debug)]
pub(crate) struct Outline<'a> {
    pub(crate) text: &'a str,
    /// The tokens outside of directives.
    pub(crate) tokens: Vec<Range<usize>>,
    /// The directives, each a line with its continuations.
    pub(crate) directives: Vec<Directive>,
    /// The declarations at global scope; empty if brackets do not match.
    pub(crate) items: Vec<Item>,
}

/// A preprocessor directive.
#[derive(Debug)]
pub(crate) struct Directive {
    /// Its tokens, without comments around them.
    pub(crate) range: Range<usize>,
    /// Its tokens, the first is `#`.
    pub(crate) tokens: Vec<Range<usize>>,
}

/// A declaration at global scope.
#[derive(Debug)]
pub(crate) struct Item {
    /// Its tokens.
    pub(crate) tokens: Range<usize>,
    /// The names that it declares.
    pub(crate) names: Vec<usize>,
    /// The parts of a function definition.
    pub(crate) function: Option<Function>,
}

/// The parts of a function definition, as tokens.
#[derive(Debug)]
pub(crate) struct Function {
    /// The index of the `(` of its parameters.
    pub(crate) open: usize,
    /// The body with its braces.
    pub(crate) body: Range<usize>,
    pub(crate) statements: Vec<Statement>,
}

/// A statement.
#[derive(Debug)]
pub(crate) struct Statement {
    /// Its tokens.
    pub(crate) tokens: Range<usize>,
    /// The statements inside, each as a list: the body of a loop, both branches of an `if`, the cases of a
    /// `switch`.
    pub(crate) bodies: Vec<Body>,
    /// The tokens of the first clause of a `for`, with its `;`.
    pub(crate) init: Option<Range<usize>>,
}

/// What a statement contains.
#[derive(Debug)]
pub(crate) struct Body {
    /// Its tokens, with braces.
    pub(crate) tokens: Range<usize>,
    pub(crate) statements: Vec<Statement>,
    /// Whether it is in braces, so that its statements may be deleted.
    pub(crate) is_list: bool,
}

/// Adds a text as a file, which has no other purpose than to be checked.
pub(crate) fn file(text: &str) -> (Files, FileId) {
    let mut files = Files::default();
    let file = files.add(File::new("shader", text));
    (files, file)
}

impl<'a> Outline<'a> {
    pub(crate) fn new(text: &'a str) -> Self {
        let (files, file) = file(text);
        let mut tokens = Vec::new();
        let mut directives: Vec<Directive> = Vec::new();
        let mut line = None;
        for lexeme in lexemes(&files, file) {
            let range = lexeme.span.start as usize..lexeme.span.end as usize;
            if !lexeme.is_in_directive {
                tokens.push(range);
                continue;
            }
            match directives.last_mut().filter(|_| line == Some(lexeme.line)) {
                Some(directive) => {
                    directive.range.end = range.end;
                    directive.tokens.push(range);
                }
                None => directives.push(Directive {
                    range: range.clone(),
                    tokens: vec![range],
                }),
            }
            line = Some(lexeme.line);
        }
        let mut outline = Self {
            text,
            tokens,
            directives,
            items: Vec::new(),
        };
        outline.items = Parser {
            outline: &outline,
            at: 0,
        }
        .items()
        .unwrap_or_default();
        outline
    }

    /// The text of a token; empty past the last one.
    pub(crate) fn token(&self, index: usize) -> &'a str {
        self.tokens
            .get(index)
            .map_or("", |range| &self.text[range.clone()])
    }

    /// The bytes of some tokens, at least one.
    pub(crate) fn bytes(&self, tokens: &Range<usize>) -> Range<usize> {
        match (
            self.tokens.get(tokens.start),
            self.tokens.get(tokens.end.saturating_sub(1)),
        ) {
            (Some(first), Some(last)) if !tokens.is_empty() => first.start..last.end,
            _ => self.text.len()..self.text.len(),
        }
    }

    /// The index of the first token that begins at a byte or after it.
    pub(crate) fn token_at(&self, byte: usize) -> usize {
        self.tokens.partition_point(|range| range.start < byte)
    }

    /// The index of the bracket that closes the one at `open`.
    pub(crate) fn partner(&self, open: usize) -> Option<usize> {
        let mut depth = 0_usize;
        for index in open..self.tokens.len() {
            match self.token(index) {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth = depth.checked_sub(1)?,
                _ => {}
            }
            if depth == 0 {
                return Some(index);
            }
        }
        None
    }

    /// The elements of the list in the parentheses at `open`, as tokens without commas.
    pub(crate) fn elements(&self, open: usize) -> Option<Vec<Range<usize>>> {
        let close = self.partner(open)?;
        let mut elements = Vec::new();
        let mut start = open + 1;
        let mut index = start;
        while index < close {
            match self.token(index) {
                "(" | "[" | "{" => index = self.partner(index)?,
                "," => {
                    elements.push(start..index);
                    start = index + 1;
                }
                _ => {}
            }
            index += 1;
        }
        if start < close || !elements.is_empty() {
            elements.push(start..close);
        }
        Some(elements)
    }

    /// Whether a token is a name or a keyword.
    pub(crate) fn is_word(&self, index: usize) -> bool {
        is_word(self.token(index))
    }

    /// The function definitions, with their items.
    pub(crate) fn functions(&self) -> impl Iterator<Item = (&Item, &Function)> {
        self.items
            .iter()
            .filter_map(|item| Some((item, item.function.as_ref()?)))
    }

    /// The statements of all functions at a depth from 0, each with whether it may be deleted without a
    /// replacement.
    pub(crate) fn statements_at(&self, depth: usize) -> Vec<(&Statement, bool)> {
        let mut level: Vec<(&Statement, bool)> = self
            .functions()
            .flat_map(|(_, function)| function.statements.iter().map(|statement| (statement, true)))
            .collect();
        for _ in 0..depth {
            let bodies = level.into_iter().flat_map(|(statement, _)| &statement.bodies);
            level = bodies
                .flat_map(|body| body.statements.iter().map(|statement| (statement, body.is_list)))
                .collect();
        }
        level
    }

    /// The declarations that the function of the host reaches by the names in them, and those that are
    /// reached otherwise: macros count.
    pub(crate) fn reachable_items(&self) -> HashSet<usize> {
        let mut words: HashSet<&str> = self
            .directives
            .iter()
            .flat_map(|directive| &directive.tokens)
            .map(|range| &self.text[range.clone()])
            .collect();
        words.extend(HOST_FUNCTIONS);
        let mut reached = HashSet::new();
        loop {
            let before = reached.len();
            for (number, item) in self.items.iter().enumerate() {
                let is_named = item.names.iter().any(|&name| words.contains(self.token(name)));
                if is_named && reached.insert(number) {
                    words.extend(item.tokens.clone().map(|index| self.token(index)));
                }
            }
            if reached.len() == before {
                return reached;
            }
        }
    }
}

/// Whether a token is a name or a keyword.
pub(crate) fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

struct Parser<'o, 'a> {
    outline: &'o Outline<'a>,
    at: usize,
}

impl Parser<'_, '_> {
    fn token(&self) -> &str {
        self.outline.token(self.at)
    }

    fn is_at_end(&self) -> bool {
        self.at >= self.outline.tokens.len()
    }

    /// Steps over a bracket with its contents.
    fn skip_bracket(&mut self) -> Option<()> {
        self.at = self.outline.partner(self.at)? + 1;
        Some(())
    }

    fn items(&mut self) -> Option<Vec<Item>> {
        let mut items = Vec::new();
        while !self.is_at_end() {
            items.push(self.item()?);
        }
        Some(items)
    }

    fn item(&mut self) -> Option<Item> {
        let outline = self.outline;
        let start = self.at;
        let mut names = Vec::new();
        // The `(` of parameters.
        let mut open = None;
        let mut is_in_value = false;
        loop {
            let before = self.at.checked_sub(1).filter(|&before| before >= start);
            let named = before.filter(|&before| outline.is_word(before) && !is_in_value);
            match self.token() {
                "" | ")" | "]" | "}" => return None,
                ";" => {
                    names.extend(named);
                    self.at += 1;
                    let (tokens, function) = (start..self.at, None);
                    return Some(Item {
                        tokens,
                        names,
                        function,
                    });
                }
                "{" if open.is_some() && before.is_some_and(|before| outline.token(before) == ")") => {
                    let body_start = self.at;
                    let body = self.body(0)?;
                    let function = Function {
                        open: open?,
                        body: body_start..self.at,
                        statements: body.statements,
                    };
                    return Some(Item {
                        tokens: start..self.at,
                        names,
                        function: Some(function),
                    });
                }
                "(" => {
                    names.extend(named);
                    open = open.or(Some(self.at));
                    self.skip_bracket()?;
                }
                "{" | "[" | "=" | "," => {
                    names.extend(named);
                    match self.token() {
                        token @ ("=" | ",") => {
                            is_in_value = token == "=";
                            self.at += 1;
                        }
                        _ => self.skip_bracket()?,
                    }
                }
                _ => self.at += 1,
            }
        }
    }

    /// Reads a body: statements in braces, or one statement.
    fn body(&mut self, depth: usize) -> Option<Body> {
        let start = self.at;
        if self.token() != "{" {
            let statement = self.statement(depth)?;
            return Some(Body {
                tokens: start..self.at,
                statements: vec![statement],
                is_list: false,
            });
        }
        self.at += 1;
        let mut statements = Vec::new();
        while self.token() != "}" {
            statements.push(self.statement(depth)?);
        }
        self.at += 1;
        Some(Body {
            tokens: start..self.at,
            statements,
            is_list: true,
        })
    }

    fn statement(&mut self, depth: usize) -> Option<Statement> {
        if depth > MAX_DEPTH {
            return None;
        }
        let start = self.at;
        let depth = depth + 1;
        let mut bodies = Vec::new();
        let mut init = None;
        match self.token() {
            "{" => bodies.push(self.body(depth)?),
            "if" => {
                self.head()?;
                bodies.push(self.body(depth)?);
                if self.token() == "else" {
                    self.at += 1;
                    bodies.push(self.body(depth)?);
                }
            }
            "for" => {
                let first = self.at + 2;
                let end = (first..self.outline.tokens.len()).find(|&at| self.outline.token(at) == ";")?;
                init = Some(first..end + 1);
                self.head()?;
                bodies.push(self.body(depth)?);
            }
            "while" => {
                self.head()?;
                bodies.push(self.body(depth)?);
            }
            "do" => {
                self.at += 1;
                bodies.push(self.body(depth)?);
                self.simple()?;
            }
            "switch" => {
                self.head()?;
                // The labels are statements up to their `:`.
                bodies.push(self.body(depth)?);
            }
            "case" | "default" => {
                while self.token() != ":" {
                    match self.token() {
                        "" | ";" | "{" | "}" => return None,
                        _ => self.at += 1,
                    }
                }
                self.at += 1;
            }
            _ => self.simple()?,
        }
        Some(Statement {
            tokens: start..self.at,
            bodies,
            init,
        })
    }

    /// Steps over a keyword and what follows in parentheses.
    fn head(&mut self) -> Option<()> {
        self.at += 1;
        (self.token() == "(").then_some(())?;
        self.skip_bracket()
    }

    /// Steps over the tokens up to a `;`.
    fn simple(&mut self) -> Option<()> {
        loop {
            match self.token() {
                "" | ")" | "]" | "}" => return None,
                "(" | "[" | "{" => self.skip_bracket()?,
                ";" => {
                    self.at += 1;
                    return Some(());
                }
                _ => self.at += 1,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outlined(text: &str, depth: usize) -> Vec<&str> {
        let outline = Outline::new(text);
        let statements = outline.statements_at(depth);
        let texts = statements
            .iter()
            .map(|(statement, _)| &text[outline.bytes(&statement.tokens)]);
        texts.collect()
    }

    #[test]
    fn statements_end_after_their_last_part() {
        let whole = |statement: &str| {
            let text = format!("void f() {{ {statement} rest(); }}");
            assert_eq!(outlined(&text, 0), [statement, "rest();"], "{text}");
        };
        whole("x = f(1, 2);");
        whole("if (a) { b; } else if (c) d; else { e; }");
        whole("if (a /* ) */) b;");
        whole("for (int i = 0; i < 3; i++) { x; // }\n y; }");
        whole("do { x; } while (y);");
        whole("while (x) y;");
        whole("switch (x) { case 0: y; break; default: z; }");
        assert_eq!(
            outlined("void f() { if (a) { b; c; } else d; }", 1),
            ["b;", "c;", "d;"]
        );
    }

    #[test]
    fn declarations_have_their_names() {
        let text = "#define N 3\nstruct S { float x; }; const float a = 1., b[N]; float f(S s);\nfloat f(S s) { return a; }";
        let outline = Outline::new(text);
        let names = |item: &Item| {
            item.names
                .iter()
                .map(|&name| outline.token(name))
                .collect::<Vec<_>>()
        };
        let all: Vec<_> = outline.items.iter().map(names).collect();
        assert_eq!(all, [vec!["S"], vec!["a", "b"], vec!["f"], vec!["f"]]);
        assert_eq!(outline.directives.len(), 1);
        assert!(outline.items[3].function.is_some() && outline.items[2].function.is_none());
    }

    #[test]
    fn the_function_of_the_host_reaches_declarations_by_names() {
        let text = "float a, b; float f() { return a; } float g() { return b; } void mainImage() { f(); }";
        let outline = Outline::new(text);
        let mut reached: Vec<_> = outline.reachable_items().into_iter().collect();
        reached.sort_unstable();
        assert_eq!(reached, [0, 1, 3]);
    }

    #[test]
    fn elements_are_separated_by_commas() {
        let text = "f(a, g(b, c), v[0])";
        let outline = Outline::new(text);
        let elements = outline.elements(1).unwrap();
        let texts: Vec<_> = elements
            .iter()
            .map(|tokens| &text[outline.bytes(tokens)])
            .collect();
        assert_eq!(texts, ["a", "g(b, c)", "v[0]"]);
        assert_eq!(Outline::new("f()").elements(1), Some(vec![]));
    }

    #[test]
    fn brackets_that_do_not_match_give_no_declarations() {
        assert!(Outline::new("void f() { (; }").items.is_empty());
        assert_eq!(Outline::new("void f() { (; }").tokens.len(), 8);
    }
}
