//! Rest: the mode at the limit of an accumulation.
//!
//! A model declares where accumulations may come to rest. A declared rest is taken only where the limit satisfies
//! everything that its mode holds, within the tolerances of the run: nothing is moved there that is not there
//! already. Of several that fit the limit decides how much comes to rest: what it tells from the value that a mode
//! holds goes on, and all else is held.

use super::accumulation::Limit;
use super::failure::{Reason, Stoppable};
use super::instant::Instant;
use super::plan::is_impact;
use super::problem::Method;
use super::simulation::{Simulation, Violation};
use super::start::ROUNDING;
use super::unrest::{Restless, Unfit};
use crate::integrate::ORDERS;
use crate::kernel::{Free, ModeKernel, with_kernel};
use crate::model::{Guard, GuardShape, Mode};
use crate::numerics::{Side, Size};
use std::cmp::Reverse;
use std::collections::BTreeSet;

/// What a mode holds, by the index of the coordinate.
#[derive(Debug, Clone, Copy)]
pub(super) enum Held {
    /// It holds the coordinate at a value.
    At(usize, f64),
    /// It holds the rate of the coordinate at a value.
    Rate(usize, f64),
}

impl Held {
    /// Index among coordinates, then velocities, of so many each; and the value.
    fn index(self, coordinates: usize) -> (usize, f64) {
        match self {
            Held::At(i, value) => (i, value),
            Held::Rate(i, value) => (coordinates + i, value),
        }
    }
}

/// Height of a hop, in roundings of its gap, whose duration is told to a quarter of all digits: ε^(−1/4).
const TOLD: f64 = (1u64 << 13) as f64;

/// A hop at a stop.
#[derive(Debug, Clone, Copy)]
struct Hop {
    /// Its height, in roundings of its gap.
    height: f64,
    /// Whether rounding in a step's polynomials makes more of the time at which it ends than the tolerance admits.
    blurs: bool,
}

impl<'p> Simulation<'p> {
    /// The mode and the limit of an accumulation that the last events make certain, where a rest fits it.
    pub fn rest(&mut self) -> Option<(usize, Limit)> {
        if !self.plan.rests(self.here.mode) {
            return None;
        }
        let limit = self.accumulation.limit(self.problem.accuracy.relative)?;
        if limit.at.seconds() >= self.problem.end.time {
            return None;
        }
        let target = self.fitting_at(&limit, false)?;
        Some((target, limit))
    }

    /// The same where hops at a stop that is not at zero have become lower than the rounding of its gap, which keeps them
    /// from becoming lower still: the limit that was told best before. (A hop begins at the stop and ends one rounding
    /// beyond it, which makes up for what a low impact takes.)
    ///
    /// By a series a hop has no rounding of where it began; so the implicit method leaves to it what it tells less well than the tolerance
    /// asks for, unless the motion is stiff.
    fn rest_below_rounding(&mut self) -> Option<(usize, Limit)> {
        let hop = self.lowest_hop();
        let is_implicit = self.problem.method == Method::Radau;
        (self.accumulation).set_needs_series(is_implicit && hop.is_some_and(|hop| hop.blurs));
        if self.signs.by_series() {
            return None;
        }
        // Where rounding does not tell it from another, to half of all digits, it is none to rest after.
        let height = hop.map(|hop| hop.height)?;
        let height = (height * f64::EPSILON.sqrt() <= 1.0).then_some(height)?;
        // What is told of lower hops is worse than what higher ones have told.
        if height >= TOLD || self.accumulation.predicted().is_none() {
            self.accumulation.predict();
        }
        if height > ORDERS as f64 || !self.plan.rests(self.here.mode) {
            return None;
        }
        let limit = self.accumulation.predicted()?;
        if limit.at.seconds() >= self.problem.end.time {
            return None;
        }
        let target = self.fitting_at(&limit, true)?;
        Some((target, limit))
    }

    /// The last hop at a stop; none where there is no such hop. A hop of the duration T that ends with the rate u is about |u| T/4 high.
    fn lowest_hop(&self) -> Option<Hop> {
        let guards = self.mode().guards.iter().filter(|guard| !guard.is_exact());
        let mut impacts = guards.filter(|guard| is_impact(guard)).peekable();
        impacts.peek()?;
        let duration = self.accumulation.last_hop()?;
        let least = self.problem.accuracy.relative * self.here.now.seconds();
        let hops = impacts.filter_map(|guard| {
            let (rate, rounding) = self.closed_gap(guard)?;
            (rounding > 0.0).then(|| Hop {
                height: 0.25 * rate.abs() * duration / rounding,
                // By Horner's rule (Higham 2002, §5.1).
                blurs: ORDERS as f64 * rounding > least * rate.abs(),
            })
        });
        hops.min_by(|a, b| a.height.total_cmp(&b.height))
    }

