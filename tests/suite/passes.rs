//! Projects with several passes: the answers of `tests/passes`, on the evaluator in both precisions and by
//! the driver, and faults that the answers reveal.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde_json::Value;
use toyproof::diagnostic::{File, Files};
use toyproof::eval::{Number, Settings};
use toyproof::glsl::{self, Checked, Filter, Stage, Wrap};
use toyproof::gpu::Worker;
use toyproof::image::{Frame, Texture};
use toyproof::player::{Clock, Graph, Target};
use toyproof::project::{PassKind, Project, Rendering, Tab, check};
use toyproof::translate::FloatMode;
use toyproof::verify::project::playback::{CpuPlayback, DevicePlayback, PassShader};

use crate::requirements::require_worker;

const TIMEOUT: Duration = Duration::from_secs(60);

/// What a pass holds after a frame.
struct Expected {
    frame: i32,
    pass: PassKind,
    size: [u32; 2],
    /// Position, and components: none where they are open.
    texels: Vec<([u32; 2], [Option<f64>; 4])>,
    tolerance: f64,
}

/// A project that ShaderToy renders.
struct Case {
    name: String,
    project: Project,
    passes: Vec<Checked>,
    expected: Vec<Expected>,
}

fn folders() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/passes");
    let entries = fs::read_dir(root).unwrap().map(|entry| entry.unwrap().path());
    let mut folders: Vec<_> = entries.filter(|path| path.is_dir()).collect();
    folders.sort();
    folders
}

/// Reads a folder: the project, or the tabs for which it is refused, and those that have errors.
fn read(folder: &Path) -> Result<Case, (Vec<String>, Vec<String>)> {
    let name = folder.file_name().unwrap().to_string_lossy().into_owned();
    let json = fs::read_to_string(folder.join("expect.json")).unwrap();
    let entries: Vec<Value> = serde_json::from_str(&json).unwrap();
    let mut files = Files::default();
    let text = fs::read_to_string(folder.join("project.json")).unwrap();
    let file = files.add(File::new(name.clone(), text));
    let project = Project::from_json(&mut files, file).unwrap();
    let checked = check(&project, &mut files, &glsl::Options::default());
    if let Some(refused) = entries[0]["refused"].as_str() {
        let errors = checked.err().map(Vec::from).unwrap_or_default();
        let places = errors
            .iter()
            .filter_map(|error| Some(files.name(error.span?).to_owned()));
        return Err((vec![refused.to_owned()], places.collect()));
    }
    let passes = match checked {
        Ok(checked) => checked.passes.into_iter().map(|pass| pass.checked).collect(),
        Err(errors) => panic!("{name}: {}", errors.first().unwrap().message),
    };
    Ok(Case {
        name,
        project,
        passes,
        expected: entries.iter().map(expected).collect(),
    })
}

fn expected(entry: &Value) -> Expected {
    let number = |value: &Value| value.as_u64().unwrap() as u32;
    let component = |value: &Value| match value {
        Value::Null => None,
        Value::String(_) => Some(f64::NAN),
        number => number.as_f64(),
    };
    let pass = entry["pass"].as_str().unwrap();
    let is_named = |tab: &Tab| tab.name() == pass;
    let Some(Tab::Pass(pass)) = Tab::ALL.into_iter().find(is_named) else {
        panic!("no such pass: {pass}");
    };
    let texels = entry["texels"].as_array().unwrap().iter().map(|texel| {
        let color = [0, 1, 2, 3].map(|at| component(&texel[2][at]));
        ([number(&texel[0]), number(&texel[1])], color)
    });
    Expected {
        frame: entry["frame"].as_i64().unwrap() as i32,
        pass,
        size: [number(&entry["size"][0]), number(&entry["size"][1])],
        texels: texels.collect(),
        tolerance: entry["tolerance"].as_f64().unwrap(),
    }
}

fn cases() -> Vec<Case> {
    folders().iter().filter_map(|folder| read(folder).ok()).collect()
}

impl Case {
    /// Renders all that is needed for any answer.
    fn rendering(&self) -> Rendering {
        // A pass that the image does not read is there for its own sake.
        let kinds: Vec<PassKind> = self.expected.iter().map(|expected| expected.pass).collect();
        self.project.rendering(&kinds).unwrap()
    }

    fn shader<'a>(&'a self, rendering: &'a Rendering) -> PassShader<'a> {
        PassShader {
            checked: rendering.passes.iter().map(|&at| &self.passes[at]).collect(),
            graph: &rendering.graph,
            media: &rendering.media,
            films: rendering.films.clone(),
        }
    }

    fn clock(&self) -> Clock {
        Clock {
            inputs: Frame {
                size: self.expected[0].size,
                films: self.rendering().films,
                ..Frame::default()
            },
            rate: 60.0,
            start: 0.0,
        }
    }

