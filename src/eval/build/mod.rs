//! Construction of the [`Function`] from the typed tree: calls are inlined, and values are scalarized.

mod builtin;
mod call;
mod expression;
mod instrument;
mod lvalue;
mod operator;
mod profile;
mod statement;
mod texture;
mod undefined;

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap, HashSet};

use thiserror::Error;
use toyproof_diagnostic::{Deadline, Overdue};
use toyproof_glsl::tree::{
    BuiltInVariable, ExprId, FunctionId, Item, Place, Tree, Type, Variable, VariableId, VariableKind,
};
use toyproof_glsl::{Checked, Sampling, Stage};

use self::instrument::{WrittenFlags, out_arguments};
use self::lvalue::{Location, component_count, scalar_kind};
use self::operator::Term;
pub use self::undefined::{Substitute, UndefinedPolicy};
use crate::ir::{
    Block, CallId, Cell, Cells, EventId, Function, Kind, LoopId, NONE, Node, Operation, Origin, Part, PartId,
    Predicate, ProfileSchema, Scope, Site, SiteId, TraceSchema, Value, ValueDef,
};

/// The maximum number of values of a program; larger programs are refused before memory runs out.
pub const MAX_VALUES: usize = 2_000_000;

/// The maximum number of cells; each rendering thread holds up to 256 bytes for each cell.
const MAX_CELLS: usize = 1 << 17;

/// The maximum nesting depth of inlined calls, statements and expressions together.
const MAX_DEPTH: usize = 10_000;

/// The stack size in bytes, enough for [`MAX_DEPTH`] with a margin.
const STACK_BYTES: usize = 128 << 20;

/// Why a shader cannot be evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Refusal {
    /// The shader has too many values or variables after inlining.
    #[error("the shader is too large after inlining to be evaluated on the CPU")]
    TooLong,
    /// The shader is nested too deeply after inlining.
    #[error("the shader is nested too deeply after inlining to be evaluated on the CPU")]
    TooDeep,
    /// There is not enough memory for the shader, or for the stack.
    #[error("not enough memory to evaluate the shader on the CPU")]
    NoMemory,
    /// Compilation exceeds its time limit.
    #[error(transparent)]
    TooSlow(#[from] Overdue),
}

/// The instrumentation that is compiled into a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct BuildOptions {
    /// The treatment of operations that GLSL leaves undefined.
    pub(crate) undefined: UndefinedPolicy,
    /// What traces record.
    pub(crate) trace: TraceDetail,
    /// The maximum number of values.
    pub(crate) max_values: usize,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self {
            undefined: UndefinedPolicy::Plain,
            trace: TraceDetail::Nothing,
            max_values: MAX_VALUES,
        }
    }
}

/// What is recorded of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum TraceDetail {
    /// Nothing: the program renders images.
    Nothing,
    /// What is computed, assigned and decided.
    Values,
    /// Also where statements and functions begin, and which cells are written.
    Steps,
    /// No trace; the operations are counted.
    Counts,
}

impl TraceDetail {
    /// Whether values are recorded.
    pub(crate) fn is_traced(self) -> bool {
        matches!(self, Self::Values | Self::Steps)
    }
}

/// Runs work that may recurse deeply on a thread with a large stack.
pub(crate) fn with_stack<T: Send>(work: impl FnOnce() -> T + Send) -> std::result::Result<T, Refusal> {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new()
            .stack_size(STACK_BYTES)
            .spawn_scoped(scope, work)
            .map_err(|_| Refusal::NoMemory)?;
        thread.join().map_err(|panic| std::panic::resume_unwind(panic))
    })
}

/// A function, and what its instrumentation refers to.
pub(crate) struct InstrumentedFunction {
    pub(crate) function: Function,
    /// The sites of checks.
    pub(crate) sites: Vec<Site>,
    /// The events of traces.
    pub(crate) schema: TraceSchema,
    /// What a profile counts.
    pub(crate) profile: ProfileSchema,
}

