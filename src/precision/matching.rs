//! Which events of two runs are the same.

use crate::record::Event;

/// Name of the transition at the limit of an accumulation.
const REST: &str = "rest";

/// The events of a run beside those of a better one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Match {
    /// Events that both have.
    pub matched: usize,
    /// Events that the better run alone has.
    pub missed: usize,
    /// Events that the run alone has.
    pub extra: usize,
    /// Largest difference of the times of an event that both have, s.
    pub time: f64,
    /// Time of the first event that only one has, s; infinite if there is none.
    pub until: f64,
}

/// Matches the events of a run with those of a better one: in their order, by the names of their
/// transitions. Where the names differ, the earlier event is one that the other run does not have.
///
/// An accumulation has infinitely many events, of which a run records those that move the state by more
/// than its tolerances; then it comes to rest. So before a rest that both have, the last events of the
/// one that records more are neither missed nor extra.
pub fn match_events(run: &[Event], better: &[Event]) -> Match {
    let mut found = Match {
        until: f64::INFINITY,
        ..Match::default()
    };
    let (mut i, mut j) = (0, 0);
    while i < run.len() || j < better.len() {
        match (run.get(i), better.get(j)) {
            (Some(a), Some(b)) if a.transition == b.transition => {
                found.matched += 1;
                found.time = found.time.max((a.t - b.t).abs());
                (i, j) = (i + 1, j + 1);
            }
            (Some(a), Some(_)) if a.transition == REST && tail(&better[j..]) > 0 => {
                j += tail(&better[j..]);
            }
            (Some(_), Some(b)) if b.transition == REST && tail(&run[i..]) > 0 => {
                i += tail(&run[i..]);
            }
            (Some(a), b) if b.is_none_or(|b| a.t <= b.t) => {
                found.extra += 1;
                found.until = found.until.min(a.t);
                i += 1;
            }
            (_, Some(b)) => {
                found.missed += 1;
                found.until = found.until.min(b.t);
                j += 1;
            }
            (_, None) => unreachable!("a remaining event of the run is extra"),
        }
    }
    found
}

/// Number of events before the next rest; 0 where there is none.
fn tail(events: &[Event]) -> usize {
    events
        .iter()
        .position(|event| event.transition == REST)
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Jump;

    fn events(list: &[(&'static str, f64)]) -> Vec<Event> {
        let event = |(j, &(transition, t)): (usize, &(&'static str, f64))| {
            let jump = Jump {
                t,
                j: j as u64 + 1,
                transition,
                from: 0,
                to: 0,
                energy: None,
            };
            Event::new(&jump, Default::default())
        };
        list.iter().enumerate().map(event).collect()
    }

    fn counts(run: &[(&'static str, f64)], better: &[(&'static str, f64)]) -> [usize; 3] {
        let found = match_events(&events(run), &events(better));
        [found.matched, found.missed, found.extra]
    }

    #[test]
    fn events_are_matched_in_their_order() {
        let better = [("slip", 1.0), ("stick", 2.0), ("slip", 3.0), ("stick", 4.0)];
        assert_eq!(counts(&better, &better), [4, 0, 0]);
        let late = better.map(|(name, t)| (name, t + 0.125));
        assert_eq!(match_events(&events(&late), &events(&better)).time, 0.125);
        // One stick and slip left out, one added, and one at the end.
        assert_eq!(counts(&[better[0], better[3]], &better), [2, 2, 0]);
        assert_eq!(counts(&better, &[better[0], better[3]]), [2, 0, 2]);
        assert_eq!(counts(&better[..3], &better), [3, 1, 0]);
        assert_eq!(counts(&[], &better), [0, 4, 0]);
        let missing = match_events(&events(&better[..2]), &events(&better));
        assert_eq!(missing.until, 3.0);
    }

    #[test]
    fn the_tail_of_an_accumulation_is_neither_missed_nor_extra() {
        let long = [
            ("land", 1.0),
            ("land", 1.5),
            ("land", 1.75),
            ("rest", 2.0),
            ("lift", 5.0),
        ];
        let short = [("land", 1.0), ("land", 1.5), ("rest", 2.0), ("lift", 5.0)];
        assert_eq!(counts(&short, &long), [4, 0, 0]);
        assert_eq!(counts(&long, &short), [4, 0, 0]);
        // A rest that only one has is missed, with what comes after.
        assert_eq!(counts(&long[..3], &long), [3, 2, 0]);
    }
}
