//! Which events of two runs are the same.

use super::TOLERANCES;
use crate::hybrid::LONGEST_PATTERN;
use crate::record::{Event, LimitState};

/// Name of the transition at the limit of an accumulation.
const REST: &str = "rest";

/// Room for the table of choices, in bytes: one a pair of events.
const ROOM: usize = 100_000_000;

/// The events of a run beside those of a better one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Match {
    /// Events that both have.
    pub matched: usize,
    /// Events that the better run alone has.
    pub missed: usize,
    /// Events that the run alone has.
    pub extra: usize,
    /// Events that one of the two alone has, in the tails of accumulations: no errors.
    pub in_tails: usize,
    /// Largest difference of the times of an event that both have, s.
    pub time: f64,
    /// Time of the last event before `until`, s; 0 if there is none.
    pub common: f64,
    /// Difference of its two times, s.
    pub apart: f64,
    /// Time of the first event that is missed or extra, or whose two times differ by more than the
    /// loosest tolerance of a study, relative, s; infinite if there is none.
    pub until: f64,
}

/// What becomes of the next event of the run or of the better one.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Choice {
    /// They are the same.
    Pair,
    /// The run is at a rest; the better run has the tail of the accumulation before it.
    TailOfBetter,
    /// The better run is at a rest; the run has the tail of the accumulation before it.
    TailOfRun,
    /// The better run alone has it.
    Missed,
    /// The run alone has it.
    Extra,
}

/// Price of a matching: the first counts, the second decides between equals.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
struct Price {
    /// Events that are missed or extra.
    unmatched: u32,
    /// Sum of the differences of time, s.
    apart: f64,
}

impl Price {
    fn pair(self, a: &Event, b: &Event) -> Price {
        Price {
            apart: self.apart + (a.t - b.t).abs(),
            ..self
        }
    }
    fn unmatched(self) -> Price {
        Price {
            unmatched: self.unmatched + 1,
            ..self
        }
    }
}

impl Match {
    /// Takes note of an event that both have.
    fn pair(&mut self, a: &Event, b: &Event) {
        let (apart, first) = ((a.t - b.t).abs(), a.t.min(b.t));
        self.matched += 1;
        self.time = self.time.max(apart);
        if apart > TOLERANCES[0] * b.t {
            self.until = self.until.min(first);
        }
        if self.until.is_infinite() {
            (self.common, self.apart) = (first, apart);
        }
    }

    /// Takes note of an event that the better run alone has.
    fn missed(&mut self, event: &Event) {
        self.missed += 1;
        self.until = self.until.min(event.t);
    }

    /// Takes note of an event that the run alone has.
    fn extra(&mut self, event: &Event) {
        self.extra += 1;
        self.until = self.until.min(event.t);
    }

    /// Takes note of the limit states of both runs: at one that ends them they end at times of their own.
    pub(super) fn add_limits(&mut self, run: &[LimitState], better: &[LimitState]) {
        let of = |all: &[LimitState], name: &str| all.iter().find(|s| s.name == name).map(|s| s.t);
        for LimitState { name, t, .. } in run {
            match of(better, name) {
                Some(exact) => {
                    let (apart, first) = ((t - exact).abs(), t.min(exact));
                    self.time = self.time.max(apart);
                    if apart > TOLERANCES[0] * exact {
                        self.until = self.until.min(first);
                    } else if first < self.until {
                        self.common = self.common.max(first);
                    }
                }
                None => {
                    self.extra += 1;
                    self.until = self.until.min(*t);
                }
            }
        }
        for LimitState { t, .. } in better.iter().filter(|s| of(run, &s.name).is_none()) {
            self.missed += 1;
            self.until = self.until.min(*t);
        }
    }
}

