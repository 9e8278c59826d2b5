//! Tests of the records and their schema.

use super::*;
use crate::frames::samples::in_frames;
use crate::record::samples::{every_verdict, record};
use crate::repair::samples::{repaired, suspected};
use crate::{Decision, Hints, growth, repair, written};

#[test]
fn reports_follow_the_schema_and_broken_ones_do_not() {
    let schema = serde_json::from_str(SCHEMA).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let black = toyproof_image::Image::new(1, 1, vec![[0.0; 4]]);
    let white = toyproof_image::Image::new(1, 1, vec![[1.0; 4]]);
    let (comparison, _) = toyproof_verify::compare::compare(&black, &white);
    let summary = CheckSummary::new(&black, &white, &[toyproof_verify::compare::PixelStatus::Differs]);
    let with_checks = Record {
        algorithm: Some(summary.clone()),
        precision: Some(summary.clone()),
        toolchain: Some(summary),
        comparison: Some(comparison),
        ..record(Verdict::Ok)
    };
    let grown = Record {
        growth: Some(growth::samples::chaotic(5)),
        ..record(Verdict::Chaotic)
    };
    // The first ones are broken below, by their index.
    let mut records = vec![
        repaired(),
        suspected(),
        in_frames([Verdict::Correct, Verdict::Wrong]),
        grown,
        with_checks,
        repaired().redacted(Hints::Line),
    ];
    records.extend(every_verdict());
    records.push(repaired().with_decision(&Decision {
        verdict: Some(Verdict::Correct),
        points: Some(2.5),
        reason: "the sheet was wrong".to_owned(),
    }));
    let report = Report::new(Some("x".to_owned()), records);
    let mut json: serde_json::Value = serde_json::from_str(&written(|out| report.json(out))).unwrap();
    assert!(
        validator.is_valid(&json),
        "{:?}",
        validator.iter_errors(&json).collect::<Vec<_>>()
    );
    for (path, value) in [
        ("/shaders/0/fix/line", 0.into()),
        ("/shaders/0/fix/edits", serde_json::json!([])),
        ("/shaders/0/fix/alternatives/0/agreeing", "many".into()),
        ("/shaders/1/suspects/0/score", 2.into()),
        ("/shaders/3/growth/cause", "fate".into()),
        ("/shaders/3/growth/frames/0/differing", (-1).into()),
        ("/shaders/2/frames/0/size", serde_json::json!([0, 4])),
        ("/shaders/2/frames/1/verdict", "splendid".into()),
        ("/shaders/0/verdict", "splendid".into()),
    ] {
        let mut json = json.clone();
        *json.pointer_mut(path).unwrap() = value;
        assert!(!validator.is_valid(&json), "{path}");
    }
    json["shaders"][0].as_object_mut().unwrap().remove("verdict");
    assert!(!validator.is_valid(&json));
}

#[test]
fn the_fix_has_the_keys_that_programs_read() {
    let json = serde_json::to_value(repaired()).unwrap();
    let fix = &json["fix"];
    let edit = serde_json::json!({
        "line": 2, "column": 12, "end_line": 2, "end_column": 17,
        "replacement": "b - c", "text": "replace `b + c` with `b - c`",
    });
    assert_eq!(fix["edits"], serde_json::json!([edit]));
    for (key, value) in edit.as_object().unwrap() {
        assert_eq!(fix[key], *value, "{key}");
    }
    let rest = ["id", "file", "agreeing", "pixels"].map(|key| fix[key].clone());
    assert_eq!(
        serde_json::json!(rest),
        serde_json::json!(["wrong-operator", "wrong", 14_400, 14_400])
    );
    assert_eq!(fix["alternatives"][0]["id"], "two-mistakes");
    assert_eq!(fix["alternatives"][0]["edits"].as_array().unwrap().len(), 2);
    let suspect = &json["suspects"][0];
    assert_eq!((&suspect["line"], &suspect["score"]), (&4.into(), &0.5.into()));
    assert_eq!(json["is_search_cut"], true);
}

#[test]
fn records_are_read_back_also_from_older_reports() {
    let json = serde_json::to_value(repaired()).unwrap();
    let read: Record = serde_json::from_value(json.clone()).unwrap();
    assert_eq!(serde_json::to_value(&read).unwrap(), json);
    let mut older = json;
    for key in ["fix", "suspects", "is_search_cut", "is_cut_by_time"] {
        older.as_object_mut().unwrap().remove(key).unwrap();
    }
    let read: Record = serde_json::from_value(older).unwrap();
    assert_eq!((read.fix, read.suspects.len()), (None, 0));
}

#[test]
fn a_fix_names_the_mistake_unless_a_known_one_explains_the_image() {
    assert_eq!(repaired().mistake.unwrap().id, "wrong-operator");
    let (files, result) = repair::samples::search();
    let mut known = record(Verdict::Wrong);
    known.mistake = Some(Mistake {
        id: "no-shadows".to_owned(),
        text: "shadows are missing".to_owned(),
        is_symptom: false,
        alternatives: Vec::new(),
    });
    let known = known.with_search(&result, &files);
    assert_eq!(known.mistake.unwrap().id, "no-shadows");
    assert_eq!(known.fix.unwrap().id, "wrong-operator");
}
