//! Turned cameras, boxes and patterns, against closed forms.

use std::f64::consts::FRAC_1_SQRT_2;

use toyproof_scene::FrameTime;

use crate::Tracer;
use crate::tests::{ONE, assert_near, pixel, scene};

/// The direction of the camera ray through the center of a pixel.
fn direction(text: &str, x: u32, y: u32) -> [f64; 3] {
    let [_, direction] = Tracer::<f64>::new(&scene(text)).camera_ray(x, y);
    direction
}

fn camera(size: &str, keys: &str) -> String {
    format!("[film]\nsize = {size}\n[camera]\n{keys}\n[background]\n")
}

#[test]
fn the_camera_looks_at_a_point() {
    let toward = |keys: &str| direction(&camera("[1, 1]", keys), 0, 0);
    let s = FRAC_1_SQRT_2;
    assert_near(toward("look_at = [0, 0, -5]"), [0.0, 0.0, -1.0]);
    assert_near(toward("eye = [1, 2, 3]\nlook_at = [4, 2, 3]"), [1.0, 0.0, 0.0]);
    assert_near(toward("eye = [0, 3, 0]\nlook_at = [0, 0, 3]"), [0.0, -s, s]);
    assert_near(
        toward("eye = [0, 3, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, -1]"),
        [0.0, -1.0, 0.0],
    );
    assert_near(
        toward("eye = [1e300, 0, 0]\nlook_at = [0, 0, -1e300]"),
        [-s, 0.0, -s],
    );
}

#[test]
fn the_field_of_view_is_horizontal() {
    // The right edge of the image is half a pixel from the center of the last one.
    for (fov, size) in [(90.0f64, 2001), (60.0, 2001), (20.0, 1001)] {
        for height in [1, 3000] {
            let text = camera(&format!("[{size}, {height}]"), &format!("fov = {fov:?}"));
            let [x, _, z] = direction(&text, size - 1, height / 2);
            let share = f64::from(size - 1) / f64::from(size);
            let expected = (0.5 * fov).to_radians().tan() * share;
            assert!((x / -z - expected).abs() < 1e-12, "{fov}: {} {expected}", x / -z);
        }
    }
    // The default screen distance.
    let default = 2.0 * 0.5f64.atan().to_degrees();
    let [with, without] = [format!("fov = {default:?}"), String::new()]
        .map(|keys| direction(&camera("[640, 360]", &keys), 17, 300));
    assert_near(with, without);
}

#[test]
fn the_camera_rolls_clockwise() {
    let of = |keys: &str| direction(&camera("[3, 1]", keys), 2, 0);
    // Rolled by a right angle, the camera's right side points down, and its upper side to the right.
    let [x, y, z] = of("screen_distance = 2");
    assert!(x > 0.0 && y == 0.0);
    assert_near(of("screen_distance = 2\nroll = 90"), [0.0, -x, z]);
    assert_near(of("screen_distance = 2\nroll = -180"), [-x, 0.0, z]);
    assert_near(of("screen_distance = 2\nup = [1, 0, 0]"), [0.0, -x, z]);
    let both = "screen_distance = 2\neye = [0, 0, 5]\nlook_at = [9, 0, 5]\nroll = 90";
    assert_near(of(both), [-z, -x, 0.0]);
}

#[test]
fn parallel_rays_start_on_the_turned_screen() {
    let text = camera(
        "[4, 4]",
        "eye = [1, 2, 3]\nlook_at = [9, 2, 3]\nprojection = \"parallel\"\nwidth = 8",
    );
    // Looking along x, the right side of the image is z. Pixels are 2 wide.
    let [origin, direction] = Tracer::<f64>::new(&scene(&text)).camera_ray(3, 0);
    assert_near(origin, [1.0, 2.0 - 3.0, 3.0 + 3.0]);
    assert_near(direction, [1.0, 0.0, 0.0]);
}

fn cuboid(keys: &str, material: &str) -> String {
    format!("[[box]]\n{keys}\nmaterial = {{ {material} }}\n")
}

const FACING: &str = "model = \"facing\", color = [1, 1, 1]";

#[test]
fn boxes_face_the_eye_by_the_angle_of_their_faces() {
    let front = |keys: &str| pixel(&(ONE.to_owned() + &cuboid(keys, FACING)), 0, 0);
    assert_near(front("center = [0, 0, -6]\nsize = [1, 2, 3]"), [1.0; 3]);
    // From inside.
    assert_near(front("center = [0, 0, 1]\nsize = [9, 9, 9]"), [1.0; 3]);
    assert_near(front("center = [0, 0, 6]\nsize = [1, 2, 3]"), [0.0; 3]);
    assert_near(front("center = [1, 0, -6]\nsize = [1, 2, 3]"), [0.0; 3]);
    // Turned counter-clockwise as seen from above, by 30°: the front face by as much, the right one by 60°.
    let turned = |x: f64| front(&format!("center = [{x}, 0, -6]\nsize = [2, 2, 2]\nangle = 30"));
    assert_near(turned(0.0), [30f64.to_radians().cos(); 3]);
    assert_near(turned(0.9), [60f64.to_radians().cos(); 3]);
    let upside_down = "center = [0.9, 0, -6]\nsize = [2, 2, 2]\naxis = [0, -3, 0]\nangle = -30";
    assert_near(front(upside_down), [60f64.to_radians().cos(); 3]);
}

