//! The structures of a shader, and the arrays that hold the scene.

use std::fmt::Write;

use super::expression::{moved_direction, moved_point, number, vector};
use super::intersection::{GRID_STRUCTURE, QUADRIC_FORM, QUADRIC_STRUCTURE, grid_values, quadric_values};
use super::parts::Parts;
use super::shading::LightShare;
use crate::{Light, Object, Scene, Shape};

impl Parts<'_> {
    /// Returns the members that all surfaces have.
    fn members(&self) -> String {
        let pattern = self.patterns.members();
        format!("    vec3 color;\n{pattern}{}", self.own_members())
    }

    /// Whether there are spheres, in grids or not.
    pub(super) fn has_spheres(&self) -> bool {
        !self.spheres.is_empty() || !self.grids.is_empty()
    }

    /// Returns the members that are copied to a hit.
    fn own_members(&self) -> String {
        let properties = self.properties();
        let lines = properties
            .iter()
            .map(|property| format!("    {} {};\n", property.kind, property.name));
        lines.collect()
    }

    /// Returns the values of the members that all surfaces have.
    fn values(&self, object: &Object) -> String {
        let mut text = vector(object.material.color) + &self.patterns.values(object);
        for property in self.properties() {
            let _ = write!(text, ", {}", (property.value)(&object.material));
        }
        text
    }

    pub(super) fn structures(&self, scene: &Scene) -> String {
        let members = self.members();
        let mut text = "struct Ray {\n    vec3 origin;\n    vec3 direction;\n};\n".to_owned();
        let sphere = if self.traces_paths {
            "    int sphere;\n"
        } else {
            ""
        };
        let _ = write!(
            text,
            "\nstruct Intersection {{\n    float t;\n    vec3 point;\n    vec3 normal;\n    vec3 color;\n{}{sphere}}};\n",
            self.own_members()
        );
        if self.has_spheres() {
            let _ = write!(
                text,
                "\nstruct Sphere {{\n    vec3 center;\n    float radius;\n{members}}};\n"
            );
        }
        if !self.spheres.is_empty() {
            text.push_str("\nSphere spheres[SPHERES];\n");
        }
        if !self.planes.is_empty() {
            let _ = write!(
                text,
                "\nstruct Plane {{\n    vec3 point;\n    vec3 normal;\n{members}}};\n\nPlane planes[PLANES];\n"
            );
        }
        if !self.quadrics.is_empty() {
            let (form, structure) = (QUADRIC_FORM, QUADRIC_STRUCTURE);
            let _ = write!(
                text,
                "\n{form}\n{structure}{members}}};\n\nQuadric quadrics[QUADRICS];\n"
            );
        }
        if !self.boxes.is_empty() {
            let axes = if self.has_turned_boxes() {
                "    mat3 axes;\n"
            } else {
                ""
            };
            let _ = write!(
                text,
                "\nstruct Box {{\n    vec3 center;\n    vec3 halfSize;\n{axes}{members}}};\n\nBox boxes[BOXES];\n"
            );
        }
        if !self.grids.is_empty() {
            let structure = GRID_STRUCTURE;
            let _ = write!(text, "\n{structure}{members}}};\n\nGrid grids[GRIDS];\n");
        }
        if self.is_lit() && !scene.lights.is_empty() {
            let shadow = if has_shadow(scene) {
                "    bool shadow;\n"
            } else {
                ""
            };
            let radius = if has_radius(scene) {
                "    float radius;\n"
            } else {
                ""
            };
            let _ = write!(
                text,
                "\nstruct Light {{\n    vec3 position;\n    vec3 color;\n{shadow}{radius}}};\n\nLight lights[LIGHTS];\n"
            );
        }
        text
    }

    pub(super) fn scene(&self, scene: &Scene) -> String {
        let mut text = "void makeScene() {\n".to_owned();
        for (index, (center, radius, object)) in self.spheres.iter().enumerate() {
            let (center, radius) = (moved_point(*center, object.motion), number(*radius));
            let values = self.values(object);
            let _ = writeln!(
                text,
                "    spheres[{index}] = Sphere({center}, {radius}, {values});"
            );
        }
        for (index, (point, normal, object)) in self.planes.iter().enumerate() {
            let normal = moved_direction(*normal, *point, object.motion);
            let point = moved_point(*point, object.motion);
            let values = self.values(object);
            let _ = writeln!(text, "    planes[{index}] = Plane({point}, {normal}, {values});");
        }
        for (index, (one, object)) in self.quadrics.iter().enumerate() {
            let (own, values) = (quadric_values(one, object.motion), self.values(object));
            let _ = writeln!(text, "    quadrics[{index}] = Quadric({own}, {values});");
        }
        for (index, (cuboid, object)) in self.boxes.iter().enumerate() {
            let (own, values) = (self.box_values(cuboid, object.motion), self.values(object));
            let _ = writeln!(text, "    boxes[{index}] = Box({own}, {values});");
        }
        for (index, scatter) in self.grids.iter().enumerate() {
            let sphere = Object {
                shape: Shape::Sphere {
                    center: scatter.corner,
                    radius: scatter.spacing,
                },
                material: scatter.material,
                motion: scatter.motion,
            };
            let (own, values) = (grid_values(scatter), self.values(&sphere));
            let _ = writeln!(text, "    grids[{index}] = Grid({own}, {values});");
        }
        if self.is_lit() {
            for (index, light) in scene.lights.iter().enumerate() {
                let _ = writeln!(
                    text,
                    "    lights[{index}] = Light({});",
                    light_values(scene, light)
                );
            }
        }
        text + "}\n"
    }
}

/// Whether lights have a member for shadows.
fn has_shadow(scene: &Scene) -> bool {
    LightShare::which(scene, |light| light.shadow) == LightShare::Some
}

/// Whether lights have a member for their radius.
fn has_radius(scene: &Scene) -> bool {
    LightShare::which(scene, |light| light.radius > 0.0) != LightShare::None
}

fn light_values(scene: &Scene, light: &Light) -> String {
    let mut values = vec![moved_point(light.position, light.motion), vector(light.color)];
    if has_shadow(scene) {
        values.push(light.shadow.to_string());
    }
    if has_radius(scene) {
        values.push(number(light.radius));
    }
    values.join(", ")
}
