//! Prints a lowered tree as GLSL 450, in the subset that naga's front end parses correctly.
//!
//! Some constructs that naga misreads are never printed: prototypes, `const in`, precision qualifiers, arrays
//! without a size or sized by a local constant, and several declarators with sizes of their own (`float a[2],
//! b;`).

mod expression;
pub(crate) mod keyword;
mod names;
mod order;
mod statement;
mod wrap;

use std::ops::Range;

pub(super) use names::{Names, Numbering, Vocabulary};
pub(super) use order::{CaseLabels, Order};
use serde::{Deserialize, Serialize};
use toyproof_diagnostic::{Deadline, Diagnostic, Overdue, Span};
use toyproof_glsl::tree::{
    FunctionId, Input, InputType, Place, Sampler, SamplerShape, Type, VariableId, VariableKind,
};
use toyproof_glsl::{Sampling, Stage};
pub(super) use wrap::wrap;

use self::names::NagasGlsl;
use crate::lower::context::LoweringContext;

/// The binding of the author's uniforms in group 0.
pub(crate) const UNIFORM_BINDING: u32 = 9;

/// The type of the block of the author's uniforms.
pub(crate) const UNIFORM_BLOCK: &str = "ToyproofUniforms";

/// Prints everything that a shader's image depends on.
pub(super) fn print(cx: &LoweringContext, deadline: &Deadline) -> Result<Lowered, Overdue> {
    let order = Order::new(cx, CaseLabels::Values);
    let names = Names::new(cx, &order, &NagasGlsl);
    let mut printer = Printer::new(cx, &names);
    printer.prelude(&order);
    for &item in &order.items {
        deadline.check()?;
        printer.item(item);
    }
    printer.epilogue();
    printer.out.refuse(cx.too_deep.clone());
    printer.out.checks_fetches = cx.checks_fetches;
    printer.out.sampling = cx.sampling;
    Ok(printer.out)
}

/// Prints a lowered shader.
struct Printer<'a> {
    cx: &'a LoweringContext,
    names: &'a Names,
    out: Lowered,
    indent: usize,
}

impl<'a> Printer<'a> {
    fn new(cx: &'a LoweringContext, names: &'a Names) -> Self {
        Self {
            cx,
            names,
            out: Lowered::default(),
            indent: 0,
        }
    }

    /// Prints a token of the author's at its place.
    fn token(&mut self, text: &str, at: Place) {
        self.out.push(text, Some(at.span));
    }

    /// Prints generated text, or text between the author's tokens.
    fn plain(&mut self, text: &str) {
        self.out.push(text, None);
    }

    fn spanned(&mut self, text: &str, span: Option<Span>) {
        self.out.push(text, span);
    }

    /// Begins an indented line.
    fn line(&mut self) {
        self.plain(&"    ".repeat(self.indent));
    }

    /// Prints `{`, indented lines and `}`.
    fn braces(&mut self, inside: impl FnOnce(&mut Self)) {
        self.plain("{\n");
        self.indented(inside);
        self.line();
        self.plain("}");
    }

    /// Prints lines indented by one more level.
    fn indented(&mut self, inside: impl FnOnce(&mut Self)) {
        self.indent += 1;
        inside(self);
        self.indent -= 1;
    }

    fn variable(&self, id: VariableId) -> &'a str {
        self.names.variables.get(&id).unwrap_or(&self.cx.tree[id].name)
    }

    fn function(&self, id: FunctionId) -> &'a str {
        self.names.functions.get(&id).unwrap_or(&self.cx.tree[id].name)
    }

    /// The type in naga's order: `float[3][2]` for two arrays of three, since naga applies sizes from left to
    /// right.
    fn type_name(&self, mut ty: Type) -> String {
        let mut sizes = String::new();
        while let Type::Array(id) = ty {
            let array = self.cx.tree.array(id);
            sizes.insert_str(0, &format!("[{}]", array.size));
            ty = array.element;
        }
        match ty {
            Type::Struct(id) => self.names.structs.get(&id).cloned().unwrap_or_default() + &sizes,
            _ => self.cx.tree.type_name(ty) + &sizes,
        }
    }
}

