//! Zip archives, as PKWARE's APPNOTE 6.3.10 describes them: read from untrusted sources, and written for
//! autograders.

use std::io::{self, Read, Seek, SeekFrom, Write};

use flate2::read::DeflateDecoder;
use flate2::write::DeflateEncoder;
use flate2::{Compression, Crc};
use toyproof_diagnostic::Date;

const LOCAL_HEADER: u32 = 0x0403_4b50;
const CENTRAL_HEADER: u32 = 0x0201_4b50;
const END: u32 = 0x0605_4b50;
const END_64: u32 = 0x0606_4b50;
const END_64_LOCATOR: u32 = 0x0706_4b50;

const END_BYTES: u64 = 22;
const END_64_LOCATOR_BYTES: u64 = 20;
/// The longest comment of an archive.
const MAX_COMMENT: u64 = 0xffff;
/// The largest directory that is read: about a million files. It is held in memory.
const MAX_DIRECTORY: u64 = 128 << 20;

/// The field of sizes and offsets above 4 GiB.
const LARGE_FIELD: u16 = 1;
/// The field of times in UTC, which Info-ZIP defines.
const TIME_FIELD: u16 = 0x5455;

const STORED: u16 = 0;
const DEFLATED: u16 = 8;
const ENCRYPTED: u16 = 1;
const UTF8: u16 = 1 << 11;

/// When a file was last changed, in seconds since 1970-01-01 00:00.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileTime {
    /// In UTC.
    Utc(i64),
    /// In the time zone of the machine that wrote the archive, to two seconds.
    Local(i64),
}

/// A file of an archive.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The path in the archive, with `/` between components. It may be hostile.
    pub name: String,
    /// When it was last changed; `None` if the archive does not state it.
    pub modified: Option<FileTime>,
    flags: u16,
    method: u16,
    crc: u32,
    compressed: u64,
    offset: u64,
}

/// An archive.
#[derive(Debug)]
pub struct Archive<R> {
    input: R,
    entries: Vec<Entry>,
    /// The number of files and folders that the archive's directory names, as far as it was read.
    count: usize,
    /// Whether the directory names more files and folders than were read.
    is_cut: bool,
}

fn broken(problem: &str) -> io::Error {
    io::Error::new(
        io::ErrorKind::InvalidData,
        format!("not a valid zip archive: {problem}"),
    )
}

/// Reads little-endian numbers one after the other.
struct Fields<'a>(&'a [u8]);

impl<'a> Fields<'a> {
    fn bytes(&mut self, count: usize) -> io::Result<&'a [u8]> {
        let (bytes, rest) = self
            .0
            .split_at_checked(count)
            .ok_or_else(|| broken("it is truncated"))?;
        self.0 = rest;
        Ok(bytes)
    }

    fn number(&mut self, bytes: usize) -> io::Result<u64> {
        let bytes = self.bytes(bytes)?.iter().rev();
        Ok(bytes.fold(0, |number, &byte| number << 8 | u64::from(byte)))
    }

    fn u16(&mut self) -> io::Result<u16> {
        Ok(self.number(2)? as u16)
    }

    fn u32(&mut self) -> io::Result<u32> {
        Ok(self.number(4)? as u32)
    }
}

impl<R: Read + Seek> Archive<R> {
    /// Reads the directory, but at most `max_entries` files and folders of it.
    ///
    /// # Errors
    /// Those of the input, or that it is not an archive.
    pub fn open(input: R, max_entries: usize) -> io::Result<Self> {
        Self::read_directory(input, max_entries).map_err(|error| match error.kind() {
            // A damaged archive names places outside of it.
            io::ErrorKind::UnexpectedEof | io::ErrorKind::InvalidInput => broken("it is truncated"),
            _ => error,
        })
    }

    fn read_directory(mut input: R, max_entries: usize) -> io::Result<Self> {
        let (offset, bytes) = find_directory(&mut input)?;
        if bytes > MAX_DIRECTORY {
            return Err(broken("its directory is too large"));
        }
        input.seek(SeekFrom::Start(offset))?;
        let mut directory = Vec::new();
        input.by_ref().take(bytes).read_to_end(&mut directory)?;
        if (directory.len() as u64) < bytes {
            return Err(broken("it is truncated"));
        }
        let mut fields = Fields(&directory);
        let mut entries = Vec::new();
        let mut count = 0;
        while !fields.0.is_empty() && count < max_entries {
            entries.extend(read_entry(&mut fields)?);
            count += 1;
        }
        Ok(Self {
            input,
            entries,
            count,
            is_cut: !fields.0.is_empty(),
        })
    }

