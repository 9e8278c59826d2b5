//! Expansion of operations that drivers compute differently, such as `sin` and matrix products, into
//! operations that they compute alike.
//!
//! A module that still contains the author's functions can then be compared bit by bit with the evaluator's
//! image. The expansions come from a library: a generated shader in strict form (`crate::lower_strict`),
//! whose functions are put before the module's own. Each expanded expression becomes a call.

use std::collections::HashMap;
use std::fmt::Write as _;

use naga::{
    BinaryOperator, Block, Expression, Function, Handle, MathFunction, Module, Range, ScalarKind, Span,
    Statement, Type, TypeInner,
};
use toyproof_diagnostic::{Diagnostics, File, Files};
use toyproof_glsl as glsl;

use crate::TranslateError;
use crate::naga_ir::ValidModule;

/// An expression to expand, with the index of its library function and its operands.
struct Site {
    at: Handle<Expression>,
    need: usize,
    arguments: Vec<Handle<Expression>>,
}

impl ValidModule {
    /// Returns the same module with every operation expanded to the same bits on all conforming drivers.
    ///
    /// # Errors
    /// naga's message, if it refuses the result.
    pub fn spelled(&self) -> Result<Self, TranslateError> {
        let naga = &self.module;
        let mut needs = Vec::new();
        let mut in_functions = Vec::new();
        for (handle, function) in naga.functions.iter() {
            let info = &self.info[handle];
            let ty = |at: Handle<Expression>| info[at].ty.inner_with(&naga.types);
            in_functions.push(sites(function, ty, &mut needs));
        }
        let mut in_entries = Vec::new();
        for (index, entry) in naga.entry_points.iter().enumerate() {
            let info = self.info.get_entry_point(index);
            let ty = |at: Handle<Expression>| info[at].ty.inner_with(&naga.types);
            in_entries.push(sites(&entry.function, ty, &mut needs));
        }
        if needs.is_empty() {
            return Ok(self.clone());
        }
        let mut module = naga.clone();
        let own = std::mem::take(&mut module.functions);
        let calls = link(&mut module, &needs)?;
        let mut handles = Vec::new();
        for ((handle, function), sites) in own.iter().zip(&in_functions) {
            let mut function = function.clone();
            renumber(&mut function, &handles);
            replace(&mut function, sites, &calls);
            handles.push(module.functions.append(function, own.get_span(handle)));
        }
        for (entry, sites) in module.entry_points.iter_mut().zip(&in_entries) {
            renumber(&mut entry.function, &handles);
            replace(&mut entry.function, sites, &calls);
        }
        Self::new(module)
    }
}

/// Collects the expressions of a function to expand.
fn sites<'a>(
    function: &Function,
    ty: impl Fn(Handle<Expression>) -> &'a TypeInner,
    needs: &mut Vec<Need>,
) -> Vec<Site> {
    let mut sites = Vec::new();
    for (at, expression) in function.expressions.iter() {
        let (value, arguments) = match *expression {
            Expression::Math {
                fun, arg, arg1, arg2, ..
            } => {
                let Some(name) = glsl_function(fun) else { continue };
                let arguments: Vec<_> = [Some(arg), arg1, arg2].into_iter().flatten().collect();
                (
                    format!("{name}({})", ["a", "b", "c"][..arguments.len()].join(", ")),
                    arguments,
                )
            }
            Expression::Binary {
                op: BinaryOperator::Multiply,
                left,
                right,
            } => {
                let is_matrix = |at| matches!(ty(at), TypeInner::Matrix { .. });
                let is_scalar = |at| matches!(ty(at), TypeInner::Scalar(_));
                if !(is_matrix(left) || is_matrix(right)) || is_scalar(left) || is_scalar(right) {
                    continue;
                }
                ("a * b".to_owned(), vec![left, right])
            }
            Expression::As {
                expr,
                kind: ScalarKind::Float,
                convert: Some(4),
            } if ty(expr).scalar_kind() == Some(ScalarKind::Uint) => {
                let Some(name) = glsl_type(ty(at)) else { continue };
                (format!("{name}(a)"), vec![expr])
            }
            _ => continue,
        };
        // The `dot` of integers is exact.
        let types: Option<Vec<_>> = arguments.iter().map(|&at| glsl_type(ty(at))).collect();
        let (Some(types), Some(result)) = (types, glsl_type(ty(at))) else {
            continue;
        };
        if ty(at).scalar_kind() != Some(ScalarKind::Float) {
            continue;
        }
        let need = Need { value, types, result };
        sites.push(Site {
            at,
            need: need.index_in(needs),
            arguments,
        });
    }
    sites
}

