//! What a text may name without declaring it, and what its host sets: for editors.

use crate::dialect::{Dialect, InputValue, Language, OLD_TEXTURE_FUNCTIONS, Version};
use crate::keywords::{Interner, Keyword, Word};
use crate::stage::Stage;
use crate::tree::{BuiltIn, Type};

impl Version {
    /// The built-in functions with their names, also the old ones such as `texture2D`.
    pub fn functions(self, is_lenient: bool) -> impl Iterator<Item = (&'static str, BuiltIn)> {
        let language = Language {
            version: self,
            is_lenient,
        };
        let functions = BuiltIn::ALL.iter();
        let functions = functions.filter(move |&&function| language.has(function));
        let old = OLD_TEXTURE_FUNCTIONS.iter().filter(move |_| self.has_old_names());
        functions
            .map(|&function| (function.name(), function))
            .chain(old.map(|&(name, function, _)| (name, function)))
    }
}

impl Version {
    /// The built-in types with their names; `mat3x3` is another name of `mat3`.
    pub fn types(self, is_lenient: bool) -> Vec<(String, Type)> {
        let interner = self.words(is_lenient);
        let names = interner.types();
        names
            .filter_map(|name| match interner.word(interner.find(name)?) {
                Word::Type(ty) => Some((name.to_owned(), ty)),
                _ => None,
            })
            .collect()
    }

    /// The keywords that are not types, in the order of the specification.
    pub fn keywords(self, is_lenient: bool) -> Vec<&'static str> {
        let interner = self.words(is_lenient);
        let is_keyword = |text: &str| {
            let word = interner.find(text).map(|symbol| interner.word(symbol));
            matches!(word, Some(Word::Keyword(_)))
        };
        let all = Keyword::ALL.iter().map(|keyword| keyword.text());
        all.filter(|text| is_keyword(text)).collect()
    }

    fn words(self, is_lenient: bool) -> Interner {
        Interner::new(Language {
            version: self,
            is_lenient,
        })
    }
}

impl Dialect {
    /// Whether an input of ShaderToy exists in a tab without a declaration.
    pub fn has_input(self, stage: Stage, name: &str) -> bool {
        self.is_implicit() && stage.has_input(name)
    }

    /// What the host sets an input to that the text declares, in Markdown; `None` if it has no such input.
    pub fn input_documentation(self, name: &str) -> Option<String> {
        self.input(name)?.first().map(|value| value.documentation())
    }
}

impl InputValue {
    fn documentation(self) -> String {
        let text = match self {
            Self::Whole(input) | Self::First(input, _) | Self::Float(input) => input.documentation(),
            Self::Mouse => "The position of the mouse, from 0 to 1 over the image.",
            Self::MouseDown => "Whether the button of the mouse is down.",
            Self::Quad => "The position of the pixel, from 0 to 1 over the image.",
            Self::QuadInSpace => "The position of the pixel, from 0 to 1 over the image, and a z of 0.",
            Self::Surface => {
                "The position of the pixel from the center of the image, in units of its height."
            }
            Self::SurfaceSize => {
                "The size of the image in units of its height: the ratio of its sides, and 1."
            }
            Self::TextureSize(_) => "The size of the texture in texels: width and height.",
            Self::Texture(_) => "A texture that is set beside the shader; black if nothing is.",
            Self::Constant(components) => {
                let components: Vec<_> = components.iter().map(f64::to_string).collect();
                return format!("An input of the host, here always ({}).", components.join(", "));
            }
        };
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_have_their_functions_and_names() {
        let has = |version: Version, name| version.functions(false).any(|(listed, _)| listed == name);
        assert!(has(Version::Es300, "texture") && !has(Version::Es300, "texture2D"));
        assert!(has(Version::Es100, "texture2D") && !has(Version::Es100, "inverse"));
        assert!(has(Version::Es100, "dFdx"));
        let has_type = |version: Version, name| version.types(false).iter().any(|(listed, _)| listed == name);
        assert!(has_type(Version::Es300, "uvec2") && !has_type(Version::Es100, "uvec2"));
        let has_keyword = |version: Version, word| version.keywords(false).contains(&word);
        assert!(has_keyword(Version::Es300, "switch") && !has_keyword(Version::Es100, "switch"));
        assert!(has_keyword(Version::Es100, "varying") && !has_keyword(Version::Es300, "varying"));
    }

    #[test]
    fn hosts_describe_their_inputs() {
        let mut count = 0;
        for dialect in Dialect::all() {
            for name in dialect.own_inputs() {
                let text = dialect.input_documentation(name).unwrap();
                assert!(text.ends_with('.'), "{name}: {text}");
                count += 1;
            }
        }
        assert!(count > 40, "{count}");
        assert_eq!(Dialect::ShaderToy.input_documentation("u_time"), None);
        assert!(Dialect::ShaderToy.has_input(Stage::Image, "iTime"));
        assert!(!Dialect::ShaderToy.has_input(Stage::Sound, "iTime"));
        assert!(!Dialect::BookOfShaders.has_input(Stage::Image, "iTime"));
    }
}
