//! Which frictions change where several reach their limits at one instant.
//!
//! A guard of the reduced form knows its own friction alone. Where inertia couples slips and static friction is above kinetic, what
//! slips relieves or loads the others at once: then all sets of what sticks and slides are judged, and *one* may go on, or *several* with
//! motions that differ. Contacts by multipliers are decided in the same way (`contact/judge.rs`, `contact/forced.rs`).

use super::departure::Departure;
use super::failure::{Reason, Stoppable};
use super::simulation::Simulation;
use crate::kernel::{Free, with_kernel};
use crate::model::TiedFriction;

/// What each friction does: none sticks, 0 slides forwards or as before, 1 backwards or the other way.
type Set = Vec<Option<usize>>;

/// A friction of a mode, by its index, and which of its changes.
type Change = (usize, usize);

/// A set, by what each friction changes to, if it does.
struct Candidate {
    changes: Vec<Option<usize>>,
    set: Set,
    mode: usize,
}

impl<'p> Simulation<'p> {
    /// What changes, one behind the other, where a guard has fallen and frictions of the mode are decided together; empty where it is
    /// decided alone.
    #[inline(always)]
    pub fn changes_of_frictions(&mut self, guard: usize) -> Stoppable<Vec<Change>> {
        match self.mode().frictions.is_empty() {
            true => Ok(Vec::new()),
            false => self.decide_frictions(guard),
        }
    }

    /// The guard and the transition of a change in the present mode.
    pub fn transition_of(&self, (friction, change): Change) -> (usize, usize) {
        let transition = self.mode().frictions[friction].changes[change];
        transition.expect("a change that was looked at")
    }

    #[cold]
    fn decide_frictions(&mut self, guard: usize) -> Stoppable<Vec<Change>> {
        self.set_context();
        let frictions = &*self.mode().frictions;
        let own = |friction: &TiedFriction| {
            let mut guards = friction.changes.iter().flatten();
            guards.any(|(of, _)| *of == guard)
        };
        let Some(first) = frictions.iter().position(own) else {
            return Ok(Vec::new());
        };
        let mut reached: Vec<bool> = (frictions.iter())
            .map(|friction| {
                let mut guards = friction.changes.iter().flatten().map(|(of, _)| *of);
                let may_be = |own: &mut Self, of| !(friction.sticks && own.is_clear(of));
                guards.any(|of| of == guard || may_be(self, of) && self.is_reached(of))
            })
            .collect();
        if !frictions[first].sticks {
            self.find_loaded(frictions, &mut reached);
        }
        if reached.iter().filter(|reached| **reached).count() < 2 {
            return Ok(Vec::new());
        }
        // What sticks below its limit may be made to slip by others.
        let decides: Vec<bool> = (frictions.iter().zip(&reached))
            .map(|(friction, reached)| *reached || friction.sticks)
            .collect();
        let Some(mut candidates) = self.admissible(frictions, &decides) else {
            // Where rounding errors are not known nothing tells a tie: the friction whose guard fell decides.
            return Ok(Vec::new());
        };
        // Between kinetic and static friction both are admissible: what may stick does.
        let yields = |a: &Set, b: &Set| {
            let same = |(a, b): (&Option<usize>, &Option<usize>)| a == b || b.is_none();
            a != b && a.iter().zip(b).all(same)
        };
        let sets: Vec<Set> = candidates.iter().map(|of| of.set.clone()).collect();
        candidates.retain(|a| !sets.iter().any(|b| yields(&a.set, b)));
        if candidates.len() > 1 {
            self.keep_forced_slips(frictions, &decides, &mut candidates);
        }
        if let [one, other, ..] = &*candidates {
            return Err(Box::new(Reason::SeveralMotions {
                contacts: (frictions.iter().zip(&reached))
                    .filter(|(_, reached)| **reached)
                    .map(|(friction, _)| friction.name)
                    .collect(),
                motions: [one, other].map(|of| self.modes[of.mode].name.to_owned()),
            }));
        }
        let order = (first..frictions.len()).chain(0..first);
        let decided = candidates.first();
        Ok(order
            .filter_map(|i| Some((i, decided?.changes[i]?)))
            .collect())
    }

