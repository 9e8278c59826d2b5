//! The roles of a function's values in ray–sphere intersection, and their usual names.

use std::collections::BTreeMap;

use toyproof_glsl::tree::{Function, Scalar, Tree, Type};

/// Roles that the user assigns, by path (`ray.origin`, `s`, `return`).
pub type RoleMap = BTreeMap<String, Role>;

/// The role of a value in ray–sphere intersection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// The origin of the ray.
    Origin,
    /// The direction of the ray.
    Direction,
    /// The center of the sphere.
    Center,
    /// The radius of the sphere.
    Radius,
    /// Center and radius in one vec4.
    Sphere,
    /// The minimum accepted t.
    TMin,
    /// The maximum accepted t.
    TMax,
    /// The t of the hit.
    T,
    /// The t of the second hit.
    Second,
    /// Whether there is a hit.
    Flag,
}

/// Common names of roles, in lowercase without underscores.
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
    /// The role with this name in `--map`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
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
            .find(|(candidate, _)| *candidate == name)
            .map(|(_, role)| role)
    }

    /// The types of values that may have this role.
    fn type_names(self) -> &'static str {
        match self {
            Self::Origin | Self::Direction | Self::Center => "a vec3",
            Self::Sphere => "a vec4",
            Self::Radius | Self::TMin | Self::TMax | Self::Second => "a float",
            Self::T => "a float or a vec2",
            Self::Flag => "a bool or an int",
        }
    }

    pub(super) fn description(self) -> &'static str {
        match self {
            Self::Origin => "the ray's origin",
            Self::Direction => "the ray's direction",
            Self::Center => "the sphere's center",
            Self::Radius => "the sphere's radius",
            Self::Sphere => "the sphere",
            Self::TMin => "the minimum t",
            Self::TMax => "the maximum t",
            Self::T => "t of the hit",
            Self::Second => "t of the second hit",
            Self::Flag => "the hit flag",
        }
    }

    /// Whether the role is the sphere or a part of the sphere.
    pub(super) fn is_of_sphere(self) -> bool {
        matches!(self, Self::Center | Self::Radius | Self::Sphere)
    }

    /// The expression that a shader that reads a case passes for it.
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

    /// Whether a name, in lowercase without underscores, is common for the role.
    pub(crate) fn has_name(self, name: &str) -> bool {
        let names = NAMES.iter().find(|(role, _)| *role == self);
        names.is_some_and(|(_, names)| names.split(' ').any(|one| one == name))
    }
}

// The inputs and outputs of a function, with roles assigned by type and name.

/// An input or output: a parameter, the result, or a member of one.
#[derive(Debug, Clone)]
pub(super) struct Leaf {
    pub(super) path: String,
    ty: Type,
    /// The name of the structure that contains it; empty if none does.
    struct_name: String,
}

/// Parts of the names of functions and structures for other shapes, which also have centers and radii.
const OTHER_SHAPES: [&str; 11] = [
    "box", "capsule", "cone", "cyl", "disk", "ellips", "hyper", "parab", "plane", "quadric", "torus",
];

/// The scalars and vectors that a value consists of; arrays are skipped.
pub(super) fn leaves(tree: &Tree, path: &str, ty: Type, struct_name: &str) -> Vec<Leaf> {
    match ty {
        Type::Struct(id) => {
            let structure = &tree[id];
            let members = structure.members.iter();
            members
                .flat_map(|member| {
                    leaves(
                        tree,
                        &format!("{path}.{}", member.name),
                        member.ty,
                        &structure.name,
                    )
                })
                .collect()
        }
        Type::Scalar(_) | Type::Vector(..) => vec![Leaf {
            path: path.to_owned(),
            ty,
            struct_name: struct_name.to_owned(),
        }],
        _ => Vec::new(),
    }
}

impl Leaf {
    /// The last name of the path, in lowercase without underscores.
    fn normalized_name(&self) -> String {
        let last = self.path.rsplit('.').next().unwrap_or_default();
        last.to_lowercase().replace('_', "")
    }

