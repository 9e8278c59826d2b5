//! Structures, and the arrays of them that hold the scene.

use std::fmt::Write;

use super::light::{Shadows, shadows};
use super::parts::{Parts, word};
use super::{number, quadric, vector};
use crate::scene::{Object, Scene};

impl Parts<'_> {
    /// The members that all surfaces have.
    fn members(&self) -> String {
        let checker = if self.checkers {
            "    vec3 other;\n    float side;\n"
        } else {
            ""
        };
        format!("    vec3 color;\n{checker}{}", self.model_member())
    }

    fn model_member(&self) -> &'static str {
        if self.names_models() {
            "    int model;\n"
        } else {
            ""
        }
    }

    /// Their values.
    fn values(&self, object: &Object) -> String {
        let material = &object.material;
        let mut text = vector(material.color);
        if self.checkers {
            let (other, side) = material
                .checker
                .map_or((material.color, 1.0), |checker| (checker.color, checker.size));
            let _ = write!(text, ", {}, {}", vector(other), number(side));
        }
        if let (true, Some(word)) = (self.names_models(), word(&material.model)) {
            let _ = write!(text, ", {word}");
        }
        text
    }

    pub(super) fn structures(&self, scene: &Scene) -> String {
        let members = self.members();
        let mut text = "struct Ray {\n    vec3 origin;\n    vec3 direction;\n};\n".to_owned();
        let _ = write!(
            text,
            "\nstruct Intersection {{\n    float t;\n    vec3 point;\n    vec3 normal;\n    vec3 color;\n{}}};\n",
            self.model_member()
        );
        if !self.spheres.is_empty() {
            let _ = write!(
                text,
                "\nstruct Sphere {{\n    vec3 center;\n    float radius;\n{members}}};\n\nSphere spheres[SPHERES];\n"
            );
        }
        if !self.planes.is_empty() {
            let _ = write!(
                text,
                "\nstruct Plane {{\n    vec3 point;\n    vec3 normal;\n{members}}};\n\nPlane planes[PLANES];\n"
            );
        }
        if !self.quadrics.is_empty() {
            let structure = quadric::STRUCTURE;
            let _ = write!(text, "\n{structure}{members}}};\n\nQuadric quadrics[QUADRICS];\n");
        }
        if self.lit() && !scene.lights.is_empty() {
            let shadow = if shadows(scene) == Shadows::Some {
                "    bool shadow;\n"
            } else {
                ""
            };
            let _ = write!(
                text,
                "\nstruct Light {{\n    vec3 position;\n    vec3 color;\n{shadow}}};\n\nLight lights[LIGHTS];\n"
            );
        }
        text
    }

    pub(super) fn scene(&self, scene: &Scene) -> String {
        let mut text = "void makeScene() {\n".to_owned();
        for (index, (center, radius, object)) in self.spheres.iter().enumerate() {
            let (center, radius) = (vector(*center), number(*radius));
            let values = self.values(object);
            let _ = writeln!(
                text,
                "    spheres[{index}] = Sphere({center}, {radius}, {values});"
            );
        }
        for (index, (point, normal, object)) in self.planes.iter().enumerate() {
            let [point, normal] = [point, normal].map(|v| vector(*v));
            let values = self.values(object);
            let _ = writeln!(text, "    planes[{index}] = Plane({point}, {normal}, {values});");
        }
        for (index, (one, object)) in self.quadrics.iter().enumerate() {
            let (own, values) = (quadric::values(one), self.values(object));
            let _ = writeln!(text, "    quadrics[{index}] = Quadric({own}, {values});");
        }
        if self.lit() {
            for (index, light) in scene.lights.iter().enumerate() {
                let shadow = match shadows(scene) {
                    Shadows::Some => format!(", {}", light.shadow),
                    _ => String::new(),
                };
                let _ = writeln!(
                    text,
                    "    lights[{index}] = Light({}, {}{shadow});",
                    vector(light.position),
                    vector(light.color)
                );
            }
        }
        text + "}\n"
    }
}
