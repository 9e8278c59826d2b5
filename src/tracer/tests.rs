//! Images with known pixels.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use rayon::prelude::*;
use toyproof_diagnostic::{File, Files};
use toyproof_image::Image;
use toyproof_scene::{self as scene, FrameTime, Sampler, Scene};

use super::*;
use crate::lanes::Level;

pub(crate) fn scene(text: &str) -> Scene {
    let mut files = Files::default();
    let file = files.add(File::new("s", text));
    scene::parse(&files, file).unwrap()
}

pub(crate) fn pixel(text: &str, x: u32, y: u32) -> [f64; 3] {
    Tracer::<f64>::new(&scene(text)).pixel(x, y)
}

pub(crate) fn assert_near(actual: [f64; 3], expected: [f64; 3]) {
    for (a, e) in actual.iter().zip(expected) {
        assert!((a - e).abs() < 1e-12, "{actual:?} is not {expected:?}");
    }
}

/// One pixel that looks along −z.
pub(crate) const ONE: &str = "[film]\nsize = [1, 1]\n";

fn ball(center: &str, radius: &str, material: &str) -> String {
    format!("[[sphere]]\ncenter = {center}\nradius = {radius}\nmaterial = {material}\n")
}

#[test]
fn samples_at_the_center_are_those_of_one_sample() {
    let text = |samples: u32| {
        let film =
            format!("[film]\nsize = [24, 16]\nsampler = \"center\"\nsamples = {samples}\n[background]\n");
        film + &ball(
            "[1, 0.5, -6]",
            "1.5",
            "{ model = \"facing\", color = [1, 0.5, 0] }",
        )
    };
    let image = |samples| Tracer::<f64>::new(&scene(&text(samples))).render(|| ());
    // Packets of 8 samples of a pixel and of 64 pixels have other orders.
    for samples in [4, 8, 16] {
        assert_eq!(image(samples), image(1), "{samples}");
    }
}

#[test]
fn a_sphere_straight_ahead_faces_the_eye() {
    let text = ONE.to_owned() + &ball("[0, 0, -6]", "1.5", "{ model = \"facing\", color = [1, 0.5, 0] }");
    assert_near(pixel(&text, 0, 0), [1.0, 0.5, 0.0]);
}

#[test]
fn aspect_scales_y_and_y_points_up() {
    let film = "[film]\nsize = [4, 2]\n[background]\nbottom = [0, 0, 0]\ntop = [1, 1, 1]\n";
    // Pixel (3, 1): x = 0.75, y = 0.5 / 2, screen at −2.
    let y = 0.25 / (0.75f64.powi(2) + 0.25f64.powi(2) + 4.0).sqrt();
    assert_near(pixel(film, 3, 1), [0.5 * (1.0 + y); 3]);
    assert_near(pixel(film, 0, 0), [0.5 * (1.0 - y); 3]);
}

#[test]
fn spheres_behind_the_eye_are_invisible_and_far_sides_visible_from_inside() {
    let facing = "{ model = \"facing\", color = [1, 1, 1] }";
    assert_near(
        pixel(&(ONE.to_owned() + &ball("[0, 0, 6]", "1.5", facing)), 0, 0),
        [0.0; 3],
    );
    assert_near(
        pixel(&(ONE.to_owned() + &ball("[0, 0, 1]", "3", facing)), 0, 0),
        [1.0; 3],
    );
}

#[test]
fn lambert_adds_ambient_and_cosine_weighted_lights() {
    let text = format!(
        "ambient = [0.1, 0.1, 0.1]\n{ONE}[[light]]\nposition = [0, 5, 0]\ncolor = [0.5, 1, 1]\n{}",
        ball("[0, 0, -6]", "1", "{ model = \"lambert\", color = [1, 0.5, 1] }")
    );
    // The hit is (0, 0, −5), N = +z, L = (0, 5, 5) / √50.
    let cosine = 0.5f64.sqrt();
    assert_near(
        pixel(&text, 0, 0),
        [0.1 + 0.5 * cosine, 0.5 * (0.1 + cosine), 0.1 + cosine],
    );
}

