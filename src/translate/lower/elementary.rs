//! The functions whose last bits drivers choose, spelled in operations that they compute alike: for strict shaders only.
//!
//! Each is written once as a function of our own (`toyproof_math`); one of a vector calls that of its components. Products
//! of matrices are spelled late, when what stands in the indices of a target is evaluated once already.

use std::collections::HashSet;

use toyproof_glsl::tree::{
    BinaryOp, BuiltIn, Constructor, Direction, ExprId, ExprKind, FunctionId, Item, Place, Scalar, Statement,
    StatementKind, Swizzle, Type, VariableId, VariableKind, walk,
};
use toyproof_math::{self as e, FloatTerm, Matrix, Program};

use super::draft::Draft;
use super::spelled;

/// What is spelled; the types of the arguments complete it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Spelled {
    /// A built-in function.
    Function(BuiltIn),
    /// `*` of matrices and vectors.
    Product,
    /// The nearest float to a `uint`.
    FloatOfUint,
}

pub(super) fn run(draft: &mut Draft) {
    draft.each_expression(|draft, id| match &draft.tree[id].kind {
        ExprKind::BuiltIn { function, arguments } if is_spelled(*function) && !selects(draft, arguments) => {
            let (function, arguments) = (Spelled::Function(*function), arguments.clone());
            call(draft, id, function, arguments);
        }
        ExprKind::Construct { arguments, .. } if draft.tree[id].ty.scalar() == Some(Scalar::Float) => {
            for argument in arguments.clone() {
                let ty = draft.tree[argument].ty;
                if let (Some(Scalar::Uint), Some(float)) = (ty.scalar(), ty.with_scalar(Scalar::Float)) {
                    let value = draft.build_at(argument).detach(argument);
                    draft.tree[argument].ty = float;
                    call(draft, argument, Spelled::FloatOfUint, vec![value]);
                }
            }
        }
        _ => {}
    });
    unfix(draft);
}

/// `mix` by a truth is a choice.
fn selects(draft: &Draft, arguments: &[ExprId]) -> bool {
    let scalar = |id: &ExprId| draft.tree[*id].ty.scalar();
    arguments.last().and_then(scalar) == Some(Scalar::Bool)
}

/// `*` of matrices and vectors.
pub(super) fn products(draft: &mut Draft) {
    draft.each_expression(|draft, id| match draft.tree[id].kind {
        ExprKind::Binary {
            op: BinaryOp::Multiply,
            left,
            right,
        } if is_product(draft, left, right) => call(draft, id, Spelled::Product, vec![left, right]),
        ExprKind::Assign {
            op: Some(BinaryOp::Multiply),
            target,
            value,
        } if is_product(draft, target, value) => {
            let ty = draft.tree[target].ty;
            let mut build = draft.build_at(id);
            let left = build.copy(target);
            let product = build.binary(BinaryOp::Multiply, left, value, ty);
            build.tree[id].kind = ExprKind::Assign {
                op: None,
                target,
                value: product,
            };
            call(draft, product, Spelled::Product, vec![left, value]);
        }
        _ => {}
    });
    unfix(draft);
}

fn is_product(draft: &Draft, left: ExprId, right: ExprId) -> bool {
    let is_matrix = |ty| matches!(ty, Type::Matrix { .. });
    let is_vector = |ty| matches!(ty, Type::Vector(..));
    let [left, right] = [left, right].map(|id| draft.tree[id].ty);
    is_matrix(left) && (is_matrix(right) || is_vector(right)) || is_vector(left) && is_matrix(right)
}

/// Local constants that begin with a call are constants to nobody but us.
fn unfix(draft: &mut Draft) {
    let global: HashSet<VariableId> = draft
        .tree
        .items
        .iter()
        .filter_map(|item| match *item {
            Item::Variable(variable) => Some(variable),
            _ => None,
        })
        .collect();
    for id in draft.tree.variables.ids() {
        let variable = &draft.tree[id];
        let calls = |root| walk::any(&draft.tree, root, |kind| matches!(kind, ExprKind::Call { .. }));
        if variable.kind == VariableKind::Const
            && !global.contains(&id)
            && variable.initialiser.is_some_and(calls)
        {
            draft.tree[id].kind = VariableKind::Local;
        }
    }
}

fn call(draft: &mut Draft, id: ExprId, spelled: Spelled, arguments: Vec<ExprId>) {
    let types: Vec<Type> = arguments
        .iter()
        .map(|&argument| draft.tree[argument].ty)
        .collect();
    let (ty, at) = (draft.tree[id].ty, draft.tree[id].at);
    let function = function(draft, spelled, types, ty, at);
    draft.tree[id].kind = ExprKind::Call { function, arguments };
    draft.tree[id].constant = false;
}

