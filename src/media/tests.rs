//! Properties of the stand-ins, checked and printed: `cargo test --release --package toyproof-media --lib --
//! --ignored --nocapture figures` prints the figures of `docs/evidence/media.md` and writes the images to
//! `target/stand-ins`.

use std::time::Instant;

use toyproof_image::{Image, pcg};

use crate::{Content, StandIn};

/// Mean and standard deviation of the components of the site's images, in 8-bit levels, measured on its
/// files, and the slope of their spectra as [`slope`] measures it.
#[rustfmt::skip]
const SITE: &[(&str, [u8; 3], [u8; 3], f64)] = &[
    ("4dfGRn", [147, 136, 123], [66, 68, 66], -2.06),
    ("XdX3Rn", [63, 70, 55], [52, 57, 52], -2.94),
    ("4dXGRn", [153, 128, 115], [26, 28, 26], -1.98),
    ("4sXGRn", [121, 118, 123], [17, 17, 20], -1.85),
    ("XsfGRn", [147, 80, 41], [23, 18, 15], -1.71),
    ("XdfGRn", [85, 65, 49], [37, 35, 30], -2.26),
    ("4sfGRn", [80, 85, 80], [51, 51, 52], -2.12),
    ("4dX3Rn", [123, 102, 78], [54, 49, 42], -1.58),
    ("XsX3Rn", [105, 69, 51], [62, 51, 40], -2.52),
    ("Xsf3Rr", [116, 113, 110], [29, 29, 30], -1.89),
    ("4df3Rr", [148, 117, 104], [31, 32, 32], -2.22),
    ("XdXGzr", [130, 119, 106], [36, 35, 35], -3.25),
    ("XsXGRn", [142, 122, 90], [51, 51, 48], -2.23),
];

/// The media that read as (r, 0, 0, 1), and those with an alpha of their own; all others are opaque.
const ONE_COMPONENT: [&str; 5] = ["4sf3Rr", "4dXGzn", "4sf3Rn", "Xdf3zn", "4sfGRr"];
const FOUR_COMPONENTS: [&str; 6] = ["Xsf3zn", "XdXGzn", "XsBSR3", "4dXGzr", "Xsf3Rn", "XdX3Rr"];

/// Size and number of the images of each stand-in, and a hash of their texels.
#[rustfmt::skip]
const EXPECTED: &[(&str, [u32; 2], usize, u32)] = &[
    ("4dfGRn", [512, 512], 1, 0x8076_feba),
    ("Xsf3zn", [256, 256], 1, 0x80f3_f82d),
    ("XdX3Rn", [1024, 1024], 1, 0x6c2d_dd7d),
    ("4dXGzr", [1024, 1024], 1, 0x809b_9f50),
    ("4dXGRn", [512, 512], 1, 0x866a_e3ec),
    ("4dXGzn", [256, 256], 1, 0xc3af_8519),
    ("4sf3Rr", [512, 512], 1, 0x4b9b_e479),
    ("XsBSR3", [1024, 1024], 1, 0x18c6_4d2d),
    ("4sXGRn", [512, 512], 1, 0x56e2_8cc0),
    ("XsfGRn", [1024, 1024], 1, 0x6f2e_a91f),
    ("XdfGRn", [512, 512], 1, 0x74f1_2324),
    ("4sfGRn", [1024, 1024], 1, 0x417b_3b32),
    ("4sf3Rn", [64, 64], 1, 0x3b6b_31e1),
    ("XdXGzn", [64, 64], 1, 0xd993_61f2),
    ("4dX3Rn", [512, 512], 1, 0xe12a_3c01),
    ("Xdf3zn", [8, 8], 1, 0x8edf_73dc),
    ("XsX3Rn", [1024, 1024], 1, 0x3fcc_d728),
    ("Xsf3Rr", [1024, 1024], 1, 0x0116_5685),
    ("4df3Rr", [1024, 1024], 1, 0xaac2_830d),
    ("Xsf3Rn", [256, 32], 1, 0xc8e9_40ad),
    ("XdXGzr", [1024, 1024], 1, 0x706d_9e86),
    ("XsXGRn", [1024, 1024], 1, 0x68a6_1e1e),
    ("XsfGzn", [512, 512], 6, 0xfa07_0c4d),
    ("4sfGzn", [64, 64], 6, 0x5c4b_d96e),
    ("XsX3zn", [256, 256], 6, 0x317b_338a),
    ("4sX3zn", [64, 64], 6, 0xe281_9e0a),
    ("XdX3zn", [256, 256], 6, 0xba45_2e38),
    ("4dX3zn", [64, 64], 6, 0x501a_440e),
    ("4sfGRr", [32, 32], 32, 0x300d_7c62),
    ("XdX3Rr", [32, 32], 32, 0x1889_4785),
    ("Xdf3Rn", [512, 396], 1, 0x15d6_51af),
    ("XdfGRr", [512, 396], 1, 0x15d6_51af),
    ("4sX3Rn", [320, 240], 1, 0x34b1_889e),
    ("4df3zn", [320, 240], 1, 0xd7b5_7e9f),
    ("4sf3zn", [640, 480], 1, 0x1a7e_c195),
];

