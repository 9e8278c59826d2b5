//! Derivatives, and texture lookups that need them, in non-uniform control flow (§8.8, §8.9).
//!
//! A derivative is a difference within a quad of 2×2 pixels. Inside an `if` whose condition differs within
//! the quad, it is undefined, which shows as seams and speckles along edges, and is an error in WGSL. A value
//! diverges if it comes from `fragCoord` or a texture, or is written in divergent control flow; all other
//! values are uniform.

use std::collections::HashMap;

use toyproof_diagnostic::Code;
use toyproof_glsl::tree::{
    BinaryOp, Block, BuiltIn, BuiltInVariable, Condition, Direction, ExprId, ExprKind, FunctionId, Statement,
    StatementKind, Tree, Value, VariableId, VariableKind,
};

use super::Findings;
use super::program::{Program, direction};

/// The maximum number of mip levels of a texture: a bias of minus this selects level 0.
const MAX_MIP_LEVELS: f64 = 15.0;

pub(super) fn run(program: &Program, findings: &mut Findings) {
    let tree = program.tree;
    let quad_function = |expr: ExprId| match tree[expr].kind {
        ExprKind::BuiltIn { function, .. } if uses_quad_neighbors(function) => Some(function),
        _ => None,
    };
    if !program.all_exprs().any(|expr| quad_function(expr).is_some()) {
        return;
    }
    let mut analysis = DivergenceAnalysis::new(program);
    for &function in &program.functions {
        // One report of each kind is enough for a function.
        let mut reported: Vec<bool> = Vec::new();
        analysis.function(function, &mut |expr, cause, values| {
            if let Some(built_in) = quad_function(expr)
                && !reported.contains(&built_in.is_derivative())
                && (built_in.is_derivative() || may_change_mip_level(program, expr, values))
            {
                reported.push(built_in.is_derivative());
                report(tree, expr, built_in, cause, findings);
            }
        });
    }
}

/// Whether a function reads neighboring pixels: a derivative, or a lookup that selects its mip level by one.
fn uses_quad_neighbors(function: BuiltIn) -> bool {
    function.is_derivative()
        || matches!(
            function,
            BuiltIn::Texture | BuiltIn::TextureProj | BuiltIn::TextureOffset | BuiltIn::TextureProjOffset
        )
}

/// Whether non-uniform control flow may change the mip level of a lookup. Its coordinates must differ between
/// pixels and be computed after control flow diverged: uniform and earlier values are available in all pixels
/// of a quad, whatever their path.
fn may_change_mip_level(program: &Program, lookup: ExprId, values: &[Divergence]) -> bool {
    let ExprKind::BuiltIn { function, arguments } = &program.tree[lookup].kind else {
        return false;
    };
    let bias = match function {
        BuiltIn::TextureOffset | BuiltIn::TextureProjOffset => arguments.get(3),
        _ => arguments.get(2),
    };
    let bias = bias.and_then(|&bias| program.constant(bias));
    let is_most_detailed = bias.is_some_and(|bias| match *bias.components() {
        [Value::Float(bias)] => bias <= -MAX_MIP_LEVELS,
        _ => false,
    });
    let at = values[arguments[1].index()];
    at.differs && at.after_divergence && !is_most_detailed && !samples_one_row(program, arguments[1])
}

/// Whether the second of two coordinates is constant, as in lookups of sound or keys, whose textures have no
/// mip levels.
fn samples_one_row(program: &Program, at: ExprId) -> bool {
    match &program.tree[program.resolve(at)].kind {
        ExprKind::Construct { arguments, .. } => match arguments[..] {
            [_, row] => program.constant(row).is_some(),
            _ => false,
        },
        _ => false,
    }
}

fn report(tree: &Tree, expr: ExprId, function: BuiltIn, cause: ExprId, findings: &mut Findings) {
    let name = function.name();
    let (code, message) = if function.is_derivative() {
        let message = format!("`{name}` in non-uniform control flow");
        (Code::Derivative, message)
    } else {
        let message = format!("`{name}` without an explicit level of detail in non-uniform control flow");
        (Code::ImplicitLod, message)
    };
    findings.add(code, tree[expr].at, message, |diagnostic| {
        let diagnostic = diagnostic.related(tree[cause].at.span, "this condition may differ between pixels");
        if function.is_derivative() {
            diagnostic
                .note("the derivative is undefined if neighboring pixels take a different path; WGSL rejects it")
                .help("compute it before the control flow diverges")
        } else {
            diagnostic
                .note("the mip level is undefined if neighboring pixels take a different path; WGSL rejects it")
                .help("sample before the control flow diverges, or give the level: `textureLod(channel, uv, 0.0)`")
        }
    });
}

