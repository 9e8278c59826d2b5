//! Is the algorithm right? The shader in f64 against the tracer in f64.

use rayon::prelude::*;

use super::{EXACT_TOLERANCE, Pixel, Standing};
use crate::image::Image;
use crate::trace::{Hull, Styles};

/// At most so often is the shader asked again with every operation moved by a unit in the last place. A pixel that
/// hangs by a hair falls to the other side every second time, so that one in 2⁸ such pixels is missed.
pub const SHAKES: u64 = 8;

/// The largest share of pixels that are asked again whether different rays of the shader have different styles. Where more
/// differ, it is not a matter of style: of the correct rewrites, the one whose rays differ most differs in 0.2 %.
const MAX_MIXED: f64 = 0.01;

/// How many pixels of a picture may still be asked that.
#[derive(Debug, Clone, Copy)]
pub struct Mixed {
    left: f64,
}

impl Mixed {
    /// Of a picture of so many pixels.
    #[must_use]
    pub fn of(pixels: u64) -> Self {
        Self {
            left: MAX_MIXED * pixels as f64,
        }
    }

    /// Whether so many more may be asked.
    fn take(&mut self, pixels: usize) -> bool {
        let is_enough = pixels as f64 <= self.left;
        if is_enough {
            self.left -= pixels as f64;
        }
        is_enough
    }
}

