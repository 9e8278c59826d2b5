//! Mistakes in the geometry: the intersection of rays with spheres, quadrics and grids, normals, and motion.

use super::{Mistake, mistakes};

/// The textbook's discriminant, for directions of length 1.
pub(super) const TEXTBOOK: &str = "b * b - dot(f, f) + sphere.radius * sphere.radius";

/// Intersections of rays with spheres, and the nearest hit.
pub(super) static INTERSECTIONS: &[Mistake] = mistakes! {
    "roots-not-halved": "does not divide the roots by 2a",
        [NearRoot = "2.0 * (-b - root)", FarRoot = "2.0 * (-b + root)"];
    "discriminant-without-4": "forgets the 4 in b² − 4ac",
        [
            Discriminant = "4.0 * b * b - dot(f, f) + sphere.radius * sphere.radius",
            NearRoot = "(-2.0 * b - root) / 2.0",
            FarRoot = "(-2.0 * b + root) / 2.0",
        ];
    "far-root": "takes the root where a ray leaves the sphere, not the one where it enters",
        [NearRoot = "-b + root"];
    "behind-the-eye": "counts what lies behind the start of a ray", [NearRootIsHit = "true"];
    "radius-not-squared": "does not square the radius",
        [Discriminant = "sphere.radius - dot(closest, closest)"];
    "root-not-taken": "does not take the square root of the discriminant", [DiscriminantRoot = "disc"];
    "sign-of-b": "has the wrong sign of b: the centre minus the origin, where the formula has the origin minus the centre",
        [CenterToOrigin = "sphere.center - ray.origin"];
    "last-hit": "keeps the last sphere that a ray meets, not the nearest",
        [IsNearer = "t < NO_HIT"],
        [IsNearer = "t < NO_HIT", HitT = "min(t, hit.t)", HitPoint = "ray.origin + hit.t * ray.direction"];
    "first-hit": "keeps the first sphere that a ray meets, not the nearest",
        [IsNearer = "t < NO_HIT && hit.t == NO_HIT"];
    "farthest-hit": "keeps the farthest sphere that a ray meets, not the nearest",
        [IsNearer = "t < NO_HIT && (hit.t == NO_HIT || t > hit.t)"];
    "first-sphere-for-all": "takes the colour and the normal of the first sphere for all",
        [SphereColor = "spheres[0].color", SphereNormal = "normalize(hit.point - spheres[0].center)"];
    "normal-of-the-first-sphere": "takes the normal of the first sphere for all",
        [SphereNormal = "normalize(hit.point - spheres[0].center)"];
    "colour-of-the-first-sphere": "takes the colour of the first sphere for all",
        [SphereColor = "spheres[0].color"];
    "colour-of-the-next-sphere": "takes the colour of the next sphere",
        [SphereColor = "spheres[(i + 1) % SPHERES].color"];
    "colour-of-the-last-sphere": "takes the colour of the last sphere for all",
        [SphereColor = "spheres[SPHERES - 1].color"];
    "loop-too-short": "ends its loop over the spheres too early: the last ones cannot be seen",
        [SphereCount = "SPHERES - 1"],
        [SphereCount = "SPHERES - 2"];
    "loop-from-1": "starts its loop over the spheres at 1: the first one cannot be seen", [FirstSphere = "1"];
    "nearest-not-reset": "does not start from far away again when it looks for the nearest hit of the next ray",
        [
            NearestHitSignature = "float nearest;\n\n…",
            InitialT = "nearest",
            ReturnHit = "if (hit.t == nearest) {\n        hit.t = NO_HIT;\n    } else {\n        nearest = hit.t;\n    }\n    …",
            PrimaryRay = "nearest = NO_HIT;\n    …",
        ];
};