// Causes of divergent control flow.

/// The condition by which control flow may diverge here.
#[derive(Clone, Copy)]
struct Control {
    /// A condition in this function.
    function: Option<ExprId>,
    /// A condition in a caller.
    callers: Option<ExprId>,
}

/// The conditions of divergent jumps, by how far their effect extends.
#[derive(Default)]
struct DivergentExits {
    /// Until the end of the function.
    function: Option<ExprId>,
    /// Until the end of the loop or `switch`.
    loop_or_switch: Option<ExprId>,
    /// Until the end of the loop iteration.
    iteration: Option<ExprId>,
}

impl DivergentExits {
    /// Any of the conditions.
    fn cause(&self) -> Option<ExprId> {
        self.function.or(self.loop_or_switch).or(self.iteration)
    }
}

// Which values and branches may differ between the pixels of a quad.

/// The maximum number of passes over all functions; divergence not found by then is ignored.
const MAX_FIXPOINT_ITERATIONS: usize = 12;

/// The values and branches found so far that may differ between the pixels of a quad.
struct DivergenceAnalysis<'a> {
    program: &'a Program<'a>,
    /// By variable index.
    variables: Vec<Divergence>,
    /// By function index: its result.
    results: Vec<Divergence>,
    /// By function index: the condition by which pixels may differ in whether they call it.
    calls: Vec<Option<ExprId>>,
    /// By expression index: its value, as of the last visit.
    values: Vec<Divergence>,
    /// Loops that pixels may leave in different iterations, by the address of their statement, with the
    /// condition.
    loops: HashMap<*const Statement, ExprId>,
    changed: bool,
}

/// How a value may vary within the pixels of a quad.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Divergence {
    /// Whether the value may differ between pixels.
    differs: bool,
    /// Whether the value was computed after control flow diverged: pixels on other paths hold an older one,
    /// or none.
    after_divergence: bool,
}

impl Divergence {
    fn or(self, other: Self) -> Self {
        Self {
            differs: self.differs || other.differs,
            after_divergence: self.after_divergence || other.after_divergence,
        }
    }
}

/// A callback for each expression in possibly divergent control flow: the expression, the diverging
/// condition, and the values so far.
type Visit<'v> = dyn FnMut(ExprId, ExprId, &[Divergence]) + 'v;

impl<'a> DivergenceAnalysis<'a> {
    /// Analyzes all reachable functions until nothing changes.
    fn new(program: &'a Program<'a>) -> Self {
        let tree = program.tree;
        let mut analysis = Self {
            program,
            variables: vec![Divergence::default(); tree.variables.len()],
            results: vec![Divergence::default(); tree.functions.len()],
            calls: vec![None; tree.functions.len()],
            values: vec![Divergence::default(); tree.exprs.len()],
            loops: HashMap::new(),
            changed: true,
        };
        for (id, variable) in tree.variables.iter() {
            analysis.variables[id.index()].differs = matches!(
                variable.kind,
                VariableKind::BuiltIn(BuiltInVariable::FragCoord | BuiltInVariable::PointCoord)
                    | VariableKind::Varying
            );
        }
        for &parameter in &tree[program.main].parameters {
            analysis.variables[parameter.index()].differs = direction(tree, parameter) != Direction::Out;
        }
        for _ in 0..MAX_FIXPOINT_ITERATIONS {
            if !std::mem::take(&mut analysis.changed) {
                break;
            }
            // Callers first, so that the arguments are known.
            for &function in program.functions.iter().rev() {
                analysis.function(function, &mut |_, _, _| {});
            }
        }
        analysis
    }

    /// Visits a function's statements.
    fn function(&mut self, function: FunctionId, visit: &mut Visit) {
        let tree = self.program.tree;
        if let Some(body) = &tree[function].body {
            let control = Control {
                function: None,
                callers: self.calls[function.index()],
            };
            self.block(function, body, control, &mut DivergentExits::default(), visit);
        }
    }

