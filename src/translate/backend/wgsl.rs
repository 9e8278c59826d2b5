//! WGSL.

use naga::back::wgsl::{WriterFlags, write_string};
use naga::{Expression, SampleLevel};

use crate::naga_ir::ValidModule;

/// WGSL refuses derivatives and implicit levels of detail where control flow may not be uniform; GLSL allows
/// them and leaves the value undefined there. Turning the check off keeps GLSL's meaning.
const DERIVATIVES: &str = "diagnostic(off, derivative_uniformity);\n";

pub(super) fn write(module: &ValidModule) -> Result<String, String> {
    let text = write_string(module.module(), module.info(), WriterFlags::empty())
        .map_err(|error| error.to_string())?;
    Ok(if takes_derivatives(module) {
        DERIVATIVES.to_owned() + &text
    } else {
        text
    })
}

fn takes_derivatives(module: &ValidModule) -> bool {
    let naga = module.module();
    let functions = naga.functions.iter().map(|(_, function)| function);
    functions
        .chain(naga.entry_points.iter().map(|entry| &entry.function))
        .flat_map(|function| function.expressions.iter())
        .any(|(_, expression)| {
            matches!(
                expression,
                Expression::Derivative { .. }
                    | Expression::ImageSample {
                        level: SampleLevel::Auto | SampleLevel::Bias(_),
                        ..
                    }
            )
        })
}
