//! Tries many values of the parameters of a shader on small images, to choose the settings that are worth a
//! measurement, and the more accurate settings of the reference.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use serde::Serialize;
use toyproof_glsl as glsl;
use toyproof_image::{Frame, Image};
use toyproof_verify::compare::visible_pixels;

use super::advice::INVISIBLE_SHARE;
use super::parameter::{Parameter, Setting, Vary, VaryError, proposals, shown};
use super::source::{Shader, Source};

/// The largest number of pixels of the small images.
const MAX_PIXELS: f64 = 160.0 * 90.0;

/// A setting that takes more than this part of the time does not pay.
const MAX_TIME: f64 = 0.93;

/// The shares of visible pixels up to which the fastest setting of each parameter is measured, in ascending
/// order. Settings up to the first one are combined.
const SHARES: [f64; 3] = [INVISIBLE_SHARE, 0.01, 0.05];

/// The share of pixels up to which a more accurate value is taken for more accurate; one that changes more is
/// another image, such as a fractal of more iterations.
const MAX_ACCURACY_SHARE: f64 = 0.1;

/// The most settings that are measured, apart from those that the user asks for.
const MAX_SETTINGS: usize = 12;

/// Renders that take less time are repeated, of which the shortest time counts.
const RELIABLE_TIME: Duration = Duration::from_millis(50);
const REPETITIONS: usize = 3;

/// What is to be measured.
#[derive(Debug, Default)]
pub(super) struct Screened {
    /// The settings of each configuration.
    pub(super) settings: Vec<Vec<Setting>>,
    /// The settings of the reference, which are more accurate than the shader's own.
    pub(super) generous: Vec<Setting>,
    /// What is to be said about parameters whose values are too small for the image.
    pub(super) notes: Vec<String>,
    /// What was rendered.
    pub(super) tried: Vec<Tried>,
}

/// A setting that was tried on a small image.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tried {
    /// The setting.
    pub setting: Setting,
    /// The time relative to the shader's own settings.
    pub time: f64,
    /// The share of pixels that visibly change, in [0, 1].
    pub changed_share: f64,
}

/// A rendering of the small image.
struct Trial {
    value: f64,
    image: Image,
    time: f64,
    /// The share of visible pixels relative to the shader's own image.
    share: f64,
}

struct Screening<'a> {
    source: Source<'a>,
    options: &'a glsl::Options,
    frame: Frame,
    own: Trial,
    until: Instant,
    interrupt: &'a AtomicBool,
}

/// Chooses settings until the given time. `vary` are the parameters that the user names; without any, those
/// of the shader's loops are tried.
pub(super) fn screen(
    source: Source<'_>,
    (frame, options): (&Frame, &glsl::Options),
    vary: &[Vary],
    until: Instant,
    interrupt: &AtomicBool,
) -> Result<Screened, VaryError> {
    let scopes = source.scopes();
    let named = vary.iter().map(|vary| vary.resolve(&scopes));
    let named: Vec<(Parameter, Vec<f64>)> = named.collect::<Result<_, _>>()?;
    let scale = (MAX_PIXELS / f64::from(frame.size[0]) / f64::from(frame.size[1]))
        .sqrt()
        .min(1.0);
    let frame = Frame {
        size: frame
            .size
            .map(|side| (f64::from(side) * scale).round().max(1.0) as u32),
        ..frame.clone()
    };
    let own = source
        .compile(&[], options)
        .and_then(|own| render(&own, &frame, until));
    let Some((image, time)) = own else {
        let settings = every_value(&named);
        return Ok(Screened {
            settings,
            ..Screened::default()
        });
    };
    let own = Trial {
        value: 0.0,
        image,
        time,
        share: 0.0,
    };
    let screening = Screening {
        source,
        options,
        frame,
        own,
        until,
        interrupt,
    };
    let mut screened = Screened::default();
    if named.is_empty() {
        let mut parameters = proposals(&scopes);
        parameters.push(Parameter::resolution());
        screening.propose(&parameters, &mut screened);
    } else {
        for (parameter, values) in &named {
            screening.compare_generous(parameter, Some(values), &mut screened);
        }
        screened.settings = every_value(&named);
    }
    Ok(screened)
}

/// Each value of each parameter alone; of two parameters also all pairs of values.
fn every_value(named: &[(Parameter, Vec<f64>)]) -> Vec<Vec<Setting>> {
    let each = named
        .iter()
        .flat_map(|(parameter, values)| values.iter().map(|&value| vec![parameter.set(value)]));
    let mut settings: Vec<_> = each.collect();
    if let [(first, firsts), (second, seconds)] = named {
        for &one in firsts {
            settings.extend(
                seconds
                    .iter()
                    .map(|&other| vec![first.set(one), second.set(other)]),
            );
        }
    }
    settings
}

fn render(shader: &Shader, frame: &Frame, until: Instant) -> Option<(Image, f64)> {
    let (mut image, mut time) = shader.evaluate::<f32>(frame, (), until).ok()?;
    for _ in 1..REPETITIONS {
        if time > RELIABLE_TIME {
            break;
        }
        let again = shader.evaluate::<f32>(frame, (), until).ok()?;
        time = time.min(again.1);
        image = again.0;
    }
    Some((image, time.as_secs_f64()))
}

/// The share of visible pixels.
fn share(one: &Image, other: &Image) -> f64 {
    visible_pixels(one, other) as f64 / one.pixels().len() as f64
}

