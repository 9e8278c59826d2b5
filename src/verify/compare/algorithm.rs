//! The algorithm check: the shader in f64 against the reference in f64.

use rayon::prelude::*;
use toyproof_image::Image;
use toyproof_tracer::{ColorRange, EpsilonFamily, EpsilonSet, RayEpsilon, RayEpsilons};

use crate::compare::{EXACT_TOLERANCE, Pixel, PixelStatus};

/// The largest number of perturbed evaluations. A perturbation changes an ill-conditioned pixel with a
/// probability of 1/2, so one in 2⁸ such pixels is missed.
pub const PERTURBATIONS: u64 = 8;

/// The largest share of pixels that are compared with mixed ray epsilons. If more pixels differ, ray
/// epsilons are not the cause: of the correct rewrites, the one whose epsilons differ most differs in 0.2 %.
const MAX_MIXED_SHARE: f64 = 0.01;

/// The reference of a shader in a band. Coordinates are in the band.
pub trait Reference: Sync {
    /// The largest difference of a component of colors that agree.
    fn tolerance(&self) -> f64;
    /// Accepts colors that the reference has for other ray epsilons than its own.
    fn accept_epsilons(&self, band: &mut Band, mixed: &mut EpsilonSearch);
    /// Whether the shader takes derivatives, and the pixel's quad lies across an edge.
    fn is_across_edge(&self, x: u32, y: u32) -> bool;
    /// Returns those of the `wanted` pixels, bottom row first, in which the reference itself changes color
    /// when its numbers are perturbed by less than a shader's precision.
    fn tied(&self, wanted: &[bool]) -> Vec<bool>;
}

/// The pixels of a band that depend on undefined behavior, bottom row first.
#[derive(Debug, Clone, Copy)]
pub struct Undefined<'a> {
    /// The pixels of the shader that do.
    pub pixels: &'a [bool],
    /// The shader's images with other results of its undefined operations; `None` if these have no
    /// substitutes.
    pub substituted: Option<&'a [Image]>,
    /// The pixels of the reference that do; empty if there are none.
    pub in_reference: &'a [bool],
}

impl Undefined<'_> {
    /// The status of a pixel whose color differs from the expected one if it `differs` in the shader's image.
    /// A pixel that is wrong whatever the undefined operations return is wrong.
    fn status(&self, at: usize, differs: impl Fn(&Image) -> bool, actual: &Image) -> PixelStatus {
        let is_wrong = match self.substituted {
            None => false,
            Some(images) => differs(actual) && images.iter().all(&differs),
        };
        match (self.pixels[at], self.in_reference.get(at) == Some(&true)) {
            (true, false) if is_wrong => PixelStatus::Differs,
            (true, _) | (_, true) => PixelStatus::Undefined,
            (false, false) if differs(actual) => PixelStatus::Differs,
            (false, false) => PixelStatus::Agrees,
        }
    }
}

/// The colors of a reference for different ray epsilons. Coordinates are in the band.
pub trait EpsilonColors: Sync {
    /// The accepted colors of a pixel for a few of the legal ray epsilons.
    fn color_range(&self, x: u32, y: u32, epsilons: EpsilonSet) -> ColorRange;
    /// All ray epsilons that a shader may have.
    fn families(&self) -> &[EpsilonFamily];
    /// The color of a pixel for these ray epsilons.
    fn pixel_with_epsilons(&self, x: u32, y: u32, epsilons: &RayEpsilons) -> [f64; 3];
    /// The number of samples of a pixel, to which its cost is proportional.
    fn samples(&self) -> u32;
}

/// State that is kept between bands: how many more pixels may be compared with other ray epsilons, and the
/// shader's epsilons, if they were found.
#[derive(Debug, Clone, Copy)]
pub struct EpsilonSearch {
    budget: f64,
    /// The number of pixels that may be compared with all ray epsilons one by one.
    single_pixel_budget: f64,
    fitted: Option<RayEpsilons>,
}

