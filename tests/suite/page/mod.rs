//! `report.html` in a real browser. `TOYPROOF_SCREENSHOTS` names a folder for screenshots.

mod large;

use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;
use std::{env, fs};

use serde_json::{Value, json};
use toyproof::image::{self, Image, quantize};
use toyproof::report::{Exhibit, Gallery, Record, Report, Rubrics, html};
use toyproof::verify::Verdict;

use crate::program::toyproof;
use crate::requirements::require_chromium;
use crate::support::SPHERE;
use crate::support::devtools::Page;

const HOSTILE: &str = "<img src=x onerror=hacked=1>.glsl";

/// Creates the report of a folder of shaders: correct, wrong, hostile, with warnings, and endless.
fn report(folder: &Path, rest: &[&str]) -> Vec<Value> {
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    fs::create_dir(folder.join("hw")).unwrap();
    write("scene.toml", SPHERE.scene);
    write(
        "rubric.toml",
        "compiles.points = 2\nalgorithm.points = 6\nalgorithm.partial_from = 0.5\nprecision.points = 2\n",
    );
    write("hw/ann.glsl", SPHERE.shader);
    write(
        "hw/bob.glsl",
        &SPHERE.shader.replace("b * b - c", "b * b - 0.9 * c"),
    );
    write("hw/cyd.glsl", &SPHERE.shader.replace("float disc", "flaot disc"));
    write(
        "hw/dan.glsl",
        &format!("float unused() {{ float x; return x; }}\n{}", SPHERE.shader),
    );
    let hostile =
        "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(</script><script>hacked=1</script>);\n}\n";
    write(&format!("hw/{HOSTILE}"), hostile);
    let check = [
        "check",
        "hw",
        "--scene",
        "scene.toml",
        "--device",
        "cpu",
        "--out",
        "out",
        "--rubric",
        "rubric.toml",
    ];
    let run = toyproof(folder, &[&check, rest].concat());
    assert_eq!(run.code, 1, "{}", run.stderr);
    let text = fs::read_to_string(folder.join("out/verdict.json")).unwrap();
    let verdicts: Value = serde_json::from_str(&text).unwrap();
    verdicts["shaders"].as_array().unwrap().clone()
}

fn page() -> Option<Page> {
    require_chromium().map(|program| Page::new(&program))
}

/// The index of the shader with this name.
fn place(records: &[Value], name: &str) -> usize {
    let named = |record: &Value| {
        record["shader"]
            .as_str()
            .is_some_and(|shader| shader.ends_with(name))
    };
    records.iter().position(named).unwrap()
}

fn shot(page: &mut Page, name: &str) {
    if let Some(folder) = env::var_os("TOYPROOF_SCREENSHOTS") {
        let path = PathBuf::from(folder).join(format!("{name}.png"));
        fs::write(path, page.screenshot()).unwrap();
    }
}

/// Asserts that the page reported no error and fetched nothing.
fn is_quiet(page: &mut Page) {
    for trouble in [
        "Runtime.exceptionThrown",
        "Runtime.consoleAPICalled",
        "Log.entryAdded",
    ] {
        assert_eq!(page.events(trouble), [Value::Null; 0], "{trouble}");
    }
    for request in page.events("Network.requestWillBeSent") {
        let url = request["request"]["url"].as_str().unwrap();
        assert!(
            url.starts_with("data:") || url.ends_with("/out/report.html"),
            "{url}"
        );
    }
}

/// A pixel's color in the inspector's format.
fn levels(pixels: &Image, x: u32, y: u32) -> String {
    let [r, g, b, _] = pixels.get(x, y).map(quantize);
    format!("{r}, {g}, {b} of 255")
}

const NARROW: &str = "document.documentElement.scrollWidth <= innerWidth";
const NAMES: &str = "[...document.querySelectorAll('#shaders tbody tr')].filter(row => !row.hidden)\
                     .map(row => row.querySelector('th').textContent)";
