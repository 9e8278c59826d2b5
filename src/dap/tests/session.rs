//! Sessions: a client in the test's thread, the debug adapter in another.

use std::io::{self, BufReader, Read, Write};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{JoinHandle, spawn};

use serde_json::{Map, Value, json};

use super::{HANG_GUARD, SPHERES, subject};
use crate::protocol::framing;
use crate::session::{Launch, LaunchError, Launcher, serve};

/// Loads the argument `text`.
struct TextLauncher;

impl Launcher for TextLauncher {
    fn launch(&mut self, arguments: &Map<String, Value>) -> Result<Launch, LaunchError> {
        let text = arguments.get("text").and_then(Value::as_str);
        let text = text.ok_or_else(|| LaunchError {
            message: "no text".to_owned(),
            details: vec!["error: no text".to_owned()],
        })?;
        Ok(Launch {
            subject: subject(text),
            stops_on_entry: arguments.contains_key("stopOnEntry"),
            notes: Vec::new(),
        })
    }
}

/// Bytes from another thread.
struct Incoming {
    receiver: Receiver<Vec<u8>>,
    rest: Vec<u8>,
}

impl Read for Incoming {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.rest.is_empty() {
            self.rest = self.receiver.recv().unwrap_or_default();
        }
        let count = self.rest.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.rest[..count]);
        self.rest.drain(..count);
        Ok(count)
    }
}

struct Outgoing(Sender<Vec<u8>>);

impl Write for Outgoing {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0
            .send(bytes.to_owned())
            .map_err(|_| io::ErrorKind::BrokenPipe)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

struct Client {
    sender: Sender<Vec<u8>>,
    receiver: BufReader<Incoming>,
    server: JoinHandle<io::Result<()>>,
    seq: i64,
    events: Vec<Value>,
}

impl Client {
    fn new() -> Self {
        let (sender, to_server) = channel();
        let (from_server, receiver) = channel();
        let incoming = |receiver| Incoming {
            receiver,
            rest: Vec::new(),
        };
        let server = spawn(move || serve(incoming(to_server), Outgoing(from_server), &mut TextLauncher));
        Self {
            sender,
            receiver: BufReader::new(incoming(receiver)),
            server,
            seq: 0,
            events: Vec::new(),
        }
    }

    /// A session that has stopped at the first line.
    fn started(text: &str) -> Self {
        let mut client = Self::new();
        client.ok("initialize", json!({"adapterID": "toyproof"}));
        client.ok("launch", json!({"text": text, "stopOnEntry": true}));
        client.ok("configurationDone", Value::Null);
        assert_eq!(client.stopped()["reason"], "entry");
        client
    }

    fn send(&self, message: &Value) {
        let mut bytes = Vec::new();
        framing::write(&mut bytes, message.to_string().as_bytes()).unwrap();
        self.sender.send(bytes).unwrap();
    }

    fn receive(&mut self) -> Value {
        let content = framing::read(&mut self.receiver)
            .unwrap()
            .expect("the session goes on");
        serde_json::from_slice(&content).unwrap()
    }

    /// Sends a request; returns its response.
    fn request(&mut self, command: &str, arguments: Value) -> Value {
        self.seq += 1;
        let seq = self.seq;
        let mut message = json!({"seq": seq, "type": "request", "command": command});
        message["arguments"] = arguments;
        self.send(&message);
        loop {
            let message = self.receive();
            if message["type"] == "response" {
                assert_eq!(message["request_seq"], seq);
                assert_eq!(message["command"], command);
                return message;
            }
            self.events.push(message);
        }
    }

    /// Sends a request that succeeds; returns the body of the response.
    fn ok(&mut self, command: &str, arguments: Value) -> Value {
        let response = self.request(command, arguments);
        assert_eq!(response["success"], true, "{response}");
        response["body"].clone()
    }

