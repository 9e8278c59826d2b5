//! An ES module for three.js: the template `three.js` with the shaders as template literals, and a table of
//! passes.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use toyproof_glsl::tree::{SamplerShape, Type};
use toyproof_glsl::{Dialect, Filter, Sampling, Version, Wrap};
use toyproof_image::Input;
use toyproof_player::{BUFFERS, BufferFormat, Graph, Pass, Source as Read, Target};

use super::literal::{self, array, object, string};
use super::template::sections;
use super::{Passes, ReadPasses};
use crate::Converter;
use crate::graph::{SourceEntry, target_name};
use crate::passes::GraphContent;
use crate::project::ProjectError;
use crate::proof::read_glsl;

const TEMPLATE: &str = include_str!("three.js");

/// The dialect of the shaders: they declare ShaderToy's inputs.
const DIALECT: Dialect = Dialect::WebGl;

/// What three.js defines in the shader of a `RawShaderMaterial`, or replaces by a number wherever it occurs
/// (`WebGLProgram.js`).
const RESERVED: [&str; 11] = [
    "SHADER_TYPE",
    "SHADER_NAME",
    "NUM_SUN_LIGHT",
    "NUM_DIR_LIGHT",
    "NUM_SPOT_LIGHT",
    "NUM_RECT_AREA_LIGHT",
    "NUM_POINT_LIGHT",
    "NUM_HEMI_LIGHT",
    "NUM_LIGHT_PROBE_GRID",
    "NUM_CLIPPING_PLANE",
    "UNION_CLIPPING_PLANE",
];

/// A row of the table of passes.
struct ModulePass {
    name: String,
    /// ShaderToy's inputs and the author's uniforms, as strings.
    uniforms: Vec<String>,
    /// Lines with the author's uniforms and their values.
    own_uniforms: Vec<String>,
    channels: Vec<(String, String)>,
    reads_sizes: bool,
}

/// A column behind which nothing fits on a line.
const NO_ROOM: usize = 1000;

/// Writes the module.
pub(super) fn write(converter: &Converter, passes: &Passes) -> Result<String, ProjectError> {
    refuse_shapes(passes)?;
    let codes = converter.port_passes(passes, DIALECT, &[Version::Es300])?;
    let version = Version::Es300.directive();
    let codes = codes
        .iter()
        .map(|code| own_names(code.strip_prefix(&*version).unwrap_or(code)));
    let codes: Vec<String> = codes
        .map(|code| code.trim_start_matches('\n').to_owned())
        .collect();
    let media = media(passes);
    let rows = codes
        .iter()
        .enumerate()
        .map(|(at, code)| ModulePass::new(converter, passes, at, code, &media));
    let rows: Vec<ModulePass> = rows.collect::<Result<_, _>>()?;
    let text = sections(TEMPLATE, |section| has_section(passes, &rows, &media, section));
    let has_channels = rows.iter().any(|row| !row.channels.is_empty());
    let table: Vec<_> = rows.iter().map(|row| row.text(has_channels)).collect();
    let media_rows: Vec<_> = media.iter().map(MediumName::row).collect();
    let mut own_uniforms: Vec<&str> = Vec::new();
    for line in rows.iter().flat_map(|row| &row.own_uniforms) {
        if !own_uniforms.contains(&&**line) {
            own_uniforms.push(line);
        }
    }
    let parameters = if media.is_empty() {
        "renderer"
    } else {
        "renderer, textures = {}"
    };
    let text = text.replacen("$passes", &array(&table, 0, NO_ROOM, 0), 1);
    let text = text.replacen("$media", &object(&media_rows, 0, NO_ROOM, 0), 1);
    let text = text.replacen("    ...uniforms,\n", &own_uniforms.concat(), 1);
    let text = text.replacen("$constructor", parameters, 1);
    // The author's texts come last, since they may contain anything.
    Ok(text.replacen("// $shaders\n", &shaders(passes, &codes), 1))
}

