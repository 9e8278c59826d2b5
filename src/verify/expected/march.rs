//! Marches of a reference shader along its rays: loops that advance by the result of a function of the place,
//! such as the distance to the nearest surface. How far they go, in how many steps, and by which part of the
//! distance, is a matter of style; the pixels that depend on them are mostly at the horizon and at edges.

use std::collections::HashSet;

use toyproof_diagnostic::Span;
use toyproof_glsl::tree::{
    BinaryOp, Block, BuiltIn, Condition, ExprId, ExprKind, FunctionId, Literal, Scalar, Statement,
    StatementKind, Tree, Type, Value, VariableId, VariableKind, walk,
};

use super::variation::{Edit, Subject, Variation};

/// How much farther marches go, and in how many more steps.
const FARTHER: i32 = 2;

/// The part of a step that a careful march takes.
const RELAXATION: f64 = 0.9;

/// The largest number of marches that are varied.
const MAX_MARCHES: usize = 3;

/// The largest number of calls through which a limit is followed.
const MAX_CALLS: u32 = 3;

/// A loop that marches.
#[derive(Debug, Clone, PartialEq)]
struct March {
    /// The limits of the march's steps and of its distance.
    limits: Vec<Limit>,
    /// The expressions that the loop adds to the distance, or to the place.
    advances: Vec<ExprId>,
}

/// A number that ends a march.
#[derive(Debug, Clone, PartialEq)]
struct Limit {
    /// The place where the loop compares with the limit.
    at: Span,
    /// The literals that determine the limit, also elsewhere.
    literals: Vec<ExprId>,
}

/// The reference with each march varied: with each of its limits farther, with shorter steps, and with all
/// of that; then with all marches varied.
pub(super) fn variations(tree: &Tree) -> Vec<Variation> {
    let marches = marches(tree);
    let mut variations: Vec<Variation> = Vec::new();
    for march in &marches {
        let limits = march.limits.iter();
        variations.extend(limits.map(|limit| variation(tree, &[limit], &[])));
        variations.push(variation(tree, &[], &march.advances));
        variations.push(variation(
            tree,
            &march.limits.iter().collect::<Vec<_>>(),
            &march.advances,
        ));
    }
    let limits: Vec<&Limit> = marches.iter().flat_map(|march| &march.limits).collect();
    let advances: Vec<ExprId> = marches.iter().flat_map(|march| march.advances.clone()).collect();
    variations.push(variation(tree, &limits, &advances));
    let mut different: Vec<Variation> = Vec::new();
    for variation in variations {
        if !variation.edits.is_empty() && !different.iter().any(|known| known.edits == variation.edits) {
            different.push(variation);
        }
    }
    different
}

fn variation(tree: &Tree, limits: &[&Limit], advances: &[ExprId]) -> Variation {
    let mut literals: Vec<ExprId> = limits.iter().flat_map(|limit| limit.literals.clone()).collect();
    literals.sort_unstable_by_key(|id| id.index());
    literals.dedup();
    let farther = literals.into_iter().filter_map(|id| match tree[id].kind {
        ExprKind::Literal(Literal { value, .. }) => Some(Edit::Number(id, farther(value)?)),
        _ => None,
    });
    let shorter = advances.iter().map(|&id| Edit::Scale(id, RELAXATION));
    Variation {
        edits: farther.chain(shorter).collect(),
        subject: Subject::March(limits.iter().map(|limit| limit.at).collect()),
    }
}

fn farther(value: Value) -> Option<Value> {
    match value {
        Value::Int(value) => value.checked_mul(FARTHER).map(Value::Int),
        Value::Uint(value) => value.checked_mul(FARTHER.cast_unsigned()).map(Value::Uint),
        Value::Float(value) => Some(Value::Float(f64::from(FARTHER) * value)),
        Value::Bool(_) => None,
    }
}

fn marches(tree: &Tree) -> Vec<March> {
    let mut marches = Vec::new();
    for (function, definition) in tree.functions.iter() {
        walk::each(definition.body.as_deref().unwrap_or_default(), &mut |statement| {
            marches.extend(march(tree, function, statement));
        });
    }
    marches.truncate(MAX_MARCHES);
    marches
}

