//! Grids with a sphere in each cell, and the numbers that they are drawn from.

use super::mistakes;

const STEPS: &str = "for (int i = 0; i < steps; i++) {";
const PLACE: &str = "radius + room * vec3(x, y, z)";
const ROOM: &str = "float room = grid.spacing - 2.0 * radius;";
const INDEX: &str = "uint(cell.x + grid.cells.x * (cell.y + grid.cells.y * cell.z))";
const SEED: &str = "drawn = grid.seed + ";

mistakes! {
    "first-cell-only": "looks into the first cell of the grid only", [(STEPS, "for (int i = 0; i < 1; i++) {")];
    "strides-without-sign": "goes through the cells in the positive direction always", [("ivec3(sign(direction))", "ivec3(1)")];
    "steps-not-of-a-cell": "takes steps of length 1 from cell to cell, not of a cell's side", [("grid.spacing / abs(direction)", "1.0 / abs(direction)")];
    "farther-wall-first": "goes on across the farther wall of a cell, not the nearer",
        [("if (next.x < next.y && next.x < next.z) {", "if (next.x > next.y && next.x > next.z) {")];
    "an-axis-forgotten": "never goes on to the cells above or below, or never to those behind",
        [("} else if (next.y < next.z) {", "} else if (false) {")],
        [("} else if (next.y < next.z) {", "} else if (true) {")];
    "cell-number-swapped": "has x and y, or y and z, exchanged in the number of a cell",
        [(INDEX, "uint(cell.y + grid.cells.y * (cell.x + grid.cells.x * cell.z))")],
        [(INDEX, "uint(cell.x + grid.cells.x * (cell.z + grid.cells.z * cell.y))")],
        [(INDEX, "uint(cell.z + grid.cells.z * (cell.y + grid.cells.y * cell.x))")];
    "another-seed": "starts from another seed",
        [(SEED, "drawn = grid.seed + 1u + ")],
        [(SEED, "drawn = grid.seed - 1u + ")],
        [(SEED, "drawn = ")],
        [(SEED, "drawn = 1u + ")];
    "in-the-middle-of-cells": "puts spheres in the middle of their cells", [(PLACE, "radius + room * 0.5")];
    "room-too-large": "gives spheres the room of the whole cell, or takes the radius away once only",
        [(ROOM, "float room = grid.spacing;")],
        [(ROOM, "float room = grid.spacing - radius;")];
    "radii-alike": "makes all spheres of the grid equally large", [("mix(grid.small, grid.large, draw())", "0.5 * (grid.small + grid.large) + 0.0 * draw()")];
    "coordinates-drawn-backwards": "draws the place from z to x, not from x to z", [(PLACE, "radius + room * vec3(z, y, x)")];
    "colours-drawn-backwards": "draws blue first and red last", [("0.8 * vec3(r, g, b)", "0.8 * vec3(b, g, r)")];
    "hash-without-its-shift": "forgets the last shift of the hash", [("return (word >> 22u) ^ word;", "return word;")];
}
