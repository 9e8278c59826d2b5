//! Loops that drivers terminate or translate wrongly.
//!
//! Mesa's llvmpipe before version 23 silently leaves every loop of an invocation after 65,535 iterations in
//! total. A [`Probe`] makes that visible in the image's alpha.

use std::num::NonZeroU32;

use naga::{
    Arena, BinaryOperator, Block, Expression, Function, GlobalVariable, Handle, Literal, Module, Range,
    Scalar, ScalarKind, Span, Statement, Type, TypeInner,
};

use super::ValidModule;

/// The value that a probe writes to alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Probe {
    /// One more than the total iterations of the pixel's loops. It is cheap. If a driver detects that a loop
    /// never ends, it treats the code after it as unreachable, and alpha may be anything, mostly 0.
    Iterations,
    /// 1 if every loop ended by itself, 0 if one did not. A counter is incremented before each loop and
    /// decremented at each exit in the shader.
    ///
    /// An optimizer assumes that loops end at their own exits, and would fold such a counter to zero. So the
    /// counter is an array element under an index that is always 0 but opaque. Drivers do not unroll loops
    /// with code next to their `break`, so this probe is slow.
    OpenLoops,
}

/// Whether any function contains a loop.
pub(super) fn has_loop(module: &Module) -> bool {
    bodies(module).any(|body| visit(body, &mut |statement| matches!(statement, Statement::Loop { .. })))
}

