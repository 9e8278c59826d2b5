//! The frames of a shader with several passes, one after the other: on the evaluator, and by a driver.

use std::ops::Deref;
use std::time::{Duration, Instant};

use toyproof_diagnostic::{Deadline, Overdue};
use toyproof_eval::{Number, PassFailure, PassRenderer, Refusal, Settings, UndefinedPolicy};
use toyproof_eval_native::Program;
use toyproof_glsl::Checked;
use toyproof_glsl::tree::{BuiltIn, ExprKind};
use toyproof_image::{Frame, Image, MovingTextures, Texture};
use toyproof_player::{BUFFERS, DriverFailure, Graph, Player, Readback, State, Target};
use toyproof_translate::FloatMode;

use crate::driver::Driver;

/// A shader with several passes.
#[derive(Debug, Clone)]
pub struct PassShader<'a> {
    /// The passes, in the order of the graph.
    pub checked: Vec<&'a Checked>,
    /// The order of the passes, and their inputs.
    pub graph: &'a Graph,
    /// The textures that do not change.
    pub media: &'a [Texture],
    /// The textures that change from frame to frame.
    pub films: MovingTextures,
}

impl PassShader<'_> {
    /// The frame with the textures of the shader that change.
    #[must_use]
    pub fn with_films(&self, frame: &Frame) -> Frame {
        let frame = Frame {
            films: self.films.clone(),
            ..frame.clone()
        };
        frame.at(frame.frame, frame.time)
    }

    /// Whether a pass looks up texels with a filter: in strict arithmetic many operations, which drivers
    /// compile better than the evaluator.
    #[must_use]
    pub fn is_filtering(&self) -> bool {
        use BuiltIn::{TexelFetch, TexelFetchOffset, TextureSize};
        let is_filter = |expr: &ExprKind| match expr {
            ExprKind::BuiltIn { function, .. } => {
                function.is_texture() && !matches!(function, TextureSize | TexelFetch | TexelFetchOffset)
            }
            _ => false,
        };
        let mut trees = self.checked.iter().map(|checked| &checked.tree);
        trees.any(|tree| tree.exprs.iter().any(|(_, expr)| is_filter(&expr.kind)))
    }

    /// Compiles all passes for the evaluator, each within `timeout`.
    ///
    /// # Errors
    /// The number of the first pass that is too large, and why.
    pub fn programs(&self, timeout: Duration) -> Result<Vec<Program>, (usize, Refusal)> {
        let passes = self.checked.iter().enumerate();
        let program = |(pass, checked): (usize, &&Checked)| {
            let program = Program::prepared_within(checked, UndefinedPolicy::Plain, Some(timeout));
            program.map_err(|refusal| (pass, refusal))
        };
        passes.map(program).collect()
    }
}

/// The frames of a shader on the evaluator.
#[derive(Debug)]
pub struct CpuPlayback<'a, N: Number> {
    player: Player<PassRenderer<'a, N>>,
    timeout: Duration,
}

impl<'a, N: Number> CpuPlayback<'a, N> {
    /// Starts before the first frame, or after the frame of a state. `timeout` is the time limit of a frame, by
    /// which the deadline is set for each.
    #[must_use]
    pub fn new(
        shader: &PassShader<'a>,
        programs: impl IntoIterator<Item = &'a Program>,
        state: Option<&State>,
        timeout: Duration,
        settings: Settings<'a, N>,
    ) -> Self {
        let programs = programs.into_iter().map(Deref::deref);
        let renderer = PassRenderer::new(programs, shader.media, settings);
        let mut player = Player::new(shader.graph.clone(), renderer);
        if let Some(state) = state {
            let load = |_: &mut _, texture: &_, mipmaps| Ok(PassRenderer::<N>::load(texture, mipmaps));
            let Ok::<(), std::convert::Infallible>(()) = player.restore(state, load);
        }
        Self { player, timeout }
    }

    /// Renders the next frame; its channels are ignored.
    ///
    /// # Errors
    /// If a pass fails.
    pub fn render(&mut self, frame: &Frame) -> Result<(), PassFailure> {
        self.player
            .renderer_mut()
            .set_deadline(Instant::now() + self.timeout);
        self.player.render(frame)
    }

    /// The last image of a pass; `None` if the shader does not use it.
    #[must_use]
    pub fn texture(&self, target: Target) -> Option<&Texture> {
        self.player.texture(target)
    }

