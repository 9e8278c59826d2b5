//! The same bits, however a picture is traced.

use super::*;

/// The bits of a picture.
fn bits(image: &Image) -> Vec<[u32; 4]> {
    image
        .pixels()
        .iter()
        .map(|pixel| pixel.map(f32::to_bits))
        .collect()
}

/// Of a scene of 45 by 27 pixels.
fn same_bits_however_it_is_traced<T: Real>(name: &str, scene: &Scene) {
    let tracers: Vec<_> = Level::all()
        .map(|level| Tracer::<T>::with_level(scene, Moment::default(), level, None))
        .collect();
    let expected = bits(&tracers[0].picture(|| ()));
    for tracer in &tracers {
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            let picture = pool.install(|| tracer.picture(|| ()));
            assert!(
                bits(&picture) == expected,
                "{name}: {:?}, {threads} threads",
                tracer.level
            );
        }
        // Pixel by pixel, no rays go together.
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

/// Mirrors and glass of every shape, which leave and meet themselves and each other, and more samples than cells in a row.
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
"#;

#[test]
fn every_instruction_set_and_number_of_threads_paints_the_same_bits() {
    let mut scenes: Vec<_> = (1..=15)
        .map(|rung| {
            let name = format!("{rung:02}");
            let mut scene = self::rung(&name, [45, 27]);
            scene.film.samples = scene.film.samples.min(2);
            (name, scene)
        })
        .collect();
    scenes.push(("mixed".to_owned(), scene(MIXED)));
    for (name, scene) in &scenes {
        same_bits_however_it_is_traced::<f32>(name, scene);
        same_bits_however_it_is_traced::<f64>(name, scene);
    }
}

#[test]
fn a_tree_that_moves_along_shows_what_a_new_one_does() {
    let mut text = String::from(
        "[film]\nsize = [48, 32]\nmax_depth = 2\n[[motion]]\nname = \"turn\"\npivot = [0, 0, -9]\naxis = [0, 1, 0]\nframes = 40\n\
         [[motion]]\nname = \"roll\"\npivot = [0, 1, -9]\naxis = [1, 0, 0]\nframes = 7\n",
    );
    for at in 0..300 {
        let (x, y, z) = (at % 10, at / 10 % 6, at / 60);
        // Those that turn, those that roll and those that stay are neighbours at first and are not later.
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
    let at = |frame| Moment { frame, time: 0.0 };
    let mut moved = Tracer::<f64>::at(&scene, at(0));
    let mut pictures = Vec::new();
    for frame in [1, 2, 9, 20, 21, 0] {
        moved = moved.moved(&scene, at(frame));
        let picture = moved.picture(|| ());
        let anew = Tracer::<f64>::at(&scene, at(frame)).picture(|| ());
        assert_eq!(picture.pixels(), anew.pixels(), "frame {frame}");
        pictures.push(anew);
    }
    assert_ne!(pictures[0].pixels(), pictures[3].pixels());
}