    fn last_frame(&self) -> i32 {
        self.expected.iter().map(|expected| expected.frame).max().unwrap()
    }

    /// The passes that are expected after a frame.
    fn targets(&self, frame: i32) -> Vec<Target> {
        let now = self.expected.iter().filter(|expected| expected.frame == frame);
        now.map(|expected| expected.pass.target()).collect()
    }

    /// Renders on the evaluator, and returns what differs from the answers.
    fn faults<N: Number>(&self, rendering: &Rendering, clock: &Clock) -> Vec<String> {
        let shader = self.shader(rendering);
        let programs = shader.programs(TIMEOUT).unwrap();
        let mut playback = CpuPlayback::<N>::new(&shader, &programs, None, TIMEOUT, Settings::plain());
        let mut faults = Vec::new();
        for frame in 0..=self.last_frame() {
            playback.render(&clock.frame(frame)).unwrap();
            for expected in self.expected.iter().filter(|expected| expected.frame == frame) {
                match playback.texture(expected.pass.target()) {
                    Some(texture) => faults.extend(expected.difference(texture)),
                    None => faults.push(format!("{} is not rendered", expected.pass)),
                }
            }
        }
        faults
    }
}

impl Expected {
    fn difference(&self, texture: &Texture) -> Option<String> {
        let actual = |at: [u32; 2]| texture.texel(at);
        let agrees = |actual: f64, expected: Option<f64>| match expected {
            None => true,
            Some(expected) if expected.is_nan() => actual.is_nan(),
            // Minus zero is not zero.
            Some(expected) => {
                (actual - expected).abs() <= self.tolerance
                    && (expected != 0.0
                        || actual != 0.0
                        || actual.is_sign_negative() == expected.is_sign_negative())
            }
        };
        let wrong = self.texels.iter().find(|(at, color)| {
            let actual = actual(*at);
            !(0..4).all(|i| agrees(actual[i], color[i]))
        });
        let (at, color) = wrong?;
        Some(format!(
            "{} of frame {} at {at:?}: {:?}, not {color:?}",
            self.pass,
            self.frame,
            actual(*at)
        ))
    }
}

