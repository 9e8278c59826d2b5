//! Reads a project from a tree of values, and reports errors in it.

use toyproof_diagnostic::{Diagnostic, Diagnostics, File, FileId, Files, nearest, one_of};
use toyproof_glsl::{Filter, Wrap};
use toyproof_player::BufferFormat;

use crate::format::{Format, Wrapper};
use crate::json;
use crate::media::{self, CUBE_A_FILE, CUBE_A_ID};
use crate::node::{Node, Value};
use crate::pass::{Buffer, Input, MAX_TAB_BYTES, Pass, PassKind, Sampler, Source, SourceType, Tab};
use crate::project::{Document, Project};
use crate::textures::LoadedMedia;

/// The maximum number of errors that are reported for one file: more scroll off the screen.
const MAX_ERRORS: usize = 20;

/// The version of the site's JSON, which its loader requires.
const VERSION: &str = "0.1";

impl Project {
    /// Reads the site's JSON: of its API, of its page data, or of the editor's export. The texts of the tabs
    /// are added to `files`, named as files in a folder that has the name of the JSON.
    ///
    /// # Errors
    /// The first error of the syntax, or those of the content.
    pub fn from_json(files: &mut Files, file: FileId) -> Result<Self, Diagnostics> {
        let root = json::parse(files, file).map_err(|error| Diagnostics::new(vec![*error], files))?;
        let (mut root, wrapper) = unwrap(root).map_err(|error| Diagnostics::new(vec![*error], files))?;
        let format = Format::detect(&root, wrapper);
        let folder = files.get(file).name().to_owned();
        let mut errors = Vec::new();
        let result = read(&mut root, &mut errors, |tab, pass, errors| {
            let text = code(pass).map_err(|error| errors.push(*error)).ok()?;
            Some(files.add(File::new(format!("{folder}/{}", tab.file_name()), text)))
        });
        let Some(Renderpass { common, passes, tabs }) = result.filter(|_| errors.is_empty()) else {
            errors.truncate(MAX_ERRORS);
            return Err(Diagnostics::new(errors, files));
        };
        Ok(Self {
            common,
            passes,
            knows_inputs: true,
            uniforms: Vec::new(),
            media: LoadedMedia::default(),
            document: Document {
                root,
                format,
                wrapper,
                tabs,
            },
        })
    }

    /// Formats the project as the site's JSON, in the variant that it was read from.
    #[must_use]
    pub fn to_json(&self, files: &Files) -> String {
        let Document {
            root, wrapper, tabs, ..
        } = &self.document;
        let mut root = root.clone();
        if let Some(Value::Array(passes)) = root.get_mut("renderpass").map(|passes| &mut passes.value) {
            for (pass, (_, file)) in passes.iter_mut().zip(tabs) {
                if let Some(code) = pass.get_mut("code") {
                    *code = files.get(*file).text().into();
                }
            }
        }
        json::write(&match wrapper {
            Wrapper::None => root,
            Wrapper::Array => vec![root].into(),
            Wrapper::Shader => [("Shader", root)].into(),
        })
    }

    /// Whether a text seems to be the site's JSON.
    #[must_use]
    pub fn is_json(text: &str) -> bool {
        text.trim_start().starts_with(['{', '[']) && text.contains("\"renderpass\"")
    }
}

/// Advice for a file that is not the site's JSON.
const EXPECTED: &str = "expected ShaderToy's JSON: of its API, of its page data, or of the editor's export";

/// Removes the structure around the JSON.
fn unwrap(root: Node) -> Result<(Node, Wrapper), Box<Diagnostic>> {
    match root.value {
        Value::Array(mut nodes) if nodes.len() == 1 && nodes[0].is_object() => {
            Ok((nodes.swap_remove(0), Wrapper::Array))
        }
        Value::Object(ref members)
            if root.get("Shader").is_some_and(Node::is_object) && members.len() == 1 =>
        {
            Ok((root.get("Shader").cloned().unwrap_or(root), Wrapper::Shader))
        }
        Value::Object(_) => match root.get("Error") {
            Some(error) => {
                let text = error.as_str().unwrap_or_default();
                let message = format!("ShaderToy's API answered with an error instead of a shader: {text}");
                let help =
                    "the API has only shaders that are published as `public + api`; use the editor's export";
                Err(error.error(message).help(help).into())
            }
            None => Ok((root, Wrapper::None)),
        },
        _ => {
            let message = format!("a project must be an object, found {}", root.describe());
            Err(root.error(message).help(EXPECTED).into())
        }
    }
}