impl Printer<'_> {
    /// Prints the version, the output, and the inputs that are read.
    fn prelude(&mut self, order: &Order) {
        self.plain("#version 450 core\nlayout(location = 0) out vec4 toyproof_color;\n");
        let tree = &self.cx.tree;
        let channels = order
            .inputs
            .iter()
            .filter_map(|&id| match (tree[id].kind, tree[id].ty) {
                (VariableKind::Channel(channel), Type::Sampler(sampler)) => Some((channel, sampler)),
                _ => None,
            });
        let channels: Vec<(u8, Sampler)> = channels.collect();
        if order.inputs.len() > channels.len() {
            self.frame();
        }
        for (channel, sampler) in channels {
            self.channel(channel, sampler);
        }
        if order.reads_uniform_block {
            self.uniform_block();
        }
        self.plain("\n");
    }

    /// Prints the block of all inputs except channels; hosts know their offsets. `iChannelTime` is an array
    /// of `vec4`, since WGSL has no uniform arrays with a stride of 4, and std140 pads the stride to 16
    /// anyway.
    fn frame(&mut self) {
        self.plain("layout(std140, set = 0, binding = 0) uniform ToyproofFrame ");
        self.braces(|printer| {
            for input in Input::ALL {
                let (name, ty) = (input.name(), input.ty());
                printer.line();
                printer.plain(&match (input.length(), ty) {
                    (None, ty) => format!("{} {name};\n", ty.name()),
                    (Some(length), InputType::Float) => format!("vec4[{length}] {name};\n"),
                    (Some(length), ty) => format!("{}[{length}] {name};\n", ty.name()),
                });
            }
        });
        self.plain(";\n");
    }

    /// Prints the block of the author's uniforms, with all of them: hosts know their offsets.
    fn uniform_block(&mut self) {
        self.plain(&format!(
            "layout(std140, set = 0, binding = {UNIFORM_BINDING}) uniform {UNIFORM_BLOCK} "
        ));
        self.braces(|printer| {
            for &member in &printer.cx.uniform_block {
                let variable = &printer.cx.tree[member];
                let text = format!(
                    "{} {};\n",
                    printer.type_name(variable.ty),
                    printer.variable(member)
                );
                printer.line();
                printer.spanned(&text, variable.at.map(|at| at.span));
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

    /// Prints `main`, which first calls the startup function.
    fn epilogue(&mut self) {
        let begin = self
            .cx
            .startup_function
            .map(|begin| format!("    {}();\n", self.function(begin)))
            .unwrap_or_default();
        let main_image = self.function(self.cx.main_image);
        // An `out` parameter takes no value; the alpha of a buffer is visible.
        let opaque = self.cx.stage == Stage::Image || self.cx.tree.adds_to_color(self.cx.main_image);
        let alpha = if opaque { "1.0" } else { "0.0" };
        let written = if self.cx.is_opaque {
            "vec4(toyproof_image_color.xyz, 1.0)"
        } else {
            "toyproof_image_color"
        };
        self.plain(&format!(
            "
void main() {{
{begin}    vec4 toyproof_image_color = vec4(0.0, 0.0, 0.0, {alpha});
    {main_image}(toyproof_image_color, gl_FragCoord.xy);
    toyproof_color = {written};
}}
"
        ));
    }
}

/// GLSL 450 in the subset that naga parses, with a mapping back to the author's text.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Lowered {
    text: String,
    /// The start of each run of bytes and the source span that it prints; a run ends where the next one
    /// starts.
    runs: Vec<(u32, Option<Span>)>,
    /// The reason why no driver may run it.
    too_deep: Option<Diagnostic>,
    checks_fetches: bool,
    sampling: [Sampling; 4],
    is_narrowed: bool,
}

impl Lowered {
    /// The shader for drivers that compute in 16 bits what it rounds to 16 bits: see
    /// [`narrowed`](crate::backend::spirv::narrowed).
    #[must_use]
    pub fn narrowed(self) -> Self {
        Self {
            is_narrowed: true,
            ..self
        }
    }

    /// Whether drivers compute in 16 bits what it rounds to 16 bits.
    pub fn is_narrowed(&self) -> bool {
        self.is_narrowed
    }

    /// The text that naga parses.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The smallest source span that covers bytes of [`Self::text`]; `None` if they are all generated.
    pub fn origin(&self, bytes: Range<usize>) -> Option<Span> {
        let first = self
            .runs
            .partition_point(|&(start, _)| start as usize <= bytes.start)
            .saturating_sub(1);
        self.runs
            .get(first..)?
            .iter()
            .take_while(|&&(start, _)| (start as usize) < bytes.end.max(bytes.start + 1))
            .filter_map(|&(_, span)| span)
            .reduce(Span::to)
    }

    /// Why no driver may run the shader: it nests deeper than drivers support, so that they would render a
    /// different image. It can still be translated.
    pub fn too_deep(&self) -> Option<&Diagnostic> {
        self.too_deep.as_ref()
    }

    /// Whether all fetches of texels check that these are within their textures: such a shader is strict.
    pub(crate) fn checks_fetches(&self) -> bool {
        self.checks_fetches
    }

    /// How the textures of channels are sampled, where the text leaves it to samplers.
    pub fn sampling(&self) -> [Sampling; 4] {
        self.sampling
    }

    /// Sets the reason why no driver may run it, if any.
    fn refuse(&mut self, too_deep: Option<Diagnostic>) {
        self.too_deep = too_deep;
    }

    /// Appends text that prints a source span, or generated text.
    fn push(&mut self, text: &str, span: Option<Span>) {
        if text.is_empty() {
            return;
        }
        if self.runs.last().is_none_or(|&(_, last)| last != span) {
            self.runs.push((self.text.len() as u32, span));
        }
        self.text.push_str(text);
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};

    use super::*;

    #[test]
    fn bytes_map_to_source_spans() {
        let file = Files::default().add(File::new("a", "a+b"));
        let span = |start, end| Some(Span::new(file, start, end));
        let mut lowered = Lowered::default();
        for (text, span) in [
            ("x = ", None),
            ("a", span(0, 1)),
            (" + ", span(0, 3)),
            ("b", span(2, 3)),
            (";", None),
        ] {
            lowered.push(text, span);
        }
        assert_eq!(lowered.text(), "x = a + b;");
        assert_eq!(lowered.origin(4..5), span(0, 1));
        assert_eq!(lowered.origin(8..9), span(2, 3));
        assert_eq!(lowered.origin(4..9), span(0, 3));
        assert_eq!(lowered.origin(0..10), span(0, 3));
        assert_eq!(lowered.origin(0..2), None);
        assert_eq!(lowered.origin(99..99), None);
    }
}
