//! Shares of pixels in words.

use toyproof_diagnostic::{grouped, plural};
use toyproof_verify::{MAX_DIFFERING, MAX_UNDEFINED, MAX_UNSTABLE, Share};

/// States how many pixels float32 renders imprecisely.
pub(super) fn imprecision(share: Share) -> String {
    format!(
        "{} visibly between float32 and double precision {}",
        count_with_verb(share, ["differs", "differ"]),
        percentage(share)
    )
}

/// Formats a subject and its verb: “1 of 230,400 pixels differs”.
pub(super) fn count_with_verb(share: Share, [one, many]: [&str; 2]) -> String {
    format!("{} {}", pixels(share), plural(share.count, one, many))
}

pub(super) fn pixels(share: Share) -> String {
    format!("{} of {} pixels", grouped(share.count), grouped(share.of))
}

/// The shares that decide a verdict.
const LIMITS: [f64; 3] = [MAX_DIFFERING, MAX_UNSTABLE, MAX_UNDEFINED];

/// Formats a share in parentheses, with one decimal, and more if it would look like a limit that it is not.
pub(super) fn percentage(share: Share) -> String {
    let ratio = share.ratio();
    if ratio < 0.001 && share.count > 0 {
        return "(under 0.1 %)".to_owned();
    }
    let text = |ratio: f64, decimals: usize| format!("({:.decimals$} %)", 100.0 * ratio);
    let is_clear = |&decimals: &usize| {
        let mut limits = LIMITS.iter();
        limits.all(|&limit| ratio == limit || text(ratio, decimals) != text(limit, decimals))
    };
    text(ratio, (1..6).find(is_clear).unwrap_or(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_beside_a_limit_does_not_look_like_the_limit() {
        for (count, of, text) in [
            (0, 57_600, "(0.0 %)"),
            (57, 57_600, "(under 0.1 %)"),
            (70, 57_600, "(0.12 %)"),
            (1, 1_000, "(0.1 %)"),
            (1_001, 1_000_000, "(0.1001 %)"),
            (31, 10_000, "(0.31 %)"),
            (49_999, 1_000_000, "(4.9999 %)"),
            (1, 2, "(50.0 %)"),
        ] {
            assert_eq!(percentage(Share { count, of }), text, "{count} of {of}");
        }
    }
}
