//! `toyproof watch`: the program, over HTTP.

mod page;

use std::fs;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::support::SPHERE;
use crate::support::wait::wait_until;
use crate::support::watching::{Answer, Pixels, Watch};

/// A size with few pixels.
const SIZE: [u32; 2] = [8, 4];

/// A limit that only a hang exceeds.
const NO_LIMIT: &str = "1h";

/// A shader of one color.
fn plain(color: &str) -> String {
    format!("void mainImage(out vec4 c, in vec2 p) {{ c = vec4({color}, 1.0); }}\n")
}

fn start(folder: &Path, arguments: &[&str]) -> Watch {
    Watch::start(Path::new(env!("CARGO_BIN_EXE_toyproof")), folder, arguments)
}

/// The color of the upper left pixel.
fn corner(pixels: &Pixels) -> [u8; 3] {
    [pixels.bytes[0], pixels.bytes[1], pixels.bytes[2]]
}

/// The color of an image that there is.
fn color(watch: &Watch, view: &Value) -> [u8; 3] {
    corner(&watch.image("frame", view).unwrap())
}

/// Saves a file as editors do that write another one and rename it.
fn save_by_renaming(path: &Path, text: &str) {
    let other = path.with_extension("tmp");
    fs::write(&other, text).unwrap();
    fs::rename(&other, path).unwrap();
}

#[test]
fn a_save_gives_a_new_image_and_a_new_verdict() {
    let folder = tempfile::tempdir().unwrap();
    let shader = folder.path().join("a.glsl");
    fs::write(&shader, plain("1.0, 0.0, 0.0")).unwrap();
    let watch = start(folder.path(), &["a.glsl"]);
    let tab = watch.open_tab();
    let view = tab.view(SIZE);
    let first = tab.next("version");
    assert_eq!(
        (&first["name"], &first["compiles"]),
        (&json!("a.glsl"), &json!(true))
    );
    assert_eq!(first["frame"]["size"], json!([640, 360]));
    let image = watch.image("frame", &view).unwrap();
    assert_eq!((corner(&image), image.bytes.len()), ([255, 0, 0], 4 * 8 * 4));
    assert_eq!(image.head["size"], json!(SIZE));
    assert_eq!(tab.next("check")["article"]["verdict"], "ok");
    save_by_renaming(&shader, &plain("0.0, 1.0, 0.0"));
    let second = tab.next("version");
    assert_ne!(second["version"], first["version"]);
    assert_eq!(color(&watch, &view), [0, 255, 0]);
    fs::write(&shader, plain("0.0, 0.0, 1.0")).unwrap();
    tab.next("version");
    assert_eq!(color(&watch, &view), [0, 0, 255]);
    assert_eq!(tab.next("check")["article"]["verdict"], "ok");
}

#[test]
fn saves_in_quick_succession_are_one() {
    let folder = tempfile::tempdir().unwrap();
    let shader = folder.path().join("a.glsl");
    fs::write(&shader, plain("1.0, 0.0, 0.0")).unwrap();
    let watch = start(folder.path(), &["a.glsl"]);
    let tab = watch.open_tab();
    let view = tab.view(SIZE);
    tab.next("version");
    // A slow machine may take longer between two saves than the time in which they are one.
    let mut quick = false;
    while !quick {
        let begin = Instant::now();
        for color in ["0.0, 1.0, 0.0", "0.0, 0.0, 1.0"] {
            fs::write(&shader, plain(color)).unwrap();
            thread::sleep(Duration::from_millis(30));
        }
        quick = begin.elapsed() < Duration::from_millis(90);
        tab.next("version");
        if !quick {
            thread::sleep(Duration::from_millis(300));
            tab.waiting("version");
        }
    }
    assert_eq!(color(&watch, &view), [0, 0, 255]);
    fs::write(&shader, plain("1.0, 1.0, 1.0")).unwrap();
    tab.next("version");
    assert_eq!(color(&watch, &view), [255, 255, 255]);
    assert_eq!(
        tab.waiting("version"),
        0,
        "there were two versions for three saves"
    );
}

