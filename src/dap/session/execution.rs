//! The execution: moving through the recording, and why it stops.

use std::io::{self, Write};

use serde_json::json;

use super::{Answer, Session, THREAD, budget, to_value};
use crate::protocol::reply::Stopped;
use crate::protocol::request::OfFrame;
use crate::recording::{Incident, Point, Recording};
use crate::stepping::StepKind;

/// How the execution moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Motion {
    /// To the first line, or to the first breakpoint.
    Begin,
    Continue,
    ReverseContinue,
    Next,
    Into,
    Out,
    Back,
    To(Point),
}

/// Where the execution stops, and why.
struct Arrival {
    point: Point,
    reason: &'static str,
    description: Option<String>,
    breakpoints: Vec<i64>,
    incidents: Vec<Incident>,
}

impl Arrival {
    fn new(point: Point, reason: &'static str) -> Self {
        Self {
            point,
            reason,
            description: None,
            breakpoints: Vec::new(),
            incidents: Vec::new(),
        }
    }
}

impl<W: Write> Session<'_, W> {
    /// Moves, and reports where the execution stops.
    pub(super) fn run(&mut self, motion: Motion) -> io::Result<()> {
        let Some(loaded) = &self.loaded else {
            return Ok(());
        };
        let (from, recording) = (loaded.at, std::rc::Rc::clone(&loaded.recording));
        let end = recording.end();
        let begins = motion == Motion::Begin;
        let is_forward = !matches!(motion, Motion::ReverseContinue | Motion::Back | Motion::To(_));
        if is_forward && !begins && from == end {
            return self.client.event("terminated", None);
        }
        // An incident of the line that is executed next is reported before it is passed.
        let is_reported = !loaded.incidents.is_empty();
        let hit = |first: usize, incidents: usize| self.next_hit(&recording, first, incidents);
        let arrival = match motion {
            Motion::Begin if loaded.stops_on_entry => Arrival::new(Point(0), "entry"),
            Motion::Begin => self.forward(&recording, hit(0, 0)),
            Motion::Continue => self.forward(&recording, hit(from.0 + 1, from.0 + usize::from(is_reported))),
            Motion::ReverseContinue => self.backward(&recording, self.previous_hit(&recording, from.0)),
            Motion::Next | Motion::Into | Motion::Out => {
                let target = step(&recording, from, motion);
                let before = hit(from.0 + 1, from.0 + usize::from(is_reported));
                match before.filter(|&stop| stop < target.point.0) {
                    Some(stop) => self.at_breakpoint(&recording, stop),
                    None => target,
                }
            }
            Motion::Back => {
                let target = step(&recording, from, motion);
                let after = self.previous_hit(&recording, from.0);
                match after.filter(|&stop| stop > target.point.0) {
                    Some(stop) => self.at_breakpoint(&recording, stop),
                    None => target,
                }
            }
            Motion::To(point) => Arrival::new(point, "restart"),
        };
        let passed = match motion {
            Motion::Begin => 0..arrival.point.0 + 1,
            Motion::Continue | Motion::Next | Motion::Into | Motion::Out => from.0 + 1..arrival.point.0 + 1,
            Motion::ReverseContinue | Motion::Back => arrival.point.0..from.0,
            Motion::To(_) => 0..0,
        };
        self.log(passed)?;
        self.arrive(arrival)
    }

    /// The first stop from `first` on with a breakpoint, or from `incidents` on with an incident.
    fn next_hit(&self, recording: &Recording, first: usize, incidents: usize) -> Option<usize> {
        let stopping = self
            .breakpoints
            .iter()
            .filter(|breakpoint| breakpoint.log.is_none());
        let next = stopping.filter_map(|breakpoint| {
            let after = breakpoint.stops.partition_point(|&stop| stop < first);
            breakpoint.stops.get(after).copied()
        });
        let mut incidents = recording.incidents(incidents..usize::MAX);
        let incident = incidents.find(|incident| self.filters.contains(&incident.kind));
        next.chain(incident.map(|incident| incident.stop)).min()
    }

    /// The last stop before one with a breakpoint or an incident.
    fn previous_hit(&self, recording: &Recording, before: usize) -> Option<usize> {
        let stopping = self
            .breakpoints
            .iter()
            .filter(|breakpoint| breakpoint.log.is_none());
        let last = stopping.filter_map(|breakpoint| {
            let at = breakpoint.stops.partition_point(|&stop| stop < before);
            at.checked_sub(1).map(|at| breakpoint.stops[at])
        });
        let mut incidents = recording.incidents(0..before);
        let incident = incidents.rfind(|incident| self.filters.contains(&incident.kind));
        last.chain(incident.map(|incident| incident.stop)).max()
    }

    /// To a breakpoint or incident, or to the end.
    fn forward(&self, recording: &Recording, hit: Option<usize>) -> Arrival {
        match hit {
            Some(stop) => self.at_breakpoint(recording, stop),
            None => Arrival {
                description: Some(if recording.is_cut {
                    "The recording ends here: the execution is too long".to_owned()
                } else {
                    "The color of the pixel is computed".to_owned()
                }),
                ..Arrival::new(recording.end(), "pause")
            },
        }
    }

    /// Back to a breakpoint or incident, or to the start.
    fn backward(&self, recording: &Recording, hit: Option<usize>) -> Arrival {
        match hit {
            Some(stop) => self.at_breakpoint(recording, stop),
            None => Arrival {
                description: Some("The start of the recording".to_owned()),
                ..Arrival::new(Point(0), "entry")
            },
        }
    }

    /// At a stop with breakpoints or incidents.
    fn at_breakpoint(&self, recording: &Recording, stop: usize) -> Arrival {
        let held = self
            .breakpoints
            .iter()
            .filter(|breakpoint| breakpoint.log.is_none() && breakpoint.stops.binary_search(&stop).is_ok());
        let breakpoints: Vec<i64> = held.map(|breakpoint| breakpoint.id).collect();
        let incidents = recording.incidents(stop..stop + 1);
        let incidents = incidents.filter(|incident| self.filters.contains(&incident.kind));
        let incidents: Vec<Incident> = incidents.cloned().collect();
        let mut arrival = Arrival::new(Point(stop), "breakpoint");
        if let Some(first) = incidents.first() {
            arrival.reason = "exception";
            arrival.description = Some(format!("{}: {}", first.kind.label(), first.text));
        }
        Arrival {
            breakpoints,
            incidents,
            ..arrival
        }
    }

    /// Shows the messages of log points.
    fn log(&mut self, passed: std::ops::Range<usize>) -> io::Result<()> {
        let Some(loaded) = &self.loaded else {
            return Ok(());
        };
        let mut messages = Vec::new();
        let mut has_more = false;
        for breakpoint in &self.breakpoints {
            let Some(log) = &breakpoint.log else { continue };
            let stops = breakpoint.stops.iter().copied();
            let stops: Vec<usize> = stops.filter(|stop| passed.contains(stop)).collect();
            let budget = budget(&loaded.subject, &self.control);
            let (texts, more) = log.texts(loaded.context(), &stops, budget);
            has_more |= more;
            messages.extend(texts);
        }
        messages.sort_by_key(|&(stop, _)| stop);
        let places: Vec<_> = messages
            .into_iter()
            .map(|(stop, text)| {
                let line = loaded.recording.stops()[stop].line;
                (loaded.sources.source(line.file), line.line, text)
            })
            .collect();
        for (source, line, text) in places {
            self.client
                .output_at("console", text + "\n", Some((source, line)))?;
        }
        if has_more {
            let text = "further messages of a log point are left out\n".to_owned();
            self.client.output("console", text)?;
        }
        Ok(())
    }

    fn arrive(&mut self, arrival: Arrival) -> io::Result<()> {
        let Some(loaded) = &mut self.loaded else {
            return Ok(());
        };
        loaded.at = arrival.point;
        loaded.handles.clear();
        let texts: Vec<_> = arrival
            .incidents
            .iter()
            .map(|incident| incident.text.clone())
            .collect();
        loaded.incidents = arrival.incidents;
        let body = Stopped {
            reason: arrival.reason,
            description: arrival.description,
            thread_id: THREAD,
            text: (!texts.is_empty()).then(|| texts.join("; ")),
            is_whole_program: true,
            hit_breakpoint_ids: arrival.breakpoints,
        };
        self.client.event("stopped", Some(to_value(&body)))
    }

    /// The first stop of the function of a frame.
    pub(super) fn frame_start(&self, arguments: &OfFrame) -> Result<Point, String> {
        let loaded = self.loaded()?;
        let frame = self.frame(Some(arguments.frame_id))?;
        let mut stops = loaded.recording.stops().iter();
        let first = stops.position(|stop| stop.invocation == frame.invocation);
        first
            .map(Point)
            .ok_or_else(|| "the function has no line".to_owned())
    }

    pub(super) fn exception_info(&self) -> Answer {
        let loaded = self.loaded()?;
        let Some(first) = loaded.incidents.first() else {
            return Err("the execution has not stopped at an exception".to_owned());
        };
        let texts: Vec<_> = loaded.incidents.iter().map(|incident| &*incident.text).collect();
        Ok(Some(json!({
            "exceptionId": first.kind.label(),
            "description": texts.join("\n"),
            "breakMode": "always",
        })))
    }
}

fn step(recording: &Recording, from: Point, motion: Motion) -> Arrival {
    let kind = match motion {
        Motion::Into => StepKind::Into,
        Motion::Out => StepKind::Out,
        Motion::Back => StepKind::Back,
        _ => StepKind::Next,
    };
    match recording.step(from, kind) {
        Some(point) if point == recording.end() && point != from => Arrival {
            description: Some("The end of the recording".to_owned()),
            ..Arrival::new(point, "step")
        },
        Some(point) => Arrival::new(point, "step"),
        None => Arrival {
            description: Some("The start of the recording".to_owned()),
            ..Arrival::new(Point(0), "step")
        },
    }
}