/// The march that a statement is, if it is one.
fn march(tree: &Tree, function: FunctionId, statement: &Statement) -> Option<March> {
    let (condition, body): (Option<ExprId>, &Block) = match &statement.kind {
        StatementKind::For { condition, body, .. } => (tested(tree, *condition), body),
        StatementKind::While { condition, body } => (tested(tree, Some(*condition)), body),
        StatementKind::DoWhile { condition, body } => (Some(*condition), body),
        _ => return None,
    };
    let mut roots = walk::own_expressions(tree, statement);
    roots.extend(walk::roots(tree, body));
    let writes = Writes::new(tree, &roots, body);
    let marched = writes.marched(tree)?;
    let mut limits = Vec::new();
    let mut add = |condition: ExprId, is_end: bool| {
        for compared in comparisons(tree, condition, is_end) {
            let is_limited =
                writes.is_counter(tree, compared.number) || marched.measures(tree, compared.number);
            if is_limited
                && !writes.writes(tree, compared.limit)
                && let Some(literals) = literals(tree, function, compared.limit, MAX_CALLS)
            {
                let at = tree[compared.limit].at.span;
                limits.push(Limit { at, literals });
            }
        }
    };
    if let Some(condition) = condition {
        add(condition, false);
    }
    walk::each(body, &mut |statement| {
        if let StatementKind::If { arms, .. } = &statement.kind {
            let ends = |body: &Block| body.last().is_some_and(walk::jumps);
            arms.iter()
                .filter(|arm| ends(&arm.body))
                .for_each(|arm| add(arm.condition, true));
        }
    });
    Some(March {
        limits,
        advances: marched.advances,
    })
}

fn tested(tree: &Tree, condition: Option<Condition>) -> Option<ExprId> {
    match condition? {
        Condition::Expression(condition) => Some(condition),
        Condition::Declare(variable) => tree[variable].initializer,
    }
}

/// The writes of a loop.
struct Writes {
    /// The written variables with the values that are assigned or added to them.
    values: Vec<(VariableId, ExprId)>,
    /// The variables that a sum is added to: `t += d`, `t = t + d`; with the summand.
    sums: Vec<(VariableId, ExprId)>,
    /// The variables that are counted up: `i++`, `i += 1`.
    counters: Vec<VariableId>,
}

impl Writes {
    fn new(tree: &Tree, roots: &[ExprId], body: &Block) -> Self {
        let mut writes = Self {
            values: Vec::new(),
            sums: Vec::new(),
            counters: Vec::new(),
        };
        walk::each(body, &mut |statement| {
            if let StatementKind::Declare(variable) = statement.kind
                && let Some(initializer) = tree[variable].initializer
            {
                writes.values.push((variable, initializer));
            }
        });
        for id in roots.iter().flat_map(|&root| tree.postorder(root)) {
            match tree[id].kind {
                ExprKind::Step { target, .. } => writes.counters.extend(tree.root_variable(target)),
                ExprKind::Assign { op, target, value } => {
                    let Some(variable) = tree.root_variable(target) else {
                        continue;
                    };
                    writes.values.push((variable, value));
                    let Some(summand) = summand(tree, variable, op, target, value) else {
                        continue;
                    };
                    if tree[summand].constant {
                        writes.counters.push(variable);
                    } else {
                        writes.sums.push((variable, summand));
                    }
                }
                _ => {}
            }
        }
        writes
    }

    /// The written variables whose values depend, in one iteration, on an expression that satisfies `on`.
    fn dependent(&self, tree: &Tree, on: impl Fn(ExprId) -> bool) -> HashSet<VariableId> {
        let mut dependent = HashSet::new();
        loop {
            let before = dependent.len();
            for &(variable, value) in &self.values {
                if on(value) || mentions_any(tree, value, &dependent) {
                    dependent.insert(variable);
                }
            }
            if dependent.len() == before {
                return dependent;
            }
        }
    }