/// Matches the events of a run with those of a better one: in their order, by the names of their
/// transitions. Of all such matchings it takes one with the fewest events missed or extra, and of
/// those the one whose times differ the least.
///
/// An accumulation has infinitely many events, of which a run records those that move the state by more
/// than its tolerances; then it comes to rest. So right before a rest that both have, what only one of
/// them records is neither missed nor extra, as long as the other has such transitions in that
/// accumulation's pattern too. Where a run comes to rest too early, the time of the rest says so.
///
/// Where a table of all pairs of events would not fit the memory, all events after the first difference
/// count as missed and extra.
pub fn match_events(run: &[Event], better: &[Event]) -> Match {
    let mut found = Match {
        until: f64::INFINITY,
        ..Match::default()
    };
    let same = |(a, b): &(&Event, &Event)| a.transition == b.transition;
    let equal = run.iter().zip(better).take_while(same).count();
    let all = equal == run.len() && equal == better.len();
    if all || (run.len() + 1).saturating_mul(better.len() + 1) > ROOM {
        (0..equal).for_each(|i| found.pair(&run[i], &better[i]));
        better[equal..].iter().for_each(|event| found.missed(event));
        run[equal..].iter().for_each(|event| found.extra(event));
        return found;
    }
    let choices = choices(run, better);
    let (mut j, mut i) = (0, 0);
    while let Some(choice) = choices[j * (better.len() + 1) + i] {
        match choice {
            Choice::Missed => {
                found.missed(&better[i]);
                i += 1;
            }
            Choice::Extra => {
                found.extra(&run[j]);
                j += 1;
            }
            Choice::Pair | Choice::TailOfBetter | Choice::TailOfRun => {
                while run[j].transition != better[i].transition {
                    found.in_tails += 1;
                    match choice {
                        Choice::TailOfBetter => i += 1,
                        _ => j += 1,
                    }
                }
                found.pair(&run[j], &better[i]);
                (j, i) = (j + 1, i + 1);
            }
        }
    }
    found
}

/// The cheapest choice for what is left from event `j` of the run and `i` of the better one on, at
/// `j * (better.len() + 1) + i`; `None` where nothing is left.
fn choices(run: &[Event], better: &[Event]) -> Vec<Option<Choice>> {
    let (n, m) = (better.len(), run.len());
    let (rests, rests_of_run) = (Rests::new(better), Rests::new(run));
    let mut choices = vec![None; (n + 1) * (m + 1)];
    let mut prices = vec![Price::default(); n + 1];
    // The prices after event j of the run, and after its next rest.
    let mut next = prices.clone();
    let mut after_rest = prices.clone();
    for j in (0..=m).rev() {
        std::mem::swap(&mut prices, &mut next);
        let own = run.get(j);
        if own.is_some_and(|event| event.transition == REST) {
            after_rest.copy_from_slice(&next);
        }
        for i in (0..=n).rev() {
            let mut best: Option<(Price, Choice)> = None;
            let mut offer = |price: Price, choice| {
                if best.is_none_or(|(least, _)| price < least) {
                    best = Some((price, choice));
                }
            };
            if let (Some(a), Some(b)) = (own, better.get(i)) {
                if a.transition == b.transition {
                    offer(next[i + 1].pair(a, b), Choice::Pair);
                } else if a.transition == REST
                    && let Some(rest) = rests.tail(i, rests_of_run.pattern(j))
                {
                    offer(next[rest + 1].pair(a, &better[rest]), Choice::TailOfBetter);
                } else if b.transition == REST
                    && let Some(rest) = rests_of_run.tail(j, rests.pattern(i))
                {
                    offer(after_rest[i + 1].pair(&run[rest], b), Choice::TailOfRun);
                }
            }
            if i < n {
                offer(prices[i + 1].unmatched(), Choice::Missed);
            }
            if j < m {
                offer(next[i].unmatched(), Choice::Extra);
            }
            prices[i] = best.map_or(Price::default(), |(price, _)| price);
            choices[j * (n + 1) + i] = best.map(|(_, choice)| choice);
        }
    }
    choices
}

