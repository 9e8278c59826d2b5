//! The profile of a shader, by line: as a table for spreadsheets, and as a page.

use toyproof_diagnostic::{FileId, Files, spreadsheet_text};
use toyproof_verify::profile::ShaderProfile;

use super::csv::table;

/// The profile of a pass.
#[derive(Debug, Clone)]
pub struct ProfiledPass<'a> {
    /// The name; none for the only pass.
    pub name: Option<&'a str>,
    /// The profile.
    pub profile: &'a ShaderProfile,
    /// The files that its source consists of.
    pub sources: Vec<FileId>,
}

const COLUMNS: [&str; 8] = [
    "pass",
    "file",
    "line",
    "operations",
    "share",
    "operations_per_pixel",
    "executions_per_pixel",
    "source",
];

/// Formats the lines of passes as CSV, the most expensive ones of each pass first. `share` is that of all
/// operations of the pass, from 0 to 1; the executions are empty where no statement begins in the line.
#[must_use]
pub fn profile_csv(passes: &[ProfiledPass<'_>], files: &Files) -> String {
    let mut bytes = Vec::new();
    let mut csv = table(&mut bytes);
    // A table in memory takes all rows.
    let _ = csv.write_record(COLUMNS);
    for pass in passes {
        let profile = pass.profile;
        for line in &profile.lines {
            let file = files.get(line.file);
            let text = &file.text()[file.line_range(line.line - 1).unwrap_or_default()];
            let executions = line.executions.map(|count| profile.per_pixel(count).to_string());
            let _ = csv.write_record([
                spreadsheet_text(pass.name.unwrap_or_default()),
                spreadsheet_text(file.name()),
                line.line.to_string(),
                line.operations.to_string(),
                (line.operations as f64 / profile.operations.max(1) as f64).to_string(),
                profile.per_pixel(line.operations).to_string(),
                executions.unwrap_or_default(),
                spreadsheet_text(text.trim_end()),
            ]);
        }
    }
    drop(csv);
    String::from_utf8_lossy(&bytes).into_owned()
}