    /// The body of the next event of a kind.
    fn event(&mut self, kind: &str) -> Value {
        loop {
            if let Some(at) = self.events.iter().position(|event| event["event"] == kind) {
                let event = self.events.remove(at);
                return event["body"].clone();
            }
            let message = self.receive();
            self.events.push(message);
        }
    }

    fn stopped(&mut self) -> Value {
        self.event("stopped")
    }

    /// Moves; returns the line of the innermost function.
    fn go(&mut self, command: &str) -> i64 {
        self.ok(command, json!({"threadId": 1}));
        self.stopped();
        self.line()
    }

    fn frames(&mut self) -> Vec<Value> {
        let body = self.ok("stackTrace", json!({"threadId": 1}));
        body["stackFrames"].as_array().unwrap().clone()
    }

    fn line(&mut self) -> i64 {
        self.frames()[0]["line"].as_i64().unwrap()
    }

    /// The variables of a scope of a frame, as `name = value`.
    fn scope(&mut self, frame: i64, name: &str) -> Vec<Value> {
        let scopes = self.ok("scopes", json!({"frameId": frame}));
        let scopes = scopes["scopes"].as_array().unwrap().clone();
        let scope = scopes.iter().find(|scope| scope["name"] == name);
        let reference = scope.unwrap_or_else(|| panic!("{scopes:?}"))["variablesReference"].clone();
        self.parts(&reference)
    }

    fn parts(&mut self, reference: &Value) -> Vec<Value> {
        let body = self.ok("variables", json!({"variablesReference": reference}));
        body["variables"].as_array().unwrap().clone()
    }

    fn set_breakpoints(&mut self, breakpoints: Value) -> Vec<Value> {
        let mut arguments = json!({"source": {"path": "a.glsl"}});
        arguments["breakpoints"] = breakpoints;
        let body = self.ok("setBreakpoints", arguments);
        body["breakpoints"].as_array().unwrap().clone()
    }

    fn disconnect(mut self) {
        self.ok("disconnect", Value::Null);
        self.server.join().unwrap().unwrap();
    }
}

fn texts(variables: &[Value]) -> Vec<String> {
    let text = |variable: &Value| {
        let part = |key: &str| variable[key].as_str().unwrap_or_default().to_owned();
        format!("{} {} = {}", part("type"), part("name"), part("value"))
    };
    variables.iter().map(text).collect()
}

#[test]
fn breakpoints_move_to_code_and_stop_in_both_directions() {
    let mut client = Client::started(SPHERES);
    let set = client.set_breakpoints(json!([{"line": 7}, {"line": 18}, {"line": 40}]));
    assert_eq!((&set[0]["verified"], &set[0]["line"]), (&json!(true), &json!(9)));
    assert_eq!(set[2]["verified"], false);
    assert_eq!(set[2]["message"], "there is no code at or after this line");
    assert_eq!(client.go("continue"), 9);
    assert_eq!(client.go("continue"), 18);
    assert_eq!(client.go("continue"), 9);
    assert_eq!(client.go("reverseContinue"), 18);
    assert_eq!(client.go("reverseContinue"), 9);
    assert_eq!(client.go("reverseContinue"), 23);
    assert_eq!(client.go("next"), 24);
    assert_eq!(client.go("stepBack"), 23);
    // Steps over calls stop at breakpoints in them, in both directions.
    for line in [24, 25, 26, 27, 28, 9] {
        assert_eq!(client.go("next"), line);
    }
    assert_eq!(client.go("stepOut"), 28);
    assert_eq!(client.go("next"), 18);
    assert_eq!(client.go("stepOut"), 28);
    assert_eq!(client.go("stepBack"), 18);
    client.set_breakpoints(json!([]));
    client.ok("continue", Value::Null);
    let stopped = client.stopped();
    assert_eq!(stopped["description"], "The color of the pixel is computed");
    assert_eq!(client.line(), 30);
    client.ok("continue", Value::Null);
    client.event("terminated");
    client.disconnect();
}

#[test]
fn conditions_and_hit_counts_select_times() {
    let text = "\
void mainImage(out vec4 c, in vec2 p) {
    for (int i = 0; i < 200; i++) {
        c.x += float(i) * 0.5;
    }
}
";
    let mut client = Client::started(text);
    let value = |client: &mut Client, expression: &str| {
        let body = client.ok("evaluate", json!({"expression": expression, "context": "watch"}));
        body["result"].as_str().unwrap().to_owned()
    };
    client.set_breakpoints(json!([{"line": 3, "condition": "i > 2 && i % 50 == 0"}]));
    client.go("continue");
    assert_eq!(value(&mut client, "i"), "50");
    client.go("continue");
    assert_eq!(
        (value(&mut client, "i"), value(&mut client, "c.x")),
        ("100".into(), "2475".into())
    );
    client.set_breakpoints(json!([{"line": 3, "hitCondition": "% 70"}]));
    client.go("continue");
    assert_eq!(value(&mut client, "i"), "139");
    let set =
        client.set_breakpoints(json!([{"line": 3, "condition": "i = 3"}, {"line": 3, "condition": "i"}]));
    for refused in set {
        assert_eq!(refused["verified"], false, "{refused}");
    }
    let set = client.set_breakpoints(json!([{"line": 3, "condition": "i > 300"}]));
    assert!(
        set[0]["message"].as_str().unwrap().contains("never holds"),
        "{set:?}"
    );
    client.disconnect();
}

