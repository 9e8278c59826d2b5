//! Analyzes all tabs of a project for an editor: what [`check`](crate::check()) reports, and the trees of
//! tabs with errors.

use toyproof_diagnostic::{Diagnostic, FileId, Files};
use toyproof_glsl::{self as glsl, Analysis, Options};
use toyproof_lint::lint;

use crate::check::{LINT_TIME_SHARE, UniqueDiagnostics, common_options, joined, pass_options};
use crate::files::{IncludeFolders, IncludedFile};
use crate::pass::Tab;
use crate::project::Project;

/// An analyzed project.
#[derive(Debug)]
pub struct AnalyzedProject {
    /// Common, if there is one, and the passes in the order of the project.
    pub tabs: Vec<AnalyzedTab>,
    /// What [`check`](crate::check()) reports, with spans in the files of the tabs: errors, or else warnings.
    pub diagnostics: Vec<Diagnostic>,
    /// The files that the tabs include.
    pub included: Vec<IncludedFile>,
}

/// A tab, with or without errors.
#[derive(Debug)]
pub struct AnalyzedTab {
    /// The tab.
    pub tab: Tab,
    /// Its own text.
    pub file: FileId,
    /// The text that is compiled: for a pass, with Common in front.
    pub text: FileId,
    /// The options with which it is compiled.
    pub options: Options,
    /// What was found in the text that is compiled.
    pub analysis: Analysis,
}

/// Analyzes all tabs of a project, and adds the texts that the compiler sees to `files`. The edit after which
/// an invalid text compiles ([`glsl::single_edit`]) is not searched: an editor needs it for few errors.
pub fn analyze(
    project: &Project,
    includes: Option<&IncludeFolders>,
    files: &mut Files,
    options: &Options,
) -> AnalyzedProject {
    let mut options = options.clone();
    options.add_uniforms(&project.uniforms);
    let common = project
        .common
        .map(|common| (Tab::Common, common, common, common_options(&options)));
    let passes = project.passes.iter().map(|pass| {
        let text = joined(project, pass, None, files);
        (
            Tab::Pass(pass.kind),
            pass.file,
            text,
            pass_options(project, pass, &options),
        )
    });
    let all: Vec<_> = common.into_iter().chain(passes).collect();
    let mut reported = UniqueDiagnostics::default();
    let mut included = Vec::new();
    let mut is_valid = true;
    let mut tabs = Vec::with_capacity(all.len());
    for (tab, file, text, options) in all {
        let (complete, found) = match includes {
            Some(includes) => includes.include_files(files, text, &options),
            None => (Ok(text), Vec::new()),
        };
        included.extend(found);
        // A text whose files cannot be included is analyzed as it is; only that is reported.
        let (text, errors) = match complete {
            Ok(text) => (text, None),
            Err(errors) => (text, Some(errors)),
        };
        let analysis = glsl::analyze(files, text, &options);
        if let Some(errors) = errors {
            is_valid = false;
            reported.add(files, errors);
        } else if !analysis.is_valid() {
            is_valid = false;
            reported.add(files, analysis.diagnostics.clone());
        }
        tabs.push(AnalyzedTab {
            tab,
            file,
            text,
            options,
            analysis,
        });
    }
    if is_valid {
        let checked = tabs.iter().filter_map(|tab| Some((tab, tab.analysis.checked()?)));
        let linted: Vec<_> = checked
            .map(|(tab, checked)| {
                let deadline = tab.options.deadline.share(LINT_TIME_SHARE);
                (checked, lint(files, checked, &deadline))
            })
            .collect();
        let linted: Vec<_> = linted.iter().map(|(checked, lints)| (*checked, lints)).collect();
        reported.add_warnings(project, files, &linted);
    }
    AnalyzedProject {
        tabs,
        diagnostics: reported.0,
        included,
    }
}
