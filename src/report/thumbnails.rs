//! The images that students see next to their marks.

use std::fmt::Write as _;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::html::Text;

/// The images that students see next to their marks.
#[derive(Debug, Default)]
pub struct Thumbnails(Vec<ShaderThumbnails>);

/// The images of a shader.
#[derive(Debug, Default)]
struct ShaderThumbnails {
    shader: String,
    /// Each with its caption, as a PNG.
    images: Vec<(&'static str, Vec<u8>)>,
}

impl Thumbnails {
    /// Adds the images of the next shader, each with its caption, as PNGs.
    pub fn add(&mut self, shader: String, images: Vec<(&'static str, Vec<u8>)>) {
        self.0.push(ShaderThumbnails { shader, images });
    }

    /// The size of all PNGs in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let images = self.0.iter().flat_map(|shader| &shader.images);
        images.map(|(_, png)| png.len()).sum()
    }

    /// The images as URLs, each with its caption, which names the shader if there are several.
    pub(super) fn urls(&self) -> Vec<(String, String)> {
        let images = self
            .0
            .iter()
            .flat_map(|of| of.images.iter().map(move |image| (&of.shader, image)));
        images
            .map(|(shader, (caption, png))| match self.0.len() {
                1 => ((*caption).to_owned(), url(png)),
                _ => (format!("{shader}: {caption}"), url(png)),
            })
            .collect()
    }

    /// Formats the images as HTML without a style sheet or a script.
    pub(super) fn html(&self) -> String {
        let mut html = String::new();
        for ShaderThumbnails { shader, images } in self.0.iter().filter(|shader| !shader.images.is_empty()) {
            if self.0.len() > 1 {
                let _ = write!(html, "<h4>{}</h4>", Text(shader));
            }
            for (caption, png) in images {
                let _ = write!(
                    html,
                    "<figure style=\"display: inline-block; margin: 0 1em 1em 0\">\
                     <img alt=\"{caption}\" src=\"{}\">\
                     <figcaption>{caption}</figcaption></figure>",
                    url(png)
                );
            }
        }
        html
    }
}

/// A PNG as a URL.
fn url(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(png))
}
