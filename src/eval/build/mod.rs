//! From the typed tree to [`Flow`]: calls inlined, everything in components.

mod builtin;
mod call;
mod construct;
mod expression;
mod layout;
mod operator;
mod place;
mod statement;
mod tail;
mod tell;
mod term;
mod texture;
mod undefined;
mod written;

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap, HashSet};

use thiserror::Error;
use toyproof_diagnostic::{Deadline, Overdue};
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{Direction, ExprId, FunctionId, Item, Place, Tree, Type, VariableId, VariableKind};

use self::place::Home;
use self::term::Term;
use self::written::{Written, handed_out};
use crate::ir::function::{Block, Cell, Cells, Flow, LoopId, NONE, Node, Origin, Scope, Value};
use crate::ir::operation::{Kind, Operation};
use crate::observe::{Predicate, Site, SiteId};
use crate::render::Other;
use crate::trace::story::{CallId, EventId, Plot};

/// The most values that a program may have: more is refused rather than run out of memory.
const MAX_VALUES: usize = 2_000_000;

/// The most cells: each thread that paints holds 256 bytes for each of them.
const MAX_CELLS: usize = 1 << 17;

/// How deep calls, statements and expressions may nest, all together, once calls are inlined.
const MAX_DEPTH: usize = 10_000;

/// The stack that so much takes, and to spare.
const STACK_BYTES: usize = 128 << 20;

/// Why a shader cannot be evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Refusal {
    /// Inlined, it is longer than we take.
    #[error("with all calls written out, this shader is too long to be evaluated on the CPU")]
    TooLong,
    /// Inlined, it nests deeper than we take.
    #[error("with all calls written out, this shader nests too deep to be evaluated on the CPU")]
    TooDeep,
    /// There is no memory for it, or for the stack that is needed.
    #[error("there is not enough memory to evaluate this shader on the CPU")]
    NoMemory,
    /// Compiling it takes longer than it may.
    #[error(transparent)]
    TooSlow(#[from] Overdue),
}

/// What comes of operations that GLSL leaves undefined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Choice {
    /// What strict GPU runs make of them.
    #[default]
    Usual,
    /// The same, and it is noted.
    Noted,
    /// Something else.
    Other(Other),
}

/// What is compiled besides the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Extras {
    /// What comes of operations that GLSL leaves undefined.
    pub(crate) choice: Choice,
    /// What each pixel does, step by step.
    pub(crate) story: bool,
}

/// Does what may recurse deep, on a stack of its own.
pub(crate) fn with_stack<T: Send>(work: impl FnOnce() -> T + Send) -> std::result::Result<T, Refusal> {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new()
            .stack_size(STACK_BYTES)
            .spawn_scoped(scope, work)
            .map_err(|_| Refusal::NoMemory)?;
        thread.join().map_err(|panic| std::panic::resume_unwind(panic))
    })
}

/// What comes of a tree.
pub(crate) struct Program {
    pub(crate) flow: Flow,
    /// Where something may be noted.
    pub(crate) sites: Vec<Site>,
    /// What may be told.
    pub(crate) plot: Plot,
}

/// Writes a shader's flow.
pub(crate) fn compile(checked: &Checked, extras: Extras, deadline: &Deadline) -> Result<Program> {
    let mut builder = Builder {
        tree: &checked.tree,
        deadline,
        extras,
        draft: RefCell::default(),
        homes: HashMap::new(),
        shared: HashSet::new(),
        cells: Vec::new(),
        scopes: 0,
        loops: Vec::new(),
        frames: Vec::new(),
        breaks: Vec::new(),
        continues: Vec::new(),
        sites: Vec::new(),
        site_ids: HashMap::new(),
        open: Vec::new(),
        written: BTreeMap::new(),
        parts: Vec::new(),
        handed_out: match extras.choice {
            Choice::Noted => handed_out(&checked.tree),
            _ => HashSet::new(),
        },
        plot: Plot::default(),
        rounds: Vec::new(),
        depth: 0,
        discarded: Cell(0),
    };
    builder.program(checked.main_image)?;
    let draft = builder.draft.into_inner();
    let [red, green, blue, discarded] = draft.output;
    let flow = Flow {
        origins: draft.origins,
        cells: builder.cells,
        scopes: builder.scopes,
        loops: builder.loops,
        body: draft.block,
        output: [red, green, blue, discarded],
    };
    Ok(Program {
        flow,
        sites: builder.sites,
        plot: builder.plot,
    })
}

