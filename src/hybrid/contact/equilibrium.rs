//! Static equilibrium with the contact forces that hold it.
//!
//! Unknown are the coordinates and the multipliers of what holds: r(q, 0, λ) = 0 with gaps and constraints at zero; what sticks
//! keeps its place, as far as the friction that holds it is not determined. A contact whose force would pull is open, and the search
//! goes on without it. Whether friction holds, and no other motion goes on, is judged as for any state a run starts in.

use super::ContactState;
use super::geometry::{Geometry, Line, multiplier, write_states};
use super::hold::{ContactValues, ROUNDOFF, hold_lines};
use crate::hybrid::equilibrium::{least_squares, to_zero};
use crate::hybrid::failure::{Reason, Stoppable};
use crate::hybrid::simulation::Simulation;
use crate::hybrid::unrest::{Tried, Unbalanced};
use crate::kernel::Free;
use crate::model::Contacts;
use crate::numerics::{Buffer, Size};
use nalgebra::{DMatrix, DVector};

/// Of contacts, which have no mode by hand.
pub(super) fn no_rest(why: Unbalanced) -> Box<Reason> {
    let of = vec![Tried { mode: None, why }];
    Box::new(Reason::NoRest { of })
}

impl<'p> Simulation<'p> {
    /// Brings coordinates to a static equilibrium of the contacts that touch there; why there is none near.
    pub(super) fn find_rest(
        &mut self,
        contacts: &'p Contacts,
        q: &mut Buffer<f64>,
    ) -> Result<(), Unbalanced> {
        let size = contacts.kernel.size();
        let zero = size.zeros();
        let at = ContactValues::new(&self.context, contacts, [q, &zero]);
        let mut states: Vec<ContactState> = (contacts.contacts.iter().enumerate())
            .map(|(k, contact)| {
                let touches = contact.normal.is_none_or(|_| {
                    let (opening, rounding) = match contact.is_ratchet {
                        false => at.position(Line::Normal(k)),
                        true => at.rate(Line::Normal(k)),
                    };
                    opening <= rounding
                });
                match (touches, contact.tangent) {
                    (false, _) => ContactState::Open,
                    (true, None) => ContactState::Closed,
                    (true, Some(_)) => match at.rate(Line::Tangent(k)) {
                        (slip, rounding) if slip.abs() <= rounding => ContactState::Sticks,
                        // A belt slides under what is at rest.
                        (slip, _) => ContactState::Slides(slip.signum()),
                    },
                }
            })
            .collect();
        loop {
            let forces = self.hold_at_rest(contacts, q, &states)?;
            let pulls = (0..states.len())
                .filter(|&k| states[k].is_closed())
                .filter_map(|k| Some((k, forces[contacts.contacts[k].normal?])))
                .filter(|(_, force)| *force < 0.0)
                .min_by(|a, b| a.1.total_cmp(&b.1));
            match pulls {
                None => break,
                // One less each time.
                Some((k, _)) => states[k] = ContactState::Open,
            }
        }
        let at = ContactValues::new(&self.context, contacts, [q, &zero]);
        let penetrates = |&k: &usize| {
            let (gap, rounding) = at.position(Line::Normal(k));
            contacts.contacts[k].normal.is_some() && gap < -rounding
        };
        match (0..states.len()).find(penetrates) {
            None => Ok(()),
            Some(k) => Err(Unbalanced::Penetrates {
                contact: contacts.contacts[k].name,
            }),
        }
    }

