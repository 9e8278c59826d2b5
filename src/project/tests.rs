//! Reading and writing projects in all forms.

use toyproof_diagnostic::{File, FileId, Files};

use super::*;

const IMAGE: &str =
    "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0); }\r\n// \u{e9}\t\"\\";
const BUFFER: &str = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }";

/// The same project in the variants of the API, of a page, and of the editor.
pub(crate) fn variants() -> [String; 3] {
    let [image, buffer] = [IMAGE, BUFFER].map(|code| serde_json::to_string(code).unwrap());
    let sampler = r#"{"filter":"linear","wrap":"clamp","vflip":"true","srgb":"false","internal":"byte"}"#;
    let api = format!(
        r#"{{"Shader":{{"ver":"0.1","info":{{"id":"a","date":"1","likes":3,"tags":["x","y"],"note":null}},"renderpass":[
        {{"inputs":[{{"id":257,"src":"/media/previz/buffer00.png","ctype":"buffer","channel":0,"sampler":{sampler},"published":1}}],
        "outputs":[{{"id":37,"channel":0}}],"code":{image},"name":"Image","description":"","type":"image"}},
        {{"inputs":[],"outputs":[{{"id":257,"channel":0}}],"code":{buffer},"name":"Buf A","description":"","type":"buffer"}}]}}}}"#
    );
    let page = format!(
        r#"[{{"ver":"0.1","info":{{"id":"a"}},"renderpass":[{{"inputs":[{{"id":"4dXGR8","filepath":"/media/previz/buffer00.png",
        "previewfilepath":"/media/previz/buffer00.png","type":"buffer","channel":0,"sampler":{sampler},"published":1}}],
        "outputs":[],"code":{image},"name":"","description":"d","type":"image"}},{{"inputs":[],
        "outputs":[{{"id":"4dXGR8","channel":0}}],"code":{buffer},"name":"Buffer A","description":"","type":"buffer"}}]}}]"#
    );
    let editor = format!(
        r#"{{"ver":"0.1","renderpass":[{{"outputs":[{{"channel":0,"id":"4dfGRr"}}],"inputs":[{{"channel":0,"type":"buffer",
        "id":"4dXGR8","filepath":"/media/previz/buffer00.png","sampler":{sampler}}},{{"channel":2,"type":"musicstream","id":"x",
        "filepath":"https://example.com","sampler":{sampler}}}],"code":{image},"name":"Image","description":"","type":"image"}},
        {{"outputs":[{{"channel":0,"id":"4dXGR8"}}],"inputs":[],"code":{buffer},"name":"Buffer A","description":"","type":"buffer"}}],
        "flags":{{"mFlagVR":false}},"info":{{"id":"-1","description":"a\nb"}}}}"#
    );
    [api, page, editor]
}

fn from_json(files: &mut Files, text: &str) -> Result<Project, String> {
    let file = files.add(File::new("x.json", text));
    Project::from_json(files, file).map_err(|errors| errors.to_string())
}

/// The project that is read from the files that it is written as.
fn through_folder(project: &Project, files: &mut Files) -> Project {
    let toml = files.add(File::new(PROJECT_FILE, project.to_toml()));
    let tabs: Vec<_> = project.tabs().iter().rev().copied().collect();
    match Project::from_folder(files, Some(toml), &tabs) {
        Ok(project) => project,
        Err(errors) => panic!("{errors}\n{}", project.to_toml()),
    }
}

#[test]
fn every_variant_survives_the_way_through_a_folder() {
    for text in variants() {
        let mut files = Files::default();
        let project = from_json(&mut files, &text).unwrap();
        assert_eq!(
            project.image().inputs[0].as_ref().unwrap().source,
            Source::Buffer(Buffer::A)
        );
        assert_eq!(files.get(project.image().file).text(), IMAGE);
        assert_eq!(files.get(project.image().file).name(), "x.json/image.glsl");
        let again = through_folder(&project, &mut files);
        assert_eq!(again.passes.len(), 2);
        let json = again.to_json(&files);
        assert_eq!(json, project.to_json(&files), "the order of keys is kept as well");
        let [before, after] =
            [&text, &json].map(|text| serde_json::from_str::<serde_json::Value>(text).unwrap());
        assert_eq!(before, after);
        assert!(project.to_toml().contains(if text.contains("257") {
            "src = "
        } else {
            "source = \"buffer-a\""
        }));
    }
}

