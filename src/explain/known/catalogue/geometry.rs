//! Mistakes in the geometry: the intersection of rays with spheres, quadrics and grids, normals, and motion.

use super::{Group, mistakes};

/// The textbook's discriminant, for directions of length 1.
pub(super) const TEXTBOOK: &str = "b * b - dot(f, f) + sphere.radius * sphere.radius";

/// Intersections of rays with spheres, and the nearest hit.
pub(super) static INTERSECTIONS: Group = mistakes! {
    /// Use `t = (-b - sqrt(disc)) / (2.0 * a)`.
    "roots-not-halved": "the roots of the quadratic are not divided by 2a",
        [NearRoot = "2.0 * (-b - root)", FarRoot = "2.0 * (-b + root)"];
    /// Use `disc = b * b - 4.0 * a * c`.
    "discriminant-without-4": "the 4 is missing in the discriminant b² − 4ac",
        [
            Discriminant = "4.0 * b * b - dot(f, f) + sphere.radius * sphere.radius",
            NearRoot = "(-2.0 * b - root) / 2.0",
            FarRoot = "(-2.0 * b + root) / 2.0",
        ];
    /// Use the smaller root, `(-b - sqrt(disc)) / (2.0 * a)`, if it is positive.
    "far-root": "the far root is used instead of the near one: rays hit the back of the sphere",
        [NearRoot = "-b + root"];
    /// Accept a root only if `t > 0.0`, or `t > 1e-3` for secondary rays.
    "hit-behind-origin": "hits behind the ray's origin (negative t) are accepted", [NearRootIsHit = "true"];
    /// Use `c = dot(oc, oc) - radius * radius`.
    "radius-not-squared": "the sphere's radius is not squared in the quadratic",
        [Discriminant = "sphere.radius - dot(closest, closest)"];
    /// Use `sqrt(disc)` in the roots.
    "discriminant-without-sqrt": "the square root of the discriminant is missing",
        [DiscriminantRoot = "disc"];
    /// Use `oc = ray.origin - center` and `b = 2.0 * dot(oc, d)`.
    "sign-of-b": "b has the wrong sign: center − origin is used instead of origin − center",
        [CenterToOrigin = "sphere.center - ray.origin"];
    /// In the loop, keep a hit only if it is nearer: `if (t > 0.0 && t < nearest) { nearest = t; … }`.
    "last-hit": "the last sphere that a ray hits is kept instead of the nearest",
        [IsNearer = "t < NO_HIT"],
        [IsNearer = "t < NO_HIT", HitT = "min(t, hit.t)", HitPoint = "ray.origin + hit.t * ray.direction"];
    /// Do not leave the loop at the first hit; keep the smallest t of all spheres.
    "first-hit": "the first sphere that a ray hits is kept instead of the nearest",
        [IsNearer = "t < NO_HIT && hit.t == NO_HIT"];
    /// Compare with `<`: `if (t < nearest) { nearest = t; … }`.
    "farthest-hit": "the farthest hit is kept instead of the nearest",
        [IsNearer = "t < NO_HIT && (hit.t == NO_HIT || t > hit.t)"];
    /// Keep the index of the nearest sphere in the loop and use `spheres[index]`.
    "first-sphere-for-all": "the color and the normal are always those of the first sphere",
        [SphereColor = "spheres[0].color", SphereNormal = "normalize(hit.point - spheres[0].center)"];
    /// Use the center of the sphere that was hit: `normalize(point - spheres[index].center)`.
    "normal-of-first-sphere": "the normal is always computed from the first sphere",
        [SphereNormal = "normalize(hit.point - spheres[0].center)"];
    /// Use the color of the sphere that was hit: `spheres[index].color`.
    "color-of-first-sphere": "the color is always that of the first sphere",
        [SphereColor = "spheres[0].color"];
    /// Use the same index for the color as for the intersection.
    "color-of-next-sphere": "the color is that of the next sphere: the index is off by one",
        [SphereColor = "spheres[(i + 1) % SPHERES].color"];
    /// Store the color only when a hit is nearer, not in each iteration.
    "color-of-last-sphere": "the color is always that of the last sphere",
        [SphereColor = "spheres[SPHERES - 1].color"];
    /// Use `for (int i = 0; i < SPHERES; i++)`.
    "loop-too-short": "the loop over the spheres ends too early: the last ones are missing",
        [SphereCount = "SPHERES - 1"],
        [SphereCount = "SPHERES - 2"];
    /// Start at 0: `for (int i = 0; i < SPHERES; i++)`.
    "loop-from-1": "the loop over the spheres starts at 1: the first one is missing", [FirstSphere = "1"];
    /// Set `nearest` to a large value at the start of each search for the nearest hit.
    "nearest-not-reset": "the nearest t of the previous ray is not reset before the next ray",
        [
            NearestHitSignature = "float nearest;\n\n…",
            InitialT = "nearest",
            ReturnHit = "if (hit.t == nearest) {\n        hit.t = NO_HIT;\n    } else {\n        nearest = hit.t;\n    }\n    …",
            PrimaryRay = "nearest = NO_HIT;\n    …",
        ];
};

