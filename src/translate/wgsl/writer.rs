//! The state of printing: lines, names, types, and facts about variables. The side effects of an expression
//! are printed as lines before its statement, which leaves a pure value.

use std::collections::{BTreeMap, HashMap, HashSet};

use toyproof_diagnostic::{Code, Deadline, Diagnostic, Files};
use toyproof_glsl::tree::{
    BinaryOp, Direction, ExprId, ExprKind, FunctionId, Place, Scalar, Type, VariableId, VariableKind, walk,
};

use super::Unprintable;
use super::names::Names;
use super::style::Style;
use crate::author::{Comments, MacroConstants, SourceText};
use crate::lower::context::LoweringContext;
use crate::print::{Order, wrap};

/// Prints a lowered shader.
pub(super) struct Writer<'a> {
    pub(super) cx: &'a LoweringContext,
    pub(super) names: &'a Names,
    pub(super) facts: &'a Facts,
    pub(super) style: Style,
    pub(super) comments: Comments<'a>,
    pub(super) source: SourceText<'a>,
    pub(super) deadline: &'a Deadline,
    pub(super) out: String,
    pub(super) indent: usize,
    /// Generated names in use in this function.
    pub(super) temporaries: HashSet<String>,
    /// Whether literals get suffixes, so that WGSL evaluates expressions of literals in 32 bits too.
    pub(super) suffixed: bool,
    /// Whether expressions consist of literals only, as far as determined.
    pub(super) abstract_numbers: HashMap<ExprId, bool>,
    /// Increments that are deferred to the end of their statement.
    pub(super) deferred_steps: HashSet<ExprId>,
    /// Whether expressions need lines before their value, as far as determined.
    pub(super) hoisting: HashMap<ExprId, bool>,
    /// The constants that macros become.
    pub(super) macros: MacroConstants,
    /// Helper functions that are called, by name.
    pub(super) helpers: BTreeMap<String, String>,
    /// The innermost expression that could not be printed.
    pub(super) failed_at: Option<Place>,
    /// The members of the block of the author's uniforms, each with its value as a comment, and the author's
    /// comments.
    pub(super) uniforms: Vec<String>,
    /// Whether derivatives are used, explicitly or for implicit levels of detail.
    pub(super) uses_derivatives: bool,
    /// Whether `gl_FragCoord` is read other than by `mainImage`'s caller.
    pub(super) reads_position: bool,
}

impl<'a> Writer<'a> {
    pub(super) fn new(
        cx: &'a LoweringContext,
        names: &'a Names,
        facts: &'a Facts,
        order: &Order,
        style: Style,
        files: &'a Files,
        deadline: &'a Deadline,
    ) -> Self {
        Self {
            cx,
            names,
            facts,
            style,
            comments: Comments::new(files, &cx.tree, &order.items),
            source: SourceText::new(files),
            deadline,
            out: String::new(),
            indent: 0,
            temporaries: HashSet::new(),
            abstract_numbers: HashMap::new(),
            suffixed: false,
            deferred_steps: HashSet::new(),
            hoisting: HashMap::new(),
            macros: MacroConstants::default(),
            helpers: BTreeMap::new(),
            failed_at: None,
            uniforms: Vec::new(),
            uses_derivatives: false,
            reads_position: false,
        }
    }

    /// Fails if the deadline has passed; [`super::wgsl`] then reports that instead.
    pub(super) fn check_deadline(&self) -> Result<(), Unprintable> {
        if self.deadline.is_over() {
            return Err(Unprintable::Construct("a shader that exceeds the time limit"));
        }
        Ok(())
    }

    /// Prints a line at the current indentation.
    pub(super) fn line(&mut self, text: &str) {
        // Blank lines are empty.
        let indent = if text.is_empty() { 0 } else { self.indent };
        self.out += &"    ".repeat(indent);
        self.out += text;
        self.out.push('\n');
    }

    /// Prints lines indented by one more level.
    pub(super) fn indented<T>(&mut self, inside: impl FnOnce(&mut Self) -> T) -> T {
        self.indent += 1;
        let value = inside(self);
        self.indent -= 1;
        value
    }

    /// Prints comments and blank lines, which are empty. A block does not begin with a blank line, and none
    /// follows another.
    pub(super) fn comment_lines(&mut self, lines: &[String]) {
        for line in lines {
            let is_repeated = self.out == "\n" || self.out.ends_with("\n\n") || self.out.ends_with("{\n");
            if !(line.is_empty() && is_repeated) {
                self.line(line);
            }
        }
    }