impl EpsilonSearch {
    /// The state at the start of an image with that number of pixels.
    #[must_use]
    pub fn new(pixels: u64) -> Self {
        Self {
            budget: MAX_MIXED_SHARE * pixels as f64,
            single_pixel_budget: MAX_MIXED_SHARE * pixels as f64,
            fitted: None,
        }
    }

    /// The ray epsilons of the shader, if they were found.
    #[must_use]
    pub fn epsilons(&self) -> Option<RayEpsilons> {
        self.fitted
    }
}

/// Whether `pixels` more fit into the budget, which they are subtracted from.
fn spend(budget: &mut f64, pixels: usize) -> bool {
    let is_enough = pixels as f64 <= *budget;
    if is_enough {
        *budget -= pixels as f64;
    }
    is_enough
}

/// Compares a band of the shader in f64, `actual`, with the reference in f64, `expected`, bottom row first;
/// coordinates are in the band.
///
/// A pixel agrees if no component is farther than the tolerance from the reference's color, or from those
/// that it has for other ray epsilons. A pixel that depends on undefined behavior is excluded, unless it is
/// outside whatever the undefined operations return. A pixel outside is excluded if it lies on an edge across
/// which the shader takes derivatives, whose values GLSL leaves to the driver. It is also excluded if the
/// reference itself is ill-conditioned there. Otherwise it is ill-conditioned if the shader's own color
/// changes by more than the tolerance in one of the images of `perturbed`, see `changed_by_rounding`.
///
/// # Panics
/// If the sizes differ.
pub fn algorithm(
    expected: &Image,
    actual: &Image,
    undefined: &Undefined,
    reference: &impl Reference,
    mixed: &mut EpsilonSearch,
    perturbed: impl FnMut(u64, &[bool]) -> Option<Image>,
) -> Vec<PixelStatus> {
    assert_eq!(expected.size(), actual.size());
    let tolerance = reference.tolerance();
    let status = |index| {
        let differs = |image: &Image| Pixel::at(index, expected, image).difference() > tolerance;
        undefined.status(index, differs, actual)
    };
    let mut statuses: Vec<_> = (0..actual.pixels().len()).into_par_iter().map(status).collect();
    if statuses.contains(&PixelStatus::Differs) {
        let mut band = Band {
            expected,
            actual,
            statuses: &mut statuses,
        };
        reference.accept_epsilons(&mut band, mixed);
    }
    for (index, status) in statuses.iter_mut().enumerate() {
        let pixel = Pixel::at(index, expected, actual);
        let is_accepted = *status == PixelStatus::Agrees && undefined.pixels[index];
        let is_across_edge = || *status == PixelStatus::Differs && reference.is_across_edge(pixel.x, pixel.y);
        if is_accepted || is_across_edge() {
            *status = PixelStatus::Undefined;
        }
    }
    exclude_tied(&mut statuses, |wanted| reference.tied(wanted));
    let changed = changed_by_rounding(actual, &are_differing(&statuses), tolerance, perturbed);
    replace(&mut statuses, &changed, PixelStatus::IllConditioned);
    statuses
}

fn are_differing(statuses: &[PixelStatus]) -> Vec<bool> {
    let differs = |status: &PixelStatus| *status == PixelStatus::Differs;
    statuses.iter().map(differs).collect()
}

fn replace(statuses: &mut [PixelStatus], selected: &[bool], other: PixelStatus) {
    for (status, _) in statuses
        .iter_mut()
        .zip(selected)
        .filter(|&(_, &selected)| selected)
    {
        *status = other;
    }
}

/// Excludes differing pixels in which the reference itself changes with the number type: no shader can
/// resolve them in float32.
pub(crate) fn exclude_tied(statuses: &mut [PixelStatus], tied: impl FnOnce(&[bool]) -> Vec<bool>) {
    let tied = tied(&are_differing(statuses));
    replace(statuses, &tied, PixelStatus::Tied);
}

