//! HLSL: the block at `b0`, the texture of binding K at `tK`, samplers through naga's sampler heap.

use naga::back::hlsl::{BindTarget, Options, PipelineOptions, Writer};

use super::bindings;
use crate::module::ValidModule;

pub(super) fn write(module: &ValidModule) -> Result<String, String> {
    let binding_map = bindings(module)
        .map(|(binding, _)| {
            let target = BindTarget {
                register: binding.binding,
                ..BindTarget::default()
            };
            (binding, target)
        })
        .collect();
    let options = Options {
        binding_map,
        force_loop_bounding: false,
        ..Options::default()
    };
    let pipeline = PipelineOptions::default();
    let mut text = String::new();
    Writer::new(&mut text, &options, &pipeline)
        .write(module.module(), module.info(), None)
        .map_err(|error| error.to_string())?;
    Ok(text)
}