    /// Prints a comment at the end of the line printed since `from`, or above it if there are several.
    pub(super) fn trailing_comment(&mut self, comment: Option<String>, from: usize) {
        let Some(comment) = comment else {
            return;
        };
        let is_one_line = self.out[from..].matches('\n').count() == 1;
        if is_one_line {
            self.out.pop();
            self.out.push(' ');
            self.out.push_str(&comment);
            self.out.push('\n');
        } else {
            let lines = self.out.split_off(from);
            self.line(&comment);
            self.out.push_str(&lines);
        }
    }

    /// Returns a generated name that is not in use.
    pub(super) fn temporary(&mut self, stem: &str) -> String {
        let is_taken = |name: &str| {
            super::names::is_taken(name) || self.names.all.contains(name) || self.temporaries.contains(name)
        };
        let name = super::names::free(stem, is_taken);
        self.temporaries.insert(name.clone());
        name
    }

    pub(super) fn variable(&self, id: VariableId) -> &'a str {
        self.names.variables.get(&id).unwrap_or(&self.cx.tree[id].name)
    }

    pub(super) fn function(&self, id: FunctionId) -> &'a str {
        self.names.functions.get(&id).unwrap_or(&self.cx.tree[id].name)
    }

    pub(super) fn type_name(&self, ty: Type) -> String {
        type_name(self.cx, self.names, ty)
    }

    /// Adds the place of the expression that could not be printed.
    fn placed(&self, why: Unprintable) -> Unprintable {
        match (why, self.failed_at) {
            (Unprintable::Construct(what), Some(at)) => {
                let style = self.style.name();
                let message = format!("{what} is not supported in the style `{style}`");
                Unprintable::Host(Box::new(
                    Diagnostic::new(Code::UnsupportedByTarget, message)
                        .at(at.span)
                        .help("use `--style plain`, which supports it"),
                ))
            }
            (why, _) => why,
        }
    }

    /// Prints the whole text: the author's first comment, and the items in the style's code.
    pub(super) fn write(mut self, order: &Order) -> Result<String, Unprintable> {
        let mut first = self
            .comments
            .first(self.cx.tree[self.cx.main_image].at)
            .join("\n");
        if !first.is_empty() {
            first.push_str("\n\n");
        }
        for &item in &order.items {
            let printed = self.item(item);
            printed.map_err(|why| self.placed(why))?;
        }
        let items = std::mem::take(&mut self.out);
        let [head, end] = self.style_code(order)?;
        let mut text = first + &head;
        let constants = self.macros.declarations(&mut self.comments);
        if !constants.is_empty() {
            text.push_str(&constants);
            text.push('\n');
        }
        for helper in self.helpers.values() {
            text.push_str(helper);
            text.push('\n');
        }
        text.push_str(&wrap(items.trim_start_matches('\n'), 1));
        text.push_str(&self.comments.rest());
        text.push_str(&end);
        Ok(text)
    }
}

/// The WGSL name of a type.
pub(super) fn type_name(cx: &LoweringContext, names: &Names, ty: Type) -> String {
    let suffix = |scalar| match scalar {
        Scalar::Float => Some('f'),
        Scalar::Int => Some('i'),
        Scalar::Uint => Some('u'),
        Scalar::Bool => None,
    };
    match ty {
        Type::Scalar(scalar) => scalar_name(scalar).to_owned(),
        Type::Vector(scalar, size) => match suffix(scalar) {
            Some(suffix) => format!("vec{size}{suffix}"),
            None => format!("vec{size}<bool>"),
        },
        Type::Matrix { columns, rows } => format!("mat{columns}x{rows}f"),
        Type::Struct(id) => names.structs.get(&id).cloned().unwrap_or_default(),
        Type::Array(id) => {
            let array = cx.tree.array(id);
            format!("array<{}, {}>", type_name(cx, names, array.element), array.size)
        }
        Type::Void | Type::Sampler(_) | Type::Error => String::new(),
    }
}

/// The WGSL name of a scalar type.
pub(super) fn scalar_name(scalar: Scalar) -> &'static str {
    match scalar {
        Scalar::Bool => "bool",
        Scalar::Int => "i32",
        Scalar::Uint => "u32",
        Scalar::Float => "f32",
    }
}

/// The syntactic class of an expression, which determines where it needs parentheses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Class {
    Primary,
    Unary,
    Product,
    Sum,
    Relation,
    /// An operator that needs no parentheses only in chains of itself.
    Chain(BinaryOp),
}

