//! Environments as cube maps: a color for each direction, so that faces meet without seams, and blurred
//! forms of them.

mod basilica;
mod buildings;
mod file;
mod forest;

use std::sync::LazyLock;

use rayon::prelude::*;
use toyproof_image::{Image, pcg};

pub(crate) use self::basilica::basilica;
pub(crate) use self::buildings::{GALLERY, LONDON};
pub use self::file::read_cube;
pub(crate) use self::forest::forest;
use crate::color::{Color, in_levels};
use crate::field::{mix, unit};

/// A direction or a position: x to the right, y up, z towards the viewer, right-handed.
pub(crate) type Vector = [f32; 3];

/// The direction of a point of a face, `u` to the right and `v` upwards in its file, each from 0 to 1, as
/// [`toyproof_image::cube::texel_direction`] has it for the centers of texels. The file's first row is t = 0.
/// The length is between 1 and √3.
fn face_direction(face: usize, u: f32, v: f32) -> Vector {
    let (s, t) = (2.0 * u - 1.0, 1.0 - 2.0 * v);
    match face {
        0 => [1.0, -t, -s],
        1 => [-1.0, -t, s],
        2 => [s, 1.0, t],
        3 => [s, -1.0, -t],
        4 => [s, -t, 1.0],
        _ => [-s, -t, -1.0],
    }
}

/// A unit vector.
pub(crate) fn normalized(v: Vector) -> Vector {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|component| component / length)
}

/// The six faces of an environment, of two samples for each texel, rounded to 8-bit levels. Brighter colors
/// than white become white, as in a photograph.
pub(crate) fn sharp(side: u32, environment: fn(Vector) -> Color) -> [Image; 6] {
    faces(side, |face, u, v| {
        let quarter = 0.25 / side as f32;
        let mut sum = [0.0; 3];
        for (du, dv) in [(-quarter, -quarter), (quarter, quarter)] {
            let color = environment(normalized(face_direction(face, u + du, v + dv)));
            sum = [0, 1, 2].map(|i| sum[i] + 0.5 * color[i].min(1.0));
        }
        sum
    })
}

/// The six faces of the environment as a rough surface reflects it: the mean around each direction, weighted
/// by the fourth power of the cosine of the angle. Colors brighter than white count as they are, so that
/// the surroundings of a sky or a window are white.
pub(crate) fn blurred(side: u32, environment: fn(Vector) -> Color) -> [Image; 6] {
    /// Samples along the side of a face: 7° apart, where the weight falls by half within 33°.
    const SAMPLES: u32 = 12;
    let samples: Vec<(Vector, Color)> = (0..6 * SAMPLES * SAMPLES)
        .into_par_iter()
        .map(|at| {
            let (face, at) = ((at / (SAMPLES * SAMPLES)) as usize, at % (SAMPLES * SAMPLES));
            let coordinate = |index: u32| (index as f32 + 0.5) / SAMPLES as f32;
            let on_cube = face_direction(face, coordinate(at % SAMPLES), coordinate(at / SAMPLES));
            let squared: f32 = on_cube.iter().map(|component| component * component).sum();
            // The solid angle of a texel of the cube is proportional to 1 / length³.
            let weight = 1.0 / (squared * squared.sqrt());
            let direction = normalized(on_cube);
            (
                direction,
                environment(direction).map(|component| component * weight),
            )
        })
        .collect();
    // The integral of cos⁴ over the hemisphere is 2π/5; a texel at the middle of a face has the solid angle
    // (2/SAMPLES)².
    let scale = 4.0 / (SAMPLES * SAMPLES) as f32 * 5.0 / (2.0 * std::f32::consts::PI);
    faces(side, |face, u, v| {
        let axis = normalized(face_direction(face, u, v));
        let mut sum = [0.0; 3];
        for (direction, color) in &samples {
            let cosine = (axis[0] * direction[0] + axis[1] * direction[1] + axis[2] * direction[2]).max(0.0);
            let weight = cosine * cosine * cosine * cosine;
            for i in 0..3 {
                sum[i] += weight * color[i];
            }
        }
        sum.map(|component| component * scale)
    })
}

/// Images of the faces from a color at each texel's center.
fn faces(side: u32, color: impl Fn(usize, f32, f32) -> Color + Sync) -> [Image; 6] {
    [0, 1, 2, 3, 4, 5].map(|face| {
        let row = |y: u32| {
            let v = (y as f32 + 0.5) / side as f32;
            let color = &color;
            (0..side).map(move |x| {
                let [r, g, b] = color(face, (x as f32 + 0.5) / side as f32, v);
                in_levels([r, g, b, 1.0])
            })
        };
        let pixels = (0..side).into_par_iter().flat_map_iter(row).collect();
        Image::new(side, side, pixels)
    })
}

