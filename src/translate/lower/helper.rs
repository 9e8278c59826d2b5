//! Functions of our own that lowered text calls, each written once for each type that asks for it.

use toyproof_glsl::tree::{BuiltIn, Direction, FunctionId, Place, Scalar, Type};

use super::draft::Draft;
use super::{equality, zero};

/// What such a function does; the types that it is made for complete it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Helper {
    /// The argument as it is, unknown to whoever evaluates constants.
    Runtime,
    /// `%` that floors.
    Remainder,
    /// `normalize` of a float.
    Normalize,
    /// `faceforward` of floats.
    Faceforward,
    /// `refract` of floats.
    Refract,
    /// `reflect` of floats.
    Reflect,
    /// A 2×2 matrix of a `vec4`.
    Matrix,
    /// `matrixCompMult`.
    MatrixCompMult,
    /// `outerProduct`.
    OuterProduct,
    /// `inverse`.
    Inverse,
    /// `isnan`.
    IsNan,
    /// `isinf`.
    IsInf,
    /// `modf`.
    Modf,
    /// `==` of structures and arrays.
    Equal,
    /// A structure or an array of zeros.
    Zero,
    /// A structure of its members; [`super::member`] gives it a body.
    Make,
}

impl Helper {
    /// Adds the function for those types; the second is that of a second argument, where it can differ.
    pub(super) fn make(self, draft: &mut Draft, (ty, other): (Type, Type), at: Place) -> FunctionId {
        use Direction::{In, Out};
        let float = Type::FLOAT;
        let boolean = ty.with_scalar(Scalar::Bool).unwrap_or(Type::BOOL);
        let name = |draft: &Draft, ty| draft.tree.type_name(ty);
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
                columns(&name(draft, ty), ty, |c| format!("a[{c}] * b[{c}]")),
            ),
            Self::OuterProduct => (
                BuiltIn::OuterProduct.name(),
                vec![(In, ty, "c"), (In, other, "r")],
                outer_product(ty, other),
                columns(
                    &name(draft, outer_product(ty, other)),
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
            Self::Equal | Self::Zero | Self::Make => return self.make_tree(draft, ty, at),
        };
        let function = draft.function(format!("toyproof_{label}"), &parameters, return_type, at);
        draft.helpers.insert(function, body);
        function
    }

    /// Adds a function that is made of nodes, since it names what the author named.
    fn make_tree(self, draft: &mut Draft, ty: Type, at: Place) -> FunctionId {
        use Direction::In;
        match (self, ty) {
            (Self::Make, Type::Struct(id)) => {
                let made = draft.tree[id].clone();
                let members = made
                    .members
                    .iter()
                    .map(|member| (In, member.ty, member.name.as_str()));
                let members: Vec<_> = members.collect();
                draft.function(format!("toyproof_{}", made.name), &members, ty, at)
            }
            (Self::Equal, _) => {
                let parameters = [(In, ty, "a"), (In, ty, "b")];
                let function = draft.function("toyproof_equal".to_owned(), &parameters, Type::BOOL, at);
                let body = equality::body(draft, function, ty, at);
                draft.tree[function].body = Some(body);
                function
            }
            _ => {
                let name = draft
                    .tree
                    .type_name(ty)
                    .replace(|c: char| !c.is_ascii_alphanumeric(), "_");
                let name = format!("toyproof_zero_{}", name.trim_end_matches('_'));
                let function = draft.function(name, &[], ty, at);
                let body = zero::body(draft, ty, at);
                draft.tree[function].body = Some(body);
                function
            }
        }
    }
}

/// `a` and `b` have different signs exactly if the truncated quotient was rounded up.
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

/// Infinity is all ones in the exponent and zeros below; NaN has more.
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

/// The matrix of as many columns as `r` has components, each as long as `c`.
fn outer_product(c: Type, r: Type) -> Type {
    Type::Matrix {
        columns: r.component_count().unwrap_or(2),
        rows: c.component_count().unwrap_or(2),
    }
}

/// Makes a matrix column by column.
fn columns(name: &str, ty: Type, column: impl Fn(u8) -> String) -> String {
    let Type::Matrix { columns, .. } = ty else {
        return String::new();
    };
    let columns: Vec<_> = (0..columns).map(column).collect();
    format!("return {name}({});", columns.join(", "))
}

/// The adjugate over the determinant.
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
