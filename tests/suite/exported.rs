//! Random scenes, each rendered by its exported shader: the tracer, the front end and the evaluator must
//! agree on all of them.

use std::fmt::Write as _;

use toyproof::diagnostic::{File, Files};
use toyproof::explain::known::Diagnosis;
use toyproof::scene;
use toyproof::scene::export;
use toyproof::verify::{Expected, Verdict};

use crate::support::{Exercise, check_and_name_on_cpu, check_exercise_with, frame, numbers, scene as parsed};

/// The number of scenes, each in one of the sizes. With `EXPORTED_SCENES`, that many are tested in all sizes.
const SCENES: u32 = 100;

const SIZES: [[u32; 2]; 4] = [[96, 54], [97, 55], [80, 80], [54, 96]];

/// One in this many scenes has round numbers, which put edges on pixel centers.
const ROUND: u32 = 5;

/// Random numbers by a linear congruential generator (Knuth's MMIX).
struct Random {
    state: u64,
    /// Numbers are multiples of the reciprocal.
    steps: f64,
}

impl Random {
    fn number(&mut self) -> f64 {
        self.state = self
            .state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.state >> 40) as f64 / f64::from(1 << 24)
    }

    /// With three digits, or a multiple of one half.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        let number = low + (high - low) * self.number();
        ((number * self.steps).round() / self.steps).clamp(low, high)
    }

    fn triple(&mut self, low: [f64; 3], high: [f64; 3]) -> String {
        let [x, y, z] = [0, 1, 2].map(|i| self.between(low[i], high[i]));
        format!("[{x:?}, {y:?}, {z:?}]")
    }

    fn color(&mut self) -> String {
        self.triple([0.1; 3], [1.0; 3])
    }

    fn one<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[(self.number() * of.len() as f64) as usize]
    }

    /// A material with one of the models, checkered or not.
    fn material(&mut self, models: &[&str]) -> String {
        let (model, color) = (self.one(models), self.color());
        let own = match model {
            "glossy" => format!(", exponent = {:?}", self.between(1.0, 60.0)),
            "glass" => {
                let (ior, fresnel) = (self.between(1.1, 2.0), self.one(&["exact", "schlick"]));
                format!(", ior = {ior:?}, fresnel = \"{fresnel}\"")
            }
            "disney" => {
                let shares = [
                    "metallic",
                    "subsurface",
                    "specular",
                    "specular_tint",
                    "anisotropic",
                    "sheen",
                    "sheen_tint",
                ];
                let more = ["clearcoat", "clearcoat_gloss"];
                let shares = shares.iter().chain(&more);
                let shares: Vec<String> = shares
                    .map(|share| format!(", {share} = {:?}", self.between(0.0, 1.0)))
                    .collect();
                format!("{}, roughness = {:?}", shares.concat(), self.between(0.2, 1.0))
            }
            _ => String::new(),
        };
        let pattern = if self.chance(0.25) {
            self.pattern()
        } else {
            String::new()
        };
        format!("material = {{ model = \"{model}\", color = {color}{own}{pattern} }}\n")
    }

    /// A key of a material: mostly checkers, in the coordinates of the scene or of the surface.
    fn pattern(&mut self) -> String {
        let (other, size) = (self.color(), self.between(0.3, 1.1));
        let space = if self.chance(0.4) {
            ", space = \"object\""
        } else {
            ""
        };
        if self.chance(0.6) {
            return format!(", checker = {{ color = {other}, size = {size:?}{space} }}");
        }
        let direction = self.triple([0.2, -1.0, -1.0], [1.0; 3]);
        format!(", stripes = {{ color = {other}, size = {size:?}, direction = {direction}{space} }}")
    }

    /// The keys of a camera that looks at the surfaces, or along −z.
    fn camera(&mut self) -> String {
        let mut text = "[camera]\n".to_owned();
        if self.chance(0.5) {
            let eye = self.triple([-3.0, -0.5, -1.0], [3.0, 3.0, 1.0]);
            let target = self.triple([-1.0, -0.5, -8.0], [1.0, 0.5, -6.0]);
            let _ = writeln!(text, "eye = {eye}\nlook_at = {target}");
            if self.chance(0.3) {
                let up = self.triple([-0.5, 0.5, -0.5], [0.5, 1.0, 0.5]);
                let _ = writeln!(text, "up = {up}");
            }
        }
        if self.chance(0.4) {
            let _ = writeln!(text, "roll = {:?}", self.between(-180.0, 180.0));
        }
        if self.chance(0.4) {
            text + "projection = \"parallel\"\nwidth = 5.0\n"
        } else {
            text + &format!("fov = {:?}\n", self.between(30.0, 80.0))
        }
    }

    /// A table of a box, without its material.
    fn cuboid(&mut self) -> String {
        let center = self.triple([-2.0, -0.8, -9.0], [2.0, 1.2, -5.0]);
        let size = self.triple([0.3; 3], [1.8; 3]);
        let rotation = if self.chance(0.5) {
            let axis = self.triple([-1.0, 0.3, -1.0], [1.0; 3]);
            format!("axis = {axis}\nangle = {:?}\n", self.between(-180.0, 180.0))
        } else {
            String::new()
        };
        format!("[[box]]\ncenter = {center}\nsize = {size}\n{rotation}")
    }

    /// One of the motions, or none.
    fn motion(&mut self, motions: u32) -> String {
        if motions == 0 || self.chance(0.4) {
            return String::new();
        }
        let which = (self.number() * f64::from(motions)) as u32;
        format!("motion = \"m{which}\"\n")
    }

    /// A table of a quadric, without its material.
    fn quadric(&mut self) -> String {
        let place = self.triple([-2.0, -0.6, -9.0], [2.0, 1.2, -5.0]);
        let axis = self.triple([-1.0, 0.3, -1.0], [1.0, 1.0, 1.0]);
        let (radius, height) = (self.between(0.3, 0.9), self.between(0.4, 1.6));
        let round = |table: &str, at: &str| {
            format!("[[{table}]]\n{at} = {place}\naxis = {axis}\nradius = {radius:?}\nheight = {height:?}\n")
        };
        match (self.number() * 5.0) as u32 {
            0 => {
                let radii = self.triple([0.3; 3], [1.0; 3]);
                format!("[[ellipsoid]]\ncenter = {place}\nradii = {radii}\n")
            }
            1 => round("cylinder", "base"),
            2 => round("cone", "apex"),
            3 => round("paraboloid", "apex"),
            _ => format!("{}waist = {:?}\n", round("hyperboloid", "center"), 0.5 * radius),
        }
    }

    /// A table of a figure on the screen.
    fn figure(&mut self) -> String {
        let (x, y) = (self.between(-0.8, 0.8), self.between(-0.4, 0.4));
        let (size, color) = (self.between(0.05, 0.3), self.color());
        let outline = match (self.number() * 3.0) as u32 {
            0 => format!("\"disk\"\ncenter = [{x:?}, {y:?}]\nradius = {size:?}"),
            1 => format!("\"heart\"\ncenter = [{x:?}, {y:?}]\nsize = {size:?}"),
            _ => format!("\"wave\"\nheight = -0.45\namplitude = {size:?}\nfrequency = 7.0"),
        };
        format!("[[figure]]\noutline = {outline}\ncolor = {color}\n")
    }

    fn chance(&mut self, share: f64) -> bool {
        self.number() < share
    }
}

