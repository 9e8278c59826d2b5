//! Changes of the surfaces, their materials, and the lights.

use toyproof_scene::{Fresnel, Model, Pattern, PatternKind, Scene, Shape, Space};

use super::{Changes, place};
use crate::known::documented::{Documented, documented};

/// What the guide says about these mistakes.
pub(super) const DOCUMENTED: &[Documented] = documented! {
    /// Check the ray direction (the camera looks along −z), the sign of b in the quadratic, and the test of t
    /// (`t > 1e-3`). Return a constant color for every hit to see where rays hit.
    Symptom "background-only": "only the background is visible: rays hit nothing";
    /// Check the direction to the light (`light - point`), the direction of the normal (outward), and the
    /// origin of shadow rays: moved off the surface, `point + 1e-3 * normal`.
    Symptom "ambient-only": "only ambient light is visible: no light reaches a surface";
    /// Add this light with its position and color, and check the bounds of the loop over the lights.
    Shading "light-missing": "the light at … is missing";
    /// Use the loop's index: `lights[i]`.
    Shading "one-light-for-all": "the light at … is used in place of every light";
    /// Compare the light's position with the scene's.
    Shading "light-sign": "the … of the light's position … has the wrong sign";
    /// Apply the light's motion to its position in each frame.
    Shading "light-not-moving": "the light at … does not move";
    /// Trace a shadow ray for this light, too.
    Shadows "light-without-shadow": "the light at … casts no shadows";
    /// Trace no shadow rays for a light with `shadow = false`.
    Shadows "extra-shadow": "the light at … casts shadows; in the scene it casts none";
    /// Use the light's radius, not its diameter.
    SoftShadows "light-too-large": "the radius of the light at … is twice the scene's";
    /// Use the scene's radius; do not halve it.
    SoftShadows "light-too-small": "the radius of the light at … is half the scene's";
    /// Use the exact reflectance, the mean of both polarizations: `0.5 * (rs * rs + rp * rp)`.
    Glass "schlick-instead-of-fresnel":
        "Schlick's approximation is used; the scene has the Fresnel equations";
    /// Use `r0 + (1.0 - r0) * pow(1.0 - c, 5.0)`.
    Glass "fresnel-instead-of-schlick":
        "the Fresnel equations are used; the scene has Schlick's approximation";
    /// Trace a refracted ray for surfaces of glass.
    Glass "glass-as-mirror": "glass is rendered as a mirror";
    /// Only reflect at mirrors; test the material before refraction.
    Glass "mirror-as-glass": "mirrors are rendered as glass";
    /// Choose the color by `mod(floor(x / side) + floor(z / side), 2.0)`.
    Quadrics "checker-missing": "checkered surfaces have only one color";
    /// Rotate the ray's origin and direction into the box's axes.
    Boxes "box-rotation-ignored": "the rotation of boxes is ignored";
    /// Subtract the surface's origin, and multiply by its axes, before computing the pattern.
    Boxes "pattern-in-world-space":
        "patterns are in the coordinates of the scene instead of those of the surface";
    /// Choose the color by `mod(floor(dot(direction, p) / size), 2.0)`.
    Boxes "stripes-missing": "striped surfaces have only one color";
    /// Add this object, and check the bounds of the loop over the objects.
    Objects "object-missing": "the … at … is missing";
    /// Use the scene's radii.
    Objects "diameter-as-radius":
        "all spheres are twice as large as the scene's: their diameter is used as the radius";
    /// Use the scene's radii; do not halve them.
    Objects "radius-halved": "all spheres are half as large as the scene's";
};

/// The largest number of surfaces of a scene in which a missing one is searched for.
const MAX_MISSING: usize = 64;

pub(super) fn no_objects(changes: &mut Changes) {
    changes.add_symptom(
        "background-only",
        "only the background is visible: rays hit nothing",
        |scene| scene.retain_objects(|_| false),
    );
}

