//! Completions with places to fill in: control flow, and the functions that a host calls.

use lsp_types::CompletionItemKind;
use toyproof_glsl::Stage;

use super::{Completer, Item, Place, Rank};

/// Statements: the label, what it inserts, and what it is.
const STATEMENTS: [(&str, &str, &str); 7] = [
    (
        "for",
        "for (int ${1:i} = 0; ${1:i} < ${2:10}; ${1:i}++) {\n\t$0\n}",
        "A loop that counts.",
    ),
    ("if", "if (${1:condition}) {\n\t$0\n}", "A condition."),
    (
        "if else",
        "if (${1:condition}) {\n\t$2\n} else {\n\t$0\n}",
        "A condition with both branches.",
    ),
    ("else", "else {\n\t$0\n}", "The other branch of a condition."),
    (
        "while",
        "while (${1:condition}) {\n\t$0\n}",
        "A loop with a condition in front.",
    ),
    (
        "do while",
        "do {\n\t$0\n} while (${1:condition});",
        "A loop with a condition behind.",
    ),
    (
        "switch",
        "switch (${1:value}) {\n\tcase ${2:0}:\n\t\t$0\n\t\tbreak;\n\tdefault:\n\t\tbreak;\n}",
        "Cases of an integer.",
    ),
];

const STRUCT: (&str, &str, &str) = (
    "struct",
    "struct ${1:Name} {\n\t${2:float} ${3:member};$0\n};",
    "A structure.",
);

const MAIN: (&str, &str, &str) = (
    "main",
    "void main() {\n\t$0\n}",
    "The function that the host runs for each pixel.",
);

impl Completer<'_> {
    pub(super) fn add_snippets(&mut self, place: Place) {
        match place {
            Place::Global => {
                self.add_snippet(STRUCT);
                self.add_entry();
            }
            Place::Statement => {
                for snippet in STATEMENTS {
                    self.add_snippet(snippet);
                }
            }
            Place::Parameters | Place::Expression => {}
        }
    }

    /// Adds the function that the host calls, unless the text has it.
    fn add_entry(&mut self) {
        let analysis = self.snapshot.analysis();
        let entry = match analysis.stage {
            _ if !analysis.dialect.calls_main_image() => MAIN,
            Stage::Image | Stage::Buffer => (
                "mainImage",
                "void mainImage(out vec4 fragColor, in vec2 fragCoord) {\n\
                 \tvec2 uv = fragCoord / iResolution.xy;\n\t$0\n\tfragColor = vec4(uv, 0.0, 1.0);\n}",
                "The function that ShaderToy calls for each pixel.",
            ),
            Stage::Cubemap => (
                "mainCubemap",
                "void mainCubemap(out vec4 fragColor, in vec2 fragCoord, in vec3 rayOri, in vec3 rayDir) {\n\
                 \t$0\n\tfragColor = vec4(0.5 + 0.5 * rayDir, 1.0);\n}",
                "The function that ShaderToy calls for each texel of a cube map.",
            ),
            Stage::Sound => (
                "mainSound",
                "vec2 mainSound(int samp, float time) {\n\t$0\n\treturn vec2(sin(6.2831 * 440.0 * time));\n}",
                "The function that ShaderToy calls for each sample of a sound.",
            ),
            Stage::Common => return,
        };
        let mut functions = self.snapshot.tree().functions.iter();
        if functions.all(|(_, function)| function.name != entry.0) {
            self.add_snippet(entry);
        }
    }

    fn add_snippet(&mut self, (label, inserted, documentation): (&str, &str, &str)) {
        let mut item = Item::new(label, CompletionItemKind::Snippet, Rank::Snippet);
        item.snippet = Some(inserted.to_owned());
        item.documentation = Some(documentation.to_owned());
        self.add(item);
    }
}
