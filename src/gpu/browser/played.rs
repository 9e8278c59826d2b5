//! The passes of a shader over frames in Chromium: the original with WebGL 2, and modules for three.js.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use toyproof_glsl::{Checked, Sampling};
use toyproof_image::{Frame, Image, Input, Texture, UniformValue, input};
use toyproof_player::Target;

use super::{BrowserFailure, Chromium, TextureTable, black, frame_json, input_json, sampling_json};

/// A pass in GLSL ES 3.00, with `ShaderToy`'s inputs as uniforms.
#[derive(Debug, Clone)]
pub struct BrowserPass<'a> {
    /// The complete shader.
    pub text: String,
    /// What it renders, as large as the image.
    pub target: Target,
    /// Whether its target has mipmaps.
    pub mipmaps: bool,
    /// What its channels read.
    pub reads: [BrowserRead<'a>; 4],
    /// How they are sampled.
    pub sampling: [Sampling; 4],
    /// The values of uniforms that the author declares.
    pub uniforms: Vec<UniformValue>,
}

/// What a channel reads.
#[derive(Debug, Clone, Copy)]
pub enum BrowserRead<'a> {
    /// Opaque black, whose size is 0.
    Nothing,
    /// The buffer with this number, as it was completed last.
    Buffer(usize),
    /// A texture.
    Texture(&'a Texture),
    /// The keyboard, whose texels each frame has.
    Keyboard,
}

/// An ES module for three.js, and the textures that it is given.
#[derive(Debug, Clone)]
pub struct ThreeModule<'a> {
    /// The text of the module, which exports a class `Shader`.
    pub text: &'a str,
    /// The textures, by their names.
    pub textures: Vec<(String, &'a Texture, Sampling)>,
}

/// The files of the library three.js.
#[derive(Debug, Clone)]
pub struct ThreeLibrary {
    main: String,
    /// What the main file imports, in versions since 0.172.
    core: Option<String>,
    version: String,
}

/// The environment variable that names the folder of the package `three`.
pub const THREE_VARIABLE: &str = "TOYPROOF_THREE";

impl ThreeLibrary {
    /// Finds the package: in the folder that `TOYPROOF_THREE` names, else in `node_modules/three` in one of
    /// these folders, or in one that contains it.
    pub fn find(folders: &[PathBuf]) -> Option<Self> {
        if let Some(named) = std::env::var_os(THREE_VARIABLE) {
            return Self::read(Path::new(&named));
        }
        let mut ancestors = folders.iter().flat_map(|folder| folder.ancestors());
        ancestors.find_map(|folder| Self::read(&folder.join("node_modules/three")))
    }

    /// Reads the package in a folder; `None` if it is not there.
    #[must_use]
    pub fn read(package: &Path) -> Option<Self> {
        let text = |name: &str| String::from_utf8(input::read(&package.join(name)).ok()?).ok();
        let description: Value = serde_json::from_str(&text("package.json")?).ok()?;
        Some(Self {
            main: text("build/three.module.js")?,
            core: text("build/three.core.js"),
            version: description["version"].as_str()?.to_owned(),
        })
    }

    /// The version of the package.
    #[must_use]
    pub fn version(&self) -> &str {
        &self.version
    }
}

/// The name of a target in the page.
fn name(target: Target) -> String {
    match target {
        Target::Image => "image".to_owned(),
        Target::Buffer(number) => format!("buffer{number}"),
    }
}

/// The values of the uniforms that the author of a shader declares, for its pass.
#[must_use]
pub fn uniform_values(checked: &Checked) -> Vec<UniformValue> {
    let declared = checked.declared_uniforms();
    let valued = declared.filter_map(|(name, _, value)| {
        let components = value.filter(|components| !components.is_empty())?;
        Some(UniformValue {
            name: name.to_owned(),
            components: components.to_vec(),
        })
    });
    valued.collect()
}

/// The inputs of a shader, as the page sets them.
fn inputs_json() -> Value {
    Input::ALL.map(input_json).to_vec().into()
}

/// The job of playing passes, without frames: in [`SCRIPT`](super::SCRIPT), what `toyproof` and `openPasses`
/// take.
#[must_use]
pub fn passes_job(passes: &[BrowserPass]) -> Value {
    let black = black();
    let mut textures = TextureTable::default();
    let passes: Vec<Value> = passes
        .iter()
        .map(|pass| {
            let reads = pass.reads.map(|read| match read {
                BrowserRead::Nothing => json!({"texture": textures.number_of(&black), "isEmpty": true}),
                BrowserRead::Buffer(number) => json!({"buffer": name(Target::Buffer(number))}),
                BrowserRead::Texture(texture) => json!({"texture": textures.number_of(texture)}),
                BrowserRead::Keyboard => json!({"keyboard": true}),
            });
            json!({
                "text": pass.text, "target": name(pass.target), "mipmaps": pass.mipmaps, "reads": reads,
                "sampling": pass.sampling.map(sampling_json), "uniforms": pass.uniforms,
            })
        })
        .collect();
    json!({"language": "passes", "inputs": inputs_json(), "passes": passes, "textures": textures.json()})
}

impl Chromium {
    /// Gives the browser three.js, for modules that import it.
    #[must_use]
    pub fn with_three(self, library: ThreeLibrary) -> Self {
        Self {
            three: Some(library),
            ..self
        }
    }

    /// The browser's library three.js.
    #[must_use]
    pub fn three(&self) -> Option<&ThreeLibrary> {
        self.three.as_ref()
    }

    /// Plays passes with WebGL 2; returns the images of all frames. Frames start from the beginning where it
    /// is said.
    ///
    /// # Errors
    /// Why there are no images.
    pub fn play(
        &mut self,
        passes: &[BrowserPass],
        frames: &[(Frame, bool)],
    ) -> Result<Vec<Image>, BrowserFailure> {
        self.run(passes_job(passes), frames)
    }

    /// Renders the frames of a module for three.js. Frames start from the beginning where it is said.
    ///
    /// # Errors
    /// Why there are no images.
    pub fn play_three(
        &mut self,
        module: &ThreeModule,
        frames: &[(Frame, bool)],
    ) -> Result<Vec<Image>, BrowserFailure> {
        let library = self.three.as_ref().ok_or(BrowserFailure::NoThree)?;
        let library = json!({"main": library.main, "core": library.core});
        let mut textures = TextureTable::default();
        let mut names = serde_json::Map::new();
        for (name, texture, sampling) in &module.textures {
            let number = textures.number_of(texture);
            names.insert(
                name.clone(),
                json!({"number": number, "sampling": sampling_json(*sampling)}),
            );
        }
        let job = json!({
            "language": "three", "text": module.text, "library": library, "names": names,
            "textures": textures.json(), "inputs": inputs_json(),
        });
        self.run(job, frames)
    }

    /// Runs a job, to which frames without textures of their own are added.
    fn run(&mut self, mut job: Value, frames: &[(Frame, bool)]) -> Result<Vec<Image>, BrowserFailure> {
        let frames_json = frames.iter().map(|(frame, restarts)| {
            let mut json = frame_json(frame, [0; 4]);
            json["restarts"] = (*restarts).into();
            json
        });
        job["frames"] = frames_json.collect();
        let frames: Vec<&Frame> = frames.iter().map(|(frame, _)| frame).collect();
        self.call_page(&job, &frames)
    }
}
