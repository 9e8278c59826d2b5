//! The pages of a large report: a table of all shaders, and a page for each part.

use std::fs;
use std::path::Path;
use std::time::UNIX_EPOCH;

use serde_json::json;
use toyproof::report::{
    Exhibit, Gallery, MAX_PAGE_SHADERS, PARTS, Record, Report, Rubrics, html_index, html_part, part_name,
};
use toyproof::verify::Verdict;

use super::{HOSTILE, NAMES, NARROW, is_quiet, page, shot};
use crate::batch::records;
use crate::program::toyproof;

const SHADERS: usize = 1_203;

/// Writes the pages of shaders, of which every tenth is wrong, and one has a hostile name.
fn write(folder: &Path) {
    let record = |index: usize| {
        let is_wrong = index % 10 == 3;
        Record {
            verdict: if is_wrong {
                Verdict::Wrong
            } else {
                Verdict::Correct
            },
            reason: if is_wrong {
                "the function `f` differs"
            } else {
                "all pixels agree"
            }
            .to_owned(),
            ..Record::unchecked(match index {
                77 => format!("hw/{HOSTILE}"),
                _ => format!("hw/s{index}.glsl"),
            })
        }
    };
    let report = Report::new(None, (0..SHADERS).map(record).collect());
    let rubrics = Rubrics::default();
    fs::create_dir_all(folder.join(PARTS)).unwrap();
    let index = html_index(&report, &rubrics, UNIX_EPOCH);
    fs::write(folder.join("report.html"), index).unwrap();
    for (number, shaders) in (1..).zip(report.shaders().chunks(MAX_PAGE_SHADERS)) {
        let mut gallery = Gallery::new(1);
        for _ in shaders {
            gallery.add_exhibit(Exhibit::default());
        }
        let page = html_part(&report, number, &rubrics, &gallery, UNIX_EPOCH);
        fs::write(folder.join(PARTS).join(part_name(number)), page).unwrap();
    }
}

#[test]
fn a_large_table_is_sorted_and_filtered_and_leads_to_the_shaders() {
    let Some(mut page) = page() else { return };
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    write(&out);
    page.window([1400, 900], false);
    page.open(&out.join("report.html"));
    page.until("document.querySelector('#shown').textContent !== ''");
    let first_and_count = format!("(names => [names[0], names.length])({NAMES})");
    let shown = "document.querySelector('#shown').textContent";
    assert_eq!(page.value(&first_and_count), json!(["s0.glsl", SHADERS]));
    assert_eq!(page.value(shown), "1203 of 1203 shown");
    shot(&mut page, "large");

    let press = |text: &str| {
        format!("[...document.querySelectorAll('button')].find(b => b.textContent === '{text}').click()")
    };
    // Numbers are sorted by their values.
    page.value(&press("Shader"));
    assert_eq!(page.value(&first_and_count), json!([HOSTILE, SHADERS]));
    page.value(&press("Shader"));
    assert_eq!(page.value(&first_and_count), json!(["s1202.glsl", SHADERS]));
    page.value(&press("Verdict"));
    assert_eq!(page.value(&first_and_count), json!(["s3.glsl", SHADERS]));

    let input = "document.querySelector('#filter').dispatchEvent(new Event('input'))";
    page.value(&format!(
        "document.querySelector('[value=correct]').click(), {input}"
    ));
    assert_eq!(page.value(shown), "120 of 1203 shown");
    assert_eq!(
        page.value("document.querySelector('td.why code').textContent"),
        "f"
    );
    page.value(&format!(
        "document.querySelector('[name=words]').value = 'S113', {input}"
    ));
    assert_eq!(page.value(NAMES), json!(["s113.glsl", "s1133.glsl"]));
    is_quiet(&mut page);
    for width in [1400, 360] {
        page.window([width, 900], true);
        assert_eq!(page.value(NARROW), true, "{width}");
    }

    page.value("[...document.querySelectorAll('#shaders tbody tr:not([hidden]) a')].at(-1).click()");
    page.until("document.querySelector('article.open h2')?.textContent === 's1133.glsl'");
    assert_eq!(
        page.value("document.querySelector('nav span').textContent"),
        "1,001–1,203"
    );
    page.value(&press_link("Previous"));
    page.until("document.querySelector('nav span')?.textContent === '501–1,000'");
    page.value(&press_link("All 1,203 shaders"));
    page.until("document.body?.className === 'index'");
}

fn press_link(text: &str) -> String {
    format!("[...document.querySelectorAll('nav a')].find(a => a.textContent === '{text}').click()")
}

#[test]
fn a_large_batch_has_pages_and_a_smaller_one_removes_them() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("hw")).unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) { c = vec4(p.x); }\n";
    for index in 0..=MAX_PAGE_SHADERS {
        fs::write(folder.join(format!("hw/{index:03}.glsl")), text).unwrap();
    }
    let check = || {
        let flags = ["--device", "cpu", "--size", "4x2", "--out", "out"];
        let run = toyproof(folder, &[&["check", "hw"][..], &flags].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
    };
    let read = |name: &str| fs::read_to_string(folder.join("out").join(name)).unwrap();
    let parts = || {
        let entries = fs::read_dir(folder.join("out").join(PARTS)).unwrap();
        entries.count()
    };
    check();
    assert_eq!(records(folder).len(), MAX_PAGE_SHADERS + 1);
    assert!(read("report.html").contains("<a href=\"report/0002.html\">501–501</a>"));
    let last = read("report/0002.html");
    assert!(last.contains("data-name=\"500.glsl\" data-actual=\"0\"") && !last.contains("499.glsl"));
    assert_eq!(parts(), 2);
    fs::remove_file(folder.join("hw/000.glsl")).unwrap();
    check();
    assert!(read("report.html").contains("<article id=\"s499\""));
    assert_eq!(parts(), 0);
}