/// The code of a value.
#[derive(Debug, Clone)]
pub(super) struct Text {
    pub(super) code: String,
    pub(super) class: Class,
}

pub(super) type TextResult = Result<Text, Unprintable>;

impl Text {
    pub(super) fn new(code: impl Into<String>, class: Class) -> Self {
        let code = code.into();
        Self { code, class }
    }

    pub(super) fn primary(code: impl Into<String>) -> Self {
        Self::new(code, Class::Primary)
    }

    /// Returns the code, in parentheses unless its class is among `bare`.
    pub(super) fn within(self, bare: &[Class]) -> String {
        if bare.contains(&self.class) {
            self.code
        } else {
            format!("({})", self.code)
        }
    }

    /// Returns the code as a side of a comparison.
    pub(super) fn term(self) -> String {
        self.within(&[Class::Primary, Class::Unary, Class::Product, Class::Sum])
    }

    /// Returns the code as the operand of `.`, `[` or a unary operator.
    pub(super) fn operand(self) -> String {
        self.within(&[Class::Primary])
    }
}

/// Facts about the variables and functions of a shader.
#[derive(Default)]
pub(super) struct Facts {
    /// Variables written after their initialization, in whole or in part: they must be `var`s.
    pub(super) written: HashSet<VariableId>,
    /// Variables with a dynamic index: an array or matrix must then be in memory.
    pub(super) indexed: HashSet<VariableId>,
    pub(super) called: HashSet<FunctionId>,
    /// The globals that each function names.
    pub(super) globals: HashMap<FunctionId, HashSet<VariableId>>,
}

impl Facts {
    pub(super) fn new(cx: &LoweringContext) -> Self {
        let tree = &cx.tree;
        let mut facts = Self::default();
        let write = |written: &mut HashSet<VariableId>, target: ExprId| {
            written.extend(tree.root_variable(target));
        };
        for id in printed_expressions(cx) {
            match &tree[id].kind {
                ExprKind::Assign { target, .. } | ExprKind::Step { target, .. } => {
                    write(&mut facts.written, *target);
                }
                ExprKind::Call { function, arguments } => {
                    facts.called.insert(*function);
                    for (argument, parameter) in arguments.iter().zip(&tree[*function].parameters) {
                        if is_out(cx, *parameter) {
                            write(&mut facts.written, *argument);
                        }
                    }
                }
                ExprKind::BuiltIn { function, arguments } => {
                    if let Some(&argument) = function.out_parameter().and_then(|at| arguments.get(at)) {
                        write(&mut facts.written, argument);
                    }
                }
                &ExprKind::Index { base, index }
                    if !tree[index].constant
                        && matches!(tree[base].ty, Type::Array(_) | Type::Matrix { .. }) =>
                {
                    facts.indexed.extend(tree.root_variable(base));
                }
                _ => {}
            }
        }
        for (id, function) in tree.functions.iter() {
            let named = facts.globals.entry(id).or_default();
            for root in function.body.iter().flat_map(|body| walk::roots(tree, body)) {
                for expr in tree.postorder(root) {
                    if let ExprKind::Variable(variable) = tree[expr].kind
                        && matches!(tree[variable].kind, VariableKind::Global | VariableKind::Const)
                    {
                        named.insert(variable);
                    }
                }
            }
        }
        facts
    }

    /// Whether a local or parameter must be in memory.
    pub(super) fn is_memory(&self, variable: VariableId) -> bool {
        self.written.contains(&variable) || self.indexed.contains(&variable)
    }
}

/// The expressions that are printed: lowering leaves others in the tree.
fn printed_expressions(cx: &LoweringContext) -> Vec<ExprId> {
    let tree = &cx.tree;
    let bodies = tree
        .functions
        .iter()
        .filter_map(|(_, function)| function.body.as_ref());
    let roots = bodies.flat_map(|body| walk::roots(tree, body));
    let globals = tree
        .variables
        .iter()
        .filter_map(|(_, variable)| variable.initializer);
    roots
        .chain(globals)
        .flat_map(|root| tree.postorder(root))
        .collect()
}

/// Whether a parameter is passed by pointer.
pub(super) fn is_out(cx: &LoweringContext, parameter: VariableId) -> bool {
    matches!(
        cx.tree[parameter].kind,
        VariableKind::Parameter(Direction::Out | Direction::InOut)
    )
}