const INSPECTED: &str = "Object.fromEntries([...document.querySelectorAll('article.open dt')]\
                         .map(dt => [dt.textContent, dt.nextSibling.textContent]))";
/// The color of the canvas at the inspected pixel.
const CANVAS: &str = "(() => { const c = document.querySelector('article.open canvas'); \
                      const [x, y] = ['x', 'y'].map(n => Number(document.querySelector(`article.open [name=${n}]`).value)); \
                      const copy = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true }); \
                      copy.drawImage(c, -x, y + 1 - c.height); \
                      return [...copy.getImageData(0, 0, 1, 1).data.slice(0, 3)].join(', ') + ' of 255' })()";

#[test]
fn the_table_sorts_and_filters_and_no_shader_text_runs() {
    let Some(mut page) = page() else { return };
    let folder = tempfile::tempdir().unwrap();
    let records = report(folder.path(), &["--size", "64x36"]);
    page.window([1400, 900], false);
    page.open(&folder.path().join("out/report.html"));
    let reported: Vec<_> = records
        .iter()
        .map(|record| record["shader"].as_str().unwrap().strip_prefix("hw/").unwrap())
        .collect();
    assert_eq!(
        page.value(NAMES),
        json!(reported),
        "in the order of the records, without their folder"
    );
    assert_eq!(
        page.value("document.querySelector('h1').textContent"),
        "toyproof check: hw"
    );
    assert_eq!(
        page.value(
            "[...document.querySelectorAll('.chip')].map(chip => chip.textContent.trim().split(/\\s+/))"
        ),
        json!([["correct", "2"], ["wrong", "1"], ["invalid", "2"]])
    );
    page.until("document.querySelectorAll('#shaders img').length === 3");
    assert_eq!(
        page.value("document.querySelector('#shaders img').alt"),
        "actual image of ann.glsl"
    );

    let click = |name: &str| {
        format!(
            "[...document.querySelectorAll('#shaders thead button')].find(b => b.textContent === '{name}').click()"
        )
    };
    let mut sorted = reported.clone();
    page.value(&click("Points"));
    let points = page
        .value("[...document.querySelectorAll('#shaders td:nth-child(4)')].map(td => Number(td.dataset.by))");
    let points: Vec<f64> = serde_json::from_value(points).unwrap();
    assert!(
        points.is_sorted() && points[0] == 0.0 && points[4] == 10.0,
        "{points:?}"
    );
    page.value(&click("Points"));
    let down = page.value("document.querySelector('#shaders td:nth-child(4)').dataset.by");
    assert_eq!(down, "10");
    assert_eq!(
        page.value("document.querySelector('#shaders th[aria-sort]').ariaSort"),
        "descending"
    );
    page.value(&click("Shader"));
    sorted.sort_unstable();
    assert_eq!(page.value(NAMES).as_array().unwrap().len(), sorted.len());

    let search = |words: &str| {
        format!(
            "{{ const f = document.querySelector('#filter'); f.words.value = '{words}'; f.words.dispatchEvent(new Event('input', {{ bubbles: true }})) }}"
        )
    };
    page.value(&search("BOB"));
    assert_eq!(page.value(NAMES), json!(["bob.glsl"]));
    assert_eq!(
        page.value("document.querySelector('#shown').textContent"),
        "1 of 5 shown"
    );
    page.value(&search(""));
    page.value("document.querySelector('#filter [value=invalid]').click()");
    let left: Vec<_> = ["ann", "bob", "dan"]
        .iter()
        .map(|name| format!("{name}.glsl"))
        .collect();
    assert_eq!(page.value(NAMES), json!(left));
    page.value("document.querySelector('#filter [value=invalid]').click()");

    let hostile = place(&records, HOSTILE);
    page.value(&format!("location.hash = '#s{hostile}'"));
    page.until("document.querySelector('article.open') !== null");
    let code = page.value("document.querySelector('article.open .source').textContent");
    assert!(
        code.as_str()
            .unwrap()
            .contains("</script><script>hacked=1</script>"),
        "{code}"
    );
    assert_eq!(page.value("typeof hacked"), "undefined");
    assert_eq!(
        page.value("document.querySelectorAll('img:not([src^=\"data:\"]), article script').length"),
        0
    );
    shot(&mut page, "invalid");
    is_quiet(&mut page);
}

