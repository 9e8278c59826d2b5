//! The page of `toyproof watch` in a real browser. `TOYPROOF_SCREENSHOTS` names a folder for screenshots.

use std::path::PathBuf;
use std::{env, fs};

use serde_json::{Value, json};

use super::{counter, plain, save_by_renaming, start};
use crate::requirements::require_chromium;
use crate::support::SPHERE;
use crate::support::devtools::Page;
use crate::support::watching::Watch;

/// WebGL 2 on the software driver of Chromium.
const SWITCHES: [&str; 3] = [
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
];

fn browser() -> Option<Page> {
    require_chromium().map(|program| Page::with(&program, &SWITCHES))
}

/// Opens the page, and waits until it shows an image.
fn open(page: &mut Page, watch: &Watch) {
    page.open_url(&watch.url());
    page.until("document.querySelector('#images').dataset.version !== undefined");
}

/// The color of the center of the image that is shown.
const CENTER: &str = "(() => { const c = document.querySelector('#images canvas'); \
                      const copy = new OffscreenCanvas(1, 1).getContext('2d'); \
                      copy.drawImage(c, -(c.width >> 1), -(c.height >> 1)); \
                      return String(copy.getImageData(0, 0, 1, 1).data.slice(0, 3)) })()";

fn until_center(page: &mut Page, color: &str) {
    page.until(&format!("{CENTER} === '{color}'"));
}

/// Asserts that the page reported no error but answers with these codes, and fetched nothing from elsewhere.
/// 409 is that for a version that a save has replaced.
fn is_quiet(page: &mut Page, watch: &Watch, codes: &[&str]) {
    for trouble in ["Runtime.exceptionThrown", "Runtime.consoleAPICalled"] {
        assert_eq!(page.events(trouble), [Value::Null; 0], "{trouble}");
    }
    for entry in page.events("Log.entryAdded") {
        let text = entry["entry"]["text"].as_str().unwrap();
        assert!(codes.iter().any(|code| text.contains(code)), "{entry}");
    }
    for request in page.events("Network.requestWillBeSent") {
        let url = request["request"]["url"].as_str().unwrap();
        assert!(url.starts_with(&watch.url()) || url.starts_with("data:"), "{url}");
    }
}

#[test]
fn the_page_follows_saves_and_keeps_the_last_good_image() {
    let Some(mut page) = browser() else { return };
    let folder = tempfile::tempdir().unwrap();
    let shader = folder.path().join("a.glsl");
    fs::write(&shader, plain("1.0, 0.0, 0.0")).unwrap();
    let watch = start(folder.path(), &["a.glsl", "--size", "64x36", "--timeout", "1s"]);
    open(&mut page, &watch);
    until_center(&mut page, "255,0,0");
    save_by_renaming(&shader, &plain("0.0, 1.0, 0.0"));
    until_center(&mut page, "0,255,0");
    page.until("document.querySelector('#article .verdict')?.textContent === 'ok'");
    fs::write(
        &shader,
        "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(<b>);\n}\n",
    )
    .unwrap();
    page.until("document.querySelector('#article .message.error') !== null");
    assert_eq!(
        page.value("document.querySelector('#problem').textContent"),
        "The image is that of the last version that compiles."
    );
    assert_eq!(page.value(CENTER), "0,255,0");
    assert_eq!(page.value("document.querySelector('#article b')"), Value::Null);
    // An image that never ends is reported, and the last one stays.
    fs::write(
        &shader,
        "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(0.0);\n    for (;;) c.x += p.x;\n}\n",
    )
    .unwrap();
    page.until("document.querySelector('#problem').textContent.includes('time limit')");
    assert_eq!(page.value(CENTER), "0,255,0");
    fs::write(&shader, plain("0.0, 0.0, 1.0")).unwrap();
    until_center(&mut page, "0,0,255");
    page.until("document.querySelector('#problem').hidden");
    is_quiet(&mut page, &watch, &["409", "422"]);
}

