//! Where a run has been since the time last advanced.

use crate::model::Mode;

/// A transition taken: its name, the mode left, the mode entered.
type Step = (&'static str, usize, usize);

/// Modes and states seen at the present instant, with the transitions that led there. Coming back to
/// one of them is a cycle that never ends.
#[derive(Debug, Default)]
pub(super) struct Visited {
    steps: Vec<Step>,
    /// A state a step, of equal widths.
    states: Vec<f64>,
}

impl Visited {
    /// The time advances.
    pub fn clear(&mut self) {
        self.steps.clear();
        self.states.clear();
    }

    /// Adds the state that a step led to: the cycle in words, if it was seen before.
    pub fn add(
        &mut self,
        (name, from, to): Step,
        state: [&[f64]; 3],
        modes: &[Mode],
    ) -> Option<String> {
        let before = self.states.len();
        for part in state {
            self.states.extend_from_slice(part);
        }
        let (seen, new) = self.states.split_at(before);
        let bits = |x: &f64| x.to_bits();
        let mut visits = self.steps.iter().enumerate();
        let first = visits.find(|(i, (_, _, mode))| {
            let state = &seen[i * new.len()..(i + 1) * new.len()];
            *mode == to && state.iter().map(bits).eq(new.iter().map(bits))
        });
        let cycle = first.map(|(first, _)| {
            let last = (name, from, to);
            let steps = self.steps[first + 1..].iter().chain([&last]);
            let text = steps.map(|(name, from, to)| {
                format!("{name} ({} → {})", modes[*from].name, modes[*to].name)
            });
            text.collect::<Vec<_>>().join(", ")
        });
        self.steps.push((name, from, to));
        cycle
    }
}