    /// The variable by which the loop marches: it determines a place, and its increment depends on the result
    /// of a function of this place.
    fn marched(&self, tree: &Tree) -> Option<Travel> {
        self.sums.iter().find_map(|&(variable, _)| {
            let placed = self.dependent(tree, |value| walk::mentions(tree, value, variable));
            let is_place = |id: ExprId| {
                matches!(tree[id].ty, Type::Vector(Scalar::Float, 2 | 3))
                    && (walk::mentions(tree, id, variable) || mentions_any(tree, id, &placed))
            };
            let measures = |root: ExprId| {
                tree.postorder(root).into_iter().any(|id| match &tree[id].kind {
                    ExprKind::Call { arguments, .. }
                    | ExprKind::BuiltIn {
                        function: BuiltIn::Length,
                        arguments,
                    } => arguments.iter().any(|&argument| is_place(argument)),
                    _ => false,
                })
            };
            let distances = self.dependent(tree, measures);
            let is_distance = |root: ExprId| measures(root) || mentions_any(tree, root, &distances);
            let advances = self.sums.iter();
            let own = advances.filter(|&&(sum, summand)| sum == variable && is_distance(summand));
            let own: Vec<ExprId> = own.map(|&(_, summand)| summand).collect();
            if own.is_empty() {
                return None;
            }
            // The distance in addition to the place, as in `p += d * ray; t += d;`.
            let beside = self.sums.iter().filter(|&&(sum, summand)| {
                sum != variable && tree[sum].ty == Type::FLOAT && is_plain(tree, summand, &distances)
            });
            let beside: Vec<_> = beside.copied().collect();
            let mut travelled: HashSet<VariableId> = beside.iter().map(|&(sum, _)| sum).collect();
            travelled.insert(variable);
            let advances = own
                .into_iter()
                .chain(beside.into_iter().map(|(_, summand)| summand));
            Some(Travel {
                travelled,
                advances: advances.collect(),
            })
        })
    }

    /// Whether the loop changes a variable that an expression mentions.
    fn writes(&self, tree: &Tree, expr: ExprId) -> bool {
        let written: HashSet<VariableId> = self.values.iter().map(|&(variable, _)| variable).collect();
        mentions_any(tree, expr, &written)
    }

    /// Whether an expression is a counter.
    fn is_counter(&self, tree: &Tree, expr: ExprId) -> bool {
        let is_one = |kind: &ExprKind| matches!(kind, ExprKind::Variable(variable) if self.counters.contains(variable));
        walk::any(tree, expr, is_one)
    }
}

/// The summand that a loop adds to a variable by an assignment: `t += d`, `t = t + d`, `t = d + t`.
fn summand(
    tree: &Tree,
    variable: VariableId,
    op: Option<BinaryOp>,
    target: ExprId,
    value: ExprId,
) -> Option<ExprId> {
    let is_itself = |id: ExprId| matches!(tree[id].kind, ExprKind::Variable(other) if other == variable);
    if !is_itself(target) {
        return None;
    }
    match (op, &tree[value].kind) {
        (Some(BinaryOp::Add), _) => Some(value),
        (
            None,
            &ExprKind::Binary {
                op: BinaryOp::Add,
                left,
                right,
            },
        ) if is_itself(left) => Some(right),
        (
            None,
            &ExprKind::Binary {
                op: BinaryOp::Add,
                left,
                right,
            },
        ) if is_itself(right) => Some(left),
        _ => None,
    }
}

fn mentions_any(tree: &Tree, root: ExprId, variables: &HashSet<VariableId>) -> bool {
    walk::any(
        tree,
        root,
        |kind| matches!(kind, ExprKind::Variable(variable) if variables.contains(variable)),
    )
}

/// Whether an expression is one of the variables, or a part of one, or a multiple.
fn is_plain(tree: &Tree, expr: ExprId, variables: &HashSet<VariableId>) -> bool {
    match tree[expr].kind {
        ExprKind::Binary {
            op: BinaryOp::Multiply,
            left,
            right,
        } => {
            (tree[left].constant && is_plain(tree, right, variables))
                || (tree[right].constant && is_plain(tree, left, variables))
        }
        _ => tree
            .root_variable(expr)
            .is_some_and(|variable| variables.contains(&variable)),
    }
}

/// The variables by which a loop marches.
struct Travel {
    travelled: HashSet<VariableId>,
    advances: Vec<ExprId>,
}

impl Travel {
    /// Whether an expression is the distance that the loop has marched: `t`, `length(p - origin)`.
    fn measures(&self, tree: &Tree, expr: ExprId) -> bool {
        tree[expr].ty == Type::FLOAT && mentions_any(tree, expr, &self.travelled)
    }
}

/// A comparison of a number with its upper limit.
struct Comparison {
    number: ExprId,
    limit: ExprId,
}

