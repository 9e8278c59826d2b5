//! Built-in functions that naga lacks, and the helper functions that lowered text calls.

use toyproof_glsl::tree::{BinaryOp, BuiltIn, Direction, ExprId, ExprKind, FunctionId, Place, Scalar, Type};

use crate::lower::context::LoweringContext;
use crate::lower::generated::Helper;
use crate::lower::{initializer, operator};

impl LoweringContext {
    /// Returns the helper function for the given types and adds it on first use.
    pub(super) fn helper(&mut self, helper: Helper, types: (Type, Type), at: Place) -> FunctionId {
        if let Some(&id) = self.helper_ids.get(&(helper, types.0, types.1)) {
            return id;
        }
        let id = helper.make(self, types, at);
        self.helper_ids.insert((helper, types.0, types.1), id);
        id
    }
}

impl Helper {
    /// Adds the function for the given types: that of the first argument, and that of the second where it can
    /// differ.
    fn make(self, cx: &mut LoweringContext, (ty, other): (Type, Type), at: Place) -> FunctionId {
        use Direction::{In, Out};
        let float = Type::FLOAT;
        let boolean = ty.with_scalar(Scalar::Bool).unwrap_or(Type::BOOL);
        let name = |cx: &LoweringContext, ty| cx.tree.type_name(ty);
        let (label, parameters, return_type, body) = match self {
            Self::Runtime => ("runtime", vec![(In, ty, "x")], ty, "return x;".to_owned()),
            Self::Remainder => ("remainder", vec![(In, ty, "a"), (In, ty, "b")], ty, remainder(ty)),
            Self::Normalize => (
                "normalize",
                vec![(In, float, "x")],
                float,
                "return x / abs(x);".to_owned(),
            ),
            Self::Faceforward => (
                "faceforward",
                vec![(In, float, "n"), (In, float, "i"), (In, float, "along")],
                float,
                "return along * i < 0.0 ? n : -n;".to_owned(),
            ),
            Self::Refract => (
                "refract",
                vec![(In, float, "i"), (In, float, "n"), (In, float, "eta")],
                float,
                "float k = 1.0 - eta * eta * (1.0 - (n * i) * (n * i));\n    \
                 return k < 0.0 ? 0.0 : eta * i - (eta * (n * i) + sqrt(k)) * n;"
                    .to_owned(),
            ),
            Self::Reflect => (
                "reflect",
                vec![(In, float, "i"), (In, float, "n")],
                float,
                "return i - 2.0 * (n * i) * n;".to_owned(),
            ),
            Self::Matrix => (
                "matrix",
                vec![(In, other, "v")],
                ty,
                "return mat2(v.xy, v.zw);".to_owned(),
            ),
            Self::MatrixCompMult => (
                BuiltIn::MatrixCompMult.name(),
                vec![(In, ty, "a"), (In, ty, "b")],
                ty,
                columns(&name(cx, ty), ty, |c| format!("a[{c}] * b[{c}]")),
            ),
            Self::OuterProduct => (
                BuiltIn::OuterProduct.name(),
                vec![(In, ty, "c"), (In, other, "r")],
                outer_product(ty, other),
                columns(
                    &name(cx, outer_product(ty, other)),
                    outer_product(ty, other),
                    |c| format!("c * r[{c}]"),
                ),
            ),
            Self::Inverse => (BuiltIn::Inverse.name(), vec![(In, ty, "m")], ty, inverse(ty)),
            Self::IsNan => (
                BuiltIn::IsNan.name(),
                vec![(In, ty, "x")],
                boolean,
                classify(ty, '>'),
            ),
            Self::IsInf => (
                BuiltIn::IsInf.name(),
                vec![(In, ty, "x")],
                boolean,
                classify(ty, '='),
            ),
            Self::Modf => (
                BuiltIn::Modf.name(),
                vec![(In, ty, "x"), (Out, ty, "whole")],
                ty,
                "whole = trunc(x);\n    return x - whole;".to_owned(),
            ),
            Self::Equal | Self::Zero | Self::Make => return self.make_tree(cx, ty, at),
        };
        let function = cx.function(format!("toyproof_{label}"), &parameters, return_type, at);
        cx.helpers.insert(function, body);
        function
    }

