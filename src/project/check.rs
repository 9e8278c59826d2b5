//! Compiles all tabs of a project, as the site does: every pass with Common in front, and Common alone.

use toyproof_diagnostic::{Code, Diagnostic, Diagnostics, File, FileId, Files};
use toyproof_glsl::tree::SamplerShape;
use toyproof_glsl::{self as glsl, Checked, Options, Stage};
use toyproof_lint::{Lints, lint};
use toyproof_player::{BUFFERS, CUBE_A};

use crate::files::IncludeFolders;
use crate::pass::{Pass, PassKind, SourceType};
use crate::project::Project;

/// A project all of whose tabs compile.
#[derive(Debug)]
pub struct CheckedProject {
    /// The passes, in the order of the project.
    pub passes: Vec<CheckedPass>,
    /// The warnings about all tabs, each once, however many passes contain Common.
    pub warnings: Vec<Diagnostic>,
}

/// A pass without errors.
#[derive(Debug)]
pub struct CheckedPass {
    /// The kind of pass.
    pub kind: PassKind,
    /// The tree, whose spans refer to the joined text of the tabs.
    pub checked: Checked,
    /// The lints' findings.
    pub lints: Lints,
}

/// The lints may take one part in this many of the time limit.
pub(crate) const LINT_TIME_SHARE: u32 = 4;

/// Checks all tabs of a project, and adds the texts that the compiler sees to `files`. The stage and the
/// shapes of channels in `options` are those of the passes.
///
/// # Errors
/// The diagnostics of all tabs, if one of them has an error; those about Common are reported once.
pub fn check(project: &Project, files: &mut Files, options: &Options) -> Result<CheckedProject, Diagnostics> {
    check_with_includes(project, None, files, options)
}

/// Checks a project as [`check`] does, with the files that its tabs include.
pub(crate) fn check_with_includes(
    project: &Project,
    includes: Option<&IncludeFolders>,
    files: &mut Files,
    options: &Options,
) -> Result<CheckedProject, Diagnostics> {
    let mut options = options.clone();
    options.add_uniforms(&project.uniforms);
    let options = &options;
    let mut reported = UniqueDiagnostics::default();
    let mut is_valid = true;
    let include = |files: &mut Files, file: FileId, options: &Options| match includes {
        Some(includes) => includes.include(files, file, options),
        None => Ok(file),
    };
    if let Some(common) = project.common {
        let options = common_options(options);
        let common = include(files, common, &options);
        if let Err(errors) = common.and_then(|common| glsl::check_declarations(files, common, &options)) {
            is_valid = false;
            reported.add(files, errors);
        }
    }
    let mut passes = Vec::new();
    for pass in &project.passes {
        let options = pass_options(project, pass, options);
        let file = joined(project, pass, None, files);
        let file = match include(files, file, &options) {
            Ok(file) => file,
            Err(errors) => {
                is_valid = false;
                reported.add(files, errors);
                continue;
            }
        };
        match glsl::check(files, file, &options) {
            Ok(checked) => {
                let lints = lint(files, &checked, &options.deadline.share(LINT_TIME_SHARE));
                let checked = match added_main(&checked) {
                    None => checked,
                    Some(added) => {
                        let options = Options {
                            calls_added_main: true,
                            ..options
                        };
                        let file = joined(project, pass, Some(added), files);
                        include(files, file, &options).and_then(|file| glsl::check(files, file, &options))?
                    }
                };
                passes.push(CheckedPass {
                    kind: pass.kind,
                    checked,
                    lints,
                });
            }
            Err(errors) => {
                is_valid = false;
                reported.add(files, glsl::with_single_edit(files, file, errors, &options));
            }
        }
    }
    if !is_valid {
        return Err(Diagnostics::new(reported.0, files));
    }
    let checked: Vec<_> = passes.iter().map(|pass| (&pass.checked, &pass.lints)).collect();
    reported.add_warnings(project, files, &checked);
    Ok(CheckedProject {
        passes,
        warnings: reported.0,
    })
}

/// The options with which Common is compiled alone.
pub(crate) fn common_options(options: &Options) -> Options {
    Options {
        stage: Stage::Common,
        ..options.clone()
    }
}

/// The options with which a pass is compiled.
pub(crate) fn pass_options(project: &Project, pass: &Pass, options: &Options) -> Options {
    Options {
        stage: stage(pass.kind),
        channels: channels(project, pass),
        sampling: project.sampling(pass),
        ..options.clone()
    }
}

/// Diagnostics, each once for all passes.
#[derive(Default)]
pub(crate) struct UniqueDiagnostics(pub(crate) Vec<Diagnostic>);

impl UniqueDiagnostics {
    pub(crate) fn add(&mut self, files: &Files, diagnostics: impl IntoIterator<Item = Diagnostic>) {
        for diagnostic in diagnostics {
            let diagnostic = diagnostic.in_origin(files);
            // Another pass may suggest another fix, or name the tab.
            let is_same =
                |other: &Diagnostic| (&other.code, other.span) == (&diagnostic.code, diagnostic.span);
            if diagnostic.span.is_none() || !self.0.iter().any(is_same) {
                self.0.push(diagnostic);
            }
        }
    }

