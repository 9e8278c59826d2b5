//! Intersections of rays with spheres, planes, quadrics, boxes, and grids of spheres.

use std::fmt::Write;

use super::expression::{moved_direction, moved_point, number, vector};
use super::image::PCG;
use super::parts::Parts;
use super::pattern::Patterns;
use crate::shape::IDENTITY;
use crate::{Cuboid, Object, Quadric, QuadricKind, Sampler, Scatter};

impl Parts<'_> {
    pub(super) fn intersections(&self, sampler: Sampler) -> Vec<String> {
        let mut pieces = Vec::new();
        let mut loops = String::new();
        pieces.extend(self.patterns.function());
        if self.has_spheres() {
            pieces.push(INTERSECT_SPHERE.to_owned());
        }
        if !self.spheres.is_empty() {
            let normal = "«SphereNormal: normalize(hit.point - spheres[i].center)»";
            loops += &self.nearest("Sphere", "spheres", "spheres[i]", normal);
        }
        if !self.grids.is_empty() {
            pieces.extend(self.grid(sampler));
            loops += &self.nearest("Grid", "grids", "sphere", "normalize(hit.point - sphere.center)");
        }
        if !self.planes.is_empty() {
            pieces.push(INTERSECT_PLANE.to_owned());
            let normal = "faceforward(planes[i].normal, ray.direction, planes[i].normal)";
            loops += &self.nearest("Plane", "planes", "planes[i]", normal);
        }
        if !self.quadrics.is_empty() {
            pieces.push(INTERSECT_QUADRIC.to_owned());
            let normal = "quadricNormal(quadrics[i], hit.point, ray.direction)";
            loops += &self.nearest("Quadric", "quadrics", "quadrics[i]", normal);
        }
        if !self.boxes.is_empty() {
            pieces.push(box_functions(self.has_turned_boxes()));
            loops += &self.nearest("Box", "boxes", "boxes[i]", "boxNormal(boxes[i], hit.point)");
        }
        pieces.push(format!(
            "«NearestHitSignature: Intersection nearestHit(Ray ray)» {{\n    Intersection hit;\n    \
             hit.t = «InitialT: NO_HIT»;\n{loops}    «ReturnHit: return hit;»\n}}\n"
        ));
        pieces
    }

    /// Returns the loop over one kind of surfaces, which keeps the nearest hit; `surface` is the surface
    /// that was hit.
    fn nearest(&self, kind: &str, all: &str, surface: &str, normal: &str) -> String {
        let count = all.to_uppercase();
        let color = match self.patterns {
            Patterns::None if kind == "Sphere" => format!("«SphereColor: {surface}.color»"),
            patterns => patterns.color(surface, "hit.point", "hit.normal"),
        };
        let (first, count) = if kind == "Sphere" {
            ("«FirstSphere: 0»", format!("«SphereCount: {count}»"))
        } else {
            ("0", count)
        };
        let mut copied = String::new();
        for property in self.properties() {
            let _ = writeln!(copied, "            hit.{0} = {surface}.{0};", property.name);
        }
        if self.traces_paths && kind == "Sphere" {
            copied += "            hit.sphere = i;\n";
        }
        let intersect_call = if kind == "Grid" {
            "        Sphere sphere;\n        float t = intersectGrid(ray, grids[i], sphere);\n".to_owned()
        } else {
            format!("        float t = intersect{kind}(ray, {surface});\n")
        };
        format!(
            "    for (int i = {first}; i < {count}; i++) {{\n{intersect_call}        if («IsNearer: t < hit.t») {{\n            \
             hit.t = «HitT: t»;\n            hit.point = «HitPoint: ray.origin + t * ray.direction»;\n            hit.normal = {normal};\n            \
             hit.color = {color};\n{copied}        }}\n    }}\n"
        )
    }
}

const INTERSECT_SPHERE: &str =
    "// Starts at the point of the ray closest to the center: smaller numbers have smaller rounding errors.
