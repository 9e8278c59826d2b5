//! The hosts of shaders: one row for each, with the inputs that it sets.

use super::Version;
use crate::tree::{Input, Sampler, SamplerShape, Scalar, Type};

/// A host, and how it wraps a shader.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Dialect {
    /// ShaderToy: `mainImage`, and inputs that are not declared.
    #[default]
    ShaderToy,
    /// The terminal Ghostty: ShaderToy with inputs about the cursor and the colors.
    Ghostty,
    /// The Book of Shaders and glslViewer.
    BookOfShaders,
    /// GLSL Sandbox.
    GlslSandbox,
    /// three.js, p5.js and other libraries whose inputs are named like `uTime`.
    Three,
    /// ISF (Interactive Shader Format) of programs for live video: a JSON header declares its inputs.
    Isf,
    /// Any other page with WebGL: a full-screen fragment shader whose uniforms are the author's own.
    WebGl,
}

/// A row of the table.
struct Host {
    dialect: Dialect,
    /// The name on the command line.
    name: &'static str,
    /// The name for people.
    title: &'static str,
    /// Whether it calls `mainImage`; otherwise it runs `main`.
    calls_main_image: bool,
    /// The version of a shader that does not state one.
    version: Version,
    /// The versions in which shaders are written for it, the preferred one first; none if they are not.
    written: &'static [Version],
    /// Whether its inputs exist without a declaration.
    is_implicit: bool,
    /// Whether the author's own page or program sets the inputs, and so any of ShaderToy's.
    sets_any: bool,
    /// The inputs beyond ShaderToy's: a name, and its values, one for each type that it may be declared with.
    inputs: &'static [(&'static str, &'static [InputValue])],
}

/// An expression of ShaderToy's inputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum InputValue {
    /// `iTime` and the like.
    Whole(Input),
    /// `iResolution.xy` and the like: the first components of a vector.
    First(Input, u8),
    /// `float(iFrame)` and the like.
    Float(Input),
    /// `iMouse.xy / iResolution.xy`, from 0 to 1.
    Mouse,
    /// `iMouse.z > 0.0`: whether the button is down.
    MouseDown,
    /// `gl_FragCoord.xy / iResolution.xy`: the coordinates of a full-screen quad, from 0 to 1.
    Quad,
    /// [`Self::Quad`], with a z of 0.
    QuadInSpace,
    /// Coordinates with the center at 0, in units of the height.
    Surface,
    /// The extent of [`Self::Surface`]: the ratio of width to height, and 1.
    SurfaceSize,
    /// `iChannelResolution[K].xy`
    TextureSize(u8),
    /// `iChannelK`
    Texture(u8),
    /// A constant vector.
    Constant(&'static [f64]),
}

/// The value of a uniform or varying.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Bound {
    /// An input of the host.
    Input(InputValue),
    /// A constant of this type, by its components.
    Value(Type, Vec<f64>),
}

impl InputValue {
    /// Its type.
    pub(crate) fn ty(self) -> Type {
        let vector = |size: usize| match size {
            1 => Type::FLOAT,
            _ => Type::Vector(Scalar::Float, size as u8),
        };
        match self {
            Self::Whole(Input::Frame) => Type::INT,
            Self::Whole(input) => vector(input.ty().components()),
            Self::First(_, size) => vector(usize::from(size)),
            Self::Float(_) => Type::FLOAT,
            Self::MouseDown => Type::BOOL,
            Self::Mouse | Self::Quad | Self::Surface | Self::SurfaceSize | Self::TextureSize(_) => vector(2),
            Self::QuadInSpace => vector(3),
            Self::Texture(_) => Type::Sampler(Sampler::float(SamplerShape::D2)),
            Self::Constant(values) => vector(values.len()),
        }
    }
}

use InputValue::{
    Constant, First, Float, Mouse, MouseDown, Quad, QuadInSpace, Surface, SurfaceSize, Texture, TextureSize,
    Whole,
};

const TIME: &[InputValue] = &[Whole(Input::Time)];
const DELTA: &[InputValue] = &[Whole(Input::TimeDelta)];
const FRAME: &[InputValue] = &[Whole(Input::Frame), Float(Input::Frame)];
const RESOLUTION: &[InputValue] = &[First(Input::Resolution, 2), Whole(Input::Resolution)];
const MOUSE_PIXELS: &[InputValue] = &[First(Input::Mouse, 2), Whole(Input::Mouse)];
const MOUSE_SHARE: &[InputValue] = &[Mouse];
const DATE: &[InputValue] = &[Whole(Input::Date)];
const QUAD: &[InputValue] = &[Quad, QuadInSpace];

