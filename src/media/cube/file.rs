//! Cube maps from files.

use std::path::{Path, PathBuf};

use toyproof_image::{Image, read};

use crate::error::MediaError;

/// Reads a cube map: six files as the site names them (`name.png`, `name_1.png` to `name_5.png`: +X −X +Y −Y
/// +Z −Z), or one file with all faces as a cross or as a strip.
///
/// In a horizontal cross, −X +Z +X −Z are a row, with +Y above +Z and −Y below it; in a vertical one, −Z is
/// below −Y, upside down. A strip has the order of the files.
///
/// # Errors
/// If a file cannot be read, or the faces are not squares of one size.
pub fn read_cube(path: &Path) -> Result<[Image; 6], MediaError> {
    let files = face_files(path);
    let present = files[1..].iter().filter(|file| file.is_file()).count();
    if present == 0 {
        return split(path, &read(path)?);
    }
    if let Some(missing) = files[1..].iter().find(|file| !file.is_file()) {
        return Err(MediaError::new(missing, "this face of the cube map is missing"));
    }
    let first = read(path)?;
    let [side, height] = first.size();
    let face = |file: &PathBuf| {
        let face = read(file)?;
        let [width, height] = face.size();
        if [width, height] != [side; 2] {
            let problem = format!("this face of a cube map is {width}×{height}, not {side}×{side} pixels");
            return Err(MediaError::new(file, problem));
        }
        Ok(face)
    };
    if height != side {
        let problem = format!("this face of a cube map is {side}×{height} pixels, not a square");
        return Err(MediaError::new(path, problem));
    }
    let [_, a, b, c, d, e] = &files;
    Ok([first, face(a)?, face(b)?, face(c)?, face(d)?, face(e)?])
}

/// The six files of a cube map, of which the first is given.
fn face_files(path: &Path) -> [PathBuf; 6] {
    let stem = path.file_stem().unwrap_or_default();
    std::array::from_fn(|face| {
        if face == 0 {
            return path.to_owned();
        }
        let mut name = stem.to_owned();
        name.push(format!("_{face}"));
        if let Some(extension) = path.extension() {
            name.push(".");
            name.push(extension);
        }
        path.with_file_name(name)
    })
}

/// The faces of one image.
fn split(path: &Path, image: &Image) -> Result<[Image; 6], MediaError> {
    let [width, height] = image.size();
    // Columns and rows of faces, and the place of each face from the top left.
    let layouts: [([u32; 2], [[u32; 2]; 6]); 4] = [
        ([4, 3], [[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [3, 1]]),
        ([3, 4], [[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [1, 3]]),
        ([6, 1], [0, 1, 2, 3, 4, 5].map(|face| [face, 0])),
        ([1, 6], [0, 1, 2, 3, 4, 5].map(|face| [0, face])),
    ];
    let found = layouts.into_iter().find(|([columns, rows], _)| {
        width.is_multiple_of(*columns) && height.is_multiple_of(*rows) && width / columns == height / rows
    });
    let Some(([columns, rows], places)) = found else {
        let problem = format!("an image of {width}×{height} pixels is not a cube map");
        let help = "a cube map is six square files name.png, name_1.png … name_5.png, a cross of 4×3 or 3×4 \
            faces, or a strip";
        return Err(MediaError::new(path, problem).with_help(help));
    };
    let side = width / columns;
    let is_turned = |face: usize| face == 5 && [columns, rows] == [3, 4];
    Ok(std::array::from_fn(|face| {
        let [column, row] = places[face];
        let (left, bottom) = (column * side, (rows - 1 - row) * side);
        let texel = |x: u32, y: u32| {
            let [x, y] = if is_turned(face) {
                [side - 1 - x, side - 1 - y]
            } else {
                [x, y]
            };
            image.get(left + x, bottom + y)
        };
        let pixels = (0..side).flat_map(|y| (0..side).map(move |x| texel(x, y)));
        Image::new(side, side, pixels.collect())
    }))
}

#[cfg(test)]
mod tests {
    use toyproof_image::{encode, output};

    use super::*;

    /// A face of 2×2 texels: its number in red, and a green texel at the lower left.
    fn face(number: usize) -> Image {
        let red = number as f32 / 5.0;
        let texel = |green| [red, green, 0.0, 1.0];
        Image::new(2, 2, vec![texel(1.0), texel(0.0), texel(0.0), texel(0.0)])
    }

    fn write(path: &Path, image: &Image) {
        output::write(path, &encode(image, path).unwrap()).unwrap();
    }

    #[test]
    fn six_files_are_the_faces_in_the_sites_order() {
        let folder = tempfile::tempdir().unwrap();
        let names = ["a.png", "a_1.png", "a_2.png", "a_3.png", "a_4.png", "a_5.png"];
        for (number, name) in names.iter().enumerate() {
            write(&folder.path().join(name), &face(number));
        }
        let first = folder.path().join("a.png");
        assert_eq!(read_cube(&first).unwrap(), std::array::from_fn(face));
        write(&folder.path().join("a_4.png"), &Image::new(1, 1, vec![[0.0; 4]]));
        assert!(
            read_cube(&first)
                .unwrap_err()
                .to_string()
                .contains("is 1×1, not 2×2")
        );
        std::fs::remove_file(folder.path().join("a_4.png")).unwrap();
        let error = read_cube(&first).unwrap_err().to_string();
        assert!(error.contains("a_4.png") && error.contains("missing"), "{error}");
    }

    #[test]
    fn crosses_and_strips_are_split() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        // The number of the face at each place from the top left; a letter for an empty one.
        for layout in [
            &[".2..", "1405", ".3.."][..],
            &[".2.", "140", ".3.", ".5."],
            &["012345"],
            &["0", "1", "2", "3", "4", "5"],
        ] {
            let (columns, rows) = (layout[0].len() as u32, layout.len() as u32);
            let texel = |x: u32, y: u32| {
                let place = layout[(rows - 1 - y / 2) as usize].as_bytes()[(x / 2) as usize];
                let Some(number) = char::from(place).to_digit(10) else {
                    return [0.0; 4];
                };
                let is_turned = number == 5 && rows == 4;
                let [x, y] = if is_turned {
                    [1 - x % 2, 1 - y % 2]
                } else {
                    [x % 2, y % 2]
                };
                face(number as usize).get(x, y)
            };
            let pixels = (0..2 * rows).flat_map(|y| (0..2 * columns).map(move |x| texel(x, y)));
            write(&path, &Image::new(2 * columns, 2 * rows, pixels.collect()));
            assert_eq!(read_cube(&path).unwrap(), std::array::from_fn(face), "{layout:?}");
        }
        write(&path, &face(0));
        let error = read_cube(&path).unwrap_err();
        assert!(error.to_string().contains("2×2 pixels is not a cube map") && error.help().is_some());
    }
}
