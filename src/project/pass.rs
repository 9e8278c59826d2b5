//! Tabs, passes and their inputs.

use std::fmt;

use toyproof_diagnostic::{FileId, Span};
use toyproof_glsl::{Filter, Wrap};
use toyproof_player::{BufferFormat, CUBE_A, IMAGE_BUFFERS, Target};

/// The maximum size of a tab in bytes. The site's editor takes 65,536 characters.
pub const MAX_TAB_BYTES: usize = 1 << 20;

/// A tab of the editor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Tab {
    /// Text that precedes every other tab.
    Common,
    /// A pass.
    Pass(PassKind),
}

/// What a pass renders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PassKind {
    /// The image.
    Image,
    /// A buffer.
    Buffer(Buffer),
    /// The cube map.
    CubeA,
    /// The sound.
    Sound,
}

/// The name of a buffer: a letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Buffer(u8);

/// A pass: its kind, its code and its inputs.
#[derive(Debug, Clone)]
pub struct Pass {
    /// What the pass renders.
    pub kind: PassKind,
    /// The text, without Common.
    pub file: FileId,
    /// The inputs of `iChannel0` to `iChannel3`.
    pub inputs: [Option<Input>; 4],
    /// How the textures of the buffer that the pass renders are made; its inputs determine whether they have
    /// mipmaps. The format of other passes does not count.
    pub format: BufferFormat,
}

/// An input of a pass.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// What is read.
    pub source: Source,
    /// How the input is sampled.
    pub sampler: Sampler,
    /// Where it stands in the project's JSON or TOML, or `None` if it is assumed.
    pub span: Option<Span>,
}

/// What an input reads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    /// A buffer of the project.
    Buffer(Buffer),
    /// The project's cube map.
    CubeA,
    /// The keyboard: 256×3 texels.
    Keyboard,
    /// The webcam.
    Webcam,
    /// The microphone: 512×2 texels.
    Mic,
    /// A texture, cube map, volume, video or piece of music.
    Medium {
        /// The type.
        source_type: SourceType,
        /// The site's id.
        id: String,
        /// The path on the site, or the address of a stream.
        path: String,
    },
}

/// How an input is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sampler {
    /// The filter.
    pub filter: Filter,
    /// What lies outside of the texture.
    pub wrap: Wrap,
    /// Whether a picture is flipped, so that its first row is at the top. Buffers and the keyboard ignore it.
    pub vflip: bool,
    /// Whether texels are decoded from sRGB. The site ignores it.
    pub srgb: bool,
}

impl PassKind {
    /// What the pass renders, if it is rendered to show the image.
    #[must_use]
    pub fn target(self) -> Target {
        match self {
            Self::Buffer(buffer) => Target::Buffer(buffer.number()),
            Self::CubeA => Target::Buffer(CUBE_A),
            Self::Image | Self::Sound => Target::Image,
        }
    }
}

impl Buffer {
    /// Buffer A.
    pub const A: Self = Self(0);
    /// Buffer B.
    pub const B: Self = Self(1);
    /// Buffer C.
    pub const C: Self = Self(2);
    /// Buffer D.
    pub const D: Self = Self(3);

    /// The buffers of `ShaderToy`. Other hosts have more, up to Buffer Z.
    pub const OF_SITE: [Self; 4] = [Self::A, Self::B, Self::C, Self::D];

    /// The buffer with this number, from 0; `None` from [`IMAGE_BUFFERS`] on.
    #[must_use]
    pub fn nth(number: usize) -> Option<Self> {
        let number = u8::try_from(number).ok()?;
        (usize::from(number) < IMAGE_BUFFERS).then_some(Self(number))
    }

    /// The number, from 0.
    #[must_use]
    pub fn number(self) -> usize {
        usize::from(self.0)
    }
}

impl fmt::Display for Buffer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&Target::Buffer(self.number()).to_string())
    }
}

/// The names of the files of buffers without `.glsl`, by their numbers.
const BUFFER_NAMES: [&str; IMAGE_BUFFERS] = [
    "buffer-a", "buffer-b", "buffer-c", "buffer-d", "buffer-e", "buffer-f", "buffer-g", "buffer-h",
    "buffer-i", "buffer-j", "buffer-k", "buffer-l", "buffer-m", "buffer-n", "buffer-o", "buffer-p",
    "buffer-q", "buffer-r", "buffer-s", "buffer-t", "buffer-u", "buffer-v", "buffer-w", "buffer-x",
    "buffer-y", "buffer-z",
];

