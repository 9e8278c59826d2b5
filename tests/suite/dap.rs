//! The debug adapter, driven by a client through its standard input and output.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Stdio};

use serde_json::{Value, json};

use crate::program::{command, toyproof};

struct Client {
    process: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    seq: i64,
    events: Vec<Value>,
}

impl Client {
    fn new(folder: &Path) -> Self {
        let mut command = command(folder);
        command
            .arg("dap")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null());
        let mut process = command.spawn().unwrap();
        Self {
            input: process.stdin.take(),
            output: BufReader::new(process.stdout.take().unwrap()),
            process,
            seq: 0,
            events: Vec::new(),
        }
    }

    /// A session that has stopped at the first line.
    fn launched(folder: &Path, launch: &Value) -> Self {
        let mut client = Self::new(folder);
        client.ok("initialize", json!({"adapterID": "toyproof", "clientID": "test"}));
        let mut arguments = launch.clone();
        arguments["stopOnEntry"] = json!(true);
        client.ok("launch", arguments);
        client.event("initialized");
        client.ok("configurationDone", json!({}));
        client.event("stopped");
        client
    }

    fn receive(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(
                self.output.read_line(&mut line).unwrap() > 0,
                "the session has ended"
            );
            match line.trim_end() {
                "" => break,
                header => length = header.strip_prefix("Content-Length: ").unwrap().parse().unwrap(),
            }
        }
        let mut content = vec![0; length];
        self.output.read_exact(&mut content).unwrap();
        serde_json::from_slice(&content).unwrap()
    }

    fn request(&mut self, command: &str, arguments: Value) -> Value {
        self.seq += 1;
        let mut message = json!({"seq": self.seq, "type": "request", "command": command});
        message["arguments"] = arguments;
        let content = message.to_string();
        let input = self.input.as_mut().unwrap();
        write!(input, "Content-Length: {}\r\n\r\n{content}", content.len()).unwrap();
        loop {
            let message = self.receive();
            if message["type"] == "response" {
                assert_eq!(message["request_seq"], self.seq);
                return message;
            }
            self.events.push(message);
        }
    }

    fn ok(&mut self, command: &str, arguments: Value) -> Value {
        let response = self.request(command, arguments);
        assert_eq!(response["success"], true, "{response}");
        response["body"].clone()
    }

    fn event(&mut self, kind: &str) -> Value {
        loop {
            if let Some(at) = self.events.iter().position(|event| event["event"] == kind) {
                return self.events.remove(at)["body"].clone();
            }
            let message = self.receive();
            self.events.push(message);
        }
    }

    /// The innermost function.
    fn frame(&mut self) -> Value {
        let body = self.ok("stackTrace", json!({"threadId": 1}));
        body["stackFrames"][0].clone()
    }

    /// The texts of the local variables, by name.
    fn locals(&mut self) -> Value {
        let scopes = self.ok("scopes", json!({"frameId": 1}));
        let locals = scopes["scopes"][0]["variablesReference"].clone();
        let body = self.ok("variables", json!({"variablesReference": locals}));
        let variables = body["variables"].as_array().unwrap().iter();
        variables
            .map(|variable| {
                (
                    variable["name"].as_str().unwrap().to_owned(),
                    variable["value"].clone(),
                )
            })
            .collect()
    }

    fn go(&mut self, command: &str) -> Value {
        self.ok(command, json!({"threadId": 1}));
        self.event("stopped")
    }

    /// Disconnects; returns the exit code.
    fn disconnect(mut self) -> i32 {
        self.ok("disconnect", json!({}));
        self.process.wait().unwrap().code().unwrap()
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The numbers of a text such as `(1, 2.5)`.
fn numbers(text: &str) -> Vec<f64> {
    let text = text.split(" (f64").next().unwrap_or_default();
    let parts = text.split(|letter: char| "(), ".contains(letter));
    parts.filter_map(|part| part.parse().ok()).collect()
}

/// Each value that `debug` reports as assigned to a variable is that of the variable at a later stop, in the
/// same order.
#[test]
fn variables_have_the_values_that_debug_reports() {
    let flags = [
        "debug",
        "glsl/03-shading.glsl",
        "--pixel",
        "33,18",
        "--size",
        "64x36",
        "--format",
        "json",
    ];
    let trace = toyproof(root(), &flags);
    let trace: Value = serde_json::from_str(&trace.stdout).unwrap();
    let mut client = Client::launched(
        root(),
        &json!({"program": "glsl/03-shading.glsl", "pixel": [33, 18], "size": [64, 36]}),
    );
    let mut stops = Vec::new();
    loop {
        let frame = client.frame();
        stops.push((frame["name"].clone(), client.locals()));
        if client.go("stepIn")["description"] == "The end of the recording" {
            break;
        }
    }
    assert_eq!(client.disconnect(), 0);
    let is_name = |name: &str| {
        name.chars()
            .all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
    };
    let mut at = 0;
    let mut compared = 0;
    for step in trace["steps"].as_array().unwrap() {
        let Some(name) = step["name"].as_str().filter(|name| is_name(name)) else {
            continue;
        };
        let values: Option<Vec<f64>> = step["f32"]
            .as_array()
            .and_then(|values| values.iter().map(Value::as_f64).collect());
        let Some(values) = values else { continue };
        let is_same = |(function, locals): &(Value, Value)| {
            let text = locals[name].as_str().unwrap_or_default();
            let found = numbers(text);
            *function == step["function"]
                && found.len() == values.len()
                && found.iter().zip(&values).all(|(a, b)| (*a as f32) == (*b as f32))
        };
        // What is assigned last, such as the result, has no later stop in its function.
        let Some(found) = stops[at..].iter().position(is_same) else {
            let is_later = stops[at..].iter().any(|(_, locals)| locals[name].is_string());
            assert!(!is_later || step["function"] == "mainImage", "{step}");
            continue;
        };
        at += found;
        compared += 1;
    }
    assert!(compared > 15, "{compared} of {stops:?}");
}

#[test]
fn errors_of_a_launch_have_the_place_of_the_fault() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("a.glsl"),
        "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(missing);\n}\n",
    )
    .unwrap();
    let mut client = Client::new(folder.path());
    client.ok("initialize", json!({}));
    let message = |client: &mut Client, launch: Value| {
        let response = client.request("launch", launch);
        assert_eq!(response["success"], false, "{response}");
        response["message"].as_str().unwrap().to_owned()
    };
    let error = message(&mut client, json!({"program": "a.glsl", "pixel": [1, 1]}));
    assert!(
        error.contains("a.glsl:2:14") && error.contains("missing"),
        "{error}"
    );
    let output = client.event("output");
    assert!(
        output["output"].as_str().unwrap().contains("vec4(missing)"),
        "{output}"
    );
    let error = message(&mut client, json!({"program": "none.glsl", "pixel": [1, 1]}));
    assert!(error.contains("none.glsl"), "{error}");
    let error = message(&mut client, json!({"program": "a.glsl"}));
    assert!(error.contains("--pixel"), "{error}");
    fs::write(
        folder.path().join("a.glsl"),
        "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(1);\n}\n",
    )
    .unwrap();
    let error = message(
        &mut client,
        json!({"program": "a.glsl", "pixel": [64, 1], "size": [64, 36]}),
    );
    assert!(error.contains("outside the image"), "{error}");
    client.ok(
        "launch",
        json!({"program": "a.glsl", "pixel": [63, 1], "size": [64, 36], "pixle": 1}),
    );
    client.ok("configurationDone", json!({}));
    client.event("stopped");
    assert_eq!(client.frame()["line"], 2);
    assert_eq!(client.disconnect(), 0);
}

