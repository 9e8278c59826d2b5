//! The target language and the kind of output, which the arguments and the extension of the output determine.

use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use toyproof_convert::Host;
use toyproof_diagnostic::path_name;
use toyproof_glsl::Dialect;
use toyproof_translate::FloatMode;
use toyproof_translate::backend::Target;
use toyproof_translate::c_family::CHost;
use toyproof_translate::wgsl::Style;

use super::Args;
use crate::cli::CliError;
use crate::cli::inputs::Format;

/// The values of `--to`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum To {
    Wgsl,
    #[value(alias = "spirv")]
    Spv,
    #[value(alias = "msl")]
    Metal,
    Hlsl,
    Glsl,
    /// An ES module for three.js, with --style three
    Js,
    /// The GLSL 450 that naga reads
    Lowered,
}

/// The values of `--style`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum StyleName {
    /// A fragment shader with the bindings below; row 0 of its target is the bottom
    Plain,
    /// A `shader_main` function for the Python package wgpu-shadertoy
    WgpuShadertoy,
    /// A compute shader for compute.toys
    ComputeToys,
    /// A fragment shader for a Material2d of Bevy
    Bevy,
    /// A shader for Unity
    Unity,
    /// A pixel shader for Windows Terminal
    WindowsTerminal,
    /// A module of Slang with the bindings below
    Slang,
    /// A shader of Godot 4, for 2D
    Godot,
    /// GLSL for ShaderToy
    Shadertoy,
    /// GLSL for the terminal Ghostty
    Ghostty,
    /// GLSL for The Book of Shaders and glslViewer
    BookOfShaders,
    /// GLSL for GLSL Sandbox
    GlslSandbox,
    /// GLSL for three.js or p5.js; with an output .js, an ES module for three.js
    Three,
    /// ISF, with a header in JSON, and all passes in one file
    Isf,
    /// GLSL for a page with WebGL that sets ShaderToy's inputs as uniforms
    Webgl,
}

impl StyleName {
    /// The host of WGSL.
    pub(super) fn wgsl(self) -> Option<Style> {
        match self {
            Self::Plain => Some(Style::Plain),
            Self::WgpuShadertoy => Some(Style::WgpuShadertoy),
            Self::ComputeToys => Some(Style::ComputeToys),
            Self::Bevy => Some(Style::Bevy),
            _ => None,
        }
    }

    /// The host of a language with the syntax of C; `None` for the plain one.
    pub(super) fn c_family(self) -> Option<CHost> {
        match self {
            Self::Unity => Some(CHost::Unity),
            Self::WindowsTerminal => Some(CHost::WindowsTerminal),
            Self::Slang => Some(CHost::Slang),
            Self::Godot => Some(CHost::Godot),
            _ => None,
        }
    }

    /// The language of the style, if it is of one only.
    fn language(self) -> Option<To> {
        match self {
            Self::Plain => None,
            Self::Godot => Some(To::Glsl),
            _ if self.c_family().is_some() => Some(To::Hlsl),
            _ if self.dialect().is_some() => Some(To::Glsl),
            _ => Some(To::Wgsl),
        }
    }

    /// The host of GLSL.
    pub(super) fn dialect(self) -> Option<Dialect> {
        Dialect::named(self.to_possible_value()?.get_name())
    }
}

impl To {
    /// The target of the backends; `None` for lowered GLSL, which naga only reads.
    pub(super) fn target(self) -> Option<Target> {
        match self {
            Self::Wgsl => Some(Target::Wgsl),
            Self::Spv => Some(Target::Spirv),
            Self::Metal => Some(Target::Msl),
            Self::Hlsl => Some(Target::Hlsl),
            Self::Glsl | Self::Js => Some(Target::Glsl),
            Self::Lowered => None,
        }
    }

    /// The name on the command line.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Js => "js",
            _ => self.target().map_or("lowered", Target::name),
        }
    }

    /// Returns whether a file with the extension of this language may contain `written`: lowered output is
    /// GLSL.
    fn may_contain(self, written: Self) -> bool {
        self == written || (self, written) == (Self::Glsl, Self::Lowered)
    }

    fn from_extension(path: &Path) -> Option<Self> {
        let has_extension = |name| {
            path.extension()
                .is_some_and(|extension| extension.eq_ignore_ascii_case(name))
        };
        if has_extension("js") {
            return Some(Self::Js);
        }
        if has_extension("fs") {
            return Some(Self::Glsl);
        }
        let target = Target::from_path(path)?;
        Self::value_variants()
            .iter()
            .copied()
            .find(|to| to.target() == Some(target))
    }
}

/// The kind of output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OutputKind {
    /// A shader, as one file.
    File,
    /// The passes of a project.
    Passes,
    /// Several shaders or projects.
    Shaders,
}

