//! An interpreter of the typed tree, as an oracle for the evaluator: it walks the tree for one pixel at a time,
//! without any optimization, and shares no code with `toyproof_eval` except the functions of `toyproof_math`.
//!
//! It computes in f32 with the rules of strict shaders, or in f64. What GLSL leaves undefined has the result that the
//! documentation of [`Fault`] and [`UndefinedPolicy`] states. Of a derivative, all four pixels of the quad are run up
//! to it, again and again: each run knows one more of them.
//!
//! [`Outcome::Skipped`] states why a pixel has no result: a derivative that not all pixels of the quad reach, more
//! steps than allowed, or the bits of NaN, which no rule determines.

mod builtin;
mod compare;
mod expression;
mod operator;
mod real;
mod statement;
mod texture;
mod value;

use std::collections::{BTreeSet, HashMap};

use toyproof::eval::{Fault, Substitute, UndefinedPolicy};
use toyproof::glsl::tree::{ExprId, Input, Item, Place, Tree, Type, VariableId, VariableKind};
use toyproof::glsl::{Checked, Stage};
use toyproof::image::Frame;

pub use self::compare::{Comparison, POLICIES, Tally};
pub use self::real::{Real, Single};
pub use self::value::Component;
use self::value::{Value, zero};

/// What became of a pixel.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome<N> {
    /// Its color.
    Color([N; 4]),
    /// The shader discarded it.
    Discarded,
    /// It is out of scope, for this reason.
    Skipped(&'static str),
}

/// A shader in a frame, to be run pixel by pixel.
#[derive(Debug, Clone, Copy)]
pub struct Interpreter<'a> {
    /// The shader.
    pub checked: &'a Checked,
    /// The inputs.
    pub frame: &'a Frame,
    /// What undefined operations give.
    pub undefined: UndefinedPolicy,
    /// The maximum number of expressions and statements of one run of a pixel.
    pub max_steps: u64,
}

/// The maximum number of derivatives that a pixel takes one after the other: each costs another run.
const MAX_DERIVATIVES: usize = 256;

/// The maximum number of steps of all runs for a pixel, in multiples of [`Interpreter::max_steps`].
const MAX_FULL_RUNS: u64 = 4;

/// The stack on which the tree is walked, in bytes: a sum of thousands of terms is as deep.
pub const STACK_BYTES: usize = 512 << 20;

impl Interpreter<'_> {
    /// Runs a pixel, and the rest of its quad as far as derivatives need it. Also returns the pixel's operations that
    /// GLSL leaves undefined, except quotients of zeros. The caller provides a stack of [`STACK_BYTES`].
    #[must_use]
    pub fn pixel<N: Real>(&self, [x, y]: [u32; 2]) -> (Outcome<N>, Faults) {
        let mut exchanged: Vec<Exchange<N>> = Vec::new();
        let mut steps = 0;
        loop {
            let (reached, faults) = self.run(&exchanged, [x, y], &mut steps);
            let reached = match reached {
                Ok(color) => return (Outcome::Color(color), faults),
                Err(Stop::Discarded) => return (Outcome::Discarded, faults),
                Err(Stop::Skipped(reason)) => return (Outcome::Skipped(reason), faults),
                Err(Stop::Derivative(reached)) => reached,
            };
            if exchanged.len() == MAX_DERIVATIVES || steps > MAX_FULL_RUNS * self.max_steps {
                return (Outcome::Skipped("too many derivatives"), faults);
            }
            let mut quad = [reached.operand; 4];
            for (at, operand) in quad.iter_mut().enumerate() {
                let pixel = [x & !1 | at as u32 & 1, y & !1 | at as u32 >> 1];
                match self.run(&exchanged, pixel, &mut steps).0 {
                    Err(Stop::Derivative(other))
                        if other.path == reached.path && other.expr == reached.expr =>
                    {
                        *operand = other.operand;
                    }
                    _ => {
                        return (
                            Outcome::Skipped("a derivative in non-uniform control flow"),
                            faults,
                        );
                    }
                }
            }
            exchanged.push(Exchange(quad));
        }
    }

    /// Runs a pixel up to its end, or up to the first derivative that is not known yet. Adds its steps to `steps`.
    fn run<N: Real>(
        &self,
        exchanged: &[Exchange<N>],
        pixel: [u32; 2],
        steps: &mut u64,
    ) -> (Result<[N; 4], N>, Faults) {
        let mut run = Run {
            tree: &self.checked.tree,
            interpreter: self,
            pixel,
            variables: HashMap::new(),
            samplers: HashMap::new(),
            exchanged,
            derivatives: 0,
            path: Vec::new(),
            faults: BTreeSet::new(),
            is_undefined: false,
            steps: 0,
        };
        let result = run.main();
        *steps += run.steps;
        (result, run.faults)
    }
}

/// Operations that GLSL leaves undefined: each kind with its place, see `site`.
pub type Faults = BTreeSet<(Fault, [u32; 4])>;

/// A place as numbers that can be ordered.
fn site(at: Place) -> [u32; 4] {
    [at.span.start, at.span.end, at.spelling.start, at.spelling.end]
}

/// The operand of a derivative in the four pixels of a quad: left and right of the lower row, then of the upper.
#[derive(Debug, Clone, Copy)]
struct Exchange<N>([N; 4]);

/// A derivative that a pixel has reached.
#[derive(Debug)]
struct Reached<N> {
    operand: N,
    expr: ExprId,
    /// The calls and iterations in which it is.
    path: Vec<u32>,
}