/// The images of a stand-in; of a film, its first.
fn images(stand_in: &StandIn) -> Vec<Image> {
    match stand_in.content {
        Content::Texture(compute) => vec![compute()],
        Content::Cube(compute) => compute().to_vec(),
        Content::Volume(compute) => compute(),
        Content::Film(compute) => vec![compute(0.0)],
    }
}

/// The mean of red, green and blue of each pixel.
fn gray(image: &Image) -> Vec<f64> {
    let mean = |&[r, g, b, _]: &[f32; 4]| f64::from(r + g + b) / 3.0;
    image.pixels().iter().map(mean).collect()
}

fn variance(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / values.len() as f64
}

/// The exponent of the power spectrum as a function of the frequency, fitted to the six finest octaves. The
/// variance that is lost when 2×2 pixels become one is that of an octave; in two dimensions, a spectrum kᵃ
/// has the variances s^(−2−a) at the scales s.
fn slope(image: &Image) -> f64 {
    let mut side = image.size()[0] as usize;
    let mut level = gray(image);
    let mut variances = vec![variance(&level)];
    for _ in 0..6 {
        let at = |x: usize, y: usize| level[y * side + x];
        let halved = (0..side / 2).flat_map(|y| (0..side / 2).map(move |x| (2 * x, 2 * y)));
        let means = halved.map(|(x, y)| (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1)) / 4.0);
        level = means.collect();
        side /= 2;
        variances.push(variance(&level));
    }
    let octaves = variances.windows(2).map(|pair| (pair[0] - pair[1]).log2());
    // The least squares of six points at −2.5, −1.5, …
    let rise: f64 = octaves
        .enumerate()
        .map(|(at, octave)| (at as f64 - 2.5) * octave)
        .sum();
    -2.0 - rise / 17.5
}

/// The mean difference of neighbors across the sides, divided by that inside: to the right, and upwards.
fn seams(image: &Image) -> [f64; 2] {
    let [width, height] = image.size();
    let values = gray(image);
    let at = |x: u32, y: u32| values[(y % height * width + x % width) as usize];
    let columns = |x: u32| (0..height).map(|y| (at(x + 1, y) - at(x, y)).abs()).sum::<f64>();
    let rows = |y: u32| (0..width).map(|x| (at(x, y + 1) - at(x, y)).abs()).sum::<f64>();
    let ratio = |count: u32, step: &dyn Fn(u32) -> f64| {
        step(count - 1) / ((0..count - 1).map(step).sum::<f64>() / f64::from(count - 1))
    };
    [ratio(width, &columns), ratio(height, &rows)]
}

/// Mean and standard deviation of red, green and blue, in 8-bit levels.
fn tone(image: &Image) -> [[f64; 2]; 3] {
    [0, 1, 2].map(|i| {
        let values: Vec<_> = image
            .pixels()
            .iter()
            .map(|pixel| 255.0 * f64::from(pixel[i]))
            .collect();
        [
            values.iter().sum::<f64>() / values.len() as f64,
            variance(&values).sqrt(),
        ]
    })
}

