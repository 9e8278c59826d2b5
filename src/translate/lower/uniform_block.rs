//! The uniforms that the author declares, as members of a block.

use std::collections::HashMap;

use toyproof_diagnostic::{Code, Diagnostic};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{
    Constructor, ExprId, ExprKind, Item, Scalar, Swizzle, Type, Value, VariableId, VariableKind,
};

use crate::lower::context::{Builder, LoweringContext};

/// Collects the uniforms that are no inputs of the host in a block, in the order of their declarations; those
/// with a given value become constants. Types that blocks do not have are replaced: `bool` by `uint`, and the
/// elements of arrays by vectors of four components where std140 pads them to that size, because WGSL has no
/// arrays with other strides.
///
/// # Errors
/// A uniform has a type that no block can have, or the shader reads an input or a texture that it cannot
/// have.
pub(super) fn run(cx: &mut LoweringContext, checked: &Checked) -> Result<(), Vec<Diagnostic>> {
    let mut refused = Vec::new();
    // The types as declared, of the members that are stored as another type.
    let mut declared = HashMap::new();
    for at in 0..cx.tree.items.len() {
        let Item::Variable(id) = cx.tree.items[at] else {
            continue;
        };
        let ty = cx.tree[id].ty;
        if cx.tree[id].kind != VariableKind::Uniform || matches!(ty, Type::Sampler(_)) || checked.is_bound(id)
        {
            continue;
        }
        if checked
            .uniforms
            .iter()
            .any(|given| given.name == cx.tree[id].name)
        {
            cx.tree[id].kind = VariableKind::Const;
            continue;
        }
        cx.tree[id].initializer = None;
        let Some(stored) = stored_type(cx, ty) else {
            let name = cx.tree.type_name(ty);
            refused.push(refuse(
                cx,
                id,
                &format!("cannot be a member of the uniform block: its type is `{name}`"),
                "declare numbers, vectors, matrices with three or four rows, or arrays of these",
            ));
            continue;
        };
        if stored != ty {
            declared.insert(id, ty);
            cx.tree[id].ty = stored;
        }
        cx.uniform_block.push(id);
    }
    refused.extend(unbound(cx));
    if !refused.is_empty() {
        return Err(refused);
    }
    cx.each_expression(|cx, id| {
        let read = match cx.tree[id].kind {
            ExprKind::Variable(variable) if declared.contains_key(&variable) => {
                let mut build = cx.build_at(id);
                let whole = build.variable(variable);
                whole_value(&mut build, whole, declared[&variable])
            }
            ExprKind::Index { base, index } => match cx.tree[base].kind {
                ExprKind::Variable(variable) if declared.contains_key(&variable) => {
                    let ty = cx.tree[id].ty;
                    let mut build = cx.build_at(id);
                    let whole = build.variable(variable);
                    // Of a vector of `bool`, or of an array.
                    let element = build.index(whole, index);
                    converted(&mut build, element, ty)
                }
                _ => return,
            },
            _ => return,
        };
        cx.tree[id] = cx.tree[read].clone();
    });
    Ok(())
}

/// Maximum number of elements of an array: more than the 1,024 vectors that OpenGL promises for all uniforms
/// (`MAX_FRAGMENT_UNIFORM_VECTORS` on desktops) cannot be set, and each use of the whole array lists them.
const MAX_ELEMENTS: u32 = 1024;

/// The type as which a block holds a uniform; `None` if it cannot.
fn stored_type(cx: &mut LoweringContext, ty: Type) -> Option<Type> {
    let numeric = |scalar| match scalar {
        Scalar::Bool => Scalar::Uint,
        other => other,
    };
    match ty {
        Type::Scalar(scalar) => Some(Type::Scalar(numeric(scalar))),
        Type::Vector(scalar, size) => Some(Type::Vector(numeric(scalar), size)),
        // naga's front end has no matrices with two rows in std140.
        Type::Matrix { rows, .. } => (rows > 2).then_some(ty),
        Type::Array(id) => {
            let array = cx.tree.array(id);
            let size = array.size;
            if size > MAX_ELEMENTS {
                return None;
            }
            let element = match array.element {
                Type::Scalar(scalar) | Type::Vector(scalar, 2) => Type::Vector(numeric(scalar), 4),
                Type::Vector(scalar, components) => Type::Vector(numeric(scalar), components),
                Type::Matrix { rows, .. } if rows > 2 => array.element,
                _ => return None,
            };
            Some(cx.tree.array_of(element, size))
        }
        _ => None,
    }
}

/// The value of a member of the block that is stored as another type.
fn whole_value(build: &mut Builder<'_>, whole: ExprId, ty: Type) -> ExprId {
    let Type::Array(id) = ty else {
        return converted(build, whole, ty);
    };
    let array = build.tree.array(id);
    let (size, element) = (array.size, array.element);
    let elements = (0..size).map(|at| {
        let index = build.literal(Value::Int(at as i32));
        let whole = build.detach(whole);
        let stored = build.index(whole, index);
        converted(build, stored, element)
    });
    let elements = elements.collect();
    build.construct(Constructor::Array, elements, ty)
}

/// A scalar, a vector or a matrix, converted from the type as which it is stored.
fn converted(build: &mut Builder<'_>, stored: ExprId, ty: Type) -> ExprId {
    let (Type::Scalar(scalar) | Type::Vector(scalar, _)) = ty else {
        return stored;
    };
    let count = ty.component_count().unwrap_or(1);
    let of_stored = build.tree[stored].ty.component_count().unwrap_or(1);
    let components = Swizzle::new(&[0, 1, 2, 3][..usize::from(count.min(4))]);
    let value = match components {
        Some(components) if count < of_stored => build.swizzle(stored, components),
        _ => stored,
    };
    match (scalar, count) {
        (Scalar::Bool, 1) => build.construct(Constructor::Scalar, vec![value], ty),
        (Scalar::Bool, _) => build.construct(Constructor::Vector, vec![value], ty),
        _ => value,
    }
}

/// The inputs and textures that are read although the module has none of their kind.
fn unbound(cx: &LoweringContext) -> Vec<Diagnostic> {
    let reads = cx.tree.exprs.iter().filter_map(|(_, expr)| match expr.kind {
        ExprKind::Variable(variable) => Some(variable),
        _ => None,
    });
    let mut read: Vec<VariableId> = reads.collect();
    read.sort_unstable();
    read.dedup();
    let refused = read.into_iter().filter_map(|id| match (cx.tree[id].kind, cx.tree[id].ty) {
        (VariableKind::Varying, _) => Some(refuse(
            cx,
            id,
            "has no value: the module has no inputs of a vertex shader",
            "a `vec2` has the coordinates of the screen, from 0 to 1; make a uniform of what does not vary",
        )),
        (VariableKind::Uniform, Type::Sampler(_)) => Some(refuse(
            cx,
            id,
            "has no binding: the module has up to four textures of the type `sampler2D`",
            "name textures of another shape `iChannel0` to `iChannel3`, as ShaderToy does",
        )),
        _ => None,
    });
    refused.collect()
}

/// An error about a declaration.
fn refuse(cx: &LoweringContext, id: VariableId, problem: &str, help: &str) -> Diagnostic {
    let variable = &cx.tree[id];
    let message = format!("`{}` {problem}", variable.name);
    let diagnostic = Diagnostic::new(Code::UnsupportedByTarget, message).help(help);
    match variable.at {
        Some(at) => diagnostic.at(at.span),
        None => diagnostic,
    }
}
