//! Shaders that are right with other inputs: another position of the mouse, another time, another resolution.

use toyproof_diagnostic::Span;
use toyproof_eval::Places;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{ExprKind, Input, Value};
use toyproof_image::{FRAME_RATE, Frame};
use toyproof_verify::Difference;

use super::Alternative;
use super::submission::{PROBES, Submission, View};
use crate::known::KnownMistake;

/// Other positions of the mouse: the center, the edges and the corners.
pub(super) fn mouse(submission: &Submission) -> Vec<(View, KnownMistake)> {
    if !submission.confirmer.case.checked.reads(Input::Mouse) {
        return Vec::new();
    }
    let frame = submission.frame();
    let [width, height] = frame.size.map(|side| side as f32);
    let shares = [0.5, 0.0, 1.0];
    let positions = shares
        .iter()
        .flat_map(|&y| shares.map(|x| [x * width, y * height]));
    let others = positions.filter(|&[x, y]| [x, y] != frame.mouse[..2]);
    let view = |[x, y]: [f32; 2]| {
        let frame = Frame {
            mouse: [x, y, x, y],
            ..frame.clone()
        };
        View::with_inputs(frame)
    };
    others
        .map(|at| (view(at), moved_mouse(at, frame.mouse)))
        .collect()
}

fn moved_mouse([x, y]: [f32; 2], [own_x, own_y, ..]: [f32; 4]) -> KnownMistake {
    let before = match [own_x, own_y] {
        [0.0, 0.0] => ", where it is before the first click",
        _ => "",
    };
    let text = format!(
        "the image depends on `iMouse`: it is right with the mouse at ({x}, {y}), but not at ({own_x}, {own_y}){before}"
    );
    KnownMistake::new(Difference::Mouse.id(), text)
}

/// Other times and numbers of the frame, as far as the shader reads them.
pub(super) fn time(submission: &Submission) -> Vec<(View, KnownMistake)> {
    let (frame, checked) = (submission.frame(), submission.confirmer.case.checked);
    let numbered = |number: f32| Frame {
        frame: number.round() as i32,
        ..frame.clone()
    };
    let timed = |time: f32| Frame {
        time,
        ..frame.clone()
    };
    let mut date = frame.date;
    date[3] = frame.time;
    let number = frame.frame as f32;
    let all = [
        (Input::Frame, numbered(frame.time * FRAME_RATE), FRAME_AT_60),
        (Input::Frame, numbered(frame.time), FRAME_AS_SECONDS),
        (Input::Time, timed(number), SECONDS_AS_FRAME),
        (Input::Time, timed(number / FRAME_RATE), TIME_AT_60),
        (
            Input::Date,
            Frame {
                date,
                ..frame.clone()
            },
            DATE,
        ),
    ];
    let all = all
        .into_iter()
        .filter(|(input, other, _)| other != frame && checked.reads(*input));
    all.map(|(_, other, text)| {
        (
            View::with_inputs(other),
            KnownMistake::new(Difference::Time.id(), text),
        )
    })
    .collect()
}

const FRAME_AT_60: &str = "the time is computed from `iFrame`: the image is right only where 60 frames are shown per second; use `iTime`";
const FRAME_AS_SECONDS: &str =
    "the number of the frame, `iFrame`, is used as the time in seconds; use `iTime`";
const SECONDS_AS_FRAME: &str =
    "the time in seconds, `iTime`, is used as the number of the frame; use `iFrame`";
const TIME_AT_60: &str = "the number of the frame is computed from `iTime`: the image is right only where 60 frames are \
                          shown per second; use `iFrame`";
const DATE: &str = "the time is read from `iDate`, which starts at midnight; use `iTime`";

// Resolutions that are written as numbers.

/// The range of numbers that may be a width or a height, in pixels.
const SIDES: std::ops::RangeInclusive<u32> = 16..=8192;

/// The range of ratios of width and height.
const ASPECTS: std::ops::RangeInclusive<f64> = 0.25..=4.0;

/// The largest distance, in literals, between two numbers that are a width and a height.
const MAX_DISTANCE: usize = 4;

/// The largest number of resolutions that are tried.
const MAX_RESOLUTIONS: usize = 24;

/// The factors of one side of a resolution that is no longer right.
const OTHER_SIDES: [f64; 2] = [0.8, 1.25];

