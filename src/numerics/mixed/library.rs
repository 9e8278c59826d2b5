//! Functions in 16 bits: rounding, and the functions of GLSL that consist of several operations, each of
//! which is rounded. They overflow where their intermediate results do: `length(vec2(300.0))` is infinite.

use std::collections::HashMap;
use std::sync::LazyLock;

use toyproof_diagnostic::{File, Files};
use toyproof_glsl::tree::{
    ExprKind, Function, FunctionId, Item, Place, Statement, StatementKind, Tree, Type, VariableId,
};
use toyproof_glsl::{Checked, Options, check};
use toyproof_translate::backend::spirv::ROUNDING_FUNCTION;

/// The start of the names of the functions that compute what built-in functions do.
const PREFIX: &str = "h_";

/// The formulas are those of `toyproof_math`. Each function is one expression.
const TEXT: &str = "
#define H toyproof_half
float H(float x) { return unpackHalf2x16(packHalf2x16(vec2(x))).x; }
vec2 H(vec2 x) { return unpackHalf2x16(packHalf2x16(x)); }
vec3 H(vec3 x) { return vec3(H(x.xy), H(x.z)); }
vec4 H(vec4 x) { return vec4(H(x.xy), H(x.zw)); }

float sum(vec2 x) { return H(x.x + x.y); }
float sum(vec3 x) { return H(sum(x.xy) + x.z); }
float sum(vec4 x) { return H(sum(x.xyz) + x.w); }

#define COMMON(T, S) \\
    T h_mod(T x, S y) { return H(x - H(y * floor(H(x / y)))); } \\
    T h_mix(T a, T b, S t) { return H(H(a * H(1.0 - t)) + H(b * t)); }
COMMON(float, float) COMMON(vec2, vec2) COMMON(vec3, vec3) COMMON(vec4, vec4)
COMMON(vec2, float) COMMON(vec3, float) COMMON(vec4, float)

#define SMOOTH(T) \\
    T cubic(T t) { return H(H(t * t) * H(3.0 - H(2.0 * t))); } \\
    T h_smoothstep(T low, T high, T x) { return cubic(clamp(H(H(x - low) / H(high - low)), 0.0, 1.0)); }
SMOOTH(float) SMOOTH(vec2) SMOOTH(vec3) SMOOTH(vec4)
#define SMOOTH_BETWEEN(T) \\
    T h_smoothstep(float low, float high, T x) { return h_smoothstep(T(low), T(high), x); }
SMOOTH_BETWEEN(vec2) SMOOTH_BETWEEN(vec3) SMOOTH_BETWEEN(vec4)

#define GEOMETRIC(T) \\
    float h_dot(T a, T b) { return sum(H(a * b)); } \\
    float h_length(T v) { return H(sqrt(h_dot(v, v))); } \\
    float h_distance(T a, T b) { return h_length(H(a - b)); } \\
    T h_normalize(T v) { return H(v / h_length(v)); } \\
    T h_faceforward(T n, T i, T r) { return h_dot(r, i) < 0.0 ? n : -n; } \\
    T h_reflect(T i, T n) { return H(i - H(H(2.0 * h_dot(n, i)) * n)); } \\
    T refracted(T i, T n, float eta, float c, float k) { \\
        return k < 0.0 ? T(0.0) : H(H(eta * i) - H(H(H(eta * c) + H(sqrt(k))) * n)); } \\
    T refracted(T i, T n, float eta, float c) { \\
        return refracted(i, n, eta, c, H(1.0 - H(H(eta * eta) * H(1.0 - H(c * c))))); } \\
    T h_refract(T i, T n, float eta) { return refracted(i, n, eta, h_dot(n, i)); }
GEOMETRIC(vec2) GEOMETRIC(vec3) GEOMETRIC(vec4)
vec3 h_cross(vec3 a, vec3 b) { return H(H(a.yzx * b.zxy) - H(b.yzx * a.zxy)); }

void mainImage(out vec4 c, in vec2 p) {}
";

static LIBRARY: LazyLock<Option<Checked>> = LazyLock::new(|| {
    let mut files = Files::default();
    let file = files.add(File::new("<halves>", TEXT));
    check(&files, file, &Options::default()).ok()
});

/// The functions, added to the tree of a shader.
pub(super) struct Library(HashMap<(String, Vec<Type>), FunctionId>);

impl Library {
    /// Adds the functions to a tree.
    pub(super) fn of(tree: &mut Tree, at: Place) -> Self {
        let mut functions = HashMap::new();
        let Some(library) = LIBRARY.as_ref() else {
            return Self(functions);
        };
        let mut ids = HashMap::new();
        for (id, function) in library.tree.functions.iter() {
            let body = function.body.as_deref().unwrap_or_default();
            let &[
                Statement {
                    kind: StatementKind::Return(Some(root)),
                    ..
                },
            ] = body
            else {
                continue;
            };
            let copied = function.parameters.iter().map(|&parameter| {
                let mut variable = library.tree[parameter].clone();
                variable.at = Some(at);
                (parameter, tree.variables.push(variable))
            });
            let parameters: HashMap<VariableId, VariableId> = copied.collect();
            let mut exprs = HashMap::new();
            for id in library.tree.postorder(root) {
                let mut expr = library.tree[id].clone();
                expr.at = at;
                match &mut expr.kind {
                    ExprKind::Variable(variable) => *variable = parameters[variable],
                    ExprKind::Call { function, .. } => *function = ids[function],
                    _ => {}
                }
                expr.kind
                    .for_each_operand_mut(|operand| *operand = exprs[operand]);
                exprs.insert(id, tree.exprs.push(expr));
            }
            let value = StatementKind::Return(Some(exprs[&root]));
            let types = function
                .parameters
                .iter()
                .map(|&parameter| library.tree[parameter].ty);
            let key = (function.name.clone(), types.collect());
            let copy = tree.functions.push(Function {
                parameters: function
                    .parameters
                    .iter()
                    .map(|parameter| parameters[parameter])
                    .collect(),
                body: Some(vec![Statement::new(value, at)]),
                at,
                ..function.clone()
            });
            tree.items.insert(0, Item::Function(copy));
            ids.insert(id, copy);
            functions.insert(key, copy);
        }
        Self(functions)
    }

    /// The function that rounds values of a type.
    pub(super) fn rounding(&self, ty: Type) -> Option<FunctionId> {
        self.0.get(&(ROUNDING_FUNCTION.to_owned(), vec![ty])).copied()
    }

    /// The function that computes what a built-in function does with arguments of these types.
    pub(super) fn built_in(&self, name: &str, types: Vec<Type>) -> Option<FunctionId> {
        self.0.get(&(format!("{PREFIX}{name}"), types)).copied()
    }
}
