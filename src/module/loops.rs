//! Loops that a driver ends by force.
//!
//! Mesa's llvmpipe before version 23 leaves every loop of an invocation after 65,535 iterations in total, and
//! says nothing. [`watch`] makes that visible: a private counter goes up before each loop and down on each
//! way out that the shader itself takes, so it is above zero at the end exactly where a loop was cut short.
//!
//! An optimiser takes for granted that a loop is left by its own ways out, and would fold such a counter to
//! zero. So the counter is the element of an array, under an index that is always 0 but not known to be.

use std::num::NonZeroU32;

use naga::{
    Arena, BinaryOperator, Block, Expression, Function, GlobalVariable, Handle, Literal, Module, Range, Scalar,
    Span, Statement, Type, TypeInner,
};

/// Whether any function holds a loop.
pub(super) fn any(module: &Module) -> bool {
    let entries = module.entry_points.iter().map(|entry| &entry.function);
    module
        .functions
        .iter()
        .map(|(_, function)| function)
        .chain(entries)
        .any(|function| block_has_loop(&function.body))
}

fn block_has_loop(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Loop { .. } => true,
        Statement::Block(inner) => block_has_loop(inner),
        Statement::If { accept, reject, .. } => block_has_loop(accept) || block_has_loop(reject),
        Statement::Switch { cases, .. } => cases.iter().any(|case| block_has_loop(&case.body)),
        _ => false,
    })
}

/// Counts open loops and lets the entry point's alpha be 1 where none is open at the end, else 0.
pub(super) fn watch(module: &mut Module) {
    let uint = scalar_type(module);
    let array = module.types.insert(
        Type {
            name: None,
            inner: TypeInner::Array {
                base: uint,
                size: naga::ArraySize::Constant(const { NonZeroU32::new(2).unwrap() }),
                stride: 4,
            },
        },
        Span::UNDEFINED,
    );
    let counter = Counter {
        open: private(module, "toyproof_open_loops", array),
        index: private(module, "toyproof_always_zero", uint),
    };
    for (_, function) in module.functions.iter_mut() {
        Watch::over(function, counter);
    }
    for entry in &mut module.entry_points {
        Watch::over(&mut entry.function, counter);
        hide_zero(&mut entry.function, counter);
        report(&mut entry.function, counter);
    }
}

/// The private variables of the counter.
#[derive(Clone, Copy)]
struct Counter {
    /// Two numbers, of which one counts.
    open: Handle<GlobalVariable>,
    /// Which.
    index: Handle<GlobalVariable>,
}

impl Counter {
    /// Appends what loads the counter; gives its pointer, its value, and what must be emitted.
    fn load(self, expressions: &mut Arena<Expression>) -> (Handle<Expression>, Handle<Expression>, Range<Expression>) {
        let mut append = |expression| expressions.append(expression, Span::UNDEFINED);
        let base = append(Expression::GlobalVariable(self.open));
        let which = append(Expression::GlobalVariable(self.index));
        let index = append(Expression::Load { pointer: which });
        let pointer = append(Expression::Access { base, index });
        let value = append(Expression::Load { pointer });
        (pointer, value, Range::new_from_bounds(index, value))
    }
}

fn scalar_type(module: &mut Module) -> Handle<Type> {
    module.types.insert(Type { name: None, inner: TypeInner::Scalar(Scalar::U32) }, Span::UNDEFINED)
}

fn private(module: &mut Module, name: &str, ty: Handle<Type>) -> Handle<GlobalVariable> {
    let zero = module.global_expressions.append(Expression::ZeroValue(ty), Span::UNDEFINED);
    module.global_variables.append(
        GlobalVariable {
            name: Some(name.to_owned()),
            space: naga::AddressSpace::Private,
            binding: None,
            ty,
            init: Some(zero),
            memory_decorations: naga::MemoryDecorations::empty(),
        },
        Span::UNDEFINED,
    )
}

/// Sets the index at the entry point's start: the position's x is below 2¹⁶, which no driver knows.
fn hide_zero(entry: &mut Function, counter: Counter) {
    let Some(position) = entry.arguments.iter().position(|argument| {
        matches!(argument.binding, Some(naga::Binding::BuiltIn(naga::BuiltIn::Position { .. })))
    }) else {
        return;
    };
    let mut append = |expression| entry.expressions.append(expression, Span::UNDEFINED);
    let pointer = append(Expression::GlobalVariable(counter.index));
    let sixteen = append(Expression::Literal(Literal::U32(16)));
    let base = append(Expression::FunctionArgument(position as u32));
    let x = append(Expression::AccessIndex { base, index: 0 });
    let left = append(Expression::As { expr: x, kind: naga::ScalarKind::Uint, convert: Some(4) });
    let value = append(Expression::Binary { op: BinaryOperator::ShiftRight, left, right: sixteen });
    let mut start = Block::new();
    start.push(Statement::Emit(Range::new_from_bounds(x, value)), Span::UNDEFINED);
    start.push(Statement::Store { pointer, value }, Span::UNDEFINED);
    entry.body.splice(0..0, start);
}

