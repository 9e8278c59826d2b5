//! Directives: the lines that begin with `#`.

use toyproof_diagnostic::{Code, Diagnostic, Fix, Span, nearest};

use super::macros::expect_end_of_directive;
use super::{PpToken, Prefix, Preprocessor};
use crate::dialect::Version;
use crate::token::TokenKind;
use crate::tree::Place;

/// The directives (§3.4).
pub(crate) const DIRECTIVES: [&str; 13] = [
    "define",
    "undef",
    "if",
    "ifdef",
    "ifndef",
    "elif",
    "else",
    "endif",
    "error",
    "pragma",
    "extension",
    "version",
    "line",
];

/// The directives that conditions consist of.
const CONDITIONS: [&str; 6] = ["if", "ifdef", "ifndef", "elif", "else", "endif"];

/// The extension of `dFdx`, `dFdy` and `fwidth`.
const DERIVATIVES: &str = "GL_OES_standard_derivatives";

/// The extensions of GLSL ES 1.00 that add functions or outputs to fragment shaders.
const EXTENSIONS_OF_WEBGL_1: [&str; 4] = [
    DERIVATIVES,
    "GL_EXT_shader_texture_lod",
    "GL_EXT_frag_depth",
    "GL_EXT_draw_buffers",
];

fn unknown_directive(name: &str, at: Place) -> Diagnostic {
    if name == "include" {
        let diagnostic = Code::BadInclude.at(at, "a text without a folder cannot include files");
        return diagnostic.help("paste the code of the file");
    }
    let diagnostic = Code::UnknownDirective.at(at, format!("unknown directive `#{name}`"));
    match nearest(name, DIRECTIVES) {
        Some(near) => diagnostic.fix(Fix::new(
            format!("did you mean `#{near}`?"),
            at.span,
            format!("#{near}"),
        )),
        None => diagnostic,
    }
}

