//! Which method is the faster one in a mode: the explicit one, unless stiffness holds it back.
//!
//! An explicit method is stiff where its steps follow a rate that the motion no longer shows. Two
//! signs of that start a trial of the implicit method, and the lengths of its steps decide.
//!
//! Stiffness may come and go while a mode lasts: a stop that is a stiff spring, a damper that state or
//! input engages. So a verdict is open again after some steps, and after twice as many each time that it
//! turns out to be the same: what that costs falls off with the length of the run. And the implicit method
//! is given up as soon as a row of its steps, of one segment or of several short ones, is no longer than what
//! the explicit method makes at the same cost.

use crate::numerics::{Memory, Persist, persist};

/// Cost of a step of Radau IIA in steps of the Taylor method. Measured on the benchmark problems: 1.5 (one
/// coordinate, linear equations) to 4 (the walking tank at loose tolerances); stiffness exceeds that by far.
const COST: f64 = 3.0;

/// Steps that may be lost before a trial: fewer than a stiff segment loses.
const PATIENCE: f64 = 8.0;

/// Time constants of the fastest decay after which nothing of it is left that matters: e⁻²⁴ = 4e-11.
const DECAYED: f64 = 24.0;

/// Steps of a trial: enough for steps that may grow eightfold each time from a transient's to those
/// of the motion behind it.
const TRIAL: u32 = 16;

/// Steps of the implicit method in a row none of which is longer than what the explicit one makes at the
/// same cost, before it is given up: they have lost what a new trial costs, at most.
const IDLE: u32 = 8;

/// Steps for which the first verdict holds. To reach it again takes the implicit method's trial and as
/// many steps of the explicit one: some thirty, 3 % of these.
const TERM: u32 = 1024;

/// Steps of a segment between two looks at the rate of its fastest decay.
const BETWEEN_DECAYS: u32 = 8;

/// Steps still to be made, from which on a run by the explicit method alone is refused where decays that are over set
/// their length: it would take minutes to years, and the implicit method a second.
const HOPELESS: f64 = 1.0e7;

/// What was found out about a mode so far, and the signs of stiffness in the present segment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stiffness {
    verdict: Verdict,
    /// Whether the verdict was the implicit method before it was open again; `None`: there was none.
    before: Option<bool>,
    /// Steps for which a verdict holds, and those that are left of them.
    term: u32,
    left: u32,
    /// Steps that the explicit method has lost by its shorter lengths.
    lost: f64,
    /// Fastest decay, 1/s; 0 before the first look.
    rate: f64,
    /// Time constants of it that have passed in a row of steps that are longer than it.
    decayed: f64,
    /// Steps of the explicit method.
    steps: u32,
    /// Whether the next segment has no transients of its own.
    goes_on: bool,
    /// Fastest decay at one of the last events, 1/s, and their number.
    rate_at_events: f64,
    events: u32,
}

persist!(Stiffness {
    verdict,
    before,
    term,
    left,
    lost,
    rate,
    decayed,
    steps,
    goes_on,
    rate_at_events,
    events
});

#[derive(Debug, Clone, Copy, Default, PartialEq)]
enum Verdict {
    /// The explicit method, as long as nothing speaks against it.
    #[default]
    Open,
    /// The implicit method, on trial for some steps that are left; it is the faster one with steps
    /// longer than `length`.
    Trial { length: f64, left: u32 },
    /// The explicit method.
    NotStiff,
    /// The implicit method; so many steps in a row were not longer than `length`.
    Stiff { length: f64, idle: u32 },
}

impl Persist for Verdict {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        let (mut place, mut length, mut count) = match *self {
            Verdict::Open => (0_usize, 0.0, 0),
            Verdict::Trial { length, left } => (1, length, left),
            Verdict::NotStiff => (2, 0.0, 0),
            Verdict::Stiff { length, idle } => (3, length, idle),
        };
        place.persist(memory)?;
        length.persist(memory)?;
        count.persist(memory)?;
        *self = match place {
            0 => Verdict::Open,
            1 => Verdict::Trial {
                length,
                left: count,
            },
            2 => Verdict::NotStiff,
            3 => Verdict::Stiff {
                length,
                idle: count,
            },
            _ => return None,
        };
        Some(())
    }
}

impl Default for Stiffness {
    fn default() -> Self {
        Stiffness {
            verdict: Verdict::Open,
            before: None,
            term: TERM,
            left: TERM,
            lost: 0.0,
            rate: 0.0,
            decayed: 0.0,
            steps: 0,
            goes_on: false,
            rate_at_events: 0.0,
            events: 0,
        }
    }
}

impl Stiffness {
    /// A segment begins, with new transients.
    pub fn begin(&mut self) {
        if std::mem::take(&mut self.goes_on) {
            return;
        }
        *self = Stiffness {
            verdict: self.verdict,
            before: self.before,
            term: self.term,
            left: self.left,
            rate_at_events: self.rate_at_events,
            events: self.events,
            ..Stiffness::default()
        };
    }

