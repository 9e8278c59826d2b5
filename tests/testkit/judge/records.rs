//! What a run left: the lines of `results.jsonl`, which `--resume` and `merge` read, or a `verdict.json`, which
//! `--compare` reads. Records that are read end up in every report.

use std::io::{self, Write};
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};
use toyproof::report::{
    ClassTable, Detail, Earlier, Exhibit, Gallery, Hints, Layout, Record, Report, Rubrics, csv, html,
    html_index, junit, lines, sarif,
};

use super::within;

/// A line of `results.jsonl`, as `check` writes it.
#[derive(Serialize, Deserialize)]
struct Line {
    key: String,
    record: Record,
    #[serde(default)]
    device: Option<String>,
}

/// The number of records that could be read from a text.
///
/// # Panics
/// If reading or reporting them does, or takes more than `allowed` of a processor; if a record changes when it is
/// written and read again; if a report is not well-formed.
pub fn judge(bytes: &[u8], allowed: Duration) -> usize {
    within(allowed, || {
        let found = bytes.split_inclusive(|&byte| byte == b'\n').filter_map(|line| {
            let line: Line = serde_json::from_slice(line).ok()?;
            Some(line.record)
        });
        let records: Vec<Record> = found.collect();
        for record in &records {
            let text = serde_json::to_string(record).expect("a record can be written");
            let again: Record = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
            assert_eq!(
                text,
                serde_json::to_string(&again).expect("a record can be written")
            );
        }
        let count = records.len();
        if count > 0 {
            report(records);
        }
        let earlier = str::from_utf8(bytes).map(|text| Earlier::parse("verdict.json".to_owned(), text));
        match earlier {
            Ok(Ok(earlier)) => drop(earlier.changes(&Report::new(None, Vec::new()))),
            Ok(Err(error)) => assert!(!error.is_empty()),
            Err(_) => {}
        }
        count
    })
}

fn report(records: Vec<Record>) {
    let rubrics = Rubrics::default();
    let mut gallery = Gallery::new(1);
    for record in &records {
        // The source may have changed since: positions may lie beyond it.
        gallery.add_exhibit(Exhibit {
            source: Some("void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(1.0);\n}\n".to_owned()),
            ..Exhibit::default()
        });
        for detail in [Detail::Short, Detail::Normal, Detail::Full] {
            let layout = Layout {
                detail,
                names: 12,
                width: Some(80),
                lists_diagnostics: true,
            };
            let _ = lines(record, &layout);
        }
    }
    let report = Report::new(Some("device".to_owned()), records);
    let records = report.shaders();
    written(|out| csv(records, &rubrics, out));
    written(|out| ClassTable::new(records, &rubrics).csv(out));
    for hints in [Hints::None, Hints::Line, Hints::Fix] {
        written(|out| junit(records, hints, out));
    }
    let text = written(|out| sarif(records, out));
    serde_json::from_str::<serde_json::Value>(&text).expect("SARIF is JSON");
    let text = written(|out| report.json(out));
    Earlier::parse("again".to_owned(), &text).unwrap_or_else(|error| panic!("{error}: {text}"));
    let _ = html(&report, &rubrics, &gallery, SystemTime::UNIX_EPOCH);
    let _ = html_index(&report, &rubrics, SystemTime::UNIX_EPOCH);
}

/// The text that a report writes.
fn written(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> String {
    let mut bytes = Vec::new();
    write(&mut bytes).expect("memory can be written");
    String::from_utf8(bytes).expect("reports are UTF-8")
}
