//! Start of a segment: consistent accelerations, and the sign of every guard.

use super::contact::{Guarded, guarded_by_contacts, held_by_others};
use super::departure::Departure;
use super::failure::{Reason, Stoppable};
use super::guards::{Conditions, Linear, watched_value};
use super::inertia::pivots;
use super::rise::{Leaves, Start};
use super::roots::Watch;
use super::simulation::{Simulation, Violation};
use super::solvers::{SlotsOf, Solvers};
use crate::integrate::{Size, Vector};
use crate::jets::ORDERS;
use crate::kernel::{Free, ModeKernel};
use crate::model::{Contacts, Guard, GuardShape};

impl<'p> Simulation<'p> {
    /// Typical sizes of the free coordinates: absolute ÷ relative tolerance.
    pub fn scale<F: Size>(&self, size: F) -> F::Vector {
        let free = &self.mode().free;
        size.vector(|i| self.sizes[free[i]])
    }

    /// Sets the rates of what drifts in the present mode.
    pub fn set_drift_in<F: Size>(&mut self, kernel: &ModeKernel<F>) {
        let coordinates = self.here.q.len();
        kernel.drift(&self.context, &mut self.drift[..coordinates]);
    }

    /// Enters the present mode: sets accelerations and remembered signs, and gives the first guard
    /// that is not respected.
    pub fn enter<F: Size>(&mut self, kernel: &'p ModeKernel<F>) -> Stoppable<Option<Violation>>
    where
        Solvers: SlotsOf<F>,
    {
        self.set_context();
        let mode = self.mode();
        if self.plan.moves[self.here.mode] {
            self.set_drift_in(kernel);
        }
        let [q, v, _] = self.here.free(kernel.size(), &mode.free);
        self.check_inertia(kernel, [&q, &v])?;
        let system = kernel.system(&self.context, &q, &v);
        let mass = system
            .factorize(&self.scale(kernel.size()))
            .map_err(|s| Reason::singular(mode, &self.problem.model, s))?;
        // With multipliers its sign means nothing by itself, and what may follow was judged.
        if mode.contacts.is_none() && mass.sign() < 0 {
            return Err(Box::new(Reason::DeterminantChangesSign { mode: mode.name }));
        }
        let mut a = system.accelerations_by(&mass);

        let start = Start {
            kernel,
            mass: &mass,
            at: [&q, &v],
            t: self.here.now.seconds(),
        };

        let is_explicit = self.is_explicit();
        self.signs.clear();
        let mut violation = None;
        let held = match &mode.contacts {
            Some(contacts) => held_by_others(&self.context, contacts, [q.as_slice(), v.as_slice()]),
            None => Vec::new(),
        };
        let guarded = match &mode.contacts {
            Some(_) => {
                let guards = self.at_zero.iter().map(|zero| zero.guard);
                let opening: Vec<usize> = guards.filter(|g| g % Contacts::GUARDS == 0).collect();
                let of = (mode, self.accuracy, &*opening);
                guarded_by_contacts(&self.context, of, [q.as_slice(), v.as_slice()])
            }
            None => Vec::new(),
        };
        for w in 0..self.plan.watched[self.here.mode].len() {
            let watched = self.plan.watched[self.here.mode][w];
            let guard = &mode.guards[watched.guard];
            let mut conditions = Conditions {
                modes: self.modes,
                plan: &self.plan,
                next: &mut self.next,
            };
            let at = Free {
                q: &q,
                v: &v,
                a: &a,
            };
            let context = &mut self.context;
            let own = watched_value(kernel, context, &mut conditions, guard, watched, at);
            let told = guarded.iter().find(|(guard, _)| *guard == watched.guard);
            if let Some((_, told)) = told.filter(|_| !watched.conditional) {
                match *told {
                    Guarded::Held => self.signs.remember(Watch::Dormant, f64::INFINITY),
                    Guarded::Rises(contact) => {
                        let until = self.signs.positive_until(contact);
                        self.signs.remember(Watch::of(own), until);
                    }
                    Guarded::LeavesBelow => {
                        self.signs.remember(Watch::Violated, 0.0);
                        violation = violation.or(Some(Violation {
                            guard: watched.guard,
                            rests: false,
                        }));
                    }
                }
                continue;
            }
            let zero = self.at_zero.iter().find(|zero| zero.guard == watched.guard);
            let vanishing = zero.map_or(0, |zero| zero.vanishing);
            if held.contains(&watched.guard) {
                let departure = self.departure(watched.guard, vanishing, ORDERS);
                if matches!(departure, Departure::Stays { .. } | Departure::Unknown) {
                    self.signs.remember(Watch::Dormant, f64::INFINITY);
                    continue;
                }
            }
            let sign = match vanishing {
                0 => Watch::of(own),
                _ => Watch::Dormant,
            };
            // The guard's own entry decides about its conditions, too.
            if sign == Watch::Armed || watched.condition.is_some() {
                self.signs.remember(sign, 0.0);
                continue;
            }
            let plain = (sign == Watch::Dormant && !watched.conditional)
                .then(|| start.leaves(&self.context, guard, &a));
            let plain = match plain.flatten() {
                // The dense output of the Taylor method shows it as it is.
                Some(Leaves::BySeries { order, .. }) if is_explicit => {
                    Some(Departure::Up { order, until: 0.0 })
                }
                Some(Leaves::BySeries { coordinate, order }) => {
                    let until = self.rises_for(kernel, (&start, &a), (coordinate, order));
                    until.map(|until| Departure::Up { order, until })
                }
                Some(Leaves::At(departure)) => Some(departure),
                None => None,
            };
            let departure = match plain {
                Some(departure) => departure,
                // A rise by the first derivative shows on a step of the Taylor method.
                None => {
                    let shown = usize::from(is_explicit && vanishing == 1);
                    self.departure(watched.guard, vanishing, shown)
                }
            };
            let (watch, away) = match departure {
                // Its dense output shows it.
                Departure::Up { until: 0.0, .. } => (sign, 0.0),
                Departure::Up { until, .. } => (Watch::Armed, until),
                Departure::Down { .. } => (Watch::Violated, 0.0),
                // A force that nothing tells from zero does not pull (a block that rests on another, and both fall freely).
                Departure::Stays { until }
                    if until > 0.0 && mode.is_of_forces(watched.guard, self.context.discrete()) =>
                {
                    (Watch::Armed, until)
                }
                Departure::Stays { .. } | Departure::Unknown => (sign, 0.0),
            };
            self.signs.remember(watch, away);
            if let Some(index) = idle_acceleration(guard, departure) {
                a[index] = 0.0;
            }
            let falls = match departure {
                Departure::Down { .. } => true,
                Departure::Unknown => sign == Watch::Violated,
                Departure::Up { .. } | Departure::Stays { .. } => false,
            };
            if falls && violation.is_none() {
                let at = Free {
                    q: &q,
                    v: &v,
                    a: &a,
                };
                let acts = !watched.conditional
                    || guard.transitions.iter().any(|transition| {
                        self.plan.allowed[transition.target] && {
                            let least = self.least_condition(kernel, transition, at);
                            self.may_take(kernel, transition, (at, least))
                        }
                    });
                if acts {
                    violation = Some(Violation {
                        guard: watched.guard,
                        rests: is_at_rest(guard, departure, &v),
                    });
                }
            }
        }
        self.signs.start();
        if violation.is_none() {
            // A chart keeps them.
            self.at_zero.clear();
            let at = Free {
                q: &q,
                v: &v,
                a: &a,
            };
            let t = self.here.now.seconds();
            (self.margins).check_start(kernel, &self.context, (mode, at), t)?;
        }
        self.set_here(kernel, [&q, &v, &a]);
        Ok(violation)
    }

    /// Enters the present mode again after an event in it, where that takes no more than what most events
    /// ask for: guards that are positive, or zero and rise. Given free coordinates and velocities, sets the
    /// accelerations too where they are needed; false: the mode is to be entered as any other. What the mode requires
    /// is looked at in the first step.
    pub fn enter_again<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        q: F::Vector,
        v: F::Vector,
        needs_accelerations: bool,
    ) -> Stoppable<bool> {
        let mode = self.mode();
        if self.plan.moves[self.here.mode] || self.check_inertia(kernel, [&q, &v]).is_err() {
            return Ok(false);
        }
        self.signs.clear();
        let zero = kernel.size().zeros();
        for watched in &self.plan.watched[self.here.mode] {
            let guard = &mode.guards[watched.guard];
            let Some(linear) = Linear::of(guard.shape, &self.context) else {
                return Ok(false);
            };
            let at = Free {
                q: &q,
                v: &v,
                a: &zero,
            };
            let is_closed = self.at_zero.iter().any(|zero| zero.guard == watched.guard);
            let value = match is_closed {
                true => 0.0,
                false => kernel.guard(&self.context, &guard.kernel, at),
            };
            let rises = !linear.rate && linear.factor * v[linear.index] > 0.0;
            if guard.transitions.iter().any(|t| t.conditional)
                || !(value > 0.0 || value == 0.0 && rises)
            {
                return Ok(false);
            }
            self.signs.remember(Watch::of(value), 0.0);
        }
        self.at_zero.clear();
        self.signs.start();
        if needs_accelerations || self.has_sample_left() {
            let system = kernel.system(&self.context, &q, &v);
            let mass = system.factorize(&self.scale(kernel.size())).ok();
            let Some(mass) = mass.filter(|mass| mass.sign() > 0) else {
                return Ok(false);
            };
            let a = system.accelerations_by(&mass);
            self.here.set_free(&mode.free, [&q, &v, &a]);
            self.flush_samples()?;
        }
        Ok(true)
    }

