//! Light is neither made nor lost, and integrals are those of the textbooks.

use super::*;

#[test]
fn a_white_furnace_stays_white() {
    // Whatever direction is drawn, it comes from the same radiance and none is lost.
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
fn glass_loses_no_light() {
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
fn a_sphere_above_a_plane_gives_the_irradiance_of_the_textbooks() {
    // E = π L (R/d)² straight below a sphere of radiance L, and so the radiance color · L · (R/d)².
    let text =
        "[film]\nsize = [1, 1]\nsamples = 1024\nsampler = \"sobol\"\nintegrator = \"path\"\nmax_depth = 2\n\
                [camera]\neye = [0, 0, 5]\n[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n\
                material = { model = \"diffuse\", color = [0.8, 0.8, 0.8] }\n"
        .to_owned()
        // Behind the eye, so that the eye sees the plane.
        + &ball("[0, 0, 8]", "2", "{ model = \"emitter\", color = [3, 3, 3] }");
    let [r, _, _] = pixel(&text, 0, 0);
    // The pixel is two units wide at a distance of 2, and so 5 at 5: its mean is less than its middle's value. Hence
    // a small pixel: the screen far away.
    let narrow = text.replace("eye = [0, 0, 5]", "eye = [0, 0, 5]\nscreen_distance = 1000");
    let [middle, _, _] = pixel(&narrow, 0, 0);
    let expected = 0.8 * 3.0 * (2.0f64 / 8.0).powi(2);
    assert!((middle - expected).abs() < 2e-3 * expected, "{middle} {expected}");
    assert!(r < middle);
}

#[test]
fn the_light_of_a_sphere_is_the_mean_over_its_cone() {
    // Straight below: the mean cosine over a cone of half angle θ is (1 + cos θ) / 2.
    let text = "[film]\nsize = [1, 1]\nsamples = 1024\nsampler = \"stratified\"\n[camera]\neye = [0, 0, 5]\n\
                screen_distance = 1000\n[[light]]\nposition = [0, 0, 8]\nradius = 4\n[[plane]]\npoint = [0, 0, 0]\n\
                normal = [0, 0, 1]\nmaterial = { model = \"lambert\", color = [1, 1, 1] }\n";
    let [r, _, _] = pixel(text, 0, 0);
    let expected = 0.5 * (1.0 + 0.75f64.sqrt());
    assert!((r - expected).abs() < 1e-4, "{r} {expected}");
}
