//! Tests of the reports of `compare` and of their schema.

use toyproof_diagnostic::{File, Files, Span};
use toyproof_explain::equality::{FirstDifference, Origin};
use toyproof_image::Image;
use toyproof_metrics::Metric;
use toyproof_player::Target;
use toyproof_verify::Quantization;
use toyproof_verify::compare::compare_pair;

use super::*;
use crate::written;

/// A gray image of 4×3 pixels, in which `differing` pixels are brighter.
fn gray(differing: usize) -> Image {
    let value = |at| if at < differing { 0.75 } else { 0.5 };
    Image::new(4, 3, (0..12).map(|at| [value(at), 0.5, 0.5, 1.0]).collect())
}

fn compared(differing: usize, criteria: &Criteria) -> ComparedImages {
    let images = [&gray(0), &gray(differing)];
    let difference = compare_pair(images, [Quantization::EightBit; 2], criteria).unwrap();
    ComparedImages::new(&difference, criteria)
}

fn names() -> [String; 2] {
    ["a", "b"].map(str::to_owned)
}

fn shaders(first: Option<FirstDifferenceRecord>) -> ComparedShaders {
    ComparedShaders {
        frames: [0, 7],
        size: [4, 3],
        passes: vec!["Buffer A".to_owned(), "Image".to_owned()],
        only_in_a: Vec::new(),
        only_in_b: vec!["Buffer B".to_owned()],
        first,
    }
}

fn first_difference() -> FirstDifferenceRecord {
    let mut files = Files::default();
    let file = files.add(File::new("a.glsl", "float x;\nx = 2.0 * y;"));
    let found = FirstDifference {
        frame: 3,
        target: Target::Buffer(0),
        pixel: [1, 2],
        colors: [[0.5, f32::NAN, 0.0, 1.0], [0.1, 0.0, 0.0, 1.0]],
        differing: 1,
        pixels: 12,
        origins: [
            Some(Origin {
                span: Span::new(file, 13, 20),
                value: vec![f64::from(0.1_f32)],
                is_unknown: true,
            }),
            None,
        ],
    };
    FirstDifferenceRecord::new(&found, [&files, &files])
}

#[test]
fn limits_decide_and_are_named() {
    let lines = |differing: usize, criteria: Criteria| {
        let images = vec![compared(differing, &criteria)];
        let report = ComparisonReport::of_images(names(), &criteria, images);
        (report.agrees(), report.lines(false).swap_remove(0))
    };
    let equal = lines(0, Criteria::default());
    assert_eq!(equal, (true, "all 12 pixels are equal".to_owned()));
    let (agrees, line) = lines(2, Criteria::default());
    assert!(
        !agrees && line.starts_with("2 of 12 pixels differ by more than one level of 255;"),
        "{line}"
    );
    let few = |most| Criteria {
        max_differing: Some(most),
        ..Criteria::default()
    };
    let (agrees, line) = lines(2, few(MaxDiffering::Pixels(2)));
    assert!(agrees && line.contains("within the limit of 2;"), "{line}");
    let (agrees, line) = lines(2, few(MaxDiffering::Percent(16.6)));
    assert!(!agrees && line.contains("the limit is 16.6 %;"), "{line}");
    assert!(lines(2, few(MaxDiffering::Percent(16.7))).0);
    let tolerant = Criteria {
        tolerance: Some(64.0 / 255.0),
        ..Criteria::default()
    };
    assert_eq!(
        lines(2, tolerant),
        (true, "all 12 pixels agree to within 64 levels of 255".to_owned())
    );
}

#[test]
fn a_limit_of_a_metric_takes_the_place_of_the_number_of_pixels() {
    let measured = |limit: Option<f64>, most: Option<MaxDiffering>| {
        let criteria = Criteria {
            metric: Some(Metric::Rmse),
            limit,
            max_differing: most,
            ..Criteria::default()
        };
        let report = ComparisonReport::of_images(names(), &criteria, vec![compared(3, &criteria)]);
        (report.agrees(), report.lines(false).swap_remove(1))
    };
    // Three of 36 components differ by a quarter.
    assert_eq!(measured(None, None), (false, "RMSE is 0.072169".to_owned()));
    assert_eq!(
        measured(Some(0.1), None),
        (true, "RMSE is 0.072169, within the limit of 0.1".to_owned())
    );
    assert_eq!(
        measured(Some(0.05), None),
        (false, "RMSE is 0.072169, above the limit of 0.05".to_owned())
    );
    assert!(
        !measured(Some(0.1), Some(MaxDiffering::Pixels(2))).0,
        "both must hold"
    );
}