/// Checks the properties of a image of the table.
fn check_material(id: &str, image: &Image) {
    let Some(&(_, mean, deviation, site_slope)) = SITE.iter().find(|row| row.0 == id) else {
        return;
    };
    for (i, [own_mean, own_deviation]) in tone(image).into_iter().enumerate() {
        // Half a level for rounding; the rest is what clamping leaves after the last adjustment.
        assert!(
            (own_mean - f64::from(mean[i])).abs() < 1.0,
            "{id}: mean {own_mean}"
        );
        assert!(
            (own_deviation - f64::from(deviation[i])).abs() < 1.0,
            "{id}: deviation {own_deviation}"
        );
    }
    // Photographs of one material differ as much.
    let own_slope = slope(image);
    assert!((own_slope - site_slope).abs() < 0.6, "{id}: slope {own_slope}");
}

/// A hash of all texels in 8-bit levels.
fn checksum(images: &[Image]) -> u32 {
    let texels = images.iter().flat_map(Image::pixels).flatten();
    texels.fold(0, |hash, &component| {
        pcg(hash ^ (255.0 * component).round() as u32)
    })
}

/// Each stand-in is computed once, since that takes a while.
#[test]
fn stand_ins_have_the_sizes_the_components_and_the_look_of_the_sites_media_and_the_same_bits_everywhere() {
    assert_eq!(StandIn::ALL.len(), EXPECTED.len());
    for (stand_in, &(id, size, count, expected)) in StandIn::ALL.iter().zip(EXPECTED) {
        assert_eq!(stand_in.id, id);
        let images = images(stand_in);
        assert_eq!(images.len(), count, "{id}");
        assert!(images.iter().all(|image| image.size() == size), "{id}");
        assert_eq!(checksum(&images), expected, "{id}: `figures` prints the hashes");
        let texels = || images.iter().flat_map(Image::pixels);
        if ONE_COMPONENT.contains(&id) {
            assert!(texels().all(|texel| texel[1..] == [0.0, 0.0, 1.0]), "{id}");
        } else if !FOUR_COMPONENTS.contains(&id) {
            assert!(texels().all(|texel| texel[3] == 1.0), "{id}");
        }
        check_material(id, &images[0]);
        // A view of a street has an end, as the site's. White noise and figures have no neighbors.
        if SITE.iter().any(|row| row.0 == id && id != "4dfGRn") || ["4sf3Rr", "XsBSR3"].contains(&id) {
            for ratio in seams(&images[0]) {
                assert!((0.5..2.0).contains(&ratio), "{id}: {ratio}");
            }
        }
    }
}

#[test]
#[ignore = "prints the figures of docs/evidence/media.md, and writes images"]
#[expect(clippy::print_stdout, reason = "it is what the test is for")]
fn figures() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/stand-ins");
    std::fs::create_dir_all(&folder).unwrap();
    for stand_in in StandIn::ALL {
        let (id, start) = (stand_in.id, Instant::now());
        let images = images(stand_in);
        let milliseconds = 1e3 * start.elapsed().as_secs_f64();
        let ([width, height], count) = (images[0].size(), images.len());
        let hash = checksum(&images);
        let (high, low) = (hash >> 16, hash & 0xffff);
        println!("(\"{id}\", [{width}, {height}], {count}, 0x{high:04x}_{low:04x}), {milliseconds:.0} ms");
        for (at, image) in images.iter().enumerate().take(6) {
            let texel = |x, y| image::Rgba(image.get(x, height - 1 - y).map(toyproof_image::quantize));
            let file = folder.join(format!("{id}_{at}.png"));
            image::RgbaImage::from_fn(width, height, texel)
                .save(file)
                .unwrap();
        }
        let Some(&(_, _, _, site_slope)) = SITE.iter().find(|row| row.0 == id) else {
            continue;
        };
        let [mean, deviation] = [0, 1].map(|i| {
            tone(&images[0])
                .map(|component| format!("{:.0}", component[i]))
                .join(", ")
        });
        let ([right, up], slope) = (seams(&images[0]), slope(&images[0]));
        println!("| {id} | {mean} | {deviation} | {right:.1}, {up:.1} | {slope:.1} | {site_slope:.1} |");
    }
}