/// Builds the function of a shader. Uniforms that are among the `parameters` get their
/// values for each point; all others are zero.
pub(crate) fn build_function(
    checked: &Checked,
    parameters: &[VariableId],
    options: BuildOptions,
    deadline: &Deadline,
) -> Result<InstrumentedFunction> {
    let mut builder = Builder {
        tree: &checked.tree,
        sampling: checked.sampling,
        keeps_alpha: checked.stage != Stage::Image,
        parameters: parameters.iter().copied().zip(0..).collect(),
        deadline,
        options,
        writer: RefCell::default(),
        locations: HashMap::new(),
        shared: HashSet::new(),
        cells: Vec::new(),
        scopes: 0,
        loops: Vec::new(),
        call_stack: Vec::new(),
        breaks: Vec::new(),
        continues: Vec::new(),
        sites: Vec::new(),
        site_ids: HashMap::new(),
        unresolved: Vec::new(),
        written: BTreeMap::new(),
        out_parameters: Vec::new(),
        out_arguments: match options.undefined {
            UndefinedPolicy::Observed => out_arguments(&checked.tree),
            _ => HashSet::new(),
        },
        schema: TraceSchema::default(),
        parts: Vec::new(),
        open_parts: Vec::new(),
        loop_headers: Vec::new(),
        depth: 0,
        discarded: Cell(0),
    };
    builder.program(checked.main_image)?;
    let mut profile = ProfileSchema::default();
    let writer = builder.writer.get_mut();
    if options.trace == TraceDetail::Counts {
        profile.blocks = profile::basic_blocks(writer);
        profile.parts = builder.parts;
        profile.calls = std::mem::take(&mut builder.schema.calls);
    }
    let writer = builder.writer.into_inner();
    let function = Function {
        defs: writer.defs,
        cells: builder.cells,
        scopes: builder.scopes,
        loops: builder.loops,
        body: writer.block,
        output: writer.output,
    };
    Ok(InstrumentedFunction {
        function,
        sites: builder.sites,
        schema: builder.schema,
        profile,
    })
}

/// The nodes that are being written. Shared, so that overloaded operators of [`Term`] can emit nodes.
#[derive(Debug)]
struct IrWriter {
    defs: Vec<ValueDef>,
    block: Block,
    /// Constants and inputs, which have no node.
    known: HashMap<ValueDef, Value>,
    /// Where the values that are written next come from; none at the beginning of the program.
    origin: Option<Origin>,
    /// The first value from each origin, in ascending order.
    origins: Vec<(u32, Origin)>,
    output: [Value; 5],
}

impl Default for IrWriter {
    fn default() -> Self {
        Self {
            defs: Vec::new(),
            block: Block::new(),
            known: HashMap::new(),
            origin: None,
            origins: Vec::new(),
            output: [NONE; 5],
        }
    }
}

impl IrWriter {
    fn push(&mut self, def: ValueDef) -> Value {
        let constant = matches!(
            def,
            ValueDef::Float(_)
                | ValueDef::Word(_)
                | ValueDef::Input(..)
                | ValueDef::Extent { .. }
                | ValueDef::Parameter(..)
                | ValueDef::FragCoord(_)
        );
        if constant && let Some(&value) = self.known.get(&def) {
            return value;
        }
        let value = Value(self.defs.len() as u32);
        if let Some(origin) = self.origin
            && self.origins.last().is_none_or(|&(_, last)| last != origin)
        {
            self.origins.push((value.0, origin));
        }
        self.defs.push(def);
        if constant {
            self.known.insert(def, value);
        } else {
            self.block.push(Node::Let(value));
        }
        value
    }
}

/// A function that is being inlined.
#[derive(Debug)]
struct InlinedCall {
    scope: Scope,
    result: Cells,
    /// The call, for traces.
    call: Option<CallId>,
}

