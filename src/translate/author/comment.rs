//! The author's comments and blank lines: what is written before a declaration or a statement, behind it, and
//! at the end of its block.

use std::collections::{BTreeMap, BTreeSet};

use toyproof_diagnostic::{FileId, Files};
use toyproof_glsl::tree::{ExprId, ExprKind, Item, Place, Tree, walk};

use super::SourceText;
use super::comment_text::trim_blank_lines;
use super::source_layout::{Fate, SourceLayout};

/// Finds the author's comments and tracks which are written.
pub(crate) struct Comments<'a> {
    files: BTreeMap<FileId, SourceLayout<'a>>,
    /// The declaration that is being written, and the place in it.
    cursor: Cursor,
}

/// How much of a declaration is written.
struct Cursor {
    file: Option<FileId>,
    declaration: usize,
    /// The comment to write next.
    comment: usize,
    /// Where its first token begins.
    begin: usize,
    /// Where its last token begins.
    end: usize,
    /// The last token whose blank line above is written.
    spaced: Option<usize>,
    /// The brace that closes the block that is being written.
    closing: usize,
}

/// The brace that closes a block that is left for one inside.
#[derive(Clone, Copy)]
pub(crate) struct OuterBlock(usize);

/// The places of a tree in each file, sorted: what is not among them was not compiled.
fn compiled_places(tree: &Tree) -> BTreeMap<FileId, Vec<usize>> {
    let mut places: BTreeMap<FileId, Vec<usize>> = BTreeMap::new();
    let mut add = |at: Place| {
        let start = at.span.start as usize;
        places.entry(at.span.file).or_default().push(start);
    };
    tree.exprs.iter().for_each(|(_, expr)| add(expr.at));
    tree.structs.iter().for_each(|(_, structure)| add(structure.at));
    tree.variables
        .iter()
        .filter_map(|(_, variable)| variable.at)
        .for_each(&mut add);
    for (_, function) in tree.functions.iter() {
        add(function.at);
        if let Some(body) = &function.body {
            walk::each(body, &mut |statement| add(statement.at));
        }
    }
    for places in places.values_mut() {
        places.sort_unstable();
    }
    places
}

/// The expressions of an item.
fn expressions(tree: &Tree, item: Item) -> Vec<ExprId> {
    let roots = match item {
        Item::Variable(id) => tree[id].initializer.into_iter().collect(),
        Item::Function(id) => tree[id]
            .body
            .as_ref()
            .map_or_else(Vec::new, |body| walk::roots(tree, body)),
        Item::Struct(_) | Item::Prototype(_) => Vec::new(),
    };
    roots.into_iter().flat_map(|root| tree.postorder(root)).collect()
}

/// The place of an item's name.
fn place_of(tree: &Tree, item: Item) -> Option<Place> {
    match item {
        Item::Variable(id) => tree[id].at,
        Item::Function(id) => Some(tree[id].at),
        Item::Struct(id) => Some(tree[id].at),
        Item::Prototype(_) => None,
    }
}

impl<'a> Comments<'a> {
    /// Reads the comments of the files that `items` are in; those of other items are not written.
    pub(crate) fn new(files: &'a Files, tree: &Tree, items: &[Item]) -> Self {
        let mut written: BTreeMap<FileId, Vec<usize>> = BTreeMap::new();
        for at in items.iter().filter_map(|&item| place_of(tree, item)) {
            written
                .entry(at.span.file)
                .or_default()
                .push(at.span.start as usize);
        }
        let compiled = compiled_places(tree);
        let layouts = written.iter().map(|(&file, _)| {
            let compiled = compiled.get(&file).map_or(&[][..], Vec::as_slice);
            (file, SourceLayout::new(files, file, compiled))
        });
        let mut comments = Self {
            files: layouts.collect(),
            cursor: Cursor::outside(),
        };
        let source = SourceText::new(files);
        let expressions = items.iter().flat_map(|&item| expressions(tree, item));
        let literals = expressions.filter(|&id| matches!(tree[id].kind, ExprKind::Literal(_)));
        let constants = literals
            .map(|id| tree[id].at)
            .filter(|&at| source.macro_name(at).is_some());
        let constants: BTreeSet<_> = constants
            .map(|at| (at.spelling.file, at.spelling.start as usize))
            .collect();
        for (file, start) in constants {
            if let Some(layout) = comments.files.get_mut(&file) {
                layout.mark_macro(start);
            }
        }
        for (file, places) in written {
            if let Some(layout) = comments.files.get_mut(&file) {
                let (macros, mut places): (Vec<_>, Vec<_>) = places
                    .into_iter()
                    .partition(|&place| layout.is_in_directive(place));
                let (inside, outside) = layout.declare_macros(macros);
                for place in inside {
                    layout.mark_macro(place);
                }
                places.extend(outside);
                layout.leave_out_others(&places);
            }
        }
        comments
    }

