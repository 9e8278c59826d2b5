//! `junit.xml`: a test case per shader, for continuous integration.

use std::time::Duration;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite, XmlString};
use toyproof_verify::Verdict;

use super::{Record, details};

/// Formats the file. A fault of the shader, or a violated requirement of an assignment, is a failure; what
/// prevented its verdict is an error; an inconclusive verdict is skipped. Characters that XML 1.0 forbids are
/// removed.
#[must_use]
pub fn junit(records: &[Record]) -> String {
    let time = records.iter().map(time).sum();
    let mut suite = TestSuite::new("toyproof check");
    suite.set_time(time).add_test_cases(records.iter().map(test_case));
    let mut report = Report::new("toyproof");
    report.set_time(time).add_test_suite(suite);
    // Writing to memory does not fail.
    let xml = report.to_string().unwrap_or_default();
    // `junit-10.xsd` has no such attribute of `testsuites`, the first element; Jenkins refuses it.
    xml.replacen(&format!(" skipped=\"{}\"", report.skipped), "", 1)
}

fn test_case(record: &Record) -> TestCase {
    let details = xml_text(&details(record));
    let fault = record.faults().into_iter().next();
    let (status, kind, message) = match (status(record.verdict), fault) {
        (None, Some((kind, sentence))) => {
            let failure = TestCaseStatus::non_success(NonSuccessKind::Failure);
            (Some(failure), kind.to_owned(), sentence)
        }
        (status, _) => (status, record.verdict.to_string(), record.reason_and_lateness()),
    };
    let status = status.map(|mut status| {
        status
            .set_type(kind)
            .set_message(xml_text(&message))
            .set_description(details.as_str());
        status
    });
    let passed = status.is_none();
    let name = xml_text(&record.shader);
    let mut case = TestCase::new(name, status.unwrap_or_else(TestCaseStatus::success));
    case.set_classname(xml_text(record.compared_with().unwrap_or("no reference")))
        .set_time(time(record));
    if passed {
        case.set_system_out(details);
    }
    case
}

/// The status of a verdict; none if the shader passes. Where nothing was compared, the test was skipped.
fn status(verdict: Verdict) -> Option<TestCaseStatus> {
    match verdict {
        Verdict::Correct => None,
        Verdict::Missing | Verdict::Invalid | Verdict::Wrong | Verdict::Unstable => {
            Some(TestCaseStatus::non_success(NonSuccessKind::Failure))
        }
        Verdict::Timeout | Verdict::Error => Some(TestCaseStatus::non_success(NonSuccessKind::Error)),
        Verdict::Chaotic | Verdict::Inconclusive | Verdict::Ok => Some(TestCaseStatus::skipped()),
    }
}

/// Removes the noncharacters that XML 1.0 forbids; `XmlString` removes control characters.
fn xml_text(text: &str) -> XmlString {
    XmlString::new(text.replace(['\u{fffe}', '\u{ffff}'], ""))
}

fn time(record: &Record) -> Duration {
    Duration::try_from_secs_f64(record.seconds.total()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use roxmltree::{Document, Node};

    use super::*;
    use crate::report::record::samples::{correct, every_verdict, invalid};

    /// The attributes and the children that each element may have in the schema that Jenkins publishes
    /// (`junit-10.xsd`). Attributes with `!` are required.
    const GRAMMAR: [(&str, &[&str], &[&str]); 7] = [
        (
            "testsuites",
            &["name", "time", "tests", "failures", "errors"],
            &["testsuite"],
        ),
        (
            "testsuite",
            &["name!", "tests!", "failures!", "errors!", "time", "skipped"],
            &["testcase"],
        ),
        (
            "testcase",
            &["name!", "classname", "time"],
            &["failure", "error", "skipped", "system-out"],
        ),
        ("failure", &["message", "type"], &[]),
        ("error", &["message", "type"], &[]),
        ("skipped", &["message", "type"], &[]),
        ("system-out", &[], &[]),
    ];

    fn follows(node: Node) {
        let name = node.tag_name().name();
        let (_, attributes, children) = GRAMMAR.iter().find(|(own, ..)| *own == name).expect(name);
        let known: BTreeSet<_> = attributes.iter().map(|name| name.trim_end_matches('!')).collect();
        for attribute in node.attributes() {
            assert!(
                known.contains(attribute.name()),
                "{name} has {}",
                attribute.name()
            );
        }
        for needed in attributes.iter().filter_map(|name| name.strip_suffix('!')) {
            assert!(node.has_attribute(needed), "{name} has no {needed}");
        }
        for child in node.children().filter(Node::is_element) {
            assert!(children.contains(&child.tag_name().name()), "{child:?} in {name}");
            follows(child);
        }
    }

    #[test]
    fn verdicts_map_to_junit_elements() {
        let text = junit(&every_verdict());
        let document = Document::parse(&text).unwrap();
        follows(document.root_element());
        let told: Vec<_> = document
            .descendants()
            .filter(|node| node.has_tag_name("testcase"))
            .map(|case| {
                let kinds = ["failure", "error", "skipped"];
                let kind = case
                    .children()
                    .find(|child| kinds.contains(&child.tag_name().name()));
                let words = kind.map_or("passed", |kind| {
                    assert_eq!(kind.attribute("type"), case.attribute("name"));
                    assert!(!kind.attribute("message").unwrap().is_empty());
                    kind.tag_name().name()
                });
                (case.attribute("name").unwrap().to_owned(), words.to_owned())
            })
            .collect();
        let wanted = [
            ("missing", "failure"),
            ("invalid", "failure"),
            ("timeout", "error"),
            ("error", "error"),
            ("wrong", "failure"),
            ("unstable", "failure"),
            ("inconclusive", "skipped"),
            ("correct", "passed"),
            ("ok", "skipped"),
        ];
        assert_eq!(told, wanted.map(|(a, b)| (a.to_owned(), b.to_owned())));
        let suite = document
            .descendants()
            .find(|node| node.has_tag_name("testsuite"))
            .unwrap();
        let count = |name| suite.attribute(name).unwrap();
        assert_eq!(
            ["tests", "failures", "errors", "skipped"].map(count),
            ["9", "4", "2", "2"]
        );
    }

    #[test]
    fn hostile_names_and_messages_stay_text() {
        let mut hostile = invalid();
        hostile.shader = "\"/><script>\u{0}\u{1b}[31m\u{ffff}&]]>.glsl".to_owned();
        hostile.reason = "<failure>".to_owned();
        let text = junit(&[correct(), hostile]);
        let document = Document::parse(&text).unwrap();
        follows(document.root_element());
        let cases = document
            .descendants()
            .filter(|node| node.has_tag_name("testcase"));
        let names: Vec<_> = cases.map(|case| case.attribute("name")).collect();
        assert_eq!(names, [Some("correct"), Some("\"/><script>&]]>.glsl")]);
    }
}
