//! The symbols of a player, which few fonts have, as polygons.

use super::outline::Outline;

/// The outline of a symbol, by its code.
pub(super) fn outline(code: u8) -> Option<Outline> {
    let mut outline = Outline::default();
    match code {
        0 => {
            bar(&mut outline, 9.0);
            triangle(&mut outline, 34.0, -20.0);
            triangle(&mut outline, 55.0, -20.0);
        }
        1 => {
            triangle(&mut outline, 32.0, -20.0);
            triangle(&mut outline, 53.0, -20.0);
        }
        6 => {
            bar(&mut outline, 20.0);
            bar(&mut outline, 36.0);
        }
        7 => {
            triangle(&mut outline, 11.0, 20.0);
            triangle(&mut outline, 32.0, 20.0);
        }
        8 => {
            triangle(&mut outline, 9.0, 20.0);
            triangle(&mut outline, 30.0, 20.0);
            bar(&mut outline, 51.0);
        }
        30 | 31 => {
            let left = if code == 30 { 22.0 } else { 32.0 };
            loudspeaker(&mut outline, left);
            if code == 31 {
                for radius in [8.0, 14.0, 20.0] {
                    wave(&mut outline, radius);
                }
            }
        }
        _ => return None,
    }
    Some(outline)
}

/// A triangle that points to the right, or to the left for a negative width.
fn triangle(outline: &mut Outline, base: f32, width: f32) {
    outline.add(&[[base, 12.0], [base + width, 31.5], [base, 51.0]]);
}

fn bar(outline: &mut Outline, left: f32) {
    outline.add(&[[left, 12.0], [left + 5.0, 12.0], [left + 5.0, 51.0], [left, 51.0]]);
}

fn loudspeaker(outline: &mut Outline, left: f32) {
    outline.add(&[
        [left, 16.0],
        [left + 9.0, 25.0],
        [left + 20.0, 25.0],
        [left + 20.0, 38.0],
        [left + 9.0, 38.0],
        [left, 47.0],
    ]);
}

/// An arc of a quarter circle to the left of the loudspeaker, of three texels.
fn wave(outline: &mut Outline, radius: f32) {
    /// Cosine and sine of −45° to 45° in steps of 22.5°.
    const DIRECTIONS: [[f32; 2]; 5] = [
        [0.707, -0.707],
        [0.924, -0.383],
        [1.0, 0.0],
        [0.924, 0.383],
        [0.707, 0.707],
    ];
    let at = |radius: f32| move |[cosine, sine]: [f32; 2]| [30.0 - radius * cosine, 31.5 + radius * sine];
    let outer = DIRECTIONS.map(at(radius + 1.5));
    let mut inner = DIRECTIONS.map(at(radius - 1.5));
    inner.reverse();
    outline.add(&[&outer[..], &inner[..]].concat());
}
