//! `==` and `!=` of structures and arrays: a function for each type, member by member.
//!
//! naga refuses them.

use toyproof_glsl::tree::{
    Arm, BinaryOp, Block, Condition, ExprId, ExprKind, FunctionId, Place, Statement, StatementKind, StepOp,
    Type, UnaryOp, Value,
};

use super::draft::Draft;
use super::helper::Helper;

pub(super) fn run(draft: &mut Draft) {
    draft.each_expression(|draft, id| {
        if let ExprKind::Binary {
            op: op @ (BinaryOp::Equal | BinaryOp::NotEqual),
            left,
            right,
        } = draft.tree[id].kind
        {
            compare(draft, id, op, left, right);
        }
    });
}

fn is_composite(ty: Type) -> bool {
    matches!(ty, Type::Struct(_) | Type::Array(_))
}

/// Lets a call stand for a comparison of composites.
fn compare(draft: &mut Draft, id: ExprId, op: BinaryOp, left: ExprId, right: ExprId) {
    let (ty, at) = (draft.tree[left].ty, draft.tree[id].at);
    if !is_composite(ty) {
        return;
    }
    let function = draft.helper(Helper::Equal, (ty, ty), at);
    let call = ExprKind::Call {
        function,
        arguments: vec![left, right],
    };
    draft.tree[id].kind = if op == BinaryOp::Equal {
        call
    } else {
        let operand = draft.build(at).push(call, Type::BOOL);
        ExprKind::Unary {
            op: UnaryOp::Not,
            operand,
        }
    };
}

/// The body of the function that compares two values of that type.
pub(super) fn body(draft: &mut Draft, function: FunctionId, ty: Type, at: Place) -> Block {
    let &[a, b] = draft.tree[function].parameters.as_slice() else {
        return Block::new();
    };
    match ty {
        Type::Struct(id) => {
            let mut whole = None;
            for (member, ty) in draft.tree[id]
                .members
                .clone()
                .into_iter()
                .map(|member| member.ty)
                .enumerate()
            {
                let mut build = draft.build(at);
                let [left, right] = [a, b].map(|parameter| {
                    let structure = build.variable(parameter);
                    build.push(ExprKind::Member { structure, member }, ty)
                });
                let equal = build.binary(BinaryOp::Equal, left, right, Type::BOOL);
                compare(draft, equal, BinaryOp::Equal, left, right);
                whole = Some(match whole {
                    Some(before) => draft.build(at).binary(BinaryOp::And, before, equal, Type::BOOL),
                    None => equal,
                });
            }
            vec![Statement {
                kind: StatementKind::Return(whole),
                at,
            }]
        }
        Type::Array(id) => elements(draft, [a, b], draft.tree.array(id).size, at),
        _ => Block::new(),
    }
}

/// `for (int i = 0; i < size; i++) if (a[i] != b[i]) return false; return true;`
fn elements(draft: &mut Draft, arrays: [toyproof_glsl::tree::VariableId; 2], size: u32, at: Place) -> Block {
    let counter = draft.local("i", Type::INT, at);
    let mut build = draft.build(at);
    let zero = build.literal(Value::Int(0));
    build.tree[counter].initialiser = Some(zero);
    let i = build.variable(counter);
    let end = build.literal(Value::Int(size.cast_signed()));
    let within = build.binary(BinaryOp::Less, i, end, Type::BOOL);
    let target = build.variable(counter);
    let step = build.push(
        ExprKind::Step {
            op: StepOp::Increment,
            postfix: true,
            target,
        },
        Type::INT,
    );
    let [left, right] = arrays.map(|array| {
        let array = build.variable(array);
        let index = build.variable(counter);
        build.index(array, index)
    });
    let differs = build.binary(BinaryOp::NotEqual, left, right, Type::BOOL);
    let [no, yes] = [false, true].map(|value| Some(build.literal(Value::Bool(value))));
    compare(draft, differs, BinaryOp::NotEqual, left, right);
    let statement = |kind| Statement { kind, at };
    let arm = Arm {
        condition: differs,
        body: vec![statement(StatementKind::Return(no))],
    };
    vec![
        statement(StatementKind::For {
            init: vec![statement(StatementKind::Declare(counter))],
            condition: Some(Condition::Expression(within)),
            step: Some(step),
            body: vec![statement(StatementKind::If {
                arms: vec![arm],
                otherwise: None,
            })],
        }),
        statement(StatementKind::Return(yes)),
    ]
}
