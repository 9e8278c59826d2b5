//! A session with a client: requests are handled one after the other.

mod configuration;
mod control;
mod execution;
mod inspection;

use std::collections::BTreeSet;
use std::io::{self, Read, Write};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

use serde::Serialize;
use serde_json::{Map, Value, json};
use toyproof_verify::contain::{Part, contain};

use self::control::Control;
use self::inspection::Handles;
use crate::breakpoints::Breakpoint;
use crate::protocol::framing;
use crate::protocol::reply::{Numbered, Output, Reply, Source};
use crate::protocol::request::{Initialize, Message, Request};
use crate::recording::{Incident, IncidentKind, Point, Recording};
use crate::sources::Sources;
use crate::subject::Subject;
use crate::watch::{Budget, Context};

/// The only thread: the pixel.
const THREAD: i64 = 1;

/// Reads the shader that a client wants to debug.
pub trait Launcher {
    /// Reads the shader that the arguments of a request `launch` name.
    ///
    /// # Errors
    /// Why there is nothing to debug.
    fn launch(&mut self, arguments: &Map<String, Value>) -> Result<Launch, LaunchError>;
}

/// What is to be debugged.
#[derive(Debug)]
pub struct Launch {
    /// The pixel.
    pub subject: Subject,
    /// Whether to stop before the first line, instead of at the first breakpoint.
    pub stops_on_entry: bool,
    /// Messages for the user, such as warnings about the shader.
    pub notes: Vec<String>,
}

/// Why there is nothing to debug.
#[derive(Debug)]
pub struct LaunchError {
    /// A sentence.
    pub message: String,
    /// All messages for the user, with excerpts of the source.
    pub details: Vec<String>,
}

/// Serves a client until it disconnects or the input ends. The thread that reads the input goes on until
/// then.
///
/// # Errors
/// If the input is not in the form of the protocol, or the output cannot be written.
pub fn serve(
    input: impl Read + Send + 'static,
    output: impl Write,
    launcher: &mut dyn Launcher,
) -> io::Result<()> {
    let control = Arc::new(Control::default());
    let received = control::receive(input, &control);
    let mut session = Session {
        client: Client {
            output,
            last_seq: 0,
            first_line: 1,
            first_column: 1,
        },
        launcher,
        control,
        filters: BTreeSet::new(),
        breakpoints: Vec::new(),
        last_breakpoint: 0,
        arguments: None,
        is_configured: false,
        loaded: None,
    };
    for message in received {
        match message? {
            Ok(message) => {
                if !session.message(&message)? {
                    break;
                }
            }
            Err(error) => session
                .client
                .output("stderr", format!("malformed message: {error}\n"))?,
        }
    }
    Ok(())
}

/// The answer to a request: the body of the response, or a message.
type Answer = Result<Option<Value>, String>;

/// What happens after a response is sent.
enum Next {
    Nothing,
    /// The execution begins, or goes on.
    Run(execution::Motion),
    /// The client can set breakpoints.
    Initialized,
    /// The debugged program has ended.
    Terminated,
    /// The session has ended.
    End,
}

struct Session<'a, W> {
    client: Client<W>,
    launcher: &'a mut dyn Launcher,
    control: Arc<Control>,
    /// The incidents to stop at.
    filters: BTreeSet<IncidentKind>,
    breakpoints: Vec<Breakpoint>,
    /// The number of the last breakpoint.
    last_breakpoint: i64,
    /// The arguments of `launch`, for a restart.
    arguments: Option<Map<String, Value>>,
    /// Whether the client has set its breakpoints.
    is_configured: bool,
    loaded: Option<Loaded>,
}

/// A shader with the recording of its pixel.
struct Loaded {
    subject: Rc<Subject>,
    recording: Rc<Recording>,
    sources: Sources,
    stops_on_entry: bool,
    at: Point,
    /// Why it has stopped, if incidents are the reason.
    incidents: Vec<Incident>,
    handles: Handles,
}

impl Loaded {
    fn context(&self) -> Context<'_> {
        Context {
            subject: &self.subject,
            recording: &self.recording,
        }
    }
}

/// The output to a client.
struct Client<W> {
    output: W,
    last_seq: i64,
    /// The numbers of the first line and of the first column.
    first_line: i64,
    first_column: i64,
}

impl<W: Write> Client<W> {
    fn send(&mut self, message: Reply) -> io::Result<()> {
        self.last_seq += 1;
        let message = Numbered {
            seq: self.last_seq,
            message,
        };
        framing::write(&mut self.output, &serde_json::to_vec(&message)?)
    }

    fn event(&mut self, event: &'static str, body: Option<Value>) -> io::Result<()> {
        self.send(Reply::Event { event, body })
    }

    fn output(&mut self, category: &'static str, output: String) -> io::Result<()> {
        self.output_at(category, output, None)
    }

    fn output_at(
        &mut self,
        category: &'static str,
        output: String,
        at: Option<(Option<Source>, usize)>,
    ) -> io::Result<()> {
        let (source, line) = at.unzip();
        let body = Output {
            category,
            text: output,
            source: source.flatten(),
            line: line.map(|line| self.line(line)),
        };
        self.event("output", Some(to_value(&body)))
    }

    /// The number of a line that counts from 1.
    fn line(&self, line: usize) -> i64 {
        line as i64 - 1 + self.first_line
    }

    fn column(&self, column: usize) -> i64 {
        column as i64 - 1 + self.first_column
    }

    /// The number from 1 of a line that the client names.
    fn line_from_client(&self, line: i64) -> usize {
        usize::try_from(line.saturating_sub(self.first_line).saturating_add(1)).unwrap_or(0)
    }
}