/// Surfaces of second degree, and checkered ones.
pub(super) static QUADRICS: Group = mistakes! {
    /// Accept a root only if the local z lies between the ends: `z >= low && z <= high`.
    "ends-not-tested": "hits beyond the ends of cylinders, cones and other open quadrics are accepted",
        [
            NearQuadricIsHit = "ahead + near > «NearQuadricMinT»",
            FarQuadricIsHit = "ahead + beyond > «FarQuadricMinT»",
        ];
    /// Test both roots: first the near one, then the far one.
    "near-root-only": "the far root is not tested where the near root lies beyond the quadric's ends",
        [FarQuadricIsHit = "false"];
    /// Use `1.0 / (radii * radii)` as the coefficients.
    "radii-not-squared": "the radii of ellipsoids are not squared",
        [EllipsoidQ = "1.0 / radii"],
        [EllipsoidQ = "1.0 / radii", EllipsoidEnds = "-radii.z, radii.z"];
    /// Use `1.0 / (radii * radii)` as the coefficients.
    "radii-multiplied": "the coefficients of ellipsoids are the squared radii instead of their reciprocals",
        [EllipsoidQ = "radii * radii"],
        [EllipsoidQ = "radii * radii", EllipsoidEnds = "-radii.z, radii.z"];
    /// Transform the ray into a frame whose z axis is the quadric's axis.
    "axis-ignored": "the axis of quadrics is ignored: all lie along z", [AxisFrame = "mat3(1.0)"];
    /// Use `transpose(axes) * v`, which is `v * axes`, to go into local space.
    "frame-not-transposed": "the ray is multiplied by the frame's matrix instead of its transpose",
        [RayInFrame = "quadric.axes * ray.direction"],
        [
            RayInFrame = "quadric.axes * ray.direction",
            OriginInFrame = "quadric.axes * (ray.origin - quadric.origin)",
        ];
    /// Use `normalize(axes * localNormal)`.
    "normal-in-local-space": "the normal is not transformed back to world space",
        [QuadricNormal = "normalize(quadric.form.q * p + vec3(0.0, 0.0, quadric.form.g))"];
    /// Use the gradient: `q * p + vec3(0.0, 0.0, g)` in local space.
    "normal-from-quadric-center": "the direction from the quadric's center is used as the normal instead of the gradient",
        [QuadricNormal = "normalize(point - quadric.origin)"];
    /// Add it to the gradient: `q * p + vec3(0.0, 0.0, g)`.
    "normal-without-linear-term": "the linear term of the quadric's equation is missing in the normal",
        [QuadricNormal = "normalize(quadric.axes * (quadric.form.q * p))"];
    /// Use x² + y² − s² z² = 0 with `s = radius / height`.
    "cone-slope-ignored": "the cone's slope is always 45°: its radius and height are ignored",
        [ConeSlope = "-1.0"];
    /// Accept only hits between the apex and the base: `z >= 0.0 && z <= height`.
    "both-nappes": "both halves (nappes) of the cone are visible", [ConeLow = "-height"];
    /// For x² + y² + 2 g z = 0, use `g = -0.5 * radius * radius / height`.
    "paraboloid-too-wide": "the factor 2 of the linear term is wrong in the paraboloid's equation",
        [ParaboloidG = "-radius * radius / height"],
        [ParaboloidG = "-2.0 * radius * radius / height"];
    /// For x² + y² − s² z² + k = 0, use `k = -waist * waist`.
    "hyperboloid-of-two-sheets": "the hyperboloid has two sheets: its constant term has the wrong sign",
        [HyperboloidK = "waist * waist"];
    /// Flip it toward the ray: `faceforward(n, d, n)`.
    "quadric-normal-reversed": "the normal of quadrics points away from the ray's origin",
        [QuadricSide = "-faceforward(normal, direction, normal)"];
    /// Use `faceforward(n, d, n)`, to light the inside as well.
    "normal-not-flipped": "the normal of open surfaces is not flipped toward the ray's origin",
        [QuadricSide = "normal"],
        [QuadricSide = "-normal"];
    /// Return `shift + t`.
    "origin-shift-not-added": "the ray's origin is moved closer to the surface, but the shift is not added to t",
        [NearQuadricT = "near"],
        [NearQuadricT = "near", FarQuadricT = "beyond"];
    /// Use the sum `floor(x / side) + floor(z / side)`.
    "checker-stripes": "the checker has stripes: only one of its two coordinates is used",
        [CheckerSum = "square.x"],
        [CheckerSum = "square.y"];
    /// Use `floor` instead of `int(…)` or `trunc`.
    "checker-truncated": "the checker truncates toward 0, so its squares are twice as wide at the axes",
        [CheckerSquare = "trunc(point.xz / side)"];
    /// Divide the position by the side of a square: `floor(point.xz / side)`.
    "checker-too-large": "the squares of the checker are twice as large as the scene's",
        [CheckerSquare = "floor(point.xz / (2.0 * side))"];
    /// Divide the position by the side of a square: `floor(point.xz / side)`.
    "checker-too-small": "the squares of the checker are half as large as the scene's",
        [CheckerSquare = "floor(point.xz / (0.5 * side))"];
    /// Use `floor(point.xz / side)`.
    "checker-multiplied": "the position is multiplied by the side of the checker's squares instead of divided by it",
        [CheckerSquare = "floor(point.xz * side)"];
    /// Where the sum of the coordinates is even, use the first color.
    "checker-colors-swapped": "the two colors of the checker are swapped",
        [CheckerEven = "«CheckerOdd»", CheckerOdd = "«CheckerEven»"];
};

