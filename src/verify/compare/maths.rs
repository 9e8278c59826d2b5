//! Is the algorithm right? The shader in f64 against the tracer in f64.

use rayon::prelude::*;
use toyproof_image::Image;
use toyproof_tracer::{Hull, RayStyles, StyleFamily, Styles};

use super::fit::{self, Fitted};
use super::{EXACT_TOLERANCE, Pixel, Standing};

/// At most so often is the shader asked again with every operation moved by a unit in the last place. A pixel that
/// hangs by a hair falls to the other side every second time, so that one in 2⁸ such pixels is missed.
pub const SHAKES: u64 = 8;

/// The largest share of pixels that are asked again whether different rays of the shader have different styles. Where more
/// differ, it is not a matter of style: of the correct rewrites, the one whose rays differ most differs in 0.2 %.
const MAX_MIXED: f64 = 0.01;

/// The largest share of a band's pixels that are asked whether an edge of the scene passes through them: rows and columns along which a
/// scene of round numbers has edges are fewer.
const MAX_TIED: f64 = 0.05;

/// What a shader is compared with. Places are in the band.
pub trait Reference: Sync {
    /// The colors of a pixel in a few of the legal styles of secondary rays.
    fn hull(&self, x: u32, y: u32, styles: Styles) -> Hull;
    /// All styles that a shader may have.
    fn families(&self) -> &[StyleFamily];
    /// The color of a pixel in these styles.
    fn styled(&self, x: u32, y: u32, styles: &RayStyles) -> [f64; 3];
    /// How many samples a pixel takes: as much more work it is.
    fn samples(&self) -> u32;
    /// Whether the shader takes derivatives, and the pixel's quad lies across an edge.
    fn is_across_edge(&self, x: u32, y: u32) -> bool;
    /// Whether the reference itself has another color there when the scene's numbers are moved by less than a shader can know them.
    fn is_tied(&self, x: u32, y: u32) -> bool;
}

/// What is known from one band to the next: how many pixels of a picture may still be asked for the styles of their rays, and which styles
/// the shader was found to have.
#[derive(Debug, Clone, Copy)]
pub struct Mixed {
    left: f64,
    /// The pixels that may be asked one by one for all styles.
    left_for_each: f64,
    fitted: Option<Fitted>,
}

impl Mixed {
    /// Of a picture of so many pixels.
    #[must_use]
    pub fn of(pixels: u64) -> Self {
        Self {
            left: MAX_MIXED * pixels as f64,
            left_for_each: MAX_MIXED * pixels as f64,
            fitted: None,
        }
    }

    /// The styles of the shader's secondary rays, where they were found.
    #[must_use]
    pub fn styles(&self) -> Option<RayStyles> {
        self.fitted.map(|fitted| fitted.styles)
    }
}

/// Whether so many more may be asked.
fn take(left: &mut f64, pixels: usize) -> bool {
    let is_enough = pixels as f64 <= *left;
    if is_enough {
        *left -= pixels as f64;
    }
    is_enough
}