float intersectSphere(Ray ray, Sphere sphere) {
    vec3 f = «CenterToOrigin: ray.origin - sphere.center»;
    float b = dot(f, ray.direction);
    vec3 closest = f - b * ray.direction;
    float disc = «Discriminant: sphere.radius * sphere.radius - dot(closest, closest)»;
    if (disc > 0.0) {
        float root = «DiscriminantRoot: sqrt(disc)»;
        float t = «NearRoot: -b - root»;
        if («NearRootIsHit: t > «SphereMinT: 0.00001»») {
            return t;
        }
        t = «FarRoot: -b + root»;
        if (t > «SphereMinT: 0.00001») {
            return t;
        }
    }
    return NO_HIT;
}
";

const INTERSECT_PLANE: &str = "float intersectPlane(Ray ray, Plane plane) {
    float t = dot(plane.normal, plane.point - ray.origin) / dot(plane.normal, ray.direction);
    return t > «PlaneMinT: 0.00001» ? t : NO_HIT;
}
";

// Quadrics.

pub(super) const QUADRIC_FORM: &str =
    "// q.x x^2 + q.y y^2 + q.z z^2 + 2 g z + k = 0 for low <= z <= high, in local coordinates.
struct Form {
    vec3 q;
    float g;
    float k;
    float low;
    float high;
};
";

pub(super) const QUADRIC_STRUCTURE: &str = "struct Quadric {
    vec3 origin;
    mat3 axes;
    Form form;
";

/// Returns the functions that the values of the quadrics call.
pub(super) fn quadric_functions<'a>(quadrics: impl Iterator<Item = &'a Quadric>) -> Vec<String> {
    let mut pieces = Vec::new();
    for quadric in quadrics {
        let (text, _) = form(&quadric.kind);
        let frame = (!is_ellipsoid(quadric)).then_some(FRAME);
        for piece in [Some(text), frame].into_iter().flatten() {
            if !pieces.iter().any(|known| known == piece) {
                pieces.push(piece.to_owned());
            }
        }
    }
    pieces
}

/// Returns the values of the members of a quadric that not every surface has.
pub(super) fn quadric_values(quadric: &Quadric, motion: Option<usize>) -> String {
    let axes = quadric
        .axes
        .map(|axis| moved_direction(axis, quadric.origin, motion));
    let axes = if is_ellipsoid(quadric) {
        format!("mat3({})", axes.join(", "))
    } else {
        format!("frame({})", axes[2])
    };
    let (_, form) = form(&quadric.kind);
    format!("{}, {axes}, {form}", moved_point(quadric.origin, motion))
}

fn is_ellipsoid(quadric: &Quadric) -> bool {
    matches!(quadric.kind, QuadricKind::Ellipsoid { .. })
}

/// Returns the function that constructs the form of a quadric, and its call.
fn form(kind: &QuadricKind) -> (&'static str, String) {
    let call = |name, numbers: &[f64]| {
        let numbers: Vec<_> = numbers.iter().map(|&value| number(value)).collect();
        format!("{name}({})", numbers.join(", "))
    };
    match *kind {
        QuadricKind::Ellipsoid { radii } => (ELLIPSOID, format!("ellipsoid({})", vector(radii))),
        QuadricKind::Cylinder { radius, height } => (CYLINDER, call("cylinder", &[radius, height])),
        QuadricKind::Cone { radius, height } => (CONE, call("cone", &[radius, height])),
        QuadricKind::Paraboloid { radius, height } => (PARABOLOID, call("paraboloid", &[radius, height])),
        QuadricKind::Hyperboloid {
            waist,
            radius,
            height,
        } => (HYPERBOLOID, call("hyperboloid", &[waist, radius, height])),
    }
}

const FRAME: &str = "// An orthonormal basis whose third vector is the axis.
mat3 frame(vec3 axis) {
    vec3 x = abs(axis.z) > 0.9 ? vec3(1.0, 0.0, 0.0) : cross(axis, vec3(0.0, 0.0, 1.0));
    x = normalize(x - dot(x, axis) * axis);
    return «AxisFrame: mat3(x, cross(axis, x), axis)»;
}
";