#[test]
fn every_answer_is_found_in_both_precisions() {
    let mut wrong = Vec::new();
    let cases = cases();
    assert!(cases.len() > 40, "{} projects", cases.len());
    for case in &cases {
        let (rendering, clock) = (case.rendering(), case.clock());
        let faults = case
            .faults::<f32>(&rendering, &clock)
            .into_iter()
            .chain(case.faults::<f64>(&rendering, &clock));
        wrong.extend(faults.map(|fault| format!("{}: {fault}", case.name)));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_site_refuses_what_it_refuses() {
    for folder in folders() {
        if let Err((refused, errors)) = read(&folder) {
            for tab in refused {
                let name = format!("{tab}.glsl");
                assert!(
                    errors.iter().any(|error| error.contains(&name)),
                    "{}: {tab}: {errors:?}",
                    folder.display()
                );
            }
        }
    }
}

#[test]
fn the_driver_has_the_same_bits_in_every_pass() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let wrong: Vec<String> = cases()
        .iter()
        .filter_map(|case| differs(case, &mut worker))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The first pass in which the driver differs from the evaluator, in at most 12 frames.
fn differs(case: &Case, worker: &mut Worker) -> Option<String> {
    let (rendering, clock) = (case.rendering(), case.clock());
    let shader = case.shader(&rendering);
    let programs = shader.programs(TIMEOUT).unwrap();
    let mut single = CpuPlayback::<f32>::new(&shader, &programs, None, TIMEOUT, Settings::plain());
    let mut device = DevicePlayback::open(worker, &shader, None, FloatMode::Strict, TIMEOUT).unwrap();
    for frame in 0..=case.last_frame().min(12) {
        let inputs = clock.frame(frame);
        single.render(&inputs).unwrap();
        let targets = case.targets(frame);
        let images = device.render(&inputs, &targets).unwrap();
        for (target, image) in targets.iter().zip(images) {
            let own = single.texture(*target).unwrap().stack();
            let bits = |pixels: &[[f32; 4]]| -> Vec<u32> {
                // The payload of NaN is open.
                let components = pixels.iter().flatten();
                components
                    .map(|component| {
                        if component.is_nan() {
                            u32::MAX
                        } else {
                            component.to_bits()
                        }
                    })
                    .collect()
            };
            if bits(own.pixels()) != bits(image.pixels()) {
                return Some(format!("{}: {target:?} of frame {frame}", case.name));
            }
        }
    }
    None
}

#[test]
fn a_state_goes_on_where_it_was_saved() {
    let all = cases();
    let case = all
        .iter()
        .find(|case| case.name == "discard-two-frames-back")
        .unwrap();
    let (rendering, clock) = (case.rendering(), case.clock());
    let shader = case.shader(&rendering);
    let programs = shader.programs(TIMEOUT).unwrap();
    let mut whole = CpuPlayback::<f32>::new(&shader, &programs, None, TIMEOUT, Settings::plain());
    let mut saved = None;
    for frame in 0..7 {
        whole.render(&clock.frame(frame)).unwrap();
        if frame == 3 {
            saved = Some(whole.state(frame));
        }
    }
    let mut resumed = CpuPlayback::<f32>::new(&shader, &programs, saved.as_ref(), TIMEOUT, Settings::plain());
    for frame in 4..7 {
        resumed.render(&clock.frame(frame)).unwrap();
    }
    assert_eq!(resumed.state(6), whole.state(6));
    let Some(mut worker) = require_worker() else {
        return;
    };
    let mut device =
        DevicePlayback::open(&mut worker, &shader, saved.as_ref(), FloatMode::Strict, TIMEOUT).unwrap();
    for frame in 4..7 {
        device.render(&clock.frame(frame), &[]).unwrap();
    }
    assert_eq!(device.state(&clock.frame(6)).unwrap(), whole.state(6));
}

/// A mistake of a player that the answers must reveal.
type Fault = (&'static str, fn(&mut Case, &mut Rendering, &mut Clock));

const FAULTS: [Fault; 8] = [
    ("buffers run from A to D", |_, rendering, _| {
        let mut order: Vec<usize> = (0..rendering.passes.len()).collect();
        let number = |&at: &usize| match rendering.graph.passes()[at].target {
            Target::Buffer(number) => number,
            Target::Image => usize::MAX,
        };
        order.sort_by_key(number);
        let passes = order.iter().map(|&at| rendering.graph.passes()[at]).collect();
        rendering.passes = order.iter().map(|&at| rendering.passes[at]).collect();
        rendering.graph = Graph::new(passes, rendering.graph.formats().clone());
    }),
    ("a missing buffer is unbound", |_, rendering, _| {
        let exists = rendering
            .graph
            .passes()
            .iter()
            .map(|pass| pass.target)
            .collect::<Vec<_>>();
        let mut passes = rendering.graph.passes().to_vec();
        for input in passes.iter_mut().flat_map(|pass| &mut pass.inputs) {
            let is_missing = |source| matches!(source, toyproof::player::Source::Buffer(number) if !exists.contains(&Target::Buffer(number)));
            *input = input.filter(|source| !is_missing(*source));
        }
        rendering.graph = Graph::new(passes, rendering.graph.formats().clone());
    }),
    ("every input has its own wrap", |case, _, _| {
        for (pass, checked) in case.project.passes.iter().zip(&mut case.passes) {
            for (sampling, input) in checked.sampling.iter_mut().zip(&pass.inputs) {
                sampling.wrap = input.as_ref().map_or(Wrap::Clamp, |input| input.sampler.wrap);
            }
        }
    }),
    ("every input has its own filter", |case, _, _| {
        for (pass, checked) in case.project.passes.iter().zip(&mut case.passes) {
            for (sampling, input) in checked.sampling.iter_mut().zip(&pass.inputs) {
                sampling.filter = input
                    .as_ref()
                    .map_or(Filter::Linear, |input| input.sampler.filter);
            }
        }
    }),
    ("no mipmaps are made", |_, rendering, _| {
        rendering.graph = Graph::new(rendering.graph.passes().to_vec(), Default::default());
    }),
    ("the alpha of buffers is 1", |case, _, _| {
        case.passes
            .iter_mut()
            .for_each(|checked| checked.stage = Stage::Image);
    }),
    ("iMouse.zw is plus zero", |_, _, clock| {
        clock.inputs.mouse = [0.0; 4];
    }),
    ("frames count from 1", |_, _, clock| {
        clock.start = 1.0 / clock.rate;
    }),
];

#[test]
fn planted_faults_of_the_player_are_revealed() {
    let mut revealed: BTreeMap<&str, usize> = FAULTS.iter().map(|(name, _)| (*name, 0)).collect();
    for (name, plant) in FAULTS {
        for mut case in cases() {
            let (mut rendering, mut clock) = (case.rendering(), case.clock());
            plant(&mut case, &mut rendering, &mut clock);
            if !case.faults::<f32>(&rendering, &clock).is_empty() {
                *revealed.get_mut(name).unwrap() += 1;
            }
        }
    }
    let missed: Vec<_> = revealed.iter().filter(|(_, projects)| **projects == 0).collect();
    assert!(missed.is_empty(), "{missed:?}");
}
