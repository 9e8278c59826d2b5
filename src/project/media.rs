//! ShaderToy's built-in media, and the ids of everything that an input may read.

use crate::pass::{Buffer, Source, SourceType};

/// A medium that the site provides. Its file is not redistributable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Medium {
    /// The id in the site's JSON.
    pub id: &'static str,
    /// The name that the site shows.
    pub name: &'static str,
    /// The type.
    pub source_type: SourceType,
    /// The file name: a hash, which identifies the medium, and an extension.
    pub file: &'static str,
    /// Width, height and depth of a texture in texels; of a cube map, of each face.
    pub size: [u32; 3],
    /// The number of stored channels: a medium with 1 is R8, so that it reads as (r, 0, 0, 1).
    pub channels: u8,
}

impl Medium {
    /// All media whose names are known, those of most shaders first for each type.
    pub const ALL: &[Self] = MEDIA;

    /// The medium with this id, or with this hash in its path.
    #[must_use]
    pub fn find(id: &str, path: &str) -> Option<&'static Self> {
        let is_file = |medium: &&Self| path.rsplit('/').next() == Some(medium.file);
        Self::ALL
            .iter()
            .find(|medium| medium.id == id)
            .or_else(|| Self::ALL.iter().find(is_file))
    }
}

const fn medium(
    id: &'static str,
    name: &'static str,
    source_type: SourceType,
    file: &'static str,
    size: [u32; 3],
    channels: u8,
) -> Medium {
    Medium {
        id,
        name,
        source_type,
        file,
        size,
        channels,
    }
}