/// The names of ShaderToy's inputs, for shaders that declare them.
const SHADERTOY: &[(&str, &[InputValue])] = &[
    (
        "iResolution",
        &[Whole(Input::Resolution), First(Input::Resolution, 2)],
    ),
    ("iTime", TIME),
    ("iGlobalTime", TIME),
    ("iTimeDelta", DELTA),
    ("iFrame", FRAME),
    ("iFrameRate", &[Whole(Input::FrameRate)]),
    ("iMouse", &[Whole(Input::Mouse), First(Input::Mouse, 2)]),
    ("iDate", DATE),
    ("iSampleRate", &[Whole(Input::SampleRate)]),
    ("iChannelTime", &[Whole(Input::ChannelTime)]),
    ("iChannelResolution", &[Whole(Input::ChannelResolution)]),
    ("iChannel0", &[Texture(0)]),
    ("iChannel1", &[Texture(1)]),
    ("iChannel2", &[Texture(2)]),
    ("iChannel3", &[Texture(3)]),
];

/// Interpolated coordinates of a full-screen quad, by the names that pages and tutorials use.
const VARYINGS: &[(&str, &[InputValue])] = &[
    ("vUv", QUAD),
    ("vUV", QUAD),
    ("v_uv", QUAD),
    ("uv", QUAD),
    ("vTexCoord", QUAD),
    ("vTextureCoord", QUAD),
    ("vTexcoord", QUAD),
    ("v_texcoord", QUAD),
    ("v_texCoord", QUAD),
    ("texCoord", QUAD),
    ("texcoord", QUAD),
    ("TexCoords", QUAD),
    ("fragTexCoord", QUAD),
];

const ES_100: &[Version] = &[Version::Es100];
const ES_300: &[Version] = &[Version::Es300];
const ES_100_OR_300: &[Version] = &[Version::Es100, Version::Es300];

const BLACK: InputValue = Constant(&[0.0, 0.0, 0.0]);
const WHITE: InputValue = Constant(&[1.0, 1.0, 1.0]);
/// A cursor in the middle of a terminal of 640×360 pixels: x, y of its upper left corner, width, height.
const CURSOR: InputValue = Constant(&[320.0, 180.0, 10.0, 20.0]);