#[test]
fn the_inspector_shows_the_image_values() {
    let Some(mut page) = page() else { return };
    let folder = tempfile::tempdir().unwrap();
    let records = report(folder.path(), &["--size", "320x180"]);
    let bob = place(&records, "bob.glsl");
    let read_image = |end: &str| image::read(&folder.path().join(format!("out/bob-{end}.png"))).unwrap();
    let (reference, actual) = (read_image("reference"), read_image("actual"));
    page.window([1400, 900], false);
    page.open(&folder.path().join("out/report.html"));
    shot(&mut page, "table");
    page.value(&format!("document.querySelector('a[href=\"#s{bob}\"]').click()"));
    page.until("document.querySelector('article.open dl dd') !== null");

    let worst = &records[bob]["algorithm"]["worst"];
    let [x, y] = ["x", "y"].map(|name| worst[name].as_u64().unwrap() as u32);
    let reported = page.value(INSPECTED);
    assert_eq!(reported["expected"], levels(&reference, x, y));
    assert_eq!(reported["actual"], levels(&actual, x, y));
    assert!(
        reported["algorithm check"]
            .as_str()
            .unwrap()
            .starts_with("differs by > 1e-"),
        "{reported}"
    );
    assert_eq!(reported["toolchain check"], "not run", "no GPU rendered");
    let floats = worst["expected"].as_array().unwrap();
    let first: f64 = reported["algorithm: expected"]
        .as_str()
        .unwrap()
        .split(", ")
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!((first - floats[0].as_f64().unwrap()).abs() < 1e-6, "{reported}");

    page.value("document.querySelector('article.open canvas').focus()");
    page.press("ArrowRight");
    page.press("ArrowUp");
    let reported = page.value(INSPECTED);
    assert_eq!(reported["expected"], levels(&reference, x + 1, y + 1));
    assert_eq!(reported["actual"], levels(&actual, x + 1, y + 1));
    assert_eq!(
        page.value("document.querySelector('article.open [name=y]').value"),
        (y + 1).to_string()
    );

    let field = |name: &str, value: u32| {
        format!(
            "{{ const f = document.querySelector('article.open [name={name}]'); f.value = {value}; f.dispatchEvent(new Event('change')) }}"
        )
    };
    page.value(&field("x", 0));
    page.value(&field("y", 9999));
    assert_eq!(page.value(INSPECTED)["expected"], levels(&reference, 0, 179));

    let slide = |value: u32| {
        format!(
            "{{ const s = document.querySelector('article.open [type=range]'); s.value = {value}; s.dispatchEvent(new Event('input')) }}"
        )
    };
    page.value(&field("x", x));
    page.value(&field("y", y));
    for (value, actual_image) in [(1000, &reference), (0, &actual)] {
        page.value(&slide(value));
        assert_eq!(page.value(CANVAS), levels(actual_image, x, y), "{value}");
    }
    page.value(&slide(500));
    shot(&mut page, "wrong");
    page.value("document.querySelector('article.open [value=difference]').click()");
    assert_ne!(page.value(CANVAS), "0, 0, 0 of 255");
    shot(&mut page, "difference");
    page.window([1400, 900], true);
    shot(&mut page, "dark");
    page.window([390, 844], false);
    shot(&mut page, "narrow");
    assert_eq!(page.value(NARROW), true, "nothing sticks out");
    page.press("Escape");
    page.until("document.querySelector('article.open') === null");
    let focused = page.value("document.activeElement.textContent");
    assert_eq!(focused, "bob.glsl", "the focus is where it was");
    shot(&mut page, "narrow-table");
    assert_eq!(page.value(NARROW), true, "nothing sticks out");
    is_quiet(&mut page);
}

