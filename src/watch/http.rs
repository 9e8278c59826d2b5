//! The part of HTTP/1.1 that the page needs: requests with small heads and bodies, one for each connection.
//!
//! The heads are parsed by `httparse`. A larger library would bring a pool of threads and no limits of sizes;
//! this server has few paths, and a stream of events in the middle of it.

use std::io::{self, Read, Write};
use std::time::{Duration, Instant};

use thiserror::Error;

/// The largest head of a request, in bytes: a browser's has less than 2 KiB.
const MAX_HEAD_BYTES: usize = 8 << 10;
/// The largest number of headers; a browser sends about 20.
const MAX_HEADERS: usize = 64;
/// The largest body, in bytes: a view is shorter than 1 KiB without its uniforms.
const MAX_BODY_BYTES: usize = 64 << 10;
/// The time limit for reading a request.
const READ_TIMEOUT: Duration = Duration::from_secs(10);

/// A request of the page.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Request {
    pub(crate) is_post: bool,
    /// The path, without what follows a `?`.
    pub(crate) path: String,
    pub(crate) body: Vec<u8>,
}

/// Why a request is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub(crate) enum Refusal {
    #[error("400 Bad Request")]
    Malformed,
    /// The token, the host or the origin is wrong.
    #[error("403 Forbidden")]
    Forbidden,
    #[error("404 Not Found")]
    UnknownPath,
    #[error("405 Method Not Allowed")]
    Method,
    #[error("408 Request Timeout")]
    Late,
    /// The shader changed in the meantime, or there is none yet.
    #[error("409 Conflict")]
    Superseded,
    #[error("411 Length Required")]
    NoLength,
    #[error("413 Content Too Large")]
    LargeBody,
    #[error("431 Request Header Fields Too Large")]
    LargeHead,
    #[error("503 Service Unavailable")]
    Busy,
}

/// A connection, from which a request is read by a deadline.
pub(crate) trait Connection: Read + Write {
    /// Limits the time of the next reads.
    fn limit_reads(&self, limit: Duration) -> io::Result<()>;
}

impl Connection for std::net::TcpStream {
    fn limit_reads(&self, limit: Duration) -> io::Result<()> {
        self.set_read_timeout(Some(limit))
    }
}

/// Reads the request of a connection to a server on this port.
pub(crate) fn read_request(connection: &mut impl Connection, port: u16) -> Result<Request, Refusal> {
    let end = Instant::now() + READ_TIMEOUT;
    let mut bytes = Vec::new();
    let (mut request, length, head) = loop {
        read_more(connection, &mut bytes, end)?;
        if let Some(parsed) = parse_head(&bytes, port)? {
            break parsed;
        }
    };
    if length > MAX_BODY_BYTES {
        return Err(Refusal::LargeBody);
    }
    while bytes.len() < head + length {
        read_more(connection, &mut bytes, end)?;
    }
    request.body = bytes[head..head + length].to_vec();
    Ok(request)
}

fn read_more(connection: &mut impl Connection, bytes: &mut Vec<u8>, end: Instant) -> Result<(), Refusal> {
    let left = end.saturating_duration_since(Instant::now());
    if left.is_zero() {
        return Err(Refusal::Late);
    }
    let mut part = [0; 4096];
    let count = connection
        .limit_reads(left)
        .and_then(|()| connection.read(&mut part))
        .map_err(|_| Refusal::Late)?;
    if count == 0 {
        return Err(Refusal::Malformed);
    }
    bytes.extend_from_slice(&part[..count]);
    Ok(())
}