#[test]
fn only_blockers_between_surface_and_light_cast_shadows() {
    let lit = |blocker: &str, shadow: &str| {
        let text = format!(
            "{ONE}[[light]]\nposition = [0, 0, 0]\nshadow = {shadow}\n{}{blocker}",
            ball("[0, 0, -6]", "1", "{ model = \"lambert\", color = [1, 1, 1] }")
        );
        // Light from above: the camera ray passes below the blocker.
        pixel(
            &text.replace("position = [0, 0, 0]", "position = [0, 3, -2]"),
            0,
            0,
        )[0]
    };
    let matte = "{ model = \"lambert\", color = [1, 1, 1] }";
    let between = ball("[0, 1.5, -3.5]", "0.5", matte);
    let beyond = ball("[0, 4.5, -0.5]", "0.5", matte);
    let cosine = 0.5f64.sqrt();
    assert_eq!(lit(&between, "true"), 0.0);
    assert!((lit(&between, "false") - cosine).abs() < 1e-12);
    assert!((lit(&beyond, "true") - cosine).abs() < 1e-12);
}

#[test]
fn mirrors_reflect_up_to_max_depth() {
    let mirrors = ball("[0, 0, -6]", "1", "{ model = \"mirror\", color = [0.5, 1, 1] }")
        + &ball("[0, 0, 6]", "1", "{ model = \"mirror\", color = [1, 0.5, 1] }");
    let text = |depth: u32| {
        format!("[film]\nsize = [1, 1]\nmax_depth = {depth}\n[background]\ncolor = [1, 1, 1]\n{mirrors}")
    };
    // Between facing mirrors, the ray never escapes.
    assert_near(pixel(&text(7), 0, 0), [0.0; 3]);
    let one = ball("[0, 0, -6]", "1", "{ model = \"mirror\", color = [0.5, 1, 1] }");
    let open = |depth: u32| {
        format!(
            "[film]\nsize = [1, 1]\nmax_depth = {depth}\n[background]\nbottom = [1, 1, 1]\ntop = [0.2, 1, 1]\n{one}"
        )
    };
    assert_near(pixel(&open(1), 0, 0), [0.0; 3]);
    assert_near(pixel(&open(2), 0, 0), [0.3, 1.0, 1.0]);
}

#[test]
fn rays_inside_a_mirror_sphere_hit_only_far_sides() {
    // From the center ahead and back: the ray does not escape and does not hit its own start.
    let text = "[film]\nsize = [1, 1]\nmax_depth = 4\n[background]\ncolor = [1, 1, 1]\n".to_owned()
        + &ball("[0, 0, 0]", "2", "{ model = \"mirror\", color = [1, 1, 1] }")
        + &ball("[0, 0, 1.5]", "0.25", "{ model = \"facing\", color = [0, 0, 1] }");
    assert_near(pixel(&text, 0, 0), [0.0, 0.0, 1.0]);
}

#[test]
fn sine_hash_yields_x_first_and_starts_at_seed_zero() {
    let text =
        "[film]\nsize = [1, 1]\nsampler = \"sine-hash\"\n[background]\nbottom = [0, 0, 0]\ntop = [1, 1, 1]\n";
    let sample = (1f64.sin() * 43_758.545_312_3).fract();
    let (x, y) = (-1.0, sample * 2.0 - 1.0);
    let expected = 0.5 * (1.0 + y / (x * x + y * y + 4.0f64).sqrt());
    assert_near(pixel(text, 0, 0), [expected; 3]);
}

#[test]
fn f32_and_f64_agree_to_f32_accuracy() {
    let text = format!(
        "[film]\nsize = [32, 18]\nmax_depth = 5\n[background]\nbottom = [0.1, 0.1, 0.3]\ntop = [0.7, 0.8, 0.9]\n{}{}",
        ball(
            "[0, 0, -6]",
            "1.5",
            "{ model = \"mirror\", color = [1, 0.9, 0.8] }"
        ),
        ball("[-1, 1, -4]", "0.7", "{ model = \"facing\", color = [1, 0, 0] }")
    );
    let single = Tracer::<f32>::new(&scene(&text)).render(|| ());
    let double = Tracer::<f64>::new(&scene(&text)).render(|| ());
    for (a, b) in single.pixels().iter().zip(double.pixels()) {
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() < 2e-5, "{a} {b}");
        }
    }
}