/// Refuses cube maps and volumes.
fn refuse_shapes(passes: &Passes) -> Result<(), ProjectError> {
    for (pass, source) in passes.sources.iter().enumerate() {
        let mut channels = passes.channels(pass);
        let shapes = source.checked.channels;
        if let Some(channel) = channels.find(|channel| shapes[*channel] != SamplerShape::D2) {
            let kind = passes.kinds[pass];
            let why = format!(
                "{kind} reads a cube map or a volume in iChannel{channel}, which is not converted yet"
            );
            return Err(ProjectError::Unwritable(why));
        }
    }
    Ok(())
}

/// Whether the module has a section of the template.
fn has_section(passes: &Passes, rows: &[ModulePass], media: &[MediumName], section: &str) -> bool {
    let has = |section| has_section(passes, rows, media, section);
    let reads = |is: fn(&SourceEntry) -> bool| {
        (0..rows.len()).any(|pass| {
            let mut entries = passes
                .channels(pass)
                .map(|channel| &passes.entries[pass][channel]);
            entries.any(|entry| entry.as_ref().is_some_and(|entry| is(&entry.source)))
        })
    };
    match section {
        "textures" => !media.is_empty(),
        "channels" => rows.iter().any(|row| !row.channels.is_empty()),
        "buffers" => {
            passes.targets().any(|target| target != Target::Image)
                || reads(|source| matches!(source, SourceEntry::Buffer { .. }))
        }
        "keyboard" => reads(|source| matches!(source, SourceEntry::Keyboard { .. })),
        "mouse" => {
            let name = string(Input::Mouse.name());
            rows.iter().any(|row| row.uniforms.contains(&name))
        }
        "discards" => {
            let image = passes.sources.last();
            image.is_some_and(|image| image.checked.discards())
        }
        "listens" => has("mouse") || has("keyboard"),
        "copies" => has("buffers") || has("discards"),
        "sampling" => has("copies") || has("textures"),
        _ => false,
    }
}

impl ModulePass {
    fn new(
        converter: &Converter,
        passes: &Passes,
        at: usize,
        code: &str,
        media: &[MediumName],
    ) -> Result<Self, ProjectError> {
        let target = passes.graph.passes()[at].target;
        let original = passes.sources[at].checked;
        let checked = read_glsl(&complete(code, target), original, DIALECT, converter.timeout);
        let checked = checked.map_err(|error| ProjectError::Unwritable(error.to_string()))?;
        let sizes = Input::ChannelResolution.name();
        let mut row = Self {
            name: js_name(target),
            uniforms: Vec::new(),
            own_uniforms: Vec::new(),
            channels: channels(passes, at, media),
            reads_sizes: false,
        };
        for (name, ty, value) in checked.declared_uniforms() {
            row.reads_sizes |= name == sizes;
            if matches!(ty, Type::Sampler(_)) || name == sizes {
                continue;
            }
            row.uniforms.push(string(name));
            if let Some(value) = value {
                let value = own_uniform(ty, value).ok_or_else(|| {
                    ProjectError::Unwritable(format!("the uniform `{name}` is an array or a structure"))
                })?;
                row.own_uniforms
                    .push(format!("    {name}: {{ value: {value} }},\n"));
            }
        }
        Ok(row)
    }

    fn text(&self, has_channels: bool) -> String {
        let name = &self.name;
        let mut row = format!(
            "{{\n    name: {},\n    fragmentShader: {name}Shader,\n",
            string(name)
        );
        let uniforms = array(&self.uniforms, 4, "    uniforms: ".len(), 1);
        let _ = writeln!(row, "    uniforms: {uniforms},");
        if has_channels {
            // One channel a line is easier to read.
            let _ = writeln!(row, "    channels: {},", object(&self.channels, 4, NO_ROOM, 1));
        }
        if self.reads_sizes {
            row += "    readsChannelResolution: true,\n";
        }
        row + "  }"
    }
}

/// The text without names that three.js would replace.
fn own_names(text: &str) -> String {
    let mut text = text.to_owned();
    for reserved in RESERVED
        .iter()
        .filter(|reserved| text.contains(**reserved))
        .collect::<Vec<_>>()
    {
        let mut own = reserved.to_lowercase();
        while text.contains(&own) {
            own.insert(0, '_');
        }
        text = text.replace(reserved, &own);
    }
    text
}

