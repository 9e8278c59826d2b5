//! What a shader that means harm is made into, and that this takes no longer than the shader is long: each program here is so large that
//! whatever looks at it again for each of its parts would take minutes, or more memory than there is.

use toyproof_diagnostic::{File, Files, Span};
use toyproof_glsl::tree::Place;

use crate::build::with_stack;
use crate::ir::alias::Groups;
use crate::ir::function::{Axis, Block, Cell, Flow, LoopId, NONE, Node, Origin, Scope, Value};
use crate::ir::operation::{Kind, Operation};
use crate::lower::linearize::{Flat, Step, flatten};
use crate::opt::dce::prune;
use crate::opt::divergence::Varying;
use crate::opt::gvn::forward;

/// A program of words that is being written, with a condition that varies.
struct Draft {
    flow: Flow,
    varies: Value,
}

impl Draft {
    /// A program with so many cells, scopes and loops.
    fn new(cells: usize, scopes: u32, loops: usize) -> Self {
        let file = Files::default().add(File::new("", ""));
        let nowhere = Place::plain(Span::new(file, 0, 0));
        let mut draft = Self {
            flow: Flow {
                origins: Vec::new(),
                cells: vec![Kind::Word; cells],
                scopes,
                loops: vec![nowhere; loops],
                body: Block::new(),
                output: [NONE; 4],
            },
            varies: NONE,
        };
        let x = draft.value(Origin::FragCoord(Axis::X));
        draft.varies = draft.value(Origin::Operation(Operation::ToBits, [x, NONE, NONE]));
        draft.flow.body.push(Node::Let(draft.varies));
        draft
    }

    fn value(&mut self, origin: Origin) -> Value {
        self.flow.origins.push(origin);
        Value(self.flow.origins.len() as u32 - 1)
    }

    fn word(&mut self, word: u32) -> Value {
        self.value(Origin::Word(word))
    }

    fn load(&mut self, cell: u32, block: &mut Block) -> Value {
        self.make(Origin::Load(Cell(cell)), block)
    }

    fn make(&mut self, origin: Origin, block: &mut Block) -> Value {
        let value = self.value(origin);
        block.push(Node::Let(value));
        value
    }

    /// With what the picture is made of.
    fn output(mut self, cells: [u32; 2]) -> Flow {
        let mut body = std::mem::take(&mut self.flow.body);
        let [a, b] = cells.map(|cell| self.load(cell, &mut body));
        self.flow.body = body;
        self.flow.output = [a, b, a, b];
        self.flow
    }

    fn flat(self) -> Flat {
        let flow = self.output([0, 0]);
        flatten(&flow, &Varying::of(&flow, &Groups::of(&flow)), false)
    }
}

fn store(cell: u32, value: Value) -> Node {
    Node::Store {
        cell: Cell(cell),
        value,
    }
}

fn leave_if(scope: u32, condition: Value) -> Node {
    Node::LeaveIf {
        scope: Scope(scope),
        condition,
        when: true,
    }
}

fn choice(condition: Value, yes: Block) -> Node {
    Node::If {
        condition,
        yes,
        no: Block::new(),
    }
}

/// How many of a program's steps are such.
fn count(flat: &Flat, is: impl Fn(&Step) -> bool) -> usize {
    flat.steps.iter().filter(|(step, _)| is(step)).count()
}

/// A scope that is left that often, each time with one more cell stored. Cell 0 is stored before and not in it, cell 1 in it last.
fn left_often(times: u32) -> Flow {
    let mut draft = Draft::new(times as usize + 2, 1, 0);
    let (before, after) = (draft.word(7), draft.word(9));
    let mut body = Block::new();
    for cell in 0..times {
        body.extend([leave_if(0, draft.varies), store(cell + 2, after)]);
    }
    body.push(store(1, after));
    draft.flow.body.extend([store(0, before), store(1, before)]);
    draft.flow.body.push(Node::Scope {
        scope: Scope(0),
        body,
    });
    draft.output([0, 1])
}

