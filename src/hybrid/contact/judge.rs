//! Which sets of contact states may follow: all of those that touch are tried (of many those that a pivoting method finds), each
//! on the motion that it leads to.
//!
//! A set may go on where what pushes does not pull, what opens does not close, what sticks does not slip and what begins to
//! slip does so in its direction: on the first derivative that rounding does not hide (`departure.rs`). Motions that are equal
//! count once, whatever the names of their sets.

use super::geometry::{Geometry, Line, write_states};
use super::hold::ContactValues;
use super::many::{all_of_many, count, to_try};
use super::share::{Dropped, Forces, Sharing};
use super::unforced::Unforced;
use super::{ContactState, Tangent};
use crate::hybrid::failure::Reason;
use crate::hybrid::simulation::Simulation;
use crate::jets::{ORDERS, Point};
use crate::model::{Contact, Contacts, Mode};

/// Which of the results of the tape of decisions.
const PUSH: usize = 0;
pub(super) const GAP: usize = 1;
pub(super) const FORWARDS: usize = 2;
pub(super) const BACKWARDS: usize = 3;
pub(super) const SLIP: usize = 4;

/// Sets of the states of one contact: what would rule some of them out costs as much as to judge two.
const FEW_SETS: usize = 4;

/// A set of contact states that may follow.
#[derive(Debug)]
pub(super) struct Candidate {
    pub states: Vec<ContactState>,
    pub discrete: Vec<f64>,
}

/// A candidate that may go on.
pub(super) struct Admitted {
    pub candidate: Candidate,
    pub orders: Orders,
}

/// What is decided about.
pub(super) struct Case<'p, 'a> {
    pub contacts: &'p Contacts,
    pub geometry: &'a Geometry,
    pub places: &'a ContactValues,
    /// What touches without a rate, with what its tangent does.
    pub touching: &'a [Option<Tangent>],
    /// What contacts do without forces, where that rules sets out.
    pub unforced: Option<Unforced>,
}

/// How results of the tape of decisions that had to be positive became so.
#[derive(Debug, Default)]
pub(super) struct Orders {
    /// Of each that is zero, which derivative decided, if any did.
    decided: Vec<(usize, usize)>,
    /// Whether each was decided.
    pub are_known: bool,
}

/// What was found.
pub(super) struct Decision {
    pub states: Vec<ContactState>,
    pub discrete: Vec<f64>,
    orders: Orders,
}

impl Decision {
    /// How many derivatives of the acceleration of a contact's gap vanish, itself among them, where it opens.
    pub fn vanishing_of_gap(&self, k: usize) -> usize {
        self.vanishing(k, GAP)
    }

    /// The same of the acceleration of its slip, where it begins to slip.
    pub fn vanishing_of_slip(&self, k: usize) -> usize {
        self.vanishing(k, SLIP)
    }

    fn vanishing(&self, k: usize, what: usize) -> usize {
        let index = k * Contacts::DECISIONS + what;
        let of = self
            .orders
            .decided
            .iter()
            .find(|(known, _)| *known == index);
        of.map_or(0, |(_, order)| *order)
    }
}