/// Boxes and patterns.
pub(super) static BOXES: Group = mistakes! {
    /// Use the largest of the three t's: `max(near.x, max(near.y, near.z))`.
    "box-entered-at-first-slab": "rays enter boxes at the first of the three slabs instead of the last one",
        [BoxEnter = "min(near.x, min(near.y, near.z))"];
    /// Use the smallest of the three t's: `min(far.x, min(far.y, far.z))`.
    "box-left-at-last-slab": "rays leave boxes at the last of the three slabs instead of the first one",
        [BoxLeave = "max(far.x, max(far.y, far.z))"];
    /// The planes of the faces lie at half the size from the center: `0.5 * size`.
    "box-size-not-halved": "boxes are twice as large as the scene's: their size is not halved",
        [BoxReach = "2.0 * …", BoxDepth = "2.0 * …"];
    /// Give the normal the sign of the point's coordinate across the face.
    "box-normal-inward": "the normal of boxes points inward", [BoxSide = "-sign(p)"];
    /// Use the axis of the face that is nearest to the point.
    "box-normal-from-center": "the direction from the box's center is used as the normal instead of the face's",
        [BoxNormal = "normalize(point - box.center)"];
    /// Use `axes * localNormal`.
    "box-normal-in-local-space": "the normal of boxes is not transformed back to world space",
        [BoxNormal = "«BoxSide» * face"];
    /// Divide the position by the scene's `size`.
    "pattern-too-large": "the squares or stripes of patterns are twice as large as the scene's",
        [PatternSide = "2.0 * …"];
    /// Divide the position by the scene's `size`.
    "pattern-too-small": "the squares or stripes of patterns are half as large as the scene's",
        [PatternSide = "0.5 * …"];
    /// Where the sum of the whole numbers is even, use the first color.
    "pattern-colors-swapped": "the two colors of patterns are swapped",
        [PatternEven = "«PatternOdd»", PatternOdd = "«PatternEven»"];
    /// In a surface's own coordinates, use the sum of all three: `floor(x / size) + floor(y / size) + floor(z
    /// / size)`.
    "pattern-without-y": "y does not count in the checker of a surface", [PatternSum = "square.x + square.z"];
    /// Set the coordinate across the face to 0 before dividing by `size`.
    "coordinate-across-face": "the coordinate across the faces of a box counts, so rounding decides the color",
        [AcrossFace = "1.0"];
};

