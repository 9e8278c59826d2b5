//! The functions that a shader has in common with its reference, such as those of a handout: the mistake is
//! elsewhere. Layout, comments, and the names of functions and local variables do not count.

use std::collections::{HashMap, HashSet};
use std::fmt::{self, Write as _};

use toyproof_glsl::tree::{
    ExprId, ExprKind, FunctionId, Item, Statement, StatementKind, Tree, VariableId, VariableKind, walk,
};

/// The definitions of a shader's functions, in a form that equal functions share.
#[derive(Debug, Default)]
pub(crate) struct Definitions(HashSet<String>);

impl Definitions {
    /// The definitions of all functions of some trees.
    pub(crate) fn new(trees: &[&Tree]) -> Self {
        let definitions = trees.iter().flat_map(|tree| definitions(tree).into_values());
        Self(definitions.collect())
    }

    /// The functions of a shader that are defined here, too.
    pub(super) fn shared_with(&self, tree: &Tree) -> HashSet<FunctionId> {
        let functions = definitions(tree).into_iter();
        functions
            .filter(|(_, definition)| self.0.contains(definition))
            .map(|(function, _)| function)
            .collect()
    }
}

/// The definition of each function that has a body; a function that is called counts with its own.
fn definitions(tree: &Tree) -> HashMap<FunctionId, String> {
    let mut definitions = HashMap::new();
    for item in &tree.items {
        if let Item::Function(function) = *item {
            let mut writer = Writer {
                tree,
                functions: &definitions,
                locals: HashMap::new(),
                out: String::new(),
            };
            if writer.function(function).is_ok() {
                let definition = writer.out;
                definitions.insert(function, definition);
            }
        }
    }
    definitions
}

/// Writes a function.
struct Writer<'a> {
    tree: &'a Tree,
    /// The functions before it.
    functions: &'a HashMap<FunctionId, String>,
    /// The numbers of its parameters and variables, in the order of their declarations.
    locals: HashMap<VariableId, usize>,
    out: String,
}