/// The nodes that are being written: shared, so that terms may write as they are added and multiplied.
#[derive(Debug)]
struct Draft {
    origins: Vec<Origin>,
    block: Block,
    /// Numbers and inputs, which stand nowhere in the code.
    known: HashMap<Origin, Value>,
    output: [Value; 4],
}

impl Default for Draft {
    fn default() -> Self {
        Self {
            origins: Vec::new(),
            block: Block::new(),
            known: HashMap::new(),
            output: [NONE; 4],
        }
    }
}

impl Draft {
    fn push(&mut self, origin: Origin) -> Value {
        let constant = matches!(
            origin,
            Origin::Float(_) | Origin::Word(_) | Origin::Input(..) | Origin::FragCoord(_)
        );
        if constant && let Some(&value) = self.known.get(&origin) {
            return value;
        }
        let value = Value(self.origins.len() as u32);
        self.origins.push(origin);
        if constant {
            self.known.insert(origin, value);
        } else {
            self.block.push(Node::Let(value));
        }
        value
    }
}

/// A function that is being inlined.
#[derive(Debug)]
struct Frame {
    scope: Scope,
    result: Cells,
    /// Its call, for stories.
    call: Option<CallId>,
}

/// Writes the flow of a tree.
struct Builder<'a> {
    tree: &'a Tree,
    deadline: &'a Deadline,
    extras: Extras,
    draft: RefCell<Draft>,
    homes: HashMap<VariableId, Home>,
    /// Variables of a `switch`, whose homes were found before it.
    shared: HashSet<VariableId>,
    cells: Vec<Kind>,
    scopes: u32,
    loops: Vec<Place>,
    frames: Vec<Frame>,
    breaks: Vec<Scope>,
    continues: Vec<Scope>,
    sites: Vec<Site>,
    site_ids: HashMap<Site, SiteId>,
    /// What was checked and is not settled.
    open: Vec<(Predicate, [Value; 2])>,
    /// Variables of which it is kept what is written, by their first cells.
    written: BTreeMap<u32, Written>,
    /// The parts of them that are parameters now, the innermost last.
    parts: Vec<(Cells, Place)>,
    /// The variables whose values a function may take away.
    handed_out: HashSet<VariableId>,
    plot: Plot,
    /// The rounds of the loops that are being written.
    rounds: Vec<EventId>,
    depth: usize,
    /// The cell that tells of `discard`.
    discarded: Cell,
}

type Result<T> = std::result::Result<T, Refusal>;

