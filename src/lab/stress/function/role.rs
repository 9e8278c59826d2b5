//! What values are to a function that meets spheres, and what people call them.

use toyproof_glsl::tree::{Scalar, Type};

/// What a value is to the intersection of a ray with a sphere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// Where the ray starts.
    Origin,
    /// Where it goes.
    Direction,
    /// The sphere's centre.
    Center,
    /// Its radius.
    Radius,
    /// Centre and radius in one vec4.
    Sphere,
    /// The smallest t that counts.
    TMin,
    /// The largest.
    TMax,
    /// The t that was found.
    T,
    /// The second one.
    Second,
    /// Whether one was found.
    Flag,
}

/// Roles and the names that people give them, in small letters without underscores.
const NAMES: [(Role, &str); 10] = [
    (
        Role::Origin,
        "o ro or org orig origin rayorigin rayorig rayo rayorg eye start from camera \
         raypos rayposition src",
    ),
    (
        Role::Direction,
        "d rd dir direction raydir raydirection rayd ray v dirn ird rdir",
    ),
    (
        Role::Center,
        "c ce cen center centre spherecenter spherecentre sphcenter sc spherepos \
         sphereposition spherec spos",
    ),
    (
        Role::Radius,
        "r ra rad radius sphereradius sphradius sr spherer srad size",
    ),
    (Role::Sphere, "sph sphere s ball"),
    (Role::TMin, "tmin mint epsilon eps near"),
    (Role::TMax, "tmax maxt far"),
    (
        Role::T,
        "t dist distance thit hitt t0 tnear tn depth len tclosest",
    ),
    (Role::Second, "t1 tfar tf t2"),
    (
        Role::Flag,
        "hit ishit didhit intersects valid found happened id index object",
    ),
];

impl Role {
    /// The role that `--map` calls so.
    #[must_use]
    pub fn named(word: &str) -> Option<Self> {
        let roles = [
            ("origin", Self::Origin),
            ("direction", Self::Direction),
            ("center", Self::Center),
            ("centre", Self::Center),
            ("radius", Self::Radius),
            ("sphere", Self::Sphere),
            ("tmin", Self::TMin),
            ("tmax", Self::TMax),
            ("t", Self::T),
            ("second", Self::Second),
            ("hit", Self::Flag),
        ];
        roles
            .into_iter()
            .find(|(name, _)| *name == word)
            .map(|(_, role)| role)
    }

    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Origin => "the ray's origin",
            Self::Direction => "its direction",
            Self::Center => "the sphere's centre",
            Self::Radius => "its radius",
            Self::Sphere => "the sphere",
            Self::TMin => "the smallest t",
            Self::TMax => "the largest t",
            Self::T => "t",
            Self::Second => "the second t",
            Self::Flag => "whether it hits",
        }
    }

    /// Whether it is the sphere's, or a part of it.
    pub(super) fn is_of_sphere(self) -> bool {
        matches!(self, Self::Center | Self::Radius | Self::Sphere)
    }

    /// What a shader that reads a case passes for it.
    pub(super) fn input(self) -> Option<&'static str> {
        Some(match self {
            Self::Origin => "a.xyz",
            Self::Direction => "b.xyz",
            Self::Center => "c.xyz",
            Self::Radius => "a.w",
            Self::Sphere => "vec4(c.xyz, a.w)",
            Self::TMin => "0.0",
            Self::TMax => "3.0e38",
            Self::T | Self::Second | Self::Flag => return None,
        })
    }

    pub(super) fn fits(self, ty: Type) -> bool {
        match self {
            Self::Origin | Self::Direction | Self::Center => ty == Type::vector(Scalar::Float, 3),
            Self::Sphere => ty == Type::vector(Scalar::Float, 4),
            Self::Radius | Self::TMin | Self::TMax | Self::Second => ty == Type::FLOAT,
            Self::T => ty == Type::FLOAT || ty == Type::vector(Scalar::Float, 2),
            Self::Flag => [Type::BOOL, Type::INT].contains(&ty),
        }
    }

    /// Whether people call it so: a name in small letters without underscores.
    pub(super) fn is_called(self, name: &str) -> bool {
        let names = NAMES.iter().find(|(role, _)| *role == self);
        names.is_some_and(|(_, names)| names.split(' ').any(|one| one == name))
    }
}