#[test]
fn pairs_of_folders_have_a_line_each_if_they_differ() {
    let criteria = Criteria::default();
    let images = vec![
        compared(0, &criteria).at_path("same.png".to_owned()),
        compared(1, &criteria).at_path("x/other.png".to_owned()),
        ComparedImages::alone(true).at_path("gone.png".to_owned()),
        ComparedImages::failed("not an image").at_path("bad.png".to_owned()),
    ];
    let report = ComparisonReport::of_images(names(), &criteria, images);
    assert!(!report.agrees() && report.has_errors());
    let lines = report.lines(false);
    assert!(
        lines[0].starts_with("x/other.png: 1 of 12 pixels differs"),
        "{lines:?}"
    );
    assert_eq!(
        lines[1..3],
        ["gone.png: only in the first folder", "bad.png: not an image"]
    );
    assert_eq!(
        lines[3],
        "4 images: 1 is equal, 1 differs, 1 has no counterpart, 1 cannot be compared"
    );
    assert_eq!(report.lines(true).len(), 5);
}

#[test]
fn the_first_difference_has_its_place_in_the_shaders() {
    let report = ComparisonReport::of_shaders(names(), shaders(Some(first_difference())));
    assert_eq!(
        report.lines(false),
        [
            "first difference: frame 3, Buffer A, pixel (1, 2)",
            "  a: (0.5, NaN, 0, 1)",
            "  b: (0.1, 0, 0, 1)",
            "a.glsl, line 2: `2.0 * y` is 0.1, which b does not compute",
            "1 of 12 pixels of this pass differs in this frame",
            "not compared, only in b: Buffer B",
        ]
    );
    let equal = ComparisonReport::of_shaders(names(), shaders(None));
    assert_eq!(
        equal.lines(false)[0],
        "frames 0 to 7 of Buffer A and Image are equal to the bit in float32, at 4×3"
    );
}

#[test]
fn reports_follow_the_schema_and_broken_ones_do_not() {
    let schema = serde_json::from_str(COMPARISON_SCHEMA).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let criteria = Criteria {
        tolerance: Some(0.5),
        max_differing: Some(MaxDiffering::Percent(1.0)),
        metric: Some(Metric::Psnr),
        limit: Some(30.0),
        region: Some(Rectangle {
            x: 1,
            y: 0,
            width: 2,
            height: 3,
        }),
    };
    let images = vec![
        compared(2, &criteria),
        compared(0, &criteria).in_frame(4),
        ComparedImages::alone(false).at_path("a.png".to_owned()),
        ComparedImages::failed("no").at_path("b.png".to_owned()),
    ];
    let of_images = ComparisonReport::of_images(names(), &criteria, images);
    let of_shaders = ComparisonReport::of_shaders(names(), shaders(Some(first_difference())));
    let json = |report: &ComparisonReport| -> serde_json::Value {
        serde_json::from_str(&written(|out| report.json(out))).unwrap()
    };
    for (report, broken) in [
        (
            &of_images,
            [
                "/images/0/status",
                "/criteria/metric",
                "/images/1/frame",
                "/agree",
            ],
        ),
        (
            &of_shaders,
            [
                "/shaders/first/a",
                "/shaders/first/place_in_a/line",
                "/shaders/size",
                "/version",
            ],
        ),
    ] {
        let mut json = json(report);
        let errors: Vec<_> = validator
            .iter_errors(&json)
            .map(|error| error.to_string())
            .collect();
        assert!(errors.is_empty(), "{errors:?}");
        for path in broken {
            let value = json.pointer_mut(path).unwrap();
            let kept = std::mem::replace(value, "broken".into());
            assert!(!validator.is_valid(&json), "{path}");
            *json.pointer_mut(path).unwrap() = kept;
        }
    }
    // Equal images have an infinite PSNR, which JSON does not have.
    assert!(json(&of_images)["images"][1]["value"].is_null());
}
