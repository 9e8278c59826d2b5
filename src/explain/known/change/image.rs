//! Changes of the camera, of the film, and of the figures on the screen.

use toyproof_scene::{Projection, Scene};

use super::{Changes, ordinal};
use crate::known::documented::{Documented, documented};

/// What the guide says about these mistakes.
pub(super) const DOCUMENTED: &[Documented] = documented! {
    /// Start all rays at the camera, with the direction to the pixel's point on the screen.
    Camera "parallel-rays": "camera rays are parallel; the scene has a pinhole camera";
    /// Give all rays the direction `vec3(0.0, 0.0, -1.0)` and move their origin with the pixel.
    Camera "perspective-rays": "camera rays start at one point; the scene has a parallel projection";
    /// Use the scene's `screen_distance` with screen coordinates from −1 to 1.
    Camera "field-of-view-too-narrow":
        "the field of view is too narrow: the screen distance is twice the scene's";
    /// Screen coordinates run from −1 to 1, so multiply them by `0.5 * width`.
    Camera "projection-width-not-halved":
        "the parallel projection is twice as wide as the scene's: its width is not halved";
    /// Screen coordinates run from −1 to 1, so multiply them by `0.5 * width`.
    Camera "projection-width-halved-twice":
        "the parallel projection is half as wide as the scene's: its width is halved twice";
    /// Use the scene's `eye` as the origin of camera rays.
    Camera "camera-at-origin": "the camera is at the origin instead of the scene's `eye`";
    /// Use `forward = normalize(lookAt - eye)`, and the direction `x * right + y * up + screenDistance *
    /// forward`.
    Camera "look-at-ignored": "the camera looks along −z instead of toward the scene's `look_at`";
    /// Rotate the camera's axes right and up by the scene's `roll`.
    Camera "roll-ignored": "the camera's roll is ignored";
    /// Check the bounds of the loop over the bounces against the scene's `max_depth`.
    Mirrors "one-bounce-fewer": "paths end one bounce before the scene's maximum depth";
    /// Check the bounds of the loop over the bounces against the scene's `max_depth`.
    Mirrors "one-bounce-more": "paths continue one bounce beyond the scene's maximum depth";
    /// Use the scene's `max_depth` as the number of iterations.
    Mirrors "max-depth-too-small": "the maximum depth is …; the scene has …";
    /// Test the upper figure first, or draw it last.
    Figures "figures-order": "the … figure covers the … one; the scene has the opposite order";
    /// The last figure in the scene is on top.
    Figures "figures-order-reversed": "the order of all figures is reversed";
    /// Add this figure, and check whether another one covers it.
    Figures "figure-missing": "the … figure is missing";
    /// Average the scene's number of samples in a loop.
    Film "one-sample": "one sample per pixel is taken; the scene has …";
};

/// The largest number of path segments that is tried.
const MAX_SEGMENTS: u32 = 12;

pub(super) fn camera(changes: &mut Changes) {
    let projected = |projection| move |scene: &mut Scene| scene.camera.projection = projection;
    match changes.scene.camera.projection {
        Projection::Pinhole { screen_distance } => {
            changes.add(
                "parallel-rays",
                &[],
                projected(Projection::Parallel { width: 2.0 }),
            );
            let screen_distance = 2.0 * screen_distance;
            changes.add(
                "field-of-view-too-narrow",
                &[],
                projected(Projection::Pinhole { screen_distance }),
            );
        }
        Projection::Parallel { width } => {
            for screen_distance in [2.0, 1.0] {
                changes.add(
                    "perspective-rays",
                    &[],
                    projected(Projection::Pinhole { screen_distance }),
                );
            }
            let wide = |factor| {
                projected(Projection::Parallel {
                    width: factor * width,
                })
            };
            changes.add("projection-width-not-halved", &[], wide(2.0));
            changes.add("projection-width-halved-twice", &[], wide(0.5));
        }
    }
    if changes.scene.camera.eye != [0.0; 3] {
        changes.add("camera-at-origin", &[], |scene| scene.camera.eye = [0.0; 3]);
    }
    changes.add("look-at-ignored", &[], |scene| scene.camera.look_at = None);
    changes.add("roll-ignored", &[], |scene| scene.camera.roll = 0.0);
}

pub(super) fn film(changes: &mut Changes) {
    let film = changes.scene.film;
    let depth = film.max_depth;
    if depth > 1 {
        changes.add("one-bounce-fewer", &[], |scene| scene.film.max_depth -= 1);
    }
    changes.add("one-bounce-more", &[], |scene| scene.film.max_depth += 1);
    for segments in (1..depth.min(MAX_SEGMENTS + 1)).rev() {
        let parts = [segments, depth].map(|depth| depth.to_string());
        changes.add("max-depth-too-small", &parts, |scene| {
            scene.film.max_depth = segments;
        });
    }
    if film.samples > 1 {
        changes.add("one-sample", &[film.samples.to_string()], |scene| {
            scene.film.samples = 1;
        });
    }
}

pub(super) fn figures(changes: &mut Changes) {
    let count = changes.scene.figures.len();
    for low in 0..count {
        for high in low + 1..count {
            let parts = [low, high].map(ordinal);
            changes.add("figures-order", &parts, |scene| scene.figures.swap(low, high));
        }
        changes.add("figure-missing", &[ordinal(low)], |scene| {
            scene.figures.remove(low);
        });
    }
    changes.add("figures-order-reversed", &[], |scene| scene.figures.reverse());
}
