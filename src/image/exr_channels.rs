//! EXR files with further channels and attributes beside the colors.

use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

use exr::image::Blocks;
use exr::meta::attribute::AttributeValue;
use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Layer, LayerAttributes, LineOrder, SmallVec,
    Text, Vec2, WritableImage,
};

use crate::{Image, ImageError};

/// A channel beside the colors.
#[derive(Debug, Clone, PartialEq)]
pub struct ExrChannel {
    /// The name: of a layer and a component, such as `Normal.X`, or one that EXR defines, such as `Z`.
    pub name: &'static str,
    /// A value for each pixel, bottom row first.
    pub values: ChannelValues,
}

/// The values of a channel.
#[derive(Debug, Clone, PartialEq)]
pub enum ChannelValues {
    /// Floats.
    Float(Vec<f32>),
    /// Numbers, such as those of objects.
    Number(Vec<u32>),
}

/// What an EXR file states about its image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExrAttributes {
    /// The program and its version (the attribute `software`).
    pub software: String,
    /// The scene (`scene`).
    pub scene: String,
    /// The command that made the image (`command`).
    pub command: String,
    /// What the channels hold, and in which units (`comments`).
    pub comments: String,
}

/// Encodes an EXR file with one part: the colors of an image, opaque, and other channels, losslessly
/// compressed. `path` is named in errors. The same arguments give the same bytes.
///
/// # Errors
/// [`ImageError::Unwritable`] if the encoder fails.
///
/// # Panics
/// If a channel does not have a value for each pixel.
pub fn encode_exr(
    image: &Image,
    channels: Vec<ExrChannel>,
    attributes: &ExrAttributes,
    path: &Path,
) -> Result<Vec<u8>, ImageError> {
    let [width, height] = image.size().map(|side| side as usize);
    let colors = ["R", "G", "B", "A"].into_iter().enumerate().map(|(at, name)| {
        let values = image.pixels().iter().map(|pixel| pixel[at]).collect();
        ExrChannel {
            name,
            values: ChannelValues::Float(values),
        }
    });
    let channels = colors.chain(channels).map(|ExrChannel { name, values }| {
        let samples = match values {
            ChannelValues::Float(values) => FlatSamples::F32(top_down(&values, width, height)),
            ChannelValues::Number(values) => FlatSamples::U32(top_down(&values, width, height)),
        };
        AnyChannel::new(name, samples)
    });
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    // The order of custom attributes in a file is that of a hash map, so that each map has one.
    let custom = |name: &str, value: &str| HashMap::from([(text(name), AttributeValue::Text(text(value)))]);
    let layer_attributes = LayerAttributes {
        software_name: Some(text(&attributes.software)),
        comments: Some(text(&attributes.comments)),
        other: custom("command", &attributes.command),
        ..LayerAttributes::default()
    };
    let channels = AnyChannels::sort(channels.collect::<SmallVec<_>>());
    let layer = Layer::new(Vec2(width, height), layer_attributes, encoding, channels);
    let mut file = exr::image::Image::from_layer(layer);
    file.attributes.other = custom("scene", &attributes.scene);
    let mut bytes = Cursor::new(Vec::new());
    let written = file.write().to_buffered(&mut bytes);
    written.map_err(|error| ImageError::Unwritable {
        path: path.to_owned(),
        error: error.to_string(),
    })?;
    Ok(bytes.into_inner())
}

fn top_down<T: Copy>(values: &[T], width: usize, height: usize) -> Vec<T> {
    assert_eq!(values.len(), width * height);
    values.chunks(width).rev().flatten().copied().collect()
}

/// A text of an EXR file, whose characters are those of Latin-1.
fn text(text: &str) -> Text {
    let latin = |character: char| {
        if u8::try_from(character).is_ok() {
            character
        } else {
            '?'
        }
    };
    Text::from(&*text.chars().map(latin).collect::<String>())
}

#[cfg(test)]
mod tests {
    use exr::prelude::{ReadChannels, ReadLayers, read};

    use super::*;

    #[test]
    fn channels_and_attributes_are_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let pixels = (0..6).map(|at| [at as f32, 0.5, -2.0, 1.0]).collect();
        let image = Image::new(3, 2, pixels);
        let channels = || {
            vec![
                ExrChannel {
                    name: "Z",
                    values: ChannelValues::Float((10..16).map(|at| at as f32).collect()),
                },
                ExrChannel {
                    name: "id",
                    values: ChannelValues::Number(vec![u32::MAX, 1, 2, 3, 4, 5]),
                },
            ]
        };
        let attributes = ExrAttributes {
            software: "toyproof".to_owned(),
            scene: "kürbis 南瓜.toml".to_owned(),
            command: "render".to_owned(),
            comments: "two\nlines".to_owned(),
        };
        let bytes = encode_exr(&image, channels(), &attributes, &path).unwrap();
        assert_eq!(bytes, encode_exr(&image, channels(), &attributes, &path).unwrap());
        std::fs::write(&path, bytes).unwrap();
        // Readers of colors ignore the rest.
        assert_eq!(crate::read(&path).unwrap(), image);

        let read = read().no_deep_data().largest_resolution_level().all_channels();
        let read = read
            .first_valid_layer()
            .all_attributes()
            .from_file(&path)
            .unwrap();
        let layer = &read.layer_data;
        let names: Vec<String> = layer
            .channel_data
            .list
            .iter()
            .map(|channel| channel.name.to_string())
            .collect();
        assert_eq!(names, ["A", "B", "G", "R", "Z", "id"]);
        let values = |name: &str| {
            let mut channels = layer.channel_data.list.iter();
            let channel = channels.find(|channel| channel.name.eq(name)).unwrap();
            channel.sample_data.clone()
        };
        assert_eq!(
            values("Z"),
            FlatSamples::F32(vec![13.0, 14.0, 15.0, 10.0, 11.0, 12.0])
        );
        assert_eq!(values("id"), FlatSamples::U32(vec![3, 4, 5, u32::MAX, 1, 2]));
        let own = &layer.attributes;
        assert_eq!(own.software_name, Some(text("toyproof")));
        assert_eq!(own.comments, Some(text("two\nlines")));
        let value = |text: &str| AttributeValue::Text(Text::from(text));
        // The reader gives all custom attributes to the layer.
        assert_eq!(own.other[&text("command")], value("render"));
        assert_eq!(own.other[&text("scene")], value("kürbis ??.toml"));
    }
}
