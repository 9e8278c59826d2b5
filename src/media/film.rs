//! Moving stand-ins for the site's videos and for a camera.

use rayon::prelude::*;
use toyproof_image::Image;
use toyproof_math::native;

use crate::color::{Color, blend, in_levels, scaled};
use crate::field::{Field, hash, smoothstep, unit};

/// Where a image is computed: positions from −1 to 1 upwards, wider than that to the right.
type Position = [f32; 2];

/// An opaque image from colors at the centers of its pixels.
fn render([width, height]: [u32; 2], color: impl Fn(Position) -> Color + Sync) -> Image {
    let row = |y: u32| {
        let color = &color;
        (0..width).map(move |x| {
            let half = height as f32 / 2.0;
            let position = [
                (x as f32 + 0.5 - width as f32 / 2.0) / half,
                (y as f32 + 0.5 - half) / half,
            ];
            let [r, g, b] = color(position);
            in_levels([r, g, b, 1.0])
        })
    };
    let pixels = (0..height).into_par_iter().flat_map_iter(row).collect();
    Image::new(width, height, pixels)
}

/// The sine of a phase in turns.
fn sine(turns: f64) -> f32 {
    // The fraction is exact where f32 would lose it in long films.
    native::sin((turns - turns.floor()) as f32 * std::f32::consts::TAU)
}

/// A dancing figure before a green screen, as two of the site's videos have one. The film repeats after 8 s.
pub(crate) fn green_screen(seconds: f64) -> Image {
    const GREEN: Color = [0.10, 0.72, 0.16];
    let beat = seconds * 1.25;
    let (sway, bounce) = (0.12 * sine(beat / 2.0), 0.05 * sine(beat).abs());
    let (left, right) = (0.55 * sine(beat), 0.55 * sine(beat + 0.4));
    render([512, 396], |[x, y]| {
        let y = y - bounce;
        let light = 1.0 - 0.14 * (x * x + y * y);
        // The body leans; the feet stay.
        let x = x - sway * smoothstep(-1.0, 0.6, y);
        let head = distance([x, y - 0.52], [0.0, 0.0], [0.0, 0.05]) - 0.155;
        let hair = distance([x, y - 0.52], [-0.02, 0.09], [0.02, 0.11]) - 0.145;
        let trunk = distance([x, y], [0.0, 0.22], [0.0, -0.12]) - 0.20;
        let arms = [(-1.0, left), (1.0, right)].map(|(side, lift)| {
            let elbow = [side * 0.40, 0.12 + 0.3 * lift];
            let hand = [side * (0.50 + 0.1 * lift), -0.10 + 0.9 * lift];
            let upper = distance([x, y], [side * 0.18, 0.30], elbow);
            upper.min(distance([x, y], elbow, hand)) - 0.065
        });
        let legs = [-1.0, 1.0].map(|side: f32| {
            let knee = [side * 0.14 + 0.4 * sway, -0.55];
            let upper = distance([x, y], [side * 0.10, -0.25], knee);
            upper.min(distance([x, y], knee, [side * 0.18, -1.2])) - 0.09
        });
        let skin = scaled([0.80, 0.58, 0.46], 0.75 + 0.5 * smoothstep(-0.2, 0.2, x + 0.1));
        let cloth = scaled([0.55, 0.16, 0.22], 0.65 + 0.5 * smoothstep(-0.3, 0.3, x + y));
        let trousers = scaled([0.16, 0.18, 0.30], 0.7 + 0.4 * smoothstep(-0.3, 0.3, x));
        let mut color = scaled(GREEN, light);
        // Edges are a few pixels wide, as those of a compressed film.
        let mut cover =
            |shape: f32, with: Color| color = blend(with, color, smoothstep(-0.010, 0.012, shape));
        cover(hair, [0.20, 0.13, 0.08]);
        for leg in legs {
            cover(leg, trousers);
        }
        for arm in arms {
            cover(arm, skin);
        }
        cover(trunk, cloth);
        cover(head, skin);
        color
    })
}

