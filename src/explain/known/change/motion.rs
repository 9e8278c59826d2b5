//! Changes of motions and of the moment.

use toyproof_scene::{FrameTime, Motion, Period, Requirements, Scene};

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
