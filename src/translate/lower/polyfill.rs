//! Expansion of the functions whose last bits depend on the driver, into operations that all drivers compute
//! in the same way: for strict shaders only.
//!
//! Each is generated once (`toyproof_math`); a function of vectors calls the function of their components.
//! Matrix products are expanded late, when the indices of targets have no side effects any more.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::fmt::Write as _;

use toyproof_glsl::tree::{
    BinaryOp, Constructor, Definition, Direction, ExprId, ExprKind, FunctionId, Place, Scalar, Statement,
    StatementKind, Swizzle, Type, VariableKind, walk,
};
use toyproof_math::{Binary, ExprGraph, FloatTerm, Kind, Matrix, Step, StepId, Unary};

use crate::inexact::InexactFunction;
use crate::lower::context::LoweringContext;
use crate::lower::generated::Expansion;
use crate::lower::lookup::{self, lookup_function};

pub(super) fn expand_inexact_functions(cx: &mut LoweringContext) {
    cx.each_expression(|cx, id| match &cx.tree[id].kind {
        ExprKind::BuiltIn { function, arguments }
            if InexactFunction::from_built_in(*function, arguments.len()).is_some()
                && !is_selection(cx, arguments) =>
        {
            let (function, arguments) = (Expansion::Function(*function), arguments.clone());
            call(cx, id, function, arguments);
        }
        ExprKind::Construct { arguments, .. } if cx.tree[id].ty.scalar() == Some(Scalar::Float) => {
            for argument in arguments.clone() {
                let ty = cx.tree[argument].ty;
                if let (Some(Scalar::Uint), Some(float)) = (ty.scalar(), ty.with_scalar(Scalar::Float)) {
                    let value = cx.build_at(argument).detach(argument);
                    cx.tree[argument].ty = float;
                    call(cx, argument, Expansion::UintToFloat, vec![value]);
                }
            }
        }
        _ => {}
    });
    demote_constants(cx);
}

/// Whether the last argument is boolean: such a `mix` selects.
fn is_selection(cx: &LoweringContext, arguments: &[ExprId]) -> bool {
    let scalar = |id: &ExprId| cx.tree[*id].ty.scalar();
    arguments.last().and_then(scalar) == Some(Scalar::Bool)
}

/// Expands `*` of matrices and vectors.
pub(super) fn expand_matrix_products(cx: &mut LoweringContext) {
    cx.each_expression(|cx, id| match cx.tree[id].kind {
        ExprKind::Binary {
            op: BinaryOp::Multiply,
            left,
            right,
        } if is_product(cx, left, right) => call(cx, id, Expansion::Product, vec![left, right]),
        ExprKind::Assign {
            op: Some(BinaryOp::Multiply),
            target,
            value,
        } if is_product(cx, target, value) => {
            let ty = cx.tree[target].ty;
            let mut build = cx.build_at(id);
            let left = build.copy(target);
            let product = build.binary(BinaryOp::Multiply, left, value, ty);
            build.tree[id].kind = ExprKind::Assign {
                op: None,
                target,
                value: product,
            };
            call(cx, product, Expansion::Product, vec![left, value]);
        }
        _ => {}
    });
    demote_constants(cx);
}

fn is_product(cx: &LoweringContext, left: ExprId, right: ExprId) -> bool {
    let is_matrix = |ty| matches!(ty, Type::Matrix { .. });
    let is_vector = |ty| matches!(ty, Type::Vector(..));
    let [left, right] = [left, right].map(|id| cx.tree[id].ty);
    is_matrix(left) && (is_matrix(right) || is_vector(right)) || is_vector(left) && is_matrix(right)
}

/// Makes local constants whose initializers now contain calls plain variables: only toyproof treats them as
/// constant.
fn demote_constants(cx: &mut LoweringContext) {
    let global: HashSet<_> = cx.tree.global_variables().collect();
    for id in cx.tree.variables.ids() {
        let variable = &cx.tree[id];
        let calls = |root| walk::any(&cx.tree, root, |kind| matches!(kind, ExprKind::Call { .. }));
        if variable.kind == VariableKind::Const
            && !global.contains(&id)
            && variable.initializer.is_some_and(calls)
        {
            cx.tree[id].kind = VariableKind::Local;
        }
    }
}

