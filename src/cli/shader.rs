//! Finds and reads shaders, for all commands that take them.

use std::collections::{BTreeMap, HashMap};
use std::fmt;
use std::path::{Component, Path, PathBuf};

use toyproof_diagnostic::{
    Code, Deadline, Diagnostic, Diagnostics, FileId, Files, Severity, grouped, nearest, path_name, plural,
};
use toyproof_glsl::tree::VariableKind;
use toyproof_glsl::{self as glsl, Checked, Stage};
use toyproof_lint::{Lints, lint};
use toyproof_media::MediaFolder;
use toyproof_project::files::{self, IncludeFolders, Input, ReadError, Search, Texts, content_diagnostic};
use toyproof_project::{CompiledProject, Declared, with_declarations};

use super::inputs::{Deny, LanguageArgs};
use super::scenes::with_builtin_hint;
use super::{CliError, Exit, Terminal};

/// The lints may take one part in this many of a shader's time limit.
const LINT_TIME_SHARE: u32 = 4;

/// The text of a shader or of a project, and its trees or the reason why there are none.
pub(super) struct Shader {
    pub(super) name: String,
    pub(super) files: Files,
    pub(super) content: Result<Content, Unusable>,
    /// The lints; of a project, the lints of its image with the warnings about all tabs.
    pub(super) lints: Lints,
    /// Whether this is a project whose image reads other passes, and so may depend on earlier frames.
    pub(super) has_passes: bool,
    /// Whether a student submitted no shader.
    pub(super) is_missing: bool,
}

/// What compiles.
pub(super) enum Content {
    Shader(Box<Checked>),
    Project(CompiledProject),
}

impl Content {
    /// The trees of all passes.
    fn trees(&self) -> Vec<&Checked> {
        match self {
            Self::Shader(checked) => vec![checked.as_ref()],
            Self::Project(project) => project.checked.iter().collect(),
        }
    }
}

/// The warnings about values of uniforms that no pass declares.
fn undeclared_uniforms(content: &Content, options: &glsl::Options) -> Vec<Diagnostic> {
    let trees = content.trees();
    let of_project = match content {
        Content::Project(project) => &project.project.uniforms[..],
        Content::Shader(_) => &[],
    };
    let variables = || trees.iter().flat_map(|checked| checked.tree.variables.iter());
    let uniforms = || variables().filter(|(_, variable)| variable.kind == VariableKind::Uniform);
    let names = || uniforms().map(|(_, variable)| variable.name.as_str());
    let given = options.uniforms.iter().chain(of_project);
    let undeclared = given.map(|value| value.name.as_str());
    let undeclared = undeclared.filter(|&name| names().all(|declared| declared != name));
    let warnings = undeclared.map(|name| {
        let message = format!("the shader declares no uniform `{name}`, whose value is given");
        let warning = Diagnostic::new(Code::UndeclaredUniform, message);
        match nearest(name, names()) {
            Some(near) => warning.help(format!("did you mean `{near}`?")),
            None => warning,
        }
    });
    warnings.collect()
}

/// Why a shader cannot be used.
pub(super) enum Unusable {
    /// The content is invalid.
    Invalid(Vec<Diagnostic>),
    /// The content cannot be read.
    Unreadable(Unreadable),
}

/// Reads and parses a file that the user named, other than a shader.
pub(super) fn parse_named<T>(
    path: &Path,
    parse: impl FnOnce(&Files, FileId) -> Result<T, Diagnostics>,
) -> Result<T, CliError> {
    let mut files = Files::default();
    match files::read_named(path).map_err(|error| content_diagnostic(error, &mut files)) {
        Ok(text) => {
            let file = files.add(text);
            parse(&files, file).map_err(|errors| CliError::diagnostics(errors, &files))
        }
        Err(Ok(diagnostic)) => Err(CliError::diagnostics(vec![diagnostic], &files)),
        Err(Err(error)) => Err(CliError::new(error)),
    }
}

/// A file that cannot be read.
#[derive(Debug, Clone)]
pub(super) struct Unreadable {
    pub(super) name: String,
    /// The fault of the shader.
    pub(super) reason: String,
}

impl From<&ReadError> for Unreadable {
    fn from(error: &ReadError) -> Self {
        Self {
            name: error.name(),
            reason: error.reason(),
        }
    }
}

impl fmt::Display for Unreadable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.name, self.reason)
    }
}