    /// The same while contacts do this: the multipliers.
    fn hold_at_rest(
        &mut self,
        contacts: &Contacts,
        q: &mut Buffer<f64>,
        states: &[ContactState],
    ) -> Result<Vec<f64>, Unbalanced> {
        let size = contacts.kernel.size();
        let n = size.get();
        let (zero, sizes) = (size.zeros(), self.scale(size));
        write_states(contacts, states, self.context.discrete_mut());
        let holds = |line: Line| match line {
            Line::Constraint(_) => true,
            Line::Normal(k) => states[k].is_closed(),
            Line::Tangent(k) => states[k] == ContactState::Sticks,
        };
        let mut held: Vec<Option<Line>> = vec![None; n];
        let geometry = Geometry::new(&self.context, contacts, [q, &zero]);
        let own = geometry.own.clone();
        let mut is_idle = vec![false; n];
        for line in geometry.all() {
            let of = multiplier(contacts, line);
            held[of] = holds(line).then_some(line);
            // What is open has no force: it is no unknown.
            is_idle[of] = match line {
                Line::Normal(k) | Line::Tangent(k) => states[k] == ContactState::Open,
                Line::Constraint(_) => false,
            };
        }
        let pushing: Vec<usize> = (0..n).filter(|&i| held[i].is_some()).collect();
        let slope = |i: usize, p: usize| -> f64 {
            let line = held[p].expect("it pushes");
            let k = own.iter().position(|&own| own == i).expect("no multiplier");
            geometry.along(line)[k].abs()
        };
        // Coordinates, and where one is a multiplier its force.
        let split = |x: &[f64]| {
            let place = |i: usize| if own.contains(&i) { x[i] } else { 0.0 };
            let is_force = |i: usize| !own.contains(&i) && !is_idle[i];
            let force = |i: usize| if is_force(i) { x[i] } else { 0.0 };
            (size.vector(place), size.vector(force))
        };
        let forces = |x: &Vec<f64>| {
            let ((q, a), context) = (split(x), &self.context);
            let at = Free {
                q: &q,
                v: &zero,
                a: &a,
            };
            let (mut r, bounds) = (size.zeros(), contacts.kernel.magnitude(context, at));
            contacts.kernel.residual(context, at, &mut r);
            // A force that others take is known to the rounding of the greatest that it balances.
            let known = |i: usize| {
                let of = |p: &usize| {
                    let shares = own.iter().filter(|&&j| slope(j, *p) != 0.0);
                    let parts = shares.map(|&j| bounds[j] / slope(j, *p));
                    slope(i, *p) * parts.fold(0.0, f64::max)
                };
                pushing.iter().map(of).fold(bounds[i], f64::max)
            };
            let places = ContactValues::new(context, contacts, [&q, &zero]);
            // A place is found to the rounding of typical changes; what is left is taken away at the end.
            let typical = |line| -> f64 {
                let parts = geometry.along(line).iter().zip(&own);
                parts.map(|(slope, &i)| slope.abs() * sizes[i]).sum()
            };
            let of = |i: usize| match held[i] {
                None if is_idle[i] => (0.0, 0.0),
                None if own.contains(&i) => (r[i], known(i)),
                None => (r[i], bounds[i]),
                Some(Line::Tangent(_)) => (0.0, 0.0),
                Some(line) => {
                    let (value, rounding) = places.position(line);
                    (value, typical(line).max(rounding / ROUNDOFF))
                }
            };
            (0..n).map(of).collect()
        };
        let slopes = |x: &Vec<f64>| {
            let ((q, a), context) = (split(x), &self.context);
            let at = Free {
                q: &q,
                v: &zero,
                a: &a,
            };
            let mut out = [size.zero_matrix(), size.zero_matrix(), size.zero_matrix()];
            contacts.kernel.jacobian(context, at, &mut out);
            let geometry = Geometry::new(context, contacts, [&q, &zero]);
            let [by_forces, _, by_places] = out;
            DMatrix::from_fn(n, n, |i, j| {
                let of_own = own.iter().position(|&own| own == j);
                match (held[i], of_own) {
                    _ if is_idle[i] || is_idle[j] => 0.0,
                    (Some(line), Some(j)) => geometry.along(line)[j],
                    (Some(_), None) => 0.0,
                    (None, Some(_)) => by_places[(i, j)],
                    (None, None) => by_forces[(i, j)],
                }
            })
        };
        let step = |x: &Vec<f64>, change: &[f64]| -> Vec<f64> {
            x.iter().zip(change).map(|(x, change)| x + change).collect()
        };
        let mut start: Vec<f64> = (0..n)
            .map(|i| if own.contains(&i) { q[i] } else { 0.0 })
            .collect();
        // The search begins with the forces that hold best where the coordinates are.
        let (loads, by_all): (Vec<(f64, f64)>, _) = (forces(&start), slopes(&start));
        let by_forces = DMatrix::from_fn(own.len(), pushing.len(), |i, j| {
            by_all[(own[i], pushing[j])]
        });
        let load = DVector::from_iterator(own.len(), own.iter().map(|&i| -loads[i].0));
        let best = least_squares(by_forces, &load);
        pushing
            .iter()
            .zip(&best)
            .for_each(|(&i, force)| start[i] = *force);
        // Forces have the size that they come to.
        let lengths: Vec<f64> = (0..n)
            .map(|i| if own.contains(&i) { sizes[i] } else { 1.0 })
            .collect();
        let found =
            to_zero((start, &lengths), forces, slopes, step).map_err(|i| match held[i] {
                Some(line) => Unbalanced::Unreached {
                    of: self.name_of_line(contacts, line),
                },
                None if own.contains(&i) => Unbalanced::Force {
                    coordinate: self.problem.model.coordinates[self.mode().free[i]].name,
                },
                None => Unbalanced::Unheld,
            })?;
        own.iter().for_each(|&i| q[i] = found[i]);
        let is_place = |line: &Line| holds(*line) && !matches!(line, Line::Tangent(_));
        let places: Vec<Line> = geometry.all().filter(is_place).collect();
        let state = [q, &mut size.zeros()];
        hold_lines(&self.context, contacts, [&places, &[]], state);
        Ok(found)
    }