#[test]
fn boxes_cast_shadows_and_are_lit() {
    let lit = |blocker: &str| {
        let text = format!(
            "{ONE}[[light]]\nposition = [0, 3, -2]\n{}{blocker}",
            cuboid(
                "center = [0, 0, -6]\nsize = [2, 2, 2]",
                "model = \"lambert\", color = [1, 1, 1]"
            )
        );
        pixel(&text, 0, 0)[0]
    };
    // The hit is (0, 0, −5), N = +z, L = (0, 3, 3) / √18.
    assert!((lit("") - FRAC_1_SQRT_2).abs() < 1e-12);
    let between = |y: f64| cuboid(&format!("center = [0, {y}, -3.5]\nsize = [9, 0.2, 0.2]"), FACING);
    assert_eq!(lit(&between(1.5)), 0.0);
    assert!((lit(&between(2.0)) - FRAC_1_SQRT_2).abs() < 1e-12);
}

/// Straight through a slab of tinted glass between two skies: each surface reflects F and transmits 1 − F,
/// times the color.
#[test]
fn a_glass_box_reflects_and_transmits_the_geometric_series() {
    let glass = "model = \"glass\", color = [0.9, 1, 0.5], ior = 1.5";
    let text = "[film]\nsize = [1, 1]\nmax_depth = 16\n[background]\ncolor = [1, 1, 1]\n".to_owned()
        + &cuboid("center = [0, 0, -6]\nsize = [2, 2, 2]", glass);
    let f = 0.2f64.powi(2);
    let expected = [0.9, 1.0, 0.5].map(|c: f64| {
        let transmitted = c * (1.0 - f);
        c * f + transmitted * transmitted / (1.0 - c * f)
    });
    let actual = pixel(&text, 0, 0);
    for (a, e) in actual.iter().zip(expected) {
        assert!((a - e).abs() < 1e-12, "{actual:?} is not {expected:?}");
    }
    // From inside.
    let inside = text.replace("-6]\nsize", "0]\nsize");
    let expected = [0.9, 1.0, 0.5].map(|c: f64| c * (1.0 - f) / (1.0 - c * f));
    for (a, e) in pixel(&inside, 0, 0).iter().zip(expected) {
        assert!((a - e).abs() < 1e-12, "{a} is not {e}");
    }
}

/// A plane-parallel plate shifts a ray and does not turn it: the sky behind it is that of the camera ray.
#[test]
fn a_glass_box_does_not_turn_rays_between_opposite_faces() {
    let sky = "[film]\nsize = [9, 9]\nmax_depth = 3\n[background]\nbottom = [0, 0, 0]\ntop = [1, 1, 1]\n";
    let plate = cuboid(
        "center = [0, 0, -4]\nsize = [99, 99, 0.5]\naxis = [1, 0, 0]\nangle = 20",
        "model = \"glass\", color = [1, 1, 1], ior = 1.5, fresnel = \"schlick\"",
    );
    let (with, without) = (
        Tracer::<f64>::new(&scene(&(sky.to_owned() + &plate))),
        Tracer::<f64>::new(&scene(sky)),
    );
    for at in 0..81 {
        let (x, y) = (at % 9, at / 9);
        let [_, d] = with.camera_ray(x, y);
        // Schlick's reflectance on both sides, and its reflection once at the front.
        let n = [0.0, -20f64.to_radians().sin(), 20f64.to_radians().cos()];
        let cosine = (0..3).map(|i| n[i] * d[i]).sum::<f64>().abs();
        let f = 0.04 + 0.96 * (1.0 - cosine).powi(5);
        let reflected_y = d[1] - 2.0 * n[1] * (0..3).map(|i| n[i] * d[i]).sum::<f64>();
        let [seen, _, _] = without.pixel(x, y);
        let expected = f * 0.5 * (1.0 + reflected_y) + (1.0 - f) * (1.0 - f) * seen;
        assert_near(with.pixel(x, y), [expected; 3]);
    }
}

/// Renders 8×8 pixels, 1 wide, with parallel rays along −z; true where the second color is.
fn second_color(surface: &str, time: f64) -> Vec<Vec<bool>> {
    let text = format!(
        "[film]\nsize = [8, 8]\n[camera]\neye = [0, 0, 20]\nprojection = \"parallel\"\nwidth = 8\n{surface}"
    );
    let tracer = Tracer::<f64>::at(&scene(&text), FrameTime { frame: 0, time });
    let row = |y| (0..8).map(|x| tracer.pixel(x, y)[1] == 0.0).collect();
    (0..8).map(row).collect()
}