#[test]
fn functions_logs_and_data_have_breakpoints() {
    let mut client = Client::started(SPHERES);
    let functions = json!({"breakpoints": [{"name": "closer"}, {"name": "missing"}]});
    let set = client.ok("setFunctionBreakpoints", functions);
    assert_eq!(set["breakpoints"][0]["verified"], true);
    assert_eq!(set["breakpoints"][1]["verified"], false);
    client.set_breakpoints(json!([{"line": 28, "logMessage": "i={i} nearest={nearest} {wrong}"}]));
    assert_eq!(client.go("continue"), 17);
    let output = client.event("output");
    assert!(
        output["output"]
            .as_str()
            .unwrap()
            .starts_with("i=0 nearest=1000 <"),
        "{output}"
    );
    assert_eq!(output["line"], 28);
    assert_eq!(client.go("continue"), 17);
    client.ok("setFunctionBreakpoints", json!({"breakpoints": []}));
    client.set_breakpoints(json!([]));
    // The writes of a variable, also as an `inout` parameter.
    let scopes = client.ok("scopes", json!({"frameId": 2}));
    let locals = &scopes["scopes"][0]["variablesReference"];
    let info = client.ok(
        "dataBreakpointInfo",
        json!({"variablesReference": locals, "name": "nearest"}),
    );
    client.ok(
        "setDataBreakpoints",
        json!({"breakpoints": [{"dataId": info["dataId"]}]}),
    );
    assert_eq!(client.go("reverseContinue"), 18);
    assert_eq!(client.go("reverseContinue"), 26);
    assert_eq!(client.go("continue"), 18);
    assert_eq!(client.go("continue"), 18);
    client.disconnect();
}