const ELLIPSOID: &str = "Form ellipsoid(vec3 radii) {
    return Form(«EllipsoidQ: 1.0 / (radii * radii)», 0.0, -1.0, «EllipsoidEnds: -NO_HIT, NO_HIT»);
}
";

const CYLINDER: &str = "Form cylinder(float radius, float height) {
    return Form(vec3(1.0, 1.0, 0.0), 0.0, -radius * radius, 0.0, height);
}
";

const CONE: &str = "Form cone(float radius, float height) {
    float slope = radius / height;
    return Form(vec3(1.0, 1.0, «ConeSlope: -slope * slope»), 0.0, 0.0, «ConeLow: 0.0», height);
}
";

const PARABOLOID: &str = "Form paraboloid(float radius, float height) {
    return Form(vec3(1.0, 1.0, 0.0), «ParaboloidG: -0.5 * radius * radius / height», 0.0, 0.0, height);
}
";

const HYPERBOLOID: &str = "Form hyperboloid(float waist, float radius, float height) {
    float z = 0.5 * height;
    float slope2 = (radius * radius - waist * waist) / (z * z);
    return Form(vec3(1.0, 1.0, -slope2), 0.0, «HyperboloidK: -waist * waist», -z, z);
}
";

pub(super) const INTERSECT_QUADRIC: &str =
    "// Starts at the point of the ray closest to the origin, as for spheres.
float intersectQuadric(Ray ray, Quadric quadric) {
    Form form = quadric.form;
    vec3 d = «RayInFrame: ray.direction * quadric.axes»;
    vec3 origin = «OriginInFrame: (ray.origin - quadric.origin) * quadric.axes»;
    float ahead = -dot(origin, d);
    vec3 o = origin + ahead * d;
    float a = dot(form.q * d, d);
    float b = dot(form.q * d, o) + form.g * d.z;
    float c = dot(form.q * o, o) + 2.0 * form.g * o.z + form.k;
    float disc = b * b - a * c;
    if (disc < 0.0) {
        return NO_HIT;
    }
    // The root without cancellation; the other follows from their product. If a is 0, there is only one root.
    float q = b > 0.0 ? -b - sqrt(disc) : -b + sqrt(disc);
    float t0 = q == 0.0 ? NO_HIT : c / q;
    float t1 = a == 0.0 ? NO_HIT : q / a;
    float near = min(t0, t1);
    float z = o.z + near * d.z;
    if («NearQuadricIsHit: ahead + near > «NearQuadricMinT: 0.00001» && z >= form.low && z <= form.high») {
        return «NearQuadricT: ahead + near»;
    }
    float beyond = max(t0, t1);
    z = o.z + beyond * d.z;
    if («FarQuadricIsHit: ahead + beyond > «FarQuadricMinT: 0.00001» && z >= form.low && z <= form.high») {
        return «FarQuadricT: ahead + beyond»;
    }
    return NO_HIT;
}

// Open surfaces are visible from both sides.
vec3 quadricNormal(Quadric quadric, vec3 point, vec3 direction) {
    vec3 p = (point - quadric.origin) * quadric.axes;
    vec3 normal = «QuadricNormal: normalize(quadric.axes * (quadric.form.q * p + vec3(0.0, 0.0, quadric.form.g)))»;
    return «QuadricSide: quadric.form.high < NO_HIT ? faceforward(normal, direction, normal) : normal»;
}
";

// Boxes.

