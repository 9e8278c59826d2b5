//! Near-identical shaders: `similar`.

use std::fs;

use crate::program::toyproof;
use crate::support::MANY_OBJECTS;

/// A copy with other names and numbers is found; what does not compile is reported.
#[test]
fn copies_are_found_whatever_their_names_and_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let hw = folder.path().join("hw");
    fs::create_dir(&hw).unwrap();
    let original = MANY_OBJECTS.shader;
    let copy = original
        .replace("sphere", "ball")
        .replace("0.5", "0.25")
        .replace("    ", "\t");
    let mandelbrot = "void mainImage(out vec4 c, in vec2 p) {
        vec2 z = vec2(0), k = 3.0 * p / iResolution.xy - 2.0;
        int n = 0;
        for (; n < 50 && dot(z, z) < 4.0; n++) z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + k;
        float level = float(n) / 50.0;
        c = vec4(level, level * level, sqrt(level), 1.0) * smoothstep(0.0, 1.0, length(z) - 0.5 * cos(iTime));
    }";
    for (name, text) in [
        ("a", original.to_owned()),
        ("b", copy),
        ("c", mandelbrot.to_owned()),
        ("d", "void main() {".to_owned()),
        (
            "e",
            "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }".to_owned(),
        ),
    ] {
        fs::write(hw.join(name).with_extension("glsl"), text).unwrap();
    }
    let run = toyproof(folder.path(), &["similar", "hw"]);
    let lines: Vec<_> = run.stdout.lines().collect();
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        lines[0].starts_with("100 %  hw/a.glsl:") && lines[1].starts_with("       hw/b.glsl:"),
        "{}",
        run.stdout
    );
    assert_eq!(lines.len(), 2, "{}", run.stdout);
    for message in [
        "warning: hw/d.glsl is not compared: it does not compile\n",
        "\n1 pair of 3 shaders shares at least 60 % of the smaller one\n",
        "1 shader has too little of its own to compare\n",
    ] {
        assert!(run.stderr.contains(message), "{}", run.stderr);
    }
    fs::write(folder.path().join("template.glsl"), original).unwrap();
    let except = toyproof(folder.path(), &["similar", "hw", "--except", "template.glsl"]);
    assert_eq!(except.stdout, "");
}
