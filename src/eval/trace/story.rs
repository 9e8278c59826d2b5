//! What one pixel does, step by step: every value that is stored, computed or decided on, in the order of the run.

use std::cell::{Cell, RefCell};

use toyproof_glsl::tree::{FunctionId, Place, Type};

use crate::batch::LANES;
use crate::number::Number;

/// Names an event of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct EventId(pub(crate) u32);

/// Names a call that was written out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CallId(pub(crate) u32);

/// Something in a program that a pixel may come to. A function that is called in two places has its events twice.
#[derive(Debug, Clone, Copy)]
pub struct Event {
    /// What happens.
    pub what: What,
    /// Where in the text.
    pub at: Place,
    /// The type of the value; `void` where there is none.
    pub ty: Type,
    /// The call that it happens in; none in `mainImage` and outside of functions.
    pub call: Option<CallId>,
    /// The event of the innermost loop around it: its [`What::Round`].
    pub round: Option<EventId>,
}

/// What happens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum What {
    /// A variable, or the part of one that stands there, takes the value.
    Stored(Place),
    /// A part of a statement has the value.
    Part,
    /// The condition of `if`, of a loop, of `?:`, or of `&&` and `||`.
    Branch,
    /// A round of a loop begins.
    Round,
    /// A function returns the value.
    Returned,
    /// A statement without a value runs: `break`, `discard`.
    Ran,
}

/// A function that is called.
#[derive(Debug, Clone, Copy)]
pub struct Call {
    /// Whose body.
    pub function: FunctionId,
    /// Where it is called.
    pub at: Place,
    /// The call around this one.
    pub parent: Option<CallId>,
}

/// All that may happen in a program, in the order in which it does: inside of a loop, in a round of it.
#[derive(Debug, Clone, Default)]
pub struct Plot {
    pub(crate) events: Vec<Event>,
    pub(crate) calls: Vec<Call>,
}

impl Plot {
    /// An event.
    #[must_use]
    pub fn event(&self, id: EventId) -> &Event {
        &self.events[id.0 as usize]
    }

    /// A call.
    #[must_use]
    pub fn call(&self, id: CallId) -> &Call {
        &self.calls[id.0 as usize]
    }

    /// The loops around an event, the outermost first, itself last if it is a round.
    #[must_use]
    pub fn rounds(&self, id: EventId) -> Vec<EventId> {
        let own = (self.event(id).what == What::Round).then_some(id);
        let mut rounds: Vec<EventId> = own.into_iter().collect();
        let mut next = self.event(id).round;
        while let Some(round) = next {
            rounds.push(round);
            next = self.event(round).round;
        }
        rounds.reverse();
        rounds
    }
}

/// One thing that happened.
#[derive(Debug, Clone, PartialEq)]
pub struct Happened {
    /// What.
    pub event: EventId,
    /// The components of its value, as numbers or as bits.
    pub values: Vec<Told>,
}

/// A component as it was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Told {
    /// A float; one in f32 is told exactly.
    Float(f64),
    /// An `int` or `uint`; of a `bool`, no bits or all.
    Word(u32),
}

/// What a pixel did.
#[derive(Debug, Clone, Default)]
pub struct Story {
    /// In order.
    pub happened: Vec<Happened>,
    /// What it is painted; none if it is discarded.
    pub colour: Option<[f64; 3]>,
    /// Whether it was so much that the rest was left out.
    pub is_cut: bool,
}

/// So many components are kept of a story.
const MAX_TOLD: usize = 1 << 21;

/// The first events of another story, whose values a pixel is made to take.
#[derive(Debug, Clone, Copy)]
pub struct Lead<'a> {
    /// The other story.
    pub story: &'a Story,
    /// So many of its events, or all.
    pub events: usize,
}

/// Takes down what happens in one lane of a batch.
#[derive(Debug)]
pub(crate) struct Scribe<'a> {
    chunk: usize,
    lane: usize,
    lead: &'a [Happened],
    story: RefCell<Story>,
    told: Cell<usize>,
}

impl<'a> Scribe<'a> {
    /// Of the pixel at a position of a batch.
    pub(crate) fn new(position: usize, lead: Option<Lead<'a>>) -> Self {
        Self {
            chunk: position / LANES,
            lane: position % LANES,
            lead: lead.map_or(&[], |lead| {
                let happened = &lead.story.happened;
                &happened[..lead.events.min(happened.len())]
            }),
            story: RefCell::default(),
            told: Cell::new(0),
        }
    }

    pub(crate) fn chunk(&self) -> usize {
        self.chunk
    }

    pub(crate) fn lane(&self) -> usize {
        self.lane
    }

    /// Takes down a component; the first of an event begins it. Tells the value that it should have instead.
    pub(crate) fn tell(&self, event: u32, component: u32, value: Told) -> Option<Told> {
        let mut story = self.story.borrow_mut();
        self.told.set(self.told.get() + 1);
        if self.told.get() > MAX_TOLD {
            story.is_cut = true;
            return None;
        }
        if component == 0 {
            story.happened.push(Happened {
                event: EventId(event),
                values: Vec::new(),
            });
        }
        let at = story.happened.len().checked_sub(1)?;
        let led = self.lead.get(at).filter(|led| led.event == EventId(event));
        let led = led.and_then(|led| led.values.get(component as usize).copied());
        story.happened[at].values.push(led.unwrap_or(value));
        led
    }

    /// Takes down an event without a value.
    pub(crate) fn mention(&self, event: u32) {
        let mut story = self.story.borrow_mut();
        self.told.set(self.told.get() + 1);
        if self.told.get() > MAX_TOLD {
            story.is_cut = true;
            return;
        }
        story.happened.push(Happened {
            event: EventId(event),
            values: Vec::new(),
        });
    }

    pub(crate) fn story(self) -> Story {
        self.story.into_inner()
    }
}

/// A number as it is told.
pub(crate) trait Tellable: Sized {
    fn told(self) -> Told;
    /// The same number, of the kind that this one is.
    fn from_told(told: Told) -> Option<Self>;
}

impl<N: Number> Tellable for N {
    fn told(self) -> Told {
        Told::Float(self.to_f64())
    }

    fn from_told(told: Told) -> Option<Self> {
        match told {
            Told::Float(value) => Some(N::from_f64(value)),
            Told::Word(_) => None,
        }
    }
}

impl Tellable for u32 {
    fn told(self) -> Told {
        Told::Word(self)
    }

    fn from_told(told: Told) -> Option<Self> {
        match told {
            Told::Word(word) => Some(word),
            Told::Float(_) => None,
        }
    }
}