    /// The inertia of the present mode must be positive definite; one that follows from the parameters alone is looked
    /// at once.
    #[inline(always)]
    fn check_inertia<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        [q, v]: [&F::Vector; 2],
    ) -> Stoppable<()> {
        if !(kernel.inertia_is_fixed() && self.has_inertia[self.here.mode]) {
            let mode = self.mode();
            pivots(&kernel.inertia(&self.context, q, v)).map_err(|not| Reason::Indefinite {
                mode: mode.name,
                coordinate: self.problem.model.coordinates[mode.free[not.row]].name,
                pivot: not.pivot,
            })?;
            self.has_inertia[self.here.mode] = true;
        }
        Ok(())
    }
}

/// The coordinate of a guard whose acceleration is no evidence of how it departs: it is zero, and the motion starts
/// without it.
fn idle_acceleration(guard: &Guard, departure: Departure) -> Option<usize> {
    let GuardShape::Linear { index, rate, .. } = guard.shape else {
        return None;
    };
    let of_acceleration = if rate { 1 } else { 2 };
    let is_idle = match departure {
        Departure::Up { order, .. } | Departure::Down { order } => order > of_acceleration,
        Departure::Stays { .. } => true,
        Departure::Unknown => false,
    };
    is_idle.then_some(index)
}

