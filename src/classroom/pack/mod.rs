//! What students get of an assignment: the images that their shaders have to render, a shader to begin with,
//! the tests of its functions, and the requirements. Nothing of the reference's text is in it, except the
//! signatures of functions that the assignment names.

mod starter;

use std::collections::{BTreeSet, HashMap};
use std::fmt::Write as _;
use std::path::Path;

use toyproof_diagnostic::{Date, grouped, plural};
use toyproof_image::{Channel, FrameInputs, input};
use toyproof_report::{Record, Rubric};
use toyproof_toml::Moment;

use self::starter::starter;
use crate::assignment::{Assignment, Rules};
use crate::collect::naming::{Paths, file_name};
use crate::function_test::{SUFFIX, Subject, test_file};

/// The file of the shader with which students begin.
pub const STARTER: &str = "shader.glsl";

/// The file with the requirements.
const README: &str = "README.md";

/// The file of the image of a frame, by its index.
#[must_use]
pub fn frame_name(index: usize) -> String {
    format!("frame-{}.png", index + 1)
}

/// A frame of an assignment, as students see it.
#[derive(Debug)]
pub struct PackedFrame {
    /// The inputs; the names of textures are those of files of the pack.
    pub inputs: FrameInputs,
    /// The size in pixels.
    pub size: [u32; 2],
    /// The name of the image.
    pub image: String,
    /// The bytes of the image.
    pub png: Vec<u8>,
}

/// The names and the contents of files.
pub type PackFiles = Vec<(String, Vec<u8>)>;

/// The textures of frames as files of the pack; their names replace the paths in the frames.
///
/// # Errors
/// A texture cannot be read.
pub fn pack_textures(frames: &mut [FrameInputs]) -> Result<PackFiles, String> {
    let images: Vec<String> = (0..frames.len()).map(frame_name).collect();
    let reserved = images.iter().map(String::as_str).chain([STARTER, README]);
    let mut names = Paths::with_reserved(&reserved.collect::<Vec<_>>());
    let mut known: HashMap<_, String> = HashMap::new();
    let mut files = Vec::new();
    for channel in frames.iter_mut().flat_map(|frame| &mut frame.channels).flatten() {
        let Channel::File(path) = channel else {
            continue;
        };
        if !known.contains_key(path) {
            let bytes = input::read(path).map_err(|error| error.to_string())?;
            let own = path.file_name().unwrap_or_default().to_string_lossy();
            let name = names.file(&[], &file_name(&own));
            files.push((name.clone(), bytes));
            known.insert(path.clone(), name);
        }
        *channel = Channel::File(Path::new(&known[path]).to_owned());
    }
    Ok(files)
}

/// The files for the students, apart from textures. `reference` has the signatures of functions; `commands`
/// check the shader in each frame.
#[must_use]
pub fn pack(
    name: &str,
    assignment: &Assignment,
    reference: Option<&Subject>,
    frames: Vec<PackedFrame>,
    commands: &[String],
) -> PackFiles {
    let uniforms = frames.iter().flat_map(|frame| &frame.inputs.uniforms);
    let uniforms: BTreeSet<&str> = uniforms.map(|uniform| uniform.name.as_str()).collect();
    let starter = starter(assignment, reference, &uniforms);
    let mut files = vec![(STARTER.to_owned(), starter.into_bytes())];
    let stem = STARTER.trim_end_matches(".glsl");
    if !assignment.functions.is_empty() {
        let tests = test_file(&assignment.functions);
        files.push((format!("{stem}{SUFFIX}"), tests.into_bytes()));
    }
    let readme = readme(name, assignment, &frames, commands);
    files.extend(frames.into_iter().map(|frame| (frame.image, frame.png)));
    // The last one: once it exists, the others do.
    files.push((README.to_owned(), readme.into_bytes()));
    files
}

/// The requirements, and how to check them.
fn readme(name: &str, assignment: &Assignment, frames: &[PackedFrame], commands: &[String]) -> String {
    let images = plural(frames.len() as u64, "this image", "these images");
    let mut text = format!("# {name}\n\nWrite a shader that renders {images}. Begin with `{STARTER}`.\n\n");
    text += "| image | size | inputs |\n|---|---|---|\n";
    for PackedFrame {
        inputs, size, image, ..
    } in frames
    {
        let [width, height] = size;
        let _ = writeln!(text, "| `{image}` | {width}×{height} | {} |", described(inputs));
    }
    let mut requirements = assignment.rules.as_ref().map_or_else(Vec::new, rules);
    if !assignment.functions.is_empty() {
        let names: Vec<_> = assignment
            .functions
            .iter()
            .map(|test| format!("`{}`", test.name))
            .collect();
        requirements.push(format!("These functions are tested: {}.", names.join(", ")));
    }
    if !assignment.permitted.is_empty() {
        let ids: Vec<_> = assignment
            .permitted
            .iter()
            .map(|one| format!("`{}`", one.id()))
            .collect();
        requirements.push(format!("These differences are permitted: {}.", ids.join(", ")));
    }
    if !requirements.is_empty() {
        let _ = writeln!(text, "\n## Requirements\n\n- {}", requirements.join("\n- "));
    }
    text += &points(assignment);
    if let Some(deadline) = assignment.deadline {
        let _ = write!(text, "\nThe submission is due at {}.\n", moment(deadline));
    }
    if let Some(late) = assignment.rubric.as_ref().and_then(Rubric::late_deduction) {
        let _ = write!(text, "\nA late submission loses {late}.\n");
    }
    let _ = write!(
        text,
        "\n## Check your shader\n\n```sh\n{}\n```\n\nThe images have 8 bits per color, so that a few pixels at edges \
         may differ although your shader is right.\n",
        commands.join("\n")
    );
    if !assignment.functions.is_empty() {
        let _ = writeln!(
            text,
            "The tests of functions are in `{}{SUFFIX}`.",
            STARTER.trim_end_matches(".glsl")
        );
    }
    text
}

