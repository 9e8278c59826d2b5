//! The language server in a real editor: Neovim with the configuration of the guide, without a terminal, runs the
//! steps of `neovim/session.lua`.

use std::path::Path;
use std::process::{Command, Stdio};
use std::{env, fs};

use serde_json::{Value, json};

use crate::docs::block;
use crate::program::toyproof;
use crate::requirements::require_program;

/// A `;` is missing after `radius * radius`, and the line of the first use of `CENTER` has a character that is two
/// units of UTF-16.
const SHADER: &str = "\
// A ball in front of a sky.
const vec3 CENTER = vec3(0.0, 0.0, -3.0);

struct Ray {
    vec3 origin;
    vec3 direction;
};

// The distance along a ray to the ball, or -1.
float intersectBall(Ray ray, float radius) {
    vec3 f = /* 🔭 */ ray.origin - CENTER;
    float b = dot(f, ray.direction);
    float h = b * b - dot(f, f) + radius*radius
    return h < 0.0 ? -1.0 : -b - sqrt(h);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 p = (2.0 * fragCoord - iResolution.xy) / iResolution.y;
    Ray ray = Ray(vec3(0.0), normalize(vec3(p, -2.0)));
    float t = intersectBall(ray, 1.0);
    vec3 color = t < 0.0 ? vec3(0.5, 0.7, 0.9) : vec3(1.0, 0.6, 0.2);
    fragColor = vec4(color, 1.0);
}
";

#[test]
fn neovim_edits_a_shader_with_the_language_server() {
    if !require_program("nvim") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let [shader, results, init] =
        ["ball.glsl", "results.json", "init.lua"].map(|name| folder.path().join(name));
    fs::write(&shader, SHADER).unwrap();
    fs::write(&init, block("docs/guide/editors.md", "vim.lsp.start_client")).unwrap();
    // The configuration names the program, which is found on the search path.
    let program = Path::new(env!("CARGO_BIN_EXE_toyproof"));
    let mut folders = vec![program.parent().unwrap().to_path_buf()];
    folders.extend(env::split_paths(&env::var_os("PATH").unwrap()));
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/suite/neovim/session.lua");
    let output = Command::new("nvim")
        .args(["--headless", "--clean", "-n", "-u"])
        .arg(&init)
        .args(["-c", &format!("luafile {script}")])
        .current_dir(folder.path())
        .env("PATH", env::join_paths(folders).unwrap())
        .env("SHADER", &shader)
        .env("RESULTS", &results)
        // The log of its client, and the pages that the server writes, go to this folder.
        .env("XDG_CACHE_HOME", folder.path().join("cache"))
        .env("XDG_STATE_HOME", folder.path().join("state"))
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let results = fs::read_to_string(&results).unwrap_or_else(|error| panic!("{error}: {output:?}"));
    let results: Value = serde_json::from_str(&results).unwrap();
    assert_eq!(results["failure"], Value::Null, "{results:#}");

    assert_eq!(results["clients"], json!(["toyproof"]));
    let error = &results["errors"][0];
    assert_eq!(results["errors"].as_array().unwrap().len(), 1, "{results:#}");
    assert_eq!(
        (&error["line"], &error["column"], &error["code"]),
        (&json!(13), &json!(48), &json!("E0100")),
    );
    let fixed = SHADER.replace("radius*radius\n", "radius*radius;\n");
    assert_eq!(results["fixed"], json!(fixed));

    let members: Vec<_> = results["members"].as_array().unwrap().iter().collect();
    for member in ["x", "y", "xy", "yx"] {
        assert!(members.contains(&&json!(member)), "{member}: {members:?}");
    }
    assert!(
        !members.contains(&&json!("z")),
        "p has two components: {members:?}"
    );
    let hover = results["hover"].as_str().unwrap();
    assert!(hover.contains("vec3 normalize(vec3"), "{hover}");
    let signature = results["signature"].as_str().unwrap();
    assert!(
        signature.contains("intersectBall(Ray ray, float radius)"),
        "{signature}"
    );
    assert_eq!(results["active_parameter"], json!(1));
    assert_eq!(results["definition"], json!({ "line": 2, "column": 12 }));

    let renamed = fixed.replace("intersectBall", "distanceToBall");
    assert_eq!(results["renamed"], json!(renamed));
    // The editor formats as the command does.
    fs::write(&shader, renamed).unwrap();
    assert_eq!(toyproof(folder.path(), &["fmt", "ball.glsl"]).code, 0);
    assert_eq!(results["formatted"], json!(fs::read_to_string(&shader).unwrap()));
    assert!(
        results["formatted"]
            .as_str()
            .unwrap()
            .contains("radius * radius;")
    );
}