/// Ways that keep all that changed on them would be gigabytes here.
#[test]
fn scopes_that_are_left_often_keep_what_there_is_room_for() {
    for times in [1, 60_000] {
        let mut flow = left_often(times);
        forward(&mut flow, false);
        let [kept, stored, ..] = flow.output.map(|value| flow.origin(value));
        assert_eq!(kept, Origin::Word(7));
        assert_eq!(stored, Origin::Load(Cell(1)), "it is 7 or 9");
    }
}

/// Rounds are tried seven thousand times here, and none comes to what is in the choice.
#[test]
fn what_no_round_of_a_loop_comes_to_is_not_copied() {
    let mut draft = Draft::new(2, 1, 1);
    let [zero, one, rounds] = [0, 1, 60_000].map(|word| draft.word(word));
    let mut body = vec![Node::Round(LoopId(0))];
    let at = draft.load(0, &mut body);
    let goes_on = draft.make(
        Origin::Operation(Operation::LessInt, [at, rounds, NONE]),
        &mut body,
    );
    body.push(Node::LeaveIf {
        scope: Scope(0),
        condition: goes_on,
        when: false,
    });
    let never = draft.make(Origin::Operation(Operation::LessInt, [at, zero, NONE]), &mut body);
    body.push(choice(never, vec![store(1, one); 1 << 20]));
    let next = draft.make(Origin::Operation(Operation::AddWord, [at, one, NONE]), &mut body);
    body.push(store(0, next));
    let body = vec![Node::Loop { id: LoopId(0), body }];
    draft.flow.body.extend([store(0, zero), store(1, zero)]);
    draft.flow.body.push(Node::Scope {
        scope: Scope(0),
        body,
    });
    let mut flow = draft.output([0, 1]);
    forward(&mut flow, false);
    assert!(matches!(flow.origin(flow.output[0]), Origin::Load(_)));
}

/// Nobody asks for the last, so that nobody asks for the one before it, and so on.
#[test]
fn choices_with_nothing_in_them_are_taken_out_at_once() {
    let many = 40_000;
    let mut draft = Draft::new(many as usize + 2, 0, 0);
    let yes = draft.word(u32::MAX);
    let mut body = vec![store(many + 1, yes), store(0, draft.varies)];
    for cell in 0..many {
        let condition = draft.load(cell, &mut body);
        body.push(choice(condition, vec![store(cell + 1, yes)]));
    }
    draft.flow.body.append(&mut body);
    let mut flow = draft.output([many + 1, many + 1]);
    prune(&mut flow);
    assert!(matches!(
        flow.body[..],
        [Node::Store { cell, .. }, Node::Let(_), Node::Let(_)] if cell.0 == many + 1
    ));
}

#[test]
fn a_choice_that_only_its_own_condition_asks_for_is_taken_out() {
    let mut draft = Draft::new(2, 0, 1);
    let yes = draft.word(u32::MAX);
    let mut body = vec![Node::Round(LoopId(0))];
    let condition = draft.load(1, &mut body);
    body.push(choice(condition, vec![store(1, yes)]));
    draft.flow.body.push(Node::Loop { id: LoopId(0), body });
    let mut flow = draft.output([0, 0]);
    prune(&mut flow);
    let inside = flow.body.iter().find_map(|node| match node {
        Node::Loop { body, .. } => Some(body.len()),
        _ => None,
    });
    assert_eq!(inside, Some(1));
}

/// A loop in which each cell takes what the next one held.
#[test]
fn what_varies_is_followed_from_cell_to_cell() {
    let many = 200_000;
    let mut draft = Draft::new(many as usize + 2, 0, 1);
    let mut body = vec![Node::Round(LoopId(0))];
    for cell in 0..many {
        let next = draft.load(cell + 1, &mut body);
        body.push(store(cell, next));
    }
    let same = draft.word(1);
    let varies = draft.varies;
    draft
        .flow
        .body
        .extend([store(many, varies), store(many + 1, same)]);
    draft.flow.body.push(Node::Loop { id: LoopId(0), body });
    let flow = draft.output([0, many + 1]);
    let varying = Varying::of(&flow, &Groups::of(&flow));
    assert!((0..=many).all(|cell| varying.cell(Cell(cell))));
    assert!(!varying.cell(Cell(many + 1)));
}