/// Takes the code out of a pass.
fn code(pass: &mut Node) -> Result<String, Box<Diagnostic>> {
    let missing = pass.error("missing key `code` in a pass");
    let Some(code) = pass.get_mut("code") else {
        return Err(missing.help("add the code of the tab, which may be empty").into());
    };
    let Some(text) = code.as_str() else {
        return Err(code
            .error(format!("`code` must be a string, found {}", code.describe()))
            .into());
    };
    if text.len() > MAX_TAB_BYTES {
        let message = "the code of this tab is larger than 1 MiB";
        return Err(code
            .error(message)
            .help("ShaderToy's editor takes 65,536 characters")
            .into());
    }
    let text = text.to_owned();
    code.value = Value::String(String::new());
    Ok(text)
}
const _: () = assert!(MAX_TAB_BYTES == 1 << 20);

/// The contents of `renderpass`.
pub(crate) struct Renderpass {
    pub(crate) common: Option<FileId>,
    pub(crate) passes: Vec<Pass>,
    pub(crate) tabs: Vec<(Tab, FileId)>,
}

/// Reads the passes of a document. `text` takes the text of a tab out of its node, or reports why there is
/// none.
pub(crate) fn read(
    root: &mut Node,
    errors: &mut Vec<Diagnostic>,
    mut text: impl FnMut(Tab, &mut Node, &mut Vec<Diagnostic>) -> Option<FileId>,
) -> Option<Renderpass> {
    match root.get("ver") {
        Some(ver) if ver.as_str() != Some(VERSION) => {
            let help = format!("ShaderToy loads only version \"{VERSION}\"");
            errors.push(ver.error("unknown version of ShaderToy's JSON").help(help));
        }
        _ => {}
    }
    let missing = root.error("missing key `renderpass`, the list of the passes");
    let Some(renderpass) = root.get_mut("renderpass") else {
        errors.push(missing.help(EXPECTED));
        return None;
    };
    let wrong = renderpass.error(format!(
        "the passes must be a list, found {}",
        renderpass.describe()
    ));
    // Built here because `root` is borrowed mutably below.
    let no_image = renderpass.error("there is no pass of the type `image`");
    let Value::Array(nodes) = &mut renderpass.value else {
        errors.push(wrong);
        return None;
    };
    let mut found = Renderpass {
        common: None,
        passes: Vec::new(),
        tabs: Vec::new(),
    };
    for node in nodes {
        let tab = match tab(node) {
            Ok(tab) => tab,
            Err(error) => {
                errors.push(*error);
                continue;
            }
        };
        if found.tabs.iter().any(|(other, _)| *other == tab) {
            let error = node.error(format!("there are two passes for {tab}"));
            errors.push(error.help("remove one of them; the second one would replace the first"));
            continue;
        }
        let inputs = inputs(node, errors);
        let Some(file) = text(tab, node, errors) else {
            continue;
        };
        found.tabs.push((tab, file));
        match tab {
            Tab::Common => found.common = Some(file),
            Tab::Pass(kind) => found.passes.push(Pass {
                kind,
                file,
                inputs,
                format: BufferFormat::default(),
            }),
        }
    }
    if errors.is_empty() && !found.passes.iter().any(|pass| pass.kind == PassKind::Image) {
        errors.push(no_image.help("add one, which shows what the other passes compute"));
    }
    Some(found)
}

/// The tab that an element of `renderpass` describes.
fn tab(pass: &Node) -> Result<Tab, Box<Diagnostic>> {
    if !pass.is_object() {
        return Err(pass
            .error(format!("a pass must be an object, found {}", pass.describe()))
            .into());
    }
    let Some(kind) = pass.get("type") else {
        let help = "add `\"type\": \"image\"`, or buffer, common, cubemap or sound";
        return Err(pass.error("missing key `type` in a pass").help(help).into());
    };
    match kind.as_str() {
        Some("image") => Ok(Tab::Pass(PassKind::Image)),
        Some("common") => Ok(Tab::Common),
        Some("sound") => Ok(Tab::Pass(PassKind::Sound)),
        Some("cubemap") => Ok(Tab::Pass(PassKind::CubeA)),
        Some("buffer") => buffer(pass).map(|buffer| Tab::Pass(PassKind::Buffer(buffer))),
        Some(other) => {
            let known = ["image", "buffer", "common", "cubemap", "sound"];
            let message = format!("unknown type `{other}` of a pass");
            Err(kind.error(message).help(suggestion(other, &known)).into())
        }
        None => {
            let message = format!("`type` must be a string, found {}", kind.describe());
            Err(kind.error(message).into())
        }
    }
}