/// Loads the scene of an exercise at a different size.
fn exercise(name: &str, size: [u32; 2]) -> Scene {
    let is_match = |path: &PathBuf| {
        let stem = path.file_stem().unwrap().to_str().unwrap();
        stem.starts_with(name)
            && stem.strip_suffix(".test").is_none()
            && path.extension().is_some_and(|extension| extension == "toml")
    };
    let mut paths = fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../glsl"))
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let text = fs::read_to_string(paths.find(is_match).unwrap()).unwrap();
    let mut scene = scene(&text);
    scene.film.size = size;
    scene
}

#[test]
fn parallel_projection_has_no_foreshortening() {
    let text = |z: &str| {
        "[film]\nsize = [8, 8]\n[camera]\nprojection = \"parallel\"\nwidth = 4\n".to_owned()
            + &ball(
                &format!("[1, 0, {z}]"),
                "0.8",
                "{ model = \"facing\", color = [1, 1, 1] }",
            )
    };
    for y in 0..8 {
        for x in 0..8 {
            // Pixels are half a unit wide.
            let [px, py] = [x, y].map(|at| 0.5 * f64::from(at) - 1.75);
            let rho2 = ((px - 1.0).powi(2) + py * py) / 0.64;
            let expected = (1.0 - rho2).max(0.0).sqrt();
            assert_near(pixel(&text("-3"), x, y), [expected; 3]);
            assert_near(pixel(&text("-3000"), x, y), [expected; 3]);
        }
    }
}

#[test]
fn mean_is_tone_mapped_before_gamma() {
    let text = "[film]\nsize = [1, 1]\ntone_map = \"reinhard\"\ngamma = 2\n[background]\ncolor = [3, 1, 0]\n";
    assert_near(pixel(text, 0, 0), [0.75f64.sqrt(), 0.5f64.sqrt(), 0.0]);
}

#[test]
fn later_figures_cover_earlier_ones_and_the_scene() {
    let disk = |radius: &str, color: &str| {
        format!("[[figure]]\noutline = \"disk\"\ncenter = [0, 0]\nradius = {radius}\ncolor = {color}\n")
    };
    let text = "[film]\nsize = [3, 1]\n[background]\ncolor = [1, 1, 1]\n".to_owned()
        + &disk("0.7", "[1, 0, 0]")
        + &disk("0.5", "[0, 1, 0]")
        + &ball("[0, 0, -6]", "9", "{ model = \"facing\", color = [1, 1, 1] }");
    assert_near(pixel(&text, 1, 0), [0.0, 1.0, 0.0]);
    assert_near(pixel(&text, 0, 0), [1.0, 0.0, 0.0]);
}

#[test]
fn motion_is_evaluated_at_the_frame_time() {
    let text = ONE.to_owned()
        + "[[motion]]\nname = \"m\"\npivot = [0, 0, 0]\nseconds = 4\n"
        + &ball("[6, 0, 0]", "1", "{ model = \"facing\", color = [1, 1, 1] }")
        + "motion = \"m\"\n";
    let at = |time: f64| Tracer::<f64>::at(&scene(&text), FrameTime { frame: 0, time }).pixel(0, 0);
    assert_near(at(0.0), [0.0; 3]);
    // A quarter turn brings x to −z, straight ahead.
    assert_near(at(1.0), [1.0; 3]);
}

