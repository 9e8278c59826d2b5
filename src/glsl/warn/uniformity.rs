//! Derivatives, and texture lookups that need them, where neighbouring pixels may have gone another way (§8.8, §8.9).
//!
//! A derivative compares with the neighbours in a quad of 2×2 pixels. Behind an `if` that they may answer differently, their values are
//! undefined: seams and speckles along the edges, and an error in WGSL. What differs between pixels is what comes from
//! `fragCoord` or a texture, or is written where control differs; all else is the same everywhere.

use std::collections::HashMap;

use super::super::codes::Code;
use super::super::tree::{
    BinaryOp, Block, BuiltIn, BuiltInVariable, Condition, Direction, ExprId, ExprKind, FunctionId, Statement,
    StatementKind, Tree, VariableId, VariableKind,
};
use super::Found;
use super::program::{Program, direction};

/// How often all functions are looked at, until nothing more is found to differ. What is left then is taken to differ nowhere.
const MAX_ROUNDS: usize = 12;

pub(super) fn run(program: &Program, found: &mut Found) {
    let tree = program.tree;
    let needs = |expr: ExprId| match tree[expr].kind {
        ExprKind::BuiltIn { function, .. } if needs_neighbours(function) => Some(function),
        _ => None,
    };
    if !program.all_exprs().any(|expr| needs(expr).is_some()) {
        return;
    }
    let mut differing = Differing {
        program,
        variables: vec![false; tree.variables.len()],
        results: vec![false; tree.functions.len()],
        calls: vec![None; tree.functions.len()],
        values: vec![false; tree.exprs.len()],
        loops: HashMap::new(),
        grew: true,
    };
    for (id, variable) in tree.variables.iter() {
        differing.variables[id.index()] = matches!(
            variable.kind,
            VariableKind::BuiltIn(BuiltInVariable::FragCoord | BuiltInVariable::PointCoord)
                | VariableKind::Varying
        );
    }
    for &parameter in &tree[program.main].parameters {
        differing.variables[parameter.index()] = direction(tree, parameter) != Direction::Out;
    }
    for _ in 0..MAX_ROUNDS {
        if !std::mem::take(&mut differing.grew) {
            break;
        }
        // Callers first: what they pass is then known.
        for &function in program.functions.iter().rev() {
            differing.function(function, &mut |_, _| {});
        }
    }
    for &function in &program.functions {
        // One of each kind tells enough of a function.
        let mut told: Vec<bool> = Vec::new();
        differing.function(function, &mut |expr, cause| {
            if let Some(built_in) = needs(expr)
                && !told.contains(&built_in.is_derivative())
            {
                told.push(built_in.is_derivative());
                tell(tree, expr, built_in, cause, found);
            }
        });
    }
}

/// Whether it compares with the neighbours: a derivative, or a lookup that chooses its mip level by one.
fn needs_neighbours(function: BuiltIn) -> bool {
    function.is_derivative()
        || matches!(
            function,
            BuiltIn::Texture | BuiltIn::TextureProj | BuiltIn::TextureOffset | BuiltIn::TextureProjOffset
        )
}

fn tell(tree: &Tree, expr: ExprId, function: BuiltIn, cause: ExprId, found: &mut Found) {
    let name = function.name();
    let (code, message) = if function.is_derivative() {
        let message = format!("`{name}` compares with neighbouring pixels, which may have gone another way");
        (Code::Derivative, message)
    } else {
        let message =
            format!("`{name}` chooses its level by neighbouring pixels, which may have gone another way");
        (Code::ImplicitLod, message)
    };
    found.tell(code, tree[expr].at, message, |diagnostic| {
        let diagnostic = diagnostic.related(tree[cause].at.span, "pixels may differ in this");
        if function.is_derivative() {
            diagnostic.note("its value is then undefined, and WGSL refuses it; compute it before control parts, into a variable")
        } else {
            diagnostic.note("WGSL refuses it; look up before control parts, or say the level: `textureLod(channel, at, 0.0)`")
        }
    });
}

/// What may differ between the pixels of a quad, as far as it is known.
struct Differing<'a> {
    program: &'a Program<'a>,
    /// By index.
    variables: Vec<bool>,
    /// By the index of the function: its result.
    results: Vec<bool>,
    /// By the index of the function: why pixels may differ in whether they call it.
    calls: Vec<Option<ExprId>>,
    /// By the index of the expression: its value, of those looked at last.
    values: Vec<bool>,
    /// Loops that pixels may leave in different rounds, by where their statements lie in memory, and why.
    loops: HashMap<*const Statement, ExprId>,
    grew: bool,
}