    /// The frame that was rendered last, as one of its passes read it: with that pass's channels.
    ///
    /// # Panics
    /// If there is no such pass.
    #[must_use]
    pub fn bound(&self, pass: usize, frame: &Frame) -> Frame {
        let channels = self.player.inputs(pass);
        let graph = self.player.graph();
        let frame = graph.frame(graph.passes()[pass].target, frame);
        self.player.renderer().bound(&frame, channels)
    }

    /// The state after a frame.
    #[must_use]
    pub fn state(&self, frame: i32) -> State {
        let copy = |texture: &Texture| Ok(texture.clone().without_mipmaps());
        let Ok::<State, std::convert::Infallible>(state) = self.player.state(frame, copy);
        state
    }
}

/// The frames of a shader by a driver.
#[derive(Debug)]
pub struct DevicePlayback<'a> {
    driver: &'a mut Driver,
    graph: Graph,
    device: String,
}

/// Why a driver does not render the passes.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlaybackFailure {
    /// A pass takes too long to translate.
    #[error(transparent)]
    Overdue(#[from] Overdue),
    /// The driver failed.
    #[error(transparent)]
    Gpu(#[from] DriverFailure),
}

impl<'a> DevicePlayback<'a> {
    /// Compiles the passes. Starts before the first frame, or after the frame of a state.
    ///
    /// # Errors
    /// If the passes cannot be compiled in time, or at all.
    pub fn open(
        driver: &'a mut Driver,
        shader: &PassShader<'_>,
        state: Option<&State>,
        float: FloatMode,
        timeout: Duration,
    ) -> Result<Self, PlaybackFailure> {
        let deadline = Deadline::after(timeout);
        let code = shader
            .checked
            .iter()
            .map(|checked| Ok((float.lower_within(checked, &deadline)?, float)));
        let code = code.collect::<Result<Vec<_>, Overdue>>()?;
        let sampling = shader.checked.iter().map(|checked| checked.sampling);
        let device = driver.open_player(
            code,
            sampling.collect(),
            shader.graph.clone(),
            shader.media.to_vec(),
            state.cloned(),
        )?;
        Ok(Self::opened(driver, device, shader.graph))
    }

    /// The playback of the passes that a driver has opened, in the order of their graph. `device` is the name
    /// that it returned.
    #[must_use]
    pub fn opened(driver: &'a mut Driver, device: String, graph: &Graph) -> Self {
        Self {
            driver,
            graph: graph.clone(),
            device,
        }
    }

    /// Adapter and driver.
    #[must_use]
    pub fn device(&self) -> &str {
        &self.device
    }

    /// Renders the next frame and returns the images of the `wanted` passes; the channels of `frame` are
    /// ignored.
    ///
    /// # Errors
    /// If the driver fails; the playback is then over.
    pub fn render(&mut self, frame: &Frame, wanted: &[Target]) -> Result<Vec<Image>, DriverFailure> {
        let wanted: Vec<_> = wanted.iter().copied().map(Readback::Last).collect();
        self.driver.play(Some(frame), &wanted)
    }

    /// Continues from a state.
    ///
    /// # Errors
    /// If the driver fails; the playback is then over.
    pub fn restore(&mut self, state: &State) -> Result<(), DriverFailure> {
        self.driver.restore_player(state.clone())
    }

    /// The state after a frame, which was rendered last.
    ///
    /// # Errors
    /// If the driver fails; the playback is then over.
    pub fn state(&mut self, frame: &Frame) -> Result<State, DriverFailure> {
        let used: Vec<_> = (0..BUFFERS).filter(|&buffer| self.graph.uses(buffer)).collect();
        let buffers = used
            .iter()
            .flat_map(|&buffer| [Readback::Last(Target::Buffer(buffer)), Readback::Other(buffer)]);
        let wanted: Vec<_> = buffers.chain([Readback::Last(Target::Image)]).collect();
        let images = self.driver.play(None, &wanted)?;
        let mut images = images.into_iter();
        let mut buffers = [const { None }; BUFFERS];
        for buffer in used {
            let textures = images.next().zip(images.next());
            let textures = textures.map(<[Image; 2]>::from);
            buffers[buffer] = textures.map(|pair| pair.map(|image| Target::Buffer(buffer).texture(image)));
        }
        Ok(State {
            frame: frame.frame,
            size: frame.size,
            buffers,
            image: images.next().map(Texture::from),
        })
    }
}
