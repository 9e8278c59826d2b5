//! The state of printing: lines, names and types.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::fmt::Write as _;

use toyproof_diagnostic::{Code, Deadline, Diagnostic, Files};
use toyproof_glsl::tree::{BuiltIn, ExprId, FunctionId, Item, Place, StructId, Type, VariableId};

use super::host::CHost;
use super::language::{Language, Words};
use super::{Title, Unprintable};
use crate::author::{Comments, MacroConstants, SourceText};
use crate::lower::context::LoweringContext;
use crate::lower::impure_functions;
use crate::print::{Names, Order, Vocabulary};

pub(super) type PrintResult<T = ()> = Result<T, Unprintable>;

/// Prints a lowered shader.
pub(super) struct Writer<'a> {
    pub(super) cx: &'a LoweringContext,
    pub(super) names: &'a Names,
    pub(super) host: CHost,
    pub(super) comments: Comments<'a>,
    pub(super) source: SourceText<'a>,
    pub(super) deadline: &'a Deadline,
    pub(super) out: String,
    pub(super) indent: usize,
    /// The constants that macros become.
    pub(super) macros: MacroConstants,
    /// Functions that replace built-in ones, by name and the types of their arguments.
    pub(super) helpers: BTreeMap<(String, String), String>,
    /// The structures that need a function that makes them: these languages list values in declarations only.
    pub(super) made: BTreeSet<StructId>,
    /// What the structure around a shader contains, in languages without global variables.
    pub(super) members: HashSet<Item>,
    /// The expressions whose values are not used, in languages in which this matters.
    pub(super) discarded: HashSet<ExprId>,
    /// The type that the function being printed returns.
    pub(super) returned: Type,
    /// The functions with side effects.
    pub(super) impure: HashSet<FunctionId>,
    /// All names in use.
    pub(super) taken: HashSet<&'a str>,
    /// The innermost expression that could not be printed.
    pub(super) failed_at: Option<Place>,
    /// Whether `gl_FragCoord` is read other than by `mainImage`'s caller.
    pub(super) reads_position: bool,
    /// Whether derivatives along y are taken, whose sign depends on the host.
    pub(super) takes_derivatives: bool,
    /// What `mainImage` gets from the host's entry point besides its color and coordinates.
    pub(super) passed: &'a [VariableId],
}

impl<'a> Writer<'a> {
    pub(super) fn new(
        cx: &'a LoweringContext,
        names: &'a Names,
        order: &Order,
        host: CHost,
        files: &'a Files,
        deadline: &'a Deadline,
    ) -> Self {
        let all = names.variables.values().chain(names.functions.values());
        let all = all.chain(names.structs.values());
        Self {
            cx,
            names,
            host,
            comments: Comments::new(files, &cx.tree, &order.items),
            source: SourceText::new(files),
            deadline,
            out: String::new(),
            indent: 0,
            macros: MacroConstants::default(),
            helpers: BTreeMap::new(),
            made: BTreeSet::new(),
            members: HashSet::new(),
            discarded: HashSet::new(),
            returned: Type::Void,
            impure: impure_functions(&cx.tree),
            taken: all.map(String::as_str).collect(),
            failed_at: None,
            reads_position: false,
            takes_derivatives: false,
            passed: &[],
        }
    }

    pub(super) fn language(&self) -> Language {
        self.host.language()
    }

    /// Fails if the deadline has passed; [`super::write`] then reports that instead.
    pub(super) fn check_deadline(&self) -> PrintResult {
        if self.deadline.is_over() {
            return Err(Unprintable::Construct("a shader that exceeds the time limit"));
        }
        Ok(())
    }

    /// Prints a line at the current indentation.
    pub(super) fn line(&mut self, text: &str) {
        // Blank lines are empty.
        let indent = if text.is_empty() { 0 } else { self.indent };
        self.out += &"    ".repeat(indent);
        self.out += text;
        self.out.push('\n');
    }

    /// Prints lines indented by one more level.
    pub(super) fn indented<T>(&mut self, inside: impl FnOnce(&mut Self) -> PrintResult<T>) -> PrintResult<T> {
        /// Maximum number of levels: each indents its lines further.
        const MAX_LEVELS: usize = 128;
        if self.indent >= MAX_LEVELS {
            return Err(Unprintable::Construct("statements that are nested this deeply"));
        }
        self.indent += 1;
        let value = inside(self);
        self.indent -= 1;
        value
    }

    /// Prints comments and blank lines, which are empty. A block does not begin with a blank line, and none
    /// follows another.
    pub(super) fn comment_lines(&mut self, lines: &[String]) {
        for line in lines {
            let is_repeated = self.out == "\n" || self.out.ends_with("\n\n") || self.out.ends_with("{\n");
            if !(line.is_empty() && is_repeated) {
                self.line(line);
            }
        }
    }

    /// Prints a comment at the end of the line printed last.
    pub(super) fn trailing_comment(&mut self, comment: Option<String>) {
        if let Some(comment) = comment {
            self.out.pop();
            self.out.push(' ');
            self.out.push_str(&comment);
            self.out.push('\n');
        }
    }