/// The roles for which a screen reader needs a name: controls and landmarks.
const NAMED: [&str; 17] = [
    "button",
    "link",
    "checkbox",
    "radio",
    "slider",
    "searchbox",
    "spinbutton",
    "application",
    "table",
    "columnheader",
    "rowheader",
    "form",
    "region",
    "article",
    "navigation",
    "search",
    "image",
];

/// The roles and names of all elements that a screen reader reads, and those of [`NAMED`] without a name.
fn heard(page: &mut Page) -> (Vec<(String, String)>, Vec<String>) {
    let reported = page.call("Accessibility.getFullAXTree", &json!({}));
    let nodes = reported["nodes"].as_array().unwrap().iter();
    let heard: Vec<(String, String)> = nodes
        .filter(|node| node["ignored"] == false)
        .map(|node| ["role", "name"].map(|what| node[what]["value"].as_str().unwrap_or_default().to_owned()))
        .map(|[role, name]| (role, name))
        .collect();
    let unnamed = heard
        .iter()
        .filter(|(role, name)| NAMED.contains(&role.as_str()) && name.trim().is_empty());
    let unnamed = unnamed.map(|(role, _)| role.clone()).collect();
    (heard, unnamed)
}

/// The focused element, and whether its focus is visible.
const FOCUS: &str = "(() => { const e = document.activeElement; \
                     return [e.name || e.textContent.trim() || e.tagName, getComputedStyle(e).outlineStyle !== 'none'] })()";

/// Presses Tab until the focus leaves the page; returns the focused elements in order.
fn tabbed(page: &mut Page) -> Vec<String> {
    let mut all = Vec::new();
    loop {
        page.press("Tab");
        let (what, seen): (String, bool) = serde_json::from_value(page.value(FOCUS)).unwrap();
        if page.value("document.activeElement === document.body") == true || all.len() > 200 {
            return all;
        }
        assert!(seen, "the focus of {what} is invisible");
        all.push(what);
    }
}

#[test]
fn all_controls_have_a_name_and_keyboard_access() {
    let Some(mut page) = page() else { return };
    let folder = tempfile::tempdir().unwrap();
    let records = report(folder.path(), &["--size", "64x36"]);
    let bob = place(&records, "bob.glsl");
    for window in [[1400, 900], [390, 844]] {
        page.window(window, false);
        page.open(&folder.path().join("out/report.html"));
        let (heard_first, unnamed) = heard(&mut page);
        assert_eq!(unnamed, [""; 0], "{heard_first:?}");
        let has = |heard: &[(String, String)], role: &str, name: &str| {
            assert!(
                heard
                    .iter()
                    .any(|(own, reported)| own == role && reported == name),
                "no {role} “{name}”: {heard:?}"
            );
        };
        has(&heard_first, "table", "Shaders");
        has(&heard_first, "button", "Verdict");
        has(&heard_first, "status", "");
        let rows = heard_first.iter().filter(|(role, _)| role == "rowheader");
        assert_eq!(rows.count(), records.len(), "the table is one in both windows");

        let reached = tabbed(&mut page);
        for name in ["words", "verdict", "Shader", "Points", "bob.glsl"] {
            assert!(reached.iter().any(|own| own == name), "{name}: {reached:?}");
        }
        page.value(&format!("document.querySelector('a[href=\"#s{bob}\"]').focus()"));
        page.press("Enter");
        page.until("document.querySelector('article.open dl dd') !== null");
        assert_eq!(
            page.value("document.activeElement.textContent"),
            "bob.glsl",
            "its heading"
        );
        let (heard_then, unnamed) = heard(&mut page);
        assert_eq!(unnamed, [""; 0], "{heard_then:?}");
        has(&heard_then, "article", "bob.glsl");
        has(&heard_then, "table", "Checks");
        has(&heard_then, "region", "Source");
        has(&heard_then, "button", "Copy the command");
        let reached = tabbed(&mut page);
        for name in ["view", "CANVAS", "x", "y"] {
            assert!(reached.iter().any(|own| own == name), "{name}: {reached:?}");
        }
        let slider = page.value("document.querySelector('article.open [type=range]').ariaValueText");
        assert_eq!(slider, "50 % reference");
        page.press("Escape");
    }
}

