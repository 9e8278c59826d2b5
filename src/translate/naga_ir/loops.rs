//! Loops that a driver ends by force.
//!
//! Mesa's llvmpipe before version 23 leaves every loop of an invocation after 65,535 iterations in total, and
//! says nothing. A [`Probe`] makes that visible in the picture's alpha.

use std::num::NonZeroU32;

use naga::{
    Arena, BinaryOperator, Block, Expression, Function, GlobalVariable, Handle, Literal, Module, Range,
    Scalar, ScalarKind, Span, Statement, Type, TypeInner,
};

/// What the alpha of a probed shader tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Probe {
    /// One more than the iterations that the pixel's loops ran in total. It costs little. Where a driver sees that a
    /// loop never ends, it takes what follows for unreachable, and alpha may be anything: most often 0.
    Iterations,
    /// 1 where every loop was left by its own means, 0 where one was not. A counter goes up before each loop
    /// and down on each way out that the shader itself takes.
    ///
    /// An optimiser takes for granted that a loop is left by its own ways out, and would fold such a counter to
    /// zero. So the counter is the element of an array, under an index that is always 0 but not known to be;
    /// and drivers do not unroll loops with code beside their `break`: this probe is slow.
    OpenLoops,
}

/// Whether any function holds a loop.
pub(super) fn any(module: &Module) -> bool {
    bodies(module).any(|body| visit(body, &mut |statement| matches!(statement, Statement::Loop { .. })))
}

/// Whether there is a loop without any way out: what follows it is never reached.
pub(super) fn any_endless(module: &Module) -> bool {
    bodies(module).any(|body| {
        visit(body, &mut |statement| match statement {
            Statement::Loop { body, break_if, .. } => break_if.is_none() && !is_left(body),
            _ => false,
        })
    })
}

fn bodies(module: &Module) -> impl Iterator<Item = &Block> {
    let functions = module.functions.iter().map(|(_, function)| function);
    functions
        .chain(module.entry_points.iter().map(|entry| &entry.function))
        .map(|function| &function.body)
}

/// Whether `found` holds for any statement of the block, at any depth.
fn visit(block: &Block, found: &mut impl FnMut(&Statement) -> bool) -> bool {
    block.iter().any(|statement| {
        found(statement)
            || match statement {
                Statement::Loop { body, continuing, .. } => visit(body, found) || visit(continuing, found),
                Statement::Block(inner) => visit(inner, found),
                Statement::If { accept, reject, .. } => visit(accept, found) || visit(reject, found),
                Statement::Switch { cases, .. } => cases.iter().any(|case| visit(&case.body, found)),
                _ => false,
            }
    })
}

/// Whether a loop's body has a statement that leaves the loop. A `break` of an inner loop or switch counts too:
/// then the loop is taken to end, which the other probe finds out.
fn is_left(body: &Block) -> bool {
    visit(body, &mut |statement| {
        matches!(
            statement,
            Statement::Break | Statement::Return { .. } | Statement::Kill
        )
    })
}

/// Adds a probe: the entry point's alpha becomes what it tells.
pub(super) fn probe(module: &mut Module, probe: Probe) {
    let counter = Counter::declare(module, probe);
    for (_, function) in module.functions.iter_mut() {
        Rewriter::over(function, probe, counter);
    }
    for entry in &mut module.entry_points {
        Rewriter::over(&mut entry.function, probe, counter);
        if let Some(index) = counter.index {
            hide_zero(&mut entry.function, index);
        }
        report(&mut entry.function, probe, counter);
    }
}

/// A private number that starts at 0.
#[derive(Clone, Copy)]
struct Counter {
    /// The number; an array of two where there is an index.
    variable: Handle<GlobalVariable>,
    /// The number's index, always 0.
    index: Option<Handle<GlobalVariable>>,
}

