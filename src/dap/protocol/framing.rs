//! The framing of messages: a header with the length, an empty line, and JSON.

use std::io::{self, BufRead, Read, Write};

/// The longest message, in bytes.
const MAX_BYTES: usize = 16 << 20;

/// The longest line of a header, in bytes.
const MAX_HEADER_BYTES: u64 = 4096;

/// Reads the content of the next message; `None` at the end of the input.
///
/// # Errors
/// If the input cannot be read, or a header is malformed, after which no message can be found.
pub(crate) fn read(input: &mut impl BufRead) -> io::Result<Option<Vec<u8>>> {
    let mut length = None;
    let mut is_first = true;
    loop {
        let mut line = Vec::new();
        input
            .by_ref()
            .take(MAX_HEADER_BYTES)
            .read_until(b'\n', &mut line)?;
        if line.is_empty() && is_first {
            return Ok(None);
        }
        if !line.ends_with(b"\n") {
            return Err(malformed("a header of a message does not end"));
        }
        let line = line.trim_ascii();
        if line.is_empty() {
            break;
        }
        is_first = false;
        let colon = line.iter().position(|&byte| byte == b':');
        let Some((name, value)) = colon.map(|at| (&line[..at], line[at + 1..].trim_ascii())) else {
            return Err(malformed("a header of a message has no colon"));
        };
        if name.eq_ignore_ascii_case(b"Content-Length") {
            let value = std::str::from_utf8(value).ok();
            length = value.and_then(|value| value.parse::<usize>().ok());
        }
    }
    let Some(length) = length else {
        return Err(malformed("a message has no valid header `Content-Length`"));
    };
    if length > MAX_BYTES {
        return Err(malformed("a message is longer than 16 MB"));
    }
    let mut content = Vec::new();
    input.by_ref().take(length as u64).read_to_end(&mut content)?;
    if content.len() < length {
        return Err(malformed("the last message is incomplete"));
    }
    Ok(Some(content))
}

fn malformed(message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, message)
}

/// Writes a message with its header.
///
/// # Errors
/// If the output cannot be written.
pub(crate) fn write(output: &mut impl Write, content: &[u8]) -> io::Result<()> {
    write!(output, "Content-Length: {}\r\n\r\n", content.len())?;
    output.write_all(content)?;
    output.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_all(mut input: &[u8]) -> io::Result<Vec<String>> {
        let mut found = Vec::new();
        while let Some(content) = read(&mut input)? {
            found.push(String::from_utf8(content).unwrap());
        }
        Ok(found)
    }

    #[test]
    fn messages_are_read_as_they_are_written() {
        let mut bytes = Vec::new();
        for content in ["{}", "", "{\"a\":\"€\"}"] {
            write(&mut bytes, content.as_bytes()).unwrap();
        }
        assert_eq!(read_all(&bytes).unwrap(), ["{}", "", "{\"a\":\"€\"}"]);
        let other_header = b"content-length:2\nContent-Type: x\r\n\r\n{}";
        assert_eq!(read_all(other_header).unwrap(), ["{}"]);
    }

    #[test]
    fn malformed_headers_are_errors() {
        let inputs: [&[u8]; 6] = [
            b"Content-Length: 3\r\n\r\n{}",
            b"Content-Length: -1\r\n\r\n{}",
            b"Content-Length: 99999999999\r\n\r\n{}",
            b"Length: 2\r\n\r\n{}",
            b"{}\r\n\r\n",
            b"Content-Length: 2",
        ];
        for input in inputs {
            assert!(read_all(input).is_err(), "{}", String::from_utf8_lossy(input));
        }
        assert!(read_all(&[b'x'; 10_000]).is_err());
    }
}