    /// The motion goes on smoothly while forces have a pole, which looks like a stiff decay: nothing is known.
    pub fn passes_pole(&mut self) {
        *self = Stiffness::default();
    }

    /// The next segment has no transients of its own: the event before it is of what is less than the errors of a step.
    pub fn go_on(&mut self) {
        self.goes_on = true;
    }

    /// Comes to a verdict.
    fn decide(&mut self, verdict: Verdict) {
        let implicit = matches!(verdict, Verdict::Stiff { .. });
        self.term = match self.before == Some(implicit) {
            true => self.term.saturating_mul(2),
            false => TERM,
        };
        (self.verdict, self.left) = (verdict, self.term);
    }

    /// Takes note of a step that a verdict holds for.
    fn serve(&mut self) {
        self.left -= 1;
        if self.left == 0 {
            self.open_again();
        }
    }

    fn open_again(&mut self) {
        (self.before, self.verdict) = (Some(self.prefers_implicit()), Verdict::Open);
        self.begin();
    }

    /// Whether the implicit method is to go on.
    pub fn prefers_implicit(&self) -> bool {
        matches!(self.verdict, Verdict::Stiff { .. } | Verdict::Trial { .. })
    }

    /// Whether the implicit method was the faster one when that was last found out.
    pub fn is_stiff(&self) -> bool {
        match self.verdict {
            Verdict::Open => self.before == Some(true),
            _ => self.prefers_implicit(),
        }
    }

    /// Takes note of a step of the explicit method of length `h`, for which the implicit one might make
    /// a step `lag` times as long, where it is longer by the least factor that matters; `rate` is that of
    /// the fastest decay, 1/s.
    pub fn explicit_step(
        &mut self,
        h: f64,
        lag: impl FnOnce(f64) -> f64,
        rate: impl FnOnce() -> f64,
    ) {
        match self.verdict {
            Verdict::Open => {}
            Verdict::NotStiff => return self.serve(),
            _ => return,
        }
        self.decay(h, rate);
        // Where nothing is lost, less than nothing is not either.
        let least = if self.lost == 0.0 { COST } else { 0.0 };
        self.lost = (self.lost + 1.0 - COST / lag(least)).max(0.0);
        if self.lost >= PATIENCE || self.decayed >= DECAYED {
            let (length, left) = (COST * h, TRIAL);
            self.verdict = Verdict::Trial { length, left };
        }
    }

    /// Whether a step of the explicit method of length `h` with an event is longer than the fastest decay, whose `rate`
    /// (1/s) is looked at where that may be: what the motion falls to in such a step is told to its tolerance only, and
    /// the terms that make up the polynomial there are larger than the motion.
    #[inline(always)]
    pub fn outlasts_decay(&mut self, h: f64, rate: impl FnOnce() -> f64) -> bool {
        let (known, events) = (&mut self.rate_at_events, &mut self.events);
        let looks = *known * h >= 1.0 || *events % BETWEEN_DECAYS == 0;
        *events = events.wrapping_add(1);
        if looks {
            *known = rate();
        }
        looks && *known * h >= 1.0
    }

    /// A step of the explicit method of length `h` cannot tell whether a guard falls, since it is longer than the fastest
    /// decay: the implicit one is tried.
    #[cold]
    pub fn explicit_step_is_blind(&mut self, h: f64) {
        let (length, left) = (COST * h, TRIAL);
        self.verdict = Verdict::Trial { length, left };
    }

    /// Counts the time constants of the fastest decay in a row of steps that are longer than it.
    fn decay(&mut self, h: f64, rate: impl FnOnce() -> f64) {
        self.steps = self.steps.wrapping_add(1);
        if self.steps % BETWEEN_DECAYS == BETWEEN_DECAYS / 2 {
            self.rate = rate();
        }
        self.decayed = match self.rate * h >= 1.0 {
            true => self.decayed + self.rate * h,
            false => 0.0,
        };
    }

    /// Takes note of a step of the explicit method where no other is allowed, with a time `left` to the end of the run, s.
    /// Gives the rate of the fastest decay, 1/s, where it is over and holds the steps to lengths by which the end is out
    /// of reach.
    pub fn explicit_step_alone(
        &mut self,
        h: f64,
        left: f64,
        rate: impl FnOnce() -> f64,
    ) -> Option<f64> {
        self.decay(h, rate);
        (left > HOPELESS * h && self.decayed >= DECAYED).then_some(self.rate)
    }

    /// The explicit method can make no step: until its term is over the verdict is the implicit one, however short
    /// its steps.
    #[cold]
    pub fn explicit_failure(&mut self) {
        let (length, idle) = (0.0, 0);
        self.decide(Verdict::Stiff { length, idle });
    }

