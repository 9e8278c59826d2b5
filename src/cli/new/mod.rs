//! `toyproof new`

mod pack;

use std::path::{Path, PathBuf};
use std::time::Duration;

use toyproof_classroom::assignment::{FILE_NAME, Model};
use toyproof_classroom::function_test::Subject;
use toyproof_classroom::pack::frame_name;
use toyproof_diagnostic::path_name;
use toyproof_image as image;
use toyproof_project::files;
use toyproof_scene as scene;
use toyproof_verify::Expected;

use self::pack::{PackArgs, new_pack};
use super::inputs::{LanguageArgs, parse_time_limit};
use super::reference::{GivenReference, ReferenceArgs};
use super::scenes::{parse_scene, read_scene};
use super::{CliError, Exit, Terminal, project};

/// Create a new file from a template
#[derive(Debug, clap::Args)]
#[command(
    arg_required_else_help = true,
    after_long_help = "Example:\n  toyproof new scene week1"
)]
pub(super) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, clap::Subcommand)]
enum What {
    /// Create a scene: a camera, a light, a floor and two spheres, with comments on every key
    #[command(
        after_long_help = "Example:\n  toyproof new scene week1\n  toyproof render week1.toml -o week1.png"
    )]
    Scene(SceneArgs),
    /// Create an assignment: a folder with a model solution, what shaders are checked against, and thumbnails
    ///
    /// From a shader, the model solution is the reference, in one frame and in further ones for the time and
    /// the mouse if it reads them. From a scene, the scene is the reference, and the model solution is
    /// exported from it.
    #[command(
        after_long_help = "Example:\n  toyproof new assignment shadows --from solution.glsl\n  \
                           toyproof check homework --assignment shadows/assignment.toml"
    )]
    Assignment(AssignmentArgs),
    /// Create what students get of an assignment: images, a shader to begin with, tests and requirements
    ///
    /// Nothing of the solution is in it: the shader has the functions that the assignment names, without
    /// their bodies. README.md states frames, rules, points, and the commands with which students check their
    /// shaders.
    #[command(
        after_long_help = "Examples:\n  toyproof new pack shadows -o shadows-for-students\n  \
                           toyproof new pack shadows/assignment.toml -o shadows.zip"
    )]
    Pack(PackArgs),
    /// Create a class: its students, and the files, assignments and deadlines of its submissions, with
    /// comments
    #[command(after_long_help = "Example:\n  toyproof new class spring\n  \
                           toyproof check moodle.zip --class spring.toml --out marks")]
    Class(ClassArgs),
    /// Create a project: an image whose pixels Buffer A refines from frame to frame
    #[command(
        after_long_help = "Example:\n  toyproof new project waves\n  toyproof export waves -o waves.json"
    )]
    Project(ProjectArgs),
}

