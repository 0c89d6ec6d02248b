//! A simulation that is prepared once, and run as often as wanted, as a whole or in parts.

use super::advance::{Stage, Stopped};
use super::checkpoint::{Checkpoint, Misfit};
use super::failure::Reason;
use super::moment::{Moment, NotComputed, View};
use super::observe::Observer;
use super::problem::Problem;
use super::simulation::Simulation;
use super::validate::{Invalid, Unknown};
use crate::input::Command;
use crate::run::{Jump, Progress, Reached, Silent, Solver};

/// A problem made ready to run, as a whole or in parts: tables, room and the initial mode. Runs after the first allocate
/// nothing, as long as the record does not grow.
///
/// What it gives is what [`super::simulate`] gives, without the trajectory, the extremes and the names of
/// a [`crate::hybrid::Run`].
///
/// # In parts
/// [`Simulator::advance_to`] and [`Simulator::advance_to_event`] go on from where the run is, and
/// [`Simulator::command`] changes an input there. Where no input is commanded the result does not depend, to the last
/// bit, on where the run was stopped on its way: steps are those of a run as a whole, and the state at a time within one is that of its
/// dense output.
///
/// ```
/// use dalembert::hybrid::{Problem, Simulator, Stopped};
/// use dalembert::input::{Command, Function};
/// use dalembert::model::models;
///
/// // A mass on a spring, with friction, that a controller pushes back to the middle every 10 ms.
/// let model = models().find("coulomb_oscillator").expect("a model of the toolkit");
/// let mut problem = Problem::new(&model);
/// problem.set_input("force", Function::commanded(0.0))?;
/// problem.set_initial("x.rate", 1.0)?;
/// problem.end.time = 2.0;
/// let mut simulator = Simulator::new(&problem)?;
/// for tick in 0..100 {
///     let now = simulator.moment();
///     let force = -2.0 * now.state("x").unwrap() - 5.0 * now.state("x.rate").unwrap();
///     simulator.command("force", Command::Hold(force))?;
///     simulator.advance_to(0.01 * f64::from(tick + 1))?;
/// }
/// // To the next transition, if there is one before the time.
/// match simulator.advance_to_event(2.0)? {
///     Stopped::Event => println!("{} at {} s", simulator.moment().mode(), simulator.time()),
///     stopped => println!("{stopped:?}"),
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Simulator<'p> {
    simulation: Simulation<'p>,
    initial_mode: usize,
    /// The run at the time that was advanced to.
    view: View,
    /// The run at another time.
    other: View,
}

impl<'p> Simulator<'p> {
    /// Prepares a problem.
    ///
    /// # Errors
    /// As [`super::simulate`].
    pub fn new(problem: &'p Problem) -> Result<Self, Reason> {
        Self::prepare(Simulation::new(problem)?)
    }

    /// Prepares a problem; rows and transitions go to `observer` as they come, and if it wants them all steps with their
    /// dense output. [`Simulator::events`] holds none of them. It hears of a step when that is made, and with it of rows up to
    /// its end, which may be after the time that is advanced to.
    ///
    /// ```
    /// use dalembert::hybrid::{MadeStep, Observer, Problem, Simulator};
    /// use dalembert::model::models;
    /// use dalembert::record::{Jump, Sides};
    /// use std::ops::ControlFlow;
    ///
    /// /// Keeps the largest height that a ball has in the middle of a step, and its speeds before and after impacts.
    /// #[derive(Default)]
    /// struct Watch {
    ///     highest: f64,
    ///     impacts: Vec<[f64; 2]>,
    /// }
    ///
    /// impl Observer for Watch {
    ///     fn row(&mut self, _: f64, _: usize, _: &[f64]) -> ControlFlow<()> {
    ///         ControlFlow::Continue(())
    ///     }
    ///     fn event(&mut self, _: &Jump, sides: Option<&Sides>) {
    ///         let sides = sides.expect("`event_states` asks for them");
    ///         self.impacts.push([sides.before.v[0], sides.after.v[0]]);
    ///     }
    ///     fn sees_steps(&self) -> bool {
    ///         true
    ///     }
    ///     fn step(&mut self, step: &mut MadeStep) {
    ///         let (mut q, mut v) = ([0.0], [0.0]);
    ///         step.state_at(0.5 * (step.from + step.to), &mut q, &mut v);
    ///         self.highest = self.highest.max(q[0]);
    ///     }
    /// }
    ///
    /// let model = models().find("bouncing_ball").expect("a model of the toolkit");
    /// let mut problem = Problem::new(&model);
    /// problem.set_initial("h", 1.0)?;
    /// let mut watch = Watch::default();
    /// let mut simulator = Simulator::observed(&problem, &mut watch)?;
    /// simulator.advance_to(0.8)?;
    /// drop(simulator);
    /// assert!(watch.highest > 0.5 && watch.impacts[0][0] < 0.0 && watch.impacts[0][1] > 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`super::simulate`].
    pub fn observed(problem: &'p Problem, observer: &'p mut dyn Observer) -> Result<Self, Reason> {
        Self::prepare(Simulation::observed(problem, Some(observer))?)
    }