#[test]
fn tabs_of_projects_are_sources() {
    let folder = tempfile::tempdir().unwrap();
    let project = folder.path().join("p");
    fs::create_dir(&project).unwrap();
    let write = |name: &str, text: &str| fs::write(project.join(name), text).unwrap();
    write("common.glsl", "float twice(float x) {\n    return 2.0 * x;\n}\n");
    let image = "void mainImage(out vec4 c, in vec2 p) {\n    c = texelFetch(iChannel0, ivec2(p), 0);\n    \
                 c.y = twice(p.x);\n}\n";
    write("image.glsl", image);
    write(
        "buffer-a.glsl",
        "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(twice(p.x));\n}\n",
    );
    let launch = json!({"program": "p", "pixel": [3, 2], "size": [8, 8], "frame": 2});
    let mut client = Client::launched(folder.path(), &launch);
    let common = project.join("common.glsl");
    let breakpoints = json!({"source": {"path": common}, "breakpoints": [{"line": 1}]});
    let set = client.ok("setBreakpoints", breakpoints.clone());
    assert_eq!(set["breakpoints"][0]["line"], 2);
    assert_eq!(client.go("continue")["reason"], "breakpoint");
    let frame = client.frame();
    assert_eq!(frame["name"], "twice");
    assert!(
        frame["source"]["path"].as_str().unwrap().ends_with("common.glsl"),
        "{frame}"
    );
    client.go("stepOut");
    assert_eq!(client.locals()["c"], "(7, 7, 7, 7)");
    assert_eq!(client.disconnect(), 0);
    // A pass, in the site's JSON, whose tabs are no files.
    let exported = toyproof(folder.path(), &["export", "p", "-o", "p.json"]);
    assert_eq!(exported.code, 0, "{}", exported.stderr);
    let launch = json!({"program": "p.json", "pixel": [3, 2], "size": [8, 8], "pass": "buffer-a"});
    let mut client = Client::launched(folder.path(), &launch);
    let source = client.frame()["source"].clone();
    let content = client.ok(
        "source",
        json!({"source": source, "sourceReference": source["sourceReference"]}),
    );
    assert!(
        content["content"].as_str().unwrap().contains("vec4(twice(p.x))"),
        "{content}"
    );
    let sources = client.ok("loadedSources", json!({}));
    assert_eq!(sources["sources"].as_array().unwrap().len(), 2, "{sources}");
    assert_eq!(client.disconnect(), 0);
}

