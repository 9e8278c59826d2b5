//! Other surfaces.

use toyproof_scene::{Fresnel, Model, Scene, Shape};

use super::{Changes, place};

/// With more surfaces than this, none is looked for that is missing.
const MAX_MISSING: usize = 64;

pub(super) fn none(changes: &mut Changes) {
    changes.add(
        "background-alone",
        "paints the background alone, as if no ray met anything: look at where rays go, where the scene stands, the sign of b, and \
         which t count as hits",
        |scene| scene.retain_objects(|_| false),
    );
}

pub(super) fn changes(changes: &mut Changes) {
    let objects = &changes.scene.objects;
    let missing: Vec<_> = objects.iter().map(|object| told(&object.shape)).collect();
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

/// A surface, as people call it.
fn told(shape: &Shape) -> String {
    match shape {
        Shape::Sphere { center, .. } => format!("the sphere at {}", place(*center)),
        Shape::Plane { point, .. } => format!("the plane through {}", place(*point)),
        Shape::Quadric(quadric) => format!("the quadric at {}", place(quadric.origin)),
    }
}