/// The comparisons of a condition that end a loop when a number exceeds a limit. `is_end` is whether the
/// condition ends the loop, rather than continues it.
fn comparisons(tree: &Tree, condition: ExprId, is_end: bool) -> Vec<Comparison> {
    let nodes = tree.postorder(condition).into_iter();
    nodes
        .filter_map(|id| {
            let ExprKind::Binary { op, left, right } = tree[id].kind else {
                return None;
            };
            let op = if is_end { op } else { op.mirrored() };
            match op {
                BinaryOp::Greater | BinaryOp::GreaterEqual => Some(Comparison {
                    number: left,
                    limit: right,
                }),
                BinaryOp::Less | BinaryOp::LessEqual => Some(Comparison {
                    number: right,
                    limit: left,
                }),
                _ => None,
            }
        })
        .collect()
}

/// The literals that determine a limit, which is a number, a constant, a variable with an initial value or a
/// parameter; `None` if something else determines it.
fn literals(tree: &Tree, function: FunctionId, limit: ExprId, calls: u32) -> Option<Vec<ExprId>> {
    let of = |expr: ExprId| literals(tree, function, expr, calls);
    match &tree[limit].kind {
        ExprKind::Literal(_) => Some(same_number(tree, limit)),
        ExprKind::Construct { arguments, .. } if tree[limit].ty == Type::FLOAT => match arguments[..] {
            [argument] => of(argument),
            _ => None,
        },
        &ExprKind::Variable(variable) => match tree[variable].kind {
            VariableKind::Const | VariableKind::Global | VariableKind::Local => {
                of(tree[variable].initializer?)
            }
            VariableKind::Parameter(_) if calls > 0 => {
                let parameters = &tree[function].parameters;
                let place = parameters.iter().position(|&parameter| parameter == variable)?;
                arguments(tree, function, place, calls - 1)
            }
            _ => None,
        },
        _ => None,
    }
}

/// The literals that determine an argument in the calls of a function; `None` if something else does in all
/// of them.
fn arguments(tree: &Tree, function: FunctionId, place: usize, calls: u32) -> Option<Vec<ExprId>> {
    let mut found = Vec::new();
    for (caller, definition) in tree.functions.iter() {
        let Some(body) = &definition.body else {
            continue;
        };
        let roots = walk::roots(tree, body).into_iter();
        for id in roots.flat_map(|root| tree.postorder(root)) {
            if let ExprKind::Call {
                function: called,
                arguments,
            } = &tree[id].kind
                && *called == function
            {
                found.extend(
                    literals(tree, caller, arguments[place], calls)
                        .into_iter()
                        .flatten(),
                );
            }
        }
    }
    (!found.is_empty()).then_some(found)
}

