//! Lookups of cube maps by a direction (OpenGL ES 3.0.6 §3.8.10): the face, and the place on it.

use crate::float::Number;

/// The component of a direction along the axis of its face, and those along the axes of the face.
struct OnFace<N> {
    /// The absolute value along the axis, which is the largest of the three.
    major: N,
    s: N,
    t: N,
}

/// Where a direction points: the number of the face, in the order +X, −X, +Y, −Y, +Z, −Z, and s and t on it,
/// from 0 to 1. The specification leaves open which face an edge belongs to: here it is the one of the last
/// axis. For the zero vector, s and t are NaN.
pub fn cube_place<N: Number>(direction: [N; 3]) -> [N; 3] {
    let OnFace { major, s, t } = on_face(direction, direction);
    let [x, y, z] = direction;
    let literal = |value| x.literal(value);
    let face = |component: N, first: f64| {
        N::select(component.less(literal(0.0)), literal(first + 1.0), literal(first))
    };
    let face = by_face(direction, [face(x, 0.0), face(y, 2.0), face(z, 4.0)]);
    let place = |component: N| component / major * literal(0.5) + literal(0.5);
    [face, place(s), place(t)]
}

/// The derivatives of s and t on the face of a direction, from the derivative of the direction, by the rule
/// for quotients.
pub fn cube_gradient<N: Number>(direction: [N; 3], derivative: [N; 3]) -> [N; 2] {
    let place = on_face(direction, direction);
    let change = on_face(direction, derivative);
    let along = |place_on_axis: N, change_on_axis: N| {
        let change = change_on_axis - place_on_axis / place.major * change.major;
        change / place.major * place.major.literal(0.5)
    };
    [along(place.s, change.s), along(place.t, change.t)]
}

/// The components of a vector along the axes of the face of a direction: table 3.21 of the specification.
fn on_face<N: Number>(direction: [N; 3], [x, y, z]: [N; 3]) -> OnFace<N> {
    let zero = direction[0].literal(0.0);
    let [left, down, back] = direction.map(|component| component.less(zero));
    let signed = |is_negative: N::Bool, component: N| N::select(is_negative, -component, component);
    OnFace {
        major: by_face(direction, [signed(left, x), signed(down, y), signed(back, z)]),
        s: by_face(direction, [N::select(left, z, -z), x, signed(back, x)]),
        t: by_face(direction, [-y, signed(down, z), -y]),
    }
}

/// The value for the axis along which the direction is longest.
fn by_face<N: Number>(direction: [N; 3], [x, y, z]: [N; 3]) -> N {
    let [across, up, along] = direction.map(N::abs);
    let is_z = !along.less(across) & !along.less(up);
    let is_y = !up.less(across);
    N::select(is_z, z, N::select(is_y, y, x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_point_to_the_faces_of_the_specification() {
        let faces = [
            ([2.0, 1.0, 1.0], [0.0, 0.25, 0.25]),
            ([-2.0, 1.0, 1.0], [1.0, 0.75, 0.25]),
            ([1.0, 2.0, 1.0], [2.0, 0.75, 0.75]),
            ([1.0, -2.0, 1.0], [3.0, 0.75, 0.25]),
            ([1.0, 1.0, 2.0], [4.0, 0.75, 0.25]),
            ([1.0, 1.0, -2.0], [5.0, 0.25, 0.25]),
        ];
        for (direction, place) in faces {
            assert_eq!(cube_place::<f64>(direction), place, "{direction:?}");
        }
        assert!(cube_place([0.0_f32; 3])[1].is_nan());
    }

    #[test]
    fn gradients_are_those_of_the_places() {
        let step = 1e-6;
        for direction in [
            [3.0, 1.0, -2.0],
            [-1.0, 0.5, 0.2],
            [0.3, -2.0, 1.9],
            [0.1, 0.2, -1.0],
        ] {
            for axis in 0..3 {
                let mut derivative = [0.0; 3];
                derivative[axis] = 1.0;
                let mut moved: [f64; 3] = direction;
                moved[axis] += step;
                let [before, after] = [direction, moved].map(cube_place);
                assert_eq!(before[0].to_bits(), after[0].to_bits(), "the same face");
                let expected = [1, 2].map(|place| (after[place] - before[place]) / step);
                let found = cube_gradient(direction, derivative);
                for (found, expected) in found.into_iter().zip(expected) {
                    // The error of the forward difference is of the order of its step.
                    assert!((found - expected).abs() < 1e-5, "{found}, not {expected}");
                }
            }
        }
    }
}
