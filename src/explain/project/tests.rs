use std::time::Duration;

use toyproof_diagnostic::{File, FileId, Files};
use toyproof_glsl::{self as glsl, Checked, Stage};
use toyproof_image::{Frame, MovingTextures};
use toyproof_lint::Lints;
use toyproof_player::{Graph, Pass, Source, Target};
use toyproof_verify::project::bind::{bind_reference, clock};
use toyproof_verify::project::playback::PassShader;
use toyproof_verify::{DEFAULT_TOLERANCE, Expected, ShaderReference};

use super::{Project, ProjectCase, ProjectExplanation, explain};

const TIMEOUT: Duration = Duration::from_secs(60);

/// Common, Buffer A, which reads itself, and the image, which shows it.
#[derive(Clone, Copy)]
struct Texts<'a> {
    common: &'a str,
    buffer: &'a str,
    image: &'a str,
}

/// A project of these texts.
struct Compiled {
    files: Files,
    tabs: [FileId; 2],
    checked: [Checked; 2],
    graph: Graph,
}

impl Compiled {
    fn of(texts: Texts) -> Self {
        let mut files = Files::default();
        let common = files.add(File::new("common.glsl", texts.common));
        let tabs = [("buffer-a.glsl", texts.buffer), ("image.glsl", texts.image)]
            .map(|(name, text)| files.add(File::new(name, text)));
        let joined = tabs.map(|tab| files.join("joined", &[common, tab]));
        let stages = [(joined[0], Stage::Buffer), (joined[1], Stage::Image)];
        let checked = stages.map(|(file, stage)| {
            let options = glsl::Options {
                stage,
                ..glsl::Options::default()
            };
            glsl::check(&files, file, &options).unwrap()
        });
        let inputs = [Some(Source::Buffer(0)), None, None, None];
        let passes = [Target::Buffer(0), Target::Image].map(|target| Pass { target, inputs });
        Self {
            files,
            tabs,
            checked,
            graph: Graph::new(passes.to_vec(), Default::default()),
        }
    }

    fn shader(&self) -> PassShader<'_> {
        PassShader {
            checked: self.checked.iter().collect(),
            graph: &self.graph,
            media: &[],
            films: MovingTextures::default(),
        }
    }
}

/// The explanation of a project in frame 6, and the file and the line of its first repair.
fn explained(own: Texts, reference: Texts) -> Option<(ProjectExplanation, Option<(String, usize)>)> {
    let (own, reference) = (Compiled::of(own), Compiled::of(reference));
    let (shader, solution) = (own.shader(), reference.shader());
    let first = Frame {
        size: [40, 24],
        ..Frame::default()
    };
    let frame = clock(&first).frame(6);
    let mut bound = frame.clone();
    bind_reference(&solution, &mut bound, TIMEOUT).unwrap();
    let image = &reference.checked[1];
    let expected = ShaderReference::new(image, &Lints::default(), &bound, DEFAULT_TOLERANCE, TIMEOUT);
    let case = ProjectCase {
        project: Project {
            shader: &shader,
            files: &own.files,
            tabs: &own.tabs,
        },
        reference: Project {
            shader: &solution,
            files: &reference.files,
            tabs: &reference.tabs,
        },
        expected: &Expected::Shader(Box::new(expected.unwrap().0)),
        frame: &frame,
        budget: 2.0,
        value_images: false,
        pool: None,
    };
    let explanation = explain(&case)?;
    let repairs = explanation.search.as_ref().map(|search| &search.repairs[..]);
    let repair = repairs.and_then(|repairs| {
        let edit = repairs.first()?.fix.edits.first()?;
        let file = own.files.name(edit.span).to_owned();
        Some((file, own.files.position(edit.span).line))
    });
    Some((explanation, repair))
}

/// Asserts that `wrong` in place of `right` in the reference is found: where it departs, and a repair of that
/// line.
#[track_caller]
fn is_repaired(reference: Texts, [right, wrong]: [&str; 2], departs: (Target, i32)) {
    let tabs = [
        ("common.glsl", reference.common),
        ("buffer-a.glsl", reference.buffer),
        ("image.glsl", reference.image),
    ];
    let (name, text) = tabs.into_iter().find(|(_, text)| text.contains(right)).unwrap();
    let line = 1 + text[..text.find(right).unwrap()].matches('\n').count();
    let [common, buffer, image] = tabs.map(|(_, text)| text.replacen(right, wrong, 1));
    let own = Texts {
        common: &common,
        buffer: &buffer,
        image: &image,
    };
    let (explanation, repair) = explained(own, reference).unwrap();
    let departure = explanation.departure;
    assert_eq!((departure.pass, departure.frame), departs, "{explanation:?}");
    let (file, at) = repair.unwrap_or_else(|| panic!("{:?}", explanation.search));
    assert_eq!((file.as_str(), at), (name, line));
}

