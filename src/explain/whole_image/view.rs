//! Shaders evaluated at other positions: mirrored, rotated, and with other screen coordinates.

use toyproof_eval::Places;
use toyproof_image::Image;
use toyproof_verify::Difference;

use super::Alternative;
use super::submission::{Axis, Submission, View, pixels_of};
use crate::known::KnownMistake;

// Symmetries.

/// The symmetries of a rectangle, of one kind. Rotations by 90° either keep shapes or stretch the image to
/// the frame.
pub(super) fn symmetries(submission: &Submission, difference: Difference) -> Vec<(View, KnownMistake)> {
    let [width, height] = submission.size();
    let frame = submission.frame();
    let reversed = [width, height].map(|length| Axis::scaled(-1.0, 0.0, length));
    let named = |view, text: &'static str| (view, KnownMistake::new(difference.id(), text));
    match difference {
        Difference::MirroredX => vec![named(View::moved(frame, [reversed[0], Axis::SAME]), MIRRORED_X)],
        Difference::MirroredY => vec![named(View::moved(frame, [Axis::SAME, reversed[1]]), MIRRORED_Y)],
        _ => {
            let transpositions = TRANSPOSITIONS.iter().flat_map(|&(signs, text)| {
                // Shapes are kept where both axes have one scale, and distorted where the image is stretched.
                [[1.0, 1.0], [width / height, height / width]].map(|scales| {
                    let x = Axis::scaled(signs[0] * scales[0], 0.5 * height, 0.5 * width);
                    let y = Axis::scaled(signs[1] * scales[1], 0.5 * width, 0.5 * height);
                    named(View::moved(frame, [x, y]).transposed(), text)
                })
            });
            std::iter::once(named(View::moved(frame, reversed), HALF_TURN))
                .chain(transpositions)
                .collect()
        }
    }
}

const MIRRORED_X: &str = "the image is mirrored: left and right are exchanged";
const MIRRORED_Y: &str = "the image is upside down: y is negated, or counted from the top";
const HALF_TURN: &str = "the image is rotated by 180°: x and y are negated";

/// The signs of x as a function of y and of y as a function of x, at which the shader is evaluated.
const TRANSPOSITIONS: [([f64; 2], &str); 4] = [
    ([1.0, 1.0], "x and y are exchanged"),
    ([-1.0, -1.0], "x and y are exchanged and negated"),
    ([-1.0, 1.0], "the image is rotated by 90° counter-clockwise"),
    ([1.0, -1.0], "the image is rotated by 90° clockwise"),
];

// Framing.

/// The largest numbers of columns and rows of pixels at which framings are tried.
const FRAMING_PROBES: [u32; 2] = [10, 8];

/// The largest number of framings that are tried on the whole image.
const MAX_CONFIRMED: usize = 3;

/// A convention for a screen coordinate, relative to the reference's.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Convention {
    /// The factor of the coordinate.
    factor: Factor,
    /// Whether the coordinate is 0 in the lower left corner, as `fragCoord` is, and not in the center.
    is_from_corner: bool,
    /// The shift of `fragCoord`, in pixels.
    shift: f64,
}

/// A power of 2 times a power of the aspect ratio.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Factor {
    /// The exponent of 2.
    two: i32,
    /// The exponent of the aspect ratio.
    aspect: i32,
}

impl Factor {
    const ONE: Self = Self { two: 0, aspect: 0 };

    fn value(self, aspect: f64) -> f64 {
        2.0_f64.powi(self.two) * aspect.powi(self.aspect)
    }

    fn text(self) -> String {
        let two = match self.two {
            1 => "2",
            -1 => "½",
            _ => "",
        };
        match self.aspect {
            1 => [two, "the aspect ratio"].join(if two.is_empty() { "" } else { " · " }),
            -1 => format!("{} / the aspect ratio", if two.is_empty() { "1" } else { two }),
            _ => two.to_owned(),
        }
    }
}

impl Convention {
    const SAME: Self = Self {
        factor: Factor::ONE,
        is_from_corner: false,
        shift: 0.0,
    };

    /// The usual conventions, without the reference's own.
    fn all() -> Vec<Self> {
        let factors = [0, 1, -1]
            .into_iter()
            .flat_map(|aspect| [0, 1, -1].into_iter().map(move |two| Factor { two, aspect }));
        let scaled = factors.flat_map(|factor| {
            [false, true].map(|is_from_corner| Self {
                factor,
                is_from_corner,
                shift: 0.0,
            })
        });
        let shifted = [-1.0, -0.5, 0.5, 1.0]
            .into_iter()
            .map(|shift| Self { shift, ..Self::SAME });
        scaled.chain(shifted).filter(|&own| own != Self::SAME).collect()
    }

