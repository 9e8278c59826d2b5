//! Another camera.

use toyproof_scene::Projection;

use super::Changes;

pub(super) fn changes(changes: &mut Changes) {
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