    /// Adds what sticks and would not hold if all that stop stuck.
    fn find_loaded(&mut self, frictions: &'p [TiedFriction], reached: &mut [bool]) {
        let stops = |i: usize| !frictions[i].sticks && reached[i];
        let decides: Vec<bool> = (0..frictions.len()).map(stops).collect();
        let stick: Vec<Option<usize>> = decides.iter().map(|stops| stops.then_some(0)).collect();
        // Where they cannot stick, nothing of that sort happens.
        self.after((&stick, &decides), |own| {
            for i in (0..frictions.len()).filter(|&i| frictions[i].sticks) {
                reached[i] |= own.friction_goes_on(i) != Some(true);
            }
        });
    }

    /// The sets that may go on, where those that decide may change; `None` where it is not known of one.
    fn admissible(
        &mut self,
        frictions: &'p [TiedFriction],
        decides: &[bool],
    ) -> Option<Vec<Candidate>> {
        let may = |(friction, decides): (&TiedFriction, &bool)| {
            let changes = (0..2).filter(|c| *decides && friction.changes[*c].is_some());
            [None].into_iter().chain(changes.map(Some)).collect()
        };
        let may: Vec<Vec<_>> = frictions.iter().zip(decides).map(may).collect();
        let mut found = Vec::new();
        for number in 0..may.iter().map(Vec::len).product::<usize>() {
            let mut rest = number;
            let pick = |options: &Vec<Option<usize>>| {
                let option = options[rest % options.len()];
                rest /= options.len();
                option
            };
            let changes: Vec<Option<usize>> = may.iter().map(pick).collect();
            let goes_on = |own: &mut Self| Some((own.goes_on(decides)?, own.here.mode));
            // Of changes that cannot be there is no such set.
            let Some(judged) = self.after((&changes, decides), goes_on) else {
                continue;
            };
            let (goes_on, mode) = judged?;
            if goes_on {
                let set = set_of(frictions, &changes);
                found.push(Candidate { changes, set, mode });
            }
        }
        Some(found)
    }

    /// Leaves out sets in which a friction slips that nothing forces to, where others may go on.
    fn keep_forced_slips(
        &mut self,
        frictions: &'p [TiedFriction],
        decides: &[bool],
        candidates: &mut Vec<Candidate>,
    ) {
        let forced: Vec<bool> = (candidates.iter())
            .map(|candidate| {
                let begins = |i: &usize| decides[*i] && candidate.set[*i].is_some();
                let slips: Vec<usize> = (0..frictions.len()).filter(begins).collect();
                forces_all(slips.len(), |slipping, next| {
                    let mut changes = candidate.changes.clone();
                    for i in (0..slips.len()).filter(|i| !slipping[*i]) {
                        let friction = slips[i];
                        changes[friction] = (!frictions[friction].sticks).then_some(0);
                    }
                    let holds = |own: &mut Self| own.friction_goes_on(slips[next]);
                    self.after((&changes, decides), holds) != Some(Some(true))
                })
            })
            .collect();
        if forced.contains(&true) {
            let mut forced = forced.into_iter();
            candidates.retain(|_| forced.next() == Some(true));
        }
    }

    /// What is asked of the state after some changes; `None` where one of them cannot be. The present state stays.
    fn after<T>(
        &mut self,
        (changes, decides): (&[Option<usize>], &[bool]),
        ask: impl FnOnce(&mut Self) -> T,
    ) -> Option<T> {
        let (mode, discrete) = (self.here.mode, self.context.discrete().to_vec());
        let [q, v, a] = [&self.here.q, &self.here.v, &self.here.a].map(|x| x.clone());
        let answer = self.walk(changes, decides).then(|| ask(self));
        self.here.mode = mode;
        self.here.q.copy_from_slice(&q);
        self.here.v.copy_from_slice(&v);
        self.here.a.copy_from_slice(&a);
        self.context.discrete_mut().copy_from_slice(&discrete);
        self.set_context();
        self.set_drift();
        answer
    }

    /// Sets the rates of what drifts in the present mode.
    fn set_drift(&mut self) {
        if self.plan.moves[self.here.mode] {
            with_kernel!(&self.mode().kernels, k => self.set_drift_in(k));
        }
    }

