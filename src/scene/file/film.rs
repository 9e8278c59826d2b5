//! `[film]`, `[camera]` and `[[figure]]`

use glam::DVec3;
use toyproof_diagnostic::Span;
use toyproof_toml::Table;

use super::super::film::MAX_SAMPLES;
use super::super::{Camera, Figure, Film, Integrator, Outline, Projection, Sampler, ToneMap};
use super::checks::Checks;

/// The maximum number of path segments.
const MAX_DEPTH: u32 = 1_000;

const SAMPLERS: [(&str, Sampler); 5] = [
    ("center", Sampler::Center),
    ("sine-hash", Sampler::SineHash),
    ("independent", Sampler::Independent),
    ("stratified", Sampler::Stratified),
    ("sobol", Sampler::Sobol),
];
const INTEGRATORS: [(&str, Integrator); 2] = [("whitted", Integrator::Whitted), ("path", Integrator::Path)];
const TONE_MAPS: [(&str, ToneMap); 2] = [("none", ToneMap::None), ("reinhard", ToneMap::Reinhard)];

pub(super) const DEFAULT_FILM: Film = Film {
    size: [640, 360],
    samples: 1,
    sampler: Sampler::Center,
    max_depth: 1,
    integrator: Integrator::Whitted,
    tone_map: ToneMap::None,
    gamma: 1.0,
};

/// The film, and where its keys stand that other tables depend on.
pub(super) struct FilmTable {
    pub(super) film: Film,
    pub(super) max_depth: Option<Span>,
    pub(super) integrator: Option<Span>,
}

impl FilmTable {
    pub(super) fn read(table: &mut Table) -> Self {
        let default = DEFAULT_FILM;
        let size = table.size_or("size", default.size);
        let samples = table.count_or("samples", [1, MAX_SAMPLES], default.samples);
        let sampler = table.choice("sampler", "sampler", &SAMPLERS);
        let max_depth = table.value_span("max_depth");
        let depth = table.count_or("max_depth", [1, MAX_DEPTH], default.max_depth);
        let integrator = table.choice("integrator", "integrator", &INTEGRATORS);
        let tone_map = table.choice("tone_map", "tone map", &TONE_MAPS);
        Self {
            film: Film {
                size,
                samples,
                sampler: sampler.map_or(default.sampler, |sampler| sampler.value),
                max_depth: depth,
                integrator: integrator.map_or(default.integrator, |integrator| integrator.value),
                tone_map: tone_map.map_or(default.tone_map, |tone_map| tone_map.value),
                gamma: table.positive_or("gamma", default.gamma),
            },
            max_depth,
            integrator: integrator.map(|integrator| integrator.span),
        }
    }
}

/// The default of `screen_distance` and of `width`, in scene units.
const DEFAULT_EXTENT: f64 = 2.0;
/// The smallest sine of the angle between `up` and the viewing direction: with a smaller one, float32 shaders
/// compute the axes of the camera with errors that are visible.
const MIN_UP_SINE: f64 = 1e-3;

pub(super) const DEFAULT_CAMERA: Camera = Camera {
    eye: [0.0; 3],
    look_at: None,
    up: Camera::UP,
    roll: 0.0,
    projection: Projection::Pinhole {
        screen_distance: DEFAULT_EXTENT,
    },
};

pub(super) fn camera(table: &mut Table) -> Camera {
    let default = DEFAULT_CAMERA;
    let [look_at_span, up_span] = ["look_at", "up"].map(|key| table.value_span(key));
    let camera = Camera {
        eye: table.point_or("eye", default.eye),
        look_at: table.optional_point("look_at"),
        up: table.direction_or("up", default.up),
        roll: table.degrees_or("roll", default.roll),
        projection: projection(table),
    };
    let up_sine = DVec3::from_array(camera.forward())
        .cross(DVec3::from_array(camera.up))
        .length();
    if let Some(span) = look_at_span.or(up_span)
        && table.is_valid()
        && (up_sine.is_nan() || up_sine < MIN_UP_SINE)
    {
        let (span, message, help) = match up_span {
            _ if up_sine.is_nan() => (span, "`look_at` must differ from `eye`", "move one of them"),
            Some(up_span) => (
                up_span,
                "`up` must not be parallel to the viewing direction",
                "use a direction that is up in the image, such as `up = [0.0, 1.0, 0.0]`",
            ),
            None => (
                span,
                "`look_at` must not be straight above or below `eye`",
                "add a direction that is up in the image, such as `up = [0.0, 0.0, -1.0]`",
            ),
        };
        table.reject(span, message, help);
    }
    camera
}

fn projection(table: &mut Table) -> Projection {
    let names = [("pinhole", false), ("parallel", true)];
    let is_parallel = table.choice("projection", "projection", &names);
    if is_parallel.is_some_and(|name| name.value) {
        table.reject_keys(&["screen_distance", "fov"], "projection", "pinhole", "parallel");
        return Projection::Parallel {
            width: table.positive_or("width", DEFAULT_EXTENT),
        };
    }
    table.reject_keys(&["width"], "projection", "parallel", "pinhole");
    if let Some(span) = table.value_span("fov")
        && table.has("screen_distance")
    {
        let message = "`fov` and `screen_distance` both set the angle of view";
        table.reject(span, message, "remove one of them");
    }
    let screen_distance = table.positive_or("screen_distance", DEFAULT_EXTENT);
    Projection::Pinhole {
        screen_distance: table.screen_distance("fov").unwrap_or(screen_distance),
    }
}

// `[[figure]]`

#[derive(Clone, Copy, PartialEq, Eq)]
enum OutlineName {
    Disk,
    Wave,
    Heart,
}

const OUTLINES: [(&str, OutlineName); 3] = [
    ("disk", OutlineName::Disk),
    ("wave", OutlineName::Wave),
    ("heart", OutlineName::Heart),
];

/// The keys that only some outlines have, each with its outlines.
const OUTLINE_KEYS: [(&[&str], &[OutlineName], &str); 4] = [
    (&["radius"], &[OutlineName::Disk], "disk"),
    (&["size"], &[OutlineName::Heart], "heart"),
    (
        &["height", "amplitude", "frequency"],
        &[OutlineName::Wave],
        "wave",
    ),
    (&["center"], &[OutlineName::Disk, OutlineName::Heart], "disk"),
];

/// Reads a figure; `None` if its outline is unknown, which is reported.
pub(super) fn figure(table: &mut Table) -> Option<Figure> {
    let name = table.required_choice("outline", "outline", &OUTLINES);
    let color = table.color("color");
    let Some(name) = name else {
        table.ignore_rest();
        return None;
    };
    let written = OUTLINES.iter().find(|(_, outline)| *outline == name.value);
    let written = written.map_or("", |(written, _)| written);
    for (keys, owners, owner) in OUTLINE_KEYS {
        if !owners.contains(&name.value) {
            table.reject_keys(keys, "outline", owner, written);
        }
    }
    let outline = match name.value {
        OutlineName::Disk => Outline::Disk {
            center: table.pair("center"),
            radius: table.positive("radius"),
        },
        OutlineName::Wave => Outline::Wave {
            height: table.number("height"),
            amplitude: table.number("amplitude"),
            frequency: table.number("frequency"),
        },
        OutlineName::Heart => Outline::Heart {
            center: table.pair("center"),
            size: table.positive("size"),
        },
    };
    Some(Figure { outline, color })
}