/// Opens the article of a shader by its link.
fn open_article(page: &mut Page, index: usize) {
    page.value(&format!(
        "document.querySelector('a[href=\"#s{index}\"]').click()"
    ));
    page.until(&format!("document.querySelector('#s{index}.open') !== null"));
}

const OPEN: &str = "document.querySelector('article.open')?.dataset.name ?? null";

#[test]
fn keys_move_between_shaders_and_terms_are_defined_on_focus() {
    let Some(mut page) = page() else { return };
    let folder = tempfile::tempdir().unwrap();
    let records = report(folder.path(), &["--size", "64x36"]);
    let bob = place(&records, "bob.glsl");
    page.window([1400, 900], false);
    page.open(&folder.path().join("out/report.html"));
    page.value(&format!("document.querySelector('a[href=\"#s{bob}\"]').focus()"));
    for (key, name) in [("ArrowDown", "cyd.glsl"), ("ArrowUp", "bob.glsl")] {
        page.press(key);
        assert_eq!(page.value("document.activeElement.textContent"), name);
    }
    page.press("Enter");
    page.until("document.querySelector('article.open dl dd') !== null");
    for (key, name) in [("ArrowRight", "cyd.glsl"), ("ArrowLeft", "bob.glsl")] {
        page.press(key);
        page.until(&format!("({OPEN}) === '{name}'"));
    }
    page.until("document.querySelector('article.open canvas') !== null");
    page.value("document.querySelector('article.open canvas').focus()");
    page.press("ArrowRight");
    assert_eq!(
        page.value(OPEN),
        "bob.glsl",
        "the key selects a pixel of the image"
    );

    page.value("document.querySelector('article.open h2').focus()");
    page.press("Tab");
    let tip = "[document.activeElement.textContent, document.querySelector('#tip').hidden, \
               document.querySelector('#tip').textContent === document.querySelector('#t-wrong-text').textContent]";
    assert_eq!(page.value(tip), json!(["wrong", false, true]));
    page.press("Escape");
    assert_eq!(page.value("document.querySelector('#tip').hidden"), true);
    assert_eq!(
        page.value(OPEN),
        "bob.glsl",
        "the first Escape closes the definition"
    );
    page.press("Enter");
    page.until("location.hash === '#t-wrong'");
    assert_eq!(page.value(OPEN), "bob.glsl", "the glossary is below the shader");
    page.press("Escape");
    assert_eq!(page.value(OPEN), Value::Null);
    is_quiet(&mut page);
}

#[test]
fn messages_are_beside_their_lines() {
    let Some(mut page) = page() else { return };
    let folder = tempfile::tempdir().unwrap();
    let records = report(folder.path(), &["--size", "64x36"]);
    let cyd = place(&records, "cyd.glsl");
    page.window([1400, 900], false);
    page.open(&folder.path().join("out/report.html"));
    open_article(&mut page, cyd);
    let error = &records[cyd]["diagnostics"][0];
    let line = error["line"].as_u64().unwrap();
    let marked = page.value(
        "(() => { const line = document.querySelector('article.open .marked .line'); \
         return [line.dataset.line, line.querySelector('mark').textContent, \
                 line.closest('pre').nextElementSibling.querySelector('a').hash] })()",
    );
    assert_eq!(marked[0], line.to_string());
    assert_eq!(marked[1], "flaot");
    let numbers = page
        .value("[...document.querySelectorAll('article.open .line')].map(line => Number(line.dataset.line))");
    let numbers: Vec<usize> = serde_json::from_value(numbers).unwrap();
    let source = fs::read_to_string(folder.path().join("hw/cyd.glsl")).unwrap();
    assert_eq!(
        numbers,
        (1..=source.lines().count()).collect::<Vec<_>>(),
        "the whole source"
    );
    page.value("document.querySelector('article.open .message a').click()");
    let hash = marked[2].as_str().unwrap();
    page.until(&format!("document.querySelector('{hash}').open"));
    is_quiet(&mut page);
}

