//! Literals of JavaScript: written as prettier formats them, and read again.

use std::collections::HashMap;

use serde_json::{Map, Value};

/// The longest line that prettier leaves as it is, in characters.
const LINE_WIDTH: usize = 80;

/// An object on one line, or with a line for each entry if it would be too long there. `column` is where it
/// begins, and `after` the number of characters behind it.
pub(super) fn object(entries: &[(String, String)], indent: usize, column: usize, after: usize) -> String {
    let entries: Vec<_> = entries
        .iter()
        .map(|(key, value)| format!("{key}: {value}"))
        .collect();
    match &entries[..] {
        [] => "{}".to_owned(),
        entries => enclosed(["{ ", " }", "{", "}"], entries, indent, column, after),
    }
}

/// An array, like [`object`].
pub(super) fn array(elements: &[String], indent: usize, column: usize, after: usize) -> String {
    match elements {
        [] => "[]".to_owned(),
        elements => enclosed(["[", "]", "[", "]"], elements, indent, column, after),
    }
}

fn enclosed(
    [open, close, open_line, close_line]: [&str; 4],
    items: &[String],
    indent: usize,
    column: usize,
    after: usize,
) -> String {
    let line = format!("{open}{}{close}", items.join(", "));
    if !line.contains('\n') && column + line.chars().count() + after <= LINE_WIDTH {
        return line;
    }
    let margin = " ".repeat(indent);
    let items = items.iter().map(|item| format!("{margin}  {item},\n"));
    format!("{open_line}\n{}{margin}{close_line}", items.collect::<String>())
}

/// A string in double quotes.
pub(super) fn string(text: &str) -> String {
    Value::from(text).to_string()
}

/// A template literal with this text.
pub(super) fn template(text: &str) -> String {
    let escaped = text.replace('\\', "\\\\").replace('`', "\\`");
    format!("`{}`", escaped.replace("${", "\\${").replace('\r', "\\r"))
}

/// The template literals that constants of a module hold, by the constants' names; `${…}` names an earlier
/// one.
pub(super) fn templates(module: &str) -> Result<HashMap<&str, String>, String> {
    let mut found = HashMap::new();
    let mut rest = module;
    while let Some((before, after)) = rest.split_once(" = /* glsl */ `") {
        let name = before.rsplit([' ', '\n']).next().unwrap_or_default();
        let (text, length) = template_text(after, &found)?;
        found.insert(name, text);
        rest = &after[length..];
    }
    Ok(found)
}

/// The text of a template literal up to its end, and the number of its bytes.
fn template_text(literal: &str, known: &HashMap<&str, String>) -> Result<(String, usize), String> {
    let mut text = String::new();
    let mut rest = literal;
    loop {
        let Some(at) = rest.find(['\\', '`', '$']) else {
            return Err("a template literal does not end".to_owned());
        };
        text += &rest[..at];
        let special = &rest[at..];
        rest = &special[1..];
        match special.as_bytes()[0] {
            b'`' => return Ok((text, literal.len() - rest.len())),
            b'\\' => {
                let escaped = rest.chars().next().unwrap_or_default();
                text.push(if escaped == 'r' { '\r' } else { escaped });
                rest = &rest[escaped.len_utf8().min(rest.len())..];
            }
            _ => match rest.strip_prefix('{').and_then(|inside| inside.split_once('}')) {
                Some((name, after)) => {
                    text += known
                        .get(name)
                        .ok_or("a template literal names an unknown constant")?;
                    rest = after;
                }
                None => text.push('$'),
            },
        }
    }
}

/// The literal that a constant of a module holds. Names in it are read as strings.
pub(super) fn constant(module: &str, name: &str) -> Result<Value, String> {
    let head = format!("\nconst {name} = ");
    let (_, text) = module
        .split_once(&head)
        .ok_or_else(|| format!("the constant `{name}` is missing"))?;
    Reader { rest: text }.value()
}

/// Reads objects, arrays, strings, names and numbers.
struct Reader<'a> {
    rest: &'a str,
}

impl Reader<'_> {
    /// Whether the text goes on with a character, which is skipped.
    fn accepts(&mut self, character: char) -> bool {
        self.rest = self.rest.trim_start();
        let after = self.rest.strip_prefix(character);
        self.rest = after.unwrap_or(self.rest);
        after.is_some()
    }

    fn value(&mut self) -> Result<Value, String> {
        if self.accepts('{') {
            let mut object = Map::new();
            while !self.accepts('}') {
                let Value::String(key) = self.word()? else {
                    return Err("the name of a property is expected".to_owned());
                };
                if !self.accepts(':') {
                    return Err(format!("`:` is missing after `{key}`"));
                }
                object.insert(key, self.value()?);
                if !self.accepts(',') && !self.rest.trim_start().starts_with('}') {
                    return Err("`,` or `}` is missing".to_owned());
                }
            }
            return Ok(Value::Object(object));
        }
        if self.accepts('[') {
            let mut array = Vec::new();
            while !self.accepts(']') {
                array.push(self.value()?);
                if !self.accepts(',') && !self.rest.trim_start().starts_with(']') {
                    return Err("`,` or `]` is missing".to_owned());
                }
            }
            return Ok(Value::Array(array));
        }
        self.word()
    }

    /// A string, or a name or number as it is.
    fn word(&mut self) -> Result<Value, String> {
        self.rest = self.rest.trim_start();
        let mut values = serde_json::Deserializer::from_str(self.rest).into_iter();
        if self.rest.starts_with('"')
            && let Some(Ok(value)) = values.next()
        {
            self.rest = &self.rest[values.byte_offset()..];
            return Ok(value);
        }
        let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '$' | '.' | '-');
        let end = self.rest.find(|c| !is_part(c)).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        if word.is_empty() {
            return Err("a value is expected".to_owned());
        }
        Ok(serde_json::from_str(word).unwrap_or_else(|_| Value::from(word)))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn templates_are_read_as_they_were_written() {
        let text = "a \\ b ` c ${d} $e \r\n µ";
        let module = format!(
            "const common = /* glsl */ `x\n`;\nconst s = /* glsl */ `${{common}}{};\n",
            &template(text)[1..]
        );
        assert_eq!(templates(&module).unwrap()["s"], format!("x\n{text}"));
        for wrong in ["const s = /* glsl */ `a", "const s = /* glsl */ `${a}`"] {
            assert!(templates(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn literals_are_read_as_they_were_written() {
        let pair = |key: &str, value: String| (key.to_owned(), value);
        let list = array(&["image".to_owned(), string("\"b\"")], 0, 0, 0);
        let short = object(&[pair("a", list), pair("isOn", "true".to_owned())], 0, 0, 0);
        assert_eq!(short, "{ a: [image, \"\\\"b\\\"\"], isOn: true }");
        let long = object(
            &[pair("a", string(&"x".repeat(80))), pair("b", "{}".to_owned())],
            2,
            0,
            0,
        );
        assert!(long.ends_with(",\n    b: {},\n  }"), "{long}");
        let module = format!("\nconst one = {short};\nconst two = {long};\n");
        assert_eq!(
            constant(&module, "one").unwrap(),
            json!({"a": ["image", "\"b\""], "isOn": true})
        );
        assert_eq!(constant(&module, "two").unwrap()["b"], json!({}));
        for wrong in ["{ a }", "[1 2]", "{ a: }", "{ \"a", "{ a: 1"] {
            assert!(constant(&format!("\nconst x = {wrong}"), "x").is_err(), "{wrong}");
        }
    }
}
