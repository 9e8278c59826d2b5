//! The measurements of `cargo xtask devices`: planted drivers are described as they are, and a driver is
//! measured.

use std::cell::Cell;
use std::path::PathBuf;
use std::time::Duration;

use toyproof::diagnostic::grouped;
use toyproof::gpu::{AdapterSelector, Worker};
use toyproof::image::Image;
use toyproof::verify::compare::CheckSummary;

use crate::requirements::require_driver;
use crate::support::devices::arguments::{UNIT, arguments};
use crate::support::devices::behavior::{BEHAVIORS, Behavior, Contraction};
use crate::support::devices::conversions::LANGUAGES;
use crate::support::devices::discovery::{Discovery, discover};
use crate::support::devices::errors::Errors;
use crate::support::devices::function::{FUNCTIONS, Function};
use crate::support::devices::precision::{Permitted, error, is_rounded, ulp};
use crate::support::devices::table::{Column, Row, markdown};
use crate::support::devices::toolchain::Toolchain;
use crate::support::devices::{Plan, derivatives};
use crate::support::{SPHERE, checked};

fn function(expression: &str) -> &'static Function {
    let mut functions = FUNCTIONS.iter();
    functions
        .find(|function| function.expression == expression)
        .unwrap_or_else(|| panic!("{expression}"))
}

fn behavior(label: &str) -> &'static Behavior {
    let mut behaviors = BEHAVIORS.iter();
    behaviors
        .find(|behavior| behavior.label == label)
        .unwrap_or_else(|| panic!("{label}"))
}

/// The arguments of a function, and its results on a device that computes it like this.
fn results(function: &Function, device: impl Fn(&[f32]) -> f32) -> (Vec<Vec<f32>>, Vec<u32>) {
    let arguments = arguments(function.usual, 1 << 12);
    let results = arguments
        .iter()
        .map(|operands| device(operands).to_bits())
        .collect();
    (arguments, results)
}

fn errors(expression: &str, device: impl Fn(&[f32]) -> f32) -> Errors {
    let function = function(expression);
    let (arguments, results) = results(function, device);
    Errors::new(function, &arguments, &results)
}

fn flush(x: f32) -> f32 {
    if x.is_subnormal() { 0.0_f32.copysign(x) } else { x }
}

#[test]
fn units_in_the_last_place_are_those_of_vulkan() {
    let two = |exponent| 2.0_f64.powi(exponent);
    for (exact, expected) in [
        (1.5, two(-23)),
        (-1.5, two(-23)),
        // Below a power of two, floats are twice as dense.
        (1.0, two(-24)),
        (1.0 - two(-30), two(-24)),
        (1.0 + two(-30), two(-23)),
        (0.0, two(-149)),
        (two(-130), two(-149)),
        (two(-126), two(-149)),
        (two(-125), two(-149)),
        (1.5 * two(-125), two(-148)),
        (f64::from(f32::MAX), two(104)),
        (two(200), two(104)),
    ] {
        assert_eq!(ulp(exact), expected, "{exact:e}");
    }
}

#[test]
fn errors_are_in_units_in_the_last_place_and_denormals_may_be_flushed() {
    let next = |x: f32, steps: u32| f32::from_bits(x.to_bits() + steps);
    assert_eq!(error(1.5, 1.5), 0.0);
    assert_eq!(error(next(1.5, 3), 1.5), 3.0);
    // The exact value lies between two floats: the nearer one is rounded correctly, whatever its error.
    let between = 1.5 + 0.25 * ulp(1.5);
    assert!(is_rounded(1.5, between) && !is_rounded(next(1.5, 1), between));
    assert_eq!(error(next(1.5, 1), between), 0.75);
    assert_eq!(error(-0.0, 0.0), 0.0);
    assert_eq!(error(0.0, 1e-40), 0.0);
    assert!(error(0.0, 1.2e-38) > 1e6, "a normal result was flushed");
    assert_eq!(error(f32::NAN, f64::NAN), 0.0);
    for (result, exact) in [(f32::NAN, 1.0), (f32::INFINITY, 1.0), (1.0, f64::NAN)] {
        assert_eq!(error(result, exact), f64::INFINITY);
    }
}