impl Parts<'_> {
    /// Whether boxes have axes of their own.
    pub(super) fn has_turned_boxes(&self) -> bool {
        let is_turned =
            |(cuboid, object): &(Cuboid, &Object)| cuboid.axes != IDENTITY || object.motion.is_some();
        self.boxes.iter().any(is_turned)
    }

    /// Returns the values of the members of a box that not every surface has.
    pub(super) fn box_values(&self, cuboid: &Cuboid, motion: Option<usize>) -> String {
        let half_size = vector(cuboid.size.map(|side| 0.5 * side));
        let mut text = format!("{}, {half_size}", moved_point(cuboid.center, motion));
        if self.has_turned_boxes() {
            let axes = cuboid
                .axes
                .map(|axis| moved_direction(axis, cuboid.center, motion));
            let _ = write!(text, ", mat3({})", axes.join(", "));
        }
        text
    }
}

/// Returns the functions that intersect boxes, with axes of their own or with those of the scene.
fn box_functions(is_turned: bool) -> String {
    let (to_local, to_scene) = if is_turned {
        (" * box.axes", "box.axes * ")
    } else {
        ("", "")
    };
    let local = |vector: &str| match to_local {
        "" => vector.to_owned(),
        _ => format!("({vector}){to_local}"),
    };
    BOX_FUNCTIONS
        .replace("ORIGIN", &local("ray.origin - box.center"))
        .replace("DIRECTION", &format!("ray.direction{to_local}"))
        .replace("POINT", &local("point - box.center"))
        .replace("TO_SCENE", to_scene)
}

const BOX_FUNCTIONS: &str =
    "// A box is where three slabs overlap: the ray is inside after it has entered all, until it leaves one.
float intersectBox(Ray ray, Box box) {
    vec3 o = ORIGIN;
    vec3 d = DIRECTION;
    // A tiny component instead of 0 avoids a division by 0.
    d = mix(d, vec3(1.0e-20), equal(d, vec3(0.0)));
    vec3 side = sign(d) * «BoxReach: box.halfSize»;
    vec3 near = (-side - o) / d;
    vec3 far = (side - o) / d;
    float enter = «BoxEnter: max(near.x, max(near.y, near.z))»;
    float leave = «BoxLeave: min(far.x, min(far.y, far.z))»;
    if (enter >= leave) {
        return NO_HIT;
    }
    if (enter > «BoxMinT: 0.00001») {
        return enter;
    }
    return leave > «BoxMinT: 0.00001» ? leave : NO_HIT;
}

// The normal of the nearest face.
vec3 boxNormal(Box box, vec3 point) {
    vec3 p = POINT;
    vec3 depth = «BoxDepth: box.halfSize» - abs(p);
    vec3 face = vec3(0.0, 0.0, 1.0);
    if (depth.x < depth.y && depth.x < depth.z) {
        face = vec3(1.0, 0.0, 0.0);
    } else if (depth.y < depth.z) {
        face = vec3(0.0, 1.0, 0.0);
    }
    return «BoxNormal: TO_SCENE(«BoxSide: sign(p)» * face)»;
}
";

// Grids with a sphere in each cell, traversed along the ray.

impl Parts<'_> {
    /// Returns the functions that find the first sphere of a grid.
    pub(super) fn grid(&self, sampler: Sampler) -> Vec<String> {
        let mut pieces = Vec::new();
        if sampler != Sampler::Independent {
            pieces.push(PCG.to_owned());
        }
        let has_plain = self
            .grids
            .iter()
            .any(|scatter| scatter.material.pattern.is_none());
        let [statements, arguments] = self.patterns.of_cell(has_plain);
        let mut members = arguments.to_owned();
        for property in self.properties() {
            let _ = write!(members, ", grid.{}", property.name);
        }
        let color = "grid.color * (0.2 + 0.8 * «CellColor: vec3(r, g, b)»)";
        let (statements, color) = match statements {
            "" => (String::new(), color),
            _ => (format!("    vec3 color = {color};\n{statements}"), "color"),
        };
        let cell_sphere = CELL_SPHERE
            .replace("STATEMENTS", &statements)
            .replace("COLOR", color)
            .replace("MEMBERS", &members);
        pieces.push(cell_sphere);
        pieces.push(INTERSECT_GRID.to_owned());
        pieces
    }
}

