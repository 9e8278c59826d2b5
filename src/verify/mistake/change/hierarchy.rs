//! Spheres that sit on spheres: a hierarchy, as the course's complex scene has it, is recognised by contact, and built otherwise.

use glam::DVec3;
use toyproof_scene::{Object, Scene, Shape};

use super::Changes;

/// A scene with fewer spheres on others has no hierarchy to speak of.
const LEAST: usize = 4;

/// A sphere of a hierarchy.
#[derive(Clone, Copy)]
struct Node {
    center: DVec3,
    radius: f64,
    color: DVec3,
    /// The sphere that it sits on; an earlier one.
    parent: Option<usize>,
    /// How many are below it.
    level: usize,
    /// Which of its parent's children it is.
    number: usize,
}

pub(super) fn changes(changes: &mut Changes) {
    let Some(nodes) = nodes(&changes.scene.objects) else {
        return;
    };
    let mut add = |name, says: &'static str, edit: &dyn Fn(&mut Scene)| changes.add(name, says, edit);
    add(
        "children-as-large-as-their-parents",
        "has spheres as large as those that they sit on",
        &|scene| rebuild(scene, &nodes, |parent, _| (parent, parent + parent)),
    );
    add(
        "children-half-sunk",
        "puts the centres of spheres on the surface of those that they sit on: one radius away, not the sum of both",
        &|scene| rebuild(scene, &nodes, |parent, own| (own, parent)),
    );
    add(
        "colours-not-mixed",
        "gives spheres a colour of their own, not half of it that of the sphere which they sit on",
        &|scene| {
            for (object, node) in scene.objects.iter_mut().zip(&nodes) {
                if let Some(parent) = node.parent {
                    object.material.color = (2.0 * node.color - nodes[parent].color).to_array();
                }
            }
        },
    );
    let deepest = nodes.iter().map(|node| node.level).max().unwrap_or(0);
    add(
        "smallest-missing",
        "leaves out the smallest spheres, or lays them upon those that they should sit on",
        &|scene| keep(scene, &nodes, |node| node.level < deepest),
    );
    let points_back = |node: &Node| {
        node.parent
            .is_some_and(|parent| (node.center - nodes[parent].center).min_element() < -1e-9)
    };
    add(
        "one-side-only",
        "puts spheres on one side of each axis only",
        &|scene| {
            keep(scene, &nodes, |node| !points_back(node));
        },
    );
    let most = nodes.iter().map(|node| node.number + 1).max().unwrap_or(0);
    for level in 1..=deepest {
        for number in 0..most {
            let says = "leaves out one of the spheres that sit on others: a loop begins or ends one off";
            add("one-child-short", says, &|scene| {
                keep(scene, &nodes, |node| node.level != level || node.number != number);
            });
        }
    }
}

/// The hierarchy, if there is one.
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
    (nodes.iter().filter(|node| node.parent.is_some()).count() >= LEAST).then_some(nodes)
}

/// Each sphere with another radius and at another distance from its parent, as `rule` says for the radii of both.
fn rebuild(scene: &mut Scene, nodes: &[Node], rule: impl Fn(f64, f64) -> (f64, f64)) {
    let mut built: Vec<(DVec3, f64)> = Vec::new();
    for node in nodes {
        built.push(match node.parent {
            None => (node.center, node.radius),
            Some(parent) => {
                let direction = (node.center - nodes[parent].center).normalize();
                let (center, around) = built[parent];
                let (radius, distance) = rule(around, around * node.radius / nodes[parent].radius);
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

/// Only those, and of their descendants only those whose ancestors stay.
fn keep(scene: &mut Scene, nodes: &[Node], stays: impl Fn(&Node) -> bool) {
    let mut kept: Vec<bool> = Vec::new();
    for node in nodes {
        kept.push(stays(node) && node.parent.is_none_or(|parent| kept[parent]));
    }
    scene.retain_objects(|at| kept[at]);
}
