//! What is reduced: a shader, a pass of a project that shows the fault alone, or all passes.

use toyproof_diagnostic::{Deadline, Files, Severity};
use toyproof_glsl as glsl;
use toyproof_project::files::{self, IncludeFolders, Input, ProjectTexts, Texts};
use toyproof_project::{CompiledProject, PassKind, Project};
use toyproof_reduce::Part;
use toyproof_reduce::fault::{Fault, Finding, NotFound, ProjectParts, Session, Subject, Wanted, find};

use super::super::CliError;
use super::super::shader::Shader;
use super::{Args, is_reduced};

/// What may be reduced of an input.
pub(super) struct Original {
    /// The passes of a project that can be tested alone, or the shader.
    single: Vec<Attempt>,
    /// The project, if it compiles.
    project: Option<Attempt>,
    /// Whether the input is a project.
    pub(super) is_project: bool,
}

/// What shows the fault.
pub(super) struct Attempt {
    /// The pass of a project that shows it alone.
    pub(super) pass: Option<PassKind>,
    /// The texts.
    pub(super) parts: Vec<Part>,
    /// The project whose parts they are.
    pub(super) project: Option<ProjectParts>,
    language: glsl::Options,
}

impl Attempt {
    fn of_text(pass: Option<PassKind>, text: String, language: &glsl::Options) -> Self {
        let part = Part {
            text,
            language: language.clone(),
            is_required: true,
        };
        Self {
            pass,
            parts: vec![part],
            project: None,
            language: language.clone(),
        }
    }

    /// The texts of all parts.
    pub(super) fn texts(&self) -> Vec<Option<String>> {
        self.parts.iter().map(|part| Some(part.text.clone())).collect()
    }

    /// Makes it what is tested.
    fn choose(&self, subject: &mut Subject) {
        subject.language = self.language.clone();
        subject.project.clone_from(&self.project);
    }

    fn find(
        &self,
        subject: &mut Subject,
        sizes: &[[u32; 2]],
        wanted: &Wanted,
    ) -> Result<(&Self, Finding), NotFound> {
        self.choose(subject);
        Ok((self, find(subject, sizes, wanted, &self.texts())?))
    }
}

impl Original {
    /// Reads the texts to reduce, with includes and Common, and how they are checked.
    pub(super) fn read(args: &Args, input: &Input) -> Result<Self, CliError> {
        let found = Ok(input.clone());
        let shader = Shader::load(&found, &args.language, Deadline::after(args.driver.timeout()));
        let unreadable =
            |error: files::ReadError| CliError::new(format_args!("{}: {}", error.name(), error.reason()));
        let is_folder = input.path().is_some_and(std::path::Path::is_dir);
        let texts = files::read(input).map_err(unreadable)?;
        match (texts, shader.image(), shader.unrendered()) {
            (Texts::Project(texts), _, Some(_)) => Self::of_project(args, input, texts, shader.project()),
            (Texts::Project(texts), Ok(_), None) if is_folder && is_reduced(input) => {
                Self::of_project(args, input, texts, shader.project())
            }
            (Texts::Project(texts), Err(_), None) => Self::of_project(args, input, texts, None),
            (Texts::Shader(_), _, Some(reason)) => {
                let error = CliError::new(format_args!("{}: {reason}", shader.name));
                Err(error.with_help("reduce the text of the pass at fault alone"))
            }
            (_, Ok(checked), None) => {
                let options = glsl::Options {
                    lenient: checked.lenient,
                    ..checked.options()
                };
                let text = shader.text(checked).to_owned();
                Ok(Self::of_shader(text, &options))
            }
            (Texts::Shader(file), Err(_), None) => {
                let options = args.language.options(Deadline::default());
                Ok(Self::of_shader(file.text().to_owned(), &options))
            }
        }
    }

    fn of_shader(text: String, language: &glsl::Options) -> Self {
        Self {
            single: vec![Attempt::of_text(None, text, language)],
            project: None,
            is_project: false,
        }
    }

    /// The passes of a project, of which `compiled` has the trees.
    fn of_project(
        args: &Args,
        input: &Input,
        texts: ProjectTexts,
        compiled: Option<&CompiledProject>,
    ) -> Result<Self, CliError> {
        let language = args.language.options(Deadline::default());
        let mut files = Files::default();
        let parsed = texts.parse(&mut files);
        let parsed = parsed.map_err(|errors| CliError::diagnostics(errors, &files))?;
        let includes = IncludeFolders::of(input, args.language.include_folders());
        let mut single = Vec::new();
        let passes = parsed.passes.iter().enumerate();
        for (number, pass) in passes {
            let tabs: Vec<_> = parsed.common.into_iter().chain([pass.file]).collect();
            let joined = files.join(pass.kind.to_string(), &tabs);
            let included = includes.include(&mut files, joined, &language);
            let file = included.map_err(|errors| CliError::diagnostics(errors, &files))?;
            let language =
                compiled.map_or_else(|| language.clone(), |compiled| compiled.checked[number].options());
            single.push(Attempt::of_text(
                Some(pass.kind),
                files.get(file).text().to_owned(),
                &language,
            ));
        }
        let project = compiled.map(|compiled| Attempt::of_project(&compiled.project, &single, language));
        single.retain(|attempt| !matches!(attempt.pass, Some(PassKind::Sound | PassKind::CubeA)));
        Ok(Self {
            single,
            project,
            is_project: true,
        })
    }

    /// Finds a fault, of a pass alone if one shows it. The subject then has what shows it.
    pub(super) fn find(
        &self,
        subject: &mut Subject,
        sizes: &[[u32; 2]],
        wanted: &Wanted,
    ) -> Result<(&Attempt, Finding), NotFound> {
        let is_of_all = match wanted {
            Wanted::Command(_) | Wanted::Verdict(_) => true,
            // A pass alone may have warnings about what it reads.
            Wanted::Diagnostic(code) => code.severity() != Severity::Error,
            Wanted::Any | Wanted::Naga | Wanted::Driver | Wanted::Toolchain => false,
        };
        let mut last = None;
        if !is_of_all || !self.is_project {
            for attempt in &self.single {
                match attempt.find(subject, sizes, wanted) {
                    Err(error @ NotFound::Absent(_)) => last = Some(error),
                    Ok((_, found)) if self.is_project && is_warning(&found) => {}
                    result => return result,
                }
            }
        }
        let Some(project) = &self.project else {
            let none = || NotFound::Untested("the project does not compile".to_owned());
            return Err(last.unwrap_or_else(none));
        };
        let (project, found) = project.find(subject, sizes, wanted)?;
        if is_warning(&found) {
            for attempt in &self.single {
                attempt.choose(subject);
                if Session::new(subject).shows(&found.fault, &attempt.texts()) {
                    return Ok((attempt, found));
                }
            }
            project.choose(subject);
        }
        Ok((project, found))
    }
}

impl Attempt {
    /// The project with the texts of its passes.
    fn of_project(project: &Project, passes: &[Self], language: glsl::Options) -> Self {
        let (parts_of, parts) = ProjectParts::new(project, |kind| {
            let attempt = passes.iter().find(|attempt| attempt.pass == Some(kind));
            attempt.map_or_else(Default::default, |attempt| {
                (attempt.parts[0].text.clone(), attempt.language.clone())
            })
        });
        Self {
            pass: None,
            parts,
            project: Some(parts_of),
            language,
        }
    }
}

fn is_warning(found: &Finding) -> bool {
    matches!(found.fault, Fault::Diagnostic { code, .. } if code.severity() != Severity::Error)
}