fn random_scene(seed: u32) -> String {
    let mut random = Random {
        state: u64::from(seed) + 1,
        steps: if seed % ROUND == ROUND - 1 { 2.0 } else { 1000.0 },
    };
    for _ in 0..8 {
        random.number();
    }
    let random = &mut random;
    let traces_paths = random.chance(0.15);
    let is_soft = !traces_paths && random.chance(0.2);
    let mut text = vec![format!("title = \"Scene {seed}\"\n")];
    if !traces_paths {
        text.push(format!("ambient = {}\n", random.triple([0.0; 3], [0.3; 3])));
    }
    text.push(format!(
        "[film]\nmax_depth = {}\n",
        1 + (random.number() * 4.0) as u32
    ));
    if traces_paths || is_soft || random.chance(0.3) {
        text.push("samples = 3\nsampler = \"independent\"\n".to_owned());
    }
    if traces_paths {
        text.push("integrator = \"path\"\n".to_owned());
    }
    if random.chance(0.3) {
        text.push("tone_map = \"reinhard\"\n".to_owned());
    }
    if random.chance(0.3) {
        text.push("gamma = 2.2\n".to_owned());
    }
    if random.chance(0.4) {
        text.push(random.camera());
    }
    text.push(if random.chance(0.5) {
        format!("[background]\ncolor = {}\n", random.color())
    } else {
        let (bottom, top) = (random.color(), random.color());
        format!("[background]\nbottom = {bottom}\ntop = {top}\n")
    });
    let motions = if random.chance(0.3) { 3 } else { 0 };
    for index in 0..motions {
        text.push(random_motion(random, index));
    }
    if !traces_paths {
        for _ in 0..(random.number() * 3.0) as u32 {
            text.push(random_light(random, is_soft) + &random.motion(motions));
        }
    }
    text.extend(random_surfaces(random, motions, traces_paths));
    if random.chance(0.2) {
        for _ in 0..=(random.number() * 2.0) as u32 {
            text.push(random.figure());
        }
    }
    text.concat()
}