    /// Adds a function built from tree nodes, since it refers to the author's names.
    fn make_tree(self, cx: &mut LoweringContext, ty: Type, at: Place) -> FunctionId {
        use Direction::In;
        match (self, ty) {
            (Self::Make, Type::Struct(id)) => {
                let made = cx.tree[id].clone();
                let members = made
                    .members
                    .iter()
                    .map(|member| (In, member.ty, member.name.as_str()));
                let members: Vec<_> = members.collect();
                cx.function(format!("toyproof_{}", made.name), &members, ty, at)
            }
            (Self::Equal, _) => {
                let parameters = [(In, ty, "a"), (In, ty, "b")];
                let function = cx.function("toyproof_equal".to_owned(), &parameters, Type::BOOL, at);
                let body = operator::equality_body(cx, function, ty, at);
                cx.tree[function].body = Some(body);
                function
            }
            _ => {
                let name = cx
                    .tree
                    .type_name(ty)
                    .replace(|c: char| !c.is_ascii_alphanumeric(), "_");
                let name = format!("toyproof_zero_{}", name.trim_end_matches('_'));
                let function = cx.function(name, &[], ty, at);
                let body = initializer::zero_body(cx, ty, at);
                cx.tree[function].body = Some(body);
                function
            }
        }
    }
}

/// Corrects the truncated remainder: the quotient was rounded up exactly if the remainder and `b` have
/// different signs.
fn remainder(ty: Type) -> String {
    match ty {
        Type::Vector(_, size) => {
            let zero = format!("ivec{size}(0)");
            format!(
                "ivec{size} r = a % b;\n    \
                 return r + b * ivec{size}(notEqual(r, {zero})) * ivec{size}(lessThan(r ^ b, {zero}));"
            )
        }
        _ => "int r = a % b;\n    return r != 0 && (r ^ b) < 0 ? r + b : r;".to_owned(),
    }
}

/// Compares the bits below the sign with those of infinity: equal for an infinity, greater for a NaN.
fn classify(ty: Type, relation: char) -> String {
    match (ty, relation) {
        (Type::Vector(_, size), '>') => {
            format!(
                "return greaterThan(floatBitsToUint(x) & uvec{size}(0x7FFFFFFFu), uvec{size}(0x7F800000u));"
            )
        }
        (Type::Vector(_, size), _) => {
            format!("return equal(floatBitsToUint(x) & uvec{size}(0x7FFFFFFFu), uvec{size}(0x7F800000u));")
        }
        (_, '>') => "return (floatBitsToUint(x) & 0x7FFFFFFFu) > 0x7F800000u;".to_owned(),
        _ => "return (floatBitsToUint(x) & 0x7FFFFFFFu) == 0x7F800000u;".to_owned(),
    }
}

/// The type of an outer product: one column for each component of `r`, as many rows as `c` has components.
fn outer_product(c: Type, r: Type) -> Type {
    Type::Matrix {
        columns: r.component_count().unwrap_or(2),
        rows: c.component_count().unwrap_or(2),
    }
}

/// Builds a matrix column by column.
fn columns(name: &str, ty: Type, column: impl Fn(u8) -> String) -> String {
    let Type::Matrix { columns, .. } = ty else {
        return String::new();
    };
    let columns: Vec<_> = (0..columns).map(column).collect();
    format!("return {name}({});", columns.join(", "))
}

/// Divides the adjugate by the determinant.
fn inverse(ty: Type) -> String {
    match ty {
        Type::Matrix { columns: 2, .. } => {
            "return mat2(m[1][1], -m[0][1], -m[1][0], m[0][0]) / (m[0][0] * m[1][1] - m[1][0] * m[0][1]);"
                .to_owned()
        }
        Type::Matrix { columns: 3, .. } => "vec3 r0 = cross(m[1], m[2]);
    vec3 r1 = cross(m[2], m[0]);
    vec3 r2 = cross(m[0], m[1]);
    return mat3(r0.x, r1.x, r2.x, r0.y, r1.y, r2.y, r0.z, r1.z, r2.z) / dot(m[0], r0);"
            .to_owned(),
        _ => "float s0 = m[0][0] * m[1][1] - m[1][0] * m[0][1];
    float s1 = m[0][0] * m[1][2] - m[1][0] * m[0][2];
    float s2 = m[0][0] * m[1][3] - m[1][0] * m[0][3];
    float s3 = m[0][1] * m[1][2] - m[1][1] * m[0][2];
    float s4 = m[0][1] * m[1][3] - m[1][1] * m[0][3];
    float s5 = m[0][2] * m[1][3] - m[1][2] * m[0][3];
    float c5 = m[2][2] * m[3][3] - m[3][2] * m[2][3];
    float c4 = m[2][1] * m[3][3] - m[3][1] * m[2][3];
    float c3 = m[2][1] * m[3][2] - m[3][1] * m[2][2];
    float c2 = m[2][0] * m[3][3] - m[3][0] * m[2][3];
    float c1 = m[2][0] * m[3][2] - m[3][0] * m[2][2];
    float c0 = m[2][0] * m[3][1] - m[3][0] * m[2][1];
    float d = s0 * c5 - s1 * c4 + s2 * c3 + s3 * c2 - s4 * c1 + s5 * c0;
    return mat4(
        m[1][1] * c5 - m[1][2] * c4 + m[1][3] * c3, -m[0][1] * c5 + m[0][2] * c4 - m[0][3] * c3,
        m[3][1] * s5 - m[3][2] * s4 + m[3][3] * s3, -m[2][1] * s5 + m[2][2] * s4 - m[2][3] * s3,
        -m[1][0] * c5 + m[1][2] * c2 - m[1][3] * c1, m[0][0] * c5 - m[0][2] * c2 + m[0][3] * c1,
        -m[3][0] * s5 + m[3][2] * s2 - m[3][3] * s1, m[2][0] * s5 - m[2][2] * s2 + m[2][3] * s1,
        m[1][0] * c4 - m[1][1] * c2 + m[1][3] * c0, -m[0][0] * c4 + m[0][1] * c2 - m[0][3] * c0,
        m[3][0] * s4 - m[3][1] * s2 + m[3][3] * s0, -m[2][0] * s4 + m[2][1] * s2 - m[2][3] * s0,
        -m[1][0] * c3 + m[1][1] * c1 - m[1][2] * c0, m[0][0] * c3 - m[0][1] * c1 + m[0][2] * c0,
        -m[3][0] * s3 + m[3][1] * s1 - m[3][2] * s0, m[2][0] * s3 - m[2][1] * s1 + m[2][2] * s0
    ) / d;"
            .to_owned(),
    }
}

