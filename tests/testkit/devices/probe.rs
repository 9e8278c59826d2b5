//! Expressions evaluated by a driver: operands and results are exchanged as bits, so that neither textures
//! nor the color target change a denormal, the sign of a zero or NaN.

use std::fmt::Write;

use toyproof::gpu::{DrawOutput, Failure, Worker};
use toyproof::image::{Frame, Image, Texture};
use toyproof::translate::FloatMode;

use crate::checked;

/// The names of the operands in expressions.
const NAMES: [&str; 6] = ["x", "y", "z", "u", "v", "w"];

/// The width of the image, in cases.
const WIDTH: usize = 256;

/// An evaluation of an expression.
#[derive(Debug, Clone)]
pub struct Case {
    /// The number of the expression.
    pub expression: usize,
    /// The bits of `x`, `y`, `z`, `u`, `v` and `w`, as far as the expression has them.
    pub operands: Vec<u32>,
}

/// Expressions, and the operands for which they are evaluated, all in one image.
#[derive(Debug, Clone)]
pub struct Probe {
    /// GLSL expressions of the type `uint`.
    pub expressions: Vec<String>,
    /// The cases, one for each pixel.
    pub cases: Vec<Case>,
}

impl Probe {
    /// A probe of one expression of the type `float`.
    pub fn of_float(expression: &str, arguments: &[Vec<f32>]) -> Self {
        let case = |operands: &Vec<f32>| Case {
            expression: 0,
            operands: operands.iter().map(|operand| operand.to_bits()).collect(),
        };
        Self {
            expressions: vec![format!("floatBitsToUint({expression})")],
            cases: arguments.iter().map(case).collect(),
        }
    }

    /// The shader, which reads the operands of its pixel.
    fn shader(&self) -> String {
        let mut text = "float operand(vec2 halves) {
    return uintBitsToFloat(uint(halves.x) | uint(halves.y) << 16);
}
uint result(int expression, float x, float y, float z, float u, float v, float w) {
"
        .to_owned();
        for (number, expression) in self.expressions.iter().enumerate() {
            let _ = writeln!(text, "    if (expression == {number}) return {expression};");
        }
        text + "    return 0u;
}
void mainImage(out vec4 color, in vec2 p) {
    ivec2 at = ivec2(p);
    vec4 a = texelFetch(iChannel0, at, 0), b = texelFetch(iChannel1, at, 0), c = texelFetch(iChannel2, at, 0);
    int expression = int(texelFetch(iChannel3, at, 0).x);
    uint bits = result(expression, operand(a.xy), operand(a.zw), operand(b.xy), operand(b.zw), operand(c.xy),
        operand(c.zw));
    color = vec4(float(bits & 65535u), float(bits >> 16), 0.0, 1.0);
}
"
    }

    /// The frame whose channels hold the operands.
    fn frame(&self) -> Frame {
        let width = self.cases.len().clamp(1, WIDTH);
        let height = self.cases.len().div_ceil(width).max(1);
        let channel = |texel: &dyn Fn(&Case) -> [f32; 4]| {
            let mut texels: Vec<_> = self.cases.iter().map(texel).collect();
            texels.resize(width * height, [0.0; 4]);
            Some(Texture::from(Image::new(width as u32, height as u32, texels)))
        };
        let operands = |first: usize| {
            channel(&move |case: &Case| {
                let halves = |number: usize| {
                    let bits = case.operands.get(number).copied().unwrap_or(0);
                    [(bits & 0xffff) as f32, (bits >> 16) as f32]
                };
                let ([a, b], [c, d]) = (halves(first), halves(first + 1));
                [a, b, c, d]
            })
        };
        Frame {
            size: [width as u32, height as u32],
            channels: [
                operands(0),
                operands(2),
                operands(4),
                channel(&|case| [case.expression as f32, 0.0, 0.0, 0.0]),
            ],
            ..Frame::default()
        }
    }

    /// The bits of the results on a driver, one for each case.
    ///
    /// # Errors
    /// Why the driver rendered no image.
    ///
    /// # Panics
    /// If an expression is invalid, or has more operands than there are.
    pub fn run(&self, worker: &mut Worker, float: FloatMode) -> Result<Vec<u32>, Failure> {
        let fits = |case: &Case| case.operands.len() <= NAMES.len();
        assert!(self.cases.iter().all(fits), "there are six operands");
        let shader = checked(&self.shader());
        let drawn = worker.draw_unwatched(float.lower(&shader), self.frame(), float);
        let image = drawn.map(DrawOutput::image)?;
        let bits = |pixel: &[f32; 4]| pixel[0] as u32 | (pixel[1] as u32) << 16;
        Ok(image.pixels().iter().take(self.cases.len()).map(bits).collect())
    }
}