fn random_motion(random: &mut Random, index: u32) -> String {
    let pivot = random.triple([-1.0, -1.0, -8.0], [1.0, 1.0, -6.0]);
    let axis = random.triple([-1.0, 0.3, -1.0], [1.0, 1.0, 1.0]);
    let period = if random.chance(0.5) {
        format!("seconds = {:?}", random.between(2.0, 9.0))
    } else {
        format!("frames = {:?}", -random.between(30.0, 300.0))
    };
    let within = if index > 0 && random.chance(0.5) {
        format!("within = \"m{}\"\n", index - 1)
    } else {
        String::new()
    };
    format!("[[motion]]\nname = \"m{index}\"\npivot = {pivot}\naxis = {axis}\n{period}\n{within}")
}

fn random_light(random: &mut Random, is_soft: bool) -> String {
    let place = random.triple([-6.0, 2.0, -4.0], [6.0, 8.0, 3.0]);
    let color = random.triple([0.1; 3], [0.6; 3]);
    let shadow = random.chance(0.7);
    let radius = if is_soft && random.chance(0.7) {
        format!("radius = {:?}\n", random.between(0.1, 1.2))
    } else {
        String::new()
    };
    format!("[[light]]\nposition = {place}\ncolor = {color}\nshadow = {shadow}\n{radius}")
}

fn random_surfaces(random: &mut Random, motions: u32, traces_paths: bool) -> Vec<String> {
    let mut text = Vec::new();
    let all = [
        "lambert", "facing", "diffuse", "mirror", "emitter", "glossy", "disney", "glass",
    ];
    let models: &[&str] = if traces_paths {
        &["diffuse", "glossy", "mirror"]
    } else {
        &all[..[1, 3, 4, 6, 7, 8][(random.number() * 6.0) as usize]]
    };
    // Glass needs a closed shape, and emitters of path-traced scenes are spheres.
    let closed = |random: &mut Random| {
        if traces_paths && random.chance(0.3) {
            let color = random.triple([1.0; 3], [9.0; 3]);
            let pattern = if random.chance(0.3) {
                random.pattern()
            } else {
                String::new()
            };
            format!("material = {{ model = \"emitter\", color = {color}{pattern} }}\n")
        } else {
            random.material(models)
        }
    };
    let open: Vec<&str> = models.iter().copied().filter(|model| *model != "glass").collect();
    for _ in 0..(random.number() * 6.0) as u32 {
        let center = random.triple([-2.5, -0.8, -10.0], [2.5, 1.5, -4.5]);
        let radius = random.between(0.3, 1.2);
        let material = closed(random);
        let motion = random.motion(motions);
        text.push(format!(
            "[[sphere]]\ncenter = {center}\nradius = {radius:?}\n{material}{motion}"
        ));
    }
    if random.chance(0.4) {
        let material = random.material(&open);
        let motion = if random.chance(0.3) {
            random.motion(motions)
        } else {
            String::new()
        };
        text.push(format!("[[plane]]\npoint = [0.0, -1.5, 0.0]\n{material}{motion}"));
    }
    if random.chance(0.4) {
        for _ in 0..=(random.number() * 2.0) as u32 {
            text.push(random.quadric() + &random.material(&open) + &random.motion(motions));
        }
    }
    if random.chance(0.5) {
        for _ in 0..=(random.number() * 3.0) as u32 {
            text.push(random.cuboid() + &random.material(models) + &random.motion(motions));
        }
    }
    if random.chance(0.1) {
        let material = random.material(&open);
        let corner = random.triple([-2.0, -1.0, -9.0], [0.0, 0.0, -8.0]);
        text.push(format!(
            "[[scatter]]\ncorner = {corner}\ncells = [3, 2, 2]\nspacing = 0.9\nradius = [0.1, 0.4]\n{material}"
        ));
    }
    text
}

fn exported(text: &str) -> Result<String, String> {
    let mut files = Files::default();
    let file = files.add(File::new("<scene>", text));
    export::shader(&scene::parse(&files, file).unwrap()).map_err(|error| error.to_string())
}

#[test]
fn random_scenes_and_their_shaders_agree() {
    let count = std::env::var("EXPORTED_SCENES").ok();
    let is_sweep = count.is_some();
    let count = count.map_or(SCENES, |count| count.parse().unwrap());
    let (mut failed, mut ill_conditioned) = (Vec::new(), 0);
    for seed in 0..count {
        let scene: &'static str = Box::leak(random_scene(seed).into_boxed_str());
        let shader: &'static str = Box::leak(exported(scene).unwrap().into_boxed_str());
        let sizes = SIZES.iter().enumerate();
        let sizes = sizes.filter(|(at, _)| is_sweep || *at == seed as usize % SIZES.len());
        for (_, &size) in sizes {
            let exercise = Exercise {
                name: "exported",
                shader,
                scene,
                frame: 37,
                time: 1.3,
                size,
            };
            // By the evaluator alone: Mesa 22.3 compiles the shaders of some scenes, such as the fourth, for
            // minutes.
            let findings = check_exercise_with(None, shader, &exercise);
            let expected = Expected::from_scene(parsed(&exercise), &frame(&exercise, size));
            let is_reported = expected.conditioning().is_some();
            ill_conditioned += u32::from(is_reported);
            let is_right = findings.verdict == Verdict::Correct
                || is_reported && matches!(findings.verdict, Verdict::Inconclusive | Verdict::Unstable);
            if !is_right {
                let [width, height] = size;
                failed.push(format!(
                    "{seed} at {width}x{height}: {}\n{scene}\n{shader}",
                    numbers(&findings)
                ));
            }
        }
    }
    assert!(
        failed.is_empty(),
        "{} failed ({ill_conditioned} are ill-conditioned):\n{}",
        failed.len(),
        failed.join("\n")
    );
}