    /// The position at which a shader with this convention has the reference's coordinate, on an axis of that
    /// length.
    fn axis(self, length: f64, aspect: f64) -> Axis {
        let center = 0.5 * length;
        let to = if self.is_from_corner { 0.0 } else { center };
        Axis::scaled(self.factor.value(aspect).recip(), center, to - self.shift)
    }
}

/// Finds the conventions for x and y under which the image is right. All pairs of them are tried in one
/// evaluation: the columns are those of all conventions for x, the rows those of all for y.
pub(super) fn framing(submission: &Submission) -> Option<Alternative> {
    let (frame, [width, height]) = (submission.frame(), submission.size());
    let aspect = width / height;
    let mut conventions = vec![Convention::SAME];
    conventions.extend(Convention::all());
    let probes = Places::spread(frame.size, FRAMING_PROBES);
    let along = |coordinates: &[f64], length: f64| -> Vec<f64> {
        let axes = conventions
            .iter()
            .map(|convention| convention.axis(length, aspect));
        axes.flat_map(|axis| axis.along(coordinates)).collect()
    };
    let all = Places {
        columns: along(&probes.columns, width),
        rows: along(&probes.rows, height),
    };
    let image = submission.evaluate(frame, &all)?;
    let expected = pixels_of(&submission.reference, &probes);
    let [columns, rows] = probes.size();
    let agrees = |x: usize, y: usize| {
        let pixels = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
        let pixels =
            pixels.map(|[column, row]| image.get(x as u32 * columns + column, y as u32 * rows + row));
        let part = Image::new(columns, rows, pixels.collect());
        submission.agree(&probes, &expected, &part)
    };
    // Of several, the first has one convention for both axes, or the reference's own for one.
    let count = conventions.len();
    let pairs = (1..count).map(|both| [both, both]);
    let pairs = pairs.chain((1..count).flat_map(|one| [[one, 0], [0, one]]));
    let others = (1..count).flat_map(|x| (1..count).map(move |y| [x, y]));
    let pairs = pairs.chain(others.filter(|[x, y]| x != y));
    let matching = pairs.filter(|&[x, y]| agrees(x, y)).take(MAX_CONFIRMED);
    matching.into_iter().find_map(|pair| {
        let [x, y] = pair.map(|at| conventions[at]);
        let view = View::moved(frame, [x.axis(width, aspect), y.axis(height, aspect)]);
        let mistake = KnownMistake::new(Difference::Framing.id(), description(x, y));
        submission.confirmed(&view, (submission.expected(), frame), mistake)
    })
}

fn description(x: Convention, y: Convention) -> String {
    let is_centered = !x.is_from_corner && !y.is_from_corner;
    if x == y && is_centered && x.shift == 0.0 {
        match x.factor {
            Factor { two: 0, aspect: 1 } => {
                return "screen coordinates are divided by `iResolution.y` instead of `iResolution.x`"
                    .to_owned();
            }
            Factor { two: 0, aspect: -1 } => {
                return "screen coordinates are divided by `iResolution.x` instead of `iResolution.y`"
                    .to_owned();
            }
            Factor { two, aspect: 0 } => {
                let size = if two > 0 { "half" } else { "twice" };
                return format!(
                    "the image is {size} as large as expected: screen coordinates are multiplied by {}, or the screen's \
                     distance or the width of the projection is wrong by this factor",
                    x.factor.text()
                );
            }
            _ => {}
        }
    }
    let one = |name: &str, convention: Convention| {
        let mut parts = Vec::new();
        if convention.factor != Factor::ONE {
            parts.push(format!("{name} is multiplied by {}", convention.factor.text()));
        }
        if convention.is_from_corner {
            parts.push(format!("{name} is 0 at the edge instead of the center"));
        }
        if convention.shift != 0.0 {
            parts.push(format!("{name} is shifted by {} pixels", convention.shift));
        }
        parts
    };
    let parts = if x == y {
        one("each of x and y", x)
    } else {
        [one("x", x), one("y", y)].concat()
    };
    format!(
        "screen coordinates differ from the reference's: {}",
        parts.join(", and ")
    )
}

/// The descriptions of all kinds of differences here, as examples.
#[cfg(test)]
pub(super) fn examples() -> Vec<KnownMistake> {
    let framing = Convention::all().into_iter().flat_map(|x| {
        let y = Convention {
            is_from_corner: true,
            ..Convention::SAME
        };
        [description(x, x), description(x, y)]
    });
    let framing = framing.map(|text| KnownMistake::new(Difference::Framing.id(), text));
    let rotated = TRANSPOSITIONS.iter().map(|&(_, text)| text).chain([HALF_TURN]);
    let rotated = rotated.map(|text| KnownMistake::new(Difference::Rotated.id(), text));
    let mirrored = [
        KnownMistake::new(Difference::MirroredX.id(), MIRRORED_X),
        KnownMistake::new(Difference::MirroredY.id(), MIRRORED_Y),
    ];
    framing.chain(rotated).chain(mirrored).collect()
}