/// The GLSL name of a function whose last bits depend on the driver.
fn glsl_function(function: MathFunction) -> Option<&'static str> {
    use MathFunction as M;
    Some(match function {
        M::Radians => "radians",
        M::Degrees => "degrees",
        M::Sin => "sin",
        M::Cos => "cos",
        M::Tan => "tan",
        M::Asin => "asin",
        M::Acos => "acos",
        M::Atan | M::Atan2 => "atan",
        M::Sinh => "sinh",
        M::Cosh => "cosh",
        M::Tanh => "tanh",
        M::Asinh => "asinh",
        M::Acosh => "acosh",
        M::Atanh => "atanh",
        M::Pow => "pow",
        M::Exp => "exp",
        M::Log => "log",
        M::Exp2 => "exp2",
        M::Log2 => "log2",
        M::InverseSqrt => "inversesqrt",
        M::Fract => "fract",
        M::Mix => "mix",
        M::Step => "step",
        M::SmoothStep => "smoothstep",
        M::Length => "length",
        M::Distance => "distance",
        M::Dot => "dot",
        M::Cross => "cross",
        M::Normalize => "normalize",
        M::FaceForward => "faceforward",
        M::Reflect => "reflect",
        M::Refract => "refract",
        M::Determinant => "determinant",
        M::Inverse => "inverse",
        M::Unpack2x16snorm => "unpackSnorm2x16",
        M::Unpack2x16unorm => "unpackUnorm2x16",
        M::Unpack2x16float => "unpackHalf2x16",
        _ => return None,
    })
}

/// The GLSL name of a type of 32-bit floats or unsigned integers.
fn glsl_type(ty: &TypeInner) -> Option<String> {
    let of = |scalar: naga::Scalar| match scalar {
        naga::Scalar::F32 => Some(("float", "vec")),
        naga::Scalar::U32 => Some(("uint", "uvec")),
        _ => None,
    };
    match *ty {
        TypeInner::Scalar(scalar) => of(scalar).map(|(one, _)| one.to_owned()),
        TypeInner::Vector { size, scalar } => of(scalar).map(|(_, vector)| format!("{vector}{}", size as u8)),
        TypeInner::Matrix { columns, rows, .. } if columns == rows => Some(format!("mat{}", columns as u8)),
        TypeInner::Matrix { columns, rows, .. } => Some(format!("mat{}x{}", columns as u8, rows as u8)),
        _ => None,
    }
}

/// Puts the library functions before all others. Returns the function for each need.
fn link(module: &mut Module, needs: &[Need]) -> Result<Vec<Handle<Function>>, TranslateError> {
    let library = library(needs)?;
    let library = library.module();
    let mut types = HashMap::new();
    for (handle, ty) in library.types.iter() {
        // The functions only use plain values; structures belong to the interface of the library's shader.
        if glsl_type(&ty.inner).is_some() || ty.inner.scalar().is_some() {
            let plain = Type {
                name: None,
                inner: ty.inner.clone(),
            };
            types.insert(handle, module.types.insert(plain, Span::UNDEFINED));
        }
    }
    let mut calls = vec![None; needs.len()];
    for (handle, function) in library.functions.iter() {
        let mut function = function.clone();
        let name = function.name.as_deref().unwrap_or_default();
        if is_library_caller(name) {
            break;
        }
        let need = need_index(name);
        retype(&mut function, &types)?;
        let placed = module.functions.append(function, Span::UNDEFINED);
        if placed.index() != handle.index() {
            return Err("the functions of the library are out of order".into());
        }
        if let Some(call) = need.and_then(|need| calls.get_mut(need)) {
            *call = Some(placed);
        }
    }
    let calls: Option<Vec<_>> = calls.into_iter().collect();
    calls.ok_or_else(|| "a function of the library is missing".into())
}

