//! What one question found, pixel by pixel.

use serde::{Deserialize, Serialize};
use toyproof_image::Image;

use super::Pixel;
use crate::compare::Mark;

/// How a pixel stands to what it is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// It agrees.
    Agrees,
    /// It differs, and another rounding of the same operations might not.
    Undecided,
    /// It differs, and so does the scene itself when its numbers are moved by less than a shader can know them: an edge passes
    /// through the pixel's sample.
    Tied,
    /// The shader does there what GLSL leaves undefined.
    Undefined,
    /// It differs.
    Differs,
}

/// The answer to a question, over the whole picture.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Pixels in the picture.
    pub pixels: u64,
    /// Pixels that differ.
    pub differing: u64,
    /// Pixels that differ, but hang by a hair in f64.
    pub undecided: u64,
    /// Those of the undecided that the scene does not decide, whatever the shader.
    #[serde(skip)]
    pub tied: u64,
    /// Pixels that are left out because the shader does there what GLSL leaves undefined.
    pub undefined: u64,
    /// The largest absolute difference of a component of colours clamped to [0, 1], over all pixels that are not undefined.
    pub max_abs: f64,
    /// The first differing pixel: lowest y, then lowest x; if none differs, the first undecided.
    pub first: Option<Pixel>,
    /// The one with the largest difference among those.
    pub worst: Option<Pixel>,
}

impl Answer {
    /// Sums up the standings of all pixels, bottom row first, of two pictures of one size.
    ///
    /// # Panics
    /// If the sizes differ.
    #[must_use]
    pub fn new(expected: &Image, actual: &Image, standings: &[Standing]) -> Self {
        assert_eq!(expected.size(), actual.size());
        assert_eq!(standings.len(), actual.pixels().len());
        let count = |standing| standings.iter().filter(|&&s| s == standing).count() as u64;
        let differing = count(Standing::Differs);
        let told = if differing > 0 {
            Standing::Differs
        } else {
            Standing::Undecided
        };
        let mut first = None;
        let mut worst: Option<(f64, Pixel)> = None;
        let mut max_abs = 0.0f64;
        for (index, &standing) in standings.iter().enumerate() {
            if standing == Standing::Undefined {
                continue;
            }
            let pixel = Pixel::at(index, expected, actual);
            let difference = pixel.difference();
            max_abs = max_abs.max(difference);
            if standing == told {
                first.get_or_insert(pixel);
                if worst.is_none_or(|(most, _)| difference > most) {
                    worst = Some((difference, pixel));
                }
            }
        }
        Self {
            pixels: standings.len() as u64,
            differing,
            undecided: count(Standing::Undecided) + count(Standing::Tied),
            tied: count(Standing::Tied),
            undefined: count(Standing::Undefined),
            max_abs,
            first,
            worst: worst.map(|(_, pixel)| pixel),
        }
    }

    /// Adds the answer for the rows above the first `height`, which this one is for.
    pub fn extend(&mut self, above: &Self, height: u32) {
        let raised = |pixel: Option<Pixel>| pixel.map(|pixel| pixel.raised(height));
        let (first, worst) = (raised(above.first), raised(above.worst));
        match (self.differing > 0, above.differing > 0) {
            (true, false) => {}
            (false, true) => (self.first, self.worst) = (first, worst),
            _ => {
                self.first = self.first.or(first);
                self.worst = Pixel::worse(self.worst, worst);
            }
        }
        self.pixels += above.pixels;
        self.differing += above.differing;
        self.undecided += above.undecided;
        self.tied += above.tied;
        self.undefined += above.undefined;
        self.max_abs = self.max_abs.max(above.max_abs);
    }

    /// What share of the pixels `count` is, in [0, 1].
    #[must_use]
    pub fn share(&self, count: u64) -> f64 {
        count as f64 / self.pixels.max(1) as f64
    }

    /// Whether no pixel differs, not even undecidedly.
    #[must_use]
    pub fn is_same(&self) -> bool {
        self.differing + self.undecided == 0
    }
}

/// What the picture of a question shows: its standings, and how much the pixels differ.
#[must_use]
pub fn marks(expected: &Image, actual: &Image, standings: &[Standing]) -> Vec<Mark> {
    let mark = |(index, standing): (usize, &Standing)| match standing {
        Standing::Undecided | Standing::Tied => Mark::UNDECIDED,
        Standing::Undefined => Mark::UNDEFINED,
        Standing::Agrees | Standing::Differs => {
            Mark::by(Pixel::at(index, expected, actual).difference() as f32)
        }
    };
    standings.iter().enumerate().map(mark).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(reds: &[f32]) -> Image {
        Image::new(
            reds.len() as u32,
            1,
            reds.iter().map(|&red| [red, 0.0, 0.0, 1.0]).collect(),
        )
    }

    #[test]
    fn undefined_pixels_count_nowhere_else() {
        use Standing::{Agrees, Differs, Undecided, Undefined};
        let (a, b) = (row(&[0.0; 5]), row(&[1.0, 0.0, 0.25, 0.5, 0.375]));
        let answer = Answer::new(&a, &b, &[Undefined, Agrees, Differs, Differs, Undecided]);
        assert_eq!(
            (
                answer.pixels,
                answer.differing,
                answer.undecided,
                answer.undefined
            ),
            (5, 2, 1, 1)
        );
        assert_eq!(answer.max_abs, 0.5);
        assert_eq!(answer.first.map(|pixel| pixel.x), Some(2));
        assert_eq!(answer.worst.map(|pixel| pixel.x), Some(3));
        assert!(!answer.is_same());
    }

    #[test]
    fn an_answer_in_bands_is_that_of_the_whole() {
        use Standing::{Agrees, Differs, Undecided, Undefined};
        let column = |reds: &[f32]| Image::new(1, reds.len() as u32, row(reds).pixels().to_vec());
        let reds = [0.9, 0.5, 0.2, 0.7, 0.7, 0.0];
        let all = [Undecided, Undefined, Differs, Undecided, Differs, Agrees];
        // One that differs is told rather than those below it that are undecided; without it, they are.
        for standings in [all, all.map(|own| if own == Differs { Undecided } else { own })] {
            let whole = Answer::new(&column(&[0.0; 6]), &column(&reds), &standings);
            for height in 0..=reds.len() {
                let part = |rows: std::ops::Range<usize>| {
                    let black = column(&[0.0; 6][rows.clone()]);
                    Answer::new(&black, &column(&reds[rows.clone()]), &standings[rows])
                };
                let mut answer = part(0..height);
                answer.extend(&part(height..reds.len()), height as u32);
                assert_eq!(answer, whole, "{height}");
            }
        }
    }

    #[test]
    fn the_first_undecided_pixel_is_told_where_none_differs() {
        use Standing::{Agrees, Undecided};
        let answer = Answer::new(&row(&[0.0; 2]), &row(&[0.0, 0.1]), &[Agrees, Undecided]);
        assert_eq!(answer.first.map(|pixel| pixel.x), Some(1));
        assert!(!answer.is_same() && answer.differing == 0);
    }
}