/// Finds the resolution with which the image is right, among the numbers of the shader. With another width or
/// another height it must be wrong: otherwise the image only shows too little of a mistake.
pub(super) fn fixed_resolution(submission: &Submission) -> Option<Alternative> {
    let frame = submission.frame();
    let in_size = |size: [u32; 2]| Frame {
        size,
        ..frame.clone()
    };
    let is_right = |size: [u32; 2]| {
        let other = in_size(size);
        let places = Places::spread(size, PROBES);
        let expected = submission.expected().colors_in(&other, &places)?;
        let actual = View::with_inputs(other).image(submission, &places)?;
        Some(submission.agree(&places, &expected, &actual))
    };
    let is_wrong_nearby = |[width, height]: [u32; 2]| {
        let mut factors = OTHER_SIDES.into_iter();
        factors.all(|factor| {
            let scaled = |side: u32| (f64::from(side) * factor).round() as u32;
            let others = [[scaled(width), height], [width, scaled(height)]];
            others.into_iter().all(|other| is_right(other) == Some(false))
        })
    };
    let candidates = resolutions(submission.confirmer.case.checked, frame.size);
    candidates.into_iter().find_map(|(size, at, text)| {
        if is_right(size) != Some(true) || !is_wrong_nearby(size) {
            return None;
        }
        let other = in_size(size);
        let expected = submission.expected().in_frame(&other)?;
        let mistake = KnownMistake::new(Difference::FixedResolution.id(), fixed(&text));
        let mistake = KnownMistake {
            at: Some(at),
            ..mistake
        };
        submission.confirmed(&View::with_inputs(other.clone()), (&expected, &other), mistake)
    })
}

fn fixed(text: &str) -> String {
    format!(
        "the image is right only in the resolution that is written in the shader, {text}; use `iResolution`"
    )
}

/// The resolutions that a shader may contain: two numbers near each other, or one side, or a ratio.
fn resolutions(checked: &Checked, own: [u32; 2]) -> Vec<([u32; 2], Span, String)> {
    let literals = checked
        .tree
        .exprs
        .iter()
        .filter_map(|(_, expr)| match &expr.kind {
            ExprKind::Literal(literal) => {
                let value = match literal.value {
                    Value::Float(value) => value,
                    Value::Int(value) => f64::from(value),
                    Value::Uint(value) => f64::from(value),
                    Value::Bool(_) => return None,
                };
                Some((value, expr.at.span))
            }
            _ => None,
        });
    let mut literals: Vec<(f64, Span)> = literals.collect();
    literals.sort_by_key(|(_, span)| span.start);
    let as_side = |value: f64| {
        let side = value as u32;
        (f64::from(side) == value && SIDES.contains(&side)).then_some(side)
    };
    let own_aspect = f64::from(own[0]) / f64::from(own[1]);
    let mut found: Vec<([u32; 2], Span, String)> = Vec::new();
    // A square image is right without an aspect ratio, whatever the numbers.
    let accepts_square = !checked.reads(Input::Resolution);
    let mut add = |size: [u32; 2], at: Span, text: String| {
        let is_new = size != own && found.iter().all(|(known, ..)| *known != size);
        let is_new = is_new && (accepts_square || size[0] != size[1]);
        let is_usual = size.iter().all(|side| SIDES.contains(side))
            && ASPECTS.contains(&(f64::from(size[0]) / f64::from(size[1])));
        if is_new && is_usual && found.len() < MAX_RESOLUTIONS {
            found.push((size, at, text));
        }
    };
    for (at, &(value, span)) in literals.iter().enumerate() {
        let Some(width) = as_side(value) else { continue };
        for &(value, _) in literals.iter().skip(at + 1).take(MAX_DISTANCE) {
            if let Some(height) = as_side(value) {
                add([width, height], span, format!("{width}×{height}"));
            }
        }
    }
    for &(value, span) in &literals {
        if let Some(side) = as_side(value) {
            let other = |ratio: f64| (f64::from(side) * ratio).round() as u32;
            add(
                [side, other(own_aspect.recip())],
                span,
                format!("a width of {side}"),
            );
            add([other(own_aspect), side], span, format!("a height of {side}"));
        }
    }
    let ratios = literals.iter().map(|&(value, span)| (value, span));
    let quotients = literals.windows(2).map(|pair| (pair[0].0 / pair[1].0, pair[0].1));
    for (ratio, span) in ratios.chain(quotients) {
        if ASPECTS.contains(&ratio) && ratio != 1.0 {
            let size = [(f64::from(own[1]) * ratio).round() as u32, own[1]];
            add(size, span, format!("an aspect ratio of {ratio:.3}"));
        }
    }
    found
}

/// The descriptions of all kinds of differences here, as examples.
#[cfg(test)]
pub(super) fn examples() -> Vec<KnownMistake> {
    let time = [FRAME_AT_60, FRAME_AS_SECONDS, SECONDS_AS_FRAME, TIME_AT_60, DATE];
    let time = time.map(|text| KnownMistake::new(Difference::Time.id(), text));
    time.into_iter()
        .chain([KnownMistake::new(
            Difference::FixedResolution.id(),
            fixed("640×360"),
        )])
        .chain([moved_mouse([320.0, 180.0], [0.0; 4])])
        .collect()
}
