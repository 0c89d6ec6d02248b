//! How often transitions happened, and what impacts did to the energy: kept while a run goes on.

use super::result::Jump;

/// Counts of transitions and sums of impacts, in bounded memory.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tally {
    /// By transition, in the order in which they first happened.
    counted: Vec<Counted>,
    /// The first impacts that gained energy, at most [`Gain::MOST`]; by transition all are counted.
    pub gains: Vec<Gain>,
}

/// What is counted of a transition.
#[derive(Debug, Clone, PartialEq)]
pub struct Counted {
    /// Its name.
    pub transition: &'static str,
    /// How often it happened.
    pub count: usize,
    /// What it did to the energy where it was an impact.
    pub impacts: Option<Impacts>,
}

/// What the impacts of one kind did to the energy.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
pub struct Impacts {
    /// Number of impacts.
    pub count: usize,
    /// Energy lost in all, in the frame of what is struck (J).
    pub lost: f64,
    /// Number of impacts that gained energy.
    pub gaining: usize,
    /// Smallest loss of one impact (J); negative where an impact gained energy.
    pub smallest_loss: f64,
    /// Largest loss of one impact (J).
    pub largest_loss: f64,
    /// Work of the ground's impulses, in the inertial frame (J).
    pub ground_work: f64,
}

/// An impact that gains energy: no mechanism explains it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Gain {
    /// Time (s).
    pub t: f64,
    /// Number of transitions up to and including this one.
    pub j: u64,
    /// Name of the transition.
    pub transition: String,
    /// Energy gained, in the frame of what is struck (J).
    pub energy: f64,
}

impl Gain {
    /// Most gains that are listed: a law that makes energy may do so at each of a million impacts.
    pub const MOST: usize = 100;
}

impl Tally {
    /// The tally of some transitions.
    pub fn of(jumps: impl IntoIterator<Item = Jump>) -> Tally {
        let mut tally = Tally::default();
        jumps.into_iter().for_each(|jump| tally.note(&jump));
        tally
    }

    /// Counts a transition.
    pub fn note(&mut self, jump: &Jump) {
        let known = self.counted.iter();
        let place = known
            .take_while(|c| c.transition != jump.transition)
            .count();
        if place == self.counted.len() {
            self.counted.push(Counted {
                transition: jump.transition,
                count: 0,
                impacts: None,
            });
        }
        let counted = &mut self.counted[place];
        counted.count += 1;
        let Some(energy) = jump.energy else { return };
        let impacts = counted.impacts.get_or_insert(Impacts {
            smallest_loss: f64::INFINITY,
            largest_loss: f64::NEG_INFINITY,
            ..Impacts::default()
        });
        impacts.count += 1;
        impacts.lost += energy.lost;
        impacts.gaining += usize::from(energy.lost < 0.0);
        impacts.smallest_loss = impacts.smallest_loss.min(energy.lost);
        impacts.largest_loss = impacts.largest_loss.max(energy.lost);
        impacts.ground_work += energy.ground_work;
        if energy.lost < 0.0 && self.gains.len() < Gain::MOST {
            self.gains.push(Gain {
                t: jump.t,
                j: jump.j,
                transition: jump.transition.into(),
                energy: -energy.lost,
            });
        }
    }

    /// What is counted, in the order in which the transitions first happened.
    pub fn counted(&self) -> &[Counted] {
        &self.counted
    }

    /// How often a transition happened.
    pub fn count(&self, transition: &str) -> usize {
        let found = self.counted.iter().find(|c| c.transition == transition);
        found.map_or(0, |c| c.count)
    }

    /// Number of all transitions.
    pub fn total(&self) -> usize {
        self.counted.iter().map(|c| c.count).sum()
    }

    /// Number of all impacts that gained energy.
    pub fn gaining(&self) -> usize {
        let impacts = self.counted.iter().filter_map(|c| c.impacts.as_ref());
        impacts.map(|impacts| impacts.gaining).sum()
    }
}
