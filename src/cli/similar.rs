//! `toyproof similar`: shaders that are near-identical.

use std::path::PathBuf;

use toyproof_classroom::similar::fingerprint::Fingerprints;
use toyproof_classroom::similar::pairs::{Pair, Subject, groups, leave_out_common, pairs};
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

/// The time limit for reading a shader.
const TIME_LIMIT: std::time::Duration = std::time::Duration::from_secs(10);

pub(super) fn run(args: &Args, terminal: &Terminal) -> Exit {
    let mut shaders = read(&args.shaders, &args.language, terminal);
    let mut excepted = read(&args.except, &args.language, terminal);
    leave_out_common(&mut shaders, &mut excepted);
    let (shaders, small): (Vec<_>, Vec<_>) = shaders.into_iter().partition(Subject::is_large_enough);
    let pairs = pairs(&shaders, f64::from(args.threshold) / 100.0);
    for &Pair {
        shaders: [a, b],
        share,
    } in &pairs
    {
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

/// The names of a few shaders, after a colon; more would not fit on a line.
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
            Fingerprints::from_text(&texts.join("\n"))
        });
        let (tree, reason) = match (shader.image(), shader.unrendered()) {
            (Ok(_), Some(reason)) => (None, reason),
            (Ok(checked), None) => (
                Some(Fingerprints::from_tree(checked, &shader.files)),
                String::new(),
            ),
            (Err(Unusable::Invalid(_)), _) => (None, "it does not compile".to_owned()),
            (Err(Unusable::Unreadable(error)), _) => (None, error.reason.clone()),
        };
        match text {
            Some(text) if tree.is_some() || matches!(shader.content, Err(Unusable::Invalid(_))) => {
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
