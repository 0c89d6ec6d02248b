//! Whether the explicit method is held back by stiffness, mode by mode.

/// Cost of a step of Radau IIA in steps of the Taylor method, as measured on the benchmark problems:
/// 1.3 (linear equations) to 3 (the walking tank).
const COST: f64 = 2.0;

/// Steps that may be lost before the method is changed: fewer than a segment of a stiff motion loses,
/// more than a transient takes.
const PATIENCE: f64 = 8.0;

/// What was seen of a mode so far.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Stiffness {
    /// Steps of the Taylor method by which Radau IIA would have been faster, of late.
    lost: f64,
}

impl Stiffness {
    /// Takes note of a step of the Taylor method, when one of Radau IIA would have been `lag` times as
    /// long: the method loses 1 − COST/lag steps, or makes up for as many.
    pub fn add(&mut self, lag: f64) {
        self.lost = (self.lost + 1.0 - COST / lag).max(0.0);
    }

    /// Whether the mode is stiff. It remains so: what follows is left to Radau IIA.
    pub fn is_shown(&self) -> bool {
        self.lost >= PATIENCE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_short_steps_are_no_stiffness_and_a_row_of_them_is() {
        let mut stiffness = Stiffness::default();
        for _ in 0..100 {
            (0..5).for_each(|_| stiffness.add(20.0));
            (0..5).for_each(|_| stiffness.add(0.5));
            assert!(!stiffness.is_shown());
        }
        (0..10).for_each(|_| stiffness.add(20.0));
        assert!(stiffness.is_shown());
    }

    #[test]
    fn a_method_that_is_not_held_back_loses_nothing() {
        let mut stiffness = Stiffness::default();
        (0..100).for_each(|_| stiffness.add(0.0));
        (0..7).for_each(|_| stiffness.add(f64::INFINITY));
        assert!(!stiffness.is_shown());
    }
}
