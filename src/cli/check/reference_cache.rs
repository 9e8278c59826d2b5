//! References with the results that are computed once for all shaders, shared by all threads.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use toyproof_explain::known::Hypotheses;
use toyproof_image::Frame;
use toyproof_scene::Scene;
use toyproof_verify::{Conditioning, Expected, ReferenceKind};

/// The largest number of scenes in each frame that the cache holds, the most recently used. The shaders of
/// one scene usually follow each other.
const MAX_CACHED_SCENES: usize = 8;

/// The largest size of the scenes that the cache holds, if there are several.
const MAX_CACHED_BYTES: usize = 256 << 20;

/// A reference with the results that are computed once and shared.
#[derive(Debug)]
pub(super) struct CachedReference {
    pub(super) expected: Expected,
    hypotheses: OnceLock<Option<Hypotheses>>,
    is_tested: AtomicBool,
}

impl CachedReference {
    pub(super) fn new(expected: Expected) -> Self {
        Self {
            expected,
            hypotheses: OnceLock::new(),
            is_tested: AtomicBool::new(false),
        }
    }

    /// How ill-conditioned a scene is, the first time that it is requested; `None` if it is not.
    pub(super) fn conditioning(&self) -> Option<Conditioning> {
        let is_first = self.expected.kind() == ReferenceKind::Scene && !self.is_tested.swap(true, Relaxed);
        is_first.then(|| self.expected.conditioning())?
    }

    /// The hypotheses that a wrong image is compared with; `None` without a scene.
    pub(super) fn hypotheses(&self, frame: &Frame) -> Option<&Hypotheses> {
        let hypotheses = || Hypotheses::new(self.expected.scene()?, frame);
        self.hypotheses.get_or_init(hypotheses).as_ref()
    }
}

/// A cache of the most recently used scenes, the latest first, each with the index of its frame.
#[derive(Debug, Default)]
pub(super) struct SceneCache {
    latest: Mutex<VecDeque<(usize, Arc<CachedReference>)>>,
}

impl SceneCache {
    /// Returns the cached results of a scene in the frame with this index, creating them if needed.
    pub(super) fn get(&self, scene: Scene, index: usize, frame: &Frame) -> Arc<CachedReference> {
        let mut latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        let before = latest
            .iter()
            .position(|(known_index, known)| *known_index == index && known.expected.scene() == Some(&scene));
        let known = before.and_then(|at| latest.remove(at)).map_or_else(
            || Arc::new(CachedReference::new(Expected::from_scene(scene, frame))),
            |(_, known)| known,
        );
        latest.push_front((index, Arc::clone(&known)));
        let bytes = |latest: &VecDeque<(usize, Arc<CachedReference>)>| {
            let bytes = latest.iter().map(|(_, known)| known.expected.bytes());
            bytes.sum::<usize>()
        };
        let in_frame =
            |latest: &VecDeque<(usize, _)>| latest.iter().filter(|(known, _)| *known == index).count();
        while in_frame(&latest) > MAX_CACHED_SCENES {
            let oldest = latest.iter().rposition(|(known, _)| *known == index);
            oldest.and_then(|at| latest.remove(at));
        }
        while latest.len() > 1 && bytes(&latest) > MAX_CACHED_BYTES {
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
    fn recently_used_scenes_are_cached() {
        let scenes = SceneCache::default();
        let frame = Frame {
            size: [64, 36],
            ..Frame::default()
        };
        let known = |title: &str| scenes.get(scene(title), 0, &frame);
        let first = known("0");
        for at in 1..MAX_CACHED_SCENES {
            known(&at.to_string());
        }
        assert!(Arc::ptr_eq(&first, &known("0")), "the last of eight");
        for at in 0..MAX_CACHED_SCENES {
            known(&format!("other {at}"));
        }
        assert!(!Arc::ptr_eq(&first, &known("0")));
        let other_frame = scenes.get(scene("0"), 1, &frame);
        assert!(!Arc::ptr_eq(&other_frame, &known("0")));
    }
}
