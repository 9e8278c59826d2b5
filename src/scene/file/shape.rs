//! `[[sphere]]` and the other tables that describe surfaces

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

use super::super::{Object, Point, Quadric, QuadricKind, Scatter, Shape};
use super::checks::{Checks, Pair, Triple};
use super::motion::Names;
use super::{Surface, material};

/// The most spheres of one scatter.
const MAX_SCATTER: u64 = 65_536;
/// The axis of what names none: upright.
const UP: Point = [0.0, 1.0, 0.0];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SphereTable {
    center: Triple,
    radius: Spanned<f64>,
    material: material::Table,
    motion: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlaneTable {
    point: Triple,
    normal: Option<Triple>,
    material: material::Table,
    motion: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EllipsoidTable {
    center: Triple,
    radii: Triple,
    material: material::Table,
    motion: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HyperboloidTable {
    center: Triple,
    axis: Option<Triple>,
    waist: Spanned<f64>,
    radius: Spanned<f64>,
    height: Spanned<f64>,
    material: material::Table,
    motion: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScatterTable {
    corner: Triple,
    cells: Spanned<[u32; 3]>,
    spacing: Spanned<f64>,
    radius: Pair,
    seed: Option<u32>,
    material: material::Table,
    motion: Option<Spanned<String>>,
}

/// One surface from its shape and what all tables have.
fn object(
    shape: Shape,
    (material, motion): (material::Table, Option<Spanned<String>>),
    names: &Names,
    checks: &mut Checks,
) -> (Vec<Object>, Range<usize>) {
    let (material, place) = material.check(checks);
    let object = Object {
        shape,
        material,
        motion: names.find(motion, checks),
    };
    (vec![object], place)
}

fn quadric(origin: (&str, Triple), axis: Option<Triple>, kind: QuadricKind, checks: &mut Checks) -> Shape {
    let axis = checks.direction("axis", axis, UP);
    let (what, origin) = origin;
    let origin = checks.point(what, Some(origin), [0.0; 3]);
    Shape::Quadric(Quadric::around(axis, origin, kind))
}

impl Surface for SphereTable {
    fn check(self, names: &Names, checks: &mut Checks) -> (Vec<Object>, Range<usize>) {
        let shape = Shape::Sphere {
            center: checks.point("center", Some(self.center), [0.0; 3]),
            radius: checks.positive("radius", &self.radius),
        };
        object(shape, (self.material, self.motion), names, checks)
    }
}

impl Surface for PlaneTable {
    fn check(self, names: &Names, checks: &mut Checks) -> (Vec<Object>, Range<usize>) {
        let shape = Shape::Plane {
            point: checks.point("point", Some(self.point), [0.0; 3]),
            normal: checks.direction("normal", self.normal, UP),
        };
        object(shape, (self.material, self.motion), names, checks)
    }
}

impl Surface for EllipsoidTable {
    fn check(self, names: &Names, checks: &mut Checks) -> (Vec<Object>, Range<usize>) {
        let radii = *self.radii.get_ref();
        if !radii.iter().all(|radius| radius.is_finite() && *radius > 0.0) {
            checks.refuse(
                self.radii.span(),
                "radii must be three finite numbers above 0".to_owned(),
            );
        }
        let shape = Shape::Quadric(Quadric {
            kind: QuadricKind::Ellipsoid { radii },
            origin: checks.point("center", Some(self.center), [0.0; 3]),
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        });
        object(shape, (self.material, self.motion), names, checks)
    }
}

/// Tables of what has a radius at one end of its axis and a height along it.
macro_rules! round {
    ($($table:ident: $kind:ident from $origin:ident;)*) => {$(
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct $table {
            $origin: Triple,
            axis: Option<Triple>,
            radius: Spanned<f64>,
            height: Spanned<f64>,
            material: material::Table,
            motion: Option<Spanned<String>>,
        }

        impl Surface for $table {
            fn check(self, names: &Names, checks: &mut Checks) -> (Vec<Object>, Range<usize>) {
                let kind = QuadricKind::$kind {
                    radius: checks.positive("radius", &self.radius),
                    height: checks.positive("height", &self.height),
                };
                let shape = quadric((stringify!($origin), self.$origin), self.axis, kind, checks);
                object(shape, (self.material, self.motion), names, checks)
            }
        }
    )*};
}

round! {
    CylinderTable: Cylinder from base;
    ConeTable: Cone from apex;
    ParaboloidTable: Paraboloid from apex;
}

impl Surface for HyperboloidTable {
    fn check(self, names: &Names, checks: &mut Checks) -> (Vec<Object>, Range<usize>) {
        let waist = checks.positive("waist", &self.waist);
        let radius = checks.positive("radius", &self.radius);
        if waist >= radius {
            checks.refuse(self.waist.span(), "waist must be smaller than radius".to_owned());
        }
        let height = checks.positive("height", &self.height);
        let kind = QuadricKind::Hyperboloid {
            waist,
            radius,
            height,
        };
        let shape = quadric(("center", self.center), self.axis, kind, checks);
        object(shape, (self.material, self.motion), names, checks)
    }
}

impl ScatterTable {
    /// The scatter, and the place in the file where its model is named.
    pub(super) fn check(self, names: &Names, checks: &mut Checks) -> (Scatter, Range<usize>) {
        let cells = *self.cells.get_ref();
        let number: u64 = cells
            .iter()
            .map(|side| u64::from(*side))
            .fold(1, u64::saturating_mul);
        if !(1..=MAX_SCATTER).contains(&number) {
            let words = format!("cells must be three whole numbers whose product is from 1 to {MAX_SCATTER}");
            checks.refuse(self.cells.span(), words);
        }
        let spacing = checks.positive("spacing", &self.spacing);
        let radius = *self.radius.get_ref();
        if !(radius[0] > 0.0 && radius[0] <= radius[1] && radius[1] <= 0.5 * spacing) {
            let words = "radius must be the smallest and the largest, above 0 and at most half the spacing";
            checks.refuse(self.radius.span(), words.to_owned());
        }
        let (material, place) = self.material.check(checks);
        let scatter = Scatter {
            corner: checks.point("corner", Some(self.corner), [0.0; 3]),
            cells: if number > MAX_SCATTER { [1; 3] } else { cells },
            spacing,
            radius,
            seed: self.seed.unwrap_or(0),
            material,
            motion: names.find(self.motion, checks),
        };
        (scatter, place)
    }
}