    fn block(
        &mut self,
        function: FunctionId,
        block: &Block,
        control: Control,
        exits: &mut DivergentExits,
        visit: &mut Visit,
    ) {
        for statement in block {
            let control = Control {
                function: control.function.or(exits.cause()),
                ..control
            };
            self.statement(function, statement, control, exits, visit);
        }
    }

    fn statement(
        &mut self,
        function: FunctionId,
        statement: &Statement,
        control: Control,
        exits: &mut DivergentExits,
        visit: &mut Visit,
    ) {
        let tree = self.program.tree;
        let within = |condition: Option<ExprId>| Control {
            function: control.function.or(condition),
            ..control
        };
        match &statement.kind {
            StatementKind::Block(body) => self.block(function, body, control, exits, visit),
            StatementKind::If { arms, otherwise } => {
                // Each condition is evaluated only where all earlier ones are false.
                let mut cause = None;
                for arm in arms {
                    self.expression(arm.condition, within(cause), visit);
                    cause = cause.or(self.values[arm.condition.index()]
                        .differs
                        .then_some(arm.condition));
                    self.block(function, &arm.body, within(cause), exits, visit);
                }
                if let Some(body) = otherwise {
                    self.block(function, body, within(cause), exits, visit);
                }
            }
            StatementKind::Switch { selector, cases } => {
                self.expression(*selector, control, visit);
                let cause = self.values[selector.index()].differs.then_some(*selector);
                let outer = exits.loop_or_switch;
                for case in cases {
                    self.block(function, &case.body, within(cause), exits, visit);
                }
                exits.loop_or_switch = outer;
            }
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                self.block(function, init, control, exits, visit);
                self.visit_loop(
                    function,
                    statement,
                    (*condition, *step),
                    body,
                    control,
                    exits,
                    visit,
                );
            }
            StatementKind::While { condition, body } => {
                self.visit_loop(
                    function,
                    statement,
                    (Some(*condition), None),
                    body,
                    control,
                    exits,
                    visit,
                );
            }
            StatementKind::DoWhile { body, condition } => {
                let after = Some(Condition::Expression(*condition));
                self.visit_loop(function, statement, (after, None), body, control, exits, visit);
            }
            StatementKind::Break => exits.loop_or_switch = exits.loop_or_switch.or(control.function),
            StatementKind::Continue => exits.iteration = exits.iteration.or(control.function),
            StatementKind::Return(value) => {
                if let Some(value) = value {
                    self.expression(*value, control, visit);
                    let value = self.values[value.index()];
                    let one_of_many = control.function.is_some() && self.program.returned(function).len() > 1;
                    let result = &mut self.results[function.index()];
                    let more = result.or(Divergence {
                        differs: value.differs || control.function.is_some(),
                        after_divergence: value.after_divergence || one_of_many,
                    });
                    self.changed |= *result != more;
                    *result = more;
                }
                exits.function = exits.function.or(control.function);
            }
            StatementKind::Expression(expr) => self.expression(*expr, control, visit),
            StatementKind::Declare(variable) => {
                if let Some(value) = tree[*variable].initializer {
                    self.expression(value, control, visit);
                    self.write(*variable, self.values[value.index()], control);
                }
            }
            StatementKind::Struct(_) | StatementKind::Discard => {}
        }
    }

    #[expect(
        clippy::too_many_arguments,
        reason = "a loop's parts, and what is handed down to all statements"
    )]
    fn visit_loop(
        &mut self,
        function: FunctionId,
        statement: &Statement,
        (condition, step): (Option<Condition>, Option<ExprId>),
        body: &Block,
        control: Control,
        exits: &mut DivergentExits,
        visit: &mut Visit,
    ) {
        let tree = self.program.tree;
        let key = std::ptr::from_ref(statement);
        let control = Control {
            function: control.function.or(self.loops.get(&key).copied()),
            ..control
        };
        let condition = condition.and_then(|condition| match condition {
            Condition::Expression(expr) => Some(expr),
            Condition::Declare(variable) => tree[variable].initializer,
        });
        let mut inner = DivergentExits {
            function: exits.function,
            ..DivergentExits::default()
        };
        let mut cause = None;
        if let Some(condition) = condition {
            self.expression(condition, control, visit);
            cause = self.values[condition.index()].differs.then_some(condition);
        }
        let within = Control {
            function: control.function.or(cause),
            ..control
        };
        self.block(function, body, within, &mut inner, visit);
        // Pixels that took a `continue` rejoin at the step; those that left the loop do not run it.
        let left = inner.function.or(inner.loop_or_switch);
        if let Some(step) = step {
            self.expression(
                step,
                Control {
                    function: within.function.or(left),
                    ..within
                },
                visit,
            );
        }
        if let Some(cause) = left.or(cause)
            && !self.loops.contains_key(&key)
        {
            self.loops.insert(key, cause);
            self.changed = true;
        }
        exits.function = inner.function;
    }

    fn merge(&mut self, variable: VariableId, divergence: Divergence) {
        let of = &mut self.variables[variable.index()];
        let more = of.or(divergence);
        self.changed |= *of != more;
        *of = more;
    }

    /// Records an assignment to a variable.
    fn write(&mut self, variable: VariableId, value: Divergence, control: Control) {
        // All pixels that run this call share its caller's control flow, so that only globals diverge by it.
        let is_global = self.program.tree[variable].kind == VariableKind::Global;
        let differs = control.function.is_some() || is_global && control.callers.is_some();
        // A variable that is set once is as available as its value.
        let is_alias = self.program.single_value(variable).is_some();
        let divergence = Divergence {
            differs: value.differs || differs,
            after_divergence: value.after_divergence || differs && !is_alias,
        };
        self.merge(variable, divergence);
    }
}

