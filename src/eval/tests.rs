//! Passes on functions. Compile times of adversarial shaders are linear in their length: programs for that
//! are so large that any pass with quadratic cost would take minutes, or exhaust the memory.

use toyproof_diagnostic::{File, Files, Span};
use toyproof_glsl::tree::Place;

use crate::build::with_stack;
use crate::exec::ops::fold;
use crate::ir::{
    AliasGroups, Axis, Block, Cell, Function, Kind, LoopId, NONE, Node, Operation, Scope, Value, ValueDef,
};
use crate::lower::linearize::{LinearCode, Step, linearize};
use crate::opt::dce::eliminate_dead_code;
use crate::opt::divergence::Divergence;
use crate::opt::gvn::number_values;
use crate::opt::pair::pair;
use crate::{Program, Refusal, UndefinedPolicy};

/// Builds a function of words, with a divergent condition.
struct FunctionBuilder {
    function: Function,
    varying: Value,
}

impl FunctionBuilder {
    /// Creates a function with these numbers of cells, scopes and loops.
    fn new(cells: usize, scopes: u32, loops: usize) -> Self {
        let file = Files::default().add(File::new("", ""));
        let place = Place::plain(Span::new(file, 0, 0));
        let mut builder = Self {
            function: Function {
                defs: Vec::new(),
                cells: vec![Kind::Word; cells],
                scopes,
                loops: vec![place; loops],
                body: Block::new(),
                output: [NONE; 5],
            },
            varying: NONE,
        };
        let x = builder.value(ValueDef::FragCoord(Axis::X));
        builder.varying = builder.value(ValueDef::Operation(Operation::ToBits, [x, NONE, NONE]));
        builder.function.body.push(Node::Let(builder.varying));
        builder
    }

    fn value(&mut self, def: ValueDef) -> Value {
        self.function.defs.push(def);
        Value(self.function.defs.len() as u32 - 1)
    }

    fn word(&mut self, word: u32) -> Value {
        self.value(ValueDef::Word(word))
    }

    fn load(&mut self, cell: u32, block: &mut Block) -> Value {
        self.make(ValueDef::Load(Cell(cell)), block)
    }

    fn make(&mut self, def: ValueDef, block: &mut Block) -> Value {
        let value = self.value(def);
        block.push(Node::Let(value));
        value
    }

    /// Finishes the function; its output is loaded from two cells.
    fn output(mut self, cells: [u32; 2]) -> Function {
        let mut body = std::mem::take(&mut self.function.body);
        let [a, b] = cells.map(|cell| self.load(cell, &mut body));
        self.function.body = body;
        self.function.output = [a, b, a, b, a];
        self.function
    }

    fn linear(self) -> LinearCode {
        let function = self.output([0, 0]);
        linearize(
            &function,
            &Divergence::new(&function, &AliasGroups::new(&function)),
            false,
        )
    }
}

fn store(cell: u32, value: Value) -> Node {
    Node::Store {
        cell: Cell(cell),
        value,
    }
}

fn break_if(scope: u32, condition: Value) -> Node {
    Node::BreakIf {
        scope: Scope(scope),
        condition,
        when: true,
    }
}

fn if_then(condition: Value, yes: Block) -> Node {
    Node::If {
        condition,
        yes,
        no: Block::new(),
    }
}

/// Counts the steps that satisfy a predicate.
fn count_steps(linear: &LinearCode, is: impl Fn(&Step) -> bool) -> usize {
    linear.steps.iter().filter(|(step, _)| is(step)).count()
}

/// Builds a scope with `times` breaks, each followed by a store to a new cell. Cell 0 is stored before the
/// scope and not in it, cell 1 at its end.
fn scope_with_breaks(times: u32) -> Function {
    let mut builder = FunctionBuilder::new(times as usize + 2, 1, 0);
    let (before, after) = (builder.word(7), builder.word(9));
    let mut body = Block::new();
    for cell in 0..times {
        body.extend([break_if(0, builder.varying), store(cell + 2, after)]);
    }
    body.push(store(1, after));
    builder.function.body.extend([store(0, before), store(1, before)]);
    builder.function.body.push(Node::Scope {
        scope: Scope(0),
        body,
    });
    builder.output([0, 1])
}

