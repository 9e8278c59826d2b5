//! Tar archives in the format of POSIX (ustar).

/// The size of a block: a file is a header of one block, and its content in whole blocks.
const BLOCK: usize = 512;

/// Packs files, each with its path, whether it is a program, and its content. The same files give the same
/// bytes, since no times of files are stored.
///
/// # Errors
/// A path is too long for the format.
pub(super) fn pack(files: &[(String, bool, &[u8])]) -> Result<Vec<u8>, String> {
    let mut archive = Vec::new();
    for (path, is_executable, content) in files {
        archive.extend(header(path, *is_executable, content.len())?);
        archive.extend(*content);
        archive.resize(archive.len().next_multiple_of(BLOCK), 0);
    }
    archive.resize(archive.len() + 2 * BLOCK, 0);
    Ok(archive)
}

/// The header of a file.
fn header(path: &str, is_executable: bool, bytes: usize) -> Result<[u8; BLOCK], String> {
    let mut header = [0; BLOCK];
    let mut put = |at: usize, text: &[u8]| header[at..at + text.len()].copy_from_slice(text);
    // The name has 100 bytes, and the folders before it 155 others.
    let splits = path
        .match_indices('/')
        .map(|(at, _)| (&path[..at], &path[at + 1..]));
    let fitting = [("", path)].into_iter().chain(splits);
    let (folders, name) = fitting
        .into_iter()
        .find(|(folders, name)| folders.len() <= 155 && name.len() <= 100)
        .ok_or_else(|| {
            format!("{path} is too long a path for a tar archive\nhelp: shorten the names of its folders")
        })?;
    put(0, name.as_bytes());
    put(100, if is_executable { b"0000755\0" } else { b"0000644\0" });
    put(108, b"0000000\0");
    put(116, b"0000000\0");
    let size = format!("{bytes:011o}\0");
    if size.len() != 12 {
        return Err(format!("{path} is larger than 8 GiB"));
    }
    put(124, size.as_bytes());
    put(136, b"00000000000\0");
    // The sum of all bytes, where its own count as spaces.
    put(148, b"        ");
    put(156, b"0");
    put(257, b"ustar\x0000");
    put(345, folders.as_bytes());
    let sum: u32 = header.iter().map(|&byte| u32::from(byte)).sum();
    header[148..156].copy_from_slice(format!("{sum:06o}\0 ").as_bytes());
    Ok(header)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_paths_are_split_or_rejected() {
        let folder = "a".repeat(90);
        let path = format!("{folder}/{folder}/b.glsl");
        let archive = pack(&[(path.clone(), false, b"void")]).unwrap();
        assert!(archive.starts_with(format!("{folder}/b.glsl\0").as_bytes()));
        assert_eq!(archive[345..345 + 91], *format!("{folder}\0").as_bytes());
        assert_eq!(archive.len(), 4 * BLOCK);
        let error = pack(&[(format!("{path}{}", "b".repeat(100)), true, b"")]).unwrap_err();
        assert!(error.contains("is too long a path"), "{error}");
    }
}