/// Counts the tied pixels for which `is_counted` returns true.
pub(crate) fn count_tied(statuses: &[PixelStatus], is_counted: impl FnOnce(&[bool]) -> Vec<bool>) -> u64 {
    let tied: Vec<bool> = statuses
        .iter()
        .map(|&status| status == PixelStatus::Tied)
        .collect();
    if !tied.contains(&true) {
        return 0;
    }
    let counted = is_counted(&tied).into_iter().zip(tied);
    counted.filter(|&(counted, tied)| counted && tied).count() as u64
}

/// Returns those of the `wanted` pixels of an image whose color changes by more than the tolerance in one of
/// the images of `perturbed`, which evaluates the same shader with every operation perturbed, given a seed
/// and the wanted pixels (Vignes, "A stochastic arithmetic for reliable scientific computation", 1993). It is
/// called only if there are wanted pixels, and may return `None`.
pub(crate) fn changed_by_rounding(
    image: &Image,
    wanted: &[bool],
    tolerance: f64,
    mut perturbed: impl FnMut(u64, &[bool]) -> Option<Image>,
) -> Vec<bool> {
    let mut left = wanted.to_vec();
    let mut changed = vec![false; wanted.len()];
    // After two perturbed images in which no wanted pixel changes, the rest is decided.
    let mut unchanged_images = 0;
    for seed in 0..PERTURBATIONS {
        if unchanged_images == 2 || !left.contains(&true) {
            break;
        }
        let Some(perturbed) = perturbed(seed, &left) else {
            break;
        };
        unchanged_images += 1;
        for index in 0..left.len() {
            if left[index] && Pixel::at(index, image, &perturbed).difference() > tolerance {
                (left[index], changed[index]) = (false, true);
                unchanged_images = 0;
            }
        }
    }
    changed
}

/// A band that is compared.
#[derive(Debug)]
pub struct Band<'a> {
    expected: &'a Image,
    actual: &'a Image,
    statuses: &'a mut [PixelStatus],
}

impl Band<'_> {
    /// Accepts the differing pixels that satisfy the condition.
    pub(crate) fn accept(&mut self, agrees: impl Fn(&Pixel) -> bool + Sync) {
        let (expected, actual) = (self.expected, self.actual);
        self.statuses
            .par_iter_mut()
            .enumerate()
            .for_each(|(index, status)| {
                if *status == PixelStatus::Differs && agrees(&Pixel::at(index, expected, actual)) {
                    *status = PixelStatus::Agrees;
                }
            });
    }

    /// The share of the pixels that differ.
    pub(crate) fn differing_share(&self) -> f64 {
        differing(self.statuses) as f64 / self.statuses.len().max(1) as f64
    }

    fn differing(&self) -> Vec<Pixel> {
        let statuses = self.statuses.iter().enumerate();
        let differing = statuses.filter(|&(_, &status)| status == PixelStatus::Differs);
        differing
            .map(|(index, _)| Pixel::at(index, self.expected, self.actual))
            .collect()
    }
}

/// Accepts the colors of a scene for the legal ray epsilons: first for a few. More epsilons are tried only
/// where pixels are still outside: `mixed` ones if few are, then the shader's own, which are fitted to some
/// of the pixels, then all that authors use, in each pixel by itself.
pub fn accept_epsilons(band: &mut Band, colors: &dyn EpsilonColors, mixed: &mut EpsilonSearch) {
    let is_within = |pixel: &Pixel, epsilons| {
        let range = colors.color_range(pixel.x, pixel.y, epsilons);
        range.distance(pixel.actual.map(f64::from)) <= EXACT_TOLERANCE
    };
    band.accept(|pixel| is_within(pixel, EpsilonSet::Alike));
    if spend(&mut mixed.budget, differing(band.statuses)) {
        band.accept(|pixel| is_within(pixel, EpsilonSet::Mixed));
    }
    let left = band.differing();
    if !left.is_empty() {
        mixed.fitted = fit_epsilons(colors, &left, mixed.fitted);
        if let Some(epsilons) = mixed.fitted {
            band.accept(|pixel| matches_epsilons(colors, pixel, &epsilons));
        }
    }
    let count = differing(band.statuses);
    if count > 0 && is_affordable(colors, count) && spend(&mut mixed.single_pixel_budget, count) {
        band.accept(|pixel| matches_any_family(colors, pixel));
    }
}