impl Writer<'_> {
    /// Fails if it calls a function that is defined after it.
    fn function(&mut self, function: FunctionId) -> fmt::Result {
        let tree = self.tree;
        let function = &tree[function];
        write!(self.out, "{}", tree.type_name(function.return_type))?;
        for &parameter in &function.parameters {
            self.declare(parameter)?;
        }
        self.block(function.body.as_deref().unwrap_or_default())
    }

    fn declare(&mut self, variable: VariableId) -> fmt::Result {
        let number = self.locals.len();
        self.locals.insert(variable, number);
        let declared = &self.tree[variable];
        write!(
            self.out,
            " {:?} {}",
            declared.kind,
            self.tree.type_name(declared.ty)
        )
    }

    fn block(&mut self, block: &[Statement]) -> fmt::Result {
        self.out.push('{');
        for statement in block {
            self.statement(statement)?;
        }
        self.out.push('}');
        Ok(())
    }

    fn statement(&mut self, statement: &Statement) -> fmt::Result {
        self.out.push_str(match &statement.kind {
            StatementKind::Expression(_) => ";",
            StatementKind::Declare(_) => "declare",
            StatementKind::Struct(_) => "struct",
            StatementKind::Block(_) => "block",
            StatementKind::If { otherwise: None, .. } => "if",
            StatementKind::If { .. } => "if-else",
            StatementKind::Switch { .. } => "switch",
            StatementKind::For { .. } => "for",
            StatementKind::While { .. } => "while",
            StatementKind::DoWhile { .. } => "do",
            StatementKind::Break => "break",
            StatementKind::Continue => "continue",
            StatementKind::Return(_) => "return",
            StatementKind::Discard => "discard",
        });
        if let Some(variable) = walk::declared(statement) {
            self.declare(variable)?;
        }
        let mut blocks = walk::child_blocks(statement).into_iter();
        if let StatementKind::For { .. } = statement.kind
            && let Some(init) = blocks.next()
        {
            // Its variables are read by the condition.
            self.block(init)?;
        }
        if let StatementKind::Switch { cases, .. } = &statement.kind {
            for case in cases {
                write!(self.out, "{}:", case.labels.len())?;
                for label in walk::values(&case.labels) {
                    self.expression(label)?;
                }
            }
        }
        for expression in walk::own_expressions(self.tree, statement) {
            self.expression(expression)?;
        }
        blocks.try_for_each(|block| self.block(block))
    }

    fn expression(&mut self, root: ExprId) -> fmt::Result {
        for expr in self.tree.postorder(root) {
            // The value of a constant is an expression in place of a name.
            if !self.out.ends_with(' ') {
                self.out.push(' ');
            }
            self.operation(expr)?;
        }
        Ok(())
    }

    /// Writes an expression without its operands.
    fn operation(&mut self, expr: ExprId) -> fmt::Result {
        let tree = self.tree;
        let out = &mut self.out;
        match &tree[expr].kind {
            ExprKind::Literal(literal) => write!(out, "{:?}", literal.value),
            ExprKind::Variable(variable) => self.variable(*variable),
            ExprKind::Unary { op, .. } => out.write_str(op.symbol()),
            ExprKind::Binary { op, .. } => out.write_str(op.symbol()),
            ExprKind::Assign { op, .. } => write!(out, "{op:?}="),
            ExprKind::Step { op, postfix, .. } => write!(out, "{op:?}{postfix}"),
            ExprKind::Conditional { .. } => out.write_str("?:"),
            ExprKind::Sequence { .. } => out.write_str(","),
            ExprKind::Call { function, .. } => {
                let definition = self.functions.get(function).ok_or(fmt::Error)?;
                write!(out, "call [{definition}]")
            }
            ExprKind::BuiltIn { function, arguments } => {
                write!(out, "{} {}", function.name(), arguments.len())
            }
            ExprKind::Construct { arguments, .. } => {
                write!(out, "{} {}", tree.type_name(tree[expr].ty), arguments.len())
            }
            ExprKind::Swizzle { components, .. } => out.write_str(&components.name()),
            ExprKind::Member { member, .. } => write!(out, "member {member}"),
            ExprKind::Index { .. } => out.write_str("[]"),
            ExprKind::Length { .. } => out.write_str("length"),
        }
    }

    fn variable(&mut self, variable: VariableId) -> fmt::Result {
        if let Some(number) = self.locals.get(&variable) {
            return write!(self.out, "local {number}");
        }
        let global = &self.tree[variable];
        match (global.kind, global.initializer) {
            // The value of a constant counts, not its name.
            (VariableKind::Const, Some(value)) => self.expression(value),
            _ => write!(self.out, "{:?} {}", global.kind, global.name),
        }
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl::{self as glsl, Checked};

    use super::*;

    fn checked(text: &str) -> Checked {
        let mut files = Files::default();
        let file = files.add(File::new("a.glsl", text));
        glsl::check(&files, file, &glsl::Options::default()).unwrap()
    }

    #[test]
    fn functions_are_shared_whatever_their_names_and_layout() {
        let reference = checked(
            "const float K = 43758.5;
             float hash(vec2 p) { return fract(sin(dot(p, vec2(12.9, 78.2))) * K); }
             float noise(vec2 p) { float sum = 0.; for (int i = 0; i < 4; i++) sum += hash(p * float(i)); return sum; }
             void mainImage(out vec4 c, in vec2 p) { c = vec4(noise(p)); }",
        );
        let definitions = Definitions::new(&[&reference.tree]);
        let shared = |text: &str| {
            let checked = checked(text);
            let shared = definitions.shared_with(&checked.tree).into_iter();
            let mut names: Vec<String> = shared.map(|id| checked.tree[id].name.clone()).collect();
            names.sort();
            names
        };
        let submission = |hash: &str, noise: &str| {
            format!(
                "float h(vec2 at) {{ {hash} }}
                 float n(vec2 at) {{ float s = 0.; for (int k = 0; k < {noise}; k++) s += h(at * float(k)); return s; }}
                 void mainImage(out vec4 color, in vec2 at) {{ color = vec4(n(at), 0., 0., 1.); }}"
            )
        };
        let given = "return fract(sin(dot(at, vec2(12.9, 78.2))) * 43758.5);";
        assert_eq!(shared(&submission(given, "4")), ["h", "n"]);
        assert_eq!(shared(&submission(given, "5")), ["h"]);
        // A function is not shared if one that it calls is not.
        assert!(
            shared(&submission(
                "return fract(sin(dot(at, vec2(12.9, 78.3))) * 43758.5);",
                "4"
            ))
            .is_empty()
        );
        assert!(
            shared(&submission(
                "return fract(cos(dot(at, vec2(12.9, 78.2))) * 43758.5);",
                "4"
            ))
            .is_empty()
        );
    }
}
