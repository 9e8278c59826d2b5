//! `toyproof similar`: shaders that are near-identical.

mod fingerprint;

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::PathBuf;

use toyproof_diagnostic::{Deadline, grouped, plural};

use self::fingerprint::Fingerprints;
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

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let mut shaders = read(&args.shaders, &args.language, terminal);
    let count = shaders.len();
    let mut left_out: HashSet<u64> = read(&args.except, &args.language, terminal)
        .iter()
        .flat_map(|(_, excepted)| excepted.hashes().collect::<Vec<_>>())
        .collect();
    left_out.extend(common(&shaders));
    for (_, fingerprints) in &mut shaders {
        fingerprints.remove(&left_out);
    }
    shaders.retain(|(_, fingerprints)| fingerprints.len() >= MIN_FINGERPRINTS);
    let small = (count - shaders.len()) as u64;
    let pairs = pairs(&shaders, f64::from(args.threshold) / 100.0);
    for &(a, b, share) in &pairs {
        let ((name, one), (other_name, other)) = (&shaders[a], &shaders[b]);
        let lines = [one.shared_lines(other), other.shared_lines(one)].map(|ranges| list(&ranges));
        let [lines, other_lines] = lines;
        terminal.result(&format!(
            "{:>3.0} %  {name}:{lines}\n       {other_name}:{other_lines}",
            100.0 * share
        ));
    }
    for group in groups(&pairs).iter().filter(|group| group.len() > 2) {
        let names: Vec<_> = group.iter().map(|&at| shaders[at].0.as_str()).collect();
        terminal.result(&format!(
            "group of {}: {}",
            grouped(group.len() as u64),
            names.join(", ")
        ));
    }
    let found = pairs.len() as u64;
    terminal.note(&format!(
        "\n{} {} of {} shaders {} at least {} % of the smaller one",
        grouped(found),
        plural(found, "pair", "pairs"),
        grouped(shaders.len() as u64),
        plural(found, "shares", "share"),
        args.threshold
    ));
    if small > 0 {
        terminal.note(&format!(
            "{} {} too little of its own to compare",
            grouped(small),
            plural(small, "shader has", "shaders have")
        ));
    }
    Exit::Success
}

/// Reads shaders; those that do not compile are reported and left out.
fn read(paths: &[PathBuf], language: &LanguageArgs, terminal: &Terminal) -> Vec<(String, Fingerprints)> {
    let mut shaders = Vec::new();
    for input in find(paths, terminal) {
        let shader = Shader::load(&input, language, Deadline::after(TIME_LIMIT));
        match &shader.checked {
            Ok(checked) => {
                let fingerprints = Fingerprints::of(checked, &shader.files);
                shaders.push((shader.name, fingerprints));
            }
            Err(unusable) => {
                let reason = match unusable {
                    Unusable::Unrendered(error) => &error.reason,
                    _ => "it does not compile",
                };
                terminal.warn(format_args!("{} is not compared: {reason}", shader.name));
            }
        }
    }
    shaders
}

/// The fingerprints that more than half of the shaders have, if there are enough to say so.
fn common(shaders: &[(String, Fingerprints)]) -> HashSet<u64> {
    const ENOUGH: usize = 6;
    let mut counts: HashMap<u64, usize> = HashMap::new();
    for hash in shaders.iter().flat_map(|(_, fingerprints)| fingerprints.hashes()) {
        *counts.entry(hash).or_default() += 1;
    }
    let is_common = |&(_, count): &(u64, usize)| shaders.len() >= ENOUGH && 2 * count > shaders.len();
    counts
        .into_iter()
        .filter(is_common)
        .map(|(hash, _)| hash)
        .collect()
}

/// The pairs that share at least a part of the smaller shader, the most similar first.
fn pairs(shaders: &[(String, Fingerprints)], threshold: f64) -> Vec<(usize, usize, f64)> {
    let mut pairs = Vec::new();
    for (b, (_, other)) in shaders.iter().enumerate() {
        for (a, (_, one)) in shaders[..b].iter().enumerate() {
            let share = one.shared(other) as f64 / one.len().min(other.len()) as f64;
            if share >= threshold {
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
