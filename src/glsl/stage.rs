//! The tabs of a project, which are compiled with different inputs and entry points.

use crate::tree::{Direction, Function, Scalar, Tree, Type, VariableKind};

/// The kind of program that a text is compiled as: a tab of ShaderToy's editor.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Stage {
    /// The image, with `mainImage`. Its alpha is 1.
    #[default]
    Image,
    /// A buffer, with `mainImage`. The shader writes its alpha.
    Buffer,
    /// A cube map, with `mainCubemap`.
    Cubemap,
    /// Sound, with `mainSound`.
    Sound,
    /// The text that precedes all other tabs, compiled alone, without an entry point.
    Common,
}

impl Stage {
    /// Whether the site declares an input in this tab.
    pub(crate) fn has_input(self, name: &str) -> bool {
        match self {
            Self::Image | Self::Buffer | Self::Cubemap => true,
            Self::Sound => name.starts_with("iChannel") || matches!(name, "iDate" | "iSampleRate"),
            Self::Common => matches!(name, "iDate" | "iSampleRate"),
        }
    }

    /// The name of the tab, for messages.
    pub(crate) fn tab(self) -> &'static str {
        match self {
            Self::Image => "Image",
            Self::Buffer => "Buffer",
            Self::Cubemap => "Cube A",
            Self::Sound => "Sound",
            Self::Common => "Common",
        }
    }

    /// The function that the site calls; `None` for Common.
    pub(crate) fn entry(self) -> Option<Entry> {
        use Direction::{ConstIn, In, InOut, Out};
        const VEC2: Type = Type::Vector(Scalar::Float, 2);
        const VEC3: Type = Type::Vector(Scalar::Float, 3);
        const VEC4: Type = Type::Vector(Scalar::Float, 4);
        const COLOR: Parameter = (VEC4, &[Out, InOut]);
        const INPUT: &[Direction] = &[In, ConstIn];
        Some(match self {
            Self::Image | Self::Buffer => Entry {
                name: "mainImage",
                return_type: Type::Void,
                parameters: &[&[COLOR, (VEC2, INPUT)]],
                help: "define `void mainImage(out vec4 fragColor, in vec2 fragCoord)`, which ShaderToy calls for each pixel",
            },
            Self::Cubemap => Entry {
                name: "mainCubemap",
                return_type: Type::Void,
                parameters: &[&[COLOR, (VEC2, INPUT), (VEC3, INPUT), (VEC3, INPUT)]],
                help: "define `void mainCubemap(out vec4 fragColor, in vec2 fragCoord, in vec3 rayOri, in vec3 rayDir)`, which \
                       ShaderToy calls for each texel",
            },
            Self::Sound => Entry {
                name: "mainSound",
                return_type: VEC2,
                // Older shaders omit the sample number.
                parameters: &[
                    &[(Type::INT, INPUT), (Type::FLOAT, INPUT)],
                    &[(Type::FLOAT, INPUT)],
                ],
                help: "define `vec2 mainSound(int samp, float time)`, which ShaderToy calls for each sample",
            },
            Self::Common => return None,
        })
    }
}

/// The function that is called with [`Options::calls_added_main`](crate::Options::calls_added_main).
pub const ADDED_MAIN: &str = "toyproofMain";

/// The function that is called instead of the host's, see [`ADDED_MAIN`].
pub(crate) fn added_entry() -> Entry {
    let mut entry = Stage::Image.entry().expect("it has one");
    entry.name = ADDED_MAIN;
    entry
}

/// The type of a parameter, and its possible qualifiers.
type Parameter = (Type, &'static [Direction]);

/// A function that the site calls.
pub(crate) struct Entry {
    pub(crate) name: &'static str,
    return_type: Type,
    /// The parameters of each form, the preferred one first.
    parameters: &'static [&'static [Parameter]],
    pub(crate) help: &'static str,
}

impl Entry {
    /// The number of the form that a function has: 0 is preferred. `None` if it has another form.
    pub(crate) fn form(&self, function: &Function, tree: &Tree) -> Option<usize> {
        let fits = |&(ty, directions): &Parameter, variable: &crate::tree::Variable| {
            let has_direction = match variable.kind {
                VariableKind::Parameter(direction) => directions.contains(&direction),
                _ => false,
            };
            variable.ty == ty && has_direction
        };
        let has_form = |form: &&[Parameter]| {
            let parameters = function.parameters.iter().map(|&id| &tree[id]);
            form.len() == function.parameters.len() && form.iter().zip(parameters).all(|(a, b)| fits(a, b))
        };
        let form = self.parameters.iter().position(has_form)?;
        (function.return_type == self.return_type).then_some(form)
    }
}