/// Rewrites the blocks of one function.
struct Watch<'a> {
    function: &'a mut Function,
    counter: Counter,
}

/// What a `break` leaves, and how many loops a `return` leaves.
#[derive(Clone, Copy)]
struct Within {
    loops: u32,
    switch: bool,
}

impl Watch<'_> {
    fn over(function: &mut Function, counter: Counter) {
        let body = std::mem::take(&mut function.body);
        let body = Watch { function, counter }.block(body, Within { loops: 0, switch: false });
        function.body = body;
    }

    fn block(&mut self, block: Block, within: Within) -> Block {
        let mut out = Block::with_capacity(block.len());
        for (statement, span) in block.span_into_iter() {
            match statement {
                Statement::Loop { body, continuing, break_if } => {
                    self.add(BinaryOperator::Add, 1, &mut out);
                    let inside = Within { loops: within.loops + 1, switch: false };
                    let body = self.block(body, inside);
                    let mut continuing = self.block(continuing, inside);
                    if let Some(condition) = break_if {
                        let mut accept = Block::new();
                        self.add(BinaryOperator::Subtract, 1, &mut accept);
                        continuing.push(Statement::If { condition, accept, reject: Block::new() }, span);
                    }
                    out.push(Statement::Loop { body, continuing, break_if }, span);
                }
                Statement::Break => {
                    if !within.switch {
                        self.add(BinaryOperator::Subtract, 1, &mut out);
                    }
                    out.push(Statement::Break, span);
                }
                Statement::Return { value } => {
                    self.add(BinaryOperator::Subtract, within.loops, &mut out);
                    out.push(Statement::Return { value }, span);
                }
                Statement::Block(inner) => {
                    let inner = self.block(inner, within);
                    out.push(Statement::Block(inner), span);
                }
                Statement::If { condition, accept, reject } => {
                    let accept = self.block(accept, within);
                    let reject = self.block(reject, within);
                    out.push(Statement::If { condition, accept, reject }, span);
                }
                Statement::Switch { selector, mut cases } => {
                    for case in &mut cases {
                        let body = std::mem::take(&mut case.body);
                        case.body = self.block(body, Within { switch: true, ..within });
                    }
                    out.push(Statement::Switch { selector, cases }, span);
                }
                other => out.push(other, span),
            }
        }
        out
    }

    /// `open = open ± amount`
    fn add(&mut self, operator: BinaryOperator, amount: u32, out: &mut Block) {
        if amount == 0 {
            return;
        }
        let expressions = &mut self.function.expressions;
        let right = expressions.append(Expression::Literal(Literal::U32(amount)), Span::UNDEFINED);
        let (pointer, left, load) = self.counter.load(expressions);
        let value = expressions.append(Expression::Binary { op: operator, left, right }, Span::UNDEFINED);
        out.push(Statement::Emit(load), Span::UNDEFINED);
        out.push(Statement::Emit(Range::new_from_bounds(value, value)), Span::UNDEFINED);
        out.push(Statement::Store { pointer, value }, Span::UNDEFINED);
    }
}

/// Sets the alpha that the entry point is about to return. naga's GLSL front end gives it the form: call the
/// author's `main`, load each output from its private variable, return a struct of them.
fn report(entry: &mut Function, counter: Counter) {
    let Some(colour) = returned_variable(entry) else {
        return;
    };
    let expressions = &mut entry.expressions;
    let (_, left, load) = counter.load(expressions);
    let mut append = |expression| expressions.append(expression, Span::UNDEFINED);
    let base = append(Expression::GlobalVariable(colour));
    let [cut, whole] = [0.0, 1.0].map(|alpha| append(Expression::Literal(Literal::F32(alpha))));
    let none = append(Expression::Literal(Literal::U32(0)));
    let alpha = append(Expression::AccessIndex { base, index: 3 });
    let condition = append(Expression::Binary { op: BinaryOperator::Equal, left, right: none });
    let value = append(Expression::Select { condition, accept: whole, reject: cut });
    let mut report = Block::new();
    report.push(Statement::Emit(load), Span::UNDEFINED);
    report.push(Statement::Emit(Range::new_from_bounds(alpha, value)), Span::UNDEFINED);
    report.push(Statement::Store { pointer: alpha, value }, Span::UNDEFINED);
    let after_main = entry
        .body
        .iter()
        .rposition(|statement| matches!(statement, Statement::Call { .. }))
        .map_or(0, |call| call + 1);
    entry.body.splice(after_main..after_main, report);
}

/// The private variable that the entry point's result is loaded from.
fn returned_variable(entry: &Function) -> Option<Handle<GlobalVariable>> {
    let returned = entry.body.iter().find_map(|statement| match statement {
        Statement::Return { value } => *value,
        _ => None,
    })?;
    let Expression::Compose { ref components, .. } = entry.expressions[returned] else {
        return None;
    };
    let Expression::Load { pointer } = entry.expressions[*components.first()?] else {
        return None;
    };
    match entry.expressions[pointer] {
        Expression::GlobalVariable(variable) => Some(variable),
        _ => None,
    }
}