pub(super) fn objects(changes: &mut Changes) {
    let objects = &changes.scene.objects;
    let missing: Vec<_> = objects.iter().map(|object| describe(&object.shape)).collect();
    if missing.len() <= MAX_MISSING && missing.len() > 1 {
        for (index, what) in missing.iter().enumerate() {
            let description = format!("{what} is missing");
            changes.add("object-missing", description, |scene| {
                scene.retain_objects(|at| at != index);
            });
        }
    }
    for (factor, id, description) in [
        (
            2.0,
            "diameter-as-radius",
            "all spheres are twice as large as the scene's: their diameter is used as the radius",
        ),
        (
            0.5,
            "radius-halved",
            "all spheres are half as large as the scene's",
        ),
    ] {
        changes.add(id, description, |scene| {
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
        "schlick-instead-of-fresnel",
        "Schlick's approximation is used; the scene has the Fresnel equations",
        |scene| {
            each_fresnel(scene, Fresnel::Schlick);
        },
    );
    changes.add(
        "fresnel-instead-of-schlick",
        "the Fresnel equations are used; the scene has Schlick's approximation",
        |scene| {
            each_fresnel(scene, Fresnel::Exact);
        },
    );
    changes.add("glass-as-mirror", "glass is rendered as a mirror", |scene| {
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
        changes.add("mirror-as-glass", "mirrors are rendered as glass", |scene| {
            for object in &mut scene.objects {
                if object.material.model == Model::Mirror && object.shape.is_closed() {
                    object.material.model = glass;
                }
            }
        });
    }
    changes.add(
        "checker-missing",
        "checkered surfaces have only one color",
        |scene| retain_patterns(scene, |pattern| pattern.kind != PatternKind::Checker),
    );
    changes.add(
        "stripes-missing",
        "striped surfaces have only one color",
        |scene| {
            retain_patterns(scene, |pattern| pattern.kind == PatternKind::Checker);
        },
    );
    changes.add(
        "pattern-in-world-space",
        "patterns are in the coordinates of the scene instead of those of the surface",
        |scene| {
            for object in &mut scene.objects {
                if let Some(pattern) = &mut object.material.pattern {
                    pattern.space = Space::World;
                }
            }
        },
    );
}

fn retain_patterns(scene: &mut Scene, keep: fn(&Pattern) -> bool) {
    for object in &mut scene.objects {
        object.material.pattern = object.material.pattern.filter(keep);
    }
}

/// Boxes without their rotation.
pub(super) fn boxes(changes: &mut Changes) {
    changes.add(
        "box-rotation-ignored",
        "the rotation of boxes is ignored",
        |scene| {
            for object in &mut scene.objects {
                if let Shape::Box(cuboid) = &mut object.shape {
                    cuboid.axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
                }
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
        Shape::Box(cuboid) => format!("the box at {}", place(cuboid.center)),
    }
}

pub(super) fn no_lights(changes: &mut Changes) {
    changes.add_symptom(
        "ambient-only",
        "only ambient light is visible: no light reaches a surface",
        |scene| scene.lights.clear(),
    );
}

pub(super) fn lights(changes: &mut Changes) {
    let lights = changes.scene.lights.clone();
    for (index, light) in lights.iter().enumerate() {
        let position = place(light.position);
        let which = format!("the light at {position}");
        if lights.len() > 1 {
            let description = format!("{which} is missing");
            changes.add("light-missing", description, |scene| {
                scene.lights.remove(index);
            });
            let description = format!("{which} is used in place of every light");
            changes.add("one-light-for-all", description, |scene| {
                for light in &mut scene.lights {
                    *light = lights[index];
                }
            });
        }
        let description = match lights.len() {
            1 => "shadows are missing".to_owned(),
            _ => format!("{which} casts no shadows"),
        };
        changes.add("light-without-shadow", description, |scene| {
            scene.lights[index].shadow = false;
        });
        let description = format!("{which} casts shadows; in the scene it casts none");
        changes.add("extra-shadow", description, |scene| {
            scene.lights[index].shadow = true;
        });
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let description = format!("the {name} of the light's position {position} has the wrong sign");
            changes.add("light-sign", description, |scene| {
                let along = &mut scene.lights[index].position[axis];
                *along = -*along;
            });
        }
        changes.add("light-not-moving", format!("{which} does not move"), |scene| {
            scene.lights[index].motion = None;
        });
        let description = format!("the radius of {which} is twice the scene's");
        changes.add("light-too-large", description, |scene| {
            scene.lights[index].radius *= 2.0;
        });
        let description = format!("the radius of {which} is half the scene's");
        changes.add("light-too-small", description, |scene| {
            scene.lights[index].radius *= 0.5;
        });
    }
}
