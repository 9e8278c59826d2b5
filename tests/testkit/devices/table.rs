//! The table of measurements: a row for each, a column for each device.

use std::fmt::Write;

/// The first columns of a row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// The section, which begins with the first of its rows.
    pub section: &'static str,
    /// What is measured.
    pub label: String,
    /// What is required.
    pub requirement: String,
}

/// The results on a device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// The device.
    pub title: String,
    /// A result for each row, or why it was not measured.
    pub cells: Vec<Result<String, String>>,
}

/// Writes the table in Markdown.
///
/// # Panics
/// If a column has fewer cells than there are rows.
pub fn markdown(rows: &[Row], columns: &[Column]) -> String {
    let mut text = String::from("| measurement | required |");
    for column in columns {
        let _ = write!(text, " {} |", escaped(&column.title));
    }
    text.push_str("\n|---|---|");
    text.push_str(&"---|".repeat(columns.len()));
    text.push('\n');
    let mut section = "";
    for (index, row) in rows.iter().enumerate() {
        if row.section != section {
            section = row.section;
            let _ = writeln!(text, "| **{section}** | |{}", " |".repeat(columns.len()));
        }
        let _ = write!(
            text,
            "| {} | {} |",
            escaped(&row.label),
            escaped(&row.requirement)
        );
        for column in columns {
            let cell = match &column.cells[index] {
                Ok(result) => escaped(result),
                Err(why) => format!("not measured: {}", escaped(why)),
            };
            let _ = write!(text, " {cell} |");
        }
        text.push('\n');
    }
    text
}

/// A text in one cell.
fn escaped(text: &str) -> String {
    text.replace('|', "\\|").replace(['\n', '\r'], " ")
}