/// Storing all changes of each path would take gigabytes here.
#[test]
fn changes_of_many_exit_paths_are_bounded() {
    for times in [1, 60_000] {
        let mut function = scope_with_breaks(times);
        number_values(&mut function, fold, false);
        let [kept, stored, ..] = function.output.map(|value| function.def(value));
        assert_eq!(kept, ValueDef::Word(7));
        assert_eq!(stored, ValueDef::Load(Cell(1)), "it is 7 or 9");
    }
}

/// Unrolling tries seven thousand iterations here, and none reaches the content of the `if`.
#[test]
fn unreachable_blocks_of_an_unrolled_loop_are_not_cloned() {
    let mut builder = FunctionBuilder::new(2, 1, 1);
    let [zero, one, rounds] = [0, 1, 60_000].map(|word| builder.word(word));
    let mut body = vec![Node::LoopHeader(LoopId(0))];
    let at = builder.load(0, &mut body);
    let goes_on = builder.make(
        ValueDef::Operation(Operation::LessInt, [at, rounds, NONE]),
        &mut body,
    );
    body.push(Node::BreakIf {
        scope: Scope(0),
        condition: goes_on,
        when: false,
    });
    let never = builder.make(
        ValueDef::Operation(Operation::LessInt, [at, zero, NONE]),
        &mut body,
    );
    body.push(if_then(never, vec![store(1, one); 1 << 20]));
    let next = builder.make(
        ValueDef::Operation(Operation::AddWord, [at, one, NONE]),
        &mut body,
    );
    body.push(store(0, next));
    let body = vec![Node::Loop { id: LoopId(0), body }];
    builder.function.body.extend([store(0, zero), store(1, zero)]);
    builder.function.body.push(Node::Scope {
        scope: Scope(0),
        body,
    });
    let mut function = builder.output([0, 1]);
    number_values(&mut function, fold, false);
    assert!(matches!(function.def(function.output[0]), ValueDef::Load(_)));
}

/// The last cell is unused, so the one before it is unused, and so on.
#[test]
fn chained_empty_branches_are_removed_in_linear_time() {
    let cell_count = 40_000;
    let mut builder = FunctionBuilder::new(cell_count as usize + 2, 0, 0);
    let yes = builder.word(u32::MAX);
    let mut body = vec![store(cell_count + 1, yes), store(0, builder.varying)];
    for cell in 0..cell_count {
        let condition = builder.load(cell, &mut body);
        body.push(if_then(condition, vec![store(cell + 1, yes)]));
    }
    builder.function.body.append(&mut body);
    let mut function = builder.output([cell_count + 1, cell_count + 1]);
    eliminate_dead_code(&mut function);
    assert!(matches!(
        function.body[..],
        [Node::Store { cell, .. }, Node::Let(_), Node::Let(_)] if cell.0 == cell_count + 1
    ));
}

#[test]
fn a_branch_used_only_by_its_own_condition_is_removed() {
    let mut builder = FunctionBuilder::new(2, 0, 1);
    let yes = builder.word(u32::MAX);
    let mut body = vec![Node::LoopHeader(LoopId(0))];
    let condition = builder.load(1, &mut body);
    body.push(if_then(condition, vec![store(1, yes)]));
    builder.function.body.push(Node::Loop { id: LoopId(0), body });
    let mut function = builder.output([0, 0]);
    eliminate_dead_code(&mut function);
    let inside = function.body.iter().find_map(|node| match node {
        Node::Loop { body, .. } => Some(body.len()),
        _ => None,
    });
    assert_eq!(inside, Some(1));
}

/// Returns the operations that value numbering makes of a float, with the definitions of their operands.
fn numbered(
    float: impl FnOnce(&mut FunctionBuilder, &mut Block) -> Value,
) -> Vec<(Operation, [Option<ValueDef>; 2])> {
    let mut builder = FunctionBuilder::new(1, 0, 0);
    let mut body = std::mem::take(&mut builder.function.body);
    let float = float(&mut builder, &mut body);
    let bits = builder.make(operation(Operation::ToBits, [float, NONE]), &mut body);
    body.push(store(0, bits));
    builder.function.body = body;
    let mut function = builder.output([0, 0]);
    number_values(&mut function, fold, false);
    let defs = function.body.iter().filter_map(|node| match node {
        Node::Let(value) => Some(function.def(*value)),
        _ => None,
    });
    let operations = defs.filter_map(|def| match def {
        ValueDef::Operation(operation, [a, b, _]) => {
            let operands = [a, b].map(|operand| (operand != NONE).then(|| function.def(operand)));
            Some((operation, operands))
        }
        _ => None,
    });
    operations.collect()
}