impl Screening<'_> {
    fn is_over(&self) -> bool {
        self.interrupt.load(Ordering::Relaxed) || Instant::now() > self.until
    }

    fn try_settings(&self, settings: &[Setting]) -> Option<Trial> {
        if self.is_over() {
            return None;
        }
        let shader = self.source.compile(settings, self.options)?;
        let (image, time) = render(&shader, &self.frame, self.until)?;
        Some(Trial {
            value: settings.first().map_or(0.0, |setting| setting.value),
            share: share(&self.own.image, &image),
            image,
            time: time / self.own.time,
        })
    }

    /// Chooses settings of these parameters, and of several together.
    fn propose(&self, parameters: &[Parameter], screened: &mut Screened) {
        // The fastest invisible setting of each parameter, with its time.
        let mut invisible: Vec<(f64, Setting)> = Vec::new();
        let mut visible: Vec<(f64, Setting)> = Vec::new();
        for parameter in parameters {
            self.compare_generous(parameter, None, screened);
            let trials = self.useful_trials(parameter);
            screened.tried.extend(trials.iter().map(|trial| Tried {
                setting: parameter.set(trial.value),
                time: trial.time,
                changed_share: trial.share,
            }));
            let mut last = None;
            for limit in SHARES {
                let within = trials
                    .iter()
                    .filter(|trial| trial.share <= limit && trial.time <= MAX_TIME);
                let Some(best) = within.min_by(|a, b| a.time.total_cmp(&b.time)) else {
                    continue;
                };
                if last != Some(best.value) {
                    let list = if limit == SHARES[0] {
                        &mut invisible
                    } else {
                        &mut visible
                    };
                    list.push((best.time, parameter.set(best.value)));
                }
                last = Some(best.value);
            }
        }
        invisible.sort_by(|a, b| a.0.total_cmp(&b.0));
        visible.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some(together) = self.together(&invisible) {
            screened.settings.push(together);
        }
        let single = invisible
            .into_iter()
            .chain(visible)
            .map(|(_, setting)| vec![setting]);
        screened.settings.extend(single);
        screened.settings.truncate(MAX_SETTINGS);
    }

    /// Renders the cheaper values of a parameter, from the cheapest one, until a value is invisible, or until
    /// even the cheapest one does not pay.
    fn useful_trials(&self, parameter: &Parameter) -> Vec<Trial> {
        let mut trials = Vec::new();
        for (index, &value) in parameter.cheaper().iter().rev().enumerate() {
            let Some(trial) = self.try_settings(&[parameter.set(value)]) else {
                continue;
            };
            let is_useless = index == 0 && trial.time > MAX_TIME;
            let is_invisible = trial.share <= SHARES[0];
            trials.push(trial);
            // Values nearer to the shader's own only cost more.
            if is_useless || is_invisible {
                break;
            }
        }
        trials
    }

    /// The fastest settings of all parameters that are invisible also together.
    fn together(&self, invisible: &[(f64, Setting)]) -> Option<Vec<Setting>> {
        let mut settings: Vec<Setting> = Vec::new();
        for (_, setting) in invisible {
            settings.push(setting.clone());
            let trial = (settings.len() > 1).then(|| self.try_settings(&settings));
            if trial.is_some_and(|trial| trial.is_none_or(|trial| trial.share > SHARES[0])) {
                settings.pop();
            }
        }
        (settings.len() > 1).then_some(settings)
    }

    /// Compares the shader's own value with more accurate ones. If they converge, the reference has the most
    /// accurate one, otherwise that of the shader, or the most accurate of those that the user gives.
    fn compare_generous(&self, parameter: &Parameter, given: Option<&[f64]>, screened: &mut Screened) {
        let values = [1, 2].map(|level| parameter.role.generous(parameter.value, level));
        let [Some(more), Some(most)] = values else {
            return;
        };
        let Some(first) = self.try_settings(&[parameter.set(more)]) else {
            return;
        };
        if first.share <= SHARES[0] {
            return;
        }
        let Some(second) = self.try_settings(&[parameter.set(most)]) else {
            return;
        };
        let rest = share(&first.image, &second.image);
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        if first.share <= MAX_ACCURACY_SHARE && (rest <= SHARES[0] || rest <= first.share / 4.0) {
            screened.generous.push(parameter.set(most));
            screened.notes.push(format!(
                "`{}` = {} is visible: {} changes {} of the pixels, and is the value of the reference",
                parameter.name,
                shown(parameter.value),
                shown(most),
                percent(second.share)
            ));
        } else {
            // Such as the number of objects, which is no accuracy.
            let accurate = given.and_then(|given| {
                let improves = |value: f64| (value - parameter.value) * (more - parameter.value) > 0.0;
                let better = given.iter().copied().filter(|&value| improves(value));
                better.max_by(|a, b| {
                    (a - parameter.value)
                        .abs()
                        .total_cmp(&(b - parameter.value).abs())
                })
            });
            screened
                .generous
                .extend(accurate.map(|value| parameter.set(value)));
            screened.notes.push(format!(
                "`{}` is no matter of accuracy: from {} to {} {} of the pixels change, to {} another {}; the reference has {}",
                parameter.name,
                shown(parameter.value),
                shown(more),
                percent(first.share),
                shown(most),
                percent(rest),
                shown(accurate.unwrap_or(parameter.value)),
            ));
        }
    }
}