impl Shader {
    pub(super) fn load(
        found: &Result<Input, ReadError>,
        language: &LanguageArgs,
        deadline: Deadline,
    ) -> Self {
        let mut files = Files::default();
        let mut lints = Lints::default();
        let mut has_passes = false;
        let (name, content) = match found {
            Err(error) => (error.name(), Err(Unusable::Unreadable(error.into()))),
            Ok(found) => {
                let options = language.options(deadline);
                let includes = IncludeFolders::of(found, language.include_folders());
                let content = read(
                    found,
                    (&includes, language.media()),
                    &mut files,
                    &mut lints,
                    &mut has_passes,
                    &options,
                );
                if let Ok(content) = &content {
                    lints.warnings.extend(undeclared_uniforms(content, &options));
                }
                let denied = denied(&mut lints.warnings, language.denied());
                let content = match content {
                    Ok(_) if !denied.is_empty() => Err(Unusable::Invalid(denied)),
                    content => content,
                };
                (found.name(), content)
            }
        };
        Self {
            name,
            files,
            content,
            lints,
            has_passes,
            is_missing: matches!(found, Err(ReadError::NotSubmitted(..))),
        }
    }

    /// All tabs, if it is a project.
    pub(super) fn project(&self) -> Option<&CompiledProject> {
        match &self.content {
            Ok(Content::Project(project)) => Some(project),
            _ => None,
        }
    }

    /// The tree of the shader, or of the image of a project, which may read other passes.
    pub(super) fn image(&self) -> Result<&Checked, &Unusable> {
        self.content.as_ref().map(|content| match content {
            Content::Shader(checked) => checked.as_ref(),
            Content::Project(project) => project.image(),
        })
    }

    /// The tree of an image that reads no other passes.
    pub(super) fn single_pass(&self) -> Option<&Checked> {
        self.image().ok().filter(|_| !self.has_passes)
    }

    /// Why a command that renders the image alone cannot use a project; `None` if the image reads no pass.
    pub(super) fn unrendered(&self) -> Option<String> {
        let project = self.project().filter(|_| self.has_passes)?;
        let needed = project.project.needed_by_image();
        let names: Vec<_> = needed.iter().map(ToString::to_string).collect();
        Some(format!(
            "the image reads {}, which this command does not render",
            names.join(", ")
        ))
    }

    /// The tree of the image, which a command needs, whether or not it reads other passes.
    pub(super) fn require_image(&self) -> Result<&Checked, CliError> {
        self.image().map_err(|unusable| match unusable {
            Unusable::Invalid(diagnostics) => {
                CliError::diagnostics(diagnostics.clone(), &self.files).with_exit(Exit::ShaderFault)
            }
            Unusable::Unreadable(error) => CliError::new(error),
        })
    }

    /// Makes the image keep the alpha that it writes, as a buffer does; on the site it is 1.
    pub(super) fn keep_alpha(&mut self) {
        let image = match &mut self.content {
            Ok(Content::Shader(checked)) => checked,
            Ok(Content::Project(project)) => project.image_mut(),
            Err(_) => return,
        };
        image.stage = Stage::Buffer;
    }

    /// The tree of an image that reads no other passes, which a command needs.
    pub(super) fn require_single_pass(&self) -> Result<&Checked, CliError> {
        let checked = self.require_image()?;
        match self.unrendered() {
            Some(reason) => Err(CliError::new(format_args!("{}: {reason}", self.name))),
            None => Ok(checked),
        }
    }

    /// The trees of all passes; empty for a shader that cannot be used.
    pub(super) fn trees(&self) -> Vec<&Checked> {
        self.content.as_ref().map_or_else(|_| Vec::new(), Content::trees)
    }

    /// The shader's source text.
    pub(super) fn text(&self, checked: &Checked) -> &str {
        let at = checked.tree[checked.main_image].at;
        self.files.get(at.span.file).text()
    }
}

/// Removes the warnings that count as errors, and returns them as errors.
pub(super) fn denied(warnings: &mut Vec<Diagnostic>, denied: &[Deny]) -> Vec<Diagnostic> {
    let (mut errors, rest): (Vec<_>, Vec<_>) = std::mem::take(warnings).into_iter().partition(|warning| {
        let includes = |denied: &Deny| denied.includes(warning.code);
        warning.severity == Severity::Warning && denied.iter().any(includes)
    });
    *warnings = rest;
    for error in &mut errors {
        error.severity = Severity::Error;
    }
    errors
}

