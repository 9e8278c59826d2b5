//! The folder of a project: a file for each tab, and `project.toml`, which holds the rest of the site's JSON,
//! key by key in the same order. The source of an input is written by name: `source = "buffer-a"`.

use toml::Spanned;
use toml::de::{DeInteger, DeTable, DeValue};
use toyproof_diagnostic::{Code, Diagnostic, Diagnostics, File, FileId, Files, Span, nearest, one_of};
use toyproof_glsl::{Filter, UniformValue, Wrap};

use crate::declared::components;
use crate::format::{Format, Wrapper};
use crate::json;
use crate::media;
use crate::node::{Member, Node, Value};
use crate::pass::{Buffer, PassKind, SourceType, Tab};
use crate::project::{Document, Project};
use crate::read::{Renderpass, default_sampler, read};
use crate::textures::LoadedMedia;

/// The name of the file next to the tabs.
pub const PROJECT_FILE: &str = "project.toml";

impl Project {
    /// Reads a project from the files of its folder: the tabs, and `project.toml`, if there is one. Without
    /// it, channel *n* of every pass but Sound reads the *n*th buffer, where that buffer exists.
    ///
    /// # Errors
    /// Those of `project.toml`.
    pub fn from_folder(
        files: &Files,
        toml: Option<FileId>,
        tabs: &[(Tab, FileId)],
    ) -> Result<Self, Diagnostics> {
        let mut errors = Vec::new();
        let root = toml.map_or(Some(Node::from([])), |file| parse(files, file, &mut errors));
        let project = root.and_then(|root| from_tree(root, tabs, &mut errors));
        match project {
            Some(project) if errors.is_empty() => Ok(project),
            _ => Err(Diagnostics::new(errors, files)),
        }
    }

    /// Formats `project.toml`.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let Document {
            root,
            format,
            wrapper,
            tabs,
        } = &self.document;
        let mut text = format!(
            "# The rest of ShaderToy's JSON: `toyproof export` puts the code of the tabs back into it.\nformat = \"{}\"\n",
            format.name()
        );
        match wrapper {
            Wrapper::None => {}
            Wrapper::Array => text += "wrapper = \"array\"\n",
            Wrapper::Shader => text += "wrapper = \"Shader\"\n",
        }
        let Value::Object(members) = &root.value else {
            return text;
        };
        let (tables, values): (Vec<_>, Vec<_>) = members
            .iter()
            .partition(|member| member.key == "renderpass" || member.node.is_object());
        for Member { key, node } in values {
            text += &line(key, node);
        }
        for Member { key, node } in tables {
            match &node.value {
                Value::Array(passes) => {
                    for (pass, (tab, _)) in passes.iter().zip(tabs) {
                        text += "\n[[pass]]\n";
                        text += &pass_lines(pass, *tab, *format);
                    }
                }
                Value::Object(members) => {
                    text.extend(["\n[", &toml_key(key), "]\n"]);
                    text.extend(members.iter().map(|member| line(&member.key, &member.node)));
                }
                _ => {}
            }
        }
        if !self.uniforms.is_empty() {
            text += "\n[uniforms]\n";
            text.extend(
                self.uniforms.iter().map(|UniformValue { name, components }| {
                    format!("{} = {components:?}\n", toml_key(name))
                }),
            );
        }
        text
    }
}

// Writing TOML.

fn line(key: &str, node: &Node) -> String {
    format!("{} = {}\n", toml_key(key), inline(node))
}

fn pass_lines(pass: &Node, tab: Tab, format: Format) -> String {
    let Value::Object(members) = &pass.value else {
        return String::new();
    };
    let line = |Member { key, node }: &Member| match (key.as_str(), &node.value) {
        ("code", _) => format!("tab = \"{}\"\n", tab.name()),
        ("inputs", Value::Array(inputs)) if !inputs.is_empty() => {
            let lines = inputs
                .iter()
                .map(|input| format!("    {},\n", inline(&shortened(input, format))));
            format!("inputs = [\n{}]\n", lines.collect::<String>())
        }
        _ => line(key, node),
    };
    members.iter().map(line).collect()
}

