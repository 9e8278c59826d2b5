//! A shader that was checked in several frames: one record of all of them.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{all_of, grouped, path_name, plural};
use toyproof_image::{Channel, FrameInputs, UniformValue};
use toyproof_verify::compare::{CheckSummary, Comparison};
use toyproof_verify::{MAX_UNSTABLE, Share, Verdict};

use super::Record;
use super::share::imprecision;

/// The largest number of frames that a record's details name, so that they stay short sentences.
const MAX_NAMED: usize = 5;

/// The result in one frame. Checks that did not run are null.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FrameRecord {
    /// `iResolution.xy`, in pixels.
    pub size: [u32; 2],
    /// `iTime`, in seconds.
    pub time: f32,
    /// `iFrame`.
    pub frame: i32,
    /// `iMouse`, in pixels.
    pub mouse: [f32; 4],
    /// `iDate`: year, month from 0, day, seconds since midnight.
    pub date: [f32; 4],
    /// The image files of the channels, or `noise`; null for black.
    pub channels: [Option<String>; 4],
    /// The values of uniforms in this frame.
    #[serde(default)]
    pub uniforms: Vec<UniformValue>,
    /// The verdict in this frame.
    pub verdict: Verdict,
    /// Why, in one short sentence.
    pub reason: String,
    /// The shader in f64 against the reference.
    pub algorithm: Option<CheckSummary>,
    /// The shader in f32 against the shader in f64.
    pub precision: Option<CheckSummary>,
    /// The GPU's image against the CPU's, bit by bit.
    pub toolchain: Option<CheckSummary>,
    /// The image against the reference.
    #[serde(rename = "image")]
    pub comparison: Option<Comparison>,
    /// The largest difference of a component between float32 and double precision, both from the first frame
    /// on; null if the image depends on no other frame.
    #[serde(default)]
    pub growth: Option<f64>,
}

impl FrameRecord {
    /// The result that `record` has for the frame with these inputs, in its size.
    fn new(inputs: &FrameInputs, size: [u32; 2], record: &Record) -> Self {
        let name = |channel: &Channel| {
            channel
                .file()
                .map_or_else(|| Channel::NOISE.to_owned(), path_name)
        };
        Self {
            size,
            time: inputs.time,
            frame: inputs.frame,
            mouse: inputs.mouse,
            date: inputs.date,
            channels: inputs
                .channels
                .each_ref()
                .map(|channel| channel.as_ref().map(name)),
            uniforms: inputs.uniforms.clone(),
            verdict: record.verdict,
            reason: record.reason.clone(),
            algorithm: record.algorithm.clone(),
            precision: record.precision.clone(),
            toolchain: record.toolchain.clone(),
            comparison: record.comparison.clone(),
            growth: record
                .growth
                .as_ref()
                .and_then(|growth| Some(growth.frames.last()?.max_abs)),
        }
    }

    /// The size and the other inputs that are not zero: `320x180, time 2`.
    #[must_use]
    pub fn label(&self) -> String {
        let [width, height] = self.size;
        let mut label = format!("{width}x{height}");
        if self.time != 0.0 {
            let _ = write!(label, ", time {}", self.time);
        }
        if self.frame != 0 {
            let _ = write!(label, ", frame {}", self.frame);
        }
        for (name, numbers) in [("mouse", self.mouse), ("date", self.date)] {
            let [first, second, rest @ ..] = numbers;
            if numbers != [0.0; 4] {
                let _ = write!(label, ", {name} ({first}, {second}");
                if rest != [0.0; 2] {
                    let _ = write!(label, ", {}, {}", rest[0], rest[1]);
                }
                label.push(')');
            }
        }
        for (index, channel) in self.channels.iter().enumerate() {
            if let Some(channel) = channel {
                let _ = write!(label, ", channel {index} {channel}");
            }
        }
        for value in &self.uniforms {
            let _ = write!(label, ", {value}");
        }
        label
    }
}

/// A frame in which a shader was checked, and the record that the shader would have if there were no other.
#[derive(Debug)]
pub struct CheckedFrame<'a> {
    /// The inputs.
    pub inputs: &'a FrameInputs,
    /// The size in pixels.
    pub size: [u32; 2],
    /// The record.
    pub record: Record,
}

/// The checks that earn points, in one frame.
pub(super) struct FrameChecks<'a> {
    pub(super) label: Option<String>,
    pub(super) algorithm: Option<&'a CheckSummary>,
    pub(super) precision: Option<&'a CheckSummary>,
}

