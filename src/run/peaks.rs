//! Extremes of a quantity, and its curve as far as it is recorded.

use super::result::Run;

/// Smallest and largest value of a quantity, and when it first took them.
#[derive(Debug, Clone, Copy, PartialEq, serde::Deserialize)]
pub struct Peak {
    /// Largest value.
    pub max: f64,
    /// First time of the largest value (s).
    pub t_max: f64,
    /// Smallest value.
    pub min: f64,
    /// First time of the smallest value (s).
    pub t_min: f64,
}

impl Run {
    /// The extremes of a quantity by its name, as the trajectory names it; none where they were not looked for.
    pub fn peak(&self, name: &str) -> Option<Peak> {
        let column = self.trajectory.column(name)?;
        let found = self.peaks.iter().find(|(i, _)| *i == column);
        found.map(|(_, peak)| *peak)
    }

    /// A column over time: the samples and, for what belongs to the state, both sides of every
    /// transition, in order of time. A sample at the time of a transition comes first.
    ///
    /// # Panics
    /// If there is no such column.
    pub fn curve(&self, column: usize) -> impl Iterator<Item = (f64, f64)> + '_ {
        let of_state = self.trajectory.columns[column].group.is_of_the_state();
        let sides = self
            .events
            .iter()
            .filter(move |_| of_state)
            .flat_map(move |event| {
                let value = |values: &mut dyn Iterator<Item = f64>| {
                    values
                        .nth(column)
                        .expect("a snapshot holds every column of the state")
                };
                let before = value(&mut event.before.values());
                [
                    (event.t, before),
                    (event.t, value(&mut event.after.values())),
                ]
            });
        let samples = self
            .trajectory
            .t
            .iter()
            .enumerate()
            .map(move |(i, &t)| (t, self.trajectory.row(i)[column]));
        let (mut samples, mut sides) = (samples.peekable(), sides.peekable());
        std::iter::from_fn(move || match (samples.peek(), sides.peek()) {
            (Some(sample), Some(side)) if sample.0 <= side.0 => samples.next(),
            (_, Some(_)) => sides.next(),
            _ => samples.next(),
        })
    }
}
