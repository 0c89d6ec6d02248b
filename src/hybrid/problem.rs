//! What is to be simulated, validated.

use super::outputs::OwnOutput;
use super::validate::{Invalid, Unknown, check_initial, within};
use crate::input::{Function, Signals};
use crate::model::{Bounds, Model, Variant};
use crate::run::Recorded;
use std::sync::Arc;

/// A complete initial-value problem of a model.
#[derive(Debug, Clone)]
pub struct Problem {
    /// The model.
    pub model: Arc<Model>,
    /// Index of the variant with the chosen options: [`Problem::variant`].
    pub chosen: usize,
    /// Title of the scene, if it has one.
    pub title: Option<String>,
    /// Parameters in the order and the units of the model.
    pub parameters: Vec<f64>,
    /// Inputs.
    pub signals: Signals,
    /// Where it starts.
    pub initial: Initial,
    /// Whether an initial state that contacts and constraints do not admit is moved to one that they do: by multipliers to the
    /// nearest in the metric of the masses; else what every mode in which the run may start holds follows from the others, and what a
    /// negative gap solves for. A run says by how much ([`crate::run::Subject::projected`]). Without it such a state is refused.
    pub project: bool,
    /// Whether it starts at rest: in the static equilibrium near the initial configuration, without velocities and under the inputs at
    /// t = 0, with the contact forces that hold it; what a mode lets drift, where there is no other, with its rate. A run says by how much coordinates were moved, as
    /// after a projection.
    pub at_rest: bool,
    /// Of each discrete state, whether its initial value is stated though it is the default. The direction in which a contact slides is
    /// that of its slip rate otherwise.
    pub stated: Vec<bool>,
    /// Of each coordinate, then of each rate: whether its initial value is not stated, so that it follows from others where every mode in
    /// which the run may start says how, whatever `initial` has.
    pub unstated: Vec<bool>,
    /// Coordinates frozen in addition: modes in which one of them is free are left out.
    pub freeze: Vec<usize>,
    /// Where it ends.
    pub end: End,
    /// Limit states.
    pub limits: Limits,
    /// Outputs besides those of the model: see [`Problem::add_output`].
    pub outputs: Vec<OwnOutput>,
    /// Tolerances.
    pub accuracy: Accuracy,
    /// Method of integration.
    pub method: Method,
    /// How impacts of contacts by multipliers are decided.
    pub collisions: Collisions,
    /// What is recorded.
    pub record: Record,
}

/// How impacts of contacts by multipliers are decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Collisions {
    /// The law.
    pub law: ImpactLaw,
    /// Whether contacts that touch take part together.
    pub order: ImpactOrder,
    /// Whether a state without a motion (Painlevé's paradox) goes on by an impact without collision, where there is one and
    /// no other.
    pub without_collision: bool,
}

/// A law of impact, with Coulomb's for its impulses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ImpactLaw {
    /// The rate of a gap after is −e times that before.
    #[default]
    Newton,
    /// The impulse of expansion is at least e times that of compression.
    Poisson,
}

impl ImpactLaw {
    /// Whose it is.
    pub fn name(self) -> &'static str {
        match self {
            ImpactLaw::Newton => "Newton",
            ImpactLaw::Poisson => "Poisson",
        }
    }
}

/// In which order contacts that touch take part in an impact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ImpactOrder {
    /// All at one instant.
    #[default]
    Together,
    /// Those that close first, then those that these make close, and so on.
    InSequence,
}

/// Initial state at t = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial {
    /// All coordinates.
    pub q: Vec<f64>,
    /// All velocities.
    pub v: Vec<f64>,
    /// All discrete states.
    pub discrete: Vec<f64>,
    /// Mode; `None`: the mode with the fewest free coordinates that holds the state.
    pub mode: Option<usize>,
}

/// A method of integration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// Taylor where a mode is not stiff, else Radau. Which one is found out on the way:
    /// see [`Method::Taylor`] and [`Method::Radau`].
    #[default]
    Auto,
    /// Radau IIA: implicit, for stiff and non-stiff equations, with 5 or 7 stages: see
    /// [`crate::integrate::stages`]. Hops of contacts that are lower than its steps tell are followed by Taylor's method.
    Radau,
    /// Taylor series of the motion: the fastest for equations that are not stiff.
    Taylor,
}

/// End of a run: whichever comes first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Time, s.
    pub time: f64,
    /// Name of a transition and how often it happens before the run ends right after it.
    pub after: Option<(&'static str, u64)>,
}

/// Limit states of a problem.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Limits {
    /// Of limits of the model by name: what a run does there. The others are as the model says.
    pub of_model: Vec<(&'static str, AtLimit)>,
    /// Limits beside those of the model.
    pub own: Vec<OwnLimit>,
}

