//! Metal Shading Language: binding K becomes `buffer(K)`, `texture(K)` or `sampler(K)`.

use naga::back::msl::{self, BindSamplerTarget, BindTarget, EntryPointResources, Options, PipelineOptions};

use super::{BOUNDS, Class, ENTRY_POINT, bindings};
use crate::naga_ir::ValidModule;

pub(super) fn write(module: &ValidModule) -> Result<String, String> {
    let mut resources = EntryPointResources::default();
    for (binding, class) in bindings(module) {
        let slot = u8::try_from(binding.binding).map_err(|error| error.to_string())?;
        let mut target = BindTarget::default();
        match class {
            Class::Block => target.buffer = Some(slot),
            Class::Texture => target.texture = Some(slot),
            Class::Sampler => target.sampler = Some(BindSamplerTarget::Resource(slot)),
        }
        resources.resources.insert(binding, target);
    }
    let options = Options {
        lang_version: (2, 0),
        per_entry_point_map: [(ENTRY_POINT.to_owned(), resources)].into(),
        fake_missing_bindings: false,
        bounds_check_policies: BOUNDS,
        force_loop_bounding: false,
        ..Options::default()
    };
    msl::write_string(
        module.module(),
        module.info(),
        &options,
        &PipelineOptions::default(),
    )
    .map(|(text, _)| text)
    .map_err(|error| error.to_string())
}