/// An old black-and-white film: a figure in a room, with scratches and flicker.
pub(crate) fn old_film(seconds: f64) -> Image {
    let frame = (seconds * 18.0).floor();
    // The numbers of a frame repeat after an hour.
    let number = frame.rem_euclid(64_800.0) as u32;
    let random = |what| unit(hash(301, number, what));
    let (flicker, scratch) = (0.92 + 0.10 * random(0), 2.6 * random(1) - 1.3);
    let (turn, step) = (sine(seconds / 6.0), sine(seconds * 0.9));
    render([320, 240], |[x, y]| {
        let wall = 0.52 + 0.10 * smoothstep(0.2, 0.9, y) - 0.16 * (x * x + y * y);
        let is_floor = y < -0.62;
        let is_window = (x + 0.75).abs() < 0.27 && (y - 0.25).abs() < 0.38;
        let is_bar = (x + 0.75).abs() < 0.018 || (y - 0.25).abs() < 0.018;
        let mut gray = if is_floor {
            0.24
        } else if is_window && !is_bar {
            0.95
        } else {
            wall
        };
        let x = x - 0.35 * turn - 0.2;
        let mut cover =
            |shape: f32, with: f32| gray = with + (gray - with) * smoothstep(-0.012, 0.012, shape);
        cover(distance([x, y], [0.0, 0.18], [0.0, -0.28]) - 0.17, 0.12);
        cover(
            distance([x, y], [-0.07, -0.35], [-0.12 - 0.1 * step, -0.95]) - 0.06,
            0.10,
        );
        cover(
            distance([x, y], [0.07, -0.35], [0.12 + 0.1 * step, -0.95]) - 0.06,
            0.10,
        );
        cover(
            distance([x, y], [0.16, 0.25], [0.34, 0.05 + 0.25 * step]) - 0.05,
            0.14,
        );
        cover(
            distance([x, y], [-0.16, 0.25], [-0.34, 0.05 - 0.25 * step]) - 0.05,
            0.14,
        );
        cover(distance([x, y], [0.0, 0.44], [0.0, 0.48]) - 0.12, 0.74);
        cover(distance([x, y], [-0.13, 0.58], [0.13, 0.58]) - 0.035, 0.06);
        let [column, row] = [(x * 160.0) as i32 as u32, (y * 120.0) as i32 as u32];
        let grain = 0.12 * (unit(hash(302 + number, column, row)) - 0.5);
        let is_scratched = (x + 0.35 * turn + 0.2 - scratch).abs() < 0.006;
        [if is_scratched { 0.9 } else { gray * flicker + grain }; 3]
    })
}

/// Hills, a lake and clouds that move, in color.
pub(crate) fn landscape(seconds: f64) -> Image {
    let clouds = Field::fractal(256, [4, 8], 303, 0.6);
    // The clouds are periodic: they return after 64 s.
    let drift = ((seconds / 64.0 - (seconds / 64.0).floor()) * 256.0) as f32;
    render([320, 240], |[x, y]| {
        let cloud = |height: f32| {
            smoothstep(
                0.2,
                1.6,
                clouds.between(90.0 * x + drift, 60.0 * height / (0.3 + height)),
            )
        };
        let sky = |height: f32| {
            let blue = blend(
                [0.70, 0.80, 0.90],
                [0.22, 0.42, 0.76],
                smoothstep(0.0, 1.0, height),
            );
            blend(blue, [0.96, 0.96, 0.95], cloud(height))
        };
        let hill = |offset: f32, scale: f32| {
            scale * (0.5 + 0.5 * native::sin(2.2 * x + offset)) + 0.05 * native::sin(9.0 * x + 3.0 * offset)
        };
        let horizon = -0.2;
        let height = y - horizon;
        if height < 0.0 {
            // The lake mirrors the sky, in waves.
            let wave = sine(f64::from(6.0 / (0.08 - height)) + 0.4 * seconds);
            return scaled(sky(-height), 0.62 + 0.10 * wave);
        }
        if height < hill(0.4, 0.22) {
            [0.16, 0.26, 0.12]
        } else if height < hill(2.1, 0.42) {
            [0.34, 0.44, 0.36]
        } else {
            sky(height)
        }
    })
}

