//! `[film]`, `[camera]` and `[[figure]]`

use serde::Deserialize;
use toml::Spanned;

use super::super::{Camera, Figure, Film, Integrator, Outline, Projection, Sampler, ToneMap};
use super::checks::{Checks, Pair, Triple};

/// The maximum number of samples per pixel.
const MAX_SAMPLES: i64 = 65_536;
/// The maximum number of path segments.
const MAX_DEPTH: i64 = 1_000;

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct FilmTable {
    size: Option<Spanned<[i64; 2]>>,
    samples: Option<Spanned<i64>>,
    sampler: Option<SamplerName>,
    pub(super) max_depth: Option<Spanned<i64>>,
    integrator: Option<IntegratorName>,
    tone_map: Option<ToneMapName>,
    gamma: Option<Spanned<f64>>,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "kebab-case")]
enum SamplerName {
    Center,
    SineHash,
    Independent,
    Stratified,
    Sobol,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "kebab-case")]
enum IntegratorName {
    Whitted,
    Path,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "kebab-case")]
enum ToneMapName {
    None,
    Reinhard,
}

impl FilmTable {
    pub(super) fn check(self, checks: &mut Checks) -> Film {
        Film {
            size: checks.size(self.size),
            samples: checks.count("samples", self.samples, MAX_SAMPLES),
            sampler: match self.sampler {
                None | Some(SamplerName::Center) => Sampler::Center,
                Some(SamplerName::SineHash) => Sampler::SineHash,
                Some(SamplerName::Independent) => Sampler::Independent,
                Some(SamplerName::Stratified) => Sampler::Stratified,
                Some(SamplerName::Sobol) => Sampler::Sobol,
            },
            max_depth: checks.count("max_depth", self.max_depth, MAX_DEPTH),
            integrator: match self.integrator {
                None | Some(IntegratorName::Whitted) => Integrator::Whitted,
                Some(IntegratorName::Path) => Integrator::Path,
            },
            tone_map: match self.tone_map {
                None | Some(ToneMapName::None) => ToneMap::None,
                Some(ToneMapName::Reinhard) => ToneMap::Reinhard,
            },
            gamma: self.gamma.map_or(1.0, |gamma| checks.positive("gamma", &gamma)),
        }
    }
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraTable {
    eye: Option<Triple>,
    projection: Option<Spanned<ProjectionName>>,
    screen_distance: Option<Spanned<f64>>,
    width: Option<Spanned<f64>>,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "kebab-case")]
enum ProjectionName {
    Pinhole,
    Parallel,
}

impl CameraTable {
    pub(super) fn check(self, checks: &mut Checks) -> Camera {
        let name = self
            .projection
            .map_or(ProjectionName::Pinhole, Spanned::into_inner);
        let or_two = |what: &str, value: Option<Spanned<f64>>, checks: &mut Checks| {
            value.map_or(2.0, |value| checks.positive(what, &value))
        };
        let projection = match name {
            ProjectionName::Pinhole => {
                checks.refuse_key("width", self.width.as_ref(), "parallel", "pinhole");
                let screen_distance = or_two("screen_distance", self.screen_distance, checks);
                Projection::Pinhole { screen_distance }
            }
            ProjectionName::Parallel => {
                checks.refuse_key(
                    "screen_distance",
                    self.screen_distance.as_ref(),
                    "pinhole",
                    "parallel",
                );
                let width = or_two("width", self.width, checks);
                Projection::Parallel { width }
            }
        };
        Camera {
            eye: checks.point("eye", self.eye, [0.0; 3]),
            projection,
        }
    }
}

// `[[figure]]`

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FigureTable {
    outline: Spanned<OutlineName>,
    color: Spanned<[f64; 3]>,
    center: Option<Pair>,
    radius: Option<Spanned<f64>>,
    size: Option<Spanned<f64>>,
    height: Option<Spanned<f64>>,
    amplitude: Option<Spanned<f64>>,
    frequency: Option<Spanned<f64>>,
}

#[derive(Deserialize, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
enum OutlineName {
    Disk,
    Wave,
    Heart,
}

impl OutlineName {
    fn name(self) -> &'static str {
        match self {
            Self::Disk => "disk",
            Self::Wave => "wave",
            Self::Heart => "heart",
        }
    }
}

impl FigureTable {
    pub(super) fn check(self, checks: &mut Checks) -> Figure {
        let place = self.outline.span();
        let name = self.outline.into_inner();
        let numbers = [
            ("radius", OutlineName::Disk, &self.radius),
            ("size", OutlineName::Heart, &self.size),
            ("height", OutlineName::Wave, &self.height),
            ("amplitude", OutlineName::Wave, &self.amplitude),
            ("frequency", OutlineName::Wave, &self.frequency),
        ];
        for (key, owner, value) in numbers {
            if owner != name {
                checks.refuse_key(key, value.as_ref(), owner.name(), name.name());
            }
        }
        if name == OutlineName::Wave {
            checks.refuse_key("center", self.center.as_ref(), "disk", name.name());
        }
        let positive = |key: &str, value: &Option<Spanned<f64>>, checks: &mut Checks| {
            let value = checks.required(key, value.as_ref(), &place);
            value.map_or(1.0, |value| checks.positive(key, value))
        };
        let number = |key: &str, value: &Option<Spanned<f64>>, checks: &mut Checks| {
            let value = checks.required(key, value.as_ref(), &place);
            value.map_or(1.0, |value| checks.finite(key, value))
        };
        let center = |checks: &mut Checks| {
            let value = checks.required("center", self.center.as_ref(), &place);
            value.map_or([0.0; 2], |value| checks.pair("center", value))
        };
        let outline = match name {
            OutlineName::Disk => Outline::Disk {
                center: center(checks),
                radius: positive("radius", &self.radius, checks),
            },
            OutlineName::Wave => Outline::Wave {
                height: number("height", &self.height, checks),
                amplitude: number("amplitude", &self.amplitude, checks),
                frequency: number("frequency", &self.frequency, checks),
            },
            OutlineName::Heart => Outline::Heart {
                center: center(checks),
                size: positive("size", &self.size, checks),
            },
        };
        Figure {
            outline,
            color: checks.color("color", Some(self.color), [0.0; 3]),
        }
    }
}
