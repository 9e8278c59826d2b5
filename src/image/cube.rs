//! Cube maps: the faces of a level in one image, each with a border of the texels of its neighbors.
//!
//! A filter that reads four texels then never leaves the image of its face, and is seamless as in OpenGL ES
//! 3.0 (§3.8.10.1). The faces are +X, −X, +Y, −Y, +Z and −Z, stacked from row 0 upwards; row 0 of a face has
//! t = 0.

use crate::Image;
use crate::texture::Component;

/// The number of faces.
pub const FACES: u32 = 6;

/// The axis of a face, and the signs of that axis, and of the axes of s and t with their numbers: table 3.21
/// of the specification of OpenGL ES 3.0.
struct Face {
    major: (usize, i64),
    s: (usize, i64),
    t: (usize, i64),
}

const fn face(major: (usize, i64), s: (usize, i64), t: (usize, i64)) -> Face {
    Face { major, s, t }
}

const TABLE: [Face; FACES as usize] = [
    face((0, 1), (2, -1), (1, -1)),
    face((0, -1), (2, 1), (1, -1)),
    face((1, 1), (0, 1), (2, 1)),
    face((1, -1), (0, 1), (2, -1)),
    face((2, 1), (0, 1), (1, -1)),
    face((2, -1), (0, -1), (1, -1)),
];

/// The direction of the center of a texel: twice its distances from the center of the cube, in texels. A
/// texel beside the face is in the plane of the face.
fn direction(face: usize, [i, j]: [i64; 2], side: i64) -> [i64; 3] {
    let Face { major, s, t } = TABLE[face];
    let mut direction = [0; 3];
    direction[major.0] = major.1 * side;
    direction[s.0] = s.1 * (2 * i + 1 - side);
    direction[t.0] = t.1 * (2 * j + 1 - side);
    direction
}

/// The direction that a texel of a cube map faces, from (−1, −1, −1) to (1, 1, 1): its center on the cube.
///
/// # Panics
/// If there is no such face.
pub fn texel_direction(face: u32, texel: [u32; 2], side: u32) -> [f64; 3] {
    let direction = direction(face as usize, texel.map(i64::from), side.into());
    direction.map(|twice| twice as f64 / f64::from(side))
}

/// The texel on the neighboring face that continues a row or a column of a face beyond its edge.
fn neighbor(face: usize, texel: [i64; 2], side: i64) -> (usize, [i64; 2]) {
    let mut direction = direction(face, texel, side);
    // The texel folds around the edge: the axis that left the face becomes the major one.
    let left = direction
        .iter()
        .position(|component| component.abs() > side)
        .unwrap_or(0);
    let sign = direction[left].signum();
    direction[left] = sign * side;
    let old = TABLE[face].major;
    direction[old.0] = old.1 * (side - 1);
    let is_face = |face: &Face| face.major == (left, sign);
    let new = TABLE.iter().position(is_face).unwrap_or(0);
    let Face { s, t, .. } = TABLE[new];
    let place = |axis: (usize, i64)| (axis.1 * direction[axis.0] + side - 1) / 2;
    (new, [place(s), place(t)])
}

/// Adds the borders to six stacked faces. The corners of the border, where three faces meet, are the means of
/// the three texels.
///
/// # Panics
/// If the height is not six times the width.
pub(crate) fn with_borders<T: Component>(stack: &Image<T>) -> Image<T> {
    let [width, height] = stack.size();
    assert_eq!(height, FACES * width, "the faces are squares");
    let side = i64::from(width);
    let texel =
        |face: usize, [i, j]: [i64; 2]| -> [T; 4] { stack.get(i as u32, (face as i64 * side + j) as u32) };
    let beside = |face: usize, at: [i64; 2]| -> [T; 4] {
        let is_outside = at.map(|place| place < 0 || place == side);
        match is_outside {
            [false, false] => texel(face, at),
            [true, true] => {
                let inside = at.map(|place| place.clamp(0, side - 1));
                let beyond = |at| {
                    let (face, at) = neighbor(face, at, side);
                    texel(face, at)
                };
                let corner = [
                    texel(face, inside),
                    beyond([at[0], inside[1]]),
                    beyond([inside[0], at[1]]),
                ];
                [0, 1, 2, 3].map(|component| T::mean(corner.map(|texel| texel[component])))
            }
            _ => {
                let (face, at) = neighbor(face, at, side);
                texel(face, at)
            }
        }
    };
    let rows = (0..FACES as usize).flat_map(|face| (-1..=side).map(move |j| (face, j)));
    let texels = rows.flat_map(|(face, j)| (-1..=side).map(move |i| (face, [i, j])));
    let pixels = texels.map(|(face, at)| beside(face, at)).collect();
    Image::new(width + 2, FACES * (width + 2), pixels)
}

