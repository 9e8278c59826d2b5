//! The worker as a driver that others render with.

use std::time::Duration;

use toyproof_image::{Frame, Image, Texture};
use toyproof_player::{self as player, ChannelSampling, DrawOutput, Graph, Readback, State};
use toyproof_translate::{FloatMode, Lowered};

use super::quirks::loop_cap::SAFE_ITERATIONS;
use super::{Failure, PlayedPasses, Worker};

impl player::Driver for Worker {
    type Code = (Lowered, FloatMode);

    fn draw_in_bands(
        &mut self,
        (lowered, float): Self::Code,
        frame: Frame,
        on_band: &mut dyn FnMut(Image),
        watch: &mut dyn FnMut(&DrawOutput, Duration) -> bool,
    ) -> Result<DrawOutput, Failure> {
        self.draw_in_bands(lowered, frame, float, on_band, watch)
    }

    fn safe_iterations(&self) -> u32 {
        SAFE_ITERATIONS
    }

    fn stop(&mut self) {
        self.stop();
    }

    fn open_player(
        &mut self,
        passes: Vec<Self::Code>,
        sampling: Vec<[ChannelSampling; 4]>,
        graph: Graph,
        media: Vec<Texture>,
        state: Option<State>,
    ) -> Result<String, Failure> {
        self.open_player(PlayedPasses::Lowered(passes), sampling, graph, media, state)
    }

    fn restore_player(&mut self, state: State) -> Result<(), Failure> {
        self.restore_player(state)
    }

    fn play(&mut self, frame: Option<&Frame>, wanted: &[Readback]) -> Result<Vec<Image>, Failure> {
        self.play(frame, wanted)
    }
}