/// Surfaces of second degree, and checkered ones.
pub(super) static QUADRICS: &[Mistake] = mistakes! {
    "ends-not-tested": "does not end cylinders, cones and their like",
        [
            NearQuadricIsHit = "ahead + near > «NearQuadricMinT»",
            FarQuadricIsHit = "ahead + beyond > «FarQuadricMinT»",
        ];
    "only-the-nearer-root": "gives up where the nearer root lies beyond the ends, though the other may not",
        [FarQuadricIsHit = "false"];
    "radii-not-squared": "does not square the radii of ellipsoids",
        [EllipsoidQ = "1.0 / radii"],
        [EllipsoidQ = "1.0 / radii", EllipsoidEnds = "-radii.z, radii.z"];
    "radii-multiplied": "multiplies by the squared radii of ellipsoids where it should divide",
        [EllipsoidQ = "radii * radii"],
        [EllipsoidQ = "radii * radii", EllipsoidEnds = "-radii.z, radii.z"];
    "axis-forgotten": "forgets the axes: all surfaces lie along z", [AxisFrame = "mat3(1.0)"];
    "frame-by-the-wrong-side": "multiplies by the frame from the wrong side",
        [RayInFrame = "quadric.axes * ray.direction"],
        [
            RayInFrame = "quadric.axes * ray.direction",
            OriginInFrame = "quadric.axes * (ray.origin - quadric.origin)",
        ];
    "normal-left-in-the-frame": "leaves the normal in the surface's own coordinates",
        [QuadricNormal = "normalize(quadric.form.q * p + vec3(0.0, 0.0, quadric.form.g))"];
    "normal-from-the-middle": "takes the direction from the surface's own origin for its normal",
        [QuadricNormal = "normalize(point - quadric.origin)"];
    "normal-without-the-linear-part": "forgets the linear part of the equation in the normal",
        [QuadricNormal = "normalize(quadric.axes * (quadric.form.q * p))"];
    "cone-without-its-slope": "has cones of 45°, whatever their radius and height", [ConeSlope = "-1.0"];
    "both-nappes": "shows both nappes of the cone", [ConeLow = "-height"];
    "paraboloid-too-wide": "has the 2 of the paraboloid's equation in the wrong place",
        [ParaboloidG = "-radius * radius / height"],
        [ParaboloidG = "-2.0 * radius * radius / height"];
    "hyperboloid-of-two-sheets": "has a hyperboloid of two sheets", [HyperboloidK = "waist * waist"];
    "quadric-normal-inwards": "shows the dark side of surfaces of second degree: their normal points away from the ray",
        [QuadricSide = "-faceforward(normal, direction, normal)"];
    "normal-not-turned": "does not turn the normal of open surfaces to the ray",
        [QuadricSide = "normal"],
        [QuadricSide = "-normal"];
    "not-moved-back": "moves the ray's start closer, and forgets to add that to t",
        [NearQuadricT = "near"],
        [NearQuadricT = "near", FarQuadricT = "beyond"];
    "checker-in-one-direction": "has stripes for a checker",
        [CheckerSum = "square.x"],
        [CheckerSum = "square.y"];
    "checker-by-truncation": "rounds towards 0 where the checker needs floor: its squares are twice as wide at the axes",
        [CheckerSquare = "trunc(point.xz / side)"];
    "checker-too-large": "has the squares of a checker twice as large",
        [CheckerSquare = "floor(point.xz / (2.0 * side))"];
    "checker-too-small": "has the squares of a checker half as large",
        [CheckerSquare = "floor(point.xz / (0.5 * side))"];
    "checker-multiplied": "multiplies by the squares' side where it should divide",
        [CheckerSquare = "floor(point.xz * side)"];
    "checker-colours-swapped": "has the two colours of the checker exchanged",
        [CheckerEven = "«CheckerOdd»", CheckerOdd = "«CheckerEven»"];
};

