//! A debug adapter: the Debug Adapter Protocol over the recorded execution of one pixel of a shader. Since
//! everything is recorded, stepping forward and back is moving through a list, and each value is known in
//! float32 and in double precision.
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//! use std::time::{Duration, Instant};
//!
//! use toyproof_dap::{Recording, StepKind, Subject};
//! use toyproof_diagnostic::{File, Files};
//! use toyproof_image::Frame;
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let mut files = Files::default();
//!     let text = "float half_of(float x) {\n    return 0.5 * x;\n}\n\
//!                 void mainImage(out vec4 c, in vec2 p) {\n    float y = half_of(p.x);\n\
//!                 c = vec4(y);\n}\n";
//!     let file = files.add(File::new("a.glsl", text));
//!     let checked = toyproof_glsl::check(&files, file, &Default::default())?;
//!     let subject = Subject {
//!         name: "a.glsl".to_owned(),
//!         files,
//!         checked,
//!         frame: Frame::default(),
//!         pixel: [3, 2],
//!         expected: None,
//!         timeout: Duration::from_secs(10),
//!     };
//!     let deadline = Instant::now() + subject.timeout;
//!     let recording = Recording::new(&subject, deadline, &AtomicBool::new(false))?;
//!     let line = |point| recording.line(point).map(|line| line.line);
//!     let first = recording.start();
//!     let inside = recording.step(first, StepKind::Into).ok_or("no step")?;
//!     let over = recording.step(first, StepKind::Next).ok_or("no step")?;
//!     assert_eq!([first, inside, over].map(line), [Some(5), Some(2), Some(6)]);
//!     assert_eq!(recording.step(over, StepKind::Back), Some(first));
//!     Ok(())
//! }
//! ```
//!
//! # Parts
//!
//! | part | contents |
//! |---|---|
//! | `protocol` | framing, requests, responses and events |
//! | `session` | [`serve`]: the requests of a client, one after the other |
//! | `recording`, `stepping` | the engine: stops, calls, values over time; what a user may want to stop at |
//! | `code` | the places at which the execution can stop, and the variables in scope there |
//! | `breakpoints`, `watch` | where breakpoints hold; expressions, which are evaluated as a shader's |
//! | `sources`, `value` | files and lines; values as texts and trees |

mod breakpoints;
mod code;
mod protocol;
mod recording;
mod session;
mod sources;
mod stepping;
mod subject;
#[cfg(test)]
mod tests;
mod value;
mod watch;

pub use recording::{Incident, IncidentKind, Line, Point, Recording};
pub use session::{Launch, LaunchError, Launcher, serve};
pub use stepping::StepKind;
pub use subject::Subject;
