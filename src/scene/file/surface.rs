//! The tables of the scene file for surfaces (`[[sphere]]` and others), for their materials, and for motions.

use glam::{DQuat, DVec3};
use toyproof_diagnostic::{Span, grouped, nearest, one_of};
use toyproof_toml::Table;

use super::super::shape::IDENTITY;
use super::super::{
    Cuboid, Disney, Fresnel, Material, Model, Motion, Object, Pattern, PatternKind, Period, Point, Quadric,
    QuadricKind, Scatter, Shape, Space,
};
use super::checks::Checks;

/// The maximum number of spheres of one scatter.
const MAX_SCATTER: u64 = 65_536;
/// The default axis: upright.
const UP: Point = [0.0, 1.0, 0.0];

/// The smallest sine of the angle between the direction of a plane's stripes and its normal: with a smaller
/// one, the stripes are more than a thousand times as wide as their `size`.
const MIN_STRIPES_SINE: f64 = 1e-3;

/// Reads the shape of a surface from its table.
type ReadShape = fn(&mut Table) -> Shape;

/// The tables that describe one surface each, and what reads their shape.
pub(super) const SHAPES: [(&str, ReadShape); 8] = [
    ("sphere", sphere),
    ("plane", plane),
    ("ellipsoid", ellipsoid),
    ("cylinder", |table| {
        axial(table, "base", |radius, height| QuadricKind::Cylinder {
            radius,
            height,
        })
    }),
    ("cone", |table| {
        axial(table, "apex", |radius, height| QuadricKind::Cone {
            radius,
            height,
        })
    }),
    ("paraboloid", |table| {
        axial(table, "apex", |radius, height| QuadricKind::Paraboloid {
            radius,
            height,
        })
    }),
    ("hyperboloid", hyperboloid),
    ("box", cuboid),
];

/// Reads a surface, and where its model stands.
pub(super) fn object(table: &mut Table, names: &MotionNames, shape: ReadShape) -> (Object, Option<Span>) {
    let shape = shape(table);
    let (material, model) = material(table, &shape);
    let object = Object {
        shape,
        material,
        motion: names.read("motion", table),
    };
    (object, model)
}

fn sphere(table: &mut Table) -> Shape {
    Shape::Sphere {
        center: table.point("center"),
        radius: table.positive("radius"),
    }
}

fn plane(table: &mut Table) -> Shape {
    Shape::Plane {
        point: table.point("point"),
        normal: table.direction_or("normal", UP),
    }
}

fn ellipsoid(table: &mut Table) -> Shape {
    Shape::Quadric(Quadric {
        origin: table.point("center"),
        kind: QuadricKind::Ellipsoid {
            radii: table.lengths("radii"),
        },
        axes: IDENTITY,
    })
}

/// Reads a quadric with a radius at one end of the axis and a height along it.
fn axial(table: &mut Table, origin: &'static str, kind: fn(f64, f64) -> QuadricKind) -> Shape {
    let origin = table.point(origin);
    let axis = table.direction_or("axis", UP);
    let kind = kind(table.positive("radius"), table.positive("height"));
    Shape::Quadric(Quadric::around(axis, origin, kind))
}

fn hyperboloid(table: &mut Table) -> Shape {
    let origin = table.point("center");
    let axis = table.direction_or("axis", UP);
    let waist_span = table.value_span("waist");
    let waist = table.positive("waist");
    let radius = table.positive("radius");
    let height = table.positive("height");
    if let Some(span) = waist_span
        && table.is_valid()
        && waist >= radius
    {
        let found = table.excerpt(span);
        let message = format!("`waist` must be less than `radius`, found {found}");
        table.reject(span, message, "for a constant radius, use [[cylinder]]");
    }
    let kind = QuadricKind::Hyperboloid {
        waist,
        radius,
        height,
    };
    Shape::Quadric(Quadric::around(axis, origin, kind))
}

