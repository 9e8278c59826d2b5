//! ISF: one text for all passes behind a header in JSON, <https://docs.isf.video/ref_json.html>.
//!
//! Hosts render the `PASSES` in their order, each with the whole text and its number in `PASSINDEX`. A target
//! that is `PERSISTENT` keeps its content, so that a pass that reads it before it is rendered gets that of
//! the last frame. Hosts filter all images linearly, up to their edges.

use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;
use std::time::Duration;

use serde::Serialize;
use serde_json::{Value, json};
use toyproof_diagnostic::{Deadline, File, FileId, Files, short};
use toyproof_glsl::tree::{Scalar, Type};
use toyproof_glsl::{self as glsl, Checked, Dialect, Filter, Options, Sampling, Version, Wrap};
use toyproof_image::{Frame, Input};
use toyproof_player::{BUFFERS, BufferFormat, Graph, Pass, Source as Read, Target};
use toyproof_project::{self as project, Declared, PassKind, with_declarations};

use super::words::{macros, replaced, words};
use super::{Passes, ReadPasses};
use crate::Converter;
use crate::graph::{SourceEntry, target_name as graph_name};
use crate::passes::GraphContent;
use crate::project::ProjectError;

/// The inputs of the mouse.
const MOUSE: [&str; 2] = ["mouse", "mouseDown"];

/// The definition that stands in front of passes that read it.
const HW_PERFORMANCE: &str = "#define HW_PERFORMANCE 1\n";

/// The longest description, in characters.
const MAX_DESCRIPTION: usize = 200;

#[derive(Clone, Serialize)]
#[serde(rename_all = "UPPERCASE")]
struct Header {
    description: String,
    isfvsn: &'static str,
    categories: [&'static str; 1],
    inputs: Vec<InputRow>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    passes: Vec<PassRow>,
}

/// An input of a header, with the numbers between which a host's slider runs.
#[derive(Clone, PartialEq, Serialize)]
#[serde(rename_all = "UPPERCASE")]
struct InputRow {
    name: String,
    #[serde(rename = "TYPE")]
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    default: Option<Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    min: Option<Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    max: Option<Value>,
}

impl InputRow {
    fn new(name: &str, kind: &'static str) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            default: None,
            min: None,
            max: None,
        }
    }

    fn image(name: &str) -> Self {
        Self::new(name, "image")
    }

    fn with_default(self, value: Value) -> Self {
        Self {
            default: Some(value),
            ..self
        }
    }

    fn between(self, min: Value, max: Value) -> Self {
        Self {
            min: Some(min),
            max: Some(max),
            ..self
        }
    }
}

/// A pass of a header; of the image, it has no target.
#[derive(Clone, Serialize)]
#[serde(rename_all = "UPPERCASE")]
struct PassRow {
    #[serde(skip_serializing_if = "Option::is_none")]
    target: Option<String>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    persistent: bool,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    float: bool,
}

/// Writes the file; `name` is that of the shader.
pub(super) fn write(converter: &Converter, passes: &Passes, name: &str) -> Result<String, ProjectError> {
    check_graph(passes)?;
    let texts = converter.port_passes(passes, Dialect::Isf, &[Version::Desktop(150)])?;
    let images = images(passes);
    let texts: Vec<String> = (0..)
        .zip(&texts)
        .map(|(pass, text)| replaced(text, &channel_names(passes, pass, &images)))
        .collect();
    let mut inputs: Vec<_> = images.iter().map(|(name, _)| InputRow::image(name)).collect();
    let reads_mouse = passes
        .sources
        .iter()
        .any(|source| source.checked.reads_input(Input::Mouse));
    if reads_mouse {
        let [position, button] = MOUSE;
        let position = InputRow::new(position, "point2D").with_default(json!([0.0, 0.0]));
        inputs.push(position.between(json!([0.0, 0.0]), json!([1.0, 1.0])));
        inputs.push(InputRow::new(button, "bool").with_default(json!(false)));
    }
    for source in &passes.sources {
        for (name, ty, value) in source.checked.declared_uniforms() {
            let Some(value) = value else { continue };
            let input = own_input(name, ty, value).ok_or_else(|| {
                ProjectError::Unwritable(format!(
                    "the uniform `{name}` has a type that inputs of ISF do not have"
                ))
            })?;
            if !inputs.contains(&input) {
                inputs.push(input);
            }
        }
    }
    let category = if images.is_empty() { "Generator" } else { "Filter" };
    let header = Header {
        description: description(passes, name),
        isfvsn: "2",
        categories: [category],
        inputs,
        passes: if texts.len() > 1 { rows(passes) } else { Vec::new() },
    };
    let body = match &texts[..] {
        [text] => text.clone(),
        texts => merged(passes, texts, &header, converter.timeout)?,
    };
    let text = format!("{}\n\n{body}", header_text(&header));
    // Whatever the host's language does not have is found here.
    read(&text, passes, converter.timeout).map_err(ProjectError::Unwritable)?;
    Ok(text)
}

