//! What samples are worth.

use super::*;

fn rmse(a: &Image, b: &Image) -> f64 {
    let square =
        |(a, b): (&[f32; 4], &[f32; 4])| -> f64 { (0..3).map(|i| f64::from(a[i] - b[i]).powi(2)).sum() };
    let sum: f64 = a.pixels().iter().zip(b.pixels()).map(square).sum();
    (sum / (3 * a.pixels().len()) as f64).sqrt()
}

/// Every so many-th pixel, across and up.
const STRIDE: u32 = 4;

/// Some pixels of a picture in its own size, where edges have the share that they have.
fn some(scene: &Scene, sampler: Sampler, samples: u32) -> Vec<[f64; 3]> {
    let mut scene = scene.clone();
    scene.film.sampler = sampler;
    scene.film.samples = samples;
    let tracer = Tracer::<f64>::new(&scene);
    let [width, height] = scene.film.size.map(|side| side / STRIDE);
    (0..width * height)
        .into_par_iter()
        .map(|at| tracer.pixel(at % width * STRIDE + 1, at / width * STRIDE + 1))
        .collect()
}

#[test]
fn spread_samples_need_fewer() {
    // An edge needs fewer samples than an edge and a penumbra.
    for (name, needed) in [("03", [4, 4, 4]), ("09", [64, 16, 16])] {
        let scene = rung(name, [640, 360]);
        let reference = some(&scene, Sampler::Sobol, 256);
        let error = |sampler: Sampler, samples: u32| {
            let square =
                |(a, b): (&[f64; 3], &[f64; 3])| -> f64 { (0..3).map(|i| (a[i] - b[i]).powi(2)).sum() };
            let pixels = some(&scene, sampler, samples);
            let sum: f64 = pixels.iter().zip(&reference).map(square).sum();
            255.0 * (sum / (3 * pixels.len()) as f64).sqrt()
        };
        let samplers = [Sampler::Independent, Sampler::Stratified, Sampler::Sobol];
        let [independent, stratified, sobol] = samplers.map(|sampler| error(sampler, 16));
        assert!(
            independent > 1.5 * stratified && stratified > 0.9 * sobol,
            "{name}: {independent} {stratified} {sobol}"
        );
        for (sampler, needed) in samplers.into_iter().zip(needed) {
            let [enough, few] = [needed, needed / 4].map(|samples| error(sampler, samples));
            assert!(enough <= 1.0 && few > 1.0, "{name}, {sampler:?}: {enough} {few}");
        }
    }
}

#[test]
fn the_error_that_is_asked_for_is_kept() {
    let mut scene = rung("09", [48, 32]);
    scene.film.sampler = Sampler::Sobol;
    let (picture, spent) = Tracer::<f64>::new(&scene).picture_within(0.004, || ());
    scene.film.samples = 4096;
    let reference = Tracer::<f64>::new(&scene).picture(|| ());
    let error = rmse(&picture, &reference);
    assert!(error < 0.004 && spent.error <= 0.004, "{error} {spent:?}");
    let [most, fewest] = spent.per_pixel;
    assert!(
        fewest == 16 && most > fewest,
        "the sky needs fewer than the shadows: {spent:?}"
    );
}

#[test]
fn every_sampler_and_number_of_samples_gives_finite_pictures() {
    let finite = |picture: &Image| picture.pixels().iter().flatten().all(|part| part.is_finite());
    for name in ["09", "13"] {
        for sampler in [Sampler::Independent, Sampler::Stratified, Sampler::Sobol] {
            for samples in [1, 2, 3, 7, 16, 37, 64, 257, 512] {
                let mut scene = rung(name, [16, 9]);
                scene.film.sampler = sampler;
                scene.film.samples = samples;
                let what = format!("{name} {sampler:?} {samples}");
                assert!(finite(&Tracer::<f64>::new(&scene).picture(|| ())), "{what}");
                assert!(finite(&Tracer::<f32>::new(&scene).picture(|| ())), "{what}, f32");
            }
        }
    }
}

#[test]
fn a_pair_on_the_squares_edge_is_no_direction_without_density() {
    // In these pixels Sobol's sequence has a pair with 0 in it, which is the edge of the disk that lobes are sampled by.
    let mut scene = rung("13", [640, 360]);
    scene.film.sampler = Sampler::Sobol;
    scene.film.samples = 512;
    for [column, row] in [[360, 172], [321, 181], [154, 256]] {
        let (x, y) = (column, 359 - row);
        let double = Tracer::<f64>::new(&scene).pixel(x, y);
        let single = Tracer::<f32>::new(&scene).pixel(x, y);
        assert!(double.iter().all(|part| part.is_finite()), "{double:?}");
        assert!(single.iter().all(|part| part.is_finite()), "{single:?}");
    }
}
