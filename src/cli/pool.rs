//! Many shaders at a time: each thread with what it needs for itself, results told in the order of the shaders.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// Does `work` for each of `todo`, on so many threads. `arrived` is told of each result as it comes. No more work is begun once `stop` is
/// set; what was begun is finished.
pub(super) fn each<H, T: Send>(
    todo: &[usize],
    threads: usize,
    stop: &AtomicBool,
    hand: impl Fn() -> H + Sync,
    work: impl Fn(&mut H, usize) -> T + Sync,
    mut arrived: impl FnMut(usize, T),
) {
    let next = AtomicUsize::new(0);
    let (results, inbox) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..threads.clamp(1, todo.len().max(1)) {
            let results = results.clone();
            let (next, hand, work) = (&next, &hand, &work);
            scope.spawn(move || {
                let mut hand = hand();
                while !stop.load(Ordering::Relaxed) {
                    let Some(&index) = todo.get(next.fetch_add(1, Ordering::Relaxed)) else {
                        break;
                    };
                    // Nobody listens any more only if the listener panicked.
                    if results.send((index, work(&mut hand, index))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(results);
        for (index, result) in inbox {
            arrived(index, result);
        }
    });
}

/// A pool for what one of so many threads computes, so that none waits for another's rows; none for a thread that is alone. Each has twice its
/// share of the cores: whoever is last has more than its share, and until then the system is fair.
pub(super) fn own(threads: usize) -> Option<ThreadPool> {
    let share = (2 * rayon::current_num_threads() / threads.max(1)).max(1);
    let pool = || ThreadPoolBuilder::new().num_threads(share).build().ok();
    (threads > 1).then(pool).flatten()
}

/// Gives results out in order, each as soon as those before it are there.
#[derive(Debug)]
pub(super) struct InOrder<T> {
    next: usize,
    early: BTreeMap<usize, T>,
}

impl<T> Default for InOrder<T> {
    fn default() -> Self {
        Self {
            next: 0,
            early: BTreeMap::new(),
        }
    }
}

impl<T> InOrder<T> {
    /// Takes a result; gives those whose turn has come.
    pub(super) fn take(&mut self, index: usize, result: T) -> Vec<T> {
        self.early.insert(index, result);
        let mut ready = Vec::new();
        while let Some(result) = self.early.remove(&self.next) {
            ready.push(result);
            self.next += 1;
        }
        ready
    }

    /// Those that wait for others, which will not come.
    pub(super) fn rest(self) -> impl Iterator<Item = T> {
        self.early.into_values()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_is_done_once_by_as_many_hands_as_there_are_threads() {
        let stop = AtomicBool::new(false);
        let hands = AtomicUsize::new(0);
        let todo: Vec<usize> = (0..100).filter(|index| index % 7 != 0).collect();
        let mut done = Vec::new();
        let hand = || hands.fetch_add(1, Ordering::Relaxed);
        each(
            &todo,
            3,
            &stop,
            hand,
            |_, index| index * 2,
            |index, double| {
                assert_eq!(double, 2 * index);
                done.push(index);
            },
        );
        done.sort_unstable();
        assert_eq!(done, todo);
        assert_eq!(hands.load(Ordering::Relaxed), 3);
    }

    #[test]
    fn nothing_more_is_begun_after_a_stop() {
        let stop = AtomicBool::new(false);
        let todo: Vec<usize> = (0..1000).collect();
        let mut done = 0;
        let work = |(): &mut (), index| {
            if index == 4 {
                stop.store(true, Ordering::Relaxed);
            }
        };
        each(&todo, 1, &stop, || (), work, |_, ()| done += 1);
        assert_eq!(done, 5);
    }

    #[test]
    fn what_comes_early_waits() {
        let mut order = InOrder::default();
        assert_eq!(order.take(1, 'b'), []);
        assert_eq!(order.take(0, 'a'), ['a', 'b']);
        assert_eq!(order.take(4, 'e'), []);
        assert_eq!(order.rest().collect::<Vec<_>>(), ['e']);
    }
}