/// The input with the name of its source instead of the members that follow from it.
fn shortened(input: &Node, format: Format) -> Node {
    let Value::Object(members) = &input.value else {
        return input.clone();
    };
    for name in media::names() {
        let named = format.members(&name);
        if let Some(at) = members.windows(named.len()).position(|window| window == named) {
            let mut members = members.clone();
            members.splice(at..at + named.len(), [Member::new("source", name.source)]);
            return Value::Object(members).into();
        }
    }
    input.clone()
}

/// A value of TOML on one line. Values that TOML does not have are JSON in a string: `{ json = "null" }`.
fn inline(node: &Node) -> String {
    let list = |items: Vec<String>| items.join(", ");
    match &node.value {
        Value::Null => format!("{{ {ESCAPE} = \"null\" }}"),
        Value::Object(members) if matches!(&members[..], [only] if only.key == ESCAPE) => {
            format!(
                "{{ {ESCAPE} = {} }}",
                inline(&json::write_compact(node).as_str().into())
            )
        }
        Value::Object(members) if members.is_empty() => "{}".to_owned(),
        Value::Object(members) => {
            let members = members
                .iter()
                .map(|Member { key, node }| format!("{} = {}", toml_key(key), inline(node)));
            format!("{{ {} }}", list(members.collect()))
        }
        Value::Array(nodes) => format!("[{}]", list(nodes.iter().map(inline).collect())),
        // Numbers and strings have the same form in both languages.
        Value::Bool(_) | Value::Number(_) | Value::String(_) => json::write_compact(node),
    }
}

/// The key of a table that holds JSON in a string.
const ESCAPE: &str = "json";

fn toml_key(key: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !key.is_empty() && key.chars().all(is_bare) {
        key.to_owned()
    } else {
        json::write_compact(&key.into())
    }
}

// Reading TOML.

fn parse(files: &Files, file: FileId, errors: &mut Vec<Diagnostic>) -> Option<Node> {
    let text = files.get(file).text();
    match DeTable::parse(text) {
        Ok(document) => Some(Tree { file, errors }.object(document.into_inner(), None)),
        Err(error) => {
            errors.push(toyproof_toml::syntax_error(
                Code::ProjectSyntax,
                &error,
                text,
                file,
            ));
            None
        }
    }
}

/// Converts TOML to a tree.
struct Tree<'e> {
    file: FileId,
    errors: &'e mut Vec<Diagnostic>,
}

impl Tree<'_> {
    fn object(&mut self, table: DeTable, span: Option<Span>) -> Node {
        let mut entries: Vec<_> = table.into_iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let members = entries.into_iter().map(|(key, node)| Member {
            key: key.into_inner().into_owned(),
            node: self.node(node),
        });
        let value = Value::Object(members.collect());
        Node { value, span }
    }

    fn node(&mut self, value: Spanned<DeValue>) -> Node {
        let span = Some(Span::new(
            self.file,
            value.span().start as u32,
            value.span().end as u32,
        ));
        let value = match value.into_inner() {
            DeValue::String(text) => Value::String(text.into_owned()),
            DeValue::Boolean(value) => Value::Bool(value),
            DeValue::Integer(number) => self.number(decimal(&number), span),
            DeValue::Float(number) => self.number(Some(number.as_str().to_owned()), span),
            DeValue::Datetime(date) => self.number(Some(date.to_string()), span),
            DeValue::Array(values) => {
                Value::Array(values.into_iter().map(|value| self.node(value)).collect())
            }
            DeValue::Table(table) => {
                let node = self.object(table, span);
                return self.unescaped(node);
            }
        };
        Node { value, span }
    }

    /// A number, as JSON writes it.
    fn number(&mut self, text: Option<String>, span: Option<Span>) -> Value {
        let mut files = Files::default();
        let text = text.unwrap_or_default();
        let file = files.add(File::new("", text.strip_prefix('+').unwrap_or(&text)));
        if let Ok(Node {
            value: number @ Value::Number(_),
            ..
        }) = json::parse(&files, file)
        {
            return number;
        }
        let node = Node {
            value: Value::Null,
            span,
        };
        let error = node.error("a value that JSON does not have");
        self.errors
            .push(error.help("write a finite decimal number, or a string in quotes"));
        Value::Null
    }

    /// Reads the JSON of `{ json = "…" }`.
    fn unescaped(&mut self, node: Node) -> Node {
        let escaped = match &node.value {
            Value::Object(members) if members.len() == 1 => node.get(ESCAPE).and_then(Node::as_str),
            _ => None,
        };
        let Some(text) = escaped else {
            return node;
        };
        let mut files = Files::default();
        let file = files.add(File::new("", text));
        match json::parse(&files, file) {
            Ok(mut parsed) => {
                parsed.set_span(node.span);
                parsed
            }
            Err(error) => {
                self.errors
                    .push(node.error(format!("`{ESCAPE}` must be JSON: {}", error.message)));
                node
            }
        }
    }
}