/// Makes an expression a call of the generated function for the types of these arguments.
pub(super) fn call(cx: &mut LoweringContext, id: ExprId, expansion: Expansion, arguments: Vec<ExprId>) {
    let types: Vec<Type> = arguments.iter().map(|&argument| cx.tree[argument].ty).collect();
    let (ty, at) = (cx.tree[id].ty, cx.tree[id].at);
    let function = function(cx, expansion, types, ty, at);
    cx.tree[id].kind = ExprKind::Call { function, arguments };
    cx.tree[id].constant = false;
}

/// Returns the generated function for the given types and adds it on first use.
pub(super) fn function(
    cx: &mut LoweringContext,
    expansion: Expansion,
    types: Vec<Type>,
    ty: Type,
    at: Place,
) -> FunctionId {
    let key = (expansion, types);
    if let Some(&id) = cx.expansions.get(&key) {
        return id;
    }
    let (expansion, types) = &key;
    let id = if let Expansion::Lookup {
        texture,
        channel,
        level,
    } = *expansion
    {
        lookup_function(cx, (texture, channel, level), types, at)
    } else if is_componentwise(*expansion, types.len()) && matches!(ty, Type::Vector(..)) {
        componentwise_function(cx, *expansion, types, ty, at)
    } else {
        let id = declare(cx, *expansion, types, ty, at);
        let body = helper_body(cx, *expansion, types, ty);
        cx.helpers.insert(id, body);
        id
    };
    cx.expansions.insert(key, id);
    id
}

const PARAMETER_NAMES: [&str; 3] = ["toyproof_a", "toyproof_b", "toyproof_c"];

fn declare(
    cx: &mut LoweringContext,
    expansion: Expansion,
    types: &[Type],
    ty: Type,
    at: Place,
) -> FunctionId {
    let name = match expansion {
        Expansion::Function(function) => function.name(),
        Expansion::Product => "product",
        Expansion::UintToFloat => "float",
        Expansion::Lookup { .. } => "lookup",
        Expansion::LevelOfDetail => "level",
        Expansion::Projection(_) => "projected",
        Expansion::CubePlace => "cube_place",
        Expansion::CubeGradient => "cube_gradient",
    };
    let parameters: Vec<_> = types
        .iter()
        .zip(PARAMETER_NAMES)
        .map(|(&ty, name)| (Direction::In, ty, name))
        .collect();
    cx.function(format!("toyproof_{name}"), &parameters, ty, at)
}

/// Adds a function of vectors that calls the function of their components.
fn componentwise_function(
    cx: &mut LoweringContext,
    expansion: Expansion,
    types: &[Type],
    ty: Type,
    at: Place,
) -> FunctionId {
    let id = declare(cx, expansion, types, ty, at);
    let scalar = |ty: Type| ty.scalar().map_or(ty, Type::Scalar);
    let scalar_function = function(
        cx,
        expansion,
        types.iter().map(|&ty| scalar(ty)).collect(),
        scalar(ty),
        at,
    );
    let parameters = cx.tree[id].parameters.clone();
    let mut build = cx.build(at);
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
            build.call(scalar_function, arguments)
        })
        .collect();
    let value = build.construct(Constructor::Vector, components, ty);
    cx.tree[id].body = Some(vec![Statement::new(StatementKind::Return(Some(value)), at)]);
    id
}

fn is_componentwise(expansion: Expansion, arguments: usize) -> bool {
    match expansion {
        Expansion::Function(function) => InexactFunction::from_built_in(function, arguments)
            .is_some_and(|function| function.definition.argument_count().is_some()),
        Expansion::UintToFloat => true,
        Expansion::Product
        | Expansion::Lookup { .. }
        | Expansion::LevelOfDetail
        | Expansion::Projection(_)
        | Expansion::CubePlace
        | Expansion::CubeGradient => false,
    }
}

