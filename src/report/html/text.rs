//! Anything as text in HTML: in an element, or between double quotes. Characters that act on the text around them are escaped.

use std::fmt::{self, Display, Formatter, Write};

use toyproof_diagnostic::printable;

/// Shows a value with what means something in HTML spelt out.
pub(super) struct Text<T>(pub(super) T);

impl<T: Display> Display for Text<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(Escaping(f), "{}", self.0)
    }
}

struct Escaping<'a, 'b>(&'a mut Formatter<'b>);

impl Write for Escaping<'_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for character in text.chars() {
            match character {
                '&' => self.0.write_str("&amp;")?,
                '<' => self.0.write_str("&lt;")?,
                '>' => self.0.write_str("&gt;")?,
                '"' => self.0.write_str("&quot;")?,
                '\'' => self.0.write_str("&#39;")?,
                '\n' | '\t' => self.0.write_char(character)?,
                other => self.0.write_str(&printable(other.encode_utf8(&mut [0; 4])))?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_means_something_in_html_is_spelt_out() {
        assert_eq!(
            Text("<a b=\"c\" d='e'>&\0\u{202e}\né").to_string(),
            "&lt;a b=&quot;c&quot; d=&#39;e&#39;&gt;&amp;\\u{0}\\u{202e}\né"
        );
        assert_eq!(Text(1.5).to_string(), "1.5");
    }
}