#[test]
fn order_samplers_and_media_are_read() {
    let mut files = Files::default();
    let sampler =
        r#""sampler":{"filter":"mipmap","wrap":"repeat","vflip":false,"srgb":"false","internal":"byte"}"#;
    let text = format!(
        r#"{{"renderpass":[{{"type":"buffer","outputs":[{{"id":"XsXGR8"}}],"code":""}},{{"type":"common","code":"// c"}},
        {{"type":"buffer","outputs":[{{"id":"257"}}],"code":""}},{{"type":"cubemap","code":""}},{{"type":"sound","code":""}},
        {{"type":"image","code":"","inputs":[{{"channel":3,"type":"texture","id":"Xsf3zn",{sampler}}},
        {{"channel":1,"type":"cubemap","id":"4dX3Rr"}},{{"channel":0,"ctype":"keyboard","id":33}}]}}]}}"#
    );
    let project = from_json(&mut files, &text).unwrap();
    let kinds: Vec<_> = project.passes.iter().map(|pass| pass.kind.to_string()).collect();
    assert_eq!(kinds, ["Buffer B", "Buffer A", "Cube A", "Sound", "Image"]);
    assert_eq!(files.get(project.common.unwrap()).text(), "// c");
    let [keyboard, cube, none, noise] = &project.image().inputs;
    assert_eq!(keyboard.as_ref().unwrap().source, Source::Keyboard);
    assert_eq!(cube.as_ref().unwrap().source, Source::CubeA);
    assert_eq!(cube.as_ref().unwrap().sampler.wrap, Wrap::Clamp);
    assert!(none.is_none());
    let noise = noise.as_ref().unwrap();
    assert_eq!(noise.source.medium().unwrap().name, "RGBA Noise Medium");
    assert_eq!(
        (noise.sampler.filter, noise.sampler.wrap),
        (Filter::Mipmap, Wrap::Repeat)
    );
    assert!(!noise.sampler.vflip);
}

#[test]
fn errors_of_json_have_a_line_and_a_column() {
    for (text, expected) in [
        (
            "[]",
            "1:1: error[E0508]: a project must be an object, found a list",
        ),
        (
            r#"{"Error": "Shader not found"}"#,
            "1:11: error[E0508]: ShaderToy's API answered with an error instead of a shader: Shader not found",
        ),
        (
            r#"{"ver": "0.1"}"#,
            "1:1: error[E0508]: missing key `renderpass`, the list of the passes",
        ),
        (
            r#"{"renderpass": {}}"#,
            "1:16: error[E0508]: the passes must be a list, found an object",
        ),
        (
            r#"{"renderpass": []}"#,
            "1:16: error[E0508]: there is no pass of the type `image`",
        ),
        (
            "{\"ver\": \"0.2\",\n\"renderpass\": [{\"type\": \"image\", \"code\": \"\"}]}",
            "1:9: error[E0508]: unknown version of ShaderToy's JSON",
        ),
        (
            r#"{"renderpass": [1]}"#,
            "1:17: error[E0508]: a pass must be an object, found a number",
        ),
        (
            r#"{"renderpass": [{"code": ""}]}"#,
            "1:17: error[E0508]: missing key `type` in a pass",
        ),
        (
            r#"{"renderpass": [{"type": "imag", "code": ""}]}"#,
            "1:26: error[E0508]: unknown type `imag` of a pass",
        ),
        (
            r#"{"renderpass": [{"type": 1, "code": ""}]}"#,
            "1:26: error[E0508]: `type` must be a string, found a number",
        ),
        (
            "{\"renderpass\": [\n {\"type\": \"image\"}]}",
            "2:2: error[E0508]: missing key `code` in a pass",
        ),
        (
            r#"{"renderpass": [{"type": "image", "code": []}]}"#,
            "1:43: error[E0508]: `code` must be a string, found a list",
        ),
        (
            r#"{"renderpass": [{"type": "image", "code": ""}, {"type": "image", "code": ""}]}"#,
            "1:48: error[E0508]: there are two passes for Image",
        ),
        (
            r#"{"renderpass": [{"type": "buffer", "code": ""}]}"#,
            "1:17: error[E0508]: missing key `outputs` of a buffer",
        ),
        (
            r#"{"renderpass": [{"type": "buffer", "code": "", "outputs": [{"id": "x"}]}]}"#,
            "1:67: error[E0508]: this is not the id of a buffer",
        ),
        (
            r#"{"renderpass": [{"type": "buffer", "code": "", "outputs": []}]}"#,
            "1:59: error[E0508]: `outputs` of a buffer must be a list with an object that has an `id`",
        ),
        (
            r#"{"renderpass": [{"type": "image", "code": "", "inputs": 1}]}"#,
            "1:57: error[E0508]: `inputs` must be a list, found a number",
        ),
    ] {
        let error = from_json(&mut Files::default(), text).unwrap_err();
        assert_eq!(error, format!("x.json:{expected}"), "{text}");
    }
}

