//! Processes shaders on several threads, each with its own context, and returns results in the order of the
//! shaders.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// Calls `work` for each of `todo` on `threads` threads, and `on_result` for each result as it arrives. Once
/// `stop` is set, no work is started; work in progress is finished.
pub(super) fn for_each<H, T: Send>(
    todo: &[usize],
    threads: usize,
    stop: &AtomicBool,
    context: impl Fn() -> H + Sync,
    work: impl Fn(&mut H, usize) -> T + Sync,
    mut on_result: impl FnMut(usize, T),
) {
    let next = AtomicUsize::new(0);
    let (results, inbox) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..threads.clamp(1, todo.len().max(1)) {
            let results = results.clone();
            let (next, context, work) = (&next, &context, &work);
            scope.spawn(move || {
                let mut context = context();
                while !stop.load(Ordering::Relaxed) {
                    let Some(&index) = todo.get(next.fetch_add(1, Ordering::Relaxed)) else {
                        break;
                    };
                    // The receiver is gone only if it panicked.
                    if results.send((index, work(&mut context, index))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(results);
        for (index, result) in inbox {
            on_result(index, result);
        }
    });
}

/// Creates a pool for the computations of one of `threads` threads, so that no thread waits for rows of
/// another's shader; `None` for a single thread. Each pool has twice its share of the cores: the last one
/// running then has more than its share, and until then the scheduler is fair.
pub(super) fn thread_pool(threads: usize) -> Option<ThreadPool> {
    let share = (2 * rayon::current_num_threads() / threads.max(1)).max(1);
    let pool = || ThreadPoolBuilder::new().num_threads(share).build().ok();
    (threads > 1).then(pool).flatten()
}

/// Reorders results: returns each as soon as all before it have arrived.
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
    /// Adds a result; returns those that are next in order.
    pub(super) fn take(&mut self, index: usize, result: T) -> Vec<T> {
        self.early.insert(index, result);
        let mut ready = Vec::new();
        while let Some(result) = self.early.remove(&self.next) {
            ready.push(result);
            self.next += 1;
        }
        ready
    }

    /// Returns the results that still wait for missing ones, in order.
    pub(super) fn rest(self) -> impl Iterator<Item = T> {
        self.early.into_values()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_task_runs_once_with_one_context_per_thread() {
        let stop = AtomicBool::new(false);
        let contexts = AtomicUsize::new(0);
        let todo: Vec<usize> = (0..100).filter(|index| index % 7 != 0).collect();
        let mut done = Vec::new();
        let context = || contexts.fetch_add(1, Ordering::Relaxed);
        for_each(
            &todo,
            3,
            &stop,
            context,
            |_, index| index * 2,
            |index, double| {
                assert_eq!(double, 2 * index);
                done.push(index);
            },
        );
        done.sort_unstable();
        assert_eq!(done, todo);
        assert_eq!(contexts.load(Ordering::Relaxed), 3);
    }

    #[test]
    fn no_task_starts_after_a_stop() {
        let stop = AtomicBool::new(false);
        let todo: Vec<usize> = (0..1000).collect();
        let mut done = 0;
        let work = |(): &mut (), index| {
            if index == 4 {
                stop.store(true, Ordering::Relaxed);
            }
        };
        for_each(&todo, 1, &stop, || (), work, |_, ()| done += 1);
        assert_eq!(done, 5);
    }

    #[test]
    fn early_results_wait() {
        let mut order = InOrder::default();
        assert_eq!(order.take(1, 'b'), []);
        assert_eq!(order.take(0, 'a'), ['a', 'b']);
        assert_eq!(order.take(4, 'e'), []);
        assert_eq!(order.rest().collect::<Vec<_>>(), ['e']);
    }
}
