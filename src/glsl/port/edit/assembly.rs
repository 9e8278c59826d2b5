//! The edited text, with what stands before and behind it.

use std::fmt::Write;

use toyproof_diagnostic::Span;

use super::{Color, FRAG_COLOR, Port};
use crate::dialect::Version;
use crate::port::input::declaration;
use crate::port::names;
use crate::stage::Stage;
use crate::tree::{Scalar, Type};

impl Port<'_> {
    /// The edited text, with what stands before and after it.
    pub(super) fn assemble(mut self) -> String {
        self.assign_globals();
        let mut head = String::new();
        if self.becomes_main() || self.version != self.checked.version {
            head += &self.precision();
        }
        if self.becomes_main() && names::words(self.source).contains("HW_PERFORMANCE") {
            head += "#define HW_PERFORMANCE 1\n";
        }
        if !self.to.calls_main_image() && !self.is_for_isf() {
            for (name, value) in std::mem::take(&mut self.inputs.used) {
                if self.is_rewrapped() && !self.declared.contains(&name) {
                    head += &declaration(name, value);
                    head.push('\n');
                }
            }
        }
        let color = names::fresh("outColor", &names::words(self.source));
        let declares_color =
            self.version != Version::Es100 && !self.to.calls_main_image() && !self.is_for_isf();
        let is_declared = self
            .checked
            .output
            .is_some_and(|output| self.checked.tree[output].at.is_some());
        if declares_color && !is_declared {
            let _ = writeln!(head, "out vec4 {color};");
        }
        if let Color::Global(name, ty) = &self.color
            && !is_declared
        {
            let _ = writeln!(head, "{};", self.checked.tree.declaration(name, *ty));
        }
        for (declaration, _) in &self.globals {
            // Declared inputs are replaced where they are declared.
            if self.checked.dialect.is_implicit() {
                let _ = writeln!(head, "{declaration}");
            }
        }
        let functions = self.texel_functions();
        if !head.is_empty() && !functions.is_empty() {
            head.push('\n');
        }
        head += &functions;
        let color = if declares_color { &color } else { FRAG_COLOR };
        let tail = self.tail(color);
        let mut text = self.version_line();
        let source = self.source.text;
        let mut first = self.source.span(0).start as usize;
        let line = source[..first].rfind('\n').map_or(0, |at| at + 1);
        if source[line..first].trim().is_empty() {
            first = line;
        }
        self.edits.sort_by_key(|(span, _)| span.start);
        let mut body = String::new();
        let mut at = 0;
        if !head.is_empty() && !head.ends_with("\n\n") {
            head.push('\n');
        }
        let mut head = Some(head);
        for (span, edit) in &self.edits {
            let start = (span.start as usize).max(at);
            if start >= first
                && let Some(head) = head.take()
            {
                body += &source[at..first.max(at)];
                body += &head;
                at = first.max(at);
            }
            body += &source[at..start.max(at)];
            body += edit;
            at = (span.end as usize).max(at);
            // Of the empty lines around what was removed, one stays.
            if edit.is_empty() && (body.is_empty() || body.ends_with("\n\n")) {
                let rest = &source[at..];
                at += rest.len() - rest.strip_prefix("\n").unwrap_or(rest).len();
            }
        }
        if let Some(head) = head {
            body += &source[at..first.max(at)];
            body += &head;
            at = first.max(at);
        }
        body += &source[at..];
        text += without_empty_conditions(&body).trim_start_matches(['\n', '\r']);
        if !tail.is_empty() {
            text.truncate(text.trim_end().len());
            text += "\n\n";
            text += &tail;
        }
        // What is added has line feeds alone.
        text.replace("\r\n", "\n")
    }

    fn version_line(&self) -> String {
        if self.to.calls_main_image() || self.is_for_isf() {
            return String::new();
        }
        let mut line = self.version.directive();
        let is_enabled = self.checked.version == Version::Es100
            && names::words(self.source).contains("GL_OES_standard_derivatives");
        if self.version == Version::Es100 && self.checked.takes_derivatives() && !is_enabled {
            line += "#extension GL_OES_standard_derivatives : enable\n";
        }
        line
    }

    /// The default precision, unless the text has one.
    fn precision(&self) -> String {
        // That of a shader with `mainImage` stands behind the inputs.
        let has_one = !self.becomes_main() && names::words(self.source).contains("precision");
        match self.version {
            _ if has_one || self.to.calls_main_image() || !self.version.is_es() => String::new(),
            Version::Es100 => "#ifdef GL_ES\nprecision highp float;\n#endif\n\n".to_owned(),
            _ => "precision highp float;\nprecision highp int;\n\n".to_owned(),
        }
    }

    /// Assigns the values of global variables at the beginning of `main`.
    fn assign_globals(&mut self) {
        let is_wrapped = self.becomes_main() || matches!(self.color, Color::Global(..));
        if is_wrapped || self.globals.is_empty() || self.body.is_empty() {
            return;
        }
        let open = self.source.span(self.body.start);
        let at = Span::new(open.file, open.end, open.end);
        let mut lines = String::new();
        for (_, value) in &self.globals {
            let _ = write!(lines, "\n    {value}");
        }
        self.edits.push((at, lines));
    }

    /// The function that the other host runs, if the shader has only the one that it calls.
    fn tail(&self, color: &str) -> String {
        let mut lines: Vec<String> = self.globals.iter().map(|(_, value)| value.clone()).collect();
        if self.becomes_main() {
            if self.checked.tree.adds_to_color(self.checked.main_image) {
                lines.push(format!("{color} = vec4(0.0, 0.0, 0.0, 1.0);"));
            }
            let main_image = self.name("mainImage");
            lines.push(format!("{main_image}({color}, gl_FragCoord.xy);"));
            // A buffer keeps the alpha that it writes.
            if self.checked.stage == Stage::Image {
                lines.push(format!("{color}.a = 1.0;"));
            }
            return function("main()", &lines);
        }
        let Color::Global(global, ty) = &self.color else {
            return String::new();
        };
        lines.push(format!("{}();", self.wrapped));
        let value = match ty {
            Type::Vector(_, 3) => format!("vec4({global}, 1.0)"),
            Type::Array(id) if self.checked.tree.array(*id).element == Type::Vector(Scalar::Float, 3) => {
                format!("vec4({global}[0], 1.0)")
            }
            Type::Array(_) => format!("{global}[0]"),
            _ => global.clone(),
        };
        lines.push(format!("{} = {value};", self.fragment_color));
        let head = format!(
            "mainImage(out vec4 {}, in vec2 {})",
            self.fragment_color, self.position
        );
        function(&head, &lines)
    }
}

fn function(head: &str, lines: &[String]) -> String {
    let lines = lines.join("\n    ");
    format!("void {head} {{\n    {lines}\n}}\n")
}

/// The text without conditions of `GL_ES` in which nothing is left, and without the empty line behind them.
fn without_empty_conditions(text: &str) -> String {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let mut kept = String::new();
    let mut at = 0;
    while at < lines.len() {
        let line: String = lines[at].split_whitespace().collect::<Vec<_>>().join(" ");
        let is_condition = matches!(
            &*line,
            "#ifdef GL_ES" | "#if defined(GL_ES)" | "#if defined GL_ES"
        );
        let next = (at + 1..lines.len()).find(|&next| !lines[next].trim().is_empty());
        if let Some(end) = next.filter(|&next| is_condition && lines[next].trim() == "#endif") {
            at = end + 1;
            if lines.get(at).is_some_and(|line| line.trim().is_empty()) {
                at += 1;
            }
        } else {
            kept += lines[at];
            at += 1;
        }
    }
    kept
}
