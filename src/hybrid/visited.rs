//! Where a run has been since the time last advanced.

use crate::model::name::intern;
use crate::numerics::{Memory, Persist};

/// A transition taken: its name, the mode left, the mode entered.
pub(super) type Step = (&'static str, usize, usize);

/// Modes and states seen at the present instant, with the transitions that led there. Coming back to
/// one of them is a cycle that never ends.
#[derive(Debug, Default)]
pub(super) struct Visited {
    steps: Vec<Step>,
    /// A state a step, of equal widths; that of the last step is still the present one.
    states: Vec<f64>,
}

impl Persist for Visited {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        let named = |&(name, from, to): &Step| (String::from(name), (from, to));
        let mut steps: Vec<(String, (usize, usize))> = self.steps.iter().map(named).collect();
        memory.list(&mut steps, Default::default)?;
        let interned = (steps.into_iter()).map(|(name, (from, to))| (intern(&name), from, to));
        self.steps = interned.collect();
        memory.list(&mut self.states, f64::default)
    }
}

impl Visited {
    /// The time advances.
    pub fn clear(&mut self) {
        self.steps.clear();
        self.states.clear();
    }

    /// Names of the transitions since then.
    pub fn transitions(&self) -> impl Iterator<Item = &'static str> {
        self.steps.iter().map(|&(name, ..)| name)
    }

    /// Leaves the present state by a transition. It is remembered if a step led there.
    pub fn leave(&mut self, state: [&[f64]; 3]) {
        if !self.steps.is_empty() {
            for part in state {
                self.states.extend_from_slice(part);
            }
        }
    }

    /// Adds the step that led from there to a state: the steps of the cycle, if that was seen before.
    pub fn arrive(&mut self, (name, from, to): Step, state: [&[f64]; 3]) -> Option<Vec<Step>> {
        let width = state.iter().map(|part| part.len()).sum();
        let bits = |x: &f64| x.to_bits();
        let seen = |(i, (_, _, mode)): &(usize, &Step)| {
            let seen = &self.states[i * width..][..width];
            let now = state.iter().copied().flatten();
            *mode == to && seen.iter().map(bits).eq(now.map(bits))
        };
        let first = self.steps.iter().enumerate().find(seen);
        let cycle = first.map(|(first, _)| {
            let last = (name, from, to);
            let steps = self.steps[first + 1..].iter().copied();
            steps.chain([last]).collect()
        });
        self.steps.push((name, from, to));
        cycle
    }
}