#[test]
fn scopes_have_variables_as_trees() {
    let mut client = Client::started(SPHERES);
    client.set_breakpoints(json!([{"line": 10, "hitCondition": "2"}]));
    client.go("continue");
    let frames = client.frames();
    let described: Vec<_> = frames
        .iter()
        .map(|frame| (&frame["name"], &frame["line"]))
        .collect();
    assert_eq!(
        described,
        [(&json!("hit"), &json!(10)), (&json!("mainImage"), &json!(28))]
    );
    assert_eq!(frames[1]["column"], 16);
    let locals = client.scope(1, "Locals");
    assert_eq!(
        texts(&locals),
        [
            "Ray ray = Ray((0, 0, 0), (0, 0, -1))",
            "vec3 center = (0, 0, -3)",
            "vec3 f = (0, 0, 3)"
        ]
    );
    assert_eq!(locals[0]["namedVariables"], 2);
    let ray = client.parts(&locals[0]["variablesReference"]);
    assert_eq!(
        texts(&ray),
        ["vec3 origin = (0, 0, 0)", "vec3 direction = (0, 0, -1)"]
    );
    assert_eq!(ray[1]["evaluateName"], "ray.direction");
    let direction = client.parts(&ray[1]["variablesReference"]);
    assert_eq!(texts(&direction)[2], "float z = -1");
    assert_eq!(direction[2]["evaluateName"], "ray.direction.z");
    let globals = client.scope(1, "Globals");
    assert_eq!(texts(&globals), ["vec3[2] centers = [(0, 0, -5), (0, 0, -3)]"]);
    assert_eq!(globals[0]["indexedVariables"], 2);
    let centers = client.ok(
        "variables",
        json!({"variablesReference": globals[0]["variablesReference"], "start": 1, "count": 1}),
    );
    assert_eq!(
        texts(centers["variables"].as_array().unwrap()),
        ["vec3 [1] = (0, 0, -3)"]
    );
    assert_eq!(centers["variables"][0]["evaluateName"], "centers[1]");
    let outputs = client.scope(1, "Outputs");
    assert_eq!(texts(&outputs)[0], "vec4 fragColor = (0, 0, 0, 0)");
    assert_eq!(texts(&outputs)[1], "vec3 color of the pixel = (0.2, 0.2, 0.2)");
    let of_main = texts(&client.scope(2, "Locals"));
    assert!(of_main.contains(&"float nearest = 4".to_owned()), "{of_main:?}");
    // The numbers of one stop are not those of the next.
    client.go("next");
    let stale = client.request("variables", json!({"variablesReference": 1}));
    assert_eq!(stale["success"], false);
    client.disconnect();
}

#[test]
fn inputs_are_those_that_the_shader_reads() {
    let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p / iResolution.xy, iTime, iFrame); }\n";
    let text = text.replace("iFrame)", "float(iFrame))");
    let mut client = Client::started(&text);
    let inputs = texts(&client.scope(1, "Inputs"));
    assert_eq!(
        inputs,
        [
            "vec3 iResolution = (64, 36, 1)",
            "float iTime = 0",
            "int iFrame = 0"
        ]
    );
    client.disconnect();
}

#[test]
fn exceptions_stop_where_values_go_wrong() {
    let text = "\
void mainImage(out vec4 c, in vec2 p) {
    float x = sqrt(-p.x);
    float big = (1e8 + p.x) - 1e8;
    c = vec4(x + big);
}
";
    let mut client = Client::started(text);
    let filters = json!({"filters": ["not-finite", "divergence", "unknown"]});
    let set = client.ok("setExceptionBreakpoints", filters);
    assert_eq!(set["breakpoints"][2]["verified"], false);
    client.ok("continue", Value::Null);
    let stopped = client.stopped();
    assert_eq!((&stopped["reason"], client.line()), (&json!("exception"), 2));
    assert_eq!(stopped["text"], "`sqrt(-p.x)` is NaN");
    let info = client.ok("exceptionInfo", json!({"threadId": 1}));
    assert_eq!(info["exceptionId"], "NaN or infinity appears");
    assert_eq!(client.go("continue"), 3);
    assert_eq!(client.go("reverseContinue"), 2);
    // A step stops at what happens in the line, and then goes on.
    assert_eq!(client.go("next"), 3);
    assert_eq!(client.go("next"), 3);
    assert_eq!(client.go("next"), 4);
    client.disconnect();
}