/// Two mirrors that intersect at an angle in the x axis. Seen from the apex, a reflected ray continues
/// straight through mirrored copies of the wedge, so the number of reflections and the last direction follow
/// from two angles.
#[test]
fn mirror_wedge_matches_unfolded_reflections() {
    let angle = 1.85f64.to_radians();
    let (sine, cosine) = angle.sin_cos();
    let color = 0.995f64;
    let text = |depth: u32| {
        // The apex lies ahead, slightly below the eye; the upper mirror rises toward the eye.
        format!(
            "[film]\nsize = [3, 64]\nmax_depth = {depth}\n[camera]\neye = [0, 0.02, 3]\nscreen_distance = 40\n\
             [background]\nbottom = [0.2, 0.2, 0.2]\ntop = [0.9, 0.9, 0.9]\n\
             [[plane]]\npoint = [0, 0, 0]\nmaterial = {{ model = \"mirror\", color = [{color}, 1, 1] }}\n\
             [[plane]]\npoint = [0, 0, 0]\nnormal = [0, {}, {sine}]\n\
             material = {{ model = \"mirror\", color = [{color}, 1, 1] }}\n",
            -cosine
        )
    };
    let tracer = Tracer::<f64>::new(&scene(&text(100)));
    let shallow = Tracer::<f64>::new(&scene(&text(20)));
    let mut most = 0;
    for y in 0..64 {
        for x in 0..3 {
            // The camera's ray, then as angles around the apex, from the lower mirror upwards.
            let [sx, sy] = [
                (f64::from(x) + 0.5) / 1.5 - 1.0,
                ((f64::from(y) + 0.5) / 32.0 - 1.0) * 64.0 / 3.0,
            ];
            let d = [sx, sy, -40.0];
            let length = d.iter().map(|c| c * c).sum::<f64>().sqrt();
            let start = (0.02f64).atan2(3.0);
            let end = d[1].atan2(d[2]);
            // Going up increases the angle, going down decreases it.
            let line = |angle_of: f64| (angle_of / angle).floor();
            let clockwise = 0.02 * d[2] - 3.0 * d[1] > 0.0;
            let end = match (clockwise, end > 0.0) {
                (true, true) => end - std::f64::consts::TAU,
                (false, false) => end + std::f64::consts::TAU,
                _ => end,
            };
            let reflections = (line(end) - line(start)).abs();
            let folded = end - angle * line(end);
            let last = if line(end).rem_euclid(2.0) == 0.0 {
                folded
            } else {
                angle - folded
            };
            let rise = last.sin() * d[1].hypot(d[2]) / length;
            let sky = 0.2 + 0.7 * 0.5 * (1.0 + rise);
            let expected = [sky * color.powf(reflections), sky, sky];
            assert_near(tracer.pixel(x, y), expected);
            if reflections >= 20.0 {
                assert_near(shallow.pixel(x, y), [0.0; 3]);
            }
            most = most.max(reflections as u32);
        }
    }
    assert!((90..100).contains(&most), "{most} reflections");
}

// Energy conservation and analytic integrals.

#[test]
fn white_furnace_stays_white() {
    // Every sampled direction has the same radiance, and no light is lost.
    let text = "[film]\nsize = [4, 4]\nsamples = 4\nsampler = \"independent\"\nintegrator = \"path\"\nmax_depth = 2\n\
                [background]\ncolor = [1, 1, 1]\n"
        .to_owned()
        + &ball("[0, 0, -6]", "1.5", "{ model = \"diffuse\", color = [1, 1, 1] }");
    for at in 0..16 {
        let [r, _, _] = pixel(&text, at % 4, at / 4);
        assert!((r - 1.0).abs() < 1e-9, "{r}");
    }
}

#[test]
fn glass_conserves_energy() {
    let text = "[film]\nsize = [9, 9]\nmax_depth = 16\n[background]\ncolor = [1, 1, 1]\n".to_owned()
        + &ball(
            "[0, 0, -4]",
            "1.9",
            "{ model = \"glass\", color = [1, 1, 1], ior = 1.5 }",
        );
    for at in 0..81 {
        let [r, _, _] = pixel(&text, at % 9, at / 9);
        assert!((r - 1.0).abs() < 1e-3, "{r}");
    }
}

