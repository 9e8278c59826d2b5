//! Another film.

use super::Changes;

/// The most path segments that are tried one by one.
const MAX_SEGMENTS: u32 = 12;

pub(super) fn changes(changes: &mut Changes) {
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
