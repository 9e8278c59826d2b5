//! `junit.xml`: a test case per shader or per test of a function, for continuous integration.

use std::io::{self, Write};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use toyproof_verify::Verdict;

use super::{Hints, Record, details};

/// Writes the file, as far as the hints permit. A fault of the shader, or a violated requirement of an
/// assignment, is a failure; an error that prevented its verdict is an error; an inconclusive verdict is
/// skipped. Characters that XML 1.0 forbids are removed.
///
/// # Errors
/// The file cannot be written.
pub fn junit(records: &[Record], hints: Hints, out: &mut dyn Write) -> io::Result<()> {
    let cases: Vec<_> = records.iter().map(|record| test_case(record, hints)).collect();
    test_suite("toyproof check", &cases, out)
}

/// A test case of a suite.
#[derive(Debug, Clone)]
pub struct TestCase {
    /// What was tested.
    pub name: String,
    /// The group of the test.
    pub class: String,
    /// How long it took.
    pub seconds: f64,
    /// The result.
    pub status: TestStatus,
    /// The kind of the fault.
    pub kind: String,
    /// The fault, in one sentence.
    pub message: String,
    /// Everything known about it.
    pub details: String,
}

/// Writes a suite of test cases. Characters that XML 1.0 forbids are removed.
///
/// # Errors
/// The file cannot be written.
pub fn test_suite(name: &str, cases: &[TestCase], out: &mut dyn Write) -> io::Result<()> {
    // The totals precede the test cases.
    let count = |status| {
        cases
            .iter()
            .filter(|case| case.status == status)
            .count()
            .to_string()
    };
    let [failures, errors, skipped] =
        [TestStatus::Failure, TestStatus::Error, TestStatus::Skipped].map(count);
    let tests = cases.len().to_string();
    let seconds = cases.iter().fold(0.0, |sum, case| sum + case.seconds);
    let time = format!("{seconds:.3}");
    let counts = [
        ("tests", tests.as_str()),
        ("failures", &failures),
        ("errors", &errors),
        ("time", &time),
    ];
    let mut writer = Writer::new_with_indent(out, b' ', 4);
    writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    // `junit-10.xsd` has no attribute `skipped` of the first element; Jenkins refuses it.
    let suites = writer
        .create_element("testsuites")
        .with_attribute(("name", "toyproof"));
    suites.with_attributes(counts).write_inner_content(|writer| {
        let suite = writer.create_element("testsuite").with_attribute(("name", name));
        let suite = suite
            .with_attributes(counts)
            .with_attribute(("skipped", skipped.as_str()));
        suite.write_inner_content(|writer| {
            for case in cases {
                write_test_case(case, writer)?;
            }
            Ok(())
        })?;
        Ok(())
    })?;
    writer.into_inner().write_all(b"\n")
}

/// The status of a test case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TestStatus {
    /// It passed.
    Passed,
    /// What is tested is wrong.
    Failure,
    /// It could not be tested.
    Error,
    /// Nothing was compared.
    Skipped,
}

impl TestStatus {
    fn new(record: &Record) -> Self {
        match Self::from(record.verdict) {
            Self::Passed if !record.is_passed() => Self::Failure,
            status => status,
        }
    }
}

impl From<Verdict> for TestStatus {
    /// If nothing was compared, the test was skipped.
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Correct => Self::Passed,
            Verdict::Missing | Verdict::Invalid | Verdict::Wrong | Verdict::Unstable => Self::Failure,
            Verdict::Timeout | Verdict::Error => Self::Error,
            Verdict::Chaotic | Verdict::Inconclusive | Verdict::Ok => Self::Skipped,
        }
    }
}

/// The test case of a record, as far as the hints permit.
fn test_case(record: &Record, hints: Hints) -> TestCase {
    let status = TestStatus::new(record);
    let redacted = record.clone().redacted(hints);
    let (kind, message) = match (
        TestStatus::from(record.verdict),
        redacted.faults().into_iter().next(),
    ) {
        (TestStatus::Passed, Some((kind, sentence))) => (kind.to_owned(), sentence),
        _ => (record.verdict.to_string(), redacted.reason_and_lateness()),
    };
    TestCase {
        name: record.shader.clone(),
        class: record.compared_with().unwrap_or("no reference").to_owned(),
        seconds: record.seconds.total(),
        status,
        kind,
        message,
        details: details(&redacted),
    }
}

fn write_test_case(case: &TestCase, writer: &mut Writer<impl Write>) -> io::Result<()> {
    let [details, name, class, message, kind] =
        [&case.details, &case.name, &case.class, &case.message, &case.kind].map(|text| xml_text(text));
    let time = format!("{:.3}", case.seconds);
    let element = writer.create_element("testcase").with_attributes([
        ("name", name.as_str()),
        ("classname", &class),
        ("time", &time),
    ]);
    element.write_inner_content(|writer| {
        let element = match case.status {
            TestStatus::Passed => "system-out",
            TestStatus::Failure => "failure",
            TestStatus::Error => "error",
            TestStatus::Skipped => "skipped",
        };
        let element = writer.create_element(element);
        let element = match case.status {
            TestStatus::Passed => element,
            _ => element.with_attributes([("message", message.as_str()), ("type", &kind)]),
        };
        element.write_text_content(BytesText::new(&details))?;
        Ok(())
    })?;
    Ok(())
}

/// Removes ANSI escape sequences, and the characters that XML 1.0 forbids.
fn xml_text(text: &str) -> String {
    let mut text = strip_ansi_escapes::strip_str(text);
    text.retain(|character| {
        matches!(character, '\t' | '\n' | '\r' | ' '..) && !matches!(character, '\u{fffe}' | '\u{ffff}')
    });
    text
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use roxmltree::{Document, Node};

    use super::*;
    use crate::record::samples::{correct, every_verdict, invalid};
    use crate::written;

    fn xml(records: &[Record]) -> String {
        written(|out| junit(records, Hints::Fix, out))
    }

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
        let text = xml(&every_verdict());
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
        let text = xml(&[correct(), hostile]);
        let document = Document::parse(&text).unwrap();
        follows(document.root_element());
        let cases = document
            .descendants()
            .filter(|node| node.has_tag_name("testcase"));
        let names: Vec<_> = cases.map(|case| case.attribute("name")).collect();
        assert_eq!(names, [Some("correct"), Some("\"/><script>&]]>.glsl")]);
    }
}