/// Why a run ends early.
#[derive(Debug)]
enum Stop<N> {
    Discarded,
    Derivative(Reached<N>),
    Skipped(&'static str),
}

type Result<T, N> = std::result::Result<T, Stop<N>>;

/// The state of one pixel.
struct Run<'a, N> {
    tree: &'a Tree,
    interpreter: &'a Interpreter<'a>,
    pixel: [u32; 2],
    /// Functions are not recursive, so each variable exists once.
    variables: HashMap<VariableId, Value<N>>,
    /// The channels that parameters of sampler types stand for; none for a sampler that nothing is bound to.
    samplers: HashMap<VariableId, Option<u8>>,
    exchanged: &'a [Exchange<N>],
    /// The number of derivatives taken.
    derivatives: usize,
    path: Vec<u32>,
    faults: Faults,
    /// Whether the result of the current operation is to be substituted.
    is_undefined: bool,
    steps: u64,
}

impl<N: Real> Run<'_, N> {
    fn main(&mut self) -> Result<[N; 4], N> {
        let tree = self.tree;
        for item in &tree.items {
            if let Item::Variable(variable) = *item
                && matches!(
                    tree[variable].kind,
                    VariableKind::Global | VariableKind::Const | VariableKind::Output
                )
            {
                self.declare(variable)?;
            }
        }
        let main = self.interpreter.checked.main_image;
        let [color, position] = tree[main].parameters[..] else {
            return Err(Stop::Skipped("an entry point with other parameters"));
        };
        // An `inout` color is opaque black, as in ShaderToy's own `main`.
        let alpha = if tree.adds_to_color(main) { 1.0 } else { 0.0 };
        self.variables
            .insert(color, [0.0, 0.0, 0.0, alpha].map(Component::float).to_vec());
        let mut at = self.frag_coord();
        at.truncate(value::size(tree, tree[position].ty));
        self.variables.insert(position, at);
        self.body(main)?;
        let mut rgba = [0, 1, 2, 3].map(|at| self.variables[&color][at].real());
        if self.interpreter.checked.stage == Stage::Image {
            rgba[3] = N::from_f64(1.0);
        }
        Ok(rgba)
    }

    /// `gl_FragCoord`: the center of the pixel, z = 0 and w = 1.
    fn frag_coord(&self) -> Value<N> {
        let [x, y] = self.pixel.map(|at| f64::from(at) + 0.5);
        [x, y, 0.0, 1.0].map(Component::float).to_vec()
    }

    /// The value of a uniform of ShaderToy.
    fn input(&self, input: Input, ty: Type) -> Value<N> {
        let frame = self.interpreter.frame;
        let resolution = |channel: usize| match &frame.channels[channel] {
            Some(texture) => texture.resolution().map(|side| side as f32),
            None => [0.0; 3],
        };
        let numbers = match input {
            Input::Resolution => vec![frame.size[0] as f32, frame.size[1] as f32, 1.0],
            Input::Time => vec![frame.time],
            Input::TimeDelta => vec![frame.time_delta],
            Input::FrameRate => vec![frame.frame_rate],
            Input::Frame => return vec![Component::Int(frame.frame)],
            Input::ChannelResolution => [0, 1, 2, 3].map(resolution).concat(),
            Input::Mouse => frame.mouse.to_vec(),
            Input::Date => frame.date.to_vec(),
            Input::SampleRate => vec![toyproof::image::SAMPLE_RATE],
            Input::ChannelTime => return zero(self.tree, ty),
        };
        let flushed = numbers.into_iter().map(toyproof::math::native::flush);
        flushed.map(|number| Component::float(number.into())).collect()
    }

    /// Counts a step.
    fn step(&mut self) -> Result<(), N> {
        self.steps += 1;
        if self.steps > self.interpreter.max_steps {
            return Err(Stop::Skipped("too many steps"));
        }
        Ok(())
    }

    /// Records a fault, if there is one; [`Self::settle`] then substitutes the result.
    fn fault(&mut self, fault: Fault, expr: ExprId, occurs: bool) {
        if occurs && fault.is_undefined() {
            self.faults.insert((fault, site(self.tree[expr].at)));
            self.is_undefined = true;
        }
    }

    /// The result of an operation, or its substitute if the operation is undefined.
    fn settle(&mut self, result: Component<N>) -> Component<N> {
        let is_undefined = std::mem::take(&mut self.is_undefined);
        let UndefinedPolicy::Substitute(substitute) = self.interpreter.undefined else {
            return result;
        };
        match result {
            result if !is_undefined => result,
            Component::Float(_) => Component::float(match substitute {
                Substitute::Number => 0.5,
                Substitute::NotANumber => f64::NAN,
                Substitute::OtherImplementation => 0.0,
            }),
            Component::Int(_) => Component::Int(0),
            Component::Uint(_) => Component::Uint(0),
            Component::Bool(_) => Component::Bool(false),
        }
    }

    /// The difference of a number between the pixels of the quad along an axis: 1 for x, 2 for y. It is that of the
    /// pixel's own row or column.
    fn derivative(&mut self, operand: N, axis: usize, expr: ExprId) -> Result<N, N> {
        let own = (self.pixel[0] & 1 | (self.pixel[1] & 1) << 1) as usize;
        let Some(Exchange(quad)) = self.exchanged.get(self.derivatives) else {
            return Err(Stop::Derivative(Reached {
                operand,
                expr,
                path: self.path.clone(),
            }));
        };
        self.derivatives += 1;
        Ok(quad[own | axis] - quad[own & !axis])
    }
}