#[test]
fn a_shader_that_never_ends_stops_with_the_next_save() {
    const ENDLESS: &str =
        "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(0.0);\n    for (;;) c.x += p.x;\n}\n";
    let folder = tempfile::tempdir().unwrap();
    let shader = folder.path().join("a.glsl");
    fs::write(&shader, plain("1.0, 0.0, 0.0")).unwrap();
    let watch = start(folder.path(), &["a.glsl", "--timeout", NO_LIMIT]);
    let tab = watch.open_tab();
    let view = tab.view(SIZE);
    tab.next("version");
    assert_eq!(color(&watch, &view), [255, 0, 0]);
    fs::write(&shader, ENDLESS).unwrap();
    assert_eq!(tab.next("version")["compiles"], true);
    thread::scope(|scope| {
        let endless = scope.spawn(|| watch.image("frame", &view));
        // The request is in progress, or begins after the save and gets the new image.
        thread::sleep(Duration::from_millis(200));
        fs::write(&shader, plain("0.0, 1.0, 0.0")).unwrap();
        tab.next("version");
        assert_eq!(color(&watch, &view), [0, 255, 0]);
        let status = endless
            .join()
            .unwrap()
            .map_or_else(|answer| answer.status, |_| 200);
        assert!([200, 409].contains(&status), "{status}");
    });
    assert_eq!(
        tab.next("check")["article"]["verdict"],
        "ok",
        "the check of the endless one has ended"
    );
}

#[test]
fn the_time_limit_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("a.glsl"),
        "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(0.0);\n    for (;;) c.x += p.x;\n}\n",
    )
    .unwrap();
    let watch = start(folder.path(), &["a.glsl", "--timeout", "200ms"]);
    let tab = watch.open_tab();
    tab.next("version");
    let Err(Answer { status, body, .. }) = watch.image("frame", &tab.view(SIZE)) else {
        panic!("an endless shader has an image");
    };
    let answer: Value = serde_json::from_slice(&body).unwrap();
    assert_eq!(status, 422);
    let message = answer["message"].as_str().unwrap();
    assert!(
        message.contains("time limit") && message.contains("line 3"),
        "{message}"
    );
    assert_eq!(tab.next("check")["article"]["verdict"], "timeout");
}

#[test]
fn an_error_leaves_the_last_good_image() {
    let folder = tempfile::tempdir().unwrap();
    let shader = folder.path().join("a.glsl");
    fs::write(&shader, plain("1.0, 0.0, 0.0")).unwrap();
    let watch = start(folder.path(), &["a.glsl"]);
    let tab = watch.open_tab();
    let view = tab.view(SIZE);
    let first = tab.next("version");
    fs::write(
        &shader,
        "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(<b>);\n}\n",
    )
    .unwrap();
    let broken = tab.next("version");
    assert_eq!(
        (&broken["compiles"], &broken["version"]),
        (&json!(false), &first["version"])
    );
    assert_eq!(broken["article"]["verdict"], "invalid");
    let article = broken["article"]["html"].as_str().unwrap();
    assert!(
        article.contains("2:14") && article.contains("data-line=\"2\""),
        "{article}"
    );
    assert!(
        !article.contains("<b>"),
        "no text of the shader is markup: {article}"
    );
    assert_eq!(color(&watch, &view), [255, 0, 0]);
    fs::remove_file(&shader).unwrap();
    let missing = tab.next("version");
    assert_eq!(
        (&missing["compiles"], color(&watch, &view)),
        (&json!(false), [255, 0, 0])
    );
    fs::write(&shader, plain("0.0, 1.0, 0.0")).unwrap();
    assert_eq!(tab.next("version")["compiles"], true);
    assert_eq!(color(&watch, &view), [0, 255, 0]);
}

#[test]
fn only_the_page_itself_is_served() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.glsl"), plain("1.0, 0.0, 0.0")).unwrap();
    let watch = start(folder.path(), &["a.glsl"]);
    let (own, host) = (watch.path(), watch.host());
    let status = |head: &str| watch.send(format!("{head}\r\n\r\n").as_bytes()).status;
    let page = watch.get("");
    assert_eq!(page.status, 200);
    for header in [
        "Content-Security-Policy: default-src 'none'",
        "Referrer-Policy: no-referrer",
        "nosniff",
    ] {
        assert!(page.head.contains(header), "{}", page.head);
    }
    let other_token = format!("/{}/", "0".repeat(own.len() - 2));
    let prefix = &own[..own.len() - 2];
    for path in [
        "/",
        "/favicon.ico",
        &other_token,
        &format!("{prefix}/"),
        &format!("{own}/").replacen('/', "//", 1),
    ] {
        assert_eq!(
            status(&format!("GET {path} HTTP/1.1\r\nHost: {host}")),
            403,
            "{path}"
        );
    }
    let port = host.split(':').nth(1).unwrap();
    for head in [
        "Host: evil.example".to_owned(),
        format!("Host: evil.example:{port}"),
        format!("Host: {host}\r\nOrigin: http://evil.example"),
        format!("Host: {host}\r\nOrigin: null"),
        String::new(),
    ] {
        assert_eq!(status(&format!("GET {own} HTTP/1.1\r\n{head}")), 403, "{head}");
    }
    let with = |rest: &str| format!("{rest} HTTP/1.1\r\nHost: {host}");
    assert_eq!(status(&with(&format!("GET {own}nothing"))), 404);
    assert_eq!(status(&with(&format!("GET {own}frame"))), 405);
    assert_eq!(status(&with(&format!("PUT {own}frame"))), 405);
    let long = "a".repeat(20_000);
    assert_eq!(
        status(&format!("{}\r\nX: {long}", with(&format!("GET {own}")))),
        431
    );
    assert_eq!(
        status(&format!(
            "{}\r\nContent-Length: 1000000",
            with(&format!("POST {own}frame"))
        )),
        413
    );
    assert_eq!(watch.post("frame", &json!({"no": "view"})).status, 400);
    assert_eq!(status("GARBAGE"), 400);
}