fn differing(statuses: &[PixelStatus]) -> usize {
    let differs = |status: &&PixelStatus| **status == PixelStatus::Differs;
    statuses.iter().filter(differs).count()
}

// Fitting: which of the legal ray epsilons a shader has, from some of the pixels in which it differs.

/// The largest number of pixels that are compared with all ray epsilons, for one sample per pixel: the number
/// is divided by that of the samples.
const MAX_FITTED_PIXELS: usize = 32;

/// The least number of pixels that are compared with all ray epsilons, for many samples per pixel.
const MIN_FITTED_PIXELS: usize = 8;

/// The largest number of samples that are taken to compare pixels one by one.
const MAX_FIT_SAMPLES: usize = 3_000_000;

/// The share of the compared pixels that the shader's epsilons must explain.
const MIN_EXPLAINED_SHARE: f64 = 0.1;

/// How often the epsilons of light rays and of other rays are fitted alternately.
const FIT_ITERATIONS: u32 = 2;

/// Returns the ray epsilons that explain most of some pixels, if any explain some; `before` are those that
/// explained earlier ones.
fn fit_epsilons(
    reference: &dyn EpsilonColors,
    differing: &[Pixel],
    before: Option<RayEpsilons>,
) -> Option<RayEpsilons> {
    let most = (MAX_FITTED_PIXELS / reference.samples() as usize).max(MIN_FITTED_PIXELS);
    let count = differing.len().min(most);
    let pixel = |at| differing[(2 * at + 1) * differing.len() / (2 * count)];
    let sample: Vec<Pixel> = (0..count).map(pixel).collect();
    let explained = |epsilons: &RayEpsilons| {
        let is_explained = |pixel: &&Pixel| matches_epsilons(reference, pixel, epsilons);
        sample.iter().filter(is_explained).count()
    };
    let mut best = before.map(|before| (explained(&before), before));
    if best.is_some_and(|(most, _)| most == count) {
        return before;
    }
    let improve = |best: &mut Option<(usize, RayEpsilons)>,
                   make: &dyn Fn(RayEpsilon, RayEpsilons) -> RayEpsilons| {
        let (most, epsilons) = best.unwrap_or_default();
        let all: Vec<RayEpsilons> = reference
            .families()
            .iter()
            .flatten()
            .map(|&epsilon| make(epsilon, epsilons))
            .collect();
        let found = all.par_iter().map(explained).collect::<Vec<_>>();
        // Of epsilons that explain as many, the first.
        let found = found.into_iter().zip(all).rev().max_by_key(|&(found, _)| found);
        if let Some((found, epsilons)) = found
            && found > most
        {
            *best = Some((found, epsilons));
        }
        best.is_some_and(|(most, _)| most == count)
    };
    let is_explained = improve(&mut best, &|epsilon, _| RayEpsilons::alike(epsilon));
    // If no epsilon explains any pixel, epsilons are not the cause.
    if !is_explained && best.is_some() {
        for _ in 0..FIT_ITERATIONS {
            let light = |light, epsilons| RayEpsilons { light, ..epsilons };
            let other = |other, epsilons| RayEpsilons { other, ..epsilons };
            if improve(&mut best, &light) || improve(&mut best, &other) {
                break;
            }
        }
    }
    let (most, epsilons) = best?;
    (most as f64 >= MIN_EXPLAINED_SHARE * count as f64).then_some(epsilons)
}

/// Whether a pixel has the reference's color for these ray epsilons.
fn matches_epsilons(reference: &dyn EpsilonColors, pixel: &Pixel, epsilons: &RayEpsilons) -> bool {
    let color = reference.pixel_with_epsilons(pixel.x, pixel.y, epsilons);
    (0..3).all(|i| {
        let [own, other] = [f64::from(pixel.actual[i]), color[i]].map(|part| part.clamp(0.0, 1.0));
        (own - other).abs() <= EXACT_TOLERANCE
    })
}

