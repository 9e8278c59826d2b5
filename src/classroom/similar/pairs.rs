//! Pairs and groups of shaders that share much of their structure.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::fingerprint::Fingerprints;

/// Shaders with fewer fingerprints are too small to compare.
const MIN_FINGERPRINTS: usize = 8;

/// A shader to compare.
#[derive(Debug)]
pub struct Subject {
    /// The name.
    pub name: String,
    /// The fingerprints of the tree; `None` if the shader does not compile.
    pub tree: Option<Fingerprints>,
    /// The fingerprints of the text.
    pub text: Fingerprints,
}

impl Subject {
    /// The fingerprints with which the shader is compared, unless the other one does not compile.
    fn preferred(&self) -> &Fingerprints {
        self.tree.as_ref().unwrap_or(&self.text)
    }

    /// Whether the shader has enough fingerprints to be compared.
    #[must_use]
    pub fn is_large_enough(&self) -> bool {
        self.preferred().count() >= MIN_FINGERPRINTS
    }

    /// The fingerprints of both shaders that are compared: of trees, or else of texts.
    #[must_use]
    pub fn comparable<'a>(&'a self, other: &'a Self) -> [&'a Fingerprints; 2] {
        match (&self.tree, &other.tree) {
            (Some(one), Some(other)) => [one, other],
            _ => [&self.text, &other.text],
        }
    }
}

/// Removes the fingerprints that everyone may have: those of the `excepted` shaders, and those that more than
/// half of the shaders have, if there are enough shaders for this.
pub fn leave_out_common(shaders: &mut [Subject], excepted: &mut [Subject]) {
    leave_out(shaders, excepted, |shader| shader.tree.as_mut());
    leave_out(shaders, excepted, |shader| Some(&mut shader.text));
}

/// Removes one kind of fingerprints.
fn leave_out(
    shaders: &mut [Subject],
    excepted: &mut [Subject],
    kind: fn(&mut Subject) -> Option<&mut Fingerprints>,
) {
    const ENOUGH: usize = 6;
    let mut all: Vec<_> = shaders.iter_mut().filter_map(kind).collect();
    let mut counts: HashMap<u64, usize> = HashMap::new();
    for hash in all.iter().flat_map(|fingerprints| fingerprints.hashes()) {
        *counts.entry(hash).or_default() += 1;
    }
    let is_common = |&(_, count): &(u64, usize)| all.len() >= ENOUGH && 2 * count > all.len();
    let common = counts.into_iter().filter(is_common).map(|(hash, _)| hash);
    let excepted = excepted.iter_mut().filter_map(kind);
    let left_out: HashSet<u64> = common
        .chain(excepted.flat_map(|fingerprints| fingerprints.hashes().collect::<Vec<_>>()))
        .collect();
    for fingerprints in &mut all {
        fingerprints.remove(&left_out);
    }
}

/// Two shaders that share much of their structure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// The indices of both shaders, in ascending order.
    pub shaders: [usize; 2],
    /// The shared part of the smaller shader, from 0 to 1.
    pub share: f64,
}

/// The pairs that share at least the part `threshold` of the smaller shader, the most similar first.
#[must_use]
pub fn pairs(shaders: &[Subject], threshold: f64) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for (b, other) in shaders.iter().enumerate() {
        for (a, one) in shaders[..b].iter().enumerate() {
            let [of_one, of_other] = one.comparable(other);
            let smaller = of_one.count().min(of_other.count());
            let share = of_one.shared(of_other) as f64 / smaller as f64;
            if smaller >= MIN_FINGERPRINTS && share >= threshold {
                pairs.push(Pair {
                    shaders: [a, b],
                    share,
                });
            }
        }
    }
    pairs.sort_by(|a, b| b.share.total_cmp(&a.share).then(a.shaders.cmp(&b.shaders)));
    pairs
}

/// The connected shaders of all pairs, by their indices.
#[must_use]
pub fn groups(pairs: &[Pair]) -> Vec<Vec<usize>> {
    let mut of: BTreeMap<usize, usize> = BTreeMap::new();
    for &Pair { shaders: [a, b], .. } in pairs {
        let [first, second] = [a, b].map(|at| of.get(&at).copied().unwrap_or(at));
        let group = first.min(second);
        of.entry(a).or_insert(first);
        of.entry(b).or_insert(second);
        for value in of.values_mut().filter(|value| [first, second].contains(value)) {
            *value = group;
        }
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (at, group) in of {
        groups.entry(group).or_default().push(at);
    }
    groups.into_values().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_with_a_common_shader_are_a_group() {
        let pairs = [[0, 1], [4, 5], [2, 3], [1, 3]].map(|shaders| Pair { shaders, share: 0.8 });
        let groups = groups(&pairs);
        assert_eq!(groups, [vec![0, 1, 2, 3], vec![4, 5]]);
    }
}
