//! Why a simulation stops before its end.

use super::checkpoint::Misfit;
use super::problem::ImpactLaw;
use super::unrest::{Restless, Tried, tried};
use super::validate::Invalid;
use crate::integrate::{Singular, StepError};

/// What the engine's inner functions give: a reason, which is seldom and large, behind a pointer, so that what they give
/// otherwise stays in registers.
pub(super) type Stoppable<T> = Result<T, Box<Reason>>;

impl From<StepError> for Box<Reason> {
    fn from(error: StepError) -> Self {
        Box::new(error.into())
    }
}

/// Reason of an early stop; the place (hybrid time, mode, state) and the trajectory so far are in
/// the [`crate::hybrid::Run`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Reason {
    /// A run does not go on from a checkpoint.
    #[error(transparent)]
    Checkpoint(#[from] Misfit),
    /// The integrator found no acceptable step.
    #[error("no step could be taken: {0}")]
    Step(#[from] StepError),
    /// The accelerations are not determined.
    #[error(
        "mode `{mode}`: the effective mass matrix is singular (coordinate `{coordinate}`), so the accelerations are not determined; with friction this is Painlevé's paradox, without it a massless part"
    )]
    Singular {
        /// Mode.
        mode: &'static str,
        /// Free coordinate without a pivot.
        coordinate: &'static str,
    },
    /// The kinetic energy is no norm.
    #[error(
        "mode `{mode}`: the mass matrix is not positive definite (pivot of `{coordinate}`: {pivot:e}), so the equations are not those of a mechanical system; check masses and inertias"
    )]
    Indefinite {
        /// Mode.
        mode: &'static str,
        /// Free coordinate whose pivot is not positive.
        coordinate: &'static str,
        /// Its pivot.
        pivot: f64,
    },
    /// An effective mass vanishes on the way.
    #[error(
        "mode `{mode}`: the effective mass of `{coordinate}` vanishes: {left:.1e} of what it was at the last event is left, and beyond zero no motion is determined; check the mass, or end the mode before"
    )]
    VanishingMass {
        /// Mode.
        mode: &'static str,
        /// Free coordinate.
        coordinate: &'static str,
        /// What is left of it, as a part of what it was; negative beyond zero.
        left: f64,
    },
    /// A number of the run is too large for a double.
    #[error("{what} is not finite: the numbers of this scene leave the range of doubles")]
    NotFinite {
        /// Which.
        what: &'static str,
    },
    /// The determinant of the effective mass matrix is negative: without friction it is positive.
    #[error(
        "mode `{mode}`: friction makes the determinant of the effective mass matrix negative; it would accelerate the slip that it opposes (Painlevé's paradox), and the motion is not determined"
    )]
    DeterminantChangesSign {
        /// Mode.
        mode: &'static str,
    },
    /// Something that must stay positive does not.
    #[error("mode `{mode}`: {failure} ({text} = {value:e} {unit})")]
    Requirement {
        /// Mode.
        mode: &'static str,
        /// What its failure means.
        failure: &'static str,
        /// The requirement as text.
        text: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// No mode is admissible: the settling came back to a mode and state it had left.
    #[error(
        "no mode is admissible here: the transitions {} lead back to the same mode and state; two guards contradict each other",
        joined(cycle)
    )]
    Cycle {
        /// The transitions of the cycle.
        cycle: Vec<Taken>,
    },
    /// No mode is admissible: a guard has fallen, and the condition of none of its transitions holds.
    #[error(
        "no mode is admissible here: the guard of {guard} has fallen, and no condition holds of a transition that it leads to"
    )]
    NoTransition {
        /// The guard.
        guard: &'static str,
    },
    /// Events follow each other without end, and between them neither time nor motion goes on.
    #[error(
        "events accumulate (chattering) and neither time nor motion goes on by more than rounding; transitions involved: {}; {missing}",
        transitions.join(", ")
    )]
    Chattering {
        /// Names of the transitions.
        transitions: Vec<&'static str>,
        /// Why they do not come to rest.
        missing: Restless,
    },
    /// Constraints depend on each other at a place.
    #[error(
        "mode `{mode}`: constraints depend on each other here (a singular position, such as a dead point or a stretched arm): the force of `{of}` is not determined, and the motion may branch"
    )]
    SingularPosition {
        /// Mode.
        mode: &'static str,
        /// What is held by the force.
        of: &'static str,
    },
    /// The motion goes to infinity within a time that is none.
    #[error(
        "mode `{mode}`: the motion goes to infinity here: `{coordinate}.rate` is {rate:.1e}, and steps do not advance the time any more; a stop, a constraint or a prescribed motion drives the system to where it has no way on (a linkage at its reach), or a force has a pole"
    )]
    Runaway {
        /// Mode.
        mode: &'static str,
        /// The coordinate that is the fastest, against its typical rate.
        coordinate: &'static str,
        /// Its rate, in its unit ÷ s.
        rate: f64,
    },
    /// The model needs a mode that the scene left out by freezing a coordinate.
    #[error("no mode is left in which {} may be frozen", frozen.join(", "))]
    NoModeLeft {
        /// The frozen coordinates.
        frozen: Vec<&'static str>,
    },
    /// The Taylor method was asked for, and the coefficients of the series leave the range of doubles.
    #[error(
        "method `taylor`: in mode `{mode}` the coefficients of the motion's series leave the range of doubles (rates are too fast); `auto` goes on by `radau` there"
    )]
    SeriesOverflows {
        /// Mode.
        mode: &'static str,
    },
    /// The Taylor method was asked for where the equations are too stiff for it.
    #[error(
        "method `taylor`: mode `{mode}` is stiff: a decay at {rate:.1e} 1/s, which is over, holds steps to {step:.1e} s, {steps:.1e} of them to the end; `radau` and `auto` follow the motion itself"
    )]
    Stiff {
        /// Mode.
        mode: &'static str,
        /// Rate of the fastest decay, 1/s.
        rate: f64,
        /// Length of a step, s.
        step: f64,
        /// Number of such steps to the end of the run.
        steps: f64,
    },
    /// The initial state fits no mode.
    #[error("the initial state does not fit mode `{mode}`: {why}")]
    Initial {
        /// Mode.
        mode: &'static str,
        /// What does not fit.
        why: Misfitting,
    },
    /// No static equilibrium to start from.
    #[error(
        "no static equilibrium is found near the initial configuration: {}",
        tried(of)
    )]
    NoRest {
        /// What moves, or cannot be brought to rest.
        of: Vec<Tried>,
    },
    /// The initial state is where no motion leads: settling would move it.
    #[error(
        "the initial state is beyond {what}: in mode `{mode}` {text} is {value:e} {unit} and must not be negative; `{transition}` would move the state at once"
    )]
    Beyond {
        /// Mode.
        mode: &'static str,
        /// The transition that would be taken.
        transition: &'static str,
        /// What it is beyond: a stop, if the transition is an impact.
        what: &'static str,
        /// The guard as text.
        text: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// The coordinate or rate (`theta.rate`) that the guard is about; empty if it is about more.
        of: String,
    },
    /// No set of contact states goes on.
    #[error(
        "no motion: of the contacts that touch ({}) no set of states may go on, whatever opens, sticks or slips (Painlevé's paradox: inconsistent); a scene may ask for an impact without collision",
        contacts.join(", ")
    )]
    NoMotion {
        /// Names of the contacts.
        contacts: Vec<&'static str>,
    },
    /// Several sets of contact states may go on, with motions that differ.
    #[error(
        "several motions: of the contacts that touch ({}) several sets of states may go on, and their motions differ: `{}` and `{}` (Painlevé's paradox: indeterminate)",
        contacts.join(", "),
        motions[0],
        motions[1]
    )]
    SeveralMotions {
        /// Names of the contacts.
        contacts: Vec<&'static str>,
        /// Two of the sets.
        motions: [String; 2],
    },
    /// The law of impact has no solution.
    #[error(
        "the impact of {} has no outcome: {}'s law and Coulomb's contradict each other there (a self-locking wedge)",
        contacts.join(", "),
        law.name()
    )]
    NoImpact {
        /// Names of the contacts.
        contacts: Vec<&'static str>,
        /// The law.
        law: ImpactLaw,
    },
    /// The model's own law of an impact leaves a gap that closes.
    #[error(
        "the impact of `{contact}` by the model's own law leaves the gap of `{closes}` with the rate {rate:e}, so that it goes on to close"
    )]
    OwnImpact {
        /// The contact that struck.
        contact: &'static str,
        /// The contact whose gap closes.
        closes: &'static str,
        /// Its rate, in the unit of the gap a second.
        rate: f64,
    },
    /// Impacts in sequence do not come to an end.
    #[error(
        "the impacts of {}, one after the other at one instant, do not come to an end; let them happen together, or with less restitution",
        contacts.join(", ")
    )]
    EndlessImpact {
        /// Names of the contacts.
        contacts: Vec<&'static str>,
    },
    /// The law of impact has several solutions.
    #[error(
        "the impact of {} has {count} outcomes that differ: {}'s law and Coulomb's do not determine it",
        contacts.join(", "),
        law.name()
    )]
    SeveralImpacts {
        /// Names of the contacts.
        contacts: Vec<&'static str>,
        /// Number of outcomes.
        count: usize,
        /// The law.
        law: ImpactLaw,
    },
    /// A reset by hand leads to a state that contacts or constraints do not admit.
    #[error("transition `{name}` leads to a state that is not admitted: {why}")]
    Reset {
        /// The transition.
        name: &'static str,
        /// What is wrong there.
        why: Misfitting,
    },
    /// A chart of the model leads to another state.
    #[error(
        "chart `{name}` changes {what} of `{of}` from {before:e} to {after:e}: it is to lead to other coordinates of the same state, by which nothing moves"
    )]
    Chart {
        /// The chart.
        name: &'static str,
        /// What it changes: the gap, its rate, the slip rate, the value of a constraint or its rate.
        what: &'static str,
        /// The contact or the constraint.
        of: &'static str,
        /// What that was.
        before: f64,
        /// What it is in the other coordinates.
        after: f64,
    },
    /// Something of the problem is not admissible.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// A run that is to be continued is not one of this problem.
    #[error("this is another run: {why}")]
    OtherRun {
        /// The value of the scene that is different, as its keys: `parameters.m`.
        path: String,
        /// What is different.
        why: String,
    },
    /// The run was interrupted from outside.
    #[error("interrupted")]
    Interrupted,
}