    /// Removes and returns the files, without folders, in the order of the directory.
    pub fn take_entries(&mut self) -> Vec<Entry> {
        std::mem::take(&mut self.entries)
    }

    /// The number of files and folders that were read from the directory.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether the directory names more files and folders.
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// Unpacks a file, but at most `limit` bytes and one more.
    ///
    /// # Errors
    /// The file is damaged, encrypted, or compressed in another way than by *deflate*.
    pub fn read(&mut self, entry: &Entry, limit: u64) -> io::Result<Vec<u8>> {
        if entry.flags & ENCRYPTED != 0 {
            return Err(io::Error::other("it is encrypted"));
        }
        self.input.seek(SeekFrom::Start(entry.offset))?;
        let mut header = [0; 30];
        self.input.read_exact(&mut header)?;
        let mut fields = Fields(&header);
        if fields.u32()? != LOCAL_HEADER {
            return Err(broken("a file is not where its directory says"));
        }
        fields.bytes(22)?;
        let names = i64::from(fields.u16()?) + i64::from(fields.u16()?);
        self.input.seek(SeekFrom::Current(names))?;
        let packed = self.input.by_ref().take(entry.compressed);
        let mut bytes = Vec::new();
        match entry.method {
            STORED => packed.take(limit + 1).read_to_end(&mut bytes)?,
            DEFLATED => DeflateDecoder::new(packed)
                .take(limit + 1)
                .read_to_end(&mut bytes)?,
            method => {
                return Err(io::Error::other(format!(
                    "its compression, method {method}, is not supported"
                )));
            }
        };
        if bytes.len() as u64 <= limit && checksum(&bytes) != entry.crc {
            return Err(broken("a file has another checksum than its content"));
        }
        Ok(bytes)
    }
}

/// The offset and the size of the directory.
fn find_directory(input: &mut (impl Read + Seek)) -> io::Result<(u64, u64)> {
    let length = input.seek(SeekFrom::End(0))?;
    let tail_at = length.saturating_sub(END_64_LOCATOR_BYTES + END_BYTES + MAX_COMMENT);
    input.seek(SeekFrom::Start(tail_at))?;
    let mut tail = Vec::new();
    input.by_ref().take(length - tail_at).read_to_end(&mut tail)?;
    let end = tail.windows(4).rposition(|bytes| bytes == END.to_le_bytes());
    let end = end.ok_or_else(|| broken("it has no directory"))?;
    let mut fields = Fields(&tail[end + 4..]);
    fields.bytes(8)?;
    let (bytes, offset) = (fields.number(4)?, fields.number(4)?);
    fields.bytes(2)?;
    if offset != u64::from(u32::MAX) && bytes != u64::from(u32::MAX) {
        return Ok((offset, bytes));
    }
    let locator = end
        .checked_sub(END_64_LOCATOR_BYTES as usize)
        .ok_or_else(|| broken("it is truncated"))?;
    let mut fields = Fields(&tail[locator..]);
    if fields.u32()? != END_64_LOCATOR {
        return Err(broken("it has no directory of large files"));
    }
    fields.bytes(4)?;
    input.seek(SeekFrom::Start(fields.number(8)?))?;
    let mut end = [0; 56];
    input.read_exact(&mut end)?;
    let mut fields = Fields(&end);
    if fields.u32()? != END_64 {
        return Err(broken("it has no directory of large files"));
    }
    fields.bytes(36)?;
    let (bytes, offset) = (fields.number(8)?, fields.number(8)?);
    Ok((offset, bytes))
}