    pub(super) fn variable(&self, id: VariableId) -> &'a str {
        self.names.variables.get(&id).unwrap_or(&self.cx.tree[id].name)
    }

    pub(super) fn function(&self, id: FunctionId) -> &'a str {
        self.names.functions.get(&id).unwrap_or(&self.cx.tree[id].name)
    }

    pub(super) fn structure_name(&self, id: StructId) -> &'a str {
        self.names.structs.get(&id).map_or("", String::as_str)
    }

    /// `float3 name`, or `float name[2]`.
    pub(super) fn declarator(&self, ty: Type, name: &str) -> PrintResult<String> {
        if self.language() == Language::Msl {
            return Ok(format!("{} {name}", self.type_name(ty)?));
        }
        let mut sizes = String::new();
        let mut element = ty;
        while let Type::Array(id) = element {
            let array = self.cx.tree.array(id);
            let _ = write!(sizes, "[{}]", array.size);
            element = array.element;
            if self.language() == Language::Godot && matches!(element, Type::Array(_)) {
                return Err(Unprintable::Construct("an array of arrays"));
            }
        }
        Ok(format!("{} {name}{sizes}", self.type_name(element)?))
    }

    /// The name of a type; arrays have one in languages in which they are values.
    pub(super) fn type_name(&self, ty: Type) -> PrintResult<String> {
        match ty {
            Type::Struct(id) => Ok(self.structure_name(id).to_owned()),
            Type::Void => Ok("void".to_owned()),
            Type::Array(id) if self.language() == Language::Glsl => {
                let array = self.cx.tree.array(id);
                Ok(format!("{}[{}]", self.type_name(array.element)?, array.size))
            }
            Type::Array(id) if self.language() == Language::Msl => {
                let array = self.cx.tree.array(id);
                Ok(format!(
                    "array<{}, {}>",
                    self.type_name(array.element)?,
                    array.size
                ))
            }
            _ => {
                let name = self.language().numeric_type(ty);
                name.ok_or(Unprintable::Construct("this type"))
            }
        }
    }

    /// Whether nothing has the name of a macro.
    pub(super) fn is_free(&self, name: &str) -> bool {
        let words = Words::new(self.host);
        let is_declared = words.declared().iter().any(|declared| declared == name);
        let is_word = words.is_reserved(name) || words.is_function(name);
        !is_declared && !is_word && !self.taken.contains(name)
    }

    pub(super) fn is_reserved(&self, word: &str) -> bool {
        Words::new(self.host).is_reserved(word)
    }

    /// A name that nothing else has.
    pub(super) fn free(&self, stem: &str) -> String {
        let mut name = stem.to_owned();
        while self.taken.contains(name.as_str()) || self.macros.contains(&name) {
            name.push('_');
        }
        name
    }

    /// Adds the place of the expression that could not be printed.
    fn placed(&self, why: Unprintable) -> Unprintable {
        match (why, self.failed_at) {
            (Unprintable::Construct(what), Some(at)) => {
                let host = self.host.name();
                let message = format!("{what} is not supported in the style `{host}`");
                Unprintable::Host(Box::new(
                    Diagnostic::new(Code::UnsupportedByTarget, message)
                        .at(at.span)
                        .help("`--style plain` supports it"),
                ))
            }
            (why, _) => why,
        }
    }

    /// Prints the whole text: the author's first comment, and the items in the host's code.
    pub(super) fn write(mut self, order: &Order, title: Title) -> PrintResult<String> {
        let entry = self.cx.tree[self.cx.main_image].at;
        let mut first = self.comments.first(entry).join("\n");
        if !first.is_empty() {
            first.push_str("\n\n");
        }
        if self.language() == Language::Msl {
            self.members = self.members_in_metal(order);
            self.discarded = self.cx.discarded_values();
        }
        let mut items: Vec<(Item, String)> = Vec::new();
        for &item in &order.items {
            let printed = self.item(item);
            printed.map_err(|why| self.placed(why))?;
            let mut printed = std::mem::take(&mut self.out);
            let follows_function = matches!(items.last(), Some((Item::Function(_), _)));
            if follows_function && !printed.starts_with('\n') {
                printed.insert(0, '\n');
            }
            items.push((item, printed));
        }
        let mut makers = HashMap::new();
        for id in self.made.clone() {
            self.maker(id)?;
            makers.insert(id, std::mem::take(&mut self.out));
        }
        let mut text = self.macros.declarations(&mut self.comments);
        if !text.is_empty() {
            text.push('\n');
        }
        for helper in self.helpers.values() {
            text += helper;
            text.push('\n');
        }
        let (mut shader, mut members) = (String::new(), String::new());
        for (item, printed) in items {
            if self.members.contains(&item) {
                members += &printed;
                continue;
            }
            if shader.ends_with("}\n") && !printed.starts_with('\n') {
                shader.push('\n');
            }
            shader += &printed;
            if let Item::Struct(id) = item {
                shader += makers.get(&id).map_or("", String::as_str);
            }
        }
        let end = if self.language() == Language::Msl {
            &mut members
        } else {
            &mut shader
        };
        *end += &self.comments.rest();
        text += shader.trim_start_matches('\n');
        if self.language() == Language::Msl {
            return self.embed(order, &first, &text, members.trim_start_matches('\n'), title);
        }
        self.embed(order, &first, "", &text, title)
    }
}

/// Whether GLSL has a function of this name, which a local would hide.
fn is_built_in(name: &str) -> bool {
    BuiltIn::ALL.iter().any(|function| function.name() == name)
}

/// Shortens generated names, which a prefix distinguishes from the author's in GLSL.
pub(super) fn shorten_generated_names(cx: &mut LoweringContext, language: Language) {
    const PREFIX: &str = "toyproof_";
    let tree = &mut cx.tree;
    let names = tree.variables.iter().map(|(_, variable)| &variable.name);
    let names = names.chain(tree.functions.iter().map(|(_, function)| &function.name));
    let all: HashSet<String> = names.cloned().collect();
    let short = |name: &mut String| {
        if let Some(rest) = name.strip_prefix(PREFIX)
            && !all.contains(rest)
            && !(language == Language::Glsl && is_built_in(rest))
        {
            *name = rest.to_owned();
        }
    };
    for id in tree.variables.ids() {
        short(&mut tree[id].name);
    }
    for id in tree.functions.ids() {
        short(&mut tree[id].name);
    }
}
