//! Which sets of contact states may follow: all of those that touch are tried (of many those that a pivoting method finds), each
//! on the motion that it leads to.
//!
//! A set may go on where what pushes does not pull, what opens does not close, what sticks does not slip and what begins to
//! slip does so in its direction: on the first derivative that rounding does not hide (`departure.rs`). Motions that are equal
//! count once, whatever the names of their sets.

use super::geometry::{Geometry, Line, write_states};
use super::hold::{Places, held_lines};
use super::many::{Answer, Asked, Friction, all_of_many, answers, to_try};
use super::{State, Tangent};
use crate::hybrid::failure::Reason;
use crate::hybrid::simulation::Simulation;
use crate::jets::{ORDERS, Point};
use crate::model::{Contact, Contacts, Mode, Row};
use crate::numerics::Unsolved;

/// Which of the results of the tape of decisions.
const PUSH: usize = 0;
const GAP: usize = 1;
const FORWARDS: usize = 2;
const BACKWARDS: usize = 3;
const SLIP: usize = 4;

/// A set of contact states that may follow.
#[derive(Debug)]
struct Candidate {
    states: Vec<State>,
    discrete: Vec<f64>,
}

/// A candidate that may go on, with the motion that it leads to.
struct Admitted {
    candidate: Candidate,
    motion: Motion,
}

/// How a candidate goes on.
struct Motion {
    /// Coefficients of the accelerations of the coordinates that are no multipliers.
    accelerations: Vec<Row>,
    /// Of each result of the tape of decisions that had to be positive and is zero, which derivative decided, if any did.
    orders: Vec<(usize, usize)>,
}

/// What was found.
pub(super) struct Decision {
    pub states: Vec<State>,
    pub discrete: Vec<f64>,
    orders: Vec<(usize, usize)>,
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
        let of = self.orders.iter().find(|(known, _)| *known == index);
        of.map_or(0, |(_, order)| *order)
    }
}

