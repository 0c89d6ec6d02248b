//! Outputs: what the model and its scene name besides the state, evaluated where they are recorded or asked for.

use super::problem::Problem;
use super::validate::Unknown;
use crate::formula::{Formula, FormulaError, Given, Names};
use crate::kernel::{Context, Free, ModeKernel};
use crate::numerics::Size;
use crate::run::{Layout, Quantity};

/// An output that is not the model's.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnOutput {
    /// Name, unit and meaning.
    pub quantity: Quantity,
    /// What it is.
    pub formula: Formula,
}

impl Problem {
    /// Adds an output: a formula over the model's quantities and the outputs before it, such as `x + R * sin(theta)`, in
    /// a unit, such as `mm`.
    ///
    /// # Errors
    /// [`FormulaError`] if the name is taken or no name, the formula is none, or its dimension is not that of the unit.
    pub fn add_output(
        &mut self,
        name: &str,
        unit: &str,
        formula: &str,
        meaning: &str,
    ) -> Result<(), FormulaError> {
        let names = self.names();
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let is_name =
            name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(plain);
        let refused = |message: String| FormulaError {
            range: None,
            message,
            help: "choose another name, of letters, digits and underscores".to_owned(),
        };
        if !is_name {
            return Err(refused(format!("`{name}` is not a name for an output")));
        }
        if names.has(name) || ["t", "mode", "j"].contains(&name) {
            return Err(refused(format!("`{name}` is there already")));
        }
        self.outputs.push(OwnOutput {
            quantity: Quantity::new(name, unit, meaning),
            formula: Formula::new(formula, unit, &names)?,
        });
        Ok(())
    }

    /// The names that formulas may use.
    pub fn names(&self) -> Names {
        let own = self.outputs.iter().map(|o| &o.quantity);
        let own = own.map(|quantity| (&*quantity.name, &*quantity.unit));
        Names::new(&self.model, self.variant(), own)
    }

    /// Names and units of all outputs: those of the model, then those of the problem.
    pub fn output_quantities(&self) -> Vec<Quantity> {
        Layout::outputs_of(self.variant(), self.own_quantities())
    }

    /// Place of an output among all.
    ///
    /// # Errors
    /// [`Unknown`] if there is none of that name.
    pub fn output(&self, name: &str) -> Result<usize, Unknown> {
        let all = self.output_quantities();
        let found = all.iter().position(|quantity| quantity.name == name);
        found.ok_or_else(|| Unknown {
            model: self.model.name,
            what: "output",
            name: name.into(),
            known: all.into_iter().map(|quantity| quantity.name).collect(),
        })
    }

    /// Names, units and order of all that a run of this problem records.
    pub fn layout(&self) -> Layout {
        let columns = self.record.columns;
        Layout::new(&self.model, self.variant(), columns, self.own_quantities())
    }

    /// Names, units and meanings of the outputs besides those of the model.
    pub fn own_quantities(&self) -> impl Iterator<Item = &Quantity> {
        self.outputs.iter().map(|output| &output.quantity)
    }
}

/// Evaluates the outputs of a problem.
#[derive(Debug, Clone)]
pub(super) struct Outputs {
    /// Number of those of the model, which come first.
    of_model: usize,
    /// Number of coordinates, and which of them are multipliers, that nobody looks at.
    hidden: std::ops::Range<usize>,
    own: Box<[Formula]>,
    reads_reactions: bool,
    parameters: Box<[f64]>,
    /// Room for all coordinates, velocities, accelerations and reactions.
    q: Box<[f64]>,
    v: Box<[f64]>,
    a: Box<[f64]>,
    reactions: Box<[f64]>,
}

impl Outputs {
    pub fn new(problem: &Problem) -> Self {
        let n = problem.model.coordinates.len();
        let zeros = |count: usize| vec![0.0; count].into_boxed_slice();
        let own: Box<[Formula]> = problem.outputs.iter().map(|o| o.formula.clone()).collect();
        Outputs {
            of_model: problem.variant().outputs.len(),
            hidden: problem.model.own_coordinates().len()..n,
            reads_reactions: own.iter().any(Formula::reads_reactions),
            own,
            parameters: problem.parameters.clone().into(),
            q: zeros(n),
            v: zeros(n),
            a: zeros(n),
            reactions: zeros(n + problem.model.motions.len()),
        }
    }

    /// Number of them.
    pub fn count(&self) -> usize {
        self.of_model + self.own.len()
    }

    /// Goes over to other parameters.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        self.parameters.copy_from_slice(parameters);
    }

    /// Evaluates the reactions that are recorded at a state of the present mode, for whose time the context is set.
    pub fn reactions<F: Size>(
        &mut self,
        kernel: &ModeKernel<F>,
        context: &Context,
        at: Free<F>,
        out: &mut [f64],
    ) {
        if self.hidden.is_empty() {
            return kernel.reactions(context, at, out);
        }
        kernel.reactions(context, at, &mut self.reactions);
        let (own, motions) = out.split_at_mut(self.hidden.start);
        own.copy_from_slice(&self.reactions[..self.hidden.start]);
        motions.copy_from_slice(&self.reactions[self.hidden.end..]);
    }

    /// Evaluates all at a state of the present mode, for whose time the context is set.
    pub fn evaluate<F: Size>(
        &mut self,
        kernel: &ModeKernel<F>,
        context: &Context,
        at: Free<F>,
        out: &mut [f64],
    ) {
        kernel.outputs(context, at, &mut out[..self.of_model]);
        if self.own.is_empty() {
            return;
        }
        kernel.coordinates(context, at, &mut self.q);
        kernel.rates(context, at, &mut self.v);
        kernel.accelerations(context, at, &mut self.a);
        if self.reads_reactions {
            kernel.reactions(context, at, &mut self.reactions);
        }
        for (i, formula) in self.own.iter().enumerate() {
            let (before, rest) = out.split_at_mut(self.of_model + i);
            rest[0] = formula.value(&Given {
                q: &self.q,
                v: &self.v,
                a: &self.a,
                reactions: &self.reactions,
                discrete: context.discrete(),
                signals: context.signals(),
                parameters: &self.parameters,
                outputs: before,
            });
        }
    }
}
