//! The distribution of a batch of shaders over shards, which are checked on several machines.

/// How much a shard may exceed its share of the costs, relative to the share, so that most shaders stay in
/// the same shard when others come and go.
const SLACK: f64 = 0.05;

/// An item of the distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Item {
    /// The time that the item takes, in any unit. Expensive items are placed first, cheap ones fill the gaps.
    pub cost: u64,
    /// A hash of the content, which determines the shard.
    pub hash: u64,
}

/// Distributes items over shards of nearly equal cost; returns the shard of each item, from 1. The order of
/// the items does not matter.
///
/// Each item goes to the shard with its largest weight that has room: consistent hashing with bounded loads
/// (Mirrokni, Thorup and Zadimoghaddam 2018), by rendezvous hashing (Thaler and Ravishankar 1998).
///
/// # Panics
/// If there are no shards.
#[must_use]
pub fn distribute(items: &[Item], shards: u32) -> Vec<u32> {
    let mut order: Vec<usize> = (0..items.len()).collect();
    order.sort_by_key(|&at| std::cmp::Reverse(items[at]));
    let total: u64 = items.iter().map(|item| item.cost).sum();
    let capacity = (total as f64 / f64::from(shards) * (1.0 + SLACK)) as u64;
    let mut loads = vec![0; shards as usize];
    let mut result = vec![0; items.len()];
    for at in order {
        let Item { cost, hash } = items[at];
        let all = (0_u32..).zip(&loads);
        let with_room = all.clone().filter(|&(_, load)| load + cost <= capacity);
        let (shard, _) = with_room
            .max_by_key(|&(shard, _)| mix(hash ^ mix(u64::from(shard))))
            .or_else(|| all.min_by_key(|&(_, load)| load))
            .expect("there is at least one shard");
        loads[shard as usize] += cost;
        result[at] = shard + 1;
    }
    result
}

/// The finalizer of `SplitMix64` (Steele, Lea and Flood 2014).
fn mix(bits: u64) -> u64 {
    let bits = bits.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 400 items; every tenth is 20 times as expensive as the others.
    fn items() -> Vec<Item> {
        let cost = |at: u64| 1000 + at % 7 + if at.is_multiple_of(10) { 19_000 } else { 0 };
        (0..400)
            .map(|at| Item {
                hash: mix(at),
                cost: cost(at),
            })
            .collect()
    }

    #[test]
    fn shards_have_equal_costs() {
        for shards in [1, 2, 8, 13] {
            let items = items();
            let mut loads = vec![0; shards as usize];
            for (item, shard) in items.iter().zip(distribute(&items, shards)) {
                loads[shard as usize - 1] += item.cost;
            }
            let mean = items.iter().map(|item| item.cost).sum::<u64>() as f64 / f64::from(shards);
            let most = *loads.iter().max().unwrap() as f64;
            assert!(most <= mean * (1.0 + SLACK), "{shards}: {loads:?}");
        }
    }

    #[test]
    fn more_shards_than_shaders_leave_some_empty() {
        let items = &items()[..3];
        let mut shards = distribute(items, 8);
        shards.sort_unstable();
        shards.dedup();
        assert_eq!(shards.len(), 3);
        assert!(distribute(&[], 8).is_empty());
    }

    #[test]
    fn the_order_does_not_matter_and_a_new_item_moves_few_others() {
        let items = items();
        let before = distribute(&items, 8);
        let mut reversed = items.clone();
        reversed.reverse();
        let mut after = distribute(&reversed, 8);
        after.reverse();
        assert_eq!(before, after);
        let mut more = items;
        let new = Item {
            hash: mix(1000),
            cost: 1003,
        };
        more.push(new);
        let moved = before.iter().zip(distribute(&more, 8)).filter(|(a, b)| **a != *b);
        let moved = moved.count();
        assert!(moved <= 20, "{moved} of 400");
    }
}