fn cuboid(table: &mut Table) -> Shape {
    let center = table.point("center");
    let size = table.lengths("size");
    if let Some(span) = table.value_span("axis")
        && !table.has("angle")
    {
        let message = "`axis` is the axis of a rotation, and needs an `angle`";
        table.reject(span, message, "add `angle = 30.0`, in degrees, or remove `axis`");
    }
    let axis = table.direction_or("axis", UP);
    let angle = table.degrees_or("angle", 0.0);
    // libm's sine and cosine: the same bits on every platform.
    let (sine, cosine) = libm::sincos(0.5 * angle.to_radians());
    let [x, y, z] = axis.map(|along| along * sine);
    let rotation = DQuat::from_xyzw(x, y, z, cosine);
    Shape::Box(Cuboid {
        center,
        size,
        axes: IDENTITY.map(|axis| (rotation * DVec3::from_array(axis)).to_array()),
    })
}

/// Reads a scatter, and where its model stands.
pub(super) fn scatter(table: &mut Table, names: &MotionNames) -> (Scatter, Option<Span>) {
    let corner = table.point("corner");
    let cells = cells(table);
    let spacing = table.positive("spacing");
    let radius = table.required::<[f64; 2]>("radius");
    if let Some(radius) = &radius {
        let [min, max] = radius.value;
        if !(min > 0.0 && min <= max) {
            table.reject_value("radius", radius, "must be a minimum greater than 0 and a maximum");
        } else if table.is_valid() && max > 0.5 * spacing {
            table.reject_value("radius", radius, "must be at most half of `spacing`");
        }
    }
    let seed = table.count_or("seed", [0, u32::MAX], 0);
    let sphere = Shape::Sphere {
        center: corner,
        radius: spacing,
    };
    let (material, model) = material(table, &sphere);
    let scatter = Scatter {
        corner,
        cells,
        spacing,
        radius: radius.map_or([1.0; 2], |radius| radius.value),
        seed,
        material,
        motion: names.read("motion", table),
    };
    (scatter, model)
}

fn cells(table: &mut Table) -> [u32; 3] {
    let Some(located) = table.required::<[i64; 3]>("cells") else {
        return [1; 3];
    };
    let cells = located.value.map(|side| u32::try_from(side).unwrap_or(0));
    let count = cells
        .iter()
        .map(|side| u64::from(*side))
        .fold(1, u64::saturating_mul);
    if located.value.iter().any(|side| *side < 1) {
        table.reject_value("cells", &located, "must be at least 1 in each direction");
        return [1; 3];
    }
    if !(1..=MAX_SCATTER).contains(&count) {
        let problem = format!("must have a product of at most {}", grouped(MAX_SCATTER));
        table.reject_value("cells", &located, &problem);
        return [1; 3];
    }
    cells
}

// `material = { … }`

#[derive(Clone, Copy, PartialEq, Eq)]
enum ModelName {
    Facing,
    Lambert,
    Diffuse,
    Disney,
    Glossy,
    Mirror,
    Glass,
    Emitter,
}

const MODELS: [(&str, ModelName); 8] = [
    ("facing", ModelName::Facing),
    ("lambert", ModelName::Lambert),
    ("diffuse", ModelName::Diffuse),
    ("disney", ModelName::Disney),
    ("glossy", ModelName::Glossy),
    ("mirror", ModelName::Mirror),
    ("glass", ModelName::Glass),
    ("emitter", ModelName::Emitter),
];

/// The keys that only one model has.
const MODEL_KEYS: [(&[&str], ModelName, &str); 3] = [
    (&["exponent"], ModelName::Glossy, "glossy"),
    (&["ior", "fresnel"], ModelName::Glass, "glass"),
    (
        &[
            "metallic",
            "subsurface",
            "specular",
            "specular_tint",
            "roughness",
            "anisotropic",
            "sheen",
            "sheen_tint",
            "clearcoat",
            "clearcoat_gloss",
        ],
        ModelName::Disney,
        "disney",
    ),
];

