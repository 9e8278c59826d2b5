//! All features that read one document at once: none may panic on any text, and positions must be in order.

use crate::color::{color_presentations, document_colors};
use crate::completion::completion;
use crate::folding::folding_ranges;
use crate::hover::hover;
use crate::inlay_hint::inlay_hints;
use crate::outline::{document_symbols, workspace_symbols};
use crate::selection::selection_range;
use crate::semantic::semantic_tokens;
use crate::signature::signature_help;
use crate::snapshot::Snapshot;

/// Runs the features of the whole document.
pub(crate) fn read_document(snapshot: &Snapshot) {
    let end = snapshot.file().text().len() as u32;
    for symbol in document_symbols(snapshot) {
        let (range, selected) = (symbol.range, symbol.selection_range);
        assert!(
            range.start <= selected.start && selected.end <= range.end,
            "{symbol:?}"
        );
    }
    workspace_symbols([snapshot], "a");
    for range in folding_ranges(snapshot) {
        assert!(range.start_line < range.end_line, "{range:?}");
    }
    for color in document_colors(snapshot) {
        let byte = |position| snapshot.encoding.byte(snapshot.file(), position);
        color_presentations(
            snapshot,
            color.color,
            (byte(color.range.start), byte(color.range.end)),
        );
    }
    semantic_tokens(snapshot, None);
    inlay_hints(snapshot, (0, end));
}

/// Runs the features at a byte of the document.
pub(crate) fn read_at(snapshot: &Snapshot, byte: u32) {
    selection_range(snapshot, byte);
    semantic_tokens(snapshot, Some((byte, byte.saturating_add(20))));
    inlay_hints(snapshot, (byte, byte));
    let Some(at) = snapshot.analyzed_byte(byte) else {
        return;
    };
    hover(snapshot, at);
    completion(snapshot, at);
    signature_help(snapshot, at);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::testing::of;

    const SHADERS: [&str; 3] = [
        "#define PI 3.14\n#define R(a) mat2(cos(a), -sin(a), sin(a), cos(a)) // turn\r\n\
         struct Ray { vec3 o, d; float t[2]; };\n\
         #if 0\nint skipped(;\n#else\n/* 😀 */ const vec3 SKY = vec3(.2, .4, 1.);\n#endif\n\
         float map(vec3 p, inout Ray r) { p.xy *= R(PI * .5); r.t[0] = length(p); return r.t[1] - 1.; }\n\
         void mainImage(out vec4 col, in vec2 uv) {\n\
         \tRay r = Ray(vec3(0), vec3(uv, 1.), float[2](0., 1.));\n\
         \tfor (int i = 0; i < 8; i++) { if (map(r.o, r) < 0.1) break; else continue; }\n\
         \tcol = texture(iChannel0, uv / iResolution.xy) \
         + vec4(mix(SKY, r.d.zyx, smoothstep(0., 1., uv.x)), 1.);\n}\n",
        "#version 100\r\nprecision mediump float;\r\nuniform vec2 u_resolution;\r\nvarying vec2 vUv;\r\n\
         void main() { gl_FragColor = texture2D(u_tex0, vUv) * vec4(1., .5, 0., 1.); }",
        "float f(float a, float b) { switch (int(a)) { case 0: return 1.; default: discard; } return sin(a",
    ];

    #[test]
    fn texts_of_one_line_take_time_in_proportion() {
        let repeated = |text: &str, count| text.repeat(count);
        for text in [
            repeated("(", 50_000) + &repeated("}", 50_000),
            repeated("{", 50_000) + &repeated(")", 50_000),
            repeated("/**/", 20_000) + "float x;",
            repeated("const vec3 color=vec3(.5,.25,1.);", 5000),
            repeated("float f(float a,float b){return f(1.,2.)+1.;}", 2000),
        ] {
            let snapshot = of(&text);
            read_document(&snapshot);
            read_at(&snapshot, text.len() as u32 - 1);
            read_at(&snapshot, text.len() as u32 / 2);
        }
    }

    #[test]
    fn no_half_typed_text_makes_a_feature_panic() {
        for text in SHADERS {
            let boundaries: Vec<usize> = text.char_indices().map(|(at, _)| at).collect();
            for (index, &cut) in boundaries.iter().enumerate().step_by(3) {
                let snapshot = of(&text[..cut]);
                read_at(&snapshot, cut as u32);
                if index % 5 == 0 {
                    read_document(&snapshot);
                }
                // With a hole behind the cut.
                let hole = boundaries.get(index + 7).copied().unwrap_or(text.len());
                let snapshot = of(&format!("{}{}", &text[..cut], &text[hole..]));
                read_at(&snapshot, cut as u32);
            }
        }
    }

    /// The shaders above, and those of the folder that the environment variable `TOYPROOF_SHADERS` names.
    fn all_shaders() -> Vec<String> {
        let mut all = SHADERS.map(str::to_owned).to_vec();
        if let Some(folder) = std::env::var_os("TOYPROOF_SHADERS") {
            let files = std::fs::read_dir(folder).unwrap();
            let texts = files.map(|file| std::fs::read(file.unwrap().path()).unwrap());
            all.extend(texts.map(|text| String::from_utf8_lossy(&text).into_owned()));
        }
        all
    }

    #[test]
    fn every_place_of_a_text_can_be_read() {
        for text in all_shaders() {
            let snapshot = of(&text);
            read_document(&snapshot);
            let step = 1 + text.len() / 2000;
            for byte in (0..=text.len() as u32 + 1).step_by(step) {
                read_at(&snapshot, byte);
            }
        }
    }
}
