//! The color spaces of FLIP, for the illuminant D65.

/// Linear RGB to XYZ, for the primaries of sRGB (IEC 61966-2-1).
const XYZ_OF_RGB: [[f64; 3]; 3] = [
    [
        10_135_552.0 / 24_577_794.0,
        8_788_810.0 / 24_577_794.0,
        4_435_075.0 / 24_577_794.0,
    ],
    [
        2_613_072.0 / 12_288_897.0,
        8_788_810.0 / 12_288_897.0,
        887_015.0 / 12_288_897.0,
    ],
    [
        1_425_312.0 / 73_733_382.0,
        8_788_810.0 / 73_733_382.0,
        70_074_185.0 / 73_733_382.0,
    ],
];

/// A component of sRGB in linear light; both are in [0, 1].
pub(super) fn linear_of_srgb(component: f64) -> f64 {
    if component <= 0.04045 {
        component / 12.92
    } else {
        ((component + 0.055) / 1.055).powf(2.4)
    }
}

/// The color spaces of one illuminant.
#[derive(Debug)]
pub(super) struct ColorSpaces {
    /// The XYZ of white, by which XYZ is divided.
    white: [f64; 3],
    rgb_of_xyz: [[f64; 3]; 3],
}

impl ColorSpaces {
    pub(super) fn new() -> Self {
        Self {
            white: product(&XYZ_OF_RGB, [1.0; 3]),
            rgb_of_xyz: inverse(&XYZ_OF_RGB),
        }
    }

    /// XYZ relative to white.
    fn relative_xyz(&self, linear: [f64; 3]) -> [f64; 3] {
        let xyz = product(&XYZ_OF_RGB, linear);
        std::array::from_fn(|at| xyz[at] / self.white[at])
    }

    /// The opponent space `YCxCz`: CIELAB without its cube roots, so that filters average light.
    pub(super) fn opponent(&self, linear: [f64; 3]) -> [f64; 3] {
        lab(self.relative_xyz(linear))
    }

    /// The linear RGB of a color of `YCxCz`.
    pub(super) fn linear_of_opponent(&self, [y, cx, cz]: [f64; 3]) -> [f64; 3] {
        let y = (y + 16.0) / 116.0;
        let relative = [y + cx / 500.0, y, y - cz / 200.0];
        let xyz = std::array::from_fn(|at| relative[at] * self.white[at]);
        product(&self.rgb_of_xyz, xyz)
    }

    /// CIELAB with the chroma reduced in dark colors, which seem less colorful (the Hunt effect, as section
    /// 4.1 of the paper models it).
    pub(super) fn adapted_lab(&self, linear: [f64; 3]) -> [f64; 3] {
        let root = |value: f64| {
            const DELTA: f64 = 6.0 / 29.0;
            if value > DELTA.powi(3) {
                value.cbrt()
            } else {
                value / (3.0 * DELTA * DELTA) + 4.0 / 29.0
            }
        };
        let [l, a, b] = lab(self.relative_xyz(linear).map(root));
        [l, 0.01 * l * a, 0.01 * l * b]
    }
}

fn lab([x, y, z]: [f64; 3]) -> [f64; 3] {
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The distance `HyAB` of two colors: of large color differences, people judge lightness and chroma
/// separately.
pub(super) fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

fn product(matrix: &[[f64; 3]; 3], vector: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * vector[0] + row[1] * vector[1] + row[2] * vector[2])
}

/// The inverse by cofactors.
fn inverse(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let cofactor = |row: usize, column: usize| {
        let [r1, r2] = [(row + 1) % 3, (row + 2) % 3];
        let [c1, c2] = [(column + 1) % 3, (column + 2) % 3];
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant: f64 = (0..3).map(|column| m[0][column] * cofactor(0, column)).sum();
    std::array::from_fn(|row| std::array::from_fn(|column| cofactor(column, row) / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spaces_have_their_known_colors() {
        let spaces = ColorSpaces::new();
        assert_eq!(spaces.opponent([1.0; 3]), [100.0, 0.0, 0.0]);
        assert_eq!(spaces.opponent([0.0; 3]), [-16.0, 0.0, 0.0]);
        // The CIELAB of the green of sRGB is (87.73, −86.18, 83.18).
        let [l, a, b] = spaces.adapted_lab([0.0, 1.0, 0.0]);
        let lab = [l, a / (0.01 * l), b / (0.01 * l)];
        for (value, expected) in lab.into_iter().zip([87.735, -86.183, 83.180]) {
            assert!((value - expected).abs() < 0.01, "{lab:?}");
        }
        let back = spaces.linear_of_opponent(spaces.opponent([0.2, 0.7, 0.4]));
        for (value, expected) in back.into_iter().zip([0.2, 0.7, 0.4]) {
            assert!((value - expected).abs() < 1e-14, "{back:?}");
        }
        // Both parts of the curve of sRGB meet.
        assert!((linear_of_srgb(0.04045) - linear_of_srgb(0.040_451)).abs() < 1e-6);
    }
}