    /// Adds the warnings about the passes of a valid project, which are given in its order.
    pub(crate) fn add_warnings(&mut self, project: &Project, files: &Files, passes: &[(&Checked, &Lints)]) {
        let common = project.common;
        let warnings = passes.iter().map(|(_, lints)| in_origin(files, &lints.warnings));
        let warnings: Vec<_> = warnings.collect();
        // An `allow` in Common may serve the warning of one pass only.
        let is_used_elsewhere = |warning: &Diagnostic| {
            let is_in_common = warning.span.is_some_and(|span| Some(span.file) == common);
            let is_unused = warning.code == Code::UnusedAllow;
            is_unused && is_in_common && !warnings.iter().all(|of_pass| of_pass.contains(warning))
        };
        for warning in warnings
            .iter()
            .flatten()
            .filter(|warning| !is_used_elsewhere(warning))
        {
            self.add(files, [warning.clone()]);
        }
        let trees: Vec<_> = passes.iter().map(|&(checked, _)| checked).collect();
        self.add(files, crate::lint::lint(project, &trees));
    }
}

fn in_origin(files: &Files, diagnostics: &[Diagnostic]) -> Vec<Diagnostic> {
    diagnostics.iter().map(|one| one.in_origin(files)).collect()
}

fn stage(kind: PassKind) -> Stage {
    match kind {
        PassKind::Image => Stage::Image,
        PassKind::Buffer(_) => Stage::Buffer,
        PassKind::CubeA => Stage::Cubemap,
        PassKind::Sound => Stage::Sound,
    }
}

/// The shapes of the channels: an unbound one is a `sampler2D`, unless the project does not say what is
/// bound.
fn channels(project: &Project, pass: &Pass) -> [Option<SamplerShape>; 4] {
    pass.inputs.each_ref().map(|input| match input {
        None if project.knows_inputs => Some(SamplerShape::D2),
        None => None,
        Some(input) => Some(match input.source.source_type() {
            SourceType::Cubemap => SamplerShape::Cube,
            // The Sound tab declares volumes as 2D textures.
            SourceType::Volume if pass.kind != PassKind::Sound => SamplerShape::D3,
            _ => SamplerShape::D2,
        }),
    })
}

/// The text before an Image tab that uses `st_assert`. The site declares these functions in this tab only.
const ASSERTIONS: &str = include_str!("st_assert.glsl");

/// The text after such a tab: a failed assertion replaces the color.
const ASSERTED: &str = include_str!("st_asserted.glsl");

/// The text after the tab of a cube map. It renders the faces stacked in one image, and rounds to the half
/// floats of the site's texture.
const CUBE_MAIN: &str = include_str!("cube_main.glsl");

/// The text after the tab of a sound. Like the site, it computes blocks of 512×512 samples, row by row.
const SOUND_MAIN: &str = include_str!("sound_main.glsl");

/// The text after a tab whose function has not the form of `mainImage`: it calls that function.
fn added_main(checked: &Checked) -> Option<String> {
    match checked.stage {
        Stage::Cubemap => Some(CUBE_MAIN.to_owned()),
        Stage::Sound => {
            // Older shaders omit the sample number.
            let arguments = match checked.tree[checked.main_image].parameters[..] {
                [_] => "toyproof_time",
                _ => "toyproof_sample, toyproof_time",
            };
            Some(SOUND_MAIN.replace("TOYPROOF_SOUND", arguments))
        }
        Stage::Image | Stage::Buffer | Stage::Common => None,
    }
}

/// Adds the text that is compiled for a pass: Common, a line feed, the tab, and perhaps a text after it.
pub(crate) fn joined(project: &Project, pass: &Pass, added: Option<String>, files: &mut Files) -> FileId {
    let mut parts: Vec<_> = project.common.into_iter().chain([pass.file]).collect();
    parts.extend(added.map(|text| files.add(File::new("<main>", text))));
    let uses_assertions = |part: &FileId| files.get(*part).text().contains("st_assert");
    if pass.kind == PassKind::Image && parts.iter().any(uses_assertions) {
        parts.insert(0, files.add(File::new("<st_assert>", ASSERTIONS)));
        parts.push(files.add(File::new("<st_assert>", ASSERTED)));
    }
    let name = files.get(pass.file).name().to_owned();
    match parts[..] {
        [only] => only,
        _ => files.join(name, &parts),
    }
}

impl Project {
    /// The passes that the image needs and that are rendered before it: the buffers and the cube map that it
    /// reads, and those that these read.
    #[must_use]
    pub fn needed_by_image(&self) -> Vec<PassKind> {
        let mut needed = self.needed_by(&[PassKind::Image]);
        needed.retain(|kind| *kind != PassKind::Image);
        needed
    }

    /// These passes, and those that they read, directly or not.
    pub(crate) fn needed_by(&self, passes: &[PassKind]) -> Vec<PassKind> {
        let mut needed = passes.to_vec();
        let mut next = 0;
        while let Some(&kind) = needed.get(next) {
            next += 1;
            let inputs = self
                .pass(kind)
                .into_iter()
                .flat_map(|pass| pass.inputs.iter().flatten());
            for read in inputs.filter_map(|input| input.source.pass()) {
                if !needed.contains(&read) && self.pass(read).is_some() {
                    needed.push(read);
                }
            }
        }
        let order = |kind: &PassKind| match kind {
            PassKind::Buffer(buffer) => buffer.number(),
            PassKind::CubeA => CUBE_A,
            PassKind::Image => BUFFERS,
            PassKind::Sound => BUFFERS + 1,
        };
        needed.sort_by_key(order);
        needed
    }
}
