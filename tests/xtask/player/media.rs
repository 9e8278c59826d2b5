//! The media that a project reads, for the page: computed stand-ins of those of the site.

use std::collections::BTreeMap;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Map, Value, json};
use toyproof::image::{Image, quantize};
use toyproof::media::{Content, StandIn};
use toyproof::project::Medium;

/// The id of the camera, which inputs of its type need not name.
const WEBCAM_ID: &str = "4sf3zn";

/// What the inputs of a project read.
#[derive(Debug, Default)]
pub(super) struct Media {
    /// The sizes of all media and the texels of those that do not move, by their ids on the site.
    pub(super) stills: Map<String, Value>,
    /// The image of each film at a time in seconds.
    films: BTreeMap<&'static str, fn(f64) -> Image>,
}

impl Media {
    /// Finds the media of a project, and writes the id of each as `medium` into the inputs that read it.
    pub(super) fn of(project: &mut Value) -> Self {
        let mut media = Self::default();
        media.name(project);
        media
    }

    /// Whether each frame needs other texels.
    pub(super) fn has_films(&self) -> bool {
        !self.films.is_empty()
    }

    /// The texels of all films at a time, in seconds.
    pub(super) fn films(&self, time: f32) -> Value {
        let films = self.films.iter();
        films
            .map(|(id, image)| ((*id).to_owned(), json!([rows_from_top(&image(time.into()))])))
            .collect::<Map<_, _>>()
            .into()
    }

    fn name(&mut self, value: &mut Value) {
        match value {
            Value::Array(elements) => elements.iter_mut().for_each(|element| self.name(element)),
            Value::Object(fields) => {
                for (key, field) in fields {
                    match field {
                        Value::Array(inputs) if key == "inputs" => {
                            for input in inputs {
                                self.name_input(input);
                            }
                        }
                        other => self.name(other),
                    }
                }
            }
            _ => {}
        }
    }

    fn name_input(&mut self, input: &mut Value) {
        let text = |keys: [&str; 2]| {
            keys.iter()
                .find_map(|key| input[*key].as_str())
                .unwrap_or_default()
        };
        let (id, path) = (text(["id", "id"]), text(["src", "filepath"]));
        let known = Medium::find(id, path);
        let id = match text(["ctype", "type"]) {
            "webcam" => WEBCAM_ID,
            _ => known.map_or(id, |medium| medium.id),
        };
        let Some(stand_in) = StandIn::find(id) else {
            return;
        };
        if !self.stills.contains_key(stand_in.id) {
            let components = known.map_or(4, |medium| medium.channels);
            let still = self.still(stand_in, components);
            self.stills.insert(stand_in.id.to_owned(), still);
        }
        input["medium"] = stand_in.id.into();
    }

    fn still(&mut self, stand_in: &'static StandIn, components: u8) -> Value {
        let (size, layers) = match stand_in.content {
            Content::Texture(compute) => layers(&[compute()], rows_from_top),
            Content::Cube(compute) => layers(&compute(), rows_from_top),
            Content::Volume(compute) => layers(&compute(), |slice| encoded(slice.pixels())),
            Content::Film(compute) => {
                self.films.insert(stand_in.id, compute);
                (compute(0.0).size(), Vec::new())
            }
        };
        json!({ "size": size, "components": components, "layers": layers })
    }
}

/// The size of images, and the text of each.
fn layers(images: &[Image], text: impl Fn(&Image) -> String) -> ([u32; 2], Vec<String>) {
    (images[0].size(), images.iter().map(text).collect())
}

/// The pixels of an upright image as in a file.
fn rows_from_top(image: &Image) -> String {
    encoded(image.upside_down().pixels())
}

fn encoded(pixels: &[[f32; 4]]) -> String {
    let bytes: Vec<u8> = pixels.iter().flat_map(|pixel| pixel.map(quantize)).collect();
    BASE64_STANDARD.encode(bytes)
}