/// The function of our own for those types, made once.
fn function(draft: &mut Draft, spelled: Spelled, types: Vec<Type>, ty: Type, at: Place) -> FunctionId {
    let key = (spelled, types);
    if let Some(&id) = draft.spelled.get(&key) {
        return id;
    }
    let (spelled, types) = &key;
    let id = if is_componentwise(*spelled) && matches!(ty, Type::Vector(..)) {
        of_components(draft, *spelled, types, ty, at)
    } else {
        let id = declare(draft, *spelled, types, ty, at);
        let body = text(draft, *spelled, types, ty);
        draft.helpers.insert(id, body);
        id
    };
    draft.spelled.insert(key, id);
    id
}

const NAMES: [&str; 3] = ["toyproof_a", "toyproof_b", "toyproof_c"];

fn declare(draft: &mut Draft, spelled: Spelled, types: &[Type], ty: Type, at: Place) -> FunctionId {
    let name = match spelled {
        Spelled::Function(function) => function.name(),
        Spelled::Product => "product",
        Spelled::FloatOfUint => "float",
    };
    let parameters: Vec<_> = types
        .iter()
        .zip(NAMES)
        .map(|(&ty, name)| (Direction::In, ty, name))
        .collect();
    draft.function(format!("toyproof_{name}"), &parameters, ty, at)
}

/// A function of vectors by that of their components.
fn of_components(draft: &mut Draft, spelled: Spelled, types: &[Type], ty: Type, at: Place) -> FunctionId {
    let id = declare(draft, spelled, types, ty, at);
    let scalar = |ty: Type| ty.scalar().map_or(ty, Type::Scalar);
    let of_one = function(
        draft,
        spelled,
        types.iter().map(|&ty| scalar(ty)).collect(),
        scalar(ty),
        at,
    );
    let parameters = draft.tree[id].parameters.clone();
    let mut build = draft.build(at);
    let components: Vec<ExprId> = (0..ty.component_count().unwrap_or(1))
        .map(|component| {
            let arguments = parameters.iter().map(|&parameter| {
                let whole = build.variable(parameter);
                match (build.tree[whole].ty, Swizzle::new(&[component])) {
                    (Type::Vector(..), Some(one)) => build.swizzle(whole, one),
                    _ => whole,
                }
            });
            let arguments = arguments.collect();
            build.call(of_one, arguments)
        })
        .collect();
    let value = build.construct(Constructor::Vector, components, ty);
    draft.tree[id].body = Some(vec![Statement {
        kind: StatementKind::Return(Some(value)),
        at,
    }]);
    id
}

/// Whether drivers differ in it, or may: the exact ones stay built in.
fn is_spelled(function: BuiltIn) -> bool {
    is_of_components(function) || is_of_vectors(function)
}

fn is_componentwise(spelled: Spelled) -> bool {
    match spelled {
        Spelled::Function(function) => is_of_components(function),
        Spelled::FloatOfUint => true,
        Spelled::Product => false,
    }
}

fn is_of_components(function: BuiltIn) -> bool {
    use BuiltIn as B;
    matches!(
        function,
        B::Radians
            | B::Degrees
            | B::Sin
            | B::Cos
            | B::Tan
            | B::Asin
            | B::Acos
            | B::Atan
            | B::Sinh
            | B::Cosh
            | B::Tanh
            | B::Asinh
            | B::Acosh
            | B::Atanh
            | B::Pow
            | B::Exp
            | B::Log
            | B::Exp2
            | B::Log2
            | B::InverseSqrt
            | B::Fract
            | B::Mod
            | B::Mix
            | B::Step
            | B::Smoothstep
    )
}

fn is_of_vectors(function: BuiltIn) -> bool {
    use BuiltIn as B;
    matches!(
        function,
        B::Length
            | B::Distance
            | B::Dot
            | B::Cross
            | B::Normalize
            | B::Faceforward
            | B::Reflect
            | B::Refract
            | B::Determinant
            | B::Inverse
            | B::UnpackSnorm2x16
            | B::UnpackUnorm2x16
            | B::UnpackHalf2x16
    )
}

/// The body of such a function.
fn text(draft: &Draft, spelled: Spelled, types: &[Type], ty: Type) -> String {
    const A: &str = NAMES[0];
    match spelled {
        // Both halves are exact, so that only their sum is rounded.
        Spelled::FloatOfUint => {
            return format!("return float(int({A} >> 16u)) * 65536.0 + float(int({A} & 65535u));");
        }
        Spelled::Function(BuiltIn::UnpackUnorm2x16) => {
            return format!(
                "return vec2(float(int({A} & 65535u)) / 65535.0, float(int({A} >> 16u)) / 65535.0);"
            );
        }
        Spelled::Function(BuiltIn::UnpackSnorm2x16) => {
            return format!(
                "return vec2(max(float(int({A} << 16u) >> 16u) / 32767.0, -1.0), \
                 max(float(int({A}) >> 16u) / 32767.0, -1.0));"
            );
        }
        // Mesa 22.3 takes the upper half of a constant for zero.
        Spelled::Function(BuiltIn::UnpackHalf2x16) => {
            return format!("return vec2(unpackHalf2x16({A}).x, unpackHalf2x16({A} >> 16u).x);");
        }
        Spelled::Function(_) | Spelled::Product => {}
    }
    let program = Program::default();
    let mut names = Vec::new();
    let mut arguments = Vec::new();
    for (&ty, name) in types.iter().zip(NAMES) {
        let components = components(ty, name);
        let first = names.len();
        names.extend(components);
        arguments.push(
            (first..names.len())
                .map(|index| program.argument(index))
                .collect(),
        );
    }
    let results = match spelled {
        Spelled::Function(function) => apply(function, &arguments),
        _ => product(&arguments, types),
    };
    let results: Vec<_> = results.into_iter().map(FloatTerm::id).collect();
    spelled::body(&program, &results, &names, &draft.tree.type_name(ty))
}