#[rustfmt::skip]
const MEDIA: &[Medium] = &[
    medium("4dfGRn", "London", SourceType::Texture, "8de3a3924cb95bd0e95a443fff0326c869f9d4979cd1d5b6e94e2a01f5be53e9.jpg", [512, 512, 1], 3),
    medium("Xsf3zn", "RGBA Noise Medium", SourceType::Texture, "f735bee5b64ef98879dc618b016ecf7939a5756040c2cde21ccb15e69a6e1cfb.png", [256, 256, 1], 4),
    medium("XdX3Rn", "Abstract 1", SourceType::Texture, "52d2a8f514c4fd2d9866587f4d7b2a5bfa1a11a0e772077d7682deb8b3b517e5.jpg", [1024, 1024, 1], 3),
    medium("4dXGzr", "Font 1", SourceType::Texture, "08b42b43ae9d3c0605da11d0eac86618ea888e62cdd9518ee8b9097488b31560.png", [1024, 1024, 1], 4),
    medium("4dXGRn", "Rock Tiles", SourceType::Texture, "10eb4fe0ac8a7dc348a2cc282ca5df1759ab8bf680117e4047728100969e7b43.jpg", [512, 512, 1], 3),
    medium("4dXGzn", "Gray Noise Medium", SourceType::Texture, "0c7bf5fe9462d5bffbd11126e82908e39be3ce56220d900f633d58fb432e56f5.png", [256, 256, 1], 1),
    medium("4sf3Rr", "Pebbles", SourceType::Texture, "ad56fba948dfba9ae698198c109e71f118a54d209c0ea50d77ea546abad89c57.png", [512, 512, 1], 1),
    medium("XsBSR3", "Blue Noise", SourceType::Texture, "cb49c003b454385aa9975733aff4571c62182ccdda480aaba9a8d250014f00ec.png", [1024, 1024, 1], 4),
    medium("4sXGRn", "Rusty Metal", SourceType::Texture, "95b90082f799f48677b4f206d856ad572f1d178c676269eac6347631d4447258.jpg", [512, 512, 1], 3),
    medium("XsfGRn", "Wood", SourceType::Texture, "1f7dca9c22f324751f2a5a59c9b181dfe3b5564a04b724c657732d0bf09c99db.jpg", [1024, 1024, 1], 3),
    medium("XdfGRn", "Stars", SourceType::Texture, "e6e5631ce1237ae4c05b3563eda686400a401df4548d0f9fad40ecac1659c46c.jpg", [512, 512, 1], 3),
    medium("4sfGRn", "Lichen", SourceType::Texture, "fb918796edc3d2221218db0811e240e72e340350008338b0c07a52bd353666a6.jpg", [1024, 1024, 1], 3),
    medium("4sf3Rn", "Gray Noise Small", SourceType::Texture, "0a40562379b63dfb89227e6d172f39fdce9022cba76623f1054a2c83d6c0ba5d.png", [64, 64, 1], 1),
    medium("XdXGzn", "RGBA Noise Small", SourceType::Texture, "3083c722c0c738cad0f468383167a0d246f91af2bfa373e9c5c094fb8c8413e0.png", [64, 64, 1], 4),
    medium("4dX3Rn", "Abstract 2", SourceType::Texture, "bd6464771e47eed832c5eb2cd85cdc0bfc697786b903bfd30f890f9d4fc36657.jpg", [512, 512, 1], 3),
    medium("Xdf3zn", "Bayer", SourceType::Texture, "85a6d68622b36995ccb98a89bbb119edf167c914660e4450d313de049320005c.png", [8, 8, 1], 1),
    medium("XsX3Rn", "Organic 2", SourceType::Texture, "92d7758c402f0927011ca8d0a7e40251439fba3a1dac26f5b8b62026323501aa.jpg", [1024, 1024, 1], 3),
    medium("Xsf3Rr", "Organic 3", SourceType::Texture, "79520a3d3a0f4d3caa440802ef4362e99d54e12b1392973e4ea321840970a88a.jpg", [1024, 1024, 1], 3),
    medium("4df3Rr", "Organic 4", SourceType::Texture, "3871e838723dd6b166e490664eead8ec60aedd6b8d95bc8e2fe3f882f0fd90f0.jpg", [1024, 1024, 1], 3),
    medium("Xsf3Rn", "Nyancat", SourceType::Texture, "cbcbb5a6cfb55c36f8f021fbb0e3f69ac96339a39fa85cd96f2017a2192821b5.png", [256, 32, 1], 4),
    medium("XdXGzr", "Abstract 3", SourceType::Texture, "8979352a182bde7c3c651ba2b2f4e0615de819585cc37b7175bcefbca15a6683.jpg", [1024, 1024, 1], 3),
    medium("XsXGRn", "Organic 1", SourceType::Texture, "cd4c518bc6ef165c39d4405b347b51ba40f8d7a065ab0e8d2e4f422cbc1e8a43.jpg", [1024, 1024, 1], 3),
    medium("XsfGzn", "Uffizi Gallery", SourceType::Cubemap, "585f9546c092f53ded45332b343144396c0b2d70d9965f585ebc172080d8aa58.jpg", [512, 512, 1], 3),
    medium("4sfGzn", "Uffizi Gallery Blurred", SourceType::Cubemap, "793a105653fbdadabdc1325ca08675e1ce48ae5f12e37973829c87bea4be3232.png", [64, 64, 1], 3),
    medium("XsX3zn", "Forest", SourceType::Cubemap, "94284d43be78f00eb6b298e6d78656a1b34e2b91b34940d02f1ca8b22310e8a0.png", [256, 256, 1], 3),
    medium("4sX3zn", "Forest Blurred", SourceType::Cubemap, "0681c014f6c88c356cf9c0394ffe015acc94ec1474924855f45d22c3e70b5785.png", [64, 64, 1], 3),
    medium("XdX3zn", "St. Peter's Basilica", SourceType::Cubemap, "488bd40303a2e2b9a71987e48c66ef41f5e937174bf316d3ed0e86410784b919.jpg", [256, 256, 1], 3),
    medium("4dX3zn", "St. Peter's Basilica Blurred", SourceType::Cubemap, "550a8cce1bf403869fde66dddf6028dd171f1852f4a704a465e1b80d23955663.png", [64, 64, 1], 3),
    medium("4sfGRr", "Grey Noise3D", SourceType::Volume, "27012b4eadd0c3ce12498b867058e4f717ce79e10a99568cca461682d84a4b04.bin", [32, 32, 32], 1),
    medium("XdX3Rr", "RGBA Noise3D", SourceType::Volume, "aea6b99da1d53055107966b59ac5444fc8bc7b3ce2d0bbb6a4a3cbae1d97f3aa.bin", [32, 32, 32], 4),
    medium("4sXGzn", "8 Bit Mentality", SourceType::Music, "a6a1cf7a09adfed8c362492c88c30d74fb3d2f4f7ba180ba34b98556660fada1.mp3", [512, 2, 1], 1),
    medium("4df3Rn", "Electronebulae", SourceType::Music, "3c33c415862bb7964d256f4749408247da6596f2167dca2c86cc38f83c244aa6.mp3", [512, 2, 1], 1),
    medium("XsXGzn", "Experiment", SourceType::Music, "29de534ed5e4a6a224d2dfffab240f2e19a9d95f5e39de8898e850efdb2a99de.mp3", [512, 2, 1], 1),
    medium("4sXGRr", "Most Geometric Person", SourceType::Music, "48e2d9ef22ca6673330b8c38a260c87694d2bbc94c19fec9dfa4a1222c364a99.mp3", [512, 2, 1], 1),
    medium("XsXGRr", "Tropical Beeper", SourceType::Music, "d96b229eeb7a08d53adfcf1ff89e54c9ffeebed193d317d1a01cc8125c0f5cca.mp3", [512, 2, 1], 1),
    medium("XdfGzn", "X TrackTure", SourceType::Music, "894a09f482fb9b2822c093630fc37f0ce6cfec02b652e4e341323e4b6e4a4543.mp3", [512, 2, 1], 1),
    medium("4dfGzn", "Ourpithyator", SourceType::Music, "ec8a6ea755d34600547a5353f21f0a453f9f55ff95514383b2d80b8d71283eda.mp3", [512, 2, 1], 1),
];