#[test]
fn a_refused_request_has_a_reason() {
    let mut client = Client::new();
    let message = |response: &Value| response["message"].as_str().unwrap().to_owned();
    for command in ["stackTrace", "continue", "configurationDone", "threads"] {
        let response = client.request(command, json!({"threadId": 1}));
        let is_refused = response["success"] == false;
        assert_eq!(is_refused, command != "threads", "{response}");
    }
    let failed = client.request("launch", json!({}));
    assert_eq!(message(&failed), "no text");
    assert_eq!(client.event("output")["output"], "error: no text\n");
    client.ok("launch", json!({"text": SPHERES}));
    let set = client.request(
        "setVariable",
        json!({"name": "x", "value": "1", "variablesReference": 1}),
    );
    assert!(message(&set).contains("recording"), "{set}");
    for command in ["attach", "goto", "nonsense", ""] {
        assert_eq!(client.request(command, Value::Null)["success"], false);
    }
    let wrong = client.request("scopes", json!({"frameId": "x"}));
    assert!(
        message(&wrong).contains("invalid arguments of `scopes`"),
        "{wrong}"
    );
    assert_eq!(client.request("scopes", json!({"frameId": 99}))["success"], false);
    client.disconnect();
}

#[test]
fn restarting_loads_the_shader_again_with_its_breakpoints() {
    let mut client = Client::started(SPHERES);
    client.set_breakpoints(json!([{"line": 18}]));
    let moved = format!("\n{SPHERES}");
    client.ok("restart", json!({"arguments": {"text": moved}}));
    let changed = client.event("breakpoint");
    assert_eq!(
        (&changed["reason"], &changed["breakpoint"]["line"]),
        (&json!("changed"), &json!(18))
    );
    client.stopped();
    assert_eq!(client.line(), 18);
    client.disconnect();
}

#[test]
fn frames_restart_and_lines_may_count_from_zero() {
    let mut client = Client::new();
    client.ok(
        "initialize",
        json!({"linesStartAt1": false, "columnsStartAt1": false}),
    );
    client.ok("launch", json!({"text": SPHERES}));
    let set = client.set_breakpoints(json!([{"line": 10}]));
    assert_eq!(set[0]["line"], 10);
    client.ok("configurationDone", Value::Null);
    client.stopped();
    let frames = client.frames();
    assert_eq!(
        (&frames[0]["line"], &frames[0]["column"]),
        (&json!(10), &json!(4))
    );
    client.ok("restartFrame", json!({"frameId": 1}));
    client.stopped();
    assert_eq!(client.line(), 8);
    client.ok("restartFrame", json!({"frameId": 2}));
    client.stopped();
    assert_eq!(client.line(), 22);
    let source = json!({"path": "a.glsl"});
    let locations = client.ok(
        "breakpointLocations",
        json!({"source": source, "line": 0, "endLine": 10}),
    );
    let lines = locations["breakpoints"].as_array().unwrap().iter();
    assert_eq!(
        lines.map(|at| at["line"].as_i64().unwrap()).collect::<Vec<_>>(),
        [8, 9, 10]
    );
    // The text is not a file.
    let sources = client.ok("loadedSources", Value::Null);
    let reference = &sources["sources"][0]["sourceReference"];
    let content = client.ok("source", json!({"sourceReference": reference}));
    assert_eq!(content["content"], SPHERES);
    client.disconnect();
}

/// A condition that would be evaluated for minutes ends when its request is canceled.
#[test]
fn a_request_can_be_canceled_while_it_is_handled() {
    let text = "\
float slow(float x) {
    for (int i = 0; i < 60000000; i++) x = fract(x * 1.1);
    return x;
}
void mainImage(out vec4 c, in vec2 p) {
    c = vec4(p.x);
}
";
    let mut client = Client::started(text);
    let evaluate = json!({"seq": 1000, "type": "request", "command": "evaluate",
        "arguments": {"expression": "slow(p.x)"}});
    client.send(&evaluate);
    client.send(
        &json!({"seq": 1001, "type": "request", "command": "cancel", "arguments": {"requestId": 1000}}),
    );
    let started = std::time::Instant::now();
    let response = client.receive();
    assert_eq!(
        (&response["request_seq"], &response["success"]),
        (&json!(1000), &json!(false))
    );
    assert!(started.elapsed() < HANG_GUARD);
    assert_eq!(client.receive()["request_seq"], 1001);
    assert_eq!(client.line(), 6);
    client.disconnect();
}

