//! What is analyzed together: a shader with the files that it includes, or all tabs of a project.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use lsp_types::Uri;
use toyproof_diagnostic::{Code, Deadline, Diagnostic, File, FileId, Files};
use toyproof_glsl::{self as glsl, Analysis, Options};
use toyproof_lint::lint;
use toyproof_project::files::{IncludeFolders, IncludedFile, Input, InputSource, OpenTexts, read_text};
use toyproof_project::{self as project, AnalyzedProject, Declared, PROJECT_FILE, Project, Tab};

/// How long the front end may take for a text: it needs milliseconds, but a text may be made to need more.
const TIME_LIMIT: Duration = Duration::from_secs(2);

/// The lints may take one part in this many of the time limit, as in `check`.
const LINT_TIME_SHARE: u32 = 4;

/// Texts that are analyzed together.
#[derive(Debug)]
pub(crate) struct Unit {
    /// All texts, those of the user and those that the compiler sees.
    pub(crate) files: Files,
    /// The shader, or the first tab.
    pub(crate) own: FileId,
    /// The texts that are compiled: one for a shader, Common and the passes for a project.
    pub(crate) texts: Vec<UnitText>,
    /// What is reported, with spans in the files of the user.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// The files of the user. Their paths are those of the editor, or canonical ones of included files.
    pub(crate) paths: BTreeMap<FileId, PathBuf>,
    /// The URIs of the files of the user: those of the editor for open documents.
    pub(crate) uris: BTreeMap<FileId, Uri>,
}

/// A text that is compiled.
#[derive(Debug)]
pub(crate) struct UnitText {
    /// The user's file that it is compiled for.
    pub(crate) own: FileId,
    /// The whole text: with included files, and Common in front.
    pub(crate) whole: FileId,
    /// The options with which it is compiled, without a deadline.
    pub(crate) options: Options,
    pub(crate) analysis: Analysis,
}

/// What a unit reads instead of files on disk, and how it is compiled.
#[derive(Debug, Clone, Default)]
pub(crate) struct Surroundings {
    /// The texts of open documents, by path and by canonical path.
    pub(crate) open: OpenTexts,
    /// The options of every check.
    pub(crate) options: Options,
    /// Further folders in which included files may lie.
    pub(crate) include_folders: Vec<PathBuf>,
}

impl Surroundings {
    fn options(&self) -> Options {
        Options {
            deadline: Deadline::after(TIME_LIMIT),
            ..self.options.clone()
        }
    }

    fn includes(&self, path: &Path) -> IncludeFolders {
        let input = Input {
            source: InputSource::File(path.to_owned()),
            relative: PathBuf::new(),
            folder: None,
        };
        IncludeFolders::of(&input, &self.include_folders).with_open_texts(self.open.clone())
    }

    /// The text of a file: that of the editor, else that on disk.
    fn read(&self, path: &Path) -> Option<File> {
        // Messages name files by their names: the editor shows where they are.
        let name = path.file_name()?.to_string_lossy();
        match self.open.get(path) {
            Some(text) => Some(File::new(name, text)),
            None => read_text(path).ok().map(|file| File::new(name, file.text())),
        }
    }
}

fn without_deadline(options: Options) -> Options {
    Options {
        deadline: Deadline::default(),
        ..options
    }
}