impl Counter {
    fn declare(module: &mut Module, probe: Probe) -> Self {
        let mut declare_type = |inner| module.types.insert(Type { name: None, inner }, Span::UNDEFINED);
        let uint = declare_type(TypeInner::Scalar(Scalar::U32));
        let size = naga::ArraySize::Constant(const { NonZeroU32::new(2).unwrap() });
        match probe {
            Probe::Iterations => Self {
                variable: private(module, "toyproof_iterations", uint),
                index: None,
            },
            Probe::OpenLoops => {
                let array = declare_type(TypeInner::Array {
                    base: uint,
                    size,
                    stride: 4,
                });
                Self {
                    variable: private(module, "toyproof_open_loops", array),
                    index: Some(private(module, "toyproof_always_zero", uint)),
                }
            }
        }
    }

    /// Appends what loads the counter; gives its pointer, its value, and what must be emitted.
    fn load(
        self,
        expressions: &mut Arena<Expression>,
    ) -> (Handle<Expression>, Handle<Expression>, Range<Expression>) {
        let mut append = |expression| expressions.append(expression, Span::UNDEFINED);
        let base = append(Expression::GlobalVariable(self.variable));
        let Some(index) = self.index else {
            let value = append(Expression::Load { pointer: base });
            return (base, value, Range::new_from_bounds(value, value));
        };
        let which = append(Expression::GlobalVariable(index));
        let index = append(Expression::Load { pointer: which });
        let pointer = append(Expression::Access { base, index });
        let value = append(Expression::Load { pointer });
        (pointer, value, Range::new_from_bounds(index, value))
    }
}

fn private(module: &mut Module, name: &str, ty: Handle<Type>) -> Handle<GlobalVariable> {
    let zero = module
        .global_expressions
        .append(Expression::ZeroValue(ty), Span::UNDEFINED);
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

/// Rewrites the blocks of one function.
struct Rewriter<'a> {
    function: &'a mut Function,
    probe: Probe,
    counter: Counter,
}

/// What a `break` leaves, and how many loops a `return` leaves.
#[derive(Clone, Copy)]
struct Within {
    loops: u32,
    switch: bool,
}

impl Rewriter<'_> {
    fn over(function: &mut Function, probe: Probe, counter: Counter) {
        let body = std::mem::take(&mut function.body);
        let mut rewriter = Rewriter {
            function,
            probe,
            counter,
        };
        let body = rewriter.block(
            body,
            Block::new(),
            Within {
                loops: 0,
                switch: false,
            },
        );
        function.body = body;
    }

    /// `block` rewritten, behind what `out` holds already.
    fn block(&mut self, block: Block, mut out: Block, within: Within) -> Block {
        for (statement, span) in block.span_into_iter() {
            match statement {
                Statement::Loop {
                    body,
                    continuing,
                    break_if,
                } => {
                    let inside = Within {
                        loops: within.loops + 1,
                        switch: false,
                    };
                    let mut start = Block::new();
                    match self.probe {
                        Probe::Iterations => self.add(1, &mut start),
                        Probe::OpenLoops => self.add(1, &mut out),
                    }
                    let body = self.block(body, start, inside);
                    let mut continuing = self.block(continuing, Block::new(), inside);
                    if let Some(condition) = break_if {
                        let mut accept = Block::new();
                        self.close(1, &mut accept);
                        continuing.push(
                            Statement::If {
                                condition,
                                accept,
                                reject: Block::new(),
                            },
                            span,
                        );
                    }
                    out.push(
                        Statement::Loop {
                            body,
                            continuing,
                            break_if,
                        },
                        span,
                    );
                }
                Statement::Break => {
                    self.close(u32::from(!within.switch), &mut out);
                    out.push(Statement::Break, span);
                }
                Statement::Return { value } => {
                    self.close(within.loops, &mut out);
                    out.push(Statement::Return { value }, span);
                }
                Statement::Block(inner) => {
                    let inner = self.block(inner, Block::new(), within);
                    out.push(Statement::Block(inner), span);
                }
                Statement::If {
                    condition,
                    accept,
                    reject,
                } => {
                    let accept = self.block(accept, Block::new(), within);
                    let reject = self.block(reject, Block::new(), within);
                    out.push(
                        Statement::If {
                            condition,
                            accept,
                            reject,
                        },
                        span,
                    );
                }
                Statement::Switch { selector, mut cases } => {
                    for case in &mut cases {
                        let body = std::mem::take(&mut case.body);
                        case.body = self.block(
                            body,
                            Block::new(),
                            Within {
                                switch: true,
                                ..within
                            },
                        );
                    }
                    out.push(Statement::Switch { selector, cases }, span);
                }
                other => out.push(other, span),
            }
        }
        out
    }

    fn close(&mut self, loops: u32, out: &mut Block) {
        if self.probe == Probe::OpenLoops && loops > 0 {
            self.update(BinaryOperator::Subtract, loops, out);
        }
    }

    fn add(&mut self, amount: u32, out: &mut Block) {
        self.update(BinaryOperator::Add, amount, out);
    }

    /// `counter = counter op amount`
    fn update(&mut self, op: BinaryOperator, amount: u32, out: &mut Block) {
        let expressions = &mut self.function.expressions;
        let right = expressions.append(Expression::Literal(Literal::U32(amount)), Span::UNDEFINED);
        let (pointer, left, load) = self.counter.load(expressions);
        let value = expressions.append(Expression::Binary { op, left, right }, Span::UNDEFINED);
        out.push(Statement::Emit(load), Span::UNDEFINED);
        out.push(
            Statement::Emit(Range::new_from_bounds(value, value)),
            Span::UNDEFINED,
        );
        out.push(Statement::Store { pointer, value }, Span::UNDEFINED);
    }
}

