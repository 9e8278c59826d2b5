//! The values that a shader passes to a function: the smallest and largest in a few frames, recorded by
//! statements that are added to the text.

use std::fmt::Write as _;
use std::time::Duration;

use toyproof_glsl::tree::Scalar;
use toyproof_glsl::{ADDED_MAIN, Checked, Dialect};
use toyproof_image::Frame;

use super::domain::{Interval, Observed, UNIT_TOLERANCE};
use super::evaluator::added_main;
use super::interface::Interface;
use crate::body::body;
use crate::run::{RunError, ShaderRunner};

/// The size of the frames, a quarter of the usual one in each direction.
const SIZE: [u32; 2] = [160, 90];

/// The times of the frames, in seconds: what moves is seen in several places.
const TIMES: [f32; 3] = [0.0, 1.7, 10.0];

/// The number that a minimum starts with, and a maximum with its negative: larger than any argument.
const NOTHING: f32 = 3e38;

/// The smallest and largest arguments of all calls; `None` if there are none, or if they cannot be recorded,
/// as in a text of macros.
///
/// # Errors
/// [`RunError`] if the frames cannot be rendered in time.
pub(super) fn observe(
    text: &str,
    checked: &Checked,
    interface: &Interface,
    timeout: Option<Duration>,
) -> Result<Option<Observed>, RunError> {
    let Some(text) = recording_text(text, checked, interface) else {
        return Ok(None);
    };
    let (_, options) = added_main(&text, checked, 0);
    let runner = match ShaderRunner::new(&text, &options, timeout) {
        Err(RunError::Invalid(_)) => return Ok(None),
        other => other?,
    };
    let count = quantities(interface).len();
    let mut found = vec![
        Interval {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY
        };
        count
    ];
    for time in TIMES {
        let frame = Frame {
            size: SIZE,
            time,
            ..Frame::default()
        };
        for (pixel, [is_known, low, high]) in runner.colors::<f32>(&frame)?.into_iter().enumerate() {
            let (at, is_called) = (pixel % count, low <= high);
            if is_known == 1.0 && is_called {
                let one = &mut found[at];
                (one.low, one.high) = (one.low.min(low), one.high.max(high));
            }
        }
    }
    let mut observed = Observed::empty(interface);
    let (components, lengths) = found.split_at(interface.inputs.len());
    for (at, &interval) in components.iter().enumerate() {
        observed.include(at, interval);
    }
    for (is_unit, length) in observed.are_unit.iter_mut().zip(lengths) {
        *is_unit = (length.low - 1.0).abs() < UNIT_TOLERANCE && (length.high - 1.0).abs() < UNIT_TOLERANCE;
    }
    Ok(observed.is_complete().then_some(observed))
}

/// The recorded quantities, as expressions in the parameters: the components of the inputs, then the lengths
/// of the float vectors among them.
fn quantities(interface: &Interface) -> Vec<String> {
    let components = interface.inputs.iter().map(|component| match component.scalar {
        Scalar::Float => component.path.clone(),
        Scalar::Int | Scalar::Uint | Scalar::Bool => format!("float({})", component.path),
    });
    let lengths = interface.vectors.iter().map(|vector| {
        let path = &interface.inputs[vector.start].path;
        format!("length({})", path.strip_suffix(".x").unwrap_or(path))
    });
    components.chain(lengths).collect()
}

/// The shader with statements that record the arguments of the function. Each pixel returns one quantity, of
/// all calls that led to its color.
fn recording_text(text: &str, checked: &Checked, interface: &Interface) -> Option<String> {
    if !Dialect::calls_main_image(checked.dialect) {
        return None;
    }
    let start = body(text, interface.name_at)?.start + 1;
    let quantities = quantities(interface);
    let (mut globals, mut statements, mut results) = (String::new(), String::new(), String::new());
    for (at, expression) in quantities.iter().enumerate() {
        let _ = write!(
            globals,
            "float tpLow{at} = {NOTHING:?}, tpHigh{at} = -{NOTHING:?}; "
        );
        let _ = write!(
            statements,
            " tpLow{at} = min(tpLow{at}, {expression}); tpHigh{at} = max(tpHigh{at}, {expression});"
        );
        let _ = writeln!(
            results,
            "    if (tpRow == {at}) tpColor = vec4(1.0, tpLow{at}, tpHigh{at}, 0.0);"
        );
    }
    let width = SIZE[0];
    let main = format!(
        "void {ADDED_MAIN}(out vec4 tpColor, in vec2 tpPlace) {{
    mainImage(tpColor, tpPlace);
    int tpRow = (int(tpPlace.y) * {width} + int(tpPlace.x)) % {};
{results}}}
",
        quantities.len()
    );
    let (before, after) = text.split_at(start);
    Some(format!("{globals}\n{before}{statements}{after}\n{main}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::tests::checked;

    fn observed(text: &str, name: &str) -> Option<Observed> {
        let checked = checked(text);
        let interface = Interface::new(&checked, name).unwrap();
        observe(text, &checked, &interface, None).unwrap()
    }

    #[test]
    fn arguments_are_recorded_over_the_frame() {
        let text = "float f(float x, int n, vec3 d) { return x * float(n) + d.x; }
            void mainImage(out vec4 c, in vec2 p) {
                vec3 d = normalize(vec3(p / iResolution.xy - 0.5, 1));
                c = vec4(0);
                for (int n = 2; n < 6; n++) c += f(p.x / iResolution.x * 4. - 1., n, d);
            }";
        let found = observed(text, "f").unwrap();
        let [x, n, dx, ..] = found.intervals[..] else {
            panic!()
        };
        // The quantities take turns along a row.
        assert!(
            (-1.0..-0.8).contains(&x.low) && (2.8..3.0).contains(&x.high),
            "{x:?}"
        );
        assert_eq!([n.low, n.high], [2.0, 5.0]);
        assert!(dx.low < -0.4 && dx.high > 0.4, "{dx:?}");
        assert_eq!(found.are_unit, [true]);
    }

    #[test]
    fn a_function_that_is_not_called_is_not_observed() {
        let text = "float f(float x) { return x; } void mainImage(out vec4 c, in vec2 p) { c = vec4(0); }";
        assert!(observed(text, "f").is_none());
    }
}