/// The components of an argument, in column order.
fn components(ty: Type, name: &str) -> Vec<String> {
    const LETTERS: [&str; 4] = ["x", "y", "z", "w"];
    let of = |size: u8| LETTERS.into_iter().take(size.into());
    match ty {
        Type::Vector(_, size) => of(size).map(|letter| format!("{name}.{letter}")).collect(),
        Type::Matrix { columns, rows } => (0..columns)
            .flat_map(|column| of(rows).map(move |letter| format!("{name}[{column}].{letter}")))
            .collect(),
        _ => vec![name.to_owned()],
    }
}

/// What a function gives for arguments of components; nothing if it is not one of ours.
fn apply<'a>(function: BuiltIn, arguments: &[Vec<FloatTerm<'a>>]) -> Vec<FloatTerm<'a>> {
    use BuiltIn as B;
    let one = |value| vec![value];
    match (function, arguments) {
        (B::Length, [v]) => one(e::length(v)),
        (B::Distance, [a, b]) => one(e::distance(a, b)),
        (B::Dot, [a, b]) => one(e::dot(a, b)),
        (B::Cross, [a, b]) => match (&a[..], &b[..]) {
            (&[a, b, c], &[x, y, z]) => e::cross([a, b, c], [x, y, z]).to_vec(),
            _ => Vec::new(),
        },
        (B::Normalize, [v]) => e::normalize(v),
        (B::Faceforward, [n, i, reference]) => e::faceforward(n, i, reference),
        (B::Reflect, [i, n]) => e::reflect(i, n),
        (B::Refract, [i, n, eta]) => e::refract(i, n, eta[0]),
        (B::Determinant, [m]) => one(e::determinant(&Matrix::new(m, m.len().isqrt()))),
        (B::Inverse, [m]) => e::inverse(&Matrix::new(m, m.len().isqrt())).components(),
        (_, [x]) => of_one(function, x[0]).into_iter().collect(),
        (B::Atan, [y, x]) => one(e::atan2(y[0], x[0])),
        (B::Pow, [x, y]) => one(e::pow(x[0], y[0])),
        (B::Mod, [x, y]) => one(e::modulo(x[0], y[0])),
        (B::Step, [edge, x]) => one(e::step(edge[0], x[0])),
        (B::Mix, [a, b, t]) => one(e::mix(a[0], b[0], t[0])),
        (B::Smoothstep, [low, high, x]) => one(e::smoothstep(low[0], high[0], x[0])),
        _ => Vec::new(),
    }
}

fn of_one(function: BuiltIn, x: FloatTerm<'_>) -> Option<FloatTerm<'_>> {
    use BuiltIn as B;
    Some(match function {
        B::Radians => e::radians(x),
        B::Degrees => e::degrees(x),
        B::Sin => e::sin(x),
        B::Cos => e::cos(x),
        B::Tan => e::tan(x),
        B::Asin => e::asin(x),
        B::Acos => e::acos(x),
        B::Atan => e::atan(x),
        B::Sinh => e::sinh(x),
        B::Cosh => e::cosh(x),
        B::Tanh => e::tanh(x),
        B::Asinh => e::asinh(x),
        B::Acosh => e::acosh(x),
        B::Atanh => e::atanh(x),
        B::Exp => e::exp(x),
        B::Log => e::log(x),
        B::Exp2 => e::exp2(x),
        B::Log2 => e::log2(x),
        B::InverseSqrt => e::inverse_sqrt(x),
        B::Fract => e::fract(x),
        _ => return None,
    })
}

/// `a·b` of a matrix and a matrix or vector.
fn product<'a>(arguments: &[Vec<FloatTerm<'a>>], types: &[Type]) -> Vec<FloatTerm<'a>> {
    match (arguments, types) {
        ([a, b], [Type::Matrix { rows, .. }, Type::Vector(..)]) => {
            Matrix::new(a, (*rows).into()).times_vector(b)
        }
        ([a, b], [Type::Vector(..), Type::Matrix { rows, .. }]) => {
            Matrix::new(b, (*rows).into()).vector_times(a)
        }
        ([a, b], [Type::Matrix { rows, .. }, Type::Matrix { rows: inner, .. }]) => {
            let product = Matrix::new(a, (*rows).into()).times(&Matrix::new(b, (*inner).into()));
            product.components()
        }
        _ => Vec::new(),
    }
}