impl Tab {
    /// All tabs of `ShaderToy`, in the order in which they are listed.
    pub const ALL: [Self; 8] = [
        Self::Common,
        Self::Pass(PassKind::Buffer(Buffer::A)),
        Self::Pass(PassKind::Buffer(Buffer::B)),
        Self::Pass(PassKind::Buffer(Buffer::C)),
        Self::Pass(PassKind::Buffer(Buffer::D)),
        Self::Pass(PassKind::CubeA),
        Self::Pass(PassKind::Image),
        Self::Pass(PassKind::Sound),
    ];

    /// The name in `project.toml`, which is that of the file without `.glsl`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Common => "common",
            Self::Pass(PassKind::Image) => "image",
            Self::Pass(PassKind::Buffer(buffer)) => BUFFER_NAMES[buffer.number()],
            Self::Pass(PassKind::CubeA) => "cube-a",
            Self::Pass(PassKind::Sound) => "sound",
        }
    }

    /// The name of the file in a project's folder.
    #[must_use]
    pub fn file_name(self) -> String {
        format!("{}.glsl", self.name())
    }

    /// The type in the site's JSON.
    pub(crate) fn type_name(self) -> &'static str {
        match self {
            Self::Common => "common",
            Self::Pass(PassKind::Image) => "image",
            Self::Pass(PassKind::Buffer(_)) => "buffer",
            Self::Pass(PassKind::CubeA) => "cubemap",
            Self::Pass(PassKind::Sound) => "sound",
        }
    }
}

/// The name that the site shows.
impl fmt::Display for Tab {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Common => f.pad("Common"),
            Self::Pass(kind) => kind.fmt(f),
        }
    }
}

/// The name that the site shows.
impl fmt::Display for PassKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Image => f.pad("Image"),
            Self::Buffer(buffer) => buffer.fmt(f),
            Self::CubeA => f.pad("Cube A"),
            Self::Sound => f.pad("Sound"),
        }
    }
}

impl Source {
    /// The pass that is read, if it is one of the project's.
    #[must_use]
    pub fn pass(&self) -> Option<PassKind> {
        match self {
            Self::Buffer(buffer) => Some(PassKind::Buffer(*buffer)),
            Self::CubeA => Some(PassKind::CubeA),
            _ => None,
        }
    }

    /// The type of the input.
    #[must_use]
    pub fn source_type(&self) -> SourceType {
        match self {
            Self::Buffer(_) => SourceType::Buffer,
            Self::CubeA => SourceType::Cubemap,
            Self::Keyboard => SourceType::Keyboard,
            Self::Webcam => SourceType::Webcam,
            Self::Mic => SourceType::Mic,
            Self::Medium { source_type, .. } => *source_type,
        }
    }
}

/// A type of inputs, as the site's JSON names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SourceType {
    /// A buffer of the project.
    Buffer,
    /// A picture.
    Texture,
    /// A cube map: six pictures, or Cube A.
    Cubemap,
    /// A 3D texture.
    Volume,
    /// The keyboard.
    Keyboard,
    /// The webcam.
    Webcam,
    /// A video.
    Video,
    /// A piece of music.
    Music,
    /// A piece of music of `SoundCloud`.
    MusicStream,
    /// The microphone.
    Mic,
}

impl SourceType {
    /// All types, each with its name in JSON.
    pub(crate) const NAMES: [(&str, Self); 10] = [
        ("texture", Self::Texture),
        ("buffer", Self::Buffer),
        ("cubemap", Self::Cubemap),
        ("volume", Self::Volume),
        ("keyboard", Self::Keyboard),
        ("webcam", Self::Webcam),
        ("video", Self::Video),
        ("music", Self::Music),
        ("musicstream", Self::MusicStream),
        ("mic", Self::Mic),
    ];

    /// The name in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        let mut names = Self::NAMES.iter();
        names
            .find(|(_, known)| *known == self)
            .map_or("", |(name, _)| name)
    }
}
