//! The user's actions with the mouse and the keyboard over the frames of a run.

use crate::Keys;

/// Input events, in the order in which they happen.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Script {
    events: Vec<(i32, InputEvent)>,
}

/// An input event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InputEvent {
    /// The mouse button is pressed at a position, in pixels from the bottom left.
    MousePress([f32; 2]),
    /// The mouse is moved to a position.
    MouseMove([f32; 2]),
    /// The mouse button is released.
    MouseRelease,
    /// The key with this code is pressed.
    KeyPress(u8),
    /// The key with this code is released.
    KeyRelease(u8),
}

impl Script {
    /// The script of these events, each before the frame with the given number is rendered. Events of one
    /// frame keep their order.
    pub fn new(mut events: Vec<(i32, InputEvent)>) -> Self {
        events.sort_by_key(|&(frame, _)| frame);
        Self { events }
    }

    /// Both scripts at once.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        Self::new([&self.events[..], &other.events].concat())
    }

    /// The events before a frame and in it.
    fn until(&self, frame: i32) -> impl Iterator<Item = (bool, InputEvent)> {
        let events = self.events.iter().take_while(move |(at, _)| *at <= frame);
        events.map(move |&(at, event)| (at == frame, event))
    }

    /// `iMouse` in a frame; `None` before the first click. As on `ShaderToy`, xy follows the mouse while the
    /// button is down, and zw is where it was pressed: z is positive while it is down, and w in the frame of
    /// the click. Positions are rounded down to whole pixels.
    pub fn mouse(&self, frame: i32) -> Option<[f32; 4]> {
        let mut mouse = None;
        for (is_now, event) in self.until(frame) {
            // The click lasts for a frame.
            let mut state = mouse.unwrap_or_default();
            match event {
                InputEvent::MousePress(at) => {
                    let at = at.map(f32::floor);
                    state = Mouse {
                        at,
                        start: at,
                        is_down: true,
                        is_clicked: is_now,
                    };
                }
                InputEvent::MouseMove(at) if state.is_down => state.at = at.map(f32::floor),
                InputEvent::MouseRelease => state.is_down = false,
                _ => continue,
            }
            mouse = Some(state);
        }
        let Mouse {
            at,
            start,
            is_down,
            is_clicked,
        } = mouse?;
        let signed = |is_positive: bool, value: f32| if is_positive { value } else { -value };
        Some([
            at[0],
            at[1],
            signed(is_down, start[0]),
            signed(is_clicked, start[1]),
        ])
    }

    /// The keyboard in a frame. A key that is pressed while it is held does nothing.
    pub fn keys(&self, frame: i32) -> Keys {
        let mut keys = Keys::default();
        for (is_now, event) in self.until(frame) {
            match event {
                InputEvent::KeyPress(code) if !keys.held.contains(code) => {
                    keys.held.set(code, true);
                    keys.toggled.set(code, !keys.toggled.contains(code));
                    if is_now {
                        keys.pressed.set(code, true);
                    }
                }
                InputEvent::KeyRelease(code) => keys.held.set(code, false),
                _ => {}
            }
        }
        keys
    }
}

/// The mouse after some events.
#[derive(Debug, Clone, Copy, Default)]
struct Mouse {
    at: [f32; 2],
    start: [f32; 2],
    is_down: bool,
    is_clicked: bool,
}

#[cfg(test)]
mod tests {
    use InputEvent::{KeyPress, KeyRelease, MouseMove, MousePress, MouseRelease};

    use super::*;

    #[test]
    fn the_mouse_has_the_signs_of_the_site() {
        let script = Script::new(vec![
            (2, MousePress([10.5, 20.0])),
            (1, MouseMove([5.0, 5.0])),
            (4, MouseMove([30.0, 40.9])),
            (6, MouseRelease),
            (7, MouseMove([1.0, 1.0])),
            (9, MousePress([0.0, 3.0])),
        ]);
        assert_eq!(script.mouse(1), None);
        assert_eq!(script.mouse(2), Some([10.0, 20.0, 10.0, 20.0]));
        assert_eq!(script.mouse(3), Some([10.0, 20.0, 10.0, -20.0]));
        assert_eq!(script.mouse(5), Some([30.0, 40.0, 10.0, -20.0]));
        assert_eq!(script.mouse(8), Some([30.0, 40.0, -10.0, -20.0]));
        assert_eq!(script.mouse(9), Some([0.0, 3.0, 0.0, 3.0]));
    }

    #[test]
    fn keys_toggle_once_per_press() {
        let script = Script::new(vec![
            (1, KeyPress(32)),
            (2, KeyPress(32)),
            (3, KeyRelease(32)),
            (5, KeyPress(32)),
            (5, KeyPress(255)),
        ]);
        let row = |frame, code| {
            let Keys {
                held,
                pressed,
                toggled,
            } = script.keys(frame);
            [held, pressed, toggled].map(|set| set.contains(code))
        };
        assert_eq!(row(0, 32), [false; 3]);
        assert_eq!(row(1, 32), [true, true, true]);
        assert_eq!(row(2, 32), [true, false, true]);
        assert_eq!(row(4, 32), [false, false, true]);
        assert_eq!(row(5, 32), [true, true, false]);
        assert_eq!(row(5, 255), [true, true, true]);
        let texture = script.keys(5).texture().to_single();
        let texel = |x, y| texture[0].get(x, y);
        assert_eq!(
            (texel(255, 2), texel(32, 2), texel(32, 0)),
            ([1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0])
        );
    }
}
