//! The requests of a client.

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::reply::Source;

/// A message of a client.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Message {
    #[serde(default)]
    pub(crate) seq: i64,
    /// `request`; clients also send `response`.
    #[serde(rename = "type")]
    pub(crate) kind: String,
    #[serde(default)]
    pub(crate) command: String,
    #[serde(default)]
    arguments: Value,
}

/// A request with its arguments.
#[derive(Debug, Clone)]
pub(crate) enum Request {
    Initialize(Initialize),
    Launch(Map<String, Value>),
    Restart(Restart),
    SetBreakpoints(SetBreakpoints),
    SetFunctionBreakpoints(SetFunctionBreakpoints),
    SetExceptionBreakpoints(SetExceptionBreakpoints),
    DataBreakpointInfo(DataBreakpointInfo),
    SetDataBreakpoints(SetDataBreakpoints),
    BreakpointLocations(BreakpointLocations),
    ConfigurationDone,
    Threads,
    StackTrace(StackTrace),
    Scopes(OfFrame),
    Variables(Variables),
    Evaluate(Evaluate),
    ExceptionInfo,
    Source(SourceArguments),
    LoadedSources,
    Continue,
    ReverseContinue,
    Next,
    StepIn,
    StepOut,
    StepBack,
    RestartFrame(OfFrame),
    Pause,
    Cancel,
    Terminate,
    Disconnect,
    /// `setVariable` and `setExpression`.
    SetVariable,
}

impl Message {
    /// The request.
    ///
    /// # Errors
    /// Why it is not understood.
    pub(crate) fn request(&self) -> Result<Request, String> {
        Ok(match &*self.command {
            "initialize" => Request::Initialize(self.arguments()?),
            "launch" => Request::Launch(self.arguments()?),
            "restart" => Request::Restart(self.arguments()?),
            "setBreakpoints" => Request::SetBreakpoints(self.arguments()?),
            "setFunctionBreakpoints" => Request::SetFunctionBreakpoints(self.arguments()?),
            "setExceptionBreakpoints" => Request::SetExceptionBreakpoints(self.arguments()?),
            "dataBreakpointInfo" => Request::DataBreakpointInfo(self.arguments()?),
            "setDataBreakpoints" => Request::SetDataBreakpoints(self.arguments()?),
            "breakpointLocations" => Request::BreakpointLocations(self.arguments()?),
            "configurationDone" => Request::ConfigurationDone,
            "threads" => Request::Threads,
            "stackTrace" => Request::StackTrace(self.arguments()?),
            "scopes" => Request::Scopes(self.arguments()?),
            "variables" => Request::Variables(self.arguments()?),
            "evaluate" => Request::Evaluate(self.arguments()?),
            "exceptionInfo" => Request::ExceptionInfo,
            "source" => Request::Source(self.arguments()?),
            "loadedSources" => Request::LoadedSources,
            "continue" => Request::Continue,
            "reverseContinue" => Request::ReverseContinue,
            "next" => Request::Next,
            "stepIn" => Request::StepIn,
            "stepOut" => Request::StepOut,
            "stepBack" => Request::StepBack,
            "restartFrame" => Request::RestartFrame(self.arguments()?),
            "pause" => Request::Pause,
            "cancel" => Request::Cancel,
            "terminate" => Request::Terminate,
            "disconnect" => Request::Disconnect,
            "setVariable" | "setExpression" => Request::SetVariable,
            "attach" => {
                return Err(
                    "there is no process to attach to; use a configuration with \"request\": \"launch\""
                        .to_owned(),
                );
            }
            other => return Err(format!("the request `{other}` is not supported")),
        })
    }

    /// The number of the request that is to be canceled.
    pub(crate) fn canceled(&self) -> Option<i64> {
        self.arguments.get("requestId")?.as_i64()
    }

    fn arguments<T: DeserializeOwned>(&self) -> Result<T, String> {
        let arguments = match &self.arguments {
            Value::Null => Value::Object(Map::new()),
            arguments => arguments.clone(),
        };
        serde_json::from_value(arguments)
            .map_err(|error| format!("invalid arguments of `{}`: {error}", self.command))
    }
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Initialize {
    #[serde(default = "yes", rename = "linesStartAt1")]
    pub(crate) lines_start_at_1: bool,
    #[serde(default = "yes", rename = "columnsStartAt1")]
    pub(crate) columns_start_at_1: bool,
}

fn yes() -> bool {
    true
}

#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Restart {
    /// The changed arguments of `launch`, if there are any.
    #[serde(default)]
    pub(crate) arguments: Option<Map<String, Value>>,
}

#[derive(Debug, Clone, Deserialize)]
pub(crate) struct SetBreakpoints {
    pub(crate) source: Source,
    #[serde(default)]
    pub(crate) breakpoints: Vec<SourceBreakpoint>,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SourceBreakpoint {
    pub(crate) line: i64,
    pub(crate) condition: Option<String>,
    pub(crate) hit_condition: Option<String>,
    pub(crate) log_message: Option<String>,
}

#[derive(Debug, Clone, Deserialize)]
pub(crate) struct SetFunctionBreakpoints {
    #[serde(default)]
    pub(crate) breakpoints: Vec<FunctionBreakpoint>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct FunctionBreakpoint {
    pub(crate) name: String,
    pub(crate) condition: Option<String>,
    pub(crate) hit_condition: Option<String>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SetExceptionBreakpoints {
    #[serde(default)]
    pub(crate) filters: Vec<String>,
    #[serde(default)]
    pub(crate) filter_options: Vec<FilterOptions>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct FilterOptions {
    pub(crate) filter_id: String,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct DataBreakpointInfo {
    pub(crate) variables_reference: Option<i64>,
    pub(crate) name: String,
    pub(crate) frame_id: Option<i64>,
}

#[derive(Debug, Clone, Deserialize)]
pub(crate) struct SetDataBreakpoints {
    #[serde(default)]
    pub(crate) breakpoints: Vec<DataBreakpoint>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct DataBreakpoint {
    pub(crate) data_id: String,
    pub(crate) condition: Option<String>,
    pub(crate) hit_condition: Option<String>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct BreakpointLocations {
    pub(crate) source: Source,
    pub(crate) line: i64,
    pub(crate) end_line: Option<i64>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct StackTrace {
    #[serde(default)]
    pub(crate) start_frame: i64,
    #[serde(default)]
    pub(crate) levels: i64,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct OfFrame {
    pub(crate) frame_id: i64,
}

#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Variables {
    #[serde(rename = "variablesReference")]
    pub(crate) reference: i64,
    #[serde(default)]
    pub(crate) start: i64,
    #[serde(default)]
    pub(crate) count: i64,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Evaluate {
    pub(crate) expression: String,
    pub(crate) frame_id: Option<i64>,
    /// `watch`, `hover`, `repl`, `clipboard` or `variables`.
    pub(crate) context: Option<String>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SourceArguments {
    #[serde(default)]
    pub(crate) source_reference: i64,
    pub(crate) source: Option<Source>,
}
