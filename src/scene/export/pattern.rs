//! Patterns: the second colors of surfaces.

use super::expression::{moved_direction, moved_point, number, vector};
use crate::{Object, Pattern, PatternKind, Point, Scene, Shape, Space};

/// The properties that the shader's code for patterns depends on.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Patterns {
    None,
    /// Only checkers in the coordinates of the scene.
    Checkers,
    /// Patterns of several kinds.
    Mixed {
        checkers: bool,
        stripes: bool,
        /// Whether some patterns are in the coordinates of their surfaces.
        own_space: bool,
        /// Whether some of the patterns in the coordinates of surfaces are on boxes.
        on_faces: bool,
    },
}

impl Patterns {
    pub(super) fn new(scene: &Scene) -> Self {
        let any = |has: fn(&Object, &Pattern) -> bool| {
            let mut objects = scene.objects.iter();
            objects.any(|object| {
                object
                    .material
                    .pattern
                    .is_some_and(|pattern| has(object, &pattern))
            })
        };
        let checkers = any(|_, pattern| pattern.kind == PatternKind::Checker);
        let stripes = any(|_, pattern| pattern.kind != PatternKind::Checker);
        let own_space = any(|_, pattern| is_own(pattern));
        let on_faces = any(|object, pattern| is_own(pattern) && matches!(object.shape, Shape::Box(_)));
        match (checkers, stripes || own_space) {
            (false, false) => Self::None,
            (true, false) => Self::Checkers,
            (_, true) => Self::Mixed {
                checkers,
                stripes,
                own_space,
                on_faces,
            },
        }
    }

    /// Returns the structure of a pattern, if there is one.
    pub(super) fn structure(self) -> Option<String> {
        let Self::Mixed {
            stripes,
            own_space,
            on_faces,
            ..
        } = self
        else {
            return None;
        };
        let members = [
            (true, "    vec3 other;\n    float side;\n"),
            (stripes, "    vec3 direction;\n"),
            (own_space, "    vec3 origin;\n    mat3 axes;\n"),
            (on_faces, "    bool onFaces;\n"),
        ];
        Some(format!("{PATTERN}struct Pattern {{\n{}}};\n", used(&members)))
    }

    /// Returns the members of surfaces.
    pub(super) fn members(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Checkers => "    vec3 other;\n    float side;\n",
            Self::Mixed { .. } => "    Pattern pattern;\n",
        }
    }

    /// Returns the values of these members, after a comma.
    pub(super) fn values(self, object: &Object) -> String {
        let pattern = object.material.pattern;
        let (other, side) = pattern.map_or((object.material.color, 1.0), |pattern| {
            (pattern.color, pattern.size)
        });
        let (other, side) = (vector(other), number(side));
        let Self::Mixed {
            stripes,
            own_space,
            on_faces,
            ..
        } = self
        else {
            return if self == Self::None {
                String::new()
            } else {
                format!(", {other}, {side}")
            };
        };
        let direction = match pattern.map(|pattern| pattern.kind) {
            Some(PatternKind::Stripes { direction }) => direction,
            _ => [0.0; 3],
        };
        let (origin, axes) = frame(object);
        let is_on_faces = matches!(object.shape, Shape::Box(_)) && pattern.as_ref().is_some_and(is_own);
        let values = [
            (true, format!("{other}, {side}")),
            (stripes, format!(", {}", vector(direction))),
            (own_space, format!(", {origin}, {axes}")),
            (on_faces, format!(", {is_on_faces}")),
        ];
        format!(", Pattern({})", used(&values))
    }

    /// Returns the statements and arguments that give these members of the sphere of a grid their values.
    /// The second color of a grid without a pattern is that of the sphere.
    pub(super) fn of_cell(self, has_plain_grid: bool) -> [&'static str; 2] {
        match (self, has_plain_grid) {
            (Self::None, _) => ["", ""],
            (Self::Checkers, false) => ["", ", grid.other, grid.side"],
            (Self::Checkers, true) => [
                "    vec3 other = grid.other == grid.color ? color : grid.other;\n",
                ", other, grid.side",
            ],
            (Self::Mixed { .. }, false) => ["", ", grid.pattern"],
            (Self::Mixed { .. }, true) => [
                "    Pattern pattern = grid.pattern;\n    if (pattern.other == grid.color) {\n        \
                 pattern.other = color;\n    }\n",
                ", pattern",
            ],
        }
    }

    /// Returns the function that computes the color at a point, if there are patterns.
    pub(super) fn function(self) -> Option<String> {
        let Self::Mixed {
            checkers,
            stripes,
            own_space,
            on_faces,
        } = self
        else {
            return (self == Self::Checkers).then(|| CHECKERED.to_owned());
        };
        let normal = if on_faces { ", vec3 normal" } else { "" };
        let place = if own_space {
            "(point - pattern.origin) * pattern.axes"
        } else {
            "point"
        };
        // In the scene's coordinates, y does not count.
        let checker_sum = if own_space {
            "square.x + square.y + square.z"
        } else {
            "square.x + square.z"
        };
        let stripe = "floor(dot(place, pattern.direction) / side)";
        let checker =
            format!("    vec3 square = floor(place / side);\n    float sum = «PatternSum: {checker_sum}»;\n");
        let only_stripes = format!("    float sum = {stripe};\n");
        let either = format!("    if (pattern.direction != vec3(0.0)) {{\n        sum = {stripe};\n    }}\n");
        let lines = [
            (
                true,
                format!("    float side = «PatternSide: pattern.side»;\n    vec3 place = {place};\n"),
            ),
            (on_faces, FACES.to_owned()),
            (checkers, checker),
            (!checkers, only_stripes),
            (checkers && stripes, either),
        ];
        Some(format!(
            "// Where the sum of the pattern's whole numbers is odd, the second color.\n\
             vec3 patterned(vec3 point{normal}, vec3 color, Pattern pattern) {{\n{}    \
             return mod(sum, 2.0) < 0.5 ? «PatternEven: color» : «PatternOdd: pattern.other»;\n}}\n",
            used(&lines)
        ))
    }

    pub(super) fn color(self, surface: &str, point: &str, normal: &str) -> String {
        match self {
            Self::None => format!("{surface}.color"),
            Self::Checkers => {
                format!("checkered({point}, {surface}.color, {surface}.other, {surface}.side)")
            }
            Self::Mixed { on_faces, .. } => {
                let normal = if on_faces {
                    format!(", {normal}")
                } else {
                    String::new()
                };
                format!("patterned({point}{normal}, {surface}.color, {surface}.pattern)")
            }
        }
    }
}