/// The inputs that are not zero, by their names in ShaderToy.
fn described(inputs: &FrameInputs) -> String {
    let list = |numbers: &[f32]| {
        let numbers: Vec<_> = numbers.iter().map(f32::to_string).collect();
        format!("({})", numbers.join(", "))
    };
    let mut parts = Vec::new();
    if inputs.time != 0.0 {
        parts.push(format!("`iTime` = {}", inputs.time));
    }
    if inputs.frame != 0 {
        parts.push(format!("`iFrame` = {}", inputs.frame));
    }
    for (name, numbers) in [("iMouse", &inputs.mouse), ("iDate", &inputs.date)] {
        if *numbers != [0.0; 4] {
            parts.push(format!("`{name}` = {}", list(numbers)));
        }
    }
    for (index, channel) in inputs.channels.iter().enumerate() {
        if let Some(channel) = channel {
            let name = channel
                .file()
                .map_or(Channel::NOISE.into(), |path| path.to_string_lossy());
            parts.push(format!("`iChannel{index}` = `{name}`"));
        }
    }
    for uniform in &inputs.uniforms {
        let value = match &uniform.components[..] {
            [number] => number.to_string(),
            numbers => format!(
                "({})",
                numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")
            ),
        };
        parts.push(format!("`{}` = {value}", uniform.name));
    }
    parts.join(", ")
}

/// The rules, each in a sentence.
fn rules(rules: &Rules) -> Vec<String> {
    let list = |names: &[String]| {
        let names: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
        names.join(", ")
    };
    let mut sentences = Vec::new();
    if !rules.must_define.is_empty() {
        sentences.push(format!("The shader must define {}.", list(&rules.must_define)));
    }
    if !rules.must_not_call.is_empty() {
        sentences.push(format!(
            "The shader must not call {}.",
            list(&rules.must_not_call)
        ));
    }
    if !rules.textures {
        sentences.push("The shader must not read textures.".to_owned());
    }
    if let Some(max) = rules.max_lines {
        sentences.push(format!(
            "The shader may have {} lines, without blank lines and comments.",
            grouped(max.into())
        ));
    }
    sentences
}

/// The table of points; empty if there are none.
fn points(assignment: &Assignment) -> String {
    let Some(rubric) = &assignment.rubric else {
        return String::new();
    };
    let checks = rubric.marks(&Record::unchecked(String::new()));
    let checks = checks.into_iter().map(|mark| (mark.name.into_owned(), mark.of));
    let rules = assignment
        .rules
        .iter()
        .map(|rules| ("rules".to_owned(), rules.points));
    let functions = assignment.functions.iter();
    let functions = functions.map(|test| (format!("function `{}`", test.name), test.points));
    let features = assignment.features.iter();
    let features = features.map(|feature| (feature.name.clone(), feature.points));
    let rows: Vec<_> = checks
        .chain(rules)
        .chain(functions)
        .chain(features)
        .filter(|(_, points)| *points > 0.0)
        .collect();
    let total: f64 = rows.iter().map(|(_, points)| points).sum();
    let mut table = "\n## Points\n\n| for | points |\n|---|---|\n".to_owned();
    for (name, points) in rows {
        let _ = writeln!(table, "| {name} | {points} |");
    }
    let _ = writeln!(table, "| total | {total} |");
    table
}