impl<'p> Simulation<'p> {
    /// The set that follows where the contacts that are given touch without a rate, with what their tangents do; all others are
    /// open. The state is that of `next`.
    pub(super) fn decide(
        &mut self,
        (contacts, geometry): (&'p Contacts, &Geometry),
        places: &ContactValues,
        touching: &[Option<Tangent>],
    ) -> Result<Decision, Reason> {
        self.expand_signals();
        let choices = choices(contacts, touching);
        let holds = |k: usize, state: &ContactState| {
            let has_gap = contacts.contacts[k].normal.is_some();
            (has_gap && state.is_closed()).then_some(Line::Normal(k))
        };
        let unforced = (count(&choices) > FEW_SETS)
            .then(|| self.unforced((contacts, geometry), places, touching))
            .flatten();
        let sets = to_try(&choices, geometry, holds, || match &unforced {
            Some(unforced) => self.answers((contacts, geometry), places, (touching, unforced)),
            None => Ok(Vec::new()),
        });
        let case = Case {
            contacts,
            geometry,
            places,
            touching,
            unforced: unforced.filter(|_| !contacts.follows_motion),
        };
        // A contact that is to slip whose slip others hold goes on as one that sticks (the same motion, and friction within its
        // bound): such sets are idle, and tried where no other is admitted.
        let mut idle = Vec::new();
        let mut admitted = Vec::new();
        for states in &sets {
            admitted.extend(self.judge(&case, states.clone(), (Some(&mut idle), false)));
        }
        let mut judge = |states, is_exact| self.judge(&case, states, (None, is_exact));
        if admitted.is_empty() {
            admitted.extend(idle.into_iter().filter_map(|states| judge(states, false)));
        }
        if admitted.is_empty() {
            let all = all_of_many(&choices);
            admitted.extend(all.filter_map(|states| judge(states, false)));
        }
        // Of two forces that are as small as the state's rounding makes them (a block that rests on another, and both fall freely) one may
        // be zero within its bound and fall, and the other below zero beyond its own. Then the state is taken as it is.
        if admitted.is_empty() {
            let taken = sets.into_iter();
            admitted.extend(taken.filter_map(|states| judge(states, true)));
        }
        let Admitted { candidate, orders } = self.one_motion(&case, admitted)?;
        Ok(Decision {
            states: candidate.states,
            discrete: candidate.discrete,
            orders,
        })
    }

    /// A set, if it may go on; one that is idle is put aside if that is asked for. The state is known to its rounding, or `is_exact`.
    pub(super) fn judge(
        &mut self,
        case: &Case<'p, '_>,
        states: Vec<ContactState>,
        (idle, is_exact): (Option<&mut Vec<Vec<ContactState>>>, bool),
    ) -> Option<Admitted> {
        let Case {
            contacts,
            geometry,
            places,
            touching,
            ref unforced,
        } = *case;
        let sharing = Sharing::new(contacts, geometry, places, &states)?;
        match idle {
            Some(idle) if sharing.holds_a_slip(geometry, &states, touching) => {
                idle.push(states);
                return None;
            }
            _ => {}
        }
        let is_out = |of: &Unforced| {
            sharing.is_determined() && of.rules_out(places, &states, touching, sharing.unknown())
        };
        let is_out = unforced.as_ref().is_some_and(is_out);
        // Tests are built with assertions: there each set is judged.
        if is_out && !cfg!(debug_assertions) {
            return None;
        }
        let of = (states, sharing, is_exact);
        let admitted = self.admitted((contacts, geometry), places, touching, of);
        debug_assert!(
            !(is_out && admitted.is_some()),
            "a set that may go on was ruled out"
        );
        admitted
    }

    /// A set, if it may go on: with some share of the forces that are not determined.
    fn admitted(
        &mut self,
        (contacts, geometry): (&'p Contacts, &Geometry),
        places: &ContactValues,
        touching: &[Option<Tangent>],
        (states, sharing, is_exact): (Vec<ContactState>, Sharing, bool),
    ) -> Option<Admitted> {
        let present = self.context.discrete().to_vec();
        let candidate = |dropped: &Dropped| {
            let mut discrete = present.clone();
            write_states(contacts, &states, &mut discrete);
            sharing.write(contacts, dropped, &mut discrete);
            let states = states.clone();
            Candidate { states, discrete }
        };
        let first = candidate(&sharing.without_friction(geometry));
        if let Some(orders) = self.admit(contacts, (&first, is_exact), touching) {
            let candidate = first;
            return Some(Admitted { candidate, orders });
        }
        if sharing.is_determined() {
            return None;
        }
        let forces = self.forces(contacts, &first)?;
        let corners = sharing.corners(geometry, places, &forces);
        corners.iter().map(candidate).find_map(|candidate| {
            let orders = self.admit(contacts, (&candidate, is_exact), touching)?;
            Some(Admitted { candidate, orders })
        })
    }

    /// The forces of a candidate; `None` if they are not known.
    fn forces(&mut self, contacts: &'p Contacts, candidate: &Candidate) -> Option<Vec<Forces>> {
        let mode = self.mode();
        let at = point(&self.next, self.here.q.len(), &candidate.discrete);
        let tape = &contacts.decisions;
        self.expansion.begin(mode, at, None);
        self.expansion.expand(mode, tape, 0);
        let of = |k: usize| {
            let value = |what: usize| {
                let known = self.expansion.result(tape, k * Contacts::DECISIONS + what)[0];
                known.error.is_finite().then_some(known.value)
            };
            let (forwards, backwards) = (value(FORWARDS)?, value(BACKWARDS)?);
            Some(Forces {
                normal: value(PUSH)?,
                friction: 0.5 * (backwards - forwards),
                limit: 0.5 * (backwards + forwards),
            })
        };
        (0..contacts.contacts.len()).map(of).collect()
    }

    /// Which derivatives decided about a candidate, if it may go on.
    fn admit(
        &mut self,
        contacts: &'p Contacts,
        (candidate, is_exact): (&Candidate, bool),
        touching: &[Option<Tangent>],
    ) -> Option<Orders> {
        let asked = asked(contacts, candidate, touching);
        let orders = self.stay_positive(contacts, (candidate, is_exact), asked)?;
        self.keeps_dropped(contacts, candidate, touching)
            .then_some(orders)
    }

    /// Which derivatives decided that results of the tape of decisions, each with its sign, are positive in a candidate or become so
    /// at once, if they do. The state is one that is known to its rounding, or `is_exact`.
    pub(super) fn stay_positive(
        &mut self,
        contacts: &'p Contacts,
        (candidate, is_exact): (&Candidate, bool),
        asked: Vec<(usize, f64)>,
    ) -> Option<Orders> {
        let mode: &Mode = self.mode();
        let at = point(&self.next, self.here.q.len(), &candidate.discrete);
        let tape = &contacts.decisions;
        let expansion = &mut self.expansion;
        let sizes = [&*self.sizes, &*self.rate_sizes];
        expansion.begin(mode, at, (!is_exact).then_some(sizes));
        expansion.expand(mode, tape, 0);
        let mut open = Vec::new();
        let mut decided = Vec::new();
        for (index, sign) in asked {
            let value = expansion.result(tape, index)[0];
            // A force that is not known is none.
            if !value.error.is_finite() {
                return None;
            }
            match value.sign() {
                Some(positive) if positive == (sign > 0.0) => {}
                Some(_) => return None,
                None => open.push((index, sign)),
            }
        }
        // What is zero leaves zero as the motion from the state that is given does.
        if !open.is_empty() {
            expansion.begin(mode, at, None);
            expansion.expand(mode, tape, 0);
        }
        for k in 1..ORDERS {
            if open.is_empty() {
                break;
            }
            expansion.expand(mode, tape, k);
            let mut falls = false;
            open.retain(
                |&(index, sign)| match expansion.result(tape, index)[k].sign() {
                    Some(positive) => {
                        falls |= positive != (sign > 0.0);
                        decided.push((index, k));
                        false
                    }
                    None => true,
                },
            );
            if falls {
                return None;
            }
        }
        let are_known = open.is_empty();
        Some(Orders { decided, are_known })
    }

    /// Whether the slips that others are to hold do stay zero. Where lines depend on each other at this position alone, as a mechanism
    /// passes a dead centre, such a slip is zero for an instant, and goes on with another sign.
    fn keeps_dropped(
        &mut self,
        contacts: &'p Contacts,
        candidate: &Candidate,
        touching: &[Option<Tangent>],
    ) -> bool {
        let touch = (0..touching.len()).filter(|&k| touching[k].is_some());
        let dropped: Vec<usize> = touch
            .filter(|&k| candidate.states[k] == ContactState::Sticks)
            .filter(|&k| contacts.contacts[k].is_dropped(&candidate.discrete))
            .map(|k| k * Contacts::DECISIONS + SLIP)
            .collect();
        if dropped.is_empty() {
            return true;
        }
        let mode: &Mode = self.mode();
        let at = point(&self.next, self.here.q.len(), &candidate.discrete);
        let (tape, expansion) = (&contacts.decisions, &mut self.expansion);
        expansion.begin(mode, at, Some([&self.sizes, &self.rate_sizes]));
        // Where the coordinates change, those to come tell how a slip goes on.
        let mut charts = (mode.guards.iter().enumerate())
            .filter(|(_, guard)| guard.transitions.iter().any(|t| t.is_chart))
            .peekable();
        if charts.peek().is_some() {
            expansion.expand(mode, &mode.guard_values, 0);
            let value = |guard: usize| expansion.result(&mode.guard_values, guard)[0];
            if charts.any(|(guard, _)| value(guard).sign().is_none()) {
                return true;
            }
        }
        for k in 0..ORDERS {
            expansion.expand(mode, tape, k);
            let leaves = |&index: &usize| expansion.result(tape, index)[k].sign().is_some();
            if dropped.iter().any(leaves) {
                return false;
            }
            let mut own = (0..mode.free.len()).filter(|&i| !contacts.is_multiplier(i));
            let rests = |i: usize| {
                at.v[mode.free[i]] == 0.0
                    && expansion.acceleration(mode.free[i])[0].sign().is_none()
            };
            if k == 0 && own.all(rests) {
                break;
            }
        }
        true
    }
}

/// The state `next` of so many coordinates, with discrete states in place of its own.
pub(super) fn point<'a>(next: &'a [f64], coordinates: usize, discrete: &'a [f64]) -> Point<'a> {
    let (q, rest) = next.split_at(coordinates);
    let v = &rest[..coordinates];
    // With multipliers all coordinates are free.
    let (held, drift) = (q, &[][..]);
    Point {
        q,
        v,
        held,
        drift,
        discrete,
    }
}

/// What must be positive for a candidate to go on: results of the tape of decisions, each with its sign.
fn asked(
    contacts: &Contacts,
    candidate: &Candidate,
    touching: &[Option<Tangent>],
) -> Vec<(usize, f64)> {
    let mut asked = Vec::new();
    for (k, contact) in contacts.contacts.iter().enumerate() {
        let Some(tangent) = touching[k] else {
            continue;
        };
        let of = |what: usize| k * Contacts::DECISIONS + what;
        let state = candidate.states[k];
        if state == ContactState::Open {
            asked.push((of(GAP), 1.0));
            continue;
        }
        if contact.normal.is_some() {
            asked.push((of(PUSH), 1.0));
        }
        match state {
            ContactState::Sticks if !contact.is_dropped(&candidate.discrete) => {
                asked.extend([(of(FORWARDS), 1.0), (of(BACKWARDS), 1.0)]);
            }
            ContactState::Slides(direction) if tangent == Tangent::Still => {
                asked.push((of(SLIP), direction));
            }
            _ => {}
        }
    }
    asked
}

/// What each contact may do, of those that touch, with what their tangents do.
fn choices(contacts: &Contacts, touching: &[Option<Tangent>]) -> Vec<Vec<ContactState>> {
    let of = |(contact, tangent): (&Contact, &Option<Tangent>)| {
        let mut choices = match tangent {
            None => return vec![ContactState::Open],
            Some(Tangent::None) => vec![ContactState::Closed],
            Some(Tangent::Still) => {
                vec![
                    ContactState::Sticks,
                    ContactState::Slides(1.0),
                    ContactState::Slides(-1.0),
                ]
            }
            Some(Tangent::Slips(direction)) => vec![ContactState::Slides(*direction)],
        };
        if contact.normal.is_some() {
            choices.push(ContactState::Open);
        }
        choices
    };
    contacts.contacts.iter().zip(touching).map(of).collect()
}