/// An integer in base 10; `None` if it is too large.
fn decimal(number: &DeInteger) -> Option<String> {
    if number.radix() == 10 {
        return Some(number.as_str().to_owned());
    }
    let value = i64::from_str_radix(number.as_str(), number.radix()).ok()?;
    Some(value.to_string())
}

// The keys of `project.toml` and of its tables that are known; others are copied to the JSON only if `format`
// says that the file was imported.

/// The known keys at the top level.
const KEYS: [&str; 7] = ["ver", "info", "flags", "pass", "renderpass", "format", "wrapper"];

/// The known keys of a pass.
const PASS_KEYS: [&str; 6] = ["tab", "inputs", "outputs", "name", "description", "type"];

/// The known keys of an input.
const INPUT_KEYS: [&str; 11] = [
    "channel",
    "source",
    "sampler",
    "id",
    "type",
    "ctype",
    "filepath",
    "previewfilepath",
    "src",
    "published",
    "name",
];

/// The known keys of a sampler.
const SAMPLER_KEYS: [&str; 5] = ["filter", "wrap", "vflip", "srgb", "internal"];

/// Removes the table of the values of uniforms, which the site does not have.
fn take_uniforms(root: &mut Node, errors: &mut Vec<Diagnostic>) -> Vec<UniformValue> {
    let Some(members) = root.members_mut() else {
        return Vec::new();
    };
    let is_table = |member: &Member| member.key == "uniforms" && member.node.is_object();
    let Some(at) = members.iter().position(is_table) else {
        return Vec::new();
    };
    let mut table = members.remove(at).node;
    let mut uniforms = Vec::new();
    for Member { key, node } in table.members_mut().into_iter().flatten() {
        if let Some(components) = components(node) {
            let name = key.clone();
            uniforms.push(UniformValue { name, components });
        } else {
            let (expected, found) = ("a number, true, false or a list of numbers", node.describe());
            errors.push(node.error(format!("`{key}` must be {expected}, found {found}")));
        }
    }
    uniforms
}