/// Refuses what ISF does not have.
fn check_graph(passes: &Passes) -> Result<(), ProjectError> {
    let refuse = |pass: usize, what: &str| {
        let why = format!("{} {what}, which ISF does not have", passes.kinds[pass]);
        Err(ProjectError::Unwritable(why))
    };
    for (pass, source) in passes.sources.iter().enumerate() {
        let checked = source.checked;
        if passes.sources.len() > 1 && checked.discards() {
            return refuse(pass, "has `discard`, after which a pixel keeps an earlier value");
        }
        for channel in passes.channels(pass) {
            let Some(entry) = &passes.entries[pass][channel] else {
                continue;
            };
            match &entry.source {
                SourceEntry::Keyboard { .. } => return refuse(pass, "reads the keyboard"),
                SourceEntry::Media { kind, .. } if !matches!(&**kind, "texture" | "video" | "webcam") => {
                    return refuse(pass, &format!("reads a {kind}"));
                }
                SourceEntry::Buffer { buffer, .. }
                    if !passes.targets().any(|target| graph_name(target) == buffer) =>
                {
                    return refuse(pass, "reads a buffer that no pass renders");
                }
                // A texel is the same whatever the sampler.
                SourceEntry::Buffer { .. } if fetches_only(checked) => {}
                SourceEntry::Buffer { .. } if entry.filter == Filter::Mipmap => {
                    return refuse(pass, "reads mipmaps of a buffer");
                }
                SourceEntry::Buffer { .. } if entry.filter == Filter::Nearest => {
                    return refuse(pass, "reads a buffer with the filter `nearest`");
                }
                SourceEntry::Buffer { .. } if entry.wrap == Wrap::Repeat => {
                    return refuse(pass, "reads a buffer that repeats");
                }
                SourceEntry::Media { .. } | SourceEntry::Buffer { .. } => {}
            }
        }
    }
    Ok(())
}

/// Whether a shader reads textures by `texelFetch` only.
fn fetches_only(checked: &Checked) -> bool {
    !checked.samples_textures()
}

/// The images that the passes read: their names, and a pass and its channel.
fn images(passes: &Passes) -> Vec<(String, (usize, usize))> {
    let mut images: Vec<(String, (usize, usize))> = Vec::new();
    for pass in 0..passes.sources.len() {
        for channel in passes.channels(pass) {
            let entry = &passes.entries[pass][channel];
            if matches!(
                entry.as_ref().map(|entry| &entry.source),
                Some(SourceEntry::Buffer { .. })
            ) {
                continue;
            }
            if passes.sources.len() == 1 {
                images.push((format!("iChannel{channel}"), (pass, channel)));
                continue;
            }
            let is_known = |(_, (of_pass, of_channel)): &(String, (usize, usize))| {
                let known = &passes.entries[*of_pass][*of_channel];
                known.as_ref().map(|known| &known.source) == entry.as_ref().map(|entry| &entry.source)
            };
            if !images.iter().any(is_known) {
                images.push((format!("image{}", images.len()), (pass, channel)));
            }
        }
    }
    images
}

/// The names of targets.
fn target_name(target: Target) -> String {
    match target {
        Target::Image => "image".to_owned(),
        Target::Buffer(number) => format!("buffer{}", char::from(b'A' + number as u8)),
    }
}