/// What a run does at a limit state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AtLimit {
    /// It ends.
    End,
    /// It goes on, and tells when the limit was first reached.
    Continue,
    /// It does not look whether it is reached, which takes no time then.
    Ignore,
}

/// A limit state that is not the model's.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnLimit {
    /// Name; of several with one name the first that is reached counts.
    pub name: String,
    /// What it means, in words.
    pub message: String,
    /// What it is about.
    pub of: Observed,
    /// Whether it is reached above the level, else below.
    pub above: bool,
    /// The level, in the unit of what it is about.
    pub level: f64,
    /// Whether a run ends there.
    pub ends: bool,
}

/// A quantity that a limit is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Observed {
    /// A coordinate, by its index.
    Coordinate(usize),
    /// The rate of a coordinate, by its index.
    Rate(usize),
    /// A reaction, by its index: those of the coordinates, then those of the motions of the ground. It is 0 where the
    /// coordinate is free.
    Reaction(usize),
    /// An output, by its index: those of the model, then those of the problem.
    Output(usize),
}

/// Tolerances of the local error of a step: absolute + relative × magnitude.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Accuracy {
    /// Relative tolerance.
    pub relative: f64,
    /// Absolute tolerance of each coordinate, in its unit.
    pub q_absolute: Vec<f64>,
    /// Absolute tolerance of each velocity, in its unit.
    pub v_absolute: Vec<f64>,
}

/// What is recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Record {
    /// Interval of the samples, s; `None`: the steps and both sides of every event.
    pub every: Option<f64>,
    /// Which columns besides coordinates, velocities and discrete states.
    pub columns: Recorded,
    /// Whether the energy ledger is kept; the columns of the energies need it.
    pub ledger: bool,
    /// Whether the states before and after an event are kept, and not its time alone.
    pub event_states: bool,
    /// Whether the extremes of coordinates and velocities are looked for, and those of the reactions and energies that
    /// are columns.
    pub extremes: bool,
}

impl Problem {
    /// A model with its default parameters and choices (the first there are of a model from a folder that was asked for
    /// others), at rest at zero without inputs, for 1 s at
    /// a relative tolerance of 1e-8, recording the events, the ledger, the extremes and the end.
    pub fn new(model: &Arc<Model>) -> Self {
        let mut variants = model.variants.iter();
        let variant = variants.position(|v| v.defaults.iter().all(|&d| d));
        let n = model.coordinates.len();
        let mut problem = Problem {
            model: model.clone(),
            chosen: variant.unwrap_or(0),
            title: None,
            parameters: model.parameters.iter().map(|p| p.default).collect(),
            signals: Signals::new(
                &model.inputs,
                model.inputs.iter().map(|_| Function::zero()).collect(),
            ),
            initial: Initial {
                q: vec![0.0; n],
                v: vec![0.0; n],
                discrete: model.discretes.iter().map(|d| d.values[0]).collect(),
                mode: None,
            },
            project: false,
            at_rest: false,
            stated: vec![false; model.discretes.len()],
            unstated: vec![false; 2 * n],
            freeze: Vec::new(),
            end: End {
                time: 1.0,
                after: None,
            },
            limits: Limits::default(),
            outputs: Vec::new(),
            accuracy: Accuracy::default(),
            method: Method::default(),
            collisions: Collisions::default(),
            record: Record {
                every: Some(f64::INFINITY),
                columns: Recorded {
                    reactions: false,
                    outputs: false,
                    energies: false,
                    inputs: false,
                },
                ledger: true,
                event_states: true,
                extremes: true,
            },
        };
        problem.set_tolerance(1e-8);
        problem
    }

    /// Sets the relative tolerance, and the absolute ones to it times the typical sizes
    /// ([`Problem::typical_sizes`]) with the parameters and the initial state as they are.
    pub fn set_tolerance(&mut self, relative: f64) {
        let sizes = self.typical_sizes();
        let [q_absolute, v_absolute] =
            sizes.map(|sizes| sizes.into_iter().map(|size| relative * size).collect());
        self.accuracy = Accuracy {
            relative,
            q_absolute,
            v_absolute,
        };
    }