/// The text of a shader as three.js completes it.
fn complete(code: &str, target: Target) -> String {
    let (version, name) = (Version::Es300.directive(), js_name(target));
    format!("{version}#define SHADER_TYPE RawShaderMaterial\n#define SHADER_NAME {name}\n{code}")
}

/// `image`, `bufferA`, …
fn js_name(target: Target) -> String {
    camel_case(target_name(target)).unwrap_or_default()
}

/// The words of a name as one; `None` if it has no letter at its beginning.
fn camel_case(name: &str) -> Option<String> {
    let words = name
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty());
    let mut joined = String::new();
    for word in words {
        let (first, rest) = word.split_at(1);
        let first = if joined.is_empty() {
            first.to_ascii_lowercase()
        } else {
            first.to_ascii_uppercase()
        };
        joined += &first;
        joined += rest;
    }
    joined
        .starts_with(|c: char| c.is_ascii_alphabetic())
        .then_some(joined)
}

/// A texture that the user passes to the module.
pub(super) struct MediumName {
    pub(super) name: String,
    /// How it is sampled and whether its first row is the top; `None` if the shader is no project.
    sampling: Option<(Sampling, bool)>,
    source: Option<SourceEntry>,
    /// A pass and its channel that read it.
    pub(super) at: (usize, usize),
}

impl MediumName {
    /// The row of the table.
    fn row(&self) -> (String, String) {
        let mut entries = Vec::new();
        if let Some((sampling, is_flipped)) = self.sampling {
            entries = sampler_entries(sampling);
            entries.push(("flipY".to_owned(), is_flipped.to_string()));
        }
        let column = 4 + self.name.len();
        (self.name.clone(), object(&entries, 2, column, 1))
    }
}

fn sampler_entries(Sampling { filter, wrap }: Sampling) -> Vec<(String, String)> {
    vec![
        ("filter".to_owned(), string(filter_name(filter))),
        ("wrap".to_owned(), string(wrap_name(wrap))),
    ]
}

fn filter_name(filter: Filter) -> &'static str {
    match filter {
        Filter::Nearest => "nearest",
        Filter::Linear => "linear",
        Filter::Mipmap => "mipmap",
    }
}

fn wrap_name(wrap: Wrap) -> &'static str {
    match wrap {
        Wrap::Clamp => "clamp",
        Wrap::Repeat => "repeat",
    }
}

/// The textures that the passes read, each with one sampler.
pub(super) fn media(passes: &Passes) -> Vec<MediumName> {
    let mut media: Vec<MediumName> = Vec::new();
    for pass in 0..passes.sources.len() {
        for channel in passes.channels(pass) {
            if !passes.is_project {
                media.push(MediumName {
                    name: format!("iChannel{channel}"),
                    sampling: None,
                    source: None,
                    at: (pass, channel),
                });
                continue;
            }
            let Some(entry) = &passes.entries[pass][channel] else {
                continue;
            };
            let SourceEntry::Media {
                kind, name, vflip, ..
            } = &entry.source
            else {
                continue;
            };
            let sampling = Some((
                Sampling {
                    filter: entry.filter,
                    wrap: entry.wrap,
                },
                *vflip,
            ));
            if media
                .iter()
                .any(|medium| medium.source.as_ref() == Some(&entry.source) && medium.sampling == sampling)
            {
                continue;
            }
            let base = name
                .as_deref()
                .and_then(camel_case)
                .unwrap_or_else(|| kind.clone());
            let mut name = base.clone();
            let mut number = 2;
            while media.iter().any(|medium| medium.name == name) {
                name = format!("{base}{number}");
                number += 1;
            }
            media.push(MediumName {
                name,
                sampling,
                source: Some(entry.source.clone()),
                at: (pass, channel),
            });
        }
    }
    media
}