    fn matches_name(&self, role: Role) -> bool {
        role.fits(self.ty) && role.has_name(&self.normalized_name())
    }

    /// Whether the value may be a position, and not a color or a normal.
    fn is_spatial(&self) -> bool {
        let normalized_name = self.normalized_name();
        let other = [
            "col", "albedo", "emi", "kd", "ks", "spec", "norm", "mat", "amb", "diff",
        ];
        self.ty == Type::vector(Scalar::Float, 3)
            && !other.iter().any(|part| normalized_name.contains(part))
            && normalized_name != "n"
    }

    /// Whether the name is that of a normal: planes and disks have a normal, spheres do not.
    fn is_normal(&self) -> bool {
        let normalized_name = self.normalized_name();
        self.ty == Type::vector(Scalar::Float, 3)
            && (normalized_name == "n" || normalized_name.contains("norm"))
    }

    fn is_in_struct(&self, part: &str) -> bool {
        self.struct_name.to_lowercase().contains(part)
    }
}

/// Checks the user's `--map` against a function's inputs and outputs.
pub(super) fn check_map(
    function: &Function,
    input_leaves: &[Leaf],
    output_leaves: &[Leaf],
    map: &RoleMap,
) -> Result<(), String> {
    let name = &function.name;
    for (path, role) in map {
        let (leaves, kind) = if role.input().is_some() {
            (input_leaves, "an input")
        } else {
            (output_leaves, "an output")
        };
        if leaves.iter().any(|leaf| leaf.path == *path && role.fits(leaf.ty)) {
            continue;
        }
        let all = || input_leaves.iter().chain(output_leaves);
        if !all().any(|leaf| leaf.path == *path) {
            let mut paths: Vec<_> = all().map(|leaf| leaf.path.as_str()).collect();
            paths.dedup();
            return Err(format!(
                "{name} has no parameter `{path}`; it has {}",
                paths.join(", ")
            ));
        }
        return Err(format!(
            "`{path}` cannot be {}, which must be {kind} of {name} and {}",
            role.description(),
            role.type_names()
        ));
    }
    Ok(())
}

/// Whether a function's inputs besides the ray describe a sphere, judged by names and types. Other shapes
/// have centers and radii too, and must not be tested as spheres.
pub(super) fn is_sphere(
    function: &Function,
    input_leaves: &[Leaf],
    inputs: &[(String, Role)],
    map: &RoleMap,
) -> bool {
    if map.values().any(|role| role.is_of_sphere()) {
        return true;
    }
    let role = |leaf: &Leaf| {
        let found = inputs.iter().find(|(path, _)| *path == leaf.path);
        found.map(|(_, role)| *role)
    };
    let struct_names = input_leaves
        .iter()
        .filter(|leaf| role(leaf).is_some_and(Role::is_of_sphere))
        .map(|leaf| leaf.struct_name.as_str());
    let names: Vec<String> = struct_names
        .chain([function.name.as_str()])
        .map(str::to_lowercase)
        .collect();
    let any = |parts: &[&str]| {
        let mut pairs = names
            .iter()
            .flat_map(|name| parts.iter().map(move |part| name.contains(part)));
        pairs.any(|is| is)
    };
    if any(&["sph", "ball"]) {
        return true;
    }
    // An additional position or normal belongs to another shape; so does an additional float if no input is
    // named as a radius.
    let rays: Vec<&str> = input_leaves
        .iter()
        .filter(|leaf| role(leaf) == Some(Role::Origin))
        .map(|leaf| leaf.struct_name.as_str())
        .collect();
    let of_ray = |leaf: &Leaf| !leaf.struct_name.is_empty() && rays.contains(&leaf.struct_name.as_str());
    let mut unknown = input_leaves
        .iter()
        .filter(|leaf| role(leaf).is_none() && !of_ray(leaf));
    let guessed = input_leaves
        .iter()
        .any(|leaf| role(leaf) == Some(Role::Radius) && !leaf.matches_name(Role::Radius));
    let is_others =
        |leaf: &Leaf| leaf.is_spatial() || leaf.is_normal() || (guessed && leaf.ty == Type::FLOAT);
    !any(&OTHER_SHAPES) && !unknown.any(is_others)
}

