//! `[[motion]]`, and the names that things give of what moves them

use serde::Deserialize;
use toml::Spanned;

use super::super::{Motion, Period};
use super::checks::{Checks, Triple};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Table {
    name: Spanned<String>,
    pivot: Option<Triple>,
    axis: Option<Triple>,
    frames: Option<Spanned<f64>>,
    seconds: Option<Spanned<f64>>,
    within: Option<Spanned<String>>,
}

/// The names of motions, in the order of the file.
pub(super) struct Names(Vec<String>);

impl Names {
    /// The motion of that name.
    pub(super) fn find(&self, name: Option<Spanned<String>>, checks: &mut Checks) -> Option<usize> {
        let name = name?;
        let found = self.0.iter().position(|known| known == name.get_ref());
        if found.is_none() {
            let known: Vec<_> = self.0.iter().map(|known| format!("\"{known}\"")).collect();
            let known = match known.as_slice() {
                [] => "there is none before here".to_owned(),
                known => format!("expected {}", known.join(" or ")),
            };
            checks.refuse(
                name.span(),
                format!("no motion is called \"{}\": {known}", name.get_ref()),
            );
        }
        found
    }
}

pub(super) fn check(tables: Vec<Table>, checks: &mut Checks) -> (Vec<Motion>, Names) {
    let mut names = Names(Vec::new());
    let mut motions = Vec::new();
    for table in tables {
        let place = table.name.span();
        let period = match (&table.frames, &table.seconds) {
            (Some(frames), None) => Period::Frames(turning("frames", frames, checks)),
            (None, Some(seconds)) => Period::Seconds(turning("seconds", seconds, checks)),
            _ => {
                let words = "a motion takes either frames or seconds for one turn";
                checks.refuse(place.clone(), words.to_owned());
                Period::Frames(1.0)
            }
        };
        motions.push(Motion {
            pivot: checks.point("pivot", table.pivot, [0.0; 3]),
            axis: checks.direction("axis", table.axis, [0.0, 1.0, 0.0]),
            period,
            within: names.find(table.within, checks),
        });
        let name = table.name.into_inner();
        if names.0.contains(&name) {
            checks.refuse(place, format!("a second motion is called \"{name}\""));
        }
        names.0.push(name);
    }
    (motions, names)
}

fn turning(what: &str, value: &Spanned<f64>, checks: &mut Checks) -> f64 {
    let number = *value.get_ref();
    if !(number.is_finite() && number != 0.0) {
        checks.refuse(
            value.span(),
            format!("{what} must be a finite number other than 0, not {number}"),
        );
    }
    number
}
