//! What a graphics driver does: it renders images, and plays the passes of a shader.

use std::fmt;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use toyproof_image::{Frame, Image, Sampling, Texture};

use crate::{DriverFailure, Graph, State, Target};

/// Renders shaders on a graphics driver: single images, and the passes of one shader over frames.
pub trait Driver: fmt::Debug + Send {
    /// The code of a shader in the form that this driver takes.
    type Code;

    /// Renders a frame, and passes the bands of [`Frame::bands`] to `on_band`, one after the other; the time
    /// spent in `on_band` does not count as rendering. `checks_loops` receives the result and the rendering
    /// time, and returns whether to check for loops that the driver truncated; it may return false if no
    /// pixel runs more than [`Self::safe_iterations`] iterations.
    ///
    /// # Errors
    /// Why there is no image: [`DriverFailure::Invalid`] also for a shader that nests deeper than
    /// drivers support.
    fn draw_in_bands(
        &mut self,
        code: Self::Code,
        frame: Frame,
        on_band: &mut dyn FnMut(Image),
        checks_loops: &mut dyn FnMut(&DrawOutput, Duration) -> bool,
    ) -> Result<DrawOutput, DriverFailure>;

    /// The number of loop iterations of a pixel up to which no loop is truncated.
    fn safe_iterations(&self) -> u32;

    /// Releases the driver's memory until the next image.
    fn stop(&mut self);

    /// Compiles the passes of a shader, in the order of their graph, with the samplers of each and the
    /// textures that do not change, and resumes from a state, if there is one. Returns the name of the
    /// device. [`Self::play`] then renders the frames, until another image is rendered.
    ///
    /// # Errors
    /// Why the passes cannot be rendered.
    fn open_player(
        &mut self,
        passes: Vec<Self::Code>,
        sampling: Vec<[Sampling; 4]>,
        graph: Graph,
        media: Vec<Texture>,
        state: Option<State>,
    ) -> Result<String, DriverFailure>;

    /// Resumes the opened passes from a state.
    ///
    /// # Errors
    /// Why the state's textures cannot be created.
    fn restore_player(&mut self, state: State) -> Result<(), DriverFailure>;

    /// Renders the next frame of the opened passes, if one is given, and returns the `wanted` textures. The
    /// channels of the frame are ignored.
    ///
    /// # Errors
    /// Why there is no image. The passes must then be opened again, and start with the first frame.
    fn play(&mut self, frame: Option<&Frame>, wanted: &[Readback]) -> Result<Vec<Image>, DriverFailure>;
}

/// A rendered image with its statistics.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct DrawOutput {
    /// The image in the float target's format, in bands of rows from the bottom up, as given by
    /// [`Frame::bands`]. Empty if the bands were passed to a callback.
    #[serde(skip)]
    pub bands: Vec<Image>,
    /// Adapter and driver.
    pub device: String,
    /// Whether the shader has loops and the driver is of a kind that truncates long loops, so that a check
    /// is needed.
    pub may_truncate_loops: bool,
    /// Number of pixels in which the driver truncated a loop, whose colors are meaningless. `None` if that
    /// could not be determined in time; 0 if it was not checked.
    pub loop_truncated: Option<u64>,
    /// Time for naga to parse, validate and emit.
    pub translate: Duration,
    /// Time for the driver to compile.
    pub compile: Duration,
    /// Time to render and read back.
    pub draw: Duration,
}

impl DrawOutput {
    /// Joins the bands into an image.
    ///
    /// # Panics
    /// If the bands were passed to a callback.
    pub fn image(self) -> Image {
        Image::of_bands(self.bands)
    }
}

/// A texture of the passes of a shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Readback {
    /// What a pass rendered last.
    Last(Target),
    /// The other texture of a buffer, which the buffer's pass renders next.
    Other(usize),
}