fn read(
    found: &Input,
    (includes, media): (&IncludeFolders, Option<&MediaFolder>),
    files: &mut Files,
    lints: &mut Lints,
    has_passes: &mut bool,
    options: &glsl::Options,
) -> Result<Content, Unusable> {
    match files::read(found) {
        Ok(Texts::Shader(text)) => {
            let file = files.add(text);
            let mut options = options.clone();
            let complete = includes.include(files, file, &options);
            let complete = complete.and_then(|file| with_declarations(files, file, &mut options));
            let file = match complete.map_err(|errors| Unusable::Invalid(errors.into()))? {
                Declared::Shader(file) => file,
                Declared::Project(project) => {
                    *has_passes = !project.needed_by_image().is_empty();
                    let compiled = CompiledProject::compile(*project, (None, media), None, files, &options);
                    let (project, of_project) =
                        compiled.map_err(|errors| Unusable::Invalid(errors.into()))?;
                    *lints = of_project;
                    return Ok(Content::Project(project));
                }
            };
            let checked = glsl::check(files, file, &options)
                .map_err(|errors| Unusable::Invalid(glsl::with_single_edit(files, file, errors, &options)))?;
            *lints = lint(files, &checked, &options.deadline.share(LINT_TIME_SHARE));
            Ok(Content::Shader(Box::new(checked)))
        }
        Ok(Texts::Project(texts)) => {
            let invalid = |errors: Diagnostics| Unusable::Invalid(errors.into());
            let folder = texts.folder().map(Path::to_owned);
            let project = texts.parse(files).map_err(invalid)?;
            *has_passes = !project.needed_by_image().is_empty();
            // JSON of the site is a project without a folder, and has its texts in itself.
            let includes = folder.is_some().then_some(includes);
            let compiled =
                CompiledProject::compile(project, (folder.as_deref(), media), includes, files, options);
            let (project, of_project) = compiled.map_err(invalid)?;
            *lints = of_project;
            Ok(Content::Project(project))
        }
        Err(error) => Err(match content_diagnostic(error, files) {
            Ok(diagnostic) => Unusable::Invalid(vec![diagnostic]),
            Err(error) => Unusable::Unreadable((&error).into()),
        }),
    }
}

/// Finds all shaders that the arguments name, in their order; standard input is read once. Warns of links
/// that are not followed, and of archives and texts.
pub(super) fn find(arguments: &[PathBuf], terminal: &Terminal) -> Vec<Result<Input, ReadError>> {
    find_in(arguments, terminal, |_, _| {})
}

/// Finds the only shader that an argument of a command names.
pub(super) fn find_one(
    argument: &Path,
    command: &str,
    terminal: &Terminal,
) -> Result<Result<Input, ReadError>, CliError> {
    let mut found = find(&[argument.to_owned()], terminal);
    match found.pop() {
        Some(input) if found.is_empty() => Ok(input),
        _ => Err(CliError::new(format_args!(
            "{} contains several shaders; `{command}` takes one",
            path_name(argument)
        ))),
    }
}

/// Finds shaders as [`find`] does. A folder in a searched one whose only shaders are in texts and archives
/// has an error, so that no student is overlooked.
pub(super) fn find_submissions(arguments: &[PathBuf], terminal: &Terminal) -> Vec<Result<Input, ReadError>> {
    find_in(arguments, terminal, add_unread)
}

fn find_in(
    arguments: &[PathBuf],
    terminal: &Terminal,
    complete: fn(&Path, &mut Search),
) -> Vec<Result<Input, ReadError>> {
    let first = arguments.iter().position(|argument| argument == Path::new("-"));
    let mut inputs: Vec<_> = arguments
        .iter()
        .enumerate()
        .filter(|&(at, argument)| argument != Path::new("-") || Some(at) == first)
        .flat_map(|(_, argument)| {
            let mut search = files::find(argument);
            complete(argument, &mut search);
            for skipped in &search.skipped {
                terminal.warn(skipped);
            }
            if let [first, rest @ ..] = &search.unread[..] {
                let more = match rest.len() as u64 {
                    0 => String::new(),
                    more => format!(" and {} more {}", grouped(more), plural(more, "file", "files")),
                };
                terminal.warn(format_args!(
                    "skipped {}{more}: not a shader\nhelp: `toyproof collect` finds shaders in archives and texts",
                    path_name(first)
                ));
            }
            search.inputs
        })
        .map(|input| input.map_err(with_builtin_hint))
        .collect();
    files::drop_included(&mut inputs);
    keep_folders(&mut inputs);
    inputs
}