#[test]
fn permitted_results_are_those_of_the_specification() {
    let point = |x: f32| Permitted::operand(x);
    let near = |exact: f64, ulps: f64| (exact + ulps * ulp(exact)) as f32;
    // 2.5 ULP of 1/3, so two floats away, and not three.
    let third = point(1.0) / point(3.0);
    assert!(third.contains(near(1.0 / 3.0, 2.0), 1.0 / 3.0, false));
    assert!(!third.contains(near(1.0 / 3.0, 3.0), 1.0 / 3.0, false));
    // Either neighbor of a sum that is not a float, however small the second operand is, and no other.
    for tiny in [1e-10, 1e-30] {
        let sum = point(1.5) + point(tiny);
        let exact = 1.5 + f64::from(tiny);
        let up = f32::from_bits(1.5_f32.to_bits() + 1);
        assert!(sum.contains(1.5, exact, false) && sum.contains(up, exact, false));
        assert!(!sum.contains(f32::from_bits(1.5_f32.to_bits() - 1), exact, false));
    }
    // Two sums may both be rounded up, by two floats; an inherited precision allows as much downwards.
    let sums = point(1.5) + point(1e-30) + point(1e-30);
    let two_down = f32::from_bits(1.5_f32.to_bits() - 2);
    assert!(!sums.contains(two_down, 1.5, false) && sums.contains(two_down, 1.5, true));
    assert!(!sums.contains(f32::from_bits(1.5_f32.to_bits() - 3), 1.5, true));
    // An absolute error of 2⁻¹¹ in [−π, π], and nothing outside.
    assert!(
        point(3.0)
            .sin()
            .contains(3.0_f32.sin() + 4.8e-4, 3.0_f64.sin(), false)
    );
    assert!(
        !point(3.0)
            .sin()
            .contains(3.0_f32.sin() + 5e-4, 3.0_f64.sin(), false)
    );
    assert!(point(4.0).sin().is_any() && !point(-3.1).sin().is_any());
    // 3 ULP of the logarithm of 8, and 2⁻²¹ beside 1.
    assert!(!point(8.0).log2().contains(near(3.0, 4.0), 3.0, false));
    assert!(
        point(1.0).log2().contains(4.7e-7, 0.0, false) && !point(1.0).log2().contains(4.8e-7, 0.0, false)
    );
    // Operands that need not be supported.
    for any in [
        point(1.0) / point(0.0),
        point(1.0) / point(2e38),
        point(-1.0).log(),
        point(0.0).inverse_sqrt(),
        point(f32::INFINITY),
        point(f32::NAN) + point(1.0),
    ] {
        assert!(any.is_any(), "{any:?}");
    }
}

/// The limits have no error where the exact value is: both are written independently of each other.
#[test]
fn exact_values_are_permitted() {
    for function in FUNCTIONS {
        let correct = |operands: &[f32]| {
            let operands: Vec<f64> = operands.iter().copied().map(f64::from).collect();
            (function.exact)(&operands) as f32
        };
        let (arguments, results) = results(function, correct);
        let errors = Errors::new(function, &arguments, &results);
        let name = function.expression;
        assert_eq!((errors.beyond, errors.not_rounded), (0, 0), "{name}: {errors:?}");
        assert!(
            10 * errors.cases > 3 * arguments.len(),
            "{name}: {} cases",
            errors.cases
        );
        let (largest, _) = errors.usual.clone().expect("most operands are usual");
        assert!(largest <= 0.5, "{name}: {largest} at a correct rounding");
        assert!(
            errors.elsewhere.is_some_and(|largest| largest <= 1.0),
            "{name}: {errors:?}"
        );
        let text = errors.to_string();
        assert_eq!(text, "all rounded correctly; **kept**");
        assert!(errors.describe_rounding().starts_with("all of "));
    }
}

#[test]
fn flushed_denormals_are_permitted_and_other_zeros_are_not() {
    let flushing = |operands: &[f32]| flush(flush(operands[0]) * flush(operands[1]));
    let errors_of_flushing = errors("x * y", flushing);
    assert_eq!(
        (errors_of_flushing.beyond, errors_of_flushing.not_rounded),
        (0, 0),
        "{errors_of_flushing:?}"
    );
    let too_early = |operands: &[f32]| {
        let product = operands[0] * operands[1];
        if product.abs() < 1e-30 { 0.0 } else { product }
    };
    let errors = errors("x * y", too_early);
    assert!(
        errors.beyond > 10 && errors.elsewhere.unwrap() > 1e6,
        "{errors:?}"
    );
    assert!(errors.to_string().contains("**not kept** in "), "{errors}");
}