fn from_tree(mut root: Node, tabs: &[(Tab, FileId)], errors: &mut Vec<Diagnostic>) -> Option<Project> {
    let format = take_choice(&mut root, "format", &Format::NAMES, errors);
    let wrappers = [("array", Wrapper::Array), ("Shader", Wrapper::Shader)];
    let wrapper = take_choice(&mut root, "wrapper", &wrappers, errors).unwrap_or(Wrapper::None);
    let uniforms = take_uniforms(&mut root, errors);
    let completes = format.is_none();
    let format = format.unwrap_or(Format::Page);
    if completes {
        report_unknown(&root, &KEYS, errors);
    }
    let knows_inputs = root.get("pass").is_some();
    let members = root.members_mut()?;
    match members.iter_mut().find(|member| member.key == "pass") {
        Some(passes) => "renderpass".clone_into(&mut passes.key),
        None => members.push(Member::new("renderpass", assumed_passes(tabs))),
    }
    if completes {
        complete_document(members);
    }
    if let Some(Value::Array(passes)) = root.get_mut("renderpass").map(|passes| &mut passes.value) {
        for pass in passes.iter_mut().filter(|pass| pass.is_object()) {
            expand_pass(pass, format, completes, errors);
        }
    }
    if !errors.is_empty() {
        return None;
    }
    let mut listed = Vec::new();
    let Renderpass {
        common,
        passes,
        tabs: found,
    } = read(&mut root, errors, |tab, pass, errors| {
        listed.push(tab);
        text(tab, pass, tabs, errors)
    })?;
    for (tab, _) in tabs {
        if !listed.contains(tab) && errors.is_empty() {
            let message = format!("{} is not listed in {PROJECT_FILE}", tab.file_name());
            let help = format!(
                "add `[[pass]]` and `tab = \"{}\"`, or remove the file",
                tab.name()
            );
            errors.push(root.error(message).help(help));
        }
    }
    Some(Project {
        knows_inputs,
        common,
        passes,
        uniforms,
        media: LoadedMedia::default(),
        document: Document {
            root,
            format,
            wrapper,
            tabs: found,
        },
    })
}

