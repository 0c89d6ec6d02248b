//! What a mode requires to be positive, and the margins of limits and validity: watched within steps, not only at
//! their ends. Bounds show for a whole step that nothing falls, or it is searched as a guard is.

use super::crossing::{Cut, Signs, cut};
use super::equations::{Equations, free_of};
use super::failure::{Reason, Stoppable};
use super::guards::{Conditions, Linear, motion};
use super::instant::Instant;
use super::limits::Margins;
use super::plan::Watched;
use super::problem::Observed;
use super::roots::{Isolation, Kind, Search, Watch};
use super::search::{Coefficients, search_function, search_polynomial};
use crate::integrate::{Motion, OneStep, Path, Series, State};
use crate::kernel::{Context, Free, ModeKernel};
use crate::model::{GuardShape, Mode, Requirement};
use crate::numerics::Size;

/// Why a run ends at the end of a step.
pub(super) enum Ended {
    /// Something that the mode requires does not hold.
    Unmet(Box<Reason>),
    /// A limit state.
    Limit,
}

/// Whether a margin tells that something is reached.
fn is_reached(margin: f64) -> bool {
    margin.is_nan() || margin < 0.0
}

#[cold]
fn unmet(mode: &Mode, index: usize, value: f64) -> Box<Reason> {
    let requirement = &mode.requirements[index];
    Box::new(Reason::Requirement {
        mode: mode.name,
        failure: requirement.failure,
        text: requirement.text,
        value,
        unit: requirement.unit,
    })
}