/// The buffer that a pass writes: that of its output's id. The output's name is only a label, and often names
/// another buffer.
fn buffer(pass: &Node) -> Result<Buffer, Box<Diagnostic>> {
    let Some(outputs) = pass.get("outputs") else {
        return Err(pass
            .error("missing key `outputs` of a buffer")
            .help(BUFFER_IDS)
            .into());
    };
    let first = outputs.as_array().and_then(<[Node]>::first);
    let Some(id) = first.and_then(|output| output.get("id")) else {
        let message = "`outputs` of a buffer must be a list with an object that has an `id`";
        return Err(outputs.error(message).help(BUFFER_IDS).into());
    };
    let text = text_of(id).unwrap_or_default();
    media::buffer(&text, "").ok_or_else(|| not_buffer(id))
}

/// Advice on the id of a buffer.
const BUFFER_IDS: &str = "the id of Buffer A is \"4dXGR8\" or 257, of B \"XsXGR8\" or 258, of C \"4sXGR8\" or 259, of D \
                          \"XdfGR8\" or 260";

fn not_buffer(id: &Node) -> Box<Diagnostic> {
    Box::new(id.error("this is not the id of a buffer").help(BUFFER_IDS))
}

/// The text of an id, which may be a number.
fn text_of(id: &Node) -> Option<String> {
    match &id.value {
        Value::String(text) | Value::Number(text) => Some(text.clone()),
        _ => None,
    }
}

fn inputs(pass: &Node, errors: &mut Vec<Diagnostic>) -> [Option<Input>; 4] {
    let mut inputs = [const { None }; 4];
    let Some(list) = pass.get("inputs") else {
        return inputs;
    };
    let Some(nodes) = list.as_array() else {
        errors.push(list.error(format!("`inputs` must be a list, found {}", list.describe())));
        return inputs;
    };
    for node in nodes {
        match input(node) {
            Ok((channel, input)) if inputs[channel].is_none() => inputs[channel] = Some(input),
            Ok((channel, _)) => {
                let error = node.error(format!("iChannel{channel} has two inputs"));
                errors.push(error.help("remove one of them, or change its `channel`"));
            }
            Err(error) => errors.push(*error),
        }
    }
    inputs
}

/// An input, and the number of its channel.
fn input(node: &Node) -> Result<(usize, Input), Box<Diagnostic>> {
    if !node.is_object() {
        return Err(node
            .error(format!("an input must be an object, found {}", node.describe()))
            .into());
    }
    let required = |key: &str| node.get(key).ok_or_else(|| missing(node, key));
    let channel = required("channel")?;
    let number = match &channel.value {
        Value::Number(number) => number.parse().ok().filter(|channel| *channel < 4),
        _ => None,
    };
    let Some(number) = number else {
        return Err(channel.error("`channel` must be 0, 1, 2 or 3").into());
    };
    let kind = node.get("ctype").or_else(|| node.get("type"));
    let kind = kind.ok_or_else(|| missing(node, "type"))?;
    let name = kind.as_str().unwrap_or_default();
    let Some(&(_, source_type)) = SourceType::NAMES.iter().find(|(known, _)| *known == name) else {
        let known = SourceType::NAMES.map(|(known, _)| known);
        let error = kind.error(format!("unknown type `{name}` of an input"));
        return Err(error.help(suggestion(name, &known)).into());
    };
    let id = required("id")?;
    let id_text = text_of(id).ok_or_else(|| {
        Box::new(id.error(format!(
            "`id` must be a string or a number, found {}",
            id.describe()
        )))
    })?;
    let path = node
        .get("src")
        .or_else(|| node.get("filepath"))
        .and_then(Node::as_str);
    let path = path.unwrap_or_default();
    let source = match source_type {
        SourceType::Buffer => Source::Buffer(media::buffer(&id_text, path).ok_or_else(|| not_buffer(id))?),
        SourceType::Cubemap if id_text == CUBE_A_ID || path.ends_with(CUBE_A_FILE) => Source::CubeA,
        SourceType::Keyboard => Source::Keyboard,
        SourceType::Webcam => Source::Webcam,
        SourceType::Mic => Source::Mic,
        source_type => Source::Medium {
            source_type,
            id: id_text,
            path: path.to_owned(),
        },
    };
    let sampler = match node.get("sampler") {
        Some(sampler) => self::sampler(sampler, source_type)?,
        None => default_sampler(source_type),
    };
    let span = node.span;
    Ok((
        number,
        Input {
            source,
            sampler,
            span,
        },
    ))
}