    /// The rate of the gap that a guard watches, and the rounding of the gap; none where the guard is not zero at the present
    /// state, or where it is no gap but a rate or a force.
    pub(super) fn closed_gap(&self, guard: &Guard) -> Option<(f64, f64)> {
        let mode = self.mode();
        with_kernel!(&mode.kernels, k => {
            let [q, v, a] = self.here.free(k.size(), &mode.free);
            let at = Free { q: &q, v: &v, a: &a };
            let value = k.guard(&self.context, &guard.kernel, at);
            match guard.shape {
                GuardShape::Linear { index, rate: false, .. } => {
                    let rounding = f64::EPSILON * q[index].abs();
                    (value.abs() <= ROUNDING * q[index].abs()).then_some((v[index], rounding))
                }
                GuardShape::General { accelerations: false, .. } => {
                    let magnitude = k.guard_magnitude(&self.context, &guard.kernel, at);
                    let no_jerk = k.size().zeros();
                    let rate = || k.guard_rate(&self.context, &guard.kernel, at, &no_jerk);
                    let is_zero = value.abs() <= ROUNDING * magnitude;
                    is_zero.then(|| (rate(), f64::EPSILON * magnitude))
                }
                _ => None,
            }
        })
    }

    /// Goes to the limit of an accumulation, if the last events have one.
    pub fn find_accumulation(&mut self) -> Stoppable<()> {
        if self.mode().contacts.is_some() {
            if self.rest_contacts()? {
                return Ok(());
            }
        } else if let Some((target, limit)) = self.rest() {
            return self.come_to_rest_together(target, limit, false);
        } else if let Some((target, mut limit)) = self.rest_below_rounding() {
            self.go_on_as_it_moves(&mut limit)?;
            return self.come_to_rest_together(target, limit, true);
        }
        let relative = self.problem.accuracy.relative;
        if self.accumulation.stands_still(self.here.now) || self.accumulation.is_over(relative) {
            let mut transitions = self.observers.recording.recent();
            transitions.sort_unstable();
            transitions.dedup();
            return Err(Box::new(Reason::Chattering {
                transitions,
                missing: self.missing_rest(),
            }));
        }
        Ok(())
    }

    /// A violated guard: a rest that fits the state if it is an impact from rest, else its transition.
    pub fn resolve(&mut self, violation: Violation) -> Stoppable<()> {
        if violation.rests && is_impact(&self.mode().guards[violation.guard]) {
            let n = self.here.q.len();
            let here = Limit {
                at: self.here.now,
                state: [&*self.here.q, &self.here.v].concat(),
                uncertainty: vec![0.0; 2 * n],
                modes: vec![self.here.mode],
            };
            if let Some(target) = self.fitting(&here, false) {
                return self.come_to_rest(target, &here);
            }
        }
        self.fire(violation.guard)
    }

    /// Lets the coordinates of a limit be where the motion from here leads: a series of hops tells them less well, as it leaves out what
    /// they are accelerated by in a hop.
    fn go_on_as_it_moves(&mut self, limit: &mut Limit) -> Stoppable<()> {
        let (before, mode) = (self.here.now, self.mode());
        let [q, v, a] = [&self.here.q, &self.here.v, &self.here.a].map(|x| x.clone());
        with_kernel!(&mode.kernels, k => self.go_on_to(k, before, limit.at))?;
        limit.state[..q.len()].copy_from_slice(&self.here.q);
        self.here.now = before;
        (self.here.q, self.here.v, self.here.a) = (q, v, a);
        Ok(())
    }

    /// Enters a mode that fits the limit of an accumulation, and from there what else the same limit fits: contacts that
    /// accumulate side by side.
    fn come_to_rest_together(
        &mut self,
        target: usize,
        mut limit: Limit,
        uncertain: bool,
    ) -> Stoppable<()> {
        let mut next = Some(target);
        while let Some(target) = next {
            self.come_to_rest(target, &limit)?;
            limit.modes = vec![target];
            next = match self.is_over() {
                true => None,
                false => self.fitting_at(&limit, uncertain),
            };
        }
        Ok(())
    }

