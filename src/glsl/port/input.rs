//! The inputs of a shader as the text for another host reads them.

use toyproof_diagnostic::{Code, Diagnostic};

use crate::dialect::{Dialect, InputValue};
use crate::tree::{Input, InputType, Place};

/// The components of a vector by each set of letters.
const COMPONENTS: [&str; 3] = ["xyzw", "rgba", "stpq"];

/// What ISF sets by these names, of which the header of a shader declares the first ones.
const ISF: [(&str, InputValue); 9] = [
    ("mouse", InputValue::Mouse),
    ("iChannel0", InputValue::Texture(0)),
    ("iChannel1", InputValue::Texture(1)),
    ("iChannel2", InputValue::Texture(2)),
    ("iChannel3", InputValue::Texture(3)),
    ("IMG_SIZE(iChannel0)", InputValue::TextureSize(0)),
    ("IMG_SIZE(iChannel1)", InputValue::TextureSize(1)),
    ("IMG_SIZE(iChannel2)", InputValue::TextureSize(2)),
    ("IMG_SIZE(iChannel3)", InputValue::TextureSize(3)),
];

/// The text that reads an input of the other host.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Spelling {
    /// An input of the same meaning.
    Name(&'static str),
    /// A vector.
    Vector {
        /// The text of all its components; `None` if the host does not set all.
        whole: Option<String>,
        /// The text of a vector that has the same first components.
        first: String,
        /// The number of components that are the same.
        same: usize,
        /// The number of components of `first`.
        size: usize,
    },
    /// Another expression.
    Value(String),
}

impl Spelling {
    /// The text of all components; `None` if the host does not set all.
    pub(super) fn whole(&self) -> Option<&str> {
        match self {
            Self::Name(name) => Some(name),
            Self::Vector { whole, .. } => whole.as_deref(),
            Self::Value(value) => Some(value),
        }
    }

    /// The text of the components that a swizzle names; `None` if the host does not set them.
    pub(super) fn components(&self, swizzle: &str) -> Option<String> {
        if let Self::Vector {
            first, same, size, ..
        } = self
            && let Some(set) = COMPONENTS
                .iter()
                .find(|set| swizzle.chars().all(|c| set[..*same].contains(c)))
        {
            let is_all = &set[..*size] == swizzle;
            return Some(if is_all {
                first.clone()
            } else {
                format!("{first}.{swizzle}")
            });
        }
        self.whole().map(|whole| format!("{whole}.{swizzle}"))
    }
}

/// Inputs of another host, and those that were used.
#[derive(Debug)]
pub(super) struct Inputs {
    to: Dialect,
    /// Whether the text reads where the mouse was clicked, which few hosts set.
    pub(super) reads_click: bool,
    /// The inputs that the text reads, in the order of their first use.
    pub(super) used: Vec<(&'static str, InputValue)>,
}

impl Inputs {
    pub(super) fn new(to: Dialect) -> Self {
        Self {
            to,
            reads_click: false,
            used: Vec::new(),
        }
    }

    /// The host's input with a value.
    fn find(&mut self, is_wanted: impl Fn(InputValue) -> bool) -> Option<(&'static str, InputValue)> {
        let of_isf = ISF.into_iter().filter(|_| self.to == Dialect::Isf);
        let found = self.to.sets(&is_wanted);
        let found = found.or_else(|| of_isf.into_iter().find(|(_, value)| is_wanted(*value)))?;
        if !self.used.contains(&found) {
            self.used.push(found);
        }
        Some(found)
    }

    /// The host's input that has all or the first components of one of ShaderToy's.
    fn find_input(&mut self, input: Input) -> Option<(&'static str, InputValue)> {
        if input == Input::Mouse && self.reads_click {
            return self.find(|value| value == InputValue::Whole(input));
        }
        self.find(|value| matches!(value, InputValue::Whole(of) | InputValue::First(of, _) if of == input))
    }

    /// The error about an input that the host does not set.
    pub(super) fn missing(&self, what: &str, at: Place) -> Box<Diagnostic> {
        let message = format!("{what} is not set by {}", self.to.title());
        let error = Code::UnsupportedByTarget.at(at, message);
        Box::new(error.help("choose another --style, or replace it with a constant"))
    }

