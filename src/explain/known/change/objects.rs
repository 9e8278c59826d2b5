//! Changes of the surfaces, their materials, and the lights.

use toyproof_scene::{Fresnel, Light, Model, Pattern, PatternKind, Scene, Shape, Space};

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
    changes.add_symptom("background-only", |scene| scene.retain_objects(|_| false));
}

pub(super) fn objects(changes: &mut Changes) {
    let objects = &changes.scene.objects;
    let shapes: Vec<Shape> = objects.iter().map(|object| object.shape).collect();
    if (2..=MAX_MISSING).contains(&shapes.len()) {
        for (index, shape) in shapes.iter().enumerate() {
            let (kind, center) = match shape {
                Shape::Sphere { center, .. } => ("sphere", *center),
                Shape::Quadric(quadric) => ("quadric", quadric.origin),
                Shape::Box(cuboid) => ("box", cuboid.center),
                Shape::Plane { point, .. } => {
                    let description = format!("the plane through {} is missing", place(*point));
                    changes.add_as("object-missing", description, |scene| {
                        scene.retain_objects(|at| at != index);
                    });
                    continue;
                }
            };
            let parts = [kind.to_owned(), place(center)];
            changes.add("object-missing", &parts, |scene| {
                scene.retain_objects(|at| at != index);
            });
        }
    }
    for (factor, id) in [(2.0, "diameter-as-radius"), (0.5, "radius-halved")] {
        changes.add(id, &[], |scene| {
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
    changes.add("schlick-instead-of-fresnel", &[], |scene| {
        each_fresnel(scene, Fresnel::Schlick);
    });
    changes.add("fresnel-instead-of-schlick", &[], |scene| {
        each_fresnel(scene, Fresnel::Exact);
    });
    let is_glass = |model: &Model| matches!(model, Model::Glass { .. });
    changes.add("glass-as-mirror", &[], |scene| {
        for object in &mut scene.objects {
            if is_glass(&object.material.model) {
                object.material.model = Model::Mirror;
            }
        }
    });
    let mut models = changes.scene.objects.iter().map(|object| object.material.model);
    if let Some(glass) = models.find(is_glass) {
        changes.add("mirror-as-glass", &[], |scene| {
            for object in &mut scene.objects {
                if object.material.model == Model::Mirror && object.shape.is_closed() {
                    object.material.model = glass;
                }
            }
        });
    }
    changes.add("checker-missing", &[], |scene| {
        retain_patterns(scene, |pattern| pattern.kind != PatternKind::Checker);
    });
    changes.add("stripes-missing", &[], |scene| {
        retain_patterns(scene, |pattern| pattern.kind == PatternKind::Checker);
    });
    changes.add("pattern-in-world-space", &[], |scene| {
        for object in &mut scene.objects {
            if let Some(pattern) = &mut object.material.pattern {
                pattern.space = Space::World;
            }
        }
    });
}

fn retain_patterns(scene: &mut Scene, keep: fn(&Pattern) -> bool) {
    for object in &mut scene.objects {
        object.material.pattern = object.material.pattern.filter(keep);
    }
}

/// Boxes without their rotation.
pub(super) fn boxes(changes: &mut Changes) {
    changes.add("box-rotation-ignored", &[], |scene| {
        for object in &mut scene.objects {
            if let Shape::Box(cuboid) = &mut object.shape {
                cuboid.axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            }
        }
    });
}

fn each_fresnel(scene: &mut Scene, which: Fresnel) {
    for object in &mut scene.objects {
        if let Model::Glass { fresnel, .. } = &mut object.material.model {
            *fresnel = which;
        }
    }
}

pub(super) fn no_lights(changes: &mut Changes) {
    changes.add_symptom("ambient-only", |scene| scene.lights.clear());
}

pub(super) fn lights(changes: &mut Changes) {
    let lights = changes.scene.lights.clone();
    for (index, light) in lights.iter().enumerate() {
        let position = [place(light.position)];
        if lights.len() > 1 {
            changes.add("light-missing", &position, |scene| {
                scene.lights.remove(index);
            });
            changes.add("one-light-for-all", &position, |scene| {
                scene.lights.fill(lights[index]);
            });
        }
        let without_shadow = |scene: &mut Scene| scene.lights[index].shadow = false;
        match lights.len() {
            1 => changes.add_as(
                "light-without-shadow",
                "shadows are missing".to_owned(),
                without_shadow,
            ),
            _ => changes.add("light-without-shadow", &position, without_shadow),
        }
        changes.add("extra-shadow", &position, |scene| {
            scene.lights[index].shadow = true;
        });
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let parts = [name.to_owned(), place(light.position)];
            changes.add("light-sign", &parts, |scene| {
                scene.lights[index].position[axis] *= -1.0;
            });
        }
        let mut change = |id, edit: &dyn Fn(&mut Light)| {
            changes.add(id, &position, |scene| edit(&mut scene.lights[index]));
        };
        change("light-not-moving", &|light| light.motion = None);
        change("light-too-large", &|light| light.radius *= 2.0);
        change("light-too-small", &|light| light.radius *= 0.5);
    }
}
