//! The values that a function takes and gives, and what each is to a ray and a sphere, by types and names.

use toyproof_glsl::tree::{Function, Scalar, Tree, Type};

use super::role::Role;
use super::signature::Map;

/// A value that a function takes or gives: a parameter, its result, or a part of one.
#[derive(Debug, Clone)]
pub(super) struct Leaf {
    pub(super) path: String,
    ty: Type,
    /// The name of the structure that it is a member of.
    within: String,
}

/// Parts of the names of functions and structures for other shapes, which have centres and radii of their own.
const OTHER_SHAPES: [&str; 11] = [
    "box", "capsule", "cone", "cyl", "disk", "ellips", "hyper", "parab", "plane", "quadric", "torus",
];

/// The parts of a value that are scalars or vectors; elements of arrays are not looked at.
pub(super) fn leaves(tree: &Tree, path: &str, ty: Type, within: &str) -> Vec<Leaf> {
    match ty {
        Type::Struct(id) => {
            let of = &tree[id];
            let members = of.members.iter();
            members
                .flat_map(|member| leaves(tree, &format!("{path}.{}", member.name), member.ty, &of.name))
                .collect()
        }
        Type::Scalar(_) | Type::Vector(..) => vec![Leaf {
            path: path.to_owned(),
            ty,
            within: within.to_owned(),
        }],
        _ => Vec::new(),
    }
}

impl Leaf {
    /// Its last name as people vary it.
    fn plain(&self) -> String {
        let last = self.path.rsplit('.').next().unwrap_or_default();
        last.to_lowercase().replace('_', "")
    }

    fn named(&self, role: Role) -> bool {
        role.fits(self.ty) && role.is_called(&self.plain())
    }

    /// Whether it may be a place, and not a colour or a normal.
    fn is_spatial(&self) -> bool {
        let plain = self.plain();
        let other = [
            "col", "albedo", "emi", "kd", "ks", "spec", "norm", "mat", "amb", "diff",
        ];
        self.ty == Type::vector(Scalar::Float, 3)
            && !other.iter().any(|word| plain.contains(word))
            && plain != "n"
    }

    /// Whether it is called as a surface's direction is: planes and disks have one, spheres have none.
    fn is_normal(&self) -> bool {
        let plain = self.plain();
        self.ty == Type::vector(Scalar::Float, 3) && (plain == "n" || plain.contains("norm"))
    }

    fn is_within(&self, word: &str) -> bool {
        self.within.to_lowercase().contains(word)
    }
}

/// Whether what the user says of a function can be.
pub(super) fn agrees(function: &Function, takes: &[Leaf], gives: &[Leaf], map: &Map) -> Result<(), String> {
    let name = &function.name;
    for (path, role) in map {
        let (leaves, does) = if role.input().is_some() {
            (takes, "takes")
        } else {
            (gives, "gives")
        };
        if leaves.iter().any(|leaf| leaf.path == *path && role.fits(leaf.ty)) {
            continue;
        }
        let all = || takes.iter().chain(gives);
        if !all().any(|leaf| leaf.path == *path) {
            let mut paths: Vec<_> = all().map(|leaf| leaf.path.as_str()).collect();
            paths.dedup();
            return Err(format!(
                "{name} has no parameter `{path}`; --map may speak of {}",
                paths.join(", ")
            ));
        }
        return Err(format!(
            "--map says that `{path}` is {}, and no value that {name} {does} under that name can be that",
            role.word()
        ));
    }
    Ok(())
}