const FRESNEL: [(&str, Fresnel); 2] = [("exact", Fresnel::Exact), ("schlick", Fresnel::Schlick)];

/// The substitute for a material that is missing or in error.
const PLACEHOLDER: Material = Material {
    model: Model::Facing,
    color: [1.0; 3],
    pattern: None,
};

const MATERIAL_EXAMPLE: &str = "material = { model = \"lambert\", color = [1.0, 0.5, 0.2] }";
const CHECKER_EXAMPLE: &str = "checker = { color = [1.0, 1.0, 1.0], size = 1.0 }";
const STRIPES_EXAMPLE: &str =
    "stripes = { color = [1.0, 1.0, 1.0], size = 1.0, direction = [1.0, 0.0, 0.0] }";

/// Reads the material of a surface of this shape, and where its model stands.
fn material(surface: &mut Table, shape: &Shape) -> (Material, Option<Span>) {
    let material = surface.required_table("material", MATERIAL_EXAMPLE, |table| {
        let name = table.required_choice("model", "material model", &MODELS);
        let color = table.color("color");
        let pattern = pattern(table, shape);
        let Some(name) = name else {
            table.ignore_rest();
            return (PLACEHOLDER, None);
        };
        let written = MODELS.iter().find(|(_, model)| *model == name.value);
        let written = written.map_or("", |(written, _)| written);
        for (keys, owner, owner_name) in MODEL_KEYS {
            if owner != name.value {
                table.reject_keys(keys, "model", owner_name, written);
            }
        }
        let material = Material {
            model: model(name.value, table),
            color,
            pattern,
        };
        (material, Some(name.span))
    });
    material.unwrap_or((PLACEHOLDER, None))
}

/// Reads the pattern of a material, if it has one.
fn pattern(material: &mut Table, shape: &Shape) -> Option<Pattern> {
    if let Some(span) = material.value_span("stripes")
        && material.has("checker")
    {
        let message = "a material has either a `checker` or `stripes`";
        material.reject(span, message, "remove one of the two");
    }
    let of_kind = |kind, space, table: &mut Table| Pattern {
        kind,
        color: table.color("color"),
        size: table.positive("size"),
        space,
    };
    let checker = material.inline_table("checker", CHECKER_EXAMPLE, |table| {
        let space = space(table, shape);
        of_kind(PatternKind::Checker, space, table)
    });
    let stripes = material.inline_table("stripes", STRIPES_EXAMPLE, |table| {
        let space = space(table, shape);
        let kind = PatternKind::Stripes {
            direction: stripes_direction(table, shape, &space),
        };
        of_kind(kind, space, table)
    });
    checker.or(stripes)
}

fn space(pattern: &mut Table, shape: &Shape) -> Space {
    let is_object = pattern.choice("space", "space", &[("world", false), ("object", true)]);
    if is_object.is_some_and(|name| name.value) {
        Space::Object { axes: shape.axes() }
    } else {
        Space::World
    }
}

/// Reads the direction across stripes, which must not be the normal of a plane: the whole plane would lie at
/// the edge of a stripe, or near it.
fn stripes_direction(pattern: &mut Table, shape: &Shape, space: &Space) -> Point {
    let span = pattern.value_span("direction");
    let direction = pattern.direction("direction");
    if let (Shape::Plane { normal, .. }, Some(span)) = (*shape, span) {
        let normal = match space {
            Space::World => normal,
            Space::Object { .. } => UP,
        };
        let along = DVec3::from_array(direction).cross(DVec3::from_array(normal));
        if along.length() < MIN_STRIPES_SINE {
            let message = "the `direction` of stripes must not be perpendicular to the plane";
            pattern.reject(
                span,
                message,
                "use a direction in the plane, such as the one in which the stripes follow each other",
            );
        }
    }
    direction
}