/// The names of what the channels of a pass read.
fn channel_names(
    passes: &Passes,
    pass: usize,
    images: &[(String, (usize, usize))],
) -> HashMap<String, String> {
    let name = |channel: usize| {
        let entry = passes.entries[pass][channel].as_ref();
        let name = match (
            passes.graph.passes()[pass].inputs[channel],
            entry.map(|entry| &entry.source),
        ) {
            (Some(Read::Buffer(number)), _) => target_name(Target::Buffer(number)),
            (_, source) => {
                let is_it = |(_, (of_pass, of_channel)): &&(String, (usize, usize))| {
                    let known = passes.entries[*of_pass][*of_channel].as_ref();
                    passes.sources.len() > 1 && known.map(|known| &known.source) == source
                };
                match images.iter().find(is_it) {
                    Some((name, _)) => name.clone(),
                    None => format!("iChannel{channel}"),
                }
            }
        };
        (format!("iChannel{channel}"), name)
    };
    let names: HashMap<String, String> = passes.channels(pass).map(name).collect();
    // Each channel has a function of its own.
    let is_single = |image: &String| names.values().filter(|name| *name == image).count() == 1;
    let functions = names.iter().filter(|(_, image)| is_single(image));
    let functions = functions.map(|(channel, image)| (format!("{channel}Texel"), format!("{image}Texel")));
    functions.chain(names.clone()).collect()
}

/// An input for an author's uniform.
fn own_input(name: &str, ty: Type, value: &[f64]) -> Option<InputRow> {
    let first = value.first().copied().unwrap_or_default();
    Some(match ty {
        Type::Scalar(Scalar::Float) => {
            let [low, high] = [first.min(0.0), first.max(1.0)];
            let input = InputRow::new(name, "float").with_default(json!(first));
            input.between(json!(low), json!(high))
        }
        Type::Scalar(Scalar::Int) => InputRow::new(name, "long").with_default(json!(first as i32)),
        Type::Scalar(Scalar::Bool) => InputRow::new(name, "bool").with_default(json!(first != 0.0)),
        Type::Vector(Scalar::Float, size @ (2 | 4)) => {
            let kind = if size == 2 { "point2D" } else { "color" };
            let zeros = vec![0.0; usize::from(size)];
            let value = if value.is_empty() { &zeros } else { value };
            InputRow::new(name, kind).with_default(json!(value))
        }
        _ => return None,
    })
}

/// The first comment of the image, or the name.
fn description(passes: &Passes, name: &str) -> String {
    let image = passes.sources.last().map_or("", |source| source.text());
    let lines = image.trim_start().lines();
    let comment = lines.map_while(|line| line.trim().strip_prefix("//"));
    let comment: Vec<_> = comment.map(|line| line.trim_matches(['/', ' ', '\t'])).collect();
    let text = comment.join(" ");
    let text = text.trim();
    let text = if text.is_empty() { name } else { text };
    text.chars()
        .filter(|c| !c.is_control())
        .take(MAX_DESCRIPTION)
        .collect()
}

/// The rows of `PASSES`.
fn rows(passes: &Passes) -> Vec<PassRow> {
    let graph = passes.graph.passes();
    let row = |(at, pass): (usize, &Pass)| {
        let Target::Buffer(number) = pass.target else {
            return PassRow {
                target: None,
                persistent: false,
                float: false,
            };
        };
        // A pass up to its own reads what it rendered in the last frame.
        let reads = |pass: &Pass| pass.inputs.contains(&Some(Read::Buffer(number)));
        let is_persistent = graph[..=at].iter().any(reads);
        PassRow {
            target: Some(target_name(pass.target)),
            persistent: is_persistent,
            float: true,
        }
    };
    graph.iter().enumerate().map(row).collect()
}

fn header_text(header: &Header) -> String {
    let mut bytes = Vec::new();
    let formatter = serde_json::ser::PrettyFormatter::with_indent(b"    ");
    let mut serializer = serde_json::Serializer::with_formatter(&mut bytes, formatter);
    // Strings, lists and numbers always serialize.
    let _ = header.serialize(&mut serializer);
    // The end of the comment would end the header.
    format!("/*{}*/", String::from_utf8_lossy(&bytes).replace("*/", "*\\/"))
}

