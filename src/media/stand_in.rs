//! The table of stand-ins, by the site's ids.

use toyproof_image::{Image, Noise};

use crate::cube::{GALLERY, basilica, blurred, forest, sharp};
use crate::{blue_noise, film, font, material, volume};

/// A computed medium in place of one of the site's, which may not be distributed.
#[derive(Debug)]
pub struct StandIn {
    /// The id in the site's JSON.
    pub id: &'static str,
    /// What the stand-in is, in a few words, and how it differs from the site's medium: the end of a sentence
    /// that begins with its name.
    pub description: &'static str,
    /// How its texels are computed.
    pub content: Content,
}

/// The kind of a medium, and the function that computes its texels: 8-bit values as floats, the same on every
/// machine. Each call computes them anew, in 10 to 100 ms for the larger ones.
///
/// An image's rows run upwards, and the images are upright: a lookup at (0, 0) of a texture with `vflip`
/// reads `get(0, 0)`, the lower left; without `vflip`, the image is upside down.
#[derive(Debug, Clone, Copy)]
pub enum Content {
    /// A two-dimensional texture.
    Texture(fn() -> Image),
    /// The faces +X −X +Y −Y +Z −Z of a cube map, each as its file shows it: without `vflip`, its first row
    /// is t = 0, as [`toyproof_image::cube`] has it.
    Cube(fn() -> [Image; 6]),
    /// The slices of a volume, z = 0 first, each with y = 0 first.
    Volume(fn() -> Vec<Image>),
    /// A film: the image at a time in seconds.
    Film(fn(f64) -> Image),
}

impl StandIn {
    /// All stand-ins.
    pub const ALL: &[Self] = STAND_INS;

    /// The stand-in for the medium with an id.
    pub fn find(id: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|stand_in| stand_in.id == id)
    }
}

const fn row(id: &'static str, content: Content, description: &'static str) -> StandIn {
    StandIn {
        id,
        description,
        content,
    }
}

#[rustfmt::skip]
const STAND_INS: &[StandIn] = &[
    row("4dfGRn", Content::Texture(material::street), "a computed street between houses, not the site's photograph of London"),
    row("Xsf3zn", Content::Texture(|| Noise::RgbaMedium.image()), "other random numbers with the same shifts between components"),
    row("XdX3Rn", Content::Texture(material::glass_stones), "a computed image of glass stones, not the site's"),
    row("4dXGzr", Content::Texture(font::font), "the same codes, sizes and distances with the glyphs of DejaVu Sans"),
    row("4dXGRn", Content::Texture(material::rock_tiles), "a computed wall of stones, not the site's photograph"),
    row("4dXGzn", Content::Texture(|| Noise::GrayMedium.image()), "other random numbers"),
    row("4sf3Rr", Content::Texture(material::pebbles), "computed heights of pebbles, not the site's"),
    row("XsBSR3", Content::Texture(blue_noise::blue_noise), "other random numbers with a blue spectrum, repeated after 128 texels"),
    row("4sXGRn", Content::Texture(material::rusty_metal), "a computed image of rusty metal, not the site's photograph"),
    row("XsfGRn", Content::Texture(material::wood), "a computed image of wood, not the site's photograph"),
    row("XdfGRn", Content::Texture(material::stars), "a computed image of stars and dust, not the site's"),
    row("4sfGRn", Content::Texture(material::lichen), "a computed image of slate with lichen, not the site's photograph"),
    row("4sf3Rn", Content::Texture(|| Noise::GraySmall.image()), "other random numbers"),
    row("XdXGzn", Content::Texture(|| Noise::RgbaSmall.image()), "other random numbers"),
    row("4dX3Rn", Content::Texture(material::woven_straw), "a computed weave of straw, not the site's photograph"),
    row("Xdf3zn", Content::Texture(|| Noise::Bayer.image()), "the same thresholds of ordered dithering"),
    row("XsX3Rn", Content::Texture(material::pitted_rust), "a computed image of pitted rust, not the site's photograph"),
    row("Xsf3Rr", Content::Texture(material::blue_stone), "a computed image of gray stone, not the site's photograph"),
    row("4df3Rr", Content::Texture(material::rose_marble), "a computed image of marble, not the site's photograph"),
    row("Xsf3Rn", Content::Texture(material::running_cat), "another cat, in the same six frames of 40 texels"),
    row("XdXGzr", Content::Texture(material::blotches), "computed blotches of color, not the site's photograph"),
    row("XsXGRn", Content::Texture(material::bark), "a computed image of bark, not the site's photograph"),
    row("XsfGzn", Content::Cube(|| sharp(512, |d| GALLERY.color(d))), "a computed court between houses, not the site's photograph"),
    row("4sfGzn", Content::Cube(|| blurred(64, |d| GALLERY.color(d))), "a computed court between houses, blurred, not the site's photograph"),
    row("XsX3zn", Content::Cube(|| sharp(256, forest)), "a computed forest, not the site's photograph"),
    row("4sX3zn", Content::Cube(|| blurred(64, forest)), "a computed forest, blurred, not the site's photograph"),
    row("XdX3zn", Content::Cube(|| sharp(256, basilica)), "a computed hall with bright windows, not the site's photograph"),
    row("4dX3zn", Content::Cube(|| blurred(64, basilica)), "a computed hall with bright windows, blurred, not the site's photograph"),
    row("4sfGRr", Content::Volume(|| volume::noise(1)), "other random numbers"),
    row("XdX3Rr", Content::Volume(|| volume::noise(4)), "other random numbers"),
    row("Xdf3Rn", Content::Film(film::green_screen), "a computed figure before a green screen, not the site's video"),
    row("XdfGRr", Content::Film(film::green_screen), "a computed figure before a green screen, not the site's video"),
    row("4sX3Rn", Content::Film(film::landscape), "a computed landscape, not the site's video"),
    row("4df3zn", Content::Film(film::old_film), "a computed black-and-white film, not the site's video"),
    row("4sf3zn", Content::Film(film::camera), "a computed face, not the image of a camera"),
];