/// Whether what a function takes beside the ray is a sphere, as far as its names and types tell: other shapes have centres and radii too,
/// and would be blamed for what they are.
pub(super) fn is_sphere(function: &Function, takes: &[Leaf], inputs: &[(String, Role)], map: &Map) -> bool {
    if map.values().any(|role| role.is_of_sphere()) {
        return true;
    }
    let role = |leaf: &Leaf| {
        let found = inputs.iter().find(|(path, _)| *path == leaf.path);
        found.map(|(_, role)| *role)
    };
    let within = takes
        .iter()
        .filter(|leaf| role(leaf).is_some_and(Role::is_of_sphere))
        .map(|leaf| leaf.within.as_str());
    let names: Vec<String> = within
        .chain([function.name.as_str()])
        .map(str::to_lowercase)
        .collect();
    let any = |words: &[&str]| {
        let mut pairs = names
            .iter()
            .flat_map(|name| words.iter().map(move |word| name.contains(word)));
        pairs.any(|is| is)
    };
    if any(&["sph", "ball"]) {
        return true;
    }
    // A place or a direction more than a sphere has is some other shape's, and so is one float of many that none calls a radius.
    let rays: Vec<&str> = takes
        .iter()
        .filter(|leaf| role(leaf) == Some(Role::Origin))
        .map(|leaf| leaf.within.as_str())
        .collect();
    let of_ray = |leaf: &Leaf| !leaf.within.is_empty() && rays.contains(&leaf.within.as_str());
    let mut unknown = takes.iter().filter(|leaf| role(leaf).is_none() && !of_ray(leaf));
    let guessed = takes
        .iter()
        .any(|leaf| role(leaf) == Some(Role::Radius) && !leaf.named(Role::Radius));
    let is_others =
        |leaf: &Leaf| leaf.is_spatial() || leaf.is_normal() || (guessed && leaf.ty == Type::FLOAT);
    !any(&OTHER_SHAPES) && !unknown.any(is_others)
}

pub(super) fn inputs(takes: &[Leaf], map: &Map) -> Vec<(String, Role)> {
    let mut found: Vec<(String, Role)> = Vec::new();
    for leaf in takes {
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
        for leaf in takes.iter().filter(|leaf| leaf.named(role)) {
            give(&mut found, leaf, role);
        }
    }
    // What is called `pos` is what its structure makes of it, or its place among the others.
    let has = |found: &[(String, Role)], role: Role| found.iter().any(|(_, other)| *other == role);
    for (word, role) in [
        ("ray", Role::Origin),
        ("ray", Role::Direction),
        ("sph", Role::Center),
        ("ball", Role::Center),
    ] {
        for leaf in takes
            .iter()
            .filter(|leaf| leaf.is_spatial() && leaf.is_within(word))
        {
            give(&mut found, leaf, role);
        }
    }
    let whole = has(&found, Role::Sphere);
    for role in [Role::Origin, Role::Direction, Role::Center] {
        if !(whole && role == Role::Center) {
            for leaf in takes.iter().filter(|leaf| leaf.is_spatial()) {
                give(&mut found, leaf, role);
            }
        }
    }
    if !whole {
        for leaf in takes.iter().filter(|leaf| leaf.ty == Type::FLOAT) {
            give(&mut found, leaf, Role::Radius);
        }
    }
    found
}

pub(super) fn outputs(gives: &[Leaf], map: &Map) -> Vec<(String, Role, Type)> {
    let mut found: Vec<(String, Role, Type)> = Vec::new();
    let mut give = |leaf: &Leaf, role: Role| {
        let taken = found
            .iter()
            .any(|(path, other, _)| *path == leaf.path || *other == role);
        if !taken {
            found.push((leaf.path.clone(), role, leaf.ty));
        }
    };
    for leaf in gives {
        if let Some(&role) = map.get(&leaf.path) {
            give(leaf, role);
        }
    }
    // What is returned by itself is t, or whether there is one.
    for leaf in gives.iter().filter(|leaf| leaf.path == "return") {
        if Role::T.fits(leaf.ty) {
            give(leaf, Role::T);
        } else if Role::Flag.fits(leaf.ty) {
            give(leaf, Role::Flag);
        }
    }
    for role in [Role::T, Role::Second, Role::Flag] {
        for leaf in gives.iter().filter(|leaf| leaf.named(role)) {
            give(leaf, role);
        }
    }
    // The only floats that a function gives out are its t.
    let floats: Vec<_> = gives.iter().filter(|leaf| leaf.ty == Type::FLOAT).collect();
    if let [leaf] = floats[..] {
        give(leaf, Role::T);
    }
    found
}
