//! Changes of a hierarchy of spheres.

use glam::DVec3;
use toyproof_scene::{Object, Scene, Shape};

use super::Changes;
use crate::known::documented::{Documented, documented};

/// What the guide says about these mistakes.
pub(super) const DOCUMENTED: &[Documented] = documented! {
    /// Scale the radius at each level.
    Objects "child-radius-of-parent": "child spheres are as large as their parents";
    /// Use `parent.radius + child.radius` as the distance of the centers.
    Objects "child-distance-too-small":
        "the centers of child spheres lie on the surface of their parents: the child's radius is not added";
    /// Use `0.5 * (own + parent.color)`.
    Objects "child-colors-not-mixed": "the color of child spheres is not averaged with that of their parents";
    /// Place them around their own parents, and check the bounds of the loop.
    Objects "smallest-missing": "the smallest spheres are missing or coincide with larger ones";
    /// Place them at `+distance` and at `-distance` along each axis.
    Objects "one-side-only": "child spheres lie on only one side of each axis";
    /// Check the bounds of the loop over the child spheres.
    Objects "child-missing": "one of the child spheres is missing at each parent: a loop bound is off by one";
};

/// A hierarchy has at least this many spheres that touch a larger one.
const MIN_CHILDREN: usize = 4;

/// A sphere of a hierarchy: spheres that touch a larger one, as in the course's complex scene.
#[derive(Clone, Copy)]
struct Node {
    center: DVec3,
    radius: f64,
    color: DVec3,
    /// The sphere that it touches; an earlier one.
    parent: Option<usize>,
    /// The number of its ancestors.
    level: usize,
    /// Its index among its parent's children.
    number: usize,
}

/// The size of a sphere, and its distance from its parent.
struct Placement {
    radius: f64,
    distance: f64,
}

pub(super) fn hierarchy(changes: &mut Changes) {
    let Some(nodes) = nodes(&changes.scene.objects) else {
        return;
    };
    let rebuilt = |rule: fn(f64, f64) -> Placement| {
        let nodes = &nodes;
        move |scene: &mut Scene| rebuild(scene, nodes, rule)
    };
    changes.add(
        "child-radius-of-parent",
        &[],
        rebuilt(|parent, _| Placement {
            radius: parent,
            distance: parent + parent,
        }),
    );
    changes.add(
        "child-distance-too-small",
        &[],
        rebuilt(|parent, own| Placement {
            radius: own,
            distance: parent,
        }),
    );
    changes.add("child-colors-not-mixed", &[], |scene| {
        for (object, node) in scene.objects.iter_mut().zip(&nodes) {
            if let Some(parent) = node.parent {
                // The scene has 0.5 · (own + parent): solve for own.
                object.material.color = (2.0 * node.color - nodes[parent].color).to_array();
            }
        }
    });
    let deepest = nodes.iter().map(|node| node.level).max().unwrap_or(0);
    changes.add("smallest-missing", &[], |scene| {
        keep(scene, &nodes, |node| node.level < deepest);
    });
    let points_back = |node: &Node| {
        node.parent
            .is_some_and(|parent| (node.center - nodes[parent].center).min_element() < -1e-9)
    };
    changes.add("one-side-only", &[], |scene| {
        keep(scene, &nodes, |node| !points_back(node));
    });
    let most = nodes.iter().map(|node| node.number + 1).max().unwrap_or(0);
    for (level, number) in (1..=deepest).flat_map(|level| (0..most).map(move |number| (level, number))) {
        changes.add("child-missing", &[], |scene| {
            keep(scene, &nodes, |node| node.level != level || node.number != number);
        });
    }
}

/// Recognizes the hierarchy by contact, if there is one.
fn nodes(objects: &[Object]) -> Option<Vec<Node>> {
    let mut nodes: Vec<Node> = Vec::new();
    for object in objects {
        let Shape::Sphere { center, radius } = object.shape else {
            return None;
        };
        let center = DVec3::from_array(center);
        let touches = |node: &Node| {
            let gap = center.distance(node.center) - (radius + node.radius);
            radius < node.radius && gap.abs() < 1e-9 * node.radius
        };
        let parent = nodes.iter().position(touches);
        nodes.push(Node {
            center,
            radius,
            color: DVec3::from_array(object.material.color),
            parent,
            level: parent.map_or(0, |parent| nodes[parent].level + 1),
            number: nodes.iter().filter(|node| node.parent == parent).count(),
        });
    }
    (nodes.iter().filter(|node| node.parent.is_some()).count() >= MIN_CHILDREN).then_some(nodes)
}

/// Rebuilds each sphere with another radius and at another distance from its parent, by a `rule` that has the
/// radii of the parent and of the sphere.
fn rebuild(scene: &mut Scene, nodes: &[Node], rule: impl Fn(f64, f64) -> Placement) {
    let mut built: Vec<(DVec3, f64)> = Vec::new();
    for node in nodes {
        built.push(match node.parent {
            None => (node.center, node.radius),
            Some(parent) => {
                let direction = (node.center - nodes[parent].center).normalize();
                let (center, around) = built[parent];
                let Placement { radius, distance } =
                    rule(around, around * node.radius / nodes[parent].radius);
                (center + distance * direction, radius)
            }
        });
    }
    for (object, (center, radius)) in scene.objects.iter_mut().zip(built) {
        object.shape = Shape::Sphere {
            center: center.to_array(),
            radius,
        };
    }
}

/// Keeps the spheres that satisfy `stays`, without those whose ancestors are removed.
fn keep(scene: &mut Scene, nodes: &[Node], stays: impl Fn(&Node) -> bool) {
    let mut kept: Vec<bool> = Vec::new();
    for node in nodes {
        kept.push(stays(node) && node.parent.is_none_or(|parent| kept[parent]));
    }
    scene.retain_objects(|at| kept[at]);
}
