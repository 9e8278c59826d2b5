//! HLSL: the block at `b0`, the texture of binding K at `tK`, the sampler of binding K at `sK`.

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
    Ok(with_samplers(&text))
}

/// naga keeps all samplers in one heap, looked up through a buffer; a host of one shader would rather bind them one by one.
fn with_samplers(text: &str) -> String {
    let is_heap = |line: &&str| {
        line.starts_with("SamplerState nagaSamplerHeap[")
            || line.starts_with("SamplerComparisonState nagaComparisonSamplerHeap[")
            || line.starts_with("StructuredBuffer<uint> nagaGroup0SamplerIndexArray ")
    };
    let lines = text.lines().filter(|line| !is_heap(line)).map(|line| {
        let sampler = line.strip_prefix("static const SamplerState ").and_then(|rest| {
            rest.strip_suffix("]];")?
                .split_once(" = nagaSamplerHeap[nagaGroup0SamplerIndexArray[")
        });
        match sampler {
            Some((name, register)) => format!("SamplerState {name} : register(s{register});\n"),
            None => format!("{line}\n"),
        }
    });
    lines.collect()
}
