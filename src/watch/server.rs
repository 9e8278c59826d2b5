//! The server: its port, its token, the paths, and a thread for each connection.

use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use serde::Deserialize;
use serde_json::{Value, json};
use toyproof_gpu::browser;
use toyproof_image::Rgb8Image;
use toyproof_report::page;

use crate::http::{self, Refusal, Request, read_request, respond};
use crate::session::{Event, Failure, Session, Studio};
use crate::view::View;

/// The largest number of connections at once: a tab has one for its events, and few for its requests.
const MAX_CONNECTIONS: usize = 64;
/// The time limit for sending a part of a response.
const WRITE_TIMEOUT: Duration = Duration::from_secs(10);
/// The time after which a comment shows whether a tab without events is still there.
const HEARTBEAT: Duration = Duration::from_secs(5);
/// The time between two looks at new connections and at the flag that ends the server.
const ACCEPT_INTERVAL: Duration = Duration::from_millis(2);

/// The time for which the rest of a refused request is awaited, and the bytes of it that are read.
const LINGER_TIME: Duration = Duration::from_millis(500);
const MAX_LEFT_BYTES: u64 = 1 << 20;

const PAGE: &str = include_str!("page/watch.html");
const STYLE: &str = include_str!("page/watch.css");
const SCRIPT: &str = include_str!("page/watch.js");
/// The place of the report's viewer in the page.
const VIEWER_MARK: &str = "<!-- viewer -->\n";

/// A server that listens on 127.0.0.1.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    port: u16,
    /// 128 random bits, in hexadecimal digits: who knows them may use the page.
    token: String,
}

impl Server {
    /// Listens on a port; 0 for any free one.
    ///
    /// # Errors
    /// Those of the system: the port may be in use.
    pub fn open(port: u16) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        listener.set_nonblocking(true)?;
        let port = listener.local_addr()?.port();
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(io::Error::other)?;
        let token = bytes.map(|byte| format!("{byte:02x}")).concat();
        Ok(Self {
            listener,
            port,
            token,
        })
    }

    /// The address of the page.
    #[must_use]
    pub fn url(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// Serves the page until the flag is set.
    pub fn run(&self, studio: Arc<dyn Studio>, stop: &AtomicBool) {
        let session = Arc::new(Session::new(studio));
        let open = Arc::new(AtomicUsize::new(0));
        thread::scope(|scope| {
            scope.spawn(|| session.follow(stop));
            while !stop.load(Ordering::Relaxed) {
                let Ok((connection, _)) = self.listener.accept() else {
                    thread::sleep(ACCEPT_INTERVAL);
                    continue;
                };
                let Some(slot) = Slot::take(&open) else {
                    // The browser tries again.
                    drop(connection);
                    continue;
                };
                let (session, token, port) = (Arc::clone(&session), self.token.clone(), self.port);
                // Connections do not keep the program from ending.
                thread::spawn(move || {
                    let _slot = slot;
                    // The other side may have gone.
                    let _ = serve(connection, &session, &token, port);
                });
            }
        });
    }
}

/// One of the connections that are open at once.
struct Slot(Arc<AtomicUsize>);