/// Adds an error for each folder in a searched one that has shaders in texts or archives, and no others.
fn add_unread(folder: &Path, search: &mut Search) {
    let path = |input: &Result<Input, ReadError>| match input {
        Ok(input) => input.path().map(Path::to_owned),
        Err(error) => Some(error.name().into()),
    };
    let mut folders = BTreeMap::new();
    for unread in &search.unread {
        let parts = unread
            .strip_prefix(folder)
            .map(|inside| inside.iter().collect::<Vec<_>>());
        if let Ok(parts @ [first, _, ..]) = parts.as_deref()
            && let student = folder.join(first)
            && !search
                .inputs
                .iter()
                .filter_map(path)
                .any(|path| path.starts_with(&student))
            && !folders.contains_key(&student)
            && files::has_shader(unread)
        {
            let inside: PathBuf = parts[1..].iter().collect();
            let instead = format!(" ({}: `toyproof collect` finds its shader)", path_name(&inside));
            folders.insert(student, instead);
        }
    }
    if folders.is_empty() {
        return;
    }
    search
        .inputs
        .retain(|input| !matches!(input, Err(ReadError::NoShader(_))));
    let missing = folders.into_iter();
    let missing = missing.map(|(student, instead)| Err(ReadError::NotSubmitted(student, instead)));
    search.inputs.extend(missing);
    search.inputs.sort_by_cached_key(path);
}

/// Makes the relative paths of inputs with equal ones start at their common folder, so that their outputs
/// keep their folders: `a/x.glsl` and `b/x.glsl`.
fn keep_folders(inputs: &mut [Result<Input, ReadError>]) {
    let mut equal: HashMap<PathBuf, Vec<&mut Input>> = HashMap::new();
    for input in inputs.iter_mut().flatten().filter(|input| input.path().is_some()) {
        equal.entry(input.relative.clone()).or_default().push(input);
    }
    for mut inputs in equal.into_values().filter(|inputs| inputs.len() > 1) {
        let folders = inputs.iter().filter_map(|input| input.path()?.parent());
        let folders: Vec<Vec<Component>> = folders.map(|folder| folder.components().collect()).collect();
        let common = |index: usize| {
            let mut parts = folders.iter().map(|folder| folder.get(index));
            let first = parts.next().flatten();
            first.is_some() && parts.all(|part| part == first)
        };
        let length = (0..folders[0].len()).take_while(|&index| common(index)).count();
        let relative = |input: &Input| -> Option<PathBuf> {
            let rest: Vec<_> = input.path()?.components().skip(length).collect();
            let is_inside = rest.iter().all(|part| matches!(part, Component::Normal(_)));
            is_inside.then(|| rest.iter().collect())
        };
        let paths: Vec<_> = inputs.iter().map(|input| relative(input)).collect();
        for (input, path) in inputs.iter_mut().zip(paths) {
            if let Some(path) = path {
                input.relative = path;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use toyproof_project::files::InputSource;

    use super::*;

    fn relative(paths: &[&str]) -> Vec<PathBuf> {
        let input = |path: &&str| {
            let path = PathBuf::from(path);
            let relative = PathBuf::from(path.file_name().unwrap());
            let source = InputSource::File(path);
            Ok(Input {
                source,
                relative,
                folder: None,
            })
        };
        let mut inputs: Vec<_> = paths.iter().map(input).collect();
        keep_folders(&mut inputs);
        inputs.into_iter().map(|input| input.unwrap().relative).collect()
    }

    #[test]
    fn equal_names_keep_their_folders() {
        let paths = relative(&["st/a/x.glsl", "st/b/x.glsl", "st/b/y.glsl"]);
        assert_eq!(paths, ["a/x.glsl", "b/x.glsl", "y.glsl"].map(PathBuf::from));
        assert_eq!(
            relative(&["x.glsl", "../x.glsl"]),
            ["x.glsl", "x.glsl"].map(PathBuf::from)
        );
        assert_eq!(
            relative(&["a/x.glsl", "a/x.glsl"]),
            ["x.glsl", "x.glsl"].map(PathBuf::from)
        );
    }
}