// Divergence of expressions and their effects.

impl DivergenceAnalysis<'_> {
    /// Computes the divergence of an expression's values, and of the variables that it writes.
    fn expression(&mut self, root: ExprId, control: Control, visit: &mut Visit) {
        let tree = self.program.tree;
        for expr in tree.postorder(root) {
            let mut divergence = match tree[expr].kind {
                ExprKind::Variable(variable) => self.variables[variable.index()],
                ExprKind::Call { function, .. } => self.results[function.index()],
                _ => Divergence::default(),
            };
            if !matches!(tree[expr].kind, ExprKind::Call { .. }) {
                tree[expr]
                    .kind
                    .for_each_operand(|operand| divergence = divergence.or(self.values[operand.index()]));
            }
            self.values[expr.index()] = divergence;
        }
        let mut pending = vec![(root, control)];
        while let Some((expr, control)) = pending.pop() {
            self.effects(expr, control);
            if let Some(cause) = control.function.or(control.callers) {
                visit(expr, cause, &self.values);
            }
            let within = |condition: ExprId, differs: bool| Control {
                function: control.function.or(differs.then_some(condition)),
                ..control
            };
            match tree[expr].kind {
                ExprKind::Binary {
                    op: BinaryOp::And | BinaryOp::Or,
                    left,
                    right,
                } => {
                    pending.push((right, within(left, self.values[left.index()].differs)));
                    pending.push((left, control));
                }
                ExprKind::Conditional { condition, yes, no } => {
                    let inside = within(condition, self.values[condition.index()].differs);
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
        let mut written = Vec::new();
        if let ExprKind::Call { function, arguments } = &tree[expr].kind {
            if self.calls[function.index()].is_none()
                && let Some(cause) = control.function.or(control.callers)
            {
                self.calls[function.index()] = Some(cause);
                self.changed = true;
            }
            for (&parameter, &argument) in tree[*function].parameters.iter().zip(arguments) {
                let passed = direction(tree, parameter);
                if passed != Direction::Out {
                    self.merge(parameter, self.values[argument.index()]);
                }
                if passed != Direction::In
                    && passed != Direction::ConstIn
                    && let Some(variable) = tree.root_variable(argument)
                {
                    self.merge(variable, self.variables[parameter.index()]);
                }
            }
        }
        tree.each_write(expr, |target, _| {
            let Some(variable) = tree.root_variable(target) else {
                return;
            };
            let mut value = match tree[expr].kind {
                ExprKind::Assign { value, .. } => self.values[value.index()],
                // A function's writes are tracked through its parameters.
                ExprKind::Call { .. } => Divergence::default(),
                _ => self.values[expr.index()],
            };
            value.differs |= self.has_divergent_index(target);
            written.push((variable, value));
        });
        for (variable, value) in written {
            self.write(variable, value, control);
        }
    }

    /// Whether pixels may write different elements.
    fn has_divergent_index(&self, target: ExprId) -> bool {
        let tree = self.program.tree;
        tree.path(target).any(|node| match tree[node].kind {
            ExprKind::Index { index, .. } => self.values[index.index()].differs,
            _ => false,
        })
    }
}
