//! `[[figure]]`

use serde::Deserialize;
use toml::Spanned;

use super::super::{Figure, Outline};
use super::checks::{Checks, Pair};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Table {
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
    fn word(self) -> &'static str {
        match self {
            Self::Disk => "disk",
            Self::Wave => "wave",
            Self::Heart => "heart",
        }
    }
}

impl Table {
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
                checks.foreign(key, value.as_ref(), owner.word(), name.word());
            }
        }
        if name == OutlineName::Wave {
            checks.foreign("center", self.center.as_ref(), "disk", name.word());
        }
        let positive = |key: &str, value: &Option<Spanned<f64>>, checks: &mut Checks| {
            let value = checks.needed(key, value.as_ref(), &place);
            value.map_or(1.0, |value| checks.positive(key, value))
        };
        let number = |key: &str, value: &Option<Spanned<f64>>, checks: &mut Checks| {
            let value = checks.needed(key, value.as_ref(), &place);
            value.map_or(1.0, |value| checks.finite(key, value))
        };
        let center = |checks: &mut Checks| {
            let value = checks.needed("center", self.center.as_ref(), &place);
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
