//! Limit states and validity: what a run watches besides guards, and what it has reached.
//!
//! Each is a margin, watched as [`super::margins`] says until it has been negative once.

use super::outputs::Outputs;
use super::problem::{AtLimit, Observed, OwnLimit, Problem};
use super::start::ROUNDING;
use super::validate::{Invalid, Unknown, within};
use crate::model::{Bounds, GuardShape, Mode, Model, Variant, shown};
use crate::numerics::{Memory, Persist};
use crate::run::{Left, LimitState, Reached};

/// What is watched in a run, and when it was reached.
#[derive(Debug)]
pub(super) struct Margins<'p> {
    variant: &'p Variant,
    /// The limits of the problem.
    pub own: Box<[OwnLimit]>,
    /// Whether the run ends there: limits of the model, its validity in motion, limits of the problem.
    pub ends: Box<[bool]>,
    /// Whether nobody asks for it.
    ignored: Box<[bool]>,
    /// When each was first reached, s.
    reached: Box<[Option<f64>]>,
    /// Whether the run has ended there.
    has_ended: bool,
    /// Room for the values of a mode's requirements and of all margins.
    pub values: Box<[f64]>,
    /// Room for the rounding errors of these.
    pub roundings: Box<[f64]>,
    /// The values at the start of a step.
    pub starts: Box<[f64]>,
    /// Which of them bounds do not show to hold for the whole step.
    pub open: Box<[bool]>,
    /// Outputs, and room for their values.
    pub outputs: Outputs,
    pub output_values: Box<[f64]>,
    /// Room for the reactions, and for all coordinates or their rates.
    pub reactions: Box<[f64]>,
    pub all: Box<[f64]>,
}

impl Persist for Margins<'_> {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        memory.slice(&mut self.reached)?;
        self.has_ended.persist(memory)
    }
}

impl<'p> Margins<'p> {
    pub fn new(problem: &'p Problem) -> Self {
        let (model, variant) = (&*problem.model, problem.variant());
        let course = |ends: bool| {
            if ends {
                AtLimit::End
            } else {
                AtLimit::Continue
            }
        };
        let of_model = variant.limits.iter().map(|limit| {
            let mut said = problem.limits.of_model.iter();
            let said = said.find(|(name, _)| *name == limit.name);
            said.map_or(course(limit.ends), |(_, course)| *course)
        });
        let of_motion = variant.valid_motion.iter().map(|_| AtLimit::Continue);
        let own = problem.limits.own.iter().map(|limit| course(limit.ends));
        let courses: Box<[AtLimit]> = of_model.chain(of_motion).chain(own).collect();
        let ends: Box<[bool]> = courses.iter().map(|of| *of == AtLimit::End).collect();
        let required = variant.modes.iter().map(|mode| mode.requirements.len());
        let zeros = |count: usize| vec![0.0; count].into_boxed_slice();
        let room = required.max().unwrap_or(0) + ends.len();
        let outputs = Outputs::new(problem);
        Margins {
            variant,
            own: problem.limits.own.clone().into(),
            ignored: courses.iter().map(|of| *of == AtLimit::Ignore).collect(),
            reached: vec![None; ends.len()].into(),
            ends,
            has_ended: false,
            values: zeros(room),
            roundings: zeros(room),
            starts: zeros(room),
            open: vec![true; room].into(),
            output_values: zeros(outputs.count()),
            outputs,
            reactions: zeros(model.coordinates.len() + model.motions.len()),
            all: zeros(model.coordinates.len()),
        }
    }

    /// Forgets what was reached, for the next run.
    pub fn clear(&mut self) {
        self.reached.fill(None);
        self.has_ended = false;
    }

    /// Whether the run has come to a limit at which it ends.
    pub fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// Whether one is asked for and was not reached so far.
    pub fn is_pending(&self, margin: usize) -> bool {
        self.reached[margin].is_none() && !self.ignored[margin]
    }

    /// Notes that a margin is negative at `t` (s).
    #[cold]
    pub fn reach(&mut self, margin: usize, t: f64) {
        if self.is_pending(margin) {
            self.reached[margin] = Some(t);
            self.has_ended |= self.ends[margin];
        }
    }

    /// Whether something is to be watched while a mode lasts.
    pub fn watches(&self, mode: &Mode) -> bool {
        let mut pending = (0..self.ends.len()).filter(|&margin| self.is_pending(margin));
        !mode.requirements.is_empty() || pending.any(|margin| self.shape(mode, margin).is_some())
    }

    /// How a margin depends on the motion in a mode; `None`: it does not change there.
    pub fn shape(&self, mode: &Mode, margin: usize) -> Option<GuardShape> {
        let general = GuardShape::General {
            accelerations: true,
            signals: true,
        };
        let Some(own) = margin.checked_sub(mode.margins.len()) else {
            return mode.margins[margin];
        };
        let (i, rate) = match self.own[own].of {
            Observed::Coordinate(i) => (i, false),
            Observed::Rate(i) => (i, true),
            Observed::Reaction(i) if mode.free.contains(&i) => return None,
            Observed::Reaction(_) | Observed::Output(_) => return Some(general),
        };
        match mode.free.iter().position(|&free| free == i) {
            Some(index) => Some(GuardShape::Linear {
                index,
                rate,
                factor: if self.own[own].above { -1.0 } else { 1.0 },
                discrete: None,
                offset: true,
            }),
            None if mode.depends[i] || mode.drifts[i] && !rate => Some(general),
            None => None,
        }
    }