#[test]
fn irradiance_below_a_sphere_is_analytic() {
    // E = π L (R/d)² directly below a sphere of radiance L, so the reflected radiance is color · L · (R/d)².
    let text =
        "[film]\nsize = [1, 1]\nsamples = 1024\nsampler = \"sobol\"\nintegrator = \"path\"\nmax_depth = 2\n\
                [camera]\neye = [0, 0, 5]\n[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n\
                material = { model = \"diffuse\", color = [0.8, 0.8, 0.8] }\n"
        .to_owned()
        // Behind the eye, which must see the plane.
        + &ball("[0, 0, 8]", "2", "{ model = \"emitter\", color = [3, 3, 3] }");
    let [r, _, _] = pixel(&text, 0, 0);
    // The pixel is wide (2 units at a distance of 2, 5 at 5), so its mean is below the value at its center.
    // Hence compare a narrow pixel, with the screen far away.
    let narrow = text.replace("eye = [0, 0, 5]", "eye = [0, 0, 5]\nscreen_distance = 1000");
    let [middle, _, _] = pixel(&narrow, 0, 0);
    let expected = 0.8 * 3.0 * (2.0f64 / 8.0).powi(2);
    assert!((middle - expected).abs() < 2e-3 * expected, "{middle} {expected}");
    assert!(r < middle);
}

#[test]
fn sphere_light_is_the_mean_over_its_cone() {
    // Directly below: the mean cosine over a cone of half angle θ is (1 + cos θ) / 2.
    let text = "[film]\nsize = [1, 1]\nsamples = 1024\nsampler = \"stratified\"\n[camera]\neye = [0, 0, 5]\n\
                screen_distance = 1000\n[[light]]\nposition = [0, 0, 8]\nradius = 4\n[[plane]]\npoint = [0, 0, 0]\n\
                normal = [0, 0, 1]\nmaterial = { model = \"lambert\", color = [1, 1, 1] }\n";
    let [r, _, _] = pixel(text, 0, 0);
    let expected = 0.5 * (1.0 + 0.75f64.sqrt());
    assert!((r - expected).abs() < 1e-4, "{r} {expected}");
}

// Convergence of samplers.

fn root_mean_square_error(a: &Image, b: &Image) -> f64 {
    let square =
        |(a, b): (&[f32; 4], &[f32; 4])| -> f64 { (0..3).map(|i| f64::from(a[i] - b[i]).powi(2)).sum() };
    let sum: f64 = a.pixels().iter().zip(b.pixels()).map(square).sum();
    (sum / (3 * a.pixels().len()) as f64).sqrt()
}

/// Stride between the sampled pixels, in x and y.
const STRIDE: u32 = 4;

