//! Structures, and the arrays of them that hold the scene.

use std::fmt::Write;

use super::light::{Shadows, shadows};
use super::parts::{Parts, word};
use super::{number, vector};
use crate::scene::{Object, Scene};

impl Parts<'_> {
    pub(super) fn structures(&self, scene: &Scene) -> String {
        let model = if self.names_models() {
            "    int model;\n"
        } else {
            ""
        };
        let mut text = "struct Ray {\n    vec3 origin;\n    vec3 direction;\n};\n".to_owned();
        let _ = write!(
            text,
            "\nstruct Intersection {{\n    float t;\n    vec3 point;\n    vec3 normal;\n    vec3 color;\n{model}}};\n"
        );
        if !self.spheres.is_empty() {
            let _ = write!(
                text,
                "\nstruct Sphere {{\n    vec3 center;\n    float radius;\n    vec3 color;\n{model}}};\n\
                 \nSphere spheres[SPHERES];\n"
            );
        }
        if !self.planes.is_empty() {
            let _ = write!(
                text,
                "\nstruct Plane {{\n    vec3 point;\n    vec3 normal;\n    vec3 color;\n{model}}};\n\
                 \nPlane planes[PLANES];\n"
            );
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
        let model = |object: &Object| match word(&object.material.model) {
            Some(word) if self.names_models() => format!(", {word}"),
            _ => String::new(),
        };
        let mut text = "void makeScene() {\n".to_owned();
        for (index, (center, radius, object)) in self.spheres.iter().enumerate() {
            let _ = writeln!(
                text,
                "    spheres[{index}] = Sphere({}, {}, {}{});",
                vector(*center),
                number(*radius),
                vector(object.material.color),
                model(object)
            );
        }
        for (index, (point, normal, object)) in self.planes.iter().enumerate() {
            let _ = writeln!(
                text,
                "    planes[{index}] = Plane({}, {}, {}{});",
                vector(*point),
                vector(*normal),
                vector(object.material.color),
                model(object)
            );
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
