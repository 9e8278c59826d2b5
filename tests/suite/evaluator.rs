//! The evaluator in f32 and the strict GPU run produce the same bits.

use toyproof::eval::{Program, Rendered, Settings};
use toyproof::glsl::Checked;
use toyproof::gpu::Worker;
use toyproof::image::{Frame, Image};
use toyproof::translate::{FloatMode, lower_strict};

use crate::requirements::{require_swiftshader, require_worker};
use crate::support::{EXERCISES, checked, differences};

fn both(worker: &mut Worker, checked: &Checked, frame: &Frame) -> (Rendered<f32>, Image) {
    let rendered = Program::new(checked)
        .unwrap()
        .render::<f32>(frame, &Settings::default())
        .unwrap();
    let drawn = worker
        .draw(lower_strict(checked), frame.clone(), FloatMode::Strict)
        .unwrap();
    (rendered, drawn.image())
}

#[test]
fn the_course_has_the_same_bits_on_the_cpu() {
    let Some(mut worker) = require_worker() else {
        return;
    };
    let frame = Frame {
        size: [131, 75],
        frame: 7,
        time: 0.7,
        ..Frame::default()
    };
    for exercise in EXERCISES {
        let (rendered, drawn) = both(&mut worker, &checked(exercise.shader), &frame);
        let (count, first) = differences(&rendered.framebuffer.image(), &drawn, |_, _| false);
        assert_eq!(count, 0, "{}: {first}", exercise.name);
        assert_eq!(
            rendered.framebuffer.undefined(),
            0,
            "{}: {:?}",
            exercise.name,
            rendered.observations
        );
    }
}

/// Constructs in which drivers have differed in spite of strict mode.
static DIFFERED: &[&str] = &[
    // Derivatives where a quad lies half in each of two triangles, which is how lavapipe fills a frame: the
    // other half must have the frame's uniform block as well.
    "c = vec4(dFdx(iResolution.x), dFdy(iResolution.y), fwidth(sin(iTime) * p.x), 1.0);",
    // A derivative of a quad's first row and column, or of the pixel's own.
    "c = vec4(dFdx(p.x * p.y), dFdy(p.x * p.y), fwidth(p.x * p.y * p.y), 1.0);",
    // Values loaded in a loop that some pixels have already left.
    "float k = 0.; for (int i = 0; i < 9; i++) { k += iResolution.x; if (k > p.x * 9.) break; } c = vec4(k, k / iResolution.x, iTime, 1.0);",
    // Zero times NaN.
    "float k = sqrt(p.x - 20.); c = vec4(0. * k, vec2(.5, 0) * k, 1.); c.w = dot(vec2(0, 1), vec2(k, 1));",
    "float k = log(20. - p.x); c.xyz = mat3(1, 0, 0, 0, p, k, 0, p.x) * vec3(k, p); c.w = 0. / k;",
    "float k = sqrt(p.x - 20.); c = vec4(mix(vec3(0, 0, 1), vec3(1, .5, 0), k), p.x > 9. ? 0. : 1.);",
    // A loop that depends on uniforms only, through more paths than a compiler can visit.
    "float k = sin(8. * cos(iTime)), s = 0.; for (int i = 0; i < 8; i++) { if (k < float(i) * .1) break; s += .1; } c = vec4(s, k, p);",
    // Exact functions of values that constant propagation makes constant, in one branch of two.
    "vec3 g = vec3(14, 63, 240) / 255.0; float m = max(g.x, g.z); c = vec4(m == 0.0 ? 0.25 : 0.5 / m);",
    "vec3 g = vec3(14, 63, 240) / 255.0; float m = min(g.x, g.z); c = vec4(m == 0.0 ? 0.25 : 0.5 / m);",
    "vec3 g = vec3(14, 63, 240) / 255.0; float m = sqrt(g.x); c = vec4(m == 0.0 ? 0.25 : 0.5 / m);",
];

#[test]
fn drivers_agree_where_they_once_differed() {
    let frame = Frame {
        size: [64, 36],
        ..Frame::default()
    };
    for mut worker in [require_worker(), require_swiftshader()].into_iter().flatten() {
        for body in DIFFERED {
            let shader = format!("void mainImage(out vec4 c, in vec2 p) {{ {body} }}");
            let (rendered, drawn) = both(&mut worker, &checked(&shader), &frame);
            let (count, first) = differences(&rendered.framebuffer.image(), &drawn, |_, _| false);
            assert_eq!(count, 0, "{body}: {first}");
        }
    }
}