/// Maps the type handles of a function to those of another module.
fn retype(
    function: &mut Function,
    types: &HashMap<Handle<Type>, Handle<Type>>,
) -> Result<(), TranslateError> {
    let known = |ty: &mut Handle<Type>| {
        *ty = *types
            .get(ty)
            .ok_or("a function of the library has a type of its own")?;
        Ok::<(), TranslateError>(())
    };
    function
        .arguments
        .iter_mut()
        .try_for_each(|argument| known(&mut argument.ty))?;
    function
        .result
        .iter_mut()
        .try_for_each(|result| known(&mut result.ty))?;
    function
        .local_variables
        .iter_mut()
        .try_for_each(|(_, local)| known(&mut local.ty))?;
    function
        .expressions
        .iter_mut()
        .try_for_each(|(_, expression)| match expression {
            Expression::ZeroValue(ty) | Expression::Compose { ty, .. } => known(ty),
            Expression::Constant(_) | Expression::GlobalVariable(_) => {
                Err("a function of the library refers to its surroundings".into())
            }
            _ => Ok(()),
        })
}

/// Updates calls to the new handles of the module's own functions.
fn renumber(function: &mut Function, handles: &[Handle<Function>]) {
    for (_, expression) in function.expressions.iter_mut() {
        if let Expression::CallResult(called) = expression {
            *called = handles[called.index()];
        }
    }
    each_block(&mut function.body, &mut |block| {
        for statement in block.iter_mut() {
            if let Statement::Call { function, .. } = statement {
                *function = handles[function.index()];
            }
        }
    });
}

/// Replaces expressions by calls.
fn replace(function: &mut Function, sites: &[Site], calls: &[Handle<Function>]) {
    let by_place: HashMap<_, _> = sites.iter().map(|site| (site.at, site)).collect();
    for site in sites {
        function.expressions[site.at] = Expression::CallResult(calls[site.need]);
    }
    each_block(&mut function.body, &mut |block| {
        let mut replaced = Block::with_capacity(block.len());
        for (statement, span) in std::mem::take(block).span_into_iter() {
            let Statement::Emit(range) = &statement else {
                replaced.push(statement, span);
                continue;
            };
            let mut pending: Option<(Handle<Expression>, Handle<Expression>)> = None;
            let flush = |pending: &mut Option<_>, replaced: &mut Block| {
                if let Some((first, last)) = pending.take() {
                    replaced.push(Statement::Emit(Range::new_from_bounds(first, last)), span);
                }
            };
            for at in range.clone() {
                if let Some(site) = by_place.get(&at) {
                    flush(&mut pending, &mut replaced);
                    let call = Statement::Call {
                        function: calls[site.need],
                        arguments: site.arguments.clone(),
                        result: Some(at),
                    };
                    replaced.push(call, span);
                } else {
                    pending = Some((pending.map_or(at, |(first, _)| first), at));
                }
            }
            flush(&mut pending, &mut replaced);
        }
        *block = replaced;
    });
}

/// Rewrites every block by `change`, inner blocks first.
fn each_block(block: &mut Block, change: &mut impl FnMut(&mut Block)) {
    for statement in block.iter_mut() {
        match statement {
            Statement::Block(block) => each_block(block, change),
            Statement::If { accept, reject, .. } => {
                each_block(accept, change);
                each_block(reject, change);
            }
            Statement::Switch { cases, .. } => {
                for case in cases {
                    each_block(&mut case.body, change);
                }
            }
            Statement::Loop { body, continuing, .. } => {
                each_block(body, change);
                each_block(continuing, change);
            }
            _ => {}
        }
    }
    change(block);
}

/// A library function: GLSL that computes its value from `a`, `b` and `c`, their types, and the type of the
/// value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Need {
    pub(crate) value: String,
    pub(crate) types: Vec<String>,
    pub(crate) result: String,
}