impl<'p> Simulation<'p> {
    /// The set that follows where the contacts that are given touch without a rate, with what their tangents do; all others are
    /// open. The state is that of `next`.
    pub(super) fn decide(
        &mut self,
        (contacts, geometry): (&'p Contacts, &Geometry),
        places: &Places,
        touching: &[Option<Tangent>],
    ) -> Result<Decision, Reason> {
        self.expand_signals();
        let choices = choices(contacts, touching);
        let holds = |k: usize, state: &State| {
            let has_gap = contacts.contacts[k].normal.is_some();
            (has_gap && state.is_closed()).then_some(Line::Normal(k))
        };
        let sets = to_try(&choices, geometry, holds, || {
            self.answers((contacts, geometry), places, touching)
        });
        let mut judge = |states: Vec<State>| {
            let candidate = self.candidate((contacts, geometry), states)?;
            let motion = self.admit(contacts, geometry, &candidate, touching)?;
            Some(Admitted { candidate, motion })
        };
        let mut admitted: Vec<Admitted> = sets.into_iter().filter_map(&mut judge).collect();
        if admitted.is_empty() {
            admitted.extend(all_of_many(&choices).filter_map(&mut judge));
        }
        // Between kinetic and static friction both are admissible: what sticks goes on sticking.
        let yields = |a: &Admitted, b: &Admitted| {
            let pairs = || a.candidate.states.iter().zip(&b.candidate.states);
            let sticks = |(k, (a, b)): (usize, (&State, &State))| {
                let could = matches!((a, b), (State::Slides(_), State::Sticks));
                a == b || could && places.static_friction(k) > places.kinetic(k)
            };
            pairs().any(|(a, b)| a != b) && pairs().enumerate().all(sticks)
        };
        let stays: Vec<bool> = (admitted.iter())
            .map(|a| !admitted.iter().any(|b| yields(a, b)))
            .collect();
        let mut stays = stays.into_iter();
        admitted.retain(|_| stays.next() == Some(true));
        // Of equal motions that which holds the most, and of these that whose contacts are the farthest apart: of feet on a line the
        // outer two, whatever their order.
        let spans = |a: &Admitted| {
            let [places, _] = held_lines(contacts, &a.candidate.states);
            geometry.volume(&places)
        };
        admitted.sort_by(|a, b| {
            let [of_a, of_b] = [a, b].map(|of| of.candidate.holds());
            of_b.cmp(&of_a).then_with(|| spans(b).total_cmp(&spans(a)))
        });
        let names = |states: &[State]| {
            let mut discrete = self.context.discrete().to_vec();
            write_states(contacts, states, &mut discrete);
            contacts.name(contacts.set(&discrete))
        };
        let touch = || {
            let all = (touching.iter().zip(&contacts.contacts)).filter(|(t, _)| t.is_some());
            all.map(|(_, c)| c.name).collect::<Vec<_>>().join(", ")
        };
        let Some(first) = admitted.first() else {
            return Err(Reason::NoMotion { contacts: touch() });
        };
        let differs = |other: &&Admitted| {
            !are_equal(&first.motion.accelerations, &other.motion.accelerations)
        };
        if let Some(other) = admitted.iter().find(differs) {
            let motions = [first, other].map(|a| names(&a.candidate.states));
            return Err(Reason::SeveralMotions {
                contacts: touch(),
                motions: format!("`{}` and `{}`", motions[0], motions[1]),
            });
        }
        let Admitted { candidate, motion } = admitted.swap_remove(0);
        Ok(Decision {
            states: candidate.states,
            discrete: candidate.discrete,
            orders: motion.orders,
        })
    }

    /// What a pivoting method says that contacts do, on their accelerations.
    fn answers(
        &mut self,
        (contacts, geometry): (&'p Contacts, &Geometry),
        places: &Places,
        touching: &[Option<Tangent>],
    ) -> Result<Vec<(Option<State>, bool)>, Unsolved> {
        let without_forces: Vec<State> = (contacts.contacts.iter().zip(touching))
            .map(|(contact, tangent)| match (contact.normal, tangent) {
                (Some(_), _) => State::Open,
                (None, Some(Tangent::Slips(direction))) => State::Slides(*direction),
                (None, _) => State::Slides(1.0),
            })
            .collect();
        let mut discrete = self.context.discrete().to_vec();
        write_states(contacts, &without_forces, &mut discrete);
        let mode = self.mode();
        let n = self.here.q.len();
        let (q, rest) = self.next.split_at(n);
        let (v, discrete) = (&rest[..n], &*discrete);
        let at = Point { q, v, discrete };
        let tape = &contacts.decisions;
        self.expansion.begin(mode, at, None);
        self.expansion.expand(mode, tape, 0);
        let value = |k: usize, what: usize| {
            self.expansion.result(tape, k * Contacts::DECISIONS + what)[0].value
        };
        // Friction without a gap acts there already, as what slides forwards; it is taken out again.
        let bare = |k: usize| contacts.contacts[k].normal.is_none();
        let frictions: Vec<(Line, f64)> = (0..touching.len())
            .filter(|&k| bare(k) && touching[k] == Some(Tangent::Still))
            .map(|k| {
                let force = 0.5 * (value(k, BACKWARDS) - value(k, FORWARDS));
                (Line::Tangent(k), force)
            })
            .collect();
        let constraints: Vec<Line> = (0..contacts.constraints.len())
            .map(Line::Constraint)
            .collect();
        let lines: Vec<Line> = geometry.all().collect();
        let compliance = geometry.compliance(&lines, &constraints);
        let taken_out = |of: Line| -> f64 {
            let place = |line: Line| lines.iter().position(|known| *known == line);
            let at = |of: Line, line: Line| Some(place(of)? * lines.len() + place(line)?);
            let parts = frictions.iter();
            parts
                .filter_map(|&(line, force)| Some(compliance[at(of, line)?] * force))
                .sum()
        };
        // Static friction, until one is seen to slip.
        let mut slips = vec![false; touching.len()];
        loop {
            let mut asked = Vec::new();
            for (k, contact) in contacts.contacts.iter().enumerate() {
                let Some(tangent) = touching[k] else { continue };
                let coefficient = match slips[k] {
                    true => places.kinetic(k),
                    false => places.static_friction(k),
                };
                let friction = match tangent {
                    Tangent::None => Friction::None,
                    Tangent::Slips(direction) => Friction::Slips {
                        direction,
                        coefficient: places.kinetic(k),
                    },
                    Tangent::Still => {
                        let limit = 0.5 * (value(k, FORWARDS) + value(k, BACKWARDS));
                        let part = match coefficient == places.static_friction(k) {
                            true => 1.0,
                            false => coefficient / places.static_friction(k),
                        };
                        Friction::Still {
                            slip: value(k, SLIP) - taken_out(Line::Tangent(k)),
                            coefficient,
                            bound: if bare(k) { limit * part } else { 0.0 },
                        }
                    }
                };
                if bare(k) && tangent != Tangent::Still {
                    continue;
                }
                let normal = value(k, GAP) - taken_out(Line::Normal(k));
                asked.push(Asked {
                    contact: k,
                    normal: contact.normal.map(|_| [normal, 0.0]),
                    friction,
                });
            }
            let answers = answers(contacts, geometry, &asked)?;
            let mut goes_on = false;
            let mut found: Vec<(Option<State>, bool)> = vec![(None, false); touching.len()];
            for (asked, (answer, open)) in asked.iter().zip(answers) {
                let k = asked.contact;
                let state = match (answer, touching[k]) {
                    (Answer::Opens, _) => State::Open,
                    (_, Some(Tangent::Slips(direction))) => State::Slides(direction),
                    (_, Some(Tangent::None)) => State::Closed,
                    (Answer::Slips(direction), _) => State::Slides(direction),
                    (Answer::Holds, _) => State::Sticks,
                };
                let starts = matches!(answer, Answer::Slips(_));
                goes_on |= starts && !slips[k] && places.kinetic(k) != places.static_friction(k);
                slips[k] |= starts;
                found[k] = (Some(state), open);
            }
            if !goes_on {
                return Ok(found);
            }
        }
    }

    /// The discrete states of a set; `None` if its lines depend on each other in a way that leaves its forces undetermined.
    fn candidate(
        &self,
        (contacts, geometry): (&Contacts, &Geometry),
        states: Vec<State>,
    ) -> Option<Candidate> {
        let mut discrete = self.context.discrete().to_vec();
        write_states(contacts, &states, &mut discrete);
        let [places, _] = held_lines(contacts, &states);
        if geometry.independent(&places).len() < places.len() {
            return None;
        }
        let mut held = places;
        for k in (0..states.len()).filter(|&k| states[k] == State::Sticks) {
            let line = Line::Tangent(k);
            if !geometry.depends(line, &held) {
                held.push(line);
                continue;
            }
            let holds = |&other: &usize| {
                held.contains(&Line::Tangent(other))
                    && geometry.are_parallel(line, Line::Tangent(other))
            };
            discrete[contacts.contacts[k].dropped?] = 1.0;
            // Its friction is part of that of another one along the same line; beside several lines that hold it together its
            // own force is not determined, and is none (a disc that rests in a wedge).
            if let Some(holder) = (0..k).find(holds) {
                discrete[contacts.contacts[holder].joined[k]?] = 1.0;
            }
        }
        Some(Candidate { states, discrete })
    }

    /// The motion of a candidate, if it may go on.
    fn admit(
        &mut self,
        contacts: &'p Contacts,
        geometry: &Geometry,
        candidate: &Candidate,
        touching: &[Option<Tangent>],
    ) -> Option<Motion> {
        let mode: &Mode = self.mode();
        let asked = asked(contacts, candidate, touching);
        let n = self.here.q.len();
        let (q, rest) = self.next.split_at(n);
        let at = Point {
            q,
            v: &rest[..n],
            discrete: &candidate.discrete,
        };
        let tape = &contacts.decisions;
        let expansion = &mut self.expansion;
        expansion.begin(mode, at, Some([&self.sizes, &self.rate_sizes]));
        expansion.expand(mode, tape, 0);
        let mut open = Vec::new();
        let mut orders = Vec::new();
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
        expansion.begin(mode, at, None);
        for k in 0..ORDERS {
            expansion.expand(mode, tape, k);
            if k == 0 {
                continue;
            }
            let mut falls = false;
            open.retain(
                |&(index, sign)| match expansion.result(tape, index)[k].sign() {
                    Some(positive) => {
                        falls |= positive != (sign > 0.0);
                        orders.push((index, k));
                        false
                    }
                    None => true,
                },
            );
            if falls {
                return None;
            }
        }
        let own = geometry.own.iter();
        Some(Motion {
            accelerations: own.map(|&i| *expansion.acceleration(i)).collect(),
            orders,
        })
    }
}

impl Candidate {
    /// How much it holds: contacts that are closed, then those that stick.
    fn holds(&self) -> (usize, usize) {
        let closed = self.states.iter().filter(|s| s.is_closed()).count();
        let sticks = self.states.iter().filter(|s| **s == State::Sticks).count();
        (closed, sticks)
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
        if state == State::Open {
            asked.push((of(GAP), 1.0));
            continue;
        }
        if contact.normal.is_some() {
            asked.push((of(PUSH), 1.0));
        }
        let is_dropped = contact
            .dropped
            .is_some_and(|i| candidate.discrete[i] != 0.0);
        match state {
            State::Sticks if !is_dropped => {
                asked.extend([(of(FORWARDS), 1.0), (of(BACKWARDS), 1.0)]);
            }
            State::Slides(direction) if tangent == Tangent::Still => {
                asked.push((of(SLIP), direction));
            }
            _ => {}
        }
    }
    asked
}

/// What each contact may do, of those that touch, with what their tangents do.
fn choices(contacts: &Contacts, touching: &[Option<Tangent>]) -> Vec<Vec<State>> {
    let of = |(contact, tangent): (&Contact, &Option<Tangent>)| {
        let mut choices = match tangent {
            None => return vec![State::Open],
            Some(Tangent::None) => vec![State::Closed],
            Some(Tangent::Still) => {
                vec![State::Sticks, State::Slides(1.0), State::Slides(-1.0)]
            }
            Some(Tangent::Slips(direction)) => vec![State::Slides(*direction)],
        };
        if contact.normal.is_some() {
            choices.push(State::Open);
        }
        choices
    };
    contacts.contacts.iter().zip(touching).map(of).collect()
}

/// Whether two motions are equal, as far as rounding tells.
fn are_equal(one: &[Row], other: &[Row]) -> bool {
    one.iter().zip(other).all(|(a, b)| {
        let is_same = |k: usize| {
            let error = a[k].error + b[k].error;
            let differ = (a[k].value - b[k].value).abs() > error;
            !differ
        };
        (0..ORDERS).all(is_same)
    })
}