/// Removes a key whose value is one of some choices.
fn take_choice<T: Copy>(
    root: &mut Node,
    key: &str,
    choices: &[(&'static str, T)],
    errors: &mut Vec<Diagnostic>,
) -> Option<T> {
    let members = root.members_mut()?;
    let at = members.iter().position(|member| member.key == key)?;
    let node = members.remove(at).node;
    let choice = choices.iter().find(|(name, _)| node.as_str() == Some(name));
    if choice.is_none() {
        let known: Vec<_> = choices.iter().map(|(name, _)| *name).collect();
        errors.push(
            node.error(format!("unknown `{key}`"))
                .help(format!("expected {}", one_of(&known))),
        );
    }
    choice.map(|(_, choice)| *choice)
}

fn report_unknown(node: &Node, known: &[&'static str], errors: &mut Vec<Diagnostic>) {
    let Value::Object(members) = &node.value else {
        return;
    };
    for Member { key, node } in members
        .iter()
        .filter(|member| !known.contains(&member.key.as_str()))
    {
        let is_tab = Tab::ALL.iter().any(|tab| tab.name() == key);
        let help = match nearest(key, known.iter().copied()) {
            None if is_tab => {
                format!("a tab has the table `[[pass]]` with `tab = \"{key}\"` and its `inputs`")
            }
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("expected {}", one_of(known)),
        };
        errors.push(node.error(format!("unknown key `{key}`")).help(help));
    }
}

/// Adds the members that the site's JSON has for every shader.
fn complete_document(members: &mut Vec<Member>) {
    if !members.iter().any(|member| member.key == "ver") {
        members.insert(0, Member::new("ver", "0.1"));
    }
    if !members.iter().any(|member| member.key == "info") {
        let info = [
            ("id", "-1".into()),
            ("name", "".into()),
            ("description", "".into()),
            ("tags", Node::from(vec![])),
        ];
        members.insert(1, Member::new("info", info));
    }
}

/// The passes of a folder without `project.toml`, in the order of the site.
fn assumed_passes(tabs: &[(Tab, FileId)]) -> Node {
    let has = |tab: Tab| tabs.iter().any(|(known, _)| *known == tab);
    let inputs: Vec<Node> = Buffer::OF_SITE
        .into_iter()
        .map(|buffer| Tab::Pass(PassKind::Buffer(buffer)))
        .enumerate()
        .filter(|(_, tab)| has(*tab))
        .map(|(channel, tab)| [("channel", channel.into()), ("source", tab.name().into())].into())
        .collect();
    let passes = Tab::ALL.into_iter().filter(|tab| has(*tab)).map(|tab| {
        let is_silent = !matches!(tab, Tab::Common | Tab::Pass(PassKind::Sound));
        let inputs = if is_silent { inputs.clone() } else { Vec::new() };
        Node::from([("inputs", inputs.into()), ("tab", tab.name().into())])
    });
    passes.collect::<Vec<_>>().into()
}

/// Writes out the names of a pass, and adds missing members if `completes`.
fn expand_pass(pass: &mut Node, format: Format, completes: bool, errors: &mut Vec<Diagnostic>) {
    if completes {
        report_unknown(pass, &PASS_KEYS, errors);
    }
    if let Some(Value::Array(inputs)) = pass.get_mut("inputs").map(|inputs| &mut inputs.value) {
        for input in inputs {
            expand_input(input, format, completes, errors);
        }
    }
    let span = pass.span;
    let Some(members) = pass.members_mut() else {
        return;
    };
    let Some(at) = members.iter().position(|member| member.key == "tab") else {
        let names = Tab::ALL.map(Tab::name);
        let help = format!("add `tab = \"image\"`, or {}", one_of(&names[..]));
        let node = Node {
            value: Value::Null,
            span,
        };
        errors.push(node.error("missing key `tab` in [[pass]]").help(help));
        return;
    };
    // Until the text is found, the code is the name of the tab.
    "code".clone_into(&mut members[at].key);
    let tab = Tab::ALL
        .into_iter()
        .find(|tab| members[at].node.as_str() == Some(tab.name()));
    let Some(tab) = tab else {
        let node = &members[at].node;
        let names = Tab::ALL.map(Tab::name);
        errors.push(
            node.error("`tab` must be the name of a tab")
                .help(format!("expected {}", one_of(&names))),
        );
        return;
    };
    if !completes {
        return;
    }
    let output = match tab {
        Tab::Pass(PassKind::Image) => Some("4dfGRr"),
        Tab::Pass(PassKind::Buffer(buffer)) => Some(media::buffer_id(buffer)),
        Tab::Pass(PassKind::CubeA) => Some(media::CUBE_A_ID),
        Tab::Pass(PassKind::Sound) | Tab::Common => None,
    };
    let outputs: Vec<Node> = output
        .map(|id| [("id", id.into()), ("channel", 0.into())].into())
        .into_iter()
        .collect();
    for (at, (key, node)) in [
        ("inputs", Node::from(Vec::new())),
        ("outputs", outputs.into()),
        ("code", "".into()),
        ("name", tab.to_string().as_str().into()),
        ("description", "".into()),
        ("type", tab.type_name().into()),
    ]
    .into_iter()
    .enumerate()
    {
        if !members.iter().any(|member| member.key == key) {
            members.insert(at.min(members.len()), Member::new(key, node));
        }
    }
}

/// Writes out the source of an input, and adds a sampler if `completes`.
fn expand_input(input: &mut Node, format: Format, completes: bool, errors: &mut Vec<Diagnostic>) {
    if completes {
        report_unknown(input, &INPUT_KEYS, errors);
        if let Some(sampler) = input.get("sampler") {
            report_unknown(sampler, &SAMPLER_KEYS, errors);
        }
    }
    let Some(members) = input.members_mut() else {
        return;
    };
    let mut source_type = None;
    if let Some(at) = members.iter().position(|member| member.key == "source") {
        let node = &members[at].node;
        let wanted = node.as_str().unwrap_or_default();
        let built_in = media::names().find(|name| name.source.eq_ignore_ascii_case(wanted));
        let name = match built_in.map(Ok).or_else(|| media::file_name(wanted)) {
            Some(Err(reason)) => {
                errors.push(
                    node.error(reason)
                        .help("name a file in the folder, or in one below it"),
                );
                members.clear();
                return;
            }
            found => found.and_then(Result::ok),
        };
        let Some(mut name) = name else {
            let near = nearest(wanted, media::names().map(|name| name.source));
            let help = near.map_or_else(
                || "expected buffer-a to buffer-d, cube-a, keyboard, webcam, mic, a file of the folder (an image, .gif, .bin, \
                     .wav, .ogg), or the name of a medium of ShaderToy"
                        .to_owned(),
                |near| format!("did you mean `{near}`?"),
            );
            errors.push(node.error(format!("unknown source `{wanted}`")).help(help));
            members.clear();
            return;
        };
        let span = node.span;
        // An image of the folder may be a face of a cube map.
        let given = members
            .iter()
            .position(|member| matches!(member.key.as_str(), "type" | "ctype"));
        if name.id.is_empty()
            && let Some(given) = given
            && let Some(kind) = known_type(&members[given].node)
        {
            name.source_type = kind;
            members.remove(given);
        }
        let at = members
            .iter()
            .position(|member| member.key == "source")
            .unwrap_or(at);
        source_type = Some(name.source_type);
        let named = format.members(&name).into_iter().map(|mut member| {
            member.node.span = span;
            member
        });
        members.splice(at..=at, named);
    }
    if completes {
        complete_sampler(members, source_type.unwrap_or(SourceType::Texture));
    }
}

/// The type that a node names.
fn known_type(node: &Node) -> Option<SourceType> {
    let name = node.as_str()?;
    let mut known = SourceType::NAMES.iter();
    known
        .find(|(known, _)| *known == name)
        .map(|(_, source_type)| *source_type)
}

/// Adds the keys of a sampler that are missing, with the values of a new input on the site.
fn complete_sampler(members: &mut Vec<Member>, source_type: SourceType) {
    let sampler = default_sampler(source_type);
    let filter = match sampler.filter {
        Filter::Nearest => "nearest",
        Filter::Linear => "linear",
        Filter::Mipmap => "mipmap",
    };
    let wrap = match sampler.wrap {
        Wrap::Clamp => "clamp",
        Wrap::Repeat => "repeat",
    };
    if !members.iter().any(|member| member.key == "sampler") {
        members.push(Member::new("sampler", []));
    }
    let given = members.iter_mut().find(|member| member.key == "sampler");
    let Some(given) = given.and_then(|sampler| sampler.node.members_mut()) else {
        return;
    };
    let vflip = if sampler.vflip { "true" } else { "false" };
    for (key, value) in SAMPLER_KEYS
        .into_iter()
        .zip([filter, wrap, vflip, "false", "byte"])
    {
        match given.iter_mut().find(|member| member.key == key) {
            None => given.push(Member::new(key, value)),
            // The site has strings only.
            Some(member) => {
                if let Value::Bool(value) = member.node.value {
                    member.node.value = Value::String(value.to_string());
                }
            }
        }
    }
}

/// The text of the tab that a pass names.
fn text(tab: Tab, pass: &mut Node, tabs: &[(Tab, FileId)], errors: &mut Vec<Diagnostic>) -> Option<FileId> {
    // A missing name has been reported.
    let code = pass.get_mut("code")?;
    let named = Tab::ALL
        .into_iter()
        .find(|tab| code.as_str() == Some(tab.name()))?;
    if named != tab {
        let message = format!("`tab` names {named}, but `type` and `outputs` are those of {tab}");
        errors.push(
            code.error(message)
                .help(format!("write `tab = \"{}\"`", tab.name())),
        );
        return None;
    }
    let Some((_, file)) = tabs.iter().find(|(known, _)| *known == tab) else {
        let message = format!(
            "there is no file {} in the folder of the project",
            tab.file_name()
        );
        errors.push(code.error(message).help("add the file, or remove this pass"));
        return None;
    };
    code.value = Value::String(String::new());
    Some(*file)
}
