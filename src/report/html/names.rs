//! The short names of shaders, without their common folder.

use std::path::is_separator;

use crate::Record;

/// The folder that all shaders are in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Names<'a> {
    /// With its final separator; empty if there is none.
    prefix: &'a str,
}

impl<'a> Names<'a> {
    /// The names of all shaders of a report.
    pub(super) fn new(records: &'a [Record]) -> Self {
        let mut names = records.iter().map(|record| record.shader.as_str());
        let first = names.next().map_or("", parent);
        Self {
            prefix: names.fold(first, common_folder),
        }
    }

    /// The path of the folder; empty if there is none.
    pub(super) fn folder(&self) -> &'a str {
        self.prefix.trim_end_matches(is_separator)
    }

    /// The last part of the folder's path; empty if there is none.
    pub(super) fn folder_name(&self) -> &'a str {
        let folder = self.folder();
        &folder[parent(folder).len()..]
    }

    /// The name of a shader within the folder.
    pub(super) fn short<'r>(&self, record: &'r Record) -> &'r str {
        record.shader.strip_prefix(self.prefix).unwrap_or(&record.shader)
    }
}

/// A path up to its last separator, with it.
fn parent(path: &str) -> &str {
    let end = path.rfind(is_separator).map_or(0, |at| at + 1);
    &path[..end]
}

/// The folder that is common to a folder and a path, with its final separator.
fn common_folder<'a>(folder: &'a str, path: &str) -> &'a str {
    let mut common = folder;
    while !path.starts_with(common) {
        common = parent(common.trim_end_matches(is_separator));
    }
    common
}

#[cfg(test)]
mod tests {
    use super::*;

    fn records(names: &[&str]) -> Vec<Record> {
        names
            .iter()
            .map(|&name| Record::unchecked(name.to_owned()))
            .collect()
    }

    #[test]
    fn the_common_folder_is_removed() {
        for (names, folder, name, short) in [
            (&["hw/a/x.glsl", "hw/ab/x.glsl"][..], "hw", "hw", "a/x.glsl"),
            (
                &["/home/t/hw/a.glsl", "/home/t/hw/b.glsl"],
                "/home/t/hw",
                "hw",
                "a.glsl",
            ),
            (&["hw/a.glsl", "hx/a.glsl"], "", "", "hw/a.glsl"),
            (&["/a.glsl", "/b/c.glsl"], "", "", "a.glsl"),
            (&["hw/a.glsl"], "hw", "hw", "a.glsl"),
            (&["a.glsl", "-"], "", "", "a.glsl"),
            (&[""], "", "", ""),
        ] {
            let records = records(names);
            let found = Names::new(&records);
            assert_eq!(
                (found.folder(), found.folder_name(), found.short(&records[0])),
                (folder, name, short),
                "{names:?}"
            );
        }
        assert_eq!(Names::new(&[]).folder(), "");
    }
}
