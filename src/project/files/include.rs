//! Reads the files that shaders include.

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use toyproof_diagnostic::{Diagnostics, File, FileId, Files, path_name};
use toyproof_glsl::{self as glsl, Options};

use super::{Input, ReadError, read_text};

/// Where the files that a shader includes may lie.
#[derive(Debug, Clone)]
pub struct IncludeFolders {
    /// The folder of the shader or project.
    own: PathBuf,
    /// Further folders, in the order in which they are searched.
    others: Vec<PathBuf>,
    open_texts: OpenTexts,
}

/// The texts of files that are open in an editor, by canonical path.
pub type OpenTexts = Arc<BTreeMap<PathBuf, String>>;

/// A file that was included.
#[derive(Debug, Clone)]
pub struct IncludedFile {
    /// Its canonical path.
    pub path: PathBuf,
    /// Its text.
    pub file: FileId,
}

/// An included file.
struct Found {
    path: PathBuf,
    file: FileId,
}

impl IncludeFolders {
    /// The folder of an input, and others. That of a stream is the current one.
    #[must_use]
    pub fn of(input: &Input, others: &[PathBuf]) -> Self {
        let own = match input.path() {
            Some(path) if path.is_dir() => path,
            Some(path) => path.parent().unwrap_or(path),
            None => Path::new(""),
        };
        Self {
            own: or_current(own),
            others: others.to_vec(),
            open_texts: OpenTexts::default(),
        }
    }

    /// The same folders with texts in place of those of files, such as the unsaved ones of an editor, by
    /// canonical path.
    #[must_use]
    pub fn with_open_texts(self, open_texts: OpenTexts) -> Self {
        Self { open_texts, ..self }
    }

    /// Adds the text in which included files replace their directives, see [`glsl::with_includes`].
    ///
    /// # Errors
    /// A file cannot be read, lies outside the folders, or a limit is exceeded.
    pub fn include(&self, files: &mut Files, file: FileId, options: &Options) -> Result<FileId, Diagnostics> {
        self.include_files(files, file, options).0
    }

    /// Includes files as [`include`](Self::include) does, and also returns those that were read.
    pub fn include_files(
        &self,
        files: &mut Files,
        file: FileId,
        options: &Options,
    ) -> (Result<FileId, Diagnostics>, Vec<IncludedFile>) {
        let (complete, found) = self.read(files, file, options);
        let found = found.into_iter();
        let found = found.map(|(canonical, found)| IncludedFile {
            path: canonical,
            file: found.file,
        });
        (complete, found.collect())
    }

    /// The texts that a shader includes, directly or not, also where a condition skips the directive.
    #[must_use]
    pub fn texts(&self, file: &File) -> Vec<File> {
        let mut files = Files::default();
        let file = files.add(file.clone());
        // An error is one of the check, which reports it.
        let (_, found) = self.read(&mut files, file, &Options::default());
        found
            .values()
            .map(|found| files.get(found.file).clone())
            .collect()
    }

    /// Also returns the files, by their canonical paths.
    fn read(
        &self,
        files: &mut Files,
        file: FileId,
        options: &Options,
    ) -> (Result<FileId, Diagnostics>, BTreeMap<PathBuf, Found>) {
        let mut found: BTreeMap<PathBuf, Found> = BTreeMap::new();
        let joined = glsl::with_includes(files, file, options, &mut |files, from, path| {
            let including = found.values().find(|found| found.file == from);
            let folder = including
                .and_then(|found| found.path.parent())
                .unwrap_or(&self.own);
            let shown = path_name(Path::new(path));
            let path = self.resolve(folder, path)?;
            let canonical = path.canonicalize().map_err(|error| error.to_string())?;
            if let Some(found) = found.get(&canonical) {
                return Ok(found.file);
            }
            let text = match self.open_texts.get(&canonical) {
                Some(text) => File::new(path_name(&path), text),
                None => read_text(&path).map_err(|error| error.to_string())?,
            };
            // Submissions often lie in one folder, and a solution beside them.
            if has_entry_point(text.text()) && !is_in_one_of(&self.others, &canonical) {
                let way_out = "name its folder with --include-dir to include it";
                return Err(format!("{shown} is a shader on its own: {way_out}"));
            }
            let file = files.add(text);
            found.insert(canonical, Found { path, file });
            Ok(file)
        });
        (joined, found)
    }

    /// The path of an included file: relative to the file that includes it, else to one of the folders.
    fn resolve(&self, including: &Path, path: &str) -> Result<PathBuf, String> {
        let folders = || [&self.own].into_iter().chain(&self.others);
        let bases = [including].into_iter().chain(folders().map(PathBuf::as_path));
        let mut candidates = bases.map(|base| base.join(path));
        let shown = path_name(Path::new(path));
        let Some(found) = candidates.find(|candidate| candidate.is_file()) else {
            let mut names: Vec<String> = folders().map(|folder| path_name(folder)).collect();
            names.dedup();
            let names = names.join(", ");
            let sought = if path.starts_with("lygia/") {
                "the folder in which `lygia` lies"
            } else {
                "its folder"
            };
            return Err(format!(
                "there is no {shown} in {names}: name {sought} with --include-dir"
            ));
        };
        let canonical = found.canonicalize().map_err(|error| error.to_string())?;
        if is_in_one_of(folders(), &canonical) {
            Ok(found)
        } else {
            let message = "is outside of the shader's folder: allow its folder with --include-dir";
            Err(format!("{shown} {message}"))
        }
    }
}

/// Removes the files of searched folders that others include and that are no shaders by themselves.
pub fn drop_included(inputs: &mut Vec<Result<Input, ReadError>>) {
    let mut included: HashSet<PathBuf> = HashSet::new();
    for input in inputs.iter().flatten().filter(|input| input.folder.is_some()) {
        let Some(Ok(text)) = input.path().filter(|path| path.is_file()).map(read_text) else {
            continue;
        };
        if !text.text().contains("include") {
            continue;
        }
        let mut files = Files::default();
        let file = files.add(text);
        let (_, found) = IncludeFolders::of(input, &[]).read(&mut files, file, &Options::default());
        let parts = found
            .into_iter()
            .filter(|(_, found)| !has_entry_point(files.get(found.file).text()));
        included.extend(parts.map(|(path, _)| path));
    }
    if included.is_empty() {
        return;
    }
    inputs.retain(|input| match input {
        Ok(input) if input.folder.is_some() => {
            let canonical = input.path().and_then(|path| path.canonicalize().ok());
            canonical.is_none_or(|path| !included.contains(&path))
        }
        _ => true,
    });
}

/// Whether a canonical path lies in one of these folders.
fn is_in_one_of<'f>(folders: impl IntoIterator<Item = &'f PathBuf>, path: &Path) -> bool {
    let mut folders = folders
        .into_iter()
        .filter_map(|folder| folder.canonicalize().ok());
    folders.any(|folder| path.starts_with(folder))
}

/// Whether a text has a word that a host calls: `mainImage`, or `main(`.
fn has_entry_point(text: &str) -> bool {
    let is_in_name = |character: char| character.is_alphanumeric() || character == '_';
    text.match_indices("main").any(|(at, word)| {
        let (before, after) = (&text[..at], &text[at + word.len()..]);
        !before.ends_with(is_in_name) && (after.starts_with("Image") || after.trim_start().starts_with('('))
    })
}

/// A folder with a name.
fn or_current(folder: &Path) -> PathBuf {
    if folder.as_os_str().is_empty() {
        PathBuf::from(".")
    } else {
        folder.to_owned()
    }
}
