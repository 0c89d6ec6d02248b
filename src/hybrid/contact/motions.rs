//! Of the sets that may go on, that whose motion follows: one, none or several.

use super::ContactState;
use super::geometry::{Geometry, write_states};
use super::hold::held_lines;
use super::judge::{Admitted, Candidate, Case, point};
use crate::hybrid::failure::Reason;
use crate::hybrid::simulation::Simulation;
use crate::jets::ORDERS;
use crate::model::Powers;

impl<'p> Simulation<'p> {
    /// The set whose motion follows, of those that may go on. Of equal motions it is that which holds the most, and of these that whose
    /// contacts are the farthest apart: of feet on a line the outer two, whatever their order.
    pub(super) fn one_motion(
        &mut self,
        case: &Case<'p, '_>,
        mut admitted: Vec<Admitted>,
    ) -> Result<Admitted, Reason> {
        keep_what_holds(case, &mut admitted);
        if admitted.len() > 1 {
            let of = (case.contacts, case.geometry);
            self.keep_what_is_forced(of, case.places, case.touching, &mut admitted);
        }
        let spans = |a: &Admitted| {
            let [places, _] = held_lines(case.contacts, &a.candidate.states);
            case.geometry.volume(&places)
        };
        admitted.sort_by(|a, b| {
            let [of_a, of_b] = [a, b].map(|of| of.candidate.holds());
            of_b.cmp(&of_a).then_with(|| spans(b).total_cmp(&spans(a)))
        });
        let mut other = self.another(case, &admitted);
        if other.is_some() {
            // A force that is as small as the state's rounding makes it may be zero within its bound, so that what pulls is closed, beside a
            // gap that is seen to open (a block on another, which both spin in free flight). Then the state is taken as it is.
            let states = admitted.iter().map(|a| a.candidate.states.clone());
            let exact: Vec<Admitted> = states
                .filter_map(|states| self.judge(case, states, (None, true)))
                .collect();
            if !exact.is_empty() {
                admitted = exact;
                other = self.another(case, &admitted);
            }
        }
        if other.is_some() && admitted.iter().any(|a| a.orders.are_known) {
            // What no derivative tells from zero gives way to what is told.
            admitted.retain(|a| a.orders.are_known);
            other = self.another(case, &admitted);
        }
        let touch = || -> Vec<&'static str> {
            let all = case.touching.iter().zip(&case.contacts.contacts);
            all.filter(|(t, _)| t.is_some())
                .map(|(_, c)| c.name)
                .collect()
        };
        if admitted.is_empty() {
            return Err(Reason::NoMotion { contacts: touch() });
        }
        if let Some(other) = other {
            let name = |a: &Admitted| {
                let mut discrete = self.context.discrete().to_vec();
                write_states(case.contacts, &a.candidate.states, &mut discrete);
                case.contacts.sets().name(case.contacts.set(&discrete))
            };
            return Err(Reason::SeveralMotions {
                contacts: touch(),
                motions: [&admitted[0], &admitted[other]].map(name),
            });
        }
        Ok(admitted.swap_remove(0))
    }

    /// One whose motion differs from that of the first, where the state is exact, and where it is known to its rounding.
    fn another(&mut self, case: &Case<'p, '_>, admitted: &[Admitted]) -> Option<usize> {
        (1..admitted.len()).find(|&other| {
            [true, false].into_iter().all(|is_exact| {
                let [one, two] = [0, other]
                    .map(|i| self.accelerations(case.geometry, &admitted[i].candidate, is_exact));
                !are_equal(&one, &two)
            })
        })
    }

    /// Coefficients of the accelerations of a candidate, of the coordinates that are no multipliers: from the state that is
    /// given, or from one that is known to its rounding.
    fn accelerations(
        &mut self,
        geometry: &Geometry,
        candidate: &Candidate,
        is_exact: bool,
    ) -> Vec<Powers> {
        let mode = self.mode();
        let contacts = mode.contacts.as_ref().expect("a mode of all sets");
        let at = point(&self.next, self.here.q.len(), &candidate.discrete);
        let sizes = [&*self.sizes, &*self.rate_sizes];
        let sizes = (!is_exact).then_some(sizes);
        self.expansion.begin(mode, at, sizes);
        for order in 0..ORDERS {
            self.expansion.expand(mode, &contacts.decisions, order);
        }
        let own = geometry.own.iter();
        own.map(|&i| *self.expansion.acceleration(i)).collect()
    }
}

/// Leaves out what yields: between kinetic and static friction both are admissible, and what sticks goes on sticking, and what it held
/// stays closed.
fn keep_what_holds(case: &Case, admitted: &mut Vec<Admitted>) {
    let yields = |a: &Admitted, b: &Admitted| {
        let pairs = || (a.candidate.states.iter().zip(&b.candidate.states)).enumerate();
        let sticks = |a: &ContactState, b: &ContactState| {
            matches!((a, b), (ContactState::Slides(_), ContactState::Sticks))
        };
        let could = |(k, (a, b)): (usize, (&ContactState, &ContactState))| {
            sticks(a, b) && case.places.static_friction(k) > case.places.kinetic(k)
        };
        let opens = |a: &ContactState, b: &ContactState| a.is_closed() != b.is_closed();
        let differ = |(_, (a, b))| a == b || opens(a, b) || sticks(a, b);
        pairs().any(could) && pairs().all(differ)
    };
    let stays: Vec<bool> = (admitted.iter())
        .map(|a| !admitted.iter().any(|b| yields(a, b)))
        .collect();
    let mut stays = stays.into_iter();
    admitted.retain(|_| stays.next() == Some(true));
}

impl Candidate {
    /// How much it holds: contacts that are closed, then those that stick.
    fn holds(&self) -> (usize, usize) {
        let closed = self.states.iter().filter(|s| s.is_closed()).count();
        let sticks = self
            .states
            .iter()
            .filter(|s| **s == ContactState::Sticks)
            .count();
        (closed, sticks)
    }
}

/// Whether two motions are equal, as far as rounding tells.
fn are_equal(one: &[Powers], other: &[Powers]) -> bool {
    one.iter().zip(other).all(|(a, b)| {
        let is_same = |k: usize| {
            let error = a[k].error + b[k].error;
            let differ = (a[k].value - b[k].value).abs() > error;
            !differ
        };
        (0..ORDERS).all(is_same)
    })
}