/// Why control may differ between pixels here.
#[derive(Clone, Copy)]
struct Control {
    /// Something in this function.
    own: Option<ExprId>,
    /// Something in a caller.
    callers: Option<ExprId>,
}

/// Where control may have parted for the rest of what encloses a statement.
#[derive(Default)]
struct Parted {
    /// Until the function ends.
    function: Option<ExprId>,
    /// Until the loop or `switch` ends.
    exit: Option<ExprId>,
    /// Until the round of the loop ends.
    round: Option<ExprId>,
}

impl Parted {
    fn cause(&self) -> Option<ExprId> {
        self.function.or(self.exit).or(self.round)
    }
}

type Visit<'v> = dyn FnMut(ExprId, ExprId) + 'v;

impl Differing<'_> {
    fn function(&mut self, function: FunctionId, visit: &mut Visit) {
        let tree = self.program.tree;
        if let Some(body) = &tree[function].body {
            let control = Control {
                own: None,
                callers: self.calls[function.index()],
            };
            self.block(function, body, control, &mut Parted::default(), visit);
        }
    }

    fn block(
        &mut self,
        function: FunctionId,
        block: &Block,
        control: Control,
        parted: &mut Parted,
        visit: &mut Visit,
    ) {
        for statement in block {
            let control = Control {
                own: control.own.or(parted.cause()),
                ..control
            };
            self.statement(function, statement, control, parted, visit);
        }
    }

    fn statement(
        &mut self,
        function: FunctionId,
        statement: &Statement,
        control: Control,
        parted: &mut Parted,
        visit: &mut Visit,
    ) {
        let tree = self.program.tree;
        let within = |own: Option<ExprId>| Control {
            own: control.own.or(own),
            ..control
        };
        match &statement.kind {
            StatementKind::Block(body) => self.block(function, body, control, parted, visit),
            StatementKind::If { arms, otherwise } => {
                // Each condition is asked only where those before it did not hold.
                let mut cause = None;
                for arm in arms {
                    self.expression(arm.condition, within(cause), visit);
                    cause = cause.or(self.values[arm.condition.index()].then_some(arm.condition));
                    self.block(function, &arm.body, within(cause), parted, visit);
                }
                if let Some(body) = otherwise {
                    self.block(function, body, within(cause), parted, visit);
                }
            }
            StatementKind::Switch { selector, cases } => {
                self.expression(*selector, control, visit);
                let cause = self.values[selector.index()].then_some(*selector);
                let outer = parted.exit;
                for case in cases {
                    self.block(function, &case.body, within(cause), parted, visit);
                }
                parted.exit = outer;
            }
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                self.block(function, init, control, parted, visit);
                self.repeat(
                    function,
                    statement,
                    (*condition, *step),
                    body,
                    control,
                    parted,
                    visit,
                );
            }
            StatementKind::While { condition, body } => {
                self.repeat(
                    function,
                    statement,
                    (Some(*condition), None),
                    body,
                    control,
                    parted,
                    visit,
                );
            }
            StatementKind::DoWhile { body, condition } => {
                let after = Some(Condition::Expression(*condition));
                self.repeat(function, statement, (after, None), body, control, parted, visit);
            }
            StatementKind::Break => parted.exit = parted.exit.or(control.own),
            StatementKind::Continue => parted.round = parted.round.or(control.own),
            StatementKind::Return(value) => {
                if let Some(value) = value {
                    self.expression(*value, control, visit);
                    if self.values[value.index()] || control.own.is_some() {
                        self.grew |= !std::mem::replace(&mut self.results[function.index()], true);
                    }
                }
                parted.function = parted.function.or(control.own);
            }
            StatementKind::Expression(expr) => self.expression(*expr, control, visit),
            StatementKind::Declare(variable) => {
                if let Some(value) = tree[*variable].initialiser {
                    self.expression(value, control, visit);
                    if self.values[value.index()] || control.own.is_some() {
                        self.mark(*variable);
                    }
                }
            }
            StatementKind::Struct(_) | StatementKind::Discard => {}
        }
    }

    #[expect(
        clippy::too_many_arguments,
        reason = "a loop's parts, and what is handed down to all statements"
    )]
    fn repeat(
        &mut self,
        function: FunctionId,
        statement: &Statement,
        (condition, step): (Option<Condition>, Option<ExprId>),
        body: &Block,
        control: Control,
        parted: &mut Parted,
        visit: &mut Visit,
    ) {
        let tree = self.program.tree;
        let key = std::ptr::from_ref(statement);
        let control = Control {
            own: control.own.or(self.loops.get(&key).copied()),
            ..control
        };
        let condition = condition.and_then(|condition| match condition {
            Condition::Expression(expr) => Some(expr),
            Condition::Declare(variable) => tree[variable].initialiser,
        });
        let mut inner = Parted {
            function: parted.function,
            ..Parted::default()
        };
        let mut cause = None;
        if let Some(condition) = condition {
            self.expression(condition, control, visit);
            cause = self.values[condition.index()].then_some(condition);
        }
        let within = Control {
            own: control.own.or(cause),
            ..control
        };
        self.block(function, body, within, &mut inner, visit);
        // A round that was cut short is over; who left the loop is not back for the step.
        let left = inner.function.or(inner.exit);
        if let Some(step) = step {
            self.expression(
                step,
                Control {
                    own: within.own.or(left),
                    ..within
                },
                visit,
            );
        }
        if let Some(cause) = left.or(cause)
            && !self.loops.contains_key(&key)
        {
            self.loops.insert(key, cause);
            self.grew = true;
        }
        parted.function = inner.function;
    }

    fn mark(&mut self, variable: VariableId) {
        self.grew |= !std::mem::replace(&mut self.variables[variable.index()], true);
    }

    /// Finds what of an expression differs, and what that makes differ.
    fn expression(&mut self, root: ExprId, control: Control, visit: &mut Visit) {
        let tree = self.program.tree;
        for expr in tree.postorder(root) {
            let mut differs = match tree[expr].kind {
                ExprKind::Variable(variable) => self.variables[variable.index()],
                ExprKind::Call { function, .. } => self.results[function.index()],
                _ => false,
            };
            if !matches!(tree[expr].kind, ExprKind::Call { .. }) {
                tree[expr]
                    .kind
                    .for_each_operand(|operand| differs |= self.values[operand.index()]);
            }
            self.values[expr.index()] = differs;
        }
        let mut pending = vec![(root, control)];
        while let Some((expr, control)) = pending.pop() {
            self.effects(expr, control);
            if let Some(cause) = control.own.or(control.callers) {
                visit(expr, cause);
            }
            let within = |condition: ExprId, differs: bool| Control {
                own: control.own.or(differs.then_some(condition)),
                ..control
            };
            match tree[expr].kind {
                ExprKind::Binary {
                    op: BinaryOp::And | BinaryOp::Or,
                    left,
                    right,
                } => {
                    pending.push((right, within(left, self.values[left.index()])));
                    pending.push((left, control));
                }
                ExprKind::Conditional { condition, yes, no } => {
                    let inside = within(condition, self.values[condition.index()]);
                    pending.extend([(no, inside), (yes, inside), (condition, control)]);
                }
                _ => tree[expr]
                    .kind
                    .for_each_operand(|operand| pending.push((operand, control))),
            }
        }
    }

    fn effects(&mut self, expr: ExprId, control: Control) {
        let tree = self.program.tree;
        let mut marked = Vec::new();
        if let ExprKind::Call { function, arguments } = &tree[expr].kind {
            if self.calls[function.index()].is_none()
                && let Some(cause) = control.own.or(control.callers)
            {
                self.calls[function.index()] = Some(cause);
                self.grew = true;
            }
            for (&parameter, &argument) in tree[*function].parameters.iter().zip(arguments) {
                let passed = direction(tree, parameter);
                if passed != Direction::Out && self.values[argument.index()] {
                    marked.push(parameter);
                }
                if passed != Direction::In
                    && passed != Direction::ConstIn
                    && self.variables[parameter.index()]
                {
                    marked.extend(tree.root_variable(argument));
                }
            }
        }
        tree.each_write(expr, |target, _| {
            let Some(variable) = tree.root_variable(target) else {
                return;
            };
            let value = match tree[expr].kind {
                ExprKind::Assign { value, .. } => self.values[value.index()],
                // What a function writes is followed by its parameters.
                ExprKind::Call { .. } => false,
                _ => self.values[expr.index()],
            };
            // What a caller's control makes differ, differs for all that this call sees, but for globals.
            let global = tree[variable].kind == VariableKind::Global && control.callers.is_some();
            if value || control.own.is_some() || global || self.is_indexed_apart(target) {
                marked.push(variable);
            }
        });
        for variable in marked {
            self.mark(variable);
        }
    }

    /// Whether pixels may write different elements.
    fn is_indexed_apart(&self, mut target: ExprId) -> bool {
        loop {
            target = match self.program.tree[target].kind {
                ExprKind::Index { index, .. } if self.values[index.index()] => return true,
                ExprKind::Index { base, .. }
                | ExprKind::Swizzle { vector: base, .. }
                | ExprKind::Member { structure: base, .. } => base,
                _ => return false,
            };
        }
    }
}
