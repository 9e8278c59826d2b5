//! Two stories of one pixel, put side by side.

use toyproof_eval::{EventId, Happened, Plot, Story, Told, What};

/// Something that happened in one story or in both.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// What.
    pub event: EventId,
    /// When.
    pub(super) moment: Moment,
    /// Its value in f32; none if it did not happen there.
    pub single: Option<Vec<Told>>,
    /// Its value in f64.
    pub double: Option<Vec<Told>>,
}

impl Step {
    /// In which round of each loop around it, the outermost first, from 1.
    #[must_use]
    pub fn rounds(&self) -> Vec<u32> {
        let rounds = self.moment.iter().map(|&(_, round)| round);
        rounds.filter(|&round| round > 0).collect()
    }

    /// The values of both, component by component, if it happened in both.
    pub fn pairs(&self) -> impl Iterator<Item = (Told, Told)> {
        let both = self.single.iter().flatten().zip(self.double.iter().flatten());
        both.map(|(&single, &double)| (single, double))
    }

    /// The component that differs most, by its number, with its value in f32 and in f64; none of what happened in one only.
    #[must_use]
    pub fn worst(&self) -> Option<(usize, Told, Told)> {
        let distance = |pair: (Told, Told)| match pair {
            (Told::Float(single), Told::Float(double)) => distance(single, double),
            (single, double) => f64::from(u8::from(single != double)),
        };
        let pairs = self.pairs().enumerate();
        let worst = pairs.reduce(|a, b| if distance(b.1) > distance(a.1) { b } else { a });
        worst.map(|(at, (single, double))| (at, single, double))
    }

    /// The largest distance of a float from its f64, in units in the last place of f32; none without floats in both.
    #[must_use]
    pub fn ulps(&self) -> Option<f64> {
        let distances = self.pairs().filter_map(|pair| match pair {
            (Told::Float(single), Told::Float(double)) => Some(ulps(single, double)),
            _ => None,
        });
        distances.reduce(|a, b| if a >= b { a } else { b })
    }
}

/// How far two numbers are apart; infinitely if one is NaN or infinite alone.
pub(super) fn distance(single: f64, double: f64) -> f64 {
    if single == double || (single.is_nan() && double.is_nan()) {
        return 0.0;
    }
    let distance = (single - double).abs();
    if distance.is_finite() {
        distance
    } else {
        f64::INFINITY
    }
}

/// How far an f32 is from an f64, in units in the last place that f32 has at that f64; infinite if one is NaN or infinite alone.
#[must_use]
pub fn ulps(single: f64, double: f64) -> f64 {
    // Of denormals, which are flushed, the unit is that of the smallest normal number.
    let scale = double.abs().max(f64::from(f32::MIN_POSITIVE));
    let exponent = ((scale.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    distance(single, double) / f64::from(exponent - 23).exp2()
}

/// When something happened: the loops around it with their rounds, then the event. In the order of a run.
pub(super) type Moment = Vec<(EventId, u32)>;

/// Finds the moment of each event of a story.
struct Clock<'a> {
    plot: &'a Plot,
    /// The loops that run, with their rounds.
    loops: Moment,
}

impl Clock<'_> {
    fn moment(&mut self, event: EventId) -> Moment {
        let around = self.plot.rounds(event);
        let is_round = self.plot.event(event).what == What::Round;
        let known = self.loops.iter().zip(&around);
        let same = known
            .take_while(|((running, _), round)| running == *round)
            .count();
        self.loops.truncate(same);
        if is_round {
            match self.loops.last_mut() {
                Some((running, round)) if *running == event => *round += 1,
                _ => self.loops.push((event, 1)),
            }
            return self.loops.clone();
        }
        let mut moment = self.loops.clone();
        moment.push((event, 0));
        moment
    }
}

/// Puts two stories side by side: both are in the order of their moments.
pub(super) fn merge(plot: &Plot, single: &Story, double: &Story) -> Vec<Step> {
    let (mut singles, mut doubles) = (timed(plot, single), timed(plot, double));
    let mut steps = Vec::new();
    loop {
        let order = match (singles.peek(), doubles.peek()) {
            (None, None) => return steps,
            (Some(_), None) => std::cmp::Ordering::Less,
            (None, Some(_)) => std::cmp::Ordering::Greater,
            (Some((single, _)), Some((double, _))) => single.cmp(double),
        };
        let single = if order.is_le() { singles.next() } else { None };
        let double = if order.is_ge() { doubles.next() } else { None };
        let Some((moment, event)) = [&single, &double]
            .into_iter()
            .flatten()
            .map(|(moment, happened)| (moment.clone(), happened.event))
            .next()
        else {
            return steps;
        };
        let values =
            |happened: Option<(Moment, &Happened)>| happened.map(|(_, happened)| happened.values.clone());
        steps.push(Step {
            event,
            moment,
            single: values(single),
            double: values(double),
        });
    }
}

/// The events of a story with their moments.
fn timed<'a>(
    plot: &'a Plot,
    story: &'a Story,
) -> std::iter::Peekable<impl Iterator<Item = (Moment, &'a Happened)>> {
    let mut clock = Clock {
        plot,
        loops: Moment::new(),
    };
    let happened = story.happened.iter();
    happened
        .map(move |happened| (clock.moment(happened.event), happened))
        .peekable()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_counted_in_units_of_f32() {
        assert_eq!(ulps(1.0, 1.0), 0.0);
        assert_eq!(ulps(1.0 + f64::from(f32::EPSILON), 1.0), 1.0);
        assert_eq!(ulps(-2.0, -2.0 - 0.5 * f64::from(f32::EPSILON)), 0.25);
        assert_eq!(ulps(f64::NAN, f64::NAN), 0.0);
        assert_eq!(ulps(f64::NAN, 1.0), f64::INFINITY);
        assert_eq!(ulps(f64::INFINITY, f64::INFINITY), 0.0);
        assert_eq!(ulps(f64::INFINITY, 1.0), f64::INFINITY);
        // Beside zero the unit is that of the smallest number that is not flushed.
        assert_eq!(ulps(f64::from(f32::MIN_POSITIVE), 0.0), f64::from(1u32 << 23));
    }
}
