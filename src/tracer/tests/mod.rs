//! Pictures whose pixels are known.

mod energy;
mod same_bits;
mod samples;

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use toyproof_diagnostic::{File, Files};
use toyproof_scene::{self as scene, Sampler};

use super::*;

fn scene(text: &str) -> Scene {
    let mut files = Files::default();
    let file = files.add(File::new("s", text));
    scene::parse(&files, file).unwrap()
}

fn pixel(text: &str, x: u32, y: u32) -> [f64; 3] {
    Tracer::<f64>::new(&scene(text)).pixel(x, y)
}

fn near(actual: [f64; 3], expected: [f64; 3]) {
    for (a, e) in actual.iter().zip(expected) {
        assert!((a - e).abs() < 1e-12, "{actual:?} is not {expected:?}");
    }
}

/// One pixel that looks straight along −z.
const ONE: &str = "[film]\nsize = [1, 1]\n";

fn ball(center: &str, radius: &str, material: &str) -> String {
    format!("[[sphere]]\ncenter = {center}\nradius = {radius}\nmaterial = {material}\n")
}

#[test]
fn a_sphere_straight_ahead_faces_the_eye() {
    let text = ONE.to_owned() + &ball("[0, 0, -6]", "1.5", "{ model = \"facing\", color = [1, 0.5, 0] }");
    near(pixel(&text, 0, 0), [1.0, 0.5, 0.0]);
}

#[test]
fn the_aspect_stretches_y_and_the_picture_stands_upright() {
    let film = "[film]\nsize = [4, 2]\n[background]\nbottom = [0, 0, 0]\ntop = [1, 1, 1]\n";
    // Pixel (3, 1): x = 0.75, y = 0.5 / 2, screen at −2.
    let y = 0.25 / (0.75f64.powi(2) + 0.25f64.powi(2) + 4.0).sqrt();
    near(pixel(film, 3, 1), [0.5 * (1.0 + y); 3]);
    near(pixel(film, 0, 0), [0.5 * (1.0 - y); 3]);
}

#[test]
fn what_lies_behind_the_eye_is_not_seen_and_from_inside_the_far_side_is() {
    let facing = "{ model = \"facing\", color = [1, 1, 1] }";
    near(
        pixel(&(ONE.to_owned() + &ball("[0, 0, 6]", "1.5", facing)), 0, 0),
        [0.0; 3],
    );
    near(
        pixel(&(ONE.to_owned() + &ball("[0, 0, 1]", "3", facing)), 0, 0),
        [1.0; 3],
    );
}

#[test]
fn lambert_adds_ambient_and_each_light_by_its_cosine() {
    let text = format!(
        "ambient = [0.1, 0.1, 0.1]\n{ONE}[[light]]\nposition = [0, 5, 0]\ncolor = [0.5, 1, 1]\n{}",
        ball("[0, 0, -6]", "1", "{ model = \"lambert\", color = [1, 0.5, 1] }")
    );
    // The hit is (0, 0, −5), N = +z, L = (0, 5, 5) / √50.
    let cosine = 0.5f64.sqrt();
    near(
        pixel(&text, 0, 0),
        [0.1 + 0.5 * cosine, 0.5 * (0.1 + cosine), 0.1 + cosine],
    );
}

#[test]
fn only_what_lies_between_surface_and_light_shades_it() {
    let lit = |blocker: &str, shadow: &str| {
        let text = format!(
            "{ONE}[[light]]\nposition = [0, 0, 0]\nshadow = {shadow}\n{}{blocker}",
            ball("[0, 0, -6]", "1", "{ model = \"lambert\", color = [1, 1, 1] }")
        );
        // Straight from the side: the eye's own ray passes below the blocker.
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
fn a_mirror_shows_what_it_reflects_until_the_depth_is_spent() {
    let mirrors = ball("[0, 0, -6]", "1", "{ model = \"mirror\", color = [0.5, 1, 1] }")
        + &ball("[0, 0, 6]", "1", "{ model = \"mirror\", color = [1, 0.5, 1] }");
    let text = |depth: u32| {
        format!("[film]\nsize = [1, 1]\nmax_depth = {depth}\n[background]\ncolor = [1, 1, 1]\n{mirrors}")
    };
    // Face to face, the ray never leaves.
    near(pixel(&text(7), 0, 0), [0.0; 3]);
    let one = ball("[0, 0, -6]", "1", "{ model = \"mirror\", color = [0.5, 1, 1] }");
    let open = |depth: u32| {
        format!(
            "[film]\nsize = [1, 1]\nmax_depth = {depth}\n[background]\nbottom = [1, 1, 1]\ntop = [0.2, 1, 1]\n{one}"
        )
    };
    near(pixel(&open(1), 0, 0), [0.0; 3]);
    near(pixel(&open(2), 0, 0), [0.3, 1.0, 1.0]);
}

#[test]
fn inside_a_mirror_the_ray_goes_from_far_side_to_far_side() {
    // From the centre straight ahead and back again: never out, and never stuck at its own start.
    let text = "[film]\nsize = [1, 1]\nmax_depth = 4\n[background]\ncolor = [1, 1, 1]\n".to_owned()
        + &ball("[0, 0, 0]", "2", "{ model = \"mirror\", color = [1, 1, 1] }")
        + &ball("[0, 0, 1.5]", "0.25", "{ model = \"facing\", color = [0, 0, 1] }");
    near(pixel(&text, 0, 0), [0.0, 0.0, 1.0]);
}

#[test]
fn the_sine_hash_draws_x_first_from_a_seed_of_zero() {
    let text =
        "[film]\nsize = [1, 1]\nsampler = \"sine-hash\"\n[background]\nbottom = [0, 0, 0]\ntop = [1, 1, 1]\n";
    let draw = (1f64.sin() * 43_758.545_312_3).fract();
    let (x, y) = (-1.0, draw * 2.0 - 1.0);
    let expected = 0.5 * (1.0 + y / (x * x + y * y + 4.0f64).sqrt());
    near(pixel(text, 0, 0), [expected; 3]);
}

#[test]
fn both_precisions_agree_to_float32() {
    let text = format!(
        "[film]\nsize = [32, 18]\nmax_depth = 5\n[background]\nbottom = [0.1, 0.1, 0.3]\ntop = [0.7, 0.8, 0.9]\n{}{}",
        ball(
            "[0, 0, -6]",
            "1.5",
            "{ model = \"mirror\", color = [1, 0.9, 0.8] }"
        ),
        ball("[-1, 1, -4]", "0.7", "{ model = \"facing\", color = [1, 0, 0] }")
    );
    let single = Tracer::<f32>::new(&scene(&text)).picture(|| ());
    let double = Tracer::<f64>::new(&scene(&text)).picture(|| ());
    for (a, b) in single.pixels().iter().zip(double.pixels()) {
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() < 2e-5, "{a} {b}");
        }
    }
}

