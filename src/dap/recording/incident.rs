//! What happens in an execution that a user may want to stop at.

use std::collections::{HashMap, HashSet};

use toyproof_eval::{CallId, Event, EventKind, TraceSchema, TraceValue};
use toyproof_glsl::tree::{Place, VariableId};
use toyproof_verify::debug::{BOUND, Step, diverges};

/// The kind of an incident: the filters of exceptions that a client offers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum IncidentKind {
    /// A NaN or an infinity appears in f32, from finite values.
    NotFinite,
    /// f32 and f64 diverge: by more than [`BOUND`], or by a branch.
    Divergence,
    /// The divergence that causes a visible difference of the colors.
    VisibleCause,
    /// An operation has an undefined result, or reads an uninitialized variable.
    Undefined,
}

impl IncidentKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [
        Self::NotFinite,
        Self::Divergence,
        Self::VisibleCause,
        Self::Undefined,
    ];

    /// The name in the protocol.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::NotFinite => "not-finite",
            Self::Divergence => "divergence",
            Self::VisibleCause => "visible-cause",
            Self::Undefined => "undefined",
        }
    }

    /// The name that a client shows.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::NotFinite => "NaN or infinity appears",
            Self::Divergence => "float32 and double precision diverge",
            Self::VisibleCause => "Loss of precision changes the color visibly",
            Self::Undefined => "Undefined behavior",
        }
    }

    /// What it means.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::NotFinite => "Stops where a NaN or an infinity arises from finite values",
            Self::Divergence => {
                "Stops where a value in float32 and in double precision differs by more than 0.1 %, or a branch, \
                 although what it is computed from does not"
            }
            Self::VisibleCause => {
                "Stops at the divergence without which float32 and double precision would have the same color"
            }
            Self::Undefined => {
                "Stops at operations with undefined results and at reads of uninitialized variables"
            }
        }
    }
}

/// Something that happens between a stop and the next one.
#[derive(Debug, Clone)]
pub struct Incident {
    /// The kind.
    pub kind: IncidentKind,
    /// The number of the stop.
    pub(crate) stop: usize,
    /// A sentence, with the values.
    pub text: String,
}

/// Finds where faulty values arise: a step that reads no faulty variable has one.
pub(super) struct FaultyValues<'a> {
    schema: &'a TraceSchema,
    /// What each statement reads.
    named: &'a HashMap<Place, Vec<VariableId>>,
    /// The cells that are not finite, and those that diverge.
    faulty: [HashSet<u32>; 2],
}

/// Both kinds of faulty values, in the order of [`FaultyValues::faulty`].
pub(super) const KINDS: [IncidentKind; 2] = [IncidentKind::NotFinite, IncidentKind::Divergence];

impl<'a> FaultyValues<'a> {
    pub(super) fn new(schema: &'a TraceSchema, named: &'a HashMap<Place, Vec<VariableId>>) -> Self {
        Self {
            schema,
            named,
            faulty: Default::default(),
        }
    }

    /// Notes that a cell has a new value, and whether it is not finite, and diverges.
    pub(super) fn write(&mut self, cell: u32, faults: [bool; 2]) {
        for (faulty, is_faulty) in self.faulty.iter_mut().zip(faults) {
            if is_faulty {
                faulty.insert(cell);
            } else {
                faulty.remove(&cell);
            }
        }
    }

    /// Whether the value of a step is not finite in f32, and whether it diverges.
    pub(super) fn of(&self, event: &Event, step: &Step) -> [bool; 2] {
        if matches!(event.kind, EventKind::Store(_)) {
            return [false; 2];
        }
        [
            step.single.iter().flatten().any(is_not_finite),
            step.single.is_some() && step.double.is_some() && diverges(self.schema, step, false),
        ]
    }

    /// Whether a statement of a call reads a variable that has a faulty value of a kind.
    pub(super) fn reads_faulty(&self, kind: usize, call: Option<CallId>, at: Option<Place>) -> bool {
        let faulty = &self.faulty[kind];
        let variables = at.and_then(|at| self.named.get(&at)).into_iter().flatten();
        !faulty.is_empty()
            && variables.into_iter().any(|&variable| {
                let own = self.schema.cells(call, variable);
                let cells = own.or_else(|| self.schema.cells(None, variable));
                cells.is_some_and(|mut cells| cells.any(|cell| faulty.contains(&cell)))
            })
    }
}

/// Whether a value is NaN or infinite.
pub(super) fn is_not_finite(value: &TraceValue) -> bool {
    matches!(value, TraceValue::Float(value) if !value.is_finite())
}

/// Whether f32 and f64 differ by more than [`BOUND`], relative to the largest component of the two.
pub(crate) fn differs(single: &[TraceValue], double: &[TraceValue]) -> bool {
    let (mut scale, mut most) = (0.0_f64, 0.0_f64);
    for pair in single.iter().zip(double) {
        match pair {
            (TraceValue::Float(single), TraceValue::Float(double)) => {
                scale = scale.max(single.abs()).max(double.abs());
                if single == double || single.is_nan() && double.is_nan() {
                    continue;
                }
                let difference = (single - double).abs();
                most = most.max(if difference.is_finite() {
                    difference
                } else {
                    f64::INFINITY
                });
            }
            (single, double) if single != double => return true,
            _ => {}
        }
    }
    // What f32 flushes to zero hardly ever matters.
    most == f64::INFINITY || most > BOUND * scale && scale > f64::from(f32::MIN_POSITIVE)
}