/// Parses a head; returns the request without its body, the length of that, and that of the head. `None` if
/// the head is incomplete.
fn parse_head(bytes: &[u8], port: u16) -> Result<Option<(Request, usize, usize)>, Refusal> {
    let mut headers = [httparse::EMPTY_HEADER; MAX_HEADERS];
    let mut parsed = httparse::Request::new(&mut headers);
    let status = parsed.parse(&bytes[..bytes.len().min(MAX_HEAD_BYTES)]);
    let head = match status {
        Ok(httparse::Status::Complete(head)) => head,
        Ok(httparse::Status::Partial) if bytes.len() < MAX_HEAD_BYTES => return Ok(None),
        Ok(httparse::Status::Partial) | Err(httparse::Error::TooManyHeaders) => {
            return Err(Refusal::LargeHead);
        }
        Err(_) => return Err(Refusal::Malformed),
    };
    let one = |name: &str| {
        let mut values = parsed
            .headers
            .iter()
            .filter(|header| header.name.eq_ignore_ascii_case(name));
        let first = values.next().map(|header| header.value);
        // Two values of a header that is checked could be read in two ways.
        match values.next() {
            None => Ok(first),
            Some(_) => Err(Refusal::Malformed),
        }
    };
    check_source(one("host")?, one("origin")?, port)?;
    let is_post = match parsed.method {
        Some("GET") => false,
        Some("POST") => true,
        _ => return Err(Refusal::Method),
    };
    if one("transfer-encoding")?.is_some() {
        return Err(Refusal::NoLength);
    }
    let length = match one("content-length")? {
        Some(text) => {
            let digits = std::str::from_utf8(text).ok();
            let digits = digits.filter(|digits| digits.bytes().all(|digit| digit.is_ascii_digit()));
            // A number that is too long for the type is also too long for the body.
            digits.ok_or(Refusal::Malformed)?.parse().unwrap_or(usize::MAX)
        }
        None if is_post => return Err(Refusal::NoLength),
        None => 0,
    };
    let target = parsed.path.unwrap_or_default();
    let request = Request {
        is_post,
        path: target.split('?').next().unwrap_or_default().to_owned(),
        body: Vec::new(),
    };
    Ok(Some((request, length, head)))
}

/// Checks that the request is one to this server by its own name, so that no name of another's domain leads
/// here, and that it comes from the page itself, or from no page.
fn check_source(host: Option<&[u8]>, origin: Option<&[u8]>, port: u16) -> Result<(), Refusal> {
    let names = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}"));
    let is_own = |text: &[u8]| names.iter().any(|name| name.as_bytes() == text);
    let is_own_origin = |origin: &[u8]| origin.strip_prefix(b"http://").is_some_and(is_own);
    if host.is_some_and(is_own) && origin.is_none_or(is_own_origin) {
        Ok(())
    } else {
        Err(Refusal::Forbidden)
    }
}

/// The content security policy: the page's own files, and images that it makes. The page may be in a frame,
/// as editors show it: who knows its address has the token.
const POLICY: &str = "default-src 'none'; base-uri 'none'; form-action 'none'; script-src 'self'; style-src 'self'; \
                      img-src 'self' data: blob:; connect-src 'self'";

/// Writes the head of a response. Without a length, the body ends with the connection.
pub(crate) fn write_head(
    out: &mut impl Write,
    status: &str,
    content_type: &str,
    length: Option<usize>,
) -> io::Result<()> {
    let length = length.map_or_else(String::new, |length| format!("Content-Length: {length}\r\n"));
    // The address has the token, so no other page may see it.
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {content_type}\r\n{length}Connection: close\r\nCache-Control: no-store\r\n\
         Content-Security-Policy: {POLICY}\r\nReferrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\n\
         Cross-Origin-Resource-Policy: same-origin\r\n\r\n"
    );
    out.write_all(head.as_bytes())
}