/// Joins the parts that are used.
fn used(parts: &[(bool, impl AsRef<str>)]) -> String {
    let used = parts.iter().filter(|(is_used, _)| *is_used);
    used.map(|(_, text)| text.as_ref()).collect()
}

/// Whether a pattern is in the coordinates of its surface.
pub(super) fn is_own(pattern: &Pattern) -> bool {
    pattern.space != Space::World
}

/// Returns the origin and the axes of the coordinates of a surface's pattern. A coordinate whose axis is 0
/// does not count.
fn frame(object: &Object) -> (String, String) {
    let zero = || vector([0.0; 3]);
    let axes = match object.material.pattern {
        None => return (zero(), "mat3(0.0)".to_owned()),
        Some(Pattern {
            space: Space::Object { axes },
            ..
        }) => axes,
        Some(Pattern {
            kind: PatternKind::Stripes { .. },
            ..
        }) => return (zero(), "mat3(1.0)".to_owned()),
        Some(_) => {
            let x_and_z = "mat3(1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)";
            return (zero(), x_and_z.to_owned());
        }
    };
    let origin = object.shape.origin();
    let is_plane = matches!(object.shape, Shape::Plane { .. });
    let axis = |(index, axis): (usize, Point)| {
        if is_plane && index == 1 {
            zero()
        } else {
            moved_direction(axis, origin, object.motion)
        }
    };
    let columns: Vec<_> = axes.into_iter().enumerate().map(axis).collect();
    (
        moved_point(origin, object.motion),
        format!("mat3({})", columns.join(", ")),
    )
}

const PATTERN: &str =
    "// A second color. Stripes follow each other along the direction, which is 0 for a checker.\n";

const CHECKERED: &str = "// A checkerboard in x and z.
vec3 checkered(vec3 point, vec3 color, vec3 other, float side) {
    vec2 square = «CheckerSquare: floor(point.xz / side)»;
    return mod(«CheckerSum: square.x + square.y», 2.0) < 0.5 ? «CheckerEven: color» : «CheckerOdd: other»;
}
";

const FACES: &str = "    // In the faces of a box, the coordinate across them is 0.
    if (pattern.onFaces) {
        place *= «AcrossFace: vec3(lessThan(abs(normal * pattern.axes), vec3(0.5)))»;
    }
";
