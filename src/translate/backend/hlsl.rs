//! HLSL: the block at `b0`, the texture of binding K at `tK`, the sampler of binding K at `sK`.

use std::collections::HashSet;

use naga::back::hlsl::{BindTarget, Options, PipelineOptions, Writer};

use super::bindings;
use crate::naga_ir::ValidModule;

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
    let named = with_free_names(module.module());
    Writer::new(&mut text, &options, &pipeline)
        .write(&named, module.info(), None)
        .map_err(|error| error.to_string())?;
    Ok(with_samplers(&text))
}

/// The same module, in which nothing has a name like those of naga's functions that make structures, which it does not keep free.
fn with_free_names(module: &naga::Module) -> naga::Module {
    let mut module = module.clone();
    let free = |name: &mut Option<String>| {
        if let Some(rest) = name.as_deref().and_then(|name| name.strip_prefix("Construct")) {
            *name = Some(format!("construct{rest}"));
        }
    };
    let of_function = |function: &mut naga::Function| {
        free(&mut function.name);
        function
            .arguments
            .iter_mut()
            .for_each(|argument| free(&mut argument.name));
        function
            .local_variables
            .iter_mut()
            .for_each(|(_, local)| free(&mut local.name));
    };
    module
        .functions
        .iter_mut()
        .for_each(|(_, function)| of_function(function));
    module
        .entry_points
        .iter_mut()
        .for_each(|entry| of_function(&mut entry.function));
    module
        .constants
        .iter_mut()
        .for_each(|(_, constant)| free(&mut constant.name));
    module
        .global_variables
        .iter_mut()
        .for_each(|(_, global)| free(&mut global.name));
    let types: Vec<_> = module
        .types
        .iter()
        .map(|(handle, ty)| (handle, ty.clone()))
        .collect();
    let mut names: HashSet<_> = types.iter().filter_map(|(_, ty)| ty.name.clone()).collect();
    for (handle, ty) in types {
        let mut name = ty.name.clone();
        free(&mut name);
        if name == ty.name {
            continue;
        }
        // Two types that are alike in all may not have one name.
        while let Some(name) = name.as_mut().filter(|name| names.contains(*name)) {
            name.push('n');
        }
        names.extend(name.clone());
        module.types.replace(handle, naga::Type { name, ..ty });
    }
    module
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