/// The JSON of a part of a message, which always serializes: its keys are strings.
fn to_value(body: &impl Serialize) -> Value {
    serde_json::to_value(body).unwrap_or_default()
}

impl<W: Write> Session<'_, W> {
    /// Handles a message; returns whether the session goes on.
    fn message(&mut self, message: &Message) -> io::Result<bool> {
        if message.kind != "request" {
            return Ok(true);
        }
        let is_canceled = self.control.begin(message.seq);
        let request = if is_canceled {
            Err("canceled".to_owned())
        } else {
            message.request()
        };
        let mut next = Next::Nothing;
        let answer = match request {
            Ok(request) => {
                let handled = contain(Part::Command, || self.request(request));
                handled
                    .unwrap_or_else(|panic| Ok((Err(panic.to_string()), Next::Nothing)))
                    .map(|(answer, then)| {
                        next = then;
                        answer
                    })?
            }
            Err(message) => Err(message),
        };
        let (body, error) = match answer {
            Ok(body) => (body, None),
            Err(error) => (Some(json!({"error": {"id": 1, "format": error}})), Some(error)),
        };
        if matches!(next, Next::Initialized) {
            self.client.event("initialized", None)?;
        }
        self.client.send(Reply::Response {
            request_seq: message.seq,
            success: error.is_none(),
            command: message.command.clone(),
            message: error,
            body,
        })?;
        match next {
            Next::Nothing | Next::Initialized => {}
            Next::Run(motion) => self.run(motion)?,
            Next::Terminated => self.client.event("terminated", None)?,
            Next::End => return Ok(false),
        }
        Ok(true)
    }

    /// Handles a request.
    ///
    /// # Errors
    /// If the output cannot be written.
    fn request(&mut self, request: Request) -> io::Result<(Answer, Next)> {
        use execution::Motion;
        let next = match &request {
            Request::Launch(_) => Next::Initialized,
            Request::ConfigurationDone | Request::Restart(_) => Next::Run(Motion::Begin),
            Request::Continue => Next::Run(Motion::Continue),
            Request::ReverseContinue => Next::Run(Motion::ReverseContinue),
            Request::Next => Next::Run(Motion::Next),
            Request::StepIn => Next::Run(Motion::Into),
            Request::StepOut => Next::Run(Motion::Out),
            Request::StepBack => Next::Run(Motion::Back),
            Request::Terminate => Next::Terminated,
            Request::Disconnect => Next::End,
            _ => Next::Nothing,
        };
        let answer = match request {
            Request::Initialize(arguments) => Ok(Some(self.initialize(&arguments))),
            Request::Launch(arguments) => self.launch(arguments)?,
            Request::Restart(arguments) => self.restart(arguments)?,
            Request::ConfigurationDone => self.configured(),
            Request::SetBreakpoints(arguments) => self.set_breakpoints(arguments),
            Request::SetFunctionBreakpoints(arguments) => self.set_function_breakpoints(arguments),
            Request::SetDataBreakpoints(arguments) => self.set_data_breakpoints(arguments),
            Request::SetExceptionBreakpoints(arguments) => Ok(Some(self.set_filters(&arguments))),
            Request::DataBreakpointInfo(arguments) => self.data_breakpoint_info(&arguments),
            Request::BreakpointLocations(arguments) => self.breakpoint_locations(&arguments),
            Request::Continue | Request::ReverseContinue => self
                .loaded()
                .map(|_| Some(json!({"allThreadsContinued": true}))),
            Request::Next | Request::StepIn | Request::StepOut | Request::StepBack | Request::Pause => {
                self.loaded().map(|_| None)
            }
            Request::RestartFrame(arguments) => {
                return Ok(match self.frame_start(&arguments) {
                    Ok(point) => (Ok(None), Next::Run(Motion::To(point))),
                    Err(error) => (Err(error), Next::Nothing),
                });
            }
            Request::Threads => Ok(Some(self.threads())),
            Request::StackTrace(arguments) => self.stack_trace(&arguments),
            Request::Scopes(arguments) => self.scopes(&arguments),
            Request::Variables(arguments) => self.variables(&arguments),
            Request::Evaluate(arguments) => self.evaluate(&arguments),
            Request::ExceptionInfo => self.exception_info(),
            Request::Source(arguments) => self.source(&arguments),
            Request::LoadedSources => self
                .loaded()
                .map(|loaded| Some(json!({"sources": loaded.sources.all()}))),
            Request::SetVariable => Err(
                "the execution is a recording, in which values cannot be changed; edit the shader and restart"
                    .to_owned(),
            ),
            Request::Cancel | Request::Terminate | Request::Disconnect => Ok(None),
        };
        let next = if answer.is_ok() { next } else { Next::Nothing };
        Ok((answer, next))
    }

    fn initialize(&mut self, arguments: &Initialize) -> Value {
        self.client.first_line = i64::from(arguments.lines_start_at_1);
        self.client.first_column = i64::from(arguments.columns_start_at_1);
        to_value(&configuration::capabilities())
    }

    fn loaded(&self) -> Result<&Loaded, String> {
        self.loaded
            .as_ref()
            .ok_or_else(|| "no shader is loaded; send `launch` first".to_owned())
    }

    fn loaded_mut(&mut self) -> Result<&mut Loaded, String> {
        self.loaded
            .as_mut()
            .ok_or_else(|| "no shader is loaded; send `launch` first".to_owned())
    }
}

/// The budget of a request on a shader.
fn budget<'a>(subject: &Subject, control: &'a Control) -> Budget<'a> {
    Budget {
        deadline: Instant::now() + subject.timeout,
        interrupt: &control.interrupt,
    }
}