impl Preprocessor<'_> {
    /// Executes the directive whose `#` has been read, up to and including its newline.
    pub(super) fn directive(&mut self, hash: Place) {
        let first = self.lex();
        let TokenKind::Word(name) = first.kind else {
            self.null_directive(first);
            return;
        };
        let at = hash.to(first.at);
        let name = self.interner.text(name).to_owned();
        if name == "error" && self.is_active() {
            let message = self.lexer.rest_of_line();
            self.report(Code::ErrorDirective.at(at, format!("#error {message}")));
            return;
        }
        if self.inclusion.is_some() && self.is_active() && (name == "include" || name == "pragma") {
            self.on_include(&name, at);
            return;
        }
        let line = self.rest_of_line();
        if self.is_active()
            && !CONDITIONS.contains(&&*name)
            && let Some(inclusion) = &mut self.inclusion
        {
            inclusion.note_directive(&name);
        }
        let done = match name.as_str() {
            "if" => self.on_if(&line, at),
            "ifdef" => self.on_ifdef(&line, at, true),
            "ifndef" => self.on_ifdef(&line, at, false),
            "elif" => self.on_elif(&line, at),
            "else" => self.on_else(&line, at),
            "endif" => self.on_endif(&line, at),
            _ if !self.is_active() => Ok(()),
            "define" => self.define(&line, at),
            "undef" => self.undef(&line, at),
            "line" => self.line(line, at),
            "version" => self.version(&line, at),
            "extension" => self.extension(&line, at),
            // §3.4: unknown pragmas are ignored. The declaration that an `#iUniform` stands for is in front of the
            // text.
            "pragma" | "iUniform" => Ok(()),
            _ => Err(Box::new(unknown_directive(&name, at))),
        };
        if let Err(diagnostic) = done {
            self.report(*diagnostic);
        }
    }

    /// Handles `#` alone on its line, which has no effect (§3.4).
    fn null_directive(&mut self, first: PpToken) {
        if matches!(first.kind, TokenKind::Newline | TokenKind::End) {
            return;
        }
        if self.is_active() {
            self.report(Code::UnknownDirective.at(first.at, "expected the name of a directive after `#`"));
        }
        self.rest_of_line();
    }

    pub(super) fn rest_of_line(&mut self) -> Vec<PpToken> {
        let mut line = Vec::new();
        loop {
            let token = self.lex();
            if matches!(token.kind, TokenKind::Newline | TokenKind::End) {
                return line;
            }
            line.push(token);
        }
    }

    /// Executes `#line n` or `#line n file`, which take effect from the next line (§3.4). Diagnostics keep
    /// the lines of the file.
    fn line(&mut self, line: Vec<PpToken>, at: Place) -> Result<(), Box<Diagnostic>> {
        let tokens = self.expand_list(line);
        let (number, rest) = self.constant(&tokens, at)?;
        let here = self.line_of(at);
        self.line_offset = number.wrapping_sub(here).wrapping_sub(1);
        if rest.is_empty() {
            return Ok(());
        }
        let (file, rest) = self.constant(rest, at)?;
        self.file_number = file;
        expect_end_of_directive(rest)
    }

    /// The line of a token, counted from the previous query, so that all queries together take linear time.
    pub(super) fn line_of(&mut self, at: Place) -> i64 {
        let (byte, line) = self.counted;
        let start = at.span.start as usize;
        let newlines = |text: &str| text.bytes().map(|byte| i64::from(byte == b'\n')).sum::<i64>();
        let line = if start >= byte {
            line + newlines(&self.text[byte..start])
        } else {
            line - newlines(&self.text[start..byte])
        };
        self.counted = (start, line);
        line
    }

    /// Checks `#version`, which must come first. ShaderToy writes it itself, in front of the text.
    fn version(&mut self, line: &[PpToken], at: Place) -> Result<(), Box<Diagnostic>> {
        if self.seen > Prefix::Nothing {
            return Code::BadVersion.refuse(at, "`#version` must be the first line of code");
        }
        let texts: Vec<_> = line.iter().map(|token| self.text(token)).collect();
        let version = match texts[..] {
            [number] => Version::parse(number, None),
            [number, profile] => Version::parse(number, Some(profile)),
            _ => None,
        };
        let dialect = self.wrapping.dialect;
        let is_supported = match version {
            Some(Version::Es300) => true,
            Some(_) => !dialect.calls_main_image(),
            None => false,
        };
        if is_supported {
            return Ok(());
        }
        let message = format!("unsupported version `{}`", texts.join(" "));
        let span = line.iter().map(|token| token.at.span).reduce(Span::to);
        let diagnostic = Code::BadVersion.at(at, message);
        if !dialect.calls_main_image() {
            let help = "write `100`, `300 es`, `310 es`, or a desktop version such as `330`";
            return Err(diagnostic.help(help).into());
        }
        let help = "ShaderToy uses `#version 300 es`";
        Err(Box::new(match span {
            Some(span) => diagnostic.fix(Fix::new(help, span, "300 es")),
            None => diagnostic.help(help),
        }))
    }

    /// Checks `#extension name : behavior` (§3.5). None is supported but those of WebGL 1 that every browser
    /// has.
    fn extension(&mut self, line: &[PpToken], at: Place) -> Result<(), Box<Diagnostic>> {
        let texts: Vec<_> = line.iter().map(|token| self.text(token)).collect();
        let [name, ":", behavior @ ("require" | "enable" | "warn" | "disable")] = texts[..] else {
            let diagnostic = Code::MalformedDirective.at(at, "malformed `#extension`");
            let help = "write `#extension NAME : BEHAVIOR`, where BEHAVIOR is `require`, `enable`, `warn` or `disable`";
            return Err(Box::new(diagnostic.help(help)));
        };
        let version = self.wrapping.language.version;
        if version == Version::Es100 && EXTENSIONS_OF_WEBGL_1.contains(&name) {
            if name == DERIVATIVES {
                self.enables_derivatives = behavior != "disable";
            }
            return Ok(());
        }
        // Browsers accept it anywhere in GLSL ES 1.00.
        if self.seen == Prefix::Text && version != Version::Es100 {
            return Code::BadExtension.refuse(at, "`#extension` after the first declaration");
        }
        let fatal = behavior == "require" || (name == "all" && behavior == "enable");
        if fatal {
            return Code::BadExtension.refuse(at, format!("unsupported extension `{name}`"));
        }
        if name != "all" {
            let message = format!("unsupported extension `{name}`");
            self.report(Code::UnknownExtension.at(at, message));
        }
        Ok(())
    }

    fn text(&self, token: &PpToken) -> &str {
        match token.kind {
            TokenKind::Word(symbol) | TokenKind::Number(symbol) => self.interner.text(symbol),
            TokenKind::Punctuator(punctuator) => punctuator.text(),
            TokenKind::Unknown(_) | TokenKind::Stray | TokenKind::Newline | TokenKind::End => "",
        }
    }
}
