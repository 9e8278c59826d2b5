//! The file of `run --state`: the state that the next frame of a project depends on, and its project.

use std::io::{self, Read};
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use toyproof_diagnostic::{Files, path_name};
use toyproof_image::{input, output};
use toyproof_player::{BUFFERS, Clock, Graph, State, Target};
use toyproof_project::{CompiledProject, Rendering};

/// Identifies the format.
const FORMAT: &str = "toyproof state 3";

/// The maximum size of the header before the textures, in bytes.
const MAX_HEAD_BYTES: u64 = 1024;

/// The maximum size of a texel, in bytes: four doubles.
const MAX_TEXEL_BYTES: u64 = 32;

/// The maximum size of what is stored beside the texels, in bytes: sizes, and the borders of Cube A, which are
/// 1.6 MB in doubles.
const MAX_REST_BYTES: u64 = 2 << 20;

/// The owner of a state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Owner {
    /// A digest of the texts of the passes, of their inputs and of the sampling of these.
    project: [u8; 32],
    /// Width and height in pixels.
    size: [u32; 2],
    /// The frames in a second.
    rate: f64,
    /// The time of frame 0, in seconds.
    start: f64,
}

impl Owner {
    /// The owner of the states of a project.
    pub(super) fn new(passes: &CompiledProject, rendering: &Rendering, files: &Files, clock: &Clock) -> Self {
        let mut digest = Sha256::new();
        let mut add = |bytes: &[u8]| {
            digest.update((bytes.len() as u64).to_le_bytes());
            digest.update(bytes);
        };
        let project = &passes.project;
        let texts = rendering.passes.iter().map(|&pass| project.passes[pass].file);
        for file in project.common.into_iter().chain(texts) {
            add(files.get(file).text().as_bytes());
        }
        for checked in passes.checked_of(rendering) {
            add(format!("{:?}", checked.sampling).as_bytes());
        }
        // Numbers and lists always serialize.
        add(&postcard::to_stdvec(&rendering.graph).unwrap_or_default());
        for medium in &rendering.media {
            add(&postcard::to_stdvec(medium).unwrap_or_default());
        }
        Self {
            project: digest.finalize().into(),
            size: clock.inputs.size,
            rate: clock.rate,
            start: clock.start,
        }
    }

    /// Why a state of another owner does not fit, after the name of its file; `None` if it is the same owner.
    fn mismatch(&self, other: &Self) -> Option<String> {
        if other.project != self.project {
            return Some("is the state of a project with other texts, passes or inputs".to_owned());
        }
        if other.size != self.size {
            let [width, height] = other.size;
            return Some(format!("is the state of frames of {width}×{height} pixels"));
        }
        if other.rate.to_bits() != self.rate.to_bits() {
            return Some(format!("is the state of {} frames in a second", other.rate));
        }
        // A time that the user gives need not be that of a frame.
        let is_moved = (other.start - self.start).abs() * self.rate > 0.5;
        is_moved.then(|| format!("is the state of a run whose frame 0 is at {} s", other.start))
    }
}

/// The maximum size of a state of a graph, in bytes: two textures of each buffer, and the image.
fn max_bytes(graph: &Graph, image: [u32; 2]) -> u64 {
    let buffers = (0..BUFFERS).filter(|&buffer| graph.uses(buffer));
    let texels = buffers.map(|buffer| 2 * graph.texels(Target::Buffer(buffer), image));
    let texels = texels.sum::<u64>() + graph.texels(Target::Image, image);
    texels * MAX_TEXEL_BYTES + MAX_REST_BYTES
}

/// Reads a state of a graph; `None` if there is no such file.
///
/// # Errors
/// Why it cannot be used.
pub(super) fn read(path: &Path, owner: &Owner, graph: &Graph) -> Result<Option<State>, String> {
    let name = path_name(path);
    let unreadable = |error: io::Error| format!("cannot read {name}: {error}");
    let mut file = match input::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(unreadable(error)),
    };
    let mut bytes = Vec::new();
    file.by_ref()
        .take(MAX_HEAD_BYTES)
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    let foreign = |_| format!("{name} is not a state of `toyproof run --state`");
    let (format, rest) = postcard::take_from_bytes::<&str>(&bytes).map_err(foreign)?;
    if format != FORMAT {
        return Err(if format.starts_with("toyproof state ") {
            format!("{name} was written by another version of toyproof")
        } else {
            foreign(postcard::Error::DeserializeBadEncoding)
        });
    }
    let damaged = |_| format!("{name} is damaged");
    let (found, rest) = postcard::take_from_bytes::<Owner>(rest).map_err(damaged)?;
    if let Some(reason) = owner.mismatch(&found) {
        return Err(format!("{name} {reason}"));
    }
    let head = bytes.len() - rest.len();
    file.take(max_bytes(graph, owner.size))
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    let state = postcard::from_bytes::<State>(&bytes[head..]).map_err(damaged)?;
    Ok(Some(state))
}

/// Writes a complete state.
///
/// # Errors
/// Why it cannot be written.
pub(super) fn write(path: &Path, owner: &Owner, state: &State) -> Result<(), String> {
    let bytes = postcard::to_stdvec(&(FORMAT, owner, state)).map_err(|error| error.to_string())?;
    output::write(path, &bytes).map_err(|error| format!("cannot write {error}"))
}
