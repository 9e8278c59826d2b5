//! What is known of the scenes that shaders were judged by, shared by all who judge.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use toyproof_image::Frame;
use toyproof_scene::Scene;
use toyproof_verify::Expected;
use toyproof_verify::mistake::Suspects;

/// So many scenes are kept, those that were asked for last, and fewer if they take more than so many bytes.
const MOST: usize = 8;
const BYTES: usize = 256 << 20;

/// A scene, and what is worked out of it once.
#[derive(Debug)]
pub(super) struct Known {
    pub(super) expected: Expected,
    suspects: OnceLock<Option<Suspects>>,
}

impl Known {
    /// What a wrong picture is compared with.
    pub(super) fn suspects(&self, frame: &Frame) -> Option<&Suspects> {
        let suspects = || Suspects::of(self.expected.scene(), frame);
        self.suspects.get_or_init(suspects).as_ref()
    }
}

/// The scenes that were asked for last, the latest first. All are seen at the same moment.
#[derive(Debug, Default)]
pub(super) struct Scenes {
    latest: Mutex<VecDeque<Arc<Known>>>,
}

impl Scenes {
    /// What is known of a scene in that frame.
    pub(super) fn known(&self, scene: Scene, frame: &Frame) -> Arc<Known> {
        let mut latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        let before = latest.iter().position(|known| *known.expected.scene() == scene);
        let known = before.and_then(|at| latest.remove(at)).unwrap_or_else(|| {
            Arc::new(Known {
                expected: Expected::new(scene, frame),
                suspects: OnceLock::new(),
            })
        });
        latest.push_front(Arc::clone(&known));
        let bytes = |latest: &VecDeque<Arc<Known>>| {
            let bytes = latest.iter().map(|known| known.expected.bytes());
            bytes.sum::<usize>()
        };
        while latest.len() > MOST || (latest.len() > 1 && bytes(&latest) > BYTES) {
            latest.pop_back();
        }
        known
    }
}

#[cfg(test)]
mod tests {
    use toyproof_diagnostic::{File, Files};
    use toyproof_scene as scene;

    use super::*;

    fn scene(title: &str) -> Scene {
        let mut files = Files::default();
        let text = format!("title = \"{title}\"\n[film]\nsize = [64, 36]\n[background]\n");
        let file = files.add(File::new("s", text));
        scene::parse(&files, file).unwrap()
    }

    #[test]
    fn a_scene_is_known_while_it_is_among_the_last() {
        let scenes = Scenes::default();
        let frame = Frame {
            size: [64, 36],
            ..Frame::default()
        };
        let known = |title: &str| scenes.known(scene(title), &frame);
        let first = known("0");
        for at in 1..MOST {
            known(&at.to_string());
        }
        assert!(Arc::ptr_eq(&first, &known("0")), "the last of eight");
        for at in 0..MOST {
            known(&format!("other {at}"));
        }
        assert!(!Arc::ptr_eq(&first, &known("0")));
    }
}