#[test]
fn one_shader_is_saved_as_a_page_of_its_own() {
    let Some(mut page) = page() else { return };
    let folder = tempfile::tempdir().unwrap();
    let records = report(folder.path(), &["--size", "64x36"]);
    let bob = place(&records, "bob.glsl");
    let file = folder.path().join("out/report.html");
    page.window([1400, 900], false);
    page.open(&file);
    open_article(&mut page, bob);
    page.until("document.querySelector('article.open dl dd') !== null");
    // The download itself is the browser's.
    page.value("{ URL.createObjectURL = blob => { window.saved = blob.text(); return '#'; }; HTMLAnchorElement.prototype.click = () => {} }");
    page.value(
        "[...document.querySelectorAll('.moves button')].find(b => b.textContent === 'Save as HTML').click()",
    );
    let saved = page.value("window.saved");
    let saved = saved.as_str().unwrap();
    for other in ["ann.glsl", "cyd.glsl", "dan.glsl", HOSTILE, "5 shaders"] {
        assert!(!saved.contains(other), "{other} is in the page of another shader");
    }
    fs::write(&file, saved).unwrap();
    page.open(&file);
    page.until("document.querySelector('article.open dl dd') !== null");
    assert_eq!(page.value("document.title"), "toyproof check: bob.glsl");
    assert_eq!(page.value("document.querySelectorAll('article').length"), 1);
    let worst = &records[bob]["algorithm"]["worst"];
    assert_eq!(
        page.value("document.querySelector('[name=x]').value"),
        worst["x"].to_string()
    );
    assert_eq!(
        page.value("document.querySelector('#t-wrong').checkVisibility()"),
        true
    );
    page.press("Escape");
    assert_eq!(page.value(OPEN), "bob.glsl", "there is no table to go back to");
    is_quiet(&mut page);
    shot(&mut page, "saved");
}

#[test]
fn the_image_after_the_fix_is_beside_the_others() {
    let Some(mut page) = page() else { return };
    let mut gallery = Gallery::new(1);
    let mut plain = |level: f32| {
        let image = Image::new(8, 8, vec![[level, level, level, 1.0]; 64]);
        Some(gallery.add_image(image::encode(&image, Path::new("x.png")).unwrap()))
    };
    let [actual, reference, fixed] = [0.0, 1.0, 0.6].map(&mut plain);
    gallery.add_exhibit(Exhibit {
        source: Some("float a() {\n    return b + c;\n}\n".to_owned()),
        actual,
        reference,
        fixed,
        ..Exhibit::default()
    });
    let edit = json!({
        "line": 2, "column": 12, "end_line": 2, "end_column": 17,
        "replacement": "b - c", "text": "replace `b + c` with `b - c`",
    });
    let mut fix = json!({
        "id": "wrong-operator", "file": "hw/eve.glsl", "agreeing": 64, "pixels": 64, "edits": [edit],
    });
    fix.as_object_mut()
        .unwrap()
        .extend(edit.as_object().unwrap().clone());
    let record = Record {
        verdict: Verdict::Wrong,
        reason: "all 64 pixels differ".to_owned(),
        fix: Some(serde_json::from_value(fix).unwrap()),
        ..Record::unchecked("hw/eve.glsl".to_owned())
    };
    let text = html(
        &Report::new(None, vec![record]),
        &Rubrics::default(),
        &gallery,
        UNIX_EPOCH,
    );
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("out/report.html");
    fs::create_dir(file.parent().unwrap()).unwrap();
    fs::write(&file, text).unwrap();
    page.window([1400, 900], false);
    page.open(&file);
    page.until("document.querySelector('article.open dl dd') !== null");
    page.value("document.querySelector('article.open [name=view][value=fixed]').click()");
    assert_eq!(page.value(CANVAS), "153, 153, 153 of 255");
    assert_eq!(page.value(INSPECTED)["after the fix"], "153, 153, 153 of 255");
    assert_eq!(
        page.value("document.querySelectorAll('article.open ul.legend li').length"),
        0,
        "the image has no legend"
    );
    assert_eq!(
        page.value("document.querySelector('.marked.fix mark').textContent"),
        "b + c"
    );
    shot(&mut page, "fix");
    page.value("dispatchEvent(new Event('beforeprint'))");
    assert_eq!(
        page.value("[...document.querySelectorAll('article.open figure img')].map(image => image.alt)"),
        json!([
            "Actual image of eve.glsl",
            "Reference of eve.glsl",
            "Image after the fix of eve.glsl"
        ])
    );
    is_quiet(&mut page);
}

