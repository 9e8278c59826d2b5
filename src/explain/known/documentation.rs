//! What the guide and `toyproof explain` say about each mistake, collected from beside the definitions.

pub use super::documented::{Documented, Topic};
use super::{catalogue, change, numbers};
use crate::{repair, whole_image};

/// Returns every mistake that can be reported, by topic.
pub fn all() -> impl Iterator<Item = Documented> {
    Topic::ALL
        .iter()
        .flat_map(|&topic| by_definition().filter(move |mistake| mistake.topic == topic))
}

fn by_definition() -> impl Iterator<Item = Documented> {
    let others = [
        super::SELF_INTERSECTION,
        whole_image::DIFFERENCES,
        whole_image::SCENES,
        numbers::DOCUMENTED,
        repair::DOCUMENTED,
    ];
    let others = others.into_iter().flatten().copied();
    let all = change::documented().chain(catalogue::documented()).chain(others);
    all.map(|mistake| Documented {
        fix: mistake.fix.trim_ascii(),
        ..mistake
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::sync::Arc;

    use toyproof_image::Frame;
    use toyproof_scene::FrameTime;

    use super::*;
    use crate::known::exercises::scenes;
    use crate::known::view::View;
    use crate::known::{KnownMistake, mutant};

    /// For each id the form of the description and the fix.
    fn rows() -> BTreeMap<&'static str, [&'static str; 2]> {
        let mut rows = BTreeMap::new();
        for Documented { id, form, fix, .. } in super::all() {
            assert!(rows.insert(id, [form, fix]).is_none(), "{id} is documented twice");
        }
        rows
    }

    /// Every mistake that can be reported for a test scene, with an example of each computed description.
    fn known_mistakes() -> Vec<KnownMistake> {
        let mut all = vec![crate::known::self_intersection()];
        all.extend(repair::mistakes());
        all.extend(whole_image::examples());
        all.extend(catalogue::all().map(catalogue::Mistake::known));
        let frame_time = FrameTime { frame: 10, time: 1.3 };
        for scene in scenes() {
            let general = change::general(&scene, frame_time);
            let changes = general.into_iter().chain(change::all(&scene, frame_time));
            all.extend(changes.map(|change| change.mistake));
            let shader = mutant::variants(&scene).into_iter().next();
            let view = Arc::new(View::new(&Frame::default(), 1, 1));
            let (scene, shader, view) = (&scene, shader.as_ref(), &view);
            all.extend(
                numbers::Parameters {
                    scene,
                    frame_time,
                    shader,
                    view,
                }
                .examples(),
            );
        }
        all
    }

    /// Whether a text has a form in which each “…” stands for any text.
    fn has_form(text: &str, form: &str) -> bool {
        let Some((start, rest)) = form.split_once('…') else {
            return text == form;
        };
        text.strip_prefix(start).is_some_and(|text| {
            let mut ends = text.char_indices().map(|(at, _)| at).chain([text.len()]);
            ends.any(|at| has_form(&text[at..], rest))
        })
    }

    #[test]
    fn every_mistake_is_documented() {
        let rows = rows();
        let mut descriptions = BTreeMap::<_, Vec<String>>::new();
        for mistake in known_mistakes() {
            let description = mistake.description.into_owned();
            descriptions.entry(mistake.id).or_default().push(description);
        }
        for (id, descriptions) in &descriptions {
            let Some([form, fix]) = rows.get(id) else {
                panic!("{id} is not documented: {descriptions:?}");
            };
            assert!(
                descriptions.iter().any(|description| has_form(description, form)),
                "{id} is documented as “{form}”, but reported as {descriptions:?}"
            );
            assert!(fix.ends_with('.'), "{id}: {fix}");
        }
        for id in rows.keys() {
            assert!(
                descriptions.contains_key(id),
                "{id} is documented, but never reported"
            );
        }
    }

    #[test]
    fn every_mistake_in_the_catalogue_is_documented_as_it_is_reported() {
        let rows = rows();
        for mistake in catalogue::all().map(catalogue::Mistake::known) {
            let documented = rows.get(mistake.id).map(|[description, _]| *description);
            assert_eq!(documented, Some(&*mistake.description), "{}", mistake.id);
        }
    }

    #[test]
    fn descriptions_are_phrases() {
        for KnownMistake { id, description, .. } in known_mistakes() {
            let is_phrase = !description.ends_with('.') && !description.contains(['|', '\n', '…']);
            let starts_low = description.starts_with(char::is_lowercase);
            let starts_with_symbol = ["N·L", "MIS", "Schlick"]
                .iter()
                .any(|symbol| description.starts_with(symbol));
            assert!(
                is_phrase && (starts_low || starts_with_symbol),
                "{id}: {description}"
            );
        }
    }
}
