//! `ShaderToy` projects: their tabs, the order of their passes, and the inputs of these, read from a folder or from the
//! site's JSON, and written as either.
//!
//! A project is the Image tab and up to seven others: Common, whose text precedes every other tab, Buffers A to D,
//! Cube A and Sound. Importing and exporting are inverse: the code stays as it is, byte for byte, and whatever else the
//! JSON holds is kept.
//!
//! ```
//! use toyproof_diagnostic::{File, Files};
//! use toyproof_project::{PassKind, Project};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let mut files = Files::default();
//!     let json = r#"{"ver": "0.1", "info": {"name": "Blue"}, "renderpass": [{"inputs": [], "outputs": [], "type": "image",
//!         "code": "void mainImage(out vec4 c, in vec2 p) { c = vec4(0, 0, 1, 1); }", "name": "Image", "description": ""}]}"#;
//!     let file = files.add(File::new("blue.json", json));
//!     let project = Project::from_json(&mut files, file)?;
//!     assert_eq!(project.name(), Some("Blue"));
//!     assert_eq!(project.passes[0].kind, PassKind::Image);
//!     assert!(project.to_toml().contains("name = \"Blue\""));
//!     Ok(())
//! }
//! ```

mod check;
mod compiled;
mod folder;
mod graph;
mod json;
mod lint;
mod media;
mod node;
mod read;
mod script;

use std::collections::HashMap;
use std::fmt;

use toyproof_diagnostic::{Diagnostic, FileId, Span};
pub use toyproof_glsl::{Filter, Wrap};
use toyproof_image::Image;

pub use self::check::{CheckedPass, CheckedProject, check};
pub use self::compiled::CompiledProject;
use self::folder::Format;
pub use self::folder::PROJECT_FILE;
pub use self::graph::{NotRendered, Rendering, Replaced};
pub use self::media::{Medium, SourceType};
use self::node::Node;
pub use self::script::parse_script;

/// The code of errors in the syntax of a project's JSON or TOML.
const INVALID_SYNTAX: &str = "E0507";
/// The code of errors in the content of a project's JSON or TOML.
const INVALID_VALUE: &str = "E0508";

/// The maximum size of a tab in bytes. The site's editor takes 65,536 characters.
pub const MAX_TAB_BYTES: usize = 1 << 20;

/// A project: Common, and passes with their inputs.
#[derive(Debug, Clone)]
pub struct Project {
    /// The text of Common.
    pub common: Option<FileId>,
    /// The passes in the order of the file. Buffers run in this order; Cube A runs after them, and the image
    /// last.
    pub passes: Vec<Pass>,
    /// Whether the inputs are given. Otherwise channel *n* of every pass but Sound is assumed to read the
    /// *n*th buffer, if there is one.
    pub knows_inputs: bool,
    /// The images of the project's folder that were added, by their paths.
    images: HashMap<String, Image>,
    document: Document,
}

/// The site's JSON without the code, as a tree.
#[derive(Debug, Clone)]
struct Document {
    root: Node,
    format: Format,
    wrapper: Wrapper,
    /// The text of each element of `renderpass`.
    tabs: Vec<(Tab, FileId)>,
}

/// What the JSON is wrapped in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wrapper {
    None,
    /// `[…]`
    Array,
    /// `{"Shader": …}`
    Shader,
}

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
    /// A buffer, of the size of the image.
    Buffer(Buffer),
    /// The cube map.
    CubeA,
    /// The sound.
    Sound,
}

/// The name of a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Buffer {
    /// Buffer A.
    A,
    /// Buffer B.
    B,
    /// Buffer C.
    C,
    /// Buffer D.
    D,
}

/// A pass: its kind, its code and its inputs.
#[derive(Debug, Clone)]
pub struct Pass {
    /// What it renders.
    pub kind: PassKind,
    /// Its text, without Common.
    pub file: FileId,
    /// The inputs of `iChannel0` to `iChannel3`.
    pub inputs: [Option<Input>; 4],
}

/// An input of a pass.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// What is read.
    pub source: Source,
    /// How it is sampled.
    pub sampler: Sampler,
    /// Where it stands in the project's JSON or TOML; none if it is assumed.
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

impl Buffer {
    /// All buffers.
    pub const ALL: [Self; 4] = [Self::A, Self::B, Self::C, Self::D];
}

impl fmt::Display for Buffer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::A => "Buffer A",
            Self::B => "Buffer B",
            Self::C => "Buffer C",
            Self::D => "Buffer D",
        })
    }
}

impl Tab {
    /// All tabs, in the order in which they are listed.
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
            Self::Pass(PassKind::Buffer(Buffer::A)) => "buffer-a",
            Self::Pass(PassKind::Buffer(Buffer::B)) => "buffer-b",
            Self::Pass(PassKind::Buffer(Buffer::C)) => "buffer-c",
            Self::Pass(PassKind::Buffer(Buffer::D)) => "buffer-d",
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
    fn type_name(self) -> &'static str {
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

impl Project {
    /// The name of the shader, if it has one.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        self.document.root.get("info")?.get("name")?.as_str()
    }

    /// The pass that renders the image.
    ///
    /// # Panics
    /// Never: every project has one.
    #[must_use]
    pub fn image(&self) -> &Pass {
        self.pass(PassKind::Image).expect("every project has an image")
    }

    /// The pass of that kind, if there is one.
    #[must_use]
    pub fn pass(&self, kind: PassKind) -> Option<&Pass> {
        self.passes.iter().find(|pass| pass.kind == kind)
    }

    /// The inputs that read an image of the project's folder, each with the path of its file.
    pub fn image_inputs(&self) -> impl Iterator<Item = (&Input, &str)> {
        let inputs = self.passes.iter().flat_map(|pass| pass.inputs.iter().flatten());
        inputs.filter_map(|input| Some((input, input.source.file()?)))
    }

    /// Adds the images of the project's folder, which `read` reads by their paths. The image of an input that
    /// has none is black.
    ///
    /// # Errors
    /// Why images cannot be read, each at its input.
    pub fn add_images(
        &mut self,
        mut read: impl FnMut(&str) -> Result<Image, String>,
    ) -> Result<(), Vec<Diagnostic>> {
        let mut images = HashMap::new();
        let mut errors = Vec::new();
        for (input, path) in self.image_inputs() {
            if images.contains_key(path) {
                continue;
            }
            match read(path) {
                Ok(image) => {
                    images.insert(path.to_owned(), image);
                }
                Err(reason) => {
                    let error = Diagnostic::error(INVALID_VALUE, reason);
                    errors.push(match input.span {
                        Some(span) => error.at(span),
                        None => error,
                    });
                }
            }
        }
        self.images = images;
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }

    /// All tabs with their texts, in the order of the file.
    #[must_use]
    pub fn tabs(&self) -> &[(Tab, FileId)] {
        &self.document.tabs
    }
}

#[cfg(test)]
mod tests;