#[test]
fn on_paper_each_shader_has_its_images_and_its_whole_source() {
    let Some(mut page) = page() else { return };
    let folder = tempfile::tempdir().unwrap();
    let records = report(folder.path(), &["--size", "64x36"]);
    let bob = place(&records, "bob.glsl");
    page.window([1400, 900], true);
    page.open(&folder.path().join("out/report.html"));
    let print = |page: &mut Page, is_start: bool| {
        let media = if is_start { "print" } else { "screen" };
        let dark = json!({ "name": "prefers-color-scheme", "value": "dark" });
        page.call(
            "Emulation.setEmulatedMedia",
            &json!({ "media": media, "features": [dark] }),
        );
        let event = if is_start { "beforeprint" } else { "afterprint" };
        page.value(&format!("dispatchEvent(new Event('{event}'))"));
    };
    page.value("document.querySelector('#filter [value=invalid]').click()");
    print(&mut page, true);
    let printed =
        "[...document.querySelectorAll('article')].filter(a => a.checkVisibility()).map(a => a.dataset.name)";
    assert_eq!(
        page.value(printed),
        json!(["ann.glsl", "bob.glsl", "dan.glsl"]),
        "those that the table shows"
    );
    assert_eq!(
        page.value(&format!(
            "[...document.querySelectorAll('#s{bob} figure img')].map(image => image.alt)"
        )),
        json!([
            "Actual image of bob.glsl",
            "Reference of bob.glsl",
            "Image after the fix of bob.glsl",
            "Difference: algorithm check of bob.glsl"
        ])
    );
    let hidden = "[...document.querySelectorAll('.source, .source details, .source .line')].filter(part => !part.closest('.filtered') \
                  && (!part.checkVisibility() || part.open === false)).length";
    assert_eq!(page.value(hidden), 0, "nothing is folded");
    assert_eq!(
        page.value("document.querySelector('#filter').checkVisibility()"),
        false
    );
    assert_eq!(
        page.value(
            "[getComputedStyle(document.body).backgroundColor, getComputedStyle(document.body).color]"
        ),
        json!(["rgb(255, 255, 255)", "rgb(0, 0, 0)"]),
        "black on white also in the dark theme"
    );
    print(&mut page, false);
    assert_eq!(
        page.value("document.querySelectorAll('figure, .source details[open]').length"),
        0
    );
    open_article(&mut page, bob);
    print(&mut page, true);
    assert_eq!(page.value(printed), json!(["bob.glsl"]), "the open one");
    is_quiet(&mut page);
}

#[test]
fn the_theme_can_be_chosen() {
    let Some(mut page) = page() else { return };
    let folder = tempfile::tempdir().unwrap();
    report(folder.path(), &["--size", "64x36"]);
    page.window([1400, 900], false);
    page.open(&folder.path().join("out/report.html"));
    let theme = "[getComputedStyle(document.body).backgroundColor === 'rgb(255, 255, 255)', \
                  document.querySelector('[aria-pressed]').ariaPressed]";
    assert_eq!(page.value(theme), json!([true, "false"]));
    page.value("document.querySelector('[aria-pressed]').click()");
    assert_eq!(page.value(theme), json!([false, "true"]));
    is_quiet(&mut page);
}