    fn prepare(mut simulation: Simulation<'p>) -> Result<Self, Reason> {
        simulation.observers.leave_out_extremes();
        simulation.begin()?;
        let mut simulator = Simulator {
            initial_mode: simulation.here.mode,
            view: View::new(simulation.here.q.len()),
            other: View::new(simulation.here.q.len()),
            simulation,
        };
        simulator.evaluate();
        Ok(simulator)
    }

    /// Runs from the start to the end; what was commanded before is forgotten.
    ///
    /// # Errors
    /// [`Reason`] why it stopped before its end; state and events are those up to there.
    pub fn run(&mut self, progress: &mut dyn Progress) -> Result<(), Reason> {
        self.simulation.rewind(self.initial_mode);
        let outcome = self.simulation.run(progress);
        self.simulation.stage = match &outcome {
            Ok(()) => Stage::Over,
            Err(reason) => Stage::Failed(Box::new(reason.clone())),
        };
        self.show_here();
        outcome
    }

    /// Goes back to the start; what was commanded is forgotten.
    pub fn rewind(&mut self) {
        self.simulation.rewind(self.initial_mode);
        self.evaluate();
    }

    /// Goes on to time `t`, s, or to the end of the run, if that comes before. Gives why it stops: [`Stopped::Time`],
    /// [`Stopped::Limit`] or [`Stopped::End`]. At a time that is not after the present one nothing is done.
    ///
    /// What happens at the very time happens when the run goes on.
    ///
    /// # Errors
    /// [`Reason`] why the run cannot go on: something that the model requires, a failure, an observer that has had
    /// enough. State and events are those up to there; the run stays there, and gives the same reason again.
    pub fn advance_to(&mut self, t: f64) -> Result<Stopped, Reason> {
        self.advance(t, false)
    }

    /// Goes on to time `t`, s, or to the next event, if that comes before: [`Stopped::Event`], or [`Stopped::Rest`]. All
    /// transitions of the instant have happened then; the state is that after them.
    ///
    /// # Errors
    /// As [`Simulator::advance_to`].
    pub fn advance_to_event(&mut self, t: f64) -> Result<Stopped, Reason> {
        self.advance(t, true)
    }

    fn advance(&mut self, t: f64, to_event: bool) -> Result<Stopped, Reason> {
        if !(t > self.view.t || self.simulation.stage.is_ended()) {
            return Ok(Stopped::Time);
        }
        let outcome = self.simulation.advance_until(t, to_event, &mut Silent);
        match &outcome {
            Ok(Stopped::Time) => self.view.t = t.min(self.simulation.here.now.seconds()),
            _ => self.view.t = self.simulation.here.now.seconds(),
        }
        self.evaluate();
        outcome
    }

    /// Commands an input from the present time on. Its function must be one that can be commanded
    /// ([`crate::input::Function::commanded`]), or a sum with one.
    ///
    /// The motion is that with a table that had these values from the start. Where the input is changed a step ends and
    /// the mode is found again; what is commanded already changes nothing.
    ///
    /// # Errors
    /// [`Invalid`] if the model has no such input, if it cannot be commanded, or if the command is no finite value or
    /// ends before it begins.
    pub fn command(&mut self, input: &str, command: Command) -> Result<(), Invalid> {
        let inputs = &self.simulation.problem.model.inputs;
        let Some(index) = inputs.iter().position(|i| i.name == input) else {
            return Err(Unknown {
                model: self.simulation.problem.model.name,
                what: "input",
                name: input.into(),
                known: inputs.iter().map(|i| i.name.into()).collect(),
            }
            .into());
        };
        let now = self.simulation.here.now.seconds();
        let wrong = match command {
            Command::Hold(value) | Command::Ramp { to: value, .. } if !value.is_finite() => {
                Some(format!("a command of {value}, which is not finite"))
            }
            Command::Ramp { until, .. } if !(until > now && until.is_finite()) => Some(format!(
                "a ramp until {until} s, which is not after the present time {now} s"
            )),
            _ => None,
        };
        if let Some(what) = wrong {
            return Err(Invalid::Command {
                input: inputs[index].name,
                what,
            });
        }
        if self.simulation.command(index, command).is_none() {
            return Err(Invalid::NotCommanded {
                input: inputs[index].name,
            });
        }
        self.evaluate();
        Ok(())
    }

