//! Other lights.

use super::{Changes, ordinal, place};

pub(super) fn none(changes: &mut Changes) {
    changes.add(
        "ambient-light-alone",
        "lets no light fall on anything but ambient light: look at the direction to the light, the sign of the normal, and where \
         shadow rays start",
        |scene| scene.lights.clear(),
    );
}

pub(super) fn changes(changes: &mut Changes) {
    let lights = changes.scene.lights.clone();
    for (index, light) in lights.iter().enumerate() {
        if lights.len() > 1 {
            let says = format!("leaves out the light at {}", place(light.position));
            changes.add("light-missing", says, |scene| {
                scene.lights.remove(index);
            });
            let says = format!("takes the {} light for every light", ordinal(index));
            changes.add("one-light-for-all", says, |scene| {
                for light in &mut scene.lights {
                    *light = lights[index];
                }
            });
        }
        let says = match lights.len() {
            1 => "has no shadows".to_owned(),
            _ => format!("has no shadows of the {} light", ordinal(index)),
        };
        changes.add("light-without-shadow", says, |scene| {
            scene.lights[index].shadow = false;
        });
        changes.add(
            "shadow-of-a-light-without",
            "has shadows of a light that casts none",
            |scene| {
                scene.lights[index].shadow = true;
            },
        );
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let says = format!(
                "has the {} light on the other side: the sign of its {name}",
                ordinal(index)
            );
            changes.add("light-sign", says, |scene| {
                let along = &mut scene.lights[index].position[axis];
                *along = -*along;
            });
        }
        changes.add("light-at-rest", "does not move the light", |scene| {
            scene.lights[index].motion = None;
        });
        let says = "takes the light's diameter for its radius, or has it twice as large";
        changes.add("light-too-large", says, |scene| scene.lights[index].radius *= 2.0);
        changes.add("light-too-small", "has the light half as large", |scene| {
            scene.lights[index].radius *= 0.5;
        });
    }
}
