//! Extremes in a part of a step: where its polynomials have them, polished on the motion itself.

use super::extremes::Extremes;
use super::interpolants::{Interpolants, Polynomial};
use super::{Observers, Part, Step};
use crate::integrate::Path;
use crate::numerics::Size;

impl Observers<'_> {
    /// Looks for extremes of all that is represented in a part of a step.
    pub(super) fn find_extremes<F: Size>(
        &mut self,
        extremes: &mut Extremes,
        step: &mut Step<F>,
        part: Part,
        columns: usize,
    ) {
        let clock = step.equations.clock;
        let seconds = |tau: f64| clock.start.plus(tau).seconds();
        for f in 0..columns {
            let (column, rate) = (self.functions.columns[f], self.functions.rate_of(f));
            let discrete = step.equations.context.discrete();
            if self.functions.is_held(f, step.mode, discrete) {
                extremes.note(column, seconds(part.from), 0.0);
                continue;
            }
            let time = |place: f64| seconds(part.time(place));
            let summits = extremes.update(&self.interpolants, f, column, rate, time);
            for place in summits.into_iter().flatten() {
                let free = self.functions.free;
                let tau = polish((step.motion, free), part, f, part.time(place));
                self.evaluate(step, tau, Interpolants::SPARE, (columns, false));
                let value = self.interpolants.value_at(Interpolants::SPARE, f);
                extremes.note(column, seconds(tau), value);
            }
        }
    }

    /// Looks for extremes of what was dissipated and of the work of the inputs: their ends, and where a power
    /// changes its sign.
    pub(super) fn find_extremes_of_work<F: Size>(
        &self,
        extremes: &mut Extremes,
        step: &Step<F>,
        part: Part,
        (columns, (work, whole)): (usize, (Option<&[Polynomial; 2]>, [f64; 2])),
    ) {
        let Some(ledger) = &self.ledger else {
            return;
        };
        let energies = extremes.energies.start;
        let [_, input, dissipated, _] = ledger.row(0.0, [0.0; 2]);
        let of = [(dissipated, energies + 2), (input, energies + 1)];
        let clock = step.equations.clock;
        for (i, (so_far, column)) in of.into_iter().enumerate() {
            let mut note = |place: f64, work: f64| {
                let t = clock.start.plus(part.time(place)).seconds();
                extremes.note(column, t, so_far + work);
            };
            if let Some(work) = work
                && self.interpolants.changes_sign(columns + i)
            {
                let mut found = |place: f64| note(place, work[i].value(place));
                self.interpolants.sign_changes(columns + i, &mut found);
            }
            note(1.0, whole[i]);
        }
    }
}

/// Goes from a place near an extremum of a function to it, where its derivative is that of the motion: by the
/// secant method, from a place that is off by less than a thousandth of the part, until a step is as short as places
/// are close ([`Interpolants::CLOSE`]): what is left is then smaller by as much again. Of the functions the first are the
/// `n` free coordinates that are no multipliers, then their rates.
fn polish<F: Size>((motion, n): (&dyn Path<F>, usize), part: Part, f: usize, tau: f64) -> f64 {
    let rate = |tau: f64| {
        let (_, v, a) = motion.at(tau);
        if f < n { v[f] } else { a[f - n] }
    };
    if f >= 2 * n {
        return tau;
    }
    let clamp = |tau: f64| tau.clamp(part.from, part.to);
    let (mut last, mut next) = (clamp(tau + 1e-3 * (part.to - part.from)), tau);
    let (mut rate_last, mut rate_next) = (rate(last), rate(next));
    // The number of right digits grows by 1.6 times each.
    for _ in 0..6 {
        let step = (next - last) * (rate_next / (rate_next - rate_last));
        if !step.is_finite() || step == 0.0 {
            break;
        }
        (last, rate_last) = (next, rate_next);
        next = clamp(next - step);
        if step.abs() <= Interpolants::CLOSE * (part.to - part.from) {
            break;
        }
        rate_next = rate(next);
    }
    next
}