/// What the channels of a pass read.
fn channels(passes: &Passes, pass: usize, media: &[MediumName]) -> Vec<(String, String)> {
    let row = |channel: usize| {
        let entry = passes.entries[pass][channel].as_ref();
        let name = format!("iChannel{channel}");
        let entries = match entry.map(|entry| (&entry.source, entry)) {
            None if passes.is_project => Vec::new(),
            None => vec![("texture".to_owned(), string(&name))],
            Some((SourceEntry::Buffer { buffer, .. }, entry)) => {
                let buffer = camel_case(buffer).unwrap_or_default();
                let sampling = Sampling {
                    filter: entry.filter,
                    wrap: entry.wrap,
                };
                let mut entries = vec![("buffer".to_owned(), string(&buffer))];
                entries.extend(sampler_entries(sampling));
                entries
            }
            Some((SourceEntry::Keyboard { .. }, _)) => vec![("keyboard".to_owned(), "true".to_owned())],
            Some((source @ SourceEntry::Media { vflip, .. }, entry)) => {
                let sampling = Some((
                    Sampling {
                        filter: entry.filter,
                        wrap: entry.wrap,
                    },
                    *vflip,
                ));
                let mut known = media.iter();
                let found = known
                    .find(|medium| medium.source.as_ref() == Some(source) && medium.sampling == sampling);
                let name = found.map_or("", |medium| &medium.name);
                vec![("texture".to_owned(), string(name))]
            }
        };
        let column = 6 + name.len() + 2;
        (name, object(&entries, 6, column, 1))
    };
    passes.channels(pass).map(row).collect()
}

/// The value of an author's uniform: a number, or an array of components. Without a value it is zero.
fn own_uniform(ty: Type, value: &[f64]) -> Option<String> {
    let size = match ty {
        Type::Scalar(_) => 1,
        Type::Vector(_, size) => usize::from(size),
        Type::Matrix { columns, rows } => usize::from(columns) * usize::from(rows),
        _ => return None,
    };
    let zeros = vec![0.0; size];
    let value = if value.is_empty() { &zeros } else { value };
    // JavaScript has other words for infinity and NaN, and GLSL has none.
    if !value.iter().all(|number| number.is_finite()) {
        return None;
    }
    let numbers: Vec<_> = value.iter().map(f64::to_string).collect();
    Some(match (&numbers[..], ty) {
        ([number], Type::Scalar(_)) => number.clone(),
        _ => format!("[{}]", numbers.join(", ")),
    })
}

/// A text from its first line of code on.
fn after_comments(text: &str) -> &str {
    let mut rest = text.trim_start();
    loop {
        let end = match rest {
            _ if rest.starts_with("//") => rest.find('\n').map(|end| end + 1),
            _ if rest.starts_with("/*") => rest.find("*/").map(|end| end + 2),
            _ => return rest,
        };
        rest = end.map_or("", |end| rest[end..].trim_start());
    }
}

