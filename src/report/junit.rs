//! `junit.xml`: a test case per shader, for continuous integration.

use std::io;

use quick_xml::Writer;
use quick_xml::events::BytesText;
use toyproof_verify::Verdict;

use super::{Record, details};

/// Formats the file. A fault of the shader is a failure; what prevented its verdict is an error; an
/// inconclusive verdict is skipped.
#[must_use]
pub fn junit(records: &[Record]) -> String {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 1);
    // Writing to memory does not fail.
    let _ = suites(&mut writer, records);
    let xml = String::from_utf8(writer.into_inner()).unwrap_or_default();
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{xml}\n")
}

/// The element of a verdict; none for a good one.
fn kind(verdict: Verdict) -> Option<&'static str> {
    match verdict {
        Verdict::Correct | Verdict::Ok => None,
        Verdict::Invalid | Verdict::Wrong | Verdict::Unstable => Some("failure"),
        Verdict::Timeout | Verdict::Error => Some("error"),
        Verdict::Inconclusive => Some("skipped"),
    }
}

fn suites(writer: &mut Writer<Vec<u8>>, records: &[Record]) -> io::Result<()> {
    let count = |name| {
        records
            .iter()
            .filter(|record| kind(record.verdict) == Some(name))
            .count()
    };
    let [tests, failures, errors, skipped] =
        [records.len(), count("failure"), count("error"), count("skipped")].map(|count| count.to_string());
    let time = time(records.iter());
    let counts = [
        ("tests", tests.as_str()),
        ("failures", failures.as_str()),
        ("errors", errors.as_str()),
        ("time", time.as_str()),
    ];
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
        suite.write_inner_content(|writer| records.iter().try_for_each(|record| case(writer, record)))?;
        Ok(())
    })?;
    Ok(())
}

fn case(writer: &mut Writer<Vec<u8>>, record: &Record) -> io::Result<()> {
    let name = xml_text(&record.shader);
    let scene = xml_text(record.scene.as_deref().unwrap_or("no scene"));
    let time = time([record].into_iter());
    let case = writer.create_element("testcase").with_attributes([
        ("name", name.as_str()),
        ("classname", scene.as_str()),
        ("time", time.as_str()),
    ]);
    let details = xml_text(&details(record));
    case.write_inner_content(|writer| {
        let text = BytesText::new(&details);
        if let Some(kind) = kind(record.verdict) {
            let (message, verdict) = (xml_text(&record.reason), record.verdict.to_string());
            let about = [("message", message.as_str()), ("type", verdict.as_str())];
            writer
                .create_element(kind)
                .with_attributes(about)
                .write_text_content(text)?;
        } else {
            writer.create_element("system-out").write_text_content(text)?;
        }
        Ok(())
    })?;
    Ok(())
}

/// The total time in seconds.
fn time<'a>(records: impl Iterator<Item = &'a Record>) -> String {
    format!("{:.3}", records.map(|record| record.seconds.total()).sum::<f64>())
}

/// Removes the characters that XML 1.0 does not allow.
fn xml_text(text: &str) -> String {
    let has_place = |c: &char| matches!(c, '\t' | '\n' | '\r' | ' '..='\u{fffd}' | '\u{10000}'..);
    text.chars().filter(has_place).collect()
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
            &[
                "name!",
                "tests!",
                "failures!",
                "errors!",
                "time",
                "disabled",
                "skipped",
            ],
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
            ("invalid", "failure"),
            ("timeout", "error"),
            ("error", "error"),
            ("wrong", "failure"),
            ("unstable", "failure"),
            ("inconclusive", "skipped"),
            ("correct", "passed"),
            ("ok", "passed"),
        ];
        assert_eq!(told, wanted.map(|(a, b)| (a.to_owned(), b.to_owned())));
        let suite = document
            .descendants()
            .find(|node| node.has_tag_name("testsuite"))
            .unwrap();
        let count = |name| suite.attribute(name).unwrap();
        assert_eq!(
            ["tests", "failures", "errors", "skipped"].map(count),
            ["8", "3", "2", "1"]
        );
    }

    #[test]
    fn hostile_names_and_messages_stay_text() {
        let mut hostile = invalid();
        hostile.shader = "\"/><script>\u{0}\u{1b}[31m&]]>.glsl".to_owned();
        hostile.reason = "<failure>".to_owned();
        let text = junit(&[correct(), hostile]);
        let document = Document::parse(&text).unwrap();
        follows(document.root_element());
        let cases = document
            .descendants()
            .filter(|node| node.has_tag_name("testcase"));
        let names: Vec<_> = cases.map(|case| case.attribute("name")).collect();
        assert_eq!(names, [Some("correct"), Some("\"/><script>[31m&]]>.glsl")]);
    }
}
