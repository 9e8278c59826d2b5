//! The parts of a shader that an edit may change: its expressions that have a value, its statements, and the
//! variables in scope at each.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use toyproof_diagnostic::Span;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{
    Block, Condition, Direction, ExprId, ExprKind, FunctionId, Item, Place, Statement, StatementKind, Tree,
    Type, VariableId, VariableKind, walk,
};

/// The largest number of variables in scope that edits use, the innermost ones.
const MAX_SCOPE: usize = 200;

/// A shader's sites and statements.
#[derive(Debug)]
pub(super) struct Shader<'a> {
    pub(super) checked: &'a Checked,
    pub(super) tree: &'a Tree,
    pub(super) source: &'a str,
    /// In source order of their statements, operands before their users.
    pub(super) sites: Vec<Site>,
    pub(super) statements: Vec<StatementSite>,
    /// The functions that the reference has, too.
    pub(super) copied: HashSet<FunctionId>,
}

/// An expression that has a value, or an assignment.
#[derive(Debug)]
pub(super) struct Site {
    /// The expression; several if they are the uses of a macro, whose body holds the text.
    pub(super) exprs: Vec<ExprId>,
    /// The expression that uses the value, if any.
    pub(super) user: Option<ExprId>,
    /// The index of its statement.
    pub(super) statement: usize,
    /// Its text.
    pub(super) span: Span,
}

/// A statement, or a declaration at global scope.
#[derive(Debug)]
pub(super) struct StatementSite {
    /// Its function and its number in it, in pre-order; `None` at global scope.
    pub(super) at: Option<StatementId>,
    /// Its first line, up to the end of the statement or of its head.
    pub(super) span: Span,
    pub(super) kind: Shape,
    /// The variables in scope, the innermost last.
    pub(super) scope: Arc<[VariableId]>,
    /// The index of the next statement of the same block.
    pub(super) next: Option<usize>,
    /// Whether its text comes from a macro.
    pub(super) is_expanded: bool,
}

/// The facts about a statement that edits depend on.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Shape {
    Declaration(VariableId),
    Expression(ExprId),
    /// An `if`; whether it has one arm and no `else`.
    If {
        is_single: bool,
    },
    Loop,
    Jump,
    Return,
    Other,
}

/// Identifies a statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct StatementId {
    pub(super) function: FunctionId,
    /// Its number in pre-order.
    pub(super) number: usize,
}

impl<'a> Shader<'a> {
    /// Collects the sites of the functions that can be reached and of the global declarations.
    pub(super) fn new(checked: &'a Checked, source: &'a str) -> Self {
        let mut collector = Collector {
            shader: Self {
                checked,
                tree: &checked.tree,
                source,
                sites: Vec::new(),
                statements: Vec::new(),
                copied: HashSet::new(),
            },
            scope: Vec::new(),
            macro_sites: HashMap::new(),
            number: 0,
        };
        collector.inputs();
        for item in &checked.tree.items {
            match *item {
                Item::Variable(variable) => collector.global(variable),
                Item::Function(function) => collector.function(function),
                Item::Struct(_) | Item::Prototype(_) => {}
            }
        }
        collector.shader
    }

    /// The text of a span.
    pub(super) fn text(&self, span: Span) -> &'a str {
        super::term::slice(self.source, span)
    }
}

struct Collector<'a> {
    shader: Shader<'a>,
    scope: Vec<VariableId>,
    /// The sites in macro bodies, by their spelling.
    macro_sites: HashMap<Span, usize>,
    /// The number of the next statement of the function.
    number: usize,
}

