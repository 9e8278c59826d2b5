//! The constants that macros become.

use std::collections::BTreeMap;

use toyproof_glsl::tree::Place;

use super::Comments;

/// The declarations of constants for macros that expand to a literal, by name.
#[derive(Default)]
pub(crate) struct MacroConstants(BTreeMap<String, (Place, String)>);

impl MacroConstants {
    /// Declares a constant for the macro of a literal; returns whether the name now means this declaration: a
    /// macro may be redefined, and its first definition keeps the name.
    pub(crate) fn declare(&mut self, name: &str, declaration: String, literal: Place) -> bool {
        if let Some((_, known)) = self.0.get(name) {
            return *known == declaration;
        }
        self.0.insert(name.to_owned(), (literal, declaration));
        true
    }

    pub(crate) fn contains(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// The lines of the declarations, in the author's order and with the author's comments.
    pub(crate) fn declarations(&self, comments: &mut Comments<'_>) -> String {
        let mut constants: Vec<&(Place, String)> = self.0.values().collect();
        constants.sort_by_key(|(literal, _)| (literal.spelling.file, literal.spelling.start));
        let mut text = String::new();
        for (literal, declaration) in constants {
            let [above, behind] = comments.of_constant(*literal);
            for line in above {
                text += &line;
                text.push('\n');
            }
            text += declaration;
            for comment in behind {
                text.push(' ');
                text += &comment;
            }
            text.push('\n');
        }
        text
    }
}