    /// What the run has reached.
    pub fn reached(&self) -> Reached {
        let Variant {
            limits,
            valid_motion,
            ..
        } = self.variant;
        let (of_model, rest) = self.reached.split_at(limits.len());
        let (of_motion, own) = rest.split_at(valid_motion.len());
        let state = |name: &str, message: &str, t: f64, ends| LimitState {
            name: name.into(),
            t,
            message: message.into(),
            ends,
        };
        let of_model = limits.iter().zip(of_model).zip(&self.ends);
        let of_model =
            of_model.filter_map(|((l, t), &ends)| Some(state(l.name, l.message, (*t)?, ends)));
        let own = self.own.iter().zip(own);
        let own = own.filter_map(|(l, t)| Some(state(&l.name, &l.message, (*t)?, l.ends)));
        let mut limit_states: Vec<_> = of_model.chain(own).collect();
        limit_states.sort_by(|a, b| a.t.total_cmp(&b.t));
        let mut names = std::collections::BTreeSet::new();
        limit_states.retain(|state| names.insert(state.name.clone()));
        let left = valid_motion.iter().zip(of_motion);
        let left = left.filter_map(|(v, t)| {
            Some(Left {
                condition: v.condition.into(),
                message: v.sentence.into(),
                t: Some((*t)?),
            })
        });
        let mut validity: Vec<_> = left.collect();
        validity.sort_by(|a, b| a.t.partial_cmp(&b.t).unwrap_or(std::cmp::Ordering::Equal));
        Reached {
            limit_states,
            validity,
        }
    }
}

impl Problem {
    /// Says what a run does at a limit state of the model.
    ///
    /// # Errors
    /// [`Unknown`] if the model has no such limit under its present choices.
    pub fn set_limit(&mut self, name: &str, course: AtLimit) -> Result<(), Unknown> {
        let limits = self.variant().limits.iter();
        let known = limits.clone().find(|limit| limit.name == name);
        let Some(name) = known.map(|limit| limit.name) else {
            return Err(Unknown {
                model: self.model.name,
                what: "limit state",
                name: name.into(),
                known: limits.map(|limit| limit.name.into()).collect(),
            });
        };
        self.limits.of_model.retain(|(known, _)| *known != name);
        self.limits.of_model.push((name, course));
        Ok(())
    }

    /// The conditions on parameters, under which the model is meant, that do not hold.
    pub fn invalid_parameters(&self) -> Vec<Left> {
        let margins = declared(self.variant(), &self.parameters);
        let margins = self.variant().valid_parameters.iter().zip(margins);
        let left = margins.filter(|(_, margin)| margin.is_nan() || *margin < 0.0);
        left.map(|(validity, _)| Left {
            condition: validity.condition.into(),
            message: validity.sentence.into(),
            t: None,
        })
        .collect()
    }

    /// Bounds of a coordinate of every admissible state, with the parameters as they are.
    pub fn bounds(&self, coordinate: usize) -> Bounds {
        let mut bounds = self.model.coordinates[coordinate].bounds();
        let values = declared(self.variant(), &self.parameters);
        let values = &values[self.variant().valid_parameters.len()..];
        let all = self.variant().bounds.iter().zip(values);
        for (bound, &value) in all.filter(|(bound, _)| bound.coordinate == coordinate) {
            match bound.upper {
                true => bounds.maximum = value,
                false => bounds.minimum = value,
            }
        }
        bounds
    }

    /// The limits must be about what there is.
    pub(super) fn check_limits(&self) -> Result<(), Invalid> {
        let n = self.model.coordinates.len();
        for limit in &self.limits.own {
            within(Bounds::NONE, "", limit.level, || {
                format!("limit `{}`", limit.name)
            })?;
            let (found, expected) = match limit.of {
                Observed::Coordinate(i) | Observed::Rate(i) => (i, n),
                Observed::Reaction(i) => (i, n + self.model.motions.len()),
                Observed::Output(i) => (i, self.variant().outputs.len() + self.outputs.len()),
            };
            if found >= expected {
                let what = "index of what a limit is about";
                return Err(Invalid::Count {
                    what,
                    found,
                    expected,
                });
            }
        }
        Ok(())
    }
}

/// What follows from parameters alone: margins of the validity, then bounds of coordinates.
fn declared(variant: &Variant, parameters: &[f64]) -> Vec<f64> {
    let mut values = vec![0.0; variant.declared.count()];
    variant.declared.evaluate(parameters, &mut values);
    values
}

/// Coordinates must be within the bounds that depend on parameters.
pub(super) fn check_bounds(
    model: &Model,
    variant: &Variant,
    parameters: &[f64],
    q: &[f64],
) -> Result<(), Invalid> {
    if variant.bounds.is_empty() {
        return Ok(());
    }
    let values = declared(variant, parameters);
    let values = &values[variant.valid_parameters.len()..];
    for (bound, &value) in variant.bounds.iter().zip(values) {
        let at = q[bound.coordinate];
        let beyond = if bound.upper { at - value } else { value - at };
        if beyond > ROUNDING * value.abs() {
            let c = &model.coordinates[bound.coordinate];
            let sign = if bound.upper { "<=" } else { ">=" };
            return Err(Invalid::BeyondStop {
                coordinate: c.name,
                value: at,
                range: format!("{sign} {} = {} {}", bound.text, shown(value), c.unit),
            });
        }
    }
    Ok(())
}
