//! What `ShaderToy` puts around a shader: the inputs before it, `main` after it.

use toyproof_glsl::tree::{Input, Sampler, SamplerShape, Type, VariableKind};

use super::names::BLOCK;
use super::order::Order;
use super::printer::Printer;

impl Printer<'_> {
    /// The version, the output, and the inputs that are read.
    pub(super) fn prelude(&mut self, order: &Order) {
        self.plain("#version 450 core\nlayout(location = 0) out vec4 toyproof_colour;\n");
        let tree = &self.draft.tree;
        let channels = order
            .inputs
            .iter()
            .filter_map(|&id| match (tree[id].kind, tree[id].ty) {
                (VariableKind::Input(Input::Channel(channel)), Type::Sampler(sampler)) => {
                    Some((channel, sampler))
                }
                _ => None,
            });
        let channels: Vec<(u8, Sampler)> = channels.collect();
        if order.inputs.len() > channels.len() {
            self.frame();
        }
        for (channel, sampler) in channels {
            self.channel(channel, sampler);
        }
        self.plain("\n");
    }

    /// All inputs but the channels; hosts know each by its offset. `iChannelTime` is an array of `vec4`, since WGSL has
    /// no uniform arrays with a stride of 4 and std140 pads it to 16 in any case.
    fn frame(&mut self) {
        self.plain("layout(std140, set = 0, binding = 0) uniform ToyproofFrame ");
        self.braces(|printer| {
            for (ty, name) in BLOCK {
                printer.line();
                printer.plain(&format!("{ty} {name};\n"));
            }
        });
        self.plain(";\n");
    }

    fn channel(&mut self, channel: u8, sampler: Sampler) {
        let shape = match sampler.shape {
            SamplerShape::D2 => "2D",
            SamplerShape::D3 => "3D",
            SamplerShape::Cube => "Cube",
            SamplerShape::D2Array => "2DArray",
        };
        let [texture, sampler] = [1 + 2 * channel, 2 + 2 * channel];
        self.plain(&format!(
            "layout(set = 0, binding = {texture}) uniform texture{shape} iChannel{channel};\n\
             layout(set = 0, binding = {sampler}) uniform sampler iChannel{channel}_sampler;\n"
        ));
    }

    /// `main`, which runs what must run before `mainImage`.
    pub(super) fn epilogue(&mut self) {
        let begin = self
            .draft
            .begin
            .map(|begin| format!("    {}();\n", self.function(begin)))
            .unwrap_or_default();
        let main_image = self.function(self.draft.main_image);
        self.plain(&format!(
            "
void main() {{
{begin}    vec4 toyproof_painted = vec4(0.0, 0.0, 0.0, 1.0);
    {main_image}(toyproof_painted, gl_FragCoord.xy);
    toyproof_colour = vec4(toyproof_painted.xyz, 1.0);
}}
"
        ));
    }
}