/// The body of a generated function.
fn helper_body(cx: &LoweringContext, expansion: Expansion, types: &[Type], ty: Type) -> String {
    let graph = ExprGraph::default();
    let mut names = Vec::new();
    let mut arguments = Vec::new();
    for (&ty, name) in types.iter().zip(PARAMETER_NAMES) {
        let components = components(ty, name);
        let first = names.len();
        names.extend(components);
        arguments.push((first..names.len()).map(|index| graph.argument(index)).collect());
    }
    let results = match expansion {
        Expansion::Function(function) => {
            let function = InexactFunction::from_built_in(function, types.len());
            match function.map(|function| function.definition) {
                Some(Definition::Glsl(body)) => return body.to_owned(),
                Some(definition) => apply(definition, &arguments),
                None => Vec::new(),
            }
        }
        Expansion::Product => product(&arguments, types),
        Expansion::LevelOfDetail => {
            let [along_x, along_y] = [0, 1].map(|at| &arguments[at]);
            vec![toyproof_math::level_of_detail(along_x, along_y)]
        }
        Expansion::Projection(axes) => return lookup::projection(types[0], axes, PARAMETER_NAMES[0]),
        Expansion::CubePlace => toyproof_math::cube_place(vector(&arguments[0])).to_vec(),
        Expansion::CubeGradient => {
            toyproof_math::cube_gradient(vector(&arguments[0]), vector(&arguments[1])).to_vec()
        }
        // Its text is written with its declaration.
        Expansion::Lookup { .. } => Vec::new(),
        // Both halves are exact, so that only their sum is rounded.
        Expansion::UintToFloat => {
            let a = PARAMETER_NAMES[0];
            return format!("return float(int({a} >> 16u)) * 65536.0 + float(int({a} & 65535u));");
        }
    };
    let results: Vec<_> = results.into_iter().map(FloatTerm::id).collect();
    function_body(&graph, &results, &names, &cx.tree.type_name(ty))
}

/// The components of a `vec3`.
fn vector<'a>(components: &[FloatTerm<'a>]) -> [FloatTerm<'a>; 3] {
    [components[0], components[1], components[2]]
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

/// The components of the result of a function.
pub(super) fn apply<'a>(definition: Definition, arguments: &[Vec<FloatTerm<'a>>]) -> Vec<FloatTerm<'a>> {
    match (definition, arguments) {
        (Definition::Unary(function), [a]) => vec![function(a[0])],
        (Definition::Binary(function), [a, b]) => vec![function(a[0], b[0])],
        (Definition::Ternary(function), [a, b, c]) => vec![function(a[0], b[0], c[0])],
        (Definition::Vectors(function), _) => function(arguments),
        _ => Vec::new(),
    }
}

/// `a·b` of a matrix and a matrix or vector.
pub(super) fn product<'a>(arguments: &[Vec<FloatTerm<'a>>], types: &[Type]) -> Vec<FloatTerm<'a>> {
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

/// Prints the GLSL body of a function that returns `results`; several results are combined into a value of
/// type `ty`.
fn function_body(graph: &ExprGraph, results: &[StepId], arguments: &[String], ty: &str) -> String {
    let mut writer = Writer {
        graph,
        arguments,
        uses: uses(graph, results),
        lines: String::new(),
    };
    writer.declare_encodings();
    let shared: Vec<StepId> = writer
        .uses
        .iter()
        .filter(|&(_, &uses)| uses > 1)
        .map(|(&id, _)| id)
        .collect();
    for id in shared {
        writer.declare(id);
    }
    let results: Vec<String> = results.iter().map(|&id| writer.operand(id)).collect();
    match &results[..] {
        [only] => format!("{}return {only};", writer.lines),
        several => format!("{}return {ty}({});", writer.lines, several.join(", ")),
    }
}

/// The number of uses of each step.
fn uses(graph: &ExprGraph, results: &[StepId]) -> BTreeMap<StepId, usize> {
    let mut uses = BTreeMap::new();
    let mut pending = results.to_vec();
    while let Some(id) = pending.pop() {
        let count = uses.entry(id).or_insert(0);
        *count += 1;
        if *count == 1 {
            pending.extend(graph.step(id).0.operands());
        }
    }
    uses
}

struct Writer<'a> {
    graph: &'a ExprGraph,
    arguments: &'a [String],
    uses: BTreeMap<StepId, usize>,
    lines: String,
}

