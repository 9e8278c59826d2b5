//! `toyproof similar`: shaders that are near-identical.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::PathBuf;

use toyproof_classroom::similar::fingerprint::Fingerprints;
use toyproof_diagnostic::{Deadline, grouped, plural};
use toyproof_project::files;

use super::inputs::LanguageArgs;
use super::shader::{Shader, Unusable, find};
use super::{Exit, Terminal};

/// List pairs of shaders that share much of their structure
///
/// Names, numbers, layout and the order of functions do not matter. Parts that more than half of the shaders
/// have, and those of the shaders given with --except, such as a template, do not count. A pair is a reason
/// to read both shaders, and proves nothing; it is not part of a verdict.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  toyproof similar homework
  toyproof similar homework --except template.glsl --threshold 80

Exit code: 0 whether or not there are pairs, 2 for any error.")]
pub(super) struct Args {
    /// Shaders: files, folders, or - for standard input
    #[arg(required = true)]
    shaders: Vec<PathBuf>,
    /// Shaders whose parts everyone may use
    #[arg(long, value_name = "SHADER")]
    except: Vec<PathBuf>,
    /// The least shared part of the smaller shader, in percent
    #[arg(long, value_name = "PERCENT", default_value_t = 60, value_parser = clap::value_parser!(u8).range(1..=100))]
    threshold: u8,
    #[command(flatten)]
    language: LanguageArgs,
}

/// Shaders with fewer fingerprints are too small to compare.
const MIN_FINGERPRINTS: usize = 8;

/// The time limit for reading a shader.
const TIME_LIMIT: std::time::Duration = std::time::Duration::from_secs(10);

/// A shader to compare.
struct Subject {
    name: String,
    /// The fingerprints of its tree; `None` if it does not compile.
    tree: Option<Fingerprints>,
    /// Those of its text.
    text: Fingerprints,
}

impl Subject {
    /// The fingerprints with which it is compared, unless the other shader does not compile.
    fn own(&self) -> &Fingerprints {
        self.tree.as_ref().unwrap_or(&self.text)
    }

    /// The common fingerprints: of trees, or else of texts.
    fn comparable<'a>(&'a self, other: &'a Self) -> [&'a Fingerprints; 2] {
        match (&self.tree, &other.tree) {
            (Some(one), Some(other)) => [one, other],
            _ => [&self.text, &other.text],
        }
    }
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let mut shaders = read(&args.shaders, &args.language, terminal);
    let mut excepted = read(&args.except, &args.language, terminal);
    leave_out(&mut shaders, &mut excepted, |shader| shader.tree.as_mut());
    leave_out(&mut shaders, &mut excepted, |shader| Some(&mut shader.text));
    let (shaders, small): (Vec<_>, Vec<_>) = shaders
        .into_iter()
        .partition(|shader| shader.own().len() >= MIN_FINGERPRINTS);
    let pairs = pairs(&shaders, f64::from(args.threshold) / 100.0);
    for &(a, b, share) in &pairs {
        let (one, other) = (&shaders[a], &shaders[b]);
        let [of_one, of_other] = one.comparable(other);
        let [lines, other_lines] =
            [of_one.shared_lines(of_other), of_other.shared_lines(of_one)].map(|ranges| list(&ranges));
        terminal.result(&format!(
            "{:>3.0} %  {}:{lines}\n       {}:{other_lines}",
            100.0 * share,
            one.name,
            other.name
        ));
    }
    for group in groups(&pairs).iter().filter(|group| group.len() > 2) {
        let names: Vec<_> = group.iter().map(|&at| shaders[at].name.as_str()).collect();
        terminal.result(&format!(
            "group of {}: {}",
            grouped(group.len() as u64),
            names.join(", ")
        ));
    }
    let found = pairs.len() as u64;
    let count = shaders.len() as u64;
    terminal.note(&format!(
        "\n{} {} of {} {} {} at least {} % of the smaller one{}",
        grouped(found),
        plural(found, "pair", "pairs"),
        grouped(count),
        plural(count, "shader", "shaders"),
        plural(found, "shares", "share"),
        args.threshold,
        names(&shaders)
    ));
    if !small.is_empty() {
        let count = small.len() as u64;
        terminal.note(&format!(
            "{} {} to compare{}",
            grouped(count),
            plural(
                count,
                "shader has too little of its own",
                "shaders have too little of their own"
            ),
            names(&small)
        ));
    }
    Exit::Success
}

/// The names of a few shaders, after a colon.
fn names(shaders: &[Subject]) -> String {
    const MAX_NAMES: usize = 5;
    if shaders.is_empty() || shaders.len() > MAX_NAMES {
        return String::new();
    }
    let names: Vec<_> = shaders.iter().map(|shader| shader.name.as_str()).collect();
    format!(": {}", names.join(", "))
}

