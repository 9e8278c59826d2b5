//! Figures in another order, or without one.

use super::{Changes, ordinal};

pub(super) fn changes(changes: &mut Changes) {
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