/// Writes a whole response.
pub(crate) fn respond(out: &mut impl Write, status: &str, content_type: &str, body: &[u8]) -> io::Result<()> {
    write_head(out, status, content_type, Some(body.len()))?;
    out.write_all(body)?;
    out.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A connection whose other side sends a text in parts of some bytes.
    struct Sent<'a>(&'a [u8], usize);

    impl Read for Sent<'_> {
        fn read(&mut self, part: &mut [u8]) -> io::Result<usize> {
            let count = self.1.min(self.0.len()).min(part.len());
            part[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    impl Write for Sent<'_> {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Connection for Sent<'_> {
        fn limit_reads(&self, _: Duration) -> io::Result<()> {
            Ok(())
        }
    }

    fn read(text: &str) -> Result<Request, Refusal> {
        let whole = read_request(&mut Sent(text.as_bytes(), usize::MAX), 80);
        assert_eq!(read_request(&mut Sent(text.as_bytes(), 7), 80), whole, "{text}");
        whole
    }

    const HOST: &str = "Host: 127.0.0.1:80\r\n";

    #[test]
    fn a_request_has_a_path_and_a_body() {
        let get = read(&format!("GET /a/b?c HTTP/1.1\r\n{HOST}\r\n")).unwrap();
        assert_eq!((get.is_post, get.path.as_str()), (false, "/a/b"));
        let own = "Origin: http://127.0.0.1:80\r\n";
        let post = read(&format!(
            "POST /a HTTP/1.1\r\n{HOST}{own}Content-Length: 2\r\n\r\n{{}}more"
        ))
        .unwrap();
        assert_eq!((post.is_post, &post.body[..]), (true, &b"{}"[..]));
    }

    #[test]
    fn other_hosts_and_origins_are_refused() {
        for head in [
            "",
            "Host: 127.0.0.1\r\n",
            "Host: 127.0.0.1:81\r\n",
            "Host: evil.example:80\r\n",
            "Host: 127.0.0.1:80\r\nOrigin: http://evil.example\r\n",
            "Host: 127.0.0.1:80\r\nOrigin: null\r\n",
            "Host: 127.0.0.1:80\r\nOrigin: https://127.0.0.1:80\r\n",
            "Host: 127.0.0.1:80\r\nOrigin: http://127.0.0.1:8080\r\n",
        ] {
            let answer = read(&format!("GET / HTTP/1.1\r\n{head}\r\n"));
            assert_eq!(answer, Err(Refusal::Forbidden), "{head}");
        }
        let twice = read(&format!("GET / HTTP/1.1\r\n{HOST}{HOST}\r\n"));
        assert_eq!(twice, Err(Refusal::Malformed));
        assert!(read("GET / HTTP/1.1\r\nHost: localhost:80\r\nOrigin: http://localhost:80\r\n\r\n").is_ok());
    }

    #[test]
    fn sizes_are_limited() {
        let long = "a".repeat(MAX_HEAD_BYTES);
        for head in [
            format!("GET /{long}"),
            format!("GET / HTTP/1.1\r\n{HOST}X: {long}\r\n\r\n"),
        ] {
            assert_eq!(read(&head), Err(Refusal::LargeHead));
        }
        let many = "X: y\r\n".repeat(MAX_HEADERS + 1);
        assert_eq!(
            read(&format!("GET / HTTP/1.1\r\n{HOST}{many}\r\n")),
            Err(Refusal::LargeHead)
        );
        let large = [&(MAX_BODY_BYTES + 1).to_string(), "99999999999999999999999"].map(str::to_owned);
        for length in large {
            let post = format!("POST / HTTP/1.1\r\n{HOST}Content-Length: {length}\r\n\r\n");
            assert_eq!(read(&post), Err(Refusal::LargeBody));
        }
    }

    #[test]
    fn what_is_no_request_is_refused() {
        let post = |headers: &str| read(&format!("POST / HTTP/1.1\r\n{HOST}{headers}\r\n"));
        assert_eq!(post(""), Err(Refusal::NoLength));
        assert_eq!(
            post("Content-Length: 0\r\nTransfer-Encoding: chunked\r\n"),
            Err(Refusal::NoLength)
        );
        assert_eq!(post("Content-Length: -1\r\n"), Err(Refusal::Malformed));
        assert_eq!(post("Content-Length: +1\r\n"), Err(Refusal::Malformed));
        assert_eq!(
            post("Content-Length: 4\r\n"),
            Err(Refusal::Malformed),
            "the body is missing"
        );
        assert_eq!(
            read(&format!("PUT / HTTP/1.1\r\n{HOST}\r\n")),
            Err(Refusal::Method)
        );
        for text in ["", "GET", "\0\0\0", "GET / HTTP/9\r\n\r\n"] {
            assert_eq!(read(text), Err(Refusal::Malformed), "{text:?}");
        }
    }
}