    /// Goes to where some changes lead, one behind the other; false where one of them cannot be. What decides has no slip rate there.
    fn walk(&mut self, changes: &[Option<usize>], decides: &[bool]) -> bool {
        for (i, change) in changes.iter().enumerate() {
            let stops = decides[i] && !self.mode().frictions[i].sticks;
            let steps: &[usize] = match change {
                Some(0) => &[0],
                Some(_) => &[1],
                // Turned round twice it slides as before, from rest.
                None if stops => &[1, 1],
                None => &[],
            };
            if !steps.iter().all(|step| self.step_to(i, *step)) {
                return false;
            }
        }
        true
    }

    /// Goes to where a change of a friction leads, if it can be.
    fn step_to(&mut self, i: usize, change: usize) -> bool {
        let (mode, n) = (self.mode(), self.here.q.len());
        let there = mode.frictions.get(i).and_then(|of| of.changes[change]);
        let Some((guard, transition)) = there else {
            return false;
        };
        let transition = &mode.guards[guard].transitions[transition];
        if !self.plan.allowed[transition.target] {
            return false;
        }
        with_kernel!(&mode.kernels, k => {
            let [q, v, a] = self.here.free(k.size(), &mode.free);
            let at = Free { q: &q, v: &v, a: &a };
            k.reset(&self.context, &transition.kernel, at, &mut self.next);
        });
        self.here.q.copy_from_slice(&self.next[..n]);
        self.here.v.copy_from_slice(&self.next[n..2 * n]);
        let discrete = &self.next[2 * n..];
        self.context.discrete_mut().copy_from_slice(discrete);
        self.here.mode = transition.target;
        self.set_context();
        true
    }

    /// Whether the frictions of the present mode may do what they do: what sticks holds, and of those that decide what slides begins to
    /// slip in its direction. `None` where rounding errors are not known.
    fn goes_on(&mut self, decides: &[bool]) -> Option<bool> {
        let mode = self.mode();
        for (i, (friction, decides)) in mode.frictions.iter().zip(decides).enumerate() {
            if (friction.sticks || *decides) && !self.friction_goes_on(i)? {
                return Some(false);
            }
        }
        Some(true)
    }

    /// The same of one friction, which sticks or begins to slip.
    fn friction_goes_on(&mut self, i: usize) -> Option<bool> {
        self.set_drift();
        let friction = &self.mode().frictions[i];
        for (guard, _) in friction.changes.iter().flatten() {
            if friction.sticks && self.is_clear(*guard) {
                continue;
            }
            match (self.departure(*guard, 0, 0), friction.sticks) {
                (Departure::Unknown, _) => return None,
                (Departure::Down { .. }, _) | (Departure::Stays { .. }, false) => {
                    return Some(false);
                }
                (Departure::Up { .. } | Departure::Stays { .. }, _) => {}
            }
        }
        Some(true)
    }
}

/// What frictions do after some changes.
fn set_of(frictions: &[TiedFriction], changes: &[Option<usize>]) -> Set {
    let of = |(friction, change): (&TiedFriction, &Option<usize>)| match (friction.sticks, change) {
        (true, change) => *change,
        (false, None) => Some(0),
        (false, Some(0)) => None,
        (false, Some(_)) => Some(1),
    };
    frictions.iter().zip(changes).map(of).collect()
}

/// Whether all of so many may be made to slip one by one, or those at once that are: `slips(slipping, next)` says whether one that does
/// not slip yet is made to by those that do.
pub(super) fn forces_all(count: usize, mut slips: impl FnMut(&[bool], usize) -> bool) -> bool {
    let mut seen: Vec<Vec<bool>> = Vec::new();
    let mut pending = vec![vec![false; count]];
    while let Some(slipping) = pending.pop() {
        if slipping.iter().all(|slips| *slips) {
            return true;
        }
        if seen.contains(&slipping) {
            continue;
        }
        let open = (0..count).filter(|i| !slipping[*i]);
        let made: Vec<usize> = open.filter(|&i| slips(&slipping, i)).collect();
        let with = |more: &[usize]| {
            let mut slipping = slipping.clone();
            more.iter().for_each(|&i| slipping[i] = true);
            slipping
        };
        pending.extend(made.chunks(1).map(with));
        if made.len() > 1 {
            pending.push(with(&made));
        }
        seen.push(slipping);
    }
    false
}