/// Sets the index at the entry point's start: the position's x is below 2¹⁶, which no driver knows.
fn hide_zero(entry: &mut Function, index: Handle<GlobalVariable>) {
    let Some(position) = entry.arguments.iter().position(|argument| {
        matches!(
            argument.binding,
            Some(naga::Binding::BuiltIn(naga::BuiltIn::Position { .. }))
        )
    }) else {
        return;
    };
    let mut append = |expression| entry.expressions.append(expression, Span::UNDEFINED);
    let pointer = append(Expression::GlobalVariable(index));
    let sixteen = append(Expression::Literal(Literal::U32(16)));
    let base = append(Expression::FunctionArgument(position as u32));
    let x = append(Expression::AccessIndex { base, index: 0 });
    let left = append(Expression::As {
        expr: x,
        kind: ScalarKind::Uint,
        convert: Some(4),
    });
    let value = append(Expression::Binary {
        op: BinaryOperator::ShiftRight,
        left,
        right: sixteen,
    });
    let mut start = Block::new();
    start.push(Statement::Emit(Range::new_from_bounds(x, value)), Span::UNDEFINED);
    start.push(Statement::Store { pointer, value }, Span::UNDEFINED);
    entry.body.splice(0..0, start);
}

/// Sets the alpha that the entry point is about to return. naga's GLSL front end gives it the form: call the
/// author's `main`, load each output from its private variable, return a struct of them.
fn report(entry: &mut Function, probe: Probe, counter: Counter) {
    let Some(colour) = returned_variable(entry) else {
        return;
    };
    let expressions = &mut entry.expressions;
    let (_, count, load) = counter.load(expressions);
    let mut append = |expression| expressions.append(expression, Span::UNDEFINED);
    let base = append(Expression::GlobalVariable(colour));
    let [cut, whole] = [0.0, 1.0].map(|alpha| append(Expression::Literal(Literal::F32(alpha))));
    let none = append(Expression::Literal(Literal::U32(0)));
    let pointer = append(Expression::AccessIndex { base, index: 3 });
    let value = match probe {
        Probe::Iterations => {
            let left = append(Expression::As {
                expr: count,
                kind: ScalarKind::Float,
                convert: Some(4),
            });
            append(Expression::Binary {
                op: BinaryOperator::Add,
                left,
                right: whole,
            })
        }
        Probe::OpenLoops => {
            let condition = append(Expression::Binary {
                op: BinaryOperator::Equal,
                left: count,
                right: none,
            });
            append(Expression::Select {
                condition,
                accept: whole,
                reject: cut,
            })
        }
    };
    let mut report = Block::new();
    report.push(Statement::Emit(load), Span::UNDEFINED);
    report.push(
        Statement::Emit(Range::new_from_bounds(pointer, value)),
        Span::UNDEFINED,
    );
    report.push(Statement::Store { pointer, value }, Span::UNDEFINED);
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