#[test]
fn errors_of_inputs_name_the_key() {
    for (input, expected) in [
        ("1", "an input must be an object, found a number"),
        (
            r#"{"type": "buffer", "id": "4dXGR8"}"#,
            "missing key `channel` in an input",
        ),
        (
            r#"{"channel": 4, "type": "buffer", "id": "4dXGR8"}"#,
            "`channel` must be 0, 1, 2 or 3",
        ),
        (
            r#"{"channel": "0", "type": "buffer", "id": "4dXGR8"}"#,
            "`channel` must be 0, 1, 2 or 3",
        ),
        (
            r#"{"channel": 0, "id": "4dXGR8"}"#,
            "missing key `type` in an input",
        ),
        (
            r#"{"channel": 0, "ctype": "bufer", "id": "4dXGR8"}"#,
            "unknown type `bufer` of an input",
        ),
        (
            r#"{"channel": 0, "type": "buffer"}"#,
            "missing key `id` in an input",
        ),
        (
            r#"{"channel": 0, "type": "buffer", "id": []}"#,
            "`id` must be a string or a number, found a list",
        ),
        (
            r#"{"channel": 0, "type": "buffer", "id": 7}"#,
            "this is not the id of a buffer",
        ),
        (
            r#"{"channel": 0, "type": "mic", "id": 7, "sampler": 1}"#,
            "`sampler` must be an object, found a number",
        ),
        (
            r#"{"channel": 0, "type": "mic", "id": 7, "sampler": {"filter": "best"}}"#,
            "unknown `filter` of a sampler",
        ),
        (
            r#"{"channel": 0, "type": "mic", "id": 7, "sampler": {"vflip": "yes"}}"#,
            "`vflip` must be \"true\" or \"false\"",
        ),
        (
            r#"{"channel": 0, "type": "mic", "id": 7}, {"channel": 0, "type": "mic", "id": 7}"#,
            "iChannel0 has two inputs",
        ),
    ] {
        let text = format!(r#"{{"renderpass": [{{"type": "image", "code": "", "inputs": [{input}]}}]}}"#);
        let error = from_json(&mut Files::default(), &text).unwrap_err();
        assert!(error.contains(&format!("E0508]: {expected}")), "{text}: {error}");
    }
}

#[test]
fn a_tab_has_a_limit() {
    let text = format!(
        r#"{{"renderpass": [{{"type": "image", "code": "{}"}}]}}"#,
        "x".repeat(MAX_TAB_BYTES + 1)
    );
    let error = from_json(&mut Files::default(), &text).unwrap_err();
    assert!(
        error.contains("1:43: error[E0508]: the code of this tab is larger than 1 MiB"),
        "{error}"
    );
}

/// The files of a folder with these tabs.
fn folder(files: &mut Files, names: &[&str]) -> Vec<(Tab, FileId)> {
    let tab = |name: &&str| Tab::ALL.into_iter().find(|tab| tab.name() == *name).unwrap();
    names
        .iter()
        .map(|name| (tab(name), files.add(File::new(name, *name))))
        .collect()
}

#[test]
fn a_folder_without_a_project_file_reads_buffers_by_index() {
    let mut files = Files::default();
    let tabs = folder(&mut files, &["image", "buffer-a", "buffer-c", "common", "sound"]);
    let project = Project::from_folder(&files, None, &tabs).unwrap();
    assert!(!project.knows_inputs);
    let kinds: Vec<_> = project.passes.iter().map(|pass| pass.kind.to_string()).collect();
    assert_eq!(kinds, ["Buffer A", "Buffer C", "Image", "Sound"]);
    let sources = |kind| {
        let pass = project.pass(kind).unwrap();
        pass.inputs
            .each_ref()
            .map(|input| input.as_ref().map(|input| input.source.clone()))
    };
    let buffers = [
        Some(Source::Buffer(Buffer::A)),
        None,
        Some(Source::Buffer(Buffer::C)),
        None,
    ];
    assert_eq!(sources(PassKind::Image), buffers);
    assert_eq!(sources(PassKind::Buffer(Buffer::C)), buffers);
    assert_eq!(sources(PassKind::Sound), [const { None }; 4]);
    // The exported JSON is complete, and is read as the same project.
    let json = project.to_json(&files);
    let again = from_json(&mut files, &json).unwrap();
    assert_eq!(again.to_json(&files), json);
    assert!(
        json.contains("\"previewfilepath\": \"/media/previz/buffer02.png\""),
        "{json}"
    );
}

#[test]
fn a_project_file_may_be_short() {
    let mut files = Files::default();
    let tabs = folder(&mut files, &["image", "buffer-b", "buffer-a"]);
    let text = "[info]\nname = \"Waves\"\n\n[[pass]]\ntab = \"buffer-b\"\n\n[[pass]]\ntab = \"buffer-a\"\n\n[[pass]]\ntab = \"image\"\n\
        inputs = [{ channel = 1, source = \"Buffer-B\", sampler = { filter = \"nearest\" } }, { channel = 0, source = \"rgba noise small\" }]\n";
    let toml = files.add(File::new(PROJECT_FILE, text));
    let project = Project::from_folder(&files, Some(toml), &tabs).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(project.name(), Some("Waves"));
    assert_eq!(project.passes[0].kind, PassKind::Buffer(Buffer::B));
    let [noise, buffer, ..] = &project.image().inputs;
    assert_eq!(noise.as_ref().unwrap().source.medium().unwrap().id, "XdXGzn");
    assert_eq!(buffer.as_ref().unwrap().sampler.filter, Filter::Nearest);
    assert_eq!(buffer.as_ref().unwrap().sampler.wrap, Wrap::Clamp);
    let json = project.to_json(&files);
    let again = from_json(&mut files, &json).unwrap();
    assert_eq!(again.to_json(&files), json);
}

#[test]
fn errors_of_a_project_file_have_a_line_and_a_column() {
    for (text, expected) in [
        (
            "[[pass]\n",
            "1:8: error[E0507]: missing `]]` at the end of a table header",
        ),
        ("[[pass]]\n", "1:1: error[E0508]: missing key `tab` in [[pass]]"),
        (
            "[[pass]]\ntab = \"buffer-e\"\n",
            "2:7: error[E0508]: `tab` must be the name of a tab",
        ),
        (
            "[[pass]]\ntab = \"sound\"\n",
            "2:7: error[E0508]: there is no file sound.glsl in the folder of the project",
        ),
        (
            "[[pass]]\ntab = \"image\"\ninput = []\n",
            "3:9: error[E0508]: unknown key `input`",
        ),
        (
            "[[pass]]\ntab = \"image\"\ntype = \"buffer\"\noutputs = [{ id = 258 }]\n",
            "2:7: error[E0508]: `tab` names Image, but `type` and `outputs` are those of Buffer B",
        ),
        (
            "[[pass]]\ntab = \"image\"\ninputs = [{ channel = 0, source = \"buffer-x\" }]\n",
            "3:35: error[E0508]: unknown source `buffer-x`",
        ),
        (
            "[[pass]]\ntab = \"image\"\ninputs = [{ channel = 0x9, source = \"buffer-a\" }]\n",
            "3:23: error[E0508]: `channel` must be 0, 1, 2 or 3",
        ),
        ("format = \"pages\"\n", "1:10: error[E0508]: unknown `format`"),
        ("titel = 1\n", "1:9: error[E0508]: unknown key `titel`"),
        (
            "[info]\ndate = 2020-01-01\n",
            "2:8: error[E0508]: a value that JSON does not have",
        ),
        (
            "[info]\nx = inf\n",
            "2:5: error[E0508]: a value that JSON does not have",
        ),
        (
            "[info]\nx = { json = \"{\" }\n",
            "2:5: error[E0508]: `json` must be JSON: expected a key in double quotes",
        ),
        (
            "pass = 1\n",
            "1:8: error[E0508]: the passes must be a list, found a number",
        ),
    ] {
        let mut files = Files::default();
        let tabs = folder(&mut files, &["image"]);
        let toml = files.add(File::new(PROJECT_FILE, text));
        let errors = Project::from_folder(&files, Some(toml), &tabs)
            .unwrap_err()
            .to_string();
        let first = errors.lines().next().unwrap();
        assert_eq!(first, format!("project.toml:{expected}"), "{text}");
    }
    let errors = |text: &str| {
        let mut files = Files::default();
        let tabs = folder(&mut files, &["image", "buffer-a"]);
        let toml = files.add(File::new(PROJECT_FILE, text));
        Project::from_folder(&files, Some(toml), &tabs).unwrap_err()
    };
    assert_eq!(
        errors("[[pass]]\ntab = \"image\"\n").to_string(),
        "error[E0508]: buffer-a.glsl is not listed in project.toml"
    );
    let of_table = errors("[buffer-a]\niChannel0 = \"buffer-a\"\n");
    assert_eq!(
        of_table[0].helps,
        ["a tab has the table `[[pass]]` with `tab = \"buffer-a\"` and its `inputs`"]
    );
}

/// The project with these tabs, and its diagnostics, each on a line.
fn checked(tabs: &[(&str, &str)]) -> (Project, Files, Result<CheckedProject, String>) {
    let mut files = Files::default();
    let tab = |name: &str| Tab::ALL.into_iter().find(|tab| tab.name() == name).unwrap();
    let tabs: Vec<_> = tabs
        .iter()
        .map(|(name, text)| (tab(name), files.add(File::new(tab(name).file_name(), *text))))
        .collect();
    let project = Project::from_folder(&files, None, &tabs).unwrap();
    let checked = check(&project, &mut files, &Default::default());
    (project, files, checked.map_err(|errors| errors.to_string()))
}

const PLAIN: &str = "void mainImage(out vec4 c, in vec2 p) { c = vec4(0); }";

#[test]
fn common_precedes_every_tab_and_errors_are_in_the_tab_s_own_lines() {
    let common = "#define T iTime\nfloat f(float x) { return x * iSampleRate; }";
    let image = "\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(f(T)); }";
    let sound = "vec2 mainSound(int samp, float time) { return vec2(f(time)); }";
    let cube = "void mainCubemap(out vec4 c, in vec2 p, in vec3 o, in vec3 d) { c = vec4(d, f(1.0)); }";
    let tabs = [
        ("common", common),
        ("image", image),
        ("sound", sound),
        ("cube-a", cube),
        ("buffer-b", PLAIN),
    ];
    let (_, _, result) = checked(&tabs);
    let kinds: Vec<_> = result
        .unwrap()
        .passes
        .iter()
        .map(|pass| pass.kind.to_string())
        .collect();
    assert_eq!(kinds, ["Buffer B", "Cube A", "Image", "Sound"]);
    for (tabs, expected) in [
        (
            vec![
                ("common", "float a;\nfloat b = x;"),
                ("image", "\n\nvoid mainImage(out vec4 c, in vec2 p) { c = y; }"),
                ("buffer-a", PLAIN),
            ],
            "common.glsl:2:11: error[E0200]: `x` is not declared\nimage.glsl:3:45: error[E0200]: `y` is not declared",
        ),
        (
            vec![("common", "float g() { return iTime; }"), ("image", PLAIN)],
            "common.glsl:1:20: error[E0412]: `iTime` is not an input of Common",
        ),
        (
            vec![
                ("common", "float g() { return texture(iChannel0, vec2(0)).x; }"),
                ("image", PLAIN),
            ],
            "common.glsl:1:28: error[E0412]: `iChannel0` is not an input of Common",
        ),
        (
            vec![("common", "/* c"), ("image", PLAIN)],
            "common.glsl:1:1: error[E0002]: unterminated comment",
        ),
        (
            vec![
                ("sound", "vec2 mainSound(int s, float t) { return iMouse.xy; }"),
                ("image", PLAIN),
            ],
            "sound.glsl:1:41: error[E0412]: `iMouse` is not an input of Sound",
        ),
        (
            vec![
                ("sound", "vec2 mainSound(vec2 s) { return s; }"),
                ("image", PLAIN),
            ],
            "sound.glsl:1:6: error[E0409]: `mainSound` has the wrong signature",
        ),
        (
            vec![("cube-a", PLAIN), ("image", PLAIN)],
            "cube-a.glsl:1:54: error[E0409]: missing function `mainCubemap`",
        ),
    ] {
        assert_eq!(checked(&tabs).2.unwrap_err(), expected, "{tabs:?}");
    }
}

#[test]
fn older_sound_has_no_number_of_the_sample() {
    let (_, _, result) = checked(&[
        ("image", PLAIN),
        ("sound", "vec2 mainSound(float t) { return vec2(sin(t)); }"),
    ]);
    assert!(result.is_ok(), "{result:?}");
    let both = "vec2 mainSound(float t) { return vec2(sin(t)); } vec2 mainSound(in int s, float t) { return mainSound(t); }";
    let checked = checked(&[("image", PLAIN), ("sound", both)]).2.unwrap();
    let sound = &checked.passes[1].checked;
    assert_eq!(sound.tree[sound.main_image].parameters.len(), 2);
}

#[test]
fn warnings_about_common_are_reported_once_and_allowed_by_each_pass() {
    let common = "float g(float x) { x + 1.0; return x; } // toyproof: allow(W0010)\nfloat h(float x) { x + 1.0; return x; }";
    let [calls_g, calls_h, calls_both] = ["g(1.0)", "h(1.0)", "g(1.0) + h(1.0)"]
        .map(|call| format!("void mainImage(out vec4 c, in vec2 p) {{ c = vec4({call}); }}"));
    let tabs = [
        ("common", common),
        ("buffer-a", calls_g.as_str()),
        ("buffer-b", &calls_h),
        ("image", &calls_both),
    ];
    let (_, files, result) = checked(&tabs);
    let warnings = result.unwrap().warnings;
    let lines: Vec<_> = warnings
        .iter()
        .map(|warning| toyproof_diagnostic::short(warning, &files))
        .collect();
    assert_eq!(
        lines,
        ["common.glsl:2:20: warning[W0010]: this expression has no effect: its value is unused"]
    );
    let (_, files, result) = checked(&[("common", common), ("image", &calls_h)]);
    let warnings = result.unwrap().warnings;
    let unused = toyproof_diagnostic::short(&warnings[0], &files);
    assert_eq!(unused, "common.glsl:1:60: warning[W0015]: unused `allow(W0010)`");
}

#[test]
fn the_image_tab_has_assertions() {
    let image = "void mainImage(out vec4 c, in vec2 p) { st_assert(p.x > 1.0); st_assert(p.y > 1.0, 2); c = vec4(1); }";
    let (_, _, result) = checked(&[("image", image)]);
    let checked = result.unwrap();
    let tree = &checked.passes[0].checked.tree;
    assert_eq!(tree[checked.passes[0].checked.main_image].name, "mainImage");
    let (_, _, result) = checked_in_buffer(image);
    assert!(result.unwrap_err().contains("unknown function `st_assert`"));
}

#[test]
fn the_image_tab_has_structures_of_channels() {
    let image =
        |expression: &str| format!("void mainImage(out vec4 c, in vec2 p) {{ c = vec4({expression}); }}");
    let errors = |expression: &str| checked(&[("image", &image(expression))]).2.unwrap_err();
    assert!(errors("iCh2.sizes").contains("`iCh2` has no member `sizes`; did you mean `size`?"));
    assert!(errors("iCh2").contains("only members can be used"));
    assert!(errors("iCh4.size").contains("`iCh4` is not declared"));
    let (_, _, result) = checked_in_buffer(&image("iCh0.time"));
    assert!(result.unwrap_err().contains("`iCh0` is not declared"));
    // An author's variable of this name is his own.
    let (_, _, result) = checked(&[("image", &format!("vec4 iCh0 = vec4(1); {}", image("iCh0.zzzz")))]);
    assert!(result.is_ok());
}

fn checked_in_buffer(buffer: &str) -> (Project, Files, Result<CheckedProject, String>) {
    checked(&[("image", PLAIN), ("buffer-a", buffer)])
}

#[test]
fn the_image_needs_what_it_reads_through_buffers() {
    let (project, ..) = checked(&[("image", PLAIN), ("sound", PLAIN), ("cube-a", PLAIN)]);
    assert_eq!(project.needed_by_image(), []);
    let (project, ..) = checked(&[("image", PLAIN), ("buffer-a", PLAIN), ("buffer-c", PLAIN)]);
    assert_eq!(
        project.needed_by_image(),
        [Buffer::A, Buffer::C].map(PassKind::Buffer)
    );
}

/// The codes of the warnings about a project file; every tab names `iChannel0` and `iChannel1`.
fn warnings(toml: &str) -> Vec<String> {
    let mut files = Files::default();
    let code = "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p) + texture(iChannel1, p); }";
    let named = |tab: &Tab| toml.contains(&format!("\"{}\"\n", tab.name()));
    let tabs: Vec<_> = Tab::ALL
        .into_iter()
        .filter(named)
        .map(|tab| (tab, files.add(File::new(tab.file_name(), code))))
        .collect();
    let toml = files.add(File::new(PROJECT_FILE, toml));
    let project = Project::from_folder(&files, Some(toml), &tabs).unwrap_or_else(|errors| panic!("{errors}"));
    let checked = check(&project, &mut files, &Default::default()).unwrap();
    let short = |warning| toyproof_diagnostic::short(warning, &files);
    checked.warnings.iter().map(short).collect()
}

#[test]
fn inputs_are_linted_where_they_are_used() {
    let pass = |tab: &str, inputs: &str| format!("[[pass]]\ntab = \"{tab}\"\ninputs = [{inputs}]\n");
    let reads = |channel: u32, source: &str, sampler: &str| {
        format!("{{ channel = {channel}, source = \"{source}\", sampler = {{ {sampler} }} }}, ")
    };
    let [nearest, linear, repeat] = ["filter = \"nearest\"", "filter = \"linear\"", "wrap = \"repeat\""];
    let none: [&str; 0] = [];
    let a = |channel, sampler| reads(channel, "buffer-a", sampler);
    let project = |passes: &[String]| warnings(&passes.concat());
    // A missing pass, and one in a channel that no code names.
    assert_eq!(
        project(&[pass("image", &(a(1, "") + &reads(2, "buffer-b", "")))]),
        ["project.toml:3:11: warning[W0018]: iChannel1 of Image reads Buffer A, which does not exist"]
    );
    let buffer = pass("buffer-a", "");
    assert_eq!(
        project(&[buffer.clone(), pass("image", &(a(0, nearest) + &a(1, linear)))]),
        [
            "project.toml:6:11: warning[W0019]: iChannel0 and iChannel1 of Image read Buffer A with different filters"
        ]
    );
    // Passes set the filter one after the other, but the wrap mode only once.
    let own = pass("buffer-a", &a(0, nearest));
    assert_eq!(project(&[own.clone(), pass("image", &a(0, linear))]), none);
    assert_eq!(
        project(&[own.clone(), pass("image", &a(0, repeat))]),
        ["project.toml:3:11: warning[W0019]: Buffer A and Image read Buffer A with different wrap modes"]
    );
    assert_eq!(
        project(&[own, pass("image", &(a(0, "") + &reads(2, "buffer-a", repeat)))]),
        none
    );
    let [reads_a, reads_b] = ["buffer-a", "buffer-b"].map(|source| reads(0, source, ""));
    assert_eq!(
        project(&[pass("buffer-b", &reads_a), buffer.clone(), pass("image", "")]),
        [
            "project.toml:3:11: warning[W0020]: Buffer B reads the previous frame of Buffer A, which runs after it in this project"
        ]
    );
    assert_eq!(
        project(&[
            pass("buffer-b", ""),
            pass("buffer-a", &reads_b),
            pass("image", "")
        ]),
        [
            "project.toml:6:11: warning[W0020]: Buffer A reads the same frame of Buffer B, which runs before it in this project"
        ]
    );
    assert_eq!(
        project(&[buffer, pass("buffer-b", &reads_a), pass("image", &reads_b)]),
        none
    );
    assert_eq!(
        project(&[
            pass("buffer-b", &reads_b),
            pass("buffer-a", ""),
            pass("image", "")
        ]),
        none
    );
}

#[test]
fn a_subset_has_the_texts_and_inputs_that_are_kept() {
    let mut files = Files::default();
    let toml = files.add(File::new(
        PROJECT_FILE,
        "[[pass]]\ntab = \"common\"\n[[pass]]\ntab = \"buffer-a\"\n[[pass]]\ntab = \"buffer-b\"\n\
         [[pass]]\ntab = \"image\"\ninputs = [{ channel = 0, source = \"buffer-a\" }, \
         { channel = 1, source = \"buffer-b\" }, { channel = 2, source = \"keyboard\" }]\n\
         [uniforms]\nspeed = 2.0\ntint = [1.0, 0.5]\n",
    ));
    let tabs = Tab::ALL.into_iter().filter(|tab| {
        let name = tab.name();
        ["common", "buffer-a", "buffer-b", "image"].contains(&name)
    });
    let tabs: Vec<_> = tabs
        .map(|tab| (tab, files.add(File::new(tab.file_name(), ""))))
        .collect();
    let project = Project::from_folder(&files, Some(toml), &tabs).unwrap();
    let [image, buffer] = ["void f() {}", "void g() {}"].map(|text| files.add(File::new("a.glsl", text)));
    let texts = [(PassKind::Image, image), (PassKind::Buffer(Buffer::B), buffer)];
    let subset = project.subset(&texts, |_, channel| channel != 2);
    for project in [&subset, &through_folder(&subset, &mut files)] {
        assert!(project.common.is_none());
        let kinds: Vec<_> = project.passes.iter().map(|pass| pass.kind.to_string()).collect();
        assert_eq!(kinds, ["Buffer B", "Image"]);
        assert_eq!(files.get(project.image().file).text(), "void f() {}");
        let sources = project
            .image()
            .inputs
            .each_ref()
            .map(|input| input.as_ref()?.source.pass());
        assert_eq!(sources, [None, Some(PassKind::Buffer(Buffer::B)), None, None]);
        assert!(project.image().inputs[2].is_none());
        let uniforms = project
            .uniforms
            .iter()
            .map(|uniform| (&*uniform.name, &*uniform.components));
        assert_eq!(
            uniforms.collect::<Vec<_>>(),
            [("speed", &[2.0][..]), ("tint", &[1.0, 0.5])]
        );
    }
}