/// Random requests with random arguments get one response each, and end nothing.
#[test]
fn random_requests_have_responses() {
    const COMMANDS: [&str; 29] = [
        "initialize",
        "launch",
        "restart",
        "setBreakpoints",
        "setFunctionBreakpoints",
        "setDataBreakpoints",
        "setExceptionBreakpoints",
        "dataBreakpointInfo",
        "breakpointLocations",
        "configurationDone",
        "threads",
        "stackTrace",
        "scopes",
        "variables",
        "evaluate",
        "exceptionInfo",
        "source",
        "loadedSources",
        "continue",
        "reverseContinue",
        "next",
        "stepIn",
        "stepOut",
        "stepBack",
        "restartFrame",
        "pause",
        "setVariable",
        "attach",
        "cancel",
    ];
    const KEYS: [&str; 20] = [
        "line",
        "frameId",
        "variablesReference",
        "expression",
        "start",
        "count",
        "levels",
        "startFrame",
        "name",
        "condition",
        "hitCondition",
        "logMessage",
        "path",
        "source",
        "breakpoints",
        "filters",
        "dataId",
        "sourceReference",
        "endLine",
        "requestId",
    ];
    const TEXTS: [&str; 12] = [
        "ray",
        "a.glsl",
        "i > 0",
        "centers[i]",
        "% 2",
        "{i}",
        "cells 0-9",
        "nearest",
        "not-finite",
        "closer",
        "",
        "€ }",
    ];
    let mut state = 1_u32;
    let mut client = Client::started(SPHERES);
    for _ in 0..3000 {
        let mut random = |below: usize| {
            state = toyproof_image::pcg(state);
            (state >> 8) as usize % below
        };
        let command = COMMANDS[random(COMMANDS.len())];
        let mut arguments = random_object(&mut random, &KEYS, &TEXTS, 2);
        if command == "launch" || command == "restart" {
            arguments = if random(2) == 0 {
                json!({"text": SPHERES, "arguments": {"text": SPHERES}})
            } else {
                json!({})
            };
        }
        client.request(command, arguments);
        client.events.clear();
    }
    client.disconnect();
}

fn random_object(
    random: &mut impl FnMut(usize) -> usize,
    keys: &[&str],
    texts: &[&str],
    depth: usize,
) -> Value {
    let count = random(5);
    let members = (0..count).map(|_| {
        let key = keys[random(keys.len())];
        let value = match random(if depth == 0 { 5 } else { 7 }) {
            0 => json!(random(40) as i64 - 3),
            1 => json!(texts[random(texts.len())]),
            2 => json!(random(2) == 0),
            3 => Value::Null,
            4 => json!([i64::MIN, i64::MAX, 1 << 40, -1][random(4)]),
            5 => random_object(random, keys, texts, depth - 1),
            _ => Value::Array(
                (0..random(3))
                    .map(|_| random_object(random, keys, texts, depth - 1))
                    .collect(),
            ),
        };
        (key.to_owned(), value)
    });
    Value::Object(members.collect())
}

#[test]
fn malformed_messages_are_reported_and_malformed_headers_end_the_session() {
    let mut client = Client::new();
    for content in ["{", "[]", "null", "{\"seq\": \"x\", \"type\": \"request\"}"] {
        let bytes = format!("Content-Length: {}\r\n\r\n{content}", content.len());
        client.sender.send(bytes.into_bytes()).unwrap();
        let output = client.event("output");
        assert!(
            output["output"]
                .as_str()
                .unwrap()
                .starts_with("malformed message"),
            "{output}"
        );
    }
    client.send(&json!({"seq": 5, "type": "response", "command": "runInTerminal"}));
    client.ok("threads", Value::Null);
    client.sender.send(b"no header\r\n\r\n".to_vec()).unwrap();
    let error = client.server.join().unwrap().unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::InvalidData);
}

#[test]
fn the_end_of_the_input_ends_the_session() {
    let Client { sender, server, .. } = Client::started(SPHERES);
    drop(sender);
    server.join().unwrap().unwrap();
}
