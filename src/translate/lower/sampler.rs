//! Sampler parameters: `vec4 f(sampler2D s, vec2 p)` becomes a function for each channel that it is called with.
//!
//! naga's `sampler2D(texture, sampler)` is no value that could be passed (gfx-rs/wgpu #5256).

use std::collections::HashMap;

use toyproof_glsl::tree::{
    Block, Condition, ExprId, ExprKind, Function, FunctionId, Item, Label, Statement, StatementKind, Type,
    VariableId, walk,
};

use super::draft::Draft;

pub(super) fn run(draft: &mut Draft) {
    let mut made = HashMap::new();
    let mut pending: Vec<FunctionId> = draft
        .tree
        .functions
        .iter()
        .filter(|(_, function)| samplers(draft, function).is_empty())
        .map(|(id, _)| id)
        .collect();
    // A new function may call others with the channels it was made for.
    while let Some(function) = pending.pop() {
        let Some(body) = &draft.tree[function].body else {
            continue;
        };
        for root in walk::roots(&draft.tree, body) {
            for call in draft.tree.postorder(root) {
                pending.extend(specialise(draft, call, &mut made));
            }
        }
    }
    // The general ones are called by nobody now.
    let tree = &draft.tree;
    let general = |item: &Item| matches!(item, Item::Function(id) | Item::Prototype(id) if !samplers(draft, &tree[*id]).is_empty());
    let items = tree.items.iter().copied().filter(|item| !general(item)).collect();
    draft.tree.items = items;
}

/// The positions of the parameters that are samplers.
fn samplers(draft: &Draft, function: &Function) -> Vec<usize> {
    let is_sampler = |&id: &VariableId| matches!(draft.tree[id].ty, Type::Sampler(_));
    let positions = function.parameters.iter().enumerate();
    positions
        .filter(|(_, id)| is_sampler(id))
        .map(|(at, _)| at)
        .collect()
}

type Made = HashMap<(FunctionId, Vec<VariableId>), FunctionId>;

/// Lets a call that passes channels call a function made for them; gives that function if it is new.
fn specialise(draft: &mut Draft, call: ExprId, made: &mut Made) -> Option<FunctionId> {
    let ExprKind::Call {
        function,
        ref arguments,
    } = draft.tree[call].kind
    else {
        return None;
    };
    let positions = samplers(draft, &draft.tree[function]);
    if positions.is_empty() {
        return None;
    }
    let channels: Option<Vec<VariableId>> = positions
        .iter()
        .map(|&at| match draft.tree[*arguments.get(at)?].kind {
            ExprKind::Variable(channel) => Some(channel),
            _ => None,
        })
        .collect();
    let channels = channels?;
    let left = arguments
        .iter()
        .enumerate()
        .filter(|(at, _)| !positions.contains(at))
        .map(|(_, &id)| id);
    let arguments = left.collect();
    let key = (function, channels);
    let known = made.get(&key).copied();
    let special = known.unwrap_or_else(|| Copy::of(draft, key.0, &positions, &key.1));
    made.insert(key, special);
    draft.tree[call].kind = ExprKind::Call {
        function: special,
        arguments,
    };
    known.is_none().then_some(special)
}

/// Copies a function, channels in the place of its samplers.
struct Copy<'a> {
    draft: &'a mut Draft,
    variables: HashMap<VariableId, VariableId>,
}

impl Copy<'_> {
    fn of(
        draft: &mut Draft,
        general: FunctionId,
        positions: &[usize],
        channels: &[VariableId],
    ) -> FunctionId {
        let mut special = draft.tree[general].clone();
        for &channel in channels {
            special.name = format!("{}_{}", special.name, draft.tree[channel].name);
        }
        let mut copy = Copy {
            draft,
            variables: HashMap::new(),
        };
        for (&at, &channel) in positions.iter().zip(channels) {
            copy.variables.insert(special.parameters[at], channel);
        }
        let parameters = std::mem::take(&mut special.parameters);
        let kept = parameters
            .into_iter()
            .enumerate()
            .filter(|(at, _)| !positions.contains(at));
        special.parameters = kept.map(|(_, parameter)| copy.declare(parameter)).collect();
        special.body = special.body.map(|body| copy.block(&body));
        let special = draft.tree.functions.push(special);
        draft.tree.items.push(Item::Function(special));
        special
    }

    fn declare(&mut self, variable: VariableId) -> VariableId {
        let mut new = self.draft.tree[variable].clone();
        new.initialiser = new.initialiser.map(|expr| self.expression(expr));
        let new = self.draft.tree.variables.push(new);
        self.variables.insert(variable, new);
        new
    }

    fn expression(&mut self, root: ExprId) -> ExprId {
        let variables = &self.variables;
        let rename = |variable| variables.get(&variable).copied().unwrap_or(variable);
        self.draft.build_at(root).copy_with(root, rename)
    }

    fn block(&mut self, block: &Block) -> Block {
        block.iter().map(|statement| self.statement(statement)).collect()
    }

    fn condition(&mut self, condition: Condition) -> Condition {
        match condition {
            Condition::Expression(expr) => Condition::Expression(self.expression(expr)),
            Condition::Declare(variable) => Condition::Declare(self.declare(variable)),
        }
    }

    fn statement(&mut self, statement: &Statement) -> Statement {
        let mut new = statement.clone();
        match &mut new.kind {
            StatementKind::Expression(expr) | StatementKind::Return(Some(expr)) => {
                *expr = self.expression(*expr);
            }
            StatementKind::Declare(variable) => *variable = self.declare(*variable),
            StatementKind::Block(body) => *body = self.block(body),
            StatementKind::If { arms, otherwise } => {
                for arm in arms {
                    arm.condition = self.expression(arm.condition);
                    arm.body = self.block(&arm.body);
                }
                if let Some(body) = otherwise {
                    *body = self.block(body);
                }
            }
            StatementKind::Switch { selector, cases } => {
                *selector = self.expression(*selector);
                for case in cases {
                    for label in &mut case.labels {
                        if let Label::Case { expr, .. } = label {
                            *expr = self.expression(*expr);
                        }
                    }
                    case.body = self.block(&case.body);
                }
            }
            StatementKind::For {
                init,
                condition,
                step,
                body,
            } => {
                *init = self.block(init);
                *condition = condition.map(|condition| self.condition(condition));
                *step = step.map(|step| self.expression(step));
                *body = self.block(body);
            }
            StatementKind::While { condition, body } => {
                *condition = self.condition(*condition);
                *body = self.block(body);
            }
            StatementKind::DoWhile { body, condition } => {
                *body = self.block(body);
                *condition = self.expression(*condition);
            }
            StatementKind::Return(None)
            | StatementKind::Struct(_)
            | StatementKind::Break
            | StatementKind::Continue
            | StatementKind::Discard => {}
        }
        new
    }
}
