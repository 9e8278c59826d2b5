//! The TOML of an assignment.

use std::path::{Path, PathBuf};

use toyproof_diagnostic::{Code, Diagnostics, FileId, Files, nearest};
use toyproof_glsl::UniformValue;
use toyproof_image::{Channel, Frame, FrameInputs};
use toyproof_project::{PassKind, Tab};
use toyproof_report::{Rubric, optional_points};
use toyproof_toml::{Format, Literal, Located, Moment, Table};
use toyproof_verify::{Difference, UnknownDifference};

use super::{Assignment, Feature, MAX_FRAMES, Reference, Rules};
use crate::function_test::{function_tests, is_identifier};

static FORMAT: Format = Format {
    form_code: Code::AssignmentSyntax,
    value_code: Code::AssignmentValue,
    aliases: &[],
};

/// The largest tolerance, in 8-bit levels.
const MAX_TOLERANCE: f64 = 255.0;

const PATHS: &str = "paths are relative to the folder of this file";

impl Assignment {
    /// Parses an assignment whose file lies in `folder`. The files that it names must exist.
    ///
    /// # Errors
    /// The first syntax error of the TOML, or all other errors.
    pub fn parse(files: &Files, file: FileId, folder: &Path) -> Result<Self, Diagnostics> {
        toyproof_toml::read(&FORMAT, files, file, |document| {
            let reference = reference(document, folder);
            let permitted = permitted(document);
            let deadline = document.optional::<Moment>("deadline");
            let mut frames = Vec::new();
            document.tables("frame", |table| {
                let frame = frame(table, folder);
                if frames.contains(&frame) && table.is_valid() {
                    table.reject(
                        table.span(),
                        "this frame is listed twice",
                        "remove one of the two",
                    );
                } else if frames.len() == MAX_FRAMES {
                    let message = format!("an assignment has at most {MAX_FRAMES} frames");
                    table.reject(table.span(), message, "remove this one");
                }
                frames.push(frame);
            });
            if frames.is_empty() {
                frames.push(FrameInputs::default());
            }
            let uniforms = document.table("uniforms", uniforms).unwrap_or_default();
            let rubric = document.table("rubric", Rubric::read);
            let rules = document.table("rules", rules);
            let functions = function_tests(document);
            let features = document.tables("feature", |table| feature(table, folder));
            let features: Vec<Feature> = features.into_iter().flatten().collect();
            document.report_unknown_keys();
            if reference.is_none() && document.is_valid() {
                let help = "add `scene = \"scene.toml\"` or `reference = \"solution.glsl\"`";
                let message = "the assignment has neither a scene nor a reference";
                document.reject(document.span(), message, help);
            }
            let of_rules = rules.as_ref().map_or(0.0, |rules| rules.points);
            let of_functions: f64 = functions.iter().map(|test| test.points).sum();
            let of_features: f64 = features.iter().map(|feature| feature.points).sum();
            let others = of_rules + of_functions + of_features;
            let of_checks = rubric.as_ref().map_or(0.0, Rubric::check_points);
            if rubric.is_some() && of_checks + others == 0.0 && document.is_valid() {
                let help = "add a table such as [rubric.algorithm] with `points = 6`";
                document.reject(document.span(), "the rubric gives no points", help);
            }
            Self {
                // Without one, there are errors.
                reference: reference.unwrap_or_else(|| Reference::Scene(PathBuf::new())),
                permitted,
                deadline: deadline.map(|deadline| deadline.value),
                frames,
                uniforms,
                rubric: rubric.or_else(|| (others > 0.0).then(Rubric::default)),
                rules,
                functions,
                features,
            }
        })
    }
}

/// Reads the values of uniforms, by their names.
fn uniforms(table: &mut Table) -> Vec<UniformValue> {
    let entries = table.take_entries::<Literal>().into_iter();
    let value = |(name, value): (String, Literal)| UniformValue {
        name,
        components: value.components(),
    };
    entries.map(value).collect()
}

/// Reads the differences with which a shader is still correct.
fn permitted(document: &mut Table) -> Vec<Difference> {
    let Some(Located { value: ids, span }) = document.optional::<Vec<String>>("permitted") else {
        return Vec::new();
    };
    let mut permitted = Vec::new();
    for id in &ids {
        match id.parse() {
            Ok(difference) => permitted.push(difference),
            Err::<_, UnknownDifference>(error) => {
                let help = match nearest(id, Difference::ALL.map(Difference::id)) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => error.to_string(),
                };
                document.reject(span, format!("`permitted` has the unknown id `{id}`"), &help);
            }
        }
    }
    permitted
}

/// Reads the reference of the shaders; `None` if no key gives it.
fn reference(document: &mut Table, folder: &Path) -> Option<Reference> {
    let scene = path(document, "scene", folder);
    let given = path(document, "reference", folder);
    let tolerance = document.optional::<f64>("tolerance");
    if let Some(tolerance) = &tolerance {
        if !(0.0..=MAX_TOLERANCE).contains(&tolerance.value) {
            document.reject_value(
                "tolerance",
                tolerance,
                "must be a number of 8-bit levels from 0 to 255",
            );
        }
        if scene.is_some() {
            let help = "remove it; only a `reference` has a tolerance";
            document.reject(tolerance.span, "`tolerance` cannot be used with `scene`", help);
        }
    }
    match (scene, given) {
        (Some(_), Some(given)) => {
            let help = "remove one of them";
            document.reject(given.span, "`reference` cannot be used with `scene`", help);
            None
        }
        (Some(scene), None) => {
            let is_toml = scene
                .value
                .extension()
                .is_some_and(|extension| extension == "toml");
            if !is_toml && document.is_valid() {
                let found = document.excerpt(scene.span);
                let help = "a shader or an image is named by `reference`";
                document.reject(
                    scene.span,
                    format!("`scene` must be a .toml file, found {found}"),
                    help,
                );
            }
            Some(Reference::Scene(scene.value))
        }
        (None, Some(given)) => Some(Reference::Given {
            path: given.value,
            tolerance: tolerance.map(|tolerance| tolerance.value),
        }),
        (None, None) => None,
    }
}