impl Margins<'_> {
    /// Number of values of a mode: of its requirements, then of all margins.
    fn count(&self, mode: &Mode) -> usize {
        mode.requirements.len() + self.ends.len()
    }

    /// Sets the values at a state of the present mode.
    fn evaluate<F: Size>(
        &mut self,
        kernel: &ModeKernel<F>,
        context: &Context,
        mode: &Mode,
        at: Free<F>,
    ) {
        let of_model = mode.requirements.len() + mode.margins.len();
        kernel.requirements(context, at, &mut self.values[..of_model]);
        let required = mode.requirements.iter().zip(&self.values);
        if { required }.any(|(of, &value)| of.may_vanish && value < 0.0) {
            self.forgive_rounding(kernel, context, mode, at);
        }
        if self
            .own
            .iter()
            .any(|limit| matches!(limit.of, Observed::Output(_)))
        {
            let (outputs, values) = (&mut self.outputs, &mut self.output_values);
            outputs.evaluate(kernel, context, at, values);
        }
        let own = self.values[of_model..].iter_mut().zip(&self.own);
        for (out, limit) in own {
            let free = |i| mode.free.iter().position(|&free| free == i);
            let value = match limit.of {
                Observed::Coordinate(i) => free(i).map_or_else(
                    || {
                        kernel.coordinates(context, at, &mut self.all);
                        self.all[i]
                    },
                    |k| at.q[k],
                ),
                Observed::Rate(i) => free(i).map_or_else(
                    || {
                        kernel.rates(context, at, &mut self.all);
                        self.all[i]
                    },
                    |k| at.v[k],
                ),
                Observed::Reaction(i) => {
                    kernel.reactions(context, at, &mut self.reactions);
                    self.reactions[i]
                }
                Observed::Output(i) => self.output_values[i],
            };
            *out = match limit.above {
                true => limit.level - value,
                false => value - limit.level,
            };
        }
    }

    /// Adds to what may vanish, and is negative by no more than its own rounding, that rounding: it holds, a force that touches zero among it.
    #[cold]
    fn forgive_rounding<F: Size>(
        &mut self,
        kernel: &ModeKernel<F>,
        context: &Context,
        mode: &Mode,
        at: Free<F>,
    ) {
        let of_model = mode.requirements.len() + mode.margins.len();
        kernel.requirement_roundings(context, at, &mut self.roundings[..of_model]);
        let values = self.values.iter_mut().zip(&self.roundings);
        for (value, &rounding) in values.take(mode.requirements.len()) {
            if *value < 0.0 && *value >= -rounding {
                *value += rounding;
            }
        }
    }

    /// What the mode requires must hold at the start of a segment, at `t` (s); what is reached there is noted.
    #[inline(always)]
    pub fn check_start<F: Size>(
        &mut self,
        kernel: &ModeKernel<F>,
        context: &Context,
        (mode, at): (&Mode, Free<F>),
        t: f64,
    ) -> Stoppable<()> {
        if self.count(mode) == 0 {
            return Ok(());
        }
        self.evaluate(kernel, context, mode, at);
        self.judge(mode, t)
    }

    /// Notes what the values tell to be reached at `t` (s), unless something that is required does not hold.
    fn judge(&mut self, mode: &Mode, t: f64) -> Stoppable<()> {
        let required = &self.values[..mode.requirements.len()];
        let is_met = |(requirement, value): (&Requirement, &f64)| requirement.is_met(*value);
        let first_unmet = (mode.requirements.iter().zip(required)).position(|of| !is_met(of));
        if let Some(index) = first_unmet {
            return Err(unmet(mode, index, required[index]));
        }
        for margin in 0..self.ends.len() {
            if is_reached(self.values[mode.requirements.len() + margin]) {
                self.reach(margin, t);
            }
        }
        Ok(())
    }

    /// Whether bounds show that nothing falls in the last step up to time `to`: far from zero they do. Those of the
    /// Taylor method are bounds of its polynomials. What they leave open is looked at by [`Self::cut_where_reached`].
    #[inline]
    pub fn hold_throughout<'a, F: Size>(
        &mut self,
        method: &impl OneStep<F, Equations<'a, F>>,
        equations: &mut Equations<'a, F>,
        mode: &Mode,
        to: f64,
    ) -> bool {
        let dense = method.dense().expect("a step was made");
        let Some(series) = dense.series() else {
            self.open.fill(true);
            return false;
        };
        let (required, of_model) = (mode.requirements.len(), mode.margins.len());
        let bounds = &mut self.values[..required + of_model];
        let tau = to - dense.start();
        (equations.kernel).requirement_bounds(equations.context, series, tau, bounds);
        // Mostly none is near.
        let (of_mode, margins) = bounds.split_at(required);
        let met = |(requirement, value): (&Requirement, &f64)| requirement.is_met(*value);
        if self.own.is_empty()
            && mode.requirements.iter().zip(of_mode).all(met)
            && margins.iter().all(|&margin| margin >= 0.0)
        {
            return true;
        }
        let mut holds = true;
        for row in 0..required + self.ends.len() {
            let row_holds = match row.checked_sub(required) {
                None => mode.requirements[row].is_met(self.values[row]),
                Some(margin) if !self.is_pending(margin) => true,
                Some(margin) if margin < of_model => self.values[row] >= 0.0,
                Some(margin) => self.own_holds(mode, margin, series, tau),
            };
            self.open[row] = !row_holds;
            holds &= row_holds;
        }
        holds
    }

    /// Whether a margin of the problem is known to stay positive for `tau` (s) from where the series was begun.
    fn own_holds<F: Size>(
        &self,
        mode: &Mode,
        margin: usize,
        (series, orders): (&Series<F>, usize),
        tau: f64,
    ) -> bool {
        let limit = &self.own[margin - mode.margins.len()];
        let Some(shape) = self.shape(mode, margin) else {
            // It was looked at where the segment started.
            return true;
        };
        let GuardShape::Linear { index, rate, .. } = shape else {
            return false;
        };
        let rows = if rate { &series.v } else { &series.q };
        let radius = (1..orders)
            .rev()
            .fold(0.0, |sum, k| (sum + rows[k][index].abs()) * tau);
        let value = rows[0][index];
        match limit.above {
            true => limit.level - value >= radius,
            false => value - limit.level >= radius,
        }
    }

    /// Cuts the last step, which was cut at its first event `found`, where something that the mode requires ceases to
    /// hold, or a limit that ends the run is reached, if that is before: says what. The shortened step is searched
    /// again, since it is a better solution than the dense output of the longer one. Notes what else is reached in
    /// what is left of the step, in a segment that began at `origin`.
    #[inline(never)]
    pub fn cut_where_reached<'a, F: Size>(
        &mut self,
        method: &mut impl OneStep<F, Equations<'a, F>>,
        equations: &mut Equations<'a, F>,
        conditions: &mut Conditions,
        (mode, watched, origin): (&Mode, &[Watched], Instant),
        (signs, end): (&mut Signs, &mut State<F>),
        mut found: Cut,
    ) -> Stoppable<(Cut, Option<Ended>)> {
        let start = method.start().t;
        let mut before = f64::INFINITY;
        let dense = method.dense().expect("a step was made");
        self.start(equations, mode, dense);
        let ends = loop {
            let dense = method.dense().expect("a step was made");
            let Some(falls) = self.first_end(equations, mode, dense, end) else {
                break false;
            };
            if falls >= end.t.min(before) {
                break true;
            }
            before = falls;
            // Of another step nothing is known.
            self.open.fill(true);
            // A step has a length, and moves something.
            let least = start
                .next_up()
                .max(start + f64::EPSILON * (method.end() - start));
            method.step_exactly(equations, falls.max(least) - start)?;
            found = cut(
                method,
                equations,
                conditions,
                (mode, watched),
                (&mut *signs, &mut *end),
            )?;
        };
        let dense = method.dense().expect("a step was made");
        self.note(equations, mode, dense, end, origin);
        if !ends {
            return Ok((found, None));
        }
        equations.at(end.t);
        self.evaluate(equations.kernel, equations.context, mode, free_of(end));
        let ended = match self.judge(mode, origin.plus(end.t).seconds()) {
            Err(reason) => Ended::Unmet(reason),
            Ok(()) if self.has_ended() => Ended::Limit,
            // The end itself, more accurate than the dense output, is not beyond.
            Ok(()) => return Ok((found, None)),
        };
        Ok((Cut::Nothing, Some(ended)))
    }

    /// When in the last step, up to the state `end`, something that ends the run happens first, local time.
    fn first_end<F: Size>(
        &mut self,
        equations: &mut Equations<F>,
        mode: &Mode,
        dense: &dyn Motion<F>,
        end: &State<F>,
    ) -> Option<f64> {
        let required = mode.requirements.len();
        let mut window = (dense.start(), end.t);
        let mut first = None;
        for row in 0..self.count(mode) {
            let margin = row.checked_sub(required);
            let counts = margin.is_none_or(|m| self.ends[m] && self.is_pending(m));
            if counts
                && self.open[row]
                && let Some(t) = self.falls(equations, mode, dense, end, (window, row))
            {
                window.1 = t;
                first = Some(t);
            }
        }
        first
    }

    /// Notes what is reached in a step and does not end the run.
    fn note<F: Size>(
        &mut self,
        equations: &mut Equations<F>,
        mode: &Mode,
        dense: &dyn Motion<F>,
        end: &State<F>,
        origin: Instant,
    ) {
        let window = (dense.start(), end.t);
        for margin in 0..self.ends.len() {
            let row = mode.requirements.len() + margin;
            if !self.ends[margin]
                && self.open[row]
                && self.is_pending(margin)
                && let Some(t) = self.falls(equations, mode, dense, end, (window, row))
            {
                self.reach(margin, origin.plus(t).seconds());
            }
        }
    }

    /// Sets the values at the start of a step, from which it may be taken again.
    fn start<F: Size>(&mut self, equations: &mut Equations<F>, mode: &Mode, dense: &dyn Motion<F>) {
        let [q, v, a] = motion(equations, dense, dense.start(), true);
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        self.evaluate(equations.kernel, equations.context, mode, at);
        self.starts.copy_from_slice(&self.values);
    }

    /// When a row falls first in a window of the last step, which ends in a state: searched as a guard is.
    fn falls<F: Size>(
        &mut self,
        equations: &mut Equations<F>,
        mode: &Mode,
        dense: &dyn Motion<F>,
        end: &State<F>,
        (window, row): ((f64, f64), usize),
    ) -> Option<f64> {
        let begins = self.starts[row];
        let margin = row.checked_sub(mode.requirements.len());
        let (holds, shape) = match margin {
            None => (
                mode.requirements[row].is_met(begins),
                Some(GuardShape::General {
                    accelerations: true,
                    signals: true,
                }),
            ),
            Some(margin) => (!is_reached(begins), self.shape(mode, margin)),
        };
        if !holds {
            // After an event that leads to the same mode again it may fail at once.
            return Some(window.0);
        }
        let watch = Watch::of(begins);
        let mut found = Search::nothing(watch);
        match Linear::of(shape?, equations.context) {
            Some(Linear {
                index,
                rate,
                factor,
                ..
            }) => {
                let coefficients = Coefficients {
                    count: dense.coefficients(rate),
                    constant: begins,
                    rises: dense.value_and_slope((index, rate), factor)[1] > 0.0,
                    write: &mut |first, out: &mut [f64]| {
                        dense.polynomial((index, rate), factor, first, out);
                        if first == 0 {
                            out[0] = begins;
                        }
                    },
                };
                let step = (dense.start(), dense.length());
                search_polynomial(
                    coefficients,
                    (step, window, Isolation::Bracket),
                    (watch, &mut found),
                );
            }
            None => {
                let mut from = window.0;
                while found.crossing.is_none() && from < window.1 {
                    let to = (from + equations.told_by_values(from)).min(window.1);
                    let value = |tau: f64| {
                        let [q, v, a] = match tau == end.t {
                            true => [end.q.clone(), end.v.clone(), end.a.clone()],
                            false => motion(equations, dense, tau, true),
                        };
                        equations.at(tau);
                        let at = Free {
                            q: &q,
                            v: &v,
                            a: &a,
                        };
                        self.evaluate(equations.kernel, equations.context, mode, at);
                        self.values[row]
                    };
                    found = search_function(value, (from, to), found.watch);
                    from = to;
                }
            }
        }
        let crossing = found.crossing?;
        // Of what is required a pole is a failure, too.
        (margin.is_none() || crossing.kind != Kind::Pole).then_some(crossing.outside)
    }
}