impl Writer<'_> {
    /// Declares variables for the encodings of infinities and NaNs: compilers refuse constant expressions
    /// with such values (tint: "value nan cannot be represented as 'f32'").
    fn declare_encodings(&mut self) {
        let encodings: BTreeSet<u32> = self
            .uses
            .keys()
            .filter_map(|&id| match self.graph.step(id).0 {
                Step::Float(bits) if !f32::from_bits(bits).is_finite() => Some(bits),
                _ => None,
            })
            .collect();
        for bits in encodings {
            let _ = write!(self.lines, "uint {} = {bits}u;\n    ", encoding_name(bits));
        }
    }

    /// Declares a variable for a step with several uses.
    fn declare(&mut self, id: StepId) {
        let (step, kind) = self.graph.step(id);
        if is_leaf(step) {
            return;
        }
        let ty = match kind {
            Kind::Float => "float",
            Kind::Bits => "uint",
            Kind::Bool => "bool",
        };
        let value = self.expression(step);
        let _ = write!(self.lines, "{ty} {} = {value};\n    ", name(id));
    }

    /// A step as an operand of another.
    fn operand(&self, id: StepId) -> String {
        let (step, _) = self.graph.step(id);
        if self.uses[&id] > 1 && !is_leaf(step) {
            name(id)
        } else {
            self.expression(step)
        }
    }

    fn expression(&self, step: Step) -> String {
        match step {
            Step::Argument(index) => self.arguments[index].clone(),
            Step::Float(bits) => literal(f32::from_bits(bits)),
            Step::Bits(bits) => format!("{bits}u"),
            Step::Unary(operation, a) => {
                let a = self.operand(a);
                match operation {
                    Unary::Negate => format!("(-{a})"),
                    Unary::Sqrt => format!("sqrt({a})"),
                    Unary::Abs => format!("abs({a})"),
                    Unary::Floor => format!("floor({a})"),
                    Unary::ToBits => format!("floatBitsToUint({a})"),
                    Unary::FromBits => format!("uintBitsToFloat({a})"),
                    Unary::FromSigned => format!("float(int({a}))"),
                    Unary::Not => format!("(!{a})"),
                }
            }
            Step::Binary(operation, a, b) => {
                let is_bool = self.graph.step(a).1 == Kind::Bool;
                let symbol = match operation {
                    Binary::Add => "+",
                    Binary::Subtract => "-",
                    Binary::Multiply => "*",
                    Binary::Divide => "/",
                    Binary::Less => "<",
                    Binary::And if is_bool => "&&",
                    Binary::And => "&",
                    Binary::Or if is_bool => "||",
                    Binary::Or => "|",
                    Binary::Left => "<<",
                    Binary::Right => ">>",
                };
                format!("({} {symbol} {})", self.operand(a), self.operand(b))
            }
            // `?:` would become branches.
            Step::Select(condition, yes, no) => {
                let [condition, yes, no] = [condition, yes, no].map(|id| self.operand(id));
                format!("mix({no}, {yes}, {condition})")
            }
        }
    }
}

fn is_leaf(step: Step) -> bool {
    matches!(step, Step::Argument(_) | Step::Float(_) | Step::Bits(_))
}

fn name(id: StepId) -> String {
    format!("toyproof_{id}")
}

/// The name of the variable with the encoding of an infinity or a NaN.
fn encoding_name(bits: u32) -> String {
    let value = f32::from_bits(bits);
    let stem = if value.is_nan() { "nan" } else { "infinity" };
    let sign = if value.is_sign_negative() { "negative_" } else { "" };
    format!("toyproof_{sign}{stem}")
}

/// A literal that naga parses to exactly this float.
fn literal(value: f32) -> String {
    if !value.is_finite() {
        return format!("uintBitsToFloat({})", encoding_name(value.to_bits()));
    }
    if value.abs() == f32::MAX {
        return format!("uintBitsToFloat({}u)", value.to_bits());
    }
    let text = format!("{value:?}");
    if value.is_sign_negative() {
        format!("({text})")
    } else {
        text
    }
}