/// Why a state is not one of a mode.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Misfitting {
    /// It is beyond a bound.
    #[error("`{coordinate}` is below {minimum} {unit}")]
    Below {
        /// The coordinate.
        coordinate: &'static str,
        /// The bound.
        minimum: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// The mode holds a coordinate at another value.
    #[error("it holds `{coordinate}` at {held} {unit}")]
    HeldAt {
        /// The coordinate.
        coordinate: &'static str,
        /// Where it is held.
        held: f64,
        /// The unit of that.
        unit: &'static str,
    },
    /// The mode holds the rate of a coordinate at another value.
    #[error("it holds `{coordinate}.rate` at {held} {unit}/s")]
    HeldRate {
        /// The coordinate.
        coordinate: &'static str,
        /// The rate at which it is held.
        held: f64,
        /// The unit of the coordinate.
        unit: &'static str,
    },
    /// The scene freezes a coordinate that is free in the mode.
    #[error("the scene freezes a coordinate that is free in it")]
    Frozen,
    /// The scene freezes a coordinate that contacts may move.
    #[error("the scene freezes a coordinate that contacts may move")]
    FrozenBesideContacts,
    /// No mode holds the state.
    #[error("no mode that the scene leaves holds it")]
    NoMode,
    /// A constraint does not hold.
    #[error("{}constraint `{constraint}` is {value:e} there, not zero", if *.is_rate { "the rate of " } else { "" })]
    Constraint {
        /// The constraint.
        constraint: &'static str,
        /// Whether it is about its rate.
        is_rate: bool,
        /// What it is, or its rate.
        value: f64,
    },
    /// A contact penetrates.
    #[error("the gap of contact `{contact}` is {gap:e} there; it must not be negative")]
    Gap {
        /// The contact.
        contact: &'static str,
        /// Its gap.
        gap: f64,
    },
    /// A ratchet turns backwards.
    #[error("the rate of ratchet `{ratchet}` is {rate:e} there; it must not be negative")]
    Ratchet {
        /// The ratchet.
        ratchet: &'static str,
        /// Its rate.
        rate: f64,
    },
}

/// A transition that was taken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Taken {
    /// Its name.
    pub name: &'static str,
    /// The mode left.
    pub from: String,
    /// The mode entered.
    pub to: String,
}

/// Transitions in a sentence.
fn joined(cycle: &[Taken]) -> String {
    let steps = (cycle.iter()).map(|Taken { name, from, to }| format!("{name} ({from} → {to})"));
    steps.collect::<Vec<_>>().join(", ")
}

impl Reason {
    /// The reason for a singular matrix met in `mode` with the given free coordinates' names.
    pub(super) fn singular(
        mode: &crate::model::Mode,
        model: &crate::model::Model,
        singular: Singular,
    ) -> Self {
        let coordinate = model.coordinates[mode.free[singular.coordinate]].name;
        Reason::Singular {
            mode: mode.name,
            coordinate,
        }
    }
}
