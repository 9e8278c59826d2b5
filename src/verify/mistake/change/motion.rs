//! Another motion, or another moment.

use toyproof_scene::{Moment, Motion, Period, Requirements, Scene};

use super::{Changes, ordinal};

pub(super) fn changes(changes: &mut Changes) {
    if !Requirements::of(changes.scene).motion {
        return;
    }
    let moment = changes.moment;
    let frame = |frame| Moment { frame, ..moment };
    changes.add_moment("next-frame", "shows the next frame", frame(moment.frame + 1));
    changes.add_moment("frame-before", "shows the frame before", frame(moment.frame - 1));
    let start = "shows the start, as if nothing moved";
    changes.add_moment("nothing-moves", start, Moment::default());
    let motions = changes.scene.motions.len();
    for index in 0..motions {
        let which = format!("the {} motion", ordinal(index));
        let mut add = |name, says: String, edit: &dyn Fn(&mut Motion)| {
            changes.add(name, says, |scene| edit(&mut scene.motions[index]));
        };
        add(
            "not-carried-along",
            format!("does not carry {which} along with the one that it is within"),
            &|motion| motion.within = None,
        );
        for (axis, name) in [
            ([0.0, 1.0, 0.0], "upright"),
            ([1.0, 0.0, 0.0], "along x"),
            ([0.0, 0.0, 1.0], "along z"),
        ] {
            let says = format!("has the axis of {which} {name}");
            add("another-axis", says, &|motion| motion.axis = axis);
        }
        add(
            "frames-for-seconds",
            format!("takes frames for seconds in {which}, or seconds for frames"),
            &|motion| {
                motion.period = match motion.period {
                    Period::Frames(frames) => Period::Seconds(frames),
                    Period::Seconds(seconds) => Period::Frames(seconds),
                };
            },
        );
        for (factor, how) in [(0.5, "twice as fast"), (2.0, "half as fast")] {
            let says = format!("turns {how} as {which}");
            add("wrong-period", says, &|motion| {
                motion.period = scaled(motion.period, factor);
            });
        }
        let says = format!("has {which} the other way round");
        add("turned-the-other-way", says, &|motion| {
            motion.period = scaled(motion.period, -1.0);
        });
        let says = format!("turns about the world's origin in {which}, not about its pivot");
        add("about-the-origin", says, &|motion| motion.pivot = [0.0; 3]);
        let says = format!("does not turn {which}: it is not called, or its turns are divided as integers");
        changes.add("motion-stands-still", says, |scene| stop(scene, index));
        for other in index + 1..motions {
            let says = format!(
                "does not turn {which} and the {} one: they are not called, or their turns are divided as integers",
                ordinal(other)
            );
            changes.add("motions-stand-still", says, |scene| {
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

/// What the motion moved goes with the one that this is within, if any.
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
