//! Start of a segment: consistent accelerations, and the sign of every guard.

use super::failure::{Reason, Stoppable};
use super::guards::{Conditions, slope, value, watched_value};
use super::requirements::check_requirements;
use super::roots::Watch;
use super::simulation::{Simulation, Violation};
use crate::integrate::{determinant_sign, solve};
use crate::kernel::{Context, Free, ModeKernel};
use crate::model::{Guard, GuardShape};
use nalgebra::{SMatrix, SVector};

/// Unit roundoff of a double.
const ROUNDOFF: f64 = f64::EPSILON / 2.0;

impl Simulation<'_> {
    /// Typical sizes of the free coordinates: absolute ÷ relative tolerance.
    pub fn scale<const F: usize>(&self) -> SVector<f64, F> {
        let free = self.mode().free;
        SVector::from_fn(|i, _| self.sizes[free[i]])
    }

    /// Enters the present mode: sets accelerations and remembered signs, and gives the first guard
    /// that is not respected.
    pub fn enter<const F: usize>(
        &mut self,
        kernel: &'static ModeKernel<F>,
    ) -> Stoppable<Option<Violation>> {
        self.set_context();
        let mode = self.mode();
        if self.plan.drifts[self.here.mode] {
            kernel.held_rates(&self.context, &mut self.drift);
        }
        let [q, v, _] = self.here.free::<F>(mode.free);
        self.check_inertia(kernel, [&q, &v])?;
        let system = kernel.system(&self.context, &q, &v);
        if determinant_sign(&system.mass) < 0 {
            return Err(Box::new(Reason::DeterminantChangesSign { mode: mode.name }));
        }
        let scale = self.scale::<F>();
        let mut a = solve(&system.mass, &-system.load, &scale)
            .map_err(|s| Reason::singular(mode, self.problem.model, s))?;

        let start = Start {
            kernel,
            mass: &system.mass,
            scale: &scale,
            at: [&q, &v],
        };

        self.signs.clear();
        let mut violation = None;
        for &watched in &self.plan.watched[self.here.mode] {
            let guard = &mode.guards[watched.guard];
            let mut conditions = Conditions {
                modes: self.modes,
                plan: &self.plan,
                next: &mut self.next,
            };
            let conditional = watched.conditional;
            let at = Free {
                q: &q,
                v: &v,
                a: &a,
            };
            let own = watched_value(
                kernel,
                &mut self.context,
                &mut conditions,
                guard,
                watched,
                at,
            );
            let mut watch = Watch::of(own);
            let violated = match watched.condition {
                None if conditional => {
                    let of = (guard, watched);
                    value(kernel, &mut self.context, &mut conditions, of, at) < 0.0
                }
                None => watch == Watch::Violated,
                // The guard's own entry has decided about its conditions, too.
                Some(_) => false,
            };
            let mut at_once = false;
            if watch == Watch::Dormant && !conditional {
                at_once = start.departure(&self.context, guard, &mut a) < 0.0;
            }
            if at_once {
                watch = Watch::Violated;
            }
            if (violated || at_once) && violation.is_none() {
                let rests = at_once && is_at_rest(guard, &v);
                violation = Some(Violation {
                    guard: watched.guard,
                    rests,
                });
            }
            self.signs.watches.push(watch);
        }
        self.signs.start();
        if violation.is_none() {
            let at = Free {
                q: &q,
                v: &v,
                a: &a,
            };
            check_requirements(kernel, &self.context, mode, at)?;
        }
        self.here.a.fill(0.0);
        self.here.set_free(mode.free, [&q, &v, &a]);
        Ok(violation)
    }

    /// Enters the present mode again after an event in it, where that takes no more than what most events
    /// ask for: guards that are positive, or zero and rise. Given free coordinates and velocities, sets the
    /// accelerations too where they are needed; false: the mode is to be entered as any other. What the mode requires
    /// is looked at in the first step.
    pub fn enter_again<const F: usize>(
        &mut self,
        kernel: &'static ModeKernel<F>,
        q: SVector<f64, F>,
        v: SVector<f64, F>,
        needs_accelerations: bool,
    ) -> Stoppable<bool> {
        let mode = self.mode();
        if self.plan.drifts[self.here.mode] || self.check_inertia(kernel, [&q, &v]).is_err() {
            return Ok(false);
        }
        self.signs.clear();
        for watched in &self.plan.watched[self.here.mode] {
            let guard = &mode.guards[watched.guard];
            let GuardShape::Linear {
                index,
                rate,
                factor,
                discrete,
                ..
            } = guard.shape
            else {
                return Ok(false);
            };
            let at = Free {
                q: &q,
                v: &v,
                a: &SVector::zeros(),
            };
            let value = kernel.guard(&self.context, &guard.kernel, at);
            let factor = slope((factor, discrete), &self.context);
            let rises = !rate && factor * v[index] > 0.0;
            if guard.transitions.iter().any(|t| t.conditional)
                || !(value > 0.0 || value == 0.0 && rises)
            {
                return Ok(false);
            }
            self.signs.watches.push(Watch::of(value));
        }
        self.signs.start();
        if needs_accelerations || self.has_sample_left() {
            let system = kernel.system(&self.context, &q, &v);
            let a = solve(&system.mass, &-system.load, &self.scale::<F>());
            let Some(a) = a.ok().filter(|_| determinant_sign(&system.mass) > 0) else {
                return Ok(false);
            };
            self.here.set_free(mode.free, [&q, &v, &a]);
            self.flush_samples();
        }
        Ok(true)
    }

    /// The inertia of the present mode must be positive definite; one that follows from the parameters alone is looked
    /// at once.
    #[inline(always)]
    fn check_inertia<const F: usize>(
        &mut self,
        kernel: &'static ModeKernel<F>,
        [q, v]: [&SVector<f64, F>; 2],
    ) -> Stoppable<()> {
        if !(kernel.inertia_is_fixed() && self.has_inertia[self.here.mode]) {
            self.factorize_inertia(&kernel.inertia(&self.context, q, v))?;
            self.has_inertia[self.here.mode] = true;
        }
        Ok(())
    }

    /// The symmetric part of an inertia must be positive definite: its factors L D Lᵀ have positive pivots D.
    fn factorize_inertia<const F: usize>(&self, inertia: &SMatrix<f64, F, F>) -> Stoppable<()> {
        // L D below the diagonal, D on it.
        let mut lower = SMatrix::<f64, F, F>::zeros();
        for i in 0..F {
            for j in 0..=i {
                let symmetric = 0.5 * (inertia[(i, j)] + inertia[(j, i)]);
                let product = |k| lower[(i, k)] * (lower[(j, k)] / lower[(k, k)]);
                let rest = symmetric - (0..j).map(product).sum::<f64>();
                if i == j {
                    // A pivot within the rounding of its own sum is not told from zero.
                    let rounding = (F + 1) as f64 * ROUNDOFF * symmetric.abs();
                    if rest.is_nan() || rest <= rounding {
                        let mode = self.mode();
                        let coordinate = self.problem.model.coordinates[mode.free[i]].name;
                        return Err(Box::new(Reason::Indefinite {
                            mode: mode.name,
                            coordinate,
                            pivot: rest,
                        }));
                    }
                }
                lower[(i, j)] = rest;
            }
        }
        Ok(())
    }
}

