//! Text layout for terminals: display width, wrapping and aligned columns.

use textwrap::{Options, WordSeparator, WordSplitter, core};

/// The number of terminal columns of a text of one line; ANSI sequences have no width.
pub fn display_width(text: &str) -> usize {
    core::display_width(text)
}

/// The narrowest room for wrapped text, in columns: below it, lines are longer than the terminal's.
const MIN_WRAPPED: usize = 20;

/// Writes a text after a prefix, and wraps it at `width` columns, if any; further lines are indented by
/// `indent` columns.
pub fn wrap(prefix: &str, indent: usize, text: &str, width: Option<usize>) -> String {
    let Some(width) = width else {
        return format!("{prefix}{text}").trim_end().to_owned();
    };
    let spaces = " ".repeat(indent);
    let options = Options::new(width.max(indent + MIN_WRAPPED))
        .initial_indent(prefix)
        .subsequent_indent(&spaces)
        .word_separator(WordSeparator::AsciiSpace)
        .word_splitter(WordSplitter::NoHyphenation)
        .break_words(false);
    textwrap::fill(text, options).trim_end().to_owned()
}

/// Aligns the cells of a table; the columns of the indices `right` are aligned to the right. Each line starts
/// with `indent` and does not end with spaces.
pub fn columns(indent: &str, rows: &[Vec<String>], right: &[usize]) -> Vec<String> {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| display_width(cell)).max().unwrap_or(0)
    };
    let widths: Vec<_> = (0..count).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().enumerate().map(|(column, cell)| {
            let spaces = " ".repeat(widths[column] - display_width(cell));
            if right.contains(&column) {
                spaces + cell
            } else {
                format!("{cell}{spaces}")
            }
        });
        let line = cells.collect::<Vec<_>>().join("  ");
        format!("{indent}{line}").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_wraps_with_a_hanging_indent() {
        let text = wrap("error: ", 7, "the quick brown fox jumps over it", Some(27));
        assert_eq!(text, "error: the quick brown fox\n       jumps over it");
        assert_eq!(
            wrap("error: ", 7, "the quick brown", None),
            "error: the quick brown"
        );
        let colored = wrap("\u{1b}[31mno\u{1b}[0m  ", 4, "aaaa bbbb cccc dddd eeee", Some(25));
        assert_eq!(colored, "\u{1b}[31mno\u{1b}[0m  aaaa bbbb cccc dddd\n    eeee");
    }

    #[test]
    fn commands_are_not_broken_at_hyphens() {
        let wrapped = wrap("", 0, "toyproof debug a.glsl --pixel 1,2 --size 160x90", Some(34));
        assert_eq!(wrapped, "toyproof debug a.glsl --pixel 1,2\n--size 160x90");
    }

    #[test]
    fn cells_are_aligned() {
        let rows = [
            vec!["a".to_owned(), "1,000".to_owned()],
            vec!["ä→b".to_owned(), "2".to_owned()],
        ];
        assert_eq!(columns("", &rows, &[1]), ["a    1,000", "ä→b      2"]);
    }
}
