//! Edits of the shader that [`export`](toyproof_scene::export) writes.

/// `(from, to)`. `from` stands exactly once in the text; a `…` in it stands for what comes up to the first occurrence of
/// what follows the `…`, and a `…` in `to` for the same.
pub(super) type Edit = (&'static str, &'static str);

/// The text after all edits, one after the other; none if one of them finds nothing to change, or too much.
pub(super) fn edited(text: &str, edits: &[(&str, &str)]) -> Option<String> {
    let mut text = text.to_owned();
    for (from, to) in edits {
        let (head, tail) = from.split_once('…').unwrap_or((from, ""));
        let mut starts = text.match_indices(head).map(|(at, _)| at);
        let start = starts.next().filter(|_| starts.next().is_none())?;
        let after = start + head.len();
        let between = text[after..].find(tail)?;
        let to = to.replace('…', &text[after..after + between]);
        text.replace_range(start..after + between + tail.len(), &to);
    }
    Some(text)
}

/// The exported shader as students write it, in each of the styles that matter. Right, they paint the same; with a mistake in
/// them they may not.
pub(super) fn styles(text: &str) -> Vec<String> {
    let mut first = text.to_owned();
    let rewrite = |text: &mut String, edits: &[Edit]| {
        if let Some(edited) = edited(text, edits) {
            *text = edited;
        }
    };
    if text.contains("const int SPHERES = 1;") {
        // Nothing stands between a single sphere and its light.
        rewrite(&mut first, &[NO_SHADOWS]);
    }
    if ["Plane", "Quadric", "Grid"]
        .iter()
        .all(|other| !text.contains(other))
    {
        rewrite(&mut first, &[ANY_SPHERE]);
        rewrite(&mut first, &[ANY_SPHERE_SOFT]);
    }
    let second = edited(&first, LEAST_T_IN_GLASS)
        .or_else(|| edited(&first, LEAST_T))
        .or_else(|| edited(&first, LEAST_T_OF_QUADRICS));
    [Some(first), second].into_iter().flatten().collect()
}

/// The shader with other offsets of secondary rays and least t's, as shares of the largest that the scene accepts.
pub(super) fn restyled(text: &str, max_offset: f64) -> Vec<String> {
    let all = RESTYLED.into_iter().map(|[offset, t_min]| {
        let [offset, t_min] = [offset * max_offset, (t_min * max_offset).max(LEAST)];
        // The written numbers stand nowhere else.
        text.replace(" 0.001 * ", &format!(" {offset:?} * "))
            .replace("> 0.00001", &format!("> {t_min:?}"))
            .replace("> 0.001)", &format!("> {t_min:?})"))
    });
    all.filter(|other| other != text).collect()
}

/// Offsets and least t's.
const RESTYLED: [[f64; 2]; 9] = [
    [1.0, 0.0],
    [0.5, 0.0],
    [0.2, 0.0],
    [0.1, 0.0],
    [0.01, 0.0],
    [0.0, 1.0],
    [0.0, 0.1],
    [1.0, 1.0],
    [0.1, 0.1],
];
/// Less is lost to rounding where a ray starts on its surface.
const LEAST: f64 = 1e-9;

pub(super) const NO_SHADOWS: Edit = (
    "if (cosine > 0.0 && !inShadow(hit, lights[i].position)) {",
    "if (cosine > 0.0) {",
);

/// A shadow ray asks each sphere, not for the nearest.
const ANY_SPHERE: Edit = (
    "    return nearestHit(Ray(origin, toLight / distance)).t < distance;",
    "    Ray ray = Ray(origin, toLight / distance);
    for (int i = 0; i < SPHERES; i++) {
        if (intersectSphere(ray, spheres[i]) < distance) {
            return true;
        }
    }
    return false;",
);

/// The same for lights with a radius.
const ANY_SPHERE_SOFT: Edit = (
    "    return nearestHit(Ray(origin, toLight)).t < distance;",
    "    Ray ray = Ray(origin, toLight);
    for (int i = 0; i < SPHERES; i++) {
        if (intersectSphere(ray, spheres[i]) < distance) {
            return true;
        }
    }
    return false;",
);

/// Reflected rays start on their surface, and hits nearer than that do not count.
const LEAST_T: &[Edit] = &[("Ray(hit.point + 0.001 * side,", "Ray(hit.point,"), NEAR, FAR];

/// The same where there is glass.
const LEAST_T_IN_GLASS: &[Edit] = &[
    ("Ray(hit.point + 0.001 * side,", "Ray(hit.point,"),
    ("Ray(hit.point - 0.001 * side,", "Ray(hit.point,"),
    NEAR,
    FAR,
];

/// Quadrics that are met at once do not count, either.
const LEAST_T_OF_QUADRICS: &[Edit] = &[
    ("if (ahead + near > 0.00001 ", "if (ahead + near > 0.001 "),
    ("if (ahead + beyond > 0.00001 ", "if (ahead + beyond > 0.001 "),
];

const NEAR: Edit = (
    "float t = -b - root;\n        if (t > 0.00001)",
    "float t = -b - root;\n        if (t > 0.001)",
);
const FAR: Edit = (
    "t = -b + root;\n        if (t > 0.00001)",
    "t = -b + root;\n        if (t > 0.001)",
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edit_finds_its_place_or_is_not_made() {
        assert_eq!(
            edited("f(x, -2.0)", &[("f(x, -…)", "g(…)")]).as_deref(),
            Some("g(2.0)")
        );
        assert_eq!(edited("a b", &[("a", "b"), ("b b", "c")]).as_deref(), Some("c"));
        assert_eq!(edited("a a", &[("a", "b")]), None);
        assert_eq!(edited("a", &[("b", "c")]), None);
    }
}