    /// Returns the comments that the file of a place begins with, up to those of its first declaration.
    pub(crate) fn first(&mut self, at: Place) -> Vec<String> {
        let Some(layout) = self.files.get_mut(&at.span.file) else {
            return Vec::new();
        };
        let all = layout.comments_before(0);
        let mut runs = layout.comments[all.clone()].iter();
        let first_run = runs
            .position(|comment| comment.before_blank_line)
            .map_or(all.end, |last| last + 1);
        let of_file = match layout.declarations.first() {
            Some([0, _]) => layout.adjacent_comments(0).start,
            // A directive.
            _ => all.end,
        };
        let mut lines = Vec::new();
        for index in all {
            if index < first_run || index < of_file && layout.comments[index].fate == Fate::Pending {
                layout.write(index, &mut lines);
            }
        }
        trim_blank_lines(&mut lines);
        lines
    }

    /// Returns the comments and blank lines, which are empty, before an item and in its head, and begins to
    /// write it.
    pub(crate) fn before_item(&mut self, name: Place) -> Vec<String> {
        let Some(layout) = self.files.get(&name.span.file) else {
            self.cursor = Cursor::outside();
            return Vec::new();
        };
        let start = name.span.start as usize;
        let token = layout.index_at(start);
        let declaration = layout.declarations.partition_point(|&[_, last]| last < token);
        let own = layout.declarations.get(declaration);
        let is_in_directive = layout.is_in_directive(start);
        if is_in_directive && own.is_none_or(|&[first, _]| !layout.tokens[first].is_in_directive) {
            // A function that was a macro inside of another declaration.
            self.cursor = Cursor::outside();
            return self.of_macro(name.span.file, start, false);
        }
        if (self.cursor.file, self.cursor.declaration) != (Some(name.span.file), declaration) {
            self.cursor = Cursor::new(layout, name.span.file, declaration);
        }
        let after_name = token + 1;
        let after_list = match layout.token(after_name) {
            "(" => layout.partners[after_name] + 1,
            _ => after_name,
        };
        let end = match layout.token(after_list) {
            _ if is_in_directive => token,
            "{" => {
                self.cursor.closing = layout.partners[after_list];
                after_list
            }
            _ => layout.declarator_end(after_name),
        };
        let first = layout
            .declarations
            .get(declaration)
            .map_or(token, |&[first, _]| first);
        self.take(first, end)
    }

    /// Returns the comments up to the end of the item that is being written.
    pub(crate) fn at_end_of_item(&mut self) -> Vec<String> {
        let mut lines = self.take_until(self.cursor.end);
        trim_blank_lines(&mut lines);
        lines
    }

    /// Returns the comment behind the `}` that ends an item.
    pub(crate) fn behind_item(&mut self) -> Option<String> {
        let layout = self.files.get_mut(&self.cursor.file?)?;
        let last = layout.declarations.get(self.cursor.declaration)?[1];
        layout.write_behind(last)
    }

    /// Returns the comments and blank lines before a statement and in it, or in the head of a compound
    /// statement; `name` is the place of the variable that it declares.
    pub(crate) fn before(&mut self, at: Place, name: Option<Place>) -> Vec<String> {
        match self.current(at) {
            Some(layout) => {
                let first = layout.index_at(at.span.start as usize);
                let last = layout.last_token(at, name);
                self.take(first, last)
            }
            None => Vec::new(),
        }
    }

    /// Returns the comment that ends the line of a statement, of a declarator or of a member.
    pub(crate) fn behind(&mut self, at: Place, name: Option<Place>) -> Option<String> {
        let start = at.span.start as usize;
        if self.cursor.file.is_none() && self.files.get(&at.span.file)?.is_in_directive(start) {
            return self.of_macro(at.span.file, start, true).into_iter().next();
        }
        let last = self.current(at)?.last_token(at, name);
        self.files.get_mut(&at.span.file)?.write_behind(last)
    }

    /// Returns the comment behind the end of a compound statement in the current block, before the `next`
    /// statement.
    pub(crate) fn behind_block(&mut self, at: Place, next: Option<Place>) -> Option<String> {
        let layout = self.current(at)?;
        let comment = layout.comments.get(self.cursor.comment)?;
        let end = comment.next.checked_sub(1)?;
        let next = next.map_or(layout.text.len(), |next| next.span.start as usize);
        let is_own = matches!(layout.token(end), "}" | ";")
            && (at.span.start as usize..next).contains(&layout.start(end))
            && layout.closing[end] == self.cursor.closing;
        if !is_own {
            return None;
        }
        self.files.get_mut(&at.span.file)?.write_behind(end)
    }