impl Record {
    /// Combines the records of all frames in which a shader was checked, of `planned` frames; there is at
    /// least one. The first frame with the worst verdict, by the order of precedence, gives the verdict and
    /// everything that explains it.
    #[must_use]
    pub fn from_frames(mut checked: Vec<CheckedFrame>, planned: usize) -> Self {
        let frames: Vec<_> = checked
            .iter()
            .map(|CheckedFrame { inputs, size, record }| FrameRecord::new(inputs, *size, record))
            .collect();
        let shown = shown_frame(&frames);
        let mut all = checked.remove(shown).record;
        for CheckedFrame { record, .. } in checked {
            for diagnostic in record.diagnostics {
                if !all.diagnostics.contains(&diagnostic) {
                    all.diagnostics.push(diagnostic);
                }
            }
            all.seconds += record.seconds;
        }
        if planned > 1 {
            all.name_frames(&frames, shown, planned);
        }
        all.frames = Some(frames);
        all
    }

    /// The algorithm and the precision check in each frame, with the frame's label where there are several.
    pub(super) fn checks_in_frames(&self) -> Vec<FrameChecks<'_>> {
        match self.frames.as_deref() {
            Some(frames @ [_, _, ..]) => {
                let checks = frames.iter().map(|frame| FrameChecks {
                    label: Some(frame.label()),
                    algorithm: frame.algorithm.as_ref(),
                    precision: frame.precision.as_ref(),
                });
                checks.collect()
            }
            _ => vec![FrameChecks {
                label: None,
                algorithm: self.algorithm.as_ref(),
                precision: self.precision.as_ref(),
            }],
        }
    }

    /// The index of the frame that gives the verdict.
    #[must_use]
    pub fn shown_frame(&self) -> usize {
        self.frames.as_deref().map_or(0, shown_frame)
    }

    /// States in which frames the shader is not right.
    fn name_frames(&mut self, frames: &[FrameRecord], shown: usize, planned: usize) {
        let count = grouped(planned as u64);
        let all = match planned {
            2 => "both frames".to_owned(),
            _ => format!("all {count} frames"),
        };
        if self.verdict.is_good() {
            let at = |frame: &FrameRecord| format!("at {}: {}", frame.label(), frame.reason);
            self.details = frames.iter().map(at).collect();
            let mut imprecise = frames.iter().filter_map(|frame| {
                let share = Share::differing(frame.precision.as_ref()?);
                (share.ratio() > MAX_UNSTABLE).then(|| (frame.label(), imprecision(share)))
            });
            self.reason = match (self.verdict, imprecise.next()) {
                (Verdict::Ok, Some((label, pixels))) => {
                    format!("the shader renders in {all}, but at {label}, {pixels}; there is no reference")
                }
                (Verdict::Ok, None) => {
                    format!("the shader renders in {all}; there is no reference to compare it with")
                }
                _ => format!("{all} agree with the reference"),
            };
            return;
        }
        if self.verdict.is_compiled() {
            self.reason = format!("at {}: {}", frames[shown].label(), self.reason);
        }
        let others = frames.iter().enumerate();
        let others: Vec<_> = others
            .filter(|(index, frame)| *index != shown && !frame.verdict.is_good())
            .map(|(_, frame)| format!("also {} at {}: {}", frame.verdict, frame.label(), frame.reason))
            .collect();
        let more = others.len().saturating_sub(MAX_NAMED) as u64;
        self.details.extend(others.into_iter().take(MAX_NAMED));
        if more > 0 {
            let frames = plural(more, "frame", "frames");
            self.details
                .push(format!("and in {} more {frames}", grouped(more)));
        }
        let numbered = (1_u64..).zip(frames);
        let not_right: Vec<_> = numbered.filter(|(_, frame)| !frame.verdict.is_good()).collect();
        let right = (frames.len() - not_right.len()) as u64;
        if right > 0 {
            let others = match &not_right[..] {
                [(number, frame)] => format!("frame {} ({})", grouped(*number), frame.label()),
                several => {
                    let numbers = several.iter().map(|(number, _)| grouped(*number));
                    let mut numbers: Vec<_> = numbers.take(MAX_NAMED).collect();
                    if let more @ 1.. = several.len() - numbers.len() {
                        numbers.push(format!("{} more", grouped(more as u64)));
                    }
                    format!("frames {}", all_of(&numbers))
                }
            };
            self.details.push(format!(
                "right in {} of {count} frames, not in {others}",
                grouped(right)
            ));
        }
        let unchecked = (planned - frames.len()) as u64;
        if unchecked > 0 && self.verdict.is_compiled() {
            let verb = plural(unchecked, "frame was", "frames were");
            self.details
                .push(format!("{} further {verb} not checked", grouped(unchecked)));
        }
    }
}

