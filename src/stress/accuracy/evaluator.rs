//! Evaluates a function for many cases: a generated shader calls it once for each pixel, with inputs from a
//! texture of floats.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use toyproof_eval::{Failure, Number, RandomRounding, Seed, Wide};
use toyproof_glsl::tree::Scalar;
use toyproof_glsl::{self as glsl, ADDED_MAIN, Checked, Dialect};
use toyproof_image::{Frame, Image, Texture};

use super::interface::{Component, Interface};
use super::{Case, Outputs};
use crate::run::{RunError, ShaderRunner};

/// The width of the image and of the texture.
const WIDTH: usize = 512;

/// The floats of a pixel that are read back.
const FLOATS_PER_PIXEL: usize = 3;

/// A compiled shader that calls a function.
#[derive(Debug)]
pub(super) struct Evaluator<'a> {
    interface: &'a Interface,
    pub(super) shader: ShaderRunner,
    channel: usize,
    outputs: Vec<Component>,
}

impl<'a> Evaluator<'a> {
    /// Compiles a shader that calls a function of `text` and returns all outputs. `timeout` is as in
    /// [`ShaderRunner::new`].
    pub(super) fn new(
        text: &str,
        checked: &Checked,
        interface: &'a Interface,
        timeout: Option<Duration>,
    ) -> Result<Self, RunError> {
        Self::of_outputs(text, checked, interface, &interface.outputs, timeout)
    }

    /// The same for some of the outputs.
    pub(super) fn of_outputs(
        text: &str,
        checked: &Checked,
        interface: &'a Interface,
        outputs: &[Component],
        timeout: Option<Duration>,
    ) -> Result<Self, RunError> {
        // The function may read a texture, which is black, with `textureSize` 0.
        let channel = (0..4)
            .rev()
            .find(|&channel| !checked.names_channel(channel))
            .unwrap_or(3);
        let (declared, options) = added_main(text, checked, channel);
        let text = format!("{text}\n{declared}{}", main(interface, outputs, channel));
        Ok(Self {
            interface,
            shader: ShaderRunner::new(&text, &options, timeout)?,
            channel,
            outputs: outputs.to_vec(),
        })
    }

    /// The outputs for each case.
    pub(super) fn evaluate<N: Number>(
        &self,
        cases: &[Case],
        noise: N::Noise,
    ) -> Result<Vec<Outputs>, RunError> {
        self.evaluate_by::<N>(cases, noise, self.shader.deadline)
    }

    fn evaluate_by<N: Number>(
        &self,
        cases: &[Case],
        noise: N::Noise,
        deadline: Option<Instant>,
    ) -> Result<Vec<Outputs>, RunError> {
        if cases.is_empty() {
            return Ok(Vec::new());
        }
        let colors = self
            .shader
            .colors_with::<N>(&self.frame(cases), noise, deadline)?;
        let floats: usize = self.outputs.iter().map(float_count).sum();
        let outputs = (0..cases.len()).map(|case| {
            let float = |index: usize| {
                let row = index / FLOATS_PER_PIXEL;
                colors[row * cases.len() + case][index % FLOATS_PER_PIXEL]
            };
            let mut floats = (0..floats).map(float);
            self.outputs
                .iter()
                .map(|output| value(output.scalar, &mut floats))
                .collect()
        });
        Ok(outputs.collect())
    }

    /// The outputs in double precision with every operation rounded at random.
    pub(super) fn perturbed(&self, cases: &[Case], seed: u64) -> Result<Vec<Outputs>, RunError> {
        self.evaluate::<RandomRounding>(cases, Seed::double(seed))
    }