impl Need {
    /// Returns the index of this need in a list, which it is appended to if missing.
    pub(crate) fn index_in(self, needs: &mut Vec<Self>) -> usize {
        needs.iter().position(|known| *known == self).unwrap_or_else(|| {
            needs.push(self);
            needs.len() - 1
        })
    }
}

const MAIN_IMAGE: &str = "mainImage";
const PREFIX: &str = "toyproof_need_";

/// The index of the need that a library function serves.
pub(crate) fn need_index(function: &str) -> Option<usize> {
    function.strip_prefix(PREFIX)?.parse().ok()
}

/// Whether a function of the library only calls the others.
pub(crate) fn is_library_caller(function: &str) -> bool {
    function == MAIN_IMAGE || function == "main"
}

/// Builds a strict shader with one function for each need.
///
/// # Errors
/// Its first error message, in one line.
pub(crate) fn library(needs: &[Need]) -> Result<ValidModule, TranslateError> {
    let mut text = String::new();
    let mut uses = String::new();
    for (index, need) in needs.iter().enumerate() {
        let parameters: Vec<_> = need
            .types
            .iter()
            .zip(["a", "b", "c"])
            .map(|(ty, name)| format!("{ty} {name}"))
            .collect();
        let arguments: Vec<_> = need.types.iter().map(|ty| format!("{ty}(p.x)")).collect();
        let Need { value, result, .. } = need;
        let _ = writeln!(
            text,
            "{result} {PREFIX}{index}({}) {{ return {value}; }}",
            parameters.join(", ")
        );
        let _ = writeln!(
            uses,
            "{result} v{index} = {PREFIX}{index}({});",
            arguments.join(", ")
        );
    }
    let _ = writeln!(text, "void {MAIN_IMAGE}(out vec4 c, in vec2 p) {{\n{uses}}}");
    let mut files = Files::default();
    let file = files.add(File::new("<library>", &text));
    let first = |errors: Diagnostics| {
        let first = errors.first();
        TranslateError(first.map_or_else(String::new, |error| error.message.clone()))
    };
    let checked = glsl::check(&files, file, &glsl::Options::default()).map_err(first)?;
    ValidModule::parse(&crate::lower_strict(&checked)).map_err(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "
        fn twice(x: f32) -> f32 { return sin(x) * 2.0; }
        @fragment fn main(@builtin(position) p: vec4f) -> @location(0) vec4f {
            var sum = vec2f();
            for (var i = 0; i < 3; i++) {
                if p.x > 4.0 { sum += mat2x2f(p.xy, p.yx) * normalize(p.zw); }
                sum.x += twice(sum.y) + f32(u32(p.x)) + f32(dot(vec2i(i), vec2i(2)));
            }
            return vec4f(sum, 0.0, pow(p.x, 2.0));
        }";

    fn wgsl(module: &ValidModule) -> String {
        let flags = naga::back::wgsl::WriterFlags::empty();
        naga::back::wgsl::write_string(module.module(), module.info(), flags).unwrap()
    }

    #[test]
    fn only_driver_dependent_operations_become_calls() {
        let module = ValidModule::of_wgsl(TEXT).unwrap();
        let text = wgsl(&module.spelled().unwrap());
        let main = &text[text.find("@fragment").unwrap()..];
        for function in ["normalize(", "pow("] {
            assert!(!main.contains(function), "{main}");
        }
        assert!(!text[text.find("fn twice").unwrap()..].contains("sin("), "{text}");
        // The product, `normalize`, the conversion of the unsigned integer and `pow`; the author's call
        // remains.
        assert_eq!(main.matches(PREFIX).count(), 4, "{main}");
        assert!(main.contains("twice(") && main.contains("dot("), "{main}");
    }

    #[test]
    fn other_modules_do_not_change() {
        let text = "@fragment fn main(@builtin(position) p: vec4f) -> @location(0) vec4f { return sqrt(p) + floor(p); }";
        let module = ValidModule::of_wgsl(text).unwrap();
        assert_eq!(wgsl(&module.spelled().unwrap()), wgsl(&module));
    }
}