/// The state at the start of a segment, for guards that are exactly zero there.
struct Start<'a, const F: usize> {
    kernel: &'static ModeKernel<F>,
    mass: &'a SMatrix<f64, F, F>,
    scale: &'a SVector<f64, F>,
    /// Free coordinates and velocities.
    at: [&'a SVector<f64, F>; 2],
}

impl<const F: usize> Start<'_, F> {
    /// Sign with which a guard that is exactly zero leaves zero: that of its first derivative that is
    /// not zero; 0 where that is not decided here and the motion must tell.
    ///
    /// An acceleration below its own rounding error is no evidence: at a smooth lift-off θ = θ̇ = θ̈ = 0
    /// and the jerk decides. It is then set to zero, so that the motion starts with the sign of the
    /// jerk.
    fn departure(&self, context: &Context, guard: &Guard, a: &mut SVector<f64, F>) -> f64 {
        let [q, v] = self.at;
        match guard.shape {
            GuardShape::Linear {
                index,
                rate,
                factor,
                discrete,
                ..
            } => {
                let factor = slope((factor, discrete), context);
                if !rate && v[index] != 0.0 {
                    return factor * v[index];
                }
                let inverse = inverse(self.mass, self.scale);
                let at = Free { q, v, a: &*a };
                let size = self.kernel.magnitude(context, at);
                let noise: f64 = (0..F)
                    .map(|j| inverse[(index, j)].abs() * size[j] * ROUNDOFF)
                    .sum();
                if a[index].abs() > noise {
                    return factor * a[index];
                }
                let jerk = -inverse * self.kernel.jerk_load(context, at);
                a[index] = 0.0;
                factor * jerk[index]
            }
            GuardShape::General { .. } => {
                let at = Free { q, v, a: &*a };
                let jerk = -inverse(self.mass, self.scale) * self.kernel.jerk_load(context, at);
                self.kernel.guard_rate(context, &guard.kernel, at, &jerk)
            }
        }
    }
}

/// Whether a guard that leaves zero at once does so from rest: a coordinate without speed. Any other
/// departure that is decided on entry has a rate.
fn is_at_rest<const F: usize>(guard: &Guard, v: &SVector<f64, F>) -> bool {
    match guard.shape {
        GuardShape::Linear {
            index, rate: false, ..
        } => v[index] == 0.0,
        _ => false,
    }
}

/// The inverse of a mass matrix that was just solved with.
fn inverse<const F: usize>(
    mass: &SMatrix<f64, F, F>,
    scale: &SVector<f64, F>,
) -> SMatrix<f64, F, F> {
    let mut inverse = SMatrix::<f64, F, F>::zeros();
    for j in 0..F {
        let unit = SVector::from_fn(|i, _| if i == j { 1.0 } else { 0.0 });
        if let Ok(column) = solve(mass, &unit, scale) {
            inverse.set_column(j, &column);
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::super::problem::Problem;
    use super::*;
    use crate::kernel::{MODELS, with_kernel};

    /// A ball at height y with velocity v, just after an event in flight: whether it flies on, and the sign
    /// remembered of its height.
    fn flies_on(y: f64, v: f64) -> Option<Watch> {
        let model = MODELS.iter().find(|m| m.name == "bouncing_ball").unwrap();
        let problem = Problem::new(model);
        let mut simulation = Simulation::new(&problem).unwrap();
        simulation.here.mode = 0;
        (simulation.here.q[0], simulation.here.v[0]) = (y, v);
        simulation.set_context();
        let mode = simulation.mode();
        let again = with_kernel!(&mode.kernels, k => {
            let [q, v, _] = simulation.here.free(mode.free);
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