    /// Enters the block of a statement or a label, if the author wrote it with braces; also returns the comment
    /// behind the `{`.
    pub(crate) fn enter(&mut self, inside: Place) -> (OuterBlock, Option<String>) {
        let outer = self.cursor.closing;
        let closing = self.current(inside).and_then(|layout| {
            let closing = layout.closing.get(layout.index_at(inside.span.start as usize));
            closing.copied().filter(|&closing| closing < layout.tokens.len())
        });
        let Some(closing) = closing.filter(|&closing| closing < outer) else {
            return (OuterBlock(outer), None);
        };
        self.cursor.closing = closing;
        let layout = self.files.get_mut(&inside.span.file);
        let behind = layout.and_then(|layout| layout.write_behind(layout.partners[closing]));
        (OuterBlock(outer), behind)
    }

    /// Leaves a block; returns the comments at its end.
    pub(crate) fn leave(&mut self, outer: OuterBlock) -> Vec<String> {
        let closing = std::mem::replace(&mut self.cursor.closing, outer.0);
        let layout = self.cursor.file.and_then(|file| self.files.get(&file));
        let end = layout
            .filter(|_| closing < outer.0)
            .map(|layout| layout.start(closing));
        let mut lines = end.map_or_else(Vec::new, |end| self.take_until(end));
        if lines.last().is_some_and(String::is_empty) {
            lines.pop();
        }
        lines
    }

    /// Returns the comments above the macro of a literal, and those that end its line.
    pub(crate) fn of_constant(&mut self, literal: Place) -> [Vec<String>; 2] {
        let (file, start) = (literal.spelling.file, literal.spelling.start as usize);
        [false, true].map(|is_behind| self.of_macro(file, start, is_behind))
    }

    /// Takes the comments above the `#define` at a byte, or those that end its line.
    fn of_macro(&mut self, file: FileId, byte: usize, is_behind: bool) -> Vec<String> {
        let mut lines = Vec::new();
        if let Some(layout) = self.files.get_mut(&file) {
            for index in layout.of_macro(byte) {
                let comment = &layout.comments[index];
                if comment.fate == Fate::OfMacro && comment.is_trailing == is_behind {
                    layout.write(index, &mut lines);
                }
            }
        }
        trim_blank_lines(&mut lines);
        lines
    }

    /// Returns the comments that are not written yet, behind a blank line.
    pub(crate) fn rest(&mut self) -> String {
        let mut lines = Vec::new();
        for layout in self.files.values_mut() {
            for index in 0..layout.comments.len() {
                if layout.comments[index].fate != Fate::Done {
                    layout.write(index, &mut lines);
                }
            }
        }
        trim_blank_lines(&mut lines);
        if lines.is_empty() {
            String::new()
        } else {
            format!("\n{}\n", lines.join("\n"))
        }
    }

    /// The file of a place in the declaration that is being written.
    fn current(&self, at: Place) -> Option<&SourceLayout<'a>> {
        let layout = self
            .files
            .get(&at.span.file)
            .filter(|_| self.cursor.file == Some(at.span.file))?;
        let start = at.span.start as usize;
        (self.cursor.begin <= start && start <= self.cursor.end).then_some(layout)
    }

    /// Takes the comments before the token `end`, which begins or ends what `first` begins.
    fn take(&mut self, first: usize, end: usize) -> Vec<String> {
        let Some(layout) = self.cursor.file.and_then(|file| self.files.get(&file)) else {
            return Vec::new();
        };
        let (start, end) = (layout.start(first), layout.start(end));
        let is_spaced = layout.follows_blank_line(first) && self.cursor.spaced.replace(first) != Some(first);
        let mut lines = self.take_until(start);
        if is_spaced {
            lines.push(String::new());
        }
        // Blank lines inside are not kept.
        let inside = self.take_until(end).into_iter().filter(|line| !line.is_empty());
        lines.extend(inside);
        lines.dedup_by(|line, before| line.is_empty() && before.is_empty());
        lines
    }

    fn take_until(&mut self, end: usize) -> Vec<String> {
        let mut lines = Vec::new();
        let layout = self.cursor.file.and_then(|file| self.files.get_mut(&file));
        if let Some(layout) = layout {
            while let Some(comment) = layout.comments.get(self.cursor.comment)
                && comment.start < end
            {
                if comment.fate == Fate::Pending {
                    layout.write(self.cursor.comment, &mut lines);
                }
                self.cursor.comment += 1;
            }
        }
        lines
    }
}