    /// Sets a parameter.
    ///
    /// # Errors
    /// [`Invalid`] if the model has no such parameter, or it must not have this value. That one parameter
    /// limits another is looked at when a run starts ([`Problem::check`]).
    pub fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), Invalid> {
        let index = self.model.parameter(name);
        let known = || self.model.parameters.iter().map(|p| p.name);
        let index = index.ok_or_else(|| self.unknown("parameter", name, known()))?;
        let parameter = &self.model.parameters[index];
        within(parameter.bounds(), parameter.unit, value, || {
            format!("parameter `{name}`")
        })?;
        self.parameters[index] = value;
        Ok(())
    }

    /// Sets the initial value of a coordinate (`theta`), a rate (`theta.rate`) or a discrete state; or where a prescribed motion
    /// that is not of the ground starts, and at which rate.
    ///
    /// # Errors
    /// [`Invalid`] if the model has none of that name, or it must not have this value.
    pub fn set_initial(&mut self, name: &str, value: f64) -> Result<(), Invalid> {
        let model = &self.model;
        let mut initial = self.initial.clone();
        let (of, is_rate) = match name.strip_suffix(".rate") {
            Some(of) => (of, true),
            None => (name, false),
        };
        if let Some(motion) = model.motions.iter().find(|m| !m.is_ground && m.name == of) {
            within(Bounds::NONE, "", value, || format!("initial `{name}`"))?;
            let [place, rate] = [!is_rate, is_rate].map(|is_it| is_it.then_some(value));
            self.signals.start(motion.input, place, rate);
            return Ok(());
        }
        let rate = name
            .strip_suffix(".rate")
            .and_then(|name| model.coordinate(name));
        if let Some(i) = rate {
            let n = model.coordinates.len();
            (initial.v[i], self.unstated[n + i]) = (value, false);
        } else if let Some(i) = model.coordinate(name) {
            (initial.q[i], self.unstated[i]) = (value, false);
        } else if let Some(i) = model.discretes.iter().position(|d| d.name == name) {
            (initial.discrete[i], self.stated[i]) = (value, true);
        } else {
            let known = model.coordinates.iter().map(|c| c.name);
            let known = known.chain(model.discretes.iter().map(|d| d.name));
            let motions = model.motions.iter().filter(|m| !m.is_ground);
            let known = known.chain(motions.map(|m| m.name));
            return Err(self
                .unknown("coordinate, rate or discrete state", name, known)
                .into());
        }
        check_initial(model, &initial, self.project)?;
        self.initial = initial;
        Ok(())
    }

    /// Sets an input.
    ///
    /// # Errors
    /// [`Unknown`] if the model has no such input.
    pub fn set_input(&mut self, name: &str, function: Function) -> Result<(), Unknown> {
        let inputs = &self.model.inputs;
        let found = inputs.iter().position(|i| i.name == name);
        let known = || inputs.iter().map(|i| i.name);
        let index = found.ok_or_else(|| self.unknown("input", name, known()))?;
        self.signals.set(index, function);
        Ok(())
    }

    /// Picks the variant with the given options, `(choice, option)`, and the defaults for all other
    /// choices.
    ///
    /// # Errors
    /// [`Unknown`] if the model has no such choice or option, or not these together.
    pub fn choose(&mut self, options: &[(&str, &str)]) -> Result<(), Unknown> {
        let choices = &self.model.choices;
        for (choice, option) in options {
            let known = choices.iter().find(|c| c.name == *choice);
            let all = || choices.iter().map(|c| c.name);
            let known = known.ok_or_else(|| self.unknown("choice", choice, all()))?;
            if !known.options.contains(option) {
                return Err(self.unknown("option", option, known.options.iter().copied()));
            }
        }
        let wanted = |choice: &str| options.iter().find(|(c, _)| *c == choice).map(|(_, o)| *o);
        let fits = |v: &&Variant| {
            (choices.iter().enumerate()).all(|(i, c)| match wanted(c.name) {
                Some(option) => v.options[i] == option,
                None => v.defaults[i],
            })
        };
        let Some(chosen) = self.model.variants.iter().position(|v| fits(&v)) else {
            let name: Vec<_> = options.iter().map(|(_, option)| *option).collect();
            let all = self.model.variants.iter().map(|v| v.options.join(" + "));
            return Err(self.unknown("variant", &name.join(" + "), all));
        };
        self.chosen = chosen;
        Ok(())
    }

    /// The variant with the chosen options.
    pub fn variant(&self) -> &Variant {
        &self.model.variants[self.chosen]
    }

    /// The variant as it runs: without the terms of the optional motions of the ground where none of these acts.
    pub fn automaton(&self) -> &Variant {
        let variant = self.variant();
        match &variant.lean {
            Some((without, lean)) if without.iter().all(|&i| self.signals.input_is_zero(i)) => lean,
            _ => variant,
        }
    }

    /// The first input that is given although the chosen options do not allow it.
    pub(crate) fn barred_input(&self) -> Option<&'static str> {
        let barred = self.variant().barred.iter();
        let given = barred.copied().find(|&i| !self.signals.input_is_zero(i));
        given.map(|i| self.model.inputs[i].name)
    }

    fn unknown(
        &self,
        what: &'static str,
        name: &str,
        known: impl Iterator<Item = impl Into<String>>,
    ) -> Unknown {
        Unknown {
            model: self.model.name,
            what,
            name: name.into(),
            known: known.map(Into::into).collect(),
        }
    }
}