#[test]
fn imprecise_functions_are_measured_and_checked() {
    let bent = |ulps: f64| {
        move |operands: &[f32]| {
            let exact = 1.0 / f64::from(operands[0]).sqrt();
            (exact + ulps * ulp(exact)) as f32
        }
    };
    let kept = errors("inversesqrt(x)", bent(1.4));
    let (largest, _) = kept.usual.clone().unwrap();
    assert!(
        (1.4..=2.0).contains(&largest) && (0.7..=1.0).contains(&kept.share),
        "{kept:?}"
    );
    assert_eq!(kept.beyond, 0);
    assert!(kept.not_rounded > kept.cases / 2, "{kept:?}");
    let broken = errors("inversesqrt(x)", bent(3.0));
    assert!(broken.beyond > broken.cases / 2, "{broken:?}");
    assert!(
        broken.describe_rounding().starts_with("**not** in "),
        "{broken:?}"
    );
    // Outside of [−π, π], a sine may be anything.
    let sine = errors("sin(x)", |operands| {
        if operands[0].abs() > 4.0 {
            7.0
        } else {
            operands[0].sin()
        }
    });
    assert!(sine.beyond == 0 && sine.elsewhere.unwrap() > 1e5, "{sine:?}");
    assert!(sine.to_string().contains(", elsewhere "), "{sine}");
    // A function that returns NaN for an ordinary argument.
    let nan = errors("sqrt(x)", |operands| {
        if operands[0] == 4.0 {
            f32::NAN
        } else {
            operands[0].sqrt()
        }
    });
    assert_eq!(
        (nan.beyond, nan.first_beyond.as_ref().map(|first| first.0[0])),
        (1, Some(4.0)),
        "{nan:?}"
    );
    assert!(
        nan.to_string().contains("such as (4.0), which gives NaN"),
        "{nan}"
    );
}

#[test]
fn contraction_is_found() {
    let arguments = Contraction::arguments(1 << 10);
    let describe = |device: &dyn Fn(usize, f32, f32, f32) -> f32| {
        let results: Vec<u32> = arguments
            .iter()
            .enumerate()
            .map(|(index, v)| device(index, v[0], v[1], v[2]).to_bits())
            .collect();
        Contraction::new(&arguments, &results)
    };
    let separate = describe(&|_, a, b, c| a * b + c);
    let fused = describe(&|_, a, b, c| a.mul_add(b, c));
    let mixed = describe(&|index, a, b, c| {
        if index % 2 == 0 {
            a * b + c
        } else {
            a.mul_add(b, c)
        }
    });
    assert!(separate.cases > 100, "{separate:?}");
    let all = grouped(separate.cases as u64);
    assert_eq!(
        separate.describe(),
        format!("not contracted, in all of {all} cases that show it")
    );
    assert_eq!(
        fused.describe(),
        format!("contracted to one rounding, in all of {all} cases that show it")
    );
    assert!(
        mixed.describe().ends_with(" with one, 0 with another result"),
        "{mixed:?}"
    );
    assert!(mixed.separate > 0 && mixed.fused > 0 && mixed.separate + mixed.fused == mixed.cases);
}

/// What a device of IEEE 754 that keeps or flushes denormals computes for rows of denormals.
fn denormal_results(behavior: &Behavior, flush: fn(f32) -> f32) -> Vec<u32> {
    let compute = |expression: &str, operands: &[u32]| {
        let operand = |at: usize| flush(f32::from_bits(operands[at]));
        let value = match expression {
            "x * y" => operand(0) * operand(1),
            "x + y" => operand(0) + operand(1),
            "x - y" => operand(0) - operand(1),
            "x / y" => operand(0) / operand(1),
            "mix(x, y, z)" => operand(0) * (1.0 - operand(2)) + operand(1) * operand(2),
            "x > 0.0 ? 1.0 : 0.0" => f32::from(u8::from(operand(0) > 0.0)),
            "abs(x)" => operand(0).abs(),
            "max(x, y)" => operand(0).max(operand(1)),
            // Copies must not flush.
            "x" => return operands[0],
            other => panic!("{other}"),
        };
        flush(value).to_bits()
    };
    let questions = behavior.questions.iter();
    questions
        .map(|question| compute(question.expression, question.operands))
        .collect()
}

