//! Changes of the camera, of the film, and of the figures on the screen.

use toyproof_scene::Projection;

use super::{Changes, ordinal};

/// The largest number of path segments that is tried.
const MAX_SEGMENTS: u32 = 12;

pub(super) fn camera(changes: &mut Changes) {
    match changes.scene.camera.projection {
        Projection::Pinhole { screen_distance } => {
            changes.add(
                "parallel-rays",
                "sends parallel rays, where the scene has them start at the eye",
                |scene| scene.camera.projection = Projection::Parallel { width: 2.0 },
            );
            changes.add("angle-too-narrow", "has the screen twice as far away", |scene| {
                scene.camera.projection = Projection::Pinhole {
                    screen_distance: 2.0 * screen_distance,
                };
            });
        }
        Projection::Parallel { width } => {
            for screen_distance in [2.0, 1.0] {
                changes.add(
                    "rays-from-one-eye",
                    "sends rays from one point, where the scene has them parallel",
                    |scene| scene.camera.projection = Projection::Pinhole { screen_distance },
                );
            }
            let says = "takes the picture's width for half of it";
            changes.add("width-not-halved", says, |scene| {
                scene.camera.projection = Projection::Parallel { width: 2.0 * width };
            });
            let says = "halves the picture's width twice";
            changes.add("width-halved-twice", says, |scene| {
                scene.camera.projection = Projection::Parallel { width: 0.5 * width };
            });
        }
    }
    if changes.scene.camera.eye != [0.0; 3] {
        changes.add("eye-at-the-origin", "has the eye at the origin", |scene| {
            scene.camera.eye = [0.0; 3];
        });
    }
}

pub(super) fn film(changes: &mut Changes) {
    let film = changes.scene.film;
    let depth = film.max_depth;
    if depth > 1 {
        changes.add("one-bounce-short", "follows one reflection too few", |scene| {
            scene.film.max_depth -= 1;
        });
    }
    changes.add("one-bounce-more", "follows one reflection too many", |scene| {
        scene.film.max_depth += 1;
    });
    for segments in (1..depth.min(MAX_SEGMENTS + 1)).rev() {
        let says = format!("follows each ray for {segments} segments, where the scene has {depth}");
        changes.add("too-few-segments", says, |scene| scene.film.max_depth = segments);
    }
    if film.samples > 1 {
        changes.add(
            "one-sample",
            "takes one sample in each pixel, where the scene has more",
            |scene| {
                scene.film.samples = 1;
            },
        );
    }
}

pub(super) fn figures(changes: &mut Changes) {
    let count = changes.scene.figures.len();
    for low in 0..count {
        for high in low + 1..count {
            let says = format!(
                "lays the {} figure over the {} one, where the scene has it below",
                ordinal(low),
                ordinal(high)
            );
            changes.add("figures-order", says, |scene| scene.figures.swap(low, high));
        }
        let says = format!("leaves out the {} figure", ordinal(low));
        changes.add("figure-missing", says, |scene| {
            scene.figures.remove(low);
        });
    }
    changes.add(
        "figures-order-reversed",
        "lays the figures on each other the other way round",
        |scene| {
            scene.figures.reverse();
        },
    );
}
