//! What the parameters of a shader cost: sentences about settings that are faster.

use toyproof_diagnostic::{all_of, grouped, plural};

use super::parameter::{LINE, Setting, shown};
use super::{MethodResult, Report};

/// The least ratio of times at which a setting is worth a sentence.
const MIN_RATIO: f64 = 1.1;

/// The most sentences.
const MAX_SENTENCES: usize = 8;

/// The share of visible pixels up to which a setting is as good as the shader's own.
pub(super) const INVISIBLE_SHARE: f64 = 0.001;

/// A setting compared with the shader's own, on one renderer.
struct Comparison<'a> {
    result: &'a MethodResult,
    own: &'a MethodResult,
}

impl Comparison<'_> {
    /// The ratio of the times, and its spread: the median absolute deviations add up as errors do.
    fn ratio(&self) -> (f64, f64) {
        let [own, other] = [self.own, self.result].map(|result| result.seconds_per_frame);
        let ratio = own.median / other.median.max(1e-9);
        let relative = [own, other].map(|time| time.deviation / time.median.max(1e-9));
        (ratio, ratio * relative[0].hypot(relative[1]))
    }

    fn changed(&self) -> u64 {
        self.result.changed_pixels.unwrap_or(u64::MAX)
    }
}

impl Report {
    /// The settings that are measured, each on all renderers.
    fn comparisons(&self) -> Vec<Vec<Comparison<'_>>> {
        let mut all: Vec<Vec<Comparison<'_>>> = Vec::new();
        let with_settings = self
            .results
            .iter()
            .filter(|result| !result.configuration.settings.is_empty());
        for result in with_settings {
            let mut own = result.configuration.clone();
            own.settings = Vec::new();
            let Some(own) = self.results.iter().find(|result| result.configuration == own) else {
                continue;
            };
            let comparison = Comparison { result, own };
            let same = |known: &&mut Vec<Comparison<'_>>| {
                known[0].result.configuration.settings == result.configuration.settings
            };
            match all.iter_mut().find(same) {
                Some(known) => known.push(comparison),
                None => all.push(vec![comparison]),
            }
        }
        for one in &mut all {
            one.sort_by(|a, b| {
                a.result
                    .configuration
                    .renderer
                    .cmp(&b.result.configuration.renderer)
            });
        }
        all
    }

    /// Sentences about the settings that make the shader faster, those that nobody sees first.
    pub(super) fn advice(&self) -> Vec<String> {
        let pixels = f64::from(self.size[0]) * f64::from(self.size[1]);
        let comparisons = self.comparisons();
        if comparisons.is_empty() {
            return Vec::new();
        }
        let mut faster: Vec<(bool, f64, String)> = Vec::new();
        for of_setting in &comparisons {
            let slowest = of_setting
                .iter()
                .map(|one| one.ratio().0)
                .fold(f64::INFINITY, f64::min);
            let changed = of_setting.iter().map(Comparison::changed).max().unwrap_or(0);
            let is_invisible = changed as f64 <= INVISIBLE_SHARE * pixels;
            if slowest >= MIN_RATIO {
                faster.push((!is_invisible, -slowest, self.sentence(of_setting, changed)));
            }
        }
        if faster.is_empty() {
            return vec![format!(
                "No other setting is {MIN_RATIO} times as fast on all renderers."
            )];
        }
        faster.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let sentences = faster.into_iter().map(|(_, _, sentence)| sentence);
        sentences.take(MAX_SENTENCES).collect()
    }

    fn sentence(&self, of_setting: &[Comparison<'_>], changed: u64) -> String {
        let settings = &of_setting[0].result.configuration.settings;
        let settings: Vec<String> = settings.iter().map(instead).collect();
        let ratios = of_setting.iter().map(|one| {
            let (ratio, spread) = one.ratio();
            format!(
                "{ratio:.1} ± {spread:.1} on {}",
                one.result.configuration.renderer
            )
        });
        let ratios: Vec<String> = ratios.collect();
        let share = 100.0 * changed as f64 / (f64::from(self.size[0]) * f64::from(self.size[1]));
        let noun = plural(changed, "visible pixel", "visible pixels");
        let share = if changed == 0 {
            String::new()
        } else {
            format!(" ({share:.2} %)")
        };
        format!(
            "{}: times as fast: {}; {} {noun}{share}",
            all_of(&settings),
            ratios.join(", "),
            grouped(changed)
        )
    }
}

/// `MAX_STEPS` 96 instead of 256; of a number without a name: 96 instead of 256 in line 7
fn instead(setting: &Setting) -> String {
    let values = format!("{} instead of {}", shown(setting.value), shown(setting.own));
    match setting.parameter.split_once(LINE) {
        Some(("", line)) => format!("{values} in line {line}"),
        Some((what, line)) => format!("{} {values} in line {line}", what.trim_end_matches(" in ")),
        None => format!("`{}` {values}", setting.parameter),
    }
}

#[cfg(test)]
mod tests {
    use super::super::parameter::{Parameter, Place, Role};
    use super::super::tests::{report, result};
    use super::*;

    fn setting(name: &str, value: f64, own: f64) -> Setting {
        let parameter = Parameter {
            name: name.to_owned(),
            role: Role::Count,
            value: own,
            place: Place::Size,
        };
        parameter.set(value)
    }

    #[test]
    fn settings_are_compared_with_the_same_renderer() {
        let mut results = vec![
            result("evaluator", 0.2, 0.0),
            result("lavapipe fast", 0.3, 0.0),
            result("evaluator", 0.1, 0.0),
            result("lavapipe fast", 0.1, 0.0),
            result("evaluator", 0.19, 0.0),
        ];
        for at in [2, 3] {
            results[at].configuration.settings =
                vec![setting("STEPS", 96.0, 256.0), setting("line 7", 2.0, 4.0)];
            results[at].changed_pixels = Some(at as u64);
        }
        results[4].configuration.settings = vec![setting("step in line 9", 0.5, 0.1)];
        results[4].changed_pixels = Some(0);
        let advice = Report {
            size: [100, 10],
            ..report(results)
        }
        .advice();
        // A gain of less than a tenth is not worth a sentence.
        assert_eq!(
            advice,
            [
                "`STEPS` 96 instead of 256 and 2 instead of 4 in line 7: times as fast: 2.0 ± 0.0 on evaluator, \
              3.0 ± 0.0 on lavapipe fast; 3 visible pixels (0.30 %)"
            ]
        );
        assert_eq!(
            instead(&setting("step in line 9", 0.5, 0.1)),
            "step 0.5 instead of 0.1 in line 9"
        );
    }
}
