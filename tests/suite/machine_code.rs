//! Machine code has the bits of the handlers, in whole images of the course, with all treatments of undefined
//! operations, in both precisions.

use toyproof::eval::{Engine, Number, Program, Rendered, Settings, Substitute, UndefinedPolicy};
use toyproof::image::Frame;

use crate::support::{EXERCISES, checked};

/// The bits of all pixels, bottom row first.
fn bits<N: Number>(rendered: &Rendered<N>, [width, height]: [u32; 2]) -> Vec<[u64; 3]> {
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let colors = places.map(|(x, y)| rendered.framebuffer.get(x, y));
    colors
        .map(|color| color.map(|part| part.to_f64().to_bits()))
        .collect()
}

fn compare<N: Number>(name: &str, program: &Program, undefined: UndefinedPolicy, frame: &Frame) {
    let render = |engine| {
        let settings = Settings::<N> {
            undefined,
            engine,
            ..Settings::default()
        };
        program.render(frame, &settings).expect("the course is rendered")
    };
    let handlers = render(Engine::Handlers);
    let expected = bits(&handlers, frame.size);
    // On a processor without AVX-512, both are the same.
    for engine in [Engine::Native, Engine::Avx2] {
        let native = render(engine);
        let case = || {
            format!(
                "{name}, {:?}, {undefined:?}, {engine:?}",
                std::any::type_name::<N>()
            )
        };
        let found = bits(&native, frame.size);
        let differing = expected.iter().zip(&found).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "{}", case());
        assert_eq!(handlers.observations, native.observations, "{}", case());
    }
}

/// Compares a small image of a shader.
fn compare_text(name: &str, text: &str) {
    let program = Program::new(&checked(text)).unwrap();
    let frame = Frame {
        size: [48, 27],
        ..Frame::default()
    };
    for undefined in [UndefinedPolicy::Plain, UndefinedPolicy::Observed] {
        compare::<f32>(name, &program, undefined, &frame);
        compare::<f64>(name, &program, undefined, &frame);
    }
}

#[test]
fn the_course_has_the_same_bits() {
    for exercise in EXERCISES {
        let program = Program::new(&checked(exercise.shader)).unwrap();
        for size in [[61, 37], [160, 90]] {
            let frame = Frame {
                size,
                ..Frame::default()
            };
            for undefined in [
                UndefinedPolicy::Plain,
                UndefinedPolicy::Observed,
                UndefinedPolicy::Substitute(Substitute::NotANumber),
            ] {
                compare::<f32>(exercise.name, &program, undefined, &frame);
                compare::<f64>(exercise.name, &program, undefined, &frame);
            }
        }
    }
}

/// A scalar variable that is changed in its own location, after a region of vectors that reads it.
#[test]
fn a_variable_keeps_its_value_until_it_was_read() {
    let text = "void mainImage(out vec4 color, in vec2 at) {\n\
                    at[int(at.y) & 1] = 2.75;\n\
                    for (float x = 0.0; x < 4.0; ++x) { at.y *= x; at.y = at.y; }\n\
                    color = vec4(at, 0.0, 1.0);\n\
                }\n";
    compare_text("variable", text);
}

/// A variable that has one value for all pixels, and is set to a derivative of one.
#[test]
fn a_uniform_variable_may_be_a_derivative() {
    let text = "float rate = 3.0; vec2 slope = vec2(2.5);\n\
                void mainImage(out vec4 color, in vec2 at) {\n\
                    color = vec4(at, 0.0, 1.0);\n\
                    for (int i = 0; i < iFrame + 2; i++) {\n\
                        color.xy += slope * at;\n\
                        slope.x = dFdx(rate);\n\
                        rate += 1.5;\n\
                    }\n\
                }\n";
    compare_text("derivative", text);
}
