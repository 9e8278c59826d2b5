//! Which way runs when: within a budget, and interleaved, so that what slows the machine for a while slows all ways alike.

/// What runs ways, and has a clock: a mock in tests.
pub(super) trait Runner {
    /// Why it had to stop.
    type Failure;

    /// Runs a way; the seconds that its frame took, or none if it cannot run and is to be left out. `first`: it is warming up.
    fn run(&mut self, way: usize, first: bool) -> Result<Option<f64>, Self::Failure>;

    /// Seconds since the start.
    fn now(&self) -> f64;
}

/// No way is measured more often than this.
const MOST_RUNS: usize = 31;
/// How much longer a warm-up may take than the cheaper ones let think.
const MARGIN: f64 = 1.5;

/// What a way is thought to cost.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cost {
    /// Of ways of one kind, the cheap ones tell what the others will need.
    pub(super) kind: usize,
    /// In any unit.
    pub(super) size: f64,
}

/// What the ways of a kind have taken, in seconds.
#[derive(Debug, Clone, Copy, Default)]
struct Known {
    /// A frame, for each unit of cost.
    per_cost: f64,
    /// What surrounds a frame: what compiles it, say.
    around: f64,
}

impl Known {
    fn estimate(&self, cost: f64) -> f64 {
        self.around + MARGIN * self.per_cost * cost
    }

    /// `took`: the whole run; `frame`: its frame.
    fn learn(&mut self, cost: f64, took: f64, frame: f64) {
        // Cheap frames hold more than their samples: the dearer tell better.
        self.per_cost = (0.5 * self.per_cost).max(frame / cost.max(f64::MIN_POSITIVE));
        self.around = self.around.max(took - frame);
    }
}