/// Evaluates at the centers of the pixels.
fn expected(is_second: impl Fn(f64, f64) -> bool) -> Vec<Vec<bool>> {
    let center = |at: u32| f64::from(at) - 3.5;
    let row = |y| (0..8).map(|x| is_second(center(x), center(y))).collect();
    (0..8).map(row).collect()
}

fn is_odd(sum: f64) -> bool {
    sum.rem_euclid(2.0) == 1.0
}

const COLORS: &str = "model = \"emitter\", color = [1, 1, 0]";

#[test]
fn checkers_of_boxes_begin_at_a_corner_of_each_face() {
    let front = |keys: &str, pattern: &str| {
        let material = format!("{COLORS}, checker = {{ color = [1, 0, 0], {pattern} }}");
        second_color(&cuboid(keys, &material), 0.0)
    };
    // The corner of the front face is at (−5, −6). Its z is a multiple of the squares' side.
    let own = |x: f64, y: f64| is_odd(((x + 5.0) / 1.5).floor() + ((y + 6.0) / 1.5).floor());
    let keys = "center = [0, 0, 0]\nsize = [10, 12, 3]";
    assert_eq!(front(keys, "size = 1.5, space = \"object\""), expected(own));
    // Seen from below after a turn by 90° about x: y of the box is z.
    let keys = "center = [0, 0, 0]\nsize = [10, 3, 12]\naxis = [1, 0, 0]\nangle = 90";
    let turned = |x: f64, y: f64| is_odd(((x + 5.0) / 1.5).floor() + ((6.0 - y) / 1.5).floor());
    assert_eq!(front(keys, "size = 1.5, space = \"object\""), expected(turned));
    // In the coordinates of the scene: columns along y.
    let world = |x: f64, _: f64| is_odd((x / 1.5).floor() + (1.6f64 / 1.5).floor());
    let keys = "center = [0, 0, 0]\nsize = [10, 12, 3.2]";
    assert_eq!(front(keys, "size = 1.5"), expected(world));
}

#[test]
fn stripes_follow_each_other_along_their_direction() {
    let plane = |pattern: &str| {
        let text = format!(
            "[[plane]]\npoint = [0.3, 0.2, 0]\nnormal = [0, 0, 1]\nmaterial = {{ {COLORS}, stripes = {{ color = [1, 0, 0], {pattern} }} }}\n"
        );
        second_color(&text, 0.0)
    };
    let world = |x: f64, y: f64| is_odd(((0.6 * x + 0.8 * y) / 1.3137).floor());
    assert_eq!(plane("size = 1.3137, direction = [3, 4, 0]"), expected(world));
    // In the plane's own coordinates, z of the scene is y, and y of the scene is −z.
    let own = |x: f64, y: f64| is_odd(((0.6 * (x - 0.3) - 0.8 * (y - 0.2)) / 1.3137).floor());
    assert_eq!(
        plane("size = 1.3137, direction = [0.6, 0, 0.8], space = \"object\""),
        expected(own)
    );
}

#[test]
fn patterns_in_the_coordinates_of_a_surface_move_with_it() {
    let ball = |space: &str| {
        format!(
            "[[motion]]\nname = \"m\"\npivot = [0, 0, 0]\naxis = [0, 0, 1]\nseconds = 4\n\
             [[sphere]]\ncenter = [0, 0, 0]\nradius = 9\nmotion = \"m\"\n\
             material = {{ {COLORS}, stripes = {{ color = [1, 0, 0], size = 1.3, direction = [1, 0, 0]{space} }} }}\n"
        )
    };
    let along_x = expected(|x, _| is_odd((x / 1.3).floor()));
    let along_y = expected(|_, y| is_odd((y / 1.3).floor()));
    let own = ball(", space = \"object\"");
    assert_eq!(second_color(&own, 0.0), along_x);
    // A quarter turn brings x to y.
    assert_eq!(second_color(&own, 1.0), along_y);
    assert_eq!(second_color(&ball(""), 1.0), along_x);
}

/// An emitter's light has the color of the point of the emitter from which it comes.
#[test]
fn striped_emitters_light_with_the_mean_of_their_colors() {
    let radiance = |color: &str| {
        let text = format!(
            "[film]\nsize = [1, 1]\nsamples = 1024\nsampler = \"sobol\"\nintegrator = \"path\"\nmax_depth = 2\n\
             [camera]\neye = [0, 0, 5]\nscreen_distance = 1000\n\
             [[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = {{ model = \"diffuse\", color = [0.8, 0.8, 0.8] }}\n\
             [[sphere]]\ncenter = [0, 0, 8]\nradius = 2\nmaterial = {{ model = \"emitter\", {color} }}\n"
        );
        pixel(&text, 0, 0)[0]
    };
    // Stripes on both sides of the plane x = 0, far thinner than the emitter is wide.
    let striped = "color = [6, 6, 6], stripes = { color = [0, 0, 0], size = 0.01, direction = [1, 0, 0] }";
    let [uniform, striped] = [radiance("color = [3, 3, 3]"), radiance(striped)];
    assert!((uniform - striped).abs() < 0.03 * uniform, "{uniform} {striped}");
}
