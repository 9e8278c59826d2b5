//! `[film]` and `[camera]`

use serde::Deserialize;
use toml::Spanned;

use super::super::{Camera, Film, Integrator, Projection, Sampler, ToneMap};
use super::checks::{Checks, Triple};

/// The most samples a pixel.
const MAX_SAMPLES: i64 = 65_536;
/// The most path segments.
const MAX_DEPTH: i64 = 1_000;

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct Table {
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

impl Table {
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
                checks.foreign("width", self.width.as_ref(), "parallel", "pinhole");
                let screen_distance = or_two("screen_distance", self.screen_distance, checks);
                Projection::Pinhole { screen_distance }
            }
            ProjectionName::Parallel => {
                checks.foreign(
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