/// Shows Buffer A.
const SHOWN: &str = "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0); }";

const BUFFER: Target = Target::Buffer(0);

#[test]
fn a_wrong_sign_in_the_update() {
    let flow = Texts {
        common: "",
        buffer: "
vec4 cell(ivec2 p) { return texelFetch(iChannel0, clamp(p, ivec2(0), ivec2(iResolution.xy) - 1), 0); }
void mainImage(out vec4 c, in vec2 p) {
    ivec2 q = ivec2(p);
    float x = cell(q).x;
    float sum = cell(q + ivec2(1, 0)).x + cell(q - ivec2(1, 0)).x + cell(q + ivec2(0, 1)).x + cell(q - ivec2(0, 1)).x;
    x = x + 0.2 * (sum - 4.0 * x);
    if (iFrame == 0) x = 0.5 + 0.5 * sin(0.7 * p.x) * cos(0.4 * p.y);
    c = vec4(x, 0.0, 0.0, 1.0);
}",
        image: SHOWN,
    };
    is_repaired(flow, ["x + 0.2", "x - 0.2"], (BUFFER, 1));
}

#[test]
fn a_mistake_of_the_image() {
    let stripes = Texts {
        common: "",
        buffer: "
void mainImage(out vec4 c, in vec2 p) {
    float x = texelFetch(iChannel0, ivec2(p), 0).x;
    c = vec4(iFrame == 0 ? p.x / 7.0 : x + 0.1);
}",
        image: "
void mainImage(out vec4 c, in vec2 p) {
    float x = texelFetch(iChannel0, ivec2(p), 0).x;
    c = vec4(vec3(0.2, 0.5, 0.9) * fract(x), 1.0);
}",
    };
    is_repaired(stripes, ["fract(x)", "x"], (Target::Image, 0));
}

#[test]
fn a_wrong_count_of_neighbors() {
    let life = Texts {
        common: "",
        buffer: "
float cell(ivec2 p) { return texelFetch(iChannel0, p, 0).x; }
void mainImage(out vec4 c, in vec2 p) {
    ivec2 q = ivec2(p);
    float n = 0.0;
    for (int i = 0; i < 9; i++) {
        if (i != 4) n += cell(q + ivec2(i % 3 - 1, i / 3 - 1));
    }
    c = vec4(n == 3.0 || n == 2.0 && cell(q) == 1.0 ? 1.0 : 0.0);
    if (iFrame == 0) c = vec4((q.x * q.x + 3 * q.y * q.x + q.y) % 5 < 2 ? 1.0 : 0.0);
}",
        image: SHOWN,
    };
    is_repaired(life, ["i / 3", "i % 3"], (BUFFER, 1));
    is_repaired(life, ["n == 2.0", "n == 4.0"], (BUFFER, 1));
}

/// An angle in alpha, which only the image shows.
const TURNED: Texts = Texts {
    common: "",
    buffer: "
void mainImage(out vec4 c, in vec2 p) {
    float angle = texelFetch(iChannel0, ivec2(p), 0).a;
    angle += 0.1 + 0.01 * p.y;
    if (iFrame == 0) angle = 0.3 * p.x;
    c = vec4(0.0, 0.0, 0.0, angle);
}",
    image: "
void mainImage(out vec4 c, in vec2 p) {
    float angle = texelFetch(iChannel0, ivec2(p), 0).a;
    c = vec4(0.5 + 0.5 * cos(angle), 0.5 + 0.5 * sin(angle), 0.0, 1.0);
}",
};