#[test]
fn expected_colors_are_those_of_the_reference() {
    let launch = json!({"program": "glsl/02-sphere.glsl", "pixel": [320, 180]});
    let mut client = Client::launched(root(), &launch);
    let scopes = client.ok("scopes", json!({"frameId": 1}));
    let scopes = scopes["scopes"].as_array().unwrap();
    let outputs = scopes.iter().find(|scope| scope["name"] == "Outputs").unwrap();
    let reference = outputs["variablesReference"].clone();
    let body = client.ok("variables", json!({"variablesReference": reference}));
    let of = |name: &str| {
        let variables = body["variables"].as_array().unwrap();
        let variable = variables.iter().find(|variable| variable["name"] == name);
        numbers(
            variable.unwrap_or_else(|| panic!("{body}"))["value"]
                .as_str()
                .unwrap(),
        )
    };
    let (own, expected) = (of("color of the pixel"), of("color of the reference"));
    assert!(
        (own[0] - expected[0]).abs() < 1e-5 && own[0] > 0.9,
        "{own:?} {expected:?}"
    );
    assert_eq!(client.disconnect(), 0);
}

#[test]
fn long_executions_are_recorded_in_part_and_endless_ones_end() {
    let folder = tempfile::tempdir().unwrap();
    let shader = |count: &str| {
        format!(
            "void mainImage(out vec4 c, in vec2 p) {{\n    for (int i = 0; i < {count}; i++) {{\n        c.x += 1.0;\n    \
             }}\n}}\n"
        )
    };
    fs::write(folder.path().join("long.glsl"), shader("1000000")).unwrap();
    fs::write(folder.path().join("endless.glsl"), shader("2000000000")).unwrap();
    let mut client = Client::launched(folder.path(), &json!({"program": "long.glsl", "pixel": [1, 1]}));
    // After the warning about the loop.
    while !client.event("output")["output"]
        .as_str()
        .unwrap()
        .contains("too long to be recorded")
    {}
    let stopped = client.go("continue");
    assert!(
        stopped["description"].as_str().unwrap().contains("too long"),
        "{stopped}"
    );
    assert_eq!(client.disconnect(), 0);
    let mut client = Client::new(folder.path());
    let launch = json!({"program": "endless.glsl", "pixel": [1, 1], "timeout": "200ms"});
    assert_eq!(client.request("launch", launch)["success"], false);
    // The end of the input ends the program.
    drop(client.input.take());
    assert_eq!(client.process.wait().unwrap().code(), Some(0));
}