fn model(name: ModelName, table: &mut Table) -> Model {
    match name {
        ModelName::Facing => Model::Facing,
        ModelName::Lambert => Model::Lambert,
        ModelName::Diffuse => Model::Diffuse,
        ModelName::Disney => Model::Disney(disney(table)),
        ModelName::Glossy => Model::Glossy {
            exponent: table.positive("exponent"),
        },
        ModelName::Mirror => Model::Mirror,
        ModelName::Glass => Model::Glass {
            ior: table.positive("ior"),
            fresnel: table
                .choice("fresnel", "Fresnel formula", &FRESNEL)
                .map_or(Fresnel::Exact, |fresnel| fresnel.value),
        },
        ModelName::Emitter => Model::Emitter,
    }
}

fn disney(table: &mut Table) -> Disney {
    let default = Disney::default();
    Disney {
        metallic: table.share_or("metallic", default.metallic),
        subsurface: table.share_or("subsurface", default.subsurface),
        specular: table.share_or("specular", default.specular),
        specular_tint: table.share_or("specular_tint", default.specular_tint),
        roughness: table.share_or("roughness", default.roughness),
        anisotropic: table.share_or("anisotropic", default.anisotropic),
        sheen: table.share_or("sheen", default.sheen),
        sheen_tint: table.share_or("sheen_tint", default.sheen_tint),
        clearcoat: table.share_or("clearcoat", default.clearcoat),
        clearcoat_gloss: table.share_or("clearcoat_gloss", default.clearcoat_gloss),
    }
}

// `[[motion]]`, and references to motions by name

/// The names of motions, in the order of the file.
#[derive(Default)]
pub(super) struct MotionNames(Vec<String>);

impl MotionNames {
    /// Returns the index of the motion that a key names, if there is such a key.
    pub(super) fn read(&self, key: &'static str, table: &mut Table) -> Option<usize> {
        let name = table.optional::<String>(key)?;
        let found = self.0.iter().position(|known| *known == name.value);
        if found.is_none() {
            let known: Vec<_> = self.0.iter().map(|known| format!("`{known}`")).collect();
            let known: Vec<_> = known.iter().map(String::as_str).collect();
            let near = nearest(&name.value, self.0.iter().map(String::as_str));
            let help = match (near, known.as_slice()) {
                (Some(near), _) => format!("did you mean `{near}`?"),
                (None, []) => format!("define it above in a [[motion]] with `name = \"{}\"`", name.value),
                (None, known) => format!("expected {}, or another [[motion]] above", one_of(known)),
            };
            table.reject(name.span, format!("unknown motion `{}`", name.value), &help);
        }
        found
    }
}

/// Reads a motion, and adds its name to those of the earlier ones.
pub(super) fn motion(table: &mut Table, names: &mut MotionNames) -> Motion {
    let name = table.required::<String>("name");
    let period = match [table.nonzero("frames"), table.nonzero("seconds")] {
        [Some(frames), None] => Period::Frames(frames),
        [None, Some(seconds)] => Period::Seconds(seconds),
        periods => {
            if table.is_valid() || periods[0].is_some() {
                let message = "a motion needs either `frames` or `seconds` for one turn";
                let help = match periods {
                    [None, None] => "add `seconds = 8.0`",
                    _ => "remove one of the two",
                };
                table.reject(table.span(), message, help);
            }
            Period::Frames(1.0)
        }
    };
    let motion = Motion {
        pivot: table.point_or("pivot", [0.0; 3]),
        axis: table.direction_or("axis", UP),
        period,
        within: names.read("within", table),
    };
    if let Some(name) = name {
        if names.0.contains(&name.value) {
            let message = format!("motion `{}` is defined twice", name.value);
            table.reject(name.span, message, "give each motion a name of its own");
        }
        names.0.push(name.value);
    } else {
        // Keeps the indices of motions and of their names equal.
        names.0.push(String::new());
    }
    motion
}
