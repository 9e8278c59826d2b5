//! Trees of values with their places: the common form of JSON and `project.toml`. Objects keep the order
//! of their keys, and numbers their digits, so that a tree is written as it was read.

use toyproof_diagnostic::{Code, Diagnostic, Span};

/// A value and its place.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub(crate) value: Value,
    /// The place; `None` if the node was not read from a file.
    pub(crate) span: Option<Span>,
}

/// A value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Null,
    Bool(bool),
    /// A number, as it is written.
    Number(String),
    String(String),
    Array(Vec<Node>),
    Object(Vec<Member>),
}

/// A key and its value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Member {
    pub(crate) key: String,
    pub(crate) node: Node,
}

impl PartialEq for Node {
    /// Whether both have the same values in the same order, wherever they stand.
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl From<Value> for Node {
    fn from(value: Value) -> Self {
        Self { value, span: None }
    }
}

impl From<&str> for Node {
    fn from(text: &str) -> Self {
        Value::String(text.to_owned()).into()
    }
}

impl From<usize> for Node {
    fn from(number: usize) -> Self {
        Value::Number(number.to_string()).into()
    }
}

impl From<Vec<Node>> for Node {
    fn from(nodes: Vec<Node>) -> Self {
        Value::Array(nodes).into()
    }
}

impl<const N: usize> From<[(&str, Node); N]> for Node {
    fn from(members: [(&str, Node); N]) -> Self {
        Value::Object(
            members
                .into_iter()
                .map(|(key, node)| Member::new(key, node))
                .collect(),
        )
        .into()
    }
}

impl Member {
    pub(crate) fn new(key: &str, node: impl Into<Node>) -> Self {
        Self {
            key: key.to_owned(),
            node: node.into(),
        }
    }
}

impl Node {
    /// The value of a key; `None` if there is no such key, or if this is not an object.
    pub(crate) fn get(&self, key: &str) -> Option<&Self> {
        let Value::Object(members) = &self.value else {
            return None;
        };
        members
            .iter()
            .find(|member| member.key == key)
            .map(|member| &member.node)
    }

    pub(crate) fn get_mut(&mut self, key: &str) -> Option<&mut Self> {
        let Value::Object(members) = &mut self.value else {
            return None;
        };
        let mut members = members.iter_mut();
        members
            .find(|member| member.key == key)
            .map(|member| &mut member.node)
    }

    /// The members of an object; `None` for other values.
    pub(crate) fn members_mut(&mut self) -> Option<&mut Vec<Member>> {
        match &mut self.value {
            Value::Object(members) => Some(members),
            _ => None,
        }
    }

    pub(crate) fn as_str(&self) -> Option<&str> {
        match &self.value {
            Value::String(text) => Some(text),
            _ => None,
        }
    }

    pub(crate) fn as_array(&self) -> Option<&[Self]> {
        match &self.value {
            Value::Array(nodes) => Some(nodes),
            _ => None,
        }
    }

    pub(crate) fn is_object(&self) -> bool {
        matches!(self.value, Value::Object(_))
    }

    /// Moves this value and all inside to one place.
    pub(crate) fn set_span(&mut self, span: Option<Span>) {
        self.span = span;
        match &mut self.value {
            Value::Array(nodes) => nodes.iter_mut().for_each(|node| node.set_span(span)),
            Value::Object(members) => members.iter_mut().for_each(|member| member.node.set_span(span)),
            _ => {}
        }
    }

    /// The type, for messages: "a string".
    pub(crate) fn describe(&self) -> &'static str {
        match &self.value {
            Value::Null => "null",
            Value::Bool(_) => "true or false",
            Value::Number(_) => "a number",
            Value::String(_) => "a string",
            Value::Array(_) => "a list",
            Value::Object(_) => "an object",
        }
    }

    /// An error about this value.
    pub(crate) fn error(&self, message: impl Into<String>) -> Diagnostic {
        let error = Diagnostic::new(Code::ProjectValue, message);
        match self.span {
            Some(span) => error.at(span),
            None => error,
        }
    }
}