/// The constants with the shaders. Common is one of its own if several passes have it as it is.
fn shaders(passes: &Passes, codes: &[String]) -> String {
    // The declarations of inputs stand between the comment at its beginning and its code.
    let common = passes
        .common
        .map(|common| after_comments(&common.replace("\r\n", "\n")).to_owned());
    let common = common.filter(|common| {
        !common.is_empty() && codes.len() > 1 && codes.iter().all(|code| code.contains(common))
    });
    let mut text = String::new();
    if let Some(common) = &common {
        let _ = writeln!(text, "const common = /* glsl */ {};\n", literal::template(common));
    }
    for (code, target) in codes.iter().zip(passes.targets()) {
        let literal = match common.as_ref().and_then(|common| code.split_once(common)) {
            Some((before, after)) => {
                let (before, after) = (literal::template(before), literal::template(after));
                format!("{}${{common}}{}", before.trim_end_matches('`'), &after[1..])
            }
            None => literal::template(code),
        };
        let _ = writeln!(text, "const {}Shader = /* glsl */ {literal};\n", js_name(target));
    }
    text.trim_end_matches('\n').to_owned() + "\n"
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct PassRow {
    name: String,
    fragment_shader: String,
    #[serde(rename = "uniforms")]
    _uniforms: Vec<String>,
    #[serde(default)]
    channels: BTreeMap<String, ChannelRow>,
    #[serde(default, rename = "readsChannelResolution")]
    _reads_channel_resolution: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ChannelRow {
    buffer: Option<String>,
    texture: Option<String>,
    #[serde(default)]
    keyboard: bool,
    filter: Option<String>,
    wrap: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MediumRow {
    filter: Option<String>,
    wrap: Option<String>,
    #[serde(rename = "flipY")]
    _flip_y: Option<bool>,
}

/// Reads the passes from a module.
///
/// # Errors
/// What is wrong with it.
pub(super) fn read(module: &str, passes: &Passes) -> Result<ReadPasses, String> {
    let texts = literal::templates(module)?;
    let rows: Vec<PassRow> = table(module, "passes")?;
    let media_rows: BTreeMap<String, MediumRow> = if module.contains("\nconst media = ") {
        table(module, "media")?
    } else {
        BTreeMap::new()
    };
    let media = media(passes);
    let targets: Vec<Target> = passes.targets().collect();
    if rows.len() != targets.len() {
        return Err("other passes than the shader's".to_owned());
    }
    let mut codes = Vec::new();
    let mut graph = Vec::new();
    let mut sampling = Vec::new();
    let mut formats: [BufferFormat; BUFFERS] = Default::default();
    for (at, row) in rows.iter().enumerate() {
        let target = targets
            .iter()
            .copied()
            .find(|target| js_name(*target) == row.name);
        let target = target.ok_or_else(|| format!("the pass `{}` is unknown", row.name))?;
        let code = texts.get(&*row.fragment_shader).ok_or("a pass has no shader")?;
        codes.push(complete(code, target));
        let mut pass = Pass {
            target,
            inputs: [None; 4],
        };
        let mut samplers = passes.sources[at].checked.sampling;
        for (channel, sampler) in samplers.iter_mut().enumerate() {
            let Some(row) = row.channels.get(&format!("iChannel{channel}")) else {
                continue;
            };
            let (filter, wrap) = match &row.texture {
                Some(texture) => {
                    let medium = media.iter().find(|medium| medium.name == *texture);
                    let (of_pass, of_channel) = medium.ok_or("an unknown texture")?.at;
                    pass.inputs[channel] = passes.graph.passes()[of_pass].inputs[of_channel];
                    let row = media_rows.get(texture).ok_or("a texture has no row")?;
                    (&row.filter, &row.wrap)
                }
                None => (&row.filter, &row.wrap),
            };
            if let Some(buffer) = &row.buffer {
                let number = (0..BUFFERS).find(|number| js_name(Target::Buffer(*number)) == *buffer);
                let number = number.ok_or_else(|| format!("the buffer `{buffer}` is unknown"))?;
                pass.inputs[channel] = Some(Read::Buffer(number));
                formats[number].mipmaps |= filter.as_deref() == Some("mipmap");
            }
            if row.keyboard {
                pass.inputs[channel] = passes.graph.passes()[at].inputs[channel];
            }
            if let (Some(filter), Some(wrap)) = (filter, wrap) {
                *sampler = named_sampling(filter, wrap).ok_or("an unknown filter or wrap")?;
            }
        }
        graph.push(pass);
        sampling.push(samplers);
    }
    Ok(ReadPasses {
        codes,
        dialect: DIALECT,
        content: GraphContent {
            graph: Graph::new(graph, formats),
            sampling,
        },
    })
}

fn named_sampling(filter: &str, wrap: &str) -> Option<Sampling> {
    let mut filters = [Filter::Nearest, Filter::Linear, Filter::Mipmap].into_iter();
    let mut wraps = [Wrap::Clamp, Wrap::Repeat].into_iter();
    Some(Sampling {
        filter: filters.find(|known| filter_name(*known) == filter)?,
        wrap: wraps.find(|known| wrap_name(*known) == wrap)?,
    })
}

fn table<T: DeserializeOwned>(module: &str, name: &str) -> Result<T, String> {
    let value = literal::constant(module, name)?;
    serde_json::from_value(value).map_err(|error| format!("the constant `{name}`: {error}"))
}