/// Builds the function of a tree.
struct Builder<'a> {
    tree: &'a Tree,
    /// How the textures of the channels are sampled.
    sampling: [Sampling; 4],
    /// Whether the alpha of the color is an output; else the alpha is 1.
    keeps_alpha: bool,
    /// The uniforms whose values are given for each run, with their numbers.
    parameters: HashMap<VariableId, u32>,
    deadline: &'a Deadline,
    options: BuildOptions,
    writer: RefCell<IrWriter>,
    locations: HashMap<VariableId, Location>,
    /// Variables declared in a `switch`, whose cells are allocated before it.
    shared: HashSet<VariableId>,
    cells: Vec<Kind>,
    scopes: u32,
    loops: Vec<Place>,
    call_stack: Vec<InlinedCall>,
    breaks: Vec<Scope>,
    continues: Vec<Scope>,
    sites: Vec<Site>,
    site_ids: HashMap<Site, SiteId>,
    /// Predicates of checks whose results have not been substituted yet.
    unresolved: Vec<(Predicate, [Value; 2])>,
    /// The flags of variables whose written components are tracked, by their first cells.
    written: BTreeMap<u32, WrittenFlags>,
    /// The parts of tracked variables that are bound to `out` parameters, the innermost last.
    out_parameters: Vec<(Cells, Place)>,
    /// The variables that are passed to `out` parameters, which makes them uninitialized.
    out_arguments: HashSet<VariableId>,
    schema: TraceSchema,
    /// The parts of the program, if they are counted.
    parts: Vec<Part>,
    /// The parts that are being written.
    open_parts: Vec<PartId>,
    /// The header events of the loops that are being written.
    loop_headers: Vec<EventId>,
    depth: usize,
    /// The cell that is set by `discard`.
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
        let color = Cells {
            first: self.cells.len() as u32,
            count: 4,
        };
        // The color is initially black, and opaque for an `inout` parameter, as in ShaderToy's own `main`; an
        // `out` parameter takes no value.
        let added_to = self.tree.adds_to_color(main_image);
        for value in [0.0, 0.0, 0.0, f64::from(u8::from(added_to))] {
            let cell = self.allocate(Kind::Float);
            let value = self.float(value);
            self.store(cell, value);
        }
        let body = self.inner(|builder| {
            builder.call_stack.push(InlinedCall {
                scope: all,
                result: Cells { first: 0, count: 0 },
                call: None,
            });
            builder.globals()?;
            builder.main_image(main_image, color)?;
            builder.call_stack.pop();
            Ok(())
        })?;
        self.push(Node::Scope { scope: all, body });
        let [r, g, b] = [0, 1, 2].map(|at| self.load(Cell(color.first + at)));
        let a = if self.keeps_alpha {
            self.load(Cell(color.first + 3))
        } else {
            self.float(1.0)
        };
        let discarded = self.load(discarded);
        self.writer.borrow_mut().output = [r, g, b, a, discarded];
        Ok(())
    }

    /// Declares the global variables, in order.
    fn globals(&mut self) -> Result<()> {
        let tree = self.tree;
        // `gl_FragDepth` starts as zero here, not where the code that uses it first happens to be.
        for (variable, _) in tree.variables.iter().filter(|(_, variable)| is_depth(variable)) {
            self.declare(variable)?;
        }
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

    /// Collects the nodes that `write` emits in a block of their own.
    fn inner(&mut self, write: impl FnOnce(&mut Self) -> Result<()>) -> Result<Block> {
        let outer = std::mem::take(&mut self.writer.borrow_mut().block);
        let written = self.deeper(write);
        let inner = std::mem::replace(&mut self.writer.borrow_mut().block, outer);
        written.map(|()| inner)
    }

    /// Runs `work` one nesting level deeper.
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
        self.writer.borrow_mut().block.push(node);
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

    /// Allocates cells for a variable of a type.
    fn allocate_type(&mut self, ty: Type) -> Result<Cells> {
        let scalars = self.tree.scalars(ty);
        if self.cells.len() + component_count(self.tree, ty) > MAX_CELLS {
            return Err(Refusal::TooLong);
        }
        let first = self.cells.len() as u32;
        self.cells
            .extend(scalars.iter().map(|&scalar| scalar_kind(scalar)));
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
        self.value(ValueDef::Load(cell))
    }

    fn load_all(&self, cells: Cells) -> Vec<Value> {
        (cells.first..cells.first + cells.count)
            .map(|cell| self.load(Cell(cell)))
            .collect()
    }

    fn value(&self, def: ValueDef) -> Value {
        self.writer.borrow_mut().push(def)
    }

    /// Fails if the program is too large or the deadline has passed.
    fn bounded(&self) -> Result<()> {
        if self.deadline.is_over() {
            self.deadline.check()?;
        }
        if self.writer.borrow().defs.len().max(self.schema.events.len()) > self.options.max_values {
            return Err(Refusal::TooLong);
        }
        Ok(())
    }

    fn float(&self, value: f64) -> Value {
        self.value(ValueDef::Float(value.to_bits()))
    }

    fn word(&self, value: u32) -> Value {
        self.value(ValueDef::Word(value))
    }

    /// Returns a `bool`: 0 or all bits.
    fn bool_value(&self, value: bool) -> Value {
        self.word(if value { u32::MAX } else { 0 })
    }

    fn unary(&self, operation: Operation, a: Value) -> Value {
        self.value(ValueDef::Operation(operation, [a, NONE, NONE]))
    }

    fn binary(&self, operation: Operation, a: Value, b: Value) -> Value {
        self.value(ValueDef::Operation(operation, [a, b, NONE]))
    }

    fn select(&self, condition: Value, yes: Value, no: Value, kind: Kind) -> Value {
        let operation = match kind {
            Kind::Float => Operation::Select,
            Kind::Word => Operation::SelectWord,
        };
        self.value(ValueDef::Operation(operation, [condition, yes, no]))
    }

    fn term(&self, value: Value) -> Term<'_> {
        Term::new(&self.writer, value)
    }

    fn terms(&self, values: &[Value]) -> Vec<Term<'_>> {
        values.iter().map(|&value| self.term(value)).collect()
    }

    /// Returns a zero for each component of a type.
    fn zeros(&self, ty: Type) -> Vec<Value> {
        let scalars = self.tree.scalars(ty);

        scalars
            .into_iter()
            .map(|scalar| match scalar_kind(scalar) {
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

fn is_depth(variable: &Variable) -> bool {
    variable.kind == VariableKind::BuiltIn(BuiltInVariable::FragDepth)
}
