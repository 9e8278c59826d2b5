//! Offsets of texture lookups: `texelFetchOffset`, and offsets that are named constants.
//!
//! naga fetches without the offset, and its IR wants offsets as literals where they are looked up.

use toyproof_glsl::tree::{BinaryOp, BuiltIn, ExprId, ExprKind};

use super::draft::Draft;

pub(super) fn run(draft: &mut Draft) {
    draft.each_expression(|draft, id| {
        let ExprKind::BuiltIn {
            function: BuiltIn::TexelFetchOffset,
            arguments,
        } = &draft.tree[id].kind
        else {
            return;
        };
        if let &[sampler, texel, lod, offset] = arguments.as_slice() {
            let whole = draft.tree[texel].ty;
            let mut build = draft.build_at(id);
            let offset = widen(&mut build, offset, whole);
            let texel = build.binary(BinaryOp::Add, texel, offset, whole);
            let arguments = vec![sampler, texel, lod];
            draft.tree[id].kind = ExprKind::BuiltIn {
                function: BuiltIn::TexelFetch,
                arguments,
            };
        }
    });
    draft.each_expression(|draft, id| {
        if let ExprKind::BuiltIn { function, arguments } = &draft.tree[id].kind
            && let Some(position) = offset_position(*function)
            && let Some(&offset) = arguments.get(position)
            && let Some(value) = draft.tree.value(offset)
        {
            let value = super::constant::spell(draft, &value, offset);
            draft.tree[offset] = draft.tree[value].clone();
        }
    });
}

/// An array's layer is not offset.
fn widen(build: &mut super::build::Builder<'_>, offset: ExprId, whole: toyproof_glsl::tree::Type) -> ExprId {
    use toyproof_glsl::tree::{Constructor, Value};
    if build.tree[offset].ty == whole {
        return offset;
    }
    let layer = build.literal(Value::Int(0));
    build.construct(Constructor::Vector, vec![offset, layer], whole)
}

fn offset_position(function: BuiltIn) -> Option<usize> {
    match function {
        BuiltIn::TextureOffset | BuiltIn::TextureProjOffset => Some(2),
        BuiltIn::TextureLodOffset | BuiltIn::TextureProjLodOffset => Some(3),
        BuiltIn::TextureGradOffset | BuiltIn::TextureProjGradOffset => Some(4),
        _ => None,
    }
}