/// The index of the first frame with the worst verdict.
fn shown_frame(frames: &[FrameRecord]) -> usize {
    let verdicts = frames
        .iter()
        .enumerate()
        .map(|(index, frame)| (frame.verdict, index));
    verdicts.min().map_or(0, |(_, index)| index)
}

/// Sample records for the tests of the formats.
#[cfg(test)]
pub(super) mod samples {
    use super::*;
    use crate::record::samples::{correct, record};

    /// A record of frames with these verdicts, at successive seconds.
    pub(crate) fn in_frames<const N: usize>(verdicts: [Verdict; N]) -> Record {
        let times = (0_u8..).map(f32::from);
        let inputs: Vec<_> = times
            .take(N)
            .map(|time| FrameInputs {
                time,
                ..FrameInputs::default()
            })
            .collect();
        let frames = inputs.iter().zip(verdicts).map(|(inputs, verdict)| CheckedFrame {
            inputs,
            size: [64, 36],
            record: Record {
                algorithm: correct().algorithm,
                ..record(verdict)
            },
        });
        Record::from_frames(frames.collect(), N)
    }
}

#[cfg(test)]
mod tests {
    use super::samples::in_frames;
    use super::*;

    #[test]
    fn the_first_frame_with_the_worst_verdict_gives_the_verdict() {
        use Verdict::{Correct, Unstable, Wrong};
        let record = in_frames([Correct, Unstable, Wrong, Wrong]);
        assert_eq!((record.verdict, record.shown_frame()), (Wrong, 2));
        assert_eq!(record.reason, "at 64x36, time 2: it is wrong");
        let details = [
            "also unstable at 64x36, time 1: it is unstable",
            "also wrong at 64x36, time 3: it is wrong",
            "right in 1 of 4 frames, not in frames 2, 3 and 4",
        ];
        assert_eq!(record.details, details);
        assert_eq!(record.seconds.total(), 6.0);
    }

    #[test]
    fn a_single_frame_is_not_named() {
        let record = in_frames([Verdict::Wrong]);
        assert_eq!((record.reason.as_str(), record.details.len()), ("it is wrong", 0));
        assert_eq!(record.frames.unwrap().len(), 1);
    }

    #[test]
    fn many_wrong_frames_are_counted() {
        let record = in_frames([Verdict::Wrong; 9]);
        assert_eq!(record.details.len(), MAX_NAMED + 1);
        assert_eq!(record.details[MAX_NAMED], "and in 3 more frames");
    }

    #[test]
    fn the_frames_that_are_not_right_are_named() {
        use Verdict::{Correct, Wrong};
        let last = |verdicts: &[Verdict]| {
            let record = match *verdicts {
                [a, b] => in_frames([a, b]),
                [a, b, c, d, e, f, g, h] => in_frames([a, b, c, d, e, f, g, h]),
                _ => unreachable!(),
            };
            record.details.last().cloned().unwrap_or_default()
        };
        assert_eq!(
            last(&[Correct, Wrong]),
            "right in 1 of 2 frames, not in frame 2 (64x36, time 1)"
        );
        let mut eight = [Wrong; 8];
        eight[2] = Correct;
        assert_eq!(
            last(&eight),
            "right in 1 of 8 frames, not in frames 1, 2, 4, 5, 6 and 2 more"
        );
    }

    #[test]
    fn labels_name_what_is_not_zero() {
        let inputs = FrameInputs {
            frame: 3,
            mouse: [1.0, 2.5, 0.0, 0.0],
            date: [2026.0, 0.0, 1.0, 0.5],
            channels: [
                None,
                Some(Channel::Noise),
                Some(Channel::File("a/b.png".into())),
                None,
            ],
            ..FrameInputs::default()
        };
        let record = Record::unchecked(String::new());
        let label = FrameRecord::new(&inputs, [8, 4], &record).label();
        let expected =
            "8x4, frame 3, mouse (1, 2.5), date (2026, 0, 1, 0.5), channel 1 noise, channel 2 a/b.png";
        assert_eq!(label, expected);
    }
}