/// The literals of the same number: all uses of the macro that a literal is from; else those with which
/// something is compared or that are returned, as in `if (t > 30.0) return 30.0;` and `if (t < 30.0)`.
fn same_number(tree: &Tree, literal: ExprId) -> Vec<ExprId> {
    let place = tree[literal].at;
    if place.is_expanded() {
        let is_same = |id: &ExprId| {
            let other = tree[*id].at;
            matches!(tree[*id].kind, ExprKind::Literal(_))
                && other.is_expanded()
                && other.spelling == place.spelling
        };
        return tree.exprs.ids().filter(is_same).collect();
    }
    let value = |id: ExprId| match tree[id].kind {
        ExprKind::Literal(Literal {
            value: Value::Float(value),
            ..
        }) => Some(value),
        _ => None,
    };
    let mut same = vec![literal];
    let mut add = |id: ExprId| {
        if value(id).is_some() && value(id) == value(literal) && !same.contains(&id) {
            same.push(id);
        }
    };
    for (_, expr) in tree.exprs.iter() {
        if let ExprKind::Binary { op, left, right } = expr.kind
            && op != op.mirrored()
        {
            add(left);
            add(right);
        }
    }
    for (_, definition) in tree.functions.iter() {
        walk::each(definition.body.as_deref().unwrap_or_default(), &mut |statement| {
            if let StatementKind::Return(Some(returned)) = statement.kind {
                add(returned);
            }
        });
    }
    same
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl as glsl;

    use super::*;

    /// The limits of the marches of a shader, and the numbers of their advances.
    fn found(functions: &str, main: &str) -> Vec<(Vec<String>, usize)> {
        let text = format!(
            "#define STEPS 64\n#define FAR 20.0\nconst float LIMIT = 20.0;\n\
             float map(vec3 p) {{ return length(p) - 1.0; }}\n{functions}\n\
             void mainImage(out vec4 c, in vec2 f) {{\n\
             vec3 o = vec3(0, 0, -3), r = normalize(vec3(f, 1)), p = o;\nfloat t = 0.0;\nc = vec4(0);\n{main}\n}}\n"
        );
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        let checked = glsl::check(&files, file, &glsl::Options::default())
            .unwrap_or_else(|_| panic!("{functions} {main}"));
        let marches = marches(&checked.tree).into_iter();
        marches
            .map(|march| {
                let limits = march.limits.iter().map(|limit| files.text(limit.at).to_owned());
                (limits.collect(), march.advances.len())
            })
            .collect()
    }

    #[test]
    fn marches_are_found_with_their_limits() {
        let march = |functions: &str, main: &str, limits: &[&str], advances: usize| {
            let limits = limits.iter().map(ToString::to_string).collect();
            assert_eq!(found(functions, main), [(limits, advances)], "{functions} {main}");
        };
        let step = "float d = map(o + t * r); if (d < 1e-3) break;";
        march(
            "",
            &format!("for (int i = 0; i < STEPS; i++) {{ {step} t += d; if (t > FAR) break; }}"),
            &["STEPS", "FAR"],
            1,
        );
        march(
            "",
            &format!("for (float i = 0.0; i < 90.0 && t <= LIMIT; ++i) {{ {step} t = t + 0.7 * d; }}"),
            &["90.0", "LIMIT"],
            1,
        );
        march(
            "",
            "int i = 0; do { t += map(o + t * r); i += 1; if (20.0 < t || i >= STEPS) break; } while (true);",
            &["20.0", "STEPS"],
            1,
        );
        march(
            "",
            "while (t < FAR) { float d = map(p); p += d * r; t += d; }",
            &["FAR"],
            2,
        );
        march(
            "",
            "for (int i = 0; i < STEPS; i++) { float d = map(p); if (length(p - o) > FAR) break; p += d * r; }",
            &["STEPS", "FAR"],
            1,
        );
        let function = "float go(vec3 o, vec3 r, float far, int most) { float t = 0.0; \
                        for (int i = 0; i < most; i++) { t += map(o + r * t); if (t > far) return far; } return t; }";
        march(function, "t = go(o, r, 20.0, STEPS);", &["most", "far"], 1);
    }

    #[test]
    fn other_loops_are_no_marches() {
        for main in [
            // Ambient occlusion, glow, fog in equal steps, noise, and Newton's method.
            "for (int i = 0; i < 5; i++) { float h = 0.1 * float(i); c.x += h - map(o + h * r); }",
            "for (int i = 0; i < 9; i++) { c += 0.1 / (1.0 + abs(map(p + float(i)))); }",
            "for (int i = 0; i < STEPS; i++) { c.x += 0.1 * max(-map(o + t * r), 0.0); t += 0.1; }",
            "float a = 0.5; for (int i = 0; i < 6; i++) { t += a * sin(p.x); p *= 2.0; a *= 0.5; }",
            "for (int i = 0; i < 6; i++) { t += (t * t - 2.0) / (2.0 * t + 1.0); }",
        ] {
            assert_eq!(found("", main), [], "{main}");
        }
    }

    #[test]
    fn all_numbers_of_a_limit_are_doubled_together() {
        let text = "#define FAR 20.0\nfloat map(vec3 p) { return length(p) - 1.0; }\n\
                    void mainImage(out vec4 c, in vec2 f) { float t = 0.0; \
                    for (int i = 0; i < 64; i++) { t += map(vec3(f, t)); if (t > FAR) break; } \
                    c = vec4(t < FAR ? t / FAR : 20.0); }";
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        let checked = glsl::check(&files, file, &glsl::Options::default()).unwrap();
        let variations = variations(&checked.tree);
        let numbers = |variation: &Variation| {
            let numbers = variation.edits.iter().filter_map(|edit| match *edit {
                Edit::Number(_, value) => Some(value),
                Edit::Scale(..) => None,
            });
            numbers.collect::<Vec<_>>()
        };
        let far = Value::Float(40.0);
        let all: Vec<_> = variations.iter().map(numbers).collect();
        assert_eq!(
            all,
            [
                vec![Value::Int(128)],
                vec![far; 3],
                vec![],
                vec![Value::Int(128), far, far, far]
            ]
        );
    }
}