/// Reads a feature of the image; `None` if a key is missing.
fn feature(table: &mut Table, folder: &Path) -> Option<Feature> {
    let name = table.required::<String>("name");
    if !table.has("without") {
        table.require("without", "\"solution-without.glsl\"");
    }
    let without = path(table, "without", folder);
    let points = table.required::<f64>("points");
    if let Some(points) = points
        .as_ref()
        .filter(|points| points.value <= 0.0 || !points.value.is_finite())
    {
        table.reject_value("points", points, "must be a number greater than 0");
    }
    let path = without?.value;
    let is_scene = path.extension().is_some_and(|extension| extension == "toml");
    Some(Feature {
        name: name?.value,
        points: points?.value,
        without: if is_scene {
            Reference::Scene(path)
        } else {
            Reference::Given {
                path,
                tolerance: None,
            }
        },
    })
}

/// Reads the path of a file or a project that must exist, relative to the folder of the assignment.
fn path(table: &mut Table, key: &'static str, folder: &Path) -> Option<Located<PathBuf>> {
    let Located { value: name, span } = table.optional::<String>(key)?;
    let value = folder.join(&name);
    let image = value.join(Tab::Pass(PassKind::Image).file_name());
    if !value.is_file() && !image.is_file() {
        let found = table.excerpt(span);
        table.reject(span, format!("there is no file {found}"), PATHS);
    }
    Some(Located { value, span })
}

fn frame(table: &mut Table, folder: &Path) -> FrameInputs {
    let size = table
        .has("size")
        .then(|| table.size_or("size", Frame::default().size));
    let time = table.optional::<f64>("time").map_or(0.0, |time| {
        if !(time.value as f32).is_finite() {
            table.reject_value("time", &time, "must be a finite number of seconds");
        }
        time.value as f32
    });
    FrameInputs {
        size,
        time,
        frame: table.count_or("frame", [0, i32::MAX as u32], 0) as i32,
        mouse: mouse(table),
        date: date(table),
        script: None,
        channels: ["channel0", "channel1", "channel2", "channel3"].map(|key| channel(table, key, folder)),
        uniforms: table.table("uniforms", uniforms).unwrap_or_default(),
    }
}

/// Reads the position of a drag, and of its click, which may be omitted.
fn mouse(table: &mut Table) -> [f32; 4] {
    let Some(mouse) = numbers(table, "mouse") else {
        return [0.0; 4];
    };
    match mouse.value[..] {
        [x, y] => [x, y, 0.0, 0.0],
        [x, y, z, w] => [x, y, z, w],
        _ => {
            table.reject_value(
                "mouse",
                &mouse,
                "must be two or four numbers: [x, y] or [x, y, z, w]",
            );
            [0.0; 4]
        }
    }
}

fn date(table: &mut Table) -> [f32; 4] {
    let Some(date) = numbers(table, "date") else {
        return [0.0; 4];
    };
    match date.value[..] {
        [year, month, day, seconds] if (0.0..=11.0).contains(&month) => [year, month, day, seconds],
        _ => {
            let problem =
                "must be four numbers: year, month from 0 (January) to 11, day, seconds since midnight";
            table.reject_value("date", &date, problem);
            [0.0; 4]
        }
    }
}

/// Reads a list of finite numbers.
fn numbers(table: &mut Table, key: &'static str) -> Option<Located<Vec<f32>>> {
    let Located { value, span } = table.optional::<Vec<f64>>(key)?;
    let value: Vec<f32> = value.into_iter().map(|number| number as f32).collect();
    let located = Located { value, span };
    if !located.value.iter().all(|number| number.is_finite()) {
        table.reject_value(key, &located, "must have finite numbers");
    }
    Some(located)
}

/// Reads the texture of a channel: `noise`, or an image.
fn channel(table: &mut Table, key: &'static str, folder: &Path) -> Option<Channel> {
    let Located { value: name, span } = table.optional::<String>(key)?;
    match Channel::named(Path::new(&name)) {
        Channel::Noise => Some(Channel::Noise),
        Channel::File(name) => {
            let path = folder.join(name);
            let channel = Channel::File(path.clone());
            if !path.is_file() {
                let found = table.excerpt(span);
                let help = format!("name an image (.png, .exr) or \"noise\"; {PATHS}");
                table.reject(span, format!("there is no file {found}"), &help);
            }
            Some(channel)
        }
    }
}

/// The largest value of `max_lines`: a shader has at most a megabyte.
const MAX_LINES: u32 = 1_000_000;

fn rules(table: &mut Table) -> Rules {
    Rules {
        points: optional_points(table).unwrap_or_default(),
        must_define: names(table, "must_define"),
        must_not_call: names(table, "must_not_call"),
        textures: table.optional("textures").is_none_or(|textures| textures.value),
        max_lines: table
            .has("max_lines")
            .then(|| table.count_or("max_lines", [1, MAX_LINES], MAX_LINES)),
    }
}

/// Reads a list of names of functions.
fn names(table: &mut Table, key: &'static str) -> Vec<String> {
    let Some(Located { value, span }) = table.optional::<Vec<String>>(key) else {
        return Vec::new();
    };
    if let Some(name) = value.iter().find(|name| !is_identifier(name)) {
        table.reject(
            span,
            format!("`{key}` must list names of functions; `{name}` is not a name"),
            "",
        );
    }
    value
}