const HOSTS: &[Host] = &[
    Host {
        dialect: Dialect::ShaderToy,
        name: "shadertoy",
        title: "ShaderToy",
        calls_main_image: true,
        version: Version::Es300,
        written: ES_300,
        is_implicit: true,
        sets_any: false,
        inputs: &[],
    },
    Host {
        dialect: Dialect::Ghostty,
        name: "ghostty",
        title: "Ghostty",
        calls_main_image: true,
        version: Version::Es300,
        written: ES_300,
        is_implicit: true,
        sets_any: false,
        inputs: &[
            ("iCurrentCursor", &[CURSOR]),
            ("iPreviousCursor", &[CURSOR]),
            ("iCurrentCursorColor", &[Constant(&[1.0, 1.0, 1.0, 1.0])]),
            ("iPreviousCursorColor", &[Constant(&[1.0, 1.0, 1.0, 1.0])]),
            ("iTimeCursorChange", &[Constant(&[0.0])]),
            ("iTimeFocus", &[Constant(&[0.0])]),
            ("iBackgroundColor", &[BLACK]),
            ("iForegroundColor", &[WHITE]),
            ("iCursorColor", &[WHITE]),
            ("iCursorText", &[BLACK]),
            ("iSelectionBackgroundColor", &[WHITE]),
            ("iSelectionForegroundColor", &[BLACK]),
        ],
    },
    Host {
        dialect: Dialect::BookOfShaders,
        name: "book-of-shaders",
        title: "The Book of Shaders",
        calls_main_image: false,
        version: Version::Es100,
        written: ES_100_OR_300,
        is_implicit: false,
        sets_any: false,
        inputs: &[
            ("u_resolution", RESOLUTION),
            ("u_time", TIME),
            ("u_delta", DELTA),
            ("u_mouse", MOUSE_PIXELS),
            ("u_date", DATE),
            ("u_frame", FRAME),
            ("u_tex0", &[Texture(0)]),
            ("u_tex1", &[Texture(1)]),
            ("u_tex2", &[Texture(2)]),
            ("u_tex3", &[Texture(3)]),
            ("u_tex0Resolution", &[TextureSize(0)]),
            ("u_tex1Resolution", &[TextureSize(1)]),
            ("u_tex2Resolution", &[TextureSize(2)]),
            ("u_tex3Resolution", &[TextureSize(3)]),
        ],
    },
    Host {
        dialect: Dialect::GlslSandbox,
        name: "glsl-sandbox",
        title: "GLSL Sandbox",
        calls_main_image: false,
        version: Version::Es100,
        written: ES_100,
        is_implicit: false,
        sets_any: false,
        inputs: &[
            ("time", TIME),
            ("resolution", RESOLUTION),
            ("mouse", MOUSE_SHARE),
            ("surfaceSize", &[SurfaceSize]),
            ("surfacePosition", &[Surface]),
        ],
    },
    Host {
        dialect: Dialect::Three,
        name: "three",
        title: "three.js and p5.js",
        calls_main_image: false,
        version: Version::Es100,
        written: ES_100_OR_300,
        is_implicit: false,
        sets_any: true,
        inputs: &[
            ("uTime", TIME),
            ("uDeltaTime", DELTA),
            ("uFrame", FRAME),
            ("uResolution", RESOLUTION),
            ("uMouse", MOUSE_PIXELS),
            ("uDate", DATE),
            ("millis", TIME),
        ],
    },
    Host {
        dialect: Dialect::Isf,
        name: "isf",
        title: "ISF",
        calls_main_image: false,
        // As programs compile it on the desktop.
        version: Version::Desktop(150),
        written: &[],
        is_implicit: false,
        sets_any: false,
        inputs: &[
            ("TIME", TIME),
            ("TIMEDELTA", DELTA),
            ("DATE", DATE),
            ("FRAMEINDEX", FRAME),
            ("RENDERSIZE", RESOLUTION),
            // Written shaders have these inputs, in whose headers they have values.
            ("mouseDown", &[MouseDown]),
            ("isf_FragNormCoord", QUAD),
            ("vv_FragNormCoord", QUAD),
        ],
    },
    Host {
        dialect: Dialect::WebGl,
        name: "webgl",
        title: "WebGL",
        calls_main_image: false,
        version: Version::Es100,
        written: ES_100_OR_300,
        is_implicit: false,
        sets_any: true,
        inputs: &[],
    },
];

impl Dialect {
    /// All dialects.
    pub fn all() -> impl Iterator<Item = Self> {
        HOSTS.iter().map(|host| host.dialect)
    }

