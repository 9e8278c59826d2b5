//! The variants of the site's JSON.

use crate::media::Name;
use crate::node::{Member, Node};

/// A variant of the site's JSON, which differ in the keys of inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    /// The data of the site's own pages.
    Page,
    /// The API.
    Api,
    /// The editor's export.
    Editor,
}

impl Format {
    pub(crate) const NAMES: [(&str, Self); 3] =
        [("page", Self::Page), ("api", Self::Api), ("editor", Self::Editor)];

    /// The variant of a tree.
    pub(crate) fn detect(root: &Node, wrapper: Wrapper) -> Self {
        let passes = root
            .get("renderpass")
            .and_then(Node::as_array)
            .unwrap_or_default();
        let inputs = passes.iter().filter_map(|pass| pass.get("inputs")?.as_array());
        let mut inputs = inputs.flatten();
        if wrapper == Wrapper::Shader || inputs.clone().any(|input| input.get("ctype").is_some()) {
            Self::Api
        } else if root.get("flags").is_some() || inputs.any(|input| input.get("previewfilepath").is_none()) {
            Self::Editor
        } else {
            Self::Page
        }
    }

    pub(crate) fn name(self) -> &'static str {
        let mut names = Self::NAMES.iter();
        names
            .find(|(_, known)| *known == self)
            .map_or("", |(name, _)| name)
    }

    /// The members of an input that name what it reads.
    pub(crate) fn members(self, name: &Name) -> Vec<Member> {
        let Name {
            source_type,
            id,
            path,
            preview,
            ..
        } = name;
        let [id, kind] = [*id, source_type.name()];
        match self {
            Self::Page => vec![
                Member::new("id", id),
                Member::new("filepath", path.as_str()),
                Member::new("previewfilepath", preview.as_str()),
                Member::new("type", kind),
            ],
            Self::Api => vec![
                Member::new("id", id),
                Member::new("src", path.as_str()),
                Member::new("ctype", kind),
            ],
            Self::Editor => vec![
                Member::new("type", kind),
                Member::new("id", id),
                Member::new("filepath", path.as_str()),
            ],
        }
    }
}

/// What the JSON is wrapped in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wrapper {
    None,
    /// `[…]`
    Array,
    /// `{"Shader": …}`
    Shader,
}
