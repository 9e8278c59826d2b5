//! The shapes of the channels, where nobody told them.

use super::Checker;
use crate::options::Options;
use crate::tree::{ExprId, ExprKind, Input, Sampler, SamplerShape, Type, VariableKind};

/// What is known of the four channels.
#[derive(Debug, Clone)]
pub(crate) struct Channels {
    pub(crate) shapes: [SamplerShape; 4],
    /// Which shapes the options tell.
    certain: [bool; 4],
    /// Whether a use told a shape just now: then the shader must be read once more.
    pub(crate) changed: bool,
}

impl Channels {
    pub(crate) fn new(options: &Options) -> Self {
        Self {
            shapes: options.channels.map(|shape| shape.unwrap_or(SamplerShape::D2)),
            certain: options.channels.map(|shape| shape.is_some()),
            changed: false,
        }
    }
}

impl Checker<'_> {
    /// When no overload takes the arguments: whether one would if a channel among them had another shape, which it has from now on.
    pub(super) fn infer_channel(
        &mut self,
        arguments: &[ExprId],
        resolves: impl Fn(&Self, &[Type]) -> bool,
    ) -> bool {
        for (position, &argument) in arguments.iter().enumerate() {
            let Some(channel) = self
                .channel(argument)
                .filter(|&channel| !self.channels.certain[channel])
            else {
                continue;
            };
            let mut types = self.types(arguments);
            // Only ever forward through this list, so that the shader is read a few times at most. What takes a cube with a
            // direction takes a volume, too, but not the other way round.
            let order = [SamplerShape::D2, SamplerShape::Cube, SamplerShape::D3];
            let now = self.channels.shapes[channel];
            if types[position] != Type::Sampler(Sampler::float(now)) {
                // Told earlier in this reading, which goes on with the old shape until it is done anew.
                return true;
            }
            for &shape in order.iter().skip_while(|&&shape| shape != now).skip(1) {
                types[position] = Type::Sampler(Sampler::float(shape));
                if resolves(self, &types) {
                    self.channels.shapes[channel] = shape;
                    self.channels.changed = true;
                    return true;
                }
            }
        }
        false
    }

    /// What is known of the channels by now.
    pub(crate) fn channels(&self) -> &Channels {
        &self.channels
    }

    fn channel(&self, argument: ExprId) -> Option<usize> {
        let ExprKind::Variable(variable) = self.tree[argument].kind else {
            return None;
        };
        match self.tree[variable].kind {
            VariableKind::Input(Input::Channel(channel)) => Some(usize::from(channel)),
            _ => None,
        }
    }
}
