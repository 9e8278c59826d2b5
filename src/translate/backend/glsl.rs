//! GLSL ES 3.00, for WebGL2 hosts; textures and samplers are combined by naga.

use naga::ShaderStage;
use naga::back::glsl::{Options, PipelineOptions, Version, Writer, WriterFlags};

use super::{BOUNDS, ENTRY_POINT};
use crate::naga_ir::ValidModule;

pub(super) fn write(module: &ValidModule) -> Result<String, String> {
    let options = Options {
        version: Version::new_gles(300),
        writer_flags: WriterFlags::empty(),
        ..Options::default()
    };
    let pipeline = PipelineOptions {
        shader_stage: ShaderStage::Fragment,
        entry_point: ENTRY_POINT.to_owned(),
        multiview: None,
    };
    let mut text = String::new();
    Writer::new(
        &mut text,
        module.module(),
        module.info(),
        &options,
        &pipeline,
        BOUNDS,
    )
    .and_then(|mut writer| writer.write())
    .map_err(|error| error.to_string())?;
    Ok(text)
}