    /// Enters a mode that fits the limit of an accumulation.
    fn come_to_rest(&mut self, target: usize, limit: &Limit) -> Stoppable<()> {
        let n = self.here.q.len();
        if self.observers.ledger.is_some() && limit.at.since(self.here.now) > 0.0 {
            let (before, mode) = (self.here.now, self.mode());
            let work = with_kernel!(&mode.kernels, k => self.go_on_to(k, before, limit.at))?;
            let (q, v) = limit.state.split_at(n);
            self.take_limit([q, v], (work, &[]));
        }
        self.here.now = limit.at;
        self.here.q.copy_from_slice(&limit.state[..n]);
        self.here.v.copy_from_slice(&limit.state[n..]);
        self.set_context();
        self.next[..2 * n].copy_from_slice(&limit.state);
        self.next[2 * n..].copy_from_slice(self.context.discrete());
        for held in self.holds(&self.modes[target], &limit.state) {
            let (place, value) = held.index(n);
            self.next[place] = value;
        }
        self.at_zero.clear();
        self.commit("rest", false, target)
    }

    /// Lets the motion go on from an instant to a limit as if nothing happened between them. Gives its work [dissipated, input], J.
    pub(super) fn go_on_to<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        before: Instant,
        limit: Instant,
    ) -> Stoppable<[f64; 2]> {
        let duration = limit.since(before);
        self.here.now = before;
        let powers = self.powers(kernel)?;
        let begins = self.here.a.to_vec();
        for i in 0..begins.len() {
            let (v, a) = (self.here.v[i], begins[i]);
            self.here.q[i] += duration * (v + 0.5 * duration * a);
            self.here.v[i] += duration * a;
        }
        self.here.now = limit;
        let ends = self.powers(kernel)?;
        for (i, begins) in begins.iter().enumerate() {
            let more = self.here.a[i] - begins;
            self.here.q[i] += duration * duration / 6.0 * more;
            self.here.v[i] += 0.5 * duration * more;
        }
        Ok([0, 1].map(|i| 0.5 * duration * (powers[i] + ends[i])))
    }

    /// [dissipated, input] power here, W, after setting the accelerations.
    fn powers<F: Size>(&mut self, kernel: &'p ModeKernel<F>) -> Stoppable<[f64; 2]> {
        self.set_context();
        self.set_accelerations(kernel)?;
        let [q, v, a] = self.here.free(kernel.size(), &self.mode().free);
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        Ok(kernel.powers(&self.context, at))
    }

    /// Takes coordinates and rates at a limit, where all impacts that are left happen at once. The ledger has the energy that they lose,
    /// and the work till there; with the impulses of these impacts, where they are known.
    pub(super) fn take_limit(&mut self, [q, v]: [&[f64]; 2], (work, impulses): ([f64; 2], &[f64])) {
        let energies = (self.observers.ledger.is_some())
            .then(|| (self.stored_energy(), self.ground_momenta()));
        self.here.q.copy_from_slice(q);
        self.here.v.copy_from_slice(v);
        self.set_context();
        let jump = energies.map(|before| self.energy_jump(before, impulses));
        if let (Some(ledger), Some(jump)) = (&mut self.observers.ledger, jump) {
            ledger.add_work(work);
            ledger.add_jump(jump);
        }
    }

    /// [`Self::fitting`] with the motions that are prescribed as they are at the limit.
    fn fitting_at(&mut self, limit: &Limit, uncertain: bool) -> Option<usize> {
        (self.context).set_signals(&self.signals, limit.at.seconds(), Side::Right);
        let target = self.fitting(limit, uncertain);
        self.set_context();
        target
    }

    /// The rest that a limit of events in some modes comes to: of those declared for these modes that fit it the
    /// one with the least that the limit tells from what is held; of these the one that holds the most, and of these
    /// the first in the order of the file. `uncertain`: within what the limit is uncertain by, too.
    fn fitting(&self, limit: &Limit, uncertain: bool) -> Option<usize> {
        let fits = self.declared(limit).filter_map(|target| {
            let mode = &self.modes[target];
            let told = self.told_apart(mode, limit, uncertain).ok()?;
            Some((told, mode.free.len(), target))
        });
        let best = fits.min_by_key(|&(told, free, _)| (told, free));
        best.map(|(_, _, target)| target)
    }

    /// The modes of the rests that are declared for the modes of a limit.
    fn declared<'s>(&'s self, limit: &'s Limit) -> impl Iterator<Item = usize> + 's {
        let rests = self.plan.rests.iter();
        rests.filter_map(|rest| limit.modes.contains(&rest.source).then_some(rest.target))
    }

    /// How many components of a limit are told from what a mode holds, by the limit's own uncertainty.
    ///
    /// # Errors
    /// The first component that differs from what the mode holds by more than its tolerance.
    fn told_apart(&self, mode: &Mode, limit: &Limit, uncertain: bool) -> Result<usize, Held> {
        let accuracy = self.accuracy;
        let n = self.here.q.len();
        let mut told = 0;
        for held in self.holds(mode, &limit.state) {
            let (place, value) = held.index(n);
            let absolute = match held {
                Held::At(i, _) => accuracy.q_absolute[i],
                Held::Rate(i, _) => accuracy.v_absolute[i],
            };
            let distance = (limit.state[place] - value).abs();
            // What is not a number fits nothing.
            let room = if uncertain {
                limit.uncertainty[place]
            } else {
                0.0
            };
            let fits = distance <= absolute + accuracy.relative * value.abs() + room;
            if !fits {
                return Err(held);
            }
            told += usize::from(distance > limit.uncertainty[place]);
        }
        Ok(told)
    }

    /// Everything that a mode holds at a state q, v: values, and rates.
    fn holds<'m>(&self, mode: &'m Mode, state: &[f64]) -> impl Iterator<Item = Held> + use<'m> {
        let n = self.here.v.len();
        let [mut values, mut rates] = [vec![0.0; n], vec![0.0; n]];
        with_kernel!(&mode.kernels, k => {
            let [q, v] = [0, n].map(|from| k.size().vector(|i| state[from + mode.free[i]]));
            let at = Free { q: &q, v: &v, a: &v };
            k.coordinates(&self.context, at, &mut values);
            k.rates(&self.context, at, &mut rates);
        });
        let held = (0..rates.len()).filter(|i| !mode.free.contains(i));
        held.flat_map(move |i| {
            let value = mode.held_at[i].map(|_| Held::At(i, values[i]));
            value.into_iter().chain([Held::Rate(i, rates[i])])
        })
    }

    /// Why events that accumulate do not come to rest.
    fn missing_rest(&self) -> Restless {
        let modes = self.modes;
        let relative = self.problem.accuracy.relative;
        let Some(limit) = self.accumulation.extrapolated(relative) else {
            return Restless::NoLimit;
        };
        let involved: BTreeSet<_> = limit.modes.iter().copied().collect();
        let unfit = self.declared(&limit).filter_map(|target| {
            let held = self.told_apart(&modes[target], &limit, false).err()?;
            Some(self.unfit(modes[target].name, held, &limit))
        });
        Restless::NoRest {
            of: involved.iter().map(|&m| modes[m].name).collect(),
            unfit: unfit.collect(),
            fitting: (self.undeclared(&limit, &involved)).map(|target| modes[target].name),
        }
    }

    /// The mode that fits a limit of events in some modes, holds more than each of them, and of all such modes the least.
    fn undeclared(&self, limit: &Limit, involved: &BTreeSet<usize>) -> Option<usize> {
        let holds_more = |target: &Mode, mode: &Mode| {
            target.free.len() < mode.free.len() && target.free.iter().all(|i| mode.free.contains(i))
        };
        let modes = self.modes.iter().enumerate();
        let fitting = modes.filter(|(_, target)| {
            involved.iter().all(|&m| holds_more(target, &self.modes[m]))
                && self.told_apart(target, limit, false).is_ok()
        });
        let least = fitting.min_by_key(|(_, target)| Reverse(target.free.len()));
        least.map(|(target, _)| target)
    }

    /// What a mode holds that a limit does not satisfy.
    fn unfit(&self, mode: &'static str, held: Held, limit: &Limit) -> Unfit {
        let coordinates = &self.problem.model.coordinates;
        let (place, value) = held.index(coordinates.len());
        let (holds, unit) = match held {
            Held::At(i, _) => (
                coordinates[i].name.to_owned(),
                coordinates[i].unit.to_owned(),
            ),
            Held::Rate(i, _) => (
                format!("{}.rate", coordinates[i].name),
                format!("{}/s", coordinates[i].unit),
            ),
        };
        Unfit {
            mode,
            holds,
            held: value,
            there: limit.state[place],
            unit,
        }
    }
}
