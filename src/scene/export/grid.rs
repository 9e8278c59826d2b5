//! Grids with a sphere in each cell: a ray looks only into the cells that it passes through.

use std::fmt::Write;

use super::parts::Parts;
use super::sampler::PCG;
use super::{number, vector};
use crate::{Sampler, Scatter};

impl Parts<'_> {
    /// The functions that find the first sphere of a grid.
    pub(super) fn grid(&self, sampler: Sampler) -> Vec<String> {
        let mut pieces = Vec::new();
        if sampler != Sampler::Independent {
            pieces.push(PCG.to_owned());
        }
        let mut members = String::new();
        if self.checkers {
            members += ", grid.other, grid.side";
        }
        for property in self.properties() {
            let _ = write!(members, ", grid.{}", property.name);
        }
        pieces.push(SPHERE_IN.replace("MEMBERS", &members));
        pieces.push(INTERSECT.to_owned());
        pieces
    }
}

/// The values of all members but those that every surface has.
pub(super) fn values(scatter: &Scatter) -> String {
    let [x, y, z] = scatter.cells;
    let [small, large] = scatter.radius.map(number);
    format!(
        "{}, ivec3({x}, {y}, {z}), {}, {small}, {large}, {}u",
        vector(scatter.corner),
        number(scatter.spacing),
        scatter.seed
    )
}

pub(super) const STRUCTURE: &str = "// Cubic cells with a sphere in each, wholly inside of it.
struct Grid {
    vec3 corner;
    ivec3 cells;
    float spacing;
    float small;
    float large;
    uint seed;
";

const SPHERE_IN: &str = "uint drawn;

float draw() {
    drawn = pcg(drawn);
    return float(drawn >> 8u) / 16777216.0;
}

// The sphere of a cell.
Sphere sphereIn(Grid grid, ivec3 cell) {
    drawn = grid.seed + uint(cell.x + grid.cells.x * (cell.y + grid.cells.y * cell.z));
    float radius = mix(grid.small, grid.large, draw());
    float room = grid.spacing - 2.0 * radius;
    float x = draw();
    float y = draw();
    float z = draw();
    float r = draw();
    float g = draw();
    float b = draw();
    vec3 center = grid.corner + grid.spacing * vec3(cell) + radius + room * vec3(x, y, z);
    return Sphere(center, radius, grid.color * (0.2 + 0.8 * vec3(r, g, b))MEMBERS);
}
";

const INTERSECT: &str = "// The first hit, cell by cell (Amanatides and Woo, \"A Fast Voxel Traversal Algorithm for Ray Tracing\", 1987).
float intersectGrid(Ray ray, Grid grid, out Sphere sphere) {
    // A direction along an axis never leaves a cell across it.
    vec3 direction = mix(ray.direction, vec3(1.0e-20), equal(ray.direction, vec3(0.0)));
    vec3 low = (grid.corner - ray.origin) / direction;
    vec3 high = (grid.corner + grid.spacing * vec3(grid.cells) - ray.origin) / direction;
    vec3 into = min(low, high);
    vec3 outOf = max(low, high);
    float enter = max(max(into.x, into.y), max(into.z, 0.0));
    float leave = min(outOf.x, min(outOf.y, outOf.z));
    ivec3 cell = ivec3(0);
    if (enter < leave) {
        vec3 place = (ray.origin + enter * ray.direction - grid.corner) / grid.spacing;
        cell = clamp(ivec3(floor(place)), ivec3(0), grid.cells - 1);
    }
    sphere = sphereIn(grid, cell);
    if (enter >= leave) {
        return NO_HIT;
    }
    ivec3 stride = ivec3(sign(direction));
    // t at which the ray leaves the cell along each axis, and how much later it leaves the one after.
    vec3 next = (grid.corner + grid.spacing * vec3(cell + max(stride, 0)) - ray.origin) / direction;
    vec3 step = grid.spacing / abs(direction);
    int steps = grid.cells.x + grid.cells.y + grid.cells.z;
    for (int i = 0; i < steps; i++) {
        sphere = sphereIn(grid, cell);
        float t = intersectSphere(ray, sphere);
        if (t < NO_HIT) {
            return t;
        }
        if (next.x < next.y && next.x < next.z) {
            cell.x += stride.x;
            next.x += step.x;
        } else if (next.y < next.z) {
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