/// The rests among events.
struct Rests<'a> {
    events: &'a [Event],
    /// Of each event the index of the next rest, itself included.
    next: Vec<Option<usize>>,
    /// Of each event the index after the last rest before it.
    begin: Vec<usize>,
}

impl<'a> Rests<'a> {
    fn new(events: &'a [Event]) -> Self {
        let is_rest = |i: usize| events[i].transition == REST;
        let mut next = vec![None; events.len()];
        let mut following = None;
        for i in (0..events.len()).rev() {
            following = if is_rest(i) { Some(i) } else { following };
            next[i] = following;
        }
        let mut start = 0;
        let begin = (0..events.len()).map(|i| {
            let begin = start;
            if is_rest(i) {
                start = i + 1;
            }
            begin
        });
        Rests {
            begin: begin.collect(),
            events,
            next,
        }
    }

    /// Events with all transitions of the pattern that leads to the one at `rest`.
    fn pattern(&self, rest: usize) -> &[Event] {
        let begin = self.begin[rest].max(rest.saturating_sub(LONGEST_PATTERN));
        &self.events[begin..rest]
    }

    /// The rest after the event at `i`, if all transitions up to it are those of `pattern`.
    fn tail(&self, i: usize, pattern: &[Event]) -> Option<usize> {
        let rest = self.next[i]?;
        let known = |event: &Event| pattern.iter().any(|k| k.transition == event.transition);
        self.events[i..rest].iter().all(known).then_some(rest)
    }
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
    fn a_pair_that_is_left_out_is_found_by_the_times_of_the_others() {
        let better: Vec<_> = (0..20)
            .map(|k| (["slip", "stick"][k % 2], k as f64))
            .collect();
        let run: Vec<_> = [&better[..6], &better[8..]].concat();
        let found = match_events(&events(&run), &events(&better));
        assert_eq!((found.matched, found.missed, found.extra), (18, 2, 0));
        assert_eq!((found.time, found.common, found.until), (0.0, 5.0, 6.0));
        // The same in their order, but one is too late to be the same motion.
        let mut run = better.clone();
        run[7].1 += 0.006;
        assert_eq!(
            match_events(&events(&run), &events(&better)).until,
            f64::INFINITY
        );
        run[7].1 += 0.002;
        let found = match_events(&events(&run), &events(&better));
        assert_eq!((found.missed, found.common, found.until), (0, 6.0, 7.0));
        // Another transition in place of one, and one more.
        let mut run = better.clone();
        run[3].0 = "land";
        run.insert(10, ("slip", 9.5));
        assert_eq!(counts(&run, &better), [19, 1, 2]);
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
        assert_eq!(
            match_events(&events(&short), &events(&long)).in_tails,
            1,
            "one landing"
        );
        // A rest that only one has is missed, with what comes after.
        assert_eq!(counts(&long[..3], &long), [3, 2, 0]);
        // Hops are the same in their order, although the loose run is as late as a hop is long.
        let late = short.map(|(name, t)| (name, t + 0.3));
        assert_eq!(counts(&late, &long), [4, 0, 0]);
    }

    #[test]
    fn what_does_not_belong_to_the_accumulation_is_missed_before_its_rest_too() {
        let short = [("land", 1.0), ("land", 1.5), ("rest", 2.0)];
        let slips = [
            ("land", 1.0),
            ("land", 1.5),
            ("slip", 1.6),
            ("land", 1.75),
            ("rest", 2.0),
        ];
        let found = match_events(&events(&short), &events(&slips));
        assert_eq!(
            [found.matched, found.missed, found.in_tails],
            [3, 1, 1],
            "{found:?}"
        );
        assert_eq!(found.until, 1.6);
        // Nor is it the tail of an accumulation that begins after another rest.
        let again = [&short[..], &[("slip", 3.0), ("rest", 4.0)]].concat();
        let landed = [&short[..], &[("slip", 3.0), ("land", 3.5), ("rest", 4.0)]].concat();
        assert_eq!(counts(&again, &landed), [5, 1, 0]);
    }
}