/// A face before a bright wall that moves a little: what a camera sees.
pub(crate) fn camera(seconds: f64) -> Image {
    let (turn, nod) = (0.06 * sine(seconds / 5.0), 0.03 * sine(seconds / 3.0));
    let is_blinking = (seconds / 4.0 - (seconds / 4.0).floor()) < 0.04;
    render([640, 480], |[x, y]| {
        let wall = scaled(
            [0.66, 0.64, 0.60],
            1.0 - 0.16 * (x * x + y * y) + 0.10 * smoothstep(0.0, 1.2, x),
        );
        let is_shelf = x > 0.75 && (y * 2.5 - (y * 2.5).floor()) < 0.1;
        let mut color = if is_shelf { [0.36, 0.26, 0.18] } else { wall };
        let mut cover =
            |shape: f32, with: Color| color = blend(with, color, smoothstep(-0.012, 0.012, shape));
        cover(
            distance([x, y], [-0.35, -1.05], [0.35, -1.05]) - 0.42,
            [0.20, 0.28, 0.42],
        );
        let (x, y) = (x - turn, y - nod - 0.02);
        let shade = 0.72 + 0.42 * smoothstep(-0.4, 0.4, x);
        let skin = scaled([0.84, 0.64, 0.52], shade);
        cover(
            distance([x, y], [0.0, 0.25], [0.0, 0.30]) - 0.44,
            [0.16, 0.11, 0.08],
        );
        cover(
            distance([x, y], [0.0, -0.5], [0.0, -0.3]) - 0.17,
            scaled(skin, 0.8),
        );
        cover(distance([x, y], [0.0, -0.14], [0.0, 0.16]) - 0.36, skin);
        for side in [-1.0, 1.0] {
            let eye = [side * 0.15 + 0.5 * turn, 0.12];
            if !is_blinking {
                cover(
                    distance([x, y], [eye[0] - 0.03, eye[1]], [eye[0] + 0.03, eye[1]]) - 0.035,
                    [0.93; 3],
                );
                cover(distance([x, y], eye, eye) - 0.032, [0.20, 0.14, 0.10]);
            }
            cover(
                distance([x, y], [eye[0] - 0.07, 0.22], [eye[0] + 0.06, 0.23]) - 0.016,
                [0.18, 0.12, 0.09],
            );
        }
        cover(
            distance([x, y], [turn, 0.06], [1.6 * turn, -0.06]) - 0.028,
            scaled(skin, 0.86),
        );
        cover(
            distance([x, y], [-0.09, -0.25], [0.09, -0.25]) - 0.022,
            [0.62, 0.30, 0.28],
        );
        color
    })
}

/// The distance of a point to a line segment.
fn distance([x, y]: Position, [ax, ay]: Position, [bx, by]: Position) -> f32 {
    let ([px, py], [dx, dy]) = ([x - ax, y - ay], [bx - ax, by - ay]);
    let squared = dx * dx + dy * dy;
    let along = if squared > 0.0 {
        ((px * dx + py * dy) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let [nx, ny] = [px - along * dx, py - along * dy];
    (nx * nx + ny * ny).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn films_move_and_most_of_a_green_screen_is_green() {
        for film in [green_screen, old_film, landscape, camera] {
            assert_ne!(film(0.0), film(0.6));
            assert_eq!(film(0.6), film(0.6));
        }
        for seconds in [0.0, 1.1, 5.0] {
            let image = green_screen(seconds);
            let is_green = |pixel: &&[f32; 4]| pixel[1] > pixel[0].max(pixel[2]) + 0.2;
            let green = image.pixels().iter().filter(is_green).count() as f32 / image.pixels().len() as f32;
            assert!((0.5..0.95).contains(&green), "{green}");
        }
    }

    #[test]
    fn the_dance_repeats_after_its_period() {
        assert_eq!(green_screen(8.0), green_screen(0.0));
        assert_eq!(landscape(64.0).get(7, 200), landscape(0.0).get(7, 200));
    }
}