/// Samples pixels of an image at full size, so that edges have their natural share.
fn sample_pixels(scene: &Scene, sampler: Sampler, samples: u32) -> Vec<[f64; 3]> {
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
    // An edge needs fewer samples than an edge with a penumbra.
    for (name, needed) in [("03", [4, 4, 4]), ("09", [64, 16, 16])] {
        let scene = exercise(name, [640, 360]);
        let reference = sample_pixels(&scene, Sampler::Sobol, 256);
        let error = |sampler: Sampler, samples: u32| {
            let square =
                |(a, b): (&[f64; 3], &[f64; 3])| -> f64 { (0..3).map(|i| (a[i] - b[i]).powi(2)).sum() };
            let pixels = sample_pixels(&scene, sampler, samples);
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
fn adaptive_sampling_meets_the_error_bound() {
    let mut scene = exercise("09", [48, 32]);
    scene.film.sampler = Sampler::Sobol;
    let (image, cost) = Tracer::<f64>::new(&scene).render_adaptive(0.004, || ());
    scene.film.samples = 4096;
    let reference = Tracer::<f64>::new(&scene).render(|| ());
    let error = root_mean_square_error(&image, &reference);
    assert!(error < 0.004 && cost.error <= 0.004, "{error} {cost:?}");
    let [most, fewest] = cost.per_pixel;
    assert!(
        fewest == 16 && most > fewest,
        "the sky needs fewer than the shadows: {cost:?}"
    );
}

#[test]
fn every_sampler_and_sample_count_gives_finite_images() {
    let finite = |image: &Image| image.pixels().iter().flatten().all(|part| part.is_finite());
    for name in ["09", "13"] {
        for sampler in [Sampler::Independent, Sampler::Stratified, Sampler::Sobol] {
            for samples in [1, 2, 3, 7, 16, 37, 64, 257, 512] {
                let mut scene = exercise(name, [16, 9]);
                scene.film.sampler = sampler;
                scene.film.samples = samples;
                let label = format!("{name} {sampler:?} {samples}");
                assert!(finite(&Tracer::<f64>::new(&scene).render(|| ())), "{label}");
                assert!(finite(&Tracer::<f32>::new(&scene).render(|| ())), "{label}, f32");
            }
        }
    }
}

#[test]
fn sobol_pairs_on_the_square_edge_have_nonzero_density() {
    // In these pixels Sobol's sequence contains a pair with a 0, which maps to the edge of the disk from
    // which lobes are sampled.
    let mut scene = exercise("13", [640, 360]);
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

// Bit-identical results in all instruction sets, thread counts and packet sizes.

/// Returns the bits of an image.
fn bits(image: &Image) -> Vec<[u32; 4]> {
    image
        .pixels()
        .iter()
        .map(|pixel| pixel.map(f32::to_bits))
        .collect()
}

/// For a scene of 45×27 pixels.
fn assert_same_bits<T: Backend>(name: &str, scene: &Scene) {
    let tracers: Vec<_> = Level::all()
        .map(|level| Tracer::<T>::with_level(scene, FrameTime::default(), level, None))
        .collect();
    let expected = bits(&tracers[0].render(|| ()));
    for tracer in &tracers {
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            let image = pool.install(|| tracer.render(|| ()));
            assert!(
                bits(&image) == expected,
                "{name}: {:?}, {threads} threads",
                tracer.level
            );
        }
        // Single pixels do not use packets.
        let pixels = (0..27).flat_map(|y| (0..45).map(move |x| [x, y]));
        for ([x, y], expected) in pixels.zip(&expected) {
            let [r, g, b] = tracer.pixel(x, y).map(|c| (c.to_f64() as f32).to_bits());
            assert_eq!(
                [r, g, b],
                expected[..3],
                "{name}: {:?}, pixel {x}, {y}",
                tracer.level
            );
        }
    }
}

/// Mirrors and glass of all kinds of shapes that reflect themselves and each other, and a number of samples
/// that does not fill a square grid.
const MIXED: &str = r#"
ambient = [0.1, 0.1, 0.1]
[film]
size = [45, 27]
max_depth = 6
samples = 6
sampler = "stratified"
[background]
bottom = [0.9, 0.8, 0.7]
top = [0.2, 0.4, 0.8]
[[light]]
position = [-3.0, 4.0, 1.0]
color = [0.5, 0.5, 0.5]
[[light]]
position = [2.0, 5.0, -4.0]
color = [0.4, 0.3, 0.3]
radius = 0.5
[[plane]]
point = [0.0, -1.0, 0.0]
normal = [0.0, 1.0, 0.0]
material = { model = "mirror", color = [0.8, 0.9, 0.9] }
[[ellipsoid]]
center = [0.9, 0.0, -4.0]
radii = [0.5, 0.8, 0.4]
material = { model = "glass", color = [1.0, 0.9, 1.0], ior = 1.5, fresnel = "schlick" }
[[sphere]]
center = [-0.8, -0.1, -4.0]
radius = 0.9
material = { model = "glass", color = [1.0, 1.0, 1.0], ior = 1.5, fresnel = "exact" }
[[sphere]]
center = [-0.8, -0.1, -4.0]
radius = 0.4
material = { model = "mirror", color = [0.9, 0.9, 0.9] }
[[sphere]]
center = [0.3, 0.6, -6.0]
radius = 0.9
material = { model = "glossy", color = [0.9, 0.3, 0.2], exponent = 20.0 }
[[box]]
center = [0.2, -0.6, -3.2]
size = [0.5, 0.6, 0.4]
axis = [0.2, 1.0, 0.1]
angle = 40.0
material = { model = "glass", color = [0.9, 1.0, 1.0], ior = 1.4 }
[[box]]
center = [1.6, 0.2, -5.5]
size = [0.7, 2.0, 0.7]
material = { model = "lambert", color = [0.3, 0.6, 0.9], checker = { color = [0.9, 0.9, 0.8], size = 0.25, space = "object" } }
"#;

/// Cameras that are turned.
const TURNED: [&str; 2] = [
    "[camera]\neye = [1, 2, 1]\nlook_at = [0, 0, -4]\nroll = 20\nfov = 50\n",
    "[camera]\neye = [1, 2, 1]\nlook_at = [0, 0, -4]\nprojection = \"parallel\"\nwidth = 4\n",
];

#[test]
fn every_instruction_set_and_number_of_threads_paints_the_same_bits() {
    let mut scenes: Vec<_> = (1..=15)
        .map(|exercise| {
            let name = format!("{exercise:02}");
            let mut scene = self::exercise(&name, [45, 27]);
            scene.film.samples = scene.film.samples.min(2);
            (name, scene)
        })
        .collect();
    scenes.push(("mixed".to_owned(), scene(MIXED)));
    // As many samples as are next to each other in packets.
    for (name, samples, sampler) in [("mixed", 8, Sampler::Stratified), ("13", 16, Sampler::Sobol)] {
        let mut scene = if name == "mixed" {
            scene(MIXED)
        } else {
            exercise(name, [45, 27])
        };
        (scene.film.samples, scene.film.sampler) = (samples, sampler);
        scenes.push((format!("{name}, {samples} samples"), scene));
    }
    for camera in TURNED {
        scenes.push((camera.to_owned(), scene(&(MIXED.to_owned() + camera))));
    }
    for (name, scene) in &scenes {
        assert_same_bits::<f32>(name, scene);
        assert_same_bits::<f64>(name, scene);
    }
}

#[test]
fn refitted_tree_renders_the_same_as_a_new_one() {
    let mut text = String::from(
        "[film]\nsize = [48, 32]\nmax_depth = 2\n[[motion]]\nname = \"turn\"\npivot = [0, 0, -9]\naxis = [0, 1, 0]\nframes = 40\n\
         [[motion]]\nname = \"roll\"\npivot = [0, 1, -9]\naxis = [1, 0, 0]\nframes = 7\n",
    );
    for at in 0..300 {
        let (x, y, z) = (at % 10, at / 10 % 6, at / 60);
        // Turning, rolling and static spheres are neighbors at first, but not later.
        let motion = ["", "motion = \"turn\"\n", "motion = \"roll\"\n"][at % 3];
        let model = if at % 7 == 0 { "mirror" } else { "facing" };
        let _ = write!(
            text,
            "[[sphere]]\ncenter = [{}, {}, {}]\nradius = 0.3\nmaterial = {{ model = \"{model}\", color = [0.{}, 0.5, 0.{}] }}\n{motion}",
            x as f64 - 4.5,
            y as f64 - 2.5,
            -7.0 - z as f64,
            1 + at % 9,
            1 + at % 8,
        );
    }
    let scene = scene(&text);
    let at = |frame| FrameTime { frame, time: 0.0 };
    let mut moved = Tracer::<f64>::at(&scene, at(0));
    let mut images = Vec::new();
    for frame in [1, 2, 9, 20, 21, 0] {
        moved = moved.moved(&scene, at(frame));
        let image = moved.render(|| ());
        let rebuilt = Tracer::<f64>::at(&scene, at(frame)).render(|| ());
        assert_eq!(image.pixels(), rebuilt.pixels(), "frame {frame}");
        images.push(rebuilt);
    }
    assert_ne!(images[0].pixels(), images[3].pixels());
}