#[test]
fn without_scripts_there_are_still_the_table_and_the_messages() {
    let Some(mut page) = page() else { return };
    let folder = tempfile::tempdir().unwrap();
    let records = report(folder.path(), &["--size", "64x36"]);
    page.call("Emulation.setScriptExecutionDisabled", &json!({ "value": true }));
    page.open(&folder.path().join("out/report.html"));
    assert_eq!(
        page.value("document.querySelectorAll('#shaders tbody tr').length"),
        records.len()
    );
    assert_eq!(
        page.value("document.querySelector('#filter').checkVisibility()"),
        false
    );
    assert_eq!(
        page.value("[...document.querySelectorAll('article')].every(a => a.checkVisibility())"),
        true
    );
    shot(&mut page, "without-script");
}

/// The number of articles that are laid out.
const VISIBLE_ARTICLES: &str =
    "[...document.querySelectorAll('article')].filter(article => article.checkVisibility()).length";

/// The number of images that the page has loaded since it was opened.
fn decoded_images(page: &mut Page) -> usize {
    let requests = page.events("Network.requestWillBeSent");
    let urls = requests
        .iter()
        .filter_map(|request| request["request"]["url"].as_str());
    urls.filter(|url| url.starts_with("data:image/")).count()
}

/// Noise, which PNG cannot compress.
fn noise(seed: u32, width: u32, height: u32) -> Image {
    let pixel = |at: u32| {
        let level = |part: u32| {
            let hash = (seed * 1_000_003 + at * 3 + part).wrapping_mul(2_654_435_761);
            f64::from((hash ^ hash >> 15).wrapping_mul(0x85eb_ca6b) >> 24) as f32 / 255.0
        };
        [level(0), level(1), level(2), 1.0]
    };
    Image::new(width, height, (0..width * height).map(pixel).collect())
}

#[test]
fn a_page_of_500_shaders_shows_one_at_a_time() {
    let Some(mut page) = page() else { return };
    let mut gallery = Gallery::new(5);
    let records = (0..500).map(|at| {
        let png = image::encode(&noise(at, 120, 67), Path::new("a.png")).unwrap();
        let actual = Some(gallery.add_image(png));
        gallery.add_exhibit(Exhibit {
            source: Some(SPHERE.shader.to_owned()),
            actual,
            ..Exhibit::default()
        });
        Record {
            verdict: Verdict::Ok,
            reason: "rendered".to_owned(),
            ..Record::unchecked(format!("hw/{at:03}.glsl"))
        }
    });
    let records: Vec<_> = records.collect();
    let text = html(
        &Report::new(None, records),
        &Rubrics::default(),
        &gallery,
        UNIX_EPOCH,
    );
    assert!((16_000_000..20_000_000).contains(&text.len()), "{}", text.len());
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("out/report.html");
    fs::create_dir(folder.path().join("out")).unwrap();
    fs::write(&file, text).unwrap();
    page.window([1400, 900], false);
    page.open(&file);
    // Opening the page costs no more than its table: articles are laid out, and images decoded, when they are
    // shown. The window has room for about a dozen thumbnails.
    assert_eq!(page.value(VISIBLE_ARTICLES), 0);
    page.until("document.querySelector('#shaders img') !== null");
    assert!(
        page.value("document.querySelectorAll('#shaders img').length")
            .as_u64()
            < Some(30)
    );
    let thumbnails = decoded_images(&mut page);
    page.value("document.querySelector('#shaders tr[data-verdict=ok] a').click()");
    page.until("document.querySelector('article.open dl dd') !== null");
    assert_eq!(page.value(VISIBLE_ARTICLES), 1);
    assert!(decoded_images(&mut page) < thumbnails + 30);
    is_quiet(&mut page);
}