/// Grids with a sphere in each cell, and the random numbers of the spheres.
pub(super) static GRIDS: Group = mistakes! {
    /// Step from cell to cell in a loop until a sphere is hit or the grid ends.
    "first-cell-only": "only the first cell of the grid is tested", [GridSteps = "1"];
    /// Step by `ivec3(sign(direction))`.
    "grid-step-sign": "the grid traversal always steps in the positive direction",
        [GridStride = "ivec3(1)"];
    /// Use `spacing / abs(direction)` as the distance between cell boundaries.
    "grid-step-length": "the grid traversal advances by 1 instead of the size of a cell",
        [GridStep = "1.0 / abs(direction)"];
    /// Step along the axis with the smallest t.
    "far-boundary-first": "the grid traversal crosses the farthest cell boundary first instead of the nearest",
        [NextCellIsX = "next.x > next.y && next.x > next.z"];
    /// Compare all three: x if it is the smallest t, otherwise y or z.
    "grid-axis-missing": "the grid traversal never steps along one of the axes",
        [NextCellIsY = "false"],
        [NextCellIsY = "true"];
    /// Use `x + nx * (y + ny * z)`.
    "cell-index-swapped": "two coordinates are swapped in the index of a cell",
        [CellNumber = "uint(cell.y + grid.cells.y * (cell.x + grid.cells.x * cell.z))"],
        [CellNumber = "uint(cell.x + grid.cells.x * (cell.z + grid.cells.z * cell.y))"],
        [CellNumber = "uint(cell.z + grid.cells.z * (cell.y + grid.cells.y * cell.x))"];
    /// Start from the scene's `seed` plus the index of the cell.
    "wrong-seed": "the random numbers of the grid start from another seed",
        [CellSeed = "grid.seed + 1u + «CellNumber»"],
        [CellSeed = "grid.seed - 1u + «CellNumber»"],
        [CellSeed = "«CellNumber»"],
        [CellSeed = "1u + «CellNumber»"];
    /// Place each sphere with three random numbers.
    "spheres-at-cell-centers": "spheres lie at the centers of their cells instead of random positions",
        [CellPlace = "0.5"];
    /// Use `radius + (spacing - 2.0 * radius) * random` along each axis.
    "position-range-too-large": "the range of a sphere's position in its cell is too large: the radius is not subtracted on both sides",
        [CellRoom = "grid.spacing"],
        [CellRoom = "grid.spacing - radius"];
    /// Use a random radius for each cell: `mix(small, large, random())`.
    "equal-radii": "all spheres of the grid have the same radius",
        [CellRadius = "0.5 * (grid.minRadius + grid.maxRadius) + 0.0 * cellRandom()"];
    /// Assign each random number to its own variable, x first: `float x = random(), y = random(), z =
    /// random();`.
    "random-coordinates-reversed": "random coordinates are sampled in the order z, y, x instead of x, y, z",
        [CellPlace = "vec3(z, y, x)"];
    /// Assign each random number to its own variable, r first: `float r = random(), g = random(), b =
    /// random();`.
    "random-colors-reversed": "random color components are sampled in the order b, g, r instead of r, g, b",
        [CellColor = "vec3(b, g, r)"];
    /// Return `(word >> 22u) ^ word`.
    "hash-shift-missing": "the last shift of the hash function is missing", [HashResult = "word"];
};

