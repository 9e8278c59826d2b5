//! Texture lookups.

use super::{Handler, Instruction, Level, Run, for_each_chunk, handler};
use crate::batch::{Batch, LANES};
use crate::number::Number;
use crate::texture::Texture;

/// Filtered: operands 0 and 1 are rows of coordinates; operand 2 is channel and component, `to` the offset in texels.
struct Filtered;

impl<N: Number> Run<N> for Filtered {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let [x, y, which] = instruction.operands;
        let (x, y) = (batch.float_row(x), batch.float_row(y));
        let out = batch.float_row(instruction.out);
        let offset =
            [instruction.to as u16, (instruction.to >> 16) as u16].map(|axis| i32::from(axis.cast_signed()));
        let texture = texture(batch, which);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (x, y) = (x[chunk].get(), y[chunk].get());
            let mut result = [N::default(); LANES];
            for lane in 0..LANES {
                result[lane] = match texture {
                    Some(texture) => texture.filtered([x[lane], y[lane]], offset, which as usize % 4, batch.noise),
                    None => nothing(which),
                };
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

/// Fetched: operands 0 and 1 are rows of places.
struct Fetched;

impl<N: Number> Run<N> for Fetched {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let [x, y, which] = instruction.operands;
        let (x, y) = (batch.word_row(x), batch.word_row(y));
        let out = batch.float_row(instruction.out);
        let texture = texture(batch, which);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (x, y) = (x[chunk].get(), y[chunk].get());
            let mut result = [N::default(); LANES];
            for lane in 0..LANES {
                result[lane] = match texture {
                    Some(texture) => {
                        let place = [x[lane], y[lane]].map(u32::cast_signed);
                        N::from_f64(f64::from(texture.fetched(place, which as usize % 4)))
                    }
                    None => nothing(which),
                };
            }
            out[chunk].set(result);
        });
        at + 1
    }
}

fn texture<'a, N: Number>(batch: &'a Batch<'_, N>, which: u32) -> Option<&'a Texture<'a>> {
    batch.textures[which as usize / 4 % 4].as_ref()
}

/// What an unbound channel gives: black, opaque.
fn nothing<N: Number>(which: u32) -> N {
    N::from_f64(f64::from(u8::from(which % 4 == 3)))
}

/// The handler of a lookup, from rows.
pub(crate) fn texel<N: Number>(filtered: bool) -> Handler<N> {
    if filtered {
        handler::<N, Filtered>(Level::Base)
    } else {
        handler::<N, Fetched>(Level::Base)
    }
}
