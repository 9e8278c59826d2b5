//! Makes the recording from the steps of a traced pixel.

use std::collections::HashMap;

use toyproof_eval::{CallId, EventId, EventKind, Fault, TraceSchema, TraceValue};
use toyproof_glsl::tree::Place;
use toyproof_verify::debug::{Explanation, Step};

use super::incident::{FaultyValues, KINDS, differs, is_not_finite};
use super::{Caller, History, Incident, IncidentKind, Invocation, Line, Recording, Stop};
use crate::code::named_variables;
use crate::subject::Subject;
use crate::value;

/// The largest number of incidents that are kept.
const MAX_INCIDENTS: usize = 10_000;

/// A function that is being executed.
struct Active {
    invocation: u32,
    call: Option<CallId>,
    /// The statement or condition that is being executed, and its line.
    step: Option<(Place, Line)>,
    /// Whether f32 executes it, too.
    is_single: bool,
    /// Whether the current statement has faulty values already, of each of [`KINDS`].
    is_faulty: [bool; 2],
}

pub(super) fn build(subject: &Subject, explanation: &Explanation<'_>) -> Recording {
    let named = named_variables(&subject.checked.tree);
    let schema = explanation.schema;
    let mut builder = Builder {
        subject,
        schema,
        is_entry_generated: is_entry_generated(subject),
        faulty_values: FaultyValues::new(schema, &named),
        stops: Vec::new(),
        invocations: Vec::new(),
        active: Vec::new(),
        has_returned: false,
        history: Default::default(),
        incidents: Vec::new(),
        lines: HashMap::new(),
    };
    let mut faults = explanation.faults.iter().peekable();
    for (at, step) in explanation.steps.iter().enumerate() {
        while let Some((_, site)) = faults.next_if(|(before, _)| *before <= at) {
            builder.undefined(site.fault, site.at);
        }
        builder.step(at as u32, step);
        if explanation.cause == Some(at) {
            let text = builder.compared(step);
            let text = format!("{text}: this difference changes the color visibly");
            builder.add_incident(IncidentKind::VisibleCause, text);
        }
    }
    for (_, site) in faults {
        builder.undefined(site.fault, site.at);
    }
    let mut invocations = builder.invocations.iter();
    let root = invocations
        .rposition(|invocation| invocation.caller.is_none() && !builder.is_hidden(invocation.call));
    Recording {
        root: root.map(|root| root as u32),
        stops: builder.stops,
        invocations: builder.invocations,
        history: builder.history,
        events: explanation.steps.len() as u32,
        incidents: builder.incidents,
        colors: [explanation.single, explanation.double],
        is_cut: explanation.is_cut,
        schema: schema.clone(),
    }
}

/// Whether `mainImage` is not in the text.
fn is_entry_generated(subject: &Subject) -> bool {
    let entry = &subject.checked.tree[subject.checked.main_image];
    subject.files.text(entry.at.spelling) != entry.name
}

struct Builder<'a> {
    subject: &'a Subject,
    schema: &'a TraceSchema,
    /// Whether `mainImage` is not in the text: the host calls another function, such as `main`.
    is_entry_generated: bool,
    faulty_values: FaultyValues<'a>,
    stops: Vec<Stop>,
    invocations: Vec<Invocation>,
    /// The functions that are being executed, outermost first.
    active: Vec<Active>,
    /// Whether a call has returned since the last event of f32.
    has_returned: bool,
    history: [History; 2],
    incidents: Vec<Incident>,
    /// The lines of the events of the kind [`EventKind::Step`].
    lines: HashMap<EventId, Line>,
}

