//! Projects of several tabs: their images, `toyproof import`, and `toyproof export` of a project.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use toyproof_diagnostic::{Files, all_of, path_name};
use toyproof_glsl::{Dialect, Filter};
use toyproof_image::Texture;
use toyproof_project::files::{self, Input, ProjectTexts, ReadError, Texts};
use toyproof_project::{CompiledProject, PROJECT_FILE, PassKind, Project, Rendering, Tab};
use toyproof_verify::Failure;
use toyproof_verify::project::playback::PassShader;

use super::inputs::check_output;
use super::terminal::file_size;
use super::{CliError, Exit, Terminal};

/// The passes of a rendering, to evaluate or render them.
pub(super) fn pass_shader<'a>(project: &'a CompiledProject, rendering: &'a Rendering) -> PassShader<'a> {
    PassShader {
        checked: project.checked_of(rendering).collect(),
        graph: &rendering.graph,
        media: &rendering.media,
        films: rendering.films.clone(),
    }
}

/// What renders the image and a pass of a project, for images of this size in pixels.
///
/// # Errors
/// If a pass is needed that cannot be rendered.
pub(super) fn rendering(
    project: &CompiledProject,
    kind: PassKind,
    size: [u32; 2],
) -> Result<Rendering, Failure> {
    let unrendered = |error: &dyn Display| Failure::Unrendered(error.to_string());
    let rendering = project.rendering(kind).map_err(|error| unrendered(&error))?;
    let sizes = rendering.graph.check_sizes(size);
    sizes.map_err(|error| unrendered(&error))?;
    Ok(rendering)
}

/// Binds the textures that the user names to the channels of the image, instead of what the project reads
/// there.
pub(super) fn bind_channels(
    project: &CompiledProject,
    rendering: &mut Rendering,
    channels: &[Option<Texture>; 4],
) {
    for (channel, texture) in channels.iter().enumerate() {
        if let Some(texture) = texture {
            let has_mipmaps = project.image().sampling[channel].filter == Filter::Mipmap;
            let texture = texture.clone();
            let medium = rendering.media.len();
            // The passes of ISF have the same inputs.
            if project.image().dialect == Dialect::Isf {
                rendering.graph.bind_to_all(channel, medium);
            } else {
                rendering.graph.bind_to_image(channel, medium);
            }
            rendering.media.push(if has_mipmaps {
                texture.with_mipmaps()
            } else {
                texture
            });
        }
    }
}

/// The files of the media that an input with these texts reads from its folder, if it is a project.
pub(super) fn image_files(input: &Input, texts: Texts) -> Vec<PathBuf> {
    let (Texts::Project(texts @ ProjectTexts::Folder { .. }), Some(folder)) = (texts, input.path()) else {
        return Vec::new();
    };
    let Ok(project) = texts.parse(&mut Files::default()) else {
        return Vec::new();
    };
    let names = project.media_files();
    names
        .filter_map(|name| files::project_image(folder, name).ok())
        .collect()
}

/// Import a project from ShaderToy's JSON into a folder
///
/// The folder gets a file for each tab (image.glsl, common.glsl, buffer-a.glsl to buffer-d.glsl, cube-a.glsl,
/// sound.glsl), and project.toml with everything else. `toyproof export` makes the same JSON of it again.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Example:
  toyproof import waves.json -o waves
  toyproof check waves
  toyproof export waves -o waves.json")]
pub(super) struct ImportArgs {
    /// ShaderToy's JSON: of its API, of its page data, or of the editor's export
    #[arg(value_name = "JSON")]
    input: PathBuf,
    /// The folder to create [default: the name of the JSON without its extension]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

pub(super) fn import(args: &ImportArgs, terminal: &Terminal) -> Result<Exit, CliError> {
    let folder = args
        .output
        .clone()
        .unwrap_or_else(|| args.input.with_extension(""));
    let mut files = Files::default();
    let project = load(&args.input, &mut files)?;
    let mut written = vec![(folder.join(PROJECT_FILE), project.to_toml())];
    written.extend(project.tabs().iter().map(|&(tab, file)| {
        let text = files.get(file).text().to_owned();
        (folder.join(tab.file_name()), text)
    }));
    create(&folder, &written, terminal)?;
    let tabs = project.tabs().iter().map(|(tab, _)| tab.to_string());
    terminal.confirm(&folder, &tabs.collect::<Vec<_>>().join(", "));
    Ok(Exit::Success)
}

/// Writes the files of a new project; nothing is overwritten.
pub(super) fn create(
    folder: &Path,
    files: &[(PathBuf, String)],
    terminal: &Terminal,
) -> Result<(), CliError> {
    let elsewhere = |error: String| CliError::new(error).with_help("choose another folder with -o");
    let known = Tab::ALL.map(|tab| folder.join(tab.file_name()));
    let mut taken = files.iter().map(|(path, _)| path).chain(&known);
    if let Some(path) = taken.find(|path| path.symlink_metadata().is_ok()) {
        let path = path_name(path);
        return Err(elsewhere(format!("{path} already exists; nothing was written")));
    }
    if folder.exists() && !folder.is_dir() {
        return Err(elsewhere(format!("{} is not a folder", path_name(folder))));
    }
    files
        .iter()
        .try_for_each(|(path, text)| terminal.write_output(folder, path, text.as_bytes()))
}

/// Reads a project, or a shader as a project of one tab.
fn load(path: &Path, files: &mut Files) -> Result<Project, CliError> {
    let found = files::find(path).inputs.into_iter().next();
    let input = found.ok_or_else(CliError::silent)??;
    let project = read(&input)?.parse(files);
    project.map_err(|errors| CliError::diagnostics(errors, files))
}

/// Reads the texts of a project; those of a shader are its Image tab.
fn read(input: &Input) -> Result<ProjectTexts, ReadError> {
    Ok(match files::read(input)? {
        Texts::Project(texts) => texts,
        Texts::Shader(file) => ProjectTexts::Folder {
            toml: None,
            folder: None,
            tabs: vec![(Tab::Pass(PassKind::Image), file)],
        },
    })
}

/// Writes a project, or a shader as a project of one tab, as ShaderToy's JSON.
pub(super) fn export(input: &Path, output: &Path, terminal: &Terminal) -> Result<Exit, CliError> {
    check_output(output, &std::iter::once(input).collect())?;
    let mut files = Files::default();
    let project = load(input, &mut files)?;
    if !project.knows_inputs && !project.needed_by_image().is_empty() {
        let names: Vec<_> = project
            .needed_by_image()
            .iter()
            .map(ToString::to_string)
            .collect();
        terminal.note(&format!(
            "without {PROJECT_FILE}, every pass is assumed to read {} in the channel of its letter",
            all_of(&names)
        ));
    }
    let json = project.to_json(&files);
    terminal.write(output, json.as_bytes())?;
    terminal.confirm(output, &file_size(json.len()));
    Ok(Exit::Success)
}

/// The files of a new project, by their names: an image that Buffer A refines from frame to frame.
pub(super) fn template() -> [(&'static str, &'static str); 4] {
    [
        ("common.glsl", include_str!("template/common.glsl")),
        ("buffer-a.glsl", include_str!("template/buffer-a.glsl")),
        ("image.glsl", include_str!("template/image.glsl")),
        (PROJECT_FILE, include_str!("template/project.toml")),
    ]
}