#[test]
fn two_tabs_follow_and_have_their_own_moments() {
    let folder = tempfile::tempdir().unwrap();
    let shader = folder.path().join("a.glsl");
    fs::write(&shader, plain("iTime, 0.0, 0.0")).unwrap();
    let watch = start(folder.path(), &["a.glsl"]);
    let tabs = [watch.open_tab(), watch.open_tab()];
    let mut views = [tabs[0].view(SIZE), tabs[1].view(SIZE)];
    (views[1]["time"], views[1]["frame"]) = (json!(1), json!(60));
    assert_ne!(views[0]["tab"], views[1]["tab"]);
    for component in 0..2 {
        for (tab, view) in tabs.iter().zip(&views) {
            tab.next("version");
            let mut expected = [0; 3];
            expected[component] = if view["frame"] == 0 { 0 } else { 255 };
            assert_eq!(color(&watch, view), expected);
        }
        fs::write(&shader, plain("0.0, iTime, 0.0")).unwrap();
    }
}

#[test]
fn included_files_the_scene_and_new_tabs_are_followed() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("part.glsl", "const vec3 COLOR = vec3(1.0, 0.0, 0.0);\n");
    write(
        "a.glsl",
        "#include \"part.glsl\"\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(COLOR, 1.0); }\n",
    );
    write("scene.toml", SPHERE.scene);
    let watch = start(
        folder.path(),
        &["a.glsl", "--scene", "scene.toml", "--size", "64x36"],
    );
    let tab = watch.open_tab();
    let view = tab.view([64, 36]);
    assert_eq!(tab.next("version")["reference"]["name"], "scene.toml");
    let reference = watch.image("reference", &view).unwrap();
    assert_eq!(tab.next("check")["article"]["verdict"], "wrong");
    write("part.glsl", "const vec3 COLOR = vec3(0.0, 1.0, 0.0);\n");
    tab.next("version");
    assert_eq!(color(&watch, &view), [0, 255, 0]);
    assert_eq!(watch.image("reference", &view).unwrap(), reference);
    write(
        "scene.toml",
        &SPHERE.scene.replace("radius = 1.5", "radius = 0.5"),
    );
    tab.next("version");
    let changed = watch.image("reference", &view).unwrap();
    assert!(changed.bytes != reference.bytes, "the radius is another");
    write("scene.toml", "radius = \n");
    let broken = tab.next("version");
    assert_eq!(broken["compiles"], true);
    assert!(
        broken["referenceFailure"]
            .as_str()
            .unwrap()
            .contains("scene.toml:1:"),
        "{broken}"
    );
}

/// A project that counts frames in Buffer A.
fn counter(folder: &Path) {
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    write(
        "buffer-a.glsl",
        "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0) + 1.0 / 255.0; }\n",
    );
    write(
        "image.glsl",
        "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0); }\n",
    );
}

#[test]
fn the_passes_of_a_project_are_played() {
    let folder = tempfile::tempdir().unwrap();
    counter(folder.path());
    let watch = start(folder.path(), &["."]);
    let tab = watch.open_tab();
    let version = tab.next("version");
    assert_eq!(version["passes"], json!(["buffer-a", "image"]));
    assert_eq!(
        (&version["hasHistory"], &version["frame"]["frame"]),
        (&json!(true), &json!(7))
    );
    let mut view = tab.view(SIZE);
    // Forth, on, back, and far forth: each frame has the count of its own.
    for frame in [3, 4, 4, 2, 200] {
        view["frame"] = json!(frame);
        let count = frame as u8 + 1;
        for pass in ["image", "buffer-a"] {
            view["pass"] = json!(pass);
            assert_eq!(color(&watch, &view), [count; 3], "{pass} in frame {frame}");
        }
    }
    view["frame"] = json!(1000);
    let late = watch.image("frame", &view).unwrap();
    assert_eq!(late.head["firstFrame"], 700, "older frames are not rendered");
    assert_eq!(corner(&late), [255; 3]);
    view["pass"] = json!("buffer-b");
    assert_eq!(watch.post("frame", &view).status, 422);
    fs::write(folder.path().join("common.glsl"), "#define STEP 2.0\n").unwrap();
    assert_eq!(tab.next("version")["compiles"], true, "a new tab is followed");
}

