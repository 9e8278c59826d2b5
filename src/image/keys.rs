//! The keyboard, as `ShaderToy` shows it to shaders.

use serde::{Deserialize, Serialize};

use crate::{Image, Texture};

/// A set of the browser's key codes, from 0 to 255.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeySet([u64; 4]);

impl KeySet {
    /// Whether a key is in the set.
    pub fn contains(self, code: u8) -> bool {
        self.0[usize::from(code) / 64] >> (code % 64) & 1 == 1
    }

    /// Adds a key, or removes it.
    pub fn set(&mut self, code: u8, is_contained: bool) {
        let bit = 1 << (code % 64);
        let word = &mut self.0[usize::from(code) / 64];
        *word = if is_contained { *word | bit } else { *word & !bit };
    }
}

/// The state of the keyboard in a frame.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Keys {
    /// The keys that are held down.
    pub held: KeySet,
    /// The keys that were pressed since the previous frame.
    pub pressed: KeySet,
    /// The keys that have been pressed an odd number of times.
    pub toggled: KeySet,
}

impl Keys {
    /// The texture of 256×3 texels: a column for each key, and the rows held, pressed and toggled, from the
    /// bottom up. Red is 1 or 0.
    pub fn texture(&self) -> Texture {
        let rows = [self.held, self.pressed, self.toggled];
        let texels = rows.into_iter().flat_map(|row| {
            (0..=u8::MAX).map(move |code| [f32::from(u8::from(row.contains(code))), 0.0, 0.0, 1.0])
        });
        Image::new(256, 3, texels.collect()).into()
    }
}