/// One text for all passes: Common, the passes with names of their own, and a function that calls one of
/// them.
fn merged(
    passes: &Passes,
    texts: &[String],
    header: &Header,
    timeout: Duration,
) -> Result<String, ProjectError> {
    let common = passes
        .common
        .map(|common| common.replace("\r\n", "\n").trim().to_owned());
    let common = common.filter(|common| texts.iter().all(|text| text.contains(&**common)));
    let common = common.unwrap_or_default();
    let bodies: Vec<String> = texts.iter().map(|text| text.replacen(&common, "", 1)).collect();
    let body_words: Vec<HashSet<&str>> = bodies.iter().map(|body| words(body)).collect();
    let all_words: HashSet<&str> = body_words
        .iter()
        .flatten()
        .copied()
        .chain(words(&common))
        .collect();
    let mut merged = if words(&common).contains("HW_PERFORMANCE") {
        format!("{HW_PERFORMANCE}{common}")
    } else {
        common.clone()
    };
    let is_defined = merged.starts_with(HW_PERFORMANCE);
    let mut calls = String::new();
    for (at, (body, target)) in bodies.iter().zip(passes.targets()).enumerate() {
        let suffix = match target {
            Target::Image => "Image".to_owned(),
            Target::Buffer(number) => char::from(b'A' + number as u8).to_string(),
        };
        let own = own_names(&alone(passes, header, &texts[at]), &common, timeout);
        let own = own.map_err(ProjectError::Unwritable)?;
        let others = |name: &str| {
            let mut others = body_words.iter().enumerate().filter(|(other, _)| *other != at);
            others.any(|(_, words)| words.contains(name))
        };
        let own = own.into_iter().chain(macros(body).map(str::to_owned));
        let mut names: HashMap<String, String> = HashMap::new();
        let is_kept = |name: &str| is_defined && name == "HW_PERFORMANCE";
        for name in own.filter(|name| (others(name) || name == "main") && !is_kept(name)) {
            let mut fresh = if name == "main" {
                format!("render{suffix}")
            } else {
                format!("{name}{suffix}")
            };
            while all_words.contains(&*fresh) {
                fresh.push('_');
            }
            names.insert(name, fresh);
        }
        let main = names.get("main").cloned().unwrap_or_default();
        let body = body.replacen(HW_PERFORMANCE, if is_defined { "" } else { HW_PERFORMANCE }, 1);
        let body = replaced(&body, &names);
        merged = format!(
            "{}\n\n// {}\n\n{}\n",
            merged.trim_end(),
            passes.kinds[at],
            body.trim()
        );
        let condition = match at {
            0 => "    if (PASSINDEX == 0)".to_owned(),
            _ if at + 1 == bodies.len() => " else".to_owned(),
            _ => format!(" else if (PASSINDEX == {at})"),
        };
        let _ = write!(calls, "{condition} {{\n        {main}();\n    }}");
    }
    Ok(format!("{}\nvoid main() {{\n{calls}\n}}\n", merged.trim_start()))
}

/// The text of a pass as a shader of its own, which reads targets as images.
fn alone(passes: &Passes, header: &Header, text: &str) -> String {
    let targets = passes.targets().filter(|target| *target != Target::Image);
    let targets = targets.map(|target| InputRow::image(&target_name(target)));
    let words = words(text);
    let inputs = header.inputs.iter().cloned().chain(targets);
    let alone = Header {
        passes: Vec::new(),
        inputs: inputs.filter(|input| words.contains(&*input.name)).collect(),
        ..header.clone()
    };
    format!("{}\n{text}", header_text(&alone))
}

/// The functions, structures and global variables that a text declares outside of Common.
fn own_names(text: &str, common: &str, timeout: Duration) -> Result<Vec<String>, String> {
    let mut files = Files::default();
    let file = files.add(File::new("written", text));
    let mut options = options(timeout);
    let declared = with_declarations(&mut files, file, &mut options).map_err(|errors| errors.to_string())?;
    let Declared::Shader(joined) = declared else {
        return Err("it has passes".to_owned());
    };
    let checked = check(&files, joined, &options)?;
    let before = files.get(joined).text().len() - text.len();
    let start = text.find(common).unwrap_or_default() + before;
    let of_common = start..start + common.len();
    let names = checked.global_names();
    let own = names.filter(|(_, at)| *at as usize >= before && !of_common.contains(&(*at as usize)));
    let own = own.filter(|(name, _)| !name.is_empty());
    Ok(own.map(|(name, _)| name.to_owned()).collect())
}

fn options(timeout: Duration) -> Options {
    Options {
        dialect: Some(Dialect::Isf),
        deadline: Deadline::after(timeout),
        ..Options::default()
    }
}

fn check(files: &Files, file: FileId, options: &Options) -> Result<Checked, String> {
    glsl::check(files, file, options).map_err(|errors| {
        let first = errors.first().map(|error| short(error, files));
        format!("ISF does not compile it: {}", first.unwrap_or_default())
    })
}