#[derive(Debug, clap::Args)]
struct SceneArgs {
    /// The name of the scene, which becomes its title and its file name
    #[arg(value_parser = parse_name)]
    name: String,
    /// The file to create [default: NAME.toml]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(Debug, clap::Args)]
struct AssignmentArgs {
    /// The name of the assignment, which becomes the name of its folder
    #[arg(value_parser = parse_name)]
    name: String,
    /// The model solution (.glsl) or the scene (.toml, or a name listed by `toyproof scenes`)
    #[arg(long, value_name = "SHADER|SCENE")]
    from: PathBuf,
    /// The folder to create [default: NAME]
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// The time limit for one image: seconds, or a number with a unit (500ms, 2m)
    #[arg(long, value_name = "TIME", default_value = "10s", value_parser = parse_time_limit)]
    timeout: Duration,
    #[command(flatten)]
    language: LanguageArgs,
}

#[derive(Debug, clap::Args)]
struct ClassArgs {
    /// The name of the class, which becomes its file name
    #[arg(value_parser = parse_name)]
    name: String,
    /// The file to create [default: NAME.toml]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(Debug, clap::Args)]
struct ProjectArgs {
    /// The name of the project, which is also the name of its folder
    #[arg(value_parser = parse_name)]
    name: String,
    /// The folder to create [default: NAME]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Parses a name that is also the name of a file.
fn parse_name(text: &str) -> Result<String, String> {
    let name = text.strip_suffix(".toml").unwrap_or(text);
    if files::is_shader(Path::new(name)) || files::is_json(Path::new(name)) {
        return Err("this is the name of a shader; leave out its extension".to_owned());
    }
    let is_allowed = |c: char| c.is_alphanumeric() || " -_.".contains(c);
    if name.starts_with(char::is_alphanumeric) && name.chars().all(is_allowed) {
        Ok(name.to_owned())
    } else {
        Err("a name consists of letters, digits, `-`, `_`, `.` and spaces, and starts with a letter or digit; \
             use `-o` to choose the folder"
            .to_owned())
    }
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<Exit, CliError> {
    match &args.what {
        What::Scene(args) => new_scene(args, terminal)?,
        What::Assignment(args) => new_assignment(args, terminal)?,
        What::Pack(args) => new_pack(args, terminal)?,
        What::Class(args) => new_class(args, terminal)?,
        What::Project(args) => new_project(args, terminal)?,
    }
    Ok(Exit::Success)
}

fn new_project(args: &ProjectArgs, terminal: &Terminal) -> Result<(), CliError> {
    let folder = args.output.clone().unwrap_or_else(|| PathBuf::from(&args.name));
    let files =
        project::template().map(|(name, text)| (folder.join(name), text.replacen("NAME", &args.name, 1)));
    project::create(&folder, &files, terminal)?;
    let name = path_name(&folder);
    terminal.note(&format!("created {name} with {} files", files.len()));
    terminal.note("next:");
    terminal.note(&format!("  toyproof check {}", quoted(&name)));
    terminal.note(&format!(
        "  toyproof export {} -o {}",
        quoted(&name),
        quoted(&format!("{name}.json"))
    ));
    Ok(())
}

fn new_scene(args: &SceneArgs, terminal: &Terminal) -> Result<(), CliError> {
    let text = scene::template(&args.name);
    if let Some(path) = create_file(&args.name, args.output.as_deref(), &text, terminal)? {
        let (scene, stem) = (quoted(&path_name(&path)), path_name(&path.with_extension("")));
        let (image, shader) = (quoted(&format!("{stem}.png")), quoted(&format!("{stem}.glsl")));
        terminal.note(&format!("  toyproof render {scene} -o {image}"));
        terminal.note(&format!("  toyproof export {scene} -o {shader}"));
        terminal.note(&format!("  toyproof check {shader}"));
    }
    Ok(())
}

fn new_class(args: &ClassArgs, terminal: &Terminal) -> Result<(), CliError> {
    let text = include_str!("../template/class.toml");
    if let Some(path) = create_file(&args.name, args.output.as_deref(), text, terminal)? {
        let class = quoted(&path_name(&path));
        terminal.note(&format!("  edit {class}"));
        terminal.note(&format!("  toyproof check DOWNLOAD --class {class} --out marks"));
    }
    Ok(())
}

/// Creates a file from a template, `NAME.toml` unless another is given, which may be standard output; returns
/// the path of a file.
fn create_file(
    name: &str,
    output: Option<&Path>,
    text: &str,
    terminal: &Terminal,
) -> Result<Option<PathBuf>, CliError> {
    let path = output.map_or_else(|| PathBuf::from(format!("{name}.toml")), Path::to_owned);
    let is_stream = path == Path::new("-");
    let name = path_name(&path);
    if !is_stream && path.exists() {
        return Err(CliError::new(format_args!(
            "{name} already exists; choose another name, or another file with `-o`"
        )));
    }
    terminal.write(&path, text.as_bytes())?;
    if is_stream {
        return Ok(None);
    }
    terminal.note(&format!("created {name}"));
    terminal.note("next:");
    Ok(Some(path))
}

/// The name of the reference shader of a new assignment.
const SOLUTION: &str = "solution.glsl";

/// The name of the scene of a new assignment.
const SCENE: &str = "scene.toml";

/// Creates the folder of an assignment. Everything is rendered before the first file is written.
fn new_assignment(args: &AssignmentArgs, terminal: &Terminal) -> Result<(), CliError> {
    let folder = args.output.clone().unwrap_or_else(|| PathBuf::from(&args.name));
    let name = path_name(&folder);
    refuse_existing(&folder)?;
    let files = if files::is_shader(&args.from) {
        from_shader(args, terminal)?
    } else {
        from_scene(args, terminal)?
    };
    for (file, bytes) in &files {
        terminal.write(&folder.join(file), bytes)?;
    }
    terminal.note(&format!("created {name}:"));
    for (file, _) in &files {
        terminal.note(&format!("  {file}"));
    }
    terminal.note("next:");
    let assignment = quoted(&path_name(&folder.join(FILE_NAME)));
    terminal.note(&format!("  edit {assignment}"));
    terminal.note(&format!("  toyproof check {}", quoted(&name)));
    terminal.note(&format!("  toyproof check SUBMISSIONS --assignment {assignment}"));
    Ok(())
}

/// Refuses to change what exists.
fn refuse_existing(path: &Path) -> Result<(), CliError> {
    if path.exists() {
        let name = path_name(path);
        return Err(CliError::new(format_args!(
            "{name} already exists; choose another name, or another folder with `-o`"
        )));
    }
    Ok(())
}

/// The names and the contents of files. The assignment is the last: once it exists, the others do.
type NewFiles = Vec<(String, Vec<u8>)>;

/// The files of an assignment whose reference is a shader.
fn from_shader(args: &AssignmentArgs, terminal: &Terminal) -> Result<NewFiles, CliError> {
    let reference = ReferenceArgs::given(args.from.clone());
    let given = GivenReference::read(&reference, &args.language, args.timeout)?;
    let given = given.ok_or_else(CliError::silent)?;
    let (shader, checked) = given.shader().ok_or_else(CliError::silent)?;
    let subject = Subject {
        checked,
        files: &shader.files,
        text: shader.text(checked),
        timeout: args.timeout,
    };
    let model = Model::Shader(&subject);
    let text = subject.text.as_bytes().to_vec();
    let frames = load(&model)?;
    let expected = given.expected(frames.iter(), args.timeout, terminal)?;
    let dependences = expected.iter().filter_map(Expected::march_dependence);
    let largest = dependences.max_by_key(|dependence| dependence.pixels.count);
    if let Some(warning) = largest.and_then(|largest| given.march_warning(largest)) {
        terminal.warn(warning);
    }
    let mut files = vec![(SOLUTION.to_owned(), text)];
    for (index, (expected, frame)) in expected.iter().zip(&frames).enumerate() {
        files.push(thumbnail(index, expected, frame)?);
    }
    files.push((FILE_NAME.to_owned(), model.assignment(SOLUTION).into_bytes()));
    Ok(files)
}

/// The files of an assignment whose reference is a scene.
fn from_scene(args: &AssignmentArgs, terminal: &Terminal) -> Result<NewFiles, CliError> {
    let text = read_scene(&args.from)?;
    let content = text.text().as_bytes().to_vec();
    let scene = parse_scene(text)?;
    let mut files = vec![(SCENE.to_owned(), content)];
    match scene::export::shader(&scene) {
        Ok(solution) => files.push((SOLUTION.to_owned(), solution.into_bytes())),
        Err(error) => terminal.warn(format_args!("there is no {SOLUTION}: {error}")),
    }
    let model = Model::Scene {
        is_animated: !scene.motions.is_empty(),
    };
    for (index, mut frame) in load(&model)?.into_iter().enumerate() {
        frame.size = scene.film.size;
        let expected = Expected::from_scene(scene.clone(), &frame);
        files.push(thumbnail(index, &expected, &frame)?);
    }
    files.push((FILE_NAME.to_owned(), model.assignment(SCENE).into_bytes()));
    Ok(files)
}

/// The frames of a new assignment, which have no files.
fn load(model: &Model) -> Result<Vec<image::Frame>, CliError> {
    let frames = model.frames().into_iter();
    frames.map(|inputs| Ok(inputs.load()?)).collect()
}

/// The image of a frame, as students should see it.
fn thumbnail(index: usize, expected: &Expected, frame: &image::Frame) -> Result<(String, Vec<u8>), CliError> {
    let name = frame_name(index);
    let bytes = image::encode(&expected.image(frame)?, name.as_ref())?;
    Ok((name, bytes))
}

/// Quotes a file name for a shell, if it has spaces.
fn quoted(name: &str) -> String {
    if name.contains(' ') {
        format!("\"{name}\"")
    } else {
        name.to_owned()
    }
}