/// The host whose file has all passes of a shader, if the arguments name one.
pub(super) fn host(args: &Args) -> Option<Host> {
    let of_output = args.output.as_deref().and_then(To::from_extension);
    let is_module = args.to.or(of_output) == Some(To::Js);
    match args.style {
        StyleName::Three if is_module => Some(Host::Three),
        StyleName::Isf => Some(Host::Isf),
        _ => None,
    }
}

/// Returns the output that the arguments name, or its default, which several shaders do not have.
pub(super) fn output(args: &Args, kind: OutputKind) -> Result<PathBuf, CliError> {
    match &args.output {
        Some(output) => Ok(output.clone()),
        None if kind == OutputKind::File => Ok(PathBuf::from("-")),
        None => Err(needs_folder(kind, Path::new("-"))),
    }
}

/// Returns the language that the arguments or the extension of the output name.
///
/// # Errors
/// They disagree, or the output cannot take the results.
pub(super) fn target_language(args: &Args, output: &Path, kind: OutputKind) -> Result<To, CliError> {
    let is_standard_output = output == Path::new("-");
    let several = kind != OutputKind::File;
    let of_extension = (!is_standard_output && !output.is_dir())
        .then(|| To::from_extension(output))
        .flatten();
    let of_style = match host(args) {
        Some(Host::Three) => Some(To::Js),
        Some(Host::Isf) | None => args.style.language(),
    };
    let to = match (args.to.or(of_style), of_extension) {
        (Some(to), Some(other)) if !other.may_contain(to) => {
            let error = CliError::new(format_args!(
                "the extension of {} means {}, but {} {}",
                path_name(output),
                other.name(),
                if args.to.is_some() {
                    "--to is"
                } else {
                    "the --style is of"
                },
                to.name()
            ));
            return Err(error.with_help("leave it out, or give the output another extension"));
        }
        (to, of) => to.or(of),
    };
    let Some(to) = to.or((is_standard_output || several || output.is_dir()).then_some(To::Wgsl)) else {
        let error = format!("cannot determine the language of {}", path_name(output));
        let extension = output.extension().unwrap_or_default();
        let mut hosts = CHost::ALL.into_iter();
        let help = match hosts.find(|host| !host.is_plain() && extension == host.extension()) {
            Some(host) => format!("for {}, add --style {}", host.title(), host.name()),
            None => "give it an extension (.wgsl .spv .metal .hlsl .frag), or name the language with --to"
                .to_owned(),
        };
        return Err(CliError::new(error).with_help(help));
    };
    if several && (is_standard_output || of_extension.is_some()) {
        return Err(needs_folder(kind, output));
    }
    if is_standard_output && to == To::Spv && io::stdout().is_terminal() {
        let error = CliError::new("SPIR-V is binary and is not written to a terminal");
        return Err(error.with_help("name a file with -o"));
    }
    if is_standard_output && args.format == Format::Json {
        let error = CliError::new("--format json needs standard output, and so does the converted shader");
        return Err(error.with_help("name a file or a folder with -o"));
    }
    Ok(to)
}

/// Checks that the options apply to the target language.
pub(super) fn check_target(args: &Args, to: To) -> Result<(), &'static str> {
    let dialect = args.style.dialect();
    match args.style.language() {
        Some(To::Hlsl) if to != To::Hlsl => return Err("this --style applies to HLSL only"),
        Some(To::Glsl) if !matches!(to, To::Glsl | To::Js) => {
            return Err("this --style applies to GLSL only");
        }
        Some(To::Wgsl) if to != To::Wgsl => return Err("this --style applies to WGSL only"),
        _ => {}
    }
    if to == To::Js && host(args) != Some(Host::Three) {
        return Err("a module is written for three.js: add --style three");
    }
    if args.style.c_family().is_some() && args.driver.explicit_float() == Some(FloatMode::Strict) {
        return Err("this --style keeps the author's functions: leave out --float strict");
    }
    if dialect.is_some() && args.driver.explicit_float() == Some(FloatMode::Strict) {
        return Err("this --style keeps the author's operations: leave out --float strict");
    }
    let is_run = host(args) == Some(Host::Three);
    if args.browser && !is_run && dialect.is_some_and(|dialect| !dialect.calls_main_image()) {
        return Err("--browser renders ShaderToy's inputs only: leave it out for this --style");
    }
    if args.browser && !matches!(to, To::Wgsl | To::Glsl | To::Js) {
        return Err("--browser applies to WGSL and GLSL, the languages that browsers run");
    }
    Ok(())
}

/// Several files cannot be written to one.
fn needs_folder(kind: OutputKind, output: &Path) -> CliError {
    let output = if output == Path::new("-") {
        "standard output".to_owned()
    } else {
        path_name(output)
    };
    let what = match kind {
        OutputKind::Passes => "the passes of a project",
        OutputKind::File | OutputKind::Shaders => "several shaders",
    };
    CliError::new(format_args!("{what} cannot be written to {output}")).with_help("name a folder with -o")
}