/// A turned camera, a turned box, and patterns of both kinds in the coordinates of their surfaces.
const TURNED: &str = r#"
[camera]
eye = [1.0, 0.8, 1.0]
look_at = [0.1, 0.0, -6.0]
roll = 20.0
fov = 50.0
[[light]]
position = [9.0, 9.0, 5.0]
[[box]]
center = [-0.8, 0.2, -6.0]
size = [1.5, 1.2, 1.0]
axis = [0.2, 1.0, 0.0]
angle = 30.0
material = { model = "lambert", color = [0.9, 0.4, 0.2], checker = { color = [0.2, 0.3, 0.4], size = 0.3, space = "object" } }
[[sphere]]
center = [1.2, 0.0, -6.5]
radius = 1.0
material = { model = "lambert", color = [0.2, 0.4, 0.9], stripes = { color = [0.9, 0.9, 0.6], size = 0.3, direction = [1.0, 2.0, 0.0], space = "object" } }
"#;

#[test]
fn mistakes_in_cameras_boxes_and_patterns_are_named() {
    let shader: &'static str = Box::leak(exported(TURNED).unwrap().into_boxed_str());
    let exercise = Exercise {
        name: "turned",
        shader,
        scene: TURNED,
        frame: 0,
        time: 0.0,
        size: [160, 90],
    };
    let mistakes = [
        ("radians(20.0)", "-radians(20.0)", "roll-reversed"),
        ("cross(forward, ", "cross(-forward, ", "camera-cross-swapped"),
        ("- eye)", ")", "look-at-as-direction"),
        (
            "max(near.x, max(near.y, near.z))",
            "min(near.x, min(near.y, near.z))",
            "box-entered-at-first-slab",
        ),
        ("sign(p) * face", "-sign(p) * face", "box-normal-inward"),
        (
            "box.axes * (sign(p) * face)",
            "sign(p) * face",
            "box-normal-in-local-space",
        ),
        (
            "float side = pattern.side",
            "float side = 0.5 * pattern.side",
            "pattern-too-small",
        ),
        (
            "? color : pattern.other",
            "? pattern.other : color",
            "pattern-colors-swapped",
        ),
    ];
    let mut wrong = Vec::new();
    for (from, to, expected) in mistakes {
        assert_eq!(shader.matches(from).count(), 1, "{from}");
        let findings = check_and_name_on_cpu(&shader.replace(from, to), &exercise);
        let name = findings.mistake.as_ref().map_or_else(String::new, Diagnosis::id);
        if name != expected {
            wrong.push(format!(
                "{to}: {name} instead of {expected}: {}",
                numbers(&findings)
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn exported_shaders_hold_only_what_their_scene_requires() {
    let bare = exported("[background]\n").unwrap();
    for word in [
        "Sphere",
        "Light",
        "makeScene",
        "Intersection",
        "random",
        "SAMPLES",
        "AMBIENT",
        "pow",
    ] {
        assert!(!bare.contains(word), "{word} in\n{bare}");
    }
    let sphere = "[[sphere]]\ncenter = [0, 0, -6]\nradius = 1.5\nmaterial = { model = \"facing\", color = [1, 1, 0] }\n";
    let one = exported(sphere).unwrap();
    assert!(one.contains("intersectSphere"));
    for word in ["Plane", "Light", "model", "MAX_DEPTH", "shade(", "AMBIENT"] {
        assert!(!one.contains(word), "{word} in\n{one}");
    }
    for word in [
        "Quadric",
        "Box",
        "checkered",
        "Pattern",
        "patterned",
        "forward",
        "figure",
        "rotate",
        "PI",
        "brdf",
    ] {
        assert!(!one.contains(word), "{word} in\n{one}");
    }
    let refused = exported("[film]\nsamples = 4\nsampler = \"sobol\"\n[background]\n");
    assert_eq!(
        refused,
        Err("a scene with the sampler `stratified` or `sobol` cannot be exported".to_owned())
    );
}