fn operation(operation: Operation, [a, b]: [Value; 2]) -> ValueDef {
    ValueDef::Operation(operation, [a, b, NONE])
}

#[test]
fn a_division_by_a_power_of_two_becomes_a_multiplication() {
    let float = |number: f64| ValueDef::Float(number.to_bits());
    let y = ValueDef::FragCoord(Axis::Y);
    let quotient = |divisor: f64| {
        numbered(|builder, body| {
            let [y, divisor] = [y, float(divisor)].map(|def| builder.value(def));
            builder.make(operation(Operation::Div, [y, divisor]), body)
        })
    };
    for (divisor, factor) in [(16_777_216.0, 1.0 / 16_777_216.0), (-0.25, -4.0)] {
        let product = (Operation::Mul, [Some(y), Some(float(factor))]);
        assert!(quotient(divisor).contains(&product), "{divisor}");
    }
    // Other reciprocals are rounded, or denormal in f32.
    for divisor in [3.0, 0.1, 0.0, f64::INFINITY, f64::exp2(127.0), f64::exp2(-127.0)] {
        let same = (Operation::Div, [Some(y), Some(float(divisor))]);
        assert!(quotient(divisor).contains(&same), "{divisor}");
    }
}

#[test]
fn a_word_whose_highest_bit_is_known_to_be_0_is_converted_as_an_integer() {
    let conversions = |making: Operation, known: u32| {
        let operations = numbered(|builder, body| {
            let known = builder.word(known);
            let word = builder.make(operation(making, [builder.varying, known]), body);
            builder.make(operation(Operation::FromUint, [word, NONE]), body)
        });
        let operations = operations.into_iter().map(|(operation, _)| operation);
        operations
            .filter(|operation| matches!(operation, Operation::FromInt | Operation::FromUint))
            .collect::<Vec<_>>()
    };
    for (making, known) in [(Operation::ShiftRightUint, 8), (Operation::And, 0x7FFF_FFFF)] {
        assert_eq!(conversions(making, known), [Operation::FromInt]);
    }
    // A shift by 32 is one by 0.
    for (making, known) in [
        (Operation::ShiftRightUint, 32),
        (Operation::ShiftRightInt, 8),
        (Operation::And, 0x8000_0000),
    ] {
        assert_eq!(conversions(making, known), [Operation::FromUint]);
    }
}

#[test]
fn the_sine_and_the_cosine_of_an_angle_become_neighbors() {
    let mut builder = FunctionBuilder::new(1, 0, 0);
    let mut body = Block::new();
    let [x, y] = [Axis::X, Axis::Y].map(|axis| builder.value(ValueDef::FragCoord(axis)));
    let mut function_of =
        |operation, angle| builder.make(ValueDef::Operation(operation, [angle, NONE, NONE]), &mut body);
    let cosine = function_of(Operation::Cos, x);
    let other = function_of(Operation::Sin, y);
    let root = function_of(Operation::Sqrt, x);
    let sine = function_of(Operation::Sin, x);
    let last = function_of(Operation::Cos, root);
    builder.function.body = body;
    pair(&mut builder.function);
    let values = builder.function.body.iter().map(|node| match node {
        Node::Let(value) => *value,
        _ => NONE,
    });
    assert_eq!(values.collect::<Vec<_>>(), [cosine, sine, other, root, last]);
}

/// A loop in which each cell takes the value of the next one.
#[test]
fn divergence_propagates_from_cell_to_cell() {
    let cell_count = 200_000;
    let mut builder = FunctionBuilder::new(cell_count as usize + 2, 0, 1);
    let mut body = vec![Node::LoopHeader(LoopId(0))];
    for cell in 0..cell_count {
        let next = builder.load(cell + 1, &mut body);
        body.push(store(cell, next));
    }
    let same = builder.word(1);
    let varying = builder.varying;
    builder
        .function
        .body
        .extend([store(cell_count, varying), store(cell_count + 1, same)]);
    builder.function.body.push(Node::Loop { id: LoopId(0), body });
    let function = builder.output([0, cell_count + 1]);
    let divergence = Divergence::new(&function, &AliasGroups::new(&function));
    assert!((0..=cell_count).all(|cell| divergence.cell(Cell(cell))));
    assert!(!divergence.cell(Cell(cell_count + 1)));
}