/// What is stored where only some pixels are varies where others read it, too, and not where only they do; cell 4 lives on from one
/// round to the next, in which they may be others.
#[test]
fn cells_are_shared_where_others_read_them() {
    let mut draft = Draft::new(5, 1, 1);
    let (varies, same) = (draft.varies, draft.word(1));
    let mut yes = vec![store(0, same), store(1, same)];
    let inside = draft.load(1, &mut yes);
    yes.push(store(0, inside));
    let scope = vec![leave_if(0, varies), store(2, same)];
    let mut round = vec![Node::Round(LoopId(0))];
    let mut again = Block::new();
    draft.load(3, &mut again);
    draft.load(4, &mut again);
    again.extend([store(3, same), store(4, same)]);
    round.extend([store(3, same), choice(varies, again)]);
    draft.flow.body.extend([
        store(4, same),
        choice(varies, yes),
        Node::Scope {
            scope: Scope(0),
            body: scope,
        },
        Node::Loop {
            id: LoopId(0),
            body: round,
        },
    ]);
    let flow = draft.output([0, 2]);
    let varying = Varying::of(&flow, &Groups::of(&flow));
    let shared = [0, 1, 2, 3, 4].map(|cell| varying.is_shared(Cell(cell)));
    assert_eq!(shared, [true, false, true, false, true]);
    assert!(varying.scope(Scope(0)));
}

/// Whether anybody is left is asked after a scope only where a way led beyond it.
#[test]
fn only_who_left_further_is_asked_for() {
    for (left, asked) in [(1, 0), (0, 1)] {
        let mut draft = Draft::new(1, 2, 0);
        let inner = Node::Scope {
            scope: Scope(1),
            body: vec![
                leave_if(1, draft.varies),
                choice(draft.varies, vec![leave_if(left, draft.varies)]),
            ],
        };
        draft.flow.body.push(Node::Scope {
            scope: Scope(0),
            body: vec![leave_if(0, draft.varies), inner],
        });
        let flat = draft.flat();
        // After the choice in any case: it leaves the inner scope at least.
        assert_eq!(
            count(&flat, |step| matches!(step, Step::JumpIfEmpty(_))),
            1 + asked
        );
    }
}

/// Each arm of an `else if` stands in that before it, and has a scope of its own, which is left.
#[test]
fn arms_in_arms_are_looked_through_once() {
    let arms = 30_000;
    let steps = with_stack(|| {
        let mut draft = Draft::new(1, arms, 0);
        let mut no = Block::new();
        for scope in (0..arms).rev() {
            let yes = vec![Node::Scope {
                scope: Scope(scope),
                body: vec![leave_if(scope, draft.varies), store(0, draft.varies)],
            }];
            no = vec![Node::If {
                condition: draft.varies,
                yes,
                no,
            }];
        }
        draft.flow.body.append(&mut no);
        draft.flat().steps.len()
    });
    assert!(steps.is_ok_and(|steps| steps > arms as usize));
}

#[test]
fn compiling_ends_when_its_time_is_over() {
    use std::time::Duration;

    let mut files = Files::default();
    let file = files.add(File::new(
        "a",
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(p, 0, 1); }",
    ));
    let checked = toyproof_glsl::check(&files, file, &toyproof_glsl::Options::default()).unwrap();
    let late = super::Program::within(&checked, Duration::ZERO).map(drop);
    assert!(matches!(late, Err(super::Refusal::TooSlow(_))), "{late:?}");
    assert!(super::Program::within(&checked, Duration::from_secs(3600)).is_ok());
}