/// Grids with a sphere in each cell, and the random numbers of the spheres.
pub(super) static GRIDS: &[Mistake] = mistakes! {
    "first-cell-only": "looks into the first cell of the grid only", [GridSteps = "1"];
    "strides-without-sign": "goes through the cells in the positive direction always",
        [GridStride = "ivec3(1)"];
    "steps-not-of-a-cell": "takes steps of length 1 from cell to cell, not of a cell's side",
        [GridStep = "1.0 / abs(direction)"];
    "farther-wall-first": "goes on across the farther wall of a cell, not the nearer",
        [NextCellIsX = "next.x > next.y && next.x > next.z"];
    "an-axis-forgotten": "never goes on to the cells above or below, or never to those behind",
        [NextCellIsY = "false"],
        [NextCellIsY = "true"];
    "cell-number-swapped": "has x and y, or y and z, exchanged in the number of a cell",
        [CellNumber = "uint(cell.y + grid.cells.y * (cell.x + grid.cells.x * cell.z))"],
        [CellNumber = "uint(cell.x + grid.cells.x * (cell.z + grid.cells.z * cell.y))"],
        [CellNumber = "uint(cell.z + grid.cells.z * (cell.y + grid.cells.y * cell.x))"];
    "another-seed": "starts from another seed",
        [CellSeed = "grid.seed + 1u + «CellNumber»"],
        [CellSeed = "grid.seed - 1u + «CellNumber»"],
        [CellSeed = "«CellNumber»"],
        [CellSeed = "1u + «CellNumber»"];
    "in-the-middle-of-cells": "puts spheres in the middle of their cells", [CellPlace = "0.5"];
    "room-too-large": "gives spheres the room of the whole cell, or takes the radius away once only",
        [CellRoom = "grid.spacing"],
        [CellRoom = "grid.spacing - radius"];
    "radii-alike": "makes all spheres of the grid equally large",
        [CellRadius = "0.5 * (grid.minRadius + grid.maxRadius) + 0.0 * cellRandom()"];
    "coordinates-drawn-backwards": "draws the place from z to x, not from x to z",
        [CellPlace = "vec3(z, y, x)"];
    "colours-drawn-backwards": "draws blue first and red last", [CellColor = "vec3(b, g, r)"];
    "hash-without-its-shift": "forgets the last shift of the hash", [HashResult = "word"];
};

/// Normals of spheres.
pub(super) static NORMALS: &[Mistake] = mistakes! {
    "normal-not-normalised": "does not normalise normals",
        [SphereNormal = "(hit.point - spheres[i].center)"],
        [SphereNormal = "(hit.point - spheres[i].center)", Discriminant = TEXTBOOK];
    "normal-inwards": "has normals that point into the spheres",
        [SphereNormal = "normalize(spheres[i].center - hit.point)"];
    "normal-from-the-origin": "has normals that point away from the world's origin, not from the sphere's centre",
        [SphereNormal = "normalize(hit.point)"];
    "normal-is-the-direction": "takes the ray's direction for the normal", [SphereNormal = "-ray.direction"];
};

/// Motions.
pub(super) static MOTIONS: &[Mistake] = mistakes! {
    "turned-the-other-way": "turns the other way round", [RotationCross = "cross(v, axis)"];
    "rotation-without-its-last-term": "forgets the last term of Rodrigues' formula",
        [Rotation = "c * v + s * «RotationCross»"];
    "sine-and-cosine-swapped": "has sine and cosine exchanged",
        [AngleCosine = "«AngleSine»", AngleSine = "«AngleCosine»"];
    "angle-in-turns": "takes the number of turns for an angle in radians", [RotationAngle = "fract(turns)"];
    "angle-in-degrees": "takes degrees for radians", [RotationAngle = "360.0 * fract(turns)"];
    "half-turns": "turns by π where 2π should stand", [RotationAngle = "3.14159265359 * fract(turns)"];
    "about-the-origin": "turns about the world's origin, not about the pivot",
        [RotationAboutPivot = "rotate(p, axis, «RotationAngle»)"];
    "pivot-not-added-back": "does not add the pivot back",
        [RotationAboutPivot = "rotate(«RotatedPoint», axis, «RotationAngle»)"];
    "pivot-not-taken-away": "does not take the pivot away before it turns", [RotatedPoint = "p"];
    "carried-along-first": "carries a thing along before it turns it about its own axis, where it should be after",
        [CarriedBy0 = "rotateAbout(motion0(p), «RotationArguments»)"],
        [CarriedBy1 = "rotateAbout(motion1(p), «RotationArguments»)"],
        [CarriedBy2 = "rotateAbout(motion2(p), «RotationArguments»)"];
};