/// A cell that only some pixels store is divergent if others read it, too, and uniform otherwise; cell 4 is
/// live from one iteration to the next, in which other pixels may be active.
#[test]
fn cells_are_shared_if_other_pixels_read_them() {
    let mut builder = FunctionBuilder::new(5, 1, 1);
    let (varying, same) = (builder.varying, builder.word(1));
    let mut yes = vec![store(0, same), store(1, same)];
    let inside = builder.load(1, &mut yes);
    yes.push(store(0, inside));
    let scope = vec![break_if(0, varying), store(2, same)];
    let mut header = vec![Node::LoopHeader(LoopId(0))];
    let mut again = Block::new();
    builder.load(3, &mut again);
    builder.load(4, &mut again);
    again.extend([store(3, same), store(4, same)]);
    header.extend([store(3, same), if_then(varying, again)]);
    builder.function.body.extend([
        store(4, same),
        if_then(varying, yes),
        Node::Scope {
            scope: Scope(0),
            body: scope,
        },
        Node::Loop {
            id: LoopId(0),
            body: header,
        },
    ]);
    let function = builder.output([0, 2]);
    let divergence = Divergence::new(&function, &AliasGroups::new(&function));
    let shared = [0, 1, 2, 3, 4].map(|cell| divergence.is_shared(Cell(cell)));
    assert_eq!(shared, [true, false, true, false, true]);
    assert!(divergence.scope(Scope(0)));
}

/// A scope is followed by a check for remaining pixels only if a break in it leaves an outer scope.
#[test]
fn only_breaks_of_outer_scopes_need_a_check() {
    for (left, checks) in [(1, 0), (0, 1)] {
        let mut builder = FunctionBuilder::new(1, 2, 0);
        let inner = Node::Scope {
            scope: Scope(1),
            body: vec![
                break_if(1, builder.varying),
                if_then(builder.varying, vec![break_if(left, builder.varying)]),
            ],
        };
        builder.function.body.push(Node::Scope {
            scope: Scope(0),
            body: vec![break_if(0, builder.varying), inner],
        });
        let linear = builder.linear();
        // There is always a check after the `if`, which leaves at least the inner scope.
        assert_eq!(
            count_steps(&linear, |step| matches!(step, Step::JumpIfEmpty(_))),
            1 + checks
        );
    }
}

/// Each arm of an `else if` is nested in the one before, and contains a scope of its own with a break.
#[test]
fn nested_else_ifs_are_linearized_in_linear_time() {
    let arms = 30_000;
    let steps = with_stack(|| {
        let mut builder = FunctionBuilder::new(1, arms, 0);
        let mut no = Block::new();
        for scope in (0..arms).rev() {
            let yes = vec![Node::Scope {
                scope: Scope(scope),
                body: vec![break_if(scope, builder.varying), store(0, builder.varying)],
            }];
            no = vec![Node::If {
                condition: builder.varying,
                yes,
                no,
            }];
        }
        builder.function.body.append(&mut no);
        builder.linear().steps.len()
    });
    assert!(steps.is_ok_and(|steps| steps > arms as usize));
}

/// Compiles the body of `mainImage(out vec4 c, in vec2 p)`.
fn compile(body: &str, limit: Option<std::time::Duration>) -> Result<(), Refusal> {
    let mut files = Files::default();
    let text = format!("void mainImage(out vec4 c, in vec2 p) {{ {body} }}");
    let file = files.add(File::new("a", text));
    let checked = toyproof_glsl::check(&files, file, &toyproof_glsl::Options::default()).unwrap();
    Program::compile(&checked, UndefinedPolicy::Plain, limit, None).map(drop)
}

#[test]
fn too_many_variables_are_refused() {
    let indexed = |count| {
        let declarations =
            (0..count).map(|number| format!("float a{number}[65536]; a{number}[int(p.x)] = p.y;"));
        let body = declarations.collect::<String>() + "c = vec4(a0[int(p.y)]);";
        compile(&body, None)
    };
    assert_eq!(indexed(1), Ok(()));
    assert_eq!(indexed(3), Err(Refusal::TooLong));
}

#[test]
fn compilation_respects_its_deadline() {
    use std::time::Duration;

    let within = |limit| compile("c = vec4(p, 0, 1);", Some(limit));
    let late = within(Duration::ZERO);
    assert!(matches!(late, Err(Refusal::TooSlow(_))), "{late:?}");
    assert!(within(Duration::from_secs(3600)).is_ok());
}
