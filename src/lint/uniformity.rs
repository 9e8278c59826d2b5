//! Derivatives, and texture lookups that need them, where neighbouring pixels may have gone another way (§8.8, §8.9).
//!
//! A derivative compares with the neighbours in a quad of 2×2 pixels. Behind an `if` that they may answer differently, their values are
//! undefined: seams and speckles along the edges, and an error in WGSL. What differs between pixels is what comes from
//! `fragCoord` or a texture, or is written where control differs; all else is the same everywhere.

mod control;
mod differing;
mod expression;

use differing::{Differing, Traits};
use toyproof_glsl::Code;
use toyproof_glsl::tree::{BuiltIn, ExprId, ExprKind, Tree, Value};

use super::Found;
use super::program::Program;

/// No texture has more levels than this: a bias that takes as many away leaves the first.
const MAX_LEVELS: f64 = 15.0;

pub(super) fn run(program: &Program, found: &mut Found) {
    let tree = program.tree;
    let needs = |expr: ExprId| match tree[expr].kind {
        ExprKind::BuiltIn { function, .. } if needs_neighbours(function) => Some(function),
        _ => None,
    };
    if !program.all_exprs().any(|expr| needs(expr).is_some()) {
        return;
    }
    let mut differing = Differing::new(program);
    for &function in &program.functions {
        // One of each kind tells enough of a function.
        let mut told: Vec<bool> = Vec::new();
        differing.function(function, &mut |expr, cause, values| {
            if let Some(built_in) = needs(expr)
                && !told.contains(&built_in.is_derivative())
                && (built_in.is_derivative() || shows(program, expr, values))
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

/// Whether a lookup may take another level than it would if all pixels came by. What it looks at must differ between pixels, and be made where
/// control had parted: what was known before, or is the same everywhere, all pixels of a quad hold, whichever way they went.
fn shows(program: &Program, lookup: ExprId, values: &[Traits]) -> bool {
    let ExprKind::BuiltIn { function, arguments } = &program.tree[lookup].kind else {
        return false;
    };
    let bias = match function {
        BuiltIn::TextureOffset | BuiltIn::TextureProjOffset => arguments.get(3),
        _ => arguments.get(2),
    };
    let bias = bias.and_then(|&bias| program.constant(bias));
    let is_lowest = bias.is_some_and(|bias| match *bias.components() {
        [Value::Float(bias)] => bias <= -MAX_LEVELS,
        _ => false,
    });
    let at = values[arguments[1].index()];
    at.differs && at.parted && !is_lowest && !is_in_one_row(program, arguments[1])
}

/// Whether the last coordinate of two is the same constant for all, as it is where sound or keys are looked up: those have no levels.
fn is_in_one_row(program: &Program, at: ExprId) -> bool {
    match &program.tree[program.resolve(at)].kind {
        ExprKind::Construct { arguments, .. } => match arguments[..] {
            [_, row] => program.constant(row).is_some(),
            _ => false,
        },
        _ => false,
    }
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
            diagnostic.note("where the channel has mip levels, edges show wrong ones; WGSL refuses it. Look up before control parts, or say the level: `textureLod(channel, at, 0.0)`")
        }
    });
}