/// Noise in [0, 1] over space, the mean of `octaves` scales with the weights 1, 1/2, 1/4, …: numbers at the
/// points of a lattice of distance 1, 1/2, 1/4, … with cubic steps between them. It repeats after 32 of these
/// distances.
pub(crate) fn noise(position: Vector, seed: u32, octaves: u32) -> f32 {
    let (mut sum, mut weights, mut weight) = (0.0, 0.0, 1.0);
    let mut scaled = position;
    for octave in 0..octaves {
        sum += weight * lattice(scaled, pcg(seed + octave));
        weights += weight;
        weight *= 0.5;
        scaled = scaled.map(|component| 2.0 * component);
    }
    sum / weights
}

/// The side of the table of random numbers, as a power of two.
const LATTICE_BITS: u32 = 5;

static LATTICE: LazyLock<Vec<f32>> =
    LazyLock::new(|| (0..1 << (3 * LATTICE_BITS)).map(|at| unit(pcg(at))).collect());

/// One scale of noise; `shift` moves it by its bits.
fn lattice(position: Vector, shift: u32) -> f32 {
    let table = &LATTICE[..];
    let cell = position.map(f32::floor);
    let [x, y, z] = [0, 1, 2].map(|i| (cell[i] as i32 as u32).wrapping_add(shift >> (8 * i)));
    let [a, b, c] = [0, 1, 2].map(|i| {
        let within = position[i] - cell[i];
        within * within * (3.0 - 2.0 * within)
    });
    let part = |coordinate: u32| coordinate & ((1 << LATTICE_BITS) - 1);
    let corner = |dx: u32, dy: u32, dz: u32| {
        let [x, y, z] = [x.wrapping_add(dx), y.wrapping_add(dy), z.wrapping_add(dz)].map(part);
        table[((z << LATTICE_BITS | y) << LATTICE_BITS | x) as usize]
    };
    let edge = |dy, dz| mix(corner(0, dy, dz), corner(1, dy, dz), a);
    mix(mix(edge(0, 0), edge(1, 0), b), mix(edge(0, 1), edge(1, 1), b), c)
}

#[cfg(test)]
mod tests {
    use toyproof_image::cube::texel_direction;

    use super::*;

    #[test]
    fn faces_have_the_directions_of_textures() {
        for face in 0..6 {
            for (x, y) in [(0, 0), (3, 0), (1, 2)] {
                let direction = face_direction(face, (x as f32 + 0.5) / 4.0, (y as f32 + 0.5) / 4.0);
                let expected = texel_direction(face as u32, [x, 3 - y], 4);
                assert_eq!(direction.map(f64::from), expected, "{face}");
            }
        }
    }

    #[test]
    fn a_blurred_uniform_environment_keeps_its_color() {
        for image in blurred(4, |_| [0.25, 0.5, 0.75]) {
            for pixel in image.pixels() {
                for (component, expected) in pixel.iter().zip([0.25, 0.5, 0.75, 1.0]) {
                    // Two levels for 864 samples in place of the integral.
                    assert!((component - expected).abs() < 2.5 / 255.0, "{pixel:?}");
                }
            }
        }
    }

    #[test]
    fn environments_continue_across_the_edges_of_faces() {
        for environment in [forest, basilica, |direction| GALLERY.color(direction)] {
            let [right, _, above, _, front, _] = sharp(64, environment);
            let difference = |a: [f32; 4], b: [f32; 4]| (0..3).map(|i| (a[i] - b[i]).abs()).sum::<f32>();
            let sum = |edge: &dyn Fn(u32) -> f32| (0..64).map(edge).sum::<f32>();
            let across = sum(&|at| difference(front.get(63, at), right.get(0, at)))
                + sum(&|at| difference(front.get(at, 63), above.get(at, 0)));
            let inside = sum(&|at| difference(front.get(63, at), front.get(62, at)))
                + sum(&|at| difference(front.get(at, 63), front.get(at, 62)));
            // Neighbors are as far apart across an edge as inside; 1 is a hundredth for each of 128 pairs.
            assert!(across < 2.0 * inside + 1.0, "{across} of {inside}");
        }
    }
}