    fn host(self) -> &'static Host {
        let host = HOSTS.iter().find(|host| host.dialect == self);
        host.expect("every dialect has a row")
    }

    /// The name on the command line, such as `book-of-shaders`.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.host().name
    }

    /// The name for people, such as “The Book of Shaders”.
    #[must_use]
    pub fn title(self) -> &'static str {
        self.host().title
    }

    /// The dialect of that name on the command line.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let host = HOSTS.iter().find(|host| host.name == name);
        host.map(|host| host.dialect)
    }

    /// Whether the host calls `mainImage`; otherwise it runs `main`.
    #[must_use]
    pub fn calls_main_image(self) -> bool {
        self.host().calls_main_image
    }

    /// The version of a shader that does not state one.
    pub(crate) fn version(self) -> Version {
        self.host().version
    }

    /// Whether ShaderToy's inputs, and those of the host, exist without a declaration.
    pub(crate) fn is_implicit(self) -> bool {
        self.host().is_implicit
    }

    /// The versions in which shaders are written for the host, the preferred one first; none if they are not.
    pub(crate) fn written_versions(self) -> &'static [Version] {
        self.host().written
    }

    /// Whether the author's own page or program sets the inputs, and so any of ShaderToy's.
    pub(crate) fn sets_any(self) -> bool {
        self.host().sets_any
    }

    /// Whether the host declares a name, so that a shader cannot.
    pub(crate) fn declares(self, name: &str) -> bool {
        let mut all = SHADERTOY.iter().chain(self.host().inputs);
        self.is_implicit() && all.any(|(input, _)| *input == name)
    }

    /// The first input that the host sets to a value with this property: its name, and the value.
    pub(crate) fn sets(self, is_wanted: impl Fn(InputValue) -> bool) -> Option<(&'static str, InputValue)> {
        let host = self.host();
        let shadertoys = SHADERTOY.iter().filter(|_| host.is_implicit || host.sets_any);
        // The first value of each is the one that the host sets; it converts it to the others.
        let mut all = host.inputs.iter().chain(shadertoys);
        all.find(|(_, values)| is_wanted(values[0]))
            .map(|&(name, values)| (name, values[0]))
    }

    /// The values of an input that the host sets; `None` if it has no such input.
    pub(crate) fn input(self, name: &str) -> Option<&'static [InputValue]> {
        let mut all = self.inputs();
        all.find(|(input, _)| *input == name).map(|(_, values)| *values)
    }

    /// The host's name of one of ShaderToy's inputs, if it has one of its own.
    #[must_use]
    pub fn name_of(self, input: Input) -> Option<&'static str> {
        let is_value = |value: &InputValue| matches!(*value, Whole(of) | First(of, _) if of == input);
        let mut inputs = self.host().inputs.iter();
        let named = inputs.find(|(_, values)| values.iter().any(is_value));
        named.map(|(name, _)| *name)
    }

    /// The names of the inputs that may have this value.
    pub(crate) fn names_of(self, value: InputValue) -> impl Iterator<Item = &'static str> {
        let of_value = move |(_, values): &&(&str, &[InputValue])| values.contains(&value);
        self.inputs().filter(of_value).map(|(name, _)| *name)
    }

    /// The names of the host's own inputs, which ShaderToy does not have.
    pub fn own_inputs(self) -> impl Iterator<Item = &'static str> {
        let inputs = self.host().inputs.iter();
        inputs.map(|(name, _)| *name)
    }

    /// The inputs that the host sets, its own first.
    fn inputs(self) -> impl Iterator<Item = &'static (&'static str, &'static [InputValue])> {
        let own = self.host().inputs.iter();
        // Shaders of a host that runs `main` often come from another one.
        let others = HOSTS
            .iter()
            .filter(|host| !host.calls_main_image)
            .flat_map(|host| host.inputs);
        let common = SHADERTOY.iter().chain(VARYINGS).chain(others);
        own.chain(common.filter(move |_| !self.calls_main_image()))
    }

    /// The dialect of a shader with a function `main` in which these names occur: the host most of whose
    /// inputs do.
    pub(crate) fn of_main(occurs: impl Fn(&str) -> bool) -> Self {
        let count = |host: &Host| host.inputs.iter().filter(|(name, _)| occurs(name)).count();
        let running_main = HOSTS.iter().filter(|host| !host.calls_main_image);
        // The first of equals.
        let best = running_main.rev().max_by_key(|host| count(host));
        best.filter(|host| count(host) > 0)
            .map_or(Self::WebGl, |host| host.dialect)
    }

    /// The dialect of a shader with a function `mainImage` in which these names occur.
    pub(crate) fn of_main_image(occurs: impl Fn(&str) -> bool) -> Self {
        let calling = HOSTS.iter().filter(|host| host.calls_main_image);
        let mut with_inputs = calling.filter(|host| host.inputs.iter().any(|(name, _)| occurs(name)));
        with_inputs.next().map_or(Self::ShaderToy, |host| host.dialect)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hosts_are_recognized_by_their_inputs() {
        let of = |text: &'static str| Dialect::of_main(move |name| text.split(' ').any(|word| word == name));
        assert_eq!(of("u_time main"), Dialect::BookOfShaders);
        assert_eq!(of("time resolution"), Dialect::GlslSandbox);
        assert_eq!(of("uTime time uResolution"), Dialect::Three);
        assert_eq!(of("speed"), Dialect::WebGl);
        assert_eq!(
            Dialect::of_main_image(|name| name == "iCurrentCursor"),
            Dialect::Ghostty
        );
        assert_eq!(Dialect::of_main_image(|name| name == "iTime"), Dialect::ShaderToy);
    }

    #[test]
    fn the_name_decides_which_input_it_is() {
        let mouse = |dialect: Dialect, name| dialect.input(name).map(|values| values[0]);
        assert_eq!(mouse(Dialect::GlslSandbox, "mouse"), Some(Mouse));
        assert_eq!(
            mouse(Dialect::BookOfShaders, "u_mouse"),
            Some(First(Input::Mouse, 2))
        );
        assert_eq!(mouse(Dialect::ShaderToy, "u_mouse"), None);
        for dialect in Dialect::all() {
            assert_eq!(Dialect::named(dialect.name()), Some(dialect));
        }
    }
}