fn missing(node: &Node, key: &str) -> Box<Diagnostic> {
    Box::new(node.error(format!("missing key `{key}` in an input")))
}

/// The sampler of a new input on the site.
pub(crate) fn default_sampler(source_type: SourceType) -> Sampler {
    let (filter, wrap, vflip) = match source_type {
        SourceType::Texture => (Filter::Mipmap, Wrap::Repeat, true),
        SourceType::Cubemap => (Filter::Mipmap, Wrap::Clamp, false),
        SourceType::Volume => (Filter::Mipmap, Wrap::Repeat, false),
        SourceType::Keyboard => (Filter::Nearest, Wrap::Clamp, true),
        _ => (Filter::Linear, Wrap::Clamp, true),
    };
    Sampler {
        filter,
        wrap,
        vflip,
        srgb: false,
    }
}

/// The values of `filter`: the site treats an unknown one as nearest.
const FILTERS: [(&str, Filter); 4] = [
    ("nearest", Filter::Nearest),
    ("linear", Filter::Linear),
    ("mipmap", Filter::Mipmap),
    ("none", Filter::Nearest),
];

/// The values of `wrap`: everything but `clamp` repeats.
const WRAPS: [(&str, Wrap); 4] = [
    ("clamp", Wrap::Clamp),
    ("repeat", Wrap::Repeat),
    ("mirror", Wrap::Repeat),
    ("none", Wrap::Repeat),
];

fn sampler(node: &Node, source_type: SourceType) -> Result<Sampler, Box<Diagnostic>> {
    if !node.is_object() {
        return Err(node
            .error(format!("`sampler` must be an object, found {}", node.describe()))
            .into());
    }
    let default = default_sampler(source_type);
    Ok(Sampler {
        filter: choice(node, "filter", &FILTERS)?.unwrap_or(default.filter),
        wrap: choice(node, "wrap", &WRAPS)?.unwrap_or(default.wrap),
        vflip: flag(node, "vflip")?.unwrap_or(default.vflip),
        srgb: flag(node, "srgb")?.unwrap_or(default.srgb),
    })
}

fn choice<T: Copy>(
    node: &Node,
    key: &str,
    choices: &[(&'static str, T)],
) -> Result<Option<T>, Box<Diagnostic>> {
    let Some(value) = node.get(key) else {
        return Ok(None);
    };
    let name = value.as_str().unwrap_or_default();
    if let Some((_, choice)) = choices.iter().find(|(known, _)| *known == name) {
        return Ok(Some(*choice));
    }
    let known: Vec<_> = choices.iter().map(|(known, _)| *known).collect();
    let error = value.error(format!("unknown `{key}` of a sampler"));
    Err(error.help(suggestion(name, &known)).into())
}

/// A Boolean, which the site writes as a string.
fn flag(node: &Node, key: &str) -> Result<Option<bool>, Box<Diagnostic>> {
    let Some(value) = node.get(key) else {
        return Ok(None);
    };
    match &value.value {
        Value::Bool(value) => Ok(Some(*value)),
        Value::String(text) if text == "true" => Ok(Some(true)),
        Value::String(text) if text == "false" => Ok(Some(false)),
        _ => Err(value
            .error(format!("`{key}` must be \"true\" or \"false\""))
            .into()),
    }
}

/// Advice on an unknown name.
fn suggestion(name: &str, known: &[&'static str]) -> String {
    match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("expected {}", one_of(known)),
    }
}