/// Reads the passes from a file. The mouse is an input of the host.
pub(super) fn read(text: &str, passes: &Passes, timeout: Duration) -> Result<ReadPasses, String> {
    let mut files = Files::default();
    let file = files.add(File::new("written", text));
    let mut options = options(timeout);
    let declared = with_declarations(&mut files, file, &mut options).map_err(|errors| errors.to_string())?;
    options
        .uniforms
        .retain(|uniform| !MOUSE.contains(&&*uniform.name));
    let images = images(passes);
    let mut codes = Vec::new();
    let mut graph = Vec::new();
    let mut sampling = Vec::new();
    let originals: Vec<Target> = passes.targets().collect();
    match declared {
        Declared::Shader(file) => {
            check(&files, file, &options)?;
            codes.push(files.get(file).text().to_owned());
            graph.push(Pass {
                target: Target::Image,
                inputs: [None; 4],
            });
            sampling.push(passes.sources[0].checked.sampling);
        }
        Declared::Project(project) => {
            let checked =
                project::check(&project, &mut files, &options).map_err(|errors| errors.to_string())?;
            let rendering = project
                .rendering(&[PassKind::Image])
                .map_err(|error| error.to_string())?;
            if rendering.passes.len() != originals.len() {
                return Err("other passes than the shader's".to_owned());
            }
            // Buffers are numbered in the order of the header.
            let read_targets: Vec<Target> = rendering.graph.passes().iter().map(|pass| pass.target).collect();
            let original = |target: Target| {
                let at = read_targets.iter().position(|known| *known == target);
                at.map(|at| originals[at])
            };
            for (at, (&number, pass)) in rendering.passes.iter().zip(rendering.graph.passes()).enumerate() {
                let tree = &checked.passes[number].checked.tree;
                let file = tree[checked.passes[number].checked.main_image].at.span.file;
                let text = files.get(file).text().to_owned();
                let declared = text
                    .lines()
                    .filter_map(|line| line.strip_prefix("uniform sampler2D ")?.strip_suffix(';'));
                let declared: Vec<&str> = declared.collect();
                let mut inputs = [None; 4];
                let mut samplers = [Sampling {
                    filter: Filter::Linear,
                    wrap: Wrap::Clamp,
                }; 4];
                for channel in 0..4 {
                    if let Some(Read::Buffer(buffer)) = pass.inputs[channel] {
                        let Some(Target::Buffer(buffer)) = original(Target::Buffer(buffer)) else {
                            return Err("a pass reads an unknown buffer".to_owned());
                        };
                        inputs[channel] = Some(Read::Buffer(buffer));
                        // The sampler does not matter for texels, which hosts read at their centers.
                        if fetches_only(passes.sources[at].checked) {
                            samplers[channel].filter = Filter::Nearest;
                        }
                    } else if let Some(name) = declared.get(channel)
                        && let Some((_, (of_pass, of_channel))) =
                            images.iter().find(|(image, _)| image == name)
                    {
                        inputs[channel] = passes.graph.passes()[*of_pass].inputs[*of_channel];
                        samplers[channel] = passes.sources[*of_pass].checked.sampling[*of_channel];
                    }
                }
                codes.push(text.clone());
                graph.push(Pass {
                    target: originals[at],
                    inputs,
                });
                sampling.push(samplers);
            }
        }
    }
    let formats: [BufferFormat; BUFFERS] = Default::default();
    Ok(ReadPasses {
        codes,
        dialect: Dialect::Isf,
        content: GraphContent {
            graph: Graph::new(graph, formats),
            sampling,
        },
    })
}

/// A frame with a mouse that the inputs of the header can describe to the bit: at an eighth of the image, and
/// where it was clicked is where it is.
pub(super) fn with_its_mouse(frame: Frame) -> Frame {
    let [width, height] = frame.size.map(|side| side as f32);
    let eighth = |place: f32, side: f32| (place / side * 8.0).round() / 8.0 * side;
    let [x, y, click, _] = frame.mouse;
    let (x, y) = (eighth(x, width), eighth(y, height));
    let sign = if click > 0.0 { 1.0 } else { -1.0 };
    Frame {
        mouse: [x, y, sign * x, sign * y],
        ..frame
    }
}