/// Compares a band of the shader in f64, `actual`, with the tracer in f64, `expected`, bottom row first; places are in the band.
///
/// A pixel agrees if no component is farther than [`EXACT_TOLERANCE`] from the hull of the answers that the tracer gives in
/// the legal styles of secondary rays. More styles are asked for only where pixels are still outside: `mixed` ones if few are, then the
/// shader's own, which a few of the pixels tell (`fit`), then all that authors use, in each pixel by itself.
/// A pixel outside of all is left
/// out if it lies on an edge across which the shader takes derivatives: what they are there, GLSL leaves to the driver. It is left out, too, if
/// the reference itself is ill-conditioned there: an edge of the scene passes through the pixel's sample. Else it
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
    reference: &impl Reference,
    mixed: &mut Mixed,
    mut shaken: impl FnMut(u64, &[bool]) -> Option<Image>,
) -> Vec<Standing> {
    assert_eq!(expected.size(), actual.size());
    let is_within = |pixel: &Pixel, styles| {
        let hull = reference.hull(pixel.x, pixel.y, styles);
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
    let becomes = |standings: &mut [Standing], other, is_other: &(dyn Fn(&Pixel) -> bool + Sync)| {
        standings
            .par_iter_mut()
            .enumerate()
            .for_each(|(index, standing)| {
                if *standing == Standing::Differs && is_other(&Pixel::at(index, expected, actual)) {
                    *standing = other;
                }
            });
    };
    if take(&mut mixed.left, differing(&standings)) {
        becomes(&mut standings, Standing::Agrees, &|pixel| {
            is_within(pixel, Styles::Mixed)
        });
    }
    if differing(&standings) > 0 {
        let left = standings.iter().enumerate();
        let left = left.filter(|&(_, &standing)| standing == Standing::Differs);
        let left: Vec<Pixel> = left
            .map(|(index, _)| Pixel::at(index, expected, actual))
            .collect();
        mixed.fitted = fit::fitted(reference, &left, mixed.fitted);
        if let Some(fitted) = mixed.fitted {
            becomes(&mut standings, Standing::Agrees, &|pixel| {
                fit::is_in(reference, pixel, &fitted.styles)
            });
        }
    }
    let count = differing(&standings);
    if count > 0 && fit::is_affordable(reference, count) && take(&mut mixed.left_for_each, count) {
        becomes(&mut standings, Standing::Agrees, &|pixel| {
            fit::is_in_any(reference, pixel)
        });
    }
    for (index, standing) in standings.iter_mut().enumerate() {
        let pixel = Pixel::at(index, expected, actual);
        if *standing == Standing::Differs && reference.is_across_edge(pixel.x, pixel.y) {
            *standing = Standing::Undefined;
        }
    }
    if differing(&standings) as f64 <= MAX_TIED * standings.len() as f64 {
        becomes(&mut standings, Standing::Tied, &|pixel| {
            reference.is_tied(pixel.x, pixel.y)
        });
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

fn differing(standings: &[Standing]) -> usize {
    let differs = |standing: &&Standing| **standing == Standing::Differs;
    standings.iter().filter(differs).count()
}

#[cfg(test)]
mod tests {
    use toyproof_tracer::RayStyle;

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

    /// A black scene.
    struct Black<H> {
        /// Of (x, styles).
        hull: H,
        /// Where the shader takes derivatives across an edge.
        edge: fn(u32) -> bool,
        tied: fn(u32) -> bool,
        families: Vec<StyleFamily>,
        /// Of (x, the offset).
        styled: fn(u32, f64) -> f64,
    }

    fn black<H: Fn(u32, Styles) -> Hull + Sync>(hull: H) -> Black<H> {
        Black {
            hull,
            edge: |_| false,
            tied: |_| false,
            families: Vec::new(),
            styled: |_, _| 0.0,
        }
    }

    impl<H: Fn(u32, Styles) -> Hull + Sync> Reference for Black<H> {
        fn hull(&self, x: u32, _: u32, styles: Styles) -> Hull {
            (self.hull)(x, styles)
        }
        fn families(&self) -> &[StyleFamily] {
            &self.families
        }
        fn styled(&self, x: u32, _: u32, styles: &RayStyles) -> [f64; 3] {
            [(self.styled)(x, styles.other.offset), 0.0, 0.0]
        }
        fn samples(&self) -> u32 {
            1
        }
        fn is_across_edge(&self, x: u32, _: u32) -> bool {
            (self.edge)(x)
        }
        fn is_tied(&self, x: u32, _: u32) -> bool {
            (self.tied)(x)
        }
    }

    #[test]
    fn what_differs_on_an_edge_is_left_out_and_what_agrees_there_is_not() {
        let (expected, actual) = (row(&[0.0; 3]), row(&[0.0, 0.3, 0.3]));
        let reference = Black {
            edge: |x| x < 2,
            ..black(|_, _| point(0.0))
        };
        let standings = maths(
            &expected,
            &actual,
            &[false; 3],
            &reference,
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
        let hull = |x, _| Hull {
            high: [if x == 1 { 0.29995 } else { 0.0 }, 0.0, 0.0],
            ..point(0.0)
        };
        let undefined = [false, false, false, false, true];
        let moving =
            |seed, _: &[bool]| Some(row(&[0.0, 0.0, if seed == 1 { 0.0 } else { 0.3 }, 0.30005, 0.3]));
        let mixed = &mut Mixed::of(5);
        let standings = maths(&expected, &actual, &undefined, &black(hull), mixed, moving);
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
            let none = row(&[0.0; 1000]);
            let mut reds = [0.0; 1000];
            reds[..differing].fill(0.3);
            let hull = |_, styles| match styles {
                Styles::Alike => point(0.0),
                Styles::Mixed => point(0.3),
            };
            let (actual, undefined) = (row(&reds), [false; 1000]);
            let standings = maths(&none, &actual, &undefined, &black(hull), &mut mixed, |_, _| None);
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
        let none = row(&[0.0]);
        let mut asked = 0;
        let mut count = |_, _: &[bool]| {
            asked += 1;
            Some(row(&[1.0]))
        };
        let mixed = &mut Mixed::of(1);
        let reference = black(|_, _| point(0.0));
        maths(&none, &none, &[false], &reference, mixed, &mut count);
        assert_eq!(asked, 0, "nothing differs");
        let mut asked = 0;
        let still = |_, wanted: &[bool]| {
            assert_eq!(wanted, [true]);
            asked += 1;
            Some(row(&[1.0]))
        };
        let standings = maths(&none, &row(&[1.0]), &[false], &reference, mixed, still);
        assert_eq!((asked, standings), (2, vec![Standing::Differs]));
    }

    #[test]
    fn nan_is_no_colour_that_a_scene_has() {
        let standings = maths(
            &row(&[0.0]),
            &row(&[f32::NAN]),
            &[false],
            &black(|_, _| point(0.0)),
            &mut Mixed::of(1),
            |_, _| None,
        );
        assert_eq!(standings, [Standing::Differs]);
    }

    /// Offsets up to 1, whose lengths the tests take for colors.
    fn offsets() -> Vec<StyleFamily> {
        let style = |offset| RayStyle {
            offset,
            ..RayStyle::default()
        };
        vec![(0..=10).map(|tenths| style(f64::from(tenths) / 10.0)).collect()]
    }

    #[test]
    fn a_style_that_explains_many_pixels_is_found_and_explains_them_all() {
        // Every color comes of an offset of 0.7, and would come of no other.
        let reference = Black {
            families: offsets(),
            styled: |x, offset| (offset * f64::from(x % 7 + 1)).sin().abs(),
            ..black(|_, _| point(0.0))
        };
        let reds: Vec<f32> = (0..1000u32)
            .map(|x| (0.7 * f64::from(x % 7 + 1)).sin().abs() as f32)
            .collect();
        let expected = row(&[0.0; 1000]);
        let mixed = &mut Mixed::of(1000);
        let standings = maths(
            &expected,
            &row(&reds),
            &[false; 1000],
            &reference,
            mixed,
            |_, _| None,
        );
        assert!(standings.iter().all(|&standing| standing == Standing::Agrees));
        assert_eq!(mixed.styles().map(|styles| styles.other.offset), Some(0.7));
        // What no offset explains is wrong, however many others are explained.
        let mut reds = reds;
        reds[500] = f32::NAN;
        let mixed = &mut Mixed::of(1000);
        let standings = maths(
            &expected,
            &row(&reds),
            &[false; 1000],
            &reference,
            mixed,
            |_, _| None,
        );
        assert_eq!(differing(&standings), 1);
    }

    #[test]
    fn a_color_between_those_of_neighboring_offsets_agrees_where_few_pixels_differ() {
        // Brightest at an offset of one half, black at both ends.
        let reference = Black {
            families: offsets(),
            styled: |_, offset| offset * (1.0 - offset),
            ..black(|_, _| point(0.0))
        };
        let mut reds = [0.0; 1000];
        // At an offset of 0.33, and brighter than at any.
        (reds[3], reds[4]) = (0.2211, 0.26);
        let expected = row(&[0.0; 1000]);
        let standings = maths(
            &expected,
            &row(&reds),
            &[false; 1000],
            &reference,
            &mut Mixed::of(1000),
            |_, _| None,
        );
        assert_eq!(standings[3..5], [Standing::Agrees, Standing::Differs]);
    }

    #[test]
    fn what_the_scene_itself_does_not_decide_is_left_out() {
        let reference = Black {
            tied: |x| x % 2 == 0,
            ..black(|_, _| point(0.0))
        };
        let mut reds = [0.0; 100];
        reds[..3].fill(0.5);
        let mixed = &mut Mixed::of(100);
        let standings = maths(
            &row(&[0.0; 100]),
            &row(&reds),
            &[false; 100],
            &reference,
            mixed,
            |_, _| None,
        );
        assert_eq!(
            standings[..4],
            [
                Standing::Tied,
                Standing::Differs,
                Standing::Tied,
                Standing::Agrees
            ]
        );
        // Where most pixels differ, it is not asked: no scene is like that.
        reds.fill(0.5);
        let mixed = &mut Mixed::of(100);
        let standings = maths(
            &row(&[0.0; 100]),
            &row(&reds),
            &[false; 100],
            &reference,
            mixed,
            |_, _| None,
        );
        assert!(!standings.contains(&Standing::Tied));
    }
}