/// Calls `visit` with each call of a built-in function.
fn each_built_in(
    cx: &mut LoweringContext,
    mut visit: impl FnMut(&mut LoweringContext, ExprId, BuiltIn, Vec<ExprId>),
) {
    cx.each_expression(|cx, id| {
        if let ExprKind::BuiltIn {
            function,
            ref arguments,
        } = cx.tree[id].kind
        {
            let arguments = arguments.clone();
            visit(cx, id, function, arguments);
        }
    });
}

/// Replaces `modf`, `matrixCompMult`, `outerProduct` and `inverse` by helper functions.
///
/// naga's GLSL front end does not know `modf` (gfx-rs/naga #2526) and `matrixCompMult`; naga cannot write
/// `outerProduct` as WGSL, HLSL or Metal, nor `inverse` as HLSL or Metal.
pub(super) fn lower_missing(cx: &mut LoweringContext) {
    each_built_in(cx, |cx, id, function, arguments| {
        let helper = match function {
            BuiltIn::Modf => Helper::Modf,
            BuiltIn::MatrixCompMult => Helper::MatrixCompMult,
            BuiltIn::OuterProduct => Helper::OuterProduct,
            BuiltIn::Inverse => Helper::Inverse,
            _ => return,
        };
        let ty = |at: usize| {
            arguments
                .get(at)
                .map_or(Type::Void, |&argument| cx.tree[argument].ty)
        };
        let types = (ty(0), ty(1));
        let at = cx.tree[id].at;
        let function = cx.helper(helper, types, at);
        cx.tree[id].kind = ExprKind::Call { function, arguments };
    });
}

/// Replaces geometric functions of scalars: `dot(1., 2.)`, `normalize(x)`, `reflect(x, n)`.
///
/// naga declares them but cannot resolve their types. It accepts `length` and `distance`.
pub(super) fn lower_geometric(cx: &mut LoweringContext) {
    each_built_in(cx, |cx, id, function, arguments| {
        let (Some(&first), at) = (arguments.first(), cx.tree[id].at) else {
            return;
        };
        if cx.tree[first].ty != Type::FLOAT {
            return;
        }
        let helper = match function {
            BuiltIn::Dot => {
                cx.tree[id].kind = ExprKind::Binary {
                    op: BinaryOp::Multiply,
                    left: first,
                    right: arguments.get(1).copied().unwrap_or(first),
                };
                return;
            }
            BuiltIn::Normalize => Helper::Normalize,
            BuiltIn::Faceforward => Helper::Faceforward,
            BuiltIn::Refract => Helper::Refract,
            BuiltIn::Reflect => Helper::Reflect,
            _ => return,
        };
        let function = cx.helper(helper, (Type::FLOAT, Type::Void), at);
        cx.tree[id].kind = ExprKind::Call { function, arguments };
    });
}

/// Replaces `isnan` and `isinf` by tests of bits.
///
/// naga parses them but has no WGSL for them: WGSL lets compilers assume that neither value occurs.
pub(super) fn lower_is_nan(cx: &mut LoweringContext) {
    each_built_in(cx, |cx, id, function, arguments| {
        let helper = match function {
            BuiltIn::IsNan => Helper::IsNan,
            BuiltIn::IsInf => Helper::IsInf,
            _ => return,
        };
        let ty = arguments
            .first()
            .map_or(Type::FLOAT, |&argument| cx.tree[argument].ty);
        let at = cx.tree[id].at;
        let function = cx.helper(helper, (ty, Type::Void), at);
        cx.tree[id].kind = ExprKind::Call { function, arguments };
    });
}
