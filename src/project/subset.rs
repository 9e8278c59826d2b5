//! A project with some of its passes and inputs, and with other texts.

use toyproof_diagnostic::FileId;

use crate::node::{Node, Value};
use crate::pass::{Pass, PassKind, Tab};
use crate::project::{Document, Project};

impl Project {
    /// The project with these passes, one of which is the image. Their texts contain Common already. Of their
    /// inputs, those are left that `keeps` the pass and the number of the channel, and that read no other pass
    /// than these. Of the document, only the passes are left.
    #[must_use]
    pub fn subset(&self, texts: &[(PassKind, FileId)], keeps: impl Fn(PassKind, usize) -> bool) -> Self {
        let text = |kind: PassKind| texts.iter().find(|(own, _)| *own == kind).map(|(_, file)| *file);
        let reads = |pass: &Pass, channel: usize| {
            let input = pass.inputs[channel].as_ref();
            input.is_some_and(|input| input.source.pass().is_none_or(|read| text(read).is_some()))
                && keeps(pass.kind, channel)
        };
        let with_text = |pass: &Pass| {
            let mut inputs = pass.inputs.clone();
            for (channel, input) in inputs.iter_mut().enumerate() {
                input.take_if(|_| !reads(pass, channel));
            }
            Some(Pass {
                file: text(pass.kind)?,
                inputs,
                ..pass.clone()
            })
        };
        let Document {
            root,
            format,
            wrapper,
            tabs,
        } = &self.document;
        let nodes = root
            .get("renderpass")
            .and_then(Node::as_array)
            .unwrap_or_default();
        let node_of = |(node, (tab, _)): (&Node, &(Tab, FileId))| {
            let Tab::Pass(kind) = *tab else { return None };
            let pass = self.pass(kind)?;
            let mut node = node.clone();
            if let Some(Value::Array(inputs)) = node.get_mut("inputs").map(|inputs| &mut inputs.value) {
                inputs.retain(|input| channel(input).is_some_and(|channel| reads(pass, channel)));
            }
            Some(((Tab::Pass(kind), text(kind)?), node))
        };
        let (tabs, nodes): (_, Vec<Node>) = nodes.iter().zip(tabs).filter_map(node_of).unzip();
        Self {
            common: None,
            passes: self.passes.iter().filter_map(with_text).collect(),
            document: Document {
                root: [("renderpass", nodes.into())].into(),
                format: *format,
                wrapper: *wrapper,
                tabs,
            },
            ..self.clone()
        }
    }
}

/// The number of the channel of an input that was read before.
fn channel(input: &Node) -> Option<usize> {
    match &input.get("channel")?.value {
        Value::Number(number) => number.parse().ok(),
        _ => None,
    }
}