/// Returns the values of the members of a grid that not every surface has.
pub(super) fn grid_values(scatter: &Scatter) -> String {
    let [x, y, z] = scatter.cells;
    let [small, large] = scatter.radius.map(number);
    format!(
        "{}, ivec3({x}, {y}, {z}), {}, {small}, {large}, {}u",
        vector(scatter.corner),
        number(scatter.spacing),
        scatter.seed
    )
}

pub(super) const GRID_STRUCTURE: &str = "// A grid of cubic cells, each with a sphere that lies inside it.
struct Grid {
    vec3 corner;
    ivec3 cells;
    float spacing;
    float minRadius;
    float maxRadius;
    uint seed;
";

const CELL_SPHERE: &str = "uint cellState;

float cellRandom() {
    cellState = pcg(cellState);
    return float(cellState >> 8u) / 16777216.0;
}

// The sphere of a cell.
Sphere cellSphere(Grid grid, ivec3 cell) {
    cellState = «CellSeed: grid.seed + «CellNumber: uint(cell.x + grid.cells.x * (cell.y + grid.cells.y * cell.z))»»;
    float radius = «CellRadius: mix(grid.minRadius, grid.maxRadius, cellRandom())»;
    float room = «CellRoom: grid.spacing - 2.0 * radius»;
    float x = cellRandom();
    float y = cellRandom();
    float z = cellRandom();
    float r = cellRandom();
    float g = cellRandom();
    float b = cellRandom();
    vec3 center = grid.corner + grid.spacing * vec3(cell) + radius + room * «CellPlace: vec3(x, y, z)»;
STATEMENTS    return Sphere(center, radius, COLORMEMBERS);
}
";

const INTERSECT_GRID: &str = "// The nearest hit, cell by cell (Amanatides and Woo, \"A Fast Voxel Traversal Algorithm for Ray Tracing\", 1987).
float intersectGrid(Ray ray, Grid grid, out Sphere sphere) {
    // A tiny component instead of 0 avoids a division by 0.
    vec3 direction = mix(ray.direction, vec3(1.0e-20), equal(ray.direction, vec3(0.0)));
    vec3 low = (grid.corner - ray.origin) / direction;
    vec3 high = (grid.corner + grid.spacing * vec3(grid.cells) - ray.origin) / direction;
    vec3 near = min(low, high);
    vec3 far = max(low, high);
    float enter = max(max(near.x, near.y), max(near.z, 0.0));
    float leave = min(far.x, min(far.y, far.z));
    ivec3 cell = ivec3(0);
    if (enter < leave) {
        vec3 place = (ray.origin + enter * ray.direction - grid.corner) / grid.spacing;
        cell = clamp(ivec3(floor(place)), ivec3(0), grid.cells - 1);
    }
    sphere = cellSphere(grid, cell);
    if (enter >= leave) {
        return NO_HIT;
    }
    ivec3 stride = «GridStride: ivec3(sign(direction))»;
    // For each axis, the t at which the ray leaves the cell, and the distance in t between cell boundaries.
    vec3 next = (grid.corner + grid.spacing * vec3(cell + max(stride, 0)) - ray.origin) / direction;
    vec3 step = «GridStep: grid.spacing / abs(direction)»;
    int steps = grid.cells.x + grid.cells.y + grid.cells.z;
    for (int i = 0; i < «GridSteps: steps»; i++) {
        sphere = cellSphere(grid, cell);
        float t = intersectSphere(ray, sphere);
        if (t < NO_HIT) {
            return t;
        }
        if («NextCellIsX: next.x < next.y && next.x < next.z») {
            cell.x += stride.x;
            next.x += step.x;
        } else if («NextCellIsY: next.y < next.z») {
            cell.y += stride.y;
            next.y += step.y;
        } else {
            cell.z += stride.z;
            next.z += step.z;
        }
        if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, grid.cells))) {
            return NO_HIT;
        }
    }
    return NO_HIT;
}
";
