//! What of a variant a scene needs: the modes it may visit and the guards that can fire.

use super::failure::Reason;
use super::problem::Problem;
use crate::model::{Contacts, Guard, Rest};

/// Modes and guards that are left after the scene's `freeze`.
#[derive(Debug)]
pub(super) struct Plan {
    /// Per mode: whether the scene may visit it.
    pub allowed: Vec<bool>,
    /// Per mode: whether something that it holds moves.
    pub moves: Vec<bool>,
    /// Per mode: what is watched.
    pub watched: Vec<Vec<Watched>>,
    /// The rests that the scene may visit, in the order of the file.
    pub rests: Vec<Rest>,
}

/// A smooth scalar that is watched for falling through zero.
///
/// A guard all of whose transitions are conditional acts only while a condition holds. Guard and
/// conditions are then watched one by one, since together they are not smooth; what counts is
/// whether the guard is violated and a condition holds where one of them changes its sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Watched {
    /// Index of the guard in its mode.
    pub guard: usize,
    /// A condition, `(transition, component)`, whose negative is watched instead of the guard.
    pub condition: Option<(usize, usize)>,
    /// Whether all transitions that the guard may trigger are conditional, so that guard and conditions are watched
    /// together.
    pub conditional: bool,
}

impl Plan {
    pub fn new(problem: &Problem) -> Result<Self, Reason> {
        let modes = &problem.automaton().modes;
        let allowed: Vec<bool> = modes
            .iter()
            .map(|m| problem.freeze.iter().all(|&frozen| m.freezes(frozen)))
            .collect();
        if !allowed.contains(&true) {
            let names = problem
                .freeze
                .iter()
                .map(|&i| problem.model.coordinates[i].name);
            return Err(Reason::NoModeLeft {
                frozen: names.collect(),
            });
        }
        let of_contact = |guard| Watched {
            guard,
            condition: None,
            conditional: false,
        };
        let watched = (modes.iter())
            .map(|m| {
                let contacts = m.contacts.as_ref().map_or(0, |c| c.contacts.len());
                let of_contacts = 0..Contacts::GUARDS * contacts;
                let by_hand = of_contacts.end..m.guards.len();
                let by_hand = by_hand.flat_map(|g| watched(g, &m.guards[g], &allowed));
                of_contacts.map(of_contact).chain(by_hand).collect()
            })
            .collect();
        let rests = (problem.variant().rests.iter().copied())
            .filter(|rest| allowed[rest.target])
            .collect();
        Ok(Plan {
            rests,
            allowed,
            moves: (modes.iter())
                .map(|m| (0..m.drifts.len()).any(|i| m.moves(i)))
                .collect(),
            watched,
        })
    }

    /// Whether accumulations with events that lead to a mode, by its index, may come to rest.
    #[inline]
    pub fn rests(&self, mode: usize) -> bool {
        self.rests.iter().any(|rest| rest.source == mode)
    }
}

/// What to watch of a guard, in view of the modes that may be visited; nothing if it cannot fire.
fn watched(guard: usize, model: &Guard, allowed: &[bool]) -> Vec<Watched> {
    let transitions = || (model.transitions.iter().enumerate()).filter(|(_, t)| allowed[t.target]);
    if transitions().next().is_none() {
        return Vec::new();
    }
    let conditional = transitions().all(|(_, t)| t.conditional);
    let mut all = vec![Watched {
        guard,
        condition: None,
        conditional,
    }];
    if conditional {
        all.extend(transitions().flat_map(|(t, transition)| {
            let components = 0..transition.kernel.conditions();
            components.map(move |c| Watched {
                guard,
                condition: Some((t, c)),
                conditional,
            })
        }));
    }
    all
}

/// Whether a guard's zero is an impact.
pub(super) fn is_impact(guard: &Guard) -> bool {
    guard.transitions.iter().any(|t| t.impact)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::models;

    /// Names of the modes that a tank may visit, each with its guards that are watched.
    fn plan(freeze: &[&str]) -> Vec<(&'static str, Vec<&'static str>)> {
        let model = models().find("walking_tank").unwrap();
        let mut problem = Problem::new(&model);
        problem.freeze = freeze
            .iter()
            .map(|c| model.coordinate(c).unwrap())
            .collect();
        let plan = Plan::new(&problem).unwrap();
        let modes = problem.variant().modes.iter().zip(&plan.watched);
        let visited = modes.zip(&plan.allowed).filter(|(_, allowed)| **allowed);
        visited
            .map(|((mode, watched), _)| {
                let transitions = watched
                    .iter()
                    .map(|w| mode.guards[w.guard].transitions[0].name);
                (mode.name, transitions.collect())
            })
            .collect()
    }

    #[test]
    fn a_frozen_coordinate_leaves_out_modes_and_the_guards_that_lead_there() {
        let all = plan(&[]);
        assert_eq!(all.len(), 4);
        assert_eq!(
            all[0],
            (
                "stands_sticks",
                vec!["slip", "slip", "lift_off", "lift_off"]
            )
        );
        let bonded = [
            ("stands_sticks", vec!["lift_off", "lift_off"]),
            ("rocks_sticks", vec!["landing"]),
        ];
        assert_eq!(plan(&["x"]), bonded);
        assert_eq!(plan(&["x", "theta"]), [("stands_sticks", vec![])]);
        let sliding = plan(&["theta"]);
        assert_eq!(sliding[0], ("stands_sticks", vec!["slip", "slip"]));
        assert_eq!(sliding[1].0, "stands_slides");
    }
}
