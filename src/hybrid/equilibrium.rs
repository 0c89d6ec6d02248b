//! Static equilibrium: a run that starts at rest begins where its accelerations vanish, near the configuration that the scene
//! gives.
//!
//! In a mode the forces r(q, v, 0) of its free coordinates are brought to zero by Newton's method, with steps of least norm where
//! a coordinate is in equilibrium wherever it is, and halved where a full step leads away. What contacts and constraints hold by
//! multipliers has a search of its own (`contact/equilibrium`). A mode counts where its guards agree: friction that holds, a
//! normal force that pushes.

use super::failure::Reason;
use super::limits::check_bounds;
use super::simulation::Simulation;
use super::solvers::{SlotsOf, Solvers};
use super::unrest::{Tried, Unbalanced};
use crate::kernel::{Free, ModeKernel, with_kernel};
use crate::numerics::Size;
use nalgebra::{DMatrix, DVector};

/// Halvings of a step of Newton's method after which it leads nowhere: a step of 2⁻³⁰ of its length is below what a
/// search from afar gains by, and far above rounding.
const HALVINGS: u32 = 30;

/// Iterations for each singular value at most, as in LAPACK; two or three are usual.
const ITERATIONS: usize = 30;

impl<'p> Simulation<'p> {
    /// Finds a mode in which the initial state is near an equilibrium, and goes there.
    pub fn start_at_rest(&mut self, parameters: &[f64]) -> Result<(), Reason> {
        let modes = self.modes;
        let mut candidates: Vec<usize> = (0..modes.len())
            .filter(|&m| self.plan.allowed[m] && self.initial.mode.is_none_or(|named| named == m))
            .collect();
        candidates.sort_by_key(|&m| modes[m].free.len());
        let mut refused = Vec::new();
        // What a belt slides under is at rest, rather than what it carries along.
        let tries = [false, true]
            .into_iter()
            .flat_map(|moves| candidates.iter().map(move |&m| (m, moves)));
        for (m, moves) in tries {
            self.here.q.copy_from_slice(&self.initial.q);
            self.here.v.copy_from_slice(&self.initial.v);
            (self.context.discrete_mut()).copy_from_slice(&self.initial.discrete);
            // Constraints hold in all modes; a contact holds where it touches, as it does where the search begins beyond.
            self.here.mode = self.freest();
            self.follow_others();
            if self.problem.variant().has_inadmissible() {
                self.project_gaps();
            }
            self.here.mode = m;
            self.apply_drift();
            if self.here.v.iter().any(|&rate| rate != 0.0) != moves {
                continue;
            }
            let why = match self.misfit_of(m) {
                Some(why) => Err(why.into()),
                None => with_kernel!(&modes[m].kernels, k => self.rest_in_mode(k)),
            };
            match why {
                Ok(()) => {
                    let (model, variant) = (&*self.problem.model, self.problem.variant());
                    check_bounds(model, variant, parameters, &self.here.q)?;
                    self.here.shown = m;
                    self.begun = Some(
                        [&*self.here.q, &self.here.v, self.context.discrete()]
                            .concat()
                            .into(),
                    );
                    return Ok(());
                }
                Err(why) => refused.push(Tried {
                    mode: Some(modes[m].name),
                    why,
                }),
            }
        }
        Err(Reason::NoRest { of: refused })
    }