/// The source of an input, as the site's JSON names it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Name {
    /// The name in `project.toml`: `buffer-a`, `keyboard`, or the name of a built-in medium.
    pub(crate) source: &'static str,
    pub(crate) source_type: SourceType,
    pub(crate) id: &'static str,
    pub(crate) path: String,
    pub(crate) preview: String,
}

/// A source that is not a medium: its name in `project.toml`, its type, its id and its path.
struct FixedSource {
    name: &'static str,
    source_type: SourceType,
    id: &'static str,
    path: &'static str,
}

const fn fixed(
    name: &'static str,
    source_type: SourceType,
    id: &'static str,
    path: &'static str,
) -> FixedSource {
    FixedSource {
        name,
        source_type,
        id,
        path,
    }
}

/// The sources that are not media, the buffers first.
#[rustfmt::skip]
const FIXED: [FixedSource; 8] = [
    fixed("buffer-a", SourceType::Buffer, "4dXGR8", "/media/previz/buffer00.png"),
    fixed("buffer-b", SourceType::Buffer, "XsXGR8", "/media/previz/buffer01.png"),
    fixed("buffer-c", SourceType::Buffer, "4sXGR8", "/media/previz/buffer02.png"),
    fixed("buffer-d", SourceType::Buffer, "XdfGR8", "/media/previz/buffer03.png"),
    fixed("cube-a", SourceType::Cubemap, CUBE_A_ID, "/media/a//media/previz/cubemap00.png"),
    fixed("keyboard", SourceType::Keyboard, "4dXGRr", "/presets/tex00.jpg"),
    fixed("webcam", SourceType::Webcam, WEBCAM_ID, "/presets/webcam.png"),
    fixed("mic", SourceType::Mic, "XdXGRr", "/presets/mic.png"),
];

/// The id of the webcam.
pub(crate) const WEBCAM_ID: &str = "4sf3zn";

/// The id of Cube A.
pub(crate) const CUBE_A_ID: &str = "4dX3Rr";

/// The end of Cube A's path.
pub(crate) const CUBE_A_FILE: &str = "cubemap00.png";

/// Everything that has a name in `project.toml`.
pub(crate) fn names() -> impl Iterator<Item = Name> {
    let fixed = FIXED.into_iter().map(|fixed| Name {
        source: fixed.name,
        source_type: fixed.source_type,
        id: fixed.id,
        path: fixed.path.to_owned(),
        preview: fixed.path.replace("/media/a/", "/media/ap/"),
    });
    let media = Medium::ALL.iter().map(|medium| Name {
        source: medium.name,
        source_type: medium.source_type,
        id: medium.id,
        path: format!("/media/a/{}", medium.file),
        preview: format!("/media/ap/{}", medium.file),
    });
    fixed.chain(media)
}

