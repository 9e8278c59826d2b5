//! The parts of the report's page that other pages use: the style, the viewer of images with the other
//! components of the script, and the article of a shader.

use serde_json::Value;
use toyproof_image::quantize;
use toyproof_verify::compare::{IN_BITS, Legend, SEEN_BY_EYE};

use super::article::Article;
use super::glossary::Glossary;
use super::source::SourceLimit;
use super::{Exhibit, Text};
use crate::{Record, Rubrics};

/// The style sheet.
pub const STYLE: &str = include_str!("page.css");
/// The template that the script fills with the images of a shader.
pub const VIEWER: &str = include_str!("viewer.html");
/// The script that defines `components`: among them the viewer. It runs in the body of the page.
pub const COMPONENTS: &str = include_str!("components.js");

/// The settings of the viewer: the images have every `step`th pixel of every `step`th row, and maps have the
/// colors of the legends.
#[must_use]
pub fn settings(step: u32) -> Value {
    let entries = |legend: Legend| -> Vec<_> {
        let entries = legend.entries().into_iter();
        entries
            .map(|(label, color)| (label, color.map(quantize)))
            .collect()
    };
    serde_json::json!({"step": step, "eye": entries(SEEN_BY_EYE), "bits": entries(IN_BITS)})
}

/// The article of a shader without images, as HTML, and the glossary with the terms, codes and mistakes that
/// it names. No text in it becomes markup.
#[must_use]
pub fn article(record: &Record, source: Option<&str>) -> [String; 2] {
    let exhibit = Exhibit {
        source: source.map(str::to_owned),
        ..Exhibit::default()
    };
    let glossary = Glossary::new(std::slice::from_ref(record));
    let article = Article {
        record,
        name: &record.shader,
        exhibit: &exhibit,
        rubrics: &Rubrics::default(),
        glossary: &glossary,
        limit: SourceLimit::new(source),
    };
    [article.html(0), glossary.html()]
}

/// Escapes a text for HTML, in an element or between double quotes.
#[must_use]
pub fn escaped(text: &str) -> String {
    Text(text).to_string()
}