/// The scene of a rung, at another size.
fn rung(name: &str, size: [u32; 2]) -> Scene {
    let is_it = |path: &PathBuf| {
        let stem = path.file_stem().unwrap().to_str().unwrap();
        stem.starts_with(name) && path.extension().is_some_and(|extension| extension == "toml")
    };
    let mut paths = fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../glsl"))
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let text = fs::read_to_string(paths.find(is_it).unwrap()).unwrap();
    let mut scene = scene(&text);
    scene.film.size = size;
    scene
}

#[test]
fn parallel_rays_see_the_far_as_large_as_the_near() {
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
            near(pixel(&text("-3"), x, y), [expected; 3]);
            near(pixel(&text("-3000"), x, y), [expected; 3]);
        }
    }
}

#[test]
fn the_mean_is_tone_mapped_and_then_takes_its_gamma() {
    let text = "[film]\nsize = [1, 1]\ntone_map = \"reinhard\"\ngamma = 2\n[background]\ncolor = [3, 1, 0]\n";
    near(pixel(text, 0, 0), [0.75f64.sqrt(), 0.5f64.sqrt(), 0.0]);
}

#[test]
fn figures_lie_on_top_of_each_other_and_of_everything_else() {
    let disk = |radius: &str, color: &str| {
        format!("[[figure]]\noutline = \"disk\"\ncenter = [0, 0]\nradius = {radius}\ncolor = {color}\n")
    };
    let text = "[film]\nsize = [3, 1]\n[background]\ncolor = [1, 1, 1]\n".to_owned()
        + &disk("0.7", "[1, 0, 0]")
        + &disk("0.5", "[0, 1, 0]")
        + &ball("[0, 0, -6]", "9", "{ model = \"facing\", color = [1, 1, 1] }");
    near(pixel(&text, 1, 0), [0.0, 1.0, 0.0]);
    near(pixel(&text, 0, 0), [1.0, 0.0, 0.0]);
}

#[test]
fn a_scene_is_traced_at_its_moment() {
    let text = ONE.to_owned()
        + "[[motion]]\nname = \"m\"\npivot = [0, 0, 0]\nseconds = 4\n"
        + &ball("[6, 0, 0]", "1", "{ model = \"facing\", color = [1, 1, 1] }")
        + "motion = \"m\"\n";
    let at = |time: f64| Tracer::<f64>::at(&scene(&text), Moment { frame: 0, time }).pixel(0, 0);
    near(at(0.0), [0.0; 3]);
    // A quarter turn brings x to −z, straight ahead.
    near(at(1.0), [1.0; 3]);
}

/// Two mirrors that meet in the x axis, at an angle. Seen from the apex, a ray that is mirrored goes straight on through
/// copies of the wedge, so that the number of reflections and the last direction follow from two angles.
#[test]
fn a_wedge_of_mirrors_is_a_kaleidoscope() {
    let angle = 1.85f64.to_radians();
    let (sine, cosine) = angle.sin_cos();
    let color = 0.995f64;
    let text = |depth: u32| {
        // The apex lies ahead, a little below the eye; the upper mirror rises towards the eye.
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
            // As the camera has it; then as angles around the apex, from the lower mirror upwards.
            let [sx, sy] = [
                (f64::from(x) + 0.5) / 1.5 - 1.0,
                ((f64::from(y) + 0.5) / 32.0 - 1.0) * 64.0 / 3.0,
            ];
            let d = [sx, sy, -40.0];
            let length = d.iter().map(|c| c * c).sum::<f64>().sqrt();
            let start = (0.02f64).atan2(3.0);
            let end = d[1].atan2(d[2]);
            // Upwards the way round leads to larger angles, downwards to smaller ones.
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
            near(tracer.pixel(x, y), expected);
            if reflections >= 20.0 {
                near(shallow.pixel(x, y), [0.0; 3]);
            }
            most = most.max(reflections as u32);
        }
    }
    assert!((90..100).contains(&most), "{most} reflections");
}
