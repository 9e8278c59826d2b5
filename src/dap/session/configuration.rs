//! Requests before the execution begins: `launch`, and those that set breakpoints.

use std::io::{self, Write};
use std::rc::Rc;
use std::time::Instant;

use serde_json::{Map, Value, json};
use toyproof_eval::Failure;

use super::inspection::Handles;
use super::{Answer, LaunchError, Loaded, Session, budget, to_value};
use crate::breakpoints::{Breakpoint, Resolution, Spec};
use crate::protocol::reply::{self, Capabilities, ExceptionFilter};
use crate::protocol::request::{
    BreakpointLocations, Restart, SetBreakpoints, SetDataBreakpoints, SetExceptionBreakpoints,
    SetFunctionBreakpoints,
};
use crate::recording::{IncidentKind, Point, Recording};
use crate::sources::Sources;

/// What the debug adapter can do.
pub(super) fn capabilities() -> Capabilities {
    let filters = IncidentKind::ALL.into_iter().map(|kind| ExceptionFilter {
        filter: kind.id(),
        label: kind.label(),
        description: kind.description(),
        default: false,
    });
    Capabilities {
        supports_configuration_done_request: true,
        supports_function_breakpoints: true,
        supports_conditional_breakpoints: true,
        supports_hit_conditional_breakpoints: true,
        supports_log_points: true,
        supports_data_breakpoints: true,
        supports_evaluate_for_hovers: true,
        supports_step_back: true,
        supports_restart_frame: true,
        supports_restart_request: true,
        supports_terminate_request: true,
        supports_cancel_request: true,
        supports_loaded_sources_request: true,
        supports_breakpoint_locations_request: true,
        supports_exception_info_request: true,
        supports_clipboard_context: true,
        exception_breakpoint_filters: filters.collect(),
    }
}