    /// Takes note of a step of the implicit method of length `h`, which an event may have ended: where
    /// segments are short, the method does not pay either.
    pub fn implicit_step(&mut self, h: f64) {
        match self.verdict {
            Verdict::Trial { length, .. } if h > length => {
                self.decide(Verdict::Stiff { length, idle: 0 });
            }
            Verdict::Trial { left: 0, .. } => self.decide(Verdict::NotStiff),
            Verdict::Trial { length, left } => {
                let left = left - 1;
                self.verdict = Verdict::Trial { length, left };
            }
            Verdict::Stiff { length, idle } => {
                let idle = if h > length { 0 } else { idle + 1 };
                self.verdict = Verdict::Stiff { length, idle };
                match idle < IDLE {
                    true => self.serve(),
                    false => self.open_again(),
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn explicit(stiffness: &mut Stiffness, steps: u32, lag: f64, rate: f64) {
        (0..steps).for_each(|_| stiffness.explicit_step(1.0, |_| lag, || rate));
    }

    #[test]
    fn where_the_explicit_method_can_make_no_step_the_implicit_one_goes_on_for_a_term() {
        let mut stiffness = Stiffness::default();
        stiffness.explicit_failure();
        (1..TERM).for_each(|_| stiffness.implicit_step(1e-300));
        assert!(stiffness.prefers_implicit());
        stiffness.implicit_step(1e-300);
        assert!(!stiffness.prefers_implicit());
    }

    #[test]
    fn a_few_short_steps_are_no_stiffness_and_a_row_of_them_is() {
        let mut stiffness = Stiffness::default();
        for _ in 0..100 {
            explicit(&mut stiffness, 5, 20.0, 0.0);
            explicit(&mut stiffness, 5, 0.5, 0.0);
        }
        assert!(!stiffness.prefers_implicit());
        explicit(&mut stiffness, 10, 20.0, 0.0);
        assert!(stiffness.prefers_implicit());
    }

    #[test]
    fn steps_of_the_length_of_a_decay_that_is_over_are_stiffness() {
        let mut stiffness = Stiffness::default();
        explicit(&mut stiffness, 1000, 0.5, 0.9);
        assert!(!stiffness.prefers_implicit());
        for _ in 0..100 {
            stiffness.begin();
            explicit(&mut stiffness, 8, 0.5, 4.0);
        }
        assert!(!stiffness.prefers_implicit());
        stiffness.begin();
        explicit(&mut stiffness, 9, 0.5, 4.0);
        assert!(stiffness.prefers_implicit());
    }

    #[test]
    fn the_lengths_of_implicit_steps_decide() {
        let mut tried = Stiffness::default();
        explicit(&mut tried, 10, 20.0, 0.0);
        let mut stiff = tried;
        (0..10).for_each(|_| stiff.implicit_step(1.0));
        stiff.implicit_step(1.25 * COST);
        (1..IDLE).for_each(|_| stiff.implicit_step(0.1));
        assert!(stiff.prefers_implicit());
        let mut not = tried;
        (0..17).for_each(|_| not.implicit_step(0.95 * COST));
        assert!(!not.prefers_implicit());
        explicit(&mut not, 100, 20.0, 0.0);
        assert!(!not.prefers_implicit());
    }

    #[test]
    fn an_implicit_method_whose_steps_stay_short_is_given_up_until_it_pays_again() {
        let mut stiffness = Stiffness::default();
        explicit(&mut stiffness, 10, 20.0, 0.0);
        stiffness.implicit_step(1.25 * COST);
        for _ in 0..100 {
            (1..IDLE).for_each(|_| stiffness.implicit_step(0.9 * COST));
            stiffness.implicit_step(1.25 * COST);
        }
        assert!(stiffness.prefers_implicit());
        (0..IDLE).for_each(|_| stiffness.implicit_step(0.9 * COST));
        assert!(!stiffness.prefers_implicit() && stiffness.is_stiff());
        explicit(&mut stiffness, 100, 0.5, 0.0);
        assert!(!stiffness.prefers_implicit());
        explicit(&mut stiffness, 10, 20.0, 0.0);
        assert!(stiffness.prefers_implicit());
    }

    #[test]
    fn a_verdict_is_open_again_after_its_term_which_doubles_while_it_stays_the_same() {
        let mut stiffness = Stiffness::default();
        for term in [TERM, 2 * TERM, 4 * TERM] {
            assert!(!stiffness.prefers_implicit());
            explicit(&mut stiffness, 10, 20.0, 0.0);
            stiffness.implicit_step(1.25 * COST);
            (1..term).for_each(|_| stiffness.implicit_step(1.25 * COST));
            assert!(stiffness.prefers_implicit());
            stiffness.implicit_step(1.25 * COST);
        }
        // It is not stiff any more, and later it is again.
        explicit(&mut stiffness, 100_000, 0.5, 0.0);
        assert!(!stiffness.prefers_implicit());
        explicit(&mut stiffness, 10, 20.0, 0.0);
        assert!(stiffness.prefers_implicit());
        // A trial that fails does not decide for ever either.
        (0..17).for_each(|_| stiffness.implicit_step(0.95 * COST));
        explicit(&mut stiffness, TERM, 20.0, 0.0);
        assert!(!stiffness.prefers_implicit());
        explicit(&mut stiffness, 10, 20.0, 0.0);
        assert!(stiffness.prefers_implicit());
    }
}
