//! `junit.xml`: a test case per shader, for continuous integration.

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
    // The totals precede the test cases.
    let count = |status| {
        let statuses = records.iter().map(Status::new);
        statuses.filter(|found| *found == status).count().to_string()
    };
    let [failures, errors, skipped] = [Status::Failure, Status::Error, Status::Skipped].map(count);
    let tests = records.len().to_string();
    let seconds = records
        .iter()
        .fold(0.0, |sum, record| sum + record.seconds.total());
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
        let suite = writer
            .create_element("testsuite")
            .with_attribute(("name", "toyproof check"));
        let suite = suite
            .with_attributes(counts)
            .with_attribute(("skipped", skipped.as_str()));
        suite.write_inner_content(|writer| {
            for record in records {
                write_test_case(&record.clone().redacted(hints), writer)?;
            }
            Ok(())
        })?;
        Ok(())
    })?;
    writer.into_inner().write_all(b"\n")
}

/// The status of a test case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Status {
    Passed,
    Failure,
    Error,
    Skipped,
}

impl Status {
    fn new(record: &Record) -> Self {
        match Self::from(record.verdict) {
            Self::Passed if !record.faults().is_empty() => Self::Failure,
            status => status,
        }
    }
}

impl From<Verdict> for Status {
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

fn write_test_case(record: &Record, writer: &mut Writer<impl Write>) -> io::Result<()> {
    let details = xml_text(&details(record));
    let name = xml_text(&record.shader);
    let class = xml_text(record.compared_with().unwrap_or("no reference"));
    let time = format!("{:.3}", record.seconds.total());
    let case = writer.create_element("testcase").with_attributes([
        ("name", name.as_str()),
        ("classname", &class),
        ("time", &time),
    ]);
    case.write_inner_content(|writer| {
        let element = match Status::new(record) {
            Status::Passed => "system-out",
            Status::Failure => "failure",
            Status::Error => "error",
            Status::Skipped => "skipped",
        };
        let element = writer.create_element(element);
        let (kind, message) = match (Status::from(record.verdict), record.faults().into_iter().next()) {
            (Status::Passed, Some((kind, sentence))) => (kind.to_owned(), sentence),
            _ => (record.verdict.to_string(), record.reason_and_lateness()),
        };
        let message = xml_text(&message);
        let element = match Status::new(record) {
            Status::Passed => element,
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