/// The measured seconds of each way, its warm-up left out. A way whose warm-up the budget has no room for has none; cheap ones come first.
pub(super) fn measure<R: Runner>(
    runner: &mut R,
    costs: &[Cost],
    budget: f64,
) -> Result<Vec<Vec<f64>>, R::Failure> {
    let mut seconds: Vec<Vec<f64>> = vec![Vec::new(); costs.len()];
    // What a run costs, all that surrounds its frame included; none for ways that are left out.
    let mut needed: Vec<Option<f64>> = vec![None; costs.len()];
    let mut order: Vec<usize> = (0..costs.len()).collect();
    order.sort_by(|&a, &b| costs[a].size.total_cmp(&costs[b].size));
    let kinds = costs.iter().map(|cost| cost.kind + 1).max().unwrap_or(0);
    let mut known = vec![Known::default(); kinds];
    for &way in &order {
        let (start, Cost { kind, size }) = (runner.now(), costs[way]);
        if start + known[kind].estimate(size) > budget {
            continue;
        }
        if let Some(frame) = runner.run(way, true)? {
            let took = runner.now() - start;
            needed[way] = Some(took);
            known[kind].learn(size, took, frame);
        }
    }
    order.retain(|&way| needed[way].is_some());
    for round in 0..MOST_RUNS {
        let mut ran = false;
        // There and back again: no way always follows the same other.
        let turn = round * order.len() / 3;
        for i in 0..order.len() {
            let place = if round % 2 == 0 { i } else { order.len() - 1 - i };
            let way = order[(place + turn) % order.len()];
            let start = runner.now();
            if start + needed[way].unwrap_or(f64::INFINITY) > budget {
                continue;
            }
            if let Some(took) = runner.run(way, false)? {
                seconds[way].push(took);
                ran = true;
            }
            needed[way] = Some(runner.now() - start);
        }
        if !ran {
            break;
        }
    }
    Ok(seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ways that take what they are told to, on a clock of their own.
    #[derive(Default)]
    struct Mock {
        now: f64,
        /// Seconds of a frame, and of what surrounds it.
        takes: Vec<(f64, f64)>,
        ran: Vec<(usize, bool)>,
        broken: Option<usize>,
    }

    impl Runner for Mock {
        type Failure = ();

        fn run(&mut self, way: usize, first: bool) -> Result<Option<f64>, ()> {
            self.ran.push((way, first));
            let (frame, around) = self.takes[way];
            self.now += frame + around + if first { around } else { 0.0 };
            Ok((self.broken != Some(way)).then_some(frame))
        }

        fn now(&self) -> f64 {
            self.now
        }
    }

    fn costs(sizes: &[f64]) -> Vec<Cost> {
        sizes.iter().map(|&size| Cost { kind: 0, size }).collect()
    }

    fn mock(takes: &[(f64, f64)]) -> Mock {
        Mock {
            takes: takes.to_vec(),
            ..Mock::default()
        }
    }

    #[test]
    fn every_way_warms_up_once_and_is_then_measured_in_turn() {
        let mut mock = mock(&[(0.01, 0.0), (0.02, 0.01), (0.03, 0.0)]);
        let seconds = measure(&mut mock, &costs(&[1.0, 2.0, 3.0]), 1.0).unwrap();
        assert!(seconds.iter().all(|times| times.len() > 8), "{seconds:?}");
        assert_eq!(seconds[1][0], 0.02, "what surrounds a frame is not counted");
        assert_eq!(mock.ran.iter().filter(|(_, first)| *first).count(), 3);
        let counts = seconds.iter().map(Vec::len);
        assert!(counts.clone().max().unwrap() - counts.min().unwrap() <= 2);
        // Each way has followed each other one.
        let measured: Vec<_> = mock
            .ran
            .iter()
            .filter(|(_, first)| !first)
            .map(|(way, _)| *way)
            .collect();
        for (a, b) in [(0, 1), (1, 0), (0, 2), (2, 0), (1, 2), (2, 1)] {
            assert!(measured.windows(2).any(|pair| pair == [a, b]), "{a} before {b}");
        }
    }

    #[test]
    fn the_budget_is_kept_and_used() {
        for budget in [0.5, 2.0, 10.0] {
            let mut mock = mock(&[(0.01, 0.002), (0.1, 0.0), (0.3, 0.1), (4.0, 0.0)]);
            measure(&mut mock, &costs(&[1.0, 10.0, 30.0, 400.0]), budget).unwrap();
            assert!(mock.now <= 1.1 * budget, "{} of {budget}", mock.now);
            assert!(mock.now >= 0.5 * budget.min(4.0), "{} of {budget}", mock.now);
        }
    }

    #[test]
    fn what_the_budget_has_no_room_for_never_starts() {
        let mut mock = mock(&[(0.1, 0.0), (50.0, 0.0)]);
        let seconds = measure(&mut mock, &costs(&[1.0, 500.0]), 3.0).unwrap();
        assert!(seconds[1].is_empty() && seconds[0].len() > 20, "{seconds:?}");
    }

    #[test]
    fn what_one_kind_needs_says_nothing_of_another() {
        let mut mock = mock(&[(0.001, 1.0), (0.01, 0.0), (0.6, 0.0)]);
        let costs = [(0, 1.0), (1, 1.0), (1, 64.0)].map(|(kind, size)| Cost { kind, size });
        let seconds = measure(&mut mock, &costs, 10.0).unwrap();
        assert!(seconds.iter().all(|times| !times.is_empty()), "{seconds:?}");
    }

    #[test]
    fn a_way_that_cannot_run_is_left_out() {
        let mut mock = mock(&[(0.1, 0.0), (0.1, 0.0)]);
        mock.broken = Some(1);
        let seconds = measure(&mut mock, &costs(&[1.0, 1.0]), 1.0).unwrap();
        assert!(seconds[1].is_empty() && !seconds[0].is_empty());
        assert_eq!(mock.ran.iter().filter(|(way, _)| *way == 1).count(), 1);
    }

    #[test]
    fn cheap_ways_are_not_run_for_ever() {
        let mut mock = mock(&[(1e-6, 0.0)]);
        let seconds = measure(&mut mock, &costs(&[1.0]), 1e9).unwrap();
        assert_eq!(seconds[0].len(), MOST_RUNS);
    }
}
