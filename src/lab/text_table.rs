//! Tables of text with aligned columns.

/// The alignment of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Align {
    Left,
    Right,
}

/// Lines with the cells of each row in columns, indented by two spaces, without trailing spaces.
pub(crate) fn lines(columns: &[Align], rows: &[Vec<String>]) -> Vec<String> {
    let aligned = columns.iter().enumerate();
    let right: Vec<usize> = aligned
        .filter(|(_, align)| **align == Align::Right)
        .map(|(column, _)| column)
        .collect();
    let lines = toyproof_diagnostic::columns(rows, &right).into_iter();
    lines
        .map(|line| format!("  {line}").trim_end().to_owned())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_by_characters() {
        let rows = [["δ", "1"], ["abc", "20"]].map(|row| row.map(str::to_owned).to_vec());
        let lines = lines(&[Align::Left, Align::Right], &rows);
        assert_eq!(lines, ["  δ     1", "  abc  20"]);
    }
}