#[test]
fn time_mouse_and_keys_reach_the_shader_while_it_plays() {
    let Some(mut page) = browser() else { return };
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write(
        "image.glsl",
        "void mainImage(out vec4 c, in vec2 p) {\n    float key = texelFetch(iChannel0, ivec2(65, 2), 0).x;\n    \
         c = vec4(iMouse.x / iResolution.x, key, float(iFrame) / 255.0, 1.0);\n}\n",
    );
    write(
        "project.toml",
        "[[pass]]\ntab = \"image\"\ninputs = [{ channel = 0, source = \"keyboard\" }]\n",
    );
    let watch = start(folder.path(), &[".", "--size", "64x36", "--frame", "0"]);
    page.window([1400, 900], false);
    open(&mut page, &watch);
    until_center(&mut page, "0,0,0");
    page.value("document.querySelector('#step').click()");
    until_center(&mut page, "0,0,1");
    assert_eq!(page.value("document.querySelector('#time').value"), "0.017");
    page.value("document.querySelector('#play').click()");
    page.until("Number(document.querySelector('#images').dataset.frame) > 3");
    let place = page.value(
        "(() => { const box = document.querySelector('#images canvas').getBoundingClientRect(); \
         return [box.left + box.width / 2, box.top + box.height / 2] })()",
    );
    for kind in ["mousePressed", "mouseReleased"] {
        page.call(
            "Input.dispatchMouseEvent",
            &json!({"type": kind, "x": place[0], "y": place[1], "button": "left", "clickCount": 1}),
        );
    }
    page.value("document.querySelector('#images canvas').focus()");
    let key =
        json!({"type": "keyDown", "key": "a", "code": "KeyA", "windowsVirtualKeyCode": 65, "text": "a"});
    page.call("Input.dispatchKeyEvent", &key);
    page.until(&format!("/^129,255,/.test({CENTER})"));
    page.press("Escape");
    page.until("document.querySelector('#play').textContent === 'Play'");
    page.value("document.querySelector('#reset').click()");
    until_center(&mut page, "0,0,0");
    is_quiet(&mut page, &watch, &["409"]);
}

#[test]
fn the_browsers_own_image_agrees() {
    let Some(mut page) = browser() else { return };
    let folder = tempfile::tempdir().unwrap();
    counter(folder.path());
    let watch = start(folder.path(), &[".", "--size", "64x36"]);
    open(&mut page, &watch);
    // The check shows frame 7.
    until_center(&mut page, "8,8,8");
    let compared = "document.querySelector('#inspected dl').textContent";
    page.value(
        "(() => { const select = document.querySelector('#comparison'); select.value = 'browser'; \
                select.dispatchEvent(new Event('change')) })()",
    );
    page.until(&format!("{compared}.includes('WebGL 2')"));
    for step in ["#step", "#step", "#step-back"] {
        page.value(&format!("document.querySelector('{step}').click()"));
    }
    page.until("document.querySelector('#images').dataset.frame === '8'");
    page.until(&format!("{compared}.includes('WebGL 29, 9, 9')"));
    assert!(page.value(compared).as_str().unwrap().contains("0 of 255 levels"));
    is_quiet(&mut page, &watch, &["409"]);
}

#[test]
fn a_wrong_shader_is_shown_beside_its_reference() {
    let Some(mut page) = browser() else { return };
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SPHERE.scene).unwrap();
    let wrong = SPHERE.shader.replace("b * b - c", "b * b - 0.9 * c");
    fs::write(folder.path().join("sphere.glsl"), wrong).unwrap();
    let watch = start(folder.path(), &["sphere.glsl", "--scene", "scene.toml"]);
    page.window([1400, 900], false);
    open(&mut page, &watch);
    page.until("document.querySelector('#article .verdict')?.textContent === 'wrong'");
    page.until("!document.querySelector('#images [value=algorithm]').closest('label').hidden");
    assert_eq!(
        page.value("document.querySelector('#images [value=difference]').closest('label').hidden"),
        false
    );
    page.until("document.querySelector('#values pre').textContent.includes('expected color')");
    for (dark, theme) in [(false, "light"), (true, "dark")] {
        for [width, height] in [[1400, 900], [400, 860]] {
            page.window([width, height], dark);
            assert_eq!(
                page.value("document.documentElement.scrollWidth <= innerWidth"),
                true,
                "{width} pixels"
            );
            if let Some(folder) = env::var_os("TOYPROOF_SCREENSHOTS") {
                let path = PathBuf::from(folder).join(format!("watch-{theme}-{width}.png"));
                fs::write(path, page.screenshot()).unwrap();
            }
        }
    }
    page.call("Accessibility.enable", &json!({}));
    let tree = page.call("Accessibility.getFullAXTree", &json!({}));
    for node in tree["nodes"].as_array().unwrap() {
        let role = node["role"]["value"].as_str().unwrap_or_default();
        let is_control = [
            "button",
            "checkbox",
            "combobox",
            "radio",
            "slider",
            "spinbutton",
            "textbox",
        ]
        .contains(&role);
        if is_control && node["ignored"] != true {
            assert_ne!(
                node["name"]["value"].as_str().unwrap_or_default(),
                "",
                "a {role} has no name"
            );
        }
    }
    is_quiet(&mut page, &watch, &["409"]);
}