/// Normals of spheres.
pub(super) static NORMALS: Group = mistakes! {
    /// Use `normalize(point - center)`, or divide by the radius.
    "normal-not-normalized": "the normal is not normalized",
        [SphereNormal = "(hit.point - spheres[i].center)"],
        [SphereNormal = "(hit.point - spheres[i].center)", Discriminant = TEXTBOOK];
    /// Use `normalize(point - center)`.
    "normal-inward": "the normal points into the sphere: center − point is used instead of point − center",
        [SphereNormal = "normalize(spheres[i].center - hit.point)"];
    /// Subtract the center: `normalize(point - center)`.
    "normal-from-world-origin": "the normal is computed from the world's origin instead of the sphere's center",
        [SphereNormal = "normalize(hit.point)"];
    /// Compute the normal from the hit point: `normalize(point - center)`.
    "normal-is-ray-direction": "the negated ray direction is used as the normal",
        [SphereNormal = "-ray.direction"];
};

/// Motions.
pub(super) static MOTIONS: Group = mistakes! {
    /// Use `cross(axis, v)` in Rodrigues' formula, or negate the angle.
    "rotation-reversed": "the rotation has the opposite direction", [RotationCross = "cross(v, axis)"];
    /// Add `(1.0 - cos(angle)) * dot(axis, v) * axis`.
    "rodrigues-last-term-missing": "the last term of Rodrigues' rotation formula is missing",
        [Rotation = "c * v + s * «RotationCross»"];
    /// Use `cos(a) * v + sin(a) * cross(axis, v) + (1.0 - cos(a)) * dot(axis, v) * axis`.
    "sine-and-cosine-swapped": "the sine and the cosine of the rotation angle are swapped",
        [AngleCosine = "«AngleSine»", AngleSine = "«AngleCosine»"];
    /// Multiply by 2π: `angle = 6.28318530718 * turns`.
    "angle-in-turns": "the rotation angle is in turns instead of radians", [RotationAngle = "fract(turns)"];
    /// Use `radians(angle)`, or `6.28318530718 * turns`.
    "angle-in-degrees": "the rotation angle is in degrees instead of radians",
        [RotationAngle = "360.0 * fract(turns)"];
    /// Use `angle = 6.28318530718 * turns`.
    "angle-with-pi": "the rotation angle uses π instead of 2π per turn",
        [RotationAngle = "3.14159265359 * fract(turns)"];
    /// Use `pivot + rotate(p - pivot)`.
    "rotation-about-origin": "the rotation is about the world's origin instead of the pivot",
        [RotationAboutPivot = "rotate(p, axis, «RotationAngle»)"];
    /// Use `pivot + rotate(p - pivot)`.
    "pivot-not-added-back": "the pivot is not added back after the rotation",
        [RotationAboutPivot = "rotate(«RotatedPoint», axis, «RotationAngle»)"];
    /// Use `pivot + rotate(p - pivot)`.
    "pivot-not-subtracted": "the pivot is not subtracted before the rotation", [RotatedPoint = "p"];
    /// Apply the object's own rotation first: `outer(inner(p))`.
    "motion-order-swapped": "the enclosing motion is applied before the object's own rotation instead of after it",
        [CarriedBy0 = "rotateAbout(motion0(p), «RotationArguments»)"],
        [CarriedBy1 = "rotateAbout(motion1(p), «RotationArguments»)"],
        [CarriedBy2 = "rotateAbout(motion2(p), «RotationArguments»)"];
};