/// Reads an entry of the directory; `None` if it is a folder.
fn read_entry(fields: &mut Fields) -> io::Result<Option<Entry>> {
    if fields.u32()? != CENTRAL_HEADER {
        return Err(broken("its directory is damaged"));
    }
    fields.bytes(4)?;
    let (flags, method) = (fields.u16()?, fields.u16()?);
    let (time, date) = (fields.u16()?, fields.u16()?);
    let mut modified = dos_time(date, time).map(FileTime::Local);
    let crc = fields.u32()?;
    let (mut compressed, mut size) = (fields.number(4)?, fields.number(4)?);
    let [name, extra, comment] = [fields.u16()?, fields.u16()?, fields.u16()?].map(usize::from);
    fields.bytes(8)?;
    let mut offset = fields.number(4)?;
    let name = fields.bytes(name)?;
    let mut extra = Fields(fields.bytes(extra)?);
    fields.bytes(comment)?;
    while extra.0.len() >= 4 {
        let (id, length) = (extra.u16()?, extra.u16()?);
        let mut field = Fields(extra.bytes(usize::from(length).min(extra.0.len()))?);
        if id == LARGE_FIELD {
            for number in [&mut size, &mut compressed, &mut offset] {
                if *number == u64::from(u32::MAX) {
                    *number = field.number(8)?;
                }
            }
        } else if id == TIME_FIELD && field.0.len() >= 5 && field.number(1)? & 1 == 1 {
            modified = Some(FileTime::Utc(i64::from(field.u32()? as i32)));
        }
    }
    let name = decode_name(name, flags & UTF8 != 0);
    Ok((!name.ends_with(['/', '\\'])).then_some(Entry {
        name: name.replace('\\', "/"),
        modified,
        flags,
        method,
        crc,
        compressed,
        offset,
    }))
}

/// The seconds since 1970 of a date and a time of DOS; `None` for one that does not exist, and for the first
/// moment of the format, which means that the time is unknown.
fn dos_time(date: u16, time: u16) -> Option<i64> {
    const NONE: [u16; 2] = [0x21, 0];
    let part = |from: u16, at: u16, bits: u16| i64::from(from >> at & ((1 << bits) - 1));
    let day = Date {
        year: 1980 + part(date, 9, 7),
        month: part(date, 5, 4),
        day: part(date, 0, 5),
    };
    let (hour, minute, second) = (part(time, 11, 5), part(time, 5, 6), 2 * part(time, 0, 5));
    let exists = (1..=12).contains(&day.month) && day.day >= 1 && hour < 24 && minute < 60 && second < 60;
    (exists && [date, time] != NONE)
        .then(|| 86_400 * day.days_since_1970() + 3600 * hour + 60 * minute + second)
}

/// The characters of code page 437 from 128.
const CODE_PAGE_437: &str = "ÇüéâäàåçêëèïîìÄÅÉæÆôöòûùÿÖÜ¢£¥₧ƒáíóúñÑªº¿⌐¬½¼¡«»░▒▓│┤╡╢╖╕╣║╗╝╜╛┐└┴┬├─┼╞╟╚╔╩╦╠═╬╧╨╤╥╙╘╒╓╫╪┘┌█▄▌▐▀αßΓπΣσµτΦΘΩδ∞φε∩≡±≥≤⌠⌡÷≈°∙·√ⁿ²■\u{a0}";

/// Decodes a name. Archives of macOS have UTF-8 without the flag; those of old Windows programs have code
/// page 437.
fn decode_name(bytes: &[u8], is_utf8: bool) -> String {
    match std::str::from_utf8(bytes) {
        Ok(name) => name.to_owned(),
        Err(_) if is_utf8 => String::from_utf8_lossy(bytes).into_owned(),
        Err(_) => {
            let upper: Vec<char> = CODE_PAGE_437.chars().collect();
            let character = |&byte: &u8| match byte.checked_sub(128) {
                Some(at) => upper[usize::from(at)],
                None => char::from(byte),
            };
            bytes.iter().map(character).collect()
        }
    }
}

fn checksum(bytes: &[u8]) -> u32 {
    let mut crc = Crc::new();
    crc.update(bytes);
    crc.sum()
}

/// Whether a file of an archive can be run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// A plain file.
    Plain,
    /// A program.
    Executable,
}

impl Mode {
    /// The bits of Unix: a regular file and its permissions.
    fn bits(self) -> u32 {
        match self {
            Self::Plain => 0o100_644,
            Self::Executable => 0o100_755,
        }
    }
}

