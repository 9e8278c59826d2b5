//! Which pixels a derivative is the difference of.

use toyproof::gpu::{DrawOutput, Failure, Worker};
use toyproof::image::{Frame, Image};
use toyproof::translate::FloatMode;

use crate::checked;

/// Width and height in pixels.
const SIZE: u32 = 16;

/// The differentiated function of whole coordinates: all differences in a quad are different integers.
const SHADER: &str = "void mainImage(out vec4 color, in vec2 p) {
    vec2 q = floor(p);
    float f = q.x * q.x + 5.0 * q.x * q.y + 7.0 * q.y * q.y;
    color = vec4(dFdx(f), dFdy(f), fwidth(f), 1.0);
}";

fn value(x: u32, y: u32) -> f32 {
    (x * x + 5 * x * y + 7 * y * y) as f32
}

/// A pixel's row or column in its quad.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Line {
    Own,
    First,
    Second,
}

impl Line {
    const ALL: [Self; 3] = [Self::Own, Self::First, Self::Second];

    /// The coordinate, in quads that begin at even coordinates.
    fn of(self, coordinate: u32) -> u32 {
        match self {
            Self::Own => coordinate,
            Self::First => coordinate & !1,
            Self::Second => coordinate | 1,
        }
    }

    fn describe(self, line: &str) -> String {
        match self {
            Self::Own => format!("fine: of the pixel's own {line}"),
            Self::First => format!("coarse: of the quad's first {line}"),
            Self::Second => format!("coarse: of the quad's second {line}"),
        }
    }
}

/// Renders the derivatives on a driver.
///
/// # Errors
/// Why the driver rendered no image.
pub fn render(worker: &mut Worker, float: FloatMode) -> Result<Image, Failure> {
    let frame = Frame {
        size: [SIZE, SIZE],
        ..Frame::default()
    };
    let drawn = worker.draw_unwatched(float.lower(&checked(SHADER)), frame, float);
    drawn.map(DrawOutput::image)
}

/// The image of a device that takes the differences of the quad's lines with these numbers (0 or 1), or of
/// the pixel's own if there is none.
pub fn planted(line: Option<u32>, sign: f32) -> Image {
    let line = |coordinate: u32| line.map_or(coordinate, |line| coordinate & !1 | line);
    let pixel = |at: u32| {
        let (x, y) = (at % SIZE, at / SIZE);
        let (x0, y0) = (x & !1, y & !1);
        let dx = value(x0 + 1, line(y)) - value(x0, line(y));
        let dy = sign * (value(line(x), y0 + 1) - value(line(x), y0));
        [dx, dy, dx.abs() + dy.abs(), 1.0]
    };
    Image::new(SIZE, SIZE, (0..SIZE * SIZE).map(pixel).collect())
}

/// Which differences of quads of 2×2 pixels the derivatives of an image are, in one sentence.
pub fn describe(image: &Image) -> String {
    let holds = |component: usize, expected: &dyn Fn(u32, u32) -> f32| {
        let mut pixels = (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y)));
        pixels.all(|(x, y)| image.get(x, y)[component] == expected(x, y))
    };
    let find = |component: usize, difference: &dyn Fn(Line, u32, u32) -> f32, line: &str| {
        let candidates = Line::ALL.into_iter().flat_map(|line| [(line, 1.0), (line, -1.0)]);
        let mut found =
            candidates.filter(|&(line, sign)| holds(component, &|x, y| sign * difference(line, x, y)));
        match found.next() {
            Some((lines, 1.0)) => lines.describe(line),
            Some((lines, _)) => format!("{}, **with the opposite sign**", lines.describe(line)),
            None => "not a difference of an aligned quad of 2×2 pixels".to_owned(),
        }
    };
    let dx = |line: Line, x: u32, y: u32| {
        let (x, y) = (x & !1, line.of(y));
        value(x + 1, y) - value(x, y)
    };
    let dy = |line: Line, x: u32, y: u32| {
        let (x, y) = (line.of(x), y & !1);
        value(x, y + 1) - value(x, y)
    };
    let is_sum = holds(2, &|x, y| {
        let pixel = image.get(x, y);
        pixel[0].abs() + pixel[1].abs()
    });
    format!(
        "`dFdx` {}; `dFdy` {}; `fwidth` is {}",
        find(0, &dx, "row"),
        find(1, &dy, "column"),
        if is_sum {
            "the sum of both"
        } else {
            "**not** the sum of both"
        }
    )
}
