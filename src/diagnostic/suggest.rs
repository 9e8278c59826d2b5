//! What a misspelt name may have meant.

/// The candidate that a name is most likely a misspelling of, if any is likely; of equals, the first. Swapped, missing, added and
/// changed letters count one each, and a third of the name may be wrong. Case hardly counts: `smoothStep` is `smoothstep`.
pub fn nearest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let length = name.chars().count();
    // Names as long as these are nobody's typing, and would cost their square.
    if length > 64 {
        return None;
    }
    let lower = name.to_lowercase();
    let distance = |candidate: &str| match candidate {
        _ if candidate == name || candidate.is_empty() => None,
        // A number that counts something else is another name: `p1` is not `p2`.
        _ if length.abs_diff(candidate.len()) > length / 3 => None,
        _ if candidate.eq_ignore_ascii_case(name) => Some(0),
        _ => Some(strsim::osa_distance(&lower, &candidate.to_lowercase())),
    };
    candidates
        .into_iter()
        .filter_map(|candidate| Some((distance(candidate)?, candidate)))
        .filter(|&(distance, _)| distance <= length / 3)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_of_the_hand_are_found_and_other_words_are_not() {
        let names = [
            "smoothstep",
            "normalize",
            "fract",
            "dot",
            "iResolution",
            "x",
            "mix",
        ];
        for (written, meant) in [
            ("smoothStep", Some("smoothstep")),
            ("normalise", Some("normalize")),
            ("noramlize", Some("normalize")),
            ("frac", Some("fract")),
            ("dto", Some("dot")),
            ("iresolution", Some("iResolution")),
            ("y", None),
            ("colour", None),
            ("max", Some("mix")),
            ("dot", None),
            ("", None),
        ] {
            assert_eq!(nearest(written, names), meant, "{written}");
        }
        assert_eq!(nearest(&"x".repeat(100_000), names), None);
    }
}