impl<W: Write> Session<'_, W> {
    pub(super) fn launch(&mut self, arguments: Map<String, Value>) -> io::Result<Answer> {
        match self.load(&arguments) {
            Ok((loaded, notes)) => {
                for note in notes {
                    self.client.output("console", with_line_end(note))?;
                }
                self.loaded = Some(loaded);
                self.arguments = Some(arguments);
                Ok(Ok(None))
            }
            Err(LaunchError { message, details }) => {
                for detail in details {
                    self.client.output("stderr", with_line_end(detail))?;
                }
                Ok(Err(message))
            }
        }
    }

    /// Reads the shader and records its pixel. Returns messages for the user, too.
    fn load(&mut self, arguments: &Map<String, Value>) -> Result<(Loaded, Vec<String>), LaunchError> {
        let mut launch = self.launcher.launch(arguments)?;
        let subject = Rc::new(launch.subject);
        let deadline = Instant::now() + subject.timeout;
        let recording = Recording::new(&subject, deadline, &self.control.interrupt);
        let recording = recording.map_err(|failure| {
            let message = match failure {
                Failure::Interrupted => "canceled".to_owned(),
                failure => format!("{}: {failure}", subject.name),
            };
            LaunchError {
                details: vec![message.clone()],
                message,
            }
        })?;
        if recording.is_cut {
            launch.notes.push(format!(
                "{}: the execution of the pixel is too long to be recorded; its first {} stops are",
                subject.name,
                recording.len()
            ));
        }
        let loaded = Loaded {
            sources: Sources::new(&subject.files, &subject.checked.tree),
            subject,
            recording: Rc::new(recording),
            stops_on_entry: launch.stops_on_entry,
            at: Point(0),
            incidents: Vec::new(),
            handles: Handles::default(),
        };
        Ok((loaded, launch.notes))
    }

    /// Reads the shader again, and sets the breakpoints in it.
    pub(super) fn restart(&mut self, arguments: Restart) -> io::Result<Answer> {
        let Some(arguments) = arguments.arguments.or_else(|| self.arguments.clone()) else {
            return Ok(self.loaded().map(|_| None));
        };
        let answer = self.launch(arguments)?;
        if answer.is_ok() {
            // The cells of variables may be others now.
            self.breakpoints
                .retain(|breakpoint| !matches!(breakpoint.spec, Spec::Data(_)));
            for breakpoint in std::mem::take(&mut self.breakpoints) {
                if let Ok(described) = self.add_breakpoint(breakpoint.id, breakpoint.spec) {
                    let body = json!({"reason": "changed", "breakpoint": described});
                    self.client.event("breakpoint", Some(body))?;
                }
            }
        }
        Ok(answer)
    }

    pub(super) fn configured(&mut self) -> Answer {
        self.loaded()?;
        if std::mem::replace(&mut self.is_configured, true) {
            return Err("the execution has begun already".to_owned());
        }
        Ok(None)
    }

    pub(super) fn set_breakpoints(&mut self, arguments: SetBreakpoints) -> Answer {
        let SetBreakpoints { source, breakpoints } = arguments;
        let is_same =
            |other: &reply::Source| other.path == source.path && other.reference == source.reference;
        self.breakpoints
            .retain(|breakpoint| !matches!(&breakpoint.spec, Spec::Line(other, _) if is_same(other)));
        let specs = breakpoints.into_iter().map(|mut breakpoint| {
            breakpoint.line = self.client.line_from_client(breakpoint.line) as i64;
            Spec::Line(source.clone(), breakpoint)
        });
        let specs = specs.collect();
        self.add_breakpoints(specs)
    }

    pub(super) fn set_function_breakpoints(&mut self, arguments: SetFunctionBreakpoints) -> Answer {
        self.breakpoints
            .retain(|breakpoint| !matches!(breakpoint.spec, Spec::Function(_)));
        self.add_breakpoints(arguments.breakpoints.into_iter().map(Spec::Function).collect())
    }

    pub(super) fn set_data_breakpoints(&mut self, arguments: SetDataBreakpoints) -> Answer {
        self.breakpoints
            .retain(|breakpoint| !matches!(breakpoint.spec, Spec::Data(_)));
        self.add_breakpoints(arguments.breakpoints.into_iter().map(Spec::Data).collect())
    }

    fn add_breakpoints(&mut self, specs: Vec<Spec>) -> Answer {
        let mut described = Vec::new();
        for spec in specs {
            self.last_breakpoint += 1;
            described.push(self.add_breakpoint(self.last_breakpoint, spec)?);
        }
        Ok(Some(json!({"breakpoints": described})))
    }

    fn add_breakpoint(&mut self, id: i64, spec: Spec) -> Result<reply::Breakpoint, String> {
        let loaded = self.loaded()?;
        let budget = budget(&loaded.subject, &self.control);
        let Resolution {
            stops,
            log,
            line,
            is_verified,
            message,
        } = spec.resolve(loaded.context(), &loaded.sources, budget);
        let described = reply::Breakpoint {
            id: Some(id),
            verified: is_verified,
            message,
            source: line.and_then(|line| loaded.sources.source(line.file)),
            line: line.map(|line| self.client.line(line.line)),
        };
        self.breakpoints.push(Breakpoint { id, spec, stops, log });
        Ok(described)
    }

    pub(super) fn set_filters(&mut self, arguments: &SetExceptionBreakpoints) -> Value {
        let options = arguments.filter_options.iter();
        let names = arguments
            .filters
            .iter()
            .chain(options.map(|option| &option.filter_id));
        self.filters.clear();
        let mut described = Vec::new();
        for name in names {
            let kind = IncidentKind::ALL.into_iter().find(|kind| kind.id() == name);
            self.filters.extend(kind);
            described.push(reply::Breakpoint {
                verified: kind.is_some(),
                message: kind.is_none().then(|| format!("there is no filter `{name}`")),
                ..reply::Breakpoint::default()
            });
        }
        json!({"breakpoints": described})
    }

    pub(super) fn breakpoint_locations(&self, arguments: &BreakpointLocations) -> Answer {
        let loaded = self.loaded()?;
        let Some(file) = loaded.sources.find(&arguments.source) else {
            return Ok(Some(json!({"breakpoints": []})));
        };
        let first = self.client.line_from_client(arguments.line);
        let last = arguments
            .end_line
            .map_or(first, |line| self.client.line_from_client(line));
        let lines = loaded.sources.lines(file, first, last).into_iter();
        let lines = lines.map(
            |(line, column)| json!({"line": self.client.line(line), "column": self.client.column(column)}),
        );
        Ok(Some(json!({"breakpoints": lines.collect::<Vec<_>>()})))
    }
}

fn with_line_end(text: String) -> String {
    if text.ends_with('\n') { text } else { text + "\n" }
}

impl<W: Write> Session<'_, W> {
    /// The only thread.
    pub(super) fn threads(&self) -> Value {
        let name = self.loaded.as_ref().map_or_else(
            || "pixel".to_owned(),
            |loaded| {
                let [x, y] = loaded.subject.pixel;
                let [width, height] = loaded.subject.frame.size;
                format!("pixel ({x}, {y}) of {width}×{height}")
            },
        );
        to_value(&json!({"threads": [{"id": super::THREAD, "name": name}]}))
    }
}