pub(super) fn assign_input_roles(input_leaves: &[Leaf], map: &RoleMap) -> Vec<(String, Role)> {
    let mut found: Vec<(String, Role)> = Vec::new();
    for leaf in input_leaves {
        if let Some(&role) = map.get(&leaf.path) {
            found.push((leaf.path.clone(), role));
        }
    }
    let give = |found: &mut Vec<(String, Role)>, leaf: &Leaf, role: Role| {
        let taken = found
            .iter()
            .any(|(path, other)| *path == leaf.path || *other == role);
        if !taken && !map.contains_key(&leaf.path) {
            found.push((leaf.path.clone(), role));
        }
    };
    let roles = [
        Role::Origin,
        Role::Direction,
        Role::Center,
        Role::Radius,
        Role::Sphere,
        Role::TMin,
        Role::TMax,
    ];
    for role in roles {
        for leaf in input_leaves.iter().filter(|leaf| leaf.matches_name(role)) {
            give(&mut found, leaf, role);
        }
    }
    // A generic name like `pos` takes its role from its structure, or from its position among the inputs.
    let has = |found: &[(String, Role)], role: Role| found.iter().any(|(_, other)| *other == role);
    for (struct_part, role) in [
        ("ray", Role::Origin),
        ("ray", Role::Direction),
        ("sph", Role::Center),
        ("ball", Role::Center),
    ] {
        for leaf in input_leaves
            .iter()
            .filter(|leaf| leaf.is_spatial() && leaf.is_in_struct(struct_part))
        {
            give(&mut found, leaf, role);
        }
    }
    let whole = has(&found, Role::Sphere);
    for role in [Role::Origin, Role::Direction, Role::Center] {
        if !(whole && role == Role::Center) {
            for leaf in input_leaves.iter().filter(|leaf| leaf.is_spatial()) {
                give(&mut found, leaf, role);
            }
        }
    }
    if !whole {
        for leaf in input_leaves.iter().filter(|leaf| leaf.ty == Type::FLOAT) {
            give(&mut found, leaf, Role::Radius);
        }
    }
    found
}

/// An output of a function with a role.
#[derive(Debug, Clone)]
pub(super) struct Output {
    pub(super) path: String,
    pub(super) role: Role,
    pub(super) ty: Type,
}

pub(super) fn assign_output_roles(output_leaves: &[Leaf], map: &RoleMap) -> Vec<Output> {
    let mut found: Vec<Output> = Vec::new();
    let mut give = |leaf: &Leaf, role: Role| {
        let taken = found
            .iter()
            .any(|other| other.path == leaf.path || other.role == role);
        if !taken {
            found.push(Output {
                path: leaf.path.clone(),
                role,
                ty: leaf.ty,
            });
        }
    };
    for leaf in output_leaves {
        // An `inout` parameter may also be an input.
        if let Some(&role) = map.get(&leaf.path).filter(|role| role.input().is_none()) {
            give(leaf, role);
        }
    }
    // A scalar or vec2 result is t, or the hit flag.
    for leaf in output_leaves.iter().filter(|leaf| leaf.path == "return") {
        if Role::T.fits(leaf.ty) {
            give(leaf, Role::T);
        } else if Role::Flag.fits(leaf.ty) {
            give(leaf, Role::Flag);
        }
    }
    for role in [Role::T, Role::Second, Role::Flag] {
        for leaf in output_leaves.iter().filter(|leaf| leaf.matches_name(role)) {
            give(leaf, role);
        }
    }
    // A function's only float output is t.
    let floats: Vec<_> = output_leaves
        .iter()
        .filter(|leaf| leaf.ty == Type::FLOAT)
        .collect();
    if let [leaf] = floats[..] {
        give(leaf, Role::T);
    }
    found
}
