//! HLSL, as naga writes it, in forms that compilers other than DXC accept too.

use std::collections::HashSet;

use naga::back::hlsl;

use super::bindings;
use crate::TranslateError;
use crate::naga_ir::ValidModule;

/// Writes HLSL: the block at `b0`, the texture of binding K at `tK`, the sampler of binding K at `sK`.
pub(super) fn write(module: &ValidModule) -> Result<String, TranslateError> {
    let binding_map = bindings(module)
        .map(|(binding, _)| {
            let target = hlsl::BindTarget {
                register: binding.binding,
                ..hlsl::BindTarget::default()
            };
            (binding, target)
        })
        .collect();
    let options = hlsl::Options {
        binding_map,
        force_loop_bounding: false,
        ..hlsl::Options::default()
    };
    let pipeline = hlsl::PipelineOptions::default();
    let mut text = String::new();
    let named = without_reserved_names(module.module());
    hlsl::Writer::new(&mut text, &options, &pipeline)
        .write(&named, module.info(), None)
        .map_err(TranslateError::new)?;
    Ok(with_initializer_lists(&with_separate_samplers(&text)))
}

/// Renames items whose names clash with the constructors that naga generates but does not reserve.
fn without_reserved_names(module: &naga::Module) -> naga::Module {
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
        // Types that are otherwise equal must have distinct names.
        while let Some(name) = name.as_mut().filter(|name| names.contains(*name)) {
            name.push('n');
        }
        names.extend(name.clone());
        module.types.replace(handle, naga::Type { name, ..ty });
    }
    module
}

/// Replaces naga's sampler heap, which it accesses through a buffer, by separate sampler bindings, which are
/// simpler for hosts of a single shader.
fn with_separate_samplers(text: &str) -> String {
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

/// Writes the initial values of arrays as initializer lists. Compilers other than DXC refuse the code that
/// naga writes: calls of its constructors in global initializers, and `(S[2])0`.
fn with_initializer_lists(text: &str) -> String {
    let lines = text.lines().map(|line| {
        let listed = match line.split_once(" = ") {
            Some((declared, value)) if declared.starts_with("static ") && value.contains("Construct") => {
                Some(format!("{declared} = {}", constructors_as_lists(value)))
            }
            Some((declared, value)) => zeros(value).map(|list| format!("{declared} = {list};")),
            None => None,
        };
        listed.unwrap_or_else(|| line.to_owned()) + "\n"
    });
    lines.collect()
}

/// Replaces calls of naga's constructors of structures and arrays by initializer lists.
fn constructors_as_lists(value: &str) -> String {
    let mut listed = String::new();
    // Whether each open parenthesis became a brace.
    let mut open = Vec::new();
    let mut rest = value;
    while let Some(at) = rest.find(['(', ')']) {
        let (before, bracket) = rest.split_at(at);
        if bracket.starts_with(')') {
            listed.push_str(before);
            listed.push_str(if open.pop() == Some(true) { " }" } else { ")" });
        } else {
            let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
            let name = before.len() - before.chars().rev().take_while(|&c| is_part(c)).count();
            let is_constructor = before[name..].starts_with("Construct");
            listed.push_str(if is_constructor { &before[..name] } else { before });
            listed.push_str(if is_constructor { "{ " } else { "(" });
            open.push(is_constructor);
        }
        rest = &bracket[1..];
    }
    listed + rest
}

/// Maximum number of elements in a list of zeros.
const MAX_ZEROS: usize = 1 << 12;

/// The list for `(name[count])0;`.
fn zeros(value: &str) -> Option<String> {
    let (name, count) = value.strip_prefix('(')?.strip_suffix("])0;")?.split_once('[')?;
    let count = count.parse().ok().filter(|&count| count <= MAX_ZEROS)?;
    Some(format!("{{ {} }}", vec![format!("({name})0"); count].join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn initial_values_are_lists() {
        for (naga, listed) in [
            (
                "static S s[2] = Constructarray2_S_(ConstructS((0.1).xxx, f(1)), ConstructS(v, 2.0));",
                "static S s[2] = { { (0.1).xxx, f(1) }, { v, 2.0 } };",
            ),
            ("static S s[2] = (S[2])0;", "static S s[2] = { (S)0, (S)0 };"),
            ("    float a[1] = (float[1])0;", "    float a[1] = { (float)0 };"),
            (
                "    a = Constructarray1_float_(1.0);",
                "    a = Constructarray1_float_(1.0);",
            ),
            ("    float4 a = (float4)0;", "    float4 a = (float4)0;"),
            (
                "    float a[9999] = (float[9999])0;",
                "    float a[9999] = (float[9999])0;",
            ),
            ("x = (a[2])0", "x = (a[2])0"),
        ] {
            assert_eq!(with_initializer_lists(naga), format!("{listed}\n"));
        }
    }
}