    /// Brings the forces of the present mode to zero; why it cannot rest.
    fn rest_in_mode<F: Size>(&mut self, kernel: &'p ModeKernel<F>) -> Result<(), Unbalanced>
    where
        Solvers: SlotsOf<F>,
    {
        let mode = self.mode();
        let size = kernel.size();
        self.set_context();
        // A belt slides under what is at rest; nothing else does.
        self.follow_slip_rates(kernel);
        let [mut q, v, zero] = self.here.free(size, &mode.free);
        let (at, context) = (
            Free {
                q: &q,
                v: &v,
                a: &zero,
            },
            &self.context,
        );
        let mut slip_rates = mode.guards.iter().filter(|g| g.direction.is_some());
        if slip_rates.any(|g| kernel.guard(context, &g.kernel, at) == 0.0) {
            return Err(Unbalanced::Stands);
        }
        let sizes = self.scale(size);
        let [q, v, zero] = {
            let forces = |q: &F::Vector| {
                let at = Free { q, v: &v, a: &zero };
                let (mut r, bounds) = (size.zeros(), kernel.magnitude(&self.context, at));
                kernel.residual(&self.context, at, &mut r);
                (0..size.get()).map(|i| (r[i], bounds[i])).collect()
            };
            let slopes = |q: &F::Vector| {
                let mut out = [size.zero_matrix(), size.zero_matrix(), size.zero_matrix()];
                let at = Free { q, v: &v, a: &zero };
                kernel.jacobian(&self.context, at, &mut out);
                let [_, _, slopes] = out;
                DMatrix::from_fn(size.get(), size.get(), |i, j| slopes[(i, j)])
            };
            let step = |q: &F::Vector, step: &[f64]| size.vector(|i| q[i] + step[i]);
            let lengths: Vec<f64> = (0..size.get()).map(|i| sizes[i]).collect();
            q = to_zero((q, &lengths), forces, slopes, step).map_err(|i| Unbalanced::Force {
                coordinate: self.problem.model.coordinates[mode.free[i]].name,
            })?;
            [q, v, zero]
        };
        self.set_here(kernel, [&q, &v, &zero]);
        let entered = self.enter(kernel).map_err(Unbalanced::Stops)?;
        let moves = entered.map(|violation| mode.guards[violation.guard].name);
        self.margins.clear();
        match moves {
            None => Ok(()),
            Some(transition) => Err(Unbalanced::Happens { transition }),
        }
    }
}

/// Newton's method for forces f(x) = 0, each with a bound of its rounding in units of the unit roundoff, from a state with typical
/// `lengths` of its components: by least norm where the slopes are singular, with steps that are halved until the forces, each as a part
/// of the terms that it was the sum of at first, become less.
///
/// # Errors
/// The index of the force that is farthest from zero, if one does not come to it within its rounding.
pub(super) fn to_zero<X>(
    (start, lengths): (X, &[f64]),
    forces: impl Fn(&X) -> Vec<(f64, f64)>,
    slopes: impl Fn(&X) -> DMatrix<f64>,
    step: impl Fn(&X, &[f64]) -> X,
) -> Result<X, usize> {
    let mut state = start;
    let mut now = forces(&state);
    let scales: Vec<f64> = (now.iter())
        .map(|&(force, bound)| match bound.max(force.abs()) {
            0.0 => 1.0,
            scale => scale,
        })
        .collect();
    let size = |forces: &[(f64, f64)]| -> f64 {
        let parts = || forces.iter().zip(&scales).map(|((f, _), s)| f / s);
        let most = parts().fold(0.0, |most: f64, part| most.max(part.abs()));
        if most == 0.0 {
            return 0.0;
        }
        // Squares of the parts themselves vanish before forces do that have no terms to round, as of a spring at its length.
        let squares = parts().map(|part| (part / most) * (part / most));
        most * squares.sum::<f64>().sqrt()
    };
    // What underflows is zero: its rounding is not a part of it any more.
    let is_zero =
        |&(force, bound): &(f64, f64)| force.abs() <= (f64::EPSILON * bound).max(f64::MIN_POSITIVE);
    loop {
        let slopes = slopes(&state);
        let (rows, columns) = slopes.shape();
        let scaled = DMatrix::from_fn(rows, columns, |i, j| {
            slopes[(i, j)] * lengths[j] / scales[i]
        });
        let load = DVector::from_iterator(rows, now.iter().zip(&scales).map(|((f, _), s)| -f / s));
        let direction = least_squares(scaled, &load);
        // Forces that are zero but for rounding can become less for ever, by a last place each time: there a step is worth
        // its while that halves them.
        let before = match now.iter().all(is_zero) {
            true => 0.5 * size(&now),
            false => size(&now),
        };
        let better = (0..=HALVINGS).find_map(|halvings| {
            let part = 0.5_f64.powi(halvings as i32);
            let change: Vec<f64> = (direction.iter().zip(lengths))
                .map(|(x, length)| part * x * length)
                .collect();
            let next = step(&state, &change);
            let after = forces(&next);
            (size(&after) < before).then_some((next, after))
        });
        match better {
            Some((next, after)) => (state, now) = (next, after),
            None => break,
        }
    }
    let left = (0..now.len()).filter(|&i| !is_zero(&now[i]));
    let most = left.max_by(|&i, &j| {
        let part = |i: usize| now[i].0.abs() / scales[i];
        part(i).total_cmp(&part(j))
    });
    most.map_or(Ok(state), Err)
}

/// The solution of least norm of A x ≈ b in the sense of least squares; what of A is less than its rounding is zero.
pub(super) fn least_squares(matrix: DMatrix<f64>, load: &DVector<f64>) -> Vec<f64> {
    let (rows, columns) = matrix.shape();
    // What is not a number leads nowhere.
    let is_finite = matrix.iter().chain(load.iter()).all(|x| x.is_finite());
    if rows == 0 || columns == 0 || !is_finite {
        return vec![0.0; columns];
    }
    let most = ITERATIONS * rows.max(columns);
    let Some(decomposed) = matrix.try_svd(true, true, f64::EPSILON, most) else {
        return vec![0.0; columns];
    };
    let largest = decomposed.singular_values.max();
    let least = f64::EPSILON * rows.max(columns) as f64 * largest;
    match decomposed.solve(load, least) {
        Ok(solution) => solution.iter().copied().collect(),
        // There is one with both factors.
        Err(_) => vec![0.0; columns],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// A force of a rounding, of which each step takes a millionth: of one spring the search lasted for hours.
    #[test]
    fn what_is_zero_but_for_rounding_is_found() {
        let asked = Cell::new(0);
        let forces = |x: &f64| {
            asked.set(asked.get() + 1);
            vec![(1e-17 - x, 1.0)]
        };
        let slopes = |_: &f64| DMatrix::from_element(1, 1, -1e6);
        let step = |x: &f64, change: &[f64]| x + change[0];
        let found = to_zero((0.0, &[1.0]), forces, slopes, step).expect("it is zero");
        assert!(found.abs() <= 1e-17 && asked.get() < 100, "{}", asked.get());
    }
}