/// Whether that number of pixels can be compared one by one.
fn is_affordable(reference: &dyn EpsilonColors, pixels: usize) -> bool {
    let epsilons: usize = reference.families().iter().map(Vec::len).sum();
    pixels * epsilons * reference.samples() as usize <= MAX_FIT_SAMPLES
}

/// Whether a pixel lies between the reference's colors for two neighboring epsilons of a family: where glass
/// is seen at a grazing angle, a color is not a monotonic function of the offset.
fn matches_any_family(reference: &dyn EpsilonColors, pixel: &Pixel) -> bool {
    reference.families().iter().any(|family| {
        let colors = family
            .iter()
            .map(|&epsilon| reference.pixel_with_epsilons(pixel.x, pixel.y, &RayEpsilons::alike(epsilon)));
        let colors: Vec<_> = colors
            .map(|color| color.map(|part| part.clamp(0.0, 1.0)))
            .collect();
        colors.windows(2).any(|pair| {
            (0..3).all(|i| {
                let own = f64::from(pixel.actual[i]).clamp(0.0, 1.0);
                let [low, high] = [pair[0][i].min(pair[1][i]), pair[0][i].max(pair[1][i])];
                low - EXACT_TOLERANCE <= own && own <= high + EXACT_TOLERANCE
            })
        })
    })
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

    fn point(red: f64) -> ColorRange {
        ColorRange {
            low: [red, 0.0, 0.0],
            high: [red, 0.0, 0.0],
        }
    }

    /// A black scene.
    struct Black<H> {
        /// The color range by x and epsilon set.
        range: H,
        /// Where the shader takes derivatives across an edge.
        edge: fn(u32) -> bool,
        tied: fn(u32) -> bool,
        families: Vec<EpsilonFamily>,
        /// The color by x and offset.
        pixel_with_epsilons: fn(u32, f64) -> f64,
    }

    fn black<H: Fn(u32, EpsilonSet) -> ColorRange + Sync>(range: H) -> Black<H> {
        Black {
            range,
            edge: |_| false,
            tied: |_| false,
            families: Vec::new(),
            pixel_with_epsilons: |_, _| 0.0,
        }
    }

    impl<H: Fn(u32, EpsilonSet) -> ColorRange + Sync> Reference for Black<H> {
        fn tolerance(&self) -> f64 {
            EXACT_TOLERANCE
        }
        fn accept_epsilons(&self, band: &mut Band, mixed: &mut EpsilonSearch) {
            accept_epsilons(band, self, mixed);
        }
        fn is_across_edge(&self, x: u32, _: u32) -> bool {
            (self.edge)(x)
        }
        fn tied(&self, wanted: &[bool]) -> Vec<bool> {
            let pixels = (0..).zip(wanted);
            pixels.map(|(x, &wanted)| wanted && (self.tied)(x)).collect()
        }
    }

    impl<H: Fn(u32, EpsilonSet) -> ColorRange + Sync> EpsilonColors for Black<H> {
        fn color_range(&self, x: u32, _: u32, epsilons: EpsilonSet) -> ColorRange {
            (self.range)(x, epsilons)
        }
        fn families(&self) -> &[EpsilonFamily] {
            &self.families
        }
        fn pixel_with_epsilons(&self, x: u32, _: u32, epsilons: &RayEpsilons) -> [f64; 3] {
            [(self.pixel_with_epsilons)(x, epsilons.other.offset), 0.0, 0.0]
        }
        fn samples(&self) -> u32 {
            1
        }
    }

    /// These pixels depend on undefined behavior that has no substitutes.
    fn undefined(pixels: &[bool]) -> Undefined<'_> {
        Undefined {
            pixels,
            substituted: None,
            in_reference: &[false; 1000][..pixels.len()],
        }
    }

    #[test]
    fn a_pixel_is_wrong_that_differs_whatever_undefined_operations_return() {
        let (expected, actual) = (row(&[0.0; 4]), row(&[0.3, 0.3, 0.0, 0.3]));
        let undefined = Undefined {
            pixels: &[true; 4],
            substituted: Some(&[row(&[0.5; 4]), row(&[0.5, 0.0, 0.5, 0.5])]),
            in_reference: &[false, false, false, true],
        };
        let reference = black(|_, _| point(0.0));
        let mixed = &mut EpsilonSearch::new(4);
        let statuses = algorithm(&expected, &actual, &undefined, &reference, mixed, |_, _| None);
        let left_out = PixelStatus::Undefined;
        assert_eq!(statuses, [PixelStatus::Differs, left_out, left_out, left_out]);
    }

    #[test]
    fn a_differing_pixel_on_an_edge_is_excluded() {
        let (expected, actual) = (row(&[0.0; 3]), row(&[0.0, 0.3, 0.3]));
        let reference = Black {
            edge: |x| x < 2,
            ..black(|_, _| point(0.0))
        };
        let statuses = algorithm(
            &expected,
            &actual,
            &undefined(&[false; 3]),
            &reference,
            &mut EpsilonSearch::new(3),
            |_, _| None,
        );
        assert_eq!(
            statuses,
            [PixelStatus::Agrees, PixelStatus::Undefined, PixelStatus::Differs]
        );
    }

    #[test]
    fn pixels_in_the_range_agree_and_ill_conditioned_ones_are_not_wrong() {
        let expected = row(&[0.0; 5]);
        let actual = row(&[0.00009, 0.3, 0.3, 0.3, 0.3]);
        let range = |x, _| ColorRange {
            high: [if x == 1 { 0.29995 } else { 0.0 }, 0.0, 0.0],
            ..point(0.0)
        };
        let pixels = [false, false, false, false, true];
        let undefined = undefined(&pixels);
        let moving =
            |seed, _: &[bool]| Some(row(&[0.0, 0.0, if seed == 1 { 0.0 } else { 0.3 }, 0.30005, 0.3]));
        let mixed = &mut EpsilonSearch::new(5);
        let statuses = algorithm(&expected, &actual, &undefined, &black(range), mixed, moving);
        assert_eq!(
            statuses,
            [
                PixelStatus::Agrees,
                PixelStatus::Agrees,
                PixelStatus::IllConditioned,
                PixelStatus::Differs,
                PixelStatus::Undefined
            ]
        );
    }

    #[test]
    fn mixed_epsilons_are_tried_where_few_pixels_differ() {
        let mut mixed = EpsilonSearch::new(2000);
        let mut count_differing = |differing: usize| {
            let none = row(&[0.0; 1000]);
            let mut reds = [0.0; 1000];
            reds[..differing].fill(0.3);
            let range = |_, epsilons| match epsilons {
                EpsilonSet::Alike => point(0.0),
                EpsilonSet::Mixed => point(0.3),
            };
            let (actual, defined) = (row(&reds), [false; 1000]);
            let undefined = undefined(&defined);
            let statuses = algorithm(&none, &actual, &undefined, &black(range), &mut mixed, |_, _| None);
            let differs = |status: &&PixelStatus| **status == PixelStatus::Differs;
            statuses.iter().filter(differs).count()
        };
        assert_eq!(count_differing(21), 21, "too many pixels differ");
        assert_eq!(count_differing(15), 0);
        assert_eq!(count_differing(6), 6, "the bands share the budget");
        assert_eq!(count_differing(5), 0);
    }

    #[test]
    fn perturbations_stop_when_nothing_changes() {
        let none = row(&[0.0]);
        let mut evaluations = 0;
        let mut count = |_, _: &[bool]| {
            evaluations += 1;
            Some(row(&[1.0]))
        };
        let mixed = &mut EpsilonSearch::new(1);
        let reference = black(|_, _| point(0.0));
        algorithm(&none, &none, &undefined(&[false]), &reference, mixed, &mut count);
        assert_eq!(evaluations, 0, "nothing differs");
        let mut evaluations = 0;
        let still = |_, wanted: &[bool]| {
            assert_eq!(wanted, [true]);
            evaluations += 1;
            Some(row(&[1.0]))
        };
        let statuses = algorithm(
            &none,
            &row(&[1.0]),
            &undefined(&[false]),
            &reference,
            mixed,
            still,
        );
        assert_eq!((evaluations, statuses), (2, vec![PixelStatus::Differs]));
    }

    #[test]
    fn nan_differs_from_the_scene() {
        let statuses = algorithm(
            &row(&[0.0]),
            &row(&[f32::NAN]),
            &undefined(&[false]),
            &black(|_, _| point(0.0)),
            &mut EpsilonSearch::new(1),
            |_, _| None,
        );
        assert_eq!(statuses, [PixelStatus::Differs]);
    }

    /// Offsets up to 1, which the tests take for colors.
    fn offsets() -> Vec<EpsilonFamily> {
        let epsilon = |offset| RayEpsilon {
            offset,
            ..RayEpsilon::default()
        };
        vec![(0..=10).map(|tenths| epsilon(f64::from(tenths) / 10.0)).collect()]
    }

    #[test]
    fn epsilons_are_fitted_to_many_pixels_and_explain_all_of_them() {
        // Every color results from an offset of 0.7, and from no other.
        let reference = Black {
            families: offsets(),
            pixel_with_epsilons: |x, offset| (offset * f64::from(x % 7 + 1)).sin().abs(),
            ..black(|_, _| point(0.0))
        };
        let reds: Vec<f32> = (0..1000u32)
            .map(|x| (0.7 * f64::from(x % 7 + 1)).sin().abs() as f32)
            .collect();
        let expected = row(&[0.0; 1000]);
        let mixed = &mut EpsilonSearch::new(1000);
        let statuses = algorithm(
            &expected,
            &row(&reds),
            &undefined(&[false; 1000]),
            &reference,
            mixed,
            |_, _| None,
        );
        assert!(statuses.iter().all(|&status| status == PixelStatus::Agrees));
        assert_eq!(mixed.epsilons().map(|epsilons| epsilons.other.offset), Some(0.7));
        // A pixel that no offset explains is wrong, however many others are explained.
        let mut reds = reds;
        reds[500] = f32::NAN;
        let mixed = &mut EpsilonSearch::new(1000);
        let statuses = algorithm(
            &expected,
            &row(&reds),
            &undefined(&[false; 1000]),
            &reference,
            mixed,
            |_, _| None,
        );
        assert_eq!(differing(&statuses), 1);
    }

    #[test]
    fn a_color_between_those_of_neighboring_offsets_agrees_where_few_pixels_differ() {
        // Brightest at an offset of one half, black at both ends.
        let reference = Black {
            families: offsets(),
            pixel_with_epsilons: |_, offset| offset * (1.0 - offset),
            ..black(|_, _| point(0.0))
        };
        let mut reds = [0.0; 1000];
        // The color for an offset of 0.33, and one brighter than any.
        (reds[3], reds[4]) = (0.2211, 0.26);
        let expected = row(&[0.0; 1000]);
        let statuses = algorithm(
            &expected,
            &row(&reds),
            &undefined(&[false; 1000]),
            &reference,
            &mut EpsilonSearch::new(1000),
            |_, _| None,
        );
        assert_eq!(statuses[3..5], [PixelStatus::Agrees, PixelStatus::Differs]);
    }

    #[test]
    fn pixels_tied_in_the_scene_are_excluded() {
        let reference = Black {
            tied: |x| x % 2 == 0,
            ..black(|_, _| point(0.0))
        };
        let mut reds = [0.0; 100];
        reds[..3].fill(0.5);
        let mixed = &mut EpsilonSearch::new(100);
        let statuses = algorithm(
            &row(&[0.0; 100]),
            &row(&reds),
            &undefined(&[false; 100]),
            &reference,
            mixed,
            |_, _| None,
        );
        assert_eq!(
            statuses[..4],
            [
                PixelStatus::Tied,
                PixelStatus::Differs,
                PixelStatus::Tied,
                PixelStatus::Agrees
            ]
        );
    }
}