#[test]
fn uniforms_the_mouse_and_keys_are_those_of_the_tab() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("a.glsl"),
        "uniform float level;\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(level, iMouse.x / 8.0, 0.0, 1.0); }\n",
    )
    .unwrap();
    let watch = start(folder.path(), &["a.glsl", "--uniform", "level=1"]);
    let tab = watch.open_tab();
    let version = tab.next("version");
    assert_eq!(
        version["uniforms"],
        json!([{"name": "level", "kind": "float", "components": [1.0]}])
    );
    let mut view = tab.view(SIZE);
    assert_eq!(color(&watch, &view), [255, 0, 0]);
    view["mouse"] = json!([8, 0, 0, 0]);
    view["uniforms"] = json!([{"name": "level", "components": [0.2]}]);
    assert_eq!(color(&watch, &view), [51, 255, 0]);
}

#[test]
fn the_values_in_a_pixel_are_those_of_debug() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("a.glsl"),
        "void mainImage(out vec4 c, in vec2 p) {\n    float t = p.x * 2.0;\n    c = vec4(t / 16.0);\n}\n",
    )
    .unwrap();
    let watch = start(folder.path(), &["a.glsl"]);
    let tab = watch.open_tab();
    tab.next("version");
    let pixel = |pixel: [u32; 2]| watch.post("pixel", &json!({"view": tab.view(SIZE), "pixel": pixel}));
    let answer: Value = serde_json::from_slice(&pixel([3, 1]).body).unwrap();
    let text = answer["text"].as_str().unwrap();
    assert!(
        text.contains("pixel (3, 1) of 8×4") && text.contains("float t"),
        "{text}"
    );
    let debug = crate::program::toyproof(
        folder.path(),
        &["debug", "a.glsl", "--size", "8x4", "--pixel", "3,1"],
    );
    assert_eq!(text.trim_end(), debug.stdout.trim_end());
    assert_eq!(pixel([8, 0]).status, 422);
    let job: Value = serde_json::from_slice(&watch.post("browser", &tab.view(SIZE)).body).unwrap();
    assert!(
        job["job"]["passes"][0]["text"]
            .as_str()
            .unwrap()
            .contains("float t = p.x * 2.0"),
        "{job}"
    );
}

#[test]
fn a_students_page_shows_what_the_assignment_permits() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("scene.toml", SPHERE.scene);
    write(
        "assignment.toml",
        "scene = \"scene.toml\"\n\n[[frame]]\nsize = [64, 36]\n",
    );
    write("a.glsl", &SPHERE.shader.replace("b * b - c", "b * b - 0.9 * c"));
    let article = |arguments: &[&str]| {
        let watch = start(folder.path(), arguments);
        let check = watch.open_tab().next("check");
        check["article"]["html"].as_str().unwrap().to_owned()
    };
    let edit = "replace <code>0.9</code>";
    let student = article(&["a.glsl", "--assignment", "assignment.toml"]);
    assert!(
        student.contains("class=\"verdict wrong\"") && !student.contains(edit),
        "{student}"
    );
    let teacher = article(&["a.glsl", "--assignment", "assignment.toml", "--hints", "fix"]);
    assert!(teacher.contains(edit), "{teacher}");
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_the_program_and_its_check() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("a.glsl"),
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(0.0); for (;;) c.x += p.x; }\n",
    )
    .unwrap();
    let temporary = folder.path().join("temporary");
    fs::create_dir(&temporary).unwrap();
    let watch = Watch::start_with(
        Path::new(env!("CARGO_BIN_EXE_toyproof")),
        folder.path(),
        &["a.glsl", "--timeout", NO_LIMIT],
        &[("TMPDIR", &temporary)],
    );
    let is_checking = || fs::read_dir(&temporary).unwrap().next().is_some();
    wait_until(is_checking);
    watch.interrupt();
    let (status, rest) = watch.wait();
    assert_eq!(
        (status.code(), rest.as_str()),
        (Some(0), ""),
        "only the address is printed"
    );
    assert!(!is_checking(), "the files of the check are removed");
}

#[test]
fn what_cannot_be_followed_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, message) in [
        (&["watch", "-"][..], "standard input cannot be followed"),
        (&["watch", "missing.glsl"], "missing.glsl"),
    ] {
        let run = crate::program::toyproof(folder.path(), arguments);
        assert_eq!((run.code, run.stdout.as_str()), (2, ""), "{}", run.stderr);
        assert!(run.stderr.contains(message), "{}", run.stderr);
    }
}
