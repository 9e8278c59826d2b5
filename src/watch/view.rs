//! What a tab of the page shows: the inputs of the frame, and the pass.

use serde::{Deserialize, Serialize};
use toyproof_image::{KeySet, Keys, UniformValue};

/// The moment and the inputs that a tab of the page shows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct View {
    /// The number of the tab, which the server gave it.
    pub tab: u64,
    /// Width and height of the image, in pixels.
    pub size: [u32; 2],
    /// `iTime`, in seconds.
    pub time: f32,
    /// `iFrame`, from 0.
    pub frame: i32,
    /// `iMouse`, in pixels.
    pub mouse: [f32; 4],
    /// The keyboard.
    #[serde(default)]
    pub keys: KeyCodes,
    /// The values of uniforms that the user sets on the page.
    #[serde(default)]
    pub uniforms: Vec<UniformValue>,
    /// The pass that is shown, such as `buffer-a`.
    pub pass: String,
}

/// The keyboard of a tab, by the browser's key codes from 0 to 255.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeyCodes {
    /// The keys that are held down.
    held: Vec<u8>,
    /// The keys that were pressed since the previous frame.
    pressed: Vec<u8>,
    /// The keys that were pressed an odd number of times.
    toggled: Vec<u8>,
}

impl From<&KeyCodes> for Keys {
    fn from(codes: &KeyCodes) -> Self {
        let set = |codes: &[u8]| {
            let mut set = KeySet::default();
            for &code in codes {
                set.set(code, true);
            }
            set
        };
        Self {
            held: set(&codes.held),
            pressed: set(&codes.pressed),
            toggled: set(&codes.toggled),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_leaves_out_what_it_does_not_use() {
        let text = r#"{"tab":1,"size":[4,2],"time":0.5,"frame":30,"mouse":[0,0,0,0],"pass":"image"}"#;
        let view: View = serde_json::from_str(text).unwrap();
        assert_eq!((view.size, view.frame), ([4, 2], 30));
        assert_eq!(Keys::from(&view.keys), Keys::default());
    }

    #[test]
    fn key_codes_become_sets() {
        let codes: KeyCodes =
            serde_json::from_str(r#"{"held":[65],"pressed":[],"toggled":[65,255]}"#).unwrap();
        let keys = Keys::from(&codes);
        assert!(keys.held.contains(65) && keys.toggled.contains(255) && !keys.pressed.contains(65));
        assert!(serde_json::from_str::<KeyCodes>(r#"{"held":[256],"pressed":[],"toggled":[]}"#).is_err());
    }
}