/// Removes the borders that [`with_borders`] adds.
pub(crate) fn without_borders<T: Copy>(bordered: &Image<T>) -> Image<T> {
    let whole = bordered.size()[0];
    let side = whole - 2;
    let rows = (0..FACES).flat_map(|face| (1..=side).map(move |row| face * whole + row));
    let pixels = rows.flat_map(|row| (1..=side).map(move |column| bordered.get(column, row)));
    Image::new(side, FACES * side, pixels.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A continuous function of the direction, on each face.
    fn smooth(side: u32) -> Image {
        let texel = |face: u32, at: [u32; 2]| {
            let [x, y, z] = texel_direction(face, at, side);
            let length = (x * x + y * y + z * z).sqrt();
            [x, y, z, length].map(|component| (component / length) as f32)
        };
        let rows = (0..FACES).flat_map(|face| (0..side).map(move |row| (face, row)));
        let pixels = rows.flat_map(|(face, row)| (0..side).map(move |column| texel(face, [column, row])));
        Image::new(side, FACES * side, pixels.collect())
    }

    #[test]
    fn directions_are_those_of_the_specification() {
        // The corner of s = t = 0 of each face, as the specification's table gives it for s = t = −1.
        let corners: Vec<_> = (0..FACES)
            .map(|face| texel_direction(face, [0, 0], 1_000_000).map(f64::round))
            .collect();
        assert_eq!(
            corners,
            [
                [1.0, 1.0, 1.0],
                [-1.0, 1.0, -1.0],
                [-1.0, 1.0, -1.0],
                [-1.0, -1.0, 1.0],
                [-1.0, 1.0, 1.0],
                [1.0, 1.0, -1.0]
            ]
        );
    }

    /// The border continues a smooth function: its texels are as near to those at the edge as any two texels
    /// side by side.
    #[test]
    fn borders_continue_the_neighboring_faces() {
        let side = 64;
        let bordered = with_borders(&smooth(side));
        let step = 2.0 / side as f32;
        let whole = side + 2;
        for face in 0..FACES {
            for row in 0..whole {
                for column in 0..whole {
                    let texel = bordered.get(column, face * whole + row);
                    let inside = [column, row].map(|place| place.clamp(1, side));
                    let near = bordered.get(inside[0], face * whole + inside[1]);
                    for component in 0..3 {
                        let difference = (texel[component] - near[component]).abs();
                        assert!(
                            difference < 1.1 * step,
                            "face {face}, {column}, {row}: {difference}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn each_border_texel_is_the_mirror_of_another() {
        for side in [1, 2, 5] {
            for face in 0..FACES as usize {
                for along in 0..side {
                    for outside in [[-1, along], [side, along], [along, -1], [along, side]] {
                        let (other, at) = neighbor(face, outside, side);
                        assert_ne!(other, face);
                        assert!(at.iter().all(|place| (0..side).contains(place)), "{at:?}");
                        assert!(at.iter().any(|place| *place == 0 || *place == side - 1));
                    }
                }
            }
        }
    }

    #[test]
    fn borders_are_removed_again() {
        let stack = smooth(5);
        assert_eq!(without_borders(&with_borders(&stack)), stack);
    }

    #[test]
    fn corners_are_means_of_three_faces() {
        let pixels = (0..FACES).map(|face| [face as f32; 4]);
        let bordered = with_borders(&Image::new(1, FACES, pixels.collect()));
        // Where +X (0), +Y (2) and +Z (4) meet.
        assert_eq!(bordered.get(0, 0), [2.0; 4]);
    }
}
