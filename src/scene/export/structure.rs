//! Structures, and the arrays of them that hold the scene.

use std::fmt::Write;

use super::light::Lights;
use super::parts::Parts;
use super::{grid, motion, number, quadric, vector};
use crate::{Light, Material, Scene};

impl Parts<'_> {
    /// The members that all surfaces have.
    fn members(&self) -> String {
        let checker = if self.checkers {
            "    vec3 other;\n    float side;\n"
        } else {
            ""
        };
        format!("    vec3 color;\n{checker}{}", self.own_members())
    }

    /// Whether there are any, in grids or not.
    pub(super) fn has_spheres(&self) -> bool {
        !self.spheres.is_empty() || !self.grids.is_empty()
    }

    /// Those that a hit takes over.
    fn own_members(&self) -> String {
        let properties = self.properties();
        let lines = properties
            .iter()
            .map(|property| format!("    {} {};\n", property.kind, property.name));
        lines.collect()
    }

    /// Their values.
    fn values(&self, material: &Material) -> String {
        let mut text = vector(material.color);
        if self.checkers {
            let (other, side) = material
                .checker
                .map_or((material.color, 1.0), |checker| (checker.color, checker.size));
            let _ = write!(text, ", {}, {}", vector(other), number(side));
        }
        for property in self.properties() {
            let _ = write!(text, ", {}", (property.value)(material));
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
            let (form, structure) = (quadric::FORM, quadric::STRUCTURE);
            let _ = write!(
                text,
                "\n{form}\n{structure}{members}}};\n\nQuadric quadrics[QUADRICS];\n"
            );
        }
        if !self.grids.is_empty() {
            let structure = grid::STRUCTURE;
            let _ = write!(text, "\n{structure}{members}}};\n\nGrid grids[GRIDS];\n");
        }
        if self.lit() && !scene.lights.is_empty() {
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
            let (center, radius) = (motion::point(*center, object.motion), number(*radius));
            let values = self.values(&object.material);
            let _ = writeln!(
                text,
                "    spheres[{index}] = Sphere({center}, {radius}, {values});"
            );
        }
        for (index, (point, normal, object)) in self.planes.iter().enumerate() {
            let normal = motion::direction(*normal, *point, object.motion);
            let point = motion::point(*point, object.motion);
            let values = self.values(&object.material);
            let _ = writeln!(text, "    planes[{index}] = Plane({point}, {normal}, {values});");
        }
        for (index, (one, object)) in self.quadrics.iter().enumerate() {
            let (own, values) = (quadric::values(one, object.motion), self.values(&object.material));
            let _ = writeln!(text, "    quadrics[{index}] = Quadric({own}, {values});");
        }
        for (index, scatter) in self.grids.iter().enumerate() {
            let (own, values) = (grid::values(scatter), self.values(&scatter.material));
            let _ = writeln!(text, "    grids[{index}] = Grid({own}, {values});");
        }
        if self.lit() {
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

/// Whether lights say if they cast shadows.
fn has_shadow(scene: &Scene) -> bool {
    Lights::which(scene, |light| light.shadow) == Lights::Some
}

/// Whether lights have a radius.
fn has_radius(scene: &Scene) -> bool {
    Lights::which(scene, |light| light.radius > 0.0) != Lights::None
}

fn light_values(scene: &Scene, light: &Light) -> String {
    let mut values = vec![motion::point(light.position, light.motion), vector(light.color)];
    if has_shadow(scene) {
        values.push(light.shadow.to_string());
    }
    if has_radius(scene) {
        values.push(number(light.radius));
    }
    values.join(", ")
}