    /// The run as it is, to go on from here later, or elsewhere: see [`Checkpoint`].
    ///
    /// ```
    /// use dalembert::hybrid::{Checkpoint, Problem, Simulator};
    /// use dalembert::model::models;
    ///
    /// let model = models().find("bouncing_ball").expect("a model of the toolkit");
    /// let mut problem = Problem::new(&model);
    /// problem.set_initial("h", 1.0)?;
    /// let mut simulator = Simulator::new(&problem)?;
    /// simulator.advance_to(0.7)?;
    /// let text = serde_json::to_string(&simulator.snapshot()?)?;
    /// simulator.advance_to(1.0)?;
    ///
    /// let checkpoint: Checkpoint = serde_json::from_str(&text)?;
    /// let mut other = Simulator::new(&problem)?;
    /// other.restore(&checkpoint)?;
    /// other.advance_to(1.0)?;
    /// assert_eq!(other.q()[0].to_bits(), simulator.q()[0].to_bits());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Reason`] why the run has failed, if it has: it does not go on.
    pub fn snapshot(&mut self) -> Result<Checkpoint, Reason> {
        self.simulation.checkpoint(self.view.t)
    }

    /// Goes to where a checkpoint was taken, of a run of this problem; its end may be another one.
    /// [`Simulator::events`] holds what happens from there on.
    ///
    /// # Errors
    /// [`Misfit`] with what differs; the run is then where it was, or, if a checkpoint is damaged that has its digest
    /// nevertheless, at its start.
    pub fn restore(&mut self, from: &Checkpoint) -> Result<(), Misfit> {
        if let Err(misfit) = self.simulation.restore(from) {
            if let Misfit::Damaged { .. } = misfit {
                self.rewind();
            }
            return Err(misfit);
        }
        self.view.t = from.time();
        self.evaluate();
        Ok(())
    }

    /// Evaluates the run at the time that it was advanced to.
    fn evaluate(&mut self) {
        let t = self.view.t;
        if self.simulation.evaluate_at(t, &mut self.view).is_err() {
            self.show_here();
        }
    }

    /// Shows the state that was computed last.
    fn show_here(&mut self) {
        let here = &self.simulation.here;
        self.view.t = here.now.seconds();
        self.view.q.copy_from_slice(&here.q);
        self.view.v.copy_from_slice(&here.v);
        self.view.a.copy_from_slice(&here.a);
    }

    /// The run at the time that it was advanced to.
    pub fn moment(&mut self) -> Moment<'_> {
        self.evaluate();
        Moment::new(&self.simulation, &self.view)
    }

    /// The run at time `t`, s, within the last step: where no input is commanded it goes beyond the time that was advanced
    /// to. An observer sees all steps. The time that was advanced to stays as it is.
    ///
    /// # Errors
    /// [`NotComputed`] where the motion is not at hand, with the times between which it is.
    pub fn at(&mut self, t: f64) -> Result<Moment<'_>, NotComputed> {
        self.simulation.evaluate_at(t, &mut self.other)?;
        Ok(Moment::new(&self.simulation, &self.other))
    }

    /// Time reached, s.
    pub fn time(&self) -> f64 {
        self.view.t
    }

    /// Name of the present mode.
    pub fn mode_name(&self) -> &'static str {
        self.simulation.mode().name
    }

    /// Index of the present mode in the variant of the problem.
    pub fn mode(&self) -> usize {
        self.simulation.here.mode
    }

    /// All coordinates.
    pub fn q(&self) -> &[f64] {
        &self.view.q
    }

    /// All velocities.
    pub fn v(&self) -> &[f64] {
        &self.view.v
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
        let mut reached = self.simulation.margins.reached();
        // The last step may go beyond the time that was advanced to.
        let now = self.view.t;
        reached.limit_states.retain(|state| state.t <= now);
        reached
            .validity
            .retain(|left| left.t.is_none_or(|t| t <= now));
        reached
    }

    /// Work done by the integrator; the method is not named.
    pub fn solver(&self) -> &Solver {
        &self.simulation.solver
    }
}