#[test]
fn flushing_devices_are_described() {
    for (label, copies) in [("denormal results", false), ("denormal operands", true)] {
        let behavior = behavior(label);
        let kept = behavior.describe(&denormal_results(behavior, |x| x));
        assert!(kept.contains("kept") && !kept.contains("flushed"), "{kept}");
        let flushed = behavior.describe(&denormal_results(behavior, flush));
        assert!(flushed.contains("`×`: flushed"), "{flushed}");
        assert_eq!(flushed.matches("kept").count(), usize::from(copies), "{flushed}");
        let broken = behavior.describe(&vec![1.0e9_f32.to_bits(); behavior.questions.len()]);
        assert!(
            broken.contains("`×`: 1e9") && !broken.contains("kept"),
            "{broken}"
        );
    }
    let behavior = behavior("`min` and `max` of NaN");
    let results = [2.0, f32::NAN, 2.0, 2.0].map(f32::to_bits);
    assert_eq!(
        behavior.describe(&results),
        "`min(NaN, 2)` = 2.0, `min(2, NaN)` = NaN, `max(NaN, 2)` = 2.0, `max(2, NaN)` = 2.0"
    );
}

#[test]
fn derivatives_are_described() {
    let of = |line, sign| derivatives::describe(&derivatives::planted(line, sign));
    assert_eq!(
        of(None, 1.0),
        "`dFdx` fine: of the pixel's own row; `dFdy` fine: of the pixel's own column; `fwidth` is the sum of both"
    );
    assert!(of(Some(0), 1.0).starts_with("`dFdx` coarse: of the quad's first row; "));
    assert!(of(Some(1), 1.0).starts_with("`dFdx` coarse: of the quad's second row; "));
    assert!(of(None, -1.0).contains("`dFdy` fine: of the pixel's own column, **with the opposite sign**"));
    let zeros = Image::new(16, 16, vec![[0.0; 4]; 256]);
    assert!(derivatives::describe(&zeros).contains("`dFdx` not a difference of an aligned quad"));
}

#[test]
fn shaders_that_differ_or_crash_the_driver_are_counted() {
    let summary = |differing, max_abs| CheckSummary {
        pixels: 1000,
        undefined: 100,
        differing,
        max_abs,
        ..CheckSummary::default()
    };
    let mut programs = Toolchain {
        kind: "programs",
        ..Toolchain::default()
    };
    programs.add("one", Ok(summary(0, 0.0)));
    assert_eq!(programs.to_string(), "1 of 1 programs, 900 of 900 pixels");
    programs.add("two", Ok(summary(7, 0.25)));
    programs.add("three", Err("the driver crashed".to_owned()));
    assert_eq!(
        programs.to_string(),
        "1 of 3 programs, 1,793 of 1,800 pixels; **1 differs** by at most 2.5e-1, first two in 7 pixels; \
         **1 has no image**, first three: the driver crashed"
    );
    programs.stopped = Some("interrupted".to_owned());
    assert!(
        programs
            .to_string()
            .ends_with("; the others were not measured: interrupted")
    );
}

#[test]
fn the_table_has_a_row_for_each_measurement_and_a_column_for_each_device() {
    let row = |section, label: &str| Row {
        section,
        label: label.to_owned(),
        requirement: "all".to_owned(),
    };
    let rows = [row("A", "first"), row("B", "|x|"), row("B", "last")];
    let columns = [
        Column {
            title: "One".to_owned(),
            cells: vec![
                Ok("1.0 ULP".to_owned()),
                Err("the driver\ncrashed".to_owned()),
                Err("interrupted".to_owned()),
            ],
        },
        Column {
            title: "Two".to_owned(),
            cells: vec![Ok("kept".to_owned()), Ok("3".to_owned()), Ok("4".to_owned())],
        },
    ];
    assert_eq!(
        markdown(&rows, &columns),
        "| measurement | required | One | Two |\n\
         |---|---|---|---|\n\
         | **A** | | | |\n\
         | first | all | 1.0 ULP | kept |\n\
         | **B** | | | |\n\
         | \\|x\\| | all | not measured: the driver crashed | 3 |\n\
         | last | all | not measured: interrupted | 4 |\n"
    );
}