/// Packs files, each with its path. The same files give the same bytes, since no times of files are stored.
///
/// # Errors
/// If a file is too large for the format.
pub fn pack(files: &[(&str, Mode, &[u8])]) -> io::Result<Vec<u8>> {
    /// 1980-01-01, the first day of the format, in the order of time and date.
    const NO_TIME: [u8; 4] = [0, 0, 0x21, 0];
    /// Version 2.0, of Unix, so that permissions count.
    const MADE_BY: u16 = 3 * 256 + 20;
    let large = |_| io::Error::other("the archive is larger than 4 GiB");
    let mut archive = Vec::new();
    let mut directory = Vec::new();
    for (name, mode, bytes) in files {
        let offset = u32::try_from(archive.len()).map_err(large)?;
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(bytes)?;
        let packed = encoder.finish()?;
        let mut common = Vec::new();
        for number in [20, UTF8, DEFLATED] {
            common.extend(number.to_le_bytes());
        }
        common.extend(NO_TIME);
        common.extend(checksum(bytes).to_le_bytes());
        for length in [packed.len(), bytes.len()] {
            common.extend(u32::try_from(length).map_err(large)?.to_le_bytes());
        }
        let name_length = u16::try_from(name.len()).map_err(|_| io::Error::other("a name is too long"))?;
        common.extend(name_length.to_le_bytes());
        common.extend([0; 2]);
        archive.extend(LOCAL_HEADER.to_le_bytes());
        archive.extend(&common);
        archive.extend(name.as_bytes());
        archive.extend(packed);
        directory.extend(CENTRAL_HEADER.to_le_bytes());
        directory.extend(MADE_BY.to_le_bytes());
        directory.extend(common);
        directory.extend([0; 6]);
        directory.extend((mode.bits() << 16).to_le_bytes());
        directory.extend(offset.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let offset = u32::try_from(archive.len()).map_err(large)?;
    let count = u16::try_from(files.len()).map_err(|_| io::Error::other("too many files"))?;
    archive.extend(&directory);
    archive.extend(END.to_le_bytes());
    archive.extend([0; 4]);
    archive.extend([count, count].map(u16::to_le_bytes).as_flattened());
    archive.extend(u32::try_from(directory.len()).map_err(large)?.to_le_bytes());
    archive.extend(offset.to_le_bytes());
    archive.extend([0; 2]);
    Ok(archive)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn files() -> Vec<u8> {
        let long = "a".repeat(10_000);
        pack(&[
            ("a.glsl", Mode::Plain, b"void"),
            ("ä/run", Mode::Executable, long.as_bytes()),
        ])
        .unwrap()
    }

    #[test]
    fn what_is_packed_is_unpacked() {
        let bytes = files();
        assert!(bytes.len() < 1000, "{}", bytes.len());
        let mut archive = Archive::open(Cursor::new(bytes), 9).unwrap();
        assert_eq!((archive.count(), archive.is_cut()), (2, false));
        let entries = archive.take_entries();
        let names: Vec<_> = entries.iter().map(|entry| entry.name.as_str()).collect();
        assert_eq!(names, ["a.glsl", "ä/run"]);
        assert_eq!(archive.read(&entries[0], 100).unwrap(), b"void");
        assert_eq!(
            archive.read(&entries[1], 10_000).unwrap(),
            "a".repeat(10_000).as_bytes()
        );
        assert_eq!(
            archive.read(&entries[1], 100).unwrap().len(),
            101,
            "more is not unpacked"
        );
        let mut cut = Archive::open(Cursor::new(files()), 1).unwrap();
        assert_eq!((cut.take_entries().len(), cut.is_cut()), (1, true));
    }

    #[test]
    fn times_of_dos_are_local() {
        // 2026-03-01 23:59:58.
        let (date, time) = ((46 << 9) + (3 << 5) + 1, (23 << 11) + (59 << 5) + 29);
        assert_eq!(dos_time(date, time), Some(1_772_409_598));
        for (date, time) in [
            (0x21, 0),
            (0, 0),
            ((46 << 9) + (13 << 5) + 1, 0),
            (date, 25 << 11),
        ] {
            assert_eq!(dos_time(date, time), None, "{date:x} {time:x}");
        }
    }

    #[test]
    fn names_of_old_programs_are_of_code_page_437() {
        assert_eq!(decode_name(b"M\x81ller/a.glsl", false), "Müller/a.glsl");
        assert_eq!(decode_name("Müller".as_bytes(), false), "Müller");
        assert_eq!(CODE_PAGE_437.chars().count(), 128);
    }

    /// Every truncation and every changed byte gives an error, or other files, but neither a panic nor a
    /// large allocation.
    #[test]
    fn damaged_archives_are_errors() {
        let bytes = files();
        let unpack = |bytes: Vec<u8>| -> io::Result<()> {
            let mut archive = Archive::open(Cursor::new(bytes), 9)?;
            for entry in archive.take_entries() {
                archive.read(&entry, 20_000)?;
            }
            Ok(())
        };
        for length in 0..bytes.len() {
            assert!(unpack(bytes[..length].to_vec()).is_err(), "{length}");
        }
        for at in 0..bytes.len() {
            for bit in 0..8 {
                let mut damaged = bytes.clone();
                damaged[at] ^= 1 << bit;
                let _ = unpack(damaged);
            }
        }
    }
}