    /// The outputs in 160 bits, rounded to f64; `None` if they are not found in an eighth of the time that is
    /// left.
    pub(super) fn exact(&self, cases: &[Case]) -> Result<Option<Vec<Outputs>>, RunError> {
        let now = Instant::now();
        let deadline = self.shader.deadline;
        let deadline = deadline.map(|deadline| now + deadline.saturating_duration_since(now) / 8);
        match self.evaluate_by::<Wide>(cases, (), deadline) {
            Ok(outputs) => Ok(Some(outputs)),
            Err(RunError::Cpu(Failure::Timeout { .. } | Failure::TimeUp)) => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// A frame with these cases.
    pub(super) fn frame(&self, cases: &[Case]) -> Frame {
        let mut texels = vec![[cases.len() as f32, 0.0, 0.0, 0.0]];
        for case in cases {
            let mut floats = Vec::with_capacity(case.len());
            for (component, &value) in self.interface.inputs.iter().zip(case.iter()) {
                push_floats(component.scalar, value, &mut floats);
            }
            let chunks = floats.chunks(4);
            texels
                .extend(chunks.map(|chunk| std::array::from_fn(|at| chunk.get(at).copied().unwrap_or(0.0))));
        }
        let rows = texels.len().div_ceil(WIDTH);
        texels.resize(rows * WIDTH, [0.0; 4]);
        let texture = Texture::from(Image::new(WIDTH as u32, rows as u32, texels));
        let floats: usize = self.outputs.iter().map(float_count).sum();
        let pixels = cases.len() * floats.div_ceil(FLOATS_PER_PIXEL);
        let default = Frame::default();
        Frame {
            size: [WIDTH.min(pixels) as u32, pixels.div_ceil(WIDTH) as u32],
            // The function may read it.
            resolution: Some(default.size),
            channels: std::array::from_fn(|at| (at == self.channel).then(|| texture.clone())),
            ..default
        }
    }
}

/// The declaration of a channel, for hosts whose shaders declare their textures, and the options of a text to
/// which [`ADDED_MAIN`] and it are added.
pub(super) fn added_main(text: &str, checked: &Checked, channel: usize) -> (String, glsl::Options) {
    let is_implicit = Dialect::calls_main_image(checked.dialect);
    let name = format!("iChannel{channel}");
    let is_missing = !is_implicit && !text.contains(&name);
    let options = glsl::Options {
        calls_added_main: true,
        lenient: checked.lenient || !is_implicit,
        ..checked.options()
    };
    let declared = if is_missing {
        format!("uniform sampler2D {name};\n")
    } else {
        String::new()
    };
    (declared, options)
}

/// The function that each pixel calls.
fn main(interface: &Interface, outputs: &[Component], channel: usize) -> String {
    let mut text = format!(
        "void {ADDED_MAIN}(out vec4 tpColor, in vec2 tpPlace) {{
    int tpPixel = int(tpPlace.y) * {WIDTH} + int(tpPlace.x);
    int tpCases = int(texelFetch(iChannel{channel}, ivec2(0), 0).x);
    int tpRow = tpPixel / tpCases;
"
    );
    let texels = interface
        .inputs
        .iter()
        .map(float_count)
        .sum::<usize>()
        .div_ceil(4);
    let _ = writeln!(
        text,
        "    int tpFirst = 1 + (tpPixel - tpRow * tpCases) * {texels};"
    );
    for at in 0..texels {
        let place = format!("ivec2((tpFirst + {at}) % {WIDTH}, (tpFirst + {at}) / {WIDTH})");
        let _ = writeln!(
            text,
            "    vec4 tpInput{at} = texelFetch(iChannel{channel}, {place}, 0);"
        );
    }
    for parameter in &interface.parameters {
        let _ = writeln!(text, "    {};", parameter.declaration);
    }
    let mut slots = (0..).map(|at| format!("tpInput{}.{}", at / 4, ["x", "y", "z", "w"][at % 4]));
    for component in &interface.inputs {
        let mut slot = || slots.next().unwrap_or_default();
        let value = match component.scalar {
            Scalar::Float => slot(),
            Scalar::Bool => format!("{} != 0.0", slot()),
            Scalar::Int => format!("int(uint({}) | uint({}) << 16u)", slot(), slot()),
            Scalar::Uint => format!("uint({}) | uint({}) << 16u", slot(), slot()),
        };
        let _ = writeln!(text, "    {} = {value};", component.code);
    }
    let arguments: Vec<_> = (0..interface.parameters.len())
        .map(|at| format!("tpArgument{at}"))
        .collect();
    let call = format!("{}({})", interface.name, arguments.join(", "));
    let _ = match &interface.result {
        Some(declaration) => writeln!(text, "    {declaration} = {call};"),
        None => writeln!(text, "    {call};"),
    };
    text += "    tpColor = vec4(0.0);\n";
    let floats: Vec<_> = outputs.iter().flat_map(to_floats).collect();
    for (row, floats) in floats.chunks(FLOATS_PER_PIXEL).enumerate() {
        let mut color = floats.to_vec();
        color.resize(4, "0.0".to_owned());
        let _ = writeln!(
            text,
            "    if (tpRow == {row}) tpColor = vec4({});",
            color.join(", ")
        );
    }
    text + "}\n"
}

// Integers are passed as two floats, which both number types represent exactly.

fn float_count(component: &Component) -> usize {
    match component.scalar {
        Scalar::Float | Scalar::Bool => 1,
        Scalar::Int | Scalar::Uint => 2,
    }
}

fn to_floats(component: &Component) -> Vec<String> {
    let code = &component.code;
    match component.scalar {
        Scalar::Float | Scalar::Bool => vec![format!("float({code})")],
        Scalar::Int | Scalar::Uint => vec![
            format!("float(uint({code}) & 65535u)"),
            format!("float(uint({code}) >> 16u)"),
        ],
    }
}

fn push_floats(scalar: Scalar, value: f64, floats: &mut Vec<f32>) {
    match scalar {
        Scalar::Float | Scalar::Bool => floats.push(value as f32),
        Scalar::Int | Scalar::Uint => {
            let bits = if scalar == Scalar::Int {
                (value as i32).cast_unsigned()
            } else {
                value as u32
            };
            floats.extend([(bits & 0xffff) as f32, (bits >> 16) as f32]);
        }
    }
}

fn value(scalar: Scalar, floats: &mut impl Iterator<Item = f64>) -> f64 {
    let mut next = || floats.next().unwrap_or(f64::NAN);
    match scalar {
        Scalar::Float | Scalar::Bool => next(),
        Scalar::Int | Scalar::Uint => {
            let bits = next() as u32 | (next() as u32) << 16;
            if scalar == Scalar::Int {
                f64::from(bits.cast_signed())
            } else {
                f64::from(bits)
            }
        }
    }
}