    /// The text of a value; `None` if the host does not set it.
    pub(super) fn spell(&mut self, value: InputValue) -> Option<Spelling> {
        Some(match value {
            // Nothing says where the mouse was clicked.
            InputValue::Whole(Input::Mouse) if self.to == Dialect::Isf => Spelling::Value(
                "vec4(mouse * RENDERSIZE, (mouseDown ? 1.0 : -1.0) * mouse * RENDERSIZE)".to_owned(),
            ),
            InputValue::First(Input::Mouse, 2) if self.to == Dialect::Isf => {
                Spelling::Value("(mouse * RENDERSIZE)".to_owned())
            }
            InputValue::MouseDown => {
                let mouse = self.spell(InputValue::Whole(Input::Mouse))?;
                Spelling::Value(format!("({} > 0.0)", mouse.components("z")?))
            }
            InputValue::Whole(input) => match self.find_input(input) {
                Some((name, InputValue::First(_, size))) => {
                    let size = usize::from(size);
                    // The pixel aspect is 1; nothing tells where the mouse was clicked.
                    let whole = (input == Input::Resolution).then(|| format!("vec3({name}, 1.0)"));
                    vector(whole, name, size, size)
                }
                Some((name, _)) => Spelling::Name(name),
                None if input == Input::Mouse => {
                    let (mouse, _) = self.find(|value| value == InputValue::Mouse)?;
                    let pixels = format!("({mouse} * {})", self.resolution()?);
                    vector(None, &pixels, 2, 2)
                }
                None => return None,
            },
            InputValue::First(input, size) => {
                let size = usize::from(size);
                match self.spell(InputValue::Whole(input))? {
                    Spelling::Name(name) => {
                        let whole = format!("{name}.{}", &COMPONENTS[0][..size]);
                        vector(Some(whole), name, size, input.ty().components())
                    }
                    Spelling::Vector { first, size: own, .. } if own == size => {
                        match self.find_input(input) {
                            Some((name, _)) => Spelling::Name(name),
                            None => vector(Some(first.clone()), &first, size, size),
                        }
                    }
                    _ => return None,
                }
            }
            InputValue::Float(input) => Spelling::Value(format!("float({})", self.name(input)?)),
            InputValue::Mouse => {
                if let Some((name, _)) = self.find(|of| of == value) {
                    return Some(Spelling::Name(name));
                }
                let mouse = self.spell(InputValue::First(Input::Mouse, 2))?;
                Spelling::Value(format!("({} / {})", mouse.whole()?, self.resolution()?))
            }
            InputValue::Quad => Spelling::Value(format!("({})", self.quad()?)),
            InputValue::QuadInSpace => Spelling::Value(format!("vec3({}, 0.0)", self.quad()?)),
            InputValue::Surface => {
                let size = self.surface_size()?;
                Spelling::Value(format!("(({} - 0.5) * {size})", self.quad()?))
            }
            InputValue::SurfaceSize => Spelling::Value(self.surface_size()?),
            InputValue::Texture(_) => Spelling::Name(self.find(|of| of == value)?.0),
            InputValue::TextureSize(channel) => {
                if let Some((name, _)) = self.find(|of| of == value) {
                    return Some(Spelling::Name(name));
                }
                let name = self.name(Input::ChannelResolution)?;
                let size = format!("{name}[{channel}]");
                vector(Some(format!("{size}.xy")), &size, 2, 3)
            }
            InputValue::Constant(values) => Spelling::Value(constant(values)),
        })
    }

    /// The text of an element of `iChannelResolution`.
    pub(super) fn channel_resolution(&mut self, channel: u8) -> Option<Spelling> {
        let (name, _) = self.find(|value| value == InputValue::TextureSize(channel))?;
        Some(vector(Some(format!("vec3({name}, 1.0)")), name, 2, 2))
    }

    fn name(&mut self, input: Input) -> Option<&'static str> {
        match self.spell(InputValue::Whole(input))? {
            Spelling::Name(name) => Some(name),
            _ => None,
        }
    }

    /// The size of the image.
    fn resolution(&mut self) -> Option<String> {
        let resolution = self.spell(InputValue::First(Input::Resolution, 2))?;
        resolution.whole().map(str::to_owned)
    }

    /// The coordinates of the image from 0 to 1.
    fn quad(&mut self) -> Option<String> {
        Some(format!("gl_FragCoord.xy / {}", self.resolution()?))
    }

    fn surface_size(&mut self) -> Option<String> {
        let resolution = self.spell(InputValue::First(Input::Resolution, 2))?;
        let [width, height] = [resolution.components("x")?, resolution.components("y")?];
        Some(format!("vec2({width} / {height}, 1.0)"))
    }
}

fn vector(whole: Option<String>, first: &str, same: usize, size: usize) -> Spelling {
    let first = first.to_owned();
    Spelling::Vector {
        whole,
        first,
        same,
        size,
    }
}

/// A constant float or vector.
fn constant(values: &[f64]) -> String {
    let numbers: Vec<_> = values.iter().map(|value| format!("{value:?}")).collect();
    match &numbers[..] {
        [number] => number.clone(),
        _ => format!("vec{}({})", numbers.len(), numbers.join(", ")),
    }
}

/// The declaration of an input of a host that runs `main`.
pub(super) fn declaration(name: &str, value: InputValue) -> String {
    match value {
        InputValue::Whole(input) => {
            let ty = match input.ty() {
                InputType::Float => "float",
                InputType::Int => "int",
                InputType::Vec3 => "vec3",
                InputType::Vec4 => "vec4",
            };
            let length = input
                .length()
                .map_or_else(String::new, |length| format!("[{length}]"));
            format!("uniform {ty} {name}{length};")
        }
        InputValue::Texture(_) => format!("uniform sampler2D {name};"),
        _ => format!("uniform vec{} {name};", value.ty().component_count().unwrap_or(2)),
    }
}