/// Whether any loop has no exit, so that the code after it is unreachable.
pub(super) fn has_infinite_loop(module: &Module) -> bool {
    bodies(module).any(|body| {
        visit(body, &mut |statement| match statement {
            Statement::Loop { body, break_if, .. } => break_if.is_none() && !has_exit(body),
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

/// Whether a loop's body has a statement that leaves the loop. This includes a `break` of an inner loop or
/// switch: then the loop is assumed to end, and the other probe detects the error.
fn has_exit(body: &Block) -> bool {
    visit(body, &mut |statement| {
        matches!(
            statement,
            Statement::Break | Statement::Return { .. } | Statement::Kill
        )
    })
}

/// Adds a probe: the entry point's alpha becomes its value.
pub(super) fn probe(module: &mut Module, probe: Probe) {
    let counter = Counter::declare(module, probe);
    for (_, function) in module.functions.iter_mut() {
        Rewriter::rewrite(function, probe, counter);
    }
    for entry in &mut module.entry_points {
        Rewriter::rewrite(&mut entry.function, probe, counter);
        if let Some(index) = counter.index {
            hide_zero(&mut entry.function, index);
        }
        report(&mut entry.function, probe, counter);
    }
}

/// A private counter, initially 0.
#[derive(Clone, Copy)]
struct Counter {
    /// The counter; an array of two if there is an index.
    variable: Handle<GlobalVariable>,
    /// The counter's index, always 0.
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

    /// Appends a load of the counter. Returns its pointer, its value and the range to emit.
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

/// The loops and switches around a statement: the number of loops that a `return` leaves, and whether a
/// `break` leaves a switch.
#[derive(Clone, Copy)]
struct Enclosing {
    loops: u32,
    switch: bool,
}

impl Rewriter<'_> {
    fn rewrite(function: &mut Function, probe: Probe, counter: Counter) {
        let body = std::mem::take(&mut function.body);
        let mut rewriter = Rewriter {
            function,
            probe,
            counter,
        };
        let body = rewriter.block(
            body,
            Block::new(),
            Enclosing {
                loops: 0,
                switch: false,
            },
        );
        function.body = body;
    }

    /// Appends the rewritten block to `out`.
    fn block(&mut self, block: Block, mut out: Block, within: Enclosing) -> Block {
        for (statement, span) in block.span_into_iter() {
            match statement {
                Statement::Loop {
                    body,
                    continuing,
                    break_if,
                } => {
                    let inside = Enclosing {
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
                        self.count_exits(1, &mut accept);
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
                    self.count_exits(u32::from(!within.switch), &mut out);
                    out.push(Statement::Break, span);
                }
                Statement::Return { value } => {
                    self.count_exits(within.loops, &mut out);
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
                            Enclosing {
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

    fn count_exits(&mut self, loops: u32, out: &mut Block) {
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

/// Sets the index at the start of the entry point to the position's x shifted right by 16: always 0, but
/// unknown to drivers.
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

/// Sets the alpha that the entry point returns. naga's GLSL front end generates the form: call the author's
/// `main`, load each output from its private variable, return a structure of them.
fn report(entry: &mut Function, probe: Probe, counter: Counter) {
    let Some(color) = returned_variable(entry) else {
        return;
    };
    let expressions = &mut entry.expressions;
    let (_, count, load) = counter.load(expressions);
    let mut append = |expression| expressions.append(expression, Span::UNDEFINED);
    let base = append(Expression::GlobalVariable(color));
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

impl ValidModule {
    /// Returns the same module with the steps of its loops at the end of their bodies, as
    /// `lower::loops::move_steps` does for GLSL.
    ///
    /// Mesa 22.3 executes the step in SPIR-V's continue construct once too often if nothing continues the
    /// loop and the stepped variable is initialized with a constant vector. The move changes nothing else.
    ///
    /// # Errors
    /// naga's message, if it refuses the result.
    pub fn with_steps_last(&self) -> Result<Self, String> {
        let mut module = self.module.clone();
        for (_, function) in module.functions.iter_mut() {
            move_steps(&mut function.body);
        }
        for entry in &mut module.entry_points {
            move_steps(&mut entry.function.body);
        }
        Self::validate(module).map_err(|error| super::chain(error.as_inner()))
    }
}

fn move_steps(block: &mut Block) {
    for statement in block.iter_mut() {
        match statement {
            Statement::Block(block) => move_steps(block),
            Statement::If { accept, reject, .. } => {
                move_steps(accept);
                move_steps(reject);
            }
            Statement::Switch { cases, .. } => cases.iter_mut().for_each(|case| move_steps(&mut case.body)),
            Statement::Loop {
                body,
                continuing,
                break_if: None,
            } => {
                move_steps(body);
                if !continues(body) && !always_jumps(body) {
                    for (step, span) in std::mem::take(continuing).span_into_iter() {
                        body.push(step, span);
                    }
                }
            }
            Statement::Loop { body, .. } => move_steps(body),
            _ => {}
        }
    }
}

/// Whether the loop's body contains a `continue` of this loop.
fn continues(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Continue => true,
        Statement::Block(block) => continues(block),
        Statement::If { accept, reject, .. } => continues(accept) || continues(reject),
        Statement::Switch { cases, .. } => cases.iter().any(|case| continues(&case.body)),
        _ => false,
    })
}

/// Whether the end of a block is never reached.
fn always_jumps(block: &Block) -> bool {
    block.last().is_some_and(|last| match last {
        Statement::Return { .. } | Statement::Kill | Statement::Break | Statement::Continue => true,
        Statement::Block(block) => always_jumps(block),
        _ => false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_move_to_the_end_of_bodies_without_continue() {
        let text = |more: &str| {
            format!(
                "@fragment fn main() -> @location(0) vec4f {{
                    var sum = 0.0;
                    for (var i = 0; i < 3; i++) {{ {more} sum += 1.0; }}
                    return vec4f(sum);
                }}"
            )
        };
        let steps = |more: &str| {
            let module = ValidModule::of_wgsl(&text(more))
                .unwrap()
                .with_steps_last()
                .unwrap();
            let body = &module.module().entry_points[0].function.body;
            let find = |statement: &Statement| match statement {
                Statement::Loop { continuing, .. } => Some(continuing.len()),
                _ => None,
            };
            let nested = body.iter().find_map(|statement| match statement {
                Statement::Block(block) => block.iter().find_map(find),
                other => find(other),
            });
            nested.unwrap()
        };
        assert_eq!(steps(""), 0);
        assert!(steps("if i == 1 { continue; }") > 0);
        assert!(steps("if i == 1 { return vec4f(); }") == 0);
        assert!(steps("for (var j = 0; j < 3; j++) { if j == 1 { continue; } }") == 0);
    }
}
