//! Modules instrumented so that the image's alpha shows whether a driver terminated a loop.

use std::num::NonZeroU32;

use naga::{
    Arena, BinaryOperator, Block, Expression, Function, GlobalVariable, Handle, Literal, Module, Range,
    Scalar, ScalarKind, Span, Statement, Type, TypeInner,
};
use toyproof_translate::TranslateError;
use toyproof_translate::naga_ir::{ValidModule, functions};

/// The value that a probe writes to alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Probe {
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
pub(crate) fn has_loops(module: &ValidModule) -> bool {
    bodies(module.module())
        .any(|body| visit(body, &mut |statement| matches!(statement, Statement::Loop { .. })))
}

/// Whether any loop has no exit, so that the code after it is unreachable.
pub(crate) fn has_infinite_loop(module: &ValidModule) -> bool {
    bodies(module.module()).any(|body| {
        visit(body, &mut |statement| match statement {
            Statement::Loop { body, break_if, .. } => break_if.is_none() && !has_exit(body),
            _ => false,
        })
    })
}

fn bodies(module: &Module) -> impl Iterator<Item = &Block> {
    functions(module).map(|function| &function.body)
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

/// The blocks within a statement other than a loop.
pub(super) fn inner_blocks(statement: &mut Statement) -> Vec<&mut Block> {
    match statement {
        Statement::Block(inner) => vec![inner],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter_mut().map(|case| &mut case.body).collect(),
        _ => Vec::new(),
    }
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

/// Whether `discard` may skip a pixel.
pub(crate) fn discards(module: &ValidModule) -> bool {
    (0..module.module().entry_points.len()).any(|entry| module.info().get_entry_point(entry).may_kill)
}

/// Returns the same shader with a probe of its loops: the entry point's alpha becomes the probe's value.
///
/// # Errors
/// naga's message, if it refuses the result.
pub(crate) fn probed(module: &ValidModule, probe: Probe) -> Result<ValidModule, TranslateError> {
    let mut module = module.module().clone();
    let counter = Counter::declare(&mut module, probe);
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
    ValidModule::new(module)
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
struct EnclosingLoops {
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
            EnclosingLoops {
                loops: 0,
                switch: false,
            },
        );
        function.body = body;
    }

    /// Appends the rewritten block to `out`.
    fn block(&mut self, block: Block, mut out: Block, within: EnclosingLoops) -> Block {
        for (statement, span) in block.span_into_iter() {
            match statement {
                Statement::Loop {
                    body,
                    continuing,
                    break_if,
                } => {
                    let inside = EnclosingLoops {
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
                mut other => {
                    let inside = match other {
                        Statement::Switch { .. } => EnclosingLoops {
                            switch: true,
                            ..within
                        },
                        _ => within,
                    };
                    for body in inner_blocks(&mut other) {
                        *body = self.block(std::mem::take(body), Block::new(), inside);
                    }
                    out.push(other, span);
                }
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

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl::{Options, check};

    use super::*;

    fn parse(text: &str) -> ValidModule {
        let mut files = Files::default();
        let file = files.add(File::new("s", text));
        let checked = check(&files, file, &Options::default()).unwrap();
        ValidModule::parse(&toyproof_translate::lower(&checked)).unwrap()
    }

    #[test]
    fn probes_are_valid_and_count_every_entry_and_exit() {
        let module = parse(
            "float f(float x) { for (int i = 0; i < 9; i++) { if (x > 4.0) return x; if (x > 3.0) break; x += 1.0; } return 0.0; }\n\
             void mainImage(out vec4 c, in vec2 p) {\n\
               float x = 0.0; do { x += f(x); } while (x < 3.0);\n\
               switch (int(x)) { case 0: x = 1.0; break; default: x = 2.0; break; }\n\
               c = vec4(x);\n\
             }",
        );
        let text = |probe| {
            let probed = probed(&module, probe).unwrap();
            let flags = naga::back::wgsl::WriterFlags::empty();
            naga::back::wgsl::write_string(probed.module(), probed.info(), flags).unwrap()
        };
        let open = text(Probe::OpenLoops);
        // Two loops are entered; one is left by its condition, a return and a break, the other by its
        // condition.
        assert_eq!(open.matches("+ 1u").count(), 2, "{open}");
        assert_eq!(open.matches("- 1u").count(), 4, "{open}");
        assert!(open.contains("select(0f, 1f,"), "{open}");
        let iterations = text(Probe::Iterations);
        assert_eq!(iterations.matches("+ 1u").count(), 2, "{iterations}");
        assert!(iterations.contains("f32("), "{iterations}");
    }

    #[test]
    fn loops_are_found_at_any_depth() {
        let with = "float f() { float x = 0.0; if (true) { while (x < 3.0) x += 1.0; } return x; }\n\
                    void mainImage(out vec4 c, in vec2 p) { c = vec4(f()); }";
        assert!(has_loops(&parse(with)) && !has_infinite_loop(&parse(with)));
        let endless = with
            .replace("x < 3.0", "true")
            .replace("while (true) x += 1.0;", "for (;;) x += 1.0;");
        assert!(has_infinite_loop(&parse(&endless)));
        let without = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p, 0.0, 1.0); }";
        assert!(!has_loops(&parse(without)));
    }
}