impl Cursor {
    /// The cursor outside of every file.
    fn outside() -> Self {
        Self {
            file: None,
            declaration: 0,
            comment: 0,
            begin: 0,
            end: 0,
            spaced: None,
            closing: 0,
        }
    }

    /// The cursor before a declaration.
    fn new(layout: &SourceLayout<'_>, file: FileId, declaration: usize) -> Self {
        let none = [0, layout.tokens.len()];
        let [first, last] = layout.declarations.get(declaration).copied().unwrap_or(none);
        Self {
            file: Some(file),
            declaration,
            comment: layout
                .regions
                .get(declaration)
                .copied()
                .unwrap_or(layout.comments.len()),
            begin: layout.start(first),
            end: layout.start(last),
            spaced: None,
            closing: layout.tokens.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{Deadline, File};
    use toyproof_glsl::{Options, check};

    use super::*;
    use crate::c_family::{CHost, Title, write};

    /// What a shader is written as, in a language that differs little from GLSL.
    fn written(text: &str) -> String {
        let mut files = Files::default();
        let file = files.add(File::new("shader", text));
        let checked = check(&files, file, &Options::default()).unwrap();
        let title = Title::of_shader("shader");
        write(&checked, &files, CHost::Hlsl, title, &Deadline::default()).unwrap()
    }

    /// Checks the lines of `mainImage` with that body.
    #[track_caller]
    fn assert_body(body: &str, lines: &[&str]) {
        let whole = written(&format!(
            "void mainImage(out vec4 c, in vec2 p) {{\n{body}\n}}\n// end"
        ));
        let (_, text) = whole.split_once("float2 p) {\n").unwrap();
        let (text, rest) = text.split_once("\n}\n").unwrap();
        let own: Vec<&str> = text
            .lines()
            .map(|line| line.strip_prefix("    ").unwrap_or(line))
            .collect();
        assert_eq!(own, lines, "{whole}");
        assert!(rest.starts_with("\n// end\n"), "{whole}");
    }

    /// Checks what is written before the entry point.
    #[track_caller]
    fn assert_items(text: &str, expected: &str) {
        let whole = written(&format!(
            "{text}void mainImage(out vec4 c, in vec2 p) {{ c = vec4(f(p)); }}"
        ));
        let (items, _) = whole.split_once("\nfloat4 main(").unwrap();
        let (items, _) = items.split_once("void mainImage(").unwrap();
        assert_eq!(items, expected, "{whole}");
    }

    #[test]
    fn comments_of_a_block_stay_in_it() {
        assert_body(
            "\n  // a\n\n  c = p.xyxy; // b\n#define X\n  /* c\n     d */\n#define Y\n\n  if (p.x > 0.) { // e\n    // f\n    \
             c *= 2.;\n    // g\n\n    // h\n\n  } // i\n  // j\n  else {\n    // k\n    c.x = 1.;\n  }\n  // l\n",
            &[
                "// a",
                "",
                "c = p.xyxy; // b",
                "// c",
                "// d",
                "",
                "if (p.x > 0.0) { // e",
                "    // f",
                "    c *= 2.0;",
                "    // g",
                "",
                "    // h",
                "} else {",
                "    // i",
                "    // j",
                "    // k",
                "    c.x = 1.0;",
                "}",
                "// l",
            ],
        );
    }

    #[test]
    fn comments_in_a_statement_precede_it() {
        assert_body(
            "c = vec4(p, /* a */\n  // b\n  p);\nfloat x = 1., // c\n  y = 2.; // d\nfor (int i = 0; /* e */ i < 9; i++) // f\n  \
             x += y; // g\n// h\nc *= x;",
            &[
                "// a",
                "// b",
                "c = float4(p, p);",
                "float x = 1.0; // c",
                "float y = 2.0; // d",
                "// e",
                "for (int i = 0; i < 9; i++) {",
                "    // f",
                "    x += y; // g",
                "}",
                "// h",
                "c *= x;",
            ],
        );
    }

    #[test]
    fn comments_behind_a_block_stay_behind_it() {
        assert_body(
            "c = p.xyxy;\nif (p.x > 0.) c.x = 1.;\ndo { c.x++; } while (c.x < 9.); // a\nif (p.y > 0.) c.y = 1.;\nc.z = 1.; // b",
            &[
                "c = p.xyxy;",
                "if (p.x > 0.0) {",
                "    c.x = 1.0;",
                "}",
                "do {",
                "    c.x++;",
                "} while (c.x < 9.0); // a",
                "if (p.y > 0.0) {",
                "    c.y = 1.0;",
                "}",
                "c.z = 1.0; // b",
            ],
        );
    }

    #[test]
    fn comments_of_labels_precede_them() {
        assert_body(
            "c = p.xyxy;\nswitch (int(p.x)) { // a\n  // b\n  case 1: // c\n    c *= 2.;\n    break; // d\n  // e\n  default:\n    \
             c = -c;\n  // f\n} // g",
            &[
                "c = p.xyxy;",
                "switch (int(p.x)) { // a",
                "    // b",
                "    case 1:",
                "        // c",
                "        c *= 2.0;",
                "        break; // d",
                "    // e",
                "    default:",
                "        c = -c;",
                "        break;",
                "    // f",
                "} // g",
            ],
        );
    }

    #[test]
    fn all_comments_before_the_first_declaration_stay() {
        assert_items(
            "// a\n\n// b\n// c\n\n\n/* d */\nfloat f(vec2 p) { return p.x; } // e\n\n// f\n\n",
            "// a\n\n// b\n// c\n\n// d\nfloat f(float2 p) {\n    return p.x;\n} // e\n\n// f\n\n",
        );
        assert_items(
            "// a\n\n// b\n#if 1\n#endif\n// c\nfloat f(vec2 p) { return p.x; }\n",
            "// a\n\n// b\n\n// c\nfloat f(float2 p) {\n    return p.x;\n}\n\n",
        );
    }

    #[test]
    fn comments_of_a_macro_stay_with_its_constant() {
        assert_items(
            "// a\n#define B 2. // b\n/* c\n * d */\n#define A 1. /* e */\n// f\n#define UNUSED 1 // g\n\n\
             float f(vec2 p) { return A + B; }\n",
            "// a\n\nstatic const float B = 2.0; // b\n// c\n// d\nstatic const float A = 1.0; // e\n\n\
             // f\n\nfloat f(float2 p) {\n    return A + B;\n}\n\n",
        );
    }

    #[test]
    fn comments_of_a_macro_stay_with_its_function() {
        assert_items(
            "// a\n\n// b\n#define S(x) ((x) * (x)) // c\n// d\nfloat g;\n// e\nfloat f(vec2 p) {\n  // f\n\n  // g\n\
             #define T(x) (2. * (x)) // h\n  // i\n  return T(p.y) + S(p.x);\n}\n",
            "// a\n\n// b\nfloat S(float x) {\n    return x * x; // c\n}\n\n\
             // g\nfloat T(float x) {\n    return 2.0 * x; // h\n}\n\n\
             // e\nfloat f(float2 p) {\n    // f\n\n    // i\n    return T(p.y) + S(p.x);\n}\n\n",
        );
    }

    #[test]
    fn branches_without_braces_have_no_comments_of_the_block_around_them() {
        assert_body(
            "if (p.x > 0.) c = p.xyxy;\nelse c = p.yxyx;\n// a\nc += 1.; // b\n// c",
            &[
                "c = float4(0.0, 0.0, 0.0, 0.0);",
                "if (p.x > 0.0) {",
                "    c = p.xyxy;",
                "} else {",
                "    c = p.yxyx;",
                "}",
                "// a",
                "c += 1.0; // b",
                "// c",
            ],
        );
    }

    #[test]
    fn comments_of_what_is_left_out_vanish() {
        assert_items(
            "float x; // used\n// free\n\n// a\nfloat g(float x) { // b\n  return x; } // c\n#if 0\n// d\nfloat h;\n#else // e\n\
             // f\nfloat f(vec2 p) {\n#ifdef G\n  // g\n  x = 1.;\n#endif\n  return x;\n}\n#endif\n",
            "static float x = 0.0; // used\n\n// free\n\n// f\nfloat f(float2 p) {\n    return x;\n}\n\n",
        );
    }

    #[test]
    fn members_keep_their_comments() {
        assert_items(
            "struct S {\n  // a\n  float x; // b\n  float y, // c\n    z[2]; // d\n  // e\n}; // f\n\
             float f(vec2 p) { S s; s.x = s.y = s.z[0] = p.x; return s.x + s.y + s.z[0]; }\n",
            "struct S {\n    // a\n    float x; // b\n    float y; // c\n    float z[2]; // d\n    // e\n}; // f\n\n\
             float f(float2 p) {\n    S s = (S)0;\n    s.x = s.y = s.z[0] = p.x;\n    return s.x + s.y + s.z[0];\n}\n\n",
        );
    }
}
