//! The types of the expressions of an assertion: the front end checks a text with them after the shader.

use toyproof_diagnostic::{Code, Diagnostic, File, Files, Span};
use toyproof_glsl::tree::{Scalar, StatementKind, Tree, Type};
use toyproof_glsl::{self as glsl, ADDED_MAIN, Checked};

use super::assertion::{Assertion, Comparison, Relation, Set, Side, Variable};
use super::result::TestError;
use super::source::{GeneratedText, Snippet};
use super::subject::Subject;
use super::value::{Component, components};

/// An assertion about a shader.
pub(super) struct SampledTest<'a> {
    pub(super) assertion: &'a Assertion,
    pub(super) after: Option<&'a Snippet>,
    pub(super) subject: &'a Subject<'a>,
}

/// The types of the expressions.
pub(super) struct Typed {
    pub(super) checked: Checked,
    pub(super) left: Vec<Component>,
    /// The compared values: one for [`Relation::Compare`], two for [`Relation::Within`].
    pub(super) right: Vec<Vec<Component>>,
    pub(super) types: Vec<Type>,
    pub(super) variables: Vec<Vec<Component>>,
    /// The types of the variables, as they are written.
    pub(super) variable_types: Vec<String>,
}

impl SampledTest<'_> {
    pub(super) fn error(at: Span, message: impl Into<String>, help: &str) -> TestError {
        TestError::Test(vec![Diagnostic::new(Code::TestValue, message).at(at).help(help)])
    }

    /// Adds what is evaluated before the test.
    pub(super) fn push_after(&self, text: &mut GeneratedText) {
        for after in self.after.into_iter().chain(&self.assertion.after) {
            text.push("    ");
            text.push_snippet(after);
            text.push(";\n");
        }
    }

    /// The compared expressions beside the first: the right side, or the ends of the range.
    pub(super) fn others(&self) -> Vec<&Snippet> {
        match &self.assertion.relation {
            Relation::Compare(_, right) => vec![&right.expression],
            Relation::Within(low, high) => vec![low, high],
            Relation::Holds | Relation::Increases | Relation::Decreases => Vec::new(),
        }
    }

    /// Checks the expressions, and returns their types.
    pub(super) fn typed(&self) -> Result<Typed, TestError> {
        let assertion = self.assertion;
        let written = |variable: &Variable| match &variable.ty {
            Some(ty) => ty.text().to_owned(),
            None => self.type_of(variable.name.text()),
        };
        let variable_types: Vec<_> = assertion.variables.iter().map(written).collect();
        let mut text = GeneratedText::default();
        text.push("void tpTyped() {\n");
        let mut ends = Vec::new();
        for variable in &assertion.variables {
            match &variable.set {
                Set::Interval(low, high) => ends.extend([low, high]),
                Set::List(values) => ends.extend(values),
            }
        }
        for (variable, ty) in assertion.variables.iter().zip(&variable_types) {
            text.push("    ");
            match &variable.ty {
                Some(ty) => text.push_snippet(ty),
                None => text.push(ty),
            }
            text.push(" ");
            text.push_snippet(&variable.name);
            text.push(";\n");
        }
        let compared = [&assertion.left.expression].into_iter().chain(self.others());
        let typed: Vec<_> = ends.iter().copied().chain(compared).collect();
        for snippet in &typed {
            text.push("    (");
            text.push_snippet(snippet);
            text.push(");\n");
        }
        self.push_after(&mut text);
        text.push(&format!(
            "}}\nvoid {ADDED_MAIN}(out vec4 tpColor, in vec2 tpPlace) {{ tpTyped(); tpColor = vec4(0.0); }}\n"
        ));
        let text = text.after_shader(self.subject);
        let mut files = Files::default();
        let file = files.add(File::new("<test>", text.text()));
        let checked = glsl::check(&files, file, &self.subject.options())
            .map_err(|found| TestError::Test(text.diagnostics(found.into(), assertion.at())))?;
        let types = statement_types(&checked.tree, typed.len());
        let (of_ends, of_sides) = types.split_at(ends.len().min(types.len()));
        let mut of_ends = of_ends.iter().copied();
        let mut variables = Vec::new();
        for (index, variable) in assertion.variables.iter().enumerate() {
            variables.push(Self::variable(&checked, index, variable, &mut of_ends)?);
        }
        let tree = &checked.tree;
        let others = self.others();
        let snippets = [&assertion.left.expression]
            .into_iter()
            .chain(others.iter().copied());
        let mut sides = Vec::new();
        for ((index, snippet), &ty) in snippets.enumerate().zip(of_sides) {
            let path = side_name(index);
            let is_length = self.side(index).is_some_and(|side| side.is_length);
            let found = if is_length {
                let has_length = ty == Type::FLOAT || matches!(ty, Type::Vector(Scalar::Float, _));
                has_length.then(|| components(tree, Type::FLOAT, &path)).flatten()
            } else {
                components(tree, ty, &path)
            };
            let Some(found) = found.filter(|found| !found.is_empty()) else {
                let name = tree.type_name(ty);
                let message = if is_length {
                    format!("bars are the length of a vector, found `{name}`")
                } else {
                    format!("a value of type `{name}` cannot be compared")
                };
                let help = "compare numbers, vectors, matrices, structures or arrays of up to 256 elements";
                return Err(Self::error(snippet.at(), message, help));
            };
            sides.push((found, if is_length { Type::FLOAT } else { ty }));
        }
        if sides.len() != 1 + others.len() {
            return Err(Self::error(assertion.at(), "the test cannot be checked", ""));
        }
        self.check_sides(tree, &sides)?;
        let (mut sides, types): (Vec<_>, Vec<_>) = sides.into_iter().unzip();
        let right = sides.split_off(1);
        Ok(Typed {
            left: sides.remove(0),
            right,
            types,
            variables,
            variable_types,
            checked,
        })
    }

    /// The side with this number.
    pub(super) fn side(&self, index: usize) -> Option<&Side> {
        match (index, &self.assertion.relation) {
            (0, _) => Some(&self.assertion.left),
            (1, Relation::Compare(_, right)) => Some(right),
            _ => None,
        }
    }

    /// The type of a variable that is passed to a function; `float` if it is not.
    fn type_of(&self, name: &str) -> String {
        let sides = [&self.assertion.left.expression].into_iter().chain(self.others());
        let tree = &self.subject.checked.tree;
        for side in sides {
            for (function, position, count) in argument_places(side.text(), name) {
                let mut types = self
                    .subject
                    .functions(function)
                    .filter(|function| function.parameters.len() == count)
                    .map(|function| tree[function.parameters[position]].ty);
                if let Some(first) = types.next()
                    && types.all(|ty| ty == first)
                {
                    return tree.type_name(first);
                }
            }
        }
        "float".to_owned()
    }

    /// The components of a variable, whose values must be of its type.
    fn variable(
        checked: &Checked,
        index: usize,
        variable: &Variable,
        of_values: &mut impl Iterator<Item = Type>,
    ) -> Result<Vec<Component>, TestError> {
        let tree = &checked.tree;
        let name = variable.name.text();
        let declared = tree
            .functions
            .iter()
            .find(|(_, function)| function.name == "tpTyped");
        let body = declared.and_then(|(_, function)| function.body.as_ref());
        let mut declared = body
            .into_iter()
            .flatten()
            .filter_map(|statement| match statement.kind {
                StatementKind::Declare(id) => Some(tree[id].ty),
                _ => None,
            });
        let ty = declared.nth(index).unwrap_or(Type::Error);
        let type_name = tree.type_name(ty);
        let (values, is_interval): (Vec<_>, _) = match &variable.set {
            Set::Interval(low, high) => (vec![low, high], true),
            Set::List(values) => (values.iter().collect(), false),
        };
        let is_numeric = match ty {
            Type::Scalar(scalar) | Type::Vector(scalar, _) => scalar != Scalar::Bool,
            _ => false,
        };
        if is_interval && !is_numeric {
            return Err(Self::error(
                variable.name.at(),
                format!("`{name}` of type `{type_name}` has no interval"),
                "list its values: `for ray in {Ray(vec3(0.0), vec3(0.0, 0.0, -1.0))}`; the type is that of \
                 the parameter for which it is passed, or the one before its name",
            ));
        }
        for value in values {
            let found = of_values.next().unwrap_or(Type::Error);
            let is_scalar = matches!(found, Type::Scalar(scalar) if scalar != Scalar::Bool);
            let converts = is_scalar && is_numeric && (is_interval || matches!(ty, Type::Scalar(_)));
            if found != ty && !converts {
                return Err(Self::error(
                    value.at(),
                    format!(
                        "`{name}` is of type `{type_name}`, and this value of type `{}`",
                        tree.type_name(found)
                    ),
                    "write the type of the variable before its name: `for vec3 p in …`; without one, it is that \
                     of the parameter for which the variable is passed",
                ));
            }
        }
        components(tree, ty, name)
            .ok_or_else(|| Self::error(variable.name.at(), format!("`{name}` has no values"), ""))
    }

    /// Checks that the sides can be compared.
    fn check_sides(&self, tree: &Tree, sides: &[(Vec<Component>, Type)]) -> Result<(), TestError> {
        let assertion = self.assertion;
        let (left, left_type) = &sides[0];
        let left_name = tree.type_name(*left_type);
        let left_at = assertion.left.expression.at();
        let is_vector = |ty: Type| matches!(ty, Type::Scalar(_) | Type::Vector(..) | Type::Matrix { .. });
        let is_ordered = |ty: Type| is_vector(ty) && ty.scalar() != Some(Scalar::Bool);
        match &assertion.relation {
            Relation::Holds if *left_type != Type::BOOL => {
                return Err(Self::error(
                    left_at,
                    format!("the test compares nothing: its expression is of type `{left_name}`"),
                    "add a comparison, such as `== 2.0`",
                ));
            }
            Relation::Increases | Relation::Decreases if left.len() != 1 || !is_ordered(*left_type) => {
                let message = format!("only a number is increasing or decreasing, found `{left_name}`");
                return Err(Self::error(
                    left_at,
                    message,
                    "test each component: `f(x).x is increasing for …`",
                ));
            }
            Relation::Compare(Comparison::Equal | Comparison::Unequal, _) | Relation::Holds => {}
            _ if !is_ordered(*left_type) => {
                let message = format!("values of type `{left_name}` have no order");
                return Err(Self::error(left_at, message, "compare numbers or vectors"));
            }
            _ => {}
        }
        for (other, (_, ty)) in self.others().into_iter().zip(&sides[1..]) {
            // A number stands for all components.
            let fits = |from: Type, from_text: &Snippet, to: Type| {
                let is_integer = from_text
                    .text()
                    .trim_start_matches(['-', '+'])
                    .bytes()
                    .all(|b| b.is_ascii_digit());
                let same_scalar =
                    from.scalar() == to.scalar() || (is_integer && to.scalar() != Some(Scalar::Bool));
                matches!(from, Type::Scalar(_)) && is_vector(to) && same_scalar
            };
            let left_text = &assertion.left.expression;
            if ty != left_type && !fits(*ty, other, *left_type) && !fits(*left_type, left_text, *ty) {
                return Err(Self::error(
                    other.at(),
                    format!(
                        "a value of type `{left_name}` is compared with one of type `{}`",
                        tree.type_name(*ty)
                    ),
                    "compare values of the same type, or a vector with a number for all of its components",
                ));
            }
        }
        Ok(())
    }
}

