//! What a model offers: names, units, meanings, dimensions, and the typed tables of its modes and
//! transitions. A model is read once from the contract that generated code exports, whether it was linked
//! or loaded ([`crate::kernel`]), and owns all that it holds; names are interned ([`name::intern`]).

mod bounds;
mod contacts;
mod context;
mod description;
mod load;
pub mod name;
mod reader;
mod registry;
mod tape;
#[cfg(test)]
mod tests;

pub use bounds::Bounds;
pub(crate) use bounds::shown;
pub use contacts::{Constraint, Contact, ContactSets, Contacts, DeclaredContact};
pub use registry::{FolderRefused, FromFolder, Models, SameName, models};
pub use tape::{Instruction, JET_ORDERS, Name, Pick, Tape};
pub(crate) use tape::{Operands, Powers};

use crate::kernel::{ConstantsKernel, GuardKernel, ModeKernels, TransitionKernel};

/// A model: one folder under `models/`.
#[derive(Debug)]
pub struct Model {
    /// Folder name, which is also the name a scene uses.
    pub name: &'static str,
    /// Digest of what its code was generated from: its folder, the generator, the pinned packages.
    pub digest: &'static str,
    /// One line that says what the model is.
    pub title: &'static str,
    /// Where the model comes from (author, year).
    pub source: &'static str,
    /// Generalized coordinates, in the order of every `q`, `v`, `a` and reaction vector.
    pub coordinates: Box<[Coordinate]>,
    /// Prescribed motions, in the order of their reactions.
    pub motions: Box<[Motion]>,
    /// Parameters, in the order of the raw parameter vector.
    pub parameters: Box<[Parameter]>,
    /// Named parameter sets (`"parameters": {"set": "full_plate"}`).
    pub parameter_sets: Box<[ParameterSet]>,
    /// Inputs a scene may prescribe.
    pub inputs: Box<[Input]>,
    /// Discrete states, changed by transitions only.
    pub discretes: Box<[Discrete]>,
    /// Modelling choices of a scene, such as the rule set; each combination is a [`Variant`].
    pub choices: Box<[Choice]>,
    /// What depends on parameters alone; evaluated once a run.
    pub constants: ConstantsKernel,
    /// One variant per combination of choices; of a model from a folder those that were asked for.
    pub variants: Box<[Variant]>,
    /// All combinations, whether or not there is a variant of them: the options, in the order of the choices.
    pub combinations: Box<[Box<[&'static str]>]>,
    /// True for models that exist for the test suite alone.
    pub for_tests: bool,
    /// The library that its functions are in, if it was loaded: it stays as long as they may be called.
    pub(crate) library: Option<crate::kernel::Library>,
}

/// A generalized coordinate and its velocity.
#[derive(Debug)]
pub struct Coordinate {
    /// Name.
    pub name: &'static str,
    /// Unit of the coordinate; the velocity has `unit/s`.
    pub unit: &'static str,
    /// Meaning and sign.
    pub meaning: &'static str,
    /// Unit of the reaction (generalized force) of this coordinate.
    pub reaction_unit: &'static str,
    /// Whether its acceleration is the force of a contact or a constraint, and its rate the impulse delivered so far.
    pub multiplier: bool,
    /// Typical magnitude, in `unit`; the default absolute tolerance is relative tolerance × scale.
    pub scale: f64,
    /// Typical magnitude of the velocity, in `unit/s`.
    pub rate_scale: f64,
    /// Lower bound that every admissible state respects, if it is a number (`theta >= 0`). Bounds that depend on
    /// parameters are [`Variant::bounds`].
    pub minimum: Option<f64>,
    /// Upper bound, likewise.
    pub maximum: Option<f64>,
}

/// A prescribed motion: of the ground along one axis, or of something else.
#[derive(Debug)]
pub struct Motion {
    /// Name (`z_h`).
    pub name: &'static str,
    /// Unit of the displacement.
    pub unit: &'static str,
    /// Unit of its reaction: the force that the ground, or what else it is of, exerts on the system along it.
    pub reaction_unit: &'static str,
    /// Whether it is of the ground.
    pub is_ground: bool,
    /// The input that is its acceleration, by its index.
    pub input: usize,
    /// Meaning and sign.
    pub meaning: &'static str,
}

/// A parameter.
#[derive(Debug)]
pub struct Parameter {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Meaning.
    pub meaning: &'static str,
    /// Value when a scene says nothing.
    pub default: f64,
    /// Smallest admissible value; exclusive where `minimum_exclusive`.
    pub minimum: f64,
    /// Whether `minimum` itself is inadmissible (a mass that must be positive).
    pub minimum_exclusive: bool,
    /// Largest admissible value (may be infinite).
    pub maximum: f64,
    /// Name of a parameter that this one must not exceed (μ_k ≤ μ_s).
    pub at_most: Option<&'static str>,
}

/// Named values for some of the parameters.
#[derive(Debug)]
pub struct ParameterSet {
    /// Name.
    pub name: &'static str,
    /// What the set describes, with its source.
    pub meaning: &'static str,
    /// `(parameter name, value)` pairs; parameters not named keep their default.
    pub values: Box<[(&'static str, f64)]>,
}

/// What an input prescribes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InputKind {
    /// An acceleration of the ground. It fills three signals: acceleration, velocity,
    /// displacement; the last two start from rest at t = 0.
    Acceleration,
    /// Any other function of time (a force, say). It fills one signal.
    Value,
}

/// A prescribed function of time.
#[derive(Debug)]
pub struct Input {
    /// Name.
    pub name: &'static str,
    /// Unit of what a scene prescribes.
    pub unit: &'static str,
    /// Meaning and sign.
    pub meaning: &'static str,
    /// Which signals it fills.
    pub kind: InputKind,
    /// Index of its first signal in the vector of signals.
    pub signal: usize,
}

/// A discrete state.
#[derive(Debug)]
pub struct Discrete {
    /// Name.
    pub name: &'static str,
    /// Admissible values; the first is the default.
    pub values: Box<[f64]>,
    /// Meaning.
    pub meaning: &'static str,
    /// Whether a scene may say what it is at the start; that of a contact may follow from the rest of the state.
    pub given: bool,
}

/// A modelling choice of a scene (a top-level key of the scene file).
#[derive(Debug)]
pub struct Choice {
    /// Name, such as `rules`.
    pub name: &'static str,
    /// The alternatives, such as `reactions`, `paper`.
    pub options: Box<[&'static str]>,
    /// Meaning.
    pub meaning: &'static str,
}

/// The hybrid automaton for one combination of choices.
#[derive(Debug)]
pub struct Variant {
    /// Chosen option of each choice, by name, in the order of [`Model::choices`].
    pub options: Box<[&'static str]>,
    /// Whether each chosen option is the default, given the choices made before it. A scene gets
    /// the variant that has the options it names and the default for every other choice.
    pub defaults: Box<[bool]>,
    /// What pages draw, as `codegen/drawing.py` writes it (JSON); empty where the model draws nothing.
    pub drawing: &'static str,
    /// Inputs, by index, that may not be given under these options.
    pub barred: Box<[usize]>,
    /// The modes; the first is where a scene starts when it names none and several fit.
    pub modes: Box<[Mode]>,
    /// Where accumulations may come to rest, in the order of the file.
    pub rests: Box<[Rest]>,
    /// Contacts, friction elements and constraints as they are declared.
    pub contacts: Box<[DeclaredContact]>,
    /// Limit states.
    pub limits: Box<[Limit]>,
    /// The discrete states that people see, by their indices: not those that choose rows of equations (`left.closed`), and none
    /// that nothing depends on under these options.
    pub discretes: Box<[usize]>,
    /// Outputs. Those that the model declares are the same under all options, those of contacts are of the contacts that are there.
    pub outputs: Box<[Output]>,
    /// The impulses that an impact of contacts may have.
    pub impulses: Box<[Impulse]>,
    /// Under which conditions on the motion the model is meant.
    pub valid_motion: Box<[Validity]>,
    /// Under which conditions on the parameters it is meant.
    pub valid_parameters: Box<[Validity]>,
    /// Bounds of coordinates that depend on parameters.
    pub bounds: Box<[ParametricBound]>,
    /// Of the parameters: by how much each of the conditions on them holds, then these bounds.
    pub declared: ConstantsKernel,
    /// The same modes where the motions of the ground that are optional never act, if some are: their inputs, by index,
    /// and the variant without their terms.
    pub lean: Option<(Box<[usize]>, Box<Variant>)>,
}

/// A mode at the limit of infinitely many events in finite time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rest {
    /// Index of a mode that some of the events lead to.
    pub source: usize,
    /// Index of the mode that is entered where the limit satisfies what it holds.
    pub target: usize,
}

/// A state in which something has happened that the model is not about, such as that a block has overturned.
#[derive(Debug)]
pub struct Limit {
    /// Name.
    pub name: &'static str,
    /// What it means, in words.
    pub message: &'static str,
    /// When it is reached, as text.
    pub text: &'static str,
    /// Whether a run ends there if the scene does not say otherwise.
    pub ends: bool,
}

/// A quantity that people look at, which the motion does not depend on.
#[derive(Debug)]
pub struct Output {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Meaning and sign.
    pub meaning: &'static str,
    /// What it is, as text.
    pub text: &'static str,
}

/// The impulse of a force of a contact or a constraint at an impact.
#[derive(Debug)]
pub struct Impulse {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Meaning.
    pub meaning: &'static str,
    /// Index of the multiplier whose rate it is since the start; none where transitions say what it is.
    pub multiplier: Option<usize>,
}

/// A condition under which the model is meant.
#[derive(Debug)]
pub struct Validity {
    /// The condition as text.
    pub condition: &'static str,
    /// What the model assumes, in words.
    pub sentence: &'static str,
}

/// A bound of a coordinate that depends on parameters.
#[derive(Debug)]
pub struct ParametricBound {
    /// Index of the coordinate.
    pub coordinate: usize,
    /// Whether it is the upper bound.
    pub upper: bool,
    /// The bound as text.
    pub text: &'static str,
}

/// Where a frozen coordinate is held, in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeldAt {
    /// At a number.
    Number(f64),
    /// At what follows from parameters, or from free coordinates, as text: [`crate::kernel::ModeKernel::coordinates`] gives the value.
    Expression(&'static str),
}

/// A mode: which coordinates are free, and the functions of the reduced system.
#[derive(Debug)]
pub struct Mode {
    /// Name.
    pub name: &'static str,
    /// Meaning.
    pub meaning: &'static str,
    /// Indices of the free coordinates, increasing.
    pub free: Box<[usize]>,
    /// Where a frozen coordinate is held; `None`: wherever it was. One entry a coordinate.
    pub held_at: Box<[Option<HeldAt>]>,
    /// Guards of this mode, in the order of the guards function.
    pub guards: Box<[Guard]>,
    /// The frictions of which several may change at one instant, where which do is decided for all of them; empty where each decides
    /// alone.
    pub frictions: Box<[TiedFriction]>,
    /// What must stay positive in this mode: the first values of the requirements function.
    pub requirements: Box<[Requirement]>,
    /// Shapes of its other values: margins of the variant's limits, then of its validity in motion. A limit is reached,
    /// or the validity left, where its margin is negative. `None`: it does not change in this mode.
    pub margins: Box<[Option<GuardShape>]>,
    /// Rate of each frozen coordinate that drifts (a belt); false: it rests. One entry a coordinate.
    pub drifts: Box<[bool]>,
    /// Whether a frozen coordinate depends on free ones (a wheel that does not slip). One entry a coordinate.
    pub depends: Box<[bool]>,
    /// Contacts and constraints that hold by multipliers in this mode, if it is one of all sets of contact states.
    pub contacts: Option<Contacts>,
    /// Mass matrix, column by column, and load.
    pub system: Tape,
    /// The guards.
    pub guard_values: Tape,
    /// Generated functions, typed by the number of free coordinates.
    pub kernels: ModeKernels,
    /// Operation counts of the generated functions, by name.
    pub operations: Box<[(&'static str, usize)]>,
}

/// A friction whose slip inertia couples with that of another.
#[derive(Debug)]
pub struct TiedFriction {
    /// Name of its contact.
    pub name: &'static str,
    /// Whether it sticks in this mode.
    pub sticks: bool,
    /// What it does next: where it sticks it slips forwards or backwards, where it slides it sticks or reverses. Each is a transition of
    /// the mode, by the index of its guard and its own in that.
    pub changes: [Option<(usize, usize)>; 2],
}

/// A continuous scalar whose fall through zero makes the mode inadmissible.
#[derive(Debug)]
pub struct Guard {
    /// Name, as errors print it.
    pub name: &'static str,
    /// The guard as text, for `describe`.
    pub text: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Its dependence, which decides how its roots are isolated.
    pub shape: GuardShape,
    /// Whether it is a force, or what has its dimension of time (of contacts solved with multipliers, in some of their states:
    /// [`Mode::is_of_forces`]): no place and no rate.
    pub of_forces: bool,
    /// The discrete state, ±1, with which it multiplies a slip rate, if it does: the direction of a contact that slides.
    pub direction: Option<usize>,
    /// The generated guard and its derivative along the flow.
    pub kernel: GuardKernel,
    /// Transitions this guard can trigger, tried in order: the first whose condition holds is taken.
    pub transitions: Box<[Transition]>,
}

impl Guard {
    /// Whether it is more than a coordinate or a rate.
    pub fn is_general(&self) -> bool {
        matches!(self.shape, GuardShape::General { .. })
    }

    /// Whether it is a coordinate or a rate itself, which has no rounding near zero.
    pub fn is_exact(&self) -> bool {
        matches!(self.shape, GuardShape::Linear { offset: false, .. })
    }

    /// Whether its fall leads to the same state in other coordinates, which is no event.
    pub fn is_chart(&self) -> bool {
        self.transitions
            .iter()
            .any(|transition| transition.is_chart)
    }
}

/// How a guard depends on the state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GuardShape {
    /// A free coordinate or its rate, times a factor, plus what does not move: a polynomial on a
    /// step's dense output.
    Linear {
        /// Index among the mode's free coordinates.
        index: usize,
        /// Whether it is the rate rather than the coordinate.
        rate: bool,
        /// Constant factor.
        factor: f64,
        /// Index of a discrete state that is a further factor.
        discrete: Option<usize>,
        /// Whether something is added: what the guard is at the zero state, which parameters and
        /// discrete states decide.
        offset: bool,
    },
    /// A function of state, accelerations, signals and parameters.
    General {
        /// Whether it depends on the accelerations of the free coordinates.
        accelerations: bool,
        /// Whether it depends on the signals.
        signals: bool,
    },
}

/// Guard → next mode, with a map of the state.
#[derive(Debug)]
pub struct Transition {
    /// Name, as events list it.
    pub name: &'static str,
    /// Index of the next mode.
    pub target: usize,
    /// Whether the transition is taken only if its condition, evaluated in the target mode after
    /// the reset, is ≥ 0.
    pub conditional: bool,
    /// Names of what the reset may change (coordinates, `theta.rate`, discretes).
    pub changes: Box<[&'static str]>,
    /// Whether it is an impact: velocities may jump and energy may be lost.
    pub impact: bool,
    /// Whether it leads to the same state in other coordinates, which is no event.
    pub is_chart: bool,
    /// Its conditions, in the target mode; none if it is unconditional.
    pub conditions: Tape,
    /// The generated reset.
    pub kernel: TransitionKernel,
}

/// Something that must stay positive for the mode to mean anything (N > 0), or of what `may_vanish` must not become negative.
#[derive(Debug)]
pub struct Requirement {
    /// The requirement as text.
    pub text: &'static str,
    /// What its failure means, in words.
    pub failure: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Whether it holds where it is zero.
    pub may_vanish: bool,
}

impl Requirement {
    /// Whether it holds at a value, or at a bound of it. Not where this is not a number.
    pub fn is_met(&self, value: f64) -> bool {
        value > 0.0 || self.may_vanish && value == 0.0
    }
}

impl Variant {
    /// Whether contacts or constraints are declared that are not switched off.
    pub fn has_contacts(&self) -> bool {
        self.contacts.iter().any(|contact| contact.is_there())
    }

    /// Whether there is a state that contacts or constraints do not admit: a gap, or what is held for good.
    pub fn has_inadmissible(&self) -> bool {
        let holds = |contact: &DeclaredContact| contact.gap.is_some() || contact.states.len() == 1;
        (self.contacts.iter()).any(|contact| contact.is_there() && holds(contact))
    }

    /// Whether contacts or constraints are held by multipliers.
    pub fn has_multipliers(&self) -> bool {
        self.modes.iter().any(|mode| mode.contacts.is_some())
    }
}

impl Mode {
    /// Whether a guard is a force in a discrete state: what pushes or what friction can still hold, not a gap and not a slip rate.
    pub fn is_of_forces(&self, guard: usize, discrete: &[f64]) -> bool {
        let of_contact = self.contacts.as_ref();
        let of_contact = of_contact.and_then(|of| of.contacts.get(guard / Contacts::GUARDS));
        self.guards[guard].of_forces
            && of_contact.is_none_or(|contact| match guard % Contacts::GUARDS {
                0 => contact.closed.is_none_or(|closed| discrete[closed] != 0.0),
                1 => contact
                    .direction
                    .is_none_or(|direction| discrete[direction] == 0.0),
                _ => true,
            })
    }

    /// Whether a mode holds a coordinate still: it is not free, does not depend on what is, and is not carried along.
    pub fn freezes(&self, i: usize) -> bool {
        !self.free.contains(&i) && !self.moves(i)
    }

    /// Whether a coordinate moves although the mode holds it: it drifts, or depends on free ones.
    pub fn moves(&self, i: usize) -> bool {
        self.drifts[i] || self.depends[i]
    }
}

impl Model {
    /// Whether contacts or constraints are declared, under some choices at least.
    pub fn has_contacts(&self) -> bool {
        self.variants.iter().any(Variant::has_contacts)
    }

    /// Whether contacts or constraints are held by multipliers, under some choices at least.
    pub fn has_multipliers(&self) -> bool {
        self.variants.iter().any(Variant::has_multipliers)
    }

    /// Whether it was loaded from a library, not linked into the program.
    pub fn is_loaded(&self) -> bool {
        self.library.is_some()
    }

    /// The coordinates that people see, which come first: those behind them are multipliers.
    pub fn own_coordinates(&self) -> &[Coordinate] {
        let all = &self.coordinates;
        &all[..all.iter().filter(|c| !c.multiplier).count()]
    }

    /// The discrete states that people see under the options of a variant.
    pub fn seen_discretes<'m>(
        &'m self,
        variant: &'m Variant,
    ) -> impl Iterator<Item = &'m Discrete> {
        variant.discretes.iter().map(|&i| &self.discretes[i])
    }

    /// Index of a reaction among those of all coordinates and motions of the ground, by its index among those that people see.
    pub fn reaction(&self, seen: usize) -> usize {
        let own = self.own_coordinates().len();
        match seen < own {
            true => seen,
            false => seen + self.coordinates.len() - own,
        }
    }

    /// Number of signals that the inputs fill.
    pub fn signal_count(&self) -> usize {
        self.inputs.iter().map(|i| i.kind.signals()).sum()
    }
    /// All variants, the lean ones among them.
    pub fn automata(&self) -> impl Iterator<Item = &Variant> {
        fn both(variant: &Variant) -> impl Iterator<Item = &Variant> {
            let lean = variant.lean.as_ref().map(|(_, lean)| &**lean);
            std::iter::once(variant).chain(lean)
        }
        self.variants.iter().flat_map(both)
    }
    /// Index of a coordinate by name.
    pub fn coordinate(&self, name: &str) -> Option<usize> {
        self.coordinates.iter().position(|c| c.name == name)
    }
    /// Index of a parameter by name.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|p| p.name == name)
    }
}

impl Parameter {
    /// The values that it may have.
    pub fn bounds(&self) -> Bounds {
        Bounds {
            minimum: self.minimum,
            minimum_exclusive: self.minimum_exclusive,
            maximum: self.maximum,
        }
    }
}

impl Coordinate {
    /// The values that it may have.
    pub fn bounds(&self) -> Bounds {
        Bounds {
            maximum: self.maximum.unwrap_or(f64::INFINITY),
            ..Bounds::at_least(self.minimum.unwrap_or(f64::NEG_INFINITY))
        }
    }
}

impl InputKind {
    /// How many signals an input of this kind fills.
    pub fn signals(self) -> usize {
        match self {
            InputKind::Acceleration => 3,
            InputKind::Value => 1,
        }
    }
}