impl Builder<'_> {
    fn step(&mut self, at: u32, step: &Step) {
        let event = self.schema.event(step.event);
        if event.kind == EventKind::Entry {
            self.enter(at, event.call, step.single.is_some());
            return;
        }
        self.leave_to(event.call);
        if let EventKind::Store(id) = event.kind {
            self.store(at, step, id);
            return;
        }
        if step.single.is_none() {
            return;
        }
        if event.kind == EventKind::Step {
            self.begin_step(at, step.event, event.at);
        }
        if std::mem::take(&mut self.has_returned) {
            self.go_on(at);
        }
        self.find_faults(step);
    }

    /// Whether a function is not in the text, and so is not displayed.
    fn is_hidden(&self, call: Option<CallId>) -> bool {
        self.is_entry_generated && call.is_none()
    }

    /// Begins to execute a function.
    fn enter(&mut self, at: u32, call: Option<CallId>, is_single: bool) {
        let parent = call.and_then(|call| self.schema.call(call).parent);
        match call {
            Some(_) => self.leave_to(parent),
            // What initializes global variables has ended.
            None => self.active.clear(),
        }
        if is_single && std::mem::take(&mut self.has_returned) {
            self.go_on(at);
        }
        let caller = call.and_then(|call| {
            let caller = self.active.last().filter(|active| !self.is_hidden(active.call))?;
            Some(Caller {
                invocation: caller.invocation,
                at: self.schema.call(call).at,
                step: caller.step.map(|(at, _)| at),
            })
        });
        let function = call.map_or(self.subject.checked.main_image, |call| {
            self.schema.call(call).function
        });
        let depth = caller.map_or(0, |caller| self.invocations[caller.invocation as usize].depth + 1);
        self.active.push(Active {
            invocation: self.invocations.len() as u32,
            call,
            step: None,
            is_single,
            is_faulty: [false; 2],
        });
        self.invocations.push(Invocation {
            call,
            function,
            depth,
            caller,
        });
    }

    /// Ends all functions that a call does not run in.
    fn leave_to(&mut self, call: Option<CallId>) {
        while let Some(active) = self.active.pop_if(|active| active.call != call) {
            self.has_returned |= active.is_single;
        }
    }

    /// A statement or condition begins: a stop, if it is on another line, or before the last one, as in the
    /// next iteration of a loop.
    fn begin_step(&mut self, at: u32, event: EventId, place: Place) {
        let files = &self.subject.files;
        let line = *self.lines.entry(event).or_insert_with(|| Line::of(files, place));
        let is_hidden = self.is_hidden(self.active.last().and_then(|active| active.call));
        let Some(active) = self.active.last_mut() else {
            return;
        };
        let order = |at: Place| (at.span.start, at.spelling.start);
        let is_new = !is_hidden
            && active
                .step
                .is_none_or(|(last, last_line)| last_line != line || order(place) <= order(last));
        active.step = Some((place, line));
        active.is_faulty = [false; 2];
        if is_new {
            self.has_returned = false;
            self.stops.push(Stop {
                at,
                invocation: active.invocation,
                place,
                line,
                is_return: false,
            });
        }
    }

    /// The execution goes on after a call, inside of a line.
    fn go_on(&mut self, at: u32) {
        if let Some(active) = self.active.last()
            && !self.is_hidden(active.call)
            && let Some((place, line)) = active.step
        {
            self.stops.push(Stop {
                at,
                invocation: active.invocation,
                place,
                line,
                is_return: true,
            });
        }
    }

    fn store(&mut self, at: u32, step: &Step, id: toyproof_eval::StoreId) {
        let store = self.schema.store(id);
        let mut written: [Vec<(u32, TraceValue)>; 2] = Default::default();
        let sides = [&step.single, &step.double];
        for ((history, values), written) in self.history.iter_mut().zip(sides).zip(&mut written) {
            if let Some(values) = values {
                history.write(at, store, values, |cell, value| written.push((cell, value)));
            }
        }
        let values = written
            .each_ref()
            .map(|written| -> Vec<TraceValue> { written.iter().map(|&(_, value)| value).collect() });
        let [single, double] = &written;
        let is_same_place =
            single.len() == double.len() && single.iter().zip(double).all(|(a, b)| a.0 == b.0);
        let diverges = !is_same_place || differs(&values[0], &values[1]);
        for (cell, value) in single {
            self.faulty_values.write(*cell, [is_not_finite(value), diverges]);
        }
        if !is_same_place {
            for (cell, _) in double {
                self.faulty_values.write(*cell, [false, true]);
            }
        }
    }

    /// Reports faulty values that arise in this step.
    fn find_faults(&mut self, step: &Step) {
        let event = self.schema.event(step.event);
        let faults = self.faulty_values.of(event, step);
        for (kind, is_faulty) in faults.into_iter().enumerate() {
            let Some(active) = self.active.last() else {
                return;
            };
            if !is_faulty || active.is_faulty[kind] {
                continue;
            }
            let at = active.step.map(|(at, _)| at);
            let is_passed_on = self.faulty_values.reads_faulty(kind, active.call, at);
            // The statements of the callers get the value from here.
            for active in &mut self.active {
                active.is_faulty[kind] = true;
            }
            if !is_passed_on {
                let text = match KINDS[kind] {
                    IncidentKind::NotFinite => self.single(step),
                    _ => self.compared(step),
                };
                self.add_incident(KINDS[kind], text);
            }
        }
    }

    /// The source text of a step, in quotes.
    fn quoted(&self, step: &Step) -> String {
        let event = self.schema.event(step.event);
        let at = match event.kind {
            EventKind::Assignment(target) => target,
            _ => event.at,
        };
        format!("`{}`", value::one_line(self.subject.files.text(at.span)))
    }

    /// The value of a step in f32.
    fn single(&self, step: &Step) -> String {
        let event = self.schema.event(step.event);
        let tree = &self.subject.checked.tree;
        let single = step.single.as_deref().unwrap_or_default();
        let value = value::text(tree, event.ty, single, value::Precision::Single);
        format!("{} is {value}", self.quoted(step))
    }

    /// The value of a step in f32 and in f64.
    fn compared(&self, step: &Step) -> String {
        let event = self.schema.event(step.event);
        let tree = &self.subject.checked.tree;
        match (&step.single, &step.double) {
            (Some(_), Some(double)) => {
                let double = value::text(tree, event.ty, double, value::Precision::Double);
                format!("{} in f32 and {double} in f64", self.single(step))
            }
            (None, _) => format!("only f64 reaches {}", self.quoted(step)),
            (_, None) => format!("only f32 reaches {}", self.quoted(step)),
        }
    }

    fn undefined(&mut self, fault: Fault, at: Place) {
        if fault.is_undefined() || fault == Fault::NeverWritten {
            let text = value::one_line(self.subject.files.text(at.span));
            let text = format!("{}: `{text}`", fault.description());
            self.add_incident(IncidentKind::Undefined, text);
        }
    }

    fn add_incident(&mut self, kind: IncidentKind, text: String) {
        if self.incidents.len() < MAX_INCIDENTS {
            self.incidents.push(Incident {
                kind,
                stop: self.stops.len().saturating_sub(1),
                text,
            });
        }
    }
}
