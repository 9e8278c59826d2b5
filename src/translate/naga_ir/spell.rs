//! The same module with what drivers differ in spelled in operations that they agree on: `sin` and the like, products of
//! matrices. A module whose text keeps the author's functions can so be compared to the bit with what the evaluator paints.
//!
//! The functions are put before the module's own, and each expression that they stand for becomes a call.

use std::collections::HashMap;

use naga::{
    BinaryOperator, Block, Expression, Function, Handle, MathFunction, Module, Range, ScalarKind, Span,
    Statement, Type, TypeInner,
};

use super::ValidModule;
use super::library::{self, Need, library};

/// An expression that is spelled: where it stands, what it needs, and its operands.
struct Site {
    at: Handle<Expression>,
    need: usize,
    arguments: Vec<Handle<Expression>>,
}

impl ValidModule {
    /// The same module, every operation of which has the same bits on all drivers that keep to its arithmetic.
    ///
    /// # Errors
    /// naga's words, should it refuse the result.
    pub fn spelled(&self) -> Result<Self, String> {
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
        Self::validate(module).map_err(|error| super::chain(error.as_inner()))
    }
}

/// The expressions of a function that are spelled.
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
                let Some(name) = spelled(fun) else { continue };
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
                let Some(name) = name(ty(at)) else { continue };
                (format!("{name}(a)"), vec![expr])
            }
            _ => continue,
        };
        // Integers have their own `dot`, which is exact.
        let types: Option<Vec<_>> = arguments.iter().map(|&at| name(ty(at))).collect();
        let (Some(types), Some(result)) = (types, name(ty(at))) else {
            continue;
        };
        if ty(at).scalar_kind() != Some(ScalarKind::Float) {
            continue;
        }
        let need = Need { value, types, result };
        sites.push(Site {
            at,
            need: need.among(needs),
            arguments,
        });
    }
    sites
}

/// The GLSL name of a function whose last bits drivers choose.
fn spelled(function: MathFunction) -> Option<&'static str> {
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

/// GLSL's name for a type of 32-bit floats or unsigned integers.
fn name(ty: &TypeInner) -> Option<String> {
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

/// Puts the functions that are needed before all others; says which stands for which need.
fn link(module: &mut Module, needs: &[Need]) -> Result<Vec<Handle<Function>>, String> {
    let library = library(needs)?;
    let library = library.module();
    let mut types = HashMap::new();
    for (handle, ty) in library.types.iter() {
        // Its functions are of plain values; structures are the surroundings of the shader that they were made with.
        if name(&ty.inner).is_some() || ty.inner.scalar().is_some() {
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
        if library::is_surroundings(name) {
            break;
        }
        let need = library::need(name);
        retype(&mut function, &types)?;
        let placed = module.functions.append(function, Span::UNDEFINED);
        if placed.index() != handle.index() {
            return Err("the functions of the library are out of order".to_owned());
        }
        if let Some(call) = need.and_then(|need| calls.get_mut(need)) {
            *call = Some(placed);
        }
    }
    let calls: Option<Vec<_>> = calls.into_iter().collect();
    calls.ok_or_else(|| "a function of the library is missing".to_owned())
}

/// Makes a function of one module one of another, which has its types under other handles.
fn retype(function: &mut Function, types: &HashMap<Handle<Type>, Handle<Type>>) -> Result<(), String> {
    let known = |ty: &mut Handle<Type>| {
        *ty = *types
            .get(ty)
            .ok_or("a function of the library has a type of its own")?;
        Ok::<(), String>(())
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
                Err("a function of the library refers to its surroundings".to_owned())
            }
            _ => Ok(()),
        })
}

/// Calls of functions that others were put before.
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

/// Puts calls where the expressions stood.
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

/// Lets `change` rewrite every block, inner ones first.
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
    fn what_drivers_differ_in_becomes_calls_and_nothing_else_does() {
        let module = ValidModule::of_wgsl(TEXT).unwrap();
        let text = wgsl(&module.spelled().unwrap());
        let main = &text[text.find("@fragment").unwrap()..];
        for function in ["normalize(", "pow("] {
            assert!(!main.contains(function), "{main}");
        }
        assert!(!text[text.find("fn twice").unwrap()..].contains("sin("), "{text}");
        // The product, the normal, the number of an unsigned one, the power; the author's call stays.
        assert_eq!(main.matches(library::PREFIX).count(), 4, "{main}");
        assert!(main.contains("twice(") && main.contains("dot("), "{main}");
    }

    #[test]
    fn a_module_without_them_stays_as_it_is() {
        let text = "@fragment fn main(@builtin(position) p: vec4f) -> @location(0) vec4f { return sqrt(p) + floor(p); }";
        let module = ValidModule::of_wgsl(text).unwrap();
        assert_eq!(wgsl(&module.spelled().unwrap()), wgsl(&module));
    }
}
