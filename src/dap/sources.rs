//! The source files of a shader as a client sees them, and the lines at which the execution can stop.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use toyproof_diagnostic::{FileId, Files, Span};
use toyproof_glsl::tree::Tree;

use crate::code::visit_function;
use crate::protocol::reply;
use crate::recording::Line;

/// The source files that have code.
#[derive(Debug, Default)]
pub(crate) struct Sources {
    files: Vec<SourceFile>,
}

#[derive(Debug)]
struct SourceFile {
    id: FileId,
    name: String,
    /// The absolute path; `None` if there is no such file, as for a tab in JSON.
    path: Option<PathBuf>,
    /// The path without links.
    canonical: Option<PathBuf>,
    /// The lines with code, in order, each with the column of the first place.
    lines: BTreeMap<usize, usize>,
}

impl Sources {
    /// Finds the files and the lines at which the execution of a shader can stop.
    pub(crate) fn new(files: &Files, tree: &Tree) -> Self {
        let mut sources = Self::default();
        for function in tree.functions.ids() {
            sources.file(files, tree[function].at.span);
            visit_function(tree, function, &mut |place| {
                let at = files.position(place.at.span);
                let file = sources.file(files, place.at.span);
                let column = file.lines.entry(at.line).or_insert(at.column);
                *column = at.column.min(*column);
                ControlFlow::Continue(())
            });
        }
        sources
    }

    /// The file of a span.
    fn file(&mut self, files: &Files, span: Span) -> &mut SourceFile {
        let id = files.origin(span).file;
        let known = self.files.iter().position(|file| file.id == id);
        let index = known.unwrap_or_else(|| {
            let name = files.get(id).name().to_owned();
            self.files.push(SourceFile {
                id,
                canonical: canonical(Path::new(&name)),
                path: std::path::absolute(&name).ok().filter(|path| path.is_file()),
                name,
                lines: BTreeMap::new(),
            });
            self.files.len() - 1
        });
        &mut self.files[index]
    }

    /// The file that a client names by its path, or by its number for one without.
    pub(crate) fn find(&self, source: &reply::Source) -> Option<FileId> {
        if let Some(number) = source.reference.filter(|&number| number > 0) {
            return self.by_number(number);
        }
        let path = source.path.as_deref()?;
        let given = canonical(Path::new(path));
        let is_same = |file: &&SourceFile| match (&file.canonical, &given) {
            (Some(own), Some(given)) => own == given,
            _ => file.name == path,
        };
        self.files.iter().find(is_same).map(|file| file.id)
    }

    /// The file with a number.
    pub(crate) fn by_number(&self, number: i64) -> Option<FileId> {
        let index = usize::try_from(number).ok()?.checked_sub(1)?;
        self.files.get(index).map(|file| file.id)
    }

    /// A file as the protocol describes it.
    pub(crate) fn source(&self, id: FileId) -> Option<reply::Source> {
        let index = self.files.iter().position(|file| file.id == id)?;
        Some(self.described(index))
    }

    fn described(&self, index: usize) -> reply::Source {
        let file = &self.files[index];
        let name = Path::new(&file.name).file_name();
        reply::Source {
            name: Some(name.map_or_else(|| file.name.clone(), |name| name.to_string_lossy().into_owned())),
            path: Some(match &file.path {
                Some(path) => path.to_string_lossy().into_owned(),
                None => file.name.clone(),
            }),
            reference: file.path.is_none().then_some(index as i64 + 1),
        }
    }

    /// All files.
    pub(crate) fn all(&self) -> Vec<reply::Source> {
        (0..self.files.len()).map(|index| self.described(index)).collect()
    }

    /// The first line with code at or after a line.
    pub(crate) fn line_with_code(&self, at: Line) -> Option<Line> {
        let file = self.files.iter().find(|file| file.id == at.file)?;
        let (&line, _) = file.lines.range(at.line..).next()?;
        Some(Line { file: at.file, line })
    }

    /// The lines with code from one line to another, each with a column.
    pub(crate) fn lines(&self, file: FileId, first: usize, last: usize) -> Vec<(usize, usize)> {
        let file = self.files.iter().find(|other| other.id == file);
        let lines = file.filter(|_| first <= last).into_iter();
        let lines = lines.flat_map(|file| file.lines.range(first..=last));
        lines.map(|(&line, &column)| (line, column)).collect()
    }
}

/// The absolute path of an existing file, without links.
fn canonical(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok().filter(|path| path.is_file())
}

/// The lines and columns of a span, from 1; columns in UTF-16 code units, as clients count them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Extent {
    pub(crate) line: usize,
    pub(crate) column: usize,
    pub(crate) end_line: usize,
    pub(crate) end_column: usize,
}

impl Extent {
    /// The extent of a span in the file of the user.
    pub(crate) fn of(files: &Files, span: Span) -> Self {
        let span = files.origin(span);
        let text = files.get(span.file).text();
        let column = |byte: u32| {
            let before = &text[..byte as usize];
            let start = before.rfind(['\n', '\r']).map_or(0, |at| at + 1);
            before[start..].encode_utf16().count() + 1
        };
        Self {
            line: files.position(span).line,
            column: column(span.start),
            end_line: files.end_position(span).line,
            end_column: column(span.end),
        }
    }
}
