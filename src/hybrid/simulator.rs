//! A simulation that is prepared once and run as often as wanted.

use super::failure::Reason;
use super::problem::Problem;
use super::simulation::Simulation;
use crate::record::{Jump, Progress, Reached, Solver};

/// A problem made ready to run: tables, room and the initial mode. Runs after the first allocate
/// nothing, as long as the record does not grow.
///
/// What it gives is what [`super::simulate`] gives, without the trajectory, the extremes and the names of
/// a [`crate::record::Run`].
pub struct Simulator<'p> {
    simulation: Simulation<'p>,
    initial_mode: usize,
}

impl<'p> Simulator<'p> {
    /// Prepares a problem.
    ///
    /// # Errors
    /// As [`super::simulate`].
    pub fn new(problem: &'p Problem) -> Result<Self, Reason> {
        let mut simulation = Simulation::new(problem)?;
        simulation.observers.leave_out_extremes();
        simulation.begin()?;
        let initial_mode = simulation.here.mode;
        Ok(Simulator {
            simulation,
            initial_mode,
        })
    }

    /// Runs from the start to the end.
    ///
    /// # Errors
    /// [`Reason`] why it stopped before its end; state and events are those up to there.
    pub fn run(&mut self, progress: &mut dyn Progress) -> Result<(), Reason> {
        self.simulation.rewind(self.initial_mode);
        self.simulation.run(progress)
    }

    /// Time reached, s.
    pub fn time(&self) -> f64 {
        self.simulation.here.now.seconds()
    }

    /// Index of the present mode in the variant of the problem.
    pub fn mode(&self) -> usize {
        self.simulation.here.mode
    }

    /// All coordinates.
    pub fn q(&self) -> &[f64] {
        &self.simulation.here.q
    }

    /// All velocities.
    pub fn v(&self) -> &[f64] {
        &self.simulation.here.v
    }

    /// All discrete states.
    pub fn discrete(&self) -> &[f64] {
        self.simulation.context.discrete()
    }

    /// The transitions so far.
    pub fn events(&self) -> &[Jump] {
        self.simulation.observers.recording.jumps()
    }

    /// Limit states that were reached, and conditions on the motion under which the model is meant that were left.
    pub fn reached(&self) -> Reached {
        self.simulation.margins.reached()
    }

    /// Work done by the integrator; the method is not named.
    pub fn solver(&self) -> &Solver {
        &self.simulation.solver
    }
}