/// Reads shaders; what cannot be compared is reported and left out.
fn read(paths: &[PathBuf], language: &LanguageArgs, terminal: &Terminal) -> Vec<Subject> {
    let mut shaders = Vec::new();
    for input in find(paths, terminal) {
        let shader = Shader::load(&input, language, Deadline::after(TIME_LIMIT));
        let text = input.as_ref().ok().and_then(|input| files::read(input).ok());
        let text = text.map(|texts| {
            let texts: Vec<_> = texts.files().iter().map(|file| file.text()).collect();
            Fingerprints::of_text(&texts.join("\n"))
        });
        let (tree, reason) = match &shader.checked {
            Ok(checked) => (Some(Fingerprints::of(checked, &shader.files)), ""),
            Err(Unusable::Invalid(_)) => (None, "it does not compile"),
            Err(Unusable::Unreadable(error) | Unusable::Unrendered(error)) => (None, error.reason.as_str()),
        };
        match text {
            Some(text) if tree.is_some() || matches!(shader.checked, Err(Unusable::Invalid(_))) => {
                if tree.is_none() {
                    terminal.warn(format_args!("{} is compared by its text: {reason}", shader.name));
                }
                shaders.push(Subject {
                    name: shader.name,
                    tree,
                    text,
                });
            }
            _ => terminal.warn(format_args!("{} is not compared: {reason}", shader.name)),
        }
    }
    shaders
}

/// Removes one kind of fingerprints: those that everyone may have, and those that more than half of the shaders
/// have, if there are enough to say so.
fn leave_out(
    shaders: &mut [Subject],
    excepted: &mut [Subject],
    kind: fn(&mut Subject) -> Option<&mut Fingerprints>,
) {
    const ENOUGH: usize = 6;
    let mut all: Vec<_> = shaders.iter_mut().filter_map(kind).collect();
    let mut counts: HashMap<u64, usize> = HashMap::new();
    for hash in all.iter().flat_map(|fingerprints| fingerprints.hashes()) {
        *counts.entry(hash).or_default() += 1;
    }
    let is_common = |&(_, count): &(u64, usize)| all.len() >= ENOUGH && 2 * count > all.len();
    let common = counts.into_iter().filter(is_common).map(|(hash, _)| hash);
    let excepted = excepted.iter_mut().filter_map(kind);
    let left_out: HashSet<u64> = common
        .chain(excepted.flat_map(|fingerprints| fingerprints.hashes().collect::<Vec<_>>()))
        .collect();
    for fingerprints in &mut all {
        fingerprints.remove(&left_out);
    }
}

/// The pairs that share at least a part of the smaller shader, the most similar first.
fn pairs(shaders: &[Subject], threshold: f64) -> Vec<(usize, usize, f64)> {
    let mut pairs = Vec::new();
    for (b, other) in shaders.iter().enumerate() {
        for (a, one) in shaders[..b].iter().enumerate() {
            let [of_one, of_other] = one.comparable(other);
            let smaller = of_one.len().min(of_other.len());
            let share = of_one.shared(of_other) as f64 / smaller as f64;
            if smaller >= MIN_FINGERPRINTS && share >= threshold {
                pairs.push((a, b, share));
            }
        }
    }
    pairs.sort_by(|a, b| b.2.total_cmp(&a.2).then((a.0, a.1).cmp(&(b.0, b.1))));
    pairs
}

/// The connected shaders of all pairs.
fn groups(pairs: &[(usize, usize, f64)]) -> Vec<Vec<usize>> {
    let mut of: BTreeMap<usize, usize> = BTreeMap::new();
    for &(a, b, _) in pairs {
        let [first, second] = [a, b].map(|at| of.get(&at).copied().unwrap_or(at));
        let group = first.min(second);
        of.entry(a).or_insert(first);
        of.entry(b).or_insert(second);
        for value in of.values_mut().filter(|value| [first, second].contains(value)) {
            *value = group;
        }
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (at, group) in of {
        groups.entry(group).or_default().push(at);
    }
    groups.into_values().collect()
}

/// Ranges of lines, for people.
fn list(ranges: &[[usize; 2]]) -> String {
    let range = |[first, last]: &[usize; 2]| {
        if first == last {
            first.to_string()
        } else {
            format!("{first}-{last}")
        }
    };
    ranges.iter().map(range).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_with_a_common_shader_are_a_group() {
        let groups = groups(&[(0, 1, 1.0), (4, 5, 0.9), (2, 3, 0.8), (1, 3, 0.7)]);
        assert_eq!(groups, [vec![0, 1, 2, 3], vec![4, 5]]);
    }
}
