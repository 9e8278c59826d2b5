//! Changes of motions, of the moment, and of a hierarchy of spheres.

use glam::DVec3;
use toyproof_scene::{FrameTime, Motion, Object, Period, Requirements, Scene, Shape};

use super::{Changes, ordinal};
use crate::known::documented::{Documented, documented};

/// What the guide says about these mistakes.
pub(super) const DOCUMENTED: &[Documented] = documented! {
    /// Use `iFrame` without adding 1.
    Motion "next-frame": "the next frame is shown";
    /// Use `iFrame` without subtracting 1.
    Motion "previous-frame": "the previous frame is shown";
    /// Compute the angle from `iTime` or `iFrame`.
    Motion "nothing-moves": "nothing moves: the image is that of time 0";
    /// Apply the enclosing motion after it: `outer(inner(p))`.
    Motion "enclosing-motion-missing": "the … motion does not follow its enclosing motion";
    /// Use the scene's `axis`, normalized.
    Motion "wrong-axis": "the axis of the … motion is …; the scene has another axis";
    /// Use `iFrame` for a period in frames and `iTime` for a period in seconds.
    Motion "frames-seconds-swapped": "the period of the … motion is counted in … instead of …";
    /// Divide `iTime` by the scene's `seconds`, or `iFrame` by its `frames`.
    Motion "wrong-period": "the … motion is … as fast as the scene's";
    /// Apply it to the object, and divide floats: `float(iFrame) / 60.0`.
    Motion "motion-missing":
        "the … motion is missing: it is not applied, or its angle is computed with integer division";
    /// Apply them to the objects, and divide floats: `float(iFrame) / 60.0`.
    Motion "motions-missing":
        "the … and the … motion are missing: they are not applied, or their angles are computed with integer division";
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

pub(super) fn motions(changes: &mut Changes) {
    if !Requirements::new(changes.scene).motion {
        return;
    }
    let frame_time = changes.frame_time;
    let frame = |frame| FrameTime { frame, ..frame_time };
    changes.add_at_time("next-frame", frame(frame_time.frame + 1));
    changes.add_at_time("previous-frame", frame(frame_time.frame - 1));
    changes.add_at_time("nothing-moves", FrameTime::default());
    let motions = changes.scene.motions.len();
    for index in 0..motions {
        let which = ordinal(index);
        let period = changes.scene.motions[index].period;
        let mut add = |id, others: &[&str], edit: &dyn Fn(&mut Motion)| {
            let others = others.iter().map(|&other| other.to_owned());
            let parts: Vec<String> = [which.clone()].into_iter().chain(others).collect();
            changes.add(id, &parts, |scene| edit(&mut scene.motions[index]));
        };
        add("enclosing-motion-missing", &[], &|motion| motion.within = None);
        for (axis, name) in [
            ([0.0, 1.0, 0.0], "y"),
            ([1.0, 0.0, 0.0], "x"),
            ([0.0, 0.0, 1.0], "z"),
        ] {
            add("wrong-axis", &[name], &|motion| motion.axis = axis);
        }
        let (units, swapped) = match period {
            Period::Frames(frames) => (["seconds", "frames"], Period::Seconds(frames)),
            Period::Seconds(seconds) => (["frames", "seconds"], Period::Frames(seconds)),
        };
        add("frames-seconds-swapped", &units, &|motion| {
            motion.period = swapped;
        });
        for (factor, how) in [(0.5, "twice"), (2.0, "half")] {
            add("wrong-period", &[how], &|motion| {
                motion.period = scaled(motion.period, factor);
            });
        }
        let reversed = format!("the {which} motion has the opposite direction");
        changes.add_as("rotation-reversed", reversed, |scene| {
            scene.motions[index].period = scaled(period, -1.0);
        });
        let moved = format!("the {which} motion is about the world's origin instead of its pivot");
        changes.add_as("rotation-about-origin", moved, |scene| {
            scene.motions[index].pivot = [0.0; 3];
        });
        changes.add("motion-missing", &[which], |scene| stop(scene, index));
        for other in index + 1..motions {
            changes.add("motions-missing", &[index, other].map(ordinal), |scene| {
                stop(scene, index);
                stop(scene, other);
            });
        }
    }
}

fn scaled(period: Period, factor: f64) -> Period {
    match period {
        Period::Frames(frames) => Period::Frames(frames * factor),
        Period::Seconds(seconds) => Period::Seconds(seconds * factor),
    }
}

/// Stops a motion; the objects that it moved follow the motion that contains it, if any.
fn stop(scene: &mut Scene, motion: usize) {
    let within = scene.motions[motion].within;
    let lights = scene.lights.iter_mut().map(|light| &mut light.motion);
    let objects = scene.objects.iter_mut().map(|object| &mut object.motion);
    let motions = scene.motions.iter_mut().map(|motion| &mut motion.within);
    for mover in lights.chain(objects).chain(motions) {
        if *mover == Some(motion) {
            *mover = within;
        }
    }
    for scattered in &mut scene.scatters {
        if scattered.scatter.motion == Some(motion) {
            scattered.scatter.motion = within;
        }
    }
}

/// The smallest number of spheres on others of a hierarchy.
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

pub(super) fn hierarchy(changes: &mut Changes) {
    let Some(nodes) = nodes(&changes.scene.objects) else {
        return;
    };
    let rebuilt = |rule: fn(f64, f64) -> (f64, f64)| {
        let nodes = &nodes;
        move |scene: &mut Scene| rebuild(scene, nodes, rule)
    };
    changes.add(
        "child-radius-of-parent",
        &[],
        rebuilt(|parent, _| (parent, parent + parent)),
    );
    changes.add(
        "child-distance-too-small",
        &[],
        rebuilt(|parent, own| (own, parent)),
    );
    changes.add("child-colors-not-mixed", &[], |scene| {
        for (object, node) in scene.objects.iter_mut().zip(&nodes) {
            if let Some(parent) = node.parent {
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

/// Rebuilds each sphere with another radius and at another distance from its parent, by a `rule` for the
/// radii of both.
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

/// Keeps the spheres that satisfy `stays`, without those whose ancestors are removed.
fn keep(scene: &mut Scene, nodes: &[Node], stays: impl Fn(&Node) -> bool) {
    let mut kept: Vec<bool> = Vec::new();
    for node in nodes {
        kept.push(stays(node) && node.parent.is_none_or(|parent| kept[parent]));
    }
    scene.retain_objects(|at| kept[at]);
}