/// Compares a band of the shader in f64, `actual`, with the tracer in f64, `expected`, bottom row first; places are in the band.
///
/// A pixel agrees if no component is farther than [`EXACT_TOLERANCE`] from the hull of the answers that the tracer gives in
/// the legal styles of secondary rays; `hull` is asked only where the exact answer does not agree, and for `mixed` styles
/// only if few pixels differ still. A pixel outside of it is left
/// out if it lies on an `edge` across which the shader takes derivatives: what they are there, GLSL leaves to the driver. Else it
/// is undecided if the shader's own answer moves by more than that in one of the pictures that `shaken` paints, given a
/// seed and which pixels are wanted, with every operation perturbed (Vignes, "A stochastic arithmetic for reliable scientific computation", 1993);
/// it is asked only if something differs, and may give up.
///
/// # Panics
/// If the sizes differ.
pub fn maths(
    expected: &Image,
    actual: &Image,
    undefined: &[bool],
    hull: impl Fn(u32, u32, Styles) -> Hull + Sync,
    edge: impl Fn(u32, u32) -> bool,
    mixed: &mut Mixed,
    mut shaken: impl FnMut(u64, &[bool]) -> Option<Image>,
) -> Vec<Standing> {
    assert_eq!(expected.size(), actual.size());
    let is_within = |pixel: &Pixel, styles| {
        let hull = hull(pixel.x, pixel.y, styles);
        hull.distance(pixel.actual.map(f64::from)) <= EXACT_TOLERANCE
    };
    let mut standings: Vec<_> = undefined
        .par_iter()
        .enumerate()
        .map(|(index, &undefined)| {
            if undefined {
                return Standing::Undefined;
            }
            let pixel = Pixel::at(index, expected, actual);
            if pixel.difference() <= EXACT_TOLERANCE || is_within(&pixel, Styles::Alike) {
                Standing::Agrees
            } else {
                Standing::Differs
            }
        })
        .collect();
    let differing = standings
        .iter()
        .filter(|&&standing| standing == Standing::Differs)
        .count();
    if mixed.take(differing) {
        standings
            .par_iter_mut()
            .enumerate()
            .for_each(|(index, standing)| {
                if *standing == Standing::Differs
                    && is_within(&Pixel::at(index, expected, actual), Styles::Mixed)
                {
                    *standing = Standing::Agrees;
                }
            });
    }
    for (index, standing) in standings.iter_mut().enumerate() {
        let pixel = Pixel::at(index, expected, actual);
        if *standing == Standing::Differs && edge(pixel.x, pixel.y) {
            *standing = Standing::Undefined;
        }
    }
    // Two pictures in which no differing pixel moves say that what is left is decided.
    let mut in_vain = 0;
    for seed in 0..SHAKES {
        let wanted: Vec<_> = standings.iter().map(|&own| own == Standing::Differs).collect();
        if in_vain == 2 || !wanted.contains(&true) {
            break;
        }
        let Some(shaken) = shaken(seed, &wanted) else {
            break;
        };
        let mut moved = false;
        for (index, standing) in standings.iter_mut().enumerate() {
            if *standing == Standing::Differs
                && Pixel::at(index, actual, &shaken).difference() > EXACT_TOLERANCE
            {
                *standing = Standing::Undecided;
                moved = true;
            }
        }
        in_vain = if moved { 0 } else { in_vain + 1 };
    }
    standings
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

    fn point(red: f64) -> Hull {
        Hull {
            low: [red, 0.0, 0.0],
            high: [red, 0.0, 0.0],
        }
    }

    /// No pixel lies on an edge.
    fn inside(_: u32, _: u32) -> bool {
        false
    }

    #[test]
    fn what_differs_on_an_edge_is_left_out_and_what_agrees_there_is_not() {
        let (expected, actual) = (row(&[0.0; 3]), row(&[0.0, 0.3, 0.3]));
        let edge = |x, _| x < 2;
        let standings = maths(
            &expected,
            &actual,
            &[false; 3],
            |_, _, _| point(0.0),
            edge,
            &mut Mixed::of(3),
            |_, _| None,
        );
        assert_eq!(
            standings,
            [Standing::Agrees, Standing::Undefined, Standing::Differs]
        );
    }

    #[test]
    fn what_lies_in_the_hull_agrees_and_what_moves_is_undecided() {
        let expected = row(&[0.0; 5]);
        let actual = row(&[0.00009, 0.3, 0.3, 0.3, 0.3]);
        let hull = |x, _, _| Hull {
            high: [if x == 1 { 0.29995 } else { 0.0 }, 0.0, 0.0],
            ..point(0.0)
        };
        let undefined = [false, false, false, false, true];
        let moving =
            |seed, _: &[bool]| Some(row(&[0.0, 0.0, if seed == 1 { 0.0 } else { 0.3 }, 0.30005, 0.3]));
        let mixed = &mut Mixed::of(5);
        let standings = maths(&expected, &actual, &undefined, hull, inside, mixed, moving);
        assert_eq!(
            standings,
            [
                Standing::Agrees,
                Standing::Agrees,
                Standing::Undecided,
                Standing::Differs,
                Standing::Undefined
            ]
        );
    }

    #[test]
    fn mixed_styles_are_asked_for_where_few_pixels_differ() {
        let mut mixed = Mixed::of(2000);
        let mut judged = |differing: usize| {
            let black = row(&[0.0; 1000]);
            let mut reds = [0.0; 1000];
            reds[..differing].fill(0.3);
            let hull = |_, _, styles| match styles {
                Styles::Alike => point(0.0),
                Styles::Mixed => point(0.3),
            };
            let (actual, undefined) = (row(&reds), [false; 1000]);
            let standings = maths(&black, &actual, &undefined, hull, inside, &mut mixed, |_, _| None);
            let differs = |standing: &&Standing| **standing == Standing::Differs;
            standings.iter().filter(differs).count()
        };
        assert_eq!(judged(21), 21, "so many are no matter of style");
        assert_eq!(judged(15), 0);
        assert_eq!(judged(6), 6, "nor are they with those of another band");
        assert_eq!(judged(5), 0);
    }

    #[test]
    fn nothing_is_shaken_without_need_nor_for_ever() {
        let black = row(&[0.0]);
        let mut asked = 0;
        let mut count = |_, _: &[bool]| {
            asked += 1;
            Some(row(&[1.0]))
        };
        let mixed = &mut Mixed::of(1);
        let hull = |_, _, _| point(0.0);
        maths(&black, &black, &[false], hull, inside, mixed, &mut count);
        assert_eq!(asked, 0, "nothing differs");
        let mut asked = 0;
        let still = |_, wanted: &[bool]| {
            assert_eq!(wanted, [true]);
            asked += 1;
            Some(row(&[1.0]))
        };
        let standings = maths(&black, &row(&[1.0]), &[false], hull, inside, mixed, still);
        assert_eq!((asked, standings), (2, vec![Standing::Differs]));
    }

    #[test]
    fn nan_is_no_colour_that_a_scene_has() {
        let standings = maths(
            &row(&[0.0]),
            &row(&[f32::NAN]),
            &[false],
            |_, _, _| point(0.0),
            inside,
            &mut Mixed::of(1),
            |_, _| None,
        );
        assert_eq!(standings, [Standing::Differs]);
    }
}