impl Builder<'_> {
    fn program(&mut self, main_image: FunctionId) -> Result<()> {
        let all = self.scope();
        let discarded = self.allocate(Kind::Word);
        self.discarded = discarded;
        let zero = self.word(0);
        self.store(discarded, zero);
        let colour = Cells {
            first: self.cells.len() as u32,
            count: 4,
        };
        // Black, and what a shader adds to is opaque, as ShaderToy's own `main` has it; but `out` brings nothing in.
        let colour_parameter = self.tree[main_image].parameters.first();
        let added_to = colour_parameter
            .is_some_and(|&parameter| call::direction(self.tree[parameter].kind) == Direction::InOut);
        for value in [0.0, 0.0, 0.0, f64::from(u8::from(added_to))] {
            let cell = self.allocate(Kind::Float);
            let value = self.float(value);
            self.store(cell, value);
        }
        let body = self.inner(|builder| {
            builder.frames.push(Frame {
                scope: all,
                result: Cells { first: 0, count: 0 },
                call: None,
            });
            builder.globals()?;
            builder.main_image(main_image, colour)?;
            builder.frames.pop();
            Ok(())
        })?;
        self.push(Node::Scope { scope: all, body });
        let [r, g, b] = [0, 1, 2].map(|at| self.load(Cell(colour.first + at)));
        let discarded = self.load(discarded);
        self.draft.borrow_mut().output = [r, g, b, discarded];
        Ok(())
    }

    /// The author's variables outside of functions, in order.
    fn globals(&mut self) -> Result<()> {
        let tree = self.tree;
        for item in &tree.items {
            let Item::Variable(variable) = *item else {
                continue;
            };
            match tree[variable].kind {
                VariableKind::Global | VariableKind::Const | VariableKind::Output => {
                    self.declare(variable)?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// What a scope's body writes, as a block of its own.
    fn inner(&mut self, write: impl FnOnce(&mut Self) -> Result<()>) -> Result<Block> {
        let outer = std::mem::take(&mut self.draft.borrow_mut().block);
        let written = self.deeper(write);
        let inner = std::mem::replace(&mut self.draft.borrow_mut().block, outer);
        written.map(|()| inner)
    }

    /// One level further down.
    fn deeper<T>(&mut self, work: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(Refusal::TooDeep);
        }
        let result = work(self);
        self.depth -= 1;
        result
    }

    fn push(&self, node: Node) {
        self.draft.borrow_mut().block.push(node);
    }

    fn scope(&mut self) -> Scope {
        self.scopes += 1;
        Scope(self.scopes - 1)
    }

    fn new_loop(&mut self, at: Place) -> LoopId {
        self.loops.push(at);
        LoopId(self.loops.len() as u32 - 1)
    }

    fn allocate(&mut self, kind: Kind) -> Cell {
        self.cells.push(kind);
        Cell(self.cells.len() as u32 - 1)
    }

    /// Cells for a variable of that type.
    fn allocate_type(&mut self, ty: Type) -> Result<Cells> {
        let scalars = self.tree.scalars(ty);
        if self.cells.len() + layout::size(self.tree, ty) > MAX_CELLS {
            return Err(Refusal::NoMemory);
        }

        let first = self.cells.len() as u32;
        self.cells
            .extend(scalars.iter().map(|&scalar| layout::kind(scalar)));
        Ok(Cells {
            first,
            count: scalars.len() as u32,
        })
    }

    fn store(&self, cell: Cell, value: Value) {
        self.push(Node::Store { cell, value });
    }

    fn store_all(&self, cells: Cells, values: &[Value]) {
        for (cell, &value) in (cells.first..cells.first + cells.count).zip(values) {
            self.store(Cell(cell), value);
        }
    }

    fn load(&self, cell: Cell) -> Value {
        self.value(Origin::Load(cell))
    }

    fn load_all(&self, cells: Cells) -> Vec<Value> {
        (cells.first..cells.first + cells.count)
            .map(|cell| self.load(Cell(cell)))
            .collect()
    }

    fn value(&self, origin: Origin) -> Value {
        self.draft.borrow_mut().push(origin)
    }

    /// Stops when a program grows beyond all measure, or the time is over.
    fn bounded(&self) -> Result<()> {
        if self.deadline.is_over() {
            self.deadline.check()?;
        }
        if self.draft.borrow().origins.len().max(self.plot.events.len()) > MAX_VALUES {
            return Err(Refusal::TooLong);
        }
        Ok(())
    }

    fn float(&self, value: f64) -> Value {
        self.value(Origin::Float(value.to_bits()))
    }

    fn word(&self, value: u32) -> Value {
        self.value(Origin::Word(value))
    }

    /// A `bool`: no bits, or all.
    fn truth(&self, value: bool) -> Value {
        self.word(if value { u32::MAX } else { 0 })
    }

    fn unary(&self, operation: Operation, a: Value) -> Value {
        self.value(Origin::Operation(operation, [a, NONE, NONE]))
    }

    fn binary(&self, operation: Operation, a: Value, b: Value) -> Value {
        self.value(Origin::Operation(operation, [a, b, NONE]))
    }

    fn select(&self, condition: Value, yes: Value, no: Value, kind: Kind) -> Value {
        let operation = match kind {
            Kind::Float => Operation::Select,
            Kind::Word => Operation::SelectWord,
        };
        self.value(Origin::Operation(operation, [condition, yes, no]))
    }

    fn term(&self, value: Value) -> Term<'_> {
        Term::new(&self.draft, value)
    }

    fn terms(&self, values: &[Value]) -> Vec<Term<'_>> {
        values.iter().map(|&value| self.term(value)).collect()
    }

    /// The zero of each component of a type.
    fn zeros(&self, ty: Type) -> Vec<Value> {
        let scalars = self.tree.scalars(ty);

        scalars
            .into_iter()
            .map(|scalar| match layout::kind(scalar) {
                Kind::Float => self.float(0.0),
                Kind::Word => self.word(0),
            })
            .collect()
    }

    fn ty(&self, expr: ExprId) -> Type {
        self.tree[expr].ty
    }

    fn at(&self, expr: ExprId) -> Place {
        self.tree[expr].at
    }
}