#[test]
fn a_state_in_alpha_and_beyond_the_range_of_colors() {
    is_repaired(TURNED, ["+ 0.01 * p.y", "- 0.01 * p.y"], (BUFFER, 1));
    let falling = Texts {
        common: "",
        buffer: "
void mainImage(out vec4 c, in vec2 p) {
    vec4 state = texelFetch(iChannel0, ivec2(p), 0);
    float height = state.x + 10.0 * state.y;
    float speed = state.y - 0.5;
    if (iFrame == 0) { height = 50.0 + p.y; speed = -p.x; }
    c = vec4(height, speed, 0.0, 1.0);
}",
        image: "
void mainImage(out vec4 c, in vec2 p) {
    c = vec4(fract(0.01 * texelFetch(iChannel0, ivec2(p), 0).xy), 0.0, 1.0);
}",
    };
    is_repaired(falling, ["- 0.5", "+ 0.5"], (BUFFER, 1));
}

#[test]
fn a_state_in_few_texels() {
    let ball = Texts {
        common: "",
        buffer: "
void mainImage(out vec4 c, in vec2 p) {
    vec4 ball = texelFetch(iChannel0, ivec2(0), 0);
    ball.xy += ball.zw;
    ball.w -= 0.5;
    if (iFrame == 0) ball = vec4(5.0, 12.0, 2.0, 1.5);
    c = ivec2(p) == ivec2(0) ? ball : vec4(0.0);
}",
        image: "
void mainImage(out vec4 c, in vec2 p) {
    vec2 ball = texelFetch(iChannel0, ivec2(0), 0).xy;
    c = vec4(vec3(exp(-0.1 * length(p - ball))), 1.0);
}",
    };
    is_repaired(ball, ["ball.w -= 0.5", "ball.w += 0.5"], (BUFFER, 1));
}

#[test]
fn a_mistake_of_common() {
    let grown = Texts {
        common: "float next(float x) {\n    return fract(1.7 * x + 0.1);\n}",
        buffer: "
void mainImage(out vec4 c, in vec2 p) {
    float x = texelFetch(iChannel0, ivec2(p), 0).x;
    c = vec4(iFrame == 0 ? p.x / 40.0 : next(x));
}",
        image: "
void mainImage(out vec4 c, in vec2 p) { c = vec4(next(texelFetch(iChannel0, ivec2(p), 0).x)); }",
    };
    is_repaired(grown, ["x + 0.1", "x - 0.1"], (Target::Image, 0));
}

#[test]
fn channels_that_nothing_reads_are_not_compared() {
    // Another alpha and another blue are no mistake; the angle of the image is.
    let buffer = TURNED.buffer.replace("0.0, 0.0, 0.0", "p.x, 7.0, 1.0");
    let image = TURNED.image.replace("0.5 * sin", "0.4 * sin");
    let own = Texts {
        buffer: &buffer,
        image: &image,
        ..TURNED
    };
    let (explanation, repair) = explained(own, TURNED).unwrap();
    assert_eq!(
        (explanation.departure.pass, explanation.departure.frame),
        (Target::Image, 0)
    );
    assert_eq!(repair.unwrap(), ("image.glsl".to_owned(), 4));
}

#[test]
fn passes_that_do_not_correspond_are_searched_in_the_whole_project() {
    // The angle is in degrees, and in red; its speed is wrong.
    let own = Texts {
        buffer: "
void mainImage(out vec4 c, in vec2 p) {
    float angle = texelFetch(iChannel0, ivec2(p), 0).r;
    angle += degrees(0.1 + 0.02 * p.y);
    if (iFrame == 0) angle = degrees(0.3 * p.x);
    c = vec4(angle, 0.0, 0.0, 1.0);
}",
        image: "
void mainImage(out vec4 c, in vec2 p) {
    float angle = radians(texelFetch(iChannel0, ivec2(p), 0).r);
    c = vec4(0.5 + 0.5 * cos(angle), 0.5 + 0.5 * sin(angle), 0.0, 1.0);
}",
        ..TURNED
    };
    let (explanation, repair) = explained(own, TURNED).unwrap();
    let departure = explanation.departure;
    assert_eq!((departure.pass, departure.frame), (Target::Image, 1));
    assert_eq!(repair.unwrap(), ("buffer-a.glsl".to_owned(), 4));
    let repair = &explanation.search.unwrap().repairs[0];
    assert!(repair.fix.message.contains("0.01"), "{}", repair.fix.message);
    // Right in every frame, whatever it holds.
    let buffer = own.buffer.replace("0.02", "0.01");
    let right = Texts {
        buffer: &buffer,
        ..own
    };
    assert!(explained(right, TURNED).is_none());
}