impl Collector<'_> {
    /// The uniforms and built-in variables that the shader can use.
    fn inputs(&mut self) {
        let tree = self.shader.tree;
        let inputs = tree
            .variables
            .iter()
            .filter(|(_, variable)| variable.kind.is_input());
        self.scope.extend(inputs.map(|(id, _)| id));
    }

    fn global(&mut self, variable: VariableId) {
        let tree = self.shader.tree;
        if let (Some(at), Some(initializer)) = (tree[variable].at, tree[variable].initializer) {
            let statement =
                self.statement_site(None, at.to(tree[initializer].at), Shape::Declaration(variable));
            self.expression(initializer, None, statement);
        }
        self.scope.push(variable);
    }

    fn function(&mut self, function: FunctionId) {
        let tree = self.shader.tree;
        let Some(body) = &tree[function].body else {
            return;
        };
        let outer = self.scope.len();
        self.scope.extend(&tree[function].parameters);
        self.number = 0;
        self.block(function, body);
        self.scope.truncate(outer);
    }

    fn block(&mut self, function: FunctionId, block: &Block) {
        let outer = self.scope.len();
        let mut before: Option<usize> = None;
        for statement in block {
            let index = self.statement(function, statement);
            if let Some(before) = before {
                self.shader.statements[before].next = Some(index);
            }
            before = Some(index);
        }
        self.scope.truncate(outer);
    }

    fn statement(&mut self, function: FunctionId, statement: &Statement) -> usize {
        let tree = self.shader.tree;
        let id = StatementId {
            function,
            number: self.number,
        };
        self.number += 1;
        let shape = match &statement.kind {
            StatementKind::Declare(variable) => Shape::Declaration(*variable),
            StatementKind::Expression(expr) => Shape::Expression(*expr),
            StatementKind::If { arms, otherwise } => Shape::If {
                is_single: arms.len() == 1 && otherwise.is_none(),
            },
            StatementKind::Break | StatementKind::Continue | StatementKind::Discard => Shape::Jump,
            StatementKind::Return(_) => Shape::Return,
            StatementKind::For { .. } | StatementKind::While { .. } | StatementKind::DoWhile { .. } => {
                Shape::Loop
            }
            _ => Shape::Other,
        };
        let at = match &statement.kind {
            StatementKind::If { arms, .. } => statement.at.to(tree[arms[0].condition].at),
            _ => statement.at,
        };
        let index = self.statement_site(Some(id), at, shape);
        let outer = self.scope.len();
        if let StatementKind::For { init, .. } = &statement.kind {
            for inner in init {
                for expr in walk::own_expressions(tree, inner) {
                    self.expression(expr, None, index);
                }
                self.scope.extend(walk::declared(inner));
            }
        }
        for expr in walk::own_expressions(tree, statement) {
            self.expression(expr, None, index);
        }
        if let Some(Condition::Declare(variable)) = condition(statement) {
            self.scope.push(variable);
        }
        match &statement.kind {
            StatementKind::For { body, .. } => self.block(function, body),
            _ => {
                for body in walk::child_blocks(statement) {
                    self.block(function, body);
                }
            }
        }
        self.scope.truncate(outer);
        if let StatementKind::Declare(variable) = statement.kind {
            self.scope.push(variable);
        }
        index
    }

    fn statement_site(&mut self, at: Option<StatementId>, place: Place, kind: Shape) -> usize {
        self.shader.statements.push(StatementSite {
            at,
            span: place.span,
            kind,
            scope: self.scope[self.scope.len().saturating_sub(MAX_SCOPE)..].into(),
            next: None,
            is_expanded: place.is_expanded(),
        });
        self.shader.statements.len() - 1
    }

    /// Collects an expression's sites. Chains may be thousands of operators long, so there is no recursion.
    fn expression(&mut self, root: ExprId, user: Option<ExprId>, statement: usize) {
        let tree = self.shader.tree;
        let mut users: HashMap<ExprId, Option<ExprId>> = HashMap::from([(root, user)]);
        // Lvalues have no value that could be replaced; their indices do.
        let mut lvalues: Vec<ExprId> = Vec::new();
        let order = tree.postorder(root);
        for &expr in order.iter().rev() {
            tree[expr].kind.for_each_operand(|operand| {
                users.insert(operand, Some(expr));
            });
            lvalues.extend(written(tree, expr));
        }
        let mut parts_of_lvalues: HashSet<ExprId> = HashSet::new();
        for lvalue in lvalues {
            let mut part = Some(lvalue);
            while let Some(expr) = part {
                parts_of_lvalues.insert(expr);
                part = match tree[expr].kind {
                    ExprKind::Swizzle { vector: base, .. }
                    | ExprKind::Member { structure: base, .. }
                    | ExprKind::Index { base, .. } => Some(base),
                    _ => None,
                };
            }
        }
        for expr in order {
            let has_value = !matches!(tree[expr].ty, Type::Void | Type::Sampler(_) | Type::Error);
            let is_step = matches!(tree[expr].kind, ExprKind::Step { .. });
            if has_value && !is_step && !parts_of_lvalues.contains(&expr) {
                self.site(expr, users[&expr], statement);
            }
        }
    }

    fn site(&mut self, expr: ExprId, user: Option<ExprId>, statement: usize) {
        let at = self.shader.tree[expr].at;
        if at.is_expanded()
            && let Some(&known) = self.macro_sites.get(&at.spelling)
        {
            self.shader.sites[known].exprs.push(expr);
            return;
        }
        if at.is_expanded() {
            // Only literals mean the same in each use of a macro.
            if !matches!(self.shader.tree[expr].kind, ExprKind::Literal(_)) {
                return;
            }
            self.macro_sites.insert(at.spelling, self.shader.sites.len());
        }
        self.shader.sites.push(Site {
            exprs: vec![expr],
            user,
            statement,
            span: at.spelling,
        });
    }
}

