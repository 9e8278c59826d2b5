//! Reads messages in a thread of its own, so that a request can be canceled while it is being handled.

use std::collections::VecDeque;
use std::io::{self, BufRead, BufReader, Read};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};

use crate::protocol::framing;
use crate::protocol::request::Message;

/// The largest number of messages that wait to be handled.
const MAX_WAITING: usize = 1024;

/// What interrupts the work on a request.
#[derive(Debug, Default)]
pub(crate) struct Control {
    /// Whether the work is to be given up.
    pub(crate) interrupt: AtomicBool,
    requests: Mutex<Requests>,
}

#[derive(Debug, Default)]
struct Requests {
    /// The request that is being handled.
    current: Option<i64>,
    /// The last requests that were canceled before they were handled.
    canceled: VecDeque<i64>,
    /// Whether the session ends.
    is_ending: bool,
}

impl Control {
    fn with<T>(&self, change: impl FnOnce(&mut Requests) -> T) -> T {
        // The state is valid after each change.
        change(&mut self.requests.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Begins to handle a request; returns whether it has been canceled.
    pub(crate) fn begin(&self, request: i64) -> bool {
        self.with(|requests| {
            requests.current = Some(request);
            self.interrupt.store(requests.is_ending, Ordering::Relaxed);
            let canceled = requests.canceled.iter().position(|&canceled| canceled == request);
            canceled.is_some_and(|at| requests.canceled.remove(at).is_some())
        })
    }

    fn cancel(&self, request: i64) {
        self.with(|requests| {
            if requests.current == Some(request) {
                self.interrupt.store(true, Ordering::Relaxed);
                return;
            }
            requests.canceled.push_back(request);
            if requests.canceled.len() > MAX_WAITING {
                requests.canceled.pop_front();
            }
        });
    }

    fn end(&self) {
        self.with(|requests| requests.is_ending = true);
        self.interrupt.store(true, Ordering::Relaxed);
    }
}

/// A message, or why there is none.
pub(crate) type Received = io::Result<Result<Message, String>>;

/// Reads messages until the input ends.
pub(crate) fn receive(input: impl Read + Send + 'static, control: &Arc<Control>) -> Receiver<Received> {
    let (sender, receiver) = sync_channel(MAX_WAITING);
    let control = Arc::clone(control);
    std::thread::spawn(move || {
        read(&mut BufReader::new(input), &control, &sender);
        control.end();
    });
    receiver
}

fn read(input: &mut impl BufRead, control: &Control, sender: &SyncSender<Received>) {
    loop {
        let message = match framing::read(input) {
            Ok(Some(content)) => {
                serde_json::from_slice::<Message>(&content).map_err(|error| error.to_string())
            }
            Ok(None) => return,
            Err(error) => {
                // The receiver has ended, or it ends now.
                let _ = sender.send(Err(error));
                return;
            }
        };
        if let Ok(message) = &message {
            match &*message.command {
                "cancel" => message
                    .canceled()
                    .into_iter()
                    .for_each(|request| control.cancel(request)),
                "disconnect" | "terminate" => control.end(),
                _ => {}
            }
        }
        if sender.send(Ok(message)).is_err() {
            return;
        }
    }
}