impl Unit {
    /// Analyzes a shader; `path` is that of its file, if it has one.
    pub(crate) fn of_shader(file: &File, path: Option<&Path>, surroundings: &Surroundings) -> Self {
        let mut files = Files::default();
        let own = files.add(file.clone());
        let mut options = surroundings.options();
        let (complete, included) = match path {
            Some(path) => surroundings
                .includes(path)
                .include_files(&mut files, own, &options),
            None => (Ok(own), Vec::new()),
        };
        let declared = complete.and_then(|whole| project::with_declarations(&mut files, whole, &mut options));
        let mut unit = match declared {
            Ok(Declared::Project(declared)) => {
                let analyzed = project::analyze(&declared, None, &mut files, &options);
                Self::of_analyzed(files, own, analyzed)
            }
            Ok(Declared::Shader(whole)) => {
                let analysis = glsl::analyze(&files, whole, &options);
                let diagnostics = match analysis.checked() {
                    Some(checked) => lint(&files, checked, &options.deadline.share(LINT_TIME_SHARE)).warnings,
                    None => analysis.diagnostics.clone(),
                };
                Self::of_text(files, own, whole, options, analysis, &diagnostics)
            }
            // A text whose files or headers cannot be read is analyzed as it is; only that is reported.
            Err(errors) => {
                let analysis = glsl::analyze(&files, own, &options);
                Self::of_text(files, own, own, options, analysis, &errors)
            }
        };
        unit.paths.extend(path.map(|path| (own, path.to_owned())));
        unit.add_included(included);
        unit
    }

    fn of_text(
        files: Files,
        own: FileId,
        whole: FileId,
        options: Options,
        analysis: Analysis,
        diagnostics: &[Diagnostic],
    ) -> Self {
        let diagnostics = diagnostics.iter().map(|one| one.in_origin(&files)).collect();
        let text = UnitText {
            own,
            whole,
            options: without_deadline(options),
            analysis,
        };
        Self {
            files,
            own,
            texts: vec![text],
            diagnostics,
            paths: BTreeMap::new(),
            uris: BTreeMap::new(),
        }
    }

    /// Analyzes the project in a folder; `None` if it has no Image tab that can be read.
    pub(crate) fn of_project(folder: &Path, surroundings: &Surroundings) -> Option<Self> {
        let mut files = Files::default();
        let mut paths = BTreeMap::new();
        let mut read = |name: &str, files: &mut Files| {
            let path = folder.join(name);
            let file = files.add(surroundings.read(&path)?);
            paths.insert(file, path);
            Some(file)
        };
        let mut tabs = Vec::new();
        for tab in Tab::ALL {
            if let Some(file) = read(&tab.file_name(), &mut files) {
                tabs.push((tab, file));
            }
        }
        let toml = read(PROJECT_FILE, &mut files);
        let (project, errors) = match Project::from_folder(&files, toml, &tabs) {
            Ok(project) => (project, Vec::new()),
            // Without the inputs of `project.toml`, the tabs can still be read.
            Err(errors) => (Project::from_folder(&files, None, &tabs).ok()?, errors.into()),
        };
        let includes = surroundings.includes(folder);
        let analyzed = project::analyze(&project, Some(&includes), &mut files, &surroundings.options());
        let mut unit = Self::of_analyzed(files, tabs[0].1, analyzed);
        unit.paths.extend(paths);
        if !errors.is_empty() {
            unit.diagnostics = errors;
        }
        Some(unit)
    }

    fn of_analyzed(files: Files, own: FileId, analyzed: AnalyzedProject) -> Self {
        let texts = analyzed.tabs.into_iter().map(|tab| UnitText {
            own: tab.file,
            whole: tab.text,
            options: without_deadline(tab.options),
            analysis: tab.analysis,
        });
        let mut unit = Self {
            texts: texts.collect(),
            diagnostics: analyzed.diagnostics,
            files,
            own,
            paths: BTreeMap::new(),
            uris: BTreeMap::new(),
        };
        unit.add_included(analyzed.included);
        unit
    }

    fn add_included(&mut self, included: Vec<IncludedFile>) {
        let included = included.into_iter();
        self.paths
            .extend(included.map(|included| (included.file, included.path)));
    }

    /// The user's file at a path.
    pub(crate) fn file_at(&self, path: &Path) -> Option<FileId> {
        let mut paths = self.paths.iter();
        paths.find(|(_, of_file)| *of_file == path).map(|(&file, _)| file)
    }

    /// Whether the only error is that the text has no entry point, as in a file that others include.
    pub(crate) fn lacks_only_entry(&self) -> bool {
        let mut diagnostics = self.diagnostics.iter();
        diagnostics.any(|one| one.code == Code::NoMainImage) && self.diagnostics.len() == 1
    }
}
