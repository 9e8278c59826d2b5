//! A folder of the user's copies of the site's media.

use std::path::{Path, PathBuf};

use toyproof_image::Image;

use crate::error::MediaError;

/// What a medium may be called.
#[derive(Debug, Clone, Copy)]
pub struct MediumNames<'a> {
    /// The id in the site's JSON, `4dXGRn`.
    pub id: &'a str,
    /// The name that the site shows, `Rock Tiles`; empty if it is not known.
    pub name: &'a str,
    /// The site's file name: a hash and an extension.
    pub file: &'a str,
}

/// The files of a folder, in which media are found by their names.
#[derive(Debug, Clone)]
pub struct MediaFolder {
    /// In the order of their names.
    files: Vec<PathBuf>,
}

impl MediaFolder {
    /// Lists a folder, without those inside it.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn open(folder: &Path) -> Result<Self, MediaError> {
        let fault =
            |error: std::io::Error| MediaError::new(folder, format!("the folder cannot be read: {error}"));
        let mut files = Vec::new();
        for entry in folder.read_dir().map_err(fault)? {
            let path = entry.map_err(fault)?.path();
            if path.is_file() {
                files.push(path);
            }
        }
        files.sort();
        Ok(Self { files })
    }

    /// The file of a medium: the one with the site's file name in any format, else with its name, else with
    /// its id. In names, only letters and digits count, in any case, and `grey` is `gray`: `rock-tiles.png`
    /// is Rock Tiles. Of several files, the first in alphabetical order is taken.
    ///
    /// Of a cube map, this is the first face, which [`crate::read_cube`] takes.
    pub fn find(&self, names: MediumNames<'_>) -> Option<&Path> {
        let hash = stem(Path::new(names.file));
        let name = significant(names.name);
        let has = |is_it: &dyn Fn(&str) -> bool| self.files.iter().find(|file| is_it(stem(file)));
        let found = has(&|stem| !stem.is_empty() && stem.eq_ignore_ascii_case(hash))
            .or_else(|| has(&|stem| !name.is_empty() && significant(stem) == name))
            .or_else(|| has(&|stem| !stem.is_empty() && stem == names.id));
        found.map(PathBuf::as_path)
    }

    /// The files that are not any of these media's, such as misspelled ones; faces of cube maps after the
    /// first count as those of the first.
    pub fn unused<'a>(&'a self, media: &'a [MediumNames<'a>]) -> impl Iterator<Item = &'a Path> {
        let used: Vec<_> = media.iter().filter_map(|&names| self.find(names)).collect();
        let is_face = move |file: &Path| {
            let Some((first, number)) = stem(file).rsplit_once('_') else {
                return false;
            };
            matches!(number, "1" | "2" | "3" | "4" | "5") && used.iter().any(|path| stem(path) == first)
        };
        let used: Vec<_> = media.iter().filter_map(|&names| self.find(names)).collect();
        let files = self.files.iter().map(PathBuf::as_path);
        files.filter(move |file| !used.contains(file) && !is_face(file))
    }
}

/// The file name without its extension.
fn stem(path: &Path) -> &str {
    path.file_stem()
        .and_then(|stem| stem.to_str())
        .unwrap_or_default()
}

/// What counts in a name.
fn significant(name: &str) -> String {
    let letters = name.chars().filter(|c| c.is_alphanumeric());
    letters
        .flat_map(char::to_lowercase)
        .collect::<String>()
        .replace("grey", "gray")
}

/// An image with as many components as its medium has on the site: one of 1 component reads as (r, 0, 0, 1),
/// and one of 3 is opaque.
#[must_use]
pub fn with_components(image: &Image, components: u8) -> Image {
    let [width, height] = image.size();
    let texel = |&[r, g, b, a]: &[f32; 4]| match components {
        1 => [r, 0.0, 0.0, 1.0],
        2 => [r, g, 0.0, 1.0],
        3 => [r, g, b, 1.0],
        _ => [r, g, b, a],
    };
    Image::new(width, height, image.pixels().iter().map(texel).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROCK: MediumNames<'static> = MediumNames {
        id: "4dXGRn",
        name: "Rock Tiles",
        file: "10eb4fe0ac8a7dc3.jpg",
    };
    const BASILICA: MediumNames<'static> = MediumNames {
        id: "XdX3zn",
        name: "St. Peter's Basilica",
        file: "488bd40303a2e2b9.jpg",
    };

    fn folder(names: &[&str]) -> (tempfile::TempDir, MediaFolder) {
        let folder = tempfile::tempdir().unwrap();
        for name in names {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let media = MediaFolder::open(folder.path()).unwrap();
        (folder, media)
    }

    fn found(media: &MediaFolder, names: MediumNames<'_>) -> Option<String> {
        let path = media.find(names)?;
        Some(path.file_name()?.to_str()?.to_owned())
    }

    #[test]
    fn media_are_found_by_hash_by_name_and_by_id() {
        for name in [
            "10eb4fe0ac8a7dc3.jpg",
            "10EB4FE0AC8A7DC3.png",
            "RockTiles.jpeg",
            "rock_tiles.JPG",
            "rock tiles",
            "4dXGRn.png",
        ] {
            let (_folder, media) = folder(&["a.png", name, "z.png"]);
            assert_eq!(found(&media, ROCK).as_deref(), Some(name));
            assert_eq!(found(&media, BASILICA), None);
        }
        let (_folder, media) = folder(&["4dXGRn.png", "Rock Tiles.png", "4dxgrN.jpg"]);
        assert_eq!(
            found(&media, ROCK).as_deref(),
            Some("Rock Tiles.png"),
            "the name precedes the id"
        );
        let gray = MediumNames {
            id: "4sfGRr",
            name: "Grey Noise3D",
            file: "27012b4eadd0.bin",
        };
        let (_folder, media) = folder(&["GrayNoise3D.bin"]);
        assert_eq!(found(&media, gray).as_deref(), Some("GrayNoise3D.bin"));
    }

    #[test]
    fn media_without_a_name_are_not_those_of_files_without_one() {
        let nameless = MediumNames {
            id: "",
            name: "",
            file: "",
        };
        let (_folder, media) = folder(&["---.png", "x.png"]);
        assert_eq!(found(&media, nameless), None);
    }

    #[test]
    fn files_that_are_no_medium_are_listed() {
        let names = [
            "St Peters Basilica.jpg",
            "St Peters Basilica_1.jpg",
            "St Peters Basilica_5.jpg",
            "rok tiles.png",
            "a_1.png",
        ];
        let (_folder, media) = folder(&names);
        let known = [ROCK, BASILICA];
        let unused: Vec<_> = media.unused(&known).map(stem).collect();
        assert_eq!(unused, ["a_1", "rok tiles"]);
        assert!(MediaFolder::open(Path::new("/nonexistent")).is_err());
    }

    #[test]
    fn media_of_fewer_components_read_as_on_the_site() {
        let image = Image::new(1, 1, vec![[0.2, 0.4, 0.6, 0.8]]);
        let read = |components| with_components(&image, components).get(0, 0);
        assert_eq!(read(1), [0.2, 0.0, 0.0, 1.0]);
        assert_eq!(read(3), [0.2, 0.4, 0.6, 1.0]);
        assert_eq!(read(4), [0.2, 0.4, 0.6, 0.8]);
    }
}