/// The variable with the value of a side.
pub(super) fn side_name(index: usize) -> String {
    format!("tpSide{index}")
}

/// The types of the first expressions that are statements of `tpTyped`.
fn statement_types(tree: &Tree, count: usize) -> Vec<Type> {
    let function = tree
        .functions
        .iter()
        .find(|(_, function)| function.name == "tpTyped");
    let body = function.and_then(|(_, function)| function.body.as_ref());
    let types = body
        .into_iter()
        .flatten()
        .filter_map(|statement| match statement.kind {
            StatementKind::Expression(id) => Some(tree[id].ty),
            _ => None,
        });
    types.take(count).collect()
}

/// The calls in an expression that have a name as an argument: the function, the position of the argument,
/// and the number of arguments.
fn argument_places<'t>(text: &'t str, name: &str) -> Vec<(&'t str, usize, usize)> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut places = Vec::new();
    for (open, _) in text.match_indices('(') {
        let before = text[..open].trim_end();
        let start = before.rfind(|c| !is_word(c)).map_or(0, |at| at + 1);
        let function = &before[start..];
        if function.is_empty() {
            continue;
        }
        let mut arguments = Vec::new();
        let (mut depth, mut from) = (0, open + 1);
        for (at, c) in text[open..].char_indices() {
            match c {
                '(' | '[' | '{' => depth += 1,
                ')' | ']' | '}' => depth -= 1,
                _ => {}
            }
            if (c == ',' && depth == 1) || depth == 0 {
                arguments.push(text[from..open + at].trim());
                from = open + at + 1;
            }
            if depth == 0 {
                break;
            }
        }
        let found = arguments
            .iter()
            .enumerate()
            .filter(|(_, argument)| **argument == name);
        places.extend(found.map(|(position, _)| (function, position, arguments.len())));
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_calls_with_a_variable_are_found() {
        let found = argument_places("f(p, g(vec2(p), q)) + h ( -p ) + k(p)", "p");
        assert_eq!(found, [("f", 0, 2), ("vec2", 0, 1), ("k", 0, 1)]);
        assert_eq!(argument_places("f(g(a, b), q)", "q"), [("f", 1, 2)]);
    }
}
