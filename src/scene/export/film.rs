//! The picture: its samples, their mean, tone map and gamma.

use std::fmt::Write;

use super::number;
use super::parts::Parts;
use crate::{Sampler, Scene, ToneMap};

impl Parts<'_> {
    pub(super) fn main(&self, scene: &Scene) -> String {
        let film = &scene.film;
        let several = film.samples > 1;
        let (indent, index) = if several { ("        ", "i") } else { ("    ", "0") };
        let start = match film.sampler {
            Sampler::Independent => format!("{indent}startSample(fragCoord, {index});\n"),
            _ => String::new(),
        };
        let sample = if film.sampler == Sampler::Center {
            format!("{indent}color += look(fragCoord);\n")
        } else {
            format!(
                "{start}{indent}float x = fragCoord.x + random() - 0.5;\n{indent}float y = fragCoord.y + random() - 0.5;\n\
                 {indent}color += look(vec2(x, y));\n"
            )
        };
        let samples = if several {
            format!(
                "    for (int i = 0; i < SAMPLES; i++) {{\n{sample}    }}\n    color /= float(SAMPLES);\n"
            )
        } else {
            sample
        };
        let scene_made = if self.models.is_empty() {
            ""
        } else {
            "    makeScene();\n"
        };
        let seed = match film.sampler {
            Sampler::SineHash => "    seed = 0.0;\n",
            _ => "",
        };
        format!(
            "void mainImage(out vec4 fragColor, in vec2 fragCoord) {{\n{scene_made}{seed}    vec3 color = vec3(0.0);\n\
             {samples}{}    fragColor = vec4(color, 1.0);\n}}\n",
            develop(scene)
        )
    }
}

fn develop(scene: &Scene) -> String {
    let mut text = String::new();
    if scene.film.tone_map == ToneMap::Reinhard {
        text.push_str("    color = color / (color + 1.0);\n");
    }
    if scene.film.gamma != 1.0 {
        let _ = writeln!(
            text,
            "    color = pow(color, vec3(1.0 / {}));",
            number(scene.film.gamma)
        );
    }
    text
}