/// The lvalues that an expression writes itself.
pub(crate) fn written(tree: &Tree, expr: ExprId) -> Vec<ExprId> {
    match &tree[expr].kind {
        ExprKind::Assign { target, .. } | ExprKind::Step { target, .. } => vec![*target],
        ExprKind::Call { function, arguments } => {
            let parameters = tree[*function].parameters.iter();
            let is_out = |parameter: &VariableId| {
                let kind = tree[*parameter].kind;
                matches!(kind, VariableKind::Parameter(Direction::Out | Direction::InOut))
            };
            let pairs = parameters.zip(arguments);
            pairs
                .filter(|(parameter, _)| is_out(parameter))
                .map(|(_, &argument)| argument)
                .collect()
        }
        ExprKind::BuiltIn { function, arguments } => function
            .out_parameter()
            .map(|at| arguments[at])
            .into_iter()
            .collect(),
        _ => Vec::new(),
    }
}

fn condition(statement: &Statement) -> Option<Condition> {
    match &statement.kind {
        StatementKind::While { condition, .. } => Some(*condition),
        StatementKind::For { condition, .. } => *condition,
        _ => None,
    }
}

/// Rebuilds a function's body: `change` gets each statement with its number in pre-order, and appends what
/// takes its place. Nested statements are done first.
pub(super) fn renumbered(
    block: Block,
    number: &mut usize,
    change: &mut dyn FnMut(usize, Statement, &mut Block),
) -> Block {
    let mut out = Block::with_capacity(block.len());
    for mut statement in block {
        let own = *number;
        *number += 1;
        for body in walk::statement_blocks_mut(&mut statement) {
            *body = renumbered(std::mem::take(body), number, change);
        }
        change(own, statement, &mut out);
    }
    out
}

/// Returns a copy of the statement with that number.
pub(super) fn find(block: &[Statement], number: &mut usize, wanted: usize) -> Option<Statement> {
    for statement in block {
        if *number == wanted {
            return Some(statement.clone());
        }
        *number += 1;
        let bodies: Vec<&Block> = match &statement.kind {
            StatementKind::For { body, .. } => vec![body],
            _ => walk::child_blocks(statement),
        };
        for body in bodies {
            if let Some(found) = find(body, number, wanted) {
                return Some(found);
            }
        }
    }
    None
}
