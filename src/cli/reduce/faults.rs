//! The names of faults, and of workarounds that may be left out.

use toyproof_diagnostic::{Code, Severity, one_of};
use toyproof_reduce::fault::Wanted;
use toyproof_translate::lower::Pass;
use toyproof_verify::Verdict;

/// Parses the value of `--fault`.
pub(super) fn parse_fault(text: &str) -> Result<Wanted, String> {
    let expected = "expected naga, driver, toolchain, verdict, verdict=NAME, error=CODE or warning=CODE";
    let code = |code: &str, severity| {
        let code = Code::parse(&code.to_uppercase());
        code.filter(|code| code.severity() == severity)
            .map(Wanted::Diagnostic)
            .ok_or("expected the code of an error (E0123) or of a warning (W0123)".to_owned())
    };
    match text.split_once('=') {
        None => match text {
            "naga" => Ok(Wanted::Naga),
            "driver" => Ok(Wanted::Driver),
            "toolchain" => Ok(Wanted::Toolchain),
            "verdict" => Ok(Wanted::Verdict(None)),
            _ => Err(expected.to_owned()),
        },
        Some(("error", text)) => code(text, Severity::Error),
        Some(("warning", text)) => code(text, Severity::Warning),
        Some(("verdict", text)) => {
            let named = VERDICTS.into_iter().find(|verdict| verdict.to_string() == text);
            let names: Vec<_> = VERDICTS.iter().map(ToString::to_string).collect();
            named
                .map(|verdict| Wanted::Verdict(Some(verdict)))
                .ok_or_else(|| format!("expected the verdict {}", one_of(&names)))
        }
        Some(_) => Err(expected.to_owned()),
    }
}

/// The verdicts on single shaders that are a fault.
const VERDICTS: [Verdict; 5] = [
    Verdict::Invalid,
    Verdict::Timeout,
    Verdict::Wrong,
    Verdict::Unstable,
    Verdict::Inconclusive,
];

/// Parses the value of `--without`.
pub(super) fn parse_pass(text: &str) -> Result<Pass, String> {
    let named = Pass::ALL.iter().find(|pass| pass_name(**pass) == text);
    named.copied().ok_or_else(|| {
        let names: Vec<_> = Pass::ALL.iter().map(|pass| pass_name(*pass)).collect();
        format!("expected {}", one_of(&names))
    })
}

/// The name of a pass in kebab case.
pub(super) fn pass_name(pass: Pass) -> String {
    let mut name = String::new();
    for c in format!("{pass:?}").chars() {
        if c.is_ascii_uppercase() && !name.is_empty() {
            name.push('-');
        }
        name.push(c.to_ascii_lowercase());
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_parsed() {
        assert_eq!(parse_fault("naga"), Ok(Wanted::Naga));
        assert_eq!(
            parse_fault("verdict=wrong"),
            Ok(Wanted::Verdict(Some(Verdict::Wrong)))
        );
        assert_eq!(
            parse_fault("warning=w0003"),
            Ok(Wanted::Diagnostic(Code::parse("W0003").unwrap()))
        );
        for bad in [
            "error=W0003",
            "warning=E0001",
            "verdict=ok",
            "crash",
            "naga=1",
            "error=",
        ] {
            assert!(parse_fault(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn passes_have_names_in_kebab_case() {
        assert_eq!(parse_pass("short-circuit"), Ok(Pass::ShortCircuit));
        assert!(parse_pass("ShortCircuit").is_err());
    }
}
