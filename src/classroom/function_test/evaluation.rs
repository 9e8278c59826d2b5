//! The evaluation of generated statements, once for each case, in f32 and in f64.

use toyproof_diagnostic::Span;
use toyproof_glsl::ADDED_MAIN;
use toyproof_glsl::tree::Scalar;
use toyproof_image::Frame;
use toyproof_stress::{RunError, ShaderRunner};

use super::result::TestError;
use super::source::GeneratedText;
use super::subject::Subject;
use super::test::Precision;
use super::value::Component;

/// Statements that are evaluated for each case, and the components of their results.
#[derive(Debug, Clone)]
pub(super) struct Evaluation {
    /// Functions before the one that runs them.
    pub(super) declarations: GeneratedText,
    /// The statements. They may read the number of the case, `tpCase`.
    pub(super) statements: GeneratedText,
    pub(super) components: Vec<Component>,
    pub(super) cases: usize,
}

/// The components of all cases in one number type.
#[derive(Debug, Clone)]
pub(super) struct Values {
    pub(super) is_single: bool,
    pub(super) cases: Vec<Vec<f64>>,
}

impl Evaluation {
    /// Compiles the shader with the statements, and evaluates them. Each pixel has three components of one
    /// case, in the default frame, so that `iResolution` has its usual value. `at`: the place of errors that
    /// are in no text of an author.
    pub(super) fn evaluate(
        &self,
        subject: &Subject,
        precision: Precision,
        at: Option<Span>,
    ) -> Result<Vec<Values>, TestError> {
        let frame = Frame::default();
        let [width, height] = frame.size;
        // The halves of an integer are floats of both number types.
        let floats: Vec<String> = self.components.iter().flat_map(floats).collect();
        let rows = floats.len().div_ceil(3).max(1);
        if rows.saturating_mul(self.cases) > (width * height) as usize {
            return Err(TestError::Shader(
                "the values of the test are too large".to_owned(),
            ));
        }
        let mut text = self.declarations.clone();
        text.push(&format!(
            "void {ADDED_MAIN}(out vec4 tpColor, in vec2 tpPlace) {{\n"
        ));
        text.push(&format!(
            "    int tpPixel = int(tpPlace.y) * {width} + int(tpPlace.x);\n    int tpRow = tpPixel / {0};\n    \
             int tpCase = tpPixel - {0} * tpRow;\n    if (tpRow < {rows}) {{\n",
            self.cases
        ));
        text.append(&self.statements);
        for (row, floats) in floats.chunks(3).enumerate() {
            let mut color = floats.to_vec();
            color.resize(4, "0.0".to_owned());
            text.push(&format!(
                "    if (tpRow == {row}) tpColor = vec4({});\n",
                color.join(", ")
            ));
        }
        text.push("    }\n}\n");
        let text = text.after_shader(subject);
        let runner = ShaderRunner::new(text.text(), &subject.options(), Some(subject.timeout));
        let runner = runner.map_err(|error| match (error, at) {
            (RunError::Invalid(found), Some(at)) => TestError::Test(text.diagnostics(found, at)),
            (error, _) => TestError::Shader(not_run(&error)),
        })?;
        let mut all = Vec::new();
        if precision != Precision::Single {
            all.push((false, runner.colors::<f64>(&frame)));
        }
        if precision != Precision::Double {
            all.push((true, runner.colors::<f32>(&frame)));
        }
        let values = all.into_iter().map(|(is_single, colors)| {
            let colors = colors.map_err(|error| TestError::Shader(not_run(&error)))?;
            let case = |case: usize| {
                let float = |index: usize| colors[index / 3 * self.cases + case][index % 3];
                self.components_of((0..floats.len()).map(float))
            };
            Ok(Values {
                is_single,
                cases: (0..self.cases).map(case).collect(),
            })
        });
        values.collect()
    }

    /// The components whose floats these are.
    fn components_of(&self, mut floats: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut next = || floats.next().unwrap_or(f64::NAN);
        let component = |component: &Component| match component.scalar {
            Scalar::Float | Scalar::Bool => next(),
            Scalar::Int | Scalar::Uint => {
                let bits = next() as u32 | (next() as u32) << 16;
                if component.scalar == Scalar::Int {
                    f64::from(bits as i32)
                } else {
                    f64::from(bits)
                }
            }
        };
        self.components.iter().map(component).collect()
    }
}

/// Expressions for a component as floats.
fn floats(component: &Component) -> Vec<String> {
    let path = &component.path;
    match component.scalar {
        Scalar::Float | Scalar::Bool => vec![format!("float({path})")],
        Scalar::Int | Scalar::Uint => vec![
            format!("float(uint({path}) & 65535u)"),
            format!("float(uint({path}) >> 16u)"),
        ],
    }
}

/// A sentence about a test that could not be evaluated.
pub(super) fn not_run(error: &RunError) -> String {
    format!("the test cannot be run: {error}")
}
