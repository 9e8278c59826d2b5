//! Changes of the surfaces, their materials, and the lights.

use toyproof_scene::{Fresnel, Model, Scene, Shape};

use super::{Changes, ordinal, place};

/// The largest number of surfaces of a scene in which a missing one is searched for.
const MAX_MISSING: usize = 64;

pub(super) fn no_objects(changes: &mut Changes) {
    changes.add(
        "background-alone",
        "paints the background alone, as if no ray met anything: look at where rays go, where the scene stands, the sign of b, and \
         which t count as hits",
        |scene| scene.retain_objects(|_| false),
    );
}

pub(super) fn objects(changes: &mut Changes) {
    let objects = &changes.scene.objects;
    let missing: Vec<_> = objects.iter().map(|object| describe(&object.shape)).collect();
    if missing.len() <= MAX_MISSING && missing.len() > 1 {
        for (index, what) in missing.iter().enumerate() {
            let says = format!("leaves out {what}");
            changes.add("object-missing", says, |scene| {
                scene.retain_objects(|at| at != index);
            });
        }
    }
    for (factor, name, says) in [
        (
            2.0,
            "diameter-for-radius",
            "takes diameters for radii: all spheres are twice as large",
        ),
        (0.5, "radius-halved", "has all spheres half as large"),
    ] {
        changes.add(name, says, |scene| {
            for object in &mut scene.objects {
                if let Shape::Sphere { radius, .. } = &mut object.shape {
                    *radius *= factor;
                }
            }
        });
    }
    materials(changes);
}

fn materials(changes: &mut Changes) {
    changes.add(
        "schlick-for-fresnel",
        "has Schlick's formula where the scene has Fresnel's equations",
        |scene| {
            each_fresnel(scene, Fresnel::Schlick);
        },
    );
    changes.add(
        "fresnel-for-schlick",
        "has Fresnel's equations where the scene has Schlick's formula",
        |scene| {
            each_fresnel(scene, Fresnel::Exact);
        },
    );
    changes.add("glass-as-mirror", "treats glass as a mirror", |scene| {
        for object in &mut scene.objects {
            if matches!(object.material.model, Model::Glass { .. }) {
                object.material.model = Model::Mirror;
            }
        }
    });
    let is_glass = |model: &Model| matches!(model, Model::Glass { .. });
    let glass = changes.scene.objects.iter().map(|object| object.material.model);
    let glass = glass.into_iter().find(is_glass);
    if let Some(glass) = glass {
        changes.add("mirror-as-glass", "treats mirrors as glass", |scene| {
            for object in &mut scene.objects {
                if object.material.model == Model::Mirror && object.shape.is_closed() {
                    object.material.model = glass;
                }
            }
        });
    }
    changes.add(
        "checker-forgotten",
        "paints checkered surfaces in one colour",
        |scene| {
            for object in &mut scene.objects {
                object.material.checker = None;
            }
        },
    );
}

fn each_fresnel(scene: &mut Scene, which: Fresnel) {
    for object in &mut scene.objects {
        if let Model::Glass { fresnel, .. } = &mut object.material.model {
            *fresnel = which;
        }
    }
}

/// Describes a surface.
fn describe(shape: &Shape) -> String {
    match shape {
        Shape::Sphere { center, .. } => format!("the sphere at {}", place(*center)),
        Shape::Plane { point, .. } => format!("the plane through {}", place(*point)),
        Shape::Quadric(quadric) => format!("the quadric at {}", place(quadric.origin)),
    }
}

pub(super) fn no_lights(changes: &mut Changes) {
    changes.add(
        "ambient-light-alone",
        "lets no light fall on anything but ambient light: look at the direction to the light, the sign of the normal, and where \
         shadow rays start",
        |scene| scene.lights.clear(),
    );
}

pub(super) fn lights(changes: &mut Changes) {
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