    /// Refuses a state in which, with the contact states that were decided, something is accelerated by more than rounding.
    pub(super) fn check_rest(&mut self, contacts: &'p Contacts) -> Stoppable<()> {
        let (mode, size, scale) = (
            self.mode(),
            contacts.kernel.size(),
            self.scale(contacts.kernel.size()),
        );
        self.set_accelerations(&contacts.kernel)?;
        let [q, v, a] = self.here.free(size, &mode.free);
        let mass = contacts
            .kernel
            .system(&self.context, &q, &v)
            .factorize(&scale);
        let mass = mass.map_err(|s| Reason::singular(mode, &self.problem.model, s))?;
        let inverse = mass.inverted();
        let at = Free {
            q: &q,
            v: &v,
            a: &a,
        };
        let bounds = contacts.kernel.magnitude(&self.context, at);
        // What is below the normal numbers has no digits: terms of which all have become that small are zero.
        let rounding = |i: usize| -> f64 {
            let terms = (0..size.get()).map(|j| inverse[(i, j)].abs() * bounds[j]);
            (f64::EPSILON * terms.sum::<f64>()).max(f64::MIN_POSITIVE)
        };
        let geometry = Geometry::new(&self.context, contacts, [&q, &v]);
        let own = &geometry.own;
        let forces: Vec<f64> = own.iter().map(|&i| bounds[i]).collect();
        // Where contacts and constraints hold a coordinate, they balance forces of which the inverse knows nothing.
        let of_balance = geometry.rounding_of_accelerations(&forces);
        let moves =
            |(&i, least): (&usize, &f64)| (a[i].abs() > rounding(i).max(*least)).then_some(i);
        let moved = own.iter().zip(&of_balance).find_map(moves);
        self.here.a.fill(0.0);
        match moved {
            None => Ok(()),
            Some(i) => Err(no_rest(Unbalanced::Accelerates {
                states: self.name_of(self.here.shown).to_string(),
                coordinate: self.problem.model.coordinates[mode.free[i]].name,
                acceleration: a[i],
            })),
        }
    }

    /// What a line belongs to, in words.
    fn name_of_line(&self, contacts: &Contacts, line: Line) -> String {
        match line {
            Line::Normal(k) | Line::Tangent(k) => {
                format!("contact `{}`", contacts.contacts[k].name)
            }
            Line::Constraint(c) => format!("constraint `{}`", contacts.constraints[c].name),
        }
    }
}