/// The name of an image file in the project's folder, if a source names one.
///
/// # Errors
/// If the path leads out of the folder.
pub(crate) fn file_name(source: &str) -> Option<Result<Name, &'static str>> {
    let source_type = file_type(source)?;
    if !is_inside(source) {
        return Some(Err("this path leads out of the project's folder"));
    }
    Some(Ok(Name {
        source: "",
        source_type,
        id: "",
        path: source.to_owned(),
        preview: source.to_owned(),
    }))
}

/// The type of a medium in a file of a format that is read, by its extension.
fn file_type(path: &str) -> Option<SourceType> {
    let (_, extension) = path.rsplit_once('.')?;
    match extension.to_ascii_lowercase().as_str() {
        "png" | "jpg" | "jpeg" | "hdr" | "exr" => Some(SourceType::Texture),
        "gif" | "apng" => Some(SourceType::Video),
        "bin" => Some(SourceType::Volume),
        "wav" | "ogg" => Some(SourceType::Music),
        _ => None,
    }
}

/// Whether a path stays inside the folder that it starts from, on every system.
fn is_inside(path: &str) -> bool {
    let is_plain = |part: &str| !part.is_empty() && part != "." && part != "..";
    path.split('/').all(is_plain) && !path.contains(['\\', ':'])
}

/// The buffer with this id, a string or a number, or with this path.
pub(crate) fn buffer(id: &str, path: &str) -> Option<Buffer> {
    // The numbers of the API: 257 to 260.
    let number = |index: usize| (257 + index).to_string() == id;
    let mut buffers = Buffer::OF_SITE.into_iter().enumerate();
    let named = buffers.find(|&(index, _)| FIXED[index].id == id || number(index));
    named.map(|(_, buffer)| buffer).or_else(|| {
        let file = path
            .rsplit('/')
            .next()?
            .strip_prefix("buffer0")?
            .strip_suffix(".png")?;
        Buffer::OF_SITE.get(file.parse::<usize>().ok()?).copied()
    })
}

/// The id of a buffer of the site.
pub(crate) fn buffer_id(buffer: Buffer) -> &'static str {
    FIXED[buffer.number()].id
}

impl Source {
    /// The built-in medium that is read, if it is one whose name is known.
    #[must_use]
    pub fn medium(&self) -> Option<&'static Medium> {
        match self {
            Self::Medium { id, path, .. } => Medium::find(id, path),
            _ => None,
        }
    }

    /// The path of the file that is read, if it is one in the folder of the project.
    #[must_use]
    pub fn file(&self) -> Option<&str> {
        match self {
            Self::Medium { id, path, .. }
                if id.is_empty() && file_type(path).is_some() && is_inside(path) =>
            {
                Some(path)
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn names_and_ids_are_unique() {
        let all: Vec<_> = names().collect();
        let distinct = |key: fn(&Name) -> String| all.iter().map(key).collect::<HashSet<_>>().len();
        assert_eq!(distinct(|name| name.source.to_lowercase()), all.len());
        assert_eq!(
            distinct(|name| format!("{} {}", name.source_type.name(), name.id)),
            all.len()
        );
        assert_eq!(distinct(|name| name.path.clone()), all.len());
    }

    #[test]
    fn files_stay_inside_of_the_folder() {
        let is_file = |path: &str| file_name(path).map(|name| name.is_ok());
        for inside in ["p.png", "textures/wood.JPG", "a b.exr", "..p.png", "noise.bin"] {
            assert_eq!(is_file(inside), Some(true), "{inside}");
        }
        for outside in [
            "../p.png",
            "/p.png",
            "a/../../p.png",
            "a//p.png",
            "c:p.png",
            "a\\p.png",
            "./p.png",
        ] {
            assert_eq!(is_file(outside), Some(false), "{outside}");
        }
        assert_eq!(
            [is_file("buffer-a"), is_file("wood.tiff"), is_file("png")],
            [None; 3]
        );
    }

    #[test]
    fn buffers_are_known_by_id_by_number_and_by_path() {
        assert_eq!(buffer("4sXGR8", ""), Some(Buffer::C));
        assert_eq!(buffer("257", ""), Some(Buffer::A));
        assert_eq!(buffer("x", "/media/previz/buffer03.png"), Some(Buffer::D));
        assert_eq!(buffer("x", "/media/previz/buffer04.png"), None);
        for buffer in Buffer::OF_SITE {
            assert_eq!(super::buffer(buffer_id(buffer), ""), Some(buffer));
        }
    }
}
