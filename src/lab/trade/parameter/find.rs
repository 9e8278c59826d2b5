//! Finds the parameters of a shader in its loops: iteration limits, step sizes and thresholds.

use toyproof_diagnostic::{Files, Span};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::walk::{child_blocks, each, jumps, own_expressions};
use toyproof_glsl::tree::{
    BinaryOp, Block, Condition, Constructor, ExprId, ExprKind, Literal, Place as TreePlace, Statement,
    StatementKind, Tree, Type, Value, VariableId, VariableKind,
};

use super::{Form, Parameter, Place, Role};

/// A number below which a comparison in a loop is that with a threshold, not with a distance.
const MAX_THRESHOLD: f64 = 0.1;

/// A tree with its text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scope<'a> {
    pub(super) checked: &'a Checked,
    pub(super) files: &'a Files,
    /// Whether the text is the file itself, even if it was joined from others.
    pub(super) is_whole: bool,
}

/// The parameters of all trees, in source order, without repetitions.
pub(crate) fn proposals(scopes: &[Scope<'_>]) -> Vec<Parameter> {
    let mut found: Vec<Parameter> = Vec::new();
    for scope in scopes {
        for parameter in scope.loops() {
            if found.iter().all(|other| other.place != parameter.place) {
                found.push(parameter);
            }
        }
    }
    // Several unnamed numbers may stand in one line: their names say what each does.
    for parameter in &mut found {
        let what = match parameter.role {
            Role::Step => "step",
            Role::Relaxation => "factor of the step",
            Role::Threshold => "threshold",
            Role::Extent => "limit",
            _ => continue,
        };
        if parameter.name.starts_with(LINE) {
            parameter.name = format!("{what} in {}", parameter.name);
        }
    }
    found
}

/// What the names of numbers without a name begin with, before the line.
pub(crate) const LINE: &str = "line ";

impl<'a> Scope<'a> {
    pub(crate) fn new(checked: &'a Checked, files: &'a Files, is_whole: bool) -> Self {
        Self {
            checked,
            files,
            is_whole,
        }
    }

    pub(super) fn tree(&self) -> &'a Tree {
        &self.checked.tree
    }

    /// The parameters of all loops.
    pub(super) fn loops(&self) -> Vec<Parameter> {
        let mut found = Vec::new();
        for (_, function) in self.tree().functions.iter() {
            let Some(body) = &function.body else {
                continue;
            };
            each(body, &mut |statement| self.of_loop(statement, &mut found));
        }
        found
    }

    fn of_loop(&self, statement: &Statement, found: &mut Vec<Parameter>) {
        let no_init = Block::new();
        let (init, condition, step, body) = match &statement.kind {
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => (
                init,
                condition.as_ref().and_then(|&condition| tested(condition)),
                *step,
                body,
            ),
            StatementKind::While { condition, body } => (&no_init, tested(*condition), None, body),
            StatementKind::DoWhile { body, condition } => (&no_init, Some(*condition), None, body),
            _ => return,
        };
        let step = step.and_then(|step| self.step_size(step));
        let before = found.len();
        for (limit, is_upper) in condition.map_or_else(Vec::new, |condition| self.limits(condition)) {
            let role = match limit.value {
                value if step.is_some() && value.abs() > MAX_THRESHOLD => Role::Extent,
                value if value.fract() == 0.0 && value >= 2.0 && is_upper => Role::Count,
                value if value > 0.0 && value < MAX_THRESHOLD => Role::Threshold,
                value if value >= 1.0 => Role::Extent,
                _ => continue,
            };
            found.push(Parameter { role, ..limit });
        }
        // `for (int i = 64; i > 0; i--)`
        if found.len() == before {
            found.extend(self.first_value(init));
        }
        found.extend(step);
        self.of_body(body, found);
    }

    /// The thresholds that end a loop, and the steps in its body, without those of inner loops.
    fn of_body(&self, body: &[Statement], found: &mut Vec<Parameter>) {
        for statement in body {
            match &statement.kind {
                StatementKind::If { arms, .. } => {
                    for arm in arms.iter().filter(|arm| arm.body.iter().any(jumps)) {
                        for (limit, _) in self.limits(arm.condition) {
                            let role = match limit.value {
                                value if value > 0.0 && value < MAX_THRESHOLD => Role::Threshold,
                                value if value >= 1.0 => Role::Extent,
                                _ => continue,
                            };
                            found.push(Parameter { role, ..limit });
                        }
                    }
                }
                StatementKind::For { .. } | StatementKind::While { .. } | StatementKind::DoWhile { .. } => {
                    continue;
                }
                _ => {
                    let roots = own_expressions(self.tree(), statement);
                    found.extend(roots.into_iter().filter_map(|root| self.step_size(root)));
                }
            }
            for block in child_blocks(statement) {
                self.of_body(block, found);
            }
        }
    }

    /// The numbers with which a condition compares, and whether it is true below them: `a < 1.0 && b > 0.01`.
    fn limits(&self, condition: ExprId) -> Vec<(Parameter, bool)> {
        use BinaryOp::{And, Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual, Or};
        match self.tree()[condition].kind {
            ExprKind::Binary {
                op: And | Or,
                left,
                right,
            } => [self.limits(left), self.limits(right)].concat(),
            ExprKind::Binary { op, left, right } => {
                let below = match op {
                    Less | LessEqual | NotEqual => true,
                    Greater | GreaterEqual | Equal => false,
                    _ => return Vec::new(),
                };
                let sides = [(right, below), (left, !below)];
                let limits = sides.into_iter().filter_map(|(side, is_upper)| {
                    let limit = self.largest(side)?;
                    Some((limit, is_upper))
                });
                limits.take(1).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The value with which a loop's variable starts, if the loop counts down from it.
    fn first_value(&self, init: &[Statement]) -> Option<Parameter> {
        let [
            Statement {
                kind: StatementKind::Declare(variable),
                ..
            },
        ] = init
        else {
            return None;
        };
        let start = self.largest(self.tree()[*variable].initializer?)?;
        (start.value.fract() == 0.0 && start.value >= 2.0).then_some(Parameter {
            role: Role::Count,
            ..start
        })
    }

    /// The step of `t += 0.1`, its factor in `t += 0.5 * d`, or a factor of 1 in `t += d`; a step of 1 counts
    /// iterations.
    fn step_size(&self, root: ExprId) -> Option<Parameter> {
        let tree = self.tree();
        let ExprKind::Assign {
            op: Some(BinaryOp::Add),
            value,
            ..
        } = tree[root].kind
        else {
            return None;
        };
        if let Some(step) = self.number(value) {
            return part_of_one(step);
        }
        let factor = match tree[value].kind {
            ExprKind::Binary {
                op: BinaryOp::Multiply,
                left,
                right,
            } => [left, right].into_iter().find_map(|side| self.number(side)),
            _ => None,
        };
        factor.and_then(part_of_one).or_else(|| self.whole_step(value))
    }

    /// The factor of a step that has none.
    fn whole_step(&self, value: ExprId) -> Option<Parameter> {
        let expr = &self.tree()[value];
        let span = self.user_span(expr.at);
        (expr.ty == Type::FLOAT && !expr.at.is_expanded()).then(|| Parameter {
            name: format!("{LINE}{}", self.files.position(expr.at.span).line),
            role: Role::Relaxation,
            value: 1.0,
            place: Place::Factor(span),
        })
    }

    /// The largest number of an expression that consists of numbers: `N`, `N - 1`, `float(N)`.
    fn largest(&self, root: ExprId) -> Option<Parameter> {
        if let Some(number) = self.number(root) {
            return Some(number);
        }
        let tree = self.tree();
        let mut largest: Option<Parameter> = None;
        for id in tree.postorder(root) {
            match &tree[id].kind {
                ExprKind::Literal(_) | ExprKind::Variable(_) => {
                    let number = self.number(id)?;
                    if largest
                        .as_ref()
                        .is_none_or(|other| number.value.abs() > other.value.abs())
                    {
                        largest = Some(number);
                    }
                }
                ExprKind::Binary { .. } | ExprKind::Unary { .. } | ExprKind::Construct { .. } => {}
                _ => return None,
            }
        }
        largest
    }

    /// A literal, a constant that is one, or a uniform.
    pub(super) fn number(&self, expr: ExprId) -> Option<Parameter> {
        let tree = self.tree();
        match &tree[expr].kind {
            ExprKind::Literal(literal) => self.literal(literal, tree[expr].at),
            ExprKind::Construct {
                constructor: Constructor::Scalar,
                arguments,
            } => match arguments[..] {
                [argument] => self.number(argument),
                _ => None,
            },
            &ExprKind::Variable(variable) => self.variable(variable),
            _ => None,
        }
    }

    /// A variable that has one value only.
    pub(super) fn variable(&self, variable: VariableId) -> Option<Parameter> {
        let tree = self.tree();
        let known = &tree[variable];
        match known.kind {
            VariableKind::Uniform => {
                let mut given = self.checked.uniforms.iter();
                let given = given.find(|value| value.name == known.name)?;
                let &[value] = &given.components[..] else {
                    return None;
                };
                Some(Parameter {
                    name: known.name.clone(),
                    role: Role::Constant,
                    value,
                    place: Place::Uniform,
                })
            }
            VariableKind::Const | VariableKind::Global | VariableKind::Local
                if known.kind == VariableKind::Const || !self.is_written(variable) =>
            {
                let initial = self.number(known.initializer?)?;
                // The name of a macro explains more than that of a copy of it.
                let is_named = !initial.name.starts_with(LINE);
                let name = if is_named {
                    initial.name.clone()
                } else {
                    known.name.clone()
                };
                Some(Parameter { name, ..initial })
            }
            _ => None,
        }
    }

    fn is_written(&self, variable: VariableId) -> bool {
        let tree = self.tree();
        tree.exprs.ids().any(|id| {
            let mut is_written = false;
            tree.each_write(id, |target, _| {
                is_written |= tree.root_variable(target) == Some(variable);
            });
            is_written
        })
    }

    /// The span in the file that is edited.
    fn user_span(&self, at: TreePlace) -> Span {
        if self.is_whole {
            at.spelling
        } else {
            self.files.origin(at.spelling)
        }
    }

    /// A literal of the user's files, named after the macro whose replacement it is, or its line.
    pub(super) fn literal(&self, literal: &Literal, at: TreePlace) -> Option<Parameter> {
        let (value, form) = match literal.value {
            Value::Int(value) => (f64::from(value), Form::Int),
            Value::Uint(value) => (f64::from(value), Form::Uint),
            Value::Float(value) => (value, Form::Float),
            Value::Bool(_) => return None,
        };
        let span = self.user_span(at);
        // A literal that several tokens of a macro make has no text of its own.
        if self.files.text(span) != &*literal.text {
            return None;
        }
        let definitions = self.checked.expansions.definitions().iter();
        let mut of_macro = definitions.filter(|definition| {
            let extent = definition.extent;
            at.is_expanded()
                && extent.file == at.spelling.file
                && (extent.start..extent.end).contains(&at.spelling.start)
        });
        let name = of_macro.next().map_or_else(
            || format!("{LINE}{}", self.files.position(at.spelling).line),
            |definition| definition.name.clone(),
        );
        Some(Parameter {
            name,
            role: Role::Constant,
            value,
            place: Place::Literal { span, form },
        })
    }
}

fn tested(condition: Condition) -> Option<ExprId> {
    match condition {
        Condition::Expression(expr) => Some(expr),
        Condition::Declare(_) => None,
    }
}

/// A step, or a factor of one, between 0 and 1.
fn part_of_one(step: Parameter) -> Option<Parameter> {
    (step.value > 0.0 && step.value < 1.0).then_some(Parameter {
        role: Role::Step,
        ..step
    })
}