#[test]
fn the_expressions_of_all_measurements_are_valid() {
    for function in FUNCTIONS {
        let operands = "float x = p.x, y = p.y, z = p.x, u = p.y, v = p.x, w = p.y;";
        checked(&format!(
            "void mainImage(out vec4 c, in vec2 p) {{ {operands} c = vec4({}); }}",
            function.expression
        ));
        // All arguments of the usual range are used.
        let arguments = arguments(function.usual, 1 << 10);
        assert_eq!(arguments.len(), 1 << 10);
        assert!(
            arguments
                .iter()
                .all(|operands| operands.len() == function.usual.len())
        );
    }
    let unit = arguments(&[UNIT], 1 << 12);
    for special in [
        0.0,
        f32::from_bits(1),
        -1.0,
        f32::MAX,
        -f32::MAX,
        2.0_f32.powi(-126),
        std::f32::consts::PI,
    ] {
        assert!(unit.iter().any(|operands| operands[0] == special), "{special:e}");
    }
    let usual = unit
        .iter()
        .filter(|operands| (0.01..1.0).contains(&operands[0].abs()))
        .count();
    assert!(usual > unit.len() / 3, "{usual} ordinary arguments");
}

const TIMEOUT: Duration = Duration::from_secs(60);

fn new_worker(selector: AdapterSelector) -> Worker {
    let program = PathBuf::from(env!("CARGO_BIN_EXE_toyproof"));
    Worker::new(program, vec![toyproof::cli::WORKER.into()], selector, TIMEOUT)
}

/// The names of the devices that `--device` selects.
fn selected(device: &str) -> Vec<String> {
    let mut discovery: Discovery = discover(&new_worker);
    discovery.select(device);
    discovery
        .devices
        .iter()
        .map(|device| device.driver.name.clone())
        .collect()
}

#[test]
fn devices_are_found_where_there_is_a_driver() {
    assert_eq!(!selected("").is_empty(), require_driver());
    assert!(selected("no such device").is_empty());
}

#[test]
fn a_driver_is_measured() {
    if !require_driver() {
        return;
    }
    let plan = Plan {
        exercises: vec![&SPHERE],
        programs: 3,
        functions: vec![function("sqrt(x)"), function("sin(x)")],
        arguments: 1 << 10,
        behaviors: vec![behavior("denormal operands")],
        languages: vec![&LANGUAGES[0]],
        ..Plan::complete(TIMEOUT)
    };
    let mut discovery = discover(&new_worker);
    discovery.select("auto");
    let device = &discovery.devices[0];
    let mut translator = new_worker(AdapterSelector::Auto).without_driver();
    let mut sections = Vec::new();
    let column = plan.measure(device, &mut translator, &|| None, &mut |section| {
        sections.extend(section);
    });
    assert_eq!(sections.len(), 5, "{sections:?}");
    let rows = plan.rows();
    let cell = |label: &str| {
        let index = rows.iter().position(|row| row.label == label);
        column.cells[index.unwrap_or_else(|| panic!("{label}: {rows:?}"))]
            .as_ref()
            .unwrap()
    };
    assert_eq!(cell("device"), &device.driver.name);
    assert!(cell("Vulkan").starts_with("1."));
    assert_eq!(cell("the course"), "1 of 1 shaders, 14,400 of 14,400 pixels");
    let programs = cell("3 random programs (seed 0)");
    assert!(
        programs.starts_with("3 of 3 programs, ") && !programs.contains("**"),
        "{programs}"
    );
    assert!(cell("`x * y + z`, strict").starts_with("not contracted, in all of "));
    assert!(cell("`sqrt(x)`").ends_with("**kept**"));
    assert!(cell("denormal operands").contains("`copy`: kept"));
    let derivatives = cell("derivatives, strict");
    assert!(
        derivatives.starts_with("`dFdx` fine: ") && !derivatives.contains("**"),
        "{derivatives}"
    );
    assert_eq!(cell("WGSL"), "proved 1 of 1; read by naga");
}

#[test]
fn what_is_not_reached_has_a_reason() {
    if !require_driver() {
        return;
    }
    let plan = Plan::complete(TIMEOUT);
    let mut discovery = discover(&new_worker);
    discovery.select("auto");
    let mut translator = new_worker(AdapterSelector::Auto).without_driver();
    let rows_measured = Cell::new(0);
    let stop = || {
        rows_measured.set(rows_measured.get() + 1);
        (rows_measured.get() > 2).then(|| "interrupted".to_owned())
    };
    let column = plan.measure(&discovery.devices[0], &mut translator, &stop, &mut |_| ());
    assert!(column.cells[..2].iter().all(Result::is_ok), "{column:?}");
    assert!(
        column.cells[2..]
            .iter()
            .all(|cell| cell == &Err("interrupted".to_owned()))
    );
    assert_eq!(column.cells.len(), plan.rows().len());
}