impl Slot {
    fn take(open: &Arc<AtomicUsize>) -> Option<Self> {
        let slot = Self(Arc::clone(open));
        (slot.0.fetch_add(1, Ordering::Relaxed) < MAX_CONNECTIONS).then_some(slot)
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
const JAVASCRIPT: &str = "text/javascript; charset=utf-8";
const JSON: &str = "application/json";
const BYTES: &str = "application/octet-stream";
const TEXT: &str = "text/plain; charset=utf-8";

/// Serves the request of a connection.
fn serve(mut connection: TcpStream, session: &Session, token: &str, port: u16) -> io::Result<()> {
    connection.set_nonblocking(false)?;
    connection.set_nodelay(true)?;
    connection.set_write_timeout(Some(WRITE_TIMEOUT))?;
    let request = match read_request(&mut connection, port) {
        Ok(request) => request,
        Err(refusal) => return refuse(&mut connection, refusal),
    };
    let parts = request
        .path
        .strip_prefix('/')
        .and_then(|path| path.split_once('/'));
    let Some((_, path)) = parts.filter(|(given, _)| *given == token) else {
        return refuse(&mut connection, Refusal::Forbidden);
    };
    if path == "events" && !request.is_post {
        let Some((tab, events)) = session.add_tab() else {
            return refuse(&mut connection, Refusal::Busy);
        };
        let sent = send_events(&mut connection, &events);
        session.remove_tab(tab);
        return sent;
    }
    match answer(path, &request, session) {
        Ok((content_type, body)) => respond(&mut connection, "200 OK", content_type, &body),
        Err(Unanswered::Refused(refusal)) => refuse(&mut connection, refusal),
        Err(Unanswered::Failed(message)) => {
            let body = json!({ "message": message }).to_string();
            respond(
                &mut connection,
                "422 Unprocessable Content",
                JSON,
                body.as_bytes(),
            )
        }
    }
}

fn refuse(connection: &mut TcpStream, refusal: Refusal) -> io::Result<()> {
    let status = refusal.to_string();
    respond(connection, &status, TEXT, format!("{status}\n").as_bytes())?;
    // What is left unread would make the system take the answer back.
    connection.shutdown(Shutdown::Write)?;
    connection.set_read_timeout(Some(LINGER_TIME))?;
    io::copy(&mut connection.take(MAX_LEFT_BYTES), &mut io::sink())?;
    Ok(())
}

/// Why a request has no answer.
enum Unanswered {
    Refused(Refusal),
    Failed(String),
}

impl From<Refusal> for Unanswered {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

impl From<Failure> for Unanswered {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Stopped => Self::Refused(Refusal::Superseded),
            Failure::Failed(message) => Self::Failed(message),
        }
    }
}

/// A pixel of a view.
#[derive(Deserialize)]
struct PixelRequest {
    view: View,
    pixel: [u32; 2],
}

type Answer = (&'static str, Vec<u8>);

/// The answer to a request for a path below the token.
fn answer(path: &str, request: &Request, session: &Session) -> Result<Answer, Unanswered> {
    let file = match path {
        "" => Some((HTML, PAGE.replace(VIEWER_MARK, page::VIEWER))),
        "page.css" => Some((CSS, page::STYLE.to_owned())),
        "watch.css" => Some((CSS, STYLE.to_owned())),
        "components.js" => Some((JAVASCRIPT, page::COMPONENTS.to_owned())),
        "browser.js" => Some((JAVASCRIPT, browser::SCRIPT.to_owned())),
        "watch.js" => Some((JAVASCRIPT, SCRIPT.to_owned())),
        _ => None,
    };
    if let Some((content_type, text)) = file {
        if request.is_post {
            return Err(Refusal::Method.into());
        }
        return Ok((content_type, text.into_bytes()));
    }
    let is_known = ["frame", "reference", "pixel", "browser"].contains(&path);
    match (is_known, request.is_post) {
        (false, _) => return Err(Refusal::UnknownPath.into()),
        (true, false) => return Err(Refusal::Method.into()),
        (true, true) => {}
    }
    let malformed = |_| Refusal::Malformed;
    if path == "pixel" {
        let request: PixelRequest = serde_json::from_slice(&request.body).map_err(malformed)?;
        return Ok((
            JSON,
            session
                .pixel(&request.view, request.pixel)?
                .to_string()
                .into_bytes(),
        ));
    }
    let view: View = serde_json::from_slice(&request.body).map_err(malformed)?;
    Ok(match path {
        "frame" => {
            let (version, rendered) = session.frame(&view)?;
            let head = json!({
                "version": version, "size": rendered.image.size(), "block": rendered.block.to_vec(),
                "firstFrame": rendered.first_frame,
            });
            (BYTES, with_pixels(&head, &rendered.image))
        }
        "reference" => match session.reference(&view)? {
            Some(image) => (BYTES, with_pixels(&json!({ "size": image.size() }), &image)),
            None => (BYTES, b"null\n".to_vec()),
        },
        _ => (JSON, session.browser_job(&view)?.to_string().into_bytes()),
    })
}

/// A line of JSON, and the pixels in RGBA with 8 bits each, the top row first, as canvases have them.
fn with_pixels(head: &Value, image: &Rgb8Image) -> Vec<u8> {
    let mut bytes = format!("{head}\n").into_bytes();
    bytes.reserve(4 * image.pixels().len());
    for row in image.rows().rev() {
        bytes.extend(row.iter().flat_map(|&[r, g, b]| [r, g, b, u8::MAX]));
    }
    bytes
}

/// Sends the events for a tab, until it is closed or dropped.
fn send_events(connection: &mut TcpStream, events: &Receiver<Event>) -> io::Result<()> {
    http::write_head(connection, "200 OK", "text/event-stream", None)?;
    loop {
        match events.recv_timeout(HEARTBEAT) {
            // JSON on one line.
            Ok((name, data)) => write!(connection, "event: {name}\ndata: {data}\n\n")?,
            Err(RecvTimeoutError::Timeout) => connection.write_all(b":\n\n")?,
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
        connection.flush()?;
    }
}
