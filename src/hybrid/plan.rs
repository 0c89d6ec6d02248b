//! What of a variant a scene needs: the modes it may visit and the guards that can fire.

use super::failure::Reason;
use super::problem::Problem;
use crate::model::{Guard, Mode};

/// Modes and guards that are left after the scene's `freeze`.
#[derive(Debug)]
pub(super) struct Plan {
    /// Per mode: whether the scene may visit it.
    pub allowed: Vec<bool>,
    /// Per mode: indices of the guards that are watched.
    pub watched: Vec<Vec<usize>>,
}

impl Plan {
    pub fn new(problem: &Problem) -> Result<Self, Reason> {
        let modes = problem.variant.modes;
        let allowed: Vec<bool> = modes
            .iter()
            .map(|m| problem.freeze.iter().all(|frozen| !m.free.contains(frozen)))
            .collect();
        if !allowed.contains(&true) {
            let names = problem
                .freeze
                .iter()
                .map(|&i| problem.model.coordinates[i].name);
            let frozen = names.collect::<Vec<_>>().join(", ");
            return Err(Reason::NoModeLeft { frozen });
        }
        let can_fire = |g: &Guard| g.transitions.iter().any(|t| allowed[t.target]);
        let watched = modes
            .iter()
            .map(|m| {
                (0..m.guards.len())
                    .filter(|&g| can_fire(&m.guards[g]))
                    .collect()
            })
            .collect();
        Ok(Plan { allowed, watched })
    }

    /// The rest mode of `mode`, if the scene may visit it.
    pub fn rest(&self, mode: &Mode) -> Option<usize> {
        mode.rest.filter(|&r| self.allowed[r])
    }
}

/// Whether a guard's zero is an impact, whose accumulation has the mode's rest as its limit.
pub(super) fn is_impact(guard: &Guard) -> bool {
    guard.transitions.iter().any(|t| t.impact)
}