/// Whether a guard leaves zero at once, and from rest: it is a coordinate without speed, or what else depends on no acceleration
/// and has a rate that is zero but for its rounding. Any other departure that is decided on entry has a rate.
fn is_at_rest(guard: &Guard, departure: Departure, v: &impl Vector) -> bool {
    let Departure::Down { order: order @ 1.. } = departure else {
        return false;
    };
    match guard.shape {
        GuardShape::Linear {
            index, rate: false, ..
        } => v[index] == 0.0,
        GuardShape::Linear { rate: true, .. } => false,
        GuardShape::General { accelerations, .. } => !accelerations && order > 1,
    }
}

#[cfg(test)]
mod tests {
    use super::super::problem::Problem;
    use super::*;
    use crate::kernel::with_kernel;
    use crate::model::models;

    /// A ball at height y with velocity v, just after an event in flight: whether it flies on, and the sign
    /// remembered of its height.
    fn flies_on(y: f64, v: f64) -> Option<Watch> {
        let model = models().find("hand_ball").unwrap();
        let problem = Problem::new(&model);
        let mut simulation = Simulation::new(&problem).unwrap();
        simulation.here.mode = 0;
        (simulation.here.q[0], simulation.here.v[0]) = (y, v);
        simulation.set_context();
        let mode = simulation.mode();
        let again = with_kernel!(&mode.kernels, k => {
            let [q, v, _] = simulation.here.free(k.size(), &mode.free);
            simulation.enter_again(k, q, v, true).unwrap()
        });
        again.then(|| simulation.signs.watches[0])
    }

    #[test]
    fn only_guards_that_are_positive_or_rise_from_zero_let_a_mode_go_on() {
        assert_eq!(flies_on(1.0, -1.0), Some(Watch::Armed));
        assert_eq!(flies_on(0.0, 1.0), Some(Watch::Dormant));
        for (y, v) in [(-1e-300, 1.0), (0.0, 0.0), (0.0, -1.0), (f64::NAN, 1.0)] {
            assert_eq!(flies_on(y, v), None, "{y} {v}");
        }
    }
}