/// A moment at its place: `2026-03-01 23:59 (UTC+01:00)`.
fn moment(moment: Moment) -> String {
    let local = moment.seconds + moment.offset;
    let minutes = local.rem_euclid(86_400) / 60;
    let offset = moment.offset.abs() / 60;
    let sign = if moment.offset < 0 { '-' } else { '+' };
    format!(
        "{} {:02}:{:02} (UTC{sign}{:02}:{:02})",
        Date::from_days_since_1970(local.div_euclid(86_400)),
        minutes / 60,
        minutes % 60,
        offset / 60,
        offset % 60,
    )
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use toyproof_diagnostic::{File, Files};
    use toyproof_glsl::{Dialect, Options, check};

    use super::*;

    const REFERENCE: &str = "\
// The secret of the solution.
struct Ray { vec3 origin; vec3 direction; };
struct Hit { bool found; Ray normal; float[2] depths; };
const float SECRET = 0.35;
float helper(float x) { return x * SECRET; }
Hit intersect(Ray ray, out float t, inout mat2 turn, int steps) {
    t = helper(1.0);
    return Hit(true, ray, float[2](t, t));
}
void prepare() {}
void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    float t;
    mat2 turn = mat2(1.0);
    prepare();
    Hit hit = intersect(Ray(vec3(0.0), vec3(1.0)), t, turn, 3);
    fragColor = vec4(hit.depths[0], t, iTime, SECRET);
}
";

    const ASSIGNMENT: &str = "\
reference = \"solution.glsl\"  # The secret of the file
deadline = 2026-03-01T23:59:00+01:00
[[frame]]
size = [4, 4]
time = 2
[rubric.algorithm]
points = 6
[rubric.late]
percent_per_day = 10
[rules]
must_define = [\"helper\"]
max_lines = 30
points = 1
[[function]]
name = \"shade\"
points = 2
after = \"prepare()\"
tests = [\"intersect(a, b, c, 1).found == true for float a in [0, 1]\"]
";

    /// The files of the assignment for this reference.
    fn packed(reference: &str, options: &Options) -> Vec<(String, String)> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("solution.glsl"), reference).unwrap();
        let mut files = Files::default();
        let file = files.add(File::new("assignment.toml", ASSIGNMENT));
        let assignment =
            Assignment::parse(&files, file, folder.path()).unwrap_or_else(|errors| panic!("{errors}"));
        let shader = files.add(File::new("solution.glsl", reference));
        let checked = check(&files, shader, options).unwrap_or_else(|errors| panic!("{errors}"));
        let subject = Subject {
            checked: &checked,
            files: &files,
            text: reference,
            timeout: Duration::from_secs(10),
        };
        let frame = PackedFrame {
            inputs: assignment.frames[0].clone(),
            size: [4, 4],
            image: "frame-1.png".to_owned(),
            png: Vec::new(),
        };
        let commands = ["toyproof check".to_owned()];
        let files = pack("week-3", &assignment, Some(&subject), vec![frame], &commands);
        files
            .into_iter()
            .map(|(name, bytes)| (name, String::from_utf8(bytes).unwrap()))
            .collect()
    }

    fn compiles(text: &str) -> Dialect {
        let mut files = Files::default();
        let file = files.add(File::new("shader.glsl", text));
        let checked = check(&files, file, &Options::default());
        checked
            .unwrap_or_else(|errors| panic!("{errors}\n{text}"))
            .dialect
    }

    #[test]
    fn a_pack_has_the_requirements_and_nothing_of_the_reference_but_signatures() {
        let files = packed(REFERENCE, &Options::default());
        let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(
            names,
            ["shader.glsl", "shader.test.toml", "frame-1.png", "README.md"]
        );
        for (name, text) in &files {
            for secret in ["SECRET", "secret", "0.35", "x *", "vec3(1.0)", "solution"] {
                assert!(!text.contains(secret), "{name}: {secret}\n{text}");
            }
        }
        let starter = &files[0].1;
        assert_eq!(compiles(starter), Dialect::ShaderToy);
        for part in [
            "// Define the function `shade` here.\n",
            "struct Ray {\n    vec3 origin;\n    vec3 direction;\n};\n",
            "float helper(float x) {\n    return 0.0;\n}\n",
            "Hit intersect(Ray ray, out float t, inout mat2 turn, int steps) {\n    t = 0.0;\n    \
             return Hit(false, Ray(vec3(0.0), vec3(0.0)), float[2](0.0, 0.0));\n}\n",
            "void prepare() {\n}\n",
        ] {
            assert!(starter.contains(part), "{part}\n{starter}");
        }
        let readme = &files[3].1;
        for part in [
            "# week-3\n",
            "| `frame-1.png` | 4×4 | `iTime` = 2 |",
            "- The shader must define `helper`.\n",
            "- The shader may have 30 lines, without blank lines and comments.\n",
            "| algorithm | 6 |\n| rules | 1 |\n| function `shade` | 2 |\n| total | 9 |\n",
            "due at 2026-03-01 23:59 (UTC+01:00)",
            "loses 10 % of all points for each day that has begun.",
            "```sh\ntoyproof check\n```",
        ] {
            assert!(readme.contains(part), "{part}\n{readme}");
        }
    }

    #[test]
    fn a_starter_has_the_dialect_of_the_reference() {
        for (reference, dialect) in [
            (
                "precision mediump float;\nuniform vec2 u_resolution;\nuniform float u_time;\n\
                 float helper(vec2 p) { return p.x; }\n\
                 void main() { gl_FragColor = vec4(helper(gl_FragCoord.xy / u_resolution) * u_time); }\n",
                Dialect::BookOfShaders,
            ),
            (
                "#version 300 es\nprecision highp float;\nuniform vec2 resolution;\nuniform float time;\n\
                 out vec4 color;\nvoid main() { color = vec4(gl_FragCoord.xy / resolution, time, 1.0); }\n",
                Dialect::GlslSandbox,
            ),
        ] {
            let files = packed(reference, &Options::default());
            assert_eq!(compiles(&files[0].1), dialect, "{}", files[0].1);
        }
    }
}
